/* Holonomic constraints phi(t,q) = 0, and nonholonomic ones A v + a = 0, beside a mass or a general
 * Lagrangian.
 *
 *     d/dt L_v = L_q + F - G^T lambda,   phi(t,q) = 0,   G v + g = 0.
 *
 * The rows of G and g are d phi/dq and d phi/dt, followed by A and a. Functions of all rows of an
 * evaluator's system at one point. */
#ifndef DVI_SYSTEM_DYNAMICS_HOLONOMIC_H
#define DVI_SYSTEM_DYNAMICS_HOLONOMIC_H
#include "system/evaluate/evaluator.h"

/* Compute phi [m], which is 0 for nonholonomic constraints, G in the order of the system's rows_q,
 * g [m], and the Hessian of phi.w in the order of rows_qq. */
dvi_status dvi__rows_value(dvi__evaluator *e, double t, const double *q, double *phi);
dvi_status dvi__rows_gradients(dvi__evaluator *e, double t, const double *q, double *phi_q);
dvi_status dvi__rows_rate(dvi__evaluator *e, double t, const double *q, double *phi_t);
dvi_status dvi__rows_hessian(dvi__evaluator *e, double t, const double *q, const double *w,
                             double *phi_w_qq);

/* Tell whether all rows are holonomic, and their callbacks take batches. */
int dvi__rows_have_batches(const dvi_system *system);

/* Compute phi [m*count] and the gradients [entries*count] of holonomic constraints alone, at up to
 * DVI_HOLONOMIC_POINTS points. */
dvi_status dvi__rows_values(dvi__evaluator *e, int count, const double *t, const double *q,
                            double *phi);
dvi_status dvi__rows_all_gradients(dvi__evaluator *e, int count, const double *t, const double *q,
                                   double *phi_q);

/* Compute d(A v + a)/dq of the nonholonomic constraints, one after the other, in the order of their
 * by_q. */
dvi_status dvi__rows_derivatives(dvi__evaluator *e, double t, const double *q, const double *v,
                                 double *Av_q);

/* Estimate the roundings of phi [m] near a point. 0 stands for a row in which none are seen. */
void dvi__rows_noise(dvi__evaluator *e, double t, const double *q, double *noise);

/* Take the matrices of an evaluator for dependent rows, or for independent ones. The Jacobian of a
 * step has -DVI__SOFTNESS times the size of its Schur complement on the diagonal of the rows and
 * their multipliers. The residuals stay exact, and multipliers that have no effect stay small. */
#define DVI__SOFTNESS 1e-7
void dvi__rows_soften(dvi__evaluator *e, int dependent);

/* Return DVI_SINGULAR, with the name of a row, if the rank of the rows drops between two places
 * that one step connects. With G0 and G1 there, det(G1 M^-1 G0^T) is negative, then. */
dvi_status dvi__rows_stay_regular(dvi__evaluator *e, const double t[2], const double *const q[2],
                                  const double *v);

/* Say which rows depend on others at the last start, in words. 0 if there are none. */
int dvi__rows_dependent(const dvi__evaluator *e, char *words, size_t size);

/* Choose independent rows. keep [m] becomes 0 for those that depend on others. */
void dvi__rows_choose(const dvi__evaluator *e, char *keep);

/* Add factor G^T w to x [n]. */
void dvi__rows_pull(const dvi_system *system, const double *phi_q, const double *w, double factor,
                    double *x);

/* Move p [n] along the gradients until the velocity fulfils the constraints, G v + g = 0.
 * *v [n] is a guess for general Lagrangians, and becomes the velocity. */
dvi_status dvi__rows_project_momentum(dvi__evaluator *e, double t, const double *q, double *p,
                                      double *v);

/* Compute the acceleration a [n] and the multipliers lambda [m] of a state whose velocity is v. */
dvi_status dvi__rows_acceleration(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *a, double *lambda);

#endif
