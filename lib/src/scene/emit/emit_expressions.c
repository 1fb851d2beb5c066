/* Sums whose kernels have one element each. They are one straight line, in a loop over points. */

#include "scene/emit/emit_parts.h"
#include "text/heap.h"

static void emit_point_inputs(dvi__emitter *out, const dvi__part *part, const int *name)
{
  for (int i = 0; i < part->variable_count; i++)
    dvi__emit(out, "    const double r%d = %s[%d * n + k];\n", name[i],
              dvi__block_name[part->block[i]], dvi__place_at(&part->variable[i], 0));
  for (int c = 0; c < part->column_count; c++) {
    dvi__emit(out, "    const double r%d = ", name[part->variable_count + c]);
    dvi__emit_number(out, part->column[c][0]);
    dvi__emit(out, ";\n");
  }
}

/* Write the lines of one part. `made` are the names of its results. */
static dvi_status emit_part(dvi__emitter *out, const dvi__part *part, int *next, int *made)
{
  const dvi__program *program = &part->program;
  int *name = dvi__name_rows(part, next);
  if (name == NULL) return DVI_NO_MEMORY;
  emit_point_inputs(out, part, name + program->row_count);
  dvi__emit_program(out, program, "    ", name, next);
  for (int i = 0; i < program->output_count; i++)
    made[i] = name[program->row_count - program->output_count + i];
  dvi__heap_free(name);
  return DVI_OK;
}

/* Write the entries, each as the sum of its contributions. `name` are the names of outputs. */
static void emit_point_entries(dvi__emitter *out, const dvi__emitted_sum *sum,
                               const dvi__contributions *all, const int *name)
{
  for (int i = 0; i < all->count; i++) {
    const dvi__contribution *own = &all->list[i];
    const int first = dvi__contribution_is_first(all, i);
    if (first)
      dvi__emit(out, "%s    %s[%d * n + k] =", i > 0 ? ";\n" : "", sum->array[own->array],
                own->entry);
    dvi__emit(out, "%sr%d", own->negative ? " - " : first ? " " : " + ", name[own->output]);
  }
  if (all->count > 0) dvi__emit(out, ";\n");
}

/* Write zeros to arrays that are not written in full. */
static void emit_zeros(dvi__emitter *out, const dvi__emitted_sum *own,
                       const dvi__contributions *all)
{
  for (int a = 0; a < own->sum->array_count; a++)
    if (own->sum->wanted[a] && dvi__entries_written(all, a) < own->sum->size[a])
      dvi__emit_zeros(out, own, a);
}

static dvi_status emit_body(dvi__emitter *out, const dvi__emitted_sum *own,
                            const dvi__contributions *all, int *name)
{
  const dvi__function_sum *sum = own->sum;
  dvi_status status = DVI_OK;
  int next = 0, *made = name;
  dvi__emit(out, "DVI_INLINE int %s_at(const int careful, const ptrdiff_t n", own->name);
  dvi__emit_parameters(out, own);
  dvi__emit(out, ")\n{\n  int64_t unusual = 0;\n  (void)careful");
  dvi__emit_mentions(out, own);
  emit_zeros(out, own, all);
  dvi__emit(out, "  DVI_INDEPENDENT\n  for (ptrdiff_t k = 0; k < n; k++) {\n");
  for (int k = 0; k < sum->part_count && status == DVI_OK;
       made += sum->part[k++].program.output_count)
    status = emit_part(out, &sum->part[k], &next, made);
  emit_point_entries(out, own, all, name);
  dvi__emit(out, "  }\n  return unusual != 0;\n}\n");
  return status;
}

dvi_status dvi__emit_expressions(dvi__emitter *out, const dvi__emitted_sum *own)
{
  dvi__contributions all;
  dvi_status status = dvi__contributions_find(own->sum->part_count, own->sum->part, &all);
  int *name = dvi__heap_take((size_t)all.output_count + 1, sizeof *name);
  if (name == NULL) status = DVI_NO_MEMORY;
  if (status == DVI_OK) status = emit_body(out, own, &all, name);
  dvi__heap_free(all.list);
  dvi__heap_free(name);
  return status;
}
