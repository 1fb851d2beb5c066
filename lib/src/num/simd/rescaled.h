/* Iterations of the step of a time-transformed system (step/element/transformed.c), with the stages
 * as lanes (lanes.h). */
#ifndef DVI_NUM_SIMD_RESCALED_H
#define DVI_NUM_SIMD_RESCALED_H
#include <stddef.h>

/* Sums of an iteration, from what was evaluated at the stages with the offsets Z,
 *
 *     energy_j = sum_i P_ij^2/(2 m_i) + V_j,   f_ij = -weight_j (g_j V_q_ij + energy_j g_q_ij),
 *     P_i = p0_i + sum_j momentum_j f_ij,
 *     rate_j = weight_j (g_j + sum_i g_q_ij (next_ij - Z_ij)),   u_ij = rate_j P_ij/m_i,
 *     next_i = sum_j place_j u_ij,
 *
 * `sweeps` times one after the other. Then next replaces Z, and Q_ij = origin_i + Z_ij. What was
 * evaluated has rows of `stages`, and room for `lanes` numbers in the last one. */
typedef struct dvi__rescaled_sums {
  int n, stages, lanes, sweeps;
  const double *place, *momentum;           /* [stages*lanes], column j at j*lanes */
  const double *weight;                     /* [lanes] */
  const double *inverse_mass, *p0, *origin; /* [n] */
  const double *g, *V, *g_q, *V_q;          /* [stages] and [n*stages] */
  double *P, *Z, *next;                     /* [n*lanes] */
  double *u, *f, *Q;                        /* [n*stages] */
  double *rate;                             /* [lanes] */
  double change, largest; /* results: largest |next - Z| and |next|, NaN if there is one */
} dvi__rescaled_sums;

void dvi__rescaled_iterate(dvi__rescaled_sums *sums);

/* Make P, Z and Q from u and f. */
void dvi__rescaled_begin(const dvi__rescaled_sums *sums);

/* Compute x_k^(-3/4), the square of a distance to the power of its monitor. */
void dvi__rescaled_distances(size_t count, const double *x, double *power);

#endif
