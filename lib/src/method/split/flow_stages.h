/* The stages of a step along the flow phi of an integrable part H0 of H = H0 + H1.
 *
 * With tau_j = h (c_j - 1/2) and the rest K(t,w) = H1(t,phi_tau(w)) at Gauss's nodes,
 *
 *     W_i = w0 + sum_j A_ij G_j,      G_j = h b_j J D phi_{tau_j}(W_j)^T grad H1(phi_{tau_j}(W_j)),
 *
 * where A_ij = a_ij/b_j = 1/2 + S_ij with a skew S, and w1 = w0 + sum_j G_j. The map from w0 to w1
 * is symplectic to the last bit of S, however h b_j is rounded, because A_ij + A_ji = 1 (Hairer,
 * Lubich and Wanner 2006, sec. VI.4). The stages are found by fixed-point iteration, which
 * contracts with the size of H1. */
#ifndef DVI_METHOD_SPLIT_FLOW_STAGES_H
#define DVI_METHOD_SPLIT_FLOW_STAGES_H
#include "step/split/integrable.h"

typedef struct dvi__flow_stages dvi__flow_stages;

/* Create for a system with a constant mass. `flow` is declared by a program, or NULL. */
dvi_status dvi__flow_stages_create(const dvi_system *system, const dvi_flow *flow, int stages,
                                   dvi_counters *counters, dvi__flow_stages **made);
void dvi__flow_stages_destroy(dvi__flow_stages **stages);

/* The flow, which moves states from and to the middle of a step. */
dvi__integrable *dvi__flow_stages_flow(const dvi__flow_stages *stages);

/* Return how many numbers dvi__flow_stages_keep writes. */
size_t dvi__flow_stages_kept(const dvi__flow_stages *stages);

/* Find the stages of a step of length h from t, with the start q0 and p0 [n] of w. `kept` has what
 * the last step left, or zeros. DVI_NOT_CONVERGED if H1 is too large for the iteration. */
dvi_status dvi__flow_stages_solve(dvi__flow_stages *stages, double t, double h, const double *q0,
                                  const double *p0, const double *kept);

/* Give w1 - w0, dq and dp [n], of the solved step. */
void dvi__flow_stages_ends(const dvi__flow_stages *stages, double *dq, double *dp);

/* Keep the forces grad H1, from which the next step guesses its own, and the path w. */
void dvi__flow_stages_keep(const dvi__flow_stages *stages, double *kept);

/* Evaluate the path at the part x of a kept step: q and p [n]. */
dvi_status dvi__flow_stages_path(dvi__flow_stages *stages, const double *kept, double x, double *q,
                                 double *p);

#endif
