/* Evaluation. Tiles of elements and points are gathered into rows, go through the kernel's program,
 * and are added up. */
#include <string.h>

#include "expr/function/function_parts.h"
#include "expr/compile/lanes.h"

enum {
  SMALL = DVI__BLOCK_ROWS * DVI__LANES, /* numbers that fit into the nearest cache */
  MIDDLE = 32768,                       /* numbers that fit into the next one */
  LARGE = DVI__ROWS_MAX * DVI__LANES
};

/* Elements first .. first + elements - 1 at points point .. point + points - 1 of count. A unit has
 * `elements` elements at most. */
typedef struct tile {
  int first, elements, point, points, count;
} tile;

/* Make the number of points a constant, up to a block of them. Loops of known length need no
 * preparation, which would cost more than their work. */
#define FEW_POINTS(X) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8)

/* ---- gather ---- */

/* Copy points. More than a block of points end with a block that overlaps the one before. */
DVI__EXPR_INLINE void copy_points(const int points, const double *restrict from,
                                  double *restrict to)
{
  const int size = points < DVI__LANES ? points : DVI__LANES, last = points - size;
  for (int k = 0; k < last; k += DVI__LANES) memcpy(to + k, from + k, DVI__LANES * sizeof *to);
  memcpy(to + last, from + last, (size_t)size * sizeof *to);
}

/* Copy numbers of one point that follow each other by `step`. The compiler makes vectors of the
 * steps that it knows. */
DVI__EXPR_INLINE void copy_strided(int elements, ptrdiff_t step, const double *restrict from,
                                   double *restrict to)
{
  for (int e = 0; e < elements; e++) to[e] = from[e * step];
}

DVI__EXPR_INLINE void gather_strided(int elements, ptrdiff_t step, const double *restrict from,
                                     double *restrict to)
{
  switch (step) {
  case 0: copy_strided(elements, 0, from, to); break;
  case 1: copy_strided(elements, 1, from, to); break;
  case 2: copy_strided(elements, 2, from, to); break;
  case 3: copy_strided(elements, 3, from, to); break;
  default: copy_strided(elements, step, from, to);
  }
}

/* Gather the numbers of one unit. x is at the tile's first point. */
DVI__EXPR_INLINE void gather_unit(const int points, dvi__track track, int elements, ptrdiff_t count,
                                  const double *restrict x, double *restrict row)
{
  const ptrdiff_t step = track.stride * count;
  const double *restrict from = x + track.start * count;
  if (track.list != NULL)
    for (int e = 0; e < elements; e++)
      copy_points(points, from + track.list[e] * count, row + (ptrdiff_t)e * points);
  else if (points == 1 && elements > 1)
    gather_strided(elements, step, from, row);
  else
    for (int e = 0; e < elements; e++)
      copy_points(points, from + e * step, row + (ptrdiff_t)e * points);
}

DVI__EXPR_INLINE void gather_variable(const int points, const dvi__element_places *places,
                                      const tile *at, const double *x, double *row)
{
  for (int e = 0; e < at->elements; e += DVI__UNIT) {
    const int elements = dvi__unit_size(at->elements, e);
    gather_unit(points, dvi__track_of(places, at->first + e), elements, at->count, x,
                row + (ptrdiff_t)e * points);
  }
}

DVI__EXPR_INLINE void gather_column(const int points, const double *restrict column, int elements,
                                    double *restrict row)
{
  for (int e = 0; e < elements; e++)
    for (int p = 0; p < points; p++) row[e * points + p] = column[e];
}

/* Return the tile's numbers of a variable if they stand in a row already, or NULL. */
static const double *find_standing_row(const dvi__element_places *places, const tile *at,
                                       const double *x)
{
  if (places->list != NULL && at->elements > DVI__UNIT) return NULL;
  const dvi__track track = dvi__track_of(places, at->first);
  if (track.list != NULL || (at->elements > 1 && (track.stride != 1 || at->points != at->count)))
    return NULL;
  return x + (ptrdiff_t)track.start * at->count;
}

/* Point input[] at the rows that the program reads. Rows that do not stand ready as whole blocks
 * are put below the registers, the last one first. One block too many fills the idle lanes of
 * each. */
DVI__EXPR_INLINE void gather_points(const int points, const dvi__part *part, const tile *at,
                                    const double *const *x, const double **input, double *registers)
{
  const int lanes = at->elements * points, width = dvi__row_width(lanes),
            whole = lanes == width && lanes > DVI__LANES;
  double *row = registers - (ptrdiff_t)part->program.input_count * width;
  for (int i = part->program.input_count - 1; i >= 0; i--, row += width) {
    const int c = i - part->variable_count;
    if (c >= 0) {
      input[i] = whole && points == 1 ? part->column[c] + at->first : NULL;
      if (input[i] == NULL) gather_column(points, part->column[c] + at->first, at->elements, row);
    } else {
      const double *from = x[part->block[i]] + at->point;
      input[i] = whole ? find_standing_row(&part->variable[i], at, from) : NULL;
      if (input[i] == NULL) gather_variable(points, &part->variable[i], at, from, row);
    }
    if (input[i] != NULL) continue;
    input[i] = row;
    for (int k = lanes; lanes < width && k < lanes + DVI__LANES; k++) row[k] = row[lanes - 1];
  }
}

DVI__EXPR_INLINE void tile_gather_body(const dvi__part *part, const tile *at,
                                       const double *const *x, const double **input,
                                       double *registers)
{
  switch (at->points) {
#define GATHER(points) \
  case points: gather_points(points, part, at, x, input, registers); break;
    FEW_POINTS(GATHER)
#undef GATHER
  default: gather_points(at->points, part, at, x, input, registers);
  }
}

DVI__EXPR_VERSIONS(tile_gather,
                   (const dvi__part *part, const tile *at, const double *const *x,
                    const double **input, double *registers),
                   (part, at, x, input, registers))

/* ---- scatter, with a `sign` of 1 or -1 ---- */

DVI__EXPR_INLINE void add_points(const int points, double sign, const double *restrict row,
                                 double *restrict to)
{
  const int size = points < DVI__LANES ? points : DVI__LANES, last = points - size;
  double end[DVI__LANES];
  for (int k = 0; k < size; k++) end[k] = to[last + k] + sign * row[last + k];
  for (int k = 0; k < last; k += DVI__LANES)
    for (int i = k; i < k + DVI__LANES; i++) to[i] += sign * row[i];
  memcpy(to + last, end, (size_t)size * sizeof *to);
}

/* Add eight at a time. The ends of longer loops are foreseen more often. */
DVI__EXPR_INLINE void add_strided(int elements, double sign, ptrdiff_t step,
                                  const double *restrict row, double *restrict to)
{
  int e = 0;
  for (; e + DVI__LANES <= elements; e += DVI__LANES, to += DVI__LANES * step)
    for (int i = 0; i < DVI__LANES; i++) to[i * step] += sign * row[e + i];
  for (; e < elements; e++, to += step) *to += sign * row[e];
}

/* Add by a list. An entry that follows itself in the list, as that of the first body of pairs does,
 * waits in a register. */
DVI__EXPR_INLINE void add_listed(int elements, double sign, const int *restrict list,
                                 ptrdiff_t count, const double *restrict row, double *to)
{
  ptrdiff_t at = list[0] * count;
  double sum = to[at];
  for (int e = 0; e < elements; e++) {
    if (list[e] * count != at) {
      to[at] = sum;
      at = list[e] * count;
      sum = to[at];
    }
    sum += sign * row[e];
  }
  to[at] = sum;
}

DVI__EXPR_INLINE void add_unit(const int points, dvi__track track, int elements, ptrdiff_t count,
                               double sign, const double *restrict row, double *restrict result)
{
  const ptrdiff_t step = track.stride * count;
  double *restrict to = result + track.start * count;
  if (track.list != NULL && points == 1)
    add_listed(elements, sign, track.list, count, row, to);
  else if (track.list != NULL)
    for (int e = 0; e < elements; e++)
      add_points(points, sign, row + (ptrdiff_t)e * points, to + track.list[e] * count);
  else if (track.stride == 1 && points == count && elements > 1)
    for (int k = 0; k < elements * points; k++) to[k] += sign * row[k];
  else if (points == 1)
    add_strided(elements, sign, step, row, to);
  else
    for (int e = 0; e < elements; e++)
      add_points(points, sign, row + (ptrdiff_t)e * points, to + e * step);
}

/* Sum the numbers of all elements by halves. `sum` [DVI__LANES_MAX] has room for half of them. */
DVI__EXPR_INLINE void fold_row(int elements, int points, const double *restrict row, double *sum)
{
  int left = (elements + 1) / 2, others = (elements - left) * points;
  for (int k = 0; k < left * points; k++)
    sum[k] = k < others ? row[k] + row[left * points + k] : row[k];
  for (; left > 1; left = (left + 1) / 2) {
    const int half = (left + 1) / 2;
    const double *restrict upper = sum + (ptrdiff_t)half * points;
    double *restrict lower = sum;
    others = (left - half) * points;
    DVI__EXPR_INDEPENDENT
    for (int k = 0; k < others; k++)
      lower[k] += upper[k]; /* NOLINT(clang-analyzer-core.uninitialized.Assign): filled above */
  }
}

/* Add a unit of points of two or three coordinates, which stand side by side. Rows are `pitch`
 * apart. */
DVI__EXPR_INLINE void add_coordinates(const int group, double sign, ptrdiff_t pitch,
                                      const double *row, double *restrict to)
{
  const double *restrict x = row, *restrict y = row + pitch,
                         *restrict z = row + (group - 1) * pitch;
  for (int e = 0; e < DVI__UNIT; e++) {
    to[group * e] += sign * x[e];
    if (group == 3) to[3 * e + 1] += sign * y[e];
    to[group * e + group - 1] += sign * z[e];
  }
}

static int place_in(const dvi__track *track, int e)
{
  return track->start + (track->list != NULL ? track->list[e] : track->stride * e);
}

/* Make the track of entries minor + scale * major. Entries without a stride are listed in `list`
 * [DVI__UNIT]. */
DVI__EXPR_INLINE dvi__track entry_track(const dvi__entries *entries, int first, int elements,
                                        int *list)
{
  const dvi__track minor = dvi__track_of(&entries->minor, first);
  if (entries->scale == 0) return minor;
  const dvi__track major = dvi__track_of(&entries->major, first);
  if (minor.list == NULL && major.list == NULL)
    return (dvi__track){.start = minor.start + entries->scale * major.start,
                        .stride = minor.stride + entries->scale * major.stride};
  int e = 0;
  do list[e] = place_in(&minor, e) + entries->scale * place_in(&major, e);
  while (++e < elements);
  return (dvi__track){.list = list};
}

/* Add a unit's row to its entries. */
DVI__EXPR_INLINE void scatter_unit(const int points, const dvi__entries *entries, int first,
                                   int elements, int count, double sign, const double *row,
                                   double *result)
{
  int list[DVI__UNIT];
  double sum[DVI__LANES_MAX];
  const dvi__track track = entry_track(entries, first, elements, list);
  if (track.list == NULL && track.stride == 0 && elements > 1) {
    if (elements == DVI__UNIT && points == 1)
      fold_row(DVI__UNIT, 1, row, sum);
    else
      fold_row(elements, points, row, sum);
    elements = 1;
    row = sum;
  }
  add_unit(points, track, elements, count, sign, row, result);
}

/* Add a full unit of a group of targets at one point, if they are adjacent. Returns how many
 * targets that were. */
DVI__EXPR_INLINE int scatter_group(const dvi__destination *target, int first, ptrdiff_t pitch,
                                   double sign, const double *row, double *result)
{
  const dvi__track track = dvi__track_of(&target->entry.minor, first);
  const int group = target->group;
  if (group < 2 || track.list != NULL || track.stride != group) return 0;
  if (group == 3)
    add_coordinates(3, sign, pitch, row, result + track.start);
  else
    add_coordinates(2, sign, pitch, row, result + track.start);
  return group;
}

DVI__EXPR_INLINE void scatter_points(const int points, const dvi__part *part, const tile *at,
                                     const double *outputs, double *const *result)
{
  const int width = dvi__row_width(at->elements * points);
  for (int e = 0; e < at->elements; e += DVI__UNIT) {
    const int elements = dvi__unit_size(at->elements, e), first = at->first + e;
    for (int k = 0, added; k < part->target_count; k += added) {
      const dvi__destination *target = &part->target[k];
      const double *row = outputs + (ptrdiff_t)target->output * width + (ptrdiff_t)e * points;
      const double sign = target->negative ? -1.0 : 1.0;
      double *to = result[target->array] + at->point;
      added = points == 1 && at->count == 1 && elements == DVI__UNIT
                  ? scatter_group(target, first, width, sign, row, to)
                  : 0;
      if (added > 0) continue;
      for (int m = 0; m <= target->mirrored; m++)
        scatter_unit(points, m ? &target->mirror : &target->entry, first, elements, at->count, sign,
                     row, to);
      added = 1;
    }
  }
}

DVI__EXPR_INLINE void tile_scatter_body(const dvi__part *part, const tile *at,
                                        const double *outputs, double *const *result)
{
  switch (at->points) {
#define SCATTER(points) \
  case points: scatter_points(points, part, at, outputs, result); break;
    FEW_POINTS(SCATTER)
#undef SCATTER
  default: scatter_points(at->points, part, at, outputs, result);
  }
}

DVI__EXPR_VERSIONS(tile_scatter,
                   (const dvi__part *part, const tile *at, const double *outputs,
                    double *const *result),
                   (part, at, outputs, result))

/* ---- tiles ---- */

/* Choose the shape of tiles for so many points. As many points as possible stand beside a unit,
 * then as many units as possible. */
static tile shape_of(const dvi__part *part, int count)
{
  const int unit = part->unit;
  tile shape = {.elements = unit, .points = count, .count = count};
  if ((ptrdiff_t)unit * count <= part->lanes) {
    if (unit < part->kernel->elements) shape.elements = part->lanes / (unit * count) * unit;
    return shape;
  }
  const int most = part->lanes / unit, chunks = (count + most - 1) / most,
            even = (count + chunks - 1) / chunks;
  if (most < DVI__LANES)
    shape.points = even;
  else
    shape.points = dvi__row_width(even) <= most ? dvi__row_width(even)
                                                : most / DVI__LANES * DVI__LANES;
  return shape;
}

static void run_tile(const dvi__part *part, const tile *at, const double *const *x,
                     double *const *result, const double **input, double *memory)
{
  const int lanes = at->elements * at->points, width = dvi__row_width(lanes),
            outputs = part->program.output_count;
  double *registers = memory + (ptrdiff_t)part->program.input_count * width;
  tile_gather(part, at, x, input, registers);
  if (width == DVI__LANES)
    dvi__program_run_block(&part->program, lanes, registers);
  else
    dvi__program_run(&part->program, lanes, input, registers);
  tile_scatter(part, at, registers + (ptrdiff_t)(part->program.row_count - outputs) * width,
               result);
}

/* Run tiles from the shape's first point on. */
static void run_tiles(const dvi__part *part, const tile *shape, const double *const *x,
                      double *const *result, const double **input, double *memory)
{
  const int all = part->kernel->elements;
  tile at = *shape;
  for (; at.point < at.count; at.point += shape->points) {
    at.points = at.count - at.point < shape->points ? at.count - at.point : shape->points;
    for (at.first = 0; at.first < all; at.first += at.elements) {
      at.elements = all - at.first < shape->elements ? all - at.first : shape->elements;
      run_tile(part, &at, x, result, input, memory);
    }
  }
}

/* Run tiles in small memory, aligned to pages. The processor compares addresses within a page
 * first, and times would depend on the start of the stack. */
static void run_small(const dvi__part *part, const tile *shape, const double *const *x,
                      double *const *result)
{
  _Alignas(4096) double memory[SMALL];
  const double *input[SMALL / DVI__LANES];
  run_tiles(part, shape, x, result, input, memory);
}

static void run_large(const dvi__part *part, const tile *shape, const double *const *x,
                      double *const *result)
{
  _Alignas(64) double memory[LARGE];
  const double *input[DVI__ROWS_MAX];
  run_tiles(part, shape, x, result, input, memory);
}

/* Return the lanes of a tile that has at most so many numbers. */
static int lanes_for(const dvi__part *part, int numbers)
{
  const int lanes = numbers / (part->program.row_count + part->program.input_count) / DVI__LANES *
                    DVI__LANES;
  return lanes < DVI__LANES_MAX ? lanes : DVI__LANES_MAX;
}

dvi_status dvi__part_plan(dvi__part *part)
{
  const int all = part->kernel->elements, large = lanes_for(part, LARGE);
  part->unit = dvi__unit_size(all, 0);
  part->lanes = lanes_for(part, SMALL);
  part->large = part->lanes < part->unit;
  if (!part->large) return DVI_OK;
  part->lanes = lanes_for(part, MIDDLE);
  const int least = dvi__row_width(part->unit);
  if (part->lanes < least) part->lanes = least;
  return least <= large ? DVI_OK : DVI_BAD_SIZE;
}

/* Clear the entries that a part stores, from this point on. Tiles are added, so that stored results
 * are added to zero. */
static void part_clear(const dvi__part *part, int point, int count, double *const *result)
{
  for (const dvi__destination *target = part->target; target < part->target + part->target_count;
       target++)
    for (int m = 0; target->sets && m <= target->mirrored; m++)
      memset(result[target->array] + (m ? target->single_mirror : target->single) * count + point,
             0, (size_t)(count - point) * sizeof **result);
}

static void run_part(const dvi__part *part, int count, const double *const *x,
                     double *const *result)
{
  tile shape = shape_of(part, count);
  if (!part->large) shape.point = dvi__part_run_points(part, count, x, result);
  if (shape.point == count) return;
  if (part->kernel->elements == 1) part_clear(part, shape.point, count, result);
  if (part->large)
    run_large(part, &shape, x, result);
  else
    run_small(part, &shape, x, result);
}

void dvi__sum_add(const dvi__function_sum *sum, int count, const double *const *x,
                  double *const *result)
{
  for (int k = 0; k < sum->part_count; k++) {
    const dvi__part *part = &sum->part[k];
    if (part->kernel->elements == 1 && count <= DVI__LANES && !part->large)
      dvi__part_run_block(part, count, x, result);
    else
      run_part(part, count, x, result);
  }
}
