#include "view/links.h"

#include <dvi/dvi.h>
#include <stdint.h>
#include <stdlib.h>

#include "cli/command.h"
#include "view/factors.h"

/* Links of a point by forces, at most, on the average: a net in space has 3. Coordinates of a
 * matrix without a pattern, whose entries are looked at. */
enum { PAIRS_MOST = 4, FULL_MOST = 256 };

/* Pairs of points, from < to, perhaps several times. */
typedef struct pairs {
  int64_t count, room;
  view_link *pair;
} pairs;

static bool pairs_add(pairs *list, int a, int b)
{
  if (a == VIEW_NONE || b == VIEW_NONE || a == b) return true;
  if (list->count == list->room) {
    const int64_t room = 2 * list->room + 64;
    view_link *grown = realloc(list->pair, (size_t)room * sizeof *grown);
    if (grown == NULL) return false;
    list->pair = grown;
    list->room = room;
  }
  list->pair[list->count++] = (view_link){a < b ? a : b, a < b ? b : a};
  return true;
}

static int compare_pairs(const void *first, const void *second)
{
  const view_link *a = first, *b = second;
  if (a->from != b->from) return a->from < b->from ? -1 : 1;
  return (a->to > b->to) - (a->to < b->to);
}

static void pairs_keep_distinct(pairs *list)
{
  int64_t kept = 0;
  if (list->count > 1) qsort(list->pair, (size_t)list->count, sizeof *list->pair, compare_pairs);
  for (int64_t k = 0; k < list->count; k++)
    if (kept == 0 || compare_pairs(&list->pair[kept - 1], &list->pair[k]) != 0)
      list->pair[kept++] = list->pair[k];
  list->count = kept;
}

static bool link_pairs(const pairs *list, view_layout *layout)
{
  for (int64_t k = 0; k < list->count; k++)
    if (!layout_link(layout, list->pair[k].from, list->pair[k].to)) return false;
  return true;
}

/* ---- forces ---- */

static int entries_of(const dvi_pattern *pattern, int n)
{
  return pattern->start != NULL ? pattern->start[n] : n * n;
}

/* Collect the pairs that second derivatives couple: those of their pattern, or without one the
 * entries that are not zero. */
static bool add_entries(const dvi_pattern *pattern, const double *entry, int n,
                        const view_layout *layout, pairs *list)
{
  const bool full = pattern->start == NULL;
  for (int j = 0; j < n; j++) {
    const int first = full ? j * n : pattern->start[j],
              end = full ? first + n : pattern->start[j + 1];
    for (int e = first; e < end; e++) {
      const int row = full ? e - first : pattern->row[e];
      const bool coupled = !full || entry[e] > 0 || entry[e] < 0;
      if (row < j && coupled && !pairs_add(list, layout->owner[row], layout->owner[j]))
        return false;
    }
  }
  return true;
}

/* Evaluate a potential's second derivatives at the start. */
static bool potential_entries(const problem *scene, const dvi_potential *V, double *entry)
{
  const double t = 0;
  if (V->hessian_batch != NULL) return V->hessian_batch(1, &t, scene->q, entry, V->user) == 0;
  return V->hessian != NULL && V->hessian(t, scene->q, entry, V->user) == 0;
}

static bool lagrangian_entries(const problem *scene, const dvi_lagrangian *L, double *entry)
{
  const int n = scene->nq;
  const double t = 0;
  double *other = calloc((size_t)(entries_of(&L->qv, n) + entries_of(&L->vv, n)) + 1,
                         sizeof *other);
  bool good = other != NULL && (L->hessian_batch != NULL || L->hessian != NULL);
  double *qv = other, *vv = good ? other + entries_of(&L->qv, n) : NULL;
  if (good)
    good = (L->hessian_batch != NULL
                ? L->hessian_batch(1, &t, scene->q, scene->v, entry, qv, vv, L->user)
                : L->hessian(t, scene->q, scene->v, entry, qv, vv, L->user)) == 0;
  free(other);
  return good;
}

/* Collect the pairs of all forces. Matrices without a pattern are looked at if they are small. */
static bool add_forces(const problem *scene, const view_layout *layout, pairs *list)
{
  const dvi_lagrangian *L = scene->terms->lagrangian;
  const int n = scene->nq, small = n <= FULL_MOST;
  double *entry = small ? calloc((size_t)n * (size_t)n, sizeof *entry) : NULL;
  bool good = !small || entry != NULL;
  if (good && L != NULL && (L->qq.start != NULL || (small && lagrangian_entries(scene, L, entry))))
    good = add_entries(&L->qq, entry, n, layout, list);
  for (int k = 0; k < scene->terms->potential_count && good; k++) {
    const dvi_potential *V = &scene->terms->potentials[k];
    if (V->qq.start != NULL || (small && potential_entries(scene, V, entry)))
      good = add_entries(&V->qq, entry, n, layout, list);
  }
  free(entry);
  return good;
}

static bool forces_are_drawn(const pairs *list, int points)
{
  const int64_t all = (int64_t)points * (points - 1) / 2;
  return list->count < all && list->count <= (int64_t)PAIRS_MOST * points;
}

/* ---- constraints ---- */

/* Collect the points of a row of constraints, if there are two of them. */
static bool add_row(const problem *scene, const dvi_holonomic *term, int a, const double *entry,
                    const view_layout *layout, pairs *list)
{
  const bool full = term->gradients.start == NULL;
  const int n = scene->nq, start = full ? a * n : term->gradients.start[a],
            end = full ? start + n : term->gradients.start[a + 1];
  int point[2], points = 0;
  for (int e = start; e < end; e++) {
    const int owner = layout->owner[full ? e - start : term->gradients.row[e]];
    bool known = owner == VIEW_NONE || !(entry[e] > 0 || entry[e] < 0);
    for (int k = 0; k < points; k++) known = known || point[k] == owner;
    if (known) continue;
    if (points == 2) return true;
    point[points++] = owner;
  }
  return points < 2 || pairs_add(list, point[0], point[1]);
}

static bool add_constraints(const problem *scene, const view_layout *layout, pairs *list)
{
  bool good = true;
  for (int k = 0; k < scene->terms->holonomic_count && good; k++) {
    const dvi_holonomic *term = &scene->terms->holonomics[k];
    const size_t entries = term->gradients.start != NULL
                               ? (size_t)term->gradients.start[term->count]
                               : (size_t)scene->nq * (size_t)term->count;
    double *entry = calloc(entries + 1, sizeof *entry);
    good = entry != NULL;
    if (good && term->gradient(0, scene->q, entry, term->user) == 0)
      for (int a = 0; a < term->count && good; a++)
        good = add_row(scene, term, a, entry, layout, list);
    free(entry);
  }
  return good;
}

/* ---- directions ---- */

static bool has_directions(const problem *scene, const view_layout *layout)
{
  bool has = false;
  for (int i = 0; i < scene->nq; i++)
    has = has || (layout->owner[i] != VIEW_NONE && is_of_direction(scene, i));
  return has;
}

static bool link_directions(const problem *scene, view_layout *layout)
{
  for (int i = 0; i < scene->nq; i++) {
    const int owner = layout->owner[i];
    const bool begins = owner != VIEW_NONE && layout->point[owner].from[0] == i;
    if (begins && is_of_direction(scene, i) && !layout_link(layout, VIEW_NONE, owner)) return false;
  }
  return true;
}

bool links_find(const problem *scene, view_layout *layout)
{
  pairs held = {0}, forced = {0};
  const bool moves = scene->q != NULL && !layout->is_chain;
  bool good = !moves || (add_constraints(scene, layout, &held) && link_directions(scene, layout));
  if (good && moves && !has_directions(scene, layout)) good = add_forces(scene, layout, &forced);
  pairs_keep_distinct(&held);
  pairs_keep_distinct(&forced);
  good = good && link_pairs(&held, layout) &&
         (!forces_are_drawn(&forced, layout->points) || link_pairs(&forced, layout));
  free(held.pair);
  free(forced.pair);
  if (!good) complain("out of memory");
  return good;
}
