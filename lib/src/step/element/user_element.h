/* One element of the discrete action (action.h) in a space of given shapes (space/shapes.h), as a
 * step: the same rows, from other tables.
 *
 * A coordinate may have the first functions alone, as slow ones have the polynomials: the unknowns
 * are those of its own functions, coordinate by coordinate. Unknowns of functions that are not
 * present at this h stay 0: their rows say so. */
#ifndef DVI_ACTION_SHAPED_H
#define DVI_ACTION_SHAPED_H
#include "step/element/action.h"
#include "space/shapes.h"

typedef struct dvi__user_element dvi__user_element;

/* has_all [n]: which coordinates have all shapes; the others have the first `fewest`. Shapes are
 * copied. */
dvi_status dvi__user_element_create(const dvi_system *system, const dvi__shapes *shapes,
                                    const char *has_all, int fewest, dvi_counters *counters,
                                    dvi__user_element **shaped);
void dvi__user_element_destroy(dvi__user_element **shaped);

const dvi__pattern *dvi__user_element_pattern(const dvi__user_element *shaped);
dvi__evaluator *dvi__user_element_evaluator(const dvi__user_element *shaped);

/* As dvi__action_place. */
void dvi__user_element_place(dvi__user_element *shaped, double t0, double h, const double *q0,
                             const double *p0);

/* The shapes have changed: ask them anew at the next place. */
void dvi__user_element_renew(dvi__user_element *shaped);

/* What a step asks for (method/one_step.h). */
dvi_status dvi__user_element_residual(dvi__user_element *shaped, const double *Y, double *R);
dvi_status dvi__user_element_jacobian(dvi__user_element *shaped, const double *Y, double *values);
dvi_status dvi__user_element_scale(dvi__user_element *shaped, double *scale);
void dvi__user_element_straight(const dvi__user_element *shaped, const double *v, double *Y);
void dvi__user_element_continue(dvi__user_element *shaped, double ratio, const double *last,
                                double *Y);

/* As dvi__action_ends, dvi__action_duration and dvi__action_path. The ends come first: the last
 * residual and the last Jacobian were asked for near Y: what is left to it counts to first order.
 * Once. */
void dvi__user_element_ends(dvi__user_element *shaped, const double *Y, double *dq, double *dp);
dvi_status dvi__user_element_duration(dvi__user_element *shaped, const double *Y, double *duration);
void dvi__user_element_path(dvi__user_element *shaped, const double *Y, double h, double tau,
                            double *offset, double *v);

#endif
