/* labels: unit */
/* Members with holonomic constraints step side by side by verlet and its compositions, each with
 * the bits and the counts of a run alone. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { MEMBERS = 21, N_MOST = 8 };

static double q[N_MOST * MEMBERS], v[N_MOST * MEMBERS];

/* Every member starts at one place, at multiples of one velocity. */
static void spread(int n, const double *place, const double *velocity, double most)
{
  ck_assert_int_le(n, N_MOST);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < MEMBERS; k++) {
      q[i * MEMBERS + k] = place[i];
      v[i * MEMBERS + k] = velocity[i] * most * (k + 1) / MEMBERS;
    }
}

static int goes_side_by_side(const dvi_ensemble *e)
{
  char text[4096];
  (void)dvi_ensemble_explain(e, text, sizeof text);
  return strstr(text, "side by side as lanes") != NULL;
}

static void add_step_counts(const dvi_counters *before, const dvi_counters *after, long sum[8])
{
  sum[0] += after->values - before->values;
  sum[1] += after->gradients - before->gradients;
  sum[2] += after->residuals - before->residuals;
  sum[3] += after->jacobians - before->jacobians;
  sum[4] += after->factorizations - before->factorizations;
  sum[5] += after->solves - before->solves;
  sum[6] += after->simplified - before->simplified;
  sum[7] += after->newtons - before->newtons;
}

/* Compare member k with its run alone, whose counts are added to sum. */
static void same_as_alone(dvi_ensemble *e, const dvi_system *system, const char *method, int k,
                          double h, int steps, long sum[8])
{
  double t[MEMBERS], q_all[N_MOST * MEMBERS], p_all[N_MOST * MEMBERS], q_k[N_MOST], v_k[N_MOST];
  const int n = dvi_system_nq(system);
  dvi_counters before, after;
  dvi_integrator *alone = create_integrator(system, method);
  dvi_status status = DVI_OK;
  for (int i = 0; i < n; i++) q_k[i] = q[i * MEMBERS + k], v_k[i] = v[i * MEMBERS + k];
  ck_assert_int_eq(dvi_integrator_start_velocity(alone, 0, q_k, v_k), DVI_OK);
  dvi_integrator_counters(alone, &before);
  for (int i = 0; i < steps && status == DVI_OK; i++) status = dvi_integrator_step(alone, h);
  dvi_integrator_counters(alone, &after);
  add_step_counts(&before, &after, sum);
  ck_assert_int_eq(dvi_ensemble_status(e, k), status);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q_all, p_all), DVI_OK);
  ck_assert_double_eq(t[k], dvi_integrator_time(alone));
  for (int i = 0; i < n; i++) {
    ck_assert_mem_eq(&q_all[i * MEMBERS + k], dvi_integrator_q(alone) + i, sizeof(double));
    ck_assert_mem_eq(&p_all[i * MEMBERS + k], dvi_integrator_p(alone) + i, sizeof(double));
  }
  dvi_integrator_destroy(&alone);
}

/* Advance all members, and then once more, and compare them with runs alone. The counts are the
 * same, too, unless members leave the others, which their renewals of matrices say. Returns how
 * many of these there are. */
static long compare_members(const dvi_system *system, const char *method, double h, int steps)
{
  dvi_ensemble *e = create_ensemble(system, method,
                                    (dvi_ensemble_options){.members = MEMBERS, .block = MEMBERS});
  long together[8] = {0}, alone[8] = {0};
  dvi_counters before, after;
  ck_assert_msg(goes_side_by_side(e), "%s", method);
  ck_assert_msg(dvi_ensemble_start_velocity(e, 0, q, v) == DVI_OK, "%s", dvi_last_error());
  dvi_ensemble_counters(e, &before);
  const dvi_status status = dvi_ensemble_advance(e, h, steps / 2);
  if (status == DVI_OK) (void)dvi_ensemble_advance(e, h, steps - steps / 2);
  dvi_ensemble_counters(e, &after);
  add_step_counts(&before, &after, together);
  for (int k = 0; k < MEMBERS; k++) same_as_alone(e, system, method, k, h, steps, alone);
  for (int i = 0; i < 8 && alone[7] == 0; i++)
    ck_assert_msg(together[i] == alone[i], "%s: count %d: %ld, alone %ld", method, i, together[i],
                  alone[i]);
  dvi_ensemble_destroy(&e);
  return alone[7];
}

/* ---- problems ---- */

static const char *const problems[] = {"spherical-constrained", "slider-crank"};
static const char *const methods[] = {"verlet", "composition:base=verlet",
                                      "composition:order=6,base=verlet"};

START_TEST(members_have_the_bits_and_the_counts_of_runs_alone)
{
  problem *model = create_problem(problems[_i / 3], NULL);
  spread(model->nq, model->q, model->v, 1.3);
  (void)compare_members(model->system, methods[_i % 3], 0.01, 12);
  (void)compare_members(model->system, methods[_i % 3], -0.01, 12);
  problem_destroy(&model);
}
END_TEST

/* ---- two rods in Cartesian coordinates, of which the first one may grow and shrink ---- */

enum { N = 4 };

typedef struct rods {
  double swell, rate; /* the first rod's square is 1 + swell sin(rate t) */
  double retry_above; /* the gradient fails above this height of the first bob */
  double weight[2];   /* of the bobs' potentials */
  int batches;        /* whether the constraints are declared for batches */
} rods;

static int weight(double t, const double *x, double *V, void *user)
{
  const rods *own = user;
  (void)t;
  *V = own->weight[0] * x[1] + own->weight[1] * x[3];
  return 0;
}

static int weight_gradient(double t, const double *x, double *V_q, void *user)
{
  const rods *own = user;
  (void)t, (void)x;
  memcpy(V_q, (const double[]){0, own->weight[0], 0, own->weight[1]}, N * sizeof *V_q);
  return 0;
}

static int phi(double t, const double *x, double *value, void *user)
{
  const rods *own = user;
  const double dx = x[2] - x[0], dy = x[3] - x[1];
  value[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] - 1 - own->swell * sin(own->rate * t));
  value[1] = 0.5 * (dx * dx + dy * dy - 1);
  return 0;
}

static int phi_gradient(double t, const double *x, double *phi_q, void *user)
{
  const rods *own = user;
  const double dx = x[2] - x[0], dy = x[3] - x[1];
  (void)t;
  memcpy(phi_q, (const double[]){x[0], x[1], -dx, -dy, dx, dy}, 6 * sizeof *phi_q);
  return x[1] > own->retry_above;
}

static int phi_rate(double t, const double *x, double *phi_t, void *user)
{
  const rods *own = user;
  (void)x;
  phi_t[0] = -0.5 * own->swell * own->rate * cos(own->rate * t);
  phi_t[1] = 0;
  return 0;
}

/* The same in batches, whose calls are counted. */
static long calls;

static int phi_batch(int points, const double *t, const double *x, double *value, void *user)
{
  int returned = 0;
  calls++;
  ck_assert_int_le(points, DVI_HOLONOMIC_POINTS);
  for (int k = 0; k < points && returned == 0; k++) {
    double point[N], both[2];
    for (int i = 0; i < N; i++) point[i] = x[i * points + k];
    returned = phi(t[k], point, both, user);
    for (int a = 0; a < 2; a++) value[a * points + k] = both[a];
  }
  return returned;
}

static int phi_gradient_batch(int points, const double *t, const double *x, double *phi_q,
                              void *user)
{
  int returned = 0;
  calls++;
  for (int k = 0; k < points && returned == 0; k++) {
    double point[N], entries[6];
    for (int i = 0; i < N; i++) point[i] = x[i * points + k];
    returned = phi_gradient(t[k], point, entries, user);
    for (int e = 0; e < 6; e++) phi_q[e * points + k] = entries[e];
  }
  return returned;
}

/* A second declaration of the second rod. */
static int again(double t, const double *x, double *value, void *user)
{
  double both[2];
  const int returned = phi(t, x, both, user);
  value[0] = 2 * both[1];
  return returned;
}

static int again_gradient(double t, const double *x, double *phi_q, void *user)
{
  const double dx = x[2] - x[0], dy = x[3] - x[1];
  (void)t, (void)user;
  memcpy(phi_q, (const double[]){-2 * dx, -2 * dy, 2 * dx, 2 * dy}, N * sizeof *phi_q);
  return 0;
}

static dvi_system *create_rods(rods *own, dvi_mass mass, int rows)
{
  static const int start[] = {0, 2, 6}, row[] = {0, 1, 0, 1, 2, 3};
  dvi_system *made = NULL;
  const dvi_potential V = {.value = weight, .gradient = weight_gradient, .user = own};
  const dvi_holonomic holonomics[] = {
      {.name = "rods",
       .count = 2,
       .value = own->batches ? NULL : phi,
       .gradient = own->batches ? NULL : phi_gradient,
       .value_batch = own->batches ? phi_batch : NULL,
       .gradient_batch = own->batches ? phi_gradient_batch : NULL,
       .rate = own->swell != 0 ? phi_rate : NULL,
       .gradients = {start, row},
       .user = own},
      {.name = "again", .count = 1, .value = again, .gradient = again_gradient, .user = own}};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = mass,
                                  .potentials = &V,
                                  .potential_count = 1,
                                  .holonomics = holonomics,
                                  .holonomic_count = rows - 1,
                                  .autonomous = own->swell == 0};
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

static const double hanging[N] = {0, -1, 0, -2}, swing[N] = {6, 0, 15, 0}, masses[N] = {1, 1, 3, 3};

START_TEST(constraints_that_depend_on_time_have_their_rates)
{
  static const double rest[N] = {0.6, -0.8, 1.4, -1.4}, none[N] = {0};
  rods own = {.swell = 0.3, .rate = 2, .retry_above = 9, .weight = {9.8, 29.4}, .batches = _i / 3};
  dvi_system *system = create_rods(&own, (dvi_mass){.diagonal = masses}, 2);
  double start[N], moved[N] = {0};
  /* phi_t + G v = 0 by a velocity along the first rod */
  for (int i = 0; i < 2; i++) moved[i] = moved[i + 2] = 0.3 * rest[i];
  memcpy(start, rest, sizeof start);
  spread(N, start, none, 1);
  for (int i = 0; i < N; i++)
    for (int k = 0; k < MEMBERS; k++) v[i * MEMBERS + k] = moved[i];
  for (int k = 0; k < MEMBERS; k++) { /* and one across both, which are parallel to it there */
    v[0 * MEMBERS + k] += 0.8 * k / MEMBERS, v[1 * MEMBERS + k] += 0.6 * k / MEMBERS;
    v[2 * MEMBERS + k] += 0.8 * k / MEMBERS, v[3 * MEMBERS + k] += 0.6 * k / MEMBERS;
  }
  (void)compare_members(system, methods[_i % 3], 0.02, 20);
  dvi_system_destroy(&system);
}
END_TEST

/* Fast members renew their matrices, which lanes do not. */
START_TEST(members_that_renew_their_matrices_are_stepped_alone)
{
  rods own = {.retry_above = 9, .weight = {9.8, 29.4}};
  dvi_system *system = create_rods(&own, (dvi_mass){.diagonal = masses}, 2);
  spread(N, hanging, swing, 1);
  ck_assert_int_gt(compare_members(system, methods[_i], _i == 0 ? 0.05 : 0.1, 20), 0);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_member_that_fails_stays_and_the_others_go_on)
{
  const char *method = methods[_i % 3];
  rods own = {.retry_above = 0.5, .weight = {9.8, 29.4}, .batches = _i / 3};
  dvi_system *system = create_rods(&own, (dvi_mass){.diagonal = masses}, 2);
  dvi_ensemble *e = create_ensemble(system, method,
                                    (dvi_ensemble_options){.members = MEMBERS, .block = 8});
  long sum[8] = {0};
  int failed = 0;
  spread(N, hanging, swing, 1);
  ck_assert_int_eq(dvi_ensemble_start_velocity(e, 0, q, v), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, 60), DVI_CALLBACK_RETRY);
  check_words("rods: the gradient callback");
  for (int k = 0; k < MEMBERS; k++) {
    failed += dvi_ensemble_status(e, k) == DVI_CALLBACK_RETRY;
    same_as_alone(e, system, method, k, 0.01, 60, sum);
  }
  ck_assert_int_gt(failed, 0);
  ck_assert_int_lt(failed, MEMBERS);
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

/* A step of all members takes as many calls as that of the member with the most iterations, and
 * twice as many for more members than a batch has. */
START_TEST(members_share_calls)
{
  enum { MANY = 80, STEPS = 10 };
  static double places[N * MANY], velocities[N * MANY];
  rods own = {.retry_above = 9, .weight = {9.8, 29.4}, .batches = 1};
  dvi_system *system = create_rods(&own, (dvi_mass){.diagonal = masses}, 2);
  dvi_ensemble *e = create_ensemble(system, "verlet",
                                    (dvi_ensemble_options){.members = MANY, .block = MANY});
  for (int i = 0; i < N * MANY; i++) {
    places[i] = hanging[i / MANY];
    velocities[i] = 0.1 * swing[i / MANY] * (i % MANY) / MANY;
  }
  ck_assert_int_eq(dvi_ensemble_start_velocity(e, 0, places, velocities), DVI_OK);
  calls = 0;
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, STEPS), DVI_OK);
  ck_assert_int_le(calls, 2 * 5 * (STEPS + 1));
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

/* An element asks for all of its nodes at once, and has the bits of one that asks one by one. */
START_TEST(nodes_of_an_element_share_calls)
{
  rods own[2] = {{.retry_above = 9, .weight = {9.8, 29.4}},
                 {.retry_above = 9, .weight = {9.8, 29.4}, .batches = 1}};
  dvi_counters counters;
  double end[2][2 * N];
  for (int s = 0; s < 2; s++) {
    dvi_system *system = create_rods(&own[s], (dvi_mass){.diagonal = masses}, 2);
    dvi_integrator *integrator = create_integrator(system, "galerkin:degree=4");
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, hanging, swing), DVI_OK);
    dvi_integrator_counters(integrator, &counters);
    const long before = counters.values + counters.gradients;
    calls = 0;
    advance(integrator, 0.02, 10);
    dvi_integrator_counters(integrator, &counters);
    ck_assert_int_eq(calls > 0, s);
    ck_assert_int_lt(3 * calls, counters.values + counters.gradients - before);
    memcpy(end[s], dvi_integrator_q(integrator), N * sizeof(double));
    memcpy(end[s] + N, dvi_integrator_p(integrator), N * sizeof(double));
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
  ck_assert_mem_eq(end[0], end[1], sizeof end[0]);
}
END_TEST

START_TEST(constraints_in_both_shapes_are_refused)
{
  rods own = {.retry_above = 9};
  const dvi_holonomic both = {.name = "rods",
                              .count = 1,
                              .value = phi,
                              .value_batch = phi_batch,
                              .gradient = phi_gradient,
                              .user = &own};
  const dvi_system_terms terms = {
      .dimension = N, .mass.scalar = 1, .holonomics = &both, .holonomic_count = 1};
  dvi_system *made = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &made), DVI_BAD_ARGUMENT);
  check_words("rods");
}
END_TEST

/* Rows that follow from others have no factor of a positive matrix. */
START_TEST(members_with_dependent_rows_are_stepped_alone)
{
  rods own = {.retry_above = 9, .weight = {9.8, 29.4}};
  dvi_system *system = create_rods(&own, (dvi_mass){.diagonal = masses}, 3);
  spread(N, hanging, swing, 0.3);
  (void)compare_members(system, "verlet", 0.01, 20);
  dvi_system_destroy(&system);
}
END_TEST

/* Neighbours at one place may have constraints of their own. */
START_TEST(members_with_systems_of_their_own_have_their_constraints)
{
  rods own[2] = {{.retry_above = 9, .weight = {9.8, 29.4}},
                 {.swell = 0, .retry_above = 9, .weight = {1, 2}}};
  const dvi_system *systems[MEMBERS];
  dvi_system *made[2];
  long sum[8] = {0};
  dvi_ensemble *e = NULL;
  for (int s = 0; s < 2; s++) made[s] = create_rods(&own[s], (dvi_mass){.diagonal = masses}, 2);
  for (int k = 0; k < MEMBERS; k++) systems[k] = made[k / 4 % 2];
  spread(N, hanging, swing, 0.3);
  const dvi_ensemble_options options = {.members = MEMBERS, .systems = systems, .threads = 2};
  ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet", &options, &e), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start_velocity(e, 0, q, v), DVI_OK);
  for (int i = 0; i < 10; i++) ck_assert_int_eq(dvi_ensemble_step(e, 0.01), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) same_as_alone(e, systems[k], "verlet", k, 0.01, 10, sum);
  dvi_ensemble_destroy(&e);
  for (int s = 0; s < 2; s++) dvi_system_destroy(&made[s]);
}
END_TEST

static int is_side_by_side(const dvi_system *system, const char *method)
{
  dvi_ensemble *e = create_ensemble(system, method, (dvi_ensemble_options){.members = 16});
  const int found = goes_side_by_side(e);
  dvi_ensemble_destroy(&e);
  return found;
}

START_TEST(explain_says_which_way_is_taken)
{
  static const double coupled[N * N] = {2, 0, 1, 0, 0, 2, 0, 1, 1, 0, 2, 0, 0, 1, 0, 2},
                                  negative[N] = {1, 1, -3, -3};
  rods own = {.retry_above = 9, .weight = {9.8, 29.4}};
  dvi_system *diagonal = create_rods(&own, (dvi_mass){.diagonal = masses}, 2),
             *full = create_rods(&own, (dvi_mass){.values = coupled}, 2),
             *indefinite = create_rods(&own, (dvi_mass){.diagonal = negative}, 2);
  ck_assert(is_side_by_side(diagonal, "verlet"));
  ck_assert(is_side_by_side(diagonal, "composition:base=verlet"));
  ck_assert(!is_side_by_side(full, "verlet"));
  ck_assert(!is_side_by_side(indefinite, "verlet"));
  dvi_system_destroy(&diagonal);
  dvi_system_destroy(&full);
  dvi_system_destroy(&indefinite);
}
END_TEST

SUITE(ensemble_constrained)
{
  tcase_add_loop_test(tests, members_have_the_bits_and_the_counts_of_runs_alone, 0, 6);
  tcase_add_loop_test(tests, constraints_that_depend_on_time_have_their_rates, 0, 6);
  tcase_add_loop_test(tests, members_that_renew_their_matrices_are_stepped_alone, 0, 2);
  tcase_add_loop_test(tests, a_member_that_fails_stays_and_the_others_go_on, 0, 6);
  tcase_add_test(tests, members_share_calls);
  tcase_add_test(tests, nodes_of_an_element_share_calls);
  tcase_add_test(tests, constraints_in_both_shapes_are_refused);
  tcase_add_test(tests, members_with_dependent_rows_are_stepped_alone);
  tcase_add_test(tests, members_with_systems_of_their_own_have_their_constraints);
  tcase_add_test(tests, explain_says_which_way_is_taken);
}
