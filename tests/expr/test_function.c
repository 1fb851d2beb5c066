#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"
#include "expr/draft.h"
#include "expr/function/function.h"
#include "support/heap.h"
#include "support/suite.h"

/* --- Against the callbacks of the catalogue. --- */

static problem *catalogue(const char *name, const char *setting)
{
  problem *found = NULL;
  char message[200];
  ck_assert_int_eq(problem_create(name, setting != NULL, &setting, &found, message, sizeof message),
                   DVI_OK);
  return found;
}

/* Points near the start of a problem. */
static double *points(const double *start, int n, int count)
{
  double *x = malloc((size_t)n * (size_t)count * sizeof *x);
  ck_assert_ptr_nonnull(x);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < count; k++)
      x[i * count + k] = start[i] + 0.1 * sin(1.0 + i + 3.0 * k) * (1.0 + fabs(start[i]));
  return x;
}

static double *room(int size)
{
  double *x = malloc(((size_t)size + 1) * sizeof *x);
  ck_assert_ptr_nonnull(x);
  return x;
}

/* Equal to some rounding of the largest number. */
static void check_equal(int size, const double *found, const double *expected)
{
  double largest = 0.0;
  for (int i = 0; i < size; i++) largest = fmax(largest, fabs(expected[i]));
  for (int i = 0; i < size; i++)
    ck_assert_double_le(fabs(found[i] - expected[i]), 40.0 * DBL_EPSILON * largest);
}

static void check_patterns(const dvi_pattern *found, int full, const dvi_pattern *expected, int n)
{
  ck_assert_int_eq(full, expected->start == NULL);
  if (full) return;
  ck_assert_mem_eq(found->start, expected->start, ((size_t)n + 1) * sizeof(int));
  ck_assert_mem_eq(found->row, expected->row, (size_t)found->start[n] * sizeof(int));
}

static void check_potential(dvi__function *function, const char *name, const char *setting,
                            int count)
{
  problem *made_by_hand = catalogue(name, setting);
  const dvi_potential *potential = &made_by_hand->terms->potentials[0];
  const int n = made_by_hand->nq;
  double *q = points(made_by_hand->q, n, count), *t = calloc((size_t)count, sizeof *t);
  double *V = room(count), *V_q = room(n * count), *V_qq = room(n * n * count);
  double *value = room(count), *gradient = room(n * count), *hessian = room(n * n * count);
  const double *const x[BLOCKS] = {[COORDINATES] = q};
  dvi_pattern pattern;
  int full;
  ck_assert_int_eq(dvi__function_value(function, count, x, V), 0);
  ck_assert_int_eq(
      dvi__function_gradient(function, count, x, (double *const[BLOCKS]){[COORDINATES] = V_q}), 0);
  ck_assert_int_eq(
      dvi__function_second(function, count, x, (double *const[PAIRS]){[PAIR_QQ] = V_qq}), 0);
  ck_assert_int_eq(dvi__function_pattern(function, PAIR_QQ, &pattern, &full), DVI_OK);
  ck_assert_int_eq(potential->value_batch(count, t, q, value, potential->user), 0);
  ck_assert_int_eq(potential->gradient_batch(count, t, q, gradient, potential->user), 0);
  ck_assert_int_eq(potential->hessian_batch(count, t, q, hessian, potential->user), 0);
  check_equal(count, V, value);
  check_equal(n * count, V_q, gradient);
  check_patterns(&pattern, full, &potential->qq, n);
  check_equal((full ? n * n : pattern.start[n]) * count, V_qq, hessian);
  double *const owned[] = {q, t, V, V_q, V_qq, value, gradient, hessian};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
  problem_destroy(&made_by_hand);
}

START_TEST(planets_pull_as_in_the_catalogue)
{
  draft own;
  dvi__function *function = solar(&own);
  for (int count = 1; count <= 9; count++) check_potential(function, "outer-solar", NULL, count);
  check_potential(function, "outer-solar", NULL, 100);
  drop(&own, function);
}
END_TEST

START_TEST(todas_lattice_is_that_of_the_catalogue)
{
  draft own;
  dvi__function *function = toda(&own, 100);
  for (int count = 1; count <= 40; count += 3) check_potential(function, "toda", "N=100", count);
  drop(&own, function);
}
END_TEST

START_TEST(soft_springs_are_those_of_the_catalogue)
{
  draft own;
  dvi__function *function = fpu(&own, 50);
  for (int count = 1; count <= 40; count += 3) check_potential(function, "fpu", "ell=50", count);
  drop(&own, function);
}
END_TEST

START_TEST(short_kernels_are_written_out)
{
  draft own;
  dvi__function *function = gravity(&own, 3, 2, 1.0, (const double[]){1.0, 1.0, 1.0});
  ck_assert_int_eq(dvi__function_kernel(function, 0)->elements, 1);
  ck_assert_int_eq(dvi__function_kernel(function, 0)->input_count, 6);
  for (int count = 1; count <= 9; count++) check_potential(function, "figure-eight", NULL, count);
  check_potential(function, "figure-eight", NULL, 300);
  drop(&own, function);
  function = fpu(&own, 50);
  ck_assert_int_eq(dvi__function_kernel_count(function), 2); /* the inner springs, and both ends */
  drop(&own, function);
}
END_TEST

START_TEST(the_double_pendulum_is_that_of_the_catalogue)
{
  enum { COUNT = 11 };
  draft own;
  dvi__function *function = double_pendulum(&own);
  problem *made_by_hand = catalogue("double-pendulum", NULL);
  const dvi_lagrangian *L = made_by_hand->terms->lagrangian;
  double *q = points(made_by_hand->q, 2, COUNT), *v = points(made_by_hand->v, 2, COUNT);
  double t[COUNT] = {0}, value[2][COUNT], gradient[2][2][2 * COUNT], second[2][3][4 * COUNT];
  const double *const x[BLOCKS] = {[COORDINATES] = q, [VELOCITIES] = v};
  ck_assert_int_eq(dvi__function_value(function, COUNT, x, value[0]), 0);
  ck_assert_int_eq(
      dvi__function_gradient(function, COUNT, x,
                             (double *const[BLOCKS]){NULL, gradient[0][0], gradient[0][1]}),
      0);
  ck_assert_int_eq(
      dvi__function_second(function, COUNT, x,
                           (double *const[PAIRS]){second[0][0], second[0][1], second[0][2]}),
      0);
  ck_assert_int_eq(L->value_batch(COUNT, t, q, v, value[1], L->user), 0);
  ck_assert_int_eq(L->gradient_batch(COUNT, t, q, v, gradient[1][0], gradient[1][1], L->user), 0);
  ck_assert_int_eq(
      L->hessian_batch(COUNT, t, q, v, second[1][0], second[1][1], second[1][2], L->user), 0);
  check_equal(COUNT, value[0], value[1]);
  check_equal(4 * COUNT, gradient[0][0], gradient[1][0]);
  check_equal(12 * COUNT, second[0][0], second[1][0]);
  free(q);
  free(v);
  problem_destroy(&made_by_hand);
  drop(&own, function);
}
END_TEST

/* --- What else is promised. --- */

/* 90 bodies have 4005 pairs, in many tiles. */
static dvi__function *many(draft *own)
{
  double mass[90];
  for (int a = 0; a < 90; a++) mass[a] = 1.0 + 0.01 * a;
  return gravity(own, 90, 3, 1.0, mass);
}

/* Points of 90 bodies, all different. */
static double *many_points(int count)
{
  double start[270];
  for (int i = 0; i < 270; i++) start[i] = 10.0 * sin(1.7 * i);
  return points(start, 270, count);
}

enum { MOST = 300 };

/* At `all` points of n variables, [n * MOST]. */
static void check_bits(dvi__function *function, int n, const double *all)
{
  double *q = room(n * MOST), *V_q = room(n * MOST), *one = room(n * MOST), V, value[MOST];
  for (int k = 0; k < MOST; k++) {
    for (int i = 0; i < n; i++) q[i] = all[i * MOST + k];
    const double *const x[BLOCKS] = {[COORDINATES] = q};
    ck_assert_int_eq(dvi__function_gradient(function, 1, x, (double *const[BLOCKS]){NULL, V_q}), 0);
    for (int i = 0; i < n; i++) one[i * MOST + k] = V_q[i];
  }
  for (int count = 2; count <= MOST; count = count < 20 ? count + 1 : count + 93) {
    for (int i = 0; i < n; i++) memcpy(q + i * count, all + i * MOST, (size_t)count * sizeof *q);
    const double *const x[BLOCKS] = {[COORDINATES] = q};
    ck_assert_int_eq(dvi__function_gradient(function, count, x, (double *const[BLOCKS]){NULL, V_q}),
                     0);
    ck_assert_int_eq(dvi__function_value(function, count, x, value), 0);
    for (int i = 0; i < n; i++)
      ck_assert_mem_eq(V_q + i * count, one + i * MOST, (size_t)count * sizeof *q);
    if (count == 2) V = value[0];
    ck_assert_double_eq(value[0], V);
  }
  free(q);
  free(V_q);
  free(one);
}

START_TEST(bits_do_not_depend_on_the_number_of_points)
{
  draft own;
  dvi__function *function = many(&own);
  double *all = many_points(MOST), start[6] = {1.0, 0.1, -0.2, 0.02, 0.03, 0.0};
  check_bits(function, 270, all);
  free(all);
  drop(&own, function);
  function = fpu(&own, 3);
  all = points(start, 6, MOST);
  check_bits(function, 6, all);
  free(all);
  drop(&own, function);
}
END_TEST

typedef struct worker {
  dvi__function *function;
  const double *q;
  double *V_q;
  int failed;
} worker;

static void *work(void *user)
{
  worker *own = user;
  const double *const x[BLOCKS] = {[COORDINATES] = own->q};
  for (int turn = 0; turn < 20; turn++)
    own->failed |= dvi__function_gradient(own->function, 3, x,
                                          (double *const[BLOCKS]){NULL, own->V_q});
  return NULL;
}

START_TEST(threads_may_ask_first_at_one_time)
{
  enum { THREADS = 4, N = 270 };
  draft own;
  dvi__function *function = many(&own);
  double *q = many_points(3);
  pthread_t thread[THREADS];
  worker workers[THREADS];
  for (int i = 0; i < THREADS; i++) {
    workers[i] = (worker){function, q, room(3 * N), 0};
    ck_assert_int_eq(pthread_create(&thread[i], NULL, work, &workers[i]), 0);
  }
  for (int i = 0; i < THREADS; i++) ck_assert_int_eq(pthread_join(thread[i], NULL), 0);
  for (int i = 0; i < THREADS; i++) {
    ck_assert_int_eq(workers[i].failed, 0);
    ck_assert_mem_eq(workers[i].V_q, workers[0].V_q, 3 * N * sizeof(double));
  }
  for (int i = 0; i < THREADS; i++) free(workers[i].V_q);
  free(q);
  dvi__function_counters counters;
  dvi__function_count(function, &counters);
  ck_assert_int_eq(counters.gradient_points, THREADS * 20 * 3);
  drop(&own, function);
}
END_TEST

static const char by_coordinates[BLOCKS] = {[COORDINATES] = 1}, qq_alone[PAIRS] = {[PAIR_QQ] = 1};

START_TEST(evaluations_allocate_nothing)
{
  draft own;
  dvi__function *function = solar(&own);
  double q[18 * 5], V[5], V_q[18 * 5], V_qq[18 * 18 * 5];
  for (int i = 0; i < 90; i++) q[i] = sin(1.0 + 2.0 * i);
  const double *const x[BLOCKS] = {[COORDINATES] = q};
  ck_assert_int_eq(dvi__function_prepare(function, 1, by_coordinates, qq_alone), DVI_OK);
  const long calls = heap_calls();
  const int failed = dvi__function_value(function, 5, x, V) |
                     dvi__function_gradient(function, 5, x, (double *const[BLOCKS]){NULL, V_q}) |
                     dvi__function_second(function, 5, x, (double *const[PAIRS]){V_qq});
  const long taken = heap_calls() - calls;
  ck_assert_int_eq(failed, 0);
  ck_assert_int_eq(taken, 0);
  drop(&own, function);
}
END_TEST

START_TEST(counters_count_points_and_what_was_derived)
{
  draft own;
  dvi__function *function = solar(&own);
  dvi__function_counters counters;
  double q[18 * 4], V[4];
  for (int i = 0; i < 72; i++) q[i] = sin(1.0 + 2.0 * i);
  const double *const x[BLOCKS] = {[COORDINATES] = q};
  dvi__function_count(function, &counters);
  ck_assert_int_eq(counters.value_operations, -1);
  ck_assert_int_eq(dvi__function_value(function, 4, x, V), 0);
  dvi__function_count(function, &counters);
  ck_assert_int_eq(counters.value_points, 4);
  ck_assert_int_eq(counters.value_operations,
                   15 * 11); /* three differences and squares, two sums, a power, two factors */
  ck_assert_int_eq(counters.gradient_operations, -1);
  ck_assert_int_eq(counters.second_operations, -1);
  ck_assert_int_eq(dvi__function_prepare(function, 0, by_coordinates, qq_alone), DVI_OK);
  dvi__function_count(function, &counters);
  ck_assert_int_gt(counters.gradient_operations, counters.value_operations);
  ck_assert_int_gt(counters.second_operations, counters.gradient_operations);
  ck_assert_int_eq(counters.second_entries, 18 * 18);
  ck_assert_int_eq(counters.gradient_points + counters.second_points, 0);
  drop(&own, function);
}
END_TEST

/* x^2 t + 3 x v tests rates of momenta, and which second derivatives are constants. */
START_TEST(time_is_a_block_and_constants_are_known)
{
  draft own;
  reset(&own, 1);
  affine(&own, 0, TIME, 0, 0);
  affine(&own, 1, COORDINATES, 0, 0);
  affine(&own, 2, VELOCITIES, 0, 0);
  const dvi__node t = variable(&own, 0), q = variable(&own, 1), v = variable(&own, 2);
  const dvi__node first = apply(&own, DVI__OP_MULTIPLY, apply(&own, DVI__OP_SQUARE, q, q), t);
  finish(&own,
         apply(&own, DVI__OP_ADD, first, times(&own, 3.0, apply(&own, DVI__OP_MULTIPLY, q, v))), 1,
         3);
  dvi__function *function = made(&own);
  const double at[3] = {2.0, 5.0, 7.0}, *const x[BLOCKS] = {&at[0], &at[1], &at[2]};
  double rate, by_q, by_v, qq, qv, vv, tq, tv;
  ck_assert_int_eq(
      dvi__function_gradient(function, 1, x, (double *const[BLOCKS]){&rate, &by_q, &by_v}), 0);
  ck_assert_double_eq(rate, 25.0);
  ck_assert_double_eq(by_q, 20.0 + 21.0);
  ck_assert_double_eq(by_v, 15.0);
  double *const second[PAIRS] = {[PAIR_QQ] = &qq, [PAIR_QV] = &qv, [PAIR_TQ] = &tq};
  ck_assert_int_eq(dvi__function_second(function, 1, x, second), 0);
  ck_assert_double_eq(qq, 4.0);
  ck_assert_double_eq(qv, 3.0);
  ck_assert_double_eq(tq, 10.0);
  ck_assert_int_eq(dvi__function_second(function, 1, x,
                                        (double *const[PAIRS]){[PAIR_VV] = &vv, [PAIR_TV] = &tv}),
                   0);
  ck_assert_int_eq(dvi__function_second_constant(function, PAIR_QQ), 0);
  ck_assert_int_eq(dvi__function_second_constant(function, PAIR_QV), 1);
  ck_assert_int_eq(dvi__function_second_constant(function, PAIR_VV), 1);
  drop(&own, function);
}
END_TEST

/* x_i x_j summed over all i and j, i = j among them, is (sum x)^2, of which all second derivatives
 * are 2. */
START_TEST(an_element_may_read_a_variable_twice)
{
  enum { N = 9 };
  draft own;
  double x[N], qq[N * N], by_q[N];
  reset(&own, N);
  for (int i = 0; i < 2; i++) {
    own.list[i] = malloc(N * N * sizeof **own.list);
    for (int e = 0; e < N * N; e++) own.list[i][e] = i == 0 ? e / N : e % N;
    own.input[0][i] = (dvi__kernel_input){.block = COORDINATES, .number = own.list[i]};
  }
  finish(&own, apply(&own, DVI__OP_MULTIPLY, variable(&own, 0), variable(&own, 1)), N * N, 2);
  dvi__function *function = made(&own);
  for (int i = 0; i < N; i++) x[i] = 1.0 + i;
  const double *const at[BLOCKS] = {[COORDINATES] = x};
  ck_assert_int_eq(dvi__function_gradient(function, 1, at, (double *const[BLOCKS]){NULL, by_q}), 0);
  ck_assert_int_eq(dvi__function_second(function, 1, at, (double *const[PAIRS]){qq}), 0);
  for (int i = 0; i < N; i++) ck_assert_double_eq(by_q[i], 90.0);
  for (int i = 0; i < N * N; i++) ck_assert_double_eq(qq[i], 2.0);
  drop(&own, function);
}
END_TEST

START_TEST(a_function_without_kernels_is_zero)
{
  draft own;
  reset(&own, 3);
  dvi__function *function = made(&own);
  double q[3] = {1.0, 2.0, 3.0}, V = 5.0, V_q[3] = {5.0, 5.0, 5.0};
  const double *const x[BLOCKS] = {[COORDINATES] = q};
  dvi_pattern pattern;
  int full;
  ck_assert_int_eq(dvi__function_value(function, 1, x, &V), 0);
  ck_assert_int_eq(dvi__function_gradient(function, 1, x, (double *const[BLOCKS]){NULL, V_q}), 0);
  ck_assert_int_eq(dvi__function_pattern(function, PAIR_QQ, &pattern, &full), DVI_OK);
  ck_assert_double_eq(V + V_q[0] + V_q[1] + V_q[2], 0.0);
  ck_assert_int_eq(full, 0);
  ck_assert_int_eq(pattern.start[3], 0);
  drop(&own, function);
}
END_TEST

/* A chain of a million links has 3e6 entries, which are found at once. */
START_TEST(the_pattern_of_a_long_chain_is_found)
{
  enum { N = 1000000 };
  draft own;
  dvi__function *function = toda(&own, N);
  dvi_pattern pattern;
  int full;
  ck_assert_int_eq(dvi__function_pattern(function, PAIR_QQ, &pattern, &full), DVI_OK);
  ck_assert_int_eq(full, 0);
  ck_assert_int_eq(pattern.start[N], 3 * N);
  ck_assert_mem_eq(pattern.row + pattern.start[1], ((int[]){0, 1, 2}), 3 * sizeof(int));
  ck_assert_mem_eq(pattern.row, ((int[]){0, 1, N - 1}), 3 * sizeof(int));
  drop(&own, function);
}
END_TEST

/* log(x - 1) at x = 0.8 in the source "log(x - 1)". */
START_TEST(what_is_not_finite_is_located)
{
  static const dvi__source source = {.name = "scene", .text = "log(x - 1)", .size = 10};
  draft own;
  char text[100];
  dvi__fault fault;
  double V, V_q;
  reset(&own, 1);
  affine(&own, 0, COORDINATES, 0, 0);
  graph_of(&own)->here = (dvi__span){4, 5};
  const dvi__node difference = apply(&own, DVI__OP_SUBTRACT, variable(&own, 0), number(&own, 1.0));
  graph_of(&own)->here = (dvi__span){0, 10};
  finish(&own, apply(&own, DVI__OP_LOG, difference, difference), 1, 1);
  dvi__function *function = made(&own);
  const double q[2] = {2.0, 0.8}, *const x[BLOCKS] = {[COORDINATES] = q};
  const double *const bad[BLOCKS] = {[COORDINATES] = q + 1},
                      one = 1.0, *const pole[BLOCKS] = {[COORDINATES] = &one};
  ck_assert_int_eq(dvi__function_value(function, 1, x, &V), 0);
  ck_assert_int_eq(dvi__function_value(function, 1, bad, &V), 1);
  ck_assert_int_eq(dvi__function_gradient(function, 1, pole, (double *const[BLOCKS]){NULL, &V_q}),
                   1);
  dvi__function_fault(function, &source, 2, x, 1, 0, text, sizeof text, &fault);
  ck_assert_str_eq(text, "log(x - 1), x - 1 = -0.2 is not finite");
  ck_assert_uint_eq(fault.span.size, 10);
  ck_assert(fault.count == 1 && fault.variable[0].block == COORDINATES &&
            fault.variable[0].number == 0);
  dvi__function_fault(function, &source, 2, x, 0, 1, text, sizeof text, &fault);
  ck_assert_str_eq(text, "");
  drop(&own, function);
}
END_TEST

SUITE(function)
{
  tcase_add_test(tests, planets_pull_as_in_the_catalogue);
  tcase_add_test(tests, todas_lattice_is_that_of_the_catalogue);
  tcase_add_test(tests, soft_springs_are_those_of_the_catalogue);
  tcase_add_test(tests, short_kernels_are_written_out);
  tcase_add_test(tests, the_double_pendulum_is_that_of_the_catalogue);
  tcase_add_test(tests, bits_do_not_depend_on_the_number_of_points);
  tcase_add_test(tests, threads_may_ask_first_at_one_time);
  tcase_add_test(tests, evaluations_allocate_nothing);
  tcase_add_test(tests, counters_count_points_and_what_was_derived);
  tcase_add_test(tests, time_is_a_block_and_constants_are_known);
  tcase_add_test(tests, an_element_may_read_a_variable_twice);
  tcase_add_test(tests, a_function_without_kernels_is_zero);
  tcase_add_test(tests, the_pattern_of_a_long_chain_is_found);
  tcase_add_test(tests, what_is_not_finite_is_located);
}
