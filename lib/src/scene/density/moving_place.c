/* The derivatives of a density by the position, which nodes that are unknowns feel.
 *
 * The density is made once more, with the position as one of its variables. */
#include <string.h>

#include "scene/density/moving.h"

/* Points that are evaluated at a time, and the variables, u, u_t, u_x and u_y of each component and
 * the position. */
enum {
  AXES = DVI_MOVING_AXES_MAX,
  POINTS = 32,
  MOST = (2 + AXES) * DVI_MOVING_COMPONENTS_MAX + AXES,
  PAIRS = MOST * (MOST + 1) / 2
};

/* Return the variable of the density without the position that is variable k of the one with it, or
 * -1 - i for the position along axis i. */
static int same_variable(const dvi__scene_moving *m, int k)
{
  const dvi_jet *of = m->placed->variable + k;
  for (int i = 0; i < m->whole->variables && of->component >= 0; i++) {
    const dvi_jet *jet = m->whole->variable + i;
    if (jet->component == of->component && jet->rate == of->rate && jet->order[0] == of->order[0] &&
        jet->order[1] == of->order[1])
      return i;
  }
  return of->component;
}

/* Points `from` to from + some of all count, and same_variable of each variable. */
typedef struct part {
  int count, from, some;
  const int *same;
} part;

static void take(const dvi__scene_moving *m, part of, const double *x, const double *z, double *to)
{
  for (int k = 0; k < m->placed->variables; k++) {
    const int i = of.same[k];
    const double *row = i < 0 ? x + (ptrdiff_t)(-1 - i) * of.count : z + (ptrdiff_t)i * of.count;
    memcpy(to + (ptrdiff_t)k * of.some, row + of.from, (size_t)of.some * sizeof *to);
  }
}

/* Put a row where `row` rows of all points are, unless nothing is wanted. */
static void put(part of, int row, const double *from, double *to)
{
  if (to != NULL)
    memcpy(to + (ptrdiff_t)row * of.count + of.from, from, (size_t)of.some * sizeof *to);
}

/* Put the second derivatives by variables a and b of which one at least is a position. */
static void put_second(const dvi__scene_moving *m, part of, int a, int b, const double *from,
                       double *l_xz, double *l_xx)
{
  const int i = -1 - (a < 0 ? a : b), other = a < 0 ? b : a, j = -1 - other;
  if (other >= 0)
    put(of, i * m->whole->variables + other, from, l_xz);
  else
    put(of, i > j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i, from, l_xx);
}

static int evaluate(const dvi__scene_moving *m, part of, double t, const double *x, const double *z,
                    double *l_x, double *l_xz, double *l_xx)
{
  double all[MOST * POINTS], first[MOST * POINTS], second[PAIRS * POINTS];
  const dvi__local *placed = m->placed;
  take(m, of, x, z, all);
  const bool has_second = l_xz != NULL || l_xx != NULL;
  /* All of the position is among the variables. */
  const int failed = dvi__local_density(of.some, t, NULL, all, NULL, first,
                                        has_second ? second : NULL, (void *)placed);
  for (int k = 0; k < placed->variables && failed == 0; k++)
    if (of.same[k] < 0) put(of, -1 - of.same[k], first + (ptrdiff_t)k * of.some, l_x);
  for (int e = 0; e < placed->pairs && has_second && failed == 0; e++) {
    const int a = of.same[placed->pair[e][0]], b = of.same[placed->pair[e][1]];
    if (a < 0 || b < 0) put_second(m, of, a, b, second + (ptrdiff_t)e * of.some, l_xz, l_xx);
  }
  return failed;
}

static void clear(int count, double *to)
{
  if (to != NULL) memset(to, 0, (size_t)count * sizeof *to);
}

int dvi__moving_place_derivative(int count, double t, const double *x, const double *z, double *l_x,
                                 double *l_xz, double *l_xx, void *user)
{
  const dvi__scene_moving *m = user;
  const int axes = m->density->jets.dimension;
  int failed = 0, same[MOST] = {0};
  for (int k = 0; k < m->placed->variables; k++) same[k] = same_variable(m, k);
  clear(axes * count, l_x);
  clear(axes * m->whole->variables * count, l_xz);
  clear(axes * (axes + 1) / 2 * count, l_xx);
  for (int from = 0; from < count && failed == 0; from += POINTS) {
    const part of = {count, from, count - from < POINTS ? count - from : POINTS, same};
    failed = evaluate(m, of, t, x, z, l_x, l_xz, l_xx);
  }
  return failed;
}
