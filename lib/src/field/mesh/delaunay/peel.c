#include "field/mesh/delaunay/peel.h"

#include <math.h>
#include <stddef.h>

#include "core/status.h"
#include "field/mesh/volume.h"

enum { AXES = DVI_MESH_DIMENSION_MAX };

static void edges_from(const dvi__sites *s, const int *vertex, int corner, double *edge)
{
  for (int i = 0, k = 0; i <= s->n; i++)
    for (int l = 0; l < s->n && i != corner; l++)
      edge[k++] = s->x[(int64_t)vertex[i] * s->n + l] - s->x[(int64_t)vertex[corner] * s->n + l];
}

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int l = 0; l < n; l++) sum += a[l] * b[l];
  return sum;
}

/* Give the smallest part that is left of an edge from a corner without the directions of those
 * before it. A cell that is thin as its neighbours are, because all points are, is not flat. */
static double smallest_part(const dvi__sites *s, const int *vertex, int corner)
{
  const int n = s->n;
  double edge[AXES * AXES], least = 1;
  edges_from(s, vertex, corner, edge);
  for (int i = 0; i < n; i++) {
    double *e = edge + (ptrdiff_t)i * n;
    const double whole = sqrt(dot(n, e, e));
    for (int pass = 0; pass < 2; pass++) /* twice because of roundings */
      for (int j = 0; j < i; j++) {
        const double *d = edge + (ptrdiff_t)j * n, along = dot(n, d, e);
        for (int l = 0; l < n; l++) e[l] -= along * d[l];
      }
    const double left = sqrt(dot(n, e, e));
    least = fmin(least, left / whole);
    for (int l = 0; l < n && left > 0; l++) e[l] /= left;
  }
  return least;
}

/* A simplex with one far corner looks flat from there, and not from its other corners. */
static int is_flat(const dvi__sites *s, const int *vertex, double part)
{
  for (int corner = 0; corner <= s->n; corner++)
    if (smallest_part(s, vertex, corner) > part) return 0;
  return 1;
}

/* Note the bits of the slots whose facets are on the hull. */
static unsigned outer_facets(const dvi__triangulation *t, int simplex)
{
  unsigned outer = 0;
  for (int slot = 0; slot <= t->sites->n; slot++)
    if (!dvi__is_finite(t, t->simplex[simplex].neighbour[slot])) outer |= 1U << slot;
  return outer;
}

static int has_vertices(const dvi__triangulation *t, int simplex, const int *vertex, int count)
{
  for (int i = 0; i < count; i++) {
    int found = 0;
    for (int j = 0; j <= t->sites->n; j++) found |= t->simplex[simplex].vertex[j] == vertex[i];
    if (!found) return 0;
  }
  return 1;
}

/* Tell whether a face of a simplex is inside, by a visit of all simplices around it. */
static dvi_status look_around(dvi__triangulation *t, int simplex, const int *vertex, int count,
                              int *is_inner)
{
  const int64_t visit = ++t->visit;
  *is_inner = 1;
  t->hole.count = 0;
  t->simplex[simplex].mark = visit;
  DVI_TRY(dvi__place_add(&t->hole, simplex));
  for (int64_t k = 0; k < t->hole.count && *is_inner; k++)
    for (int slot = 0; slot <= t->sites->n; slot++) {
      const dvi__delaunay_simplex *s = &t->simplex[t->hole.at[k]];
      const int next = s->neighbour[slot];
      int holds = 1; /* whether the facet has the face */
      for (int i = 0; i < count; i++) holds &= s->vertex[slot] != vertex[i];
      if (!holds || t->simplex[next].mark == visit) continue;
      *is_inner &= dvi__is_finite(t, next) && has_vertices(t, next, vertex, count);
      t->simplex[next].mark = visit;
      DVI_TRY(dvi__place_add(&t->hole, next));
    }
  return DVI_OK;
}

/* Write each corner of facet `slot` times a number, so that their sum is next to the opposite
 * corner. The numbers [n+1] have the sum 1. They are not finite for a facet without an area. */
static void project(const dvi__sites *s, const int *vertex, int slot, double *number)
{
  const int n = s->n, first = slot == 0;
  double edge[AXES][AXES], gram[AXES * AXES], to[AXES] = {0};
  int other[AXES] = {0}, others = 0;
  for (int i = 0; i <= n; i++)
    if (i != slot && i != first) other[others++] = i;
  other[others] = slot;
  for (int k = 0; k <= others; k++)
    for (int l = 0; l < n; l++)
      edge[k][l] = s->x[(int64_t)vertex[other[k]] * n + l] - s->x[(int64_t)vertex[first] * n + l];
  number[first] = 1;
  for (int k = -1; k < others; k++) { /* by Cramer's rule, the divisor first */
    for (int i = 0; i < others; i++)
      for (int j = 0; j < others; j++) {
        const double *a = edge[j == k ? others : j];
        gram[i * others + j] = 0;
        for (int l = 0; l < n; l++) gram[i * others + j] += edge[i][l] * a[l];
      }
    to[k + 1] = dvi__determinant(others, gram);
  }
  for (int k = 0; k < others; k++) {
    number[other[k]] = to[k + 1] / to[0];
    number[first] -= number[other[k]];
  }
  number[slot] = 0;
}

/* Tell whether another simplex lies between a flat one and the outside. Seen from there, a facet is
 * in front if the opposite corner lies on the far side of it. */
static int is_covered(const dvi__triangulation *t, int simplex, unsigned outer)
{
  double number[AXES + 1];
  for (int slot = 0; slot <= t->sites->n; slot++) {
    if (!(outer >> slot & 1)) continue;
    project(t->sites, t->simplex[simplex].vertex, slot, number);
    for (int i = 0; i <= t->sites->n; i++)
      if (!(outer >> i & 1) && number[i] < -1e-3) return 1;
  }
  return 0;
}

/* A ball stays a ball without a simplex that meets its boundary in some facets and in nothing
 * else. Then the face of the corners opposite to these facets is inside. With as many facets as
 * dimensions the simplex would take a point with it. */
static dvi_status can_go(dvi__triangulation *t, int simplex, int also_covered, int *answer)
{
  const unsigned outer = outer_facets(t, simplex);
  int corner[AXES + 1], count = 0;
  for (int slot = 0; slot <= t->sites->n; slot++)
    if (outer >> slot & 1) corner[count++] = t->simplex[simplex].vertex[slot];
  *answer = 0;
  if (count == 0 || count >= t->sites->n) return DVI_OK;
  if (!also_covered && is_covered(t, simplex, outer)) return DVI_OK;
  return look_around(t, simplex, corner, count, answer);
}

/* A removed simplex stays as a neighbour, as those with the infinite vertex do. */
static void remove_simplex(dvi__triangulation *t, int simplex)
{
  double edge[AXES * AXES];
  edges_from(t->sites, t->simplex[simplex].vertex, 0, edge);
  t->peeled += fabs(dvi__determinant(t->sites->n, edge));
  t->simplex[simplex].vertex[0] = DVI__UNUSED;
}

dvi_status dvi__list_flat(const dvi__triangulation *t, double part, dvi__places *flat)
{
  for (int c = 0; c < t->count; c++)
    if (dvi__is_finite(t, c) && is_flat(t->sites, t->simplex[c].vertex, part))
      DVI_TRY(dvi__place_add(flat, c));
  return DVI_OK;
}

/* Each removal may make others possible. */
static dvi_status remove_some(dvi__triangulation *t, int also_covered, dvi__places *flat)
{
  int64_t before;
  do {
    int64_t left = 0;
    before = flat->count;
    for (int64_t k = 0; k < before; k++) {
      int answer;
      DVI_TRY(can_go(t, flat->at[k], also_covered, &answer));
      if (answer)
        remove_simplex(t, flat->at[k]);
      else
        flat->at[left++] = flat->at[k];
    }
    flat->count = left;
  } while (flat->count < before);
  return DVI_OK;
}

dvi_status dvi__peel(dvi__triangulation *t, double part, dvi__places *flat)
{
  int64_t left = 0;
  DVI_TRY(remove_some(t, 0, flat));
  DVI_TRY(remove_some(t, 1, flat));
  for (int64_t k = 0; k < flat->count; k++)
    if (is_flat(t->sites, t->simplex[flat->at[k]].vertex, part)) flat->at[left++] = flat->at[k];
  flat->count = left;
  return DVI_OK;
}
