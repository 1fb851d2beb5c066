/* Products of sparse axes. The matrix of a derivative is the Kronecker product of those of the
 * axes, with the first axis slowest. */

#include "core/memory.h"
#include "core/status.h"
#include "field/space/interpolate.h"

/* ---- creation ---- */

static void place_points(const dvi_space *space)
{
  int64_t after = space->points, before = 1;
  for (int64_t i = 0; i < space->points; i++) space->weight[i] = 1;
  for (int d = 0; d < space->dimension; d++) {
    const dvi__line *line = &space->line[d];
    const int64_t own = dvi__line_points(line);
    double *x = space->x + d * space->points;
    after /= own;
    for (int64_t i = 0; i < before * own; i++) {
      double weight;
      const double place = dvi__line_point(line, i % own, &weight);
      for (int64_t j = i * after; j < (i + 1) * after; j++) {
        x[j] = place;
        space->weight[j] *= weight;
      }
    }
    before *= own;
  }
}

/* Count functions and points. */
static dvi_status count_products(dvi_space *space)
{
  double functions = 1, points = 1;
  space->functions = space->points = space->row_entries = 1;
  for (int d = 0; d < space->dimension; d++) {
    functions *= (double)space->line[d].functions;
    points *= (double)dvi__line_points(&space->line[d]);
  }
  DVI_TRY(dvi__space_check_sizes(functions, points));
  space->is_nodal = 1;
  for (int d = 0; d < space->dimension; d++) {
    const dvi__line *line = &space->line[d];
    space->functions *= line->functions;
    space->points *= dvi__line_points(line);
    space->row_entries *= line->locals;
    space->is_nodal = space->is_nodal && line->is_nodal;
    space->smoothness[d] = line->smoothness;
  }
  return DVI_OK;
}

dvi_status dvi__box_place(dvi_space *space)
{
  DVI_TRY(count_products(space));
  space->x = DVI_NEW(double, space->dimension * space->points);
  space->weight = DVI_NEW(double, space->points);
  if (space->x == NULL || space->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld points", (long long)space->points);
  place_points(space);
  return DVI_OK;
}

/* ---- the boundary ---- */

static const char *const sides[2 * DVI_AXES_MAX] = {"left", "right", "bottom",
                                                    "top",  "back",  "front"};

/* Tell if a function does not vanish at side 2 d or 2 d + 1, or at any one if `side` is -1. */
static int is_at(const dvi_space *space, int64_t function, int side)
{
  for (int d = space->dimension - 1; d >= 0; d--) {
    const int64_t own = space->line[d].functions, i = function % own;
    function /= own;
    if (space->line[d].periodic || (side >= 0 && side / 2 != d)) continue;
    if (side % 2 != 1 && i == 0) return 1;
    if (side != 2 * d && i == own - 1) return 1;
  }
  return 0;
}

static dvi_status add_part(dvi_space *space, const char *name, int side)
{
  dvi__space_part *part = &space->part[space->parts++];
  part->name = name;
  for (int64_t i = 0; i < space->functions; i++) part->count += is_at(space, i, side);
  part->function = DVI_NEW(int, part->count);
  if (part->function == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for a boundary");
  int64_t count = 0;
  for (int64_t i = 0; i < space->functions; i++)
    if (is_at(space, i, side)) part->function[count++] = (int)i;
  return DVI_OK;
}

static dvi_status find_boundary(dvi_space *space)
{
  space->part = DVI_NEW(dvi__space_part, 2 * DVI_AXES_MAX + 1);
  if (space->part == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for a boundary");
  DVI_TRY(add_part(space, "boundary", -1));
  for (int side = 0; side < 2 * DVI_AXES_MAX; side++)
    if (side / 2 < space->dimension && !space->line[side / 2].periodic)
      DVI_TRY(add_part(space, sides[side], side));
  return DVI_OK;
}

static dvi_status box_create(const dvi_space_options *options, dvi_space *space)
{
  (void)options;
  DVI_TRY(dvi__box_place(space));
  return find_boundary(space);
}

/* ---- operators ---- */

/* Append the Kronecker product of one row of each axis. */
static int64_t multiply_rows(const dvi__csr *factor, int axes, const int64_t *row, int64_t at,
                             dvi__csr *product)
{
  int64_t entry[DVI_AXES_MAX] = {0};
  for (int d = 0; d < axes; d++) {
    entry[d] = factor[d].start[row[d]];
    if (entry[d] == factor[d].start[row[d] + 1]) return at;
  }
  for (;;) {
    int64_t column = 0;
    double value = 1;
    for (int d = 0; d < axes; d++) {
      column = column * factor[d].columns + factor[d].column[entry[d]];
      value *= factor[d].value[entry[d]];
    }
    product->column[at] = (int)column;
    product->value[at++] = value;
    int d = axes - 1;
    while (d >= 0 && ++entry[d] == factor[d].start[row[d] + 1]) {
      entry[d] = factor[d].start[row[d]];
      d--;
    }
    if (d < 0) return at;
  }
}

static dvi_status multiply_axes(const dvi__csr *factor, int axes, dvi__csr *product)
{
  int64_t rows = 1, columns = 1, entries = 1, row[DVI_AXES_MAX] = {0};
  for (int d = 0; d < axes; d++) {
    rows *= factor[d].rows;
    columns *= factor[d].columns;
    entries *= factor[d].start[factor[d].rows];
  }
  DVI_TRY(dvi__csr_allocate(rows, columns, entries, product));
  for (int64_t i = 0; i < rows; i++) {
    product->start[i + 1] = multiply_rows(factor, axes, row, product->start[i], product);
    for (int d = axes - 1; d >= 0 && ++row[d] == factor[d].rows; d--) row[d] = 0;
  }
  return DVI_OK;
}

static dvi_status box_matrix(const dvi_space *space, const int *order, dvi__csr *made)
{
  dvi__csr factor[DVI_AXES_MAX] = {{0}};
  dvi_status status = dvi__line_operator(&space->line[0], order[0], &factor[0]);
  for (int d = 1; d < space->dimension && status == DVI_OK; d++)
    status = dvi__line_operator(&space->line[d], order[d], &factor[d]);
  if (status == DVI_OK && space->dimension == 1) {
    *made = factor[0];
    return DVI_OK;
  }
  if (status == DVI_OK) status = multiply_axes(factor, space->dimension, made);
  for (int d = 0; d < space->dimension; d++) dvi__csr_clear(&factor[d]);
  return status;
}

static dvi_status box_row(const dvi_space *space, const int *order, const double *x, int *column,
                          double *value, int64_t *count)
{
  int own_column[DVI__LOCALS_MOST];
  double own_value[DVI__LOCALS_MOST];
  *count = 1;
  column[0] = 0;
  value[0] = 1;
  for (int d = 0; d < space->dimension; d++) {
    const dvi__line *line = &space->line[d];
    const int own = dvi__line_row(line, order[d], x[d], own_column, own_value);
    for (int64_t i = *count - 1; i >= 0; i--) /* backwards, because the row grows in place */
      for (int j = own - 1; j >= 0; j--) {
        column[i * own + j] = (int)(column[i] * line->functions + own_column[j]);
        value[i * own + j] = value[i] * own_value[j];
      }
    *count *= own;
  }
  return DVI_OK;
}

/* ---- description ---- */

static void explain_line(const dvi__line *line, dvi__note *note)
{
  dvi__note_add(note, "axis %s, %g to %g%s: %s", line->name, line->from, line->to,
                line->periodic ? ", periodic" : "", line->kind->form.name);
  if (line->degree > 0) dvi__note_add(note, ", degree %d", line->degree);
  dvi__note_add(note, ", %lld %s: %lld functions, ", (long long)line->cells,
                line->cells == 1 ? "cell" : "cells", (long long)line->functions);
  line->kind->explain(line, note);
  dvi__note_add(note, "\n");
}

void dvi__explain_product(const dvi_space *space, dvi__note *note)
{
  if (space->dimension > 1)
    dvi__note_add(note, "product of %d axes: %lld functions, %lld points\n", space->dimension,
                  (long long)space->functions, (long long)space->points);
}

static void box_explain(const dvi_space *space, dvi__note *note)
{
  for (int d = 0; d < space->dimension; d++) explain_line(&space->line[d], note);
  dvi__explain_product(space, note);
  if (space->is_nodal) dvi__note_add(note, "the mass is diagonal\n");
}

const dvi__domain dvi__box = {
    .create = box_create,
    .matrix = box_matrix,
    .row = box_row,
    .evaluate = dvi__evaluate_by_rows,
    .interpolate = dvi__box_interpolate,
    .explain = box_explain,
};
