/* The branch of solutions that begins at a step of length 0.
 *
 * The equations of a long step have several solutions. The one that belongs to the motion becomes
 * the state itself as the step shrinks to 0. It is followed from there: the equations of a growing
 * part of the step are solved, each time from a guess that is extrapolated through the solutions
 * before.  Source: Deuflhard 2004, sec. 5.1. */
#ifndef DVI_SOLVE_BRANCH_H
#define DVI_SOLVE_BRANCH_H
#include "solve/nonlinear.h"

/* Numbers of solutions that an extrapolation goes through, and of vectors of work. */
enum { DVI__BRANCH_POINTS = 4, DVI__BRANCH_ROOM = DVI__BRANCH_POINTS + 2 };

/* Largest distance between an extrapolated guess and the next solution, as a part of how far the
 * branch has come. */
#define DVI__BRANCH_NEAR 0.03

/* A branch is followed in at most DVI__BRANCH_PARTS parts of a step. It is followed in at least
 * DVI__BRANCH_CAREFUL parts where solutions of another branch were met. */
enum { DVI__BRANCH_PARTS = 4096, DVI__BRANCH_CAREFUL = 64, DVI__BRANCH_SENTENCE = 600 };

typedef struct dvi__branch {
  void *of; /* first argument of the functions */
  /* Put the solver's equations at `part` of the step, 0 < part <= 1. */
  dvi_status (*place)(void *of, double part);
  /* Guess x [unknowns] for a short part of the step. */
  dvi_status (*guess)(void *of, double part, double *x);
  /* Measure how far a solution is from its guess. Default: the largest part, over the groups, of
   * how far the group has come. */
  double (*distance)(void *of, const double *guess, const double *x);
  double near; /* a solution on the branch is no farther from an extrapolated guess */
  int parts;   /* smallest number of parts in which the step is followed */
  /* along the branch the determinant of the Jacobian changes its sign at folds alone */
  int signs;
  /* the Jacobian is symmetric, and before folds it is positive (1) or negative (-1) definite;
   * default 0 (not known) */
  int definite;
  int from_zero; /* x is 0 at a step of length 0, and the extrapolation begins there */
  double size;   /* size of the quantities to which x is an increment (nonlinear.h) */
  double *room;  /* [DVI__BRANCH_ROOM * unknowns] */
} dvi__branch;

/* How far a branch was followed, and how the iteration beyond the last solution went. */
typedef struct dvi__branch_end {
  double reached;
  dvi__solve_report report;
  dvi_status status;
  /* there is no solution beyond, or only one across a fold; 0 if there is one, but not near its
   * guess */
  int ends;
} dvi__branch_end;

/* Find the solution x [unknowns] of the whole step on the branch. The equations are left there.
 *
 * DVI_STEP_TOO_LARGE: the branch ends before the whole step, or nothing can be solved beyond. Then
 * x is the last solution. A negative status is fatal. */
dvi_status dvi__branch_follow(const dvi__branch *branch, dvi__solver *solver, double *x,
                              dvi__branch_end *end);

/* Tell whether a Newton method began near its solution, and the equations were nearly linear in
 * between, in every group. */
int dvi__branch_is_near(const dvi__solve_report *report);

/* Tell whether the equations were all but linear from the guess to the solution, however far apart
 * these are. */
int dvi__branch_is_straight(const dvi__solve_report *report);

/* The failure of the whole step, before its branch was followed. */
typedef struct dvi__branch_failure {
  dvi_status status; /* DVI_OK if nothing failed */
  int unsolved;      /* 1 if an iterative solver did not find a correction */
  char sentence[DVI__BRANCH_SENTENCE];
} dvi__branch_failure;

/* Keep a status of the solver and the thread's error sentence. */
void dvi__branch_note(dvi_status status, const dvi__solver *solver, dvi__branch_failure *failure);

/* Fail with DVI_STEP_TOO_LARGE and a sentence on how far the solutions of a step of length h reach.
 * A callback's failure takes precedence: that of the whole step, else that beyond the end. */
dvi_status dvi__branch_tell(const dvi__branch_end *end, double h, const dvi__branch_failure *whole);

#endif
