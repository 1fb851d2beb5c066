/* Marches of elastic solids among obstacles: orders at hits, energies, rests and friction. With
 * DVI_SHOW_ORDERS in the environment the errors are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/solid/judged_solids.h"
#include "support/solid/quad_contact.h"
#include "support/suite.h"

static const char *const methods[] = {"avi", "avi:classes=no", "verlet"};
enum { METHODS = 3, NUMBERS_MOST = 3 * 27 };

static dvi_march *march_of(const dvi_elastic *solid, const char *method, double fraction)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_elastic_march_create(solid, &options, &march) == DVI_OK, "%s",
                dvi_last_error());
  return march;
}

static void begin(dvi_march *march, const double *u, const double *rate)
{
  double E[NUMBERS_MOST];
  for (int64_t i = 0; i < dvi_march_size(march, DVI_FORM_E); i++) E[i] = -rate[i];
  const dvi_march_state state = {.size = sizeof state, .A = u, .E = E};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
}

static void advance(dvi_march *march, double t)
{
  ck_assert_msg(dvi_march_advance(march, t) == DVI_OK, "%s", dvi_last_error());
}

static double observed(const dvi_march *march, const char *name)
{
  double value = 0;
  for (int i = 0; dvi_march_observable(march, i) != NULL; i++) {
    if (strcmp(dvi_march_observable(march, i), name) != 0) continue;
    ck_assert_msg(dvi_march_observe(march, i, &value) == DVI_OK, "%s", dvi_last_error());
    return value;
  }
  ck_abort_msg("no %s", name);
}

static void sample(const dvi_march *march, dvi_march_form form, double *values)
{
  ck_assert_msg(dvi_march_sample(march, form, 0, NULL, values) == DVI_OK, "%s", dvi_last_error());
}

/* ---- throws ---- */

static const dvi_obstacle obstacles[] = {
    {.name = "plane",
     .kind = DVI_OBSTACLE_PLANE,
     .point = {0, -0.1},
     .normal = {0.5, 1, 0.25},
     .restitution = 0.75},
    {.name = "ball",
     .kind = DVI_OBSTACLE_BALL,
     .point = {-0.4, -0.8, -0.2},
     .radius = 0.8,
     .restitution = 1},
    {.name = "rough",
     .kind = DVI_OBSTACLE_PLANE,
     .point = {0, -0.1},
     .normal = {0.5, 1, 0.25},
     .restitution = 0.5,
     .friction = 0.3},
    {.name = "cave",
     .kind = DVI_OBSTACLE_HOLLOW,
     .point = {0.4, 0.7, 0.45},
     .radius = 1.2,
     .restitution = 0.875},
};

enum { THROWS = 8, LEVELS = 5 };

/* A block that flies and turns, and meets an obstacle with a corner. */
typedef struct throw
{
  judged_solid s;
  dvi_obstacle obstacle;
  double *u, *rate;  /* [size] the start */
  quad *end, *speed; /* [size] */
  double span;
  quad_hits hits;
}
throw;

static throw throw_of(int i)
{
  const solid_case of = {
      .n = 2 + i % 2, .cells = i % 2 ? 1 : 2, .grading = 1.5, .law = DVI_ELASTIC_NEO_HOOKEAN};
  throw c = {.obstacle = obstacles[i / 2], .span = 0.75};
  c.s = make_judged(&of, &c.obstacle, 1);
  const int size = c.s.judge.size;
  c.end = calloc((size_t)size, sizeof *c.end), c.speed = calloc((size_t)size, sizeof *c.speed);
  start_judged(&c.s, 0.5, c.end, c.speed);
  for (int k = 0; k < size; k++)
    c.speed[k] = (double)(c.speed[k] + (k % of.n == 1 ? -0.5 : -0.125));
  c.u = rounded(size, c.end), c.rate = rounded(size, c.speed);
  quad_solid_advance_among(&c.s.judge, &c.obstacle, 1, c.span, 20, c.end, c.speed, &c.hits);
  return c;
}

static void end_throw(throw *c)
{
  free(c->u), free(c->rate), free(c->end), free(c->speed);
  end_judged_solid(&c->s);
}

static void check_order_of(const throw *c, const char *method)
{
  double error[LEVELS][2], values[NUMBERS_MOST];
  for (int level = 0; level < LEVELS; level++) {
    dvi_march *march = march_of(c->s.elastic, method, ldexp(0.1, -level));
    begin(march, c->u, c->rate);
    advance(march, c->span);
    sample(march, DVI_FORM_A, values);
    error[level][0] = error_of_solid(c->s.judge.size, values, c->end);
    sample(march, DVI_FORM_E, values);
    for (int k = 0; k < c->s.judge.size; k++) values[k] = -values[k];
    error[level][1] = error_of_solid(c->s.judge.size, values, c->speed);
    if (getenv("DVI_SHOW_ORDERS"))
      fprintf(stderr, "%s %s %dd %g: %g hits (%d), u %.3e v %.3e\n", c->obstacle.name, method, c->s.judge.n, ldexp(0.1, -level),
              observed(march, "hits"), c->hits.count, error[level][0], error[level][1]);
    dvi_march_destroy(&march);
  }
  for (int k = 0; k < 2; k++) {
    const double measured = log2(error[0][k] / error[LEVELS - 1][k]) / (LEVELS - 1);
    if (getenv("DVI_SHOW_ORDERS")) { fprintf(stderr, " slope %.2f\n", measured); continue; }
    ck_assert_msg(measured > 1.7, "%s: order %g of form %d", method, measured, k);
  }
}

START_TEST(marches_keep_order_2_at_hits)
{
  throw c = throw_of(_i % THROWS);
  check_order_of(&c, methods[_i / THROWS]);
  end_throw(&c);
}
END_TEST

SUITE(elastic_contacts)
{
  tcase_add_loop_test(tests, marches_keep_order_2_at_hits, 0, METHODS * THROWS);
}
