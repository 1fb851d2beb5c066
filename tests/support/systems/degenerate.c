#include "support/systems/degenerate.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

enum { LEVELS = 4, COORDINATES_MOST = 4 };

/* Measures errors at the end of the span for four steps. Errors that thousands of roundings may
 * explain are not fitted. */
void check_degenerate_order(const char *name, const char *setting, const char *method, double h,
                            int expected)
{
  problem *model = create_problem(name, setting), *standard = create_problem(name, NULL);
  double last = 0;
  int fitted = 0;
  for (int level = 0; level < LEVELS; level++, h /= 2) {
    dvi_integrator *integrator = start_integrator(model, method);
    ck_assert_int_eq(dvi_integrator_order(integrator), expected);
    advance(integrator, h, lround(model->order_t_end / h));
    const double error = distance(model->nq, dvi_integrator_q(integrator), standard->digits_q);
    const double floor = 5e-13 * fmax(1, magnitude(model->nq, standard->digits_q)),
                 slope = log2(last / error);
    if (level > 0 && error > floor) {
      /* the first two steps may not be asymptotic yet */
      const double within = level == 1 ? 0.7 : 0.2;
      ck_assert_msg(fabs(slope - expected) <= within, "%s %s: slope %.2f at h = %g (error %g)",
                    name, method, slope, h, error);
      fitted++;
    }
    last = error;
    dvi_integrator_destroy(&integrator);
  }
  ck_assert_msg(fitted >= 1, "%s %s: nothing above the floor", name, method);
  problem_destroy(&model);
  problem_destroy(&standard);
}

double constraint_defect(const problem *model, const dvi_integrator *integrator)
{
  double alpha[COORDINATES_MOST];
  ck_assert_int_eq(
      dvi_system_momentum(model->system, 0, dvi_integrator_q(integrator), model->v, alpha), DVI_OK);
  return distance(model->nq, alpha, dvi_integrator_p(integrator));
}

/* Compares the largest errors of the first half of a run and of the second half. Over so many steps
 * the energy of a method that drifts by 1e-14 a step would change by more than the allowed
 * difference. */
void check_long_run(const char *name, const char *setting, const char *method, double h, long steps,
                    double bound, double most_of_momentum)
{
  problem *model = create_problem(name, setting);
  dvi_integrator *integrator = start_integrator(model, method);
  double first[8], now[8], half[2] = {0, 0}, momentum = 0;
  const int count = dvi_system_invariant_count(model->system);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  for (long k = 0; k < steps; k++) {
    advance(integrator, h, 1);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    half[2 * k / steps] = fmax(half[2 * k / steps], fabs(now[0] - first[0]) / fabs(first[0]));
    for (int i = 1; i < count; i++) momentum = fmax(momentum, fabs(now[i] - first[i]));
  }
  ck_assert_msg(half[0] <= bound && half[1] <= 1.02 * half[0] + 1e-12,
                "%s %s: energy errors %g, then %g", name, method, half[0], half[1]);
  ck_assert_double_le(momentum, most_of_momentum);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}

enum { POINTS = 128 };

static double loop_integral(int n, dvi_integrator *const *point)
{
  double q[COORDINATES_MOST * POINTS], p[COORDINATES_MOST * POINTS], integral = 0;
  for (int k = 0; k < POINTS; k++)
    for (int i = 0; i < n; i++) {
      q[i * POINTS + k] = dvi_integrator_q(point[k])[i];
      p[i * POINTS + k] = dvi_integrator_p(point[k])[i];
    }
  ck_assert_int_eq(dvi_loop_integral(n, POINTS, q, p, &integral), DVI_OK);
  return integral;
}

double loop_integral_change(const char *name, const char *setting, const char *method, double h,
                            long steps)
{
  problem *model = create_problem(name, setting);
  dvi_integrator *point[POINTS];
  for (int k = 0; k < POINTS; k++) {
    const double angle = 2 * 3.14159265358979323846 * k / POINTS,
                 q[2] = {model->q[0] + 0.05 * cos(angle), model->q[1] + 0.05 * sin(angle)};
    double p[2];
    point[k] = create_integrator(model->system, method);
    ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(point[k], 0, q, p), DVI_OK);
  }
  const double before = loop_integral(model->nq, point);
  for (int k = 0; k < POINTS; k++) advance(point[k], h, steps);
  const double change = fabs(loop_integral(model->nq, point) / before - 1);
  for (int k = 0; k < POINTS; k++) dvi_integrator_destroy(&point[k]);
  problem_destroy(&model);
  return change;
}

/* ---- twins ---- */

static int kinetic_form(const double *q, double *alpha, void *user)
{
  (void)user;
  for (int i = 0; i < 2; i++) {
    alpha[i] = 0;
    alpha[2 + i] = q[i];
  }
  return 0;
}

static int kinetic_gradient(const double *q, double *alpha_q, void *user)
{
  (void)q, (void)user;
  for (int i = 0; i < 16; i++) alpha_q[i] = i == 8 || i == 13;
  return 0;
}

static int kinetic_hessian(const double *q, const double *w, double *alpha_w_qq, void *user)
{
  (void)q, (void)w, (void)user;
  memset(alpha_w_qq, 0, 16 * sizeof *alpha_w_qq);
  return 0;
}

static int twin_energy(double t, const double *q, double *H, void *user)
{
  const dvi_potential *well = user;
  const int returned = well->value_batch(1, &t, q + 2, H, well->user);
  *H += 0.5 * (q[0] * q[0] + q[1] * q[1]);
  return returned;
}

static int twin_energy_gradient(double t, const double *q, double *H_q, void *user)
{
  const dvi_potential *well = user;
  for (int i = 0; i < 2; i++) H_q[i] = q[i];
  return well->gradient_batch(1, &t, q + 2, H_q + 2, well->user);
}

static int twin_energy_hessian(double t, const double *q, double *H_qq, void *user)
{
  const dvi_potential *well = user;
  double V[4];
  memset(H_qq, 0, 16 * sizeof *H_qq);
  H_qq[0] = H_qq[5] = 1;
  const int returned = well->hessian_batch(1, &t, q + 2, V, well->user);
  for (int e = 0; e < 4; e++) H_qq[4 * (2 + e / 2) + 2 + e % 2] = V[e];
  return returned;
}

twins create_twins(void)
{
  twins both = {.regular = create_problem("henon-heiles", NULL)};
  static dvi_potential well;
  well = both.regular->terms->potentials[0];
  const dvi_one_form form = {
      .value = kinetic_form, .gradient = kinetic_gradient, .hessian = kinetic_hessian};
  const dvi_potential H = {.value = twin_energy,
                           .gradient = twin_energy_gradient,
                           .hessian = twin_energy_hessian,
                           .user = &well};
  const dvi_system_terms terms = {
      .dimension = 4, .one_form = &form, .potentials = &H, .potential_count = 1, .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &both.degenerate) == DVI_OK, "%s", dvi_last_error());
  return both;
}

void destroy_twins(twins *both)
{
  dvi_system_destroy(&both->degenerate);
  problem_destroy(&both->regular);
}

static dvi_integrator *start_twin(const twins *both, const char *method)
{
  const double *x = both->regular->q, *y = both->regular->p, q[] = {y[0], y[1], x[0], x[1]},
               p[] = {0, 0, y[0], y[1]};
  dvi_integrator *integrator = create_integrator(both->degenerate, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

enum { TWIN_STEPS = 50 };
/* the tolerance allows some roundings a step of numbers below 1 */
static const double twin_h = 0.1, twin_tolerance = 2e-13;

void check_same_as_regular(const char *degenerate, const char *regular)
{
  twins both = create_twins();
  dvi_integrator *a = start_twin(&both, degenerate), *b = start_integrator(both.regular, regular);
  advance(a, twin_h, TWIN_STEPS);
  advance(b, twin_h, TWIN_STEPS);
  ck_assert_int_eq(dvi_integrator_order(a), dvi_integrator_order(b));
  ck_assert_double_le(distance(2, dvi_integrator_q(a), dvi_integrator_p(b)), twin_tolerance);
  ck_assert_double_le(distance(2, dvi_integrator_q(a) + 2, dvi_integrator_q(b)), twin_tolerance);
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
  destroy_twins(&both);
}

/* p = p - h V'(x) */
static void kick_momentum(const twins *both, const double *x, double *p)
{
  double force[2];
  const dvi_potential *well = both->regular->terms->potentials;
  ck_assert_int_eq(well->gradient_batch(1, &(double){0}, x, force, well->user), 0);
  for (int i = 0; i < 2; i++) p[i] -= twin_h * force[i];
}

void check_symplectic_euler(const char *degenerate, int momentum_first)
{
  twins both = create_twins();
  dvi_integrator *integrator = start_twin(&both, degenerate);
  double x[2], p[2];
  memcpy(x, both.regular->q, sizeof x);
  memcpy(p, both.regular->p, sizeof p);
  for (int step = 0; step < TWIN_STEPS; step++) {
    if (momentum_first) kick_momentum(&both, x, p);
    for (int i = 0; i < 2; i++) x[i] += twin_h * p[i];
    if (!momentum_first) kick_momentum(&both, x, p);
  }
  advance(integrator, twin_h, TWIN_STEPS);
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator), p), twin_tolerance);
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator) + 2, x), twin_tolerance);
  dvi_integrator_destroy(&integrator);
  destroy_twins(&both);
}

/* ---- class ---- */

static int no_form(const double *q, double *alpha, void *user)
{
  (void)q, (void)user;
  alpha[0] = 1;
  alpha[1] = 2;
  return 0;
}

/* The gradient may belong to alpha = grad (c (x^2 + y^2)/2), which has no two-form, either. */
static int no_curl(const double *q, double *alpha_q, void *user)
{
  (void)q;
  alpha_q[0] = alpha_q[3] = *(const double *)user;
  alpha_q[1] = alpha_q[2] = 0;
  return 0;
}

/* No gauge helps where the two-form is 0. */
static void check_no_two_form(const char *method, double c)
{
  const dvi_one_form form = {.value = no_form, .gradient = no_curl, .user = &c};
  const dvi_system_terms terms = {.dimension = 2, .one_form = &form};
  dvi_system *system = NULL;
  dvi_integrator *none = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_integrator_create(system, method, &none), DVI_UNSUPPORTED);
  check_words("singular at all of 12 points probed");
  dvi_system_destroy(&system);
}

void check_refused_one_forms(const char *method)
{
  static const struct {
    const char *problem, *words;
  } outside[] = {{"lotka-volterra",
                  "0 of 2 are; use the gauge alpha + grad f with df/dq_i = -alpha_i for q[0],"},
                 {"massless-particle", "df/dq_i = -alpha_i for q[0],"},
                 {"vortices", "df/dq_i = -alpha_i for q[0], q[2],"},
                 {"guiding-centre", "1 of 4 are; use the gauge"},
                 {"lotka-volterra-4d", "no gauge helps"},
                 {"tokamak", "no gauge helps"}};
  for (size_t k = 0; k < sizeof outside / sizeof *outside; k++) {
    problem *model = create_problem(outside[k].problem, NULL);
    dvi_integrator *none = NULL;
    ck_assert_int_eq(dvi_integrator_create(model->system, method, &none), DVI_UNSUPPORTED);
    check_words(outside[k].words);
    ck_assert_ptr_null(none);
    problem_destroy(&model);
  }
  check_no_two_form(method, 0);
  check_no_two_form(method, 1);
}

void check_one_step(const char *method, int order)
{
  check_degenerate_order("lotka-volterra", "gauge=singular", method, 0.0625, order);
  check_degenerate_order("massless-particle", "gauge=singular", method, 0.125, order);
  check_refused_one_forms(method);
}
