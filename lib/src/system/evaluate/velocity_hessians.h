/* Velocity Hessians of general Lagrangians at batches of points, those of several paths. */
#ifndef DVI_SYSTEM_EVALUATE_VELOCITY_HESSIANS_H
#define DVI_SYSTEM_EVALUATE_VELOCITY_HESSIANS_H
#include "system/evaluate/evaluator.h"

/* Compute L_qq, L_qv, L_vv [entries*count] in the order of the Lagrangian's own patterns, of which
 * the last are those of dvi__velocity_hessian. Nothing is counted. */
dvi_status dvi__velocity_hessians(dvi__evaluator *e, int count, const double *t, const double *q,
                                  const double *v, double *L_qq, double *L_qv, double *L_vv);

/* Tell whether the system has a general Lagrangian with a gradient and a Hessian, and admits all
 * points. Then the functions above take no differences. */
int dvi__system_has_smooth_lagrangian(const dvi_system *system);

#endif
