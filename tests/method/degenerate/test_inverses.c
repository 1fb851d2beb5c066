/* labels: invariant */
/* Steps of one-forms invert their Jacobian near that of the two-form, in place of a factor. */
#include "support/systems/degenerate.h"
#include "support/suite.h"

static const struct {
  const char *problem, *setting, *method;
  double h;
  int own; /* factors of another kind, which the method prepares */
} usual[] = {
    {"massless-particle", "gauge=singular", "vprk:nodes=4", 0.4, 0},
    {"massless-particle", NULL, "vprk:nodes=6", 0.4, 0},
    {"lotka-volterra", NULL, "vprk:nodes=3,projection=post", 0.2, 0},
    {"lotka-volterra", NULL, "vprk:nodes=3,projection=midpoint", 0.2, 0},
    {"lotka-volterra-4d", NULL, "vprk:nodes=4,projection=symplectic", 0.1, 0},
    {"vortices", NULL, "vprk:nodes=5", 0.05, 0},
    {"vortices", NULL, "vprk:nodes=5,projection=none", 0.05, 0},
    {"tokamak", NULL, "vprk:nodes=3,tableau=lobatto-iiie", 800, 0},
    {"massless-particle", "gauge=singular", "dg:stiffness=1,degree=3", 0.4, 1},
    {"lotka-volterra", NULL, "dg:degree=2", 0.1, 0},
    {"lotka-volterra", NULL, "dg:degree=0", 0.01, 0},
    {"lotka-volterra", "gauge=symmetric", "dg:degree=2,flux=path,points=3", 0.1, 0},
    {"vortices", NULL, "dg:stiffness=1,degree=4,nodes=6", 0.05, 1},
};
enum { USUAL = sizeof usual / sizeof *usual };

/* Preparations are those of factors, of which dg with a stiffness has that of the two-form. With an
 * inverse of other equations Newton's method would take many more residuals, or more Jacobians. */
START_TEST(usual_steps_prepare_no_factor_and_converge_as_fast)
{
  enum { STEPS = 20 };
  problem *model = create_problem(usual[_i].problem, usual[_i].setting);
  dvi_integrator *integrator = start_integrator(model, usual[_i].method);
  dvi_counters before, after;
  dvi_integrator_counters(integrator, &before);
  advance(integrator, usual[_i].h, STEPS);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.preparations, before.preparations + usual[_i].own);
  ck_assert_int_le(after.jacobians - before.jacobians, 2 * STEPS + STEPS / 2);
  ck_assert_int_le(after.residuals - before.residuals, 6 * STEPS);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The Jacobian of so long a step is far from that of the two-form. */
START_TEST(a_long_step_falls_back_on_a_factor)
{
  problem *model = create_problem("vortices", NULL);
  dvi_integrator *integrator = start_integrator(model, "vprk:nodes=4");
  dvi_counters before, after;
  dvi_integrator_counters(integrator, &before);
  (void)dvi_integrator_step(integrator, 1);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_gt(after.preparations, before.preparations);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(inverses)
{
  tcase_add_loop_test(tests, usual_steps_prepare_no_factor_and_converge_as_fast, 0, USUAL);
  tcase_add_test(tests, a_long_step_falls_back_on_a_factor);
}
