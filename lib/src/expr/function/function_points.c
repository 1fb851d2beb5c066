/* Evaluation of kernels at many points. Elements go through the program one by one, with points as
 * lanes, so that the program reads most numbers where they stand. The outputs of a unit wait for
 * its last element. They are then added in the order of tiles (function_run.c). */
#include <string.h>

#include "expr/function/function_parts.h"
#include "expr/compile/lanes.h"

enum {
  NUMBERS = 16384, /* numbers that fit into the second-level cache, beside those of the caller */
  /* Fewer points than this have as much work in the program's decisions as in its numbers. */
  LEAST = 4 * DVI__LANES
};

/* Points point .. point + width - 1 of count. */
typedef struct stretch {
  int point, width, count;
} stretch;

/* Where a unit's numbers stand. Registers of element e begin at registers + (elements - 1 - e)
 * outputs rows. Each element's registers thus begin below those of the one before, and end below
 * the outputs of that one. */
typedef struct unit {
  int first, elements;
  double *columns, *registers;
} unit;

/* Return the registers of a program that are not outputs. */
static int scratch_rows(const dvi__program *program)
{
  return program->row_count - program->output_count;
}

static double *registers_of(const dvi__part *part, const unit *u, int e, int width)
{
  const ptrdiff_t rows = (ptrdiff_t)(u->elements - 1 - e) * part->program.output_count;
  return u->registers + rows * width;
}

/* Choose how many points go side by side, 0 if too few would. */
static int width_for(const dvi__part *part, int count)
{
  const dvi__program *program = &part->program;
  const int rows = scratch_rows(program) + part->unit * program->output_count + part->column_count;
  const int room = NUMBERS / rows / DVI__LONG_BLOCK * DVI__LONG_BLOCK,
            most = room < DVI__LANES_MAX ? room : DVI__LANES_MAX,
            whole = count / DVI__LANES * DVI__LANES, width = whole < most ? whole : most;
  return width >= LEAST ? width : 0;
}

DVI__EXPR_INLINE void fill_row(int width, double value, double *restrict row)
{
  for (int first = 0; first < width; first += DVI__LANES)
    DVI__EXPR_INDEPENDENT for (int k = first; k < first + DVI__LANES; k++) row[k] = value;
}

/* Add a row, or store it, added to zero, which gives the bits of tiles. */
DVI__EXPR_INLINE void add_row(const int block, int width, int sets, double sign,
                              const double *restrict row, double *restrict to)
{
  for (int first = 0; first < width; first += block)
    DVI__EXPR_INDEPENDENT for (int k = first; k < first + block; k++)
        to[k] = (sets ? 0.0 : to[k]) + sign * row[k];
}

/* Tell whether all elements of a unit add to one entry. */
DVI__EXPR_INLINE int unit_folds(const dvi__entries *entries, const unit *u)
{
  const dvi__track minor = dvi__track_of(&entries->minor, u->first);
  if (u->elements == 1 || minor.list != NULL) return 0;
  if (entries->scale == 0) return minor.stride == 0;
  const dvi__track major = dvi__track_of(&entries->major, u->first);
  return major.list == NULL && minor.stride + entries->scale * major.stride == 0;
}

/* Add the sum of the elements' rows, `pitch` below each other, which is made by halves as tiles do
 * (fold_row). */
DVI__EXPR_INLINE void add_fold(int elements, int width, double sign, ptrdiff_t pitch,
                               const double *restrict row, double *restrict to)
{
  for (int first = 0; first < width; first += DVI__LANES) {
    double sum[DVI__UNIT][DVI__LANES];
    int loaded = 0;
    do memcpy(sum[loaded], row - loaded * pitch + first, sizeof sum[0]);
    while (++loaded < elements);
    for (int left = elements; left > 1; left = (left + 1) / 2) {
      const int half = (left + 1) / 2;
      for (int e = 0; e < left - half; e++)
        for (int k = 0; k < DVI__LANES; k++) sum[e][k] += sum[half + e][k];
    }
    for (int k = 0; k < DVI__LANES; k++) to[first + k] += sign * sum[0][k];
  }
}

/* Add one output of all elements of a unit to its entries. */
DVI__EXPR_INLINE void add_output(const dvi__part *part, const dvi__destination *target,
                                 const dvi__entries *entries, const stretch *at, const unit *u,
                                 double *result)
{
  const double sign = target->negative ? -1.0 : 1.0;
  const ptrdiff_t output = scratch_rows(&part->program) + target->output;
  if (unit_folds(entries, u)) {
    add_fold(u->elements, at->width, sign, (ptrdiff_t)part->program.output_count * at->width,
             registers_of(part, u, 0, at->width) + output * at->width,
             result + dvi__entry_at(entries, u->first) * at->count + at->point);
    return;
  }
  for (int e = 0; e < u->elements; e++) {
    const double *row = registers_of(part, u, e, at->width) + output * at->width;
    double *to = result + dvi__entry_at(entries, u->first + e) * at->count + at->point;
    if (target->sets)
      add_row(DVI__LANES, at->width, 1, sign, row, to);
    else if (at->width % DVI__LONG_BLOCK == 0)
      add_row(DVI__LONG_BLOCK, at->width, 0, sign, row, to);
    else
      add_row(DVI__LANES, at->width, 0, sign, row, to);
  }
}

DVI__EXPR_INLINE void add_unit_body(const dvi__part *part, const stretch *at, const unit *u,
                                    double *const *result)
{
  for (const dvi__destination *target = part->target; target < part->target + part->target_count;
       target++)
    for (int m = 0; m <= target->mirrored; m++)
      add_output(part, target, m ? &target->mirror : &target->entry, at, u, result[target->array]);
}

DVI__EXPR_VERSIONS(add_unit,
                   (const dvi__part *part, const stretch *at, const unit *u, double *const *result),
                   (part, at, u, result))

DVI__EXPR_INLINE void fill_columns_body(const dvi__part *part, int e, int width, double *columns)
{
  for (int c = 0; c < part->column_count; c++)
    fill_row(width, part->column[c][e], columns + (ptrdiff_t)c * width);
}

DVI__EXPR_VERSIONS(fill_columns, (const dvi__part *part, int e, int width, double *columns),
                   (part, e, width, columns))

static void run_element(const dvi__part *part, const stretch *at, const unit *u, int e,
                        const double *const *x, const double **input)
{
  for (int i = 0; i < part->variable_count; i++)
    input[i] = x[part->block[i]] +
               (ptrdiff_t)dvi__place_at(&part->variable[i], u->first + e) * at->count + at->point;
  fill_columns(part, u->first + e, at->width, u->columns);
  dvi__program_run(&part->program, at->width, input, registers_of(part, u, e, at->width));
}

static void run_stretch(const dvi__part *part, const stretch *at, const double *const *x,
                        double *const *result, const double **input, double *memory)
{
  unit u = {.columns = memory, .registers = memory + (ptrdiff_t)part->column_count * at->width};
  for (int c = 0; c < part->column_count; c++)
    input[part->variable_count + c] = u.columns + (ptrdiff_t)c * at->width;
  for (u.first = 0; u.first < part->kernel->elements; u.first += DVI__UNIT) {
    u.elements = dvi__unit_size(part->kernel->elements, u.first);
    for (int e = 0; e < u.elements; e++) run_element(part, at, &u, e, x, input);
    add_unit(part, at, &u, result);
  }
}

int dvi__part_run_points(const dvi__part *part, int count, const double *const *x,
                         double *const *result)
{
  _Alignas(4096) double memory[NUMBERS];
  const double *input[DVI__BLOCK_ROWS]; /* a part that is not large has no more */
  const int whole = count / DVI__LANES * DVI__LANES;
  stretch at = {.width = width_for(part, count), .count = count};
  if (at.width == 0) return 0;
  for (; at.point < whole; at.point += at.width) {
    if (whole - at.point < at.width) at.width = whole - at.point;
    run_stretch(part, &at, x, result, input, memory);
  }
  return whole;
}
