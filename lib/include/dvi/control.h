/** Optimal control: the forces u(t) that bring a system from one state to another one at the least
 *  cost.
 *
 *      minimise  h sum_j b_j C(t_j, Q_j, V_j, u_j)  over all steps,
 *      d/dt L_v = L_q + F + F_u(t,q,v,u)  as the rows of a method (forced discrete Euler-Lagrange
 *      equations), with u at the points of its quadrature.
 *
 *  With a multiplier w_a for each row the Lagrange function of this problem is the discrete action
 *  of the Lagrangian
 *
 *      G(t, (q,w), (v,w')) = min over u of C + w.(L_q + F + F_u) + w'.L_v
 *
 *  by the same method. Its stationary paths are found as those of dvi/path.h, by Newton's method
 *  with line search and sparse LU. Cost and costates have the order of the method. Source: Junge,
 *  Marsden and Ober-Bloebaum 2005; Ober-Bloebaum, Junge and Marsden 2011, sec. 3 and 4. */
#ifndef DVI_CONTROL_H
#define DVI_CONTROL_H
#include <dvi/path.h>

/** Controls u [count], their forces and their cost. All results are 0 before a call. Matrices are
 *  stored by columns. Callbacks return 0 for success, else as in dvi/system.h. */
typedef struct dvi_controls {
  int count; /**< 1 to 16 */
  /** The cost C per unit of time and its derivatives C_q and C_v [n], C_u [count]. As a function of
   *  u the cost must be strictly convex. Required. */
  int (*cost)(double t, const double *q, const double *v, const double *u, double *C, double *C_q,
              double *C_v, double *C_u, void *user);
  /** The forces F_u [n] of the controls, beside those of the system, and their derivatives F_q and
   *  F_v [n x n] and F_u [n x count]. Required. */
  int (*force)(double t, const double *q, const double *v, const double *u, double *F, double *F_q,
               double *F_v, double *F_u, void *user);
  /** bounds [count] of u, each -INFINITY or INFINITY where there is none. NULL: no bounds */
  const double *least, *most;
  void *user;
} dvi_controls;

/** Options of a control problem. All of them are copied. */
typedef struct dvi_control_options {
  int steps;                     /**< N, at least 2 */
  double start, span;            /**< the time at the start, and the time to the end, > 0 */
  int dimension;                 /**< n, the length of each of the arrays */
  const double *q0, *p0;         /**< the state at the start */
  const double *q1, *p1;         /**< the state at the end. Numbers that are free are guesses */
  const char *free_q1, *free_p1; /**< not 0 where the end's number is free. NULL: none is free */
  /** not 0 if the span is free, too. It is a guess then. For autonomous systems whose costs and
   *  forces of controls do not depend on time either */
  int free_span;
} dvi_control_options;

/** Results of a solve. */
typedef struct dvi_control_report {
  double cost; /**< the cost h sum_j b_j C_j, without the barrier of the bounds */
  double span; /**< the time from the start to the end */
  /** the log barrier's factor at the end, in units of the cost per unit of time. 0 without bounds.
   *  The barrier raises the cost by less than this factor times the span and the number of
   *  bounds */
  double barrier;
  /** Numbers of negative and of zero eigenvalues of the second derivatives of the Lagrange function
   *  (the KKT matrix). -1 if they could not be found */
  long negative, zero;
  long multipliers; /**< number of multipliers */
  /** 1 if the solution is a strict local minimum, negative = multipliers and zero = 0. 0 if it is
   *  a saddle, -1 if that is not known */
  int is_minimum;
  double gradient; /**< largest residual, as that of dvi_path_report */
  int iterations;  /**< iterations of KINSOL and Newton's method, of all barriers */
} dvi_control_report;

/** A control problem with its solution. */
typedef struct dvi_control dvi_control;

#ifdef __cplusplus
extern "C" {
#endif

/** Make a control problem. Its first guess is the straight line between the ends with multipliers
 *  0.
 *
 *  @param      system    a constant mass or a general Lagrangian in R^n, with potentials and
 *                        forces. Must outlive the problem
 *  @param      method    as for dvi_path_create
 *  @param      controls  read at creation; the data at `user` must outlive the problem
 *  @param[out] control   owned by the caller. NULL on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, a number is not finite, or a bound is not below its
 *                            other bound
 *  @retval DVI_BAD_SIZE      the number of controls, or the dimension, is out of range
 *  @retval DVI_UNSUPPORTED   the system declares other terms, or the span is free and the system
 *                            is not declared autonomous
 *  @retval (others)          as dvi_path_create */
dvi_status dvi_control_create(const dvi_system *system, const char *method,
                              const dvi_controls *controls, const dvi_control_options *options,
                              dvi_control **control);

/** Free a problem and set the pointer to NULL. NULL is allowed. */
void dvi_control_destroy(dvi_control **control);

/** Guess the motion by points q [points*n] at times t [points], joined by straight lines, with
 *  multipliers 0. Fails as dvi_path_guess. */
dvi_status dvi_control_guess(dvi_control *control, int points, int dimension, const double *t,
                             const double *q);

/** Solve from the guess, or from the last solution. With bounds the problem is solved for a falling
 *  sequence of log barriers. On failure the problem is as it was.
 *
 *  @param[out] report  may be NULL
 *  @retval DVI_NOT_CONVERGED  no stationary motion was found from the guess, or there is none. Or
 *                             the cost has no minimum in the controls on the way. Or no span
 *                             has the least cost, as where slower is always cheaper
 *  @retval DVI_SINGULAR       the solution is not isolated: the controls do not reach the end, or
 *                             many motions cost the same
 *  @retval (others)           as dvi_path_solve */
dvi_status dvi_control_solve(dvi_control *control, dvi_control_report *report);

/** Return the number of steps N. 0 before a solve. */
int dvi_control_steps(const dvi_control *control);

/** Return the time of node k, 0 <= k <= N. NaN if k is out of range, or before a solve. */
double dvi_control_time(const dvi_control *control, int k);

/** Return the coordinates [n] of node k. NULL if k is out of range, or before a solve. Owned by the
 *  problem, valid until its next call. */
const double *dvi_control_q(const dvi_control *control, int k);

/** Return the momenta [n] of node k, as dvi_control_q returns the coordinates. */
const double *dvi_control_p(const dvi_control *control, int k);

/** Give the costates [n] of node k: the derivatives by q and by p of the least cost from there to
 *  the end.
 *
 *  @retval DVI_BAD_STATE  before a solve, or k is out of range */
dvi_status dvi_control_costate(const dvi_control *control, int k, double *by_q, double *by_p);

/** Give the controls [count] at node k, which have the order of the method, too.
 *
 *  @retval DVI_BAD_STATE  before a solve, or k is out of range
 *  @retval (others)       from the callbacks */
dvi_status dvi_control_u(dvi_control *control, int k, double *u);

/** Give the time and the controls at quadrature point j of step k, where the discrete problem has
 *  them. Returns DVI_BAD_STATE before a solve, or if k or j is out of range. */
dvi_status dvi_control_point(dvi_control *control, int k, int j, double *t, double *u);

/** Return the number of quadrature points of a step. 0 for NULL. */
int dvi_control_points(const dvi_control *control);

/** Return the method's full specification. NULL for NULL. */
const char *dvi_control_method(const dvi_control *control);

#ifdef __cplusplus
}
#endif
#endif
