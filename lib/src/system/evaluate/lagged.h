/* Forces of a fixed-point iteration in which slow potentials lag behind the fast ones.
 *
 * An iteration on the places x = Phi(x) whose forces are those of potentials declared fast and of
 * slow ones contracts by the sum of two parts, |x' - x*| <= c |x - x*| + g |y - x*|, with the slow
 * forces evaluated at earlier places y. Where g is far below c, the fast forces may be iterated
 * alone for a while. The slow forces are evaluated anew before their error would show in the change
 * after the next one, g |x - y| >= c^2 |change|. Both factors are measured, c by two changes, and g
 * where the slow forces are evaluated for the second time in a step. Until then those of the last
 * step serve.
 *
 * The fixed point is that of all forces. The next iteration by all forces changes the places by
 * c |change| + g |x - y|. Where the second part is the larger one, it is tested as a change by the
 * fast forces would be. */
#ifndef DVI_SYSTEM_EVALUATE_LAGGED_H
#define DVI_SYSTEM_EVALUATE_LAGGED_H
#include "system/evaluate/evaluator.h"

/* Number of factors that are kept from step to step. */
enum { DVI__LAG_FACTORS = 2 };

/* Lanes of `capacity` problems side by side, [width] in use. */
typedef struct dvi__lagged dvi__lagged;

/* Tell whether a system has fast potentials and others, and no other forces. */
int dvi__can_lag(const dvi_system *system);

/* Create room for so many problems of `nodes` points each. DVI_NO_MEMORY. */
dvi_status dvi__lagged_create(const dvi_system *system, int nodes, int capacity,
                              dvi__lagged **lagged);
void dvi__lagged_destroy(dvi__lagged **lagged);

/* Begin an iteration for `width` problems. Factors [DVI__LAG_FACTORS*width] are those of the last
 * step, whose length was h/ratio. NULL stands for none. */
void dvi__lagged_begin(dvi__lagged *lagged, int width, double ratio, const double *factors);

/* Evaluate the slow forces in the next iteration. */
void dvi__lagged_renew(dvi__lagged *lagged);

/* How forces move the places of the iteration, factor_i sum_j matrix_j weight_j V_q_ij. */
typedef struct dvi__place_table {
  int lanes;
  const double *matrix; /* [nodes*lanes] by columns */
  const double *weight; /* [nodes] */
  const double *factor; /* [n] */
} dvi__place_table;

/* Compute V_q at the nodes of all problems, whose points stand side by side at each node. t
 * [nodes*width], q and V_q [n*nodes*width]. Fast potentials count as gradients. */
dvi_status dvi__lagged_gradient(dvi__lagged *lagged, dvi__evaluator *evaluator, const double *t,
                                const double *q, const dvi__place_table *table, double *V_q);

/* Replace the change [width] of each problem by that which is to be tested, where `largest` [width]
 * is the size of the places. */
void dvi__lagged_change(dvi__lagged *lagged, const double *largest, double *change);

/* Go on with these problems, [width]. */
void dvi__lagged_close_up(dvi__lagged *lagged, int width, const int *going);

/* Give the factors of a problem, `stride` numbers apart. */
void dvi__lagged_factors(const dvi__lagged *lagged, int lane, size_t stride, double *factors);

#endif
