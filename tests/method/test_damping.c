/* labels: order */
/* Uniform friction -gamma p: orders, contraction of the symplectic form, momenta, balances. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/friction/damped.h"

/* ---- orders ---- */

typedef struct claim {
  const char *method;
  int order;
  int steps; /* of the longest step over a time of 4 */
} claim;

static const claim claims[] = {
    {"verlet", 2, 40},
    {"midpoint", 2, 40},
    {"trapezoidal", 2, 40},
    {"galerkin:degree=1", 2, 40},
    {"galerkin:degree=2", 4, 20},
    {"galerkin:degree=3", 6, 8},
    {"galerkin:degree=4", 8, 5},
    {"galerkin:degree=2,quadrature=lobatto,nodes=2", 2, 60},
    {"galerkin:degree=3,quadrature=lobatto", 6, 8},
    {"galerkin:degree=2,solver=newton", 4, 20},
    {"galerkin:degree=2,solver=fixed-point", 4, 20},
    {"galerkin:degree=2,solver=kinsol", 4, 20},
    {"composition:order=4,base=verlet", 4, 40},
    {"composition:order=6,base=midpoint", 6, 10},
    {"lie-verlet", 2, 80},
    {"lie-galerkin:degree=1", 2, 40},
    {"lie-galerkin:degree=2", 4, 20},
    {"lie-galerkin:degree=3", 6, 10},
    {"composition:order=4,base=lie-verlet", 4, 80},
};
enum { CLAIMS = sizeof claims / sizeof *claims, LEVELS = 5, STATE = DAMPED_NQ + DAMPED_NV };

static const double span = 4;

/* Writes the exact q and p of the oscillator, or those of IDA, at the span's end. */
static void judge_damped(damped_kind kind, const damped *model, double *end)
{
  const dvi_reference_options tight = {.code = DVI_IDA, .relative_tolerance = 1e-13};
  double *q = end, *p = end + DAMPED_NQ;
  if (kind == DAMPED_OSCILLATOR) {
    const double half = model->gamma / 2, w = sqrt(1 - half * half), decay = exp(-half * span),
                 b = (model->v[0] + half * model->q[0]) / w, c = cos(w * span), s = sin(w * span);
    q[0] = decay * (model->q[0] * c + b * s);
    p[0] = decay * ((b * w - half * model->q[0]) * c - (model->q[0] * w + half * b) * s);
    return;
  }
  memcpy(q, model->q, sizeof model->q);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
  ck_assert_msg(dvi_reference_solve(model->system, 0, span, q, p, &tight, NULL) == DVI_OK, "%s",
                dvi_last_error());
}

static double error_at_end(const damped *model, const char *method, int steps, const double *end)
{
  dvi_integrator *integrator = damped_integrator(model, method);
  advance(integrator, span / steps, steps);
  const double error = fmax(distance(model->nq, dvi_integrator_q(integrator), end),
                            distance(model->nv, dvi_integrator_p(integrator), end + DAMPED_NQ));
  dvi_integrator_destroy(&integrator);
  return error;
}

/* The slope between the two shortest steps whose errors are above the judge's own. */
static void check_claim(damped_kind kind, const claim *c)
{
  damped model;
  double end[STATE] = {0}, error[LEVELS];
  const double floor = kind == DAMPED_OSCILLATOR ? 5e-14 : 3e-11;
  int last = -1;
  make_damped(kind, 0.3, &model);
  judge_damped(kind, &model, end);
  for (int level = 0; level < LEVELS; level++) {
    error[level] = error_at_end(&model, c->method, c->steps << level, end);
    if (error[level] > floor) last = level;
  }
  ck_assert_msg(last >= 1, "%s of %s: nothing to fit, the first error is %.1e", c->method,
                model.name, error[0]);
  const double slope = log2(error[last - 1] / error[last]);
  ck_assert_msg(fabs(slope - c->order) < (last >= 2 ? 0.3 : 0.6),
                "%s of %s: order %.2f, not %d, from the errors %.2e, %.2e, %.2e, %.2e, %.2e",
                c->method, model.name, slope, c->order, error[0], error[1], error[2], error[3],
                error[4]);
  destroy_damped(&model);
}

/* IDA's own error, 2e-12 where a force acts, hides order 8. */
static int takes(const char *method, damped_kind kind)
{
  if (kind == DAMPED_DRIVE && strcmp(method, "galerkin:degree=4") == 0) return 0;
  if (kind >= DAMPED_TOP) return strstr(method, "lie") != NULL;
  return strstr(method, "lie") == NULL &&
         (kind != DAMPED_DRIVE || strstr(method, "verlet") == NULL);
}

START_TEST(damping_keeps_the_order)
{
  const claim *c = &claims[_i];
  for (int kind = 0; kind < DAMPED_FREE_TOP; kind++)
    if (takes(c->method, (damped_kind)kind)) check_claim((damped_kind)kind, c);
}
END_TEST

/* ---- the symplectic form ---- */

static const char *const methods[] = {"verlet",
                                      "midpoint",
                                      "galerkin:degree=2",
                                      "galerkin:degree=3,quadrature=lobatto",
                                      "composition:order=4,base=verlet",
                                      "galerkin:degree=5"};
enum { METHODS = sizeof methods / sizeof *methods };

/* The map of a step of the oscillator is linear. Its determinant is e^{-gamma h}, at any step,
 * to the roundings of the factors, of which a composition has eight. */
START_TEST(area_shrinks_by_the_rate_alone)
{
  static const double unit[2][2] = {{1, 0}, {0, 1}};
  damped model;
  make_damped(DAMPED_OSCILLATOR, 0.7, &model);
  dvi_integrator *integrator = damped_integrator(&model, methods[_i]);
  for (int k = 0; k < 4; k++) {
    const double h = ldexp(0.8, -k);
    double end[2][2];
    for (int j = 0; j < 2; j++) {
      ck_assert_int_eq(dvi_integrator_start(integrator, 0, &unit[j][0], &unit[j][1]), DVI_OK);
      advance(integrator, h, 1);
      end[j][0] = *dvi_integrator_q(integrator);
      end[j][1] = *dvi_integrator_p(integrator);
    }
    const double area = end[0][0] * end[1][1] - end[0][1] * end[1][0];
    ck_assert_msg(fabs(area - exp(-0.7 * h)) < 1e-15, "%s: area %.17g at h = %g, not %.17g",
                  methods[_i], area, h, exp(-0.7 * h));
  }
  dvi_integrator_destroy(&integrator);
  destroy_damped(&model);
}
END_TEST

/* Adds d along a direction of phase space to the start of the plane's motion, takes a step, and
 * adds factor times its end. */
static void add_moved(dvi_integrator *integrator, const double *start, int direction, double d,
                      double factor, double *sum)
{
  double moved[4];
  memcpy(moved, start, sizeof moved);
  moved[direction] += d;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, moved, moved + 2), DVI_OK);
  advance(integrator, 0.2, 1);
  for (int i = 0; i < 2; i++) {
    sum[i] += factor * dvi_integrator_q(integrator)[i];
    sum[2 + i] += factor * dvi_integrator_p(integrator)[i];
  }
}

/* M^T J M = e^{-gamma h} J for the derivative M of a nonlinear step, by differences of order 4. */
START_TEST(the_form_shrinks_by_the_rate_alone)
{
  const double d = 1e-3, start[4] = {1, 0.3, 0.4, 0.9}, rate = exp(-0.5 * 0.2);
  double M[4][4] = {{0}};
  damped model;
  make_damped(DAMPED_PLANE, 0.5, &model);
  dvi_integrator *integrator = damped_integrator(&model, methods[_i]);
  for (int j = 0; j < 4; j++) {
    add_moved(integrator, start, j, d, 2 / (3 * d), M[j]);
    add_moved(integrator, start, j, -d, -2 / (3 * d), M[j]);
    add_moved(integrator, start, j, 2 * d, -1 / (12 * d), M[j]);
    add_moved(integrator, start, j, -2 * d, 1 / (12 * d), M[j]);
  }
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      double form = 0;
      for (int i = 0; i < 2; i++) form += M[a][i] * M[b][2 + i] - M[a][2 + i] * M[b][i];
      const double expected = b == a + 2 ? rate : a == b + 2 ? -rate : 0;
      ck_assert_msg(fabs(form - expected) < 1e-10, "%s: form (%d,%d) is %.12g, not %.12g",
                    methods[_i], a, b, form, expected);
    }
  dvi_integrator_destroy(&integrator);
  destroy_damped(&model);
}
END_TEST

/* ---- momenta and balances ---- */

/* Momenta of symmetries are e^{-gamma t} times those of the start, at any step, to the rounding of
 * the factor e^{-gamma h/2} in each half (of three substeps in compositions of order 4), and their
 * balances close. */
START_TEST(momenta_decay_exactly)
{
  static const char *const on_bodies[] = {"lie-verlet", "lie-galerkin:degree=1",
                                          "lie-galerkin:degree=3",
                                          "composition:order=4,base=lie-verlet"};
  const int on_body = _i >= METHODS;
  const char *method = on_body ? on_bodies[_i - METHODS] : methods[_i];
  damped model;
  double start, now, defect;
  make_damped(on_body ? DAMPED_FREE_TOP : DAMPED_PLANE, 0.02, &model);
  dvi_integrator *integrator = damped_integrator(&model, method);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 1, &start), DVI_OK);
  const int steps = repeats(2000);
  for (int k = 1; k <= 4; k++) {
    advance(integrator, 0.1, steps / 4);
    const double rest = exp(-model.gamma * dvi_integrator_time(integrator));
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 1, &now), DVI_OK);
    ck_assert_int_eq(dvi_integrator_balance(integrator, 1, &defect), DVI_OK);
    ck_assert_msg(fabs(now / start / rest - 1) < 6 * 0.6e-16 * k * steps / 2,
                  "%s: the momentum is off by %.1e", method, now / start / rest - 1);
    ck_assert_msg(fabs(defect) < 1e-13, "%s: its balance is off by %.1e", method, defect);
  }
  dvi_integrator_destroy(&integrator);
  destroy_damped(&model);
}
END_TEST

/* The largest defect of the energy's balance over a time of 200. */
static double largest_defect(damped_kind kind, const char *method, double h)
{
  damped model;
  double largest = 0, defect;
  make_damped(kind, 0.05, &model);
  dvi_integrator *integrator = damped_integrator(&model, method);
  for (long k = lround(200 / h); k > 0; k--) {
    advance(integrator, h, 1);
    ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &defect), DVI_OK);
    largest = fmax(largest, fabs(defect));
  }
  dvi_integrator_destroy(&integrator);
  destroy_damped(&model);
  return largest;
}

START_TEST(energies_are_balanced_with_the_methods_order)
{
  static const struct {
    const char *method;
    damped_kind kind;
    int order;
  } of[] = {{"verlet", DAMPED_PLANE, 2},
            {"galerkin:degree=2", DAMPED_PLANE, 4},
            {"galerkin:degree=3", DAMPED_PLANE, 6},
            {"galerkin:degree=2", DAMPED_DRIVE, 4},
            {"lie-verlet", DAMPED_TOP, 2},
            {"lie-galerkin:degree=2", DAMPED_TOP, 4}};
  const double coarse = largest_defect(of[_i].kind, of[_i].method, 0.1),
               fine = largest_defect(of[_i].kind, of[_i].method, 0.05);
  ck_assert_msg(fabs(log2(coarse / fine) - of[_i].order) < 0.3, "%s: slope %.2f from %.2e, %.2e",
                of[_i].method, log2(coarse / fine), coarse, fine);
  ck_assert_double_le(coarse, of[_i].order == 2 ? 3e-2 : 2e-4);
}
END_TEST

/* Over a long run a driven system settles, and the defect does not grow faster than time. */
START_TEST(long_runs_balance)
{
  damped model;
  double first, last;
  make_damped(DAMPED_DRIVE, 0.05, &model);
  dvi_integrator *integrator = damped_integrator(&model, "galerkin:degree=3");
  advance(integrator, 0.1, repeats(2000));
  ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &first), DVI_OK);
  advance(integrator, 0.1, 9 * repeats(2000));
  ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &last), DVI_OK);
  ck_assert_double_lt(fabs(last), 1e-7);
  ck_assert_double_lt(fabs(last), 15 * fabs(first) + 1e-12);
  dvi_integrator_destroy(&integrator);
  destroy_damped(&model);
}
END_TEST

/* ---- reversal, lengths, members ---- */

START_TEST(steps_back_undo_steps)
{
  static const double lengths[] = {0.1, 0.03, 0.17};
  damped model;
  make_damped(DAMPED_PLANE, 0.4, &model);
  dvi_integrator *integrator = damped_integrator(&model, methods[_i]);
  for (int k = 0; k < 30; k++) advance(integrator, lengths[k % 3], 1);
  for (int k = 29; k >= 0; k--) advance(integrator, -lengths[k % 3], 1);
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator), model.q), 2e-13);
  ck_assert_double_eq_tol(dvi_integrator_supplied(integrator, 0), 0, 1e-12);
  dvi_integrator_destroy(&integrator);
  destroy_damped(&model);
}
END_TEST

/* Members of an ensemble have the bits of single runs. */
START_TEST(members_step_as_single_runs)
{
  damped model;
  make_damped(DAMPED_PLANE, 0.4, &model);
  dvi_ensemble *ensemble = create_ensemble(model.system, methods[_i],
                                           (dvi_ensemble_options){.members = 9});
  dvi_integrator *single = create_integrator(model.system, methods[_i]);
  const double p[2] = {0.25, 0.875};
  double q[18], momenta[18], end_q[18], end_p[18];
  for (int k = 0; k < 18; k++) {
    q[k] = model.q[k / 9];
    momenta[k] = p[k / 9];
  }
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, q, momenta), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.1, 20), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(ensemble, NULL, end_q, end_p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(single, 0, model.q, p), DVI_OK);
  advance(single, 0.1, 20);
  for (int i = 0; i < 2; i++) {
    ck_assert_double_eq(end_q[9 * i + 8], dvi_integrator_q(single)[i]);
    ck_assert_double_eq(end_p[9 * i + 8], dvi_integrator_p(single)[i]);
  }
  dvi_integrator_destroy(&single);
  dvi_ensemble_destroy(&ensemble);
  destroy_damped(&model);
}
END_TEST

SUITE(damping)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, damping_keeps_the_order, 0, CLAIMS);
  tcase_add_loop_test(tests, area_shrinks_by_the_rate_alone, 0, METHODS);
  tcase_add_loop_test(tests, the_form_shrinks_by_the_rate_alone, 0, METHODS);
  tcase_add_loop_test(tests, momenta_decay_exactly, 0, METHODS + 4);
  tcase_add_loop_test(tests, energies_are_balanced_with_the_methods_order, 0, 6);
  tcase_add_test(tests, long_runs_balance);
  tcase_add_loop_test(tests, steps_back_undo_steps, 0, METHODS);
  tcase_add_loop_test(tests, members_step_as_single_runs, 0, METHODS);
}
