/* The places of the unknowns, and the pattern of their Jacobian. */
#include "boundary/layout.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

static const double one = 1.0;

/* Return the place of node k. Places of given nodes are before the first unknown or after the last
 * one. */
static int node_position(const dvi_path *path, int k)
{
  const int all = path->ends == DVI_ENDS_PERIODIC || path->ends == DVI_ENDS_MIXED;
  return k * path->n * path->s - (all ? 0 : path->n);
}

int dvi__path_node(const dvi_path *path, int k)
{
  const int at = node_position(path, k);
  return at >= 0 && at < path->core ? at : -1;
}

int dvi__path_given(const dvi_path *path, int end, int i)
{
  if (path->ends != DVI_ENDS_MIXED || path->free[end][i]) return -1;
  return node_position(path, end == 0 ? 0 : path->steps) + i;
}

int dvi__path_bubbles(const dvi_path *path, int k)
{
  return node_position(path, k) + path->n;
}

/* Find the places of coordinate i of a periodic path's last node. The node is A times the first
 * one, so each of its numbers has as many places as A has entries in a row. */
static void turned_places(const dvi_path *path, int i, dvi__places *places)
{
  if (path->turn.start == NULL) return;
  const int first = path->turn.start[i];
  *places = (dvi__places){.count = path->turn.start[i + 1] - first,
                          .at = path->turn.row + first,
                          .factor = path->turn_values + first};
}

void dvi__path_places(const dvi_path *path, int k, int a, int i, int row, dvi__places *places)
{
  const int turned = path->ends == DVI_ENDS_PERIODIC && a == 1 && k + 1 == path->steps;
  int at = a < 2 ? node_position(path, turned ? 0 : k + a) : dvi__path_bubbles(path, k);
  /* A step forward gives the next node. */
  if (a < 2 && row && path->ends == DVI_ENDS_INITIAL) at += path->n * path->s;
  at += a < 2 ? i : i * (path->s - 1) + a - 2;
  const int given = a < 2 &&
                    (at == dvi__path_given(path, 0, i) || at == dvi__path_given(path, 1, i));
  *places = (dvi__places){
      .count = at >= 0 && at < path->core && !given, .at = NULL, .factor = &one, .single = at};
  places->at = &places->single;
  if (turned) turned_places(path, i, places);
}

void dvi__path_turn(const dvi_path *path, const double *x, double *y)
{
  if (path->turn.start == NULL) {
    memmove(y, x, (size_t)path->n * sizeof(double));
    return;
  }
  for (int i = 0; i < path->n; i++) {
    y[i] = 0;
    for (int e = path->turn.start[i]; e < path->turn.start[i + 1]; e++)
      y[i] += path->turn_values[e] * x[path->turn.row[e]];
  }
}

void dvi__path_turn_back(const dvi_path *path, const double *y, double *x)
{
  if (path->turn.start == NULL) {
    memmove(x, y, (size_t)path->n * sizeof(double));
    return;
  }
  memset(x, 0, (size_t)path->n * sizeof(double));
  for (int i = 0; i < path->n; i++)
    for (int e = path->turn.start[i]; e < path->turn.start[i + 1]; e++)
      x[path->turn.row[e]] += path->turn_values[e] * y[i];
}

const double *dvi__path_image(dvi_path *path, const double *q)
{
  dvi__path_turn(path, q, path->wrapped);
  for (int i = 0; i < path->n && path->shift != NULL; i++) path->wrapped[i] += path->shift[i];
  return path->wrapped;
}

const double *dvi__path_at(dvi_path *path, const double *x, int k)
{
  const int at = dvi__path_node(path, k);
  if (at >= 0) return x + at;
  if (k == 0) return path->q0;
  return path->ends == DVI_ENDS_FIXED ? path->q1 : dvi__path_image(path, x);
}

/* ---- entries ---- */

static void emit_block(const dvi_path *path, int k, const dvi__places *column, int a, int i,
                       size_t from, dvi__emit *emit, void *of)
{
  dvi__places row;
  dvi__path_places(path, k, a, i, 1, &row);
  for (int c = 0; c < column->count; c++)
    for (int r = 0; r < row.count; r++)
      emit(of, row.at[r], column->at[c], column->factor[c] * row.factor[r], from);
}

void dvi__path_each_entry(const dvi_path *path, int k, dvi__emit *emit, void *of)
{
  const dvi__pattern *coupling = dvi__action_coupling(path->action);
  const size_t size = (size_t)path->s + 1;
  for (int j = 0; j < path->n; j++)
    for (size_t b = 0; b < size; b++) {
      dvi__places column;
      dvi__path_places(path, k, (int)b, j, 0, &column);
      if (column.count == 0) continue;
      for (size_t a = 0; a < size; a++)
        for (int e = coupling->start[j]; e < coupling->start[j + 1]; e++)
          emit_block(path, k, &column, (int)a, coupling->row[e], ((size_t)e * size + b) * size + a,
                     emit, of);
    }
}

void dvi__path_each_gauge(const dvi_path *path, dvi__emit_gauge *emit, void *of)
{
  const int first = path->core + (path->free_span != 0);
  for (int k = 0; k < path->steps; k++)
    for (int g = 0; g < path->gauges; g++)
      for (int i = 0; i < path->n; i++)
        emit(of, dvi__path_node(path, k) + i, first + g,
             ((size_t)g * (size_t)path->steps + (size_t)k) * (size_t)path->n + (size_t)i);
}

/* A pattern under construction. Its columns are first counted and then filled, in any order and
 * with repeated entries. */
typedef struct pattern_draft {
  dvi__pattern pattern;
  /* 1: columns are counted into start[column + 1]. 0: start[column] moves on as columns are
   * filled */
  int counts;
  size_t entries;
} pattern_draft;

static void draft_add(pattern_draft *d, int row, int column)
{
  if (d->counts) {
    d->entries++;
    if (d->entries < INT_MAX) d->pattern.start[column + 1]++;
  } else {
    d->pattern.row[d->pattern.start[column]++] = row;
  }
}

static void draft_add_entry(void *of, int row, int column, double factor, size_t from)
{
  (void)factor, (void)from;
  draft_add(of, row, column);
}

static void draft_add_gauge(void *of, int unknown, int multiplier, size_t from)
{
  (void)from;
  draft_add(of, unknown, multiplier);
  draft_add(of, multiplier, unknown);
}

static void draft_add_all(const dvi_path *path, pattern_draft *d)
{
  for (int k = 0; k < path->steps; k++) dvi__path_each_entry(path, k, draft_add_entry, d);
  dvi__path_each_gauge(path, draft_add_gauge, d);
  /* The span's row and column are full. */
  for (int c = 0; path->free_span && c < path->core; c++) draft_add_gauge(d, c, path->core, 0);
  for (int i = 0; i < 2 * path->n; i++) {
    const int given = dvi__path_given(path, i % 2, i / 2);
    if (given >= 0) draft_add(d, given, given);
  }
  /* The span's own entry, and those of multipliers that are not in use. */
  for (int c = path->core; c < path->unknowns; c++) draft_add(d, c, c);
}

/* Sort the rows of each column and remove repeated ones. */
static dvi_status sort_pattern_rows(dvi__pattern *rough, dvi__pattern *tidied)
{
  dvi__pattern by_rows = {0};
  dvi_status status = dvi__pattern_transpose(rough, &by_rows);
  dvi__pattern_clear(rough);
  if (status == DVI_OK) status = dvi__pattern_transpose(&by_rows, tidied);
  dvi__pattern_clear(&by_rows);
  if (status != DVI_OK) return status;
  int kept = 0;
  for (int c = 0, from = 0; c < tidied->columns; c++) {
    const int first = kept, end = tidied->start[c + 1];
    for (; from < end; from++)
      if (kept == first || tidied->row[kept - 1] != tidied->row[from])
        tidied->row[kept++] = tidied->row[from];
    tidied->start[c + 1] = kept;
  }
  return DVI_OK;
}

static dvi_status too_many(const dvi_path *path, double count, const char *what)
{
  return dvi__fail(DVI_BAD_SIZE,
                   "path: %d steps of degree %d in %d coordinates have %.3g %s, more than an int "
                   "can count; take fewer",
                   path->steps, path->s, path->n, count, what);
}

static dvi_status draw_pattern(dvi_path *path)
{
  pattern_draft d = {
      .pattern = {path->unknowns, path->unknowns, DVI_NEW(int, (size_t)path->unknowns + 1), NULL},
      .counts = 1};
  if (d.pattern.start == NULL)
    return dvi__fail(DVI_NO_MEMORY, "path: no memory for %d unknowns", path->unknowns);
  draft_add_all(path, &d);
  dvi_status status = d.entries < INT_MAX
                          ? DVI_OK
                          : too_many(path, (double)d.entries, "entries in the Jacobian");
  for (int c = 0; c < path->unknowns && status == DVI_OK; c++)
    d.pattern.start[c + 1] += d.pattern.start[c];
  if (status == DVI_OK) d.pattern.row = DVI_NEW(int, d.entries);
  if (status == DVI_OK && d.pattern.row == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "path: no memory for %zu entries", d.entries);
  if (status != DVI_OK) {
    dvi__pattern_clear(&d.pattern);
    return status;
  }
  d.counts = 0;
  draft_add_all(path, &d);
  for (int c = path->unknowns; c > 0; c--) d.pattern.start[c] = d.pattern.start[c - 1];
  d.pattern.start[0] = 0;
  return sort_pattern_rows(&d.pattern, &path->pattern);
}

dvi_status dvi__path_lay_out(dvi_path *path)
{
  const double blocks = (path->s + 1.0) * (path->s + 1.0) *
                        dvi__pattern_entries(dvi__action_coupling(path->action));
  const double core = (double)path->steps * path->n * path->s -
                      (path->ends == DVI_ENDS_FIXED ? path->n : 0) +
                      (path->ends == DVI_ENDS_MIXED ? path->n : 0);
  /* The limit counts the places of the last node, beyond the last unknown, too. */
  if (core + 2.0 * path->n * path->s > INT_MAX) return too_many(path, core, "unknowns");
  if (path->steps * blocks > INT_MAX)
    return too_many(path, path->steps * blocks, "entries in the Jacobian");
  if (core < 1)
    return dvi__fail(DVI_BAD_SIZE, "path: 1 straight step between fixed ends leaves nothing to "
                                   "vary; at least 2 steps are needed");
  path->core = (int)core;
  path->unknowns = path->core + (path->free_span != 0) + path->gauges;
  return draw_pattern(path);
}
