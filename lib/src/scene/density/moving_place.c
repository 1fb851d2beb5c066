/* The derivatives of a density by the position, which nodes that are unknowns feel.
 *
 * The density is made once more, with the position as one of its variables. */
#include <string.h>

#include "scene/density/moving.h"

/* Points that are evaluated at a time, and the variables, u, u_t and u_x of each component and the
 * position. */
enum { POINTS = 32, MOST = 3 * DVI_MOVING_COMPONENTS_MAX + 1, PAIRS = MOST * (MOST + 1) / 2 };

/* Return the variable of the density without the position that is variable k of the one with it, or
 * -1 for the position. */
static int same_variable(const dvi__scene_moving *m, int k)
{
  const dvi_jet *of = m->placed->variable + k;
  for (int i = 0; i < m->whole->variables && of->component >= 0; i++) {
    const dvi_jet *jet = m->whole->variable + i;
    if (jet->component == of->component && jet->rate == of->rate && jet->order[0] == of->order[0])
      return i;
  }
  return -1;
}

/* Points `from` to from + some of all count. */
typedef struct part {
  int count, from, some;
} part;

static void take(const dvi__scene_moving *m, part of, const double *x, const double *z, double *to)
{
  for (int k = 0; k < m->placed->variables; k++) {
    const int i = same_variable(m, k);
    const double *row = i < 0 ? x : z + (ptrdiff_t)i * of.count;
    memcpy(to + (ptrdiff_t)k * of.some, row + of.from, (size_t)of.some * sizeof *to);
  }
}

static void put(part of, const double *row, double *to)
{
  if (to != NULL) memcpy(to + of.from, row, (size_t)of.some * sizeof *to);
}

static int evaluate(const dvi__scene_moving *m, part of, double t, const double *x, const double *z,
                    double *l_x, double *l_xz, double *l_xx)
{
  double all[MOST * POINTS], first[MOST * POINTS], second[PAIRS * POINTS];
  const dvi__local *placed = m->placed;
  take(m, of, x, z, all);
  const bool has_second = l_xz != NULL || l_xx != NULL;
  const int failed = dvi__local_density(of.some, t, x, all, NULL, first, has_second ? second : NULL,
                                        (void *)placed);
  for (int k = 0; k < placed->variables && failed == 0; k++)
    if (same_variable(m, k) < 0) put(of, first + (ptrdiff_t)k * of.some, l_x);
  for (int e = 0; e < placed->pairs && has_second && failed == 0; e++) {
    const int a = same_variable(m, placed->pair[e][0]), b = same_variable(m, placed->pair[e][1]);
    const double *row = second + (ptrdiff_t)e * of.some;
    if (a < 0 && b < 0)
      put(of, row, l_xx);
    else if ((a < 0 || b < 0) && l_xz != NULL)
      put(of, row, l_xz + (ptrdiff_t)(a < 0 ? b : a) * of.count);
  }
  return failed;
}

int dvi__moving_place_derivative(int count, double t, const double *x, const double *z, double *l_x,
                                 double *l_xz, double *l_xx, void *user)
{
  const dvi__scene_moving *m = user;
  int failed = 0;
  if (l_x != NULL) memset(l_x, 0, (size_t)count * sizeof *l_x);
  if (l_xz != NULL) memset(l_xz, 0, (size_t)(count * m->whole->variables) * sizeof *l_xz);
  if (l_xx != NULL) memset(l_xx, 0, (size_t)count * sizeof *l_xx);
  for (int from = 0; from < count && failed == 0; from += POINTS) {
    const part of = {count, from, count - from < POINTS ? count - from : POINTS};
    failed = evaluate(m, of, t, x, z, l_x, l_xz, l_xx);
  }
  return failed;
}
