#include "bodies/pulls.h"

#include <math.h>

#include "entry.h"

enum { POINTS = 8 }; /* points of a batch that are evaluated side by side */

static ptrdiff_t arm_row(const arm *of, int i, int count)
{
  return (ptrdiff_t)(of->first + i * of->stride) * count;
}

/* The functions of one point alone are compiled apart, because codes that ask for one should not
 * pay for loops. */

/* Compute the vectors r of a pull at `some` points from q on, and |r|^2. */
PROBLEM_INLINE void pull_vectors(const pull *of, int count, int some, const double *q,
                                 double r[3][POINTS], double *r2)
{
  for (int k = 0; k < some; k++) r[0][k] = r[1][k] = r[2][k] = 0;
  for (int a = 0; a < of->arms; a++)
    for (int i = 0; i < 3; i++) {
      const double *from = q + arm_row(&of->arm[a], i, count);
      for (int k = 0; k < some; k++) r[i][k] += of->arm[a].factor * from[k];
    }
  for (int k = 0; k < some; k++) r2[k] = r[0][k] * r[0][k] + r[1][k] * r[1][k] + r[2][k] * r[2][k];
}

/* Compute strength/|r|^3 as well. */
PROBLEM_INLINE void pull_forces(const pull *of, int count, int some, const double *q,
                                double r[3][POINTS], double *r2, double *force)
{
  pull_vectors(of, count, some, q, r, r2);
  for (int k = 0; k < some; k++) force[k] = of->strength / (r2[k] * sqrt(r2[k]));
}

static int pulls_value(int count, const double *t, const double *q, double *V, void *user)
{
  const pulls *all = user;
  double r[3][POINTS], r2[POINTS];
  (void)t;
  memset(V, 0, (size_t)count * sizeof *V);
  for (int first = 0; first < count; first += POINTS) {
    const int some = count - first < POINTS ? count - first : POINTS;
    for (int j = 0; j < all->count; j++) {
      pull_vectors(&all->pull[j], count, some, q + first, r, r2);
      for (int k = 0; k < some; k++) V[first + k] -= all->pull[j].strength / sqrt(r2[k]);
    }
  }
  return 0;
}

PROBLEM_INLINE void add_gradients(const pulls *all, int count, int some, const double *q,
                                  double *V_q)
{
  for (int j = 0; j < all->count; j++) {
    const pull *of = &all->pull[j];
    double r[3][POINTS], r2[POINTS], force[POINTS];
    pull_forces(of, count, some, q, r, r2, force);
    for (int a = 0; a < of->arms; a++)
      for (int i = 0; i < 3; i++) {
        double *to = V_q + arm_row(&of->arm[a], i, count);
        for (int k = 0; k < some; k++) to[k] += of->arm[a].factor * force[k] * r[i][k];
      }
  }
}

static int pulls_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const pulls *all = user;
  (void)t;
  memset(V_q, 0, (size_t)all->nq * (size_t)count * sizeof *V_q);
  if (count == 1) {
    add_gradients(all, 1, 1, q, V_q);
    return 0;
  }
  for (int first = 0; first < count; first += POINTS)
    add_gradients(all, count, count - first < POINTS ? count - first : POINTS, q + first,
                  V_q + first);
  return 0;
}

/* Compute the Hessian of -1/|r| in r, I/|r|^3 - 3 r r^t/|r|^5. */
static void pull_matrices(const pull *of, int count, int some, const double *q,
                          double H[3][3][POINTS])
{
  double r[3][POINTS], r2[POINTS], force[POINTS];
  pull_forces(of, count, some, q, r, r2, force);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < some; k++)
        H[i][j][k] = force[k] * ((i == j ? 1.0 : 0.0) - 3.0 * r[i][k] * r[j][k] / r2[k]);
}

static void pull_add_hessian(const pull *of, int nq, int count, int some, const double *q,
                             double *V_qq)
{
  double H[3][3][POINTS];
  pull_matrices(of, count, some, q, H);
  for (int b = 0; b < 3 * of->arms; b++)
    for (int a = 0; a < 3 * of->arms; a++) {
      const arm *row = &of->arm[a / 3], *column = &of->arm[b / 3];
      const double factor = row->factor * column->factor, *from = H[a % 3][b % 3];
      double *to = V_qq + arm_row(column, b % 3, count) * nq + arm_row(row, a % 3, count);
      for (int k = 0; k < some; k++) to[k] += factor * from[k];
    }
}

static int pulls_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const pulls *all = user;
  (void)t;
  memset(V_qq, 0, (size_t)all->nq * (size_t)all->nq * (size_t)count * sizeof *V_qq);
  for (int first = 0; first < count; first += POINTS)
    for (int j = 0; j < all->count; j++)
      pull_add_hessian(&all->pull[j], all->nq, count,
                       count - first < POINTS ? count - first : POINTS, q + first, V_qq + first);
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
