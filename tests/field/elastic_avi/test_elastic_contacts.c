/* Marches of elastic solids among obstacles: orders at hits, energies, rests and friction. With
 * DVI_SHOW_ORDERS in the environment the errors are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/field/generated.h"
#include "support/field/solids.h"
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
     .restitution = 0.75,
     .friction = 0.1},
    {.name = "cave",
     .kind = DVI_OBSTACLE_HOLLOW,
     .point = {0.4, 0.7, 0.45},
     .radius = 1.2,
     .restitution = 0.875},
};

enum { THROWS = 8, RUNS = 21 };

static const double runs_in_half = 4; /* after which the step is halved */

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

/* Set the errors of u and u'. */
static void measure(const throw *c, const char *method, double fraction, double error[2])
{
  const int size = c->s.judge.size;
  double values[NUMBERS_MOST];
  dvi_march *march = march_of(c->s.elastic, method, fraction);
  begin(march, c->u, c->rate);
  advance(march, c->span);
  sample(march, DVI_FORM_A, values);
  error[0] = error_of_solid(size, values, c->end);
  sample(march, DVI_FORM_E, values);
  for (int k = 0; k < size; k++) values[k] = -values[k];
  error[1] = error_of_solid(size, values, c->speed);
  dvi_march_destroy(&march);
}

/* The error of a hit depends on its place in a step, so the slope is that of a line of best fit. */
START_TEST(marches_keep_order_2_at_hits)
{
  const char *method = methods[_i / THROWS];
  throw c = throw_of(_i % THROWS);
  double order[2] = {0}, weight = 0;
  ck_assert_int_ge(c.hits.count, 1);
  for (int run = 0; run < RUNS; run++) {
    const double x = run - 0.5 * (RUNS - 1);
    double error[2];
    measure(&c, method, 0.1 * exp2(-run / runs_in_half), error);
    for (int k = 0; k < 2; k++) order[k] -= x * log2(error[k]) * runs_in_half;
    weight += x * x;
  }
  for (int k = 0; k < 2; k++) {
    if (getenv("DVI_SHOW_ORDERS"))
      fprintf(stderr, "%s, %s, n = %d, %d hits: order %.2f of %s\n", c.obstacle.name, method,
              c.s.judge.n, c.hits.count, order[k] / weight, k == 0 ? "u" : "u'");
    ck_assert_double_gt(order[k] / weight, 1.75);
  }
  end_throw(&c);
}
END_TEST

/* ---- blocks under their weight ---- */

static const double g_down = 0.5, g_along = 0.2;

static int weight(double t, const double *X, const double *normal, double *force, void *user)
{
  const double *of = user;
  (void)t, (void)X, (void)normal;
  for (int i = 0; i < 2; i++) force[i] = of[i];
  return 0;
}

/* A unit square above a floor y = 0 of a height. */
static dvi_elastic *falling(double restitution, double friction, double height, double alpha,
                            double *force)
{
  const dvi_obstacle floor = {.name = "floor",
                              .kind = DVI_OBSTACLE_PLANE,
                              .point = {0, -height},
                              .normal = {0, 1},
                              .restitution = restitution,
                              .friction = friction};
  const dvi_elastic_load load = {.part = "all", .force = weight, .is_steady = 1, .user = force};
  const dvi_generator_options options = {.cells = {2, 2}, .grading = {1.5}, .dimension = 2};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_NEO_HOOKEAN);
  material.lambda = material.mu = 4;
  material.alpha = alpha;
  return solid_on(
      generated("kuhn", options), material,
      (dvi_elastic_terms){.load = &load, .loads = 1, .obstacle = &floor, .obstacles = 1});
}

static dvi_march *thrown(const dvi_elastic *solid, const char *method, double fraction, double vx,
                         double vy)
{
  double rate[NUMBERS_MOST];
  dvi_march *march = march_of(solid, method, fraction);
  for (int64_t i = 0; i < dvi_march_size(march, DVI_FORM_A); i++) rate[i] = i % 2 ? vy : vx;
  begin(march, NULL, rate);
  return march;
}

/* The least y + height of the nodes. */
static double lowest(const dvi_elastic *solid, const dvi_march *march, double height)
{
  double u[NUMBERS_MOST], least = INFINITY;
  const double *X = dvi_mesh_points(dvi_elastic_mesh(solid));
  sample(march, DVI_FORM_A, u);
  for (int64_t i = 1; i < dvi_march_size(march, DVI_FORM_A); i += 2)
    least = fmin(least, X[i] + u[i] + height);
  return least;
}

static double swing(const char *method, double fraction)
{
  double force[] = {0, -g_down}, worst = 0;
  dvi_elastic *solid = falling(1, 0, 0.25, 0, force);
  dvi_march *march = thrown(solid, method, fraction, 0, 0);
  const double start = observed(march, "energy");
  for (int k = 1; k <= 60; k++) {
    advance(march, k / 2.0);
    worst = fmax(worst, fabs(observed(march, "energy") - start));
    if (k % 6 == 0) fprintf(stderr, "  %g %g: %g\n", fraction, k / 2., observed(march, "energy") - start);
  }
  ck_assert_double_gt(observed(march, "hits"), 50);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return worst;
}

START_TEST(elastic_hits_keep_the_energy)
{
  const double a = swing(methods[_i], 0.4), b = swing(methods[_i], 0.1), c = swing(methods[_i], 0.025);
  fprintf(stderr, "swing %g %g %g\n", a, b, c);
}
END_TEST

START_TEST(a_block_comes_to_rest)
{
  double force[] = {0, -g_down};
  const double e = _i % 3 / 2.0;
  dvi_elastic *solid = falling(e, _i / 9 * 0.3, 0.125, 0.5, force);
  dvi_march *march = thrown(solid, methods[_i / 3 % 3], 0.4, 0, 0);
  double energy = observed(march, "energy"), most = -INFINITY;
  for (int k = 1; k <= 80; k++) {
    advance(march, k);
    ck_assert_double_gt(lowest(solid, march, 0.125), -1e-14);
    const double now = observed(march, "energy");
    most = fmax(most, now - energy);
    energy = now;
  }
  fprintf(stderr, "e %g %s: hits %g kinetic %g most %g\n", e, methods[_i / 3%3], observed(march, "hits"), observed(march, "kinetic"), most);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* The impulse of friction is -mu times that of the floor, P_y + m g t. */
START_TEST(friction_brakes_a_block_that_slides)
{
  double force[] = {g_along, -g_down};
  const double mu = 0.25, e = _i % 3 / 2.0, height = _i / 3 % 2 * 0.05;
  for (int k = 0; k < 3; k++) {
    dvi_elastic *solid = falling(e, mu, height, 0, force);
    dvi_march *march = thrown(solid, methods[_i / 6], ldexp(0.4, -2*k), 1, 0);
    double worst = 0;
    for (double t = 0.5; t <= 10; t += 0.5) {
      advance(march, t);
      const double x = observed(march, "momentum_x") - 1 - g_along * t,
                   y = observed(march, "momentum_y") + g_down * t;
      worst = fmax(worst, fabs(x + mu * y));
    }
    fprintf(stderr, "friction %s e %g height %g: %g hits %g\n", methods[_i / 6], e, height, worst, observed(march, "hits"));
    dvi_march_destroy(&march);
    dvi_elastic_destroy(&solid);
  }
}
END_TEST

SUITE(elastic_contacts)
{
  tcase_add_loop_test(tests, marches_keep_order_2_at_hits, 0, METHODS * THROWS);
  tcase_add_loop_test(tests, elastic_hits_keep_the_energy, 0, METHODS);
  tcase_add_loop_test(tests, a_block_comes_to_rest, 0, 18);
  tcase_add_loop_test(tests, friction_brakes_a_block_that_slides, 0, 18);
}
