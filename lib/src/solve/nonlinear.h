/* Systems of nonlinear equations R(x) = 0, and several solvers behind one interface. Nothing here
 * knows mechanics. Each solver is a rung. The caller's ladder says which rung follows which
 * (method/element/element_step.c).
 *
 * The rungs, from cheap to robust:
 *   fixed point  x <- x - C^{-1} R(x) with a constant matrix C that the equations supply (the
 *                chord);
 *   simplified   the same with a matrix near the Jacobian that the equations freeze at the guess
 *                and solve in their own way;
 *   Newton       with the LU factor of the Jacobian kept while the corrections shrink fast;
 *   KINSOL       Newton with line search, then Newton's method to the floor.
 *
 * All end at the roundoff floor, which is a tolerance of a few roundings of the unknowns, or
 * corrections that no longer shrink. */
#ifndef DVI_SOLVE_NONLINEAR_H
#define DVI_SOLVE_NONLINEAR_H
#include "num/linear.h"

typedef struct dvi__equations dvi__equations;

struct dvi__equations {
  int unknowns;
  /* number of unknowns in a row that have one unit and are measured together (default 1) */
  int group;
  void *of; /* first argument of the callbacks */
  /* Called once, before the first Jacobian is needed. Completes the members from `pattern` to
   * `whole` in the solver's own copy of the equations. After a failure the next solve calls it
   * again. NULL if nothing is to be prepared. */
  dvi_status (*prepare)(void *of, struct dvi__equations *own);
  const dvi__pattern *pattern; /* pattern of the Jacobian, which outlives the solver */
  /* linear solver of the Jacobian; default AUTO, which takes the diagonal entries for the largest
   * ones. With COMPLEX values are pairs, and corrections are real parts: those of H + i delta are
   * H (H^2 + delta^2)^-1 R, Tikhonov's, where a symmetric H may be singular */
  dvi__linear_kind linear;
  /* number of last rows and columns that may be full while the matrix counts as sparse; default 0,
   * and `linear` alone decides */
  int border;
  /* The Jacobian as an operator without a pattern, which outlives the solver. `jacobian` puts the
   * operator at x and gets no values. NULL if the Jacobian is a matrix. */
  const dvi__operator *whole;
  dvi_status (*residual)(void *of, const double *x, double *r);
  dvi_status (*jacobian)(void *of, const double *x, double *values);
  /* The Jacobian in parts, or NULL. invert evaluates its derivatives at x, and tells whether
   * correct can replace r by J^{-1} r there, for a determinant with the sign 1. If it cannot, fill
   * writes the values, which are factored. */
  dvi_status (*invert)(void *of, const double *x, int *inverted);
  void (*correct)(void *of, double *r);
  void (*fill)(void *of, double *values);
  dvi_status (*prepare_chord)(void *of, const double *x); /* NULL if nothing is to be prepared */
  void (*chord)(void *of, double *r);                     /* r <- C^{-1} r */
  /* Set scale [unknowns] > 0 to the size of a row per unit of an unknown. Called after
   * prepare_chord. *unchanged, 0 before, becomes 1 if the sizes are those of the last call. */
  dvi_status (*row_scale)(void *of, double *scale, int *unchanged);
  /* Set magnitude [unknowns] to the sum of the magnitudes of what is summed in each row at the last
   * residual's point. A row cannot be told from 0 to better than a rounding of this sum, and a
   * correction cannot be smaller than the effect of that on the solution. NULL if not known. */
  void (*magnitudes)(void *of, double *magnitude);
  /* error of the residual beyond roundoff, relative to the unknowns, where it holds differences */
  double noise;
  /* Newton's method factors the Jacobian at each of its points, because the equations are nearly
   * singular and an old factor leads astray */
  int renewed;
  /* all results are those of the solution, or are corrected to it to first order, so that the next
   * correction need not be seen to be small */
  int ahead;
  int rough; /* the Jacobian is exact for short steps alone, and costs as much as many residuals */
  /* The same fixed point iteration in variables of the equations' own, where that is cheaper. NULL
   * if residual and chord serve. */
  void (*fixed_point_begin)(void *of, const double *x);
  dvi_status (*fixed_point_iterate)(void *of, double *change, double *largest);
  void (*fixed_point_end)(void *of, double *x);
  /* that iteration is simplified Newton's method, with the Jacobian of its guess */
  int fixed_point_frozen;
  /* Those variables, for a test of the solution. Their number, their values after the last
   * iteration, and the residual there, z less what one more iteration makes of it. z is a copy. */
  int own_unknowns;
  const double *(*own_point)(void *of);
  dvi_status (*own_residual)(void *of, const double *z, double *r);
  /* Simplified Newton's method, or NULL. */
  dvi_status (*freeze)(void *of, const double *x);
  void (*frozen)(void *of, double *r); /* r <- correction */
};

typedef enum dvi__rung { DVI__FIXED_POINT, DVI__SIMPLIFIED, DVI__NEWTON, DVI__KINSOL } dvi__rung;

/* How a solve went, for the sentence on failure. */
typedef struct dvi__solve_report {
  int iterations;
  int idle; /* those at the end of Newton's method whose corrections were roundings */
  /* largest change of an unknown in the first iteration of Newton's methods */
  double largest_first;
  /* first correction of Newton's methods relative to the unknowns, largest of all groups */
  double first;
  /* largest second correction over the largest first one, 0 if there was none */
  double contraction;
  double bend;       /* the same ratio for the worst group */
  double correction; /* largest change of an unknown in the last iteration */
  double residual;   /* largest |R_i| / row_scale_i at KINSOL's last point */
  double row;        /* largest |R_i| at the last point of Newton's method */
} dvi__solve_report;

typedef struct dvi__solver dvi__solver;

/* Memory for Newton's method and for KINSOL is allocated when each is first needed. */
dvi_status dvi__solver_create(const dvi__equations *equations, dvi_counters *counters,
                              dvi__solver **solver);
void dvi__solver_destroy(dvi__solver **solver);

/* Run one rung, from the guess in x to the solution in x.
 *
 * `size` is the size of the quantities to which x is an increment. Rounding noise of size * epsilon
 * is expected. With `wary`, Newton's methods give up on a guess so far off that it might lead to
 * another solution. With `patient`, slow fixed point iterations go on. A positive status says that
 * there is no solution and x is spoilt. A negative one is fatal. */
dvi_status dvi__solve(dvi__solver *solver, dvi__rung rung, double size, int wary, int patient,
                      double *x, dvi__solve_report *report);

/* Evaluate the Jacobian's values at x without a factor. */
dvi_status dvi__solver_jacobian(dvi__solver *solver, const double *x, double *values);

/* Factor a Jacobian of these values, in the order of the pattern, unless the last factored one has
 * the same values. */
dvi_status dvi__solver_take_jacobian(dvi__solver *solver, const double *values);

/* Solve with the Jacobian that was factored last. b [unknowns] becomes J^{-1} b. */
void dvi__solver_apply_factor(dvi__solver *solver, double *b);

/* Give the sign of the determinant of the Jacobian that was factored last. That Jacobian is near
 * the solution's if the iteration used it. 1 if there is none, or the sign is not known. */
int dvi__solver_sign(const dvi__solver *solver);

/* Tell whether that Jacobian, a symmetric one, is positive (sign 1) or negative (-1) definite. 1 if
 * there is none, or it is not known. */
int dvi__solver_is_definite(const dvi__solver *solver, int sign);

/* Prepare Newton's method, as its first use does. DVI_NO_MEMORY, and the failures of `prepare`. */
dvi_status dvi__solver_prepare(dvi__solver *solver);

/* Give the linear solver of the Newton rungs, once prepared. */
dvi__linear *dvi__solver_linear(const dvi__solver *solver);

#endif
