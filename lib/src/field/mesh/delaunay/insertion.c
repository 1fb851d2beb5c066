/* Points are inserted one by one (Bowyer 1981, Watson 1981). The simplices whose spheres hold the
 * new point are replaced by those that join it to the facets around them. An infinite vertex closes
 * the hull: the sphere of a facet with this vertex is the half-space beyond the facet. Because all
 * signs are exact, and no point lies on a sphere, the simplices are a triangulation after each
 * point. */
#include "field/mesh/delaunay/insertion.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/delaunay/order.h"

enum { AXES = DVI_MESH_DIMENSION_MAX, SLOTS = 8 };

static dvi_status no_memory(int64_t count)
{
  return dvi__fail(DVI_NO_MEMORY, "no memory for %lld simplices", (long long)count);
}

/* ---- lists ---- */

/* Give twice the room, with what is there. NULL, and nothing changed, if there is no memory. */
static void *grown(void *old, int64_t count, int64_t room, size_t size)
{
  void *more = dvi__allocate((size_t)room, size);
  if (more == NULL) return NULL;
  if (count > 0) memcpy(more, old, (size_t)count * size);
  dvi__release(old);
  return more;
}

dvi_status dvi__place_add(dvi__places *list, int place)
{
  if (list->count == list->room) {
    const int64_t room = list->room > 0 ? 2 * list->room : 64;
    int *more = grown(list->at, list->count, room, sizeof *more);
    if (more == NULL) return no_memory(room);
    list->at = more;
    list->room = room;
  }
  list->at[list->count++] = place;
  return DVI_OK;
}

int dvi__slot_of(const int *entry, int wanted)
{
  int slot = 0;
  while (entry[slot] != wanted) slot++;
  return slot;
}

int dvi__is_finite(const dvi__triangulation *t, int simplex)
{
  const int *vertex = t->simplex[simplex].vertex;
  if (vertex[0] == DVI__UNUSED) return 0;
  for (int i = 0; i <= t->sites->n; i++)
    if (vertex[i] == DVI__INFINITE) return 0;
  return 1;
}

static dvi_status take_unused(dvi__triangulation *t, int *simplex)
{
  *simplex = t->unused;
  if (t->unused >= 0) {
    t->unused = t->simplex[t->unused].neighbour[0];
    return DVI_OK;
  }
  if (t->count == t->room) {
    const int64_t room = t->room > 0 ? 2 * t->room : 64;
    if (t->count >= INT_MAX / SLOTS)
      return dvi__fail(DVI_BAD_SIZE, "more than %lld simplices are too many", (long long)t->count);
    dvi__delaunay_simplex *more = grown(t->simplex, t->count, room, sizeof *more);
    if (more == NULL) return no_memory(room);
    t->simplex = more;
    t->room = room;
  }
  *simplex = (int)t->count++;
  return DVI_OK;
}

static void give_back(dvi__triangulation *t, int simplex)
{
  t->simplex[simplex].vertex[0] = DVI__UNUSED;
  t->simplex[simplex].neighbour[0] = t->unused;
  t->unused = simplex;
}

/* ---- where a new point belongs ---- */

static dvi_status refuse_twins(const dvi__triangulation *t, const int *vertex, int p)
{
  const int n = t->sites->n;
  for (int i = 0; i <= n; i++) {
    const int a = vertex[i] < p ? vertex[i] : p, b = vertex[i] < p ? p : vertex[i];
    const double *x = t->sites->x + (int64_t)a * n, *y = t->sites->x + (int64_t)b * n;
    int equal = 1;
    for (int l = 0; l < n; l++) equal &= x[l] == y[l];
    if (equal)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "points %d and %d are equal, or differ by less than rounding: leave one out",
                       a, b);
  }
  return DVI_OK;
}

/* Walk from simplex to simplex through facets beyond which the point lies. The walk ends in a
 * simplex that holds the point, or outside of a facet of the hull. It never returns to a simplex,
 * because the height of the point above the lifted simplices grows. */
static dvi_status locate(const dvi__triangulation *t, int p, int *simplex)
{
  const int n = t->sites->n;
  int at = t->last, from = -1;
  for (int first = 0, moved = 1; moved && dvi__is_finite(t, at); first++) {
    const dvi__delaunay_simplex *s = &t->simplex[at];
    moved = 0;
    for (int k = 0; k <= n && !moved; k++) {
      const int slot = (first + k) % (n + 1), next = s->neighbour[slot];
      if (next == from || dvi__side(t->sites, s->vertex, slot, p) >= 0) continue;
      from = at;
      at = next;
      moved = 1;
    }
  }
  *simplex = at;
  return dvi__is_finite(t, at) ? refuse_twins(t, t->simplex[at].vertex, p) : DVI_OK;
}

/* Tell whether the point is inside of the sphere of a simplex. A facet of the hull and a point of
 * its plane have one sphere there, which is that of the simplex on the facet's other side. */
static int is_hit(const dvi__triangulation *t, int simplex, int p)
{
  const dvi__delaunay_simplex *s = &t->simplex[simplex];
  int slot = 0;
  while (slot <= t->sites->n && s->vertex[slot] != DVI__INFINITE) slot++;
  if (slot > t->sites->n) return dvi__is_inside(t->sites, s->vertex, p);
  const int side = dvi__side(t->sites, s->vertex, slot, p);
  if (side != 0) return side > 0;
  return dvi__is_inside(t->sites, t->simplex[s->neighbour[slot]].vertex, p);
}

/* Collect the simplices that are hit, and the facets around them. */
static dvi_status dig(dvi__triangulation *t, int p, int start)
{
  const int64_t missed = t->visit + 1, hit = t->visit + 2;
  t->visit += 2;
  t->hole.count = t->border.count = 0;
  t->simplex[start].mark = hit;
  DVI_TRY(dvi__place_add(&t->hole, start));
  for (int64_t k = 0; k < t->hole.count; k++)
    for (int slot = 0; slot <= t->sites->n; slot++) {
      const int at = t->hole.at[k], next = t->simplex[at].neighbour[slot];
      dvi__delaunay_simplex *s = &t->simplex[next];
      if (s->mark != hit && s->mark != missed) s->mark = is_hit(t, next, p) ? -hit : missed;
      if (s->mark == missed) DVI_TRY(dvi__place_add(&t->border, at * SLOTS + slot));
      if (s->mark == -hit) DVI_TRY(dvi__place_add(&t->hole, next));
      if (s->mark == -hit) s->mark = hit;
    }
  return DVI_OK;
}

/* ---- the new simplices ---- */

/* Join the point to each facet around the hole. What was inside then refers to the new simplex at
 * the facet by a negative number. */
static dvi_status join(dvi__triangulation *t, int p)
{
  for (int64_t k = 0; k < t->border.count; k++) {
    const int inner = t->border.at[k] / SLOTS, slot = t->border.at[k] % SLOTS;
    int made;
    DVI_TRY(take_unused(t, &made));
    dvi__delaunay_simplex *s = &t->simplex[made];
    *s = t->simplex[inner];
    s->vertex[slot] = p;
    s->mark = 0;
    int *back = t->simplex[s->neighbour[slot]].neighbour;
    back[dvi__slot_of(back, inner)] = made;
    t->simplex[inner].neighbour[slot] = -1 - made;
  }
  return DVI_OK;
}

/* Find the new simplex beyond face `out` of the one at this facet of the hole, by turning through
 * the hole around what both facets have in common. */
static int turn(const dvi__triangulation *t, int inner, int slot, int out)
{
  int at = inner, hinge = t->simplex[at].vertex[slot], next;
  while ((next = t->simplex[at].neighbour[out]) >= 0) {
    const dvi__delaunay_simplex *s = &t->simplex[next];
    out = dvi__slot_of(s->vertex, hinge);
    hinge = s->vertex[dvi__slot_of(s->neighbour, at)];
    at = next;
  }
  return -1 - next;
}

static dvi_status fill(dvi__triangulation *t, int p)
{
  DVI_TRY(join(t, p));
  for (int64_t k = 0; k < t->border.count; k++) {
    const int inner = t->border.at[k] / SLOTS, slot = t->border.at[k] % SLOTS,
              made = -1 - t->simplex[inner].neighbour[slot];
    for (int out = 0; out <= t->sites->n; out++)
      if (out != slot) t->simplex[made].neighbour[out] = turn(t, inner, slot, out);
    if (dvi__is_finite(t, made)) t->last = made;
  }
  for (int64_t k = 0; k < t->hole.count; k++) give_back(t, t->hole.at[k]);
  return DVI_OK;
}

static dvi_status insert(dvi__triangulation *t, int p)
{
  int start;
  DVI_TRY(locate(t, p, &start));
  DVI_TRY(dig(t, p, start));
  return fill(t, p);
}

/* ---- the first simplex ---- */

/* Give the part of a point's way from the first corner that is orthogonal to the axes so far, and
 * the square of its length. */
static double rest_of(const dvi__sites *s, int p, int first, const double *axis, int axes,
                      double *rest)
{
  double square = 0;
  for (int l = 0; l < s->n; l++)
    rest[l] = s->x[(int64_t)p * s->n + l] - s->x[(int64_t)first * s->n + l];
  for (int i = 0; i < axes; i++) {
    double along = 0;
    for (int l = 0; l < s->n; l++) along += axis[i * s->n + l] * rest[l];
    for (int l = 0; l < s->n; l++) rest[l] -= along * axis[i * s->n + l];
  }
  for (int l = 0; l < s->n; l++) square += rest[l] * rest[l];
  return square;
}

/* Take points that are far from what those before them span. */
static void choose_corners(const dvi__sites *s, int *vertex)
{
  double axis[AXES * AXES] = {0}, rest[AXES];
  vertex[0] = 0;
  for (int k = 0; k < s->n; k++) {
    double farthest = -1;
    for (int p = 0; p < s->points; p++) {
      const double square = rest_of(s, p, vertex[0], axis, k, rest);
      if (square <= farthest) continue;
      farthest = square;
      vertex[k + 1] = p;
    }
    (void)rest_of(s, vertex[k + 1], vertex[0], axis, k, rest);
    for (int l = 0; l < s->n; l++) axis[k * s->n + l] = farthest > 0 ? rest[l] / sqrt(farthest) : 0;
  }
}

static void exchange(int *a, int *b)
{
  const int other = *a;
  *a = *b;
  *b = other;
}

/* Surround the first simplex with infinite ones, of the orientation of their neighbours. */
static void surround(dvi__triangulation *t)
{
  const int n = t->sites->n;
  for (int i = 0; i <= n; i++) {
    dvi__delaunay_simplex *s = &t->simplex[i + 1];
    memcpy(s->vertex, t->simplex[0].vertex, sizeof s->vertex);
    t->simplex[0].neighbour[i] = i + 1;
    for (int j = 0; j <= n; j++) s->neighbour[j] = j == i ? 0 : j + 1;
    s->vertex[i] = DVI__INFINITE;
    exchange(&s->vertex[0], &s->vertex[1]);
    exchange(&s->neighbour[0], &s->neighbour[1]);
  }
}

static dvi_status begin(dvi__triangulation *t)
{
  const int n = t->sites->n;
  int made, vertex[AXES + 1] = {0};
  for (int i = 0; i <= n + 1; i++) DVI_TRY(take_unused(t, &made));
  choose_corners(t->sites, vertex);
  const int side = dvi__side(t->sites, vertex, 0, vertex[0]);
  if (side == 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "these %lld points have no simplex with a volume: do they lie in a plane?",
                     (long long)t->sites->points);
  if (side < 0) exchange(&vertex[0], &vertex[1]);
  memcpy(t->simplex[0].vertex, vertex, sizeof vertex);
  surround(t);
  return DVI_OK;
}

static dvi_status insert_all(dvi__triangulation *t, const int *order)
{
  DVI_TRY(begin(t));
  int corner[AXES + 1];
  memcpy(corner, t->simplex[0].vertex, sizeof corner);
  for (int64_t k = 0; k < t->sites->points; k++) {
    int is_corner = 0;
    for (int i = 0; i <= t->sites->n; i++) is_corner |= corner[i] == order[k];
    if (!is_corner) DVI_TRY(insert(t, order[k]));
  }
  return DVI_OK;
}

dvi_status dvi__triangulate(const dvi__sites *sites, dvi__triangulation *t)
{
  *t = (dvi__triangulation){.sites = sites, .unused = -1};
  int *order = dvi__insertion_order(sites);
  const dvi_status status = order != NULL ? insert_all(t, order) : no_memory(sites->points);
  dvi__release(order);
  return status;
}

void dvi__triangulation_clear(dvi__triangulation *t)
{
  dvi__release(t->simplex);
  dvi__release(t->hole.at);
  dvi__release(t->border.at);
  *t = (dvi__triangulation){.unused = -1};
}
