/* Sums with kernels of many elements. Each kernel gets a function of one unit of elements. Its
 * results are kept until the unit is done and then added output by output, as the byte code does.
 * It is compiled for eight, four, two and one point, and for the flat rows of a chain, which are
 * neighbours in a row whose points follow each other. */
#include <stdio.h>

#include "scene/emit/emit_parts.h"
#include "text/heap.h"

enum { ROOM = 8192, ROOM_MAX = 131072, TERMS_MAX = 1024 };

/* ---- sums that are written out ---- */

/* Return how many terms the sums of a short part have. */
static int terms_of(const dvi__part *part)
{
  int additions = 0;
  for (int k = 0; k < part->target_count; k++) additions += 1 + part->target[k].mirrored;
  return additions * part->kernel->elements;
}

/* Return 1 if all elements are one unit, of which every entry's sum is written out. */
static int part_is_short(const dvi__part *part)
{
  const int elements = part->kernel->elements;
  int few = elements <= DVI__UNIT && terms_of(part) <= TERMS_MAX;
  for (int k = 0; k < part->target_count && elements > 1; k++) {
    const dvi__destination *target = &part->target[k];
    few = few && !dvi__is_one_entry(&target->entry, 0) &&
          !(target->mirrored && dvi__is_one_entry(&target->mirror, 0));
  }
  return few;
}

/* ---- arrays, before the functions ---- */

static void declare_element_places(dvi__emitter *out, const dvi__element_places *places,
                                   int elements)
{
  if (places->list != NULL) (void)dvi__emit_ints(out, elements, places->list);
}

static dvi_status declare_arrays(dvi__emitter *out, const dvi__emitted_sum *own,
                                 const dvi__part *part, dvi__additions *additions)
{
  const int elements = part->kernel->elements;
  dvi_status status = DVI_OK;
  for (int i = 0; i < part->variable_count; i++)
    declare_element_places(out, &part->variable[i], elements);
  for (int c = 0; c < part->column_count; c++)
    (void)dvi__emit_doubles(out, elements, part->column[c]);
  for (int a = 0; a < own->sum->array_count && status == DVI_OK && !part_is_short(part); a++)
    status = dvi__additions_declare(out, part, a, &additions[a]);
  return status;
}

/* ---- a unit ---- */

/* Write the place of element first + e. */
static void emit_place(dvi__emitter *out, const dvi__element_places *places, int elements)
{
  if (places->list != NULL)
    dvi__emit(out, "(%d + dvi_list_%d[first + e])", places->start,
              dvi__emit_ints(out, elements, places->list));
  else if (places->stride == 0)
    dvi__emit(out, "%d", places->start);
  else
    dvi__emit(out, "(%d + %d * (first + e))", places->start, places->stride);
}

static void emit_unit_inputs(dvi__emitter *out, const dvi__part *part, const int *name)
{
  const int elements = part->kernel->elements;
  for (int i = 0; i < part->variable_count; i++) {
    dvi__emit(out, "      const double r%d = %s[", name[i], dvi__block_name[part->block[i]]);
    emit_place(out, &part->variable[i], elements);
    dvi__emit(out, " * n + p];\n");
  }
  for (int c = 0; c < part->column_count; c++)
    dvi__emit(out, "      const double r%d = dvi_row_%d[first + e];\n",
              name[part->variable_count + c], dvi__emit_doubles(out, elements, part->column[c]));
}

/* Write all entries of a short part. Each is the sum of its contributions, added to zero in arrays
 * that the part stores. */
static dvi_status emit_short_entries(dvi__emitter *out, const dvi__emitted_sum *sum,
                                     const dvi__part *part, unsigned stored)
{
  dvi__contributions all;
  const dvi_status status = dvi__contributions_find(1, part, &all);
  dvi__emit(out, "  DVI_INDEPENDENT\n  for (int p = 0; p < points; p++) {\n");
  for (int i = 0; i < all.count; i++) {
    const dvi__contribution *own = &all.list[i];
    const char *array = sum->array[own->array];
    if (dvi__contribution_is_first(&all, i)) {
      dvi__emit(out, "%s    %s[%d * n + p] = ", i > 0 ? ";\n" : "", array, own->entry);
      if ((stored >> own->array & 1U) != 0)
        dvi__emit(out, "0.0");
      else
        dvi__emit(out, "%s[%d * n + p]", array, own->entry);
    }
    dvi__emit(out, " %c y[%d][%d * points + p]", own->negative ? '-' : '+', own->output,
              own->element);
  }
  dvi__emit(out, "%s  }\n", all.count > 0 ? ";\n" : "");
  dvi__heap_free(all.list);
  return status;
}

/* Return the elements of a unit and choose how many points are taken at once. All results of a unit
 * stay in a near cache, and the code is soon compiled. */
static int choose_unit(const dvi__part *part)
{
  return part->kernel->elements < DVI__UNIT ? part->kernel->elements : DVI__UNIT;
}

static int points_of(const dvi__emitted_sum *own, const dvi__part *part)
{
  int points = own->points;
  while (points > 1 && part->program.output_count * choose_unit(part) * points > ROOM) points /= 2;
  while (points > 1 && part_is_short(part) && terms_of(part) * points > TERMS_MAX) points /= 2;
  return points;
}

static dvi_status emit_unit(dvi__emitter *out, const dvi__emitted_sum *own, int k,
                            const dvi__additions *additions, unsigned stored)
{
  const dvi__part *part = &own->sum->part[k];
  const dvi__program *program = &part->program;
  int next = 0, *name = dvi__name_rows(part, &next);
  if (name == NULL) return DVI_NO_MEMORY;
  dvi__emit(
      out,
      "DVI_INLINE int64_t %s_%d(const int careful, const int points, int first, int elements,\n",
      own->name, k);
  dvi__emit(out, "    const ptrdiff_t n, ptrdiff_t k");
  dvi__emit_parameters(out, own);
  dvi__emit(out, ")\n{\n");
  const int lanes = choose_unit(part) * points_of(own, part);
  dvi__emit(out, "  double y[%d][%d], sum[%d];\n", program->output_count, lanes, lanes);
  dvi__emit(out, "  int64_t unusual = 0;\n  (void)careful, (void)first, (void)sum");
  dvi__emit_mentions(out, own);
  dvi__emit_shifts(out, own, part);
  dvi__emit(out, "  DVI_INDEPENDENT\n  for (int e = 0; e < elements; e++) {\n    DVI_INDEPENDENT\n "
                 "   for (int p = 0; p < points; p++) {\n");
  emit_unit_inputs(out, part, name + program->row_count);
  dvi__emit_program(out, program, "      ", name, &next);
  for (int i = 0; i < program->output_count; i++)
    dvi__emit(out, "      y[%d][e * points + p] = r%d;\n", i,
              name[program->row_count - program->output_count + i]);
  dvi__emit(out, "    }\n  }\n");
  dvi__heap_free(name);
  dvi_status status = DVI_OK;
  if (part_is_short(part)) status = emit_short_entries(out, own, part, k == 0 ? stored : 0);
  for (int a = 0; a < own->sum->array_count && !part_is_short(part); a++)
    dvi__additions_emit(out, &additions[a], own->array[a], part->kernel->elements);
  dvi__emit(out, "  return unusual;\n}\n");
  return status;
}

/* ---- all units, at all points ---- */

static int is_row(const dvi__element_places *places)
{
  return places->list == NULL && places->stride == 1;
}

/* Return 1 if elements are neighbours in all that they read and write. */
static int is_flat(const dvi__part *part)
{
  int flat = part->column_count == 0 && !part_is_short(part);
  for (int i = 0; i < part->variable_count; i++) flat &= is_row(&part->variable[i]);
  for (int k = 0; k < part->target_count; k++) {
    const dvi__destination *target = &part->target[k];
    flat &= target->entry.scale == 0 && is_row(&target->entry.minor);
    flat &= !target->mirrored || (target->mirror.scale == 0 && is_row(&target->mirror.minor));
  }
  return flat;
}

static void emit_unit_call(dvi__emitter *out, const dvi__emitted_sum *own, int k,
                           const char *first_arguments)
{
  dvi__emit(out, "unusual |= %s_%d(careful, %s", own->name, k, first_arguments);
  dvi__emit_arguments(out, own);
  dvi__emit(out, ");\n");
}

static void emit_calls(dvi__emitter *out, const dvi__emitted_sum *own, int k)
{
  const dvi__part *part = &own->sum->part[k];
  const int all = part->kernel->elements, most = points_of(own, part);
  dvi__emit(out, "  for (int first = 0; first < %d; first += %d) {\n", all, DVI__UNIT);
  if (all <= DVI__UNIT)
    dvi__emit(out, "    const int elements = %d;\n", all);
  else
    dvi__emit(out, "    const int elements = %d - first < %d ? %d - first : %d;\n", all, DVI__UNIT,
              all, DVI__UNIT);
  dvi__emit(out, "    ptrdiff_t k = 0;\n");
  if (is_flat(part)) {
    dvi__emit(out, "    if (n <= %d) {\n      ", most);
    emit_unit_call(out, own, k, "elements * (int)n, first, 1, n, 0");
    dvi__emit(out, "      continue;\n    }\n");
  }
  for (int points = most; points > 1; points /= 2) {
    char arguments[40];
    (void)snprintf(arguments, sizeof arguments, "%d, first, elements, n, k", points);
    dvi__emit(out, "    for (; !careful && k + %d <= n; k += %d) ", points, points);
    emit_unit_call(out, own, k, arguments);
  }
  dvi__emit(out, "    for (; k < n; k++) ");
  emit_unit_call(out, own, k, "1, first, elements, n, k");
  dvi__emit(out, "  }\n");
}

/* Find the arrays that the first part stores, so that they need not be zero before. */
static dvi_status find_stored(const dvi__emitted_sum *own, unsigned *stored)
{
  dvi__contributions all;
  *stored = 0;
  if (own->sum->part_count == 0 || !part_is_short(own->sum->part)) return DVI_OK;
  const dvi_status status = dvi__contributions_find(1, own->sum->part, &all);
  for (int a = 0; a < own->sum->array_count && status == DVI_OK; a++)
    if (own->sum->wanted[a] && dvi__entries_written(&all, a) == own->sum->size[a])
      *stored |= 1U << a;
  dvi__heap_free(all.list);
  return status;
}

static int is_too_large(const dvi__part *part)
{
  return (long)part->program.output_count * choose_unit(part) > ROOM_MAX;
}

dvi_status dvi__emit_elements(dvi__emitter *out, const dvi__emitted_sum *own)
{
  unsigned stored;
  dvi_status status = find_stored(own, &stored);
  if (status != DVI_OK) return status;
  for (int k = 0; k < own->sum->part_count; k++) {
    dvi__additions additions[DVI__PAIRS];
    if (is_too_large(&own->sum->part[k])) return DVI_BAD_SIZE;
    status = declare_arrays(out, own, &own->sum->part[k], additions);
    if (status != DVI_OK) return status;
    status = emit_unit(out, own, k, additions, stored);
    if (status != DVI_OK) return status;
  }
  dvi__emit(out, "DVI_INLINE int %s_at(const int careful, const ptrdiff_t n", own->name);
  dvi__emit_parameters(out, own);
  dvi__emit(out, ")\n{\n  int64_t unusual = 0;\n");
  for (int a = 0; a < own->sum->array_count; a++)
    if (own->sum->wanted[a] && (stored >> a & 1U) == 0) dvi__emit_zeros(out, own, a);
  for (int k = 0; k < own->sum->part_count; k++) emit_calls(out, own, k);
  dvi__emit(out, "  return unusual != 0;\n}\n");
  return DVI_OK;
}
