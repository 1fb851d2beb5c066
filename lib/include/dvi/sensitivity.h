/** Derivatives of a run with respect to its start and its parameters.
 *
 *  A run is N steps of the map (q, p) -> (q', p') of a discrete action with parameters theta. The
 *  derivatives are exact for this discrete map, beside rounding, and not approximations of those of
 *  the equations of motion. A tangent takes one more solve with the factor of a step's Jacobian. An
 *  adjoint takes one with its transpose, backward over the steps, whose states are computed again
 *  from about sqrt(N) saved ones (Griewank and Walther 2000).
 *
 *  The methods are galerkin, midpoint, trapezoidal, verlet, and hp and hamiltonian of types 1 to 3,
 *  on constant masses and general Lagrangians in R^n, with forces or without. */
#ifndef DVI_SENSITIVITY_H
#define DVI_SENSITIVITY_H
#include <dvi/integrator.h>

/** How a system depends on parameters. Values of a control on intervals of time are parameters,
 *  too. */
typedef struct dvi_dependence {
  int count; /**< number of parameters, 0 or more */
  /** The derivatives of L_q + F and of L_v by the parameters, [n*count] each. That of component i
   *  by parameter k is in_q[k*n + i], and in_v[k*n + i]. Both are 0 before the call. Required if
   *  count > 0. Returns 0 for success, else as in dvi/system.h. */
  int (*derivative)(double t, const double *q, const double *v, double *in_q, double *in_v,
                    void *user);
  void *user;
} dvi_dependence;

/** An objective, end(T, q(T), p(T)) plus the integral of rate(t, q, v) over the run by the
 *  quadrature of the method. Either function may be NULL. Derivatives are 0 before the call.
 *  by_theta is [count] of the dependence, the derivative by the parameters at fixed q, v and p. */
typedef struct dvi_objective {
  int (*end)(double t, const double *q, const double *p, double *value, double *by_q, double *by_p,
             double *by_theta, void *user);
  int (*rate)(double t, const double *q, const double *v, double *value, double *by_q, double *by_v,
              double *by_theta, void *user);
  void *user;
} dvi_objective;

/** A run of equal steps. */
typedef struct dvi_run_plan {
  double t, h;
  long steps;          /**< at least 1 */
  const double *q, *p; /**< the start [n] */
} dvi_run_plan;

/** The value of an objective and its derivatives. Arrays that are NULL are left out. */
typedef struct dvi_gradient {
  double value;
  double *by_q, *by_p; /**< [n] by the start */
  double *by_theta;    /**< [count] by the parameters, at a fixed start */
} dvi_gradient;

/** A run with derivatives. */
typedef struct dvi_sensitivity dvi_sensitivity;

#ifdef __cplusplus
extern "C" {
#endif

/** Make a run.
 *
 *  @param      system       must outlive the run
 *  @param      method       a specification (dvi/method.h), without `solver`
 *  @param      dependence   copied. NULL for no parameters
 *  @param[out] sensitivity  owned by the caller. NULL on failure
 *  @retval DVI_BAD_OPTION    the method is none of those above
 *  @retval DVI_UNSUPPORTED   the system declares other terms than those above
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, the count is negative, or derivative is missing
 *  @retval (others)          as dvi_integrator_create */
dvi_status dvi_sensitivity_create(const dvi_system *system, const char *method,
                                  const dvi_dependence *dependence, dvi_sensitivity **sensitivity);

/** Free a run and set the pointer to NULL. NULL is allowed. */
void dvi_sensitivity_destroy(dvi_sensitivity **sensitivity);

/** Start at (t, q, p), with the identity as tangents of q and p, and 0 as those of parameters.
 *  Fails as dvi_integrator_start, and leaves the run as it was then. */
dvi_status dvi_sensitivity_start(dvi_sensitivity *sensitivity, double t, const double *q,
                                 const double *p);

/** Take a step, and carry all tangents over it. Fails as dvi_integrator_step, and leaves the run as
 *  it was then. If the tangents fail, the run has to start anew.
 *  @retval DVI_BAD_STATE   before the start
 *  @retval DVI_SINGULAR    the Jacobian of the step is singular
 *  @retval DVI_NOT_FINITE, DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  from the callbacks */
dvi_status dvi_sensitivity_step(dvi_sensitivity *sensitivity, double h);

/** Return the tangents, 2n rows and 2n + count columns, by columns. Row i is q_i, row n + i is p_i.
 *  Column j is the derivative by q_j at the start, n + j that by p_j, 2n + k that by parameter k.
 *  Owned by the run. NULL before the start. */
const double *dvi_sensitivity_tangent(const dvi_sensitivity *sensitivity);

/** Return the time of the run. NaN before the start. */
double dvi_sensitivity_time(const dvi_sensitivity *sensitivity);

/** Return the coordinates [n] of the run. Owned by the run. NULL before the start. */
const double *dvi_sensitivity_q(const dvi_sensitivity *sensitivity);

/** Return the momenta [n] of the run. Owned by the run. NULL before the start. */
const double *dvi_sensitivity_p(const dvi_sensitivity *sensitivity);

/** Return the method's full specification. NULL for NULL. */
const char *dvi_sensitivity_method(const dvi_sensitivity *sensitivity);

/** Compute an objective of a whole run, and its derivatives by the adjoint. The run starts anew,
 *  and has no tangents afterwards.
 *
 *  @param[out] gradient  its arrays are the caller's
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, or h or the number of steps is out of range
 *  @retval DVI_NOT_FINITE    the objective or a derivative is not finite
 *  @retval (others)          as dvi_sensitivity_step */
dvi_status dvi_sensitivity_gradient(dvi_sensitivity *sensitivity, const dvi_run_plan *plan,
                                    const dvi_objective *objective, dvi_gradient *gradient);

#ifdef __cplusplus
}
#endif
#endif
