/* Evaluation: tiles of elements and points are gathered into rows, go through the kernel's program, and are added up. */
#include <string.h>

#include "scene/function_parts.h"
#include "scene/lanes.h"

enum {
  HALF = DVI__LANES / 2,
  SMALL = 4096,   /* numbers that stay in the nearest cache */
  MIDDLE = 32768, /* that stay in the next one */
  LARGE = DVI__ROWS_MAX * DVI__LANES
};

/* Elements first .. first + elements - 1 at points point .. point + points - 1 of count; so many elements a unit has. */
typedef struct tile {
  int first, elements, point, points, count;
} tile;

/* --- Gather. --- */

DVI__SCENE_INLINE void copy_run(int points, const double *restrict from, double *restrict to)
{
  int k = 0;
  for (; k + DVI__LANES <= points; k += DVI__LANES) memcpy(to + k, from + k, DVI__LANES * sizeof *to);
  for (; k + HALF <= points; k += HALF) memcpy(to + k, from + k, HALF * sizeof *to);
  for (; k < points; k++) to[k] = from[k];
}

/* Numbers of one point that follow each other by `step`. The compiler makes vectors of the steps that it knows. */
DVI__SCENE_INLINE void copy_strided(int elements, ptrdiff_t step, const double *restrict from, double *restrict to)
{
  for (int e = 0; e < elements; e++) to[e] = from[e * step];
}

DVI__SCENE_INLINE void gather_strided(int elements, ptrdiff_t step, const double *restrict from, double *restrict to)
{
  switch (step) {
  case 0: copy_strided(elements, 0, from, to); break;
  case 1: copy_strided(elements, 1, from, to); break;
  case 2: copy_strided(elements, 2, from, to); break;
  case 3: copy_strided(elements, 3, from, to); break;
  default: copy_strided(elements, step, from, to);
  }
}

/* The numbers of one unit; x is at the tile's first point. */
DVI__SCENE_INLINE void gather_unit(dvi__track track, int elements, int points, int count, const double *restrict x,
                                   double *restrict row)
{
  const ptrdiff_t step = (ptrdiff_t)track.stride * count;
  const double *restrict from = x + (ptrdiff_t)track.start * count;
  if (track.list != NULL && points == 1)
    for (int e = 0; e < elements; e++) row[e] = from[(ptrdiff_t)track.list[e] * count];
  else if (track.list != NULL)
    for (int e = 0; e < elements; e++) copy_run(points, from + (ptrdiff_t)track.list[e] * count, row + (ptrdiff_t)e * points);
  else if (points == 1)
    gather_strided(elements, step, from, row);
  else if (track.stride == 1 && points == count)
    memcpy(row, from, (size_t)elements * (size_t)points * sizeof *row);
  else
    for (int e = 0; e < elements; e++) copy_run(points, from + e * step, row + (ptrdiff_t)e * points);
}

/* Where the tile's numbers of a variable stand in a row already, or NULL. */
DVI__SCENE_INLINE const double *standing(const dvi__places *places, const tile *at, const double *x)
{
  if (places->list != NULL && at->elements > DVI__UNIT) return NULL;
  const dvi__track track = dvi__track_of(places, at->first);
  if (track.list != NULL || (at->elements > 1 && (track.stride != 1 || at->points != at->count))) return NULL;
  return x + (ptrdiff_t)track.start * at->count;
}

DVI__SCENE_INLINE void gather_variable(const dvi__places *places, const tile *at, const double *x, double *row)
{
  for (int e = 0; e < at->elements; e += DVI__UNIT) {
    const int elements = dvi__unit_size(at->elements, e);
    gather_unit(dvi__track_of(places, at->first + e), elements, at->points, at->count, x, row + (ptrdiff_t)e * at->points);
  }
}

DVI__SCENE_INLINE void gather_column(const double *column, const tile *at, double *row)
{
  for (int e = 0; e < at->elements; e++)
    for (int p = 0; p < at->points; p++) row[e * at->points + p] = column[at->first + e];
}

/* Point input[] at the rows that the program reads. What does not stand ready is put into `rows`. */
DVI__SCENE_LANES static void gather(const dvi__part *part, const tile *at, const double *const *x, const double **input,
                                    double *rows)
{
  const int lanes = at->elements * at->points, width = dvi__row_width(lanes), whole = lanes == width;
  for (int i = 0; i < part->variable_count + part->column_count; i++, rows += width) {
    const int c = i - part->variable_count;
    if (c < 0) {
      const double *from = x[part->block[i]] + at->point;
      input[i] = whole ? standing(&part->variable[i], at, from) : NULL;
      if (input[i] != NULL) continue;
      gather_variable(&part->variable[i], at, from, rows);
    } else {
      input[i] = whole && at->points == 1 ? part->column[c] + at->first : NULL;
      if (input[i] != NULL) continue;
      gather_column(part->column[c], at, rows);
    }
    for (int k = lanes; k < width; k++) rows[k] = rows[lanes - 1];
    input[i] = rows;
  }
}

/* --- Scatter: `sign` is 1 or -1. --- */

DVI__SCENE_INLINE void add_run(int points, double sign, const double *restrict row, double *restrict to)
{
  int k = 0;
  for (; k + DVI__LANES <= points; k += DVI__LANES)
    for (int i = k; i < k + DVI__LANES; i++) to[i] += sign * row[i];
  for (; k + HALF <= points; k += HALF)
    for (int i = k; i < k + HALF; i++) to[i] += sign * row[i];
  for (; k < points; k++) to[k] += sign * row[k];
}

/* Eight at a time: the ends of longer loops are foreseen more often. */
DVI__SCENE_INLINE void add_strided(int elements, double sign, ptrdiff_t step, const double *restrict row, double *restrict to)
{
  int e = 0;
  for (; e + DVI__LANES <= elements; e += DVI__LANES, to += DVI__LANES * step)
    for (int i = 0; i < DVI__LANES; i++) to[i * step] += sign * row[e + i];
  for (; e < elements; e++, to += step) *to += sign * row[e];
}

/* An entry that follows itself in the list, as that of the first body of pairs does, waits in a register. */
DVI__SCENE_INLINE void add_listed(int elements, double sign, const int *restrict list, ptrdiff_t count, const double *restrict row,
                                  double *to)
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

DVI__SCENE_INLINE void add_unit(dvi__track track, int elements, int points, int count, double sign, const double *restrict row,
                                double *restrict result)
{
  const ptrdiff_t step = (ptrdiff_t)track.stride * count;
  double *restrict to = result + (ptrdiff_t)track.start * count;
  if (track.list != NULL && points == 1)
    add_listed(elements, sign, track.list, count, row, to);
  else if (track.list != NULL)
    for (int e = 0; e < elements; e++) add_run(points, sign, row + (ptrdiff_t)e * points, to + (ptrdiff_t)track.list[e] * count);
  else if (track.stride == 1 && points == count)
    for (int k = 0; k < elements * points; k++) to[k] += sign * row[k];
  else if (points == 1)
    add_strided(elements, sign, step, row, to);
  else
    for (int e = 0; e < elements; e++) add_run(points, sign, row + (ptrdiff_t)e * points, to + e * step);
}

/* The sum of all elements' numbers, by halves; `sum` [DVI__LANES_MAX] has room for half of them. */
DVI__SCENE_INLINE void fold(int elements, int points, const double *restrict row, double *sum)
{
  int left = (elements + 1) / 2, others = (elements - left) * points;
  for (int k = 0; k < left * points; k++) sum[k] = k < others ? row[k] + row[left * points + k] : row[k];
  for (; left > 1; left = (left + 1) / 2) {
    const int half = (left + 1) / 2;
    const double *restrict upper = sum + (ptrdiff_t)half * points;
    double *restrict lower = sum;
    others = (left - half) * points;
    DVI__SCENE_INDEPENDENT
    for (int k = 0; k < others; k++) lower[k] += upper[k]; /* NOLINT(clang-analyzer-core.uninitialized.Assign): filled above */
  }
}

/* A unit of points of two or three coordinates, which stand side by side; rows are `pitch` apart. */
DVI__SCENE_INLINE void add_points(const int group, double sign, ptrdiff_t pitch, const double *row, double *restrict to)
{
  const double *restrict x = row, *restrict y = row + pitch, *restrict z = row + (group - 1) * pitch;
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

/* The track of entries minor + scale * major; `list` [DVI__UNIT] is for those that have no stride. */
DVI__SCENE_INLINE dvi__track entry_track(const dvi__entries *entries, int first, int elements, int *list)
{
  const dvi__track minor = dvi__track_of(&entries->minor, first);
  if (entries->scale == 0) return minor;
  const dvi__track major = dvi__track_of(&entries->major, first);
  if (minor.list == NULL && major.list == NULL)
    return (dvi__track){NULL, minor.start + entries->scale * major.start, minor.stride + entries->scale * major.stride};
  for (int e = 0; e < elements; e++) list[e] = place_in(&minor, e) + entries->scale * place_in(&major, e);
  return (dvi__track){list, 0, 0};
}

/* Add a unit's row to its entries. */
DVI__SCENE_INLINE void scatter_unit(const dvi__entries *entries, int first, int elements, const tile *at, int negative,
                                    const double *row, double *result)
{
  int list[DVI__UNIT];
  double sum[DVI__LANES_MAX];
  const dvi__track track = entry_track(entries, first, elements, list);
  if (track.list == NULL && track.stride == 0 && elements > 1) {
    if (elements == DVI__UNIT && at->points == 1)
      fold(DVI__UNIT, 1, row, sum);
    else
      fold(elements, at->points, row, sum);
    elements = 1;
    row = sum;
  }
  if (negative)
    add_unit(track, elements, at->points, at->count, -1.0, row, result);
  else
    add_unit(track, elements, at->points, at->count, 1.0, row, result);
}

/* Add a full unit of a group of targets at one point, if they lie so. Returns how many targets that were. */
DVI__SCENE_INLINE int scatter_points(const dvi__destination *target, int first, ptrdiff_t pitch, const double *row, double *result)
{
  const dvi__track track = dvi__track_of(&target->entry.minor, first);
  const int group = target->group;
  if (group < 2 || track.list != NULL || track.stride != group) return 0;
  const double sign = target->negative ? -1.0 : 1.0;
  if (group == 3)
    add_points(3, sign, pitch, row, result + track.start);
  else
    add_points(2, sign, pitch, row, result + track.start);
  return group;
}

DVI__SCENE_LANES static void scatter(const dvi__part *part, const tile *at, const double *outputs, double *const *result)
{
  const int width = dvi__row_width(at->elements * at->points);
  for (int e = 0; e < at->elements; e += DVI__UNIT) {
    const int elements = dvi__unit_size(at->elements, e);
    for (int k = 0, added; k < part->target_count; k += added) {
      const dvi__destination *target = &part->target[k];
      const double *row = outputs + (ptrdiff_t)target->output * width + (ptrdiff_t)e * at->points;
      double *to = result[target->array] + at->point;
      added = at->count == 1 && elements == DVI__UNIT ? scatter_points(target, at->first + e, width, row, to) : 0;
      if (added > 0) continue;
      scatter_unit(&target->entry, at->first + e, elements, at, target->negative, row, to);
      if (target->mirrored) scatter_unit(&target->mirror, at->first + e, elements, at, target->negative, row, to);
      added = 1;
    }
  }
}

/* --- Tiles. --- */

/* The shape of tiles at so many points: as many points as fit beside a unit, then as many units as fit. */
static tile shape_of(const dvi__part *part, int count)
{
  const int unit = part->unit;
  tile shape = {.elements = unit, .points = count, .count = count};
  if ((ptrdiff_t)unit * count <= part->lanes) {
    if (unit < part->kernel->elements) shape.elements = part->lanes / (unit * count) * unit;
    return shape;
  }
  const int most = part->lanes / unit, chunks = (count + most - 1) / most, even = (count + chunks - 1) / chunks;
  if (most < DVI__LANES)
    shape.points = even;
  else
    shape.points = dvi__row_width(even) <= most ? dvi__row_width(even) : most / DVI__LANES * DVI__LANES;
  return shape;
}

static void run_tile(const dvi__part *part, const tile *at, const double *const *x, double *const *result, const double **input,
                     double *memory)
{
  const int lanes = at->elements * at->points, width = dvi__row_width(lanes), outputs = part->program.output_count;
  double *registers = memory + (ptrdiff_t)part->program.input_count * width;
  gather(part, at, x, input, memory);
  dvi__program_run(&part->program, lanes, input, registers);
  scatter(part, at, registers + (ptrdiff_t)(part->program.row_count - outputs) * width, result);
}

static void run_tiles(const dvi__part *part, const tile *shape, const double *const *x, double *const *result, const double **input,
                      double *memory)
{
  const int all = part->kernel->elements;
  tile at = *shape;
  for (at.point = 0; at.point < at.count; at.point += shape->points) {
    at.points = at.count - at.point < shape->points ? at.count - at.point : shape->points;
    for (at.first = 0; at.first < all; at.first += at.elements) {
      at.elements = all - at.first < shape->elements ? all - at.first : shape->elements;
      run_tile(part, &at, x, result, input, memory);
    }
  }
}

static void run_small(const dvi__part *part, const tile *shape, const double *const *x, double *const *result)
{
  _Alignas(64) double memory[SMALL];
  const double *input[SMALL / DVI__LANES];
  run_tiles(part, shape, x, result, input, memory);
}

static void run_large(const dvi__part *part, const tile *shape, const double *const *x, double *const *result)
{
  _Alignas(64) double memory[LARGE];
  const double *input[DVI__ROWS_MAX];
  run_tiles(part, shape, x, result, input, memory);
}

/* Lanes of a tile of which so many numbers are wanted at most. */
static int lanes_for(const dvi__part *part, int numbers)
{
  const int lanes = numbers / (part->program.row_count + part->program.input_count) / DVI__LANES * DVI__LANES;
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

void dvi__sum_add(const dvi__sum *sum, int count, const double *const *x, double *const *result)
{
  for (int k = 0; k < sum->part_count; k++) {
    const dvi__part *part = &sum->part[k];
    const tile shape = shape_of(part, count);
    if (part->large)
      run_large(part, &shape, x, result);
    else
      run_small(part, &shape, x, result);
  }
}
