#include "support/field/journeys.h"

#include <math.h>

#include "support/suite.h"

void depart(const dvi_moving_terms *terms, dvi_moving_wave *wave, void *user, const char *method,
            journey *j)
{
  *j = (journey){0};
  ck_assert_msg(!dvi_moving_create(terms, &j->moving), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_start(j->moving, wave, user, j->q, j->v, j->p), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_system(j->moving, &j->system), "%s", dvi_last_error());
  ck_assert_msg(!dvi_integrator_create(j->system, method, &j->integrator), "%s", dvi_last_error());
  ck_assert_msg(!dvi_integrator_start(j->integrator, 0, j->q, j->p), "%s", dvi_last_error());
  ck_assert(!dvi_integrator_invariants(j->integrator, j->first));
}

void travel(journey *j, int steps, double dt)
{
  for (int k = 0; k < steps; k++) {
    ck_assert_msg(!dvi_integrator_step(j->integrator, dt), "%s", dvi_last_error());
    double now[4];
    ck_assert(!dvi_integrator_invariants(j->integrator, now));
    for (int i = 0; i < dvi_system_invariant_count(j->system); i++)
      j->drift[i] = fmax(j->drift[i], fabs(now[i] - j->first[i]));
  }
  const double *q = dvi_integrator_q(j->integrator);
  const double t = dvi_integrator_time(j->integrator);
  ck_assert_msg(!dvi_moving_lift(j->moving, t, q, j->x, j->u), "%s", dvi_last_error());
}

void arrive(journey *j)
{
  dvi_integrator_destroy(&j->integrator);
  dvi_system_destroy(&j->system);
  dvi_moving_destroy(&j->moving);
}
