/* The branch of solutions that begins at a step of length 0.
 *
 * The equations of a long step have several solutions. The one that belongs to the motion becomes
 * the state itself as the step shrinks to 0. It is followed from there: the equations of a growing
 * part of the step are solved, each time from a guess that is extrapolated through the solutions
 * before.  Source: Deuflhard 2004, sec. 5.1. */
#ifndef DVI_SOLVE_BRANCH_H
#define DVI_SOLVE_BRANCH_H
#include "solve/nonlinear.h"

/* Solutions that an extrapolation goes through; vectors of work. */
enum { DVI__BRANCH_POINTS = 4, DVI__BRANCH_ROOM = DVI__BRANCH_POINTS + 2 };

/* Between an extrapolated guess and the next solution, as a part of how far the branch has come. */
#define DVI__BRANCH_NEAR 0.03

/* A branch is followed in at most so many parts of a step; and in at least so many where solutions
 * of another one were met. */
enum { DVI__BRANCH_PARTS = 4096, DVI__BRANCH_CAREFUL = 64, DVI__BRANCH_SENTENCE = 600 };

typedef struct dvi__branch {
  void *of; /* first argument of the functions */
  /* Put the solver's equations at `part` of the step, 0 < part <= 1. */
  dvi_status (*place)(void *of, double part);
  /* x [unknowns], a guess for a short part of the step. */
  dvi_status (*guess)(void *of, double part, double *x);
  /* How far a solution is from its guess; NULL: as a part of how far its group has come, the
   * worst. */
  double (*distance)(void *of, const double *guess, const double *x);
  double near; /* a solution on the branch is no farther from an extrapolated guess */
  int parts;   /* the step is followed in at least so many parts */
  /* along the branch the determinant of the Jacobian changes its sign at folds alone */
  int signs;
  /* 1, -1: and it is symmetric, and positive or negative definite before them; 0: it need not be */
  int definite;
  int from_zero; /* x is 0 at a step of length 0: the extrapolation begins there */
  double size;   /* of the quantities to which x is an increment (nonlinear.h) */
  double *room;  /* [DVI__BRANCH_ROOM * unknowns] */
} dvi__branch;

/* What was found: the part of the step up to which there is a solution; how the iteration beyond
 * went, and its status. */
typedef struct dvi__branch_end {
  double reached;
  dvi__solve_report report;
  dvi_status status;
  /* there is no solution beyond, or one across a fold; 0: there is one, but not near its guess */
  int ends;
} dvi__branch_end;

/* The solution x [unknowns] of the whole step on the branch; the equations are left there.
 *
 * DVI_STEP_TOO_LARGE: the branch ends before, or nothing can be solved beyond; x is the last
 * solution. A negative status: fatal. */
dvi_status dvi__branch_follow(const dvi__branch *branch, dvi__solver *solver, double *x,
                              dvi__branch_end *end);

/* Whether a Newton method began near its solution, and the equations were nearly linear in between,
 * group by group. */
int dvi__branch_is_near(const dvi__solve_report *report);

/* Whether the equations were all but linear from the guess to the solution, however far that is. */
int dvi__branch_is_straight(const dvi__solve_report *report);

/* What the solution of the whole step failed by, before its branch was followed. */
typedef struct dvi__branch_failure {
  dvi_status status; /* DVI_OK: nothing failed */
  char sentence[DVI__BRANCH_SENTENCE];
} dvi__branch_failure;

/* Keep a status and the thread's error sentence. */
void dvi__branch_note(dvi_status status, dvi__branch_failure *failure);

/* DVI_STEP_TOO_LARGE, with a sentence on how far the solutions of a step of length h reach. But a
 * callback's failure speaks for itself: that of the whole step, else that beyond the end. */
dvi_status dvi__branch_tell(const dvi__branch_end *end, double h, const dvi__branch_failure *whole);

#endif
