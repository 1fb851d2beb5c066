/* labels: invariant slow long */
/* A million steps on groups, which are never projected back: momenta, energy, and the distance from
 * the group. */
#include <dvi/diagnostics.h>
#include <math.h>
#include <string.h>

#include "support/systems/bodies.h"
#include "support/runs.h"
#include "support/suite.h"

enum { SAMPLING = 10 };

/* The fit takes samples for independent. The last motion is chaotic, and its energy wanders over
 * many samples, so that the significance of no drift is 0.8 to 6, by roundings alone. That of a
 * drift as large as the energy's error is about 100. */
static const struct {
  body_kind kind;
  const char *method;
  double h, significance;
} runs[] = {{PENDULUM_3D, "lie-galerkin:degree=2", 0.05, 3},
            {FREE_BODY, "euler-poincare:degree=2", 0.2, 3},
            {DIRECTIONS, "sphere-galerkin:degree=2", 0.005, 10}};

/* Over 1e6 steps the roundings of the impulses leave 1e3 ulp in the momentum, and no trend. The
 * distance is that of the last rounding. */
START_TEST(a_million_steps_keep_what_they_should)
{
  body model;
  double first[2], now[2], far = 0, momentum = 0;
  dvi_drift drift;
  dvi_drift_fit energy;
  make_body(runs[_i].kind, &model);
  dvi_integrator *made = body_integrator(&model, runs[_i].method);
  ck_assert_int_eq(dvi_integrator_invariants(made, first), DVI_OK);
  dvi_drift_init(&drift);
  for (long n = 0; n < repeats(1000000); n += SAMPLING) {
    advance(made, runs[_i].h, SAMPLING);
    ck_assert_int_eq(dvi_integrator_invariants(made, now), DVI_OK);
    dvi_drift_add(&drift, dvi_integrator_time(made), now[0]);
    momentum = fmax(momentum, fabs(now[1] - first[1]));
    far = fmax(far, dvi_system_distance(model.system, dvi_integrator_q(made)));
  }
  dvi_drift_result(&drift, &energy);
  ck_assert_msg(energy.significance < runs[_i].significance,
                "%s: energy %.1e, drift %.1e, significance %.1f", model.name, energy.largest,
                energy.change, energy.significance);
  ck_assert_msg(momentum < 1e-12 * fmax(1, fabs(first[1])), "%s: momentum %.1e", model.name,
                momentum);
  ck_assert_msg(far < 1e-15, "%s: distance %.1e", model.name, far);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

SUITE(lie_galerkin_long)
{
  tcase_set_timeout(tests, 600);
  tcase_add_loop_test(tests, a_million_steps_keep_what_they_should, 0, sizeof runs / sizeof *runs);
}
