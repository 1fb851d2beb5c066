/* Systems of nonlinear equations R(x) = 0, and the ladder of solvers behind one door. Nothing here
 * knows mechanics.
 *
 * The rungs, cheap to robust:
 *   fixed point  x <- x - C^{-1} R(x) with a constant matrix C that the equations supply (the
 *     chord);
 *   simplified
 *   the same with a matrix near the Jacobian that the equations freeze at the guess and solve in
 *     their own way;
 *   Newton       with the LU factor of the Jacobian kept while the corrections shrink fast;
 *   KINSOL       Newton with line search, then Newton's method to the floor.
 * All end at the roundoff floor: a tolerance of a few roundings of the unknowns, or corrections
 * that no longer shrink. */
#ifndef DVI_SOLVE_NONLINEAR_H
#define DVI_SOLVE_NONLINEAR_H
#include "num/linear.h"

typedef struct dvi__equations dvi__equations;

struct dvi__equations {
  int unknowns;
  int group; /* so many unknowns in a row have one unit, and are measured together; 0: 1 */
  void *of;  /* first argument of the callbacks */
  /* Before the first Jacobian is asked for, once: make ready for it, and complete what follows up
   * to `whole` in the solver's own copy of the equations. After a failure it is called again by the
   * next solve. NULL: all is there. */
  dvi_status (*prepare)(void *of, struct dvi__equations *own);
  const dvi__pattern *pattern; /* of the Jacobian; outlives the solver */
  /* that factors it; default: AUTO, which takes the diagonal's entries for the largest ones */
  dvi__linear_kind linear;
  /* so many of the last rows and columns may be full: sparse all the same; 0: none, `linear` says
   * what is done */
  int border;
  /* The Jacobian as an operator, which has no pattern: `jacobian` puts it at x, and gets no values.
   * NULL: it is a matrix. Outlives the solver. */
  const dvi__operator *whole;
  dvi_status (*residual)(void *of, const double *x, double *r);
  dvi_status (*jacobian)(void *of, const double *x, double *values);
  dvi_status (*prepare_chord)(void *of, const double *x);
  void (*chord)(void *of, double *r); /* r <- C^{-1} r */
  /* [unknowns] > 0: size of a row per unit of an unknown; after prepare_chord. *unchanged, 0
   * before, is set to 1 if it is what it was at the last call. */
  dvi_status (*row_scale)(void *of, double *scale, int *unchanged);
  /* [unknowns] sums of the magnitudes of what is summed in each row at the last residual's point;
   * NULL: not known. A row cannot be told from 0 to better than a rounding of it, and a correction
   * cannot be smaller than what the Jacobian makes of that. */
  void (*magnitudes)(void *of, double *magnitude);
  /* of the residual beyond roundoff, relative to the unknowns: it holds differences; 0: none */
  double noise;
  /* Newton's method factors the Jacobian at each of its points: the equations are nearly singular,
   * and an old factor leads astray */
  int renewed;
  /* and what is taken from the last residual's point is corrected to first order: the next
   * correction need not be seen to be small */
  int ahead;
  /* The same fixed point iteration in variables of the equations' own, where that is cheaper; NULL:
   * residual and chord do it. */
  void (*sweep_from)(void *of, const double *x);
  dvi_status (*sweep)(void *of, double *change, double *largest);
  void (*sweep_to)(void *of, double *x);
  /* Simplified Newton's method; NULL: there is none. */
  dvi_status (*freeze)(void *of, const double *x);
  void (*frozen)(void *of, double *r); /* r <- correction */
};

typedef enum dvi__rung { DVI__FIXED_POINT, DVI__SIMPLIFIED, DVI__NEWTON, DVI__KINSOL } dvi__rung;

/* How a solve went; on failure, for the sentence. */
typedef struct dvi__solve_report {
  int iterations;
  double largest_first; /* change of an unknown in the first iteration of Newton's methods */
  /* the first correction of Newton's methods relative to the unknowns, group by group: the worst */
  double first;
  /* the largest second correction over the largest first one, 0: there was none */
  double contraction;
  double bend;       /* the same, group by group: the worst */
  double correction; /* largest change of an unknown in the last iteration */
  double residual;   /* KINSOL's: largest |R_i| / row_scale_i at the last point */
  double row;        /* Newton's method's: largest |R_i| there */
} dvi__solve_report;

typedef struct dvi__solver dvi__solver;

/* Memory for Newton's method and for KINSOL is taken when each is first needed. */
dvi_status dvi__solver_create(const dvi__equations *equations, dvi_counters *counters,
                              dvi__solver **solver);
void dvi__solver_destroy(dvi__solver **solver);

/* One rung, from the guess in x to the solution in x.
 *
 * `size` is the size of the quantities to which x is an increment: rounding noise of size * epsilon
 * is expected. With `wary`, Newton's methods give up on a guess so far off that it might lead to
 * another solution. With `patient`, slow fixed point iterations go on. A positive status: not
 * solved, x is spoilt; a negative one: fatal. */
dvi_status dvi__solve(dvi__solver *solver, dvi__rung rung, double size, int wary, int patient,
                      double *x, dvi__solve_report *report);

/* Let KINSOL judge a solution that another rung found; x stays. DVI_NOT_CONVERGED: it does not
 * pass, and the KINSOL rung should take over. */
dvi_status dvi__certify(dvi__solver *solver, double size, const double *x,
                        dvi__solve_report *report);

/* The Jacobian's values at x, and no factor. */
dvi_status dvi__solver_jacobian(dvi__solver *solver, const double *x, double *values);

/* Factor a Jacobian of these values, in the order of the pattern, unless it is the last one that
 * was factored. */
dvi_status dvi__solver_take_jacobian(dvi__solver *solver, const double *values);

/* Solve with the Jacobian that was factored last: b [unknowns] becomes J^{-1} b. */
void dvi__solver_apply_factor(dvi__solver *solver, double *b);

/* The sign of the determinant of the Jacobian that was factored last, and is near that of the
 * solution if the iteration went by it; 1 if there is none, or it is not known. */
int dvi__solver_sign(const dvi__solver *solver);

/* Whether that Jacobian, a symmetric one, is positive (sign 1) or negative (-1) definite; 1 if
 * there is none, or it is not known. */
int dvi__solver_is_definite(const dvi__solver *solver, int sign);

/* Make ready for Newton's method, as its first use does. DVI_NO_MEMORY, and as `prepare` fails. */
dvi_status dvi__solver_prepare(dvi__solver *solver);

/* The linear solver of the Newton rungs, after that. */
dvi__linear *dvi__solver_linear(const dvi__solver *solver);

#endif
