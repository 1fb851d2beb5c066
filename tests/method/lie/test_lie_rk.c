/* labels: unit */
#include <check.h>
#include <math.h>
#include <string.h>

#include "support/systems/mixed_factors.h"
#include "support/runs.h"
#include "support/suite.h"

static const double pendulum_moments[] = {.13, .28, .17},
                    /* Omega at T = 1 */
    pendulum_end[] = {-6.751473860336227, .1484346732487297, 3.362315606396518};

static const struct {
  const char *method;
  int order;
} schemes[] = {{"lie-rk:scheme=explicit-midpoint", 2},
               {"lie-rk:scheme=implicit-midpoint", 2},
               {"lie-rk:scheme=crouch-grossman", 2},
               {"lie-rk:scheme=munthe-kaas", 4}};

/* The error of Omega at time 1. */
static double error_of_pendulum(const char *method, double h)
{
  body pendulum;
  make_body(PENDULUM_3D, &pendulum);
  dvi_integrator *integrator = body_integrator(&pendulum, method);
  advance(integrator, h, lround(1 / h));
  const double *Pi = dvi_integrator_p(integrator);
  const double Omega[] = {Pi[0] / pendulum_moments[0], Pi[1] / pendulum_moments[1],
                          Pi[2] / pendulum_moments[2]};
  const double error = distance(3, Omega, pendulum_end);
  dvi_integrator_destroy(&integrator);
  destroy_body(&pendulum);
  return error;
}

START_TEST(a_pendulum_shows_the_order)
{
  const double coarse = error_of_pendulum(schemes[_i].method, .005),
               fine = error_of_pendulum(schemes[_i].method, .0025);
  ck_assert_double_eq_tol(log2(coarse / fine), schemes[_i].order, .1);
}
END_TEST

/* Distance of q and p at time 1 from those of lie-galerkin:degree=6. */
static double error_of_product(const body *model, const char *method, double h)
{
  dvi_integrator *judge = body_integrator(model, "lie-galerkin:degree=6"),
                 *integrator = body_integrator(model, method);
  advance(judge, 1.0 / 16, 16);
  advance(integrator, h, lround(1 / h));
  const double error = fmax(
      distance(dvi_system_nq(model->system), dvi_integrator_q(judge), dvi_integrator_q(integrator)),
      distance(dvi_system_nv(model->system), dvi_integrator_p(judge),
               dvi_integrator_p(integrator)));
  dvi_integrator_destroy(&judge);
  dvi_integrator_destroy(&integrator);
  return error;
}

START_TEST(products_show_the_order)
{
  body cells;
  const char *method = schemes[_i % 4].method;
  if (_i / 4 < MIXED_KINDS)
    make_mixed_factors((mixed_kind)(_i / 4), &cells);
  else
    make_body(PRODUCT, &cells);
  const double coarse = error_of_product(&cells, method, 1.0 / 64),
               fine = error_of_product(&cells, method, 1.0 / 128);
  ck_assert_double_eq_tol(log2(coarse / fine), schemes[_i % 4].order, .25);
  destroy_body(&cells);
}
END_TEST

/* Exponentials and the implicit midpoint rule stay on the group, and the explicit midpoint rule
 * leaves it by its error. A state on the group can be a start. */
START_TEST(the_group_is_kept_or_left)
{
  body cells;
  make_body(PRODUCT, &cells);
  dvi_integrator *integrator = body_integrator(&cells, schemes[_i].method);
  advance(integrator, .02, 100);
  const double off = dvi_system_distance(cells.system, dvi_integrator_q(integrator));
  if (_i == 0)
    ck_assert_double_ge(off, 1e-6);
  else
    ck_assert_double_le(off, 1e-13); /* 100 steps, some roundings each */
  ck_assert_int_eq(dvi_integrator_start(integrator, 2, dvi_integrator_q(integrator),
                                        dvi_integrator_p(integrator)),
                   _i == 0 ? DVI_BAD_ARGUMENT : DVI_OK);
  dvi_integrator_destroy(&integrator);
  destroy_body(&cells);
}
END_TEST

START_TEST(there_is_no_path_between_steps)
{
  body top;
  make_body(FREE_BODY, &top);
  dvi_integrator *integrator = body_integrator(&top, "lie-rk");
  double q[9];
  advance(integrator, .1, 1);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, .05, q, NULL), DVI_UNSUPPORTED);
  check_words("leave the rotations");
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
}
END_TEST

START_TEST(stages_count_gradients_and_take_no_memory)
{
  static const int gradients[] = {2, 0, 2, 4};
  body cells;
  make_body(PRODUCT, &cells);
  dvi_integrator *integrator = body_integrator(&cells, schemes[_i].method);
  dvi_counters before, after;
  advance(integrator, .02, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, .02, 10);
  dvi_integrator_counters(integrator, &after);
  if (gradients[_i] != 0) ck_assert_int_eq(after.gradients - before.gradients, 10 * gradients[_i]);
  ck_assert_int_eq(after.allocations, before.allocations);
  dvi_integrator_destroy(&integrator);
  destroy_body(&cells);
}
END_TEST

/* The energy error of a free body at time 100. */
static double energy_error(const char *method, double h)
{
  body top;
  make_body(FREE_BODY, &top);
  dvi_integrator *integrator = body_integrator(&top, method);
  double first[2], last[2];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  advance(integrator, h, lround(100 / h));
  ck_assert_int_eq(dvi_integrator_invariants(integrator, last), DVI_OK);
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
  return fabs(last[0] - first[0]);
}

START_TEST(lie_verlet_has_the_smaller_energy_error_at_every_step)
{
  const double h = .4 * pow(.5, _i);
  ck_assert_double_le(energy_error("lie-verlet", h), 1e-13);
  ck_assert_double_ge(energy_error("lie-rk:scheme=crouch-grossman", h), 1e-7);
}
END_TEST

START_TEST(an_implicit_step_too_large_fails_by_name)
{
  const double J[] = {1, 0, 0, 0, 2, 0, 0, 0, 2.5}, Omega[] = {100, 50, -20};
  body top;
  make_free_body(J, Omega, &top);
  dvi_integrator *integrator = body_integrator(&top, "lie-rk:scheme=implicit-midpoint");
  ck_assert_int_eq(dvi_integrator_step(integrator, 1), DVI_NOT_CONVERGED);
  check_words("does not settle");
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
}
END_TEST

/* The mass between factors is singular somewhere off the group. No guess goes there, so the matrix
 * keeps the order of its pivots, and KLU its memory. */
START_TEST(coupled_cells_refuse_steps_too_large)
{
  static const double h[] = {2, 50, 1e4};
  body cells;
  make_body(PRODUCT, &cells);
  dvi_integrator *integrator = body_integrator(&cells, "lie-rk:scheme=implicit-midpoint");
  for (int i = 0; i < 3; i++) {
    ck_assert_int_eq(dvi_integrator_step(integrator, h[i]), DVI_NOT_CONVERGED);
    ck_assert_int_eq(
        memcmp(dvi_integrator_q(integrator), cells.q, (size_t)cells.nq * sizeof(double)), 0);
  }
  advance(integrator, .05, 1);
  dvi_integrator_destroy(&integrator);
  destroy_body(&cells);
}
END_TEST

START_TEST(an_explicit_step_too_large_asks_for_a_smaller_one)
{
  body cells;
  make_body(PRODUCT, &cells);
  dvi_integrator *integrator = body_integrator(&cells, "lie-rk:scheme=explicit-midpoint");
  for (double h = .1; h < 1e5; h *= 1.3) {
    dvi_status status = DVI_OK;
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, cells.q, cells.v), DVI_OK);
    for (int i = 0; i < 5 && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
    ck_assert_msg(status >= 0, "h %g: %s", h, dvi_last_error());
  }
  dvi_integrator_destroy(&integrator);
  destroy_body(&cells);
}
END_TEST

SUITE(lie_rk)
{
  tcase_add_loop_test(tests, a_pendulum_shows_the_order, 0, 4);
  tcase_add_loop_test(tests, products_show_the_order, 0, 4 * (MIXED_KINDS + 1));
  tcase_add_loop_test(tests, the_group_is_kept_or_left, 0, 4);
  tcase_add_test(tests, there_is_no_path_between_steps);
  tcase_add_loop_test(tests, stages_count_gradients_and_take_no_memory, 0, 4);
  tcase_add_loop_test(tests, lie_verlet_has_the_smaller_energy_error_at_every_step, 0, 6);
  tcase_add_test(tests, an_implicit_step_too_large_fails_by_name);
  tcase_add_test(tests, coupled_cells_refuse_steps_too_large);
  tcase_add_test(tests, an_explicit_step_too_large_asks_for_a_smaller_one);
}
