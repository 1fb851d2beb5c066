/* Marches of elastic solids among obstacles: orders at hits, energies, rests and friction. With
 * DVI_SHOW_ORDERS in the environment the errors are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/field/solids.h"
#include "support/solid/throws.h"
#include "support/suite.h"

static const char *const methods[] = {"avi", "avi:classes=no", "verlet"};
enum { METHODS = 3, NUMBERS_MOST = 3 * 27 };
static const double restitutions[] = {0, 0.5, 1};

static const double *points_of(const dvi_elastic *solid)
{
  return dvi_mesh_points(dvi_elastic_mesh(solid));
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

static thrown throw_of(int i)
{
  const solid_case of = {
      .n = 2 + i % 2, .cells = i % 2 ? 1 : 2, .grading = 1.5, .law = DVI_ELASTIC_NEO_HOOKEAN};
  return throw_block(&of, obstacles + i / 2, 0.5, 0.75);
}

/* Set the errors of u and u'. */
static void measure(const thrown *c, const char *method, double fraction, double error[2])
{
  const int size = c->s.judge.size;
  double values[NUMBERS_MOST];
  dvi_march *march = march_of_solid(c->s.elastic, method, fraction);
  start_march_of_solid(march, c->u, c->rate);
  advance_march(march, c->span);
  copy_march(march, DVI_FORM_A, values);
  error[0] = error_of_solid(size, values, c->end);
  copy_march(march, DVI_FORM_E, values);
  for (int k = 0; k < size; k++) values[k] = -values[k];
  error[1] = error_of_solid(size, values, c->speed);
  dvi_march_destroy(&march);
}

/* The error of a hit depends on its place in a step, so the slope is that of a line of best fit. */
START_TEST(marches_keep_order_2_at_hits)
{
  const char *method = methods[_i / THROWS];
  thrown c = throw_of(_i % THROWS);
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
    ck_assert_double_gt(order[k] / weight, 1.7);
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

static dvi_march *tossed(const dvi_elastic *solid, const char *method, double fraction, double vx,
                         double vy)
{
  double rate[NUMBERS_MOST] = {0};
  dvi_march *march = march_of_solid(solid, method, fraction);
  for (int64_t i = 0; i < dvi_march_size(march, DVI_FORM_A); i++) rate[i] = i % 2 ? vy : vx;
  start_march_of_solid(march, NULL, rate);
  return march;
}

/* The least y + height of the nodes. */
static double lowest(const dvi_elastic *solid, const dvi_march *march, double height)
{
  double u[NUMBERS_MOST], least = INFINITY;
  const double *X = points_of(solid);
  copy_march(march, DVI_FORM_A, u);
  for (int64_t i = 1; i < dvi_march_size(march, DVI_FORM_A); i += 2)
    least = fmin(least, X[i] + u[i] + height);
  return least;
}

/* Give the largest change of the energy over about a hundred hits, and the change at the end. */
static double swing(const char *method, double fraction)
{
  double force[] = {0, -g_down}, worst = 0;
  dvi_elastic *solid = falling(1, 0, 0.25, 0, force);
  dvi_march *march = tossed(solid, method, fraction, 0, 0);
  const double start = observe_march(march, "energy");
  for (int k = 1; k <= 60; k++) {
    advance_march(march, k / 2.0);
    worst = fmax(worst, fabs(observe_march(march, "energy") - start));
  }
  ck_assert_double_gt(observe_march(march, "hits"), 50);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return worst;
}

/* The block has 1/8 to lose. Without hits the energy swings by as much. */
START_TEST(elastic_hits_keep_the_energy_to_order_2)
{
  const double coarse = swing(methods[_i], 0.4), fine = swing(methods[_i], 0.05);
  ck_assert_double_lt(coarse, 0.0125);
  ck_assert_double_lt(fine, 2 * coarse / 64);
}
END_TEST

/* The nodes of the floor reach it together, at t = 1/2. Those that rest then are pressed on. */
START_TEST(a_flat_hit_has_the_impulse_of_its_restitution)
{
  double force[] = {0, 0}, floor_mass = 0;
  const double e = restitutions[_i / METHODS];
  dvi_elastic *solid = falling(e, 0, 0.25, 0, force);
  dvi_march *march = tossed(solid, methods[_i % METHODS], 0.3, 0.25, -0.5);
  const double *X = points_of(solid);
  for (int v = 0; v < 9; v++)
    if (X[2 * v + 1] == 0) floor_mass += dvi_elastic_masses(solid)[v];
  advance_march(march, 0.4999);
  ck_assert_double_eq(observe_march(march, "hits"), 0);
  advance_march(march, 0.5001);
  ck_assert_double_eq(observe_march(march, "hits"), 3);
  ck_assert_double_eq_tol(observe_march(march, "momentum_y"), -0.5 + (1 + e) * 0.5 * floor_mass,
                          e > 0 ? 1e-14 : 2e-5);
  ck_assert_double_eq_tol(observe_march(march, "momentum_x"), 0.25, 1e-14);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* With free steps the cells of a node that rests push at different times, so that it trembles by
 * O(h^2) without a surface, too. Elastic hits change the energy of what moves by O(h^2). */
START_TEST(a_damped_block_comes_to_rest)
{
  double force[] = {0, -g_down};
  const int is_free = _i / 3 % METHODS == 1;
  dvi_elastic *solid = falling(restitutions[_i % 3], _i < 9 ? 0 : 0.3, 0.125, 0.5, force);
  dvi_march *march = tossed(solid, methods[_i / 3 % METHODS], 0.4, 0, 0);
  double energy = observe_march(march, "energy");
  for (int k = 1; k <= 80; k++) {
    advance_march(march, k);
    ck_assert_double_gt(lowest(solid, march, 0.125), -1e-14);
    const double now = observe_march(march, "energy"),
                 gain = restitutions[_i % 3] < 1 ? 0 : 0.25 * observe_march(march, "kinetic");
    ck_assert_double_lt(now, energy + gain + (is_free ? 1e-4 : 1e-15));
    energy = now;
  }
  ck_assert_double_lt(observe_march(march, "kinetic"), is_free ? 2e-4 : 1e-15);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- friction ---- */

/* Give the largest error of the impulse of friction, which is -mu times that of the floor,
 * P_y + m g t. */
static double friction_error(double e, double height, const char *method, double fraction)
{
  double force[] = {g_along, -g_down}, worst = 0;
  const double mu = 0.25;
  dvi_elastic *solid = falling(e, mu, height, 0, force);
  dvi_march *march = tossed(solid, method, fraction, 1, 0);
  for (int k = 1; k <= 20; k++) {
    const double t = k / 2.0;
    advance_march(march, t);
    const double along = observe_march(march, "momentum_x") - 1 - g_along * t,
                 floor = observe_march(march, "momentum_y") + g_down * t;
    worst = fmax(worst, fabs(along + mu * floor));
  }
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return worst;
}

/* Friction in a rest is of order 1. The impulse is about 5. */
START_TEST(friction_takes_its_part_of_the_impulse)
{
  const double e = restitutions[_i % 3], height = _i / 3 % 2 * 0.05;
  const char *method = methods[_i / 6];
  const double coarse = friction_error(e, height, method, 0.4),
               fine = friction_error(e, height, method, 0.1);
  ck_assert_double_lt(coarse, 0.03);
  ck_assert_double_lt(fine, fmax(0.35 * coarse, 1e-13));
}
END_TEST

/* Slower and slower, P' = -alpha P - (mu g - g_x) beside what the floor shakes, it stops, and stays
 * for ever. */
START_TEST(friction_stops_and_holds_a_block)
{
  double force[] = {g_along, -g_down}, u[2][NUMBERS_MOST];
  const double brake = 0.6 * g_down - g_along;
  dvi_elastic *solid = falling(0, 0.6, 0, 1, force);
  dvi_march *march = tossed(solid, methods[_i], 0.4, 0.25, 0);
  advance_march(march, 0.75);
  ck_assert_double_eq_tol(observe_march(march, "momentum_x"), (0.25 + brake) * exp(-0.75) - brake,
                          0.02);
  advance_march(march, 60);
  copy_march(march, DVI_FORM_A, u[0]);
  advance_march(march, 120);
  copy_march(march, DVI_FORM_A, u[1]);
  const double *X = points_of(solid);
  for (int v = 0; v < 9; v++)
    for (int i = 0; i < 2 && X[2 * v + 1] == 0; i++)
      ck_assert_double_eq(u[0][2 * v + i], u[1][2 * v + i]);
  ck_assert_double_lt(observe_march(march, "kinetic"), methods[_i][3] == ':' ? 1e-6 : 1e-20);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- bits, caves and starts ---- */

static void check_same(const dvi_march *a, const dvi_march *b)
{
  double values[2][NUMBERS_MOST];
  for (int form = 0; form < 2; form++) {
    copy_march(a, (dvi_march_form)form, values[0]);
    copy_march(b, (dvi_march_form)form, values[1]);
    ck_assert_mem_eq(values[0], values[1], (size_t)dvi_march_size(a, DVI_FORM_A) * sizeof(double));
  }
  ck_assert_double_eq(observe_march(a, "hits"), observe_march(b, "hits"));
}

START_TEST(cuts_and_saves_among_hits_change_no_bit)
{
  double force[] = {g_along, -g_down};
  char path[64];
  dvi_elastic *solid = falling(0.5, 0.3, 0.01, 0, force);
  dvi_march *whole = tossed(solid, methods[_i], 0.4, 0.25, -0.25),
            *cut = tossed(solid, methods[_i], 0.4, 0.25, -0.25),
            *saved = march_of_solid(solid, methods[_i], 0.4);
  (void)snprintf(path, sizeof path, "elastic_contacts_%d_%d.state", _i, (int)getpid());
  for (int k = 1; k <= 100; k++) {
    const int component = k % 18;
    double single, all[NUMBERS_MOST];
    advance_march(cut, k * 0.05);
    ck_assert(dvi_march_sample(cut, DVI_FORM_E, 1, &component, &single) == DVI_OK);
    copy_march(cut, DVI_FORM_E, all);
    ck_assert(single == all[component]);
    if (k == 37) ck_assert(dvi_march_save(cut, path) == DVI_OK);
    if (k == 37) ck_assert(dvi_march_load(saved, path) == DVI_OK);
  }
  (void)remove(path);
  advance_march(whole, 5);
  advance_march(saved, 5);
  ck_assert_double_gt(observe_march(whole, "hits"), 5);
  check_same(whole, cut);
  check_same(whole, saved);
  dvi_march_destroy(&whole);
  dvi_march_destroy(&cut);
  dvi_march_destroy(&saved);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(threads_change_no_bit_among_hits)
{
  double force[] = {g_along, -g_down}, E[NUMBERS_MOST];
  dvi_elastic *solid = falling(0.5, 0.3, 0.01, 0, force);
  const dvi_march_options options = {
      .size = sizeof options, .method = methods[_i], .fraction = 0.4, .threads = 3};
  dvi_march *one = tossed(solid, methods[_i], 0.4, 0.25, -0.25), *three = NULL;
  ck_assert(dvi_elastic_march_create(solid, &options, &three) == DVI_OK);
  for (int i = 0; i < 18; i++) E[i] = i % 2 ? 0.25 : -0.25;
  const dvi_march_state state = {.size = sizeof state, .E = E};
  ck_assert(dvi_march_start(three, &state) == DVI_OK);
  advance_march(one, 5);
  advance_march(three, 5);
  check_same(one, three);
  dvi_march_destroy(&one);
  dvi_march_destroy(&three);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(a_block_stays_in_a_cave)
{
  double u[NUMBERS_MOST], rate[NUMBERS_MOST] = {0};
  const dvi_obstacle cave = {.name = "cave",
                             .kind = DVI_OBSTACLE_HOLLOW,
                             .point = {0.5, 0.5, 0.5},
                             .radius = 1,
                             .restitution = restitutions[_i / METHODS]};
  const solid_case of = {.n = 3, .cells = 1, .grading = 1, .law = DVI_ELASTIC_NEO_HOOKEAN};
  judged_solid s = make_judged(&of, &cave, 1);
  dvi_march *march = march_of_solid(s.elastic, methods[_i % METHODS], 0.4);
  for (int k = 0; k < 24; k++) rate[k] = k % 3 == 0 ? 0.3 : k % 3 == 1 ? -0.2 : 0.1;
  start_march_of_solid(march, NULL, rate);
  const double energy = observe_march(march, "energy"), *X = points_of(s.elastic);
  for (int k = 1; k <= 40; k++) {
    advance_march(march, k / 2.0);
    copy_march(march, DVI_FORM_A, u);
    for (int v = 0; v < 8; v++) {
      double square = 0;
      for (int i = 0; i < 3; i++)
        square += (X[3 * v + i] + u[3 * v + i] - 0.5) * (X[3 * v + i] + u[3 * v + i] - 0.5);
      ck_assert_double_lt(square, 1 + 1e-14);
    }
    ck_assert_double_lt(observe_march(march, "energy"), 1.05 * energy);
  }
  ck_assert_double_gt(observe_march(march, "hits"), 3);
  dvi_march_destroy(&march);
  end_judged_solid(&s);
}
END_TEST

START_TEST(a_start_inside_of_an_obstacle_is_refused)
{
  double force[] = {0, 0}, u[18] = {0};
  dvi_elastic *solid = falling(0, 0, 0.25, 0, force);
  dvi_march *march = march_of_solid(solid, methods[_i], 0.4);
  const dvi_march_state state = {.size = sizeof state, .A = u};
  u[1] = -0.5;
  ck_assert(dvi_march_start(march, &state) == DVI_BAD_ARGUMENT);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "inside of the obstacle \"floor\", 0.25 deep"));
  u[1] = -0.25;
  ck_assert(dvi_march_start(march, &state) == DVI_OK);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

SUITE(elastic_contacts)
{
  tcase_add_loop_test(tests, marches_keep_order_2_at_hits, 0, METHODS * THROWS);
  tcase_add_loop_test(tests, elastic_hits_keep_the_energy_to_order_2, 0, METHODS);
  tcase_add_loop_test(tests, a_flat_hit_has_the_impulse_of_its_restitution, 0, 3 * METHODS);
  tcase_add_loop_test(tests, a_damped_block_comes_to_rest, 0, 6 * METHODS);
  tcase_add_loop_test(tests, friction_takes_its_part_of_the_impulse, 0, 6 * METHODS);
  tcase_add_loop_test(tests, friction_stops_and_holds_a_block, 0, METHODS);
  tcase_add_loop_test(tests, cuts_and_saves_among_hits_change_no_bit, 0, METHODS);
  tcase_add_loop_test(tests, threads_change_no_bit_among_hits, 0, METHODS);
  tcase_add_loop_test(tests, a_block_stays_in_a_cave, 0, 2 * METHODS);
  tcase_add_loop_test(tests, a_start_inside_of_an_obstacle_is_refused, 0, METHODS);
}
