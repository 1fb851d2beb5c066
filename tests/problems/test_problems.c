/* Tests every derivative and pattern of the catalogue against differences, every start, and every
 * refusal. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"
#include "system/evaluate/evaluator.h"
#include "support/accepted.h"
#include "support/suite.h"

/* Differences of the value are good to about 1e-10 at these points, and a wrong term shows at 1. */
#define TOLERANCE 1e-7

static problem *create(const char *name, int setting_count, const char *const *settings)
{
  problem *made = NULL;
  char message[256] = "";
  ck_assert_msg(problem_create(name, setting_count, settings, &made, message, sizeof message) ==
                    DVI_OK,
                "%s: %s", name, message);
  return made;
}

/* A reproducible number in [-1, 1]. */
static double draw_noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / 8388608.0 - 1.0;
}

static double size_of(int n, const double *x)
{
  double most = 0.0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most > 0.0 ? most : 1.0;
}

/* Check the derivatives, at a time when no drive stands still, at the start moved by `distance`,
 * relative to the size of q and v. */
static void check_near_start(const problem *made, double distance, unsigned seed)
{
  double *q = calloc((size_t)made->nq, sizeof *q), *v = calloc((size_t)made->nv, sizeof *v);
  ck_assert(q && v);
  unsigned state = seed;
  for (int i = 0; i < made->nq; i++)
    q[i] = made->q[i] + distance * size_of(made->nq, made->q) * draw_noise(&state);
  for (int i = 0; i < made->nv; i++)
    v[i] = made->v[i] + distance * size_of(made->nv, made->v) * draw_noise(&state);
  dvi_derivative_check found;
  const dvi_status status = dvi_system_check(made->system, 0.7, q, v, TOLERANCE, &found);
  ck_assert_msg(status == DVI_OK, "%s: %s (gradient %g, hessian %g, outside %g)", made->name,
                dvi_last_error(), found.gradient_error, found.hessian_error, found.outside);
  free(q);
  free(v);
}

static void check_derivatives(const char *name, int setting_count, const char *const *settings)
{
  problem *made = create(name, setting_count, settings);
  check_near_start(made, 0.0, 1);
  for (unsigned seed = 1; seed <= 4; seed++) check_near_start(made, 0.2, seed);
  problem_destroy(&made);
}

START_TEST(derivatives_and_patterns_agree_with_differences)
{
  check_derivatives(problem_name(_i), 0, NULL);
}
END_TEST

START_TEST(derivatives_agree_for_other_parameters)
{
  static const char *const cases[][2] = {
      {"oscillator", "k=3"},
      {"pendulum", "q0=1e-3"},
      {"kepler", "e=0.9"},
      {"henon-heiles", "lambda=-0.7"},
      {"double-pendulum", "l1=.7"},
      {"double-pendulum", "m2=3"},
      {"driven-pendulum", "a=1"},
      {"stiff-pendulum", "k=7"},
      {"stiff-pendulum", "l=2.5"},
      {"oscillators", "omega=3"},
      {"toda", "N=2"},
      {"toda", "N=3"},
      {"toda", "N=4"},
      {"toda", "N=7"},
      {"fpu", "ell=1"},
      {"fpu", "ell=2"},
      {"fpu", "ell=9"},
      {"chain", "n=1"},
      {"chain", "n=2"},
      {"chain", "n=3"},
      {"chain", "beta=0"},
      {"pendulum-3d", "l=2"},
      {"spherical-chain", "n=1"},
      {"spherical-chain", "n=3"},
      {"two-body", "size=2"},
      {"satellite", "n=1"},
  };
  check_derivatives(cases[_i][0], 1, &cases[_i][1]);
}
END_TEST

/* The points of a batch are more than one vector register holds, and not a multiple of it. */
#define POINTS 5

/* Entry e of point k of a batch is entry e of that point alone, bit for bit, because no callback
 * mixes points. */
static void check_same(const char *name, const char *what, int entries, const double *batch, int k,
                       const double *alone)
{
  for (int e = 0; e < entries; e++)
    ck_assert_msg(!(batch[e * POINTS + k] < alone[e] || batch[e * POINTS + k] > alone[e]),
                  "%s: %s %d of point %d", name, what, e, k);
}

static void check_batches(const char *name, int setting_count, const char *const *settings)
{
  problem *made = create(name, setting_count, settings);
  const int n = made->nq, most = n * n > n ? n * n : n;
  double *numbers = calloc((size_t)(4 * n + 3 * most) * (POINTS + 1), sizeof *numbers),
         t[POINTS] = {0.0}, L[POINTS], one;
  ck_assert_ptr_nonnull(numbers);
  double *q = numbers, *v = q + n * POINTS, *rows = v + n * POINTS, *blocks = rows + 2 * n * POINTS;
  double *q1 = blocks + 3 * most * POINTS, *v1 = q1 + n, *rows1 = v1 + n, *blocks1 = rows1 + 2 * n;
  unsigned state = 7;
  for (int j = 0; j < n * POINTS; j++) {
    q[j] = made->q[j / POINTS] + 0.2 * size_of(n, made->q) * draw_noise(&state);
    v[j] = (n == made->nv ? made->v[j / POINTS] : 0) +
           0.2 * size_of(made->nv, made->v) * draw_noise(&state);
  }
  dvi__evaluator *e = NULL;
  ck_assert_int_eq(dvi__evaluator_create(made->system, POINTS, DVI__HESSIANS, NULL, &e), DVI_OK);
  const dvi__pattern *patterns[3] = {&made->system->qq, &made->system->qv, &made->system->vv};
  double *hessians = blocks, *hessians1 = blocks1;
  ck_assert_int_eq(dvi__lagrangian_value(e, POINTS, t, q, v, L), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, POINTS, t, q, v, rows, rows + n * POINTS), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_hessian(e, POINTS, t, q, v, hessians, hessians + most * POINTS,
                                           hessians + 2 * most * POINTS),
                   DVI_OK);
  for (int k = 0; k < POINTS; k++) {
    for (int i = 0; i < n; i++) {
      q1[i] = q[i * POINTS + k];
      v1[i] = v[i * POINTS + k];
    }
    ck_assert_int_eq(dvi__lagrangian_value(e, 1, t, q1, v1, &one), DVI_OK);
    ck_assert_int_eq(dvi__lagrangian_gradient(e, 1, t, q1, v1, rows1, rows1 + n), DVI_OK);
    ck_assert_int_eq(
        dvi__lagrangian_hessian(e, 1, t, q1, v1, hessians1, hessians1 + most, hessians1 + 2 * most),
        DVI_OK);
    check_same(name, "value", 1, L, k, &one);
    check_same(name, "gradient", 2 * n, rows, k, rows1);
    for (int b = 0; b < 3; b++)
      check_same(name, "hessian", dvi__pattern_entries(patterns[b]), hessians + b * most * POINTS,
                 k, hessians1 + b * most);
  }
  dvi__evaluator_destroy(&e);
  free(numbers);
  problem_destroy(&made);
}

START_TEST(a_batch_gives_each_point_what_it_gets_alone)
{
  static const char *const one_spring = "ell=1";
  check_batches(problem_name(_i), 0, NULL);
  check_batches("fpu", 1, &one_spring);
}
END_TEST

START_TEST(momenta_are_the_legendre_transform_of_the_velocities)
{
  problem *made = create(problem_name(_i), 0, NULL);
  const size_t n = (size_t)made->nv;
  double *v = calloc(n, sizeof *v);
  ck_assert_ptr_nonnull(v);
  memcpy(v, made->v, n * sizeof *v);
  for (size_t i = 0; i < n; i++) v[i] += 1e-3 * size_of(made->nv, made->v);
  ck_assert_int_eq(dvi_system_velocity(made->system, 0.0, made->q, made->p, v), DVI_OK);
  /* M is well conditioned in all of them, so the error is the roundoff of one solve */
  for (size_t i = 0; i < n; i++)
    ck_assert_double_eq_tol(v[i], made->v[i], 1e-13 * size_of(made->nv, made->v));
  free(v);
  problem_destroy(&made);
}
END_TEST

START_TEST(every_problem_is_found_by_its_name_and_complete)
{
  const char *name = problem_name(_i);
  ck_assert_int_eq(problem_find(name), _i);
  ck_assert_ptr_nonnull(problem_summary(_i));
  for (const problem_parameter *p = problem_parameters(_i); p->name; p++) {
    ck_assert_ptr_nonnull(p->help);
    ck_assert(p->least <= p->value && p->value <= p->most);
  }
  problem *made = create(name, 0, NULL);
  ck_assert_str_eq(made->name, name);
  ck_assert_int_eq(made->nq, dvi_system_nq(made->system));
  ck_assert_int_eq(made->nv, dvi_system_nv(made->system));
  ck_assert(made->h > 0.0 && made->h < made->t_end && made->order_h > 0.0 &&
            made->order_h < made->order_t_end);
  ck_assert(made->digits_q && made->digits_p);
  for (int i = 0; i < made->nq; i++) {
    ck_assert_int_gt((int)strlen(made->coordinate[i]), 0);
    for (int j = 0; j < i; j++) ck_assert_str_ne(made->coordinate[i], made->coordinate[j]);
  }
  for (int i = 0; i < made->nv; i++) {
    ck_assert_int_gt((int)strlen(made->momentum[i]), 0);
    for (int j = 0; j < i; j++) ck_assert_str_ne(made->momentum[i], made->momentum[j]);
    for (int j = 0; j < i && made->velocity; j++)
      ck_assert_str_ne(made->velocity[i], made->velocity[j]);
  }
  problem_destroy(&made);
  ck_assert_ptr_null(made);
}
END_TEST

static accepted_cases with_parameters;

static int has_parameter(int which)
{
  return problem_parameters(which)->name != NULL;
}

START_TEST(digits_belong_to_the_default_parameters_only)
{
  const int which = with_parameters.which[_i];
  const problem_parameter *p = problem_parameters(which);
  char same[64], other[64];
  char value[32];
  problem_spell(p, p->value, value, sizeof value);
  snprintf(same, sizeof same, "%s=%s", p->name, value);
  problem_spell(p, p->whole ? p->value + 1.0 : 0.75 * p->value, value, sizeof value);
  snprintf(other, sizeof other, "%s=%s", p->name, value);
  const char *setting = same;
  problem *made = create(problem_name(which), 1, &setting);
  ck_assert_ptr_nonnull(made->digits_q);
  problem_destroy(&made);
  setting = other;
  made = create(problem_name(which), 1, &setting);
  ck_assert_ptr_null(made->digits_q);
  ck_assert_ptr_null(made->digits_p);
  problem_destroy(&made);
}
END_TEST

START_TEST(bad_settings_are_refused_with_a_sentence)
{
  static const char *const cases[][3] = {
      {"nonsense", NULL, "no problem 'nonsense'"},
      {"kepler", "e=1", "eccentricity"},
      {"kepler", "e=-0.1", "eccentricity"},
      {"kepler", "e=nan", "eccentricity"},
      {"kepler", "e=0.5x", "eccentricity"},
      {"kepler", "e=", "eccentricity"},
      {"kepler", "e", "name=value"},
      {"kepler", "ecc=0.5", "it has: e"},
      {"kepler", "=0.5", "it has: e"},
      {"toda", "N=1", "whole number"},
      {"toda", "N=2.5", "whole number"},
      {"fpu", "ell=0", "whole number"},
      {"fpu", "ell=1e9", "whole number"},
      {"chain", "n=0", "whole number"},
      {"chain", "beta=-1", "from 0"},
      {"fpu", "omega=0", "positive"},
      {"fpu", "omega=inf", "positive"},
      {"oscillator", "k=0", "positive"},
      {"double-pendulum", "m1=-1", "positive"},
      {"pendulum-3d", "m=0", "positive"},
      {"double-pendulum", "m3=1", "l1, l2, m1, m2, g"},
      {"outer-solar", "G=1", "it has: none"},
  };
  problem *made = NULL;
  char message[256] = "";
  const char *setting = cases[_i][1];
  ck_assert_int_eq(
      problem_create(cases[_i][0], setting ? 1 : 0, &setting, &made, message, sizeof message),
      DVI_BAD_OPTION);
  ck_assert_ptr_null(made);
  ck_assert_msg(strstr(message, cases[_i][2]) != NULL, "%s", message);
}
END_TEST

START_TEST(a_chain_of_any_length_starts_as_it_should)
{
  const char *setting = "ell=1000";
  problem *made = create("fpu", 1, &setting);
  ck_assert_int_eq(made->nq, 2000);
  ck_assert_str_eq(made->coordinate[999], "x0_1000");
  ck_assert_str_eq(made->coordinate[1000], "x1_1");
  ck_assert(made->q[0] == 1.0 && made->p[0] == 1.0 && made->q[1000] == 1.0 / 50.0 &&
            made->p[1000] == 1.0);
  problem_destroy(&made);
}
END_TEST

/* Exact solutions start where the problem starts, and meet the digits at order_t_end. */
START_TEST(exact_solutions_meet_start_and_digits)
{
  static const char *const names[] = {"oscillator", "oscillators", "kepler", "free-body"};
  problem *made = create(names[_i], 0, NULL);
  double q[9], p[9];
  ck_assert_int_eq(made->exact(made, 0.0, q, p), 0);
  for (int i = 0; i < made->nq; i++) {
    ck_assert_double_eq_tol(q[i], made->q[i], 1e-15);
    if (i < made->nv) ck_assert_double_eq_tol(p[i], made->p[i], 1e-15);
  }
  ck_assert_int_eq(made->exact(made, made->order_t_end, q, p), 0);
  /* a few ulp, because the parameter itself is rounded (e = 0.6) */
  for (int i = 0; i < made->nq; i++) {
    ck_assert_double_eq_tol(q[i], made->digits_q[i],
                            1e-15 * size_of(made->nq, made->digits_q) * made->order_t_end);
    if (i < made->nv)
      ck_assert_double_eq_tol(p[i], made->digits_p[i],
                              1e-15 * size_of(made->nv, made->digits_p) * made->order_t_end);
  }
  problem_destroy(&made);
}
END_TEST

/* The state is on the orbit, it is there at the right time, and the state at -t mirrors that at
 * t. */
START_TEST(keplers_equation_is_solved_for_any_eccentricity_and_time)
{
  static const char *const settings[] = {"e=0",    "e=0.3",   "e=0.6",     "e=0.9",
                                         "e=0.99", "e=0.999", "e=0.999999"};
  static const double times[] = {1e-12,
                                 1e-4,
                                 0.1,
                                 1.0,
                                 3.14159265358979,
                                 3.2,
                                 6.28,
                                 100.0,
                                 1256.637061435917,
                                 1e6,
                                 6.28318530717958648e6};
  problem *made = create("kepler", 1, &settings[_i]);
  const double e = strtod(settings[_i] + 2, NULL), b2 = (1.0 - e) * (1.0 + e);
  for (size_t j = 0; j < sizeof times / sizeof *times; j++) {
    double q[2], p[2], mirror_q[2], mirror_p[2];
    ck_assert_int_eq(made->exact(made, times[j], q, p), 0);
    ck_assert_int_eq(made->exact(made, -times[j], mirror_q, mirror_p), 0);
    ck_assert(mirror_q[0] == q[0] && mirror_q[1] == -q[1] && mirror_p[0] == -p[0] &&
              mirror_p[1] == p[1]);
    const double r = hypot(q[0], q[1]), kinetic = 0.5 * (p[0] * p[0] + p[1] * p[1]);
    const double E = atan2(q[1] / sqrt(b2), q[0] + e), period = 0x1.921fb54442d18p2;
    /* a few ulp of the reduced time, and of E where dt/dE is 1 + e, and beyond 1e4 the period's own
     * rounding */
    if (times[j] < 1e4)
      ck_assert_double_eq_tol(E - e * sin(E), remainder(times[j], period),
                              2e-15 + 2e-16 * times[j]);
    /* terms as large as 1/r cancel to -1/2 */
    ck_assert_double_eq_tol(kinetic - 1.0 / r, -0.5, 1e-15 * (1.0 + kinetic) / (1.0 - e));
    ck_assert_double_eq_tol((q[0] * p[1] - q[1] * p[0]) / sqrt(b2), 1.0, 1e-14 + 1e-15 / (1.0 - e));
  }
  problem_destroy(&made);
}
END_TEST

/* One period is 2 pi. 6.283185307179586 is 2 pi minus 4.77e-16, so k of them end 4.77e-16 k before
 * the pericentre. */
START_TEST(many_periods_are_reduced_without_loss)
{
  const char *setting = "e=0.9";
  problem *made = create("kepler", 1, &setting);
  const double period = 0x1.921fb54442d18p2, period_rest = 2.4492935982947064e-16;
  const double turns = 0x1p20; /* turns * period is exact */
  double q[2], p[2], near_q[2], near_p[2];
  ck_assert_int_eq(made->exact(made, turns * period, q, p), 0);
  ck_assert_int_eq(made->exact(made, -turns * period_rest, near_q, near_p), 0);
  /* relative, because y is 1e-9 there */
  ck_assert_double_eq_tol(q[1] / near_q[1], 1.0, 1e-13);
  ck_assert_double_eq_tol(q[0], near_q[0], 1e-15);
  problem_destroy(&made);
}
END_TEST

START_TEST(kepler_in_the_singularity_gives_no_finite_number)
{
  problem *made = create("kepler", 0, NULL);
  const double q[2] = {0.0, 0.0}, v[2] = {0.0, 1.0};
  double L = 0.0;
  ck_assert_int_eq(dvi_system_lagrangian(made->system, 0.0, q, v, &L), DVI_NOT_FINITE);
  problem_destroy(&made);
}
END_TEST

START_TEST(symmetries_and_invariants_have_their_names)
{
  static const struct {
    const char *problem;
    const char *names[8];
  } cases[] = {
      {"oscillator", {"energy"}},
      {"kepler", {"energy", "angular_momentum", "laplace_x", "laplace_y"}},
      {"toda", {"energy", "momentum"}},
      {"fpu", {"energy", "I", "I_1", "I_2", "I_3"}},
      {"pendulum-3d", {"energy", "angular_momentum_z"}},
      {"kovalevskaya", {"energy", "angular_momentum_z", "kovalevskaya"}},
      {"figure-eight", {"energy", "momentum_x", "momentum_y", "angular_momentum"}},
      {"outer-solar",
       {"energy", "momentum_x", "momentum_y", "momentum_z", "angular_momentum_x",
        "angular_momentum_y", "angular_momentum_z"}},
  };
  problem *made = create(cases[_i].problem, 0, NULL);
  int count = 0;
  for (; cases[_i].names[count]; count++)
    ck_assert_str_eq(dvi_system_invariant_name(made->system, count), cases[_i].names[count]);
  ck_assert_int_eq(dvi_system_invariant_count(made->system), count);
  problem_destroy(&made);
}
END_TEST

/* Affine rows do work. */
static int has_affine_rows(const problem *made)
{
  for (int k = 0; k < made->terms->nonholonomic_count; k++)
    if (made->terms->nonholonomics[k].affine != NULL) return 1;
  return 0;
}

/* Every invariant but the stiff energies of fpu, and the energy of systems that depend on time or
 * have affine rows, has the same value at the start and at the stored digits. */
START_TEST(invariants_hold_between_start_and_digits)
{
  problem *made = create(problem_name(_i), 0, NULL);
  const int count = dvi_system_invariant_count(made->system);
  double start[16], end[16];
  ck_assert_int_le(count, 16);
  ck_assert_int_eq(dvi_system_invariants(made->system, 0.0, made->q, made->p, start), DVI_OK);
  ck_assert_int_eq(
      dvi_system_invariants(made->system, made->order_t_end, made->digits_q, made->digits_p, end),
      DVI_OK);
  for (int i = 0; i < count; i++) {
    const char *name = dvi_system_invariant_name(made->system, i);
    /* roundoff of the digits times the largest force or speed, 1e3 in stiff-pendulum, q p ~ 1e-4 in
     * outer-solar */
    if (name[0] != 'I' &&
        (i > 0 || (dvi_system_autonomous(made->system) && !has_affine_rows(made))))
      ck_assert_msg(fabs(end[i] - start[i]) <= 4e-15 * fmax(size_of(count, start), 1e-7),
                    "%s: %s changes by %g of %g", made->name, name, end[i] - start[i], start[i]);
  }
  problem_destroy(&made);
}
END_TEST

SUITE(problems)
{
  const int count = problem_count();
  tcase_add_loop_test(tests, derivatives_and_patterns_agree_with_differences, 0, count);
  tcase_add_loop_test(tests, derivatives_agree_for_other_parameters, 0, 26);
  tcase_add_loop_test(tests, a_batch_gives_each_point_what_it_gets_alone, 0, count);
  tcase_add_loop_test(tests, momenta_are_the_legendre_transform_of_the_velocities, 0, count);
  tcase_add_loop_test(tests, every_problem_is_found_by_its_name_and_complete, 0, count);
  find_accepted_cases(count, has_parameter, &with_parameters);
  tcase_add_loop_test(tests, digits_belong_to_the_default_parameters_only, 0,
                      with_parameters.count);
  tcase_add_loop_test(tests, bad_settings_are_refused_with_a_sentence, 0, 22);
  tcase_add_test(tests, a_chain_of_any_length_starts_as_it_should);
  tcase_add_loop_test(tests, exact_solutions_meet_start_and_digits, 0, 4);
  tcase_add_loop_test(tests, keplers_equation_is_solved_for_any_eccentricity_and_time, 0, 7);
  tcase_add_test(tests, many_periods_are_reduced_without_loss);
  tcase_add_test(tests, kepler_in_the_singularity_gives_no_finite_number);
  tcase_add_loop_test(tests, symmetries_and_invariants_have_their_names, 0, 8);
  tcase_add_loop_test(tests, invariants_hold_between_start_and_digits, 0, count);
}
