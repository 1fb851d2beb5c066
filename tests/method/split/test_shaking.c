/* labels: unit order invariant */
/* Noise functions: two masses on a line, V = k d^2/2 with d = q1 - q2, are shaken by
 * h_1 = (0.3 d^2 + sin d)/2 and h_2 = cos(2 d)/5. */
#include <dvi/dvi.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { N = 2, FINEST = 9, LEVELS = 5, PATHS = 40 };

static const double k = 2.3, start_q[N] = {1, -0.5}, start_p[N] = {0.2, 0.3};

/* ---- functions of d ---- */

static int by_distance(double slope, double *x_q)
{
  x_q[0] = slope;
  x_q[1] = -slope;
  return 0;
}

static int spring(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * k * (q[0] - q[1]) * (q[0] - q[1]);
  return 0;
}

static int spring_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  return by_distance(k * (q[0] - q[1]), V_q);
}

static int first(double t, const double *q, double *h, void *user)
{
  const double d = q[0] - q[1];
  (void)t, (void)user;
  *h = 0.5 * (0.3 * d * d + sin(d));
  return 0;
}

static int first_gradient(double t, const double *q, double *h_q, void *user)
{
  const double d = q[0] - q[1];
  (void)t, (void)user;
  return by_distance(0.5 * (0.6 * d + cos(d)), h_q);
}

static int first_hessian(double t, const double *q, double *h_qq, void *user)
{
  const double d = q[0] - q[1], bend = 0.5 * (0.6 - sin(d));
  (void)t, (void)user;
  memcpy(h_qq, (const double[]){bend, -bend, -bend, bend}, 4 * sizeof *h_qq);
  return 0;
}

static int second(int count, const double *t, const double *q, double *h, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < count; i++) h[i] = 0.2 * cos(2 * (q[i] - q[count + i]));
  return 0;
}

static int second_gradient(int count, const double *t, const double *q, double *h_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < count; i++) {
    h_q[i] = -0.4 * sin(2 * (q[i] - q[count + i]));
    h_q[count + i] = -h_q[i];
  }
  return 0;
}

static int along(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  xi[0] = xi[1] = 1;
  return 0;
}

/* One function with a Hessian and one point a call, the other one with neither. */
static const dvi_potential functions[] = {
    {.name = "first", .value = first, .gradient = first_gradient, .hessian = first_hessian},
    {.name = "second", .value_batch = second, .gradient_batch = second_gradient}};

static dvi_system *make_shaken(const dvi_noise *noise)
{
  const dvi_potential V = {.name = "spring", .value = spring, .gradient = spring_gradient};
  const dvi_symmetry shift = {.name = "momentum", .generator = along};
  dvi_system *system;
  ck_assert_msg(dvi_system_create(&(dvi_system_terms){.dimension = N,
                                                      .mass.scalar = 1.3,
                                                      .potentials = &V,
                                                      .potential_count = 1,
                                                      .symmetries = &shift,
                                                      .symmetry_count = 1,
                                                      .noise = noise,
                                                      .autonomous = 1},
                                  &system) == DVI_OK,
                "%s", dvi_last_error());
  return system;
}

static const dvi_noise shaking = {.seed = 7, .functions = functions, .function_count = 2};

static dvi_integrator *start_shaken(const dvi_system *system, const char *method)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, start_q, start_p), DVI_OK);
  return integrator;
}

/* ---- tests ---- */

START_TEST(derivatives_are_checked)
{
  dvi_system *system = make_shaken(&shaking);
  ck_assert_msg(dvi_system_check(system, 0, start_q, start_p, 0, NULL) == DVI_OK, "%s",
                dvi_last_error());
  dvi_potential wrong = functions[0];
  wrong.gradient = spring_gradient;
  dvi_system *bad = make_shaken(&(dvi_noise){.seed = 7, .functions = &wrong, .function_count = 1});
  ck_assert_int_ne(dvi_system_check(bad, 0, start_q, start_p, 0, NULL), DVI_OK);
  check_words("first");
  dvi_system_destroy(&system);
  dvi_system_destroy(&bad);
}
END_TEST

/* Ends of paths of noise that all levels see, after 2^(level + 3) steps. */
static void end_of_paths(const dvi_system *system, const char *scheme, int level, double *q)
{
  double q0[N * PATHS], p0[N * PATHS];
  const char *method = method_spec("langevin:scheme=ovio,%s,refinement=%d", scheme, FINEST - level);
  dvi_ensemble *e = create_ensemble(system, method,
                                    (dvi_ensemble_options){.members = PATHS, .threads = 1});
  for (int i = 0; i < N; i++)
    for (int m = 0; m < PATHS; m++) {
      q0[i * PATHS + m] = start_q[i];
      p0[i * PATHS + m] = start_p[i];
    }
  ck_assert_int_eq(dvi_ensemble_start(e, 0, q0, p0), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, ldexp(0.25, -level), 8L << level), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, q, NULL), DVI_OK);
  dvi_ensemble_destroy(&e);
}

/* Functions of q alone commute. */
START_TEST(paths_converge_with_order_1)
{
  static const char *const schemes[] = {"degree=1", "degree=2", "degree=2,quadrature=lobatto"};
  double finest[N * PATHS], q[N * PATHS], error[LEVELS];
  dvi_system *system = make_shaken(&shaking);
  end_of_paths(system, schemes[_i], FINEST, finest);
  for (int level = 0; level < LEVELS; level++) {
    end_of_paths(system, schemes[_i], level, q);
    error[level] = 0;
    for (int i = 0; i < N * PATHS; i++) error[level] += pow(q[i] - finest[i], 2);
    if (level > 0) ck_assert_double_eq_tol(0.5 * log2(error[level - 1] / error[level]), 1, 0.35);
  }
  ck_assert_double_eq_tol(0.5 * log2(error[0] / error[LEVELS - 1]) / (LEVELS - 1), 1, 0.12);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(steps_are_symplectic_on_each_path_and_keep_momenta)
{
  static const char *const methods[] = {"langevin:scheme=ovio,degree=1",
                                        "langevin:scheme=ovio,degree=3",
                                        "langevin:scheme=ovio,degree=2,quadrature=lobatto"};
  dvi_system *system = make_shaken(&shaking);
  for (int i = 0; i < 3; i++) {
    double defect;
    dvi_integrator *integrator = start_shaken(system, methods[i]);
    ck_assert_msg(dvi_symplecticity(integrator, 0, start_q, start_p, 0.3, &defect) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_double_lt(fabs(defect), 1e-9);
    advance(integrator, 0.1, 1000);
    const double *p = dvi_integrator_p(integrator);
    ck_assert_double_eq_tol(p[0] + p[1], start_p[0] + start_p[1], 1e-13);
    ck_assert_double_gt(fabs(p[0] - start_p[0]), 0.01);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* Gauss collocation keeps a quadratic energy, so that the balance is a sum of roundings. */
START_TEST(the_energy_is_balanced_by_the_work_of_the_noise)
{
  double defect;
  dvi_noise heated = shaking;
  heated.temperature = 0.5;
  heated.friction = 0.3 * _i;
  dvi_system *system = make_shaken(&heated);
  const dvi_integrator_options options = {
      .size = sizeof options, .method = "langevin:scheme=ovio,degree=2", .balances = 1};
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create_with(system, &options, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, start_q, start_p), DVI_OK);
  advance(integrator, 0.1, 1000);
  ck_assert_double_gt(fabs(dvi_integrator_supplied(integrator, 0)), 0.05);
  for (int i = 0; i < 2; i++) {
    ck_assert_int_eq(dvi_integrator_balance(integrator, i, &defect), DVI_OK);
    ck_assert_double_eq_tol(defect, 0, 1e-11);
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_member_is_a_run_of_its_stream_and_a_restored_run_goes_on)
{
  static const char method[] = "langevin:scheme=ovio,degree=2";
  static char bytes[8192];
  enum { MEMBERS = 3 };
  double q0[N * MEMBERS], p0[N * MEMBERS], q[N * MEMBERS];
  size_t size;
  dvi_noise last = shaking;
  last.stream = MEMBERS - 1;
  dvi_system *system = make_shaken(&shaking), *alone = make_shaken(&last);
  dvi_ensemble *e = create_ensemble(system, method,
                                    (dvi_ensemble_options){.members = MEMBERS, .threads = 2});
  for (int i = 0; i < N * MEMBERS; i++) {
    q0[i] = start_q[i / MEMBERS];
    p0[i] = start_p[i / MEMBERS];
  }
  ck_assert_int_eq(dvi_ensemble_start(e, 0, q0, p0), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, 40), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, q, NULL), DVI_OK);
  dvi_integrator *one = start_shaken(alone, method), *other = create_integrator(alone, method);
  advance(one, 0.1, 20);
  ck_assert_int_eq(dvi_integrator_save_memory(one, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_OK);
  advance(other, 0.1, 20);
  for (int i = 0; i < N; i++)
    ck_assert_double_eq(dvi_integrator_q(other)[i], q[i * MEMBERS + MEMBERS - 1]);
  ck_assert_double_ne(q[0], q[1]);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
  dvi_system_destroy(&alone);
}
END_TEST

static void check_system(const dvi_noise *noise, dvi_status status, const char *words)
{
  const dvi_system_terms terms = {.dimension = N, .mass.scalar = 1, .noise = noise};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), status);
  check_words(words);
}

START_TEST(what_cannot_be_is_refused)
{
  static const char *const methods[] = {"langevin", "langevin:scheme=obabo"};
  dvi_potential bare = functions[0];
  dvi_system *system = make_shaken(&shaking);
  for (int i = 0; i < 2; i++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(dvi_integrator_create(system, methods[i], &integrator), DVI_UNSUPPORTED);
    check_words("noise functions are taken by scheme=ovio alone");
  }
  bare.gradient = NULL;
  check_system(&(dvi_noise){.functions = &bare, .function_count = 1}, DVI_BAD_ARGUMENT,
               "noise function 'first' has no gradient");
  check_system(&(dvi_noise){.functions = functions, .function_count = -1}, DVI_BAD_SIZE,
               "noise functions");
  check_system(&(dvi_noise){.function_count = 1}, DVI_BAD_ARGUMENT, "noise functions");
  dvi_system_destroy(&system);
}
END_TEST

SUITE(shaking)
{
  tcase_add_test(tests, derivatives_are_checked);
  tcase_add_loop_test(tests, paths_converge_with_order_1, 0, 3);
  tcase_add_test(tests, steps_are_symplectic_on_each_path_and_keep_momenta);
  tcase_add_loop_test(tests, the_energy_is_balanced_by_the_work_of_the_noise, 0, 2);
  tcase_add_test(tests, a_member_is_a_run_of_its_stream_and_a_restored_run_goes_on);
  tcase_add_test(tests, what_cannot_be_is_refused);
}
