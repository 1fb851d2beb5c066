/* A grid whose last axis is divided among processes.
 *
 * Places keep their numbers of the whole grid, and so do the arrays of an axis. Rows are in memory
 * only for the own planes, and one more at both sides: below are B of the last boxes before, above
 * is E of the first nodes behind. A step takes B of the last own boxes first and gives it on, as
 * on an axis that repeats itself, and gives on E of the first nodes when it is done. So all values
 * come from the same operations as on one process. Sums over all processes are exact until they
 * are rounded once (num/accumulator.h).
 *
 * Where several steps go together, a process has as many planes of its neighbours, the ghosts.
 * Before the steps these come from their owners, once, and the process updates them along with its
 * own ones, one plane less on each side in each step, from the same values by the same
 * operations. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

struct dvi__yee_planes {
  dvi_yee_ranks ranks;
  int failed;                       /* what a function returned, 0 for success */
  int filled;                       /* ghosts that are as their owners have them, on each side */
  int has_layers;                   /* ghosts of some process are in layers across them */
  size_t across;                    /* rows of a plane */
  size_t sums;                      /* numbers of layers in a plane */
  double *sent, *received, *moment; /* [copies*3*across*width], the last for a moment */
};

static const char name[] = "xyz";

/* ---- division ---- */

/* Give the first box of a process. */
static int first_box(int cells, int rank, int count)
{
  return (int)((int64_t)cells * rank / count);
}

static dvi_status check_ranks(const dvi_yee_ranks *r)
{
  if (r->size != sizeof *r)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: set ranks.size to sizeof(dvi_yee_ranks)");
  if (r->count < 1 || r->rank < 0 || r->rank >= r->count)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: there is no process %d of %d", r->rank, r->count);
  if (r->pass == NULL || r->sum == NULL || r->largest == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: the functions by which processes speak are not all given");
  return DVI_OK;
}

dvi_status dvi__yee_divide(const dvi_yee_terms *terms, dvi__yee *y)
{
  const int last = y->axes - 1, cells = y->axis[last].cells;
  const dvi_yee_ranks *r = terms->ranks;
  y->divided = -1;
  for (int l = 0; l < 3; l++) {
    y->own[l][0] = 0;
    y->own[l][1] = y->axis[l].nodes;
  }
  if (r != NULL) DVI_TRY(check_ranks(r));
  if (r == NULL || r->count == 1) return dvi__yee_choose_together(y, terms, 1);
  if (last == 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "yee: a grid of one axis cannot be divided among %d processes; run it on one",
                     r->count);
  if (cells / 2 < r->count)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: axis %c has %d boxes, and %d processes need 2 each; run fewer processes",
                     name[last], cells, r->count);
  DVI_TRY(dvi__yee_choose_together(y, terms, r->count));
  y->divided = last;
  y->own[last][0] = first_box(cells, r->rank, r->count);
  if (r->rank < r->count - 1) y->own[last][1] = first_box(cells, r->rank + 1, r->count);
  const int ghosts = y->together > 1 ? y->together : 0, around = y->axis[last].wraps;
  y->ghosts[0] = r->rank > 0 || around ? ghosts : 0;
  y->ghosts[1] = r->rank < r->count - 1 || around ? ghosts : 0;
  return DVI_OK;
}

static size_t count_numbers(const dvi__yee *y)
{
  const size_t across = y->divided == 2 ? y->rows[0] : 1;
  return (size_t)y->copies * 3 * across * y->width;
}

/* Tell if layers along the divided axis reach to ghosts of any process. */
static int reach_to_ghosts(const dvi__yee *y, const dvi_yee_ranks *r)
{
  const dvi__yee_axis *a = &y->axis[y->divided];
  for (int rank = 1; rank < r->count; rank++)
    for (int e = 0; e < 2; e++) {
      const dvi__yee_layers *l = &a->layers[e];
      const int first = first_box(a->cells, rank, r->count), last = l->first + l->count - 1;
      if (l->count > 0 && l->first < first + y->together && last >= first - y->together) return 1;
    }
  return 0;
}

/* Count the numbers of sums of layers that a plane of ghosts has at most. */
static size_t count_sums(const dvi__yee *y, const dvi__yee_planes *p)
{
  size_t sums = p->has_layers ? p->across * y->width : 0;
  for (int e = 0; e < 2; e++) {
    sums += p->across * (size_t)y->axis[0].layers[e].width;
    if (y->divided == 2) sums += (size_t)y->axis[1].layers[e].count * y->width;
  }
  return DVI__YEE_DIFFERENCES * (size_t)y->copies * sums;
}

dvi_status dvi__yee_make_planes(const dvi_yee_terms *terms, dvi__yee *y)
{
  if (y->divided < 0) return DVI_OK;
  size_t count = count_numbers(y);
  y->planes = DVI_NEW(dvi__yee_planes, 1);
  if (y->planes != NULL) {
    y->planes->ranks = *terms->ranks;
    y->planes->across = y->divided == 2 ? y->rows[0] : 1;
    y->planes->has_layers = reach_to_ghosts(y, terms->ranks);
    y->planes->sums = count_sums(y, y->planes);
    if (y->together > 1 && count < (size_t)y->together * y->planes->sums)
      count = (size_t)y->together * y->planes->sums;
    y->planes->sent = DVI_NEW(double, count);
    y->planes->received = DVI_NEW(double, count);
    y->planes->moment = DVI_NEW(double, count);
  }
  if (y->planes != NULL && y->planes->sent != NULL && y->planes->received != NULL &&
      y->planes->moment != NULL)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "yee: no memory for planes of %zu numbers", count);
}

void dvi__yee_clear_planes(dvi__yee *y)
{
  if (y->planes == NULL) return;
  dvi__release(y->planes->sent);
  dvi__release(y->planes->received);
  dvi__release(y->planes->moment);
  dvi__release(y->planes);
}

/* ---- failures ---- */

int dvi__yee_processes(const dvi__yee *y)
{
  return y->planes != NULL ? y->planes->ranks.count : 1;
}

dvi_status dvi__yee_check_ranks(const dvi__yee *y)
{
  if (y->planes == NULL || y->planes->failed == 0) return DVI_OK;
  return dvi__fail(DVI_CALLBACK_FAILED,
                   "yee: process %d of %d could not speak with the others: code %d",
                   y->planes->ranks.rank, y->planes->ranks.count, y->planes->failed);
}

int dvi__yee_begin_ranks(const dvi__yee *y)
{
  const int failed = y->planes != NULL ? y->planes->failed : 0;
  if (y->planes != NULL) y->planes->failed = 0;
  return failed;
}

void dvi__yee_lose_ranks(const dvi__yee *y, int failure)
{
  if (failure != 0) y->planes->failed = failure;
}

dvi_status dvi__yee_agree(const dvi__yee *y, dvi_status status)
{
  double extreme[2] = {status, -(double)status}; /* failures have numbers above or below 0 */
  if (y->planes == NULL) return status;
  dvi__yee_largest_of_all(y, 2, extreme);
  const dvi_status reached = dvi__yee_check_ranks(y);
  if (reached != DVI_OK) return status != DVI_OK ? status : reached;
  const dvi_status agreed = (dvi_status)(extreme[1] > 0 ? -extreme[1] : extreme[0]);
  if (status != DVI_OK || agreed == DVI_OK) return agreed;
  return dvi__fail(agreed, "yee: another one of %d processes failed, whose sentence tells why",
                   y->planes->ranks.count);
}

dvi_status dvi__yee_agree_anew(const void *self, dvi_status status)
{
  const dvi__yee *y = self;
  const int lost = dvi__yee_begin_ranks(y);
  status = dvi__yee_agree(y, status);
  dvi__yee_lose_ranks(y, lost);
  return status;
}

/* ---- sums ---- */

void dvi__yee_largest_of_all(const dvi__yee *y, int count, double *number)
{
  dvi__yee_planes *p = y->planes;
  if (p != NULL && p->failed == 0) p->failed = p->ranks.largest(count, number, p->ranks.user);
}

void dvi__yee_add_all(const dvi__yee *y, int count, int64_t *number)
{
  dvi__yee_planes *p = y->planes;
  if (p != NULL && p->failed == 0) p->failed = p->ranks.sum(count, number, p->ranks.user);
}

/* Halves of numbers do not overflow. */
uint64_t dvi__yee_sum_modulo(const dvi__yee *y, uint64_t number)
{
  int64_t half[2] = {(int64_t)(number & UINT32_MAX), (int64_t)(number >> 32)};
  dvi__yee_add_all(y, 2, half);
  return (uint64_t)half[0] + ((uint64_t)half[1] << 32);
}

double dvi__yee_sum_of_all(const dvi__yee *y, dvi__accumulator *sum)
{
  if (y->planes != NULL) {
    dvi__accumulator_carry(sum);
    dvi__yee_add_all(y, DVI__SUM_NUMBERS, sum->number);
  }
  return dvi__accumulator_value(sum);
}

/* ---- planes ---- */

/* Send the first `count` numbers for each copy. Return 0 if there is no process to receive from. */
static int send(const dvi__yee *y, int way, size_t count, double *received)
{
  dvi__yee_planes *p = y->planes;
  const dvi_yee_ranks *r = &p->ranks;
  const int around = y->axis[y->divided].wraps, from = r->rank - way;
  if (p->failed != 0) return 0;
  p->failed = r->pass(way, around, (int64_t)count * y->copies, p->sent, received, r->user);
  return p->failed == 0 && (around || (from >= 0 && from < r->count));
}

/* Multiply what has come around the end of an axis by its phase, as row.c does. */
static void turn(const dvi__yee *y, int way, size_t count, double *x)
{
  const dvi__yee_axis *a = &y->axis[y->divided];
  const int from = y->planes->ranks.rank - way;
  if (y->copies == 1 || (from >= 0 && from < y->planes->ranks.count)) return;
  const double sine = way > 0 ? -a->sine : a->sine;
  for (size_t i = 0; i < count; i++) {
    const double re = x[i], im = x[count + i];
    x[i] = a->cosine * re - sine * im;
    x[count + i] = a->cosine * im + sine * re;
  }
}

/* Copy a plane of the components of a form, those along the divided axis or the others, to a buffer
 * or from it. Give the numbers of a copy. */
static size_t copy_plane(const dvi__yee *y, int form, int along, int plane, double *buffer,
                         int takes)
{
  const size_t across = y->planes->across, row = dvi__yee_row_along(y, y->divided, plane) * across,
               block = (size_t)y->components * y->width, bytes = y->width * sizeof(double);
  size_t at = 0;
  for (int copy = 0; copy < y->copies; copy++)
    for (int c = form; c < form + 3; c++) {
      if (y->slot[c] < 0 || (c % 3 == y->divided) != along) continue;
      for (size_t j = 0; j < across; j++, at += y->width) {
        double *x = y->state[copy] + (row + j) * block + (size_t)y->slot[c] * y->width;
        memcpy(takes ? x : buffer + at, takes ? buffer + at : x, bytes);
      }
    }
  return at / (size_t)y->copies;
}

static void pass(const dvi__yee *y, int form, int along, int way, int from, int to)
{
  if (y->planes == NULL || y->planes->failed != 0) return;
  const size_t count = copy_plane(y, form, along, from, y->planes->sent, 0);
  if (!send(y, way, count, y->planes->received)) return;
  turn(y, way, count, y->planes->received);
  (void)copy_plane(y, form, along, to, y->planes->received, 1);
}

void dvi__yee_pass_faces(const dvi__yee *y)
{
  if (y->divided < 0) return;
  pass(y, DVI__YEE_B, 0, 1, dvi__yee_last_boxes(y), dvi__yee_begin(y, y->divided) - 1);
}

void dvi__yee_pass_edges(const dvi__yee *y)
{
  if (y->divided < 0) return;
  pass(y, DVI__YEE_E, 0, -1, dvi__yee_begin(y, y->divided), y->own[y->divided][1]);
}

void dvi__yee_pass_faces_back(const dvi__yee *y)
{
  if (y->divided < 0) return;
  pass(y, DVI__YEE_B, 1, -1, dvi__yee_begin(y, y->divided), y->own[y->divided][1]);
}

/* ---- ghosts ---- */

/* Copy sums of layers in a plane of ghosts, or one that others have as such, to a buffer or from
 * it. */
static void copy_sums(const dvi__yee *y, int plane, double *buffer, int takes)
{
  const int j = y->divided == 2 ? -1 : plane, k = y->divided == 2 ? plane : 0;
  for (int axis = 0; axis < 3; axis++)
    for (int e = 0; e < 2; e++) {
      const dvi__yee_layers *l = &y->axis[axis].layers[e];
      const int layer = axis == y->divided ? plane - l->first : 0;
      if (l->count == 0 || layer < 0 || layer >= l->count) continue;
      for (int copy = 0; copy < y->copies; copy++)
        buffer += dvi__yee_copy_sums(y, axis, e, copy, layer, j, k, buffer, takes);
    }
}

/* Give the numbers of planes from a place on, which are beside the own ones. */
static double *planes_at(const dvi__yee *y, int copy, int place)
{
  const int l = y->divided, row = place - y->own[l][0] + dvi__yee_margin(y, l, 0);
  return y->state[copy] + (size_t)row * y->planes->across * (size_t)y->components * y->width;
}

/* Give planes to a neighbour, from a place on, and receive those at another place. Where there is
 * no neighbour nothing is sent, or received. */
static void pass_ghosts(const dvi__yee *y, int way, int planes, int from, int to)
{
  dvi__yee_planes *p = y->planes;
  const dvi_yee_ranks *r = &p->ranks;
  const int around = y->axis[y->divided].wraps, sends = y->ghosts[way > 0] > 0,
            receives = y->ghosts[way < 0] > 0;
  const int64_t count = (int64_t)(p->across * (size_t)y->components * y->width) * planes,
                sums = (int64_t)p->sums * planes;
  for (int copy = 0; copy < y->copies && p->failed == 0; copy++)
    p->failed = r->pass(way, around, count, planes_at(y, copy, from),
                        receives ? planes_at(y, copy, to) : p->received, r->user);
  if (sums == 0 || p->failed != 0) return;
  for (int i = 0; i < planes && sends; i++)
    copy_sums(y, dvi__yee_around(y, y->divided, from + i), p->sent + p->sums * (size_t)i, 0);
  p->failed = r->pass(way, around, sums, p->sent, p->received, r->user);
  for (int i = 0; i < planes && receives && p->failed == 0; i++)
    copy_sums(y, dvi__yee_around(y, y->divided, to + i), p->received + p->sums * (size_t)i, 1);
}

void dvi__yee_fill_ghosts(const dvi__yee *y, int planes)
{
  if (y->ghosts[0] + y->ghosts[1] == 0 || y->planes->filled >= planes) return;
  const int *own = y->own[y->divided];
  pass_ghosts(y, 1, planes, own[1] - planes, own[0] - planes);
  pass_ghosts(y, -1, planes, own[0], own[1]);
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

size_t dvi__yee_at_plane(const dvi__yee *y, int component, int copy, const int *place)
{
  const size_t number = 3 * (size_t)copy + (size_t)component % 3,
               row = y->divided == 2 ? dvi__yee_row_along(y, 1, place[1]) : 0;
  return (number * y->planes->across + row) * y->width + DVI__YEE_LEFT + (size_t)place[0];
}

const double *dvi__yee_pass_plane(const dvi__yee *y, int is_moment)
{
  const size_t count = count_numbers(y) / (size_t)y->copies;
  double *received = is_moment ? y->planes->moment : y->planes->received;
  if (send(y, 1, count, received) && is_moment) turn(y, 1, count, received);
  return received;
}
