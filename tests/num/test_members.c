/* labels: unit */
/* Every member has, at every instruction set, the bits that the loops for one member alone give. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/members.h"
#include "support/suite.h"

/* Widths from 1 to 9, 22 and 35: every remainder of a vector, and many vectors. */
enum { N = 3, STAGES_MOST = 17, LANES_MOST = 24, WIDTH_MOST = 35 };

static void best_again(void)
{
  dvi__lanes_choose(-1);
}

static void fill(int count, double *x, int seed)
{
  for (int i = 0; i < count; i++) x[i] = sin(1.0 + seed + 3 * i) * ldexp(1.0, (seed + i) % 7 - 3);
}

/* Row `number` of one member out of a matrix of members. */
static void take(int rows, int width, int k, const double *all, double *one)
{
  for (int i = 0; i < rows; i++) one[i] = all[i * width + k];
}

static void same_column(int rows, int width, int k, const double *all, const double *one)
{
  for (int i = 0; i < rows; i++) ck_assert_mem_eq(&all[i * width + k], &one[i], sizeof(double));
}

static double matrix[STAGES_MOST * LANES_MOST], node[LANES_MOST], weight[STAGES_MOST], factor[N];
static double p0[N * WIDTH_MOST], start[N * WIDTH_MOST], low[N * WIDTH_MOST],
    origin[N * WIDTH_MOST];
static double change[WIDTH_MOST], largest[WIDTH_MOST];
static double force[N * STAGES_MOST * WIDTH_MOST], Z[N * STAGES_MOST * WIDTH_MOST],
    Q[N * STAGES_MOST * WIDTH_MOST + 1];
static double old_force[N * STAGES_MOST * WIDTH_MOST], old_Z[N * STAGES_MOST * WIDTH_MOST];

/* ---- sweeps ---- */

/* What dvi__lanes_split, dvi__lanes_begin and dvi__lanes_iterate work on for one member. */
typedef struct single {
  double p0[N], start[N], low[N], origin[N], force[N * STAGES_MOST], Z[N * LANES_MOST],
      Q[N * STAGES_MOST];
  dvi__fixed_point iteration;
} single;

static void take_member(int k, int stages, int lanes, int width, single *one)
{
  double z[N * STAGES_MOST];
  memset(one, 0, sizeof *one);
  take(N, width, k, p0, one->p0), take(N, width, k, origin, one->origin);
  take(N * stages, width, k, old_force, one->force);
  take(N * stages, width, k, old_Z, z);
  for (int i = 0; i < N; i++)
    memcpy(one->Z + i * lanes, z + i * stages, (size_t)stages * sizeof(double));
  one->iteration = (dvi__fixed_point){.n = N,
                                      .stages = stages,
                                      .lanes = lanes,
                                      .matrix = matrix,
                                      .node = node,
                                      .weight = weight,
                                      .factor = factor,
                                      .p0 = one->p0,
                                      .start = one->start,
                                      .low = one->low,
                                      .origin = one->origin,
                                      .force = one->force,
                                      .Z = one->Z,
                                      .Q = one->Q};
  dvi__lanes_split(&one->iteration);
}

static void same_member(int k, int stages, int lanes, int width, const single *one)
{
  double z[N * STAGES_MOST];
  for (int i = 0; i < N; i++)
    memcpy(z + i * stages, one->Z + i * lanes, (size_t)stages * sizeof(double));
  same_column(N, width, k, start, one->start);
  same_column(N, width, k, low, one->low);
  same_column(N * stages, width, k, force, one->force);
  same_column(N * stages, width, k, Z, z);
  same_column(N * stages, width, k, Q, one->Q);
}

/* The matrix's columns and the nodes are padded with zeros, as those of an element are. The first
 * node is where the step starts, as Lobatto's is. */
static void fill_tables(int stages, int lanes)
{
  fill(stages * lanes, matrix, 4), fill(lanes, node, 5), fill(stages, weight, 6),
      fill(N, factor, 8);
  factor[0] = fabs(factor[0]);
  node[0] = 0;
  for (int l = 0; l < stages; l++) matrix[l * lanes] = 0;
  for (int j = stages; j < lanes; j++) {
    node[j] = 0;
    for (int l = 0; l < stages; l++) matrix[l * lanes + j] = 0;
  }
}

/* Two coordinates that show the signs of zeros: where all forces and the momentum point back the
 * sum at the first node is -0 or 0 by how it is added; the other one rests. */
static void fill_members(int stages, int width)
{
  fill(N * width, p0, 7), fill(N * width, origin, 9);
  fill(N * stages * width, force, 1), fill(N * stages * width, Z, 2);
  for (int k = 0; k < width; k++) {
    p0[k] = -fabs(p0[k]);
    p0[width + k] = k % 2 == 0 ? 0.0 : -0.0;
    origin[k] = origin[width + k] = k % 3 == 0 ? 0.0 : -0.0;
    for (int j = 0; j < stages; j++) {
      force[j * width + k] = -weight[j];
      force[(stages + j) * width + k] = k % 5 == 0 ? 0.0 : -0.0;
    }
  }
  memcpy(old_force, force, sizeof force);
  memcpy(old_Z, Z, sizeof Z);
}

static dvi__members_fixed_point made_iteration(int stages, int lanes, int width)
{
  return (dvi__members_fixed_point){.n = N,
                                    .stages = stages,
                                    .width = width,
                                    .lanes = lanes,
                                    .matrix = matrix,
                                    .node = node,
                                    .weight = weight,
                                    .factor = factor,
                                    .start = start,
                                    .low = low,
                                    .origin = origin,
                                    .force = force,
                                    .Z = Z,
                                    .Q = Q,
                                    .change = change,
                                    .largest = largest};
}

/* Many members by one loop, and each alone by the other, for case number i. */
static void compare(int i, void (*many)(const dvi__members_fixed_point *s),
                    void (*alone)(dvi__fixed_point *s))
{
  const int level = i / STAGES_MOST, stages = 1 + i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  dvi__lanes_choose(level);
  fill_tables(stages, lanes);
  for (int width = 1; width <= WIDTH_MOST; width += width < 9 ? 1 : 13) {
    const dvi__members_fixed_point iteration = made_iteration(stages, lanes, width);
    fill_members(stages, width);
    dvi__members_split(N, width, factor, p0, start, low);
    for (int k = 0; k < width; k++) change[k] = largest[k] = 0;
    many(&iteration);
    for (int k = 0; k < width; k++) {
      single one;
      take_member(k, stages, lanes, width, &one);
      one.iteration.change = one.iteration.largest = 0;
      alone(&one.iteration);
      same_member(k, stages, lanes, width, &one);
      ck_assert_double_eq(change[k], one.iteration.change);
      ck_assert_double_eq(largest[k], one.iteration.largest);
    }
  }
}

START_TEST(a_sweep_has_the_bits_of_one_member_alone)
{
  compare(_i, dvi__members_iterate, dvi__lanes_iterate);
}
END_TEST

static void begin_alone(dvi__fixed_point *iteration)
{
  dvi__lanes_begin(iteration);
}

START_TEST(a_beginning_has_the_bits_of_one_member_alone)
{
  compare(_i, dvi__members_begin, begin_alone);
}
END_TEST

/* ---- ends ---- */

static double moved[N * WIDTH_MOST], moved_low[N * WIDTH_MOST], sum_of[N * WIDTH_MOST];

static void check_ends_of(int k, int stages, int width)
{
  double g[N * STAGES_MOST], start_k[N], moved_k[N], low_k[N], sum_k[N];
  take(N * stages, width, k, force, g);
  take(N, width, k, p0, start_k);
  dvi__lanes_ends(&(dvi__ends){.n = N,
                               .stages = stages,
                               .g = g,
                               .slant = weight,
                               .factor = factor,
                               .p0 = start_k,
                               .moved = moved_k,
                               .low = low_k,
                               .sum = sum_k});
  same_column(N, width, k, moved, moved_k);
  same_column(N, width, k, moved_low, low_k);
  same_column(N, width, k, sum_of, sum_k);
}

START_TEST(ends_have_the_bits_of_one_member_alone)
{
  const int level = _i / STAGES_MOST, stages = 1 + _i % STAGES_MOST;
  dvi__lanes_choose(level);
  fill_tables(stages, dvi__lanes_for(stages));
  for (int width = 1; width <= WIDTH_MOST; width += width < 9 ? 1 : 13) {
    fill_members(stages, width);
    dvi__members_ends_of(&(dvi__members_ends){.n = N,
                                              .stages = stages,
                                              .width = width,
                                              .g = force,
                                              .slant = weight,
                                              .factor = factor,
                                              .p0 = p0,
                                              .moved = moved,
                                              .low = moved_low,
                                              .sum = sum_of});
    for (int k = 0; k < width; k++) check_ends_of(k, stages, width);
  }
}
END_TEST

/* ---- products ---- */

START_TEST(a_product_has_the_bits_of_one_member_alone)
{
  const int level = _i / STAGES_MOST, terms = 1 + _i % STAGES_MOST,
            rows = 1 + (5 * terms) % STAGES_MOST, lanes = dvi__lanes_for(rows);
  fill(terms * lanes, matrix, 1);
  for (int width = 1; width <= WIDTH_MOST; width += width < 9 ? 1 : 13) {
    fill(N * terms * width, Z, 2);
    Q[N * rows * width] = 42;
    dvi__lanes_choose(level);
    dvi__members_product(N, terms, lanes, rows, matrix, width, Z, Q);
    ck_assert_double_eq(Q[N * rows * width], 42); /* nothing is written behind */
    for (int k = 0; k < width; k++) {
      double x[N * STAGES_MOST], out[N * STAGES_MOST];
      take(N * terms, width, k, Z, x);
      dvi__lanes_product(N, terms, lanes, rows, matrix, x, out);
      same_column(N * rows, width, k, Q, out);
    }
  }
}
END_TEST

SUITE(members)
{
  tcase_add_checked_fixture(tests, NULL, best_again);
  tcase_add_loop_test(tests, a_sweep_has_the_bits_of_one_member_alone, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, a_beginning_has_the_bits_of_one_member_alone, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, ends_have_the_bits_of_one_member_alone, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, a_product_has_the_bits_of_one_member_alone, 0,
                      dvi__lanes_levels() * STAGES_MOST);
}
