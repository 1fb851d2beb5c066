/* What tests of methods for degenerate Lagrangians share. */
#ifndef SUPPORT_DEGENERATE_H
#define SUPPORT_DEGENERATE_H
#include "support/runs.h"

/* The errors at the end of the span of an order study, for four steps from h on, shrink with the
 * order that the method claims, which is `expected`. Errors at the floor of roundoff are not
 * fitted. The reference is the problem's digits, which do not depend on the gauge. */
void check_degenerate_order(const char *name, const char *setting, const char *method, double h,
                            int expected);

/* Largest |p - alpha(q)|. */
double off_constraint(const problem *of, const dvi_integrator *integrator);

/* Over many steps the energy's error stays below the bound (relative), no larger in the second half
 * than in the first, and the momenta of symmetries change by no more than `momentum`. */
void check_long_run(const char *name, const char *setting, const char *method, double h, long steps,
                    double bound, double momentum);

/* Relative change over `steps` of the loop integral of p dq, from a loop of 128 starts about the
 * problem's in its first two coordinates. */
double change_of_loop(const char *name, const char *setting, const char *method, double h,
                      long steps);

/* The Henon-Heiles system twice: of two freedoms with the regular Lagrangian, and of four
 * coordinates (y, x) with alpha = (0, y) and H = y^2/2 + V(x). */
typedef struct twins {
  problem *regular;
  dvi_system *degenerate;
} twins;
twins made_twins(void);
void destroy_twins(twins *both);

/* Steps of both from the same state end at the same state up to roundoff. */
void check_same_as_regular(const char *degenerate, const char *regular);

/* The same with p1 = p0 - h V'(x), x1 = x0 + h p, the momentum first or the position. */
void check_symplectic_euler(const char *degenerate, int momentum_first);

/* A method for one-forms that are constant in half of their components has this order where the
 * other half depends on all coordinates, and refuses the rest. */
void check_one_step(const char *method, int order);

/* The method refuses one-forms outside of its class, in words that name the gauge, or that there is
 * none, or that the two-form is singular. */
void check_class(const char *method);

#endif
