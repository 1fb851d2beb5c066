/* labels: unit */
/* Every member has, at every instruction set, the bits that the loops for one member alone give. */
#include <math.h>
#include <string.h>

#include "num/compensated.h"
#include "num/lanes.h"
#include "num/members.h"
#include "support/suite.h"

enum { N = 3, STAGES_MOST = 9, LANES_MOST = 16, WIDTH_MOST = 35 };

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
static double start[N * WIDTH_MOST], origin[N * WIDTH_MOST], change[WIDTH_MOST], largest[WIDTH_MOST];
static double force[N * STAGES_MOST * WIDTH_MOST], Z[N * STAGES_MOST * WIDTH_MOST], Q[N * STAGES_MOST * WIDTH_MOST + 1];
static double old_force[N * STAGES_MOST * WIDTH_MOST], old_Z[N * STAGES_MOST * WIDTH_MOST];

/* The sweep of dvi__lanes_sweep for member k, from the old forces and offsets. */
static void check_sweep_of(int k, int stages, int lanes, int width)
{
  double force_k[N * STAGES_MOST], z_k[N * STAGES_MOST], Z_k[N * LANES_MOST] = {0}, Q_k[N * STAGES_MOST], start_k[N], origin_k[N];
  take(N * stages, width, k, old_force, force_k);
  take(N * stages, width, k, old_Z, z_k);
  take(N, width, k, start, start_k);
  take(N, width, k, origin, origin_k);
  for (int i = 0; i < N; i++) memcpy(Z_k + i * lanes, z_k + i * stages, (size_t)stages * sizeof(double));
  dvi__sweep alone = {.n = N,
                      .stages = stages,
                      .lanes = lanes,
                      .matrix = matrix,
                      .node = node,
                      .weight = weight,
                      .start = start_k,
                      .factor = factor,
                      .origin = origin_k,
                      .force = force_k,
                      .Z = Z_k,
                      .Q = Q_k};
  dvi__lanes_sweep(&alone);
  for (int i = 0; i < N; i++) memcpy(z_k + i * stages, Z_k + i * lanes, (size_t)stages * sizeof(double));
  same_column(N * stages, width, k, force, force_k);
  same_column(N * stages, width, k, Z, z_k);
  same_column(N * stages, width, k, Q, Q_k);
  ck_assert_double_eq(change[k], alone.change);
  ck_assert_double_eq(largest[k], alone.largest);
}

/* The matrix's columns and the nodes are padded with zeros, as those of an element are. */
static void fill_tables(int stages, int lanes)
{
  fill(stages * lanes, matrix, 4), fill(lanes, node, 5), fill(stages, weight, 6), fill(N, factor, 8);
  for (int j = stages; j < lanes; j++) {
    node[j] = 0;
    for (int l = 0; l < stages; l++) matrix[l * lanes + j] = 0;
  }
}

START_TEST(a_sweep_has_the_bits_of_one_member_alone)
{
  const int level = _i / STAGES_MOST, stages = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  if (level >= dvi__lanes_levels()) return;
  fill_tables(stages, lanes);
  for (int width = 1; width <= WIDTH_MOST; width++) {
    const int numbers = N * stages * width;
    fill(N * width, start, 7), fill(N * width, origin, 9), fill(numbers, force, 1), fill(numbers, Z, 2);
    memcpy(old_force, force, sizeof force);
    memcpy(old_Z, Z, sizeof Z);
    dvi__members_sweep sweep = {.n = N,
                                .stages = stages,
                                .width = width,
                                .lanes = lanes,
                                .matrix = matrix,
                                .node = node,
                                .weight = weight,
                                .factor = factor,
                                .start = start,
                                .origin = origin,
                                .force = force,
                                .Z = Z,
                                .Q = Q,
                                .change = change,
                                .largest = largest};
    dvi__lanes_choose(level);
    dvi__members_sweep_once(&sweep);
    for (int k = 0; k < width; k++) check_sweep_of(k, stages, lanes, width);
  }
}
END_TEST

START_TEST(a_product_has_the_bits_of_one_member_alone)
{
  const int level = _i / STAGES_MOST, terms = 1 + _i % STAGES_MOST, rows = 1 + (5 * terms) % STAGES_MOST,
            lanes = dvi__lanes_for(rows);
  if (level >= dvi__lanes_levels()) return;
  fill(terms * lanes, matrix, 1);
  for (int width = 1; width <= WIDTH_MOST; width++) {
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

START_TEST(sums_and_drifts_have_the_bits_of_plain_loops)
{
  enum { COUNT = 41 };
  double x[COUNT], sum[COUNT + 1], carry[COUNT], plain[COUNT], plain_carry[COUNT];
  if (_i >= dvi__lanes_levels()) return;
  dvi__lanes_choose(_i);
  for (int count = 0; count <= COUNT; count++)
    for (int drift = 0; drift < 2; drift++) {
      fill(count, x, 1), fill(count, sum, 2), fill(count, carry, 3);
      memcpy(plain, sum, sizeof plain);
      memcpy(plain_carry, carry, sizeof plain_carry);
      sum[count] = 42;
      if (drift)
        dvi__members_drift((size_t)count, 0.3, 0.7, x, sum, carry);
      else
        dvi__members_add((size_t)count, 0.3, x, sum, carry);
      for (int k = 0; k < count; k++) dvi__add_compensated(plain + k, plain_carry + k, drift ? x[k] / 0.7 * 0.3 : 0.3 * x[k]);
      ck_assert_mem_eq(sum, plain, (size_t)count * sizeof(double));
      ck_assert_mem_eq(carry, plain_carry, (size_t)count * sizeof(double));
      ck_assert_double_eq(sum[count], 42);
    }
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("members");
  tcase_add_checked_fixture(tests, NULL, best_again);
  tcase_add_loop_test(tests, a_sweep_has_the_bits_of_one_member_alone, 0, 3 * STAGES_MOST);
  tcase_add_loop_test(tests, a_product_has_the_bits_of_one_member_alone, 0, 3 * STAGES_MOST);
  tcase_add_loop_test(tests, sums_and_drifts_have_the_bits_of_plain_loops, 0, 3);
  return run_tests("num/members", tests);
}
