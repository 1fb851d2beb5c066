/* The turn of velocities by the field of a vector potential (Boris 1970; Hairer and Lubich 2018,
 * eq. 2.2). By half a step's field before and after,
 *
 *     M (v+ - v-) = h/2 B (v+ + v-),     B_ij = dA_j/dq_i - dA_i/dq_j,
 *
 * so that the increment d = v+ - v- has (M - h/2 B) d = h B v-. B is skew, so v+.Mv+ = v-.Mv-, and
 * with a definite mass the matrix is regular for every h. Where mass and field couple the
 * coordinates in groups of at most three, as those of particles in space, the solution is by
 * cofactors. Else it is by factors of the sparse matrix. */
#ifndef DVI_STEP_SPLIT_GYRATION_H
#define DVI_STEP_SPLIT_GYRATION_H
#include "system/system.h"

typedef struct dvi__gyration dvi__gyration;

/* Create for a system with a constant mass and a vector potential. */
dvi_status dvi__gyration_create(const dvi_system *system, dvi_counters *counters,
                                dvi__gyration **gyration);
void dvi__gyration_destroy(dvi__gyration **gyration);

/* Give the number of groups of at most three coordinates, or 0 if the matrix is factored. */
int dvi__gyration_groups(const dvi__gyration *gyration);

/* Compute y [n*count] = factor B w of a batch, from the gradients A_q [entries*count] of A. */
void dvi__gyration_times(const dvi__gyration *gyration, int count, double factor, const double *A_q,
                         const double *w, double *y);

/* Replace d [n*count] by (M - h/2 B)^-1 d. DVI_SINGULAR with an indefinite mass. */
dvi_status dvi__gyration_solve(dvi__gyration *gyration, int count, double h, const double *A_q,
                               double *d);

#endif
