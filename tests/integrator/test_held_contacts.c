/* labels: unit order */
/* Contacts whose hits accumulate, or that stay closed, are held as constraints, and released where
 * their force vanishes. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/walls.h"

static const double g = 9.81;

static dvi_integrator *start_at(const dvi_system *system, const char *method, const double *q,
                                const double *v)
{
  const dvi_integrator_options options = {.size = sizeof options, .method = method, .balances = 1};
  dvi_integrator *integrator;
  ck_assert_msg(dvi_integrator_create_with(system, &options, &integrator) == DVI_OK, "%s: %s",
                method, dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  return integrator;
}

/* Take steps until something of this kind happens to a contact. */
static dvi_hit wait_for(dvi_integrator *integrator, double h, dvi_hit_kind kind)
{
  for (int i = 0; i < 2000; i++) {
    advance(integrator, h, 1);
    for (int k = 0; k < dvi_integrator_hit_count(integrator); k++)
      if (dvi_integrator_hit(integrator, k).kind == kind) return dvi_integrator_hit(integrator, k);
  }
  ck_abort_msg("nothing happened");
  return (dvi_hit){.contact = -1};
}

static double force_of(dvi_integrator *integrator, int contact)
{
  double force;
  ck_assert_int_eq(dvi_integrator_contact_force(integrator, contact, &force), DVI_OK);
  return force;
}

/* The slope of the logarithms of errors [4] at steps that shrink by a ratio. */
static double slope_of(const double error[4], double ratio)
{
  return (3 * log(error[0] / error[3]) + log(error[1] / error[2])) / (10 * log(ratio));
}

/* The steps of rests and of releases, and the ratio of the former. */
static const struct held_case {
  const char *method;
  double order, rest_h, ratio, h;
} cases[] = {{"verlet", 2, 0.12, 2, 0.1},
             {"midpoint", 2, 0.12, 2, 0.1},
             {"trapezoidal", 2, 0.12, 2, 0.1},
             {"galerkin:degree=1", 2, 0.12, 2, 0.1},
             {"galerkin:degree=2", 4, 0.24, 2, 0.1},
             {"galerkin:degree=2,quadrature=lobatto,nodes=3", 4, 0.24, 2, 0.1},
             {"composition:order=4,base=verlet", 4, 0.24, 2, 0.1},
             {"galerkin:degree=3", 6, 0.48, 1.4, 0.8 / 3}};
enum { CASES = sizeof cases / sizeof *cases };

/* ---- a ball comes to rest ---- */

static const double rest_at = 4.06371276887158;

START_TEST(a_ball_rests_from_the_limit_of_its_hits_on)
{
  const double q = 1, none = 0;
  dvi_system *system = create_holding_walls(WALLS_DROP, 0.8);
  for (int c = 0; c < CASES; c++) {
    dvi_integrator *integrator = start_at(system, cases[c].method, &q, &none);
    double gap, defect;
    const dvi_hit hold = wait_for(integrator, 0.05, DVI_HOLD);
    ck_assert_double_eq_tol(hold.t, rest_at, 2e-14);
    ck_assert_double_eq(hold.after, 0);
    ck_assert_int_eq(dvi_integrator_held(integrator), 0);
    advance(integrator, 0.05, 100);
    ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, NULL), DVI_OK);
    ck_assert_double_le(fabs(gap), 1e-17);
    ck_assert_double_le(fabs(*dvi_integrator_p(integrator)), 1e-17);
    ck_assert_double_eq_tol(force_of(integrator, 0), g, 1e-12);
    /* all of the energy is lost at hits, the last 1e-18 of it at the hold */
    ck_assert_double_eq_tol(dvi_integrator_supplied(integrator, 0), -g, 2e-14);
    ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &defect), DVI_OK);
    ck_assert_double_le(fabs(defect), 2e-14);
    dvi_counters counters;
    dvi_integrator_counters(integrator, &counters);
    ck_assert_int_eq(counters.hits, 96);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* Hits of a restitution near 1 need much room in one step. */
START_TEST(hits_accumulate_with_restitutions_from_0_to_nearly_1)
{
  static const double e[] = {0, 0.01, 0.5, 0.9, 0.97};
  const double q = 1, none = 0, fall = sqrt(2 / g);
  for (size_t i = 0; i < sizeof e / sizeof *e; i++) {
    dvi_system *system = create_holding_walls(WALLS_DROP, e[i]);
    dvi_integrator *integrator = start_at(system, "galerkin:degree=2", &q, &none);
    const dvi_hit hold = wait_for(integrator, 0.1, DVI_HOLD);
    ck_assert_double_eq_tol(hold.t, fall * (1 + 2 * e[i] / (1 - e[i])), 3e-14 * hold.t);
    advance(integrator, 0.1, 10);
    ck_assert_double_eq_tol(force_of(integrator, 0), g, 1e-12);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
}
END_TEST

START_TEST(a_contact_that_is_closed_at_the_start_is_held)
{
  const double none = 0;
  dvi_system *system = create_holding_walls(WALLS_DROP, 1);
  for (int c = 0; c < CASES; c++) {
    dvi_integrator *integrator = start_at(system, cases[c].method, &none, &none);
    ck_assert_int_eq(dvi_integrator_held(integrator), -1);
    ck_assert_double_eq(force_of(integrator, 0), 0);
    advance(integrator, 0.1, 100);
    ck_assert_int_eq(dvi_integrator_held(integrator), 0);
    ck_assert_double_eq_tol(*dvi_integrator_q(integrator), 0, 1e-17);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- a pendulum against a wall ---- */

/* Integrate over 0 to 1 by Gauss's rule of three points on 400 parts. */
static long double integral(long double (*f)(long double s, long double of), long double of)
{
  enum { PARTS = 400 };
  const long double apart = sqrtl(0.6L) / 2;
  long double sum = 0;
  for (int i = 0; i < PARTS; i++)
    sum += (5 * f((i + 0.5L - apart) / PARTS, of) + 8 * f((i + 0.5L) / PARTS, of) +
            5 * f((i + 0.5L + apart) / PARTS, of)) /
           (18 * (long double)PARTS);
  return sum;
}

static const long double wall = 0.3L;

/* dt/ds of the fall from x = wall + rise to the wall, with x = wall + rise (1 - s^2). */
static long double fall_of_pendulum(long double s, long double rise)
{
  const long double part = rise * s * s,
                    squared = 4 * sinl(wall + rise - part / 2) * sinl(part / 2);
  return 2 * rise * s / sqrtl(squared);
}

/* The height at which the pendulum has the energy sin(wall) rise + .. above that of the wall. */
static long double rise_of(long double energy)
{
  const long double slope = sinl(wall);
  long double rise = 2 * energy / (slope + sqrtl(slope * slope + 2 * cosl(wall) * energy));
  for (int i = 0; i < 20; i++)
    rise -= (2 * sinl(wall + rise / 2) * sinl(rise / 2) - energy) / sinl(wall + rise);
  return rise;
}

/* The time at which the hits of a pendulum accumulate, which is let go at 1.2 rad. */
static double pendulum_rests_at(long double e)
{
  long double t = integral(fall_of_pendulum, 1.2L - wall), energy = cosl(wall) - cosl(1.2L);
  for (energy *= e * e; energy > 1e-36L; energy *= e * e)
    t += 2 * integral(fall_of_pendulum, rise_of(energy));
  return (double)t;
}

START_TEST(the_time_of_rest_has_the_order_of_the_method)
{
  const double q = 1.2, none = 0, exact = pendulum_rests_at(0.6L);
  dvi_system *system = create_holding_walls(WALLS_PRESSED, 0.6);
  for (int c = 0; c < CASES; c++) {
    double error[4], h = cases[c].rest_h;
    for (int level = 0; level < 4; level++, h /= cases[c].ratio) {
      dvi_integrator *integrator = start_at(system, cases[c].method, &q, &none);
      error[level] = fabs(wait_for(integrator, h, DVI_HOLD).t - exact);
      advance(integrator, h, 10);
      ck_assert_double_eq_tol(force_of(integrator, 0), sin(0.3), 1e-10);
      ck_assert_double_eq_tol(*dvi_integrator_q(integrator), 0.3, 1e-16);
      dvi_integrator_destroy(&integrator);
    }
    ck_assert_msg(fabs(slope_of(error, cases[c].ratio) - cases[c].order) < 0.3,
                  "%s: %g of %g %g %g %g", cases[c].method, slope_of(error, cases[c].ratio),
                  error[0], error[1], error[2], error[3]);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- a ball leaves a hill ---- */

/* dt/ds of the slide from the top of the unit circle, at the speed 1, to the angle `end`. */
static long double slide(long double s, long double end)
{
  return end / sqrtl(1 + 2 * 9.81L * (1 - cosl(end * s)));
}

/* The angle from the top at which gravity no longer presses, (v^2/g + 2)/3 = cos(angle). */
static long double end_of_slide(void)
{
  return acosl((1 / 9.81L + 2) / 3);
}

/* The parabola from there to 0.8. */
static void fly_on(double place[2])
{
  const long double a = end_of_slide(), v = sqrtl(9.81L * cosl(a)), t = 0.8L - integral(slide, a);
  place[0] = (double)(sinl(a) + v * cosl(a) * t);
  place[1] = (double)(cosl(a) - v * sinl(a) * t - 9.81L / 2 * t * t);
}

static void check_hill(walls_place where, const struct held_case *c, const double *q,
                       const double *v)
{
  const double exact = (double)integral(slide, end_of_slide());
  double late[4], off[4], flown[2], h = c->h;
  dvi_system *system = create_holding_walls(where, 0.5);
  fly_on(flown);
  for (int level = 0; level < 4; level++, h /= 2) {
    dvi_integrator *integrator = start_at(system, c->method, q, v);
    const dvi_hit release = wait_for(integrator, h, DVI_RELEASE);
    late[level] = fabs(release.t - exact);
    ck_assert_int_eq(dvi_integrator_held(integrator), -1);
    advance(integrator, h, lround((0.8 - dvi_integrator_time(integrator)) / h));
    const double *at = dvi_integrator_q(integrator),
                 place[] = {where == WALLS_ROUND ? at[0] * cos(at[1]) : at[0],
                            where == WALLS_ROUND ? at[0] * sin(at[1]) : at[1]};
    off[level] = distance(2, place, flown);
    dvi_integrator_destroy(&integrator);
  }
  ck_assert_msg(fabs(slope_of(late, 2) - c->order) < 0.3, "%s: %g of %g %g %g %g", c->method,
                slope_of(late, 2), late[0], late[1], late[2], late[3]);
  ck_assert_msg(fabs(slope_of(off, 2) - c->order) < 0.3, "%s: place, %g of %g %g %g %g", c->method,
                slope_of(off, 2), off[0], off[1], off[2], off[3]);
  dvi_system_destroy(&system);
}

START_TEST(the_time_of_a_release_has_the_order_of_the_method)
{
  const double q[] = {0, 1}, v[] = {1, 0};
  for (int c = 0; c < CASES; c++) check_hill(WALLS_HILL, &cases[c], q, v);
}
END_TEST

START_TEST(a_general_lagrangian_is_released_at_the_same_time)
{
  const double q[] = {1, acos(0)}, v[] = {0, -1};
  static const struct held_case polar[] = {{"midpoint", 2, 0, 0, 0.05},
                                           {"galerkin:degree=2", 4, 0, 0, 0.1},
                                           {"galerkin:degree=3", 6, 0, 0, 0.1}};
  for (int c = 0; c < 3; c++) check_hill(WALLS_ROUND, &polar[c], q, v);
}
END_TEST

/* The slide is on the hill all the time, and its energy is that of the method without contacts. */
START_TEST(a_contact_that_is_held_stays_closed)
{
  const double q[] = {0, 1}, v[] = {1, 0};
  dvi_system *system = create_holding_walls(WALLS_HILL, 0.5);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", q, v);
  for (int i = 0; i < 10; i++) {
    double gap, defect, force = force_of(integrator, 0), there[2];
    advance(integrator, 0.05, 1);
    ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, NULL), DVI_OK);
    ck_assert_double_le(fabs(gap), 4 * DBL_EPSILON);
    ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &defect), DVI_OK);
    ck_assert_double_le(fabs(defect), 1e-8);
    ck_assert_double_ge(force, 0);
    /* the gap is |q|^2 - 1, and its gradient 2 q */
    const double *at = dvi_integrator_q(integrator), *p = dvi_integrator_p(integrator);
    ck_assert_double_eq_tol(force_of(integrator, 0), (g * at[1] - p[0] * p[0] - p[1] * p[1]) / 2,
                            1e-9);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.05 * i + 0.03, there, NULL), DVI_OK);
    ck_assert_double_eq_tol(hypot(there[0], there[1]), 1, 1e-6);
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- floors that move, and other contacts ---- */

START_TEST(a_ball_on_a_lift_follows_it)
{
  const double q = 0.3, none = 0;
  dvi_system *system = create_holding_walls(WALLS_LIFT, 0.6);
  for (int c = 0; c < CASES; c++) {
    dvi_integrator *integrator = start_at(system, cases[c].method, &q, &none);
    wait_for(integrator, 0.1, DVI_HOLD);
    advance(integrator, 0.1, 100);
    const double t = dvi_integrator_time(integrator);
    ck_assert_double_eq_tol(*dvi_integrator_q(integrator), sin(t), 4e-15);
    ck_assert_double_eq_tol(*dvi_integrator_p(integrator), cos(t), 4e-15);
    ck_assert_double_eq_tol(force_of(integrator, 0), g - sin(t), 1e-8);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_ball_that_is_held_hits_a_wall_and_stays_held)
{
  const double q[] = {-1, 0.5}, v[] = {1, 0};
  dvi_system *system = create_holding_walls(WALLS_TABLE, 0.6);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=2", q, v);
  wait_for(integrator, 0.1, DVI_HOLD);
  const dvi_hit hit = wait_for(integrator, 0.1, DVI_HIT);
  ck_assert_int_eq(hit.contact, 1);
  ck_assert_double_eq_tol(hit.t, 2, 4e-15);
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], -0.6, 4e-15);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[1], 0, 1e-17);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* The wall's impulse has an upward part, which the floor does not answer. */
START_TEST(a_wall_that_lifts_a_ball_releases_it)
{
  const double q[] = {0, 0}, v[] = {1, 0};
  dvi_system *system = create_holding_walls(WALLS_RAMP, 1);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=2", q, v);
  const dvi_hit release = wait_for(integrator, 0.15, DVI_RELEASE);
  ck_assert_double_eq_tol(release.t, 1, 4e-15);
  ck_assert_double_eq_tol(release.after, 0.8, 4e-15);
  ck_assert_int_eq(dvi_integrator_hit(integrator, 0).contact, 1);
  ck_assert_int_eq(dvi_integrator_held(integrator), -1);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- what is refused ---- */

/* Take steps until one fails, which must leave the state and what is held. */
static void run_into_refusal(dvi_integrator *integrator, double h)
{
  dvi_status status = DVI_OK;
  double p[2] = {0};
  int held = -1;
  for (int i = 0; i < 1000 && status == DVI_OK; i++) {
    held = dvi_integrator_held(integrator);
    memcpy(p, dvi_integrator_p(integrator),
           (size_t)dvi_system_nq(dvi_integrator_system(integrator)) * sizeof *p);
    status = dvi_integrator_step(integrator, h);
  }
  ck_assert_int_eq(status, DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_integrator_held(integrator), held);
  ck_assert_double_eq(p[0], dvi_integrator_p(integrator)[0]);
}

START_TEST(a_wall_that_presses_a_ball_is_a_corner)
{
  const double q[] = {-1, 0.5}, v[] = {1, 0};
  dvi_system *system = create_holding_walls(WALLS_SLOPE, 0.6);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=2", q, v);
  run_into_refusal(integrator, 0.1);
  check_words("'first'");
  check_words("'second'");
  check_words("corner");
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_second_contact_that_would_be_held_is_refused)
{
  const double q[] = {0.5, 0}, v[] = {0, 0};
  dvi_system *system = create_holding_walls(WALLS_NOOK, 0.6);
  dvi_integrator *integrator = start_at(system, "verlet", q, v);
  run_into_refusal(integrator, 0.1);
  check_words("contact 'second' accumulate");
  check_words("another contact is held already");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_hold_cannot_be_undone)
{
  const double none = 0;
  dvi_system *system = create_holding_walls(WALLS_DROP, 1);
  dvi_integrator *integrator = start_at(system, "verlet", &none, &none);
  advance(integrator, 0.1, 2);
  run_into_refusal(integrator, -0.1);
  check_words("contact 'first' is held closed");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_restitution_next_to_1_is_refused_where_hits_are_too_many)
{
  const double q = 0.01, none = 0;
  dvi_system *system = create_holding_walls(WALLS_DROP, 0.9999);
  dvi_integrator *integrator = start_at(system, "verlet", &q, &none);
  ck_assert_int_eq(dvi_integrator_step(integrator, 800), DVI_UNSUPPORTED);
  check_words("accumulate (4000 in the step)");
  ck_assert_int_eq(dvi_integrator_held(integrator), -1);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

static int drag(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  F[0] = -v[0];
  return 0;
}

static int plain_gap(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  *phi = q[0];
  return 0;
}

static int plain_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)q, (void)user;
  phi_q[0] = 1;
  return 0;
}

START_TEST(what_cannot_hold_says_so)
{
  dvi_contact contact = {.name = "wall", .gap = plain_gap, .gradient = plain_gradient, .hold = 2};
  const dvi_force force = {.name = "drag", .value = drag};
  dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .contacts = &contact, .contact_count = 1};
  dvi_system *system;
  dvi_integrator *integrator;
  double N;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("contact 'wall' has hold = 2");
  contact.hold = 1;
  terms.forces = &force, terms.force_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "verlet", &integrator), DVI_UNSUPPORTED);
  check_words("contact 'wall', which may be held");
  ck_assert_int_eq(dvi_integrator_create(system, "moreau-jean", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_may_hold(integrator, 0), 0);
  ck_assert_int_eq(dvi_integrator_contact_force(integrator, 0, &N), DVI_UNSUPPORTED);
  check_words("keeps contacts closed itself");
  dvi_integrator_destroy(&integrator);
  ck_assert_int_eq(dvi_integrator_create(system, "galerkin", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_contact_force(integrator, 0, &N), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_integrator_contact_force(integrator, 1, &N), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_contact_force(NULL, 0, &N), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_may_hold(NULL, 0), 0);
  ck_assert_int_eq(dvi_integrator_held(NULL), -1);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- with the driver ---- */

START_TEST(a_run_that_is_restored_while_it_holds_has_the_same_bits)
{
  const double q[] = {0, 1}, v[] = {1, 0};
  static char bytes[8192];
  size_t size;
  dvi_system *system = create_holding_walls(WALLS_HILL, 0.5);
  for (int c = 0; c < CASES; c++) {
    dvi_integrator *integrator = start_at(system, cases[c].method, q, v),
                   *other = start_at(system, cases[c].method, q, v);
    advance(integrator, 0.05, 4);
    ck_assert_int_eq(dvi_integrator_held(integrator), 0);
    ck_assert_int_eq(dvi_integrator_save_memory(integrator, bytes, sizeof bytes, &size), DVI_OK);
    ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_OK);
    ck_assert_int_eq(dvi_integrator_held(other), 0);
    ck_assert_double_eq(force_of(other, 0), force_of(integrator, 0));
    advance(integrator, 0.05, 12);
    advance(other, 0.05, 12);
    ck_assert_int_eq(dvi_integrator_held(other), -1);
    ck_assert_int_eq(memcmp(dvi_integrator_q(integrator), dvi_integrator_q(other), sizeof q), 0);
    ck_assert_int_eq(memcmp(dvi_integrator_p(integrator), dvi_integrator_p(other), sizeof q), 0);
    bytes[size / 2] ^= 1;
    ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_BAD_FILE);
    ck_assert_int_eq(dvi_integrator_held(other), -1);
    dvi_integrator_destroy(&integrator);
    dvi_integrator_destroy(&other);
  }
  dvi_system_destroy(&system);
}
END_TEST

static int at_half_way(double t, const double *q, const double *v, double *value, void *user)
{
  (void)q, (void)v, (void)user;
  *value = t - 0.51;
  return 0;
}

/* The step to 0.6 holds, and releases at 0.527. The event takes it back, and it is taken again. */
START_TEST(an_event_takes_a_step_back_that_releases)
{
  const double q[] = {0, 1}, v[] = {1, 0};
  const dvi_event event = {.value = at_half_way, .terminal = 1};
  const dvi_run_options options = {.h = 0.2, .t_end = 2, .events = &event, .event_count = 1};
  dvi_run_report report;
  dvi_system *system = create_holding_walls(WALLS_HILL, 0.5);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", q, v);
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_double_eq_tol(report.event_time, 0.51, 1e-12);
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  ck_assert_double_eq_tol(wait_for(integrator, 0.2, DVI_RELEASE).t, 0.527002185637, 1e-7);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  advance(integrator, 0.2, 1);
  const double inside[] = {0, 0.5};
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, inside, v), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_held(integrator), -1);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(holding_takes_no_memory)
{
  const double q = 1, none = 0;
  dvi_counters before, after;
  dvi_system *system = create_holding_walls(WALLS_DROP, 0.5);
  dvi_integrator *integrator = start_at(system, "galerkin:degree=3", &q, &none);
  advance(integrator, 0.1, 20);
  dvi_integrator_counters(integrator, &before);
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &none), DVI_OK);
  advance(integrator, 0.1, 40);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  ck_assert_int_eq(after.allocations, before.allocations);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(creation_without_memory_says_so)
{
  static const char *const methods[] = {"verlet", "galerkin", "composition"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_status status = DVI_NO_MEMORY;
    for (int k = 0; status != DVI_OK; k++) {
      dvi_system *system = create_holding_walls(WALLS_DROP, 0.5);
      dvi_integrator *integrator;
      dvi__fail_allocations_after(k);
      status = dvi_integrator_create(system, methods[m], &integrator);
      dvi__fail_allocations_after(-1);
      ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
      dvi_integrator_destroy(&integrator);
      dvi_system_destroy(&system);
      ck_assert_int_lt(k, 1000);
    }
  }
}
END_TEST

SUITE(held_contacts)
{
  tcase_add_test(tests, a_ball_rests_from_the_limit_of_its_hits_on);
  tcase_add_test(tests, hits_accumulate_with_restitutions_from_0_to_nearly_1);
  tcase_add_test(tests, a_contact_that_is_closed_at_the_start_is_held);
  tcase_add_test(tests, the_time_of_rest_has_the_order_of_the_method);
  tcase_add_test(tests, the_time_of_a_release_has_the_order_of_the_method);
  tcase_add_test(tests, a_general_lagrangian_is_released_at_the_same_time);
  tcase_add_test(tests, a_contact_that_is_held_stays_closed);
  tcase_add_test(tests, a_ball_on_a_lift_follows_it);
  tcase_add_test(tests, a_ball_that_is_held_hits_a_wall_and_stays_held);
  tcase_add_test(tests, a_wall_that_lifts_a_ball_releases_it);
  tcase_add_test(tests, a_wall_that_presses_a_ball_is_a_corner);
  tcase_add_test(tests, a_second_contact_that_would_be_held_is_refused);
  tcase_add_test(tests, a_hold_cannot_be_undone);
  tcase_add_test(tests, a_restitution_next_to_1_is_refused_where_hits_are_too_many);
  tcase_add_test(tests, what_cannot_hold_says_so);
  tcase_add_test(tests, a_run_that_is_restored_while_it_holds_has_the_same_bits);
  tcase_add_test(tests, an_event_takes_a_step_back_that_releases);
  tcase_add_test(tests, holding_takes_no_memory);
  tcase_add_test(tests, creation_without_memory_says_so);
}
