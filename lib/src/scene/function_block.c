/* Evaluation of kernels of one element at a few points: each row is a block of lanes. The number of points is a constant to what follows: loops of known length need
 * no preparation, which would cost more than their work. */
#include "scene/function_parts.h"
#include "scene/lanes.h"

DVI__SCENE_INLINE void gather(const int points, const dvi__part *part, const double *const *x, double *registers)
{
  double *row = registers;
  for (int i = 0; i < part->variable_count; i++) {
    const double *from = x[part->block[i]] + (ptrdiff_t)dvi__place_at(&part->variable[i], 0) * points;
    row -= DVI__LANES;
    for (int k = 0; k < points; k++) row[k] = from[k];
    for (int k = points; k < DVI__LANES; k++) row[k] = from[points - 1];
  }
  for (int c = 0; c < part->column_count; c++) {
    row -= DVI__LANES;
    for (int k = 0; k < DVI__LANES; k++) row[k] = part->column[c][0];
  }
}

DVI__SCENE_INLINE void scatter(const int points, const dvi__part *part, const double *outputs, double *const *result)
{
  for (const dvi__destination *target = part->target; target < part->target + part->target_count; target++) {
    const double sign = target->negative ? -1.0 : 1.0, *restrict row = outputs + (ptrdiff_t)target->output * DVI__LANES;
    for (int m = 0; m <= target->mirrored; m++) {
      const ptrdiff_t entry = dvi__entry_at(m == 0 ? &target->entry : &target->mirror, 0);
      double *restrict to = result[target->array] + entry * points;
      if (target->sets)
        for (int k = 0; k < points; k++) to[k] = sign * row[k];
      else
        for (int k = 0; k < points; k++) to[k] += sign * row[k];
    }
  }
}

DVI__SCENE_INLINE void run(const int points, const dvi__part *part, const double *const *x, double *const *result)
{
  _Alignas(64) double memory[DVI__BLOCK_ROWS * DVI__LANES];
  double *registers = memory + (ptrdiff_t)part->program.input_count * DVI__LANES;
  gather(points, part, x, registers);
  dvi__program_run_block(&part->program, points, registers);
  scatter(points, part, registers + (ptrdiff_t)(part->program.row_count - part->program.output_count) * DVI__LANES, result);
}

DVI__SCENE_LANES static void run_points(const dvi__part *part, int points, const double *const *x, double *const *result)
{
  switch (points) {
  case 1: run(1, part, x, result); break;
  case 2: run(2, part, x, result); break;
  case 3: run(3, part, x, result); break;
  case 4: run(4, part, x, result); break;
  case 5: run(5, part, x, result); break;
  case 6: run(6, part, x, result); break;
  case 7: run(7, part, x, result); break;
  default: run(8, part, x, result);
  }
}

void dvi__part_run_block(const dvi__part *part, int points, const double *const *x, double *const *result)
{
  run_points(part, points, x, result);
}
