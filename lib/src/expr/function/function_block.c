/* Evaluation of kernels of one element at a few points. Each row is a block of lanes. The number of
 * points is a constant in the loops. Loops of known length need no preparation, which would cost
 * more than their work. */
#include <string.h>

#include "expr/function/function_parts.h"
#include "expr/compile/lanes.h"

DVI__EXPR_INLINE void block_gather(const int points, const dvi__part *part, const double *const *x,
                                   double *registers)
{
  double *row = registers;
  for (int i = 0; i < part->variable_count; i++) {
    const double *from = x[part->block[i]] +
                         (ptrdiff_t)dvi__place_at(&part->variable[i], 0) * points;
    row -= DVI__LANES;
    const double last = from[points - 1];
    memcpy(row, from, (size_t)points * sizeof *row);
    for (int k = points; k < DVI__LANES; k++) row[k] = last;
  }
  for (int c = 0; c < part->column_count; c++) {
    const double value = part->column[c][0];
    row -= DVI__LANES;
    for (int k = 0; k < DVI__LANES; k++) row[k] = value;
  }
}

/* Store results, or add them. They pass through memory of their own, so that the compiler need not
 * ask what else they might overwrite. A stored result is added to zero, which gives the bits of
 * tiles. */
DVI__EXPR_INLINE void block_put(const int points, int sets, double sign, const double *row,
                                double *to)
{
  const size_t size = (size_t)points * sizeof *to;
  double before[DVI__LANES] = {0}, sum[DVI__LANES];
  if (!sets) memcpy(before, to, size);
  memcpy(sum, row, size);
  for (int k = 0; k < points; k++) sum[k] = before[k] + sign * sum[k];
  memcpy(to, sum, size);
}

DVI__EXPR_INLINE void block_scatter(const int points, const dvi__part *part, const double *outputs,
                                    double *const *result)
{
  const dvi__destination *const end = part->target + part->target_count;
  for (const dvi__destination *target = part->target; target < end; target++) {
    const double sign = target->negative ? -1.0 : 1.0,
                 *row = outputs + (ptrdiff_t)target->output * DVI__LANES;
    block_put(points, target->sets, sign, row, result[target->array] + target->single * points);
    if (target->mirrored)
      block_put(points, target->sets, sign, row,
                result[target->array] + target->single_mirror * points);
  }
}

DVI__EXPR_INLINE void block_run(const int points, const dvi__part *part, const double *const *x,
                                double *const *result)
{
  _Alignas(64) double memory[DVI__BLOCK_ROWS * DVI__LANES];
  double *registers = memory + (ptrdiff_t)part->program.input_count * DVI__LANES;
  block_gather(points, part, x, registers);
  dvi__program_run_block(&part->program, points, registers);
  block_scatter(points, part,
                registers +
                    (ptrdiff_t)(part->program.row_count - part->program.output_count) * DVI__LANES,
                result);
}

DVI__EXPR_INLINE void run_points_body(const dvi__part *part, int points, const double *const *x,
                                      double *const *result)
{
  switch (points) {
  case 1: block_run(1, part, x, result); break;
  case 2: block_run(2, part, x, result); break;
  case 3: block_run(3, part, x, result); break;
  case 4: block_run(4, part, x, result); break;
  case 5: block_run(5, part, x, result); break;
  case 6: block_run(6, part, x, result); break;
  case 7: block_run(7, part, x, result); break;
  default: block_run(8, part, x, result);
  }
}

DVI__EXPR_VERSIONS(run_points,
                   (const dvi__part *part, int points, const double *const *x,
                    double *const *result),
                   (part, points, x, result))

void dvi__part_run_block(const dvi__part *part, int points, const double *const *x,
                         double *const *result)
{
  run_points(part, points, x, result);
}
