/* The forces of noise functions in one step of length h,
 *
 *     F_k = -h_k'(q) DeltaW_k/h,     DeltaW_k = W_k(t1) - W_k(t0).
 *
 * The action of a step then has - sum_k DeltaW_k sum_i b_i h_k(Q_i), the quadrature of
 * - sum_k int h_k(q) o dW_k. The map is symplectic on each path of W. Functions of q alone commute,
 * so the strong order is 1. Source: Bou-Rabee and Owhadi 2009, eq. 1.5. */
#ifndef DVI_METHOD_SPLIT_SHAKING_H
#define DVI_METHOD_SPLIT_SHAKING_H
#include "method/method.h"

typedef struct dvi__shaking dvi__shaking;

dvi_status dvi__shaking_create(const dvi_system *system, dvi__shaking **shaking);
void dvi__shaking_destroy(dvi__shaking **shaking);

/* Give the forces [noise.function_count], which read what is drawn. */
const dvi_force *dvi__shaking_forces(const dvi__shaking *shaking);

/* Draw the increments of a step of length h in equal parts from the numbers that follow those in
 * the memory of the bath, which stays as it is. */
void dvi__shaking_draw(dvi__shaking *shaking, double h, int parts, const double *memory);

#endif
