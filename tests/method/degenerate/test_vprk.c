/* labels: order invariant */
/* Variational partitioned Runge-Kutta methods with projections: orders, constraint, energy, loop
 * integrals, refusals. */
#include <math.h>
#include <string.h>

#include "support/systems/degenerate.h"
#include "support/suite.h"

static const struct {
  const char *problem, *setting;
  double h;
} places[] = {{"lotka-volterra", NULL, 0.25},
              {"lotka-volterra", "gauge=singular", 0.25},
              {"lotka-volterra", "gauge=symmetric", 0.25},
              {"lotka-volterra-4d", NULL, 0.125},
              {"massless-particle", NULL, 0.5},
              {"massless-particle", "gauge=singular", 0.5},
              {"vortices-linear", NULL, 0.25},
              {"vortices", NULL, 0.0625},
              {"guiding-centre", NULL, 32},
              {"tokamak", NULL, 800}};
enum { PLACES = sizeof places / sizeof *places };

/* Orders 2, 4 and 6 show over four steps. Order 8 is at the floor after two of them on most
 * problems. */
START_TEST(gauss_with_the_symmetric_projection_has_order_2s)
{
  const int s = 1 + _i / PLACES, at = _i % PLACES;
  check_degenerate_order(places[at].problem, places[at].setting, method_spec("vprk:nodes=%d", s),
                         places[at].h, 2 * s);
}
END_TEST

static const struct {
  const char *problem, *setting, *method;
  double h;
  int order;
} kinds[] = {
    {"massless-particle", NULL, "vprk:nodes=1,projection=symplectic", 0.25, 2},
    {"massless-particle", NULL, "vprk:nodes=2,projection=symplectic", 0.25, 4},
    {"vortices", NULL, "vprk:nodes=3,projection=symplectic", 0.0625, 6},
    {"lotka-volterra", NULL, "vprk:nodes=4,projection=symplectic", 0.5, 8},
    {"massless-particle", NULL, "vprk:nodes=1,projection=midpoint", 0.25, 2},
    {"massless-particle", NULL, "vprk:nodes=2,projection=midpoint", 0.25, 4},
    {"massless-particle", NULL, "vprk:nodes=3,projection=midpoint", 0.25, 4},
    {"lotka-volterra", "gauge=symmetric", "vprk:nodes=4,projection=midpoint", 0.125, 6},
    {"vortices", NULL, "vprk:nodes=5,projection=midpoint", 0.0625, 6},
    {"massless-particle", NULL, "vprk:nodes=1,projection=post", 0.25, 2},
    {"massless-particle", NULL, "vprk:nodes=2,projection=post", 0.25, 4},
    {"vortices", NULL, "vprk:nodes=3,projection=post", 0.0625, 6},
    {"lotka-volterra", "gauge=singular", "vprk:nodes=1,projection=none", 0.25, 2},
    {"lotka-volterra", "gauge=singular", "vprk:nodes=2,projection=none", 0.25, 2},
    {"lotka-volterra", "gauge=singular", "vprk:nodes=3,projection=none", 0.25, 4},
    {"lotka-volterra", "gauge=singular", "vprk:nodes=4,projection=none", 0.25, 4},
    {"lotka-volterra", "gauge=singular", "vprk:nodes=5,projection=none", 0.25, 6},
    {"vortices", NULL, "vprk:nodes=2,tableau=lobatto-iiie", 0.0625, 2},
    {"vortices", NULL, "vprk:nodes=3,tableau=lobatto-iiie", 0.0625, 4},
    {"vortices", NULL, "vprk:nodes=4,tableau=lobatto-iiie", 0.0625, 6},
    {"vortices", NULL, "vprk:nodes=5,tableau=lobatto-iiie", 0.0625, 8},
    {"vortices", NULL, "vprk:nodes=3,tableau=lobatto-iiie,projection=symplectic", 0.0625, 4},
    {"massless-particle", NULL, "vprk:nodes=3,tableau=lobatto-iiie,projection=post", 0.125, 3},
    {"vortices", NULL, "vprk:nodes=5,tableau=lobatto-iiie,projection=midpoint", 0.0625, 4},
    {"lotka-volterra", NULL, "vprk:nodes=4,tableau=lobatto-iiie,projection=none", 0.25, 2},
    {"lotka-volterra", NULL, "vprk:nodes=5,tableau=lobatto-iiie,projection=none", 0.25, 4},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

START_TEST(tableaux_and_projections_have_the_order_that_they_claim)
{
  check_degenerate_order(kinds[_i].problem, kinds[_i].setting, kinds[_i].method, kinds[_i].h,
                         kinds[_i].order);
}
END_TEST

/* ---- structure ---- */

START_TEST(projected_steps_end_on_the_constraint_and_others_leave_it)
{
  problem *model = create_problem("massless-particle", NULL);
  static const char *const projected[] = {"symmetric", "midpoint", "symplectic", "post"};
  for (int k = 0; k < 4; k++) {
    dvi_integrator *integrator = start_integrator(model,
                                                  method_spec("vprk:projection=%s", projected[k]));
    for (int step = 0; step < 200; step++) {
      advance(integrator, 0.1, 1);
      ck_assert_double_eq(constraint_defect(model, integrator), 0);
    }
    dvi_integrator_destroy(&integrator);
  }
  dvi_integrator *unprojected = start_integrator(model, "vprk:projection=none");
  double queried;
  advance(unprojected, 0.1, 200);
  ck_assert_double_gt(constraint_defect(model, unprojected), 1e-8);
  ck_assert_int_eq(dvi_integrator_constraint(unprojected, &queried), DVI_OK);
  ck_assert_double_eq(queried, constraint_defect(model, unprojected));
  dvi_integrator_destroy(&unprojected);
  problem_destroy(&model);
}
END_TEST

static const struct {
  const char *problem, *method;
  double h, bound, momentum;
} runs[] = {
    {"lotka-volterra", "vprk", 0.1, 2.1e-6, 0},
    {"lotka-volterra", "vprk:nodes=3", 0.1, 2.6e-9, 0},
    {"massless-particle", "vprk:nodes=3", 0.2, 2.5e-9, 0},
    {"massless-particle", "vprk:nodes=4", 0.2, 1e-11, 0},
    {"tokamak", "vprk", 500, 2e-7, 1e-14},
    {"vortices", "vprk:nodes=3", 0.1, 2e-6, 1e-11},
    {"vortices", "vprk:nodes=2,projection=symplectic", 0.1, 4e-5, 2e-7},
    {"guiding-centre", "vprk", 10, 1e-7, 1e-13},
};
enum { RUNS = sizeof runs / sizeof *runs };

/* From one start post ends where none does, but for its kick. */
START_TEST(the_multiplier_is_the_kick)
{
  problem *model = create_problem("massless-particle", NULL),
          *regular = create_problem("kepler", NULL);
  dvi_integrator *post = start_integrator(model, "vprk:projection=post"),
                 *none = start_integrator(model, "vprk:projection=none"),
                 *other = start_integrator(regular, "midpoint");
  double unwanted;
  ck_assert_ptr_null(dvi_integrator_multiplier(post));
  advance(post, 0.2, 1);
  advance(none, 0.2, 1);
  advance(other, 0.01, 1);
  const double *lambda = dvi_integrator_multiplier(post);
  ck_assert_double_gt(magnitude(2, lambda), 1e-6);
  for (int i = 0; i < 2; i++)
    ck_assert_double_eq_tol(dvi_integrator_q(post)[i], dvi_integrator_q(none)[i] + lambda[i],
                            1e-15);
  ck_assert_ptr_null(dvi_integrator_multiplier(none));
  ck_assert_ptr_null(dvi_integrator_multiplier(other));
  ck_assert_ptr_null(dvi_integrator_multiplier(NULL));
  ck_assert_int_eq(dvi_integrator_constraint(other, &unwanted), DVI_UNSUPPORTED);
  dvi_integrator_destroy(&post);
  dvi_integrator_destroy(&none);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
  problem_destroy(&regular);
}
END_TEST

/* Projections conserve the momenta of shifts exactly, those of rotations up to the square of the
 * multiplier, which is largest on vortices. */
START_TEST(energy_stays_bounded_and_momenta_are_conserved)
{
  check_long_run(runs[_i].problem, NULL, runs[_i].method, runs[_i].h, 15000, runs[_i].bound,
                 runs[_i].momentum);
}
END_TEST

/* The banana orbit turns back, and R stays between the same two radii from beginning to end. */
START_TEST(a_banana_stays_a_banana)
{
  problem *model = create_problem("tokamak", NULL);
  dvi_integrator *integrator = start_integrator(model, "vprk");
  double inner[2] = {2, 2}, outer[2] = {0, 0};
  int turned = 0;
  const int steps = 20000;
  for (int k = 0; k < steps; k++) {
    advance(integrator, 500, 1);
    const double R = dvi_integrator_q(integrator)[0], u = dvi_integrator_q(integrator)[3];
    inner[2 * k / steps] = fmin(inner[2 * k / steps], R);
    outer[2 * k / steps] = fmax(outer[2 * k / steps], R);
    turned += u < 0;
  }
  ck_assert(turned > steps / 4 && turned < 3 * steps / 4);
  for (int k = 0; k < 2; k++) {
    ck_assert_double_eq_tol(inner[k], 1.006697, 2e-5);
    ck_assert_double_eq_tol(outer[k], 1.081944, 2e-5);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(loop_integrals_are_conserved_by_symplectic_maps_alone)
{
  ck_assert_double_le(loop_integral_change("massless-particle", NULL,
                                           "vprk:nodes=2,projection=symplectic", 0.1, 600),
                      1e-11);
  ck_assert_double_le(loop_integral_change("massless-particle", NULL,
                                           "vprk:nodes=3,projection=symplectic", 0.1, 600),
                      1e-11);
  ck_assert_double_ge(
      loop_integral_change("massless-particle", NULL, "vprk:nodes=2,projection=post", 0.1, 600),
      1e-9);
}
END_TEST

/* ---- failures and restarts ---- */

START_TEST(a_step_out_of_the_logarithms_domain_leaves_the_state)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *integrator = start_integrator(model, "vprk");
  advance(integrator, 0.1, 3);
  double q[2], p[2];
  memcpy(q, dvi_integrator_q(integrator), sizeof q);
  memcpy(p, dvi_integrator_p(integrator), sizeof p);
  ck_assert_int_gt(dvi_integrator_step(integrator, 40), 0);
  check_words("the state is unchanged");
  ck_assert_mem_eq(q, dvi_integrator_q(integrator), sizeof q);
  ck_assert_mem_eq(p, dvi_integrator_p(integrator), sizeof p);
  advance(integrator, 0.1, 1);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* A potential that asks for a smaller step from some call on, as one that is short of a
 * resource. */
static int calls_left;

static int short_of_calls(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * (q[0] * q[0] + q[1] * q[1]);
  return 0;
}

static int gradient_short_of_calls(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0];
  V_q[1] = q[1];
  return calls_left-- > 0 ? 0 : 1;
}

static int plane(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = -0.5 * q[1];
  alpha[1] = 0.5 * q[0];
  return 0;
}

static int plane_gradient(const double *q, double *alpha_q, void *user)
{
  (void)q, (void)user;
  alpha_q[0] = alpha_q[3] = 0;
  alpha_q[1] = -0.5;
  alpha_q[2] = 0.5;
  return 0;
}

START_TEST(a_callback_that_goes_on_asking_for_smaller_steps_is_heard)
{
  const dvi_one_form form = {.value = plane, .gradient = plane_gradient};
  const dvi_potential H = {.value = short_of_calls, .gradient = gradient_short_of_calls};
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = &form, .potentials = &H, .potential_count = 1};
  const double q[2] = {1, 0}, v[2] = {0, 1};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "vprk:nodes=3");
  calls_left = 1000;
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, q, v) == DVI_OK, "%s",
                dvi_last_error());
  calls_left = _i;
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_CALLBACK_RETRY);
  ck_assert_mem_eq(dvi_integrator_q(integrator), q, sizeof q);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* One Jacobian, and the correction that shows how the next one would shrink. The guess with its
 * expected error makes the first correction so small. */
START_TEST(a_smooth_step_takes_a_jacobian_and_two_residuals)
{
  enum { STEPS = 400 };
  problem *model = create_problem("massless-particle", "gauge=singular");
  dvi_integrator *integrator = start_integrator(model, "vprk:nodes=4");
  dvi_counters first, n;
  advance(integrator, 0.25, 1);
  dvi_integrator_counters(integrator, &first);
  advance(integrator, 0.25, STEPS);
  dvi_integrator_counters(integrator, &n);
  ck_assert_int_le(n.jacobians - first.jacobians, STEPS + STEPS / 16);
  ck_assert_int_le(n.residuals - first.residuals, 2 * STEPS + STEPS / 2);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(lobatto_wants_two_nodes)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, "vprk:nodes=1,tableau=lobatto-iiie", &none),
                   DVI_BAD_OPTION);
  check_words("nodes=2 or more");
  ck_assert_ptr_null(none);
  problem_destroy(&model);
}
END_TEST

SUITE(vprk)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, gauss_with_the_symmetric_projection_has_order_2s, 0, 3 * PLACES);
  tcase_add_loop_test(tests, tableaux_and_projections_have_the_order_that_they_claim, 0, KINDS);
  tcase_add_test(tests, projected_steps_end_on_the_constraint_and_others_leave_it);
  tcase_add_test(tests, the_multiplier_is_the_kick);
  tcase_add_test(tests, a_smooth_step_takes_a_jacobian_and_two_residuals);
  tcase_add_loop_test(tests, energy_stays_bounded_and_momenta_are_conserved, 0, RUNS);
  tcase_add_test(tests, a_banana_stays_a_banana);
  tcase_add_test(tests, loop_integrals_are_conserved_by_symplectic_maps_alone);
  tcase_add_test(tests, a_step_out_of_the_logarithms_domain_leaves_the_state);
  tcase_add_loop_test(tests, a_callback_that_goes_on_asking_for_smaller_steps_is_heard, 0, 6);
  tcase_add_test(tests, lobatto_wants_two_nodes);
}
