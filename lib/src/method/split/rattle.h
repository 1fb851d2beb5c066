/* The forces of holonomic constraints phi(t,q) = 0 in a step of Verlet's method.
 *
 * With G = d phi/dq, the multipliers lambda at the start and mu at the end of a step solve
 *
 *     p_half = p0 - h/2 (dV(q0) + G(q0)^T lambda),   q1 = q0 + h M^-1 p_half,   phi(t1,q1) = 0,
 *     p1 = p_half - h/2 dV(q1) - G(q1)^T mu,         G(q1) M^-1 p1 + phi_t(t1,q1) = 0.
 *
 * Only lambda is implicit. Simplified Newton's method for h^2 lambda/2 keeps G M^-1 G^T of the
 * start of the step, which is the matrix of mu of the step before. A step therefore factors one
 * matrix of the size of phi. With l(t) the multipliers of the motion and s a smooth function,
 * lambda = l(t0) + h s and 2 mu/h = l(t1) - h s up to h^2, so both are guessed by their differences
 * in the step before. Source: Andersen 1983 (RATTLE); Hairer, Lubich and Wanner 2006, sec.
 * VII.1.4. */
#ifndef DVI_METHOD_SPLIT_RATTLE_H
#define DVI_METHOD_SPLIT_RATTLE_H
#include "method/method.h"
#include "step/split/rattle_members.h"

typedef struct dvi__rattle dvi__rattle;

/* Differences take two numbers a row in a method's memory, that from the end of a step to the next
 * start, and that from a start to its end, both divided by h. */
enum { DVI__RATTLE_TREND = 2 };

dvi_status dvi__rattle_create(const dvi_system *system, dvi__evaluator *evaluator,
                              dvi_counters *counters, dvi__rattle **rattle);
void dvi__rattle_destroy(dvi__rattle **rattle);

/* Tell whether the mass is positive, and on the diagonal, and give the matrix of independent
 * rows. */
int dvi__rattle_has_matrix(const dvi__rattle *rattle, dvi__rattle_matrix *matrix);

/* Add - h/2 G^T lambda to the momentum of a state at (t0, q0), after its first kick. lambda [rows]
 * are the last multipliers, trend [DVI__RATTLE_TREND rows] is NULL if steps do not follow each
 * other smoothly. DVI_NOT_CONVERGED, DVI_SINGULAR, DVI_NOT_FINITE, and those of callbacks. */
dvi_status dvi__rattle_begin(dvi__rattle *rattle, dvi__state *state, double h, double *lambda,
                             double *trend);

/* Subtract G^T mu from the momentum of a state at (t1, q1), after its last kick. */
dvi_status dvi__rattle_end(dvi__rattle *rattle, dvi__state *state, double h, double *lambda,
                           double *trend);

/* Do the same to a momentum that another move has changed. */
dvi_status dvi__rattle_project(dvi__rattle *rattle, dvi__state *state);

#endif
