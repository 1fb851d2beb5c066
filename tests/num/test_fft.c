/* labels: unit */
/* Discrete Fourier transforms against direct sums in quadruple precision. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "num/fft/complex.h"
#include "num/fft/fft.h"
#include "support/heap.h"
#include "support/quad/quad_real.h"
#include "support/suite.h"

enum { MOST = 4200, LONGEST = 6561 };

typedef struct transform {
  dvi__fft *plan;
  int n;
  double *work;
} transform;

static transform made_transform(int n)
{
  transform t = {NULL, n, NULL};
  ck_assert_int_eq(dvi__fft_create(n, &t.plan), DVI_OK);
  t.work = malloc((size_t)dvi__fft_work(t.plan) * sizeof(double));
  return t;
}

static void free_transform(transform *t)
{
  dvi__fft_destroy(&t->plan);
  ck_assert_ptr_null(t->plan);
  free(t->work);
}

/* Numbers of both signs without order. */
static void fill(int count, double *x)
{
  for (int i = 0; i < count; i++) x[i] = sin(1.0 + i) + cos(0.37 * i * i);
}

/* Give the roots of unity of order n [2 n]. */
static void fill_roots(int n, quad *root)
{
  const quad turn = 2 * quad_acos(-1);
  for (int k = 0; k < n; k++) {
    root[2 * k] = quad_cos(turn * k / n);
    root[2 * k + 1] = quad_sin(turn * k / n);
  }
}

/* A transform makes about log2 n roundings of numbers of the size of the root mean square sum, a
 * chirp three times as many. The largest error of all sums is a few times that. */
static double bound(int n, double size)
{
  return 4e-16 * (1 + log2(n)) * size;
}

static double norm(int count, const double *x)
{
  double sum = 0;
  for (int i = 0; i < count; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

static void check_sums(int n, int sign, const double *z, const quad *root, int every,
                       const double *sums)
{
  const double size = norm(2 * n, z);
  for (int k = 0; k < n; k += every) {
    quad re = 0, im = 0;
    for (int j = 0; j < n; j++) {
      const quad *w = root + 2 * ((long)j * k % n);
      re += w[0] * z[2 * j] - sign * w[1] * z[2 * j + 1];
      im += w[0] * z[2 * j + 1] + sign * w[1] * z[2 * j];
    }
    ck_assert_double_le(fabs((double)(sums[2 * k] - re)), bound(n, size));
    ck_assert_double_le(fabs((double)(sums[2 * k + 1] - im)), bound(n, size));
  }
}

static void check_complex(int n, int sign, const quad *root, int every)
{
  static double z[2 * LONGEST], sums[2 * LONGEST];
  dvi__fourier *complex;
  ck_assert_int_eq(dvi__fourier_create((size_t)n, &complex), DVI_OK);
  double *work = malloc(dvi__fourier_work(complex) * sizeof(double));
  fill(2 * n, z);
  memcpy(sums, z, sizeof z);
  check_sums(n, sign, z, root, every, dvi__fourier_transform(complex, sign, sums, work));
  free(work);
  dvi__fourier_destroy(&complex);
}

static void check_analysis(const transform *t, const quad *root, int every)
{
  const int n = t->n;
  static double x[LONGEST], sums[LONGEST];
  fill(n, x);
  memcpy(sums, x, sizeof x);
  dvi__fft_analyse(t->plan, sums, t->work);
  for (int k = 0; k <= n / 2; k += every) {
    quad c = 0, s = 0;
    for (int j = 0; j < n; j++) {
      c += root[2 * ((long)j * k % n)] * x[j];
      s += root[2 * ((long)j * k % n) + 1] * x[j];
    }
    ck_assert_double_le(fabs((double)(sums[k == 0 ? 0 : 2 * k - 1] - c)), bound(n, norm(n, x)));
    if (k > 0 && 2 * k < n)
      ck_assert_double_le(fabs((double)(sums[2 * k] - s)), bound(n, norm(n, x)));
  }
}

static void check_synthesis(const transform *t, const quad *root, int every)
{
  const int n = t->n;
  static double a[LONGEST], x[LONGEST];
  fill(n, a);
  memcpy(x, a, sizeof x);
  dvi__fft_synthesise(t->plan, x, t->work);
  for (int j = 0; j < n; j += every) {
    quad sum = a[0];
    for (int k = 1; k <= n / 2; k++) {
      const quad *w = root + 2 * ((long)j * k % n);
      sum += w[0] * a[2 * k - 1] + (2 * k < n ? w[1] * a[2 * k] : 0);
    }
    ck_assert_double_le(fabs((double)(x[j] - sum)), bound(n, norm(n, a)));
  }
}

static void check_length(int n, int every)
{
  static quad root[2 * LONGEST];
  transform t = made_transform(n);
  fill_roots(n, root);
  check_complex(n, 1, root, every);
  check_complex(n, -1, root, every);
  check_analysis(&t, root, every);
  check_synthesis(&t, root, every);
  free_transform(&t);
}

START_TEST(transforms_of_all_short_lengths_are_the_direct_sums)
{
  for (int n = 1; n <= 70; n++) check_length(n, 1);
}
END_TEST

START_TEST(transforms_of_long_lengths_are_the_direct_sums)
{
  static const int lengths[] = {4096, 4097, 2187, 3125, 2310, 6561};
  for (int i = 0; i < 6; i++) check_length(lengths[i], 97);
}
END_TEST

static double product(int n, const double *x, const double *y)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* a . (analyse x) = (synthesise a) . x holds to rounding in the size of |a| |x| sqrt(n). */
START_TEST(synthesis_is_the_transpose_of_analysis)
{
  static const int lengths[] = {1, 2, 3, 4, 6, 7, 15, 22, 64, 73, 240, 1001, 4096, 4097};
  for (int i = 0; i < 14; i++) {
    static double x[MOST], a[MOST], sums[MOST], values[MOST];
    const int n = lengths[i];
    transform t = made_transform(n);
    fill(n, x);
    for (int k = 0; k < n; k++) values[k] = a[k] = cos(3.0 + k);
    memcpy(sums, x, sizeof x);
    dvi__fft_analyse(t.plan, sums, t.work);
    dvi__fft_synthesise(t.plan, values, t.work);
    ck_assert_double_eq_tol(product(n, a, sums), product(n, values, x),
                            bound(n, norm(n, a) * norm(n, x) * sqrt(n)));
    free_transform(&t);
  }
}
END_TEST

/* ---- threads and memory ---- */

enum { SHARED = 1386, ROUNDS = 50 };

typedef struct worker {
  const dvi__fft *plan;
  double x[SHARED];
} worker;

static void *repeat(void *argument)
{
  worker *w = argument;
  double *work = malloc((size_t)dvi__fft_work(w->plan) * sizeof(double));
  for (int round = 0; round < ROUNDS; round++) {
    fill(SHARED, w->x);
    dvi__fft_analyse(w->plan, w->x, work);
    dvi__fft_synthesise(w->plan, w->x, work);
  }
  free(work);
  return NULL;
}

START_TEST(threads_that_share_a_plan_find_the_same_bits)
{
  static worker workers[4];
  pthread_t thread[4];
  transform t = made_transform(SHARED);
  for (int i = 0; i < 4; i++) {
    workers[i].plan = t.plan;
    ck_assert_int_eq(pthread_create(&thread[i], NULL, repeat, &workers[i]), 0);
  }
  for (int i = 0; i < 4; i++) pthread_join(thread[i], NULL);
  for (int i = 1; i < 4; i++) ck_assert_mem_eq(workers[i].x, workers[0].x, sizeof workers[0].x);
  free_transform(&t);
}
END_TEST

START_TEST(transforms_take_no_memory)
{
  static const int lengths[] = {1000, 1001, 1022};
  static double z[2 * MOST];
  for (int i = 0; i < 3; i++) {
    transform t = made_transform(lengths[i]);
    const long before = heap_calls(), counted = dvi__allocation_count();
    dvi__fft_analyse(t.plan, z, t.work);
    dvi__fft_synthesise(t.plan, z, t.work);
    ck_assert_int_eq(heap_calls() - before, 0);
    ck_assert_int_eq(dvi__allocation_count() - counted, 0);
    free_transform(&t);
  }
}
END_TEST

START_TEST(a_plan_that_finds_no_memory_leaves_none)
{
  static const int lengths[] = {60, 75, 46, 31};
  for (int i = 0; i < 4; i++) {
    dvi_status status = DVI_NO_MEMORY;
    for (long successes = 0; status == DVI_NO_MEMORY; successes++) {
      dvi__fft *plan;
      dvi__fail_allocations_after(successes);
      status = dvi__fft_create(lengths[i], &plan);
      dvi__fail_allocations_after(-1);
      ck_assert(status == DVI_OK || plan == NULL);
      dvi__fft_destroy(&plan);
    }
    ck_assert_int_eq(status, DVI_OK);
  }
}
END_TEST

/* ---- lengths ---- */

START_TEST(lengths_have_small_factors_only)
{
  static const int asked[] = {1, 2, 7, 11, 13, 4097, 65537, 1 << 30},
                   found[] = {1, 2, 8, 12, 15, 4320, 65610, 1 << 30};
  for (int i = 0; i < 8; i++) ck_assert_int_eq(dvi__fft_length(asked[i]), found[i]);
}
END_TEST

START_TEST(a_plan_of_no_points_is_refused)
{
  dvi__fft *plan;
  ck_assert_int_eq(dvi__fft_create(0, &plan), DVI_BAD_SIZE);
  check_words("0 points asked, 1 to 67108864 possible");
  ck_assert_ptr_null(plan);
  ck_assert_int_eq(dvi__fft_create(DVI__FFT_MAX + 1, &plan), DVI_BAD_SIZE);
}
END_TEST

SUITE(fft)
{
  tcase_add_test(tests, transforms_of_all_short_lengths_are_the_direct_sums);
  tcase_add_test(tests, transforms_of_long_lengths_are_the_direct_sums);
  tcase_add_test(tests, synthesis_is_the_transpose_of_analysis);
  tcase_add_test(tests, threads_that_share_a_plan_find_the_same_bits);
  tcase_add_test(tests, transforms_take_no_memory);
  tcase_add_test(tests, a_plan_that_finds_no_memory_leaves_none);
  tcase_add_test(tests, lengths_have_small_factors_only);
  tcase_add_test(tests, a_plan_of_no_points_is_refused);
}
