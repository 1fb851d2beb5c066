#include "bodies/pulls.h"

#include <math.h>

/* Compute the vector r of a pull at point k. */
PROBLEM_INLINE void pull_vector(const pull *of, const int count, int k, const double *q, double *r)
{
  double sum[3] = {0.0};
  for (int a = 0; a < of->arms; a++) {
    const arm *one = &of->arm[a];
    const ptrdiff_t first = (ptrdiff_t)one->first * count + k,
                    stride = (ptrdiff_t)one->stride * count;
    for (int i = 0; i < 3; i++) sum[i] += one->factor * q[first + i * stride];
  }
  memcpy(r, sum, sizeof sum);
}

static int pulls_value(int count, const double *t, const double *q, double *V, void *user)
{
  const pulls *all = user;
  (void)t;
  for (int k = 0; k < count; k++) {
    double r[3];
    V[k] = 0.0;
    for (int j = 0; j < all->count; j++) {
      pull_vector(&all->pull[j], count, k, q, r);
      V[k] -= all->pull[j].strength / sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    }
  }
  return 0;
}

PROBLEM_INLINE void pull_add_gradient(const pull *of, const int count, int k, const double *q,
                                      double *V_q)
{
  double r[3];
  pull_vector(of, count, k, q, r);
  const double r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], force = of->strength / (r2 * sqrt(r2));
  for (int a = 0; a < of->arms; a++) {
    const arm *one = &of->arm[a];
    const ptrdiff_t first = (ptrdiff_t)one->first * count + k,
                    stride = (ptrdiff_t)one->stride * count;
    const double along = one->factor * force;
    for (int i = 0; i < 3; i++) V_q[first + i * stride] += along * r[i];
  }
}

PROBLEM_INLINE void pulls_gradient_at(const pulls *all, const int count, const double *q,
                                      double *V_q)
{
  memset(V_q, 0, (size_t)all->nq * (size_t)count * sizeof *V_q);
  for (int k = 0; k < count; k++)
    for (int j = 0; j < all->count; j++) pull_add_gradient(&all->pull[j], count, k, q, V_q);
}

/* One point needs no products of places. */
static int pulls_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  (void)t;
  if (count == 1)
    pulls_gradient_at(user, 1, q, V_q);
  else
    pulls_gradient_at(user, count, q, V_q);
  return 0;
}

/* Add the Hessian. That of -1/|r| in r is I/|r|^3 - 3 r r^t/|r|^5. */
static void pull_add_hessian(const pull *of, int nq, int count, int k, const double *q,
                             double *V_qq)
{
  double r[3];
  pull_vector(of, count, k, q, r);
  const double r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], force = of->strength / (r2 * sqrt(r2));
  for (int a = 0; a < 3 * of->arms; a++)
    for (int b = 0; b < 3 * of->arms; b++) {
      const arm *row = &of->arm[a / 3], *column = &of->arm[b / 3];
      const int i = a % 3, j = b % 3, in_row = row->first + i * row->stride,
                in_column = column->first + j * column->stride;
      V_qq[((ptrdiff_t)in_column * nq + in_row) * count + k] +=
          row->factor * column->factor * force * ((i == j ? 1.0 : 0.0) - 3.0 * r[i] * r[j] / r2);
    }
}

static int pulls_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const pulls *all = user;
  (void)t;
  memset(V_qq, 0, (size_t)all->nq * (size_t)all->nq * (size_t)count * sizeof *V_qq);
  for (int k = 0; k < count; k++)
    for (int j = 0; j < all->count; j++)
      pull_add_hessian(&all->pull[j], all->nq, count, k, q, V_qq);
  return 0;
}

dvi_potential pulls_potential(const char *name, const pulls *all)
{
  return (dvi_potential){.name = name,
                         .value_batch = pulls_value,
                         .gradient_batch = pulls_gradient,
                         .hessian_batch = pulls_hessian,
                         .user = (void *)all};
}
