/* labels: unit */
/* Members of one-forms go side by side by projected vprk, each with the bits and the counts of a
 * run alone. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { MEMBERS = 21, N = 2 };

/* ---- systems ---- */

/* alpha = (-q2 - beta q2^3/3, q1/4), H = q1^2/2 + q1^4/8 + q2^2/2. The gradient of alpha fails, or
 * is no number, beyond a limit of q1. With `singular` alpha = (-q2^2/2, q1/4), whose two-form is
 * singular at q2 = -1/4. */
typedef struct field {
  double beta, retry_above, fail_above, nan_above;
  int singular;
  long calls; /* of the gradient */
} field;

static int field_value(const double *q, double *alpha, void *user)
{
  const field *own = user;
  alpha[0] = own->singular ? -0.5 * q[1] * q[1] : -q[1] - own->beta * q[1] * q[1] * q[1] / 3;
  alpha[1] = 0.25 * q[0];
  return 0;
}

static int field_gradient(const double *q, double *alpha_q, void *user)
{
  field *own = user;
  own->calls++;
  alpha_q[0] = alpha_q[3] = 0;
  alpha_q[1] = own->singular ? -q[1] : -1 - own->beta * q[1] * q[1];
  alpha_q[2] = q[0] > own->nan_above ? (double)NAN : 0.25;
  return q[0] > own->fail_above ? -1 : q[0] > own->retry_above;
}

static int field_hessian(const double *q, const double *w, double *alpha_w_qq, void *user)
{
  const field *own = user;
  memset(alpha_w_qq, 0, N * N * sizeof(double));
  alpha_w_qq[3] = own->singular ? -w[0] : -2 * own->beta * q[1] * w[0];
  return 0;
}

static int well_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * (q[0] * q[0] + q[1] * q[1]) + 0.125 * pow(q[0], 4);
  return 0;
}

static int well_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0] + 0.5 * q[0] * q[0] * q[0];
  V_q[1] = q[1];
  return 0;
}

static int well_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  V_qq[0] = 1 + 1.5 * q[0] * q[0], V_qq[1] = V_qq[2] = 0, V_qq[3] = 1;
  return 0;
}

/* f = q1^2 q2/2 */
static int gauge_gradient(const double *q, double *f_q, void *user)
{
  (void)user;
  f_q[0] = q[0] * q[1], f_q[1] = 0.5 * q[0] * q[0];
  return 0;
}

static int gauge_hessian(const double *q, double *f_qq, void *user)
{
  (void)user;
  f_qq[0] = q[1], f_qq[1] = f_qq[2] = q[0], f_qq[3] = 0;
  return 0;
}

static int gauge_third(const double *q, const double *w, double *f_w_qq, void *user)
{
  (void)q, (void)user;
  f_w_qq[0] = w[1], f_w_qq[1] = f_w_qq[2] = w[0], f_w_qq[3] = 0;
  return 0;
}

static dvi_system *create_field(field *own, int with_gauge)
{
  dvi_system *made = NULL;
  const dvi_one_form alpha = {
      .value = field_value, .gradient = field_gradient, .hessian = field_hessian, .user = own};
  const dvi_gauge gauge = {
      .gradient = gauge_gradient, .hessian = gauge_hessian, .third = gauge_third};
  const dvi_potential wells[] = {
      {.value = well_value, .gradient = well_gradient, .hessian = well_hessian},
      {.value = well_value, .gradient = well_gradient, .hessian = well_hessian}};
  const dvi_system_terms terms = {.dimension = N,
                                  .one_form = &alpha,
                                  .gauge = with_gauge ? &gauge : NULL,
                                  .potentials = wells,
                                  .potential_count = with_gauge ? 2 : 1,
                                  .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

static const double never = 1e300;

static field a_field(double beta)
{
  return (field){.beta = beta, .retry_above = never, .fail_above = never, .nan_above = never};
}

/* ---- members and their twins ---- */

static double q[N * MEMBERS], p[N * MEMBERS];

static void place_member(const dvi_system *system, int k, double q1, double q2)
{
  const double at[N] = {q1, q2}, rest[N] = {0};
  double momentum[N];
  ck_assert_int_eq(dvi_system_momentum(system, 0, at, rest, momentum), DVI_OK);
  for (int i = 0; i < N; i++) q[i * MEMBERS + k] = at[i], p[i * MEMBERS + k] = momentum[i];
}

static void spread_members(const dvi_system *const *systems, double size)
{
  for (int k = 0; k < MEMBERS; k++)
    place_member(systems[k], k, size * cos(0.3 * k), size * (0.2 + sin(0.3 * k)));
}

/* Lengths of steps change on the way, some are too long, and the last ones go back. */
static const struct {
  double h;
  long steps;
} legs[] = {{0.05, 20}, {0.08, 12}, {1.5, 2}, {0.05, 6}, {-0.05, 9}};
enum { LEGS = sizeof legs / sizeof *legs };

static void add_counters(const dvi_integrator *alone, dvi_counters *sum)
{
  dvi_counters of;
  dvi_integrator_counters(alone, &of);
  sum->steps += of.steps;
  sum->failed_steps += of.failed_steps;
  sum->gradients += of.gradients;
  sum->hessians += of.hessians;
  sum->residuals += of.residuals;
  sum->jacobians += of.jacobians;
  sum->factorizations += of.factorizations;
  sum->solves += of.solves;
  sum->newtons += of.newtons;
  sum->followed += of.followed;
}

static void check_counters(const dvi_ensemble *e, const dvi_counters *sum)
{
  dvi_counters of;
  dvi_ensemble_counters(e, &of);
  ck_assert_int_eq(of.steps, sum->steps);
  ck_assert_int_eq(of.failed_steps, sum->failed_steps);
  ck_assert_int_eq(of.gradients, sum->gradients);
  ck_assert_int_eq(of.hessians, sum->hessians);
  ck_assert_int_eq(of.residuals, sum->residuals);
  ck_assert_int_eq(of.jacobians, sum->jacobians);
  ck_assert_int_eq(of.factorizations, sum->factorizations);
  ck_assert_int_eq(of.solves, sum->solves);
  ck_assert_int_eq(of.newtons, sum->newtons);
  ck_assert_int_eq(of.followed, sum->followed);
}

static void same_as_alone(const dvi_ensemble *e, const dvi_system *system, const char *method,
                          int k, dvi_counters *sum)
{
  double t[MEMBERS], q_now[N * MEMBERS], p_now[N * MEMBERS];
  const double start_q[] = {q[k], q[MEMBERS + k]}, start_p[] = {p[k], p[MEMBERS + k]};
  dvi_integrator *alone = create_integrator(system, method);
  dvi_status status = dvi_integrator_start(alone, 0, start_q, start_p);
  for (int i = 0; i < LEGS; i++) {
    status = DVI_OK;
    for (long step = 0; step < legs[i].steps && status == DVI_OK; step++)
      status = dvi_integrator_step(alone, legs[i].h);
  }
  ck_assert_int_eq(dvi_ensemble_status(e, k), status);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q_now, p_now), DVI_OK);
  for (int i = 0; i < N; i++) {
    ck_assert_mem_eq(&q_now[i * MEMBERS + k], dvi_integrator_q(alone) + i, sizeof(double));
    ck_assert_mem_eq(&p_now[i * MEMBERS + k], dvi_integrator_p(alone) + i, sizeof(double));
  }
  ck_assert_double_eq(t[k], dvi_integrator_time(alone));
  add_counters(alone, sum);
  dvi_integrator_destroy(&alone);
}

static void check_words_of(const dvi_ensemble *e, const char *words)
{
  char text[2048];
  (void)dvi_ensemble_explain(e, text, sizeof text);
  ck_assert_msg(strstr(text, words) != NULL, "%s", text);
}

/* Returns how many steps fail. */
static long compare(const dvi_system *const *systems, const char *method, int threads)
{
  dvi_counters sum = {0};
  const dvi_ensemble_options options = {
      .members = MEMBERS, .threads = threads, .block = 16, .systems = systems};
  dvi_ensemble *e = create_ensemble(NULL, method, options);
  check_words_of(e, "side by side as lanes");
  ck_assert_msg(dvi_ensemble_start(e, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < LEGS; i++) (void)dvi_ensemble_advance(e, legs[i].h, legs[i].steps);
  for (int k = 0; k < MEMBERS; k++) same_as_alone(e, systems[k], method, k, &sum);
  check_counters(e, &sum);
  dvi_ensemble_destroy(&e);
  return sum.failed_steps;
}

static void use_system(const dvi_system *system, const dvi_system *systems[MEMBERS])
{
  for (int k = 0; k < MEMBERS; k++) systems[k] = system;
}

static const char *const methods[] = {"vprk:nodes=1",
                                      "vprk:nodes=2",
                                      "vprk:nodes=5",
                                      "vprk:nodes=3,tableau=lobatto-iiie",
                                      "vprk:nodes=2,projection=symplectic",
                                      "vprk:nodes=3,projection=post"};
enum { METHODS = sizeof methods / sizeof *methods };

START_TEST(members_have_the_bits_and_counts_of_runs_alone)
{
  field own = a_field(1);
  dvi_system *system = create_field(&own, _i / METHODS);
  const dvi_system *systems[MEMBERS];
  use_system(system, systems);
  spread_members(systems, 1.2);
  (void)compare(systems, methods[_i % METHODS], 1);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(members_may_have_systems_of_their_own)
{
  field own[] = {a_field(1), a_field(0), a_field(-0.2)};
  dvi_system *made[3];
  const dvi_system *systems[MEMBERS];
  for (int i = 0; i < 3; i++) made[i] = create_field(&own[i], 0);
  for (int k = 0; k < MEMBERS; k++) systems[k] = made[k < 10 ? 0 : k < 12 ? 1 : 2];
  spread_members(systems, 0.9);
  for (int threads = 1; threads <= 2; threads++) (void)compare(systems, "vprk:nodes=2", threads);
  for (int i = 0; i < 3; i++) dvi_system_destroy(&made[i]);
}
END_TEST

/* Some members come to where their callbacks ask for a smaller step, fail, or give NaN, or where
 * the two-form is singular. They fail as they fail alone, and no other member sees them. */
START_TEST(members_that_fail_are_no_one_elses_matter)
{
  const int kind = _i % 4;
  field own = a_field(1);
  if (kind == 0) own.retry_above = 1.2;
  if (kind == 1) own.fail_above = 1.2;
  if (kind == 2) own.nan_above = 1.2;
  own.singular = kind == 3;
  dvi_system *system = create_field(&own, 0);
  const dvi_system *systems[MEMBERS];
  use_system(system, systems);
  spread_members(systems, 0.9);
  for (int k = 0; k < MEMBERS && kind == 3; k++) place_member(system, k, 0.1, 1 + 0.02 * k);
  place_member(system, 3, 1, kind == 3 ? 0.1 : 0.9);
  place_member(system, 12, kind == 3 ? -1 : 1.1, kind == 3 ? 0.1 : -0.8);
  const long failed = compare(systems, methods[1 + _i / 4], 1);
  ck_assert_msg(failed > 0, "no step fails");
  dvi_system_destroy(&system);
}
END_TEST

/* Members side by side use the gradients of the Jacobian again, do not evaluate those that have no
 * effect, and take no memory. */
START_TEST(steps_side_by_side_save_evaluations)
{
  field own = a_field(1);
  dvi_counters before, after;
  dvi_system *system = create_field(&own, 0);
  const dvi_system *systems[MEMBERS];
  use_system(system, systems);
  spread_members(systems, 0.9);
  dvi_ensemble *e = create_ensemble(system, "vprk:nodes=2", (dvi_ensemble_options){.members = 8});
  double first_q[N * 8], first_p[N * 8];
  for (int i = 0; i < N; i++) {
    memcpy(first_q + 8 * i, q + MEMBERS * i, 8 * sizeof *q);
    memcpy(first_p + 8 * i, p + MEMBERS * i, 8 * sizeof *p);
  }
  ck_assert_int_eq(dvi_ensemble_start(e, 0, first_q, first_p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, 64), DVI_OK);
  dvi_ensemble_counters(e, &before);
  own.calls = 0;
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, 50), DVI_OK);
  dvi_ensemble_counters(e, &after);
  /* those of the Hessians, of the first residual and of the end's side, alone */
  const long gradients = after.gradients - before.gradients,
             alone = gradients + (after.hessians - before.hessians) + 8 * 50;
  ck_assert_msg(own.calls <= alone - 3 * 8 * 50, "%ld of %ld", own.calls, alone);
  ck_assert_int_eq(after.allocations, before.allocations);
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

/* Without a projection, or along directions at the mean, members go one after the other. */
START_TEST(other_projections_go_one_after_the_other)
{
  field own = a_field(1);
  dvi_system *system = create_field(&own, 0);
  dvi_ensemble *e = create_ensemble(system,
                                    _i == 0 ? "vprk:projection=midpoint" : "vprk:projection=none",
                                    (dvi_ensemble_options){.members = MEMBERS});
  check_words_of(e, "one after the other");
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(ensemble_one_form)
{
  tcase_add_loop_test(tests, members_have_the_bits_and_counts_of_runs_alone, 0, 2 * METHODS);
  tcase_add_test(tests, members_may_have_systems_of_their_own);
  tcase_add_loop_test(tests, members_that_fail_are_no_one_elses_matter, 0, 4 * 2);
  tcase_add_test(tests, steps_side_by_side_save_evaluations);
  tcase_add_loop_test(tests, other_projections_go_one_after_the_other, 0, 2);
}
