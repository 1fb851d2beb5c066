/* What sources and waves do to few values of few rows. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/yee.h"

static dvi_status grow(dvi__yee_acts *acts)
{
  const int64_t capacity = 2 * acts->capacity + 64;
  int64_t *row = DVI_NEW(int64_t, capacity);
  dvi__yee_act *act = DVI_NEW(dvi__yee_act, capacity);
  if (row == NULL || act == NULL) {
    dvi__release(row);
    dvi__release(act);
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for sources on %lld cells",
                     (long long)acts->count);
  }
  if (acts->count > 0) {
    memcpy(row, acts->row, (size_t)acts->count * sizeof *row);
    memcpy(act, acts->act, (size_t)acts->count * sizeof *act);
  }
  dvi__yee_clear_acts(acts);
  acts->row = row;
  acts->act = act;
  acts->capacity = capacity;
  return DVI_OK;
}

/* Give the place of a value among the rows of its (j, k). */
static int32_t place_in_rows(const dvi__yee *y, int component, int i)
{
  return (int32_t)((size_t)y->slot[component] * y->width + DVI__YEE_LEFT) + i;
}

dvi_status dvi__yee_add_act(const dvi__yee *y, dvi__yee_acts *acts, int component, const int *place,
                            int from, double w0, double w1)
{
  if (acts->count == acts->capacity) DVI_TRY(grow(acts));
  acts->row[acts->count] = (int64_t)dvi__yee_row(y, place[1], place[2]);
  acts->act[acts->count++] = (dvi__yee_act){place_in_rows(y, component, place[0]), from, {w0, w1}};
  return DVI_OK;
}

/* An act with what orders it. Equal places keep their order. */
typedef struct ordered {
  int64_t row, number;
  dvi__yee_act act;
} ordered;

static int compare(const void *a, const void *b)
{
  const ordered *x = a, *y = b;
  if (x->row != y->row) return x->row < y->row ? -1 : 1;
  if (x->act.place != y->act.place) return x->act.place < y->act.place ? -1 : 1;
  return x->number < y->number ? -1 : 1;
}

dvi_status dvi__yee_sort_acts(const dvi__yee *y, dvi__yee_acts *acts)
{
  const size_t rows = y->rows[0] * y->rows[1], count = (size_t)acts->count;
  if (count == 0) return DVI_OK;
  ordered *all = DVI_NEW(ordered, count);
  int64_t *first = DVI_NEW(int64_t, rows + 1);
  if (all == NULL || first == NULL) {
    dvi__release(all);
    dvi__release(first);
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for sources on %zu cells", count);
  }
  for (size_t i = 0; i < count; i++) all[i] = (ordered){acts->row[i], (int64_t)i, acts->act[i]};
  qsort(all, count, sizeof *all, compare);
  for (size_t i = 0; i < count; i++) {
    first[all[i].row + 1] = (int64_t)i + 1;
    acts->act[i] = all[i].act;
  }
  for (size_t r = 0; r < rows; r++)
    if (first[r + 1] < first[r]) first[r + 1] = first[r];
  dvi__release(all);
  dvi__release(acts->row);
  acts->row = first;
  return DVI_OK;
}

void dvi__yee_clear_acts(dvi__yee_acts *acts)
{
  dvi__release(acts->row);
  dvi__release(acts->act);
}

/* Give the first of the acts first to last-1, which are sorted, at a place or behind it. */
static int64_t lower_bound(const dvi__yee_acts *acts, int64_t first, int64_t last, int32_t place)
{
  while (first < last) {
    const int64_t middle = first + (last - first) / 2;
    if (acts->act[middle].place < place)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

double dvi__yee_acted(const dvi__yee *y, const dvi__yee_acts *acts, int component, const int *place,
                      const double *drive)
{
  double sum = 0;
  if (acts->count == 0) return 0;
  const size_t row = dvi__yee_row(y, place[1], place[2]);
  const int32_t at = place_in_rows(y, component, place[0]);
  const int64_t last = acts->row[row + 1];
  for (int64_t n = lower_bound(acts, acts->row[row], last, at);
       n < last && acts->act[n].place == at; n++)
    sum += acts->act[n].w[0] * drive[acts->act[n].from] +
           acts->act[n].w[1] * drive[acts->act[n].from + 1];
  return sum;
}
