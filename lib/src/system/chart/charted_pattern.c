/* Patterns of the Lagrangian in the charts: slots whose stored coordinates meet in a matrix have
 * full blocks. */
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/chart/charted_struct.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for patterns");
}

/* The slot of every stored coordinate, and of every chart coordinate. */
static dvi_status find_cells(dvi__charted *x)
{
  const dvi_system *base = x->base;
  x->slot = DVI_NEW(int, base->n);
  x->slot_of_x = DVI_NEW(int, base->nx);
  if (x->slot == NULL || x->slot_of_x == NULL) return no_memory();
  for (int c = 0; c < base->slot_count; c++) {
    const dvi__factor_slot *slot = &base->slots[c];
    for (int i = 0; i < dvi__chart_stored(slot->kind); i++) x->slot[slot->q + i] = c;
    for (int i = 0; i < dvi__chart_size(slot->kind); i++) x->slot_of_x[slot->x + i] = c;
  }
  return DVI_OK;
}

/* Which slots meet in symmetric patterns of stored coordinates. */
typedef struct meetings {
  const dvi_system *base;
  const int *slot;
  const dvi__pattern *part[2]; /* NULL: none */
  int own;                     /* every slot meets itself, not only those that are no lines */
  int *seen, stamp;            /* [slots] the stamp of the last time */
  int *met, count;             /* [slots] those that meet the last slot, in no order */
} meetings;

static void add_new(meetings *m, int c)
{
  if (m->seen[c] == m->stamp) return;
  m->seen[c] = m->stamp;
  m->met[m->count++] = c;
}

static void meet(meetings *m, int c)
{
  const dvi__factor_slot *at = &m->base->slots[c];
  m->stamp++;
  m->count = 0;
  if (m->own || at->kind != DVI__LINE) add_new(m, c);
  for (int k = 0; k < 2 && m->part[k] != NULL; k++)
    for (int e = m->part[k]->start[at->q];
         e < m->part[k]->start[at->q + dvi__chart_stored(at->kind)]; e++)
      add_new(m, m->slot[m->part[k]->row[e]]);
}

/* The pattern of slots. It is symmetric: giving every slot its columns in turn makes rows
 * ascend. */
static dvi_status meet_all(meetings *m, dvi__pattern *slots)
{
  const int count = m->base->slot_count;
  size_t entries = 0;
  *slots = (dvi__pattern){count, count, DVI_NEW(int, (size_t)count + 2), NULL};
  if (slots->start == NULL) return no_memory();
  for (int c = 0; c < count; c++) {
    meet(m, c);
    entries += (size_t)m->count;
    slots->start[c + 2] = (int)entries;
  }
  slots->row = DVI_NEW(int, entries);
  if (slots->row == NULL) return no_memory();
  for (int c = 0; c < count; c++) {
    meet(m, c);
    for (int i = 0; i < m->count; i++) slots->row[slots->start[m->met[i] + 1]++] = c;
  }
  return DVI_OK;
}

/* Rows of all that meet slot c, for each of its chart coordinates. Only counts them if there is no
 * room. */
static size_t put_columns(const dvi_system *base, const dvi__pattern *slots, int c, size_t at,
                          dvi__pattern *made)
{
  const dvi__factor_slot *column = &base->slots[c];
  for (int j = 0; j < dvi__chart_size(column->kind); j++) {
    for (int e = slots->start[c]; e < slots->start[c + 1]; e++) {
      const dvi__factor_slot *row = &base->slots[slots->row[e]];
      for (int i = 0; i < dvi__chart_size(row->kind); i++, at++)
        if (made != NULL) made->row[at] = row->x + i;
    }
    if (made != NULL) made->start[column->x + j + 1] = (int)at;
  }
  return at;
}

static dvi_status expand(const dvi_system *base, const dvi__pattern *slots, dvi__pattern *made)
{
  size_t entries = 0;
  for (int c = 0; c < base->slot_count; c++) entries = put_columns(base, slots, c, entries, NULL);
  if (entries > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "charts: a Hessian of %zu entries is too large", entries);
  *made = (dvi__pattern){base->nx, base->nx, DVI_NEW(int, (size_t)base->nx + 1),
                         DVI_NEW(int, entries)};
  if (made->start == NULL || made->row == NULL) return no_memory();
  for (int c = 0, at = 0; c < base->slot_count; c++)
    at = (int)put_columns(base, slots, c, (size_t)at, made);
  return DVI_OK;
}

/* Full blocks where slots meet in a or b. `own`: and all the diagonal blocks. */
static dvi_status make_pattern(const dvi__charted *x, const dvi__pattern *a, const dvi__pattern *b,
                               int own, dvi__pattern *made)
{
  const dvi_system *base = x->base;
  meetings m = {
      base, x->slot, {a, b}, own, DVI_NEW(int, base->slot_count), 0, DVI_NEW(int, base->slot_count),
      0};
  dvi__pattern slots = {0};
  dvi_status status = m.seen != NULL && m.met != NULL ? meet_all(&m, &slots) : no_memory();
  if (status == DVI_OK) status = expand(base, &slots, made);
  dvi__pattern_clear(&slots);
  dvi__release(m.seen);
  dvi__release(m.met);
  return status;
}

dvi__place dvi__charted_place(const dvi__charted *x, const dvi__pattern *made, int row_cell,
                              int column_cell)
{
  const int row = x->base->slots[row_cell].x, column = x->base->slots[column_cell].x;
  return (dvi__place){dvi__pattern_find(made, row, column),
                      made->start[column + 1] - made->start[column]};
}

/* The block of every entry of `part` in `made`. */
static dvi_status place(const dvi__charted *x, const dvi__pattern *part, const dvi__pattern *made,
                        dvi__place **places)
{
  *places = DVI_NEW(dvi__place, dvi__pattern_entries(part));
  if (*places == NULL) return no_memory();
  for (int j = 0; j < part->columns; j++)
    for (int e = part->start[j]; e < part->start[j + 1]; e++)
      (*places)[e] = dvi__charted_place(x, made, x->slot[part->row[e]], x->slot[j]);
  return DVI_OK;
}

static dvi_status place_own(const dvi__charted *x, const dvi__pattern *made, dvi__place **places)
{
  *places = DVI_NEW(dvi__place, x->base->slot_count);
  if (*places == NULL) return no_memory();
  for (int c = 0; c < x->base->slot_count; c++) (*places)[c] = dvi__charted_place(x, made, c, c);
  return DVI_OK;
}

dvi_status dvi__charted_make_patterns(dvi__charted *x)
{
  const dvi__pattern *qq = &x->base->qq, *vv = &x->base->vv;
  DVI_TRY(find_cells(x));
  DVI_TRY(make_pattern(x, qq, vv, 0, &x->qq));
  DVI_TRY(make_pattern(x, vv, NULL, 0, &x->qv));
  DVI_TRY(make_pattern(x, vv, NULL, 1, &x->vv));
  DVI_TRY(place(x, qq, &x->qq, &x->in_qq));
  DVI_TRY(place(x, vv, &x->qq, &x->mass_in_qq));
  DVI_TRY(place(x, vv, &x->qv, &x->mass_in_qv));
  DVI_TRY(place(x, vv, &x->vv, &x->mass_in_vv));
  DVI_TRY(place_own(x, &x->qq, &x->own_in_qq));
  return place_own(x, &x->qv, &x->own_in_qv);
}
