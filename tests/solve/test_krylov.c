/* Newton's method without a matrix. */
#include <math.h>

#include "solve/krylov.h"
#include "support/suite.h"

enum { N = 60 };

typedef struct cubic {
  double strength, x[N];
} cubic;

/* f_i = x_i - x_(i+1)/3 + strength x_i^3 - i/N, around a circle. */
static void residual(void *of, const double *x, double *f)
{
  const cubic *c = of;
  for (int i = 0; i < N; i++)
    f[i] = x[i] - x[(i + 1) % N] / 3 + c->strength * pow(x[i], 3) - (double)i / N;
}

static void stand_at(void *of, const double *x)
{
  cubic *c = of;
  for (int i = 0; i < N; i++) c->x[i] = x[i];
}

static void times(void *of, const double *v, double *y)
{
  const cubic *c = of;
  for (int i = 0; i < N; i++)
    y[i] = (1 + 3 * c->strength * c->x[i] * c->x[i]) * v[i] - v[(i + 1) % N] / 3;
}

/* Newton's full steps from 0 would go as far as the right side, where the cubes are large. */
START_TEST(solutions_are_exact_to_roundoff)
{
  cubic c = {.strength = 1e4};
  double x[N] = {0}, f[N], left = 1;
  dvi__krylov *krylov;
  ck_assert(dvi__krylov_create(&(dvi__smooth_equations){N, &c, residual, stand_at, times},
                               &krylov) == DVI_OK);
  ck_assert(dvi__krylov_solve(krylov, 1, x, &left) == DVI_OK);
  residual(&c, x, f);
  for (int i = 0; i < N; i++) ck_assert_double_lt(fabs(f[i]), 1e-14);
  ck_assert_double_lt(left, 1e-14);
  dvi__krylov_destroy(&krylov);
  ck_assert(krylov == NULL);
}
END_TEST

static void no_zero(void *of, const double *x, double *f)
{
  (void)of;
  for (int i = 0; i < N; i++) f[i] = 1 + x[i] * x[i];
}

static void times_no_zero(void *of, const double *v, double *y)
{
  const cubic *c = of;
  for (int i = 0; i < N; i++) y[i] = 2 * c->x[i] * v[i];
}

START_TEST(equations_without_a_solution_leave_a_residual)
{
  cubic c = {0};
  double x[N], left = 0;
  dvi__krylov *krylov;
  for (int i = 0; i < N; i++) x[i] = 3;
  ck_assert(dvi__krylov_create(&(dvi__smooth_equations){N, &c, no_zero, stand_at, times_no_zero},
                               &krylov) == DVI_OK);
  ck_assert(dvi__krylov_solve(krylov, 3, x, &left) == DVI_NOT_CONVERGED);
  ck_assert(left >= 1.0 / 3);
  dvi__krylov_destroy(&krylov);
}
END_TEST

SUITE(krylov)
{
  tcase_add_test(tests, solutions_are_exact_to_roundoff);
  tcase_add_test(tests, equations_without_a_solution_leave_a_residual);
}
