/* Parts of the cells for threads.
 *
 * Each class of steps is cut by itself, so that all members have as much to do in each slot. The
 * cuts are across an axis, or follow the cells' own numbers, whichever leaves the fewest events to
 * cells at the edge of a part. Free steps are cut by their events in a unit of time. */
#include "field/elastic_avi/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

typedef struct placed {
  double place;
  int cell;
} placed;

typedef struct parts {
  const dvi__solid_avi *avi;
  int members;
  placed *order;  /* [active] */
  int *owner;     /* [active] */
  int *of_vertex; /* [vertices] the owner of all of a node's cells, or one of these */
} parts;

enum { NOBODY = -1, SEVERAL = -2 };

static int compare(const void *first, const void *second)
{
  const placed *a = first, *b = second;
  if (a->place != b->place) return a->place < b->place ? -1 : 1;
  return a->cell < b->cell ? -1 : a->cell > b->cell;
}

/* Order the cells of each class along an axis, or for -1 as they are. */
static void order(const parts *p, int axis)
{
  const dvi__solid_avi *avi = p->avi;
  const int n = avi->n;
  for (int64_t c = 0; c < avi->active; c++) {
    double sum = 0;
    for (int a = 0; a <= n && axis >= 0; a++)
      sum += avi->solid->point[(int64_t)avi->corner[c * (n + 1) + a] * n + axis];
    p->order[c] = (placed){sum, (int)c};
  }
  for (int k = 0; k < avi->classes && axis >= 0; k++) {
    const int64_t first = k > 0 ? avi->class_end[k - 1] : 0;
    qsort(p->order + first, (size_t)(avi->class_end[k] - first), sizeof *p->order, compare);
  }
}

/* Give each member the same number of events of each class. */
static void cut(const parts *p)
{
  const dvi__solid_avi *avi = p->avi;
  for (int k = 0; k < avi->classes; k++) {
    const int64_t first = k > 0 ? avi->class_end[k - 1] : 0, end = avi->class_end[k];
    double whole = 0, sum = 0;
    for (int64_t i = first; i < end; i++) whole += 1 / avi->step[p->order[i].cell];
    for (int64_t i = first; i < end; i++) {
      const double weight = 1 / avi->step[p->order[i].cell];
      const int owner = (int)((sum + 0.5 * weight) / whole * p->members);
      p->owner[p->order[i].cell] = owner < p->members ? owner : p->members - 1;
      sum += weight;
    }
  }
}

static int is_at_edge(const parts *p, int64_t c)
{
  const int width = p->avi->n + 1;
  for (int a = 0; a < width; a++)
    if (p->of_vertex[p->avi->corner[c * width + a]] == SEVERAL) return 1;
  return 0;
}

/* Find the owners of nodes. Returns the events of cells at the edge in a unit of time. */
static double find_edge(const parts *p)
{
  const dvi__solid_avi *avi = p->avi;
  const int width = avi->n + 1;
  double events = 0;
  for (int64_t v = 0; v < avi->vertices; v++) p->of_vertex[v] = NOBODY;
  for (int64_t i = 0; i < avi->active * width; i++) {
    int *of = p->of_vertex + avi->corner[i];
    if (*of == NOBODY) *of = p->owner[i / width];
    if (*of != p->owner[i / width]) *of = SEVERAL;
  }
  for (int64_t c = 0; c < avi->active; c++)
    if (is_at_edge(p, c)) events += 1 / avi->step[c];
  return events;
}

static double try_axis(const parts *p, int axis)
{
  order(p, axis);
  cut(p);
  return find_edge(p);
}

dvi_status dvi__solid_share_out(const dvi__solid_avi *avi, int members, int *owner,
                                uint8_t *is_edge)
{
  const parts p = {.avi = avi,
                   .members = members,
                   .order = DVI_NEW(placed, avi->active),
                   .owner = owner,
                   .of_vertex = DVI_NEW(int, avi->vertices)};
  const int has_memory = p.order != NULL && p.of_vertex != NULL;
  double least = INFINITY;
  int best = 0;
  for (int axis = -1; axis < avi->n && has_memory; axis++) {
    const double events = try_axis(&p, axis);
    if (events < least) best = axis;
    least = fmin(least, events);
  }
  if (has_memory) (void)try_axis(&p, best);
  for (int64_t c = 0; c < avi->active && has_memory; c++) is_edge[c] = (uint8_t)is_at_edge(&p, c);
  dvi__release(p.order);
  dvi__release(p.of_vertex);
  return has_memory
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "%s: no memory for %d threads", avi->method, members);
}
