/* labels: order */
/* Orders of mechanical methods on solids, judged in quadruple precision. With DVI_SHOW_ORDERS in
 * the environment the errors are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/solid/judged_solids.h"
#include "support/suite.h"

enum { LAWS = 4, LEVELS = 5 };

/* A motion up to t = 1, and its exact end. */
typedef struct motion {
  judged_solid s;
  dvi_system *system;
  double *q, *p; /* [unknowns] at the start */
  double *u;     /* [size] for results */
  quad *end;     /* [size] displacements */
  const char *name;
} motion;

static motion motion_of(const solid_case *of)
{
  motion m = {.s = make_judged(of, NULL, 0), .name = name_solid(of)};
  const size_t size = (size_t)m.s.judge.size;
  m.end = calloc(size, sizeof *m.end);
  quad *v = calloc(size, sizeof *v);
  start_judged(&m.s, 1, m.end, v);
  double *u = rounded((int)size, m.end), *rate = rounded((int)size, v);
  m.q = calloc(size, sizeof *m.q), m.p = calloc(size, sizeof *m.p);
  m.u = calloc(size, sizeof *m.u);
  dvi_elastic_project(m.s.elastic, u, rate, m.q, NULL, m.p);
  ck_assert_double_le(quad_solid_advance(&m.s.judge, 0, 1, m.end, v), 1e-18);
  ck_assert_msg(dvi_elastic_system(m.s.elastic, &m.system) == DVI_OK, "%s", dvi_last_error());
  free(u), free(rate), free(v);
  return m;
}

static void end_motion(motion *m)
{
  dvi_system_destroy(&m->system);
  free(m->q), free(m->p), free(m->u), free(m->end);
  end_judged_solid(&m->s);
}

static double error_of(const motion *m, const char *method, long steps)
{
  dvi_integrator *integrator = create_integrator(m->system, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, m->q, m->p) == DVI_OK, "%s", dvi_last_error());
  advance(integrator, 1.0 / (double)steps, steps);
  ck_assert_int_eq(
      dvi_elastic_lift(m->s.elastic, 1, dvi_integrator_q(integrator), NULL, m->u, NULL), DVI_OK);
  dvi_integrator_destroy(&integrator);
  return error_of_solid(m->s.judge.size, m->u, m->end);
}

/* Require the order between the first and the last of five levels whose error is above the floor of
 * roundings. There are three such levels at least. */
static void check_order_of(const motion *m, const char *method, long first, int order)
{
  const double floor = 1e-13;
  double error[LEVELS];
  int last = 0;
  for (int level = 0; level < LEVELS; level++) {
    error[level] = error_of(m, method, first << level);
    if (getenv("DVI_SHOW_ORDERS"))
      fprintf(stderr, "%s, %s, %ld steps: %.3e\n", method, m->name, first << level, error[level]);
    if (error[level] > floor && last == level - 1) last = level;
    if (level > last) ck_assert_double_le(error[level], 2 * floor);
  }
  ck_assert_int_ge(last, 2);
  const double measured = log2(error[last - 2] / error[last]) / 2;
  ck_assert_msg(fabs(measured - order) < 0.2, "%s, %s: order %g", method, m->name, measured);
}

/* Steps of 0.8 of the stable one and finer ones. */
static long explicit_steps(const motion *m)
{
  double omega;
  ck_assert_int_eq(dvi_elastic_fastest(m->s.elastic, &omega), DVI_OK);
  return (long)ceil(omega / 2 / 0.8);
}

static void check_case(int n, int law, unsigned traits)
{
  const solid_case of = {.n = n,
                         .cells = n == 2 ? 2 : 1,
                         .grading = 1.5,
                         .jitter = 0.2,
                         .law = (dvi_elastic_law)law,
                         .traits = traits,
                         .seed = (unsigned)(1 + law)};
  motion m = motion_of(&of);
  check_order_of(&m, "verlet", explicit_steps(&m), 2);
  check_order_of(&m, "midpoint", 8, 2);
  check_order_of(&m, "galerkin:degree=2", 4, 4);
  check_order_of(&m, "galerkin:degree=3", 2, 6);
  end_motion(&m);
}

START_TEST(free_solids)
{
  check_case(2 + _i / LAWS, _i % LAWS, 0);
}
END_TEST

START_TEST(solids_with_moving_sides_and_loads)
{
  check_case(2 + _i / LAWS, _i % LAWS, SOLID_MOVED | SOLID_LOADED);
}
END_TEST

START_TEST(damped_solids_of_two_materials)
{
  check_case(2 + _i / LAWS, _i % LAWS, SOLID_MOVED | SOLID_LOADED | SOLID_DAMPED | SOLID_OF_TWO);
}
END_TEST

START_TEST(split_energies_give_imex_order_two)
{
  const solid_case of = {.n = 2 + _i / LAWS,
                         .cells = 1 + (_i < LAWS),
                         .grading = 1.5,
                         .law = (dvi_elastic_law)(_i % LAWS),
                         .traits = SOLID_LOADED,
                         .split = 1,
                         .seed = 3};
  motion m = motion_of(&of);
  check_order_of(&m, "imex", 16, 2);
  check_order_of(&m, "galerkin:degree=2", 4, 4);
  end_motion(&m);
}
END_TEST

SUITE(solid_orders)
{
  tcase_add_loop_test(tests, free_solids, 0, 2 * LAWS);
  tcase_add_loop_test(tests, solids_with_moving_sides_and_loads, 0, 2 * LAWS);
  tcase_add_loop_test(tests, damped_solids_of_two_materials, 0, 2 * LAWS);
  tcase_add_loop_test(tests, split_energies_give_imex_order_two, 0, 2 * LAWS);
}
