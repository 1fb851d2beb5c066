/* Checks and systems that tests of methods for degenerate Lagrangians share. */
#ifndef SUPPORT_DEGENERATE_H
#define SUPPORT_DEGENERATE_H
#include "support/runs.h"

/* Requires that the method claims the expected order, and that the errors at the end of the span of
 * an order study shrink with it for the steps h, h/2, h/4, h/8. Errors at the floor of roundoff are
 * not fitted. The reference are the problem's digits, which do not depend on the gauge. */
void check_degenerate_order(const char *name, const char *setting, const char *method, double h,
                            int expected);

/* Gives the largest |p - alpha(q)|. */
double constraint_defect(const problem *model, const dvi_integrator *integrator);

/* Requires that over many steps the relative error of the energy stays below the bound, and does
 * not grow in the second half, and that momenta of symmetries change by at most `momentum`. */
void check_long_run(const char *name, const char *setting, const char *method, double h, long steps,
                    double bound, double momentum);

/* Gives the relative change over `steps` of the loop integral of p dq. The loop has 128 starts
 * around the problem's start in its first two coordinates. */
double loop_integral_change(const char *name, const char *setting, const char *method, double h,
                            long steps);

/* The Henon-Heiles system twice: with the regular Lagrangian of two coordinates, and with four
 * coordinates (y, x), alpha = (0, y) and H = y^2/2 + V(x). */
typedef struct twins {
  problem *regular;
  dvi_system *degenerate;
} twins;
twins create_twins(void);
void destroy_twins(twins *both);

/* Requires that a step of both from the same state ends at the same state up to roundoff. */
void check_same_as_regular(const char *degenerate, const char *regular);

/* Requires the step p1 = p0 - h V'(x), x1 = x0 + h p, with the momentum or the position first. */
void check_symplectic_euler(const char *degenerate, int momentum_first);

/* Requires the order of a method for one-forms with constant components in one half, where the
 * other half depends on all coordinates, and requires that it refuses all other one-forms. */
void check_one_step(const char *method, int order);

/* Requires that the method refuses one-forms outside of its class, in words that name the gauge, or
 * say that there is none, or that the two-form is singular. */
void check_refused_one_forms(const char *method);

#endif
