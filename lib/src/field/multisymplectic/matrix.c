/* The matrix of a step: minus the second derivative of a row's action by its lower and its upper
 * level, close to the mass over dt. It decides how fast the equations of a level converge, and not
 * what their solution is. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/multisymplectic/lattice.h"

/* ---- what second derivatives are like ---- */

enum { PROBES = 3 };

/* Compare the second derivatives at another z with those of the first one. */
static void compare(const dvi__batch *b, const double *first, dvi__lattice_part *part)
{
  for (int p = 0; p < part->pairs; p++)
    for (int i = 0; i < b->count; i++) {
      const size_t at = (size_t)p * (size_t)b->count + (size_t)i;
      const double change = fabs(b->l_zz[at] - first[at]);
      if (b->l_zz[at] != 0 || first[at] != 0) part->is_zero[p] = 0;
      if (!(change <= 1e-12 * fabs(first[at]))) part->varies[p] = 1;
    }
}

/* Tell if a density is not defined at a place, which is no failure of it. */
static int is_undefined(dvi_status status)
{
  return status == DVI_CALLBACK_RETRY || status == DVI_NOT_FINITE;
}

/* Evaluate second derivatives at some z and t at random. A density that is not defined there counts
 * as one that varies. */
static dvi_status probe_part(const dvi__lattice *lattice, dvi__lattice_part *part, double *first)
{
  uint64_t seed = 1;
  memset(part->is_zero, 1, (size_t)part->pairs);
  for (int64_t cell = 0; cell < lattice->cells;) {
    dvi__batch b = dvi__batch_begin(lattice, part, cell, DVI__BATCH / lattice->points);
    for (int k = 0; k < PROBES; k++) {
      b.t = k;
      seed = dvi__fill_random((int64_t)part->variables * b.count, seed, b.z);
      for (int i = 0; i < part->variables * b.count; i++) b.z[i] *= 1 + k;
      const dvi_status status = dvi__batch_evaluate(&b, DVI__WANT_L_ZZ);
      if (is_undefined(status)) {
        memset(part->varies, 1, (size_t)part->pairs);
        memset(part->is_zero, 0, (size_t)part->pairs);
        return DVI_OK;
      }
      DVI_TRY(status);
      if (k == 0) memcpy(first, b.l_zz, (size_t)part->pairs * (size_t)b.count * sizeof *first);
      compare(&b, first, part);
    }
    cell += b.cells;
  }
  return DVI_OK;
}

/* The levels change their places in what mixes rates with other variables. */
static int is_symmetric(const dvi__lattice *lattice)
{
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    for (int p = 0; p < part->pairs; p++)
      if (!part->is_zero[p] &&
          part->variable[part->pair[p][0]].is_rate != part->variable[part->pair[p][1]].is_rate)
        return 0;
  }
  return 1;
}

dvi_status dvi__lattice_probe(dvi__lattice *lattice)
{
  double *first = DVI_NEW(double, dvi__batch_work(lattice));
  if (first == NULL) return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for work");
  dvi_status status = DVI_OK;
  for (int i = 0; i < lattice->parts && status == DVI_OK; i++)
    status = probe_part(lattice, &lattice->part[i], first);
  dvi__release(first);
  DVI_TRY(status);
  lattice->is_symmetric = is_symmetric(lattice);
  return DVI_OK;
}

/* ---- pattern ---- */

/* Whether corners and components meet in the matrix. */
typedef struct meetings {
  char meets[DVI__CORNERS][DVI__CORNERS][DVI_COMPONENTS_MAX][DVI_COMPONENTS_MAX];
} meetings;

/* How much a variable depends on the values of a level at a point in time. */
static double dependence(const dvi__lattice *lattice, const dvi__lattice_variable *v,
                         const double *value, int level)
{
  return v->is_rate ? (2 * level - 1) / lattice->dt : value[level];
}

static int meets_in_time(const dvi__lattice *lattice, const dvi__lattice_part *part, int a, int b)
{
  for (int k = 0; k < part->time.count; k++) {
    const double *value = part->time.value[k];
    if (dependence(lattice, &part->variable[a], value, 0) != 0 &&
        dependence(lattice, &part->variable[b], value, 1) != 0)
      return 1;
  }
  return 0;
}

static void meet_in_space(const dvi__lattice *lattice, const dvi__lattice_variable *a,
                          const dvi__lattice_variable *b, meetings *m)
{
  for (int q = 0; q < lattice->points; q++)
    for (int i = 0; i < lattice->corners; i++)
      for (int j = 0; j < lattice->corners; j++)
        if (lattice->shape[1 + a->axis][q][i] != 0 && lattice->shape[1 + b->axis][q][j] != 0)
          m->meets[i][j][a->component][b->component] = 1,
          m->meets[j][i][b->component][a->component] = 1;
}

/* Fluxes depend on values. */
static void meet_in_fluxes(const dvi__lattice *lattice, meetings *m)
{
  for (int c = 0; c < lattice->components && lattice->time_weight > 0; c++) {
    const dvi__lattice_variable value = {c, 0, -1};
    meet_in_space(lattice, &value, &value, m);
  }
}

static void find_meetings(const dvi__lattice *lattice, meetings *m)
{
  *m = (meetings){0};
  if (lattice->conditions > 0) meet_in_fluxes(lattice, m);
  for (int i = 0; i < lattice->corners; i++)
    for (int c = 0; c < lattice->components; c++) m->meets[i][i][c][c] = 1;
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    for (int p = 0; p < part->pairs; p++) {
      const int a = part->pair[p][0], b = part->pair[p][1];
      if (part->is_zero[p]) continue;
      if (meets_in_time(lattice, part, a, b) || meets_in_time(lattice, part, b, a))
        meet_in_space(lattice, &part->variable[a], &part->variable[b], m);
    }
  }
}

static void insert(int row, int *rows, int *count)
{
  int at = *count;
  while (at > 0 && rows[at - 1] > row) at--;
  if (at > 0 && rows[at - 1] == row) return;
  memmove(rows + at + 1, rows + at, (size_t)(*count - at) * sizeof *rows);
  rows[at] = row;
  ++*count;
}

/* Collect the rows of the column of a value. */
static int collect_rows(const dvi__lattice *lattice, const meetings *m, int64_t value, int *rows)
{
  const int64_t vertex = value % lattice->vertices;
  const int component = (int)(value / lattice->vertices);
  int count = 0;
  for (int j = 0; j < lattice->corners; j++) {
    const int64_t cell = dvi__lattice_cell_at(lattice, vertex, j);
    for (int i = 0; i < lattice->corners && cell >= 0; i++)
      for (int c = 0; c < lattice->components; c++) {
        const int other = lattice->corner[cell * lattice->corners + i];
        const int row = lattice->unknown[c * lattice->vertices + other];
        if (row >= 0 && m->meets[i][j][c][component]) insert(row, rows, &count);
      }
  }
  return count;
}

enum { MOST_ROWS = 27 * DVI_COMPONENTS_MAX };

dvi_status dvi__lattice_make_pattern(dvi__lattice *lattice)
{
  meetings *m = DVI_NEW(meetings, 1);
  dvi__pattern *pattern = &lattice->pattern;
  int64_t entries = 0;
  int rows[MOST_ROWS + 1];
  *pattern = (dvi__pattern){lattice->unknowns, lattice->unknowns,
                            DVI_NEW(int, lattice->unknowns + 1), NULL};
  if (m == NULL || pattern->start == NULL) goto no_memory;
  find_meetings(lattice, m);
  for (int64_t i = 0; i < lattice->size; i++)
    if (lattice->unknown[i] >= 0) entries += collect_rows(lattice, m, i, rows);
  pattern->row = entries < INT32_MAX ? DVI_NEW(int, entries) : NULL;
  if (pattern->row == NULL) goto no_memory;
  for (int64_t i = 0; i < lattice->size; i++) {
    const int column = lattice->unknown[i];
    if (column < 0) continue;
    const int count = collect_rows(lattice, m, i, rows), start = pattern->start[column];
    memcpy(pattern->row + start, rows, (size_t)count * sizeof *rows);
    pattern->start[column + 1] = start + count;
  }
  dvi__release(m);
  return DVI_OK;
no_memory:
  dvi__release(m);
  return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for a matrix of %d unknowns",
                   lattice->unknowns);
}

/* ---- values ---- */

/* Add -w l_ab of the points of a cell, differentiated by the lower level in variable a and by the
 * upper one in b. */
static void add_entries(const dvi__batch *b, int cell, const dvi__lattice_variable *row,
                        const dvi__lattice_variable *column, const double *l_zz, double *values)
{
  const dvi__lattice *lattice = b->lattice;
  const int *corner = lattice->corner + (b->cell + cell) * lattice->corners;
  const double factor = -b->duration * dependence(lattice, row, b->level, 0) *
                        dependence(lattice, column, b->level, 1);
  for (int j = 0; j < lattice->corners && factor != 0; j++) {
    const int of = lattice->unknown[column->component * lattice->vertices + corner[j]];
    for (int i = 0; i < lattice->corners && of >= 0; i++) {
      const int to = lattice->unknown[row->component * lattice->vertices + corner[i]];
      double sum = 0;
      if (to < 0) continue;
      for (int q = 0; q < lattice->points; q++)
        sum += lattice->shape[1 + row->axis][q][i] * lattice->shape[1 + column->axis][q][j] *
               b->weight[cell * lattice->points + q] * l_zz[cell * lattice->points + q];
      if (sum != 0) values[dvi__pattern_find(&lattice->pattern, to, of)] += factor * sum;
    }
  }
}

/* Divide l_zz by the widths of the cells of derivatives. */
static void scale_by_widths(const dvi__batch *b, const dvi__lattice_variable *v, double *l_zz)
{
  const int points = b->lattice->points;
  for (int c = 0; c < b->cells && v->axis >= 0; c++)
    for (int q = 0; q < points; q++) l_zz[c * points + q] /= dvi__batch_width(b, v, c);
}

static dvi_status add_matrix(void *of, const dvi__batch *b)
{
  double *values = of;
  for (int p = 0; p < b->part->pairs; p++) {
    const dvi__lattice_variable *row = &b->part->variable[b->part->pair[p][0]],
                                *column = &b->part->variable[b->part->pair[p][1]];
    double *l_zz = b->l_zz + (size_t)p * (size_t)b->count;
    if (b->part->is_zero[p]) continue;
    scale_by_widths(b, row, l_zz);
    scale_by_widths(b, column, l_zz);
    for (int c = 0; c < b->cells; c++) {
      add_entries(b, c, row, column, l_zz, values);
      if (row != column) add_entries(b, c, column, row, l_zz, values);
    }
  }
  return DVI_OK;
}

dvi_status dvi__lattice_matrix(const dvi__lattice *lattice, const dvi__row *row, double *values)
{
  memset(values, 0, (size_t)dvi__pattern_entries(&lattice->pattern) * sizeof *values);
  dvi__lattice_add_matrix_of_fluxes(lattice, values);
  return dvi__row_visit(lattice, row, DVI__WANT_L_ZZ | DVI__OF_BOTH_LEVELS, add_matrix, values);
}
