/* labels: unit order */
/* A change of gauge, alpha + grad f, keeps the two-form and the motion, and changes the momenta. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

/* f = sum over pairs (x,y) of c (x y + kappa (x^3 y/3 + x y^3)) removes the first component from
 * alpha = c (1 + kappa r^2) (-y, x). */
typedef struct product {
  int pairs;
  double c, kappa;
} product;

static int gradient(const double *q, double *f_q, void *user)
{
  const product *f = user;
  for (int i = 0; i < 4; i++) f_q[i] = 0;
  for (int k = 0; k < f->pairs; k++) {
    const double x = q[2 * k], y = q[2 * k + 1];
    f_q[2 * k] = f->c * (y + f->kappa * (x * x * y + y * y * y));
    f_q[2 * k + 1] = f->c * (x + f->kappa * (x * x * x / 3 + 3 * x * y * y));
  }
  return 0;
}

static const int start_of_pairs[] = {0, 2, 4, 6, 8}, start_of_one[] = {0, 2, 4, 4, 4},
                 row[] = {0, 1, 0, 1, 2, 3, 2, 3};

static int hessian(const double *q, double *f_qq, void *user)
{
  const product *f = user;
  for (int k = 0; k < f->pairs; k++, f_qq += 4) {
    const double x = q[2 * k], y = q[2 * k + 1];
    f_qq[0] = 2 * f->c * f->kappa * x * y;
    f_qq[1] = f_qq[2] = f->c * (1 + f->kappa * (x * x + 3 * y * y));
    f_qq[3] = 6 * f->c * f->kappa * x * y;
  }
  return 0;
}

static int form_third_derivative(const double *q, const double *w, double *f_w_qq, void *user)
{
  const product *f = user;
  for (int k = 0; k < f->pairs; k++, f_w_qq += 4) {
    const double x = 2 * f->c * f->kappa * q[2 * k], y = 2 * f->c * f->kappa * q[2 * k + 1],
                 *u = w + 2 * k;
    f_w_qq[0] = y * u[0] + x * u[1];
    f_w_qq[1] = f_w_qq[2] = x * u[0] + 3 * y * u[1];
    f_w_qq[3] = 3 * y * u[0] + 3 * x * u[1];
  }
  return 0;
}

typedef struct place {
  const char *problem, *setting;
  product f;
} place;

/* vortices has gamma = 1/2, halved. The last two leave the class again. */
static const place places[] = {
    {"vortices", NULL, {2, 0.25, 1}},
    {"guiding-centre", NULL, {1, 0.5, 0.5}},
    {"massless-particle", NULL, {1, 0.5, 1}},
    {"lotka-volterra", NULL, {1, -1, 0}},
    {"lotka-volterra", "gauge=singular", {1, 1, 0}},
    {"lotka-volterra-4d", NULL, {2, 0.3, 0.1}},
};
enum { PLACES = sizeof places / sizeof *places, IN_CLASS = 4 };

static dvi_gauge declare_gauge(const place *at, int n, product *own)
{
  *own = at->f;
  return (dvi_gauge){.gradient = gradient,
                     .hessian = hessian,
                     .third = form_third_derivative,
                     .qq = {n == 2 || own->pairs == 2 ? start_of_pairs : start_of_one, row},
                     .user = own};
}

/* f of two coordinates must not write into four. */
static int gradient_of_two(const double *q, double *f_q, void *user)
{
  double whole[4];
  const int returned = gradient(q, whole, user);
  memcpy(f_q, whole, 2 * sizeof *f_q);
  return returned;
}

static dvi_system *gauged(const problem *model, const dvi_gauge *gauge)
{
  dvi_system_terms terms = *model->terms;
  dvi_gauge f = *gauge;
  dvi_system *system = NULL;
  if (model->nq == 2) f.gradient = gradient_of_two;
  terms.gauge = &f;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static const double q[] = {0.7, 0.4, 1.3, 0.6}, v[] = {0.2, -0.5, 0.3, 0.1};

START_TEST(the_two_form_stays_and_the_momenta_move_by_the_gradient)
{
  product own;
  const place *at = &places[_i];
  problem *model = create_problem(at->problem, at->setting);
  const dvi_gauge f = declare_gauge(at, model->nq, &own);
  dvi_system *system = gauged(model, &f);
  double before[16], after[16], p[4], moved[4], f_q[4];
  ck_assert_int_eq(dvi_system_two_form(model->system, q, before, NULL), DVI_OK);
  ck_assert_int_eq(dvi_system_two_form(system, q, after, NULL), DVI_OK);
  ck_assert_double_le(distance(model->nq * model->nq, before, after),
                      1e-15 * fmax(1, magnitude(model->nq * model->nq, before)));
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, v, p), DVI_OK);
  ck_assert_int_eq(dvi_system_momentum(system, 0, q, v, moved), DVI_OK);
  (void)gradient(q, f_q, &own);
  for (int i = 0; i < model->nq; i++) ck_assert_double_eq(moved[i], p[i] + f_q[i]);
  ck_assert_msg(dvi_system_check(system, 0, q, v, 0, NULL) == DVI_OK, "%s", dvi_last_error());
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* Requires that the error of one method at the problem's digits, over four steps, has the order in
 * every gauge. */
static void check_order(const problem *model, const dvi_system *system, const char *method,
                        double h, int order)
{
  double last = 0;
  for (int level = 0; level < 4; level++, h /= 2) {
    dvi_integrator *integrator = create_integrator(system, method);
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, model->q, model->v), DVI_OK);
    advance(integrator, h, lround(model->order_t_end / h));
    const double error = distance(model->nq, dvi_integrator_q(integrator), model->digits_q),
                 slope = log2(last / error);
    ck_assert_msg(level == 0 || fabs(slope - order) <= (level == 1 ? 0.6 : 0.2),
                  "%s %s: slope %.2f at h = %g (error %g)", model->name, method, slope, h, error);
    last = error;
    dvi_integrator_destroy(&integrator);
  }
}

static double step_of(const problem *model)
{
  return strcmp(model->name, "vortices") == 0         ? 0.0625
         : strcmp(model->name, "guiding-centre") == 0 ? 32
                                                      : 0.25;
}

START_TEST(in_another_gauge_the_trajectory_is_the_same_to_the_methods_order)
{
  product own;
  const place *at = &places[_i];
  problem *model = create_problem(at->problem,
                                  NULL); /* its digits, because the motion is that of every gauge */
  problem *in_gauge = create_problem(at->problem, at->setting);
  const dvi_gauge f = declare_gauge(at, model->nq, &own);
  dvi_system *system = gauged(in_gauge, &f);
  check_order(model, system, "vprk", step_of(model), 4);
  dvi_system_destroy(&system);
  problem_destroy(&model);
  problem_destroy(&in_gauge);
}
END_TEST

START_TEST(a_gauge_brings_systems_into_the_class_of_one_step_methods)
{
  static const struct {
    const char *method;
    int order;
  } claims[] = {{"dvi-midpoint", 2}, {"dvi-trapezoidal", 2}, {"dvrk", 4}};
  product own;
  const place *at = &places[_i];
  problem *model = create_problem(at->problem, at->setting);
  const dvi_gauge f = declare_gauge(at, model->nq, &own);
  dvi_system *system = gauged(model, &f);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, "dvrk", &none), DVI_UNSUPPORTED);
  for (int k = 0; k < 3; k++)
    check_order(model, system, claims[k].method, step_of(model) / 2, claims[k].order);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* singular + grad (x y) is the catalogue's standard gauge, number for number up to roundoff, also
 * if missing callbacks are differenced. */
START_TEST(a_gauge_is_the_one_form_that_it_gives)
{
  product own;
  const place *at = &places[4];
  problem *singular = create_problem(at->problem, at->setting),
          *standard = create_problem(at->problem, NULL);
  dvi_gauge f = declare_gauge(at, 2, &own);
  if (_i == 1) f.third = NULL;
  dvi_system *system = gauged(singular, &f);
  dvi_integrator *a = create_integrator(system, "vprk:nodes=3"),
                 *b = start_integrator(standard, "vprk:nodes=3");
  ck_assert_msg(dvi_integrator_start(a, 0, standard->q, standard->p) == DVI_OK, "%s",
                dvi_last_error());
  advance(a, 0.1, 50);
  advance(b, 0.1, 50);
  ck_assert_double_le(distance(2, dvi_integrator_q(a), dvi_integrator_q(b)), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(a), dvi_integrator_p(b)), 1e-13);
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
  dvi_system_destroy(&system);
  problem_destroy(&singular);
  problem_destroy(&standard);
}
END_TEST

static int wrong_hessian(const double *at, double *f_qq, void *user)
{
  const int returned = hessian(at, f_qq, user);
  f_qq[1] += 1e-3;
  return returned;
}

static int wrong_third(const double *at, const double *w, double *f_w_qq, void *user)
{
  const int returned = form_third_derivative(at, w, f_w_qq, user);
  f_w_qq[0] += 1e-3;
  return returned;
}

START_TEST(bad_gauges_are_refused_and_wrong_ones_found)
{
  static const int upper_start[] = {0, 1, 3}, upper_row[] = {0, 0, 1};
  product own;
  problem *model = create_problem("massless-particle", NULL),
          *regular = create_problem("kepler", NULL);
  const dvi_gauge good = declare_gauge(&places[2], 2, &own);
  dvi_gauge bad = good;
  dvi_system *system = NULL;
  dvi_system_terms terms = *model->terms;
  terms.gauge = &bad;
  bad.hessian = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("the gauge has no Hessian callback");
  bad = good;
  bad.qq = (dvi_pattern){upper_start, upper_row};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("both triangles");
  bad = good;
  bad.hessian = wrong_hessian;
  system = gauged(model, &bad);
  ck_assert_int_eq(dvi_system_check(system, 0, q, v, 0, NULL), DVI_BAD_ARGUMENT);
  check_words("system check: gauge: d2f/dq2 (1,0) is");
  dvi_system_destroy(&system);
  bad = good;
  bad.third = wrong_third;
  system = gauged(model, &bad);
  ck_assert_int_eq(dvi_system_check(system, 0, q, v, 0, NULL), DVI_BAD_ARGUMENT);
  check_words("system check: gauge: d2(grad f.v)/dq2 (0,0) is");
  dvi_system_destroy(&system);
  terms = *regular->terms;
  terms.gauge = &good;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("a gauge without a one-form");
  problem_destroy(&model);
  problem_destroy(&regular);
}
END_TEST

START_TEST(a_system_in_another_gauge_survives_every_failure_of_memory)
{
  product own;
  problem *model = create_problem("vortices", NULL);
  const dvi_gauge f = declare_gauge(&places[0], 4, &own);
  const long before = dvi__allocation_count();
  dvi_system *system = gauged(model, &f);
  const long needed = dvi__allocation_count() - before;
  dvi_system_destroy(&system);
  dvi_system_terms terms = *model->terms;
  terms.gauge = &f;
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi_system_create(&terms, &system);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    ck_assert_ptr_null(system);
  }
  ck_assert_int_gt(needed, 20);
  problem_destroy(&model);
}
END_TEST

SUITE(gauge)
{
  tcase_add_loop_test(tests, the_two_form_stays_and_the_momenta_move_by_the_gradient, 0, PLACES);
  tcase_add_loop_test(tests, in_another_gauge_the_trajectory_is_the_same_to_the_methods_order, 0,
                      PLACES);
  tcase_add_loop_test(tests, a_gauge_brings_systems_into_the_class_of_one_step_methods, 0,
                      IN_CLASS);
  tcase_add_loop_test(tests, a_gauge_is_the_one_form_that_it_gives, 0, 2);
  tcase_add_test(tests, bad_gauges_are_refused_and_wrong_ones_found);
  tcase_add_test(tests, a_system_in_another_gauge_survives_every_failure_of_memory);
}
