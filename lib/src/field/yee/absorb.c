/* First-order absorbing ends. A wave that leaves along the axis has E' = -+v B' for the E along the
 * end and the B across it, with the speed v, and so takes power out of the grid whatever comes.
 * B' is the curl of E. At the middle of the last box, of length h, and of a step this is
 *
 *     E0+ = E1 + b (E1+ - E0) -+ v dt/(v dt + h) (T+ + T),   b = (v dt - h)/(v dt + h),
 *
 * with E1 one box inside, and the difference T along E of the edges through the box, which point
 * along the axis. Without T this is Mur's condition (Mur 1981, eq. 15), which does the same to
 * waves of empty space, but gives power to those that vanish before the end. They grow then if a
 * material inside holds them. In boxes beside another absorbing end T is left out, for it would
 * need an edge there, which needs E0 itself, and in absorbing layers, which stretch it. The rows on
 * ends of x come first, then those of y, then those of z, which take E1 and T from rows that are
 * done. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/yee.h"

static int is_absorbing(const dvi__yee *y, int axis, int end)
{
  return y->axis[axis].end[end].kind == DVI_YEE_ABSORBING;
}

int dvi__yee_absorbs(const dvi__yee *y)
{
  return y->absorbed != NULL;
}

/* Materials have no copies behind the end of an axis that repeats itself. */
static void move_inside(const dvi__yee *y, const int *place, int *inside)
{
  for (int l = 0; l < 3; l++)
    inside[l] = y->axis[l].wraps && place[l] == y->axis[l].cells ? 0 : place[l];
}

/* The speed is that of eps on the edge, and of mu on the face between it and the edge inside. */
double dvi__yee_courant(const dvi__yee *y, int c, int axis, int end, const int *place)
{
  const dvi__yee_axis *a = &y->axis[axis];
  int at[3];
  move_inside(y, place, at);
  const double over_eps = dvi__yee_over_eps(y, c, at);
  at[axis] = end == 0 ? 0 : a->cells - 1;
  return sqrt(over_eps * dvi__yee_over_mu(y, 3 - axis - c, at)) * y->dt / a->length[at[axis]];
}

int dvi__yee_has_difference(const dvi__yee *y, int c, int axis, const int *place)
{
  const dvi__yee_axis *along = &y->axis[c];
  const int first = along->layers[0].count + is_absorbing(y, c, 0),
            last = along->cells - along->layers[1].count - is_absorbing(y, c, 1);
  return y->slot[axis] >= 0 && !along->is_trivial && place[c] >= first && place[c] < last;
}

/* ---- what is kept ---- */

/* E1, T, b, and -+v dt/(v dt + h). The first two change, the others are made once. */
enum { INSIDE, DIFFERENCE, FACTOR, PART, KEPT };

/* A row across an end, or of one value at an end of x, is kept for each component and end. */
static size_t kept_at(const dvi__yee *y, int what, int axis, int end, int copy, int c, int j, int k)
{
  const size_t row = dvi__yee_row(y, j, k), left = row % y->rows[0], below = row / y->rows[0],
               rows = y->rows[0] * y->rows[1],
               across = axis == 0   ? row
                        : axis == 1 ? rows + below * y->width
                                    : rows + (y->rows[1] + left) * y->width,
               all = rows + (y->rows[0] + y->rows[1]) * y->width;
  return ((((size_t)copy * KEPT + (size_t)what) * 3 + (size_t)c) * 2 + (size_t)end) * all + across;
}

/* ---- rows ---- */

typedef void row_work(dvi__yee *y, int axis, int end, int copy, int c, int j, int k);

/* Tell if rows at node i are neither on an end of an axis nor behind it. */
static int is_within(const dvi__yee *y, int c, int axis, int i)
{
  const int is_copy = c != axis && y->axis[axis].wraps && i == y->axis[axis].cells;
  return is_copy || dvi__yee_is_free(y, c, axis, i);
}

/* Work on the rows of a component that are on an end of an axis. */
static void for_rows_of(dvi__yee *y, int axis, int end, int c, row_work *work)
{
  const int last[2] = {y->axis[1].is_trivial ? 0 : y->axis[1].cells,
                       y->axis[2].is_trivial ? 0 : y->axis[2].cells};
  const int at = end == 0 ? 0 : y->axis[axis].cells;
  for (int k = axis == 2 ? at : 0; k <= (axis == 2 ? at : last[1]); k++)
    for (int j = axis == 1 ? at : 0; j <= (axis == 1 ? at : last[0]); j++) {
      if (axis < 2 && !is_within(y, c, 2, k)) continue;
      if (axis < 1 && !is_within(y, c, 1, j)) continue;
      for (int copy = 0; copy < y->copies; copy++) work(y, axis, end, copy, c, j, k);
    }
}

static void for_rows(dvi__yee *y, row_work *work)
{
  for (int axis = 0; axis < y->axes; axis++)
    for (int end = 0; end < 2; end++)
      for (int c = 0; c < 3 && is_absorbing(y, axis, end); c++)
        if (c != axis && y->slot[c] >= 0) for_rows_of(y, axis, end, c, work);
}

/* A row on an end, from its first value on. */
typedef struct end_row {
  int c, axis, place[3];
  size_t count;
  double *E;
  ptrdiff_t inwards;     /* the step to the value inside */
  const double *through; /* the edge through the box, if there is such a component */
  ptrdiff_t next;        /* the step to the edge whose difference with it is T */
} end_row;

static end_row row_on_end(dvi__yee *y, int axis, int end, int copy, int c, int j, int k)
{
  const int cells = y->axis[axis].cells, box = end == 0 ? 0 : cells - 1;
  end_row row = {.c = c,
                 .axis = axis,
                 .place = {axis == 0 && end == 1 ? cells : 0, j, k},
                 .count = axis == 0 ? 1 : (size_t)y->axis[0].cells + (c != 0),
                 .inwards = end == 0 ? y->next[axis] : -y->next[axis],
                 .next = y->next[c]};
  row.E = y->state[copy] + dvi__yee_at(y, c, j, k) + row.place[0];
  if (y->slot[axis] >= 0)
    row.through = y->state[copy] + (axis == 0 ? box : 0) +
                  dvi__yee_at(y, axis, axis == 1 ? box : j, axis == 2 ? box : k);
  return row;
}

/* Give T at the value i of a row. */
static double difference_at(const dvi__yee *y, const end_row *row, size_t i)
{
  const int place[3] = {row->place[0] + (int)i, row->place[1], row->place[2]};
  return dvi__yee_has_difference(y, row->c, row->axis, place)
             ? row->through[(ptrdiff_t)i + row->next] - row->through[i]
             : 0;
}

static void keep_row(dvi__yee *y, int axis, int end, int copy, int c, int j, int k)
{
  const end_row row = row_on_end(y, axis, end, copy, c, j, k);
  double *inside = y->absorbed + kept_at(y, INSIDE, axis, end, copy, c, j, k),
         *difference = y->absorbed + kept_at(y, DIFFERENCE, axis, end, copy, c, j, k);
  for (size_t i = 0; i < row.count; i++) {
    inside[i] = row.E[(ptrdiff_t)i + row.inwards];
    difference[i] = difference_at(y, &row, i);
  }
}

static void set_factors(dvi__yee *y, int axis, int end, int copy, int c, int j, int k)
{
  const end_row row = row_on_end(y, axis, end, copy, c, j, k);
  double *factor = y->absorbed + kept_at(y, FACTOR, axis, end, copy, c, j, k),
         *part = y->absorbed + kept_at(y, PART, axis, end, copy, c, j, k);
  for (size_t i = 0; i < row.count; i++) {
    const int place[3] = {row.place[0] + (int)i, j, k};
    const double courant = dvi__yee_courant(y, c, axis, end, place);
    factor[i] = (courant - 1) / (courant + 1);
    part[i] = (end == 0 ? -courant : courant) / (courant + 1);
  }
}

static void absorb_row(dvi__yee *y, int axis, int end, int copy, int c, int j, int k)
{
  const end_row row = row_on_end(y, axis, end, copy, c, j, k);
  const double *inside = y->absorbed + kept_at(y, INSIDE, axis, end, copy, c, j, k),
               *difference = y->absorbed + kept_at(y, DIFFERENCE, axis, end, copy, c, j, k),
               *factor = y->absorbed + kept_at(y, FACTOR, axis, end, copy, c, j, k),
               *part = y->absorbed + kept_at(y, PART, axis, end, copy, c, j, k);
  for (size_t i = 0; i < row.count; i++)
    row.E[i] = inside[i] + factor[i] * (row.E[(ptrdiff_t)i + row.inwards] - row.E[i]) +
               part[i] * (difference[i] + difference_at(y, &row, i));
}

dvi_status dvi__yee_make_absorbed(dvi__yee *y)
{
  int count = 0;
  for (int l = 0; l < y->axes; l++) count += is_absorbing(y, l, 0) + is_absorbing(y, l, 1);
  if (count == 0) return DVI_OK;
  const size_t all = y->rows[0] * y->rows[1] + (y->rows[0] + y->rows[1]) * y->width;
  y->absorbed = DVI_NEW(double, (size_t)y->copies *KEPT * 6 * all);
  if (y->absorbed == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for absorbing ends");
  for_rows(y, set_factors);
  return DVI_OK;
}

void dvi__yee_keep_absorbed(dvi__yee *y)
{
  for_rows(y, keep_row);
}

void dvi__yee_absorb(dvi__yee *y)
{
  for_rows(y, absorb_row);
}
