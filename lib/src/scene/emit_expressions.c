/* Sums whose kernels have one element each: one straight line, in a loop over points. */
#include <stdlib.h>

#include "scene/emit_parts.h"

/* An output, counted over all parts, that is added to an entry of a result. */
typedef struct contribution {
  int array, entry, output;
} contribution;

typedef struct contributions {
  int count, output_count;
  contribution *list; /* by array, entry and output */
  int *name;          /* [output_count] of the outputs, once they are written */
} contributions;

static int by_entry(const void *first, const void *second)
{
  const contribution *a = first, *b = second;
  if (a->array != b->array) return a->array < b->array ? -1 : 1;
  if (a->entry != b->entry) return a->entry < b->entry ? -1 : 1;
  return (a->output > b->output) - (a->output < b->output);
}

static int entry_of(const dvi__entries *entries)
{
  return dvi__place_at(&entries->minor, 0) + (entries->scale != 0 ? entries->scale * dvi__place_at(&entries->major, 0) : 0);
}

static void collect(const dvi__part *part, contributions *all)
{
  for (int i = 0; i < part->program.output_count; i++, all->output_count++) {
    const dvi__target *target = &part->target[i];
    all->list[all->count++] = (contribution){target->array, entry_of(&target->entry), all->output_count};
    if (target->mirrored) all->list[all->count++] = (contribution){target->array, entry_of(&target->mirror), all->output_count};
  }
}

/* To be freed, also after a failure. */
static dvi_status collect_all(const dvi__sum *sum, contributions *all)
{
  size_t outputs = 1;
  for (int k = 0; k < sum->part_count; k++) outputs += (size_t)sum->part[k].program.output_count;
  *all = (contributions){.list = calloc(2 * outputs, sizeof *all->list), .name = calloc(outputs, sizeof *all->name)};
  if (all->list == NULL || all->name == NULL) return DVI_NO_MEMORY;
  for (int k = 0; k < sum->part_count; k++) collect(&sum->part[k], all);
  qsort(all->list, (size_t)all->count, sizeof *all->list, by_entry);
  return DVI_OK;
}

static int starts_entry(const contributions *all, int i)
{
  return i == 0 || all->list[i].array != all->list[i - 1].array || all->list[i].entry != all->list[i - 1].entry;
}

/* How many entries of an array are written. */
static int entries_written(const contributions *all, int array)
{
  int entries = 0;
  for (int i = 0; i < all->count; i++) entries += all->list[i].array == array && starts_entry(all, i);
  return entries;
}

static void emit_inputs(dvi__emitter *out, const dvi__part *part, const int *name)
{
  for (int i = 0; i < part->variable_count; i++)
    dvi__emit(out, "    const double r%d = x%d[%d * n + k];\n", name[i], (int)part->block[i], dvi__place_at(&part->variable[i], 0));
  for (int c = 0; c < part->column_count; c++) {
    dvi__emit(out, "    const double r%d = ", name[part->variable_count + c]);
    dvi__emit_number(out, part->column[c][0]);
    dvi__emit(out, ";\n");
  }
}

/* The lines of one part; the names of its results are `made`. */
static dvi_status emit_part(dvi__emitter *out, const dvi__part *part, int *next, int *made)
{
  const dvi__program *program = &part->program;
  int *name = dvi__name_rows(part, next);
  if (name == NULL) return DVI_NO_MEMORY;
  emit_inputs(out, part, name + program->row_count);
  dvi__emit_program(out, program, "    ", name, next);
  for (int i = 0; i < program->output_count; i++) made[i] = name[program->row_count - program->output_count + i];
  free(name);
  return DVI_OK;
}

/* The entries, each the sum of what is added to it. */
static void emit_entries(dvi__emitter *out, const contributions *all)
{
  for (int i = 0; i < all->count; i++) {
    const contribution *own = &all->list[i];
    if (starts_entry(all, i)) dvi__emit(out, "%s    y%d[%d * n + k] =", i > 0 ? ";\n" : "", own->array, own->entry);
    dvi__emit(out, "%s r%d", starts_entry(all, i) ? "" : " +", all->name[own->output]);
  }
  if (all->count > 0) dvi__emit(out, ";\n");
}

/* Arrays that are not written in full are zero elsewhere. */
static void emit_zeros(dvi__emitter *out, const dvi__emitted_sum *own, const contributions *all)
{
  for (int a = 0; own->mask >> a != 0; a++)
    if ((own->mask >> a & 1U) != 0 && entries_written(all, a) < own->size[a])
      dvi__emit(out, "  memset(result[%d], 0, (size_t)%d * (size_t)count * sizeof *result[%d]);\n", a, own->size[a], a);
}

dvi_status dvi__emit_expressions(dvi__emitter *out, const dvi__emitted_sum *own)
{
  const dvi__sum *sum = own->sum;
  contributions all;
  dvi_status status = collect_all(sum, &all);
  if (status == DVI_OK) {
    int next = 0, *made = all.name;
    dvi__emit(out, "DVI_INLINE int %s_at(const int careful, int count, const double *const *x, double *const *result)\n{\n",
              own->name);
    dvi__emit(out, "  const ptrdiff_t n = count;\n  int64_t unusual = 0;\n  (void)careful, (void)x, (void)result, (void)n;\n");
    dvi__emit_pointers(out, own, 0, sum->part_count, "");
    emit_zeros(out, own, &all);
    dvi__emit(out, "  DVI_INDEPENDENT\n  for (ptrdiff_t k = 0; k < n; k++) {\n");
    for (int k = 0; k < sum->part_count && status == DVI_OK; made += sum->part[k++].program.output_count)
      status = emit_part(out, &sum->part[k], &next, made);
    emit_entries(out, &all);
    dvi__emit(out, "  }\n  return unusual != 0;\n}\n");
  }
  free(all.list);
  free(all.name);
  return status;
}
