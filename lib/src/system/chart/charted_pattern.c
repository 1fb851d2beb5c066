/* Patterns of the Lagrangian in the charts. Slots whose stored coordinates meet in a matrix have
 * full blocks. */
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/chart/charted_struct.h"

static dvi_status refuse_memory_of_charts(void)
{
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for patterns");
}

/* Find the slot of every stored coordinate, and of every chart coordinate. */
static dvi_status find_slots(dvi__charted *x)
{
  const dvi_system *base = x->base;
  x->slot = DVI_NEW(int, base->n);
  x->slot_of_x = DVI_NEW(int, base->nx);
  if (x->slot == NULL || x->slot_of_x == NULL) return refuse_memory_of_charts();
  for (int c = 0; c < base->slot_count; c++) {
    const dvi__factor_slot *slot = &base->slots[c];
    for (int i = 0; i < dvi__chart_stored(slot->kind); i++) x->slot[slot->q + i] = c;
    for (int i = 0; i < dvi__chart_size(slot->kind); i++) x->slot_of_x[slot->x + i] = c;
  }
  return DVI_OK;
}

/* The pairs of slots that meet in symmetric patterns of stored coordinates. */
typedef struct meetings {
  const dvi_system *base;
  const int *slot;
  const dvi__pattern *part[2]; /* patterns, or NULL */
  /* not 0 if every slot meets itself. Otherwise slots of lines do so only by their entries. */
  int own;
  int *seen, stamp; /* stamp [slots] of the last meeting */
  int *met, count;  /* slots [slots] that meet the last slot, unordered */
} meetings;

static void add_new(meetings *m, int c)
{
  if (m->seen[c] == m->stamp) return;
  m->seen[c] = m->stamp;
  m->met[m->count++] = c;
}

static void meet_slot(meetings *m, int c)
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

/* Compute the pattern of slots. It is symmetric, so giving every slot its columns in turn makes
 * rows ascend. */
static dvi_status meet_all(meetings *m, dvi__pattern *slots)
{
  const int count = m->base->slot_count;
  size_t entries = 0;
  *slots = (dvi__pattern){
      .rows = count, .columns = count, .start = DVI_NEW(int, (size_t)count + 2)};
  if (slots->start == NULL) return refuse_memory_of_charts();
  for (int c = 0; c < count; c++) {
    meet_slot(m, c);
    entries += (size_t)m->count;
    slots->start[c + 2] = (int)entries;
  }
  slots->row = DVI_NEW(int, entries);
  if (slots->row == NULL) return refuse_memory_of_charts();
  for (int c = 0; c < count; c++) {
    meet_slot(m, c);
    for (int i = 0; i < m->count; i++) slots->row[slots->start[m->met[i] + 1]++] = c;
  }
  return DVI_OK;
}

/* Write the rows of all that meet slot c, for each of its chart coordinates. Without room the rows
 * are only counted. */
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

static dvi_status expand_slots(const dvi_system *base, const dvi__pattern *slots,
                               dvi__pattern *made)
{
  size_t entries = 0;
  for (int c = 0; c < base->slot_count; c++) entries = put_columns(base, slots, c, entries, NULL);
  if (entries > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "charts: a Hessian of %zu entries is too large", entries);
  *made = (dvi__pattern){.rows = base->nx,
                         .columns = base->nx,
                         .start = DVI_NEW(int, (size_t)base->nx + 1),
                         .row = DVI_NEW(int, entries)};
  if (made->start == NULL || made->row == NULL) return refuse_memory_of_charts();
  for (int c = 0, at = 0; c < base->slot_count; c++)
    at = (int)put_columns(base, slots, c, (size_t)at, made);
  return DVI_OK;
}

dvi_status dvi__charted_slot_pattern(const dvi__charted *x, const dvi__pattern *a,
                                     const dvi__pattern *b, int own, dvi__pattern *made)
{
  const dvi_system *base = x->base;
  meetings m = {.base = base,
                .slot = x->slot,
                .part = {a, b},
                .own = own,
                .seen = DVI_NEW(int, base->slot_count),
                .met = DVI_NEW(int, base->slot_count)};
  dvi__pattern slots = {0};
  dvi_status status = m.seen != NULL && m.met != NULL ? meet_all(&m, &slots)
                                                      : refuse_memory_of_charts();
  if (status == DVI_OK) status = expand_slots(base, &slots, made);
  dvi__pattern_clear(&slots);
  dvi__release(m.seen);
  dvi__release(m.met);
  return status;
}

dvi__place dvi__charted_place(const dvi__charted *x, const dvi__pattern *made, int row_slot,
                              int column_slot)
{
  const int row = x->base->slots[row_slot].x, column = x->base->slots[column_slot].x;
  return (dvi__place){.first = dvi__pattern_find(made, row, column),
                      .column = made->start[column + 1] - made->start[column]};
}

dvi_status dvi__charted_place_entries(const dvi__charted *x, const dvi__pattern *part,
                                      const dvi__pattern *made, dvi__place **places)
{
  *places = DVI_NEW(dvi__place, dvi__pattern_entries(part));
  if (*places == NULL) return refuse_memory_of_charts();
  for (int j = 0; j < part->columns; j++)
    for (int e = part->start[j]; e < part->start[j + 1]; e++)
      (*places)[e] = dvi__charted_place(x, made, x->slot[part->row[e]], x->slot[j]);
  return DVI_OK;
}

dvi_status dvi__charted_place_own(const dvi__charted *x, const dvi__pattern *made,
                                  dvi__place **places)
{
  *places = DVI_NEW(dvi__place, x->base->slot_count);
  if (*places == NULL) return refuse_memory_of_charts();
  for (int c = 0; c < x->base->slot_count; c++) (*places)[c] = dvi__charted_place(x, made, c, c);
  return DVI_OK;
}

dvi_status dvi__charted_make_patterns(dvi__charted *x)
{
  const dvi__pattern *qq = &x->base->qq, *vv = &x->base->vv;
  DVI_TRY(find_slots(x));
  DVI_TRY(dvi__charted_slot_pattern(x, qq, vv, 0, &x->qq));
  DVI_TRY(dvi__charted_slot_pattern(x, vv, NULL, 0, &x->qv));
  DVI_TRY(dvi__charted_slot_pattern(x, vv, NULL, 1, &x->vv));
  DVI_TRY(dvi__charted_make_blocks(x));
  DVI_TRY(dvi__charted_place_own(x, &x->qq, &x->own_in_qq));
  return dvi__charted_place_own(x, &x->qv, &x->own_in_qv);
}
