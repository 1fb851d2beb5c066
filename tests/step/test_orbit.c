/* labels: unit */
/* Kepler motions: their exact solution, what they conserve, and their transposed derivatives. */
#include "step/split/orbit.h"

#include <float.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

enum { D = 3 };

typedef struct place {
  double q[D], v[D];
} place;

static place moved(double mu, const place *from, double tau)
{
  dvi__orbit o;
  place to;
  dvi__orbit_place(mu, D, from->q, from->v, tau, 0, &o);
  for (int i = 0; i < D; i++) {
    to.q[i] = from->q[i] + o.f_less_1 * from->q[i] + o.g * from->v[i];
    to.v[i] = from->v[i] + o.f_rate * from->q[i] + o.g_rate_less_1 * from->v[i];
  }
  return to;
}

static double distance_of(const place *a, const place *b)
{
  return fmax(distance(D, a->q, b->q), distance(D, a->v, b->v));
}

/* Ellipses, a parabola, hyperbolas, a fall from rest, and a repulsion. */
static const struct {
  double mu;
  place at;
} starts[] = {
    {1, {{1, 0, 0}, {0, 1, 0}}},       {1, {{1, 0.2, -0.3}, {0.2, 0.9, 0.4}}},
    {1, {{0.1, 0, 0}, {0, 4.2, 0.4}}}, {2, {{1, 0, 0}, {0, 2, 0}}},
    {1, {{1, 0, 0}, {-2, 1, 0.5}}},    {0.3, {{0, 2, 1}, {1, -0.5, 0.1}}},
    {-1, {{1, 0.5, 0}, {-1, 0, 0.2}}},
};
enum { STARTS = sizeof starts / sizeof *starts };

static double energy_of(double mu, const place *z)
{
  double r2 = 0, v2 = 0;
  for (int i = 0; i < D; i++) {
    r2 += z->q[i] * z->q[i];
    v2 += z->v[i] * z->v[i];
  }
  return 0.5 * v2 - mu / sqrt(r2);
}

START_TEST(the_energy_stays_and_the_way_back_is_the_way)
{
  const double mu = starts[_i].mu;
  const place *from = &starts[_i].at;
  for (double tau = 1e-9; tau < 30; tau *= 3)
    for (int sign = -1; sign <= 1; sign += 2) {
      const place to = moved(mu, from, sign * tau), back = moved(mu, &to, -sign * tau);
      ck_assert_double_eq_tol(energy_of(mu, &to), energy_of(mu, from), 2e-14);
      ck_assert_double_le(distance_of(&back, from), 1e-11);
    }
}
END_TEST

START_TEST(motions_one_after_the_other_are_the_motion_of_the_sum)
{
  const double mu = starts[_i].mu;
  const place *from = &starts[_i].at, half = moved(mu, from, 0.7), twice = moved(mu, &half, -2.9),
              once = moved(mu, from, 0.7 - 2.9);
  ck_assert_double_le(distance_of(&twice, &once), 1e-12);
}
END_TEST

/* A short time is the start and its Taylor series, with the acceleration -mu q/r^3. */
START_TEST(short_motions_follow_the_force)
{
  const double mu = starts[_i].mu, tau = 1e-4;
  const place *from = &starts[_i].at, to = moved(mu, from, tau), back = moved(mu, from, -tau);
  double r2 = 0;
  for (int i = 0; i < D; i++) r2 += from->q[i] * from->q[i];
  for (int i = 0; i < D; i++) {
    const double pull = -mu * from->q[i] / (r2 * sqrt(r2));
    ck_assert_double_eq_tol((to.v[i] - back.v[i]) / (2 * tau), pull, 1e-3 + 1e-5 * fabs(pull));
    ck_assert_double_eq_tol((to.q[i] - back.q[i]) / (2 * tau), from->v[i], 3e-5);
  }
}
END_TEST

/* Differences of order 4 of lambda.q(tau). */
static double difference_by(double mu, const place *from, double tau, const double *lambda, int j)
{
  static const double weight[] = {1, -8, 8, -1}, shift[] = {-2, -1, 1, 2};
  const double step = 1e-3 * magnitude(D, from->q) / (1 + magnitude(D, from->v));
  double sum = 0;
  for (int k = 0; k < 4; k++) {
    place near = *from;
    *(j < D ? near.q + j : near.v + (j - D)) += shift[k] * step;
    const place to = moved(mu, &near, tau);
    for (int i = 0; i < D; i++) sum += weight[k] * lambda[i] * to.q[i];
  }
  return sum / (12 * step);
}

START_TEST(the_pullback_is_the_transposed_derivative)
{
  static const double times[] = {1e-3, -0.2, 0.8, -1.7, 3.1}, lambda[D] = {0.3, -0.5, 0.7};
  const double mu = starts[_i].mu;
  const place *from = &starts[_i].at;
  for (int k = 0; k < 5; k++) {
    dvi__orbit o;
    double to[2 * D];
    dvi__orbit_place(mu, D, from->q, from->v, times[k], 0, &o);
    dvi__orbit_pullback(&o, D, from->q, from->v, lambda, to, to + D);
    for (int j = 0; j < 2 * D; j++)
      ck_assert_double_eq_tol(to[j], difference_by(mu, from, times[k], lambda, j),
                              1e-7 * magnitude(2 * D, to));
  }
}
END_TEST

/* The catalogue solves Kepler's equation. The error is that of the start's rounding, which is
 * larger by 1/(1 - e) near the pericentre. */
START_TEST(eccentric_orbits_are_the_exact_ones)
{
  static const char *const settings[] = {"e=0", "e=0.6", "e=0.9", "e=0.99", "e=0.9999"};
  static const double most[] = {1e-14, 2e-14, 2e-13, 1e-11, 2e-8};
  problem *model = create_problem("kepler", settings[_i]);
  const place from = {{model->q[0], model->q[1], 0}, {model->p[0], model->p[1], 0}};
  for (double tau = -7; tau < 20; tau += 0.37) {
    const place to = moved(1, &from, tau);
    double q[2], p[2];
    ck_assert_int_eq(model->exact(model, tau, q, p), 0);
    ck_assert_msg(distance(2, to.q, q) <= most[_i], "%s at %g: %g", settings[_i], tau,
                  distance(2, to.q, q));
  }
  problem_destroy(&model);
}
END_TEST

/* A guess is a help and no more. */
START_TEST(a_guess_changes_nothing_but_roundings)
{
  const place *from = &starts[_i].at;
  static const double factors[] = {1e-6, 0.5, 1 + 1e-9, 3, 1e6};
  dvi__orbit plain, guessed;
  dvi__orbit_place(starts[_i].mu, D, from->q, from->v, 1.3, 0, &plain);
  for (int k = 0; k < 5; k++) {
    dvi__orbit_place(starts[_i].mu, D, from->q, from->v, 1.3, factors[k] * plain.s, &guessed);
    ck_assert_double_eq_tol(guessed.s, plain.s, 16 * DBL_EPSILON * plain.s);
  }
}
END_TEST

START_TEST(the_centre_itself_gives_no_number)
{
  const place centre = {{0, 0, 0}, {1, 0, 0}}, lost = {{NAN, 0, 0}, {1, 0, 0}};
  const place from_centre = moved(1, &centre, 1), from_nowhere = moved(1, &lost, 1);
  ck_assert(!isfinite(from_centre.q[0]));
  ck_assert(!isfinite(from_nowhere.q[0]));
}
END_TEST

SUITE(orbit)
{
  tcase_add_loop_test(tests, the_energy_stays_and_the_way_back_is_the_way, 0, STARTS);
  tcase_add_loop_test(tests, motions_one_after_the_other_are_the_motion_of_the_sum, 0, STARTS);
  tcase_add_loop_test(tests, short_motions_follow_the_force, 0, STARTS);
  tcase_add_loop_test(tests, the_pullback_is_the_transposed_derivative, 0, STARTS);
  tcase_add_loop_test(tests, eccentric_orbits_are_the_exact_ones, 0, 5);
  tcase_add_loop_test(tests, a_guess_changes_nothing_but_roundings, 0, STARTS);
  tcase_add_test(tests, the_centre_itself_gives_no_number);
}
