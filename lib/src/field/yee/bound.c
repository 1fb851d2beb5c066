/* The largest stable step, 2/sqrt(lambda) with the largest eigenvalue lambda of
 * M_1^-1 d_1^T M_2 d_1.
 *
 * Without materials the operator is a sum over the axes, and lambda the sum of the largest
 * eigenvalues of minus the second difference along each, which bisection finds by Sylvester's law
 * of inertia. With materials Lanczos' method finds it, within a thousandth from above. The place is
 * where boxes are the shortest and waves the fastest. Losses do not change it. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

/* ---- one axis ---- */

/* The symmetric matrix of the free nodes of an axis, with an entry in its corner if the axis
 * repeats itself. */
typedef struct line {
  const dvi__yee_axis *a;
  int first, count;
} line;

static double diagonal(const line *l, int i)
{
  const dvi__yee_axis *a = l->a;
  const int node = l->first + i, n = a->cells;
  const double after = node < n ? 1 / a->length[node] : 0,
               before = node > 0   ? 1 / a->length[node - 1]
                        : a->wraps ? 1 / a->length[n - 1]
                                   : 0;
  return (after + before) / a->dual[node];
}

/* Give minus the entry between the nodes i and i+1, or around the end. */
static double coupling(const line *l, int i)
{
  const dvi__yee_axis *a = l->a;
  const int node = l->first + i, next = l->first + (i + 1) % l->count;
  return 1 / (a->length[node] * sqrt(a->dual[node] * a->dual[next]));
}

/* Count the eigenvalues below x. */
static int count_below(const line *l, double x)
{
  const dvi__yee_axis *a = l->a;
  const int n = l->count;
  double pivot = diagonal(l, 0) - x, last = diagonal(l, n - 1) - x, re = 0, im = 0;
  int below = 0;
  if (a->wraps) re = -coupling(l, n - 1) * a->cosine, im = -coupling(l, n - 1) * a->sine;
  for (int i = 0; i < n - 1; i++) {
    if (pivot == 0) pivot = -1e-300;
    below += pivot < 0;
    const double off = -coupling(l, i), with_last = i == n - 2 ? off : 0;
    last -= ((re + with_last) * (re + with_last) + im * im) / pivot;
    re *= -off / pivot;
    im *= -off / pivot;
    pivot = i == n - 2 ? last : diagonal(l, i + 1) - x - off * off / pivot;
  }
  return below + ((n > 1 ? last : pivot) < 0);
}

static double largest_of_axis(const dvi__yee_axis *a)
{
  const line l = {a, a->free[0], a->free[1] - a->free[0]};
  double low = 0, high = 0;
  if (a->is_trivial || l.count < 1) return 0;
  if (l.count == 1 && a->wraps) return 2 * (1 - a->cosine) / (a->length[0] * a->dual[0]);
  for (int i = 0; i < l.count; i++) high = fmax(high, 2 * diagonal(&l, i));
  for (int i = 0; i < 200 && high - low > 1e-15 * high; i++) {
    const double middle = 0.5 * (low + high);
    if (count_below(&l, middle) == l.count)
      high = middle;
    else
      low = middle;
  }
  return high;
}

/* ---- place ---- */

static double length_around(const dvi__yee *y, int component, int l, int i)
{
  return dvi__yee_reaches(component, l) ? y->axis[l].length[i] : y->axis[l].dual[i];
}

/* The place where boxes are the shortest and waves the fastest: the largest sum over the axes of
 * 1/(eps mu h^2) at a face. */
static double local_largest(const dvi__yee *y, int c, const int *place)
{
  double sum = 0, over_eps = 0;
  for (int l = 0; l < 3 && !y->axis[l].is_trivial; l++) {
    const double h = length_around(y, DVI__YEE_B + c, l, place[l]);
    sum += 1 / (h * h);
  }
  for (int e = 0; e < 3; e++)
    if (e != c && y->slot[e] >= 0) over_eps = fmax(over_eps, dvi__yee_over_eps(y, e, place));
  return sum * dvi__yee_over_mu(y, c, place) * over_eps;
}

/* The first one of several places, by their numbers in the whole grid. */
typedef struct tight {
  double most, number, x[3];
} tight;

static tight tightest_here(const dvi__yee *y)
{
  tight found = {-1, 0, {0, 0, 0}};
  for (int c = DVI__YEE_B; c < DVI__YEE_B + 3; c++) {
    int place[3] = {0, 0, 0};
    if (y->slot[c] < 0) continue;
    for (place[2] = dvi__yee_begin(y, 2); place[2] < dvi__yee_end(y, c, 2); place[2]++)
      for (place[1] = dvi__yee_begin(y, 1); place[1] < dvi__yee_end(y, c, 1); place[1]++)
        for (place[0] = 0; place[0] < dvi__yee_places(y, c, 0); place[0]++) {
          const double here = local_largest(y, c - DVI__YEE_B, place);
          if (!(here > found.most)) continue;
          found.most = here;
          found.number = (double)dvi__yee_whole_number(y, c, place);
          for (int l = 0; l < 3; l++) {
            const dvi__yee_axis *a = &y->axis[l];
            found.x[l] = a->node[place[l]];
            if (dvi__yee_reaches(c, l)) found.x[l] += 0.5 * a->length[place[l]];
          }
        }
  }
  return found;
}

void dvi__yee_tightest(const dvi__yee *y, double *x)
{
  const tight here = tightest_here(y);
  double most = here.most, last;
  dvi__yee_largest_of_all(y, 1, &most);
  const double own = last = here.most == most ? -here.number : -(double)INFINITY;
  dvi__yee_largest_of_all(y, 1, &last);
  for (int l = 0; l < 3; l++) x[l] = own == last ? here.x[l] : -(double)INFINITY;
  dvi__yee_largest_of_all(y, 3, x);
}

/* ---- bound ---- */

static double fastest(const dvi__yee *y, size_t count, const double *array)
{
  double most = 0;
  if (array == NULL) return 1;
  for (size_t i = 0; i < count; i++) most = fmax(most, array[i]);
  dvi__yee_largest_of_all(y, 1, &most);
  return most;
}

static dvi_status find_largest(dvi__yee *y, double *lambda)
{
  const size_t rows = y->rows[0] * y->rows[1] * y->width;
  *lambda = 0;
  for (int l = 0; l < 3; l++) *lambda += largest_of_axis(&y->axis[l]);
  *lambda *= fastest(y, rows * (size_t)y->edges_slots, y->ce) *
             fastest(y, rows * (size_t)(y->components - y->edges_slots), y->mi);
  if (y->ce != NULL || y->mi != NULL) {
    for (int l = 0; l < 3; l++) dvi__yee_set_step(&y->axis[l], 1);
    DVI_TRY(dvi__yee_lanczos(y, *lambda, lambda));
  }
  return DVI_OK;
}

dvi_status dvi__yee_find_bound(dvi__yee *y, double *bound)
{
  double lambda;
  DVI_TRY(find_largest(y, &lambda));
  *bound = lambda > 0 ? 2 / sqrt(lambda) : (double)INFINITY;
  return DVI_OK;
}
