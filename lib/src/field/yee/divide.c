/* How processes divide a grid.
 *
 * Blocks are cut along y and z. Along x rows stay whole, so that loops in lanes run through them
 * and a row has no ghosts of its own. A block's surface is what it costs: planes that go to
 * neighbours, and that are updated twice where steps go together. Slabs across the last axis have
 * their planes in memory one after the other, and two neighbours only, and are taken as long as
 * they are thick. Otherwise the division is the one with the least surface. */
#include <math.h>
#include <stdio.h>

#include "core/status.h"
#include "field/yee/ranks.h"

enum { LEAST = 2, THICK = 12 }; /* boxes of an axis for each process, at least and in slabs */

static const char name[] = "xyz";

/* ---- checks ---- */

static dvi_status check_ranks(const dvi_yee_ranks *r)
{
  if (r->size != sizeof *r)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: set ranks.size to sizeof(dvi_yee_ranks)");
  if (r->count < 1 || r->rank < 0 || r->rank >= r->count)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: there is no process %d of %d", r->rank, r->count);
  if (r->pass == NULL || r->sum == NULL || r->largest == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: the functions by which processes speak are not all given");
  for (int l = 0; l < 3; l++)
    if (r->parts[l] < 0)
      return dvi__fail(DVI_BAD_ARGUMENT, "yee: ranks.parts is %d for axis %c; set 0 or more",
                       r->parts[l], name[l]);
  if (r->parts[0] <= 1) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "yee: axis x is to have %d parts, but is not divided",
                   r->parts[0]);
}

/* ---- divisions ---- */

/* Give the planes of ghosts that a process has along an axis, one on each side with a neighbour. */
static int sides(const dvi__yee_axis *a, int parts)
{
  return parts == 1 ? 0 : parts == 2 && !a->wraps ? 1 : 2;
}

/* Give the surface of a block, times the number of processes. */
static double surface_of(const dvi__yee *y, int rows, int planes)
{
  const dvi__yee_axis *across = &y->axis[1], *up = &y->axis[2];
  return (double)sides(across, rows) * rows * up->cells +
         (double)sides(up, planes) * planes * across->cells;
}

/* Tell if an axis may have that many parts. */
static int is_possible(const dvi__yee *y, const dvi_yee_ranks *r, int axis, int parts)
{
  const int asked = r->parts[axis];
  return (asked == 0 || asked == parts) && (parts == 1 || y->axis[axis].cells / parts >= LEAST);
}

/* Choose the parts of y and z. Return 0 if there is no division. */
static int choose_parts(const dvi_yee_ranks *r, dvi__yee *y)
{
  double least = (double)INFINITY;
  for (int planes = r->count; planes > 0; planes--) {
    const int rows = r->count / planes;
    if (r->count % planes != 0 || !is_possible(y, r, 1, rows) || !is_possible(y, r, 2, planes))
      continue;
    const int are_thick = rows == 1 && y->axis[2].cells / planes >= THICK;
    const double surface = are_thick ? 0 : surface_of(y, rows, planes);
    if (!(surface < least)) continue;
    least = surface;
    y->parts[1] = rows;
    y->parts[2] = planes;
  }
  return isfinite(least);
}

static dvi_status refuse_parts(const dvi_yee_ranks *r, const dvi__yee *y)
{
  const int *parts = r->parts;
  char asked[128] = "";
  if (parts[0] > 0 || parts[1] > 0 || parts[2] > 0)
    (void)snprintf(asked, sizeof asked, " by %d x %d x %d parts, where 0 is any number,", parts[0],
                   parts[1], parts[2]);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "yee: %d x %d x %d boxes cannot be divided among %d processes%s so that each of "
                   "them has 2 boxes of y%s; run fewer processes",
                   y->axis[0].cells, y->axis[1].cells, y->axis[2].cells, r->count, asked,
                   y->axes > 2 ? " and of z" : "");
}

static dvi_status take_parts(const dvi_yee_ranks *r, dvi__yee *y)
{
  DVI_TRY(check_ranks(r));
  if (y->axes == 1 && r->count > 1)
    return dvi__fail(DVI_UNSUPPORTED,
                     "yee: a grid of one axis cannot be divided among %d processes; run it on one",
                     r->count);
  if (!choose_parts(r, y)) return refuse_parts(r, y);
  y->part[2] = (int)((int64_t)r->rank * y->parts[2] / r->count);
  y->part[1] = r->rank - y->part[2] * y->parts[1];
  return DVI_OK;
}

int dvi__yee_first_box(const dvi__yee *y, int axis, int part)
{
  return (int)((int64_t)y->axis[axis].cells * part / y->parts[axis]);
}

/* Find the own nodes of an axis, and the ghosts beside them. */
static void take_part(dvi__yee *y, int axis)
{
  const int part = y->part[axis], parts = y->parts[axis], around = y->axis[axis].wraps,
            ghosts = y->together > 1 && parts > 1 ? y->together : 0;
  y->own[axis][0] = dvi__yee_first_box(y, axis, part);
  y->own[axis][1] = part < parts - 1 ? dvi__yee_first_box(y, axis, part + 1) : y->axis[axis].nodes;
  y->ghosts[axis][0] = part > 0 || around ? ghosts : 0;
  y->ghosts[axis][1] = part < parts - 1 || around ? ghosts : 0;
  y->first[axis] = y->own[axis][0] - dvi__yee_margin(y, axis, 0);
  y->around[axis] = parts > 1 && around ? y->axis[axis].cells : 0;
}

dvi_status dvi__yee_divide(const dvi_yee_terms *terms, dvi__yee *y)
{
  const dvi_yee_ranks *r = terms->ranks;
  for (int l = 0; l < 3; l++) y->parts[l] = 1;
  if (r != NULL) DVI_TRY(take_parts(r, y));
  DVI_TRY(dvi__yee_choose_together(y, terms));
  for (int l = 0; l < 3; l++) take_part(y, l);
  return DVI_OK;
}
