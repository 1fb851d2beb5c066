/* The flow phi_tau of an integrable part H0 of a system, at batches of points, and its transposed
 * derivatives.
 *
 * The kinds are
 *     drift     H0 = p.M^-1 p/2, without a fast potential,
 *     rotation  H0 = p.M^-1 p/2 + fast potentials, all quadratic (step/split/modes.h),
 *     kepler    H0 = sum of |p_a|^2/(2 m_a) - k_a/|q_a| over bodies a in a plane or in space, where
 *               the fast potentials are found to have this form (step/split/orbit.h),
 *     declared  that of a program (dvi/shapes.h).
 * Batches are component-major. */
#ifndef DVI_STEP_SPLIT_INTEGRABLE_H
#define DVI_STEP_SPLIT_INTEGRABLE_H
#include <dvi/shapes.h>

#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__integrable dvi__integrable;

/* A batch of points. */
typedef struct dvi__points {
  int count;
  const double *tau;   /* [count] */
  const double *q, *p; /* [n*count] */
} dvi__points;

/* Create the flow of a system with a constant mass, for batches of up to `capacity` points. `flow`
 * is declared by a program, or NULL. System and flow must outlive the result. DVI_UNSUPPORTED if
 * no flow of the fast potentials is known. */
dvi_status dvi__integrable_create(const dvi_system *system, const dvi_flow *flow, int capacity,
                                  dvi_counters *counters, dvi__integrable **integrable);
void dvi__integrable_destroy(dvi__integrable **integrable);

/* Describe the flow in some words. */
const char *dvi__integrable_words(const dvi__integrable *integrable);

/* Forget earlier batches. Until the next call, points with the same place in batches of one size
 * are taken for near ones. */
void dvi__integrable_begin(dvi__integrable *integrable);

/* Compute phi_tau [n*count]. to_p may be NULL. */
dvi_status dvi__integrable_move(dvi__integrable *integrable, const dvi__points *points,
                                double *to_q, double *to_p);

/* Move a state by phi_tau, with compensated sums. */
dvi_status dvi__integrable_advance(dvi__integrable *integrable, double tau,
                                   const dvi__phase *phase);

/* Compute D phi_tau^T (lambda_q, lambda_p) [n*count] at the points of the last move. lambda_p is
 * NULL if the rest is a function of q, else the flow is a declared one. */
dvi_status dvi__integrable_pullback(dvi__integrable *integrable, const dvi__points *points,
                                    const double *lambda_q, const double *lambda_p, double *by_q,
                                    double *by_p);

#endif
