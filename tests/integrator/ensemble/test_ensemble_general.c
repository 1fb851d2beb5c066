/* labels: unit */
/* Members of general Lagrangians, of coupled masses and of systems with friction iterate side by
 * side on their paths, each with the bits of a run alone. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MEMBERS = 21, N = 2 };

/* ---- systems ---- */

/* A point on a hilly road beside a rotor, L = (1 + q1^2) v1^2/2 + v1 v2/4 + v2^2/2 - cosh(q1)
 * - q2^2/2. The gradient fails, or is not a number, beyond a limit of q1, and `coupled` declares a
 * mass that does not depend on q. */
typedef struct road {
  double retry_above, fail_above, nan_above;
} road;

static int road_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = 0.5 * (1 + q[0] * q[0]) * v[0] * v[0] + 0.25 * v[0] * v[1] + 0.5 * v[1] * v[1] - cosh(q[0]) -
       0.5 * q[1] * q[1];
  return 0;
}

static int road_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  const road *own = user;
  (void)t;
  L_q[0] = q[0] > own->nan_above ? (double)NAN : q[0] * v[0] * v[0] - sinh(q[0]);
  L_q[1] = -q[1];
  L_v[0] = (1 + q[0] * q[0]) * v[0] + 0.25 * v[1];
  L_v[1] = 0.25 * v[0] + v[1];
  return q[0] > own->fail_above ? -1 : q[0] > own->retry_above;
}

static int road_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                        double *L_vv, void *user)
{
  const double qq[] = {v[0] * v[0] - cosh(q[0]), 0, 0, -1}, qv[] = {2 * q[0] * v[0], 0, 0, 0},
               vv[] = {1 + q[0] * q[0], 0.25, 0.25, 1};
  (void)t, (void)user;
  memcpy(L_qq, qq, sizeof qq), memcpy(L_qv, qv, sizeof qv), memcpy(L_vv, vv, sizeof vv);
  return 0;
}

static dvi_system *create_road(road *own)
{
  dvi_system *made = NULL;
  const dvi_lagrangian L = {
      .value = road_value, .gradient = road_gradient, .hessian = road_hessian, .user = own};
  const dvi_system_terms terms = {.dimension = N, .lagrangian = &L, .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

/* L = v1 v2 - sin(q1) q2, whose mass cannot be inverted without exchanges. Members go alone. */
static int crossed_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = v[0] * v[1] - sin(q[0]) * q[1];
  return 0;
}

static int crossed_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  (void)t, (void)user;
  L_q[0] = -cos(q[0]) * q[1], L_q[1] = -sin(q[0]);
  L_v[0] = v[1], L_v[1] = v[0];
  return 0;
}

static int crossed_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                           double *L_vv, void *user)
{
  const double qq[] = {sin(q[0]) * q[1], -cos(q[0]), -cos(q[0]), 0}, vv[] = {0, 1, 1, 0};
  (void)t, (void)v, (void)user;
  memcpy(L_qq, qq, sizeof qq), memset(L_qv, 0, sizeof qq), memcpy(L_vv, vv, sizeof vv);
  return 0;
}

static dvi_system *create_crossed(void)
{
  dvi_system *made = NULL;
  const dvi_lagrangian L = {
      .value = crossed_value, .gradient = crossed_gradient, .hessian = crossed_hessian};
  const dvi_system_terms terms = {.dimension = N, .lagrangian = &L, .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

static int hill_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = cosh(q[0]) + 0.5 * q[1] * q[1];
  return 0;
}

static int hill_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = sinh(q[0]), V_q[1] = q[1];
  return 0;
}

static int drag(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < N; i++) F[i] = -0.1 * v[i] * fabs(v[i]);
  return 0;
}

static dvi_system *create_coupled(int with_drag)
{
  static const int start[] = {0, 2, 4}, row[] = {0, 1, 0, 1};
  static const double mass[] = {1.5, 0.25, 0.25, 1};
  dvi_system *made = NULL;
  const dvi_potential hill = {.value = hill_value, .gradient = hill_gradient};
  const dvi_force force = {.name = "drag", .value = drag};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.values = mass, .pattern = {.start = start, .row = row}},
                                  .potentials = &hill,
                                  .potential_count = 1,
                                  .forces = with_drag ? &force : NULL,
                                  .force_count = with_drag,
                                  .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

/* ---- members and their twins ---- */

static double q[N * MEMBERS], p[N * MEMBERS];

/* Fills numbers that look random between -1 and 1, times a size. */
static void spread_members(double size)
{
  unsigned state = 12345;
  for (int i = 0; i < N * MEMBERS; i++) {
    state = 1664525 * state + 1013904223;
    q[i] = size * ((double)state / 2147483648.0 - 1);
    state = 1664525 * state + 1013904223;
    p[i] = size * ((double)state / 2147483648.0 - 1);
  }
}

static void goes_side_by_side(const dvi_ensemble *e)
{
  char text[2048];
  (void)dvi_ensemble_explain(e, text, sizeof text);
  ck_assert_msg(strstr(text, "side by side as lanes") != NULL, "%s", text);
}

/* Lengths of steps change twice on the way, and the last ones go back. */
static const double lengths[] = {0.1, 0.1, 0.1, 0.15, 0.15, -0.05, -0.05, 0.9, 0.9, 0.1, 0.1};
enum { STEPS = sizeof lengths / sizeof *lengths };

static void same_as_alone(dvi_ensemble *e, const dvi_system *system, const char *method, int k)
{
  double t[MEMBERS], q_now[N * MEMBERS], p_now[N * MEMBERS];
  const double start_q[] = {q[k], q[MEMBERS + k]}, start_p[] = {p[k], p[MEMBERS + k]};
  dvi_integrator *alone = create_integrator(system, method);
  dvi_status status = dvi_integrator_start(alone, 0, start_q, start_p);
  for (int i = 0; i < STEPS; i++) status = dvi_integrator_step(alone, lengths[i]);
  ck_assert_int_eq(dvi_ensemble_status(e, k), status);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q_now, p_now), DVI_OK);
  for (int i = 0; i < N; i++) {
    ck_assert_mem_eq(&q_now[i * MEMBERS + k], dvi_integrator_q(alone) + i, sizeof(double));
    ck_assert_mem_eq(&p_now[i * MEMBERS + k], dvi_integrator_p(alone) + i, sizeof(double));
  }
  ck_assert_double_eq(t[k], dvi_integrator_time(alone));
  dvi_integrator_destroy(&alone);
}

/* Returns how many steps fail. */
static long compare(const dvi_system *system, const char *method, int threads)
{
  dvi_counters counters;
  dvi_ensemble *e = create_ensemble(
      system, method, (dvi_ensemble_options){.members = MEMBERS, .threads = threads, .block = 8});
  goes_side_by_side(e);
  ck_assert_msg(dvi_ensemble_start(e, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < STEPS; i++) (void)dvi_ensemble_step(e, lengths[i]);
  for (int k = 0; k < MEMBERS; k++) same_as_alone(e, system, method, k);
  dvi_ensemble_counters(e, &counters);
  dvi_ensemble_destroy(&e);
  return counters.failed_steps;
}

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
}

static const char *const methods[] = {
    "midpoint",          "trapezoidal",
    "galerkin:degree=3", "galerkin:degree=3,solver=fixed-point",
    "galerkin:degree=8", "composition:order=4,base=galerkin,degree=2"};
enum { METHODS = sizeof methods / sizeof *methods, KINDS = 4 };

static const double never = 1e300;

static dvi_system *create_kind(int kind, road *own)
{
  if (kind == 3) return create_crossed();
  return kind == 0 ? create_road(own) : create_coupled(kind == 2);
}

/* At the longest steps the iteration fails for some members, which go on alone and come back. */
START_TEST(members_have_the_bits_of_runs_alone)
{
  road own = {never, never, never};
  dvi_system *system = create_kind(_i / METHODS, &own);
  spread_members(2);
  (void)compare(system, methods[_i % METHODS], 1 + _i % 4);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(threads_change_no_bit)
{
  road own = {never, never, never};
  dvi_system *system = create_road(&own);
  spread_members(2);
  for (int threads = 1; threads <= 4; threads++)
    (void)compare(system, "galerkin:degree=2", threads);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(every_level_gives_these_bits)
{
  road own = {never, never, never};
  dvi_system *system = create_kind(_i % KINDS, &own);
  dvi__lanes_choose(_i / KINDS);
  spread_members(1);
  (void)compare(system, "galerkin:degree=3", 1);
  dvi_system_destroy(&system);
}
END_TEST

/* Some members climb the hill until their callbacks ask for a smaller step, fail, or give NaN. They
 * fail as they fail alone, and no other member sees them. */
START_TEST(members_that_fail_are_no_one_elses_matter)
{
  const int kind = _i % 3;
  road own = {kind == 0 ? 1.2 : never, kind == 1 ? 1.2 : never, kind == 2 ? 1.2 : never};
  dvi_system *system = create_road(&own);
  spread_members(1);
  p[3] = p[11] = 2.5;
  const long failed = compare(system, methods[_i / 3 % METHODS], 1 + _i % 4);
  ck_assert_msg(failed > 0 && failed < MEMBERS * STEPS / 4, "%ld", failed);
  dvi_system_destroy(&system);
}
END_TEST

/* A step of short length is solved with one velocity Hessian, which is inverted without a linear
 * solver, and takes no other derivative. */
START_TEST(a_step_takes_one_velocity_hessian)
{
  road own = {never, never, never};
  dvi_counters before, after;
  dvi_system *system = create_road(&own);
  dvi_ensemble *e = create_ensemble(system, "galerkin", (dvi_ensemble_options){.members = MEMBERS});
  spread_members(0.5);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, 2), DVI_OK);
  dvi_ensemble_counters(e, &before);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, 10), DVI_OK);
  dvi_ensemble_counters(e, &after);
  ck_assert_int_eq(after.fixed_points - before.fixed_points, 10 * MEMBERS);
  ck_assert_int_eq(after.hessians - before.hessians, 10 * MEMBERS);
  ck_assert_int_eq(after.factorizations, before.factorizations);
  ck_assert_int_eq(after.jacobians, before.jacobians);
  ck_assert_int_eq(after.allocations, before.allocations);
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(ensemble_general)
{
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_add_loop_test(tests, members_have_the_bits_of_runs_alone, 0, KINDS * METHODS);
  tcase_add_test(tests, threads_change_no_bit);
  tcase_add_loop_test(tests, every_level_gives_these_bits, 0, KINDS * dvi__lanes_levels());
  tcase_add_loop_test(tests, members_that_fail_are_no_one_elses_matter, 0, 3 * METHODS);
  tcase_add_test(tests, a_step_takes_one_velocity_hessian);
}
