/* labels: order */
/* Row terms from outside of the library's files, as CONTRIBUTING's recipe "Adding a term inside a
 * method" says. A force of Rayleigh's kind and a multiplier are each added to galerkin's step. */
#include "step/element/row_term.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "method/element/element_step.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/forced.h"

/* ---- a stepper with a term ---- */

typedef struct run {
  dvi_system *system;
  dvi_counters counters;
  dvi__stepper stepper;
  dvi__state state;
  double numbers[8];
} run;

static void start_run(run *r, const dvi_system_terms *terms, const char *method,
                      const dvi__row_term *term, const double *q, const double *p)
{
  *r = (run){.system = NULL};
  ck_assert_int_eq(dvi_system_create(terms, &r->system), DVI_OK);
  ck_assert_int_eq(dvi__stepper_create(r->system, method, NULL, &r->counters, &r->stepper), DVI_OK);
  ck_assert_msg(dvi__element_add_term(&r->stepper, term) == DVI_OK, "%s", dvi_last_error());
  r->stepper.memory = calloc(r->stepper.memory_count, sizeof(double));
  ck_assert_ptr_nonnull(r->stepper.memory);
  r->state = (dvi__state){.q = r->numbers,
                          .p = r->numbers + 2,
                          .q_compensation = r->numbers + 4,
                          .p_compensation = r->numbers + 6};
  memcpy(r->state.q, q, (size_t)terms->dimension * sizeof *q);
  memcpy(r->state.p, p, (size_t)terms->dimension * sizeof *p);
}

/* Takes steps of h from the start. The velocity is p, for masses are 1. */
static void take_steps(run *r, double h, int steps)
{
  dvi__stepper_start(&r->stepper, r->state.p);
  for (int i = 0; i < steps; i++)
    ck_assert_msg(r->stepper.method->step(&r->stepper, &r->state, h) == DVI_OK, "step %d: %s", i,
                  dvi_last_error());
}

static void finish_run(run *r)
{
  free(r->stepper.memory);
  dvi__stepper_destroy(&r->stepper);
  dvi_system_destroy(&r->system);
}

/* ---- damping: F = -dR/dv with Rayleigh's function R = c v^2/2 ---- */

static const double damping = 0.3;
enum { NODES_MOST = 16 };

typedef struct rayleigh {
  dvi__pattern pattern;
  double F[NODES_MOST], F_q[NODES_MOST], F_v[NODES_MOST];
} rayleigh;

static dvi_status add_damping(void *user, const dvi__row_path *path, const double *own, double *R,
                              double *dp, double *own_R)
{
  rayleigh *r = user;
  (void)own, (void)own_R;
  for (int j = 0; j < path->r; j++) r->F[j] = -damping * path->V[j];
  dvi__row_add_forces(path, r->F, R, dp);
  return DVI_OK;
}

static void add_damping_magnitudes(const void *user, const dvi__row_path *path, double *magnitude,
                                   double *own_magnitude)
{
  (void)own_magnitude;
  dvi__row_add_force_magnitudes(path, ((const rayleigh *)user)->F, magnitude);
}

static dvi_status add_damping_derivatives(void *user, const dvi__row_path *path, const double *own,
                                          const dvi__row_jacobian *J)
{
  rayleigh *r = user;
  (void)own;
  for (int j = 0; j < path->r; j++) r->F_q[j] = 0, r->F_v[j] = -damping;
  dvi__row_add_force_derivatives(path, &r->pattern, r->F_q, r->F_v, J);
  return DVI_OK;
}

/* |q - exact| after the time 4 of q'' + c q' + q = 0, q(0) = 1, q'(0) = 0. */
static double damping_error(const char *method, int steps)
{
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &unit_spring, .potential_count = 1};
  const double one = 1, zero = 0, a = damping / 2, w = sqrt(1 - a * a), t = 4;
  rayleigh r = {.F = {0}};
  ck_assert_int_eq(dvi__pattern_diagonal(1, &r.pattern), DVI_OK);
  const dvi__row_term term = {.name = "damping",
                              .of = &r,
                              .pattern = &r.pattern,
                              .rows = add_damping,
                              .magnitudes = add_damping_magnitudes,
                              .derivatives = add_damping_derivatives};
  run made;
  start_run(&made, &terms, method, &term, &one, &zero);
  take_steps(&made, t / steps, steps);
  const double q = exp(-a * t) * (cos(w * t) + a / w * sin(w * t)),
               p = -exp(-a * t) / w * sin(w * t);
  const double error = hypot(made.state.q[0] - q, made.state.p[0] - p);
  finish_run(&made);
  dvi__pattern_clear(&r.pattern);
  return error;
}

START_TEST(a_damped_oscillator_has_the_order_of_the_method)
{
  const char *const solver[] = {"", ",solver=newton", ",solver=kinsol", ",solver=simplified"};
  for (int degree = 1; degree <= 3; degree++)
    for (int k = 0; k < 4; k++) {
      const char *method = method_spec("galerkin:degree=%d%s", degree, solver[k]);
      double before = damping_error(method, 4);
      for (int steps = 8; steps <= 32; steps *= 2) {
        const double error = damping_error(method, steps), order = log2(before / error);
        ck_assert_msg(fabs(order - 2 * degree) < 0.25, "%s: order %g at %d steps", method, order,
                      steps);
        before = error;
      }
    }
}
END_TEST

/* ---- a rod of length 1: phi = |q|^2 - 1 = 0 at the end of each step, by a multiplier at its start
 * ---- */

static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[1];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  V_q[0] = 0, V_q[1] = 1;
  return 0;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  V_qq[0] = V_qq[1] = 0;
  return 0;
}

/* The start's momentum is p0 + lambda G(q0) with G = 2 q, hence R_k -= psi_k(1) lambda G
 * (Leimkuhler and Skeel 1994). */
static dvi_status add_rod(void *user, const dvi__row_path *p, const double *own, double *R,
                          double *dp, double *own_R)
{
  (void)user;
  for (int i = 0; i < 2; i++) {
    const double impulse = own[0] * 2 * p->q0[i];
    for (int k = 0; k < p->s; k++) R[i * p->s + k] -= p->end[k] * impulse;
    dp[i] += impulse;
  }
  own_R[0] = p->q1[0] * p->q1[0] + p->q1[1] * p->q1[1] - 1;
  return DVI_OK;
}

static dvi_status add_rod_derivatives(void *user, const dvi__row_path *p, const double *own,
                                      const dvi__row_jacobian *J)
{
  (void)user, (void)own;
  for (int i = 0; i < 2; i++) {
    double *column = dvi__row_own_column(J, 0, i);
    for (int k = 0; k < p->s; k++) column[k] -= p->end[k] * 2 * p->q0[i];
    for (int l = 0; l < p->s; l++) dvi__row_own_rows(J, 0, i, l)[0] += 2 * p->q1[i] * p->end[l];
  }
  return DVI_OK;
}

static void scale_rod(const void *user, double h, double *scale)
{
  (void)user, (void)h;
  scale[0] = 1;
}

/* Gives the angle after the time 2 of a pendulum that starts at rest, at 1 radian from below, and
 * the largest |phi|. */
static double rod_angle(int degree, int steps, double *off)
{
  const dvi_potential weight = {
      .value = weight_value, .gradient = weight_gradient, .hessian = weight_hessian};
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .potentials = &weight, .potential_count = 1};
  const double q[] = {sin(1.0), -cos(1.0)}, rest[] = {0, 0};
  dvi__pattern both;
  ck_assert_int_eq(dvi__pattern_copy_rectangular(&(dvi_pattern){0}, 2, 1, "both", &both), DVI_OK);
  const dvi__row_term term = {.name = "rod",
                              .unknowns = 1,
                              .acting = &both,
                              .rows = add_rod,
                              .derivatives = add_rod_derivatives,
                              .scale = scale_rod};
  run made;
  start_run(&made, &terms,
            method_spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", degree, degree + 1),
            &term, q, rest);
  take_steps(&made, 2.0 / steps, steps);
  *off = fabs(hypot(made.state.q[0], made.state.q[1]) - 1);
  const double angle = atan2(made.state.q[0], -made.state.q[1]);
  finish_run(&made);
  dvi__pattern_clear(&both);
  return angle;
}

/* A multiplier at the ends has order 2 for every degree, because the path between them does not
 * depend on the rod. */
START_TEST(a_multiplier_holds_its_constraint_and_has_order_2)
{
  for (int degree = 1; degree <= 2; degree++) {
    double off, finest = rod_angle(degree, 4096, &off), before = 0;
    for (int steps = 16; steps <= 256; steps *= 2) {
      const double error = fabs(rod_angle(degree, steps, &off) - finest);
      ck_assert_msg(off < 1e-14, "|q| is off by %g", off);
      if (before > 0)
        ck_assert_msg(fabs(log2(before / error) - 2) < 0.1, "order %g at %d steps",
                      log2(before / error), steps);
      before = error;
    }
  }
}
END_TEST

START_TEST(too_many_terms_are_refused)
{
  const double one = 1, zero = 0;
  rayleigh r = {.F = {0}};
  ck_assert_int_eq(dvi__pattern_diagonal(1, &r.pattern), DVI_OK);
  const dvi__row_term term = {
      .name = "damping", .of = &r, .pattern = &r.pattern, .rows = add_damping};
  run made;
  start_run(&made, &(dvi_system_terms){.dimension = 1, .mass = {.scalar = 1}}, "galerkin", &term,
            &one, &zero);
  for (int k = 1; k < 8; k++) ck_assert_int_eq(dvi__element_add_term(&made.stepper, &term), DVI_OK);
  ck_assert_int_eq(dvi__element_add_term(&made.stepper, &term), DVI_BAD_SIZE);
  check_words("damping is one term of the rows too many; 8 are possible");
  finish_run(&made);
  dvi__pattern_clear(&r.pattern);
}
END_TEST

SUITE(row_term)
{
  tcase_add_test(tests, a_damped_oscillator_has_the_order_of_the_method);
  tcase_add_test(tests, a_multiplier_holds_its_constraint_and_has_order_2);
  tcase_add_test(tests, too_many_terms_are_refused);
}
