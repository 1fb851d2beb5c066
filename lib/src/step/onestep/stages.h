/* The stages of an implicit one-step method, which know of each other: W_j = h f(Z_j), Z_j = z +
 * sum_k a_jk W_k, one dense system of 2 n s unknowns. */
#ifndef DVI_ACTION_STAGES_H
#define DVI_ACTION_STAGES_H
#include "step/onestep/vector_field.h"
#include "step/onestep/runge_kutta.h"

typedef struct dvi__stages dvi__stages;

/* field and method must outlive it. */
dvi_status dvi__stages_create(dvi__vector_field *field, int n, const dvi__runge_kutta *method,
                              dvi_counters *counters, dvi__stages **stages);
void dvi__stages_destroy(dvi__stages **stages);

/* unit [n], which must stay as it is: the momentum that stands beside a coordinate of size 1 in
 * norms. */
void dvi__stages_unit(dvi__stages *stages, const double *unit);

/* Solve from z [2n] with t and h; W [2n*s]. The stages are points `first` and on of the field. */
dvi_status dvi__stages_solve(dvi__stages *stages, int first, double t, double h, const double *z,
                             double *W);

/* With the second derivatives at points `first` and on: the x_j with x_j - sum_k a_kj h f_z(Z_k)^T
 * x_k = y_j, x and y [2n*s]. */
dvi_status dvi__stages_solve_transposed(dvi__stages *stages, int first, double h, double *x);

/* The same with x_j - h f_z(Z_j) sum_k a_jk x_k = y_j, in two parts. */
dvi_status dvi__stages_factor(dvi__stages *stages, int first, double h);
void dvi__stages_apply(dvi__stages *stages, double *x);

#endif
