/* labels: unit order */
/* Hits of contacts are met at their times, to the order of the method, and reflect the momentum. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/walls.h"

static dvi_integrator *start_at(const dvi_system *system, const char *method, const double *q,
                                const double *v)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  return integrator;
}

/* ---- times ---- */

/* The hits of the pendulum, from quadratures of the energy integral. */
static const double first_hit = 1.26001542743043, between_hits = 5.03214151311856;

static double error_of_pendulum(const dvi_system *system, const char *method, double h)
{
  const double q = -0.5, v = 1;
  double error = 0;
  int hits = 0;
  dvi_integrator *integrator = start_at(system, method, &q, &v);
  for (long i = 0; i < lround(12 / h); i++) {
    advance(integrator, h, 1);
    for (int k = 0; k < dvi_integrator_hit_count(integrator); k++, hits++) {
      const dvi_hit hit = dvi_integrator_hit(integrator, k);
      error = fmax(error, fabs(hit.t - first_hit - hits * between_hits));
      ck_assert_double_eq_tol(hit.after, -hit.before, 1e-15);
    }
  }
  ck_assert_int_eq(hits, 3);
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.hits, 3);
  ck_assert_int_eq(counters.steps, lround(12 / h));
  dvi_integrator_destroy(&integrator);
  return error;
}

/* Times of degree 3 reach 1e-13, the digits that are known. */
START_TEST(times_of_hits_have_the_order_of_the_method)
{
  static const struct {
    const char *method;
    double order, h;
  } cases[] = {{"verlet", 2, 0.1},
               {"midpoint", 2, 0.1},
               {"trapezoidal", 2, 0.1},
               {"galerkin:degree=2", 4, 0.2},
               {"galerkin:degree=2,quadrature=lobatto,nodes=3", 4, 0.2},
               {"composition:order=4,base=verlet", 4, 0.2},
               {"galerkin:degree=3", 6, 0.4}};
  dvi_system *system = create_walls(WALLS_PENDULUM, 1);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    double h = cases[c].h, error = error_of_pendulum(system, cases[c].method, h);
    for (int level = 0; level < 3; level++) {
      const double finer = error_of_pendulum(system, cases[c].method, h /= 2);
      ck_assert_double_eq_tol(log2(error / finer), cases[c].order, 0.15);
      error = finer;
    }
  }
  dvi_system_destroy(&system);
}
END_TEST

static const double circle_hits[] = {.385326443040231, .693820155359945, 1.56989697353817,
                                     1.78736655607934};

/* Between hits the ball follows a parabola, on which all these methods are exact. */
START_TEST(a_ball_in_a_circle_hits_it_at_the_known_times)
{
  static const char *const methods[] = {"verlet", "midpoint", "trapezoidal", "galerkin:degree=3"};
  const double q[] = {.2, .1}, v[] = {1.5, 0};
  dvi_system *system = create_walls(WALLS_CIRCLE, 1);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator = start_at(system, methods[m], q, v);
    int hits = 0;
    for (int i = 0; i < 19; i++) {
      advance(integrator, 0.1, 1);
      for (int k = 0; k < dvi_integrator_hit_count(integrator); k++)
        ck_assert_double_eq_tol(dvi_integrator_hit(integrator, k).t, circle_hits[hits++], 2e-14);
    }
    ck_assert_int_eq(hits, 4);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* In polar coordinates the mass depends on q, and the impulse is found by iteration. */
START_TEST(a_general_lagrangian_hits_at_the_same_times)
{
  const double r = hypot(.2, .1), q[] = {r, atan2(.1, .2)},
               v[] = {1.5 * .2 / r, -1.5 * .1 / (r * r)};
  dvi_system *system = create_walls(WALLS_POLAR, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=6", q, v);
  int hits = 0;
  for (int i = 0; i < 76; i++) {
    advance(integrator, 0.025, 1);
    for (int k = 0; k < dvi_integrator_hit_count(integrator); k++)
      ck_assert_double_eq_tol(dvi_integrator_hit(integrator, k).t, circle_hits[hits++], 1e-9);
  }
  ck_assert_int_eq(hits, 4);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_step_back_undoes_a_step_with_hits)
{
  const double q[] = {.2, .1}, v[] = {1.5, 0};
  dvi_system *system = create_walls(WALLS_CIRCLE, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", q, v);
  advance(integrator, 0.1, 19);
  advance(integrator, -0.1, 19);
  /* the motion is unstable, by a factor of about 1e3 over four hits */
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator), q), 1e-11);
  ck_assert_double_le(distance(2, dvi_integrator_p(integrator), v), 1e-11);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- several hits in a step ---- */

/* A free particle between walls: its place is that of a triangle wave. */
static double triangle(double x)
{
  const double turn = fabs(x) - 2 * floor(fabs(x) / 2);
  return turn <= 1 ? turn : 2 - turn;
}

START_TEST(hits_within_one_step_follow_each_other)
{
  static const char *const methods[] = {"verlet", "galerkin:degree=3", "midpoint"};
  const double q = 0.25, v = 1;
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_system *system = create_walls(WALLS_CHANNEL, 1);
    dvi_integrator *integrator = start_at(system, methods[m], &q, &v);
    advance(integrator, 5.5, 1);
    ck_assert_int_eq(dvi_integrator_hit_count(integrator), 5);
    ck_assert_double_eq(dvi_integrator_last_step(integrator), 5.5);
    for (int k = 0; k < 5; k++) {
      const dvi_hit hit = dvi_integrator_hit(integrator, k);
      ck_assert_double_eq_tol(hit.t, 0.75 + k, 1e-14);
      ck_assert_int_eq(hit.contact, 1 - k % 2);
    }
    ck_assert_int_eq(dvi_integrator_hit(integrator, 5).contact, -1);
    for (int k = 0; k <= 110; k++) {
      double x;
      ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.05 * k, &x, NULL), DVI_OK);
      ck_assert_double_eq_tol(x, triangle(0.25 + 0.05 * k), 1e-13);
    }
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* The ball falls to the floor, is thrown up, and is back above its start at the step's end. */
START_TEST(a_gap_that_closes_and_opens_within_a_step_is_found)
{
  static const char *const methods[] = {"verlet", "midpoint", "galerkin:degree=4"};
  const double q[] = {0, 1 + 0.05}, v[] = {1, 0}, slow[] = {-1.9, 0.9999};
  dvi_system *system = create_walls(WALLS_STONE, 1);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    const double from[] = {-2, 0.9}, along[] = {1, 0};
    dvi_integrator *integrator = start_at(system, methods[m], from, along);
    advance(integrator, 4, 1);
    ck_assert_int_eq(dvi_integrator_hit_count(integrator), 1);
    ck_assert_double_eq_tol(dvi_integrator_hit(integrator, 0).t, 2 - sqrt(1 - 0.81), 1e-14);
    /* the chord of the hit stays in its place for a particle that passes by */
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
    advance(integrator, 4, 1);
    ck_assert_int_eq(dvi_integrator_hit_count(integrator), 0);
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, slow, v), DVI_OK);
    advance(integrator, 4, 1);
    ck_assert_int_eq(dvi_integrator_hit_count(integrator), 1);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_gap_that_is_only_touched_changes_nothing)
{
  const double q[] = {-2, 1}, v[] = {1, 0};
  dvi_system *system = create_walls(WALLS_STONE, 1);
  for (int parts = 1; parts <= 9; parts++) {
    dvi_integrator *integrator = start_at(system, "galerkin:degree=3", q, v);
    advance(integrator, 4.0 / parts, parts);
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], 2, 1e-13);
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], 1, 1e-13);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(contacts_that_do_not_push_each_other_may_close_together)
{
  const double q[] = {1, 1}, v[] = {-1, -1};
  dvi_system *system = create_walls(WALLS_CORNER, 0.5);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=2", q, v);
  advance(integrator, 2, 1);
  ck_assert_int_eq(dvi_integrator_hit_count(integrator), 2);
  for (int i = 0; i < 2; i++) ck_assert_double_eq_tol(dvi_integrator_q(integrator)[i], 0.5, 1e-14);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- impulses ---- */

START_TEST(a_wall_that_moves_gives_its_speed)
{
  const double q = 1, v = -1;
  for (int elastic = 0; elastic <= 1; elastic++) {
    const double e = elastic ? 1 : 0.6;
    dvi_system *system = create_walls(WALLS_MOVING, e);
    dvi_integrator *integrator = start_at(system, "verlet", &q, &v);
    advance(integrator, 1, 1);
    ck_assert_double_eq_tol(dvi_integrator_hit(integrator, 0).t, 1 / 1.5, 1e-15);
    ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], 0.5 + e * 1.5, 1e-14);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
}
END_TEST

START_TEST(an_energy_of_higher_degree_is_kept_too)
{
  const double q = 0.5, v = 0.9;
  for (int elastic = 0; elastic <= 1; elastic++) {
    dvi_system *system = create_walls(WALLS_FAST, elastic ? 1 : 0.5);
    dvi_integrator *integrator = start_at(system, "galerkin:degree=2", &q, &v);
    advance(integrator, 0.4, 2);
    const dvi_hit hit = dvi_integrator_hit(integrator, 0);
    ck_assert_double_eq_tol(hit.before, -0.9, 1e-13);
    ck_assert_double_eq_tol(hit.after, elastic ? 0.9 : 0.45, 1e-13);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* The energy's own error of degree 3 is 1e-11 there. Without the reflection's law it would walk. */
START_TEST(energy_is_kept_by_elastic_hits_over_a_long_run)
{
  const double q = -0.5, v = 1, x[] = {.2, .1}, w[] = {1.5, 0};
  double before, after, worst = 0;
  dvi_system *system = create_walls(WALLS_PENDULUM, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", &q, &v);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &before), DVI_OK);
  for (int i = 0; i < repeats(20000); i++) {
    advance(integrator, 0.1, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &after), DVI_OK);
    worst = fmax(worst, fabs(after - before));
  }
  ck_assert_double_le(worst, 2e-9);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  system = create_walls(WALLS_CIRCLE, 1);
  integrator = start_at(system, "verlet", x, w);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &before), DVI_OK);
  advance(integrator, 0.1, repeats(10000));
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &after), DVI_OK);
  /* 2e3 hits, each with some roundings of an energy of 10 */
  ck_assert_double_eq_tol(after, before, 2e-11);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* The energy that hits take is supplied, and the balance stays. */
START_TEST(balances_count_the_impulses)
{
  const double q = 1, none = 0;
  dvi_system *system = create_walls(WALLS_DROP, 0.8);
  const dvi_integrator_options options = {
      .size = sizeof options, .method = "galerkin:degree=2", .balances = 1};
  dvi_integrator *integrator;
  double defect;
  ck_assert_int_eq(dvi_integrator_create_with(system, &options, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &none), DVI_OK);
  advance(integrator, 0.1, 10);
  ck_assert_double_eq_tol(dvi_integrator_supplied(integrator, 0), 9.81 * (0.64 - 1), 1e-14);
  ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &defect), DVI_OK);
  ck_assert_double_le(fabs(defect), 1e-14);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- where it ends ---- */

/* Take steps of h until one fails with this status, which must leave the state. */
static void run_into(dvi_integrator *integrator, double h, dvi_status wanted)
{
  dvi_status status = DVI_OK;
  double t = 0, q[2] = {0}, p[2] = {0};
  const size_t bytes = (size_t)dvi_system_nq(dvi_integrator_system(integrator)) * sizeof *q;
  for (int i = 0; i < 1000 && status == DVI_OK; i++) {
    t = dvi_integrator_time(integrator);
    memcpy(q, dvi_integrator_q(integrator), bytes);
    memcpy(p, dvi_integrator_p(integrator), bytes);
    status = dvi_integrator_step(integrator, h);
  }
  ck_assert_int_eq(status, wanted);
  ck_assert_double_eq(dvi_integrator_time(integrator), t);
  ck_assert_int_eq(memcmp(dvi_integrator_q(integrator), q, bytes), 0);
  ck_assert_int_eq(memcmp(dvi_integrator_p(integrator), p, bytes), 0);
}

START_TEST(hits_that_accumulate_are_named_with_their_time)
{
  static const char *const methods[] = {"verlet", "midpoint", "galerkin:degree=3"};
  const double q = 1, none = 0;
  dvi_system *system = create_walls(WALLS_DROP, 0.8);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator = start_at(system, methods[m], &q, &none);
    run_into(integrator, 0.05, DVI_UNSUPPORTED);
    check_words("contact 'first' accumulate");
    check_words("moreau-jean");
    const char *time = strstr(dvi_last_error(), "at about t = ");
    ck_assert_ptr_nonnull(time);
    ck_assert_double_eq_tol(strtod(time + strlen("at about t = "), NULL), 4.06371276887158, 2e-14);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(the_times_before_are_those_of_a_geometric_series)
{
  const double q = 1, none = 0;
  double expected = sqrt(2 / 9.81), apart = 2 * expected;
  int hits = 0;
  dvi_system *system = create_walls(WALLS_DROP, 0.8);
  dvi_integrator *integrator = start_at(system, "verlet", &q, &none);
  for (int i = 0; i < 80; i++) {
    advance(integrator, 0.05, 1);
    for (int k = 0; k < dvi_integrator_hit_count(integrator); k++, hits++) {
      ck_assert_double_eq_tol(dvi_integrator_hit(integrator, k).t, expected, 2e-14);
      apart *= 0.8;
      expected += apart;
    }
  }
  ck_assert_int_ge(hits, 18);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_contact_that_stays_closed_is_refused)
{
  const double none = 0, up = 1;
  dvi_system *system = create_walls(WALLS_DROP, 1);
  dvi_integrator *integrator = start_at(system, "verlet", &none, &none);
  run_into(integrator, 0.1, DVI_UNSUPPORTED);
  check_words("contact 'first' stays closed");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  system = create_walls(WALLS_DROP, 0);
  integrator = start_at(system, "verlet", &up, &none);
  run_into(integrator, 0.1, DVI_UNSUPPORTED);
  check_words("contact 'first'");
  check_words("stays closed");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_corner_is_refused)
{
  const double q[] = {2, 1}, v[] = {-2, -1};
  dvi_system *system = create_walls(WALLS_WEDGE, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=2", q, v);
  run_into(integrator, 0.15, DVI_UNSUPPORTED);
  check_words("'first'");
  check_words("'second'");
  check_words("corner");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_loss_cannot_be_undone)
{
  const double q = 1, none = 0;
  dvi_system *system = create_walls(WALLS_DROP, 0.8);
  dvi_integrator *integrator = start_at(system, "verlet", &q, &none);
  advance(integrator, 0.1, 6);
  run_into(integrator, -0.1, DVI_UNSUPPORTED);
  check_words("cannot be undone");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_start_inside_is_refused_by_name)
{
  const double inside = -0.125, none = 0, q = 0.5;
  double gap;
  int contact;
  dvi_system *system = create_walls(WALLS_CHANNEL, 1);
  dvi_integrator *integrator = start_at(system, "verlet", &q, &none);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &inside, &none), DVI_BAD_ARGUMENT);
  check_words("contact 'first' is -0.125 at the start");
  ck_assert_double_eq(*dvi_integrator_q(integrator), 0.5);
  ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, &contact), DVI_OK);
  ck_assert_double_eq(gap, 0.5);
  ck_assert_int_eq(contact, 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- with the driver ---- */

START_TEST(a_restored_run_has_the_same_bits)
{
  const double q[] = {.2, .1}, v[] = {1.5, 0};
  static char bytes[8192];
  size_t size;
  dvi_system *system = create_walls(WALLS_CIRCLE, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", q, v),
                 *other = create_integrator(system, "galerkin:degree=3");
  advance(integrator, 0.1, 4);
  ck_assert_int_eq(dvi_integrator_hit_count(integrator), 1);
  ck_assert_int_eq(dvi_integrator_save_memory(integrator, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_hit_count(other), 0);
  advance(integrator, 0.1, 15);
  advance(other, 0.1, 15);
  ck_assert_int_eq(memcmp(dvi_integrator_q(integrator), dvi_integrator_q(other), sizeof q), 0);
  ck_assert_int_eq(memcmp(dvi_integrator_p(integrator), dvi_integrator_p(other), sizeof q), 0);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&other);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(steps_with_hits_take_no_memory)
{
  const double q[] = {.2, .1}, v[] = {1.5, 0};
  dvi_counters before, after;
  dvi_system *system = create_walls(WALLS_CIRCLE, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", q, v);
  advance(integrator, 0.1, 10);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 0.1, 100);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.allocations, before.allocations);
  ck_assert_int_gt(after.hits, before.hits + 10);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

static int at_threshold(double t, const double *q, const double *v, double *value, void *user)
{
  (void)t, (void)v, (void)user;
  *value = q[0] - 0.4;
  return 0;
}

/* The particle passes 0.4 at 0.15, and then, after the hit at 0.75, at 1.35, both in one step. */
START_TEST(an_event_behind_a_hit_ends_the_run_at_its_time)
{
  const double q = 0.25, v = 1;
  const dvi_event event = {.value = at_threshold, .direction = -1, .terminal = 1};
  const dvi_run_options options = {.h = 1.4, .t_end = 4, .events = &event, .event_count = 1};
  dvi_run_report report;
  dvi_system *system = create_walls(WALLS_CHANNEL, 1);
  dvi_integrator *integrator = start_at(system, "verlet", &q, &v);
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_EVENT);
  ck_assert_double_eq_tol(report.event_time, 1.35, 1e-12);
  ck_assert_double_eq_tol(*dvi_integrator_q(integrator), 0.4, 1e-12);
  ck_assert_double_eq_tol(*dvi_integrator_p(integrator), -1, 1e-15);
  ck_assert_int_eq(report.steps, 1);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- callbacks and memory that fail ---- */

START_TEST(creation_without_memory_says_so)
{
  static const char *const methods[] = {"verlet", "galerkin", "moreau-jean"};
  dvi_system *system = create_walls(WALLS_DROP, 1);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_status status = DVI_NO_MEMORY;
    for (int k = 0; status != DVI_OK; k++) {
      dvi_integrator *integrator;
      dvi__fail_allocations_after(k);
      status = dvi_integrator_create(system, methods[m], &integrator);
      dvi__fail_allocations_after(-1);
      ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
      dvi_integrator_destroy(&integrator);
      ck_assert_int_lt(k, 500);
    }
  }
  dvi_system_destroy(&system);
}
END_TEST

static double bad_answer;

static int failing_gap(double t, const double *q, double *phi, void *user)
{
  (void)user;
  *phi = t > 0.35 && isnan(bad_answer) ? bad_answer : q[0];
  return t > 0.35 && !isnan(bad_answer) ? (int)bad_answer : 0;
}

static int unit_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)q, (void)user;
  phi_q[0] = 1;
  return 0;
}

START_TEST(a_gap_that_fails_leaves_the_state)
{
  static const struct {
    double answer;
    dvi_status status;
  } cases[] = {{(double)NAN, DVI_NOT_FINITE}, {-3, DVI_CALLBACK_FAILED}, {2, DVI_CALLBACK_RETRY}};
  const dvi_contact contact = {.name = "wall", .gap = failing_gap, .gradient = unit_gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .contacts = &contact, .contact_count = 1};
  const double q = 1, v = 1;
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    bad_answer = cases[c].answer;
    dvi_integrator *integrator = start_at(system, "galerkin:degree=2", &q, &v);
    run_into(integrator, 0.1, cases[c].status);
    check_words("wall");
    ck_assert_double_eq_tol(dvi_integrator_time(integrator), 0.3, 1e-15);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

SUITE(contacts)
{
  tcase_add_test(tests, times_of_hits_have_the_order_of_the_method);
  tcase_add_test(tests, a_ball_in_a_circle_hits_it_at_the_known_times);
  tcase_add_test(tests, a_general_lagrangian_hits_at_the_same_times);
  tcase_add_test(tests, a_step_back_undoes_a_step_with_hits);
  tcase_add_test(tests, hits_within_one_step_follow_each_other);
  tcase_add_test(tests, a_gap_that_closes_and_opens_within_a_step_is_found);
  tcase_add_test(tests, a_gap_that_is_only_touched_changes_nothing);
  tcase_add_test(tests, contacts_that_do_not_push_each_other_may_close_together);
  tcase_add_test(tests, a_wall_that_moves_gives_its_speed);
  tcase_add_test(tests, an_energy_of_higher_degree_is_kept_too);
  tcase_add_test(tests, energy_is_kept_by_elastic_hits_over_a_long_run);
  tcase_add_test(tests, balances_count_the_impulses);
  tcase_add_test(tests, hits_that_accumulate_are_named_with_their_time);
  tcase_add_test(tests, the_times_before_are_those_of_a_geometric_series);
  tcase_add_test(tests, a_contact_that_stays_closed_is_refused);
  tcase_add_test(tests, a_corner_is_refused);
  tcase_add_test(tests, a_loss_cannot_be_undone);
  tcase_add_test(tests, a_start_inside_is_refused_by_name);
  tcase_add_test(tests, a_restored_run_has_the_same_bits);
  tcase_add_test(tests, steps_with_hits_take_no_memory);
  tcase_add_test(tests, an_event_behind_a_hit_ends_the_run_at_its_time);
  tcase_add_test(tests, creation_without_memory_says_so);
  tcase_add_test(tests, a_gap_that_fails_leaves_the_state);
}
