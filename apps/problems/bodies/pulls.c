#include "bodies/pulls.h"

#include <math.h>

enum { POINTS = 8 }; /* points of a batch that are evaluated side by side */

/* Some points of a batch of `count`, from q on. */
typedef struct batch {
  int count, some;
  const double *q;
} batch;

static batch pulls_batch(int count, int first, const double *q)
{
  return (batch){count, count - first < POINTS ? count - first : POINTS, q + first};
}

static ptrdiff_t arm_row(const arm *of, int i, int count)
{
  return (ptrdiff_t)(of->first + i * of->stride) * count;
}

/* Compute the vectors r of a pull, and |r|^2. */
static void pull_vectors(const pull *of, const batch *at, double r[3][POINTS], double *r2)
{
  memset(r2, 0, POINTS * sizeof *r2);
  for (int i = 0; i < 3; i++) {
    memset(r[i], 0, sizeof r[i]);
    for (int a = 0; a < of->arms; a++) {
      const double factor = of->arm[a].factor, *q = at->q + arm_row(&of->arm[a], i, at->count);
      for (int k = 0; k < at->some; k++) r[i][k] += factor * q[k];
    }
    for (int k = 0; k < at->some; k++) r2[k] += r[i][k] * r[i][k];
  }
}

static int pulls_value(int count, const double *t, const double *q, double *V, void *user)
{
  const pulls *all = user;
  double r[3][POINTS], r2[POINTS];
  (void)t;
  memset(V, 0, (size_t)count * sizeof *V);
  for (int first = 0; first < count; first += POINTS) {
    const batch at = pulls_batch(count, first, q);
    for (int j = 0; j < all->count; j++) {
      pull_vectors(&all->pull[j], &at, r, r2);
      for (int k = 0; k < at.some; k++) V[first + k] -= all->pull[j].strength / sqrt(r2[k]);
    }
  }
  return 0;
}

static void pull_add_gradient(const pull *of, const batch *at, double *V_q)
{
  double r[3][POINTS], r2[POINTS], force[POINTS];
  pull_vectors(of, at, r, r2);
  for (int k = 0; k < at->some; k++) force[k] = of->strength / (r2[k] * sqrt(r2[k]));
  for (int a = 0; a < of->arms; a++)
    for (int i = 0; i < 3; i++) {
      const double factor = of->arm[a].factor;
      double *to = V_q + arm_row(&of->arm[a], i, at->count);
      for (int k = 0; k < at->some; k++) to[k] += factor * force[k] * r[i][k];
    }
}

static int pulls_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const pulls *all = user;
  (void)t;
  memset(V_q, 0, (size_t)all->nq * (size_t)count * sizeof *V_q);
  for (int first = 0; first < count; first += POINTS) {
    const batch at = pulls_batch(count, first, q);
    for (int j = 0; j < all->count; j++) pull_add_gradient(&all->pull[j], &at, V_q + first);
  }
  return 0;
}

/* Compute the Hessian of -1/|r| in r, I/|r|^3 - 3 r r^t/|r|^5. */
static void pull_matrices(const pull *of, const batch *at, double H[3][3][POINTS])
{
  double r[3][POINTS], r2[POINTS], force[POINTS];
  pull_vectors(of, at, r, r2);
  for (int k = 0; k < at->some; k++) force[k] = of->strength / (r2[k] * sqrt(r2[k]));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < at->some; k++)
        H[i][j][k] = force[k] * ((i == j ? 1.0 : 0.0) - 3.0 * r[i][k] * r[j][k] / r2[k]);
}

static void pull_add_hessian(const pull *of, int nq, const batch *at, double *V_qq)
{
  double H[3][3][POINTS];
  pull_matrices(of, at, H);
  for (int b = 0; b < 3 * of->arms; b++)
    for (int a = 0; a < 3 * of->arms; a++) {
      const arm *row = &of->arm[a / 3], *column = &of->arm[b / 3];
      const double factor = row->factor * column->factor, *from = H[a % 3][b % 3];
      double *to = V_qq + arm_row(column, b % 3, at->count) * nq + arm_row(row, a % 3, at->count);
      for (int k = 0; k < at->some; k++) to[k] += factor * from[k];
    }
}

static int pulls_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const pulls *all = user;
  (void)t;
  memset(V_qq, 0, (size_t)all->nq * (size_t)all->nq * (size_t)count * sizeof *V_qq);
  for (int first = 0; first < count; first += POINTS) {
    const batch at = pulls_batch(count, first, q);
    for (int j = 0; j < all->count; j++)
      pull_add_hessian(&all->pull[j], all->nq, &at, V_qq + first);
  }
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
