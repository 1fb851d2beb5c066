/* Verlet's method with a hanging chain of 100 rods: the work of a step, by counters. */
#include <dvi/dvi.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

enum { RODS = 100, N = 2 * RODS };

/* Rods of length 1/RODS with masses 1/RODS at their ends hang from the origin. */
static int weight(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int k = 0; k < RODS; k++) *V += 9.81 / RODS * q[2 * k + 1];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < N; i++) V_q[i] = i % 2 == 0 ? 0 : 9.81 / RODS;
  return 0;
}

static double along(const double *q, int k, int i)
{
  return q[2 * k + i] - (k > 0 ? q[2 * k - 2 + i] : 0);
}

static int rods(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < RODS; k++) {
    const double x = along(q, k, 0), y = along(q, k, 1);
    phi[k] = 0.5 * (x * x + y * y - 1.0 / RODS / RODS);
  }
  return 0;
}

static int rods_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < RODS; k++) {
    for (int i = 0; i < 2 && k > 0; i++) *phi_q++ = -along(q, k, i);
    for (int i = 0; i < 2; i++) *phi_q++ = along(q, k, i);
  }
  return 0;
}

static dvi_system *make_chain(void)
{
  int start[RODS + 1] = {0}, row[4 * RODS], entries = 0;
  for (int k = 0; k < RODS; k++) {
    for (int i = k > 0 ? 2 * k - 2 : 0; i < 2 * k + 2; i++) row[entries++] = i;
    start[k + 1] = entries;
  }
  const dvi_potential V = {.name = "weight", .value = weight, .gradient = weight_gradient};
  const dvi_holonomic constraint = {.name = "rods",
                                    .count = RODS,
                                    .value = rods,
                                    .gradient = rods_gradient,
                                    .gradients = {start, row}};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = N,
                                                         .mass.scalar = 1.0 / RODS,
                                                         .potentials = &V,
                                                         .potential_count = 1,
                                                         .holonomics = &constraint,
                                                         .holonomic_count = 1},
                                     &system),
                   DVI_OK);
  return system;
}

static dvi_integrator *start_chain(const dvi_system *system)
{
  double q[N], p[N] = {0};
  dvi_integrator *integrator = create_integrator(system, "verlet");
  for (int k = 0; k < RODS; k++) {
    q[2 * k] = (k + 1.0) / RODS * sin(0.3);
    q[2 * k + 1] = -(k + 1.0) / RODS * cos(0.3);
  }
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* One factor serves a step: that of its start is the one of the step before. Multipliers that are
 * guessed by differences need one or two evaluations of the constraints, and one solution at the
 * end. */
START_TEST(a_step_takes_one_factor_and_few_solutions)
{
  static const double h[] = {1e-5, 1e-4, 1e-3}, most[] = {1.2, 2.1, 3.6};
  const int steps = 200;
  dvi_system *system = make_chain();
  dvi_integrator *integrator = start_chain(system);
  dvi_counters before, after;
  double off;
  advance(integrator, h[_i], 10);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, h[_i], steps);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.factorizations - before.factorizations, steps);
  ck_assert_int_eq(after.preparations - before.preparations, 0);
  ck_assert_double_le((double)(after.residuals - before.residuals), most[_i] * steps);
  ck_assert_double_le((double)(after.solves - before.solves), (most[_i] + 1) * steps);
  ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
  ck_assert_double_lt(off, 1e-16);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(rattle_chain)
{
  tcase_add_loop_test(tests, a_step_takes_one_factor_and_few_solutions, 0, 3);
}
