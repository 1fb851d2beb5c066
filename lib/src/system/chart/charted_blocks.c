/* Products of tangents with the blocks of a matrix of stored coordinates, at several points side by
 * side. Each block is multiplied from the right once, for all that multiply it from the left. */
#include "core/memory.h"
#include "core/status.h"
#include "group/chart_lanes.h"
#include "num/simd/wide.h"
#include "system/chart/charted_struct.h"

typedef dvi__lane lane;

/* ---- create ---- */

/* One block's entries, from the cursors of its columns on. */
typedef struct block_reader {
  const dvi__charted *x;
  const dvi__pattern *part;
  const double *values; /* entries that are 0 in it are left out, or NULL */
  int cursor[DVI__CHART_POINT];
} block_reader;

/* Find the first slot that a cursor is at, or the count of slots. */
static int next_row_slot(const block_reader *r, const dvi__factor_slot *column)
{
  int next = r->x->base->slot_count;
  for (int j = 0; j < dvi__chart_stored(column->kind); j++) {
    const int e = r->cursor[j];
    if (e < r->part->start[column->q + j + 1] && r->x->slot[r->part->row[e]] < next)
      next = r->x->slot[r->part->row[e]];
  }
  return next;
}

/* Read the entries in a row slot, and move the cursors behind them. Without room they are counted.
 * Returns how many there are. */
static int read_block(block_reader *r, const dvi__factor_slot *column, int row_slot,
                      dvi__block_entry *to)
{
  const int first = r->x->base->slots[row_slot].q;
  int count = 0;
  for (int j = 0; j < dvi__chart_stored(column->kind); j++) {
    int *e = &r->cursor[j];
    for (; *e < r->part->start[column->q + j + 1] && r->x->slot[r->part->row[*e]] == row_slot; ++*e)
      if (r->values == NULL || r->values[*e] != 0) {
        if (to != NULL) to[count] = (dvi__block_entry){*e, r->part->row[*e] - first, j};
        count++;
      }
  }
  return count;
}

/* List all blocks with their entries. Without room they are counted. */
static void list_blocks(block_reader *r, dvi__slot_blocks *made)
{
  int entries = 0;
  made->count = 0;
  for (int c = 0; c < r->x->base->slot_count; c++) {
    const dvi__factor_slot *column = &r->x->base->slots[c];
    for (int j = 0; j < dvi__chart_stored(column->kind); j++)
      r->cursor[j] = r->part->start[column->q + j];
    for (int row; (row = next_row_slot(r, column)) < r->x->base->slot_count;) {
      const int some = read_block(r, column, row,
                                  made->entry != NULL ? made->entry + entries : NULL);
      if (some == 0) continue;
      if (made->block != NULL)
        made->block[made->count] = (dvi__slot_block){.row = row, .column = c, .first = entries};
      entries += some;
      made->count++;
    }
  }
  if (made->block != NULL) made->block[made->count].first = entries;
}

static void place_blocks(const dvi__charted *x, int is_mass, dvi__slot_blocks *made)
{
  for (int b = 0; b < made->count; b++) {
    dvi__slot_block *block = &made->block[b];
    block->qq = dvi__charted_place(x, &x->qq, block->row, block->column);
    if (!is_mass) continue;
    block->qv = dvi__charted_place(x, &x->qv, block->row, block->column);
    block->vv = dvi__charted_place(x, &x->vv, block->row, block->column);
  }
}

static dvi_status make_blocks(const dvi__charted *x, const dvi__pattern *part, const double *values,
                              dvi__slot_blocks *made)
{
  block_reader reader = {.x = x, .part = part, .values = values};
  *made = (dvi__slot_blocks){0};
  list_blocks(&reader, made);
  made->block = DVI_NEW(dvi__slot_block, (size_t)made->count + 1);
  made->entry = DVI_NEW(dvi__block_entry, dvi__pattern_entries(part));
  if (made->block == NULL || made->entry == NULL)
    return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %d blocks", made->count);
  list_blocks(&reader, made);
  place_blocks(x, values != NULL, made);
  return DVI_OK;
}

dvi_status dvi__charted_make_blocks(dvi__charted *x)
{
  DVI_TRY(make_blocks(x, &x->base->vv, x->base->mass_values, &x->masses));
  return make_blocks(x, &x->base->qq, NULL, &x->potentials);
}

void dvi__charted_clear_blocks(dvi__charted *x)
{
  dvi__release(x->masses.block);
  dvi__release(x->masses.entry);
  dvi__release(x->potentials.block);
  dvi__release(x->potentials.entry);
}

/* ---- products ---- */

/* Some points of a group, from `at` on. Point `to` of a batch of `count` is the first. */
typedef struct points {
  int at, some;
  size_t count, to;
} points;

static const double *rows_of(const dvi__charted *x, int slot, const double *tangents,
                             const points *p)
{
  return tangents + 3 * (size_t)x->base->slots[slot].q * DVI__GROUP + (size_t)p->at;
}

static int size_of(const dvi__charted *x, int slot)
{
  return dvi__chart_size(x->base->slots[slot].kind);
}

/* Add left^T P to a block of `values`. */
INLINE void add_product(const dvi__charted *x, const dvi__slot_block *block, dvi__place in,
                        const double *left, const lane *P, const points *p, double *values)
{
  const int rows = size_of(x, block->row), columns = size_of(x, block->column),
            stored = dvi__chart_stored(x->base->slots[block->row].kind);
  const double *from = rows_of(x, block->row, left, p);
  for (int a = 0; a < rows; a++) {
    lane sum[3] = {{0}};
    for (int i = 0; i < stored; i++) {
      const lane factor = *(const dvi__lane_at *)(from + (size_t)((i * rows + a) * DVI__GROUP));
      for (int b = 0; b < columns; b++) sum[b] += factor * P[3 * i + b];
    }
    for (int b = 0; b < columns; b++) {
      double *to = values + (size_t)(in.first + b * in.column + a) * p->count + p->to;
      lane before;
      load_rows(1, to, 0, p->some, &before);
      before += sum[b];
      store_rows(1, &before, 0, p->some, to);
    }
  }
}

/* Add an entry times row j of the right factor to row i of P. */
INLINE void add_row(int columns, const dvi__block_entry *entry, const lane *value,
                    const double *right, lane *P)
{
  for (int b = 0; b < columns; b++) {
    const ptrdiff_t at = (ptrdiff_t)(entry->column * columns + b) * DVI__GROUP;
    P[3 * entry->row + b] += *value * *(const dvi__lane_at *)(right + at);
  }
}

INLINE void clear_rows(const dvi__charted *x, const dvi__slot_block *block, lane *P)
{
  const int rows = dvi__chart_stored(x->base->slots[block->row].kind);
  for (int i = 0; i < 3 * rows; i++) P[i] = (lane){0};
}

/* Compute P = M right of a block of the mass. */
INLINE void multiply_mass(const dvi__charted *x, const dvi__slot_block *block, const double *right,
                          const points *p, lane *P)
{
  const double *from = rows_of(x, block->column, right, p);
  clear_rows(x, block, P);
  for (int e = block[0].first; e < block[1].first; e++) {
    const dvi__block_entry *entry = &x->masses.entry[e];
    const lane value = x->base->mass_values[entry->entry] + (lane){0};
    add_row(size_of(x, block->column), entry, &value, from, P);
  }
}

/* Compute P = L_yy T of a block. A user's Hessian without a pattern is nearly all zeros. Returns 0
 * if there is nothing else. */
INLINE int multiply_potential(const dvi__charted *x, const dvi__slot_block *block, int group,
                              const points *p, lane *P)
{
  const double *from = rows_of(x, block->column, x->T, p);
  int found = 0;
  clear_rows(x, block, P);
  for (int e = block[0].first; e < block[1].first; e++) {
    const dvi__block_entry *entry = &x->potentials.entry[e];
    lane value;
    load_rows(1, x->L_yy + (size_t)entry->entry * (size_t)group + (size_t)p->at, 0, p->some,
              &value);
    if (value[0] == 0 && value[1] == 0 && value[2] == 0 && value[3] == 0) continue;
    found = 1;
    add_row(size_of(x, block->column), entry, &value, from, P);
  }
  return found;
}

static int is_line(const dvi__charted *x, int slot)
{
  return x->base->slots[slot].kind == DVI__LINE;
}

/* The tangents S of lines are 0, and only what turns has those of C. */
INLINE void add_masses(const dvi__charted *x, const points *p, int on_path, const dvi__hessian *to)
{
  for (const dvi__slot_block *block = x->masses.block, *end = block + x->masses.count; block < end;
       block++) {
    const int bends = !is_line(x, block->row),
              turns = on_path && x->inertia == NULL && dvi__turns(&x->base->slots[block->row]);
    lane P[27];
    multiply_mass(x, block, x->T, p, P);
    add_product(x, block, block->vv, x->T, P, p, to->vv);
    if (bends) add_product(x, block, block->qv, x->S, P, p, to->qv);
    if (turns) add_product(x, block, block->qv, x->turned_S, P, p, x->C_qv);
    if (!bends || is_line(x, block->column)) continue;
    multiply_mass(x, block, x->S, p, P);
    add_product(x, block, block->qq, x->S, P, p, to->qq);
    if (turns) add_product(x, block, block->qq, x->turned_S, P, p, x->C_qq);
  }
}

INLINE void add_potentials(const dvi__charted *x, int group, const points *p, int on_path,
                           const dvi__hessian *to)
{
  for (const dvi__slot_block *block = x->potentials.block, *end = block + x->potentials.count;
       block < end; block++) {
    lane P[27];
    if (!multiply_potential(x, block, group, p, P)) continue;
    add_product(x, block, block->qq, x->T, P, p, to->qq);
    if (on_path && dvi__turns(&x->base->slots[block->row]))
      add_product(x, block, block->qq, x->turned_T, P, p, x->C_qq);
  }
}

WIDE static void add_all(const dvi__charted *x, int count, int first, int group, int on_path,
                         const dvi__hessian *to)
{
  for (int at = 0; at < group; at += DVI__LANES) {
    const points p = {at, group - at < DVI__LANES ? group - at : DVI__LANES, (size_t)count,
                      (size_t)(first + at)};
    add_masses(x, &p, on_path, to);
    add_potentials(x, group, &p, on_path, to);
  }
}

void dvi__charted_add_blocks(const dvi__charted *x, int count, int first, int group, int on_path,
                             const dvi__hessian *to)
{
  add_all(x, count, first, group, on_path, to);
}

WIDE static void add_mass(const dvi__charted *x, double *mass)
{
  const points p = {.some = 1, .count = 1};
  for (const dvi__slot_block *block = x->masses.block, *end = block + x->masses.count; block < end;
       block++) {
    lane P[27];
    multiply_mass(x, block, x->T, &p, P);
    add_product(x, block, block->vv, x->T, P, &p, mass);
  }
}

void dvi__charted_add_mass(const dvi__charted *x, double *mass)
{
  add_mass(x, mass);
}
