/* labels: order */
/* Orders of marches of solids, judged in quadruple precision, over five fractions from 0.8 on, with
 * loads from 0.6 and with damping from 0.4 on, where the fastest vibrations are resolved. With
 * DVI_SHOW_ORDERS in the environment they are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/marches.h"
#include "support/solid/judged_solids.h"
#include "support/suite.h"

enum { LAWS = 4, LEVELS = 5, TIMES = 8 };

typedef struct goal {
  judged_solid s;
  double *u, *rate;                /* [size] the start, the rate as E */
  quad *end[TIMES], *speed[TIMES]; /* [size] at the times */
  const char *name;
} goal;

static double time_of(int i)
{
  return (TIMES + i) / (2.0 * TIMES);
}

static quad *copy_of(int size, const quad *x)
{
  quad *copy = calloc((size_t)size, sizeof *copy);
  memcpy(copy, x, (size_t)size * sizeof *copy);
  return copy;
}

static goal goal_of(const solid_case *of)
{
  goal g = {.s = make_judged(of, NULL, 0), .name = name_solid(of)};
  const int size = g.s.judge.size;
  quad *u = calloc((size_t)size, sizeof *u), *v = calloc((size_t)size, sizeof *v);
  start_judged(&g.s, 1, u, v);
  g.u = rounded(size, u), g.rate = rounded(size, v);
  for (int i = 0; i < size; i++) g.rate[i] = -g.rate[i];
  for (int i = 0; i < TIMES; i++) {
    const quad from = i > 0 ? (quad)time_of(i - 1) : 0;
    ck_assert_double_le(quad_solid_advance(&g.s.judge, from, (quad)time_of(i), u, v), 1e-18);
    g.end[i] = copy_of(size, u), g.speed[i] = copy_of(size, v);
  }
  free(u), free(v);
  return g;
}

static void end_goal(goal *g)
{
  for (int i = 0; i < TIMES; i++) free(g->end[i]), free(g->speed[i]);
  free(g->u), free(g->rate);
  end_judged_solid(&g->s);
}

/* Set error[0] to that of u, and error[1] to that of u', root mean squares over the times. At a
 * single one an error depends on where the times of events happen to be. */
static void find_errors(const goal *g, const char *method, double fraction, double *error)
{
  const int size = g->s.judge.size;
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  const dvi_march_state start = {.size = sizeof start, .A = g->u, .E = g->rate};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_elastic_march_create(g->s.elastic, &options, &march) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_march_start(march, &start) == DVI_OK, "%s", dvi_last_error());
  error[0] = error[1] = 0;
  for (int i = 0; i < TIMES; i++) {
    advance_march(march, time_of(i));
    double *u = sample_march(march, DVI_FORM_A), *v = sample_march(march, DVI_FORM_E);
    for (int k = 0; k < size; k++) v[k] = -v[k];
    error[0] = hypot(error[0], error_of_solid(size, u, g->end[i]) / sqrt(TIMES));
    error[1] = hypot(error[1], error_of_solid(size, v, g->speed[i]) / sqrt(TIMES));
    free(u), free(v);
  }
  dvi_march_destroy(&march);
}

/* The slope of a line through the logarithms. */
static double slope_of(double error[LEVELS][2], int k)
{
  double slope = 0, squares = 0;
  for (int level = 0; level < LEVELS; level++) {
    const double x = level - (LEVELS - 1) / 2.0;
    slope -= x * log2(error[level][k]);
    squares += x * x;
  }
  return slope / squares;
}

/* Steps are halved, and keep the ratios of one another. */
static void check_march(const goal *g, const char *method, double coarsest)
{
  double error[LEVELS][2];
  for (int level = 0; level < LEVELS; level++)
    find_errors(g, method, ldexp(coarsest, -level), error[level]);
  for (int k = 0; k < 2; k++) {
    const double measured = slope_of(error, k);
    if (getenv("DVI_SHOW_ORDERS"))
      fprintf(stderr, "%s, %s: order %.2f of %s, errors %.2e .. %.2e\n", method, g->name, measured,
              k == 0 ? "u" : "u'", error[0][k], error[LEVELS - 1][k]);
    ck_assert_msg(fabs(measured - 2) < 0.2, "%s, %s: order %g of %s", method, g->name, measured,
                  k == 0 ? "u" : "u'");
  }
}

static void check_case(int i, unsigned traits, double coarsest)
{
  const solid_case of = {.n = 2 + i / LAWS,
                         .cells = i < LAWS ? 2 : 1,
                         .grading = 2,
                         .jitter = 0.2,
                         .law = (dvi_elastic_law)(i % LAWS),
                         .traits = traits,
                         .seed = (unsigned)i + 1};
  goal g = goal_of(&of);
  check_march(&g, "avi", coarsest);
  check_march(&g, "avi:classes=no", coarsest);
  check_march(&g, "verlet", coarsest);
  end_goal(&g);
}

START_TEST(free_solids)
{
  check_case(_i, SOLID_OF_TWO, 0.8);
}
END_TEST

START_TEST(solids_with_moving_sides_and_loads)
{
  check_case(_i, SOLID_OF_TWO | SOLID_MOVED | SOLID_LOADED, 0.6);
}
END_TEST

START_TEST(damped_solids)
{
  check_case(_i, SOLID_OF_TWO | SOLID_MOVED | SOLID_LOADED | SOLID_DAMPED, 0.4);
}
END_TEST

SUITE(solid_march_orders)
{
  tcase_add_loop_test(tests, free_solids, 0, 2 * LAWS);
  tcase_add_loop_test(tests, solids_with_moving_sides_and_loads, 0, 2 * LAWS);
  tcase_add_loop_test(tests, damped_solids, 0, 2 * LAWS);
}
