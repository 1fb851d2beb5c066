/* The stages of an implicit one-step method are coupled. W_j = h f(Z_j) with Z_j = z + sum_k a_jk
 * W_k is one dense system of 2 n s unknowns. */
#ifndef DVI_STEP_ONESTEP_STAGES_H
#define DVI_STEP_ONESTEP_STAGES_H
#include "step/onestep/vector_field.h"
#include "step/onestep/runge_kutta.h"

typedef struct dvi__stages dvi__stages;

/* Create the system of the stages. field and method must outlive it. */
dvi_status dvi__stages_create(dvi__vector_field *field, int n, const dvi__runge_kutta *method,
                              dvi_counters *counters, dvi__stages **stages);
void dvi__stages_destroy(dvi__stages **stages);

/* Set unit [n], the momentum of the same size as a coordinate of size 1 in norms. The caller keeps
 * the array unchanged. */
void dvi__stages_unit(dvi__stages *stages, const double *unit);

/* Solve for W [2n*s] from z [2n] with t and h. The stages are points `first` and on of the
 * field. */
dvi_status dvi__stages_solve(dvi__stages *stages, int first, double t, double h, const double *z,
                             double *W);

/* Solve x_j - sum_k a_kj h f_z(Z_k)^T x_k = y_j with x and y [2n*s], in place, with the second
 * derivatives at points `first` and on. */
dvi_status dvi__stages_solve_transposed(dvi__stages *stages, int first, double h, double *x);

/* Solve x_j - h f_z(Z_j) sum_k a_jk x_k = y_j in the same way. The first function factors the
 * matrix, the second one solves. */
dvi_status dvi__stages_factor(dvi__stages *stages, int first, double h);
void dvi__stages_apply(dvi__stages *stages, double *x);

#endif
