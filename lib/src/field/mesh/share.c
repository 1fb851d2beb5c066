#include "field/mesh/share.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

void dvi__share_destroy(dvi__share *share)
{
  if (share == NULL) return;
  for (int k = 0; k < DVI__DEGREES; k++) {
    dvi__release(share->number[k]);
    dvi__release(share->owner[k]);
  }
  dvi__release(share);
}

int64_t dvi__whole_count(const dvi_mesh *mesh, int k)
{
  return mesh->share == NULL ? mesh->count[k] : mesh->share->total[k];
}

int64_t dvi__find_number(const dvi_mesh *mesh, int k, int64_t number)
{
  int64_t first = 0, last = mesh->count[k];
  if (mesh->share == NULL) return number;
  const int64_t *numbers = mesh->share->number[k];
  while (first < last) {
    const int64_t middle = first + (last - first) / 2;
    if (numbers[middle] < number)
      first = middle + 1;
    else
      last = middle;
  }
  return first < mesh->count[k] && numbers[first] == number ? first : -1;
}

static int compare_cells(const void *a, const void *b)
{
  const int first = *(const int *)a, second = *(const int *)b;
  return (first > second) - (first < second);
}

int dvi__is_outer(const dvi_mesh *mesh, int64_t facet)
{
  int64_t count;
  const int cell = (int)facet;
  if (mesh->coface[2 * facet + 1] >= 0) return 0;
  if (mesh->share == NULL) return 1;
  const int *boundary = dvi_mesh_part_cells(mesh, "boundary", mesh->n - 1, &count);
  return count > 0 && bsearch(&cell, boundary, (size_t)count, sizeof cell, compare_cells) != NULL;
}

/* ---- all processes ---- */

static dvi_status check_call(const dvi_ranks *ranks, int failed)
{
  if (failed == 0) return DVI_OK;
  return dvi__fail(DVI_CALLBACK_FAILED,
                   "mesh: process %d of %d could not speak with the others: code %d", ranks->rank,
                   ranks->count, failed);
}

dvi_status dvi__count_all(const dvi_mesh *mesh, int count, int64_t *number)
{
  const dvi__share *s = mesh->share;
  return s == NULL ? DVI_OK : check_call(&s->ranks, s->ranks.sum(count, number, s->ranks.user));
}

dvi_status dvi__largest_of_all(const dvi_mesh *mesh, int count, double *number)
{
  const dvi__share *s = mesh->share;
  return s == NULL ? DVI_OK : check_call(&s->ranks, s->ranks.largest(count, number, s->ranks.user));
}

dvi_status dvi__refresh(const dvi_mesh *mesh, int k, double *values)
{
  const dvi__share *s = mesh->share;
  return s == NULL ? DVI_OK : check_call(&s->ranks, s->ranks.refresh(k, values, s->ranks.user));
}

dvi_status dvi__agree_among(const dvi_ranks *ranks, dvi_status status)
{
  double extreme[2] = {status, -(double)status}; /* failures have numbers above or below 0 */
  const dvi_status reached = check_call(ranks, ranks->largest(2, extreme, ranks->user));
  if (reached != DVI_OK) return status != DVI_OK ? status : reached;
  const dvi_status agreed = (dvi_status)(extreme[1] > 0 ? -extreme[1] : extreme[0]);
  if (status != DVI_OK || agreed == DVI_OK) return agreed;
  return dvi__fail(agreed, "mesh: another one of %d processes failed, and its sentence tells why",
                   ranks->count);
}

dvi_status dvi__agree(const dvi_mesh *mesh, dvi_status status)
{
  return mesh->share == NULL ? status : dvi__agree_among(&mesh->share->ranks, status);
}

dvi_status dvi__sum_of_all(const dvi_mesh *mesh, dvi__accumulator *sum, double *value)
{
  if (mesh->share != NULL) {
    dvi__accumulator_carry(sum);
    DVI_TRY(dvi__count_all(mesh, DVI__SUM_NUMBERS, sum->number));
  }
  *value = dvi__accumulator_value(sum);
  return DVI_OK;
}

/* ---- rows of the whole mesh ---- */

/* Words that are put together at once, of rows that are not wider. */
enum { WORDS = 1 << 14 };

int64_t dvi__whole_room(int width)
{
  return width < WORDS ? WORDS : width;
}

/* A process adds the bits of its rows to the zeros of the others, so that their sum as integers is
 * exact, of -0 as well. */
dvi_status dvi__gather_rows(const dvi_mesh *mesh, const dvi__whole_rows *rows, int64_t *room,
                            void (*put)(void *to, int64_t count, const int64_t *word), void *to)
{
  const int64_t width = rows->width, most = dvi__whole_room(rows->width) / width;
  int64_t here = 0;
  for (int64_t first = 0; first < rows->total; first += most) {
    const int64_t count = rows->total - first < most ? rows->total - first : most;
    memset(room, 0, (size_t)(count * width) * sizeof *room);
    for (; here < rows->listed; here++) {
      const int64_t row = (rows->number != NULL ? rows->number[here] : here) - first;
      if (row >= count) break;
      rows->fill(rows->of, here, room + row * width);
    }
    DVI_TRY(dvi__count_all(mesh, (int)(count * width), room));
    put(to, count * width, room);
  }
  return DVI_OK;
}

/* ---- places ---- */

/* The owner of the first cell has it before all others there, and another process may have a later
 * one where cells meet without common vertices. */
dvi_status dvi__locate_first(const dvi_mesh *mesh, const double *at, double *place, int64_t *number)
{
  int cell = -1;
  const dvi_status status = dvi_mesh_locate(mesh, 1, at, &cell, place);
  const int64_t total = dvi__whole_count(mesh, mesh->n);
  double behind = cell >= 0 && dvi__owns(mesh, mesh->n, cell)
                      ? (double)(total - dvi__whole_number(mesh, mesh->n, cell))
                      : 0; /* the more the earlier the cell comes */
  DVI_TRY(dvi__agree(mesh, status));
  DVI_TRY(dvi__largest_of_all(mesh, 1, &behind));
  *number = behind > 0 ? total - (int64_t)behind : -1;
  return DVI_OK;
}

dvi_status dvi__check_owned(const dvi_mesh *mesh, int k, int64_t count, const int *cell)
{
  for (int64_t i = 0; i < count; i++)
    if (!dvi__owns(mesh, k, cell[i]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "mesh: %s is of process %d and not of this one, %d: ask for all cells",
                       dvi__name_cell(mesh, k, cell[i]).text, mesh->share->owner[k][cell[i]],
                       mesh->share->ranks.rank);
  return DVI_OK;
}

dvi_status dvi__refuse_share(const dvi_mesh *mesh, const char *what)
{
  return dvi__refuse_share_but(mesh, what, "");
}

dvi_status dvi__refuse_share_but(const dvi_mesh *mesh, const char *what, const char *remedy)
{
  if (mesh->share == NULL) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "%s needs a whole mesh, which %d processes share: take %s%s",
                   what, mesh->share->ranks.count, remedy,
                   remedy[0] != '\0' ? ", or one process" : "one process");
}
