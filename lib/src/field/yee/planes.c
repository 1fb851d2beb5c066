/* A grid that is divided among processes.
 *
 * Places keep their numbers of the whole grid, and so do the arrays of an axis. Rows are in memory
 * only for the own planes of an axis, and one more at both sides: below are B of the last boxes
 * before, above is E of the first nodes behind. A step takes B of the last own boxes first and
 * gives it on, as on an axis that repeats itself, and gives on E of the first nodes when it is
 * done. So all values come from the same operations as on one process. None of them needs a row
 * that is beside the own ones along two axes. Sums over all processes are exact until they are
 * rounded once (num/accumulator.h).
 *
 * Where several steps go together, a process has as many planes of its neighbours, the ghosts.
 * Before the steps these come from their owners, once, and the process updates them along with its
 * own ones, one plane less on each side in each step, from the same values by the same operations.
 * Ghosts along z have those along y at their ends, which the neighbour has got before, so that rows
 * beside the own ones along two axes need no message of their own. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

/* ---- sizes ---- */

/* Give the rows of a plane across an axis, with those beside the own ones. */
static size_t rows_across(const dvi__yee *y, int axis)
{
  return y->rows[2 - axis];
}

/* Give the numbers of planes that are sent one by one, of all components of a form. */
static size_t count_numbers(const dvi__yee *y, int axis)
{
  return (size_t)y->copies * 3 * rows_across(y, axis) * y->width;
}

/* Ghosts that lie across an axis in memory, in blocks of numbers that follow each other. */
typedef struct ghost_blocks {
  size_t count, size, stride;
} ghost_blocks;

static ghost_blocks blocks_of(const dvi__yee *y, int axis, int planes)
{
  const size_t row = (size_t)y->components * y->width, plane = y->rows[0] * row;
  if (axis == 2) return (ghost_blocks){1, (size_t)planes * plane, 0};
  return (ghost_blocks){(size_t)(y->own[2][1] - y->own[2][0]), (size_t)planes * row, plane};
}

/* Give the ghosts that planes across an axis have along the other one: for z those along y. */
static void range_across(const dvi__yee *y, int axis, int planes, int *range)
{
  dvi__yee_reach(y, 3 - axis, 0, axis == 2 ? planes : 0, range);
}

static int is_in_layers(const dvi__yee_axis *a, int i)
{
  int found = 0;
  for (int e = 0; e < 2; e++)
    found |= i >= a->layers[e].first && i < a->layers[e].first + a->layers[e].count;
  return found;
}

/* Count the numbers of sums of layers that planes of ghosts have at most. All processes along the
 * axis count the same. */
static size_t count_sums(const dvi__yee *y, int axis, int planes)
{
  const dvi__yee_layers *ends = y->axis[0].layers;
  size_t sums = 0;
  int range[2];
  range_across(y, axis, planes, range);
  for (int i = range[0]; i < range[1]; i++) {
    sums += (size_t)(ends[0].width + ends[1].width);
    if (y->planes->has_layers[axis]) sums += y->width;
    if (is_in_layers(&y->axis[3 - axis], dvi__yee_around(y, 3 - axis, i))) sums += y->width;
  }
  return DVI__YEE_DIFFERENCES * (size_t)y->copies * sums * (size_t)planes;
}

/* ---- memory ---- */

/* Tell if layers of an axis reach to ghosts of any process along it. */
static int reach_to_ghosts(const dvi__yee *y, int axis)
{
  for (int part = 1; part < y->parts[axis]; part++)
    for (int e = 0; e < 2; e++) {
      const dvi__yee_layers *l = &y->axis[axis].layers[e];
      const int first = dvi__yee_first_box(y, axis, part), last = l->first + l->count - 1;
      if (l->count > 0 && l->first < first + y->together && last >= first - y->together) return 1;
    }
  return 0;
}

/* Count the most numbers that go across an axis from memory of their own. */
static size_t count_passed(const dvi__yee *y, int axis)
{
  const size_t one = count_numbers(y, axis);
  if (y->together == 1) return one;
  const ghost_blocks b = blocks_of(y, axis, y->together);
  const size_t packed = b.count > 1 ? b.count * b.size : 0, sums = count_sums(y, axis, y->together),
               many = packed > sums ? packed : sums;
  return one > many ? one : many;
}

/* Make room for what goes across an axis. *most is the largest number until then. */
static dvi_status make_room(const dvi__yee *y, int axis, size_t *most)
{
  dvi__yee_planes *p = y->planes;
  p->has_layers[axis] = reach_to_ghosts(y, axis);
  const size_t count = count_passed(y, axis);
  p->received[axis] = DVI_NEW(double, count);
  p->moment[axis] = DVI_NEW(double, count_numbers(y, axis));
  if (count > *most) *most = count;
  if (p->received[axis] != NULL && p->moment[axis] != NULL) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "yee: no memory for planes of %zu numbers", count);
}

dvi_status dvi__yee_make_planes(const dvi_yee_terms *terms, dvi__yee *y)
{
  size_t most = 0;
  if (terms->ranks == NULL || terms->ranks->count == 1) return DVI_OK;
  y->planes = DVI_NEW(dvi__yee_planes, 1);
  if (y->planes == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for other processes");
  y->planes->ranks = *terms->ranks;
  for (int axis = 1; axis < 3; axis++)
    if (dvi__yee_is_divided(y, axis)) DVI_TRY(make_room(y, axis, &most));
  y->planes->sent = DVI_NEW(double, most);
  if (y->planes->sent != NULL) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "yee: no memory for planes of %zu numbers", most);
}

void dvi__yee_clear_planes(dvi__yee *y)
{
  if (y->planes == NULL) return;
  for (int axis = 0; axis < 3; axis++) {
    dvi__release(y->planes->received[axis]);
    dvi__release(y->planes->moment[axis]);
  }
  dvi__release(y->planes->sent);
  dvi__release(y->planes);
}

/* ---- neighbours ---- */

/* Give the process that is before (-1) or after this one along an axis, or -1. */
static int neighbour(const dvi__yee *y, int axis, int way)
{
  const int parts = y->parts[axis], at = y->part[axis] + way, stride = axis == 2 ? y->parts[1] : 1;
  if ((at < 0 || at >= parts) && !y->axis[axis].wraps) return -1;
  return y->planes->ranks.rank + ((at + parts) % parts - y->part[axis]) * stride;
}

/* Send numbers [count] along an axis, and receive as many. Return 0 if none have come. */
static int send(const dvi__yee *y, int axis, int way, size_t count, const double *sent,
                double *received)
{
  dvi__yee_planes *p = y->planes;
  const int from = neighbour(y, axis, -way);
  if (p->failed != 0) return 0;
  p->failed = p->ranks.pass(neighbour(y, axis, way), from, (int64_t)count, sent, received,
                            p->ranks.user);
  return p->failed == 0 && from >= 0;
}

/* ---- planes ---- */

/* Multiply what has come around the end of an axis by its phase, as row.c does. */
static void turn(const dvi__yee *y, int axis, int way, size_t count, double *x)
{
  const dvi__yee_axis *a = &y->axis[axis];
  if (y->copies == 1 || y->part[axis] != (way > 0 ? 0 : y->parts[axis] - 1)) return;
  const double sine = way > 0 ? -a->sine : a->sine;
  for (size_t i = 0; i < count; i++) {
    const double re = x[i], im = x[count + i];
    x[i] = a->cosine * re - sine * im;
    x[count + i] = a->cosine * im + sine * re;
  }
}

/* Copy a plane of the components of a form, those along the axis that it is across or the others,
 * to a buffer or from it. Give the numbers of a copy. */
static size_t copy_plane(const dvi__yee *y, int axis, int form, int along, int plane,
                         double *buffer, int takes)
{
  const size_t across = rows_across(y, axis), stride = axis == 2 ? 1 : y->rows[0],
               row = dvi__yee_row_along(y, axis, plane) * (axis == 2 ? y->rows[0] : 1),
               block = (size_t)y->components * y->width, bytes = y->width * sizeof(double);
  size_t at = 0;
  for (int copy = 0; copy < y->copies; copy++)
    for (int c = form; c < form + 3; c++) {
      if (y->slot[c] < 0 || (c % 3 == axis) != along) continue;
      for (size_t j = 0; j < across; j++, at += y->width) {
        double *x = y->state[copy] + (row + j * stride) * block + (size_t)y->slot[c] * y->width;
        memcpy(takes ? x : buffer + at, takes ? buffer + at : x, bytes);
      }
    }
  return at / (size_t)y->copies;
}

static void pass(const dvi__yee *y, int axis, int form, int along, int way, int from, int to)
{
  dvi__yee_planes *p = y->planes;
  if (p->failed != 0) return;
  const size_t count = copy_plane(y, axis, form, along, from, p->sent, 0);
  if (!send(y, axis, way, count * (size_t)y->copies, p->sent, p->received[axis])) return;
  turn(y, axis, way, count, p->received[axis]);
  (void)copy_plane(y, axis, form, along, to, p->received[axis], 1);
}

void dvi__yee_pass_faces(const dvi__yee *y)
{
  for (int axis = 1; axis < 3; axis++)
    if (dvi__yee_is_divided(y, axis))
      pass(y, axis, DVI__YEE_B, 0, 1, dvi__yee_last_boxes(y, axis), y->own[axis][0] - 1);
}

void dvi__yee_pass_edges(const dvi__yee *y)
{
  for (int axis = 1; axis < 3; axis++)
    if (dvi__yee_is_divided(y, axis))
      pass(y, axis, DVI__YEE_E, 0, -1, y->own[axis][0], y->own[axis][1]);
}

void dvi__yee_pass_faces_back(const dvi__yee *y)
{
  for (int axis = 1; axis < 3; axis++)
    if (dvi__yee_is_divided(y, axis))
      pass(y, axis, DVI__YEE_B, 1, -1, y->own[axis][0], y->own[axis][1]);
}

/* ---- ghosts ---- */

/* Give where planes from a place on begin, which are beside the own ones of the other axis. */
static double *planes_at(const dvi__yee *y, int axis, int copy, int place)
{
  const int first = place - y->first[axis];
  const size_t below = (size_t)dvi__yee_margin(y, 2, 0), row = (size_t)first,
               before = axis == 1 ? below * y->rows[0] + row : row * y->rows[0];
  return y->state[copy] + before * (size_t)y->components * y->width;
}

static void pack(const ghost_blocks *b, double *planes, double *buffer, int takes)
{
  for (size_t i = 0; i < b->count; i++, planes += b->stride, buffer += b->size)
    memcpy(takes ? planes : buffer, takes ? buffer : planes, b->size * sizeof *buffer);
}

/* Give planes to a neighbour, from a place on, and receive those at another place. What is one
 * block goes from where it is, and comes to where it will be. */
static void pass_fields(const dvi__yee *y, int axis, int way, int planes, int from, int to)
{
  dvi__yee_planes *p = y->planes;
  const ghost_blocks b = blocks_of(y, axis, planes);
  const int receives = y->ghosts[axis][way < 0] > 0;
  for (int copy = 0; copy < y->copies; copy++) {
    double *sent = planes_at(y, axis, copy, from),
           *received = receives ? planes_at(y, axis, copy, to) : p->received[axis];
    if (b.count == 1)
      (void)send(y, axis, way, b.size, sent, received);
    else {
      pack(&b, sent, p->sent, 0);
      if (send(y, axis, way, b.count * b.size, p->sent, p->received[axis]))
        pack(&b, received, p->received[axis], 1);
    }
  }
}

/* Copy sums of layers of planes of ghosts, or of those that others have as such, to a buffer or
 * from it. */
static void copy_sums(const dvi__yee *y, int axis, int planes, int first, double *buffer, int takes)
{
  int range[3][2] = {{0, 0}, {first, first + planes}, {first, first + planes}};
  range_across(y, axis, planes, range[3 - axis]);
  for (int k = range[2][0]; k < range[2][1]; k++)
    for (int j = range[1][0]; j < range[1][1]; j++)
      buffer += dvi__yee_copy_sums(y, dvi__yee_around(y, 1, j), dvi__yee_around(y, 2, k), buffer,
                                   takes);
}

static int has_sums(const dvi__yee *y, int axis)
{
  const dvi__yee_layers *ends = y->axis[0].layers, *others = y->axis[3 - axis].layers;
  return ends[0].count + ends[1].count + others[0].count + others[1].count +
             y->planes->has_layers[axis] >
         0;
}

static void pass_sums(const dvi__yee *y, int axis, int way, int planes, int from, int to)
{
  dvi__yee_planes *p = y->planes;
  if (!has_sums(y, axis)) return;
  if (y->ghosts[axis][way > 0] > 0) copy_sums(y, axis, planes, from, p->sent, 0);
  if (send(y, axis, way, count_sums(y, axis, planes), p->sent, p->received[axis]))
    copy_sums(y, axis, planes, to, p->received[axis], 1);
}

void dvi__yee_fill_ghosts(const dvi__yee *y, int planes)
{
  if (y->planes == NULL || y->together == 1 || y->planes->filled >= planes) return;
  for (int axis = 1; axis < 3; axis++) {
    const int *own = y->own[axis];
    if (!dvi__yee_is_divided(y, axis)) continue;
    pass_fields(y, axis, 1, planes, own[1] - planes, own[0] - planes);
    pass_sums(y, axis, 1, planes, own[1] - planes, own[0] - planes);
    pass_fields(y, axis, -1, planes, own[0], own[1]);
    pass_sums(y, axis, -1, planes, own[0], own[1]);
  }
  y->planes->filled = planes;
}

void dvi__yee_spoil_ghosts(const dvi__yee *y)
{
  if (y->planes != NULL) y->planes->filled = 0;
}

/* ---- other numbers of planes ---- */

double *dvi__yee_plane_sent(const dvi__yee *y)
{
  return y->planes->sent;
}

size_t dvi__yee_at_plane(const dvi__yee *y, int axis, int component, int copy, const int *place)
{
  const size_t number = 3 * (size_t)copy + (size_t)component % 3,
               row = dvi__yee_row_along(y, 3 - axis, place[3 - axis]);
  return (number * rows_across(y, axis) + row) * y->width + DVI__YEE_LEFT + (size_t)place[0];
}

const double *dvi__yee_pass_plane(const dvi__yee *y, int axis, int is_moment)
{
  const size_t count = count_numbers(y, axis);
  double *received = is_moment ? y->planes->moment[axis] : y->planes->received[axis];
  if (send(y, axis, 1, count, y->planes->sent, received) && is_moment)
    turn(y, axis, 1, count / (size_t)y->copies, received);
  return received;
}
