/* Evaluation of Taylor coefficients along a curve. It goes element by element, and each row is a
 * series. */
#include <string.h>

#include "expr/function/function_parts.h"

enum { NUMBERS = DVI__ROWS_MAX * DVI__LANES };

/* Gather the inputs of element e. Row i stands `i + 1` rows below the registers. A column is a
 * series of one coefficient. */
static void series_gather(const dvi__part *part, int e, int count, const int *width,
                          const double *const *x, double *registers)
{
  double *row = registers;
  for (int i = 0; i < part->variable_count; i++) {
    const int size = width[part->block[i]];
    const double *from = x[part->block[i]] + dvi__place_at(&part->variable[i], e);
    row -= count;
    for (int k = 0; k < count; k++) row[k] = from[(ptrdiff_t)k * size];
  }
  for (int c = 0; c < part->column_count; c++) {
    row -= count;
    memset(row, 0, (size_t)count * sizeof *row);
    row[0] = part->column[c][e];
  }
}

static void series_scatter(const dvi__part *part, int e, int count, const int *size,
                           const double *outputs, double *const *result)
{
  for (const dvi__destination *target = part->target; target < part->target + part->target_count;
       target++) {
    const double sign = target->negative ? -1.0 : 1.0,
                 *row = outputs + (ptrdiff_t)target->output * count;
    for (int m = 0; m <= target->mirrored; m++) {
      double *to = result[target->array] + dvi__entry_at(m ? &target->mirror : &target->entry, e);
      for (int k = 0; k < count; k++) to[(ptrdiff_t)k * size[target->array]] += sign * row[k];
    }
  }
}

dvi_status dvi__sum_add_series(const dvi__function_sum *sum, int count, const int *width,
                               const double *const *x, double *const *result)
{
  _Alignas(64) double memory[NUMBERS];
  for (int p = 0; p < sum->part_count; p++) {
    const dvi__part *part = &sum->part[p];
    const dvi__program *program = &part->program;
    if (program->row_count + program->input_count > NUMBERS / count) return DVI_BAD_SIZE;
    double *registers = memory + (ptrdiff_t)program->input_count * count;
    const double *outputs = registers +
                            (ptrdiff_t)(program->row_count - program->output_count) * count;
    for (int e = 0; e < part->kernel->elements; e++) {
      series_gather(part, e, count, width, x, registers);
      dvi__program_run_series(program, count - 1, registers);
      series_scatter(part, e, count, sum->size, outputs, result);
    }
  }
  return DVI_OK;
}
