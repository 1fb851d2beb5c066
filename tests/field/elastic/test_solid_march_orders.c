/* labels: order */
/* Orders of marches of solids, judged in quadruple precision, at fractions 0.8 to 0.05. With
 * DVI_SHOW_ORDERS in the environment the errors are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/field/marches.h"
#include "support/solid/solids.h"
#include "support/suite.h"

enum { LAWS = 4, LEVELS = 5 };

typedef struct goal {
  tested_solid s;
  double *u, *rate; /* [size] the start, the rate as E */
  quad *end, *speed;
  const char *name;
} goal;

static goal goal_of(const solid_case *of)
{
  goal g = {.s = make_solid(of, NULL, 0), .name = name_solid(of)};
  const int size = g.s.judge.size;
  g.end = calloc((size_t)size, sizeof *g.end), g.speed = calloc((size_t)size, sizeof *g.speed);
  start_solid(&g.s, 1, g.end, g.speed);
  g.u = rounded(size, g.end), g.rate = rounded(size, g.speed);
  for (int i = 0; i < size; i++) g.rate[i] = -g.rate[i];
  ck_assert_double_le(quad_solid_advance(&g.s.judge, 0, 1, g.end, g.speed), 1e-18);
  return g;
}

static void end_goal(goal *g)
{
  free(g->u), free(g->rate), free(g->end), free(g->speed);
  end_solid(&g->s);
}

/* Set error[0] to that of u, and error[1] to that of u', at t = 1. */
static void find_errors(const goal *g, const char *method, double fraction, double *error)
{
  const int size = g->s.judge.size;
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction, .span = 1};
  const dvi_march_state start = {.size = sizeof start, .A = g->u, .E = g->rate};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_elastic_march_create(g->s.elastic, &options, &march) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_march_start(march, &start) == DVI_OK, "%s", dvi_last_error());
  advance_march(march, 1);
  double *u = sample_march(march, DVI_FORM_A), *v = sample_march(march, DVI_FORM_E);
  for (int i = 0; i < size; i++) v[i] = -v[i];
  error[0] = error_of_solid(size, u, g->end);
  error[1] = error_of_solid(size, v, g->speed);
  free(u), free(v);
  dvi_march_destroy(&march);
}

static void check_march(const goal *g, const char *method)
{
  double error[LEVELS][2];
  for (int level = 0; level < LEVELS; level++) {
    find_errors(g, method, ldexp(0.8, -level), error[level]);
    if (getenv("DVI_SHOW_ORDERS"))
      fprintf(stderr, "%s, %s, fraction %g: u %.3e, u' %.3e\n", method, g->name, ldexp(0.8, -level),
              error[level][0], error[level][1]);
  }
  for (int k = 0; k < 2; k++) {
    const double measured = log2(error[0][k] / error[LEVELS - 1][k]) / (LEVELS - 1);
    ck_assert_msg(fabs(measured - 2) < 0.3, "%s, %s: order %g of %s", method, g->name, measured,
                  k == 0 ? "u" : "u'");
  }
}

static void check_case(int i, unsigned traits)
{
  const solid_case of = {.n = 2 + i / LAWS,
                         .cells = i < LAWS ? 2 : 1,
                         .grading = 2,
                         .jitter = 0.2,
                         .law = (dvi_elastic_law)(i % LAWS),
                         .traits = traits,
                         .seed = (unsigned)i + 1};
  goal g = goal_of(&of);
  check_march(&g, "avi");
  check_march(&g, "avi:classes=no");
  check_march(&g, "verlet");
  end_goal(&g);
}

START_TEST(free_solids)
{
  check_case(_i, SOLID_OF_TWO);
}
END_TEST

START_TEST(solids_with_moving_sides_and_loads)
{
  check_case(_i, SOLID_OF_TWO | SOLID_MOVED | SOLID_LOADED);
}
END_TEST

START_TEST(damped_solids)
{
  check_case(_i, SOLID_OF_TWO | SOLID_MOVED | SOLID_LOADED | SOLID_DAMPED);
}
END_TEST

SUITE(solid_march_orders)
{
  tcase_add_loop_test(tests, free_solids, 0, 2 * LAWS);
  tcase_add_loop_test(tests, solids_with_moving_sides_and_loads, 0, 2 * LAWS);
  tcase_add_loop_test(tests, damped_solids, 0, 2 * LAWS);
}
