/* labels: unit */
/* Every instruction set gives the bits of the plain loops. On an older processor fewer sets are
 * tested; the baseline always is. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "num/compensated.h"
#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"

enum { N = 5, STAGES_MOST = 80, LANES_MOST = 80 };

static void best_again(void)
{
  dvi__lanes_choose(-1);
}

/* Numbers of several sizes and both signs, never twice the same. */
static double number(int seed)
{
  return sin(1.0 + seed) * ldexp(1.0, seed % 7 - 3);
}

static void fill(int count, double *x, int seed)
{
  for (int i = 0; i < count; i++) x[i] = number(seed + 3 * i);
}

static double sweep_matrix[STAGES_MOST * LANES_MOST], node[LANES_MOST], weight[STAGES_MOST], p0[N],
    start[N], low[N], factor[N], origin[N];
static double force[2][N * STAGES_MOST], Z[2][N * LANES_MOST], Q[2][N * STAGES_MOST + LANES_MOST];

/* One lane of a product: long ones as four sums. */
static double lane(int terms, int lanes, const double *matrix, const double *x)
{
  double sum[4] = {0};
  for (int k = 0; k < 4 && terms >= 8; k++) sum[k] = matrix[k * lanes] * x[k];
  for (int k = terms >= 8 ? 4 : 0; k < terms; k++)
    sum[terms >= 8 && k < terms / 4 * 4 ? k % 4 : 0] += matrix[k * lanes] * x[k];
  return terms >= 8 ? (sum[0] + sum[1]) + (sum[2] + sum[3]) : sum[0];
}

/* What lanes.h says, one number after the other. */
static void plain_iteration(dvi__fixed_point *s)
{
  s->change = s->largest = 0;
  for (int i = 0; i < s->n; i++) {
    double *g = s->force + i * s->stages;
    for (int j = 0; j < s->stages; j++) g[j] *= s->weight[j];
    for (int l = 0; l < s->lanes; l++) {
      double *z = &s->Z[i * s->lanes + l];
      const double sum = lane(s->stages, s->lanes, s->matrix + l, g);
      const double next = s->start[i] * s->node[l] + (s->factor[i] * sum + s->low[i] * s->node[l]);
      s->change = fmax(s->change, fabs(*z - next));
      s->largest = fmax(s->largest, fabs(next));
      if (l < s->stages) s->Q[i * s->stages + l] = s->origin[i] + next;
      *z = next;
    }
  }
}

static dvi__fixed_point made_iteration(int stages, int which)
{
  const int lanes = dvi__lanes_for(stages);
  fill(N * stages, force[which], 1);
  fill(N * lanes, Z[which], 2);
  fill(N * stages, Q[which], 3);
  return (dvi__fixed_point){.n = N,
                            .stages = stages,
                            .lanes = lanes,
                            .matrix = sweep_matrix,
                            .node = node,
                            .weight = weight,
                            .p0 = p0,
                            .start = start,
                            .low = low,
                            .factor = factor,
                            .origin = origin,
                            .force = force[which],
                            .Z = Z[which],
                            .Q = Q[which]};
}

START_TEST(a_sweep_has_the_bits_of_plain_loops)
{
  const int stages = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  dvi__lanes_choose(_i / STAGES_MOST);
  fill(stages * lanes, sweep_matrix, 4), fill(lanes, node, 5), fill(stages, weight, 6);
  fill(N, p0, 7), fill(N, factor, 8), fill(N, origin, 9);
  dvi__fixed_point fast = made_iteration(stages, 0), plain = made_iteration(stages, 1);
  dvi__lanes_split(&fast);
  for (int i = 0; i < N; i++) {
    ck_assert_double_eq(start[i], factor[i] * p0[i]);
    ck_assert_double_eq(low[i], fma(factor[i], p0[i], -start[i]));
  }
  for (int again = 0; again < 2; again++) {
    for (int k = 0; k < lanes; k++) Q[0][N * stages + k] = 42;
    dvi__lanes_iterate(&fast);
    plain_iteration(&plain);
    /* nothing is written behind */
    for (int k = 0; k < lanes; k++) ck_assert_double_eq(Q[0][N * stages + k], 42);
    ck_assert_mem_eq(force[0], force[1], (size_t)(N * stages) * sizeof(double));
    ck_assert_mem_eq(Z[0], Z[1], (size_t)(N * lanes) * sizeof(double));
    ck_assert_mem_eq(Q[0], Q[1], (size_t)(N * stages) * sizeof(double));
    ck_assert_double_eq(fast.change, plain.change);
    ck_assert_double_eq(fast.largest, plain.largest);
  }
}
END_TEST

/* A number that is not finite shows in the change and stays there, wherever it is. */
START_TEST(a_sweep_shows_forces_that_are_not_finite)
{
  const int stages = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  dvi__lanes_choose(_i / STAGES_MOST);
  fill(stages * lanes, sweep_matrix, 4), fill(lanes, node, 5), fill(stages, weight, 6);
  fill(N, p0, 7), fill(N, factor, 8), fill(N, origin, 9);
  for (int at = 0; at < N * stages; at += 1 + at) {
    for (int bad = 0; bad < 2; bad++) {
      dvi__fixed_point iteration = made_iteration(stages, 0);
      dvi__lanes_split(&iteration);
      force[0][at] = bad ? HUGE_VAL : (double)NAN;
      dvi__lanes_iterate(&iteration);
      ck_assert(!isfinite(iteration.change));
    }
  }
}
END_TEST

START_TEST(a_beginning_has_the_bits_of_its_parts)
{
  static double g[N * STAGES_MOST], whole_start[N], whole_low[N];
  const int stages = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  dvi__lanes_choose(_i / STAGES_MOST);
  fill(stages * lanes, sweep_matrix, 4), fill(lanes, node, 5), fill(N * stages, g, 10);
  fill(N, p0, 7), fill(N, factor, 8), fill(N, origin, 9);
  const dvi__fixed_point whole = made_iteration(stages, 0), parts = made_iteration(stages, 1);
  dvi__lanes_begin_from(&whole, sweep_matrix, g);
  memcpy(whole_start, start, sizeof start), memcpy(whole_low, low, sizeof low);
  dvi__lanes_split(&parts);
  dvi__lanes_product(N, stages, lanes, lanes, sweep_matrix, g, Z[1]);
  dvi__lanes_begin(&parts);
  ck_assert_mem_eq(whole_start, start, sizeof start);
  ck_assert_mem_eq(whole_low, low, sizeof low);
  ck_assert_mem_eq(Z[0], Z[1], (size_t)(N * lanes) * sizeof(double));
  ck_assert_mem_eq(Q[0], Q[1], (size_t)(N * stages) * sizeof(double));
}
END_TEST

START_TEST(a_product_has_the_bits_of_plain_loops)
{
  static double x[N * STAGES_MOST], out[N * LANES_MOST + 1];
  const int width = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(width),
            terms = 1 + (7 * width) % 23;
  dvi__lanes_choose(_i / STAGES_MOST);
  fill(terms * lanes, sweep_matrix, 1), fill(N * terms, x, 2);
  out[N * width] = 42;
  dvi__lanes_product(N, terms, lanes, width, sweep_matrix, x, out);
  for (int i = 0; i < N; i++)
    for (int l = 0; l < width; l++)
      ck_assert_double_eq(out[i * width + l], lane(terms, lanes, sweep_matrix + l, x + i * terms));
  ck_assert_double_eq(out[N * width], 42); /* nothing is written behind */
}
END_TEST

/* ---- kicks and drifts ---- */

enum { LONGEST = 37 };

typedef struct coordinates {
  double q[LONGEST + 1], p[LONGEST + 1], q_compensation[LONGEST + 1], p_compensation[LONGEST + 1];
} coordinates;

static dvi__phase phase_of(coordinates *c)
{
  return (dvi__phase){c->q, c->p, c->q_compensation, c->p_compensation};
}

static coordinates made_coordinates(void)
{
  coordinates c;
  fill(LONGEST + 1, c.q, 1), fill(LONGEST + 1, c.p, 2), fill(LONGEST + 1, c.q_compensation, 3),
      fill(LONGEST + 1, c.p_compensation, 4);
  for (int i = 0; i <= LONGEST; i++) c.q_compensation[i] *= 1e-17, c.p_compensation[i] *= 1e-17;
  return c;
}

/* What lanes.h says, one number after the other. */
static void plain_kick_drift(const dvi__kick_drift *l)
{
  for (size_t i = 0; i < l->count; i++) {
    double p = l->from.p[i], q = l->from.q[i], p_compensation = l->from.p_compensation[i],
           q_compensation = l->from.q_compensation[i];
    for (int k = 0; k < l->kicks; k++)
      dvi__add_compensated(&p, &p_compensation, l->kick[k] * l->force[i]);
    const double v = l->by == DVI__BY_ARRAY    ? p / l->mass[i]
                     : l->by == DVI__BY_SCALAR ? p / l->scalar
                                               : p * l->scalar;
    dvi__add_compensated(&q, &q_compensation, v * l->drift);
    l->to.p[i] = p, l->to.q[i] = q, l->to.p_compensation[i] = p_compensation,
    l->to.q_compensation[i] = q_compensation;
  }
}

START_TEST(a_leap_has_the_bits_of_plain_loops)
{
  double forces[LONGEST], masses[LONGEST];
  const int count = _i % (LONGEST + 1);
  dvi__lanes_choose(_i / (LONGEST + 1));
  fill(LONGEST, forces, 5), fill(LONGEST, masses, 6);
  for (int variant = 0; variant < 12; variant++) {
    coordinates from = made_coordinates(), fast = from, plain = from;
    const int in_place = variant >= 6;
    dvi__kick_drift kick_drift = {.count = (size_t)count,
                                  .kicks = 1 + variant % 2,
                                  .kick = {-0.3, 0.7},
                                  .drift = 0.1,
                                  .by = (dvi__division)(variant % 3),
                                  .scalar = 3,
                                  .mass = masses,
                                  .force = forces,
                                  .from = phase_of(in_place ? &fast : &from),
                                  .to = phase_of(&fast),
                                  .far = variant % 2};
    dvi__lanes_kick_drift(&kick_drift);
    kick_drift.from = phase_of(in_place ? &plain : &from);
    kick_drift.to = phase_of(&plain);
    plain_kick_drift(&kick_drift);
    ck_assert_mem_eq(&fast, &plain, sizeof fast); /* nothing is written behind, either */
  }
}
END_TEST

START_TEST(a_kick_has_the_bits_of_plain_loops)
{
  double forces[LONGEST];
  const int count = _i % (LONGEST + 1);
  dvi__lanes_choose(_i / (LONGEST + 1));
  fill(LONGEST, forces, 5);
  coordinates fast = made_coordinates(), plain = fast;
  dvi__lanes_add_scaled((size_t)count, -0.3, forces, fast.p, fast.p_compensation);
  for (int i = 0; i < count; i++)
    dvi__add_compensated(&plain.p[i], &plain.p_compensation[i], -0.3 * forces[i]);
  ck_assert_mem_eq(&fast, &plain, sizeof fast);
}
END_TEST

START_TEST(one_number_that_is_not_finite_is_seen_anywhere)
{
  enum { MOST = 100 };
  double x[MOST];
  const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL},
               good[] = {1.7976931348623157e308, -1.7976931348623157e308, 0, -0.0, 5e-324};
  dvi__lanes_choose(_i);
  for (int count = 0; count <= MOST; count++) {
    for (int i = 0; i < count; i++) x[i] = good[i % 5];
    ck_assert_int_eq(dvi__lanes_all_finite((size_t)count, x), 1);
    for (int at = 0; at < count; at++) {
      x[at] = bad[at % 3];
      ck_assert_int_eq(dvi__lanes_all_finite((size_t)count, x), 0);
      x[at] = good[at % 5];
    }
  }
}
END_TEST

/* Problems with loops of their own for each instruction set, and degrees on both sides of a row's
 * length. */
START_TEST(steps_have_the_same_bits_at_every_level)
{
  static const struct {
    const char *problem, *method;
    double h;
  } runs[] = {{"kepler", "midpoint", 0.05},
              {"kepler", "galerkin:degree=2", 0.05},
              {"outer-solar", "galerkin:degree=3", 50},
              {"outer-solar", "galerkin:degree=8", 300},
              {"fpu", "galerkin:degree=5,quadrature=lobatto", 0.01},
              {"double-pendulum", "galerkin:degree=9", 0.05},
              {"kepler", "composition:order=8,base=galerkin,degree=4", 0.1}};
  double q[64];
  problem *model = create_problem(runs[_i].problem, NULL);
  for (int level = 0; level < dvi__lanes_levels(); level++) {
    dvi__lanes_choose(level);
    dvi_integrator *integrator = start_integrator(model, runs[_i].method);
    advance(integrator, runs[_i].h, 50);
    if (level > 0)
      ck_assert_mem_eq(q, dvi_integrator_q(integrator), (size_t)model->nq * sizeof(double));
    memcpy(q, dvi_integrator_q(integrator), (size_t)model->nq * sizeof(double));
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&model);
}
END_TEST

START_TEST(levels_have_names)
{
  ck_assert_int_ge(dvi__lanes_levels(), 1);
  ck_assert_str_eq(dvi__lanes_level_name(0), "baseline");
  ck_assert_ptr_null(dvi__lanes_level_name(-1));
  ck_assert_ptr_null(dvi__lanes_level_name(100));
  ck_assert_int_eq(dvi__lanes_for(1) + dvi__lanes_for(2) + dvi__lanes_for(3) + dvi__lanes_for(5) +
                       dvi__lanes_for(9),
                   1 + 2 + 4 + 8 + 16);
}
END_TEST

SUITE(lanes)
{
  tcase_add_checked_fixture(tests, NULL, best_again);
  tcase_add_loop_test(tests, a_sweep_has_the_bits_of_plain_loops, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, a_sweep_shows_forces_that_are_not_finite, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, a_beginning_has_the_bits_of_its_parts, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, a_product_has_the_bits_of_plain_loops, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, a_leap_has_the_bits_of_plain_loops, 0,
                      dvi__lanes_levels() * (LONGEST + 1));
  tcase_add_loop_test(tests, a_kick_has_the_bits_of_plain_loops, 0,
                      dvi__lanes_levels() * (LONGEST + 1));
  tcase_add_loop_test(tests, one_number_that_is_not_finite_is_seen_anywhere, 0,
                      dvi__lanes_levels());
  tcase_add_loop_test(tests, steps_have_the_same_bits_at_every_level, 0, 7);
  tcase_add_test(tests, levels_have_names);
}
