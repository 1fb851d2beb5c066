/* labels: unit */
/* A kind of dynamics that no file of the library knows, as CONTRIBUTING's recipe says: the driver,
 * invariants, checkpoints and judges call its functions. A particle near the speed of light, L =
 * -sqrt(1 - v^2) - q^2/2, has the velocity p/sqrt(1 + p^2), which a general Lagrangian finds by
 * Newton's method. */
#include "system/evaluate/dynamics.h"

#include <math.h>

#include <dvi/reference.h>

#include "support/runs.h"
#include "support/suite.h"

static int value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = -sqrt(1 - v[0] * v[0]) - 0.5 * q[0] * q[0];
  return v[0] * v[0] < 1 ? 0 : 1;
}

static int gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                    void *user)
{
  (void)t, (void)user;
  L_q[0] = -q[0];
  L_v[0] = v[0] / sqrt(1 - v[0] * v[0]);
  return v[0] * v[0] < 1 ? 0 : 1;
}

static int calls;

static dvi_status velocity_of_particle(dvi__evaluator *e, double t, const double *q,
                                       const double *p, double *v)
{
  (void)e, (void)t, (void)q;
  calls++;
  v[0] = p[0] / sqrt(1 + p[0] * p[0]);
  return DVI_OK;
}

static dvi_status energy_of_particle(dvi__evaluator *e, double t, const double *q, const double *v,
                                     const double *p, double *E)
{
  (void)e, (void)t, (void)v;
  *E = sqrt(1 + p[0] * p[0]) + 0.5 * q[0] * q[0];
  return DVI_OK;
}

/* A particle as a general Lagrangian, then as a kind of its own. */
static dvi_system *create_particle(dvi__dynamics *kind)
{
  const dvi_lagrangian lagrangian = {.value = value, .gradient = gradient};
  dvi_system *system = NULL;
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.dimension = 1, .lagrangian = &lagrangian, .autonomous = 1}, &system),
      DVI_OK);
  if (kind == NULL) return system;
  *kind = *system->dynamics;
  kind->name = "particle near the speed of light";
  kind->searches_velocity = 0;
  kind->velocity = velocity_of_particle;
  kind->energy = energy_of_particle;
  system->dynamics = kind;
  return system;
}

static double end_of_run(const dvi_system *system, double *energy)
{
  const double q = 1, p = 0.5;
  dvi_integrator *integrator = create_integrator(system, "galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &p), DVI_OK);
  for (int step = 0; step < 50; step++)
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, energy), DVI_OK);
  const double end = dvi_integrator_q(integrator)[0];
  dvi_integrator_destroy(&integrator);
  return end;
}

START_TEST(the_driver_asks_the_kind_for_velocities_and_energies)
{
  dvi__dynamics kind;
  dvi_system *general = create_particle(NULL), *particle = create_particle(&kind);
  double searched, told;
  const double end = end_of_run(general, &searched);
  calls = 0;
  ck_assert_double_eq_tol(end_of_run(particle, &told), end, 1e-12);
  ck_assert_int_gt(calls, 0);
  ck_assert_double_eq_tol(told, searched, 1e-13);
  dvi_system_destroy(&general);
  dvi_system_destroy(&particle);
}
END_TEST

START_TEST(the_judges_ask_it_too)
{
  const dvi_reference_code codes[] = {DVI_IDA, DVI_CVODE_ADAMS, DVI_ARKODE};
  dvi__dynamics kind;
  dvi_system *general = create_particle(NULL), *particle = create_particle(&kind);
  for (int k = 0; k < 3; k++) {
    const dvi_reference_options options = {.code = codes[k]};
    double q[2] = {1, 1}, p[2] = {0.5, 0.5};
    ck_assert_int_eq(dvi_reference_solve(general, 0, 5, &q[0], &p[0], &options, NULL), DVI_OK);
    calls = 0;
    ck_assert_msg(dvi_reference_solve(particle, 0, 5, &q[1], &p[1], &options, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_gt(calls, 0);
    ck_assert_double_eq_tol(q[0], q[1], 1e-7);
    ck_assert_double_eq_tol(p[0], p[1], 1e-7);
  }
  dvi_system_destroy(&general);
  dvi_system_destroy(&particle);
}
END_TEST

SUITE(dynamics)
{
  tcase_add_test(tests, the_driver_asks_the_kind_for_velocities_and_energies);
  tcase_add_test(tests, the_judges_ask_it_too);
}
