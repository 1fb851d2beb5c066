/* labels: order */
/* Blocks that meet planes and balls, judged in quadruple precision: times of hits, and orders. With
 * DVI_SHOW_ORDERS in the environment the errors are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/field/marches.h"
#include "support/runs.h"
#include "support/solid/throws.h"
#include "support/suite.h"

enum { LEVELS = 5, CASES = 4 };

static const dvi_obstacle obstacles[] = {
    {
        .name = "plane",
        .kind = DVI_OBSTACLE_PLANE,
        .point = {0, -0.1},
        .normal = {0.5, 1, 0.25},
        .restitution = 0.75,
    },
    {.name = "ball",
     .kind = DVI_OBSTACLE_BALL,
     .point = {-0.4, -0.8, -0.2},
     .radius = 0.8,
     .restitution = 1},
};

static thrown throw_of(int i, double span, double turn)
{
  const solid_case of = {
      .n = 2 + i % 2, .cells = i % 2 == 0 ? 2 : 1, .grading = 1, .law = DVI_ELASTIC_NEO_HOOKEAN};
  return throw_block(&of, obstacles + i / 2, turn, span);
}

/* ---- mechanical methods ---- */

static dvi_integrator *fly(const thrown *c, dvi_system *system, const char *method)
{
  const size_t size = (size_t)c->s.judge.size;
  double *q = calloc(size, sizeof *q), *p = calloc(size, sizeof *p);
  dvi_integrator *integrator = create_integrator(system, method);
  dvi_elastic_project(c->s.elastic, c->u, c->rate, q, NULL, p);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  free(q), free(p);
  return integrator;
}

static void check_order_of(const thrown *c, const char *method, long first, int order)
{
  double error[LEVELS];
  dvi_system *system = NULL;
  ck_assert_msg(dvi_elastic_system(c->s.elastic, &system) == DVI_OK, "%s", dvi_last_error());
  for (int level = 0; level < LEVELS; level++) {
    dvi_integrator *integrator = fly(c, system, method);
    advance(integrator, c->span / (double)(first << level), first << level);
    error[level] = error_of_solid(c->s.judge.size, dvi_integrator_q(integrator), c->end);
    if (getenv("DVI_SHOW_ORDERS"))
      fprintf(stderr, "%s, %d hits, %ld steps: %.3e\n", method, c->hits.count, first << level,
              error[level]);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
  const double measured = log2(error[0] / error[LEVELS - 1]) / (LEVELS - 1);
  ck_assert_msg(measured > order - 0.3, "%s: order %g", method, measured);
}

START_TEST(methods_keep_their_orders_at_hits)
{
  thrown c = throw_of(_i, 0.75, 0.5);
  ck_assert_int_ge(c.hits.count, 1);
  check_order_of(&c, "verlet", 16, 2);
  check_order_of(&c, "galerkin:degree=2", 8, 4);
  end_throw(&c);
}
END_TEST

/* A block that does not turn flies straight until then. */
START_TEST(first_hits_are_exact)
{
  thrown c = throw_of(_i, 0.75, 0);
  dvi_system *system = NULL;
  ck_assert_msg(dvi_elastic_system(c.s.elastic, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator *integrator = fly(&c, system, "verlet");
  while (dvi_integrator_hit_count(integrator) == 0) advance(integrator, 0.015625, 1);
  ck_assert_double_eq_tol(dvi_integrator_hit(integrator, 0).t, (double)c.hits.t[0], 1e-14);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  end_throw(&c);
}
END_TEST

SUITE(solid_contacts)
{
  tcase_add_loop_test(tests, methods_keep_their_orders_at_hits, 0, CASES);
  tcase_add_loop_test(tests, first_hits_are_exact, 0, CASES);
}
