/* Sums of kernels as C functions. */
#include <stdatomic.h>

#include "scene/emit_parts.h"
#include "scene/heap.h"

int *dvi__name_rows(const dvi__part *part, int *next)
{
  const dvi__program *program = &part->program;
  int *name = dvi__heap_take((size_t)program->row_count + (size_t)program->input_count + 1, sizeof *name);
  for (int i = 0; i < program->input_count && name != NULL; i++) name[program->row_count + i] = (*next)++;
  return name;
}

void dvi__emit_pointers(dvi__emitter *out, const dvi__emitted_sum *own, int first, int last, const char *shift)
{
  unsigned blocks = 0, arrays = 0;
  for (int k = first; k < last; k++) {
    const dvi__part *part = &own->sum->part[k];
    for (int i = 0; i < part->variable_count; i++) blocks |= 1U << part->block[i];
    for (int i = 0; i < part->target_count; i++) arrays |= 1U << part->target[i].array;
  }
  for (int b = 0; blocks >> b != 0; b++)
    if ((blocks >> b & 1U) != 0) dvi__emit(out, "  const double *restrict const x%d = x[%d]%s;\n", b, b, shift);
  for (int a = 0; arrays >> a != 0; a++)
    if ((arrays >> a & 1U) != 0) dvi__emit(out, "  double *restrict const y%d = result[%d]%s;\n", a, a, shift);
}

static int has_one_element(const dvi__sum *sum)
{
  for (int k = 0; k < sum->part_count; k++)
    if (sum->part[k].kernel->elements > 1) return 0;
  return 1;
}

static int has_inverse_roots(const dvi__sum *sum)
{
  for (int k = 0; k < sum->part_count; k++)
    if (dvi__program_has_inverse_roots(&sum->part[k].program)) return 1;
  return 0;
}

static dvi_status emit_sum(dvi__emitter *out, const dvi__emitted_sum *own)
{
  const dvi_status status = has_one_element(own->sum) ? dvi__emit_expressions(out, own) : dvi__emit_elements(out, own);
  if (status != DVI_OK) return status;
  dvi__emit(out, "DVI_LANES static void %s(int count, const double *const *x, double *const *result)\n{\n", own->name);
  if (has_inverse_roots(own->sum))
    dvi__emit(out, "  if (%s_at(0, count, x, result)) (void)%s_at(1, count, x, result);\n}\n\n", own->name, own->name);
  else
    dvi__emit(out, "  (void)%s_at(0, count, x, result);\n}\n\n", own->name);
  return out->failed;
}

dvi_status dvi__emit_value(dvi__emitter *out, dvi__function *function, const char *name)
{
  const dvi_status status = dvi__function_prepare(function, 1, 0, 0);
  if (status != DVI_OK) return status;
  const dvi__emitted_sum own = {atomic_load(&function->value), name, &(int){1}, 1};
  return emit_sum(out, &own);
}

dvi_status dvi__emit_gradient(dvi__emitter *out, dvi__function *function, unsigned blocks, const char *name)
{
  const dvi_status status = dvi__function_prepare(function, 0, blocks, 0);
  if (status != DVI_OK) return status;
  const dvi__emitted_sum own = {atomic_load(&function->gradient[blocks]), name, function->block_size, blocks};
  return emit_sum(out, &own);
}

dvi_status dvi__emit_second(dvi__emitter *out, dvi__function *function, unsigned pairs, const char *name)
{
  int size[DVI__PAIRS];
  const dvi_status status = dvi__function_prepare(function, 0, 0, pairs);
  if (status != DVI_OK) return status;
  for (int pair = 0; pair < DVI__PAIRS; pair++) size[pair] = function->pattern[pair].entries;
  const dvi__emitted_sum own = {atomic_load(&function->second[pairs]), name, size, pairs};
  return emit_sum(out, &own);
}
