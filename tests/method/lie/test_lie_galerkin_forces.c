/* labels: order */
/* Forces on bodies and directions: orders, balances, forces in joints, refusals. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <dvi/diagnostics.h>
#include <dvi/joint.h>
#include <dvi/reference.h>

#include "support/runs.h"
#include "support/suite.h"

/* A body and a direction, with weights, and forces between and on them. */
enum { NQ = 15, NV = 9 };

static const double inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9};

static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 9.81 * q[11] + 2 * q[14];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, NQ * sizeof *V_q);
  V_q[11] = 9.81;
  V_q[14] = 2;
  return 0;
}

static int drag(double t, const double *q, const double *v, double *F, void *user)
{
  (void)user;
  for (int i = 0; i < 3; i++) {
    F[i] = -0.3 * v[i] + 0.2 * sin(t) * q[3 * i + 1];
    F[3 + i] = -0.4 * v[3 + i] * v[3 + i] * v[3 + i] + 0.1 * q[i];
    F[6 + i] = -0.2 * v[6 + i] + 0.3 * q[i] * cos(t) + 0.1 * q[9 + i];
  }
  return 0;
}

/* Turns about the vertical: e_3 in the body's frame, and e_3 x. */
static int vertical(const double *q, double *xi, void *user)
{
  (void)user;
  memcpy(xi, q + 6, 3 * sizeof *xi);
  xi[3] = -q[10], xi[4] = q[9], xi[5] = 0;
  xi[6] = -q[13], xi[7] = q[12], xi[8] = 0;
  return 0;
}

static const dvi_factor factors[] = {{.kind = DVI_SE3, .mass = 1, .inertia = inertia},
                                     {.kind = DVI_S2, .mass = .7}};
static const dvi_potential weight = {
    .name = "weight", .value = weight_value, .gradient = weight_gradient};
static const dvi_symmetry turns = {.name = "vertical", .generator = vertical};
static const double start_q[NQ] = {1, 0, 0, 0, 1, 0, 0, 0, 1, .1, .2, .3, .6, 0, -.8},
                    start_v[NV] = {.5, -.4, .7, .1, .2, .3, .8, .5, .6};

static dvi_system *dragged;

static dvi_system *create_dragged(const dvi_force *force)
{
  const dvi_system_terms terms = {.potentials = &weight,
                                  .potential_count = 1,
                                  .symmetries = &turns,
                                  .symmetry_count = 1,
                                  .factors = factors,
                                  .factor_count = 2,
                                  .forces = force,
                                  .force_count = 1};
  dvi_system *made;
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

static void make_dragged(void)
{
  dragged = create_dragged(&(dvi_force){.name = "drag", .value = drag});
}

static void forget_dragged(void)
{
  dvi_system_destroy(&dragged);
}

static dvi_integrator *start_balanced(const char *method)
{
  const dvi_integrator_options options = {.size = sizeof options, .method = method, .balances = 1};
  dvi_integrator *made;
  ck_assert_msg(dvi_integrator_create_with(dragged, &options, &made) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, start_q, start_v), DVI_OK);
  return made;
}

/* ---- orders and balances ---- */

static double judged[NQ];

static void judge_dragged(dvi_reference_code code)
{
  const dvi_reference_options tight = {.code = code, .relative_tolerance = 1e-13};
  double p[NV];
  memcpy(judged, start_q, sizeof judged);
  ck_assert_int_eq(dvi_system_momentum(dragged, 0, start_q, start_v, p), DVI_OK);
  ck_assert_msg(dvi_reference_solve(dragged, 0, 1, judged, p, &tight, NULL) == DVI_OK, "%s",
                dvi_last_error());
}

static void check_order_of(const char *method, int order)
{
  enum { COUNT = 6 };
  double h[COUNT], error[COUNT];
  dvi_order_fit fit;
  for (int k = 0; k < COUNT; k++) {
    dvi_integrator *made = start_balanced(method);
    h[k] = 1.0 / (6 << k);
    advance(made, h[k], 6 << k);
    error[k] = distance(NQ, dvi_integrator_q(made), judged);
    dvi_integrator_destroy(&made);
  }
  ck_assert_msg(dvi_order(COUNT, h, error, 1e-10, 1e-3, &fit) == DVI_OK, "%s: no window", method);
  ck_assert_msg(fabs(fit.slope - order) < 0.3, "%s: order %.2f, not %d", method, fit.slope, order);
}

START_TEST(steps_have_order_2s)
{
  judge_dragged(DVI_ARKODE);
  check_order_of(method_spec("lie-galerkin:degree=%d", _i), 2 * _i);
  check_order_of(method_spec("lie-galerkin:degree=%d,quadrature=lobatto,nodes=%d", _i, _i + 1),
                 2 * _i);
}
END_TEST

START_TEST(all_judges_agree)
{
  double first[NQ];
  judge_dragged(DVI_ARKODE);
  memcpy(first, judged, sizeof first);
  judge_dragged(DVI_IDA);
  ck_assert_double_le(distance(NQ, first, judged), 1e-9);
  judge_dragged(DVI_CVODE_BDF);
  ck_assert_double_le(distance(NQ, first, judged), 1e-9);
}
END_TEST

/* The momentum of turns is balanced to rounding, at any step. The energy has a defect of the order
 * of the method. */
START_TEST(supplies_balance_momenta_and_energy)
{
  double energy, before = 0;
  for (int k = 0; k < 3; k++) {
    dvi_integrator *made = start_balanced("lie-galerkin:degree=2");
    double worst = 0;
    for (int step = 0; step < 8 << k; step++) {
      double momentum;
      advance(made, 1.0 / (8 << k), 1);
      ck_assert_int_eq(dvi_integrator_balance(made, 1, &momentum), DVI_OK);
      worst = fmax(worst, fabs(momentum));
    }
    ck_assert_msg(worst < 3e-15, "a momentum off balance by %.1e", worst);
    ck_assert_double_ge(fabs(dvi_integrator_supplied(made, 1)), 1e-3);
    ck_assert_int_eq(dvi_integrator_balance(made, 0, &energy), DVI_OK);
    if (k > 0) ck_assert_double_eq_tol(log2(before / fabs(energy)), 4, 0.4);
    before = fabs(energy);
    dvi_integrator_destroy(&made);
  }
}
END_TEST

/* ---- friction in a joint ---- */

static int pin_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 9.81 * q[11];
  return 0;
}

static int pin_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, 12 * sizeof *V_q);
  V_q[11] = 9.81;
  return 0;
}

static int friction(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  memset(F, 0, 6 * sizeof *F);
  for (int i = 0; i < 3; i++) F[i] = -0.05 * v[i];
  return 0;
}

/* The pendulum of the hinge by its angle: J a'' = -m g l sin a - c a'. */
static int angle_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -2.943 * cos(*q);
  return 0;
}

static int angle_friction(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  *F = -0.05 * *v;
  return 0;
}

static double angle_after(double span)
{
  const dvi_potential V = {.name = "weight", .value = angle_value};
  const dvi_force F = {.name = "friction", .value = angle_friction};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass = {.scalar = .11},
                                  .potentials = &V,
                                  .potential_count = 1,
                                  .autonomous = 1,
                                  .forces = &F,
                                  .force_count = 1};
  const dvi_reference_options tight = {.code = DVI_ARKODE, .relative_tolerance = 1e-13};
  double q = 2, p = 0;
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_reference_solve(system, 0, span, &q, &p, &tight, NULL), DVI_OK);
  dvi_system_destroy(&system);
  return q;
}

START_TEST(a_hinge_with_friction_is_a_damped_pendulum)
{
  static const double light[] = {.02, 0, 0, 0, .02, 0, 0, 0, .02};
  const dvi_factor body = {.kind = DVI_SE3, .mass = 1, .inertia = light};
  const dvi_joint hinge = {.kind = DVI_HINGE, .body = {DVI_GROUND, 0}, .axis = {1, 0, 0}};
  const dvi_potential V = {.name = "weight", .value = pin_value, .gradient = pin_gradient};
  const dvi_force F = {.name = "friction", .value = friction};
  const double a = 2, l = .3, p[6] = {0};
  const double q[12] = {1, 0, 0, 0, cos(a), -sin(a), 0, sin(a), cos(a), 0, l * sin(a), -l * cos(a)};
  dvi_joints *joints;
  dvi_system *system;
  ck_assert_int_eq(dvi_joints_create(&body, 1, &hinge, 1, q, &joints), DVI_OK);
  const dvi_system_terms terms = {.potentials = &V,
                                  .potential_count = 1,
                                  .autonomous = 1,
                                  .factors = &body,
                                  .factor_count = 1,
                                  .forces = &F,
                                  .force_count = 1,
                                  .holonomics = dvi_joints_constraints(joints),
                                  .holonomic_count = 1};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator *made = create_integrator(system, "lie-galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_start(made, 0, q, p), DVI_OK);
  advance(made, 0.01, 300);
  const double *end = dvi_integrator_q(made);
  ck_assert_double_eq_tol(sin(atan2(end[7], end[8])), sin(angle_after(3)), 1e-8);
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
  dvi_joints_destroy(&joints);
}
END_TEST

/* ---- Verlet's method takes forces of time and place ---- */

static int stir(double t, const double *q, const double *v, double *F, void *user)
{
  (void)v, (void)user;
  for (int i = 0; i < 3; i++) {
    F[i] = 0.2 * sin(t) * q[3 * i + 1];
    F[3 + i] = 0.1 * q[i] - 0.3 * q[9 + i];
    F[6 + i] = 0.3 * q[i] * cos(t) + 0.1 * q[9 + i];
  }
  return 0;
}

static void stir_instead(void)
{
  forget_dragged();
  dragged = create_dragged(&(dvi_force){.name = "stir", .value = stir, .without_velocity = 1});
}

START_TEST(verlet_has_order_2_with_forces_of_place_and_composes)
{
  stir_instead();
  judge_dragged(DVI_IDA);
  check_order_of("lie-verlet", 2);
  check_order_of("composition:order=4,base=lie-verlet", 4);
}
END_TEST

START_TEST(verlet_balances_momenta_and_energy)
{
  double defect[2][2] = {{0}}, now;
  stir_instead();
  for (int level = 0; level < 2; level++) {
    dvi_integrator *made = start_balanced("lie-verlet");
    for (int k = 0; k < 200 << level; k++) {
      advance(made, ldexp(0.01, -level), 1);
      for (int i = 0; i < 2; i++) {
        ck_assert_int_eq(dvi_integrator_balance(made, i, &now), DVI_OK);
        defect[level][i] = fmax(defect[level][i], fabs(now));
      }
    }
    dvi_integrator_destroy(&made);
    ck_assert_double_le(defect[level][1], 1e-13);
  }
  ck_assert_double_eq_tol(log2(defect[0][0] / defect[1][0]), 2, 0.2);
}
END_TEST

/* ---- declarations and refusals ---- */

static int no_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                       void *user)
{
  (void)t, (void)q, (void)v, (void)F_q, (void)F_v, (void)user;
  return 0;
}

static int sideways(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)v, (void)user;
  memset(F, 0, NV * sizeof *F);
  F[3] = q[9];
  return 0;
}

/* A pattern of nv rows and nq columns, and the same force without one. */
START_TEST(patterns_change_nothing)
{
  static const int start[NQ + 1] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}, row[] = {3};
  const dvi_force sparse = {
      .name = "side", .value = sideways, .by_q = {start, row}, .without_velocity = 1};
  const dvi_force full = {.name = "side", .value = sideways, .without_velocity = 1};
  const dvi_force *const forces[] = {&sparse, &full};
  double q[2][NQ];
  for (int k = 0; k < 2; k++) {
    dvi_system *system = create_dragged(forces[k]);
    dvi_integrator *made = create_integrator(system, "lie-galerkin:degree=2");
    ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, start_q, start_v), DVI_OK);
    advance(made, 0.05, 20);
    memcpy(q[k], dvi_integrator_q(made), sizeof q[k]);
    dvi_integrator_destroy(&made);
    dvi_system_destroy(&system);
  }
  ck_assert_double_le(distance(NQ, q[0], q[1]), 1e-14);
}
END_TEST

START_TEST(jacobians_and_other_methods_are_refused)
{
  static const char *const methods[] = {"lie-verlet", "euler-poincare", "lie-rk", "verlet"};
  const dvi_force force = {.name = "drag", .value = drag, .jacobian = no_jacobian};
  const dvi_system_terms terms = {
      .factors = factors, .factor_count = 2, .forces = &force, .force_count = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("'drag' has a Jacobian, but with factors");
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    dvi_integrator *made;
    ck_assert_int_eq(dvi_integrator_create(dragged, methods[k], &made), DVI_UNSUPPORTED);
    if (k == 0) check_words("forces without a potential that depend on the velocity");
  }
}
END_TEST

SUITE(lie_galerkin_forces)
{
  tcase_add_checked_fixture(tests, make_dragged, forget_dragged);
  tcase_add_loop_test(tests, steps_have_order_2s, 1, 4);
  tcase_add_test(tests, all_judges_agree);
  tcase_add_test(tests, supplies_balance_momenta_and_energy);
  tcase_add_test(tests, a_hinge_with_friction_is_a_damped_pendulum);
  tcase_add_test(tests, verlet_has_order_2_with_forces_of_place_and_composes);
  tcase_add_test(tests, verlet_balances_momenta_and_energy);
  tcase_add_test(tests, patterns_change_nothing);
  tcase_add_test(tests, jacobians_and_other_methods_are_refused);
}
