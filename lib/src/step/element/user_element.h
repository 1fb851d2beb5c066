/* One element of the discrete action (action.h) in a space of the user's functions
 * (space/shapes.h), as a step. The rows are the same, from other tables.
 *
 * A coordinate may have the first functions alone, as slow ones have the polynomials. The unknowns
 * are those of its own functions, coordinate by coordinate. Unknowns of functions that are not
 * present at this h stay 0, by rows of their own. */
#ifndef DVI_STEP_ELEMENT_USER_ELEMENT_H
#define DVI_STEP_ELEMENT_USER_ELEMENT_H
#include "step/element/action.h"
#include "space/shapes.h"

typedef struct dvi__user_element dvi__user_element;

/* Create an element. has_all [n] marks the coordinates that have all functions. The others have the
 * first `fewest`. Shapes are copied. */
dvi_status dvi__user_element_create(const dvi_system *system, const dvi__shapes *shapes,
                                    const char *has_all, int fewest, dvi_counters *counters,
                                    dvi__user_element **element);
void dvi__user_element_destroy(dvi__user_element **element);

const dvi__pattern *dvi__user_element_pattern(const dvi__user_element *element);
dvi__evaluator *dvi__user_element_evaluator(const dvi__user_element *element);

/* Place the element as dvi__action_place. */
void dvi__user_element_place(dvi__user_element *element, double t0, double h, const double *q0,
                             const double *p0);

/* Evaluate the shapes anew at the next place, because they have changed. */
void dvi__user_element_renew(dvi__user_element *element);

/* Functions of a step (method/one_step.h). */
dvi_status dvi__user_element_residual(dvi__user_element *element, const double *Y, double *R);
dvi_status dvi__user_element_jacobian(dvi__user_element *element, const double *Y, double *values);
dvi_status dvi__user_element_scale(dvi__user_element *element, double *scale);
void dvi__user_element_straight(const dvi__user_element *element, const double *v, double *Y);
void dvi__user_element_continue(dvi__user_element *element, double ratio, const double *last,
                                double *Y);

/* Give ends, duration and path as dvi__action_ends, dvi__action_duration and dvi__action_path. The
 * ends come first, and once. The last residual and the last Jacobian were evaluated near Y, and the
 * remaining difference counts to first order. */
void dvi__user_element_ends(dvi__user_element *element, const double *Y, double *dq, double *dp);
dvi_status dvi__user_element_duration(dvi__user_element *element, const double *Y,
                                      double *duration);
void dvi__user_element_path(dvi__user_element *element, const double *Y, double h, double tau,
                            double *offset, double *v);

#endif
