/* Additions of the rows of a unit to the entries of an array. One loop runs over all additions,
 * whose numbers are tables. Compilers take more than their share of time for a function of very
 * many loops. */
#include "scene/emit/emit_parts.h"
#include "text/heap.h"

/* A row that goes to entries, while the tables are made. */
typedef struct addition {
  const dvi__entries *entries;
  int row, sign;
} addition;

/* ---- units that add all their elements to one entry ---- */

int dvi__is_one_entry(const dvi__entries *entries, int first)
{
  const dvi__track minor = dvi__track_of(&entries->minor, first);
  if (entries->scale == 0) return minor.list == NULL && minor.stride == 0;
  const dvi__track major = dvi__track_of(&entries->major, first);
  return minor.list == NULL && major.list == NULL &&
         minor.stride + entries->scale * major.stride == 0;
}

/* Choose how rows are folded. If that depends on the unit, flags [count][units] are written. */
static dvi_status declare_folds(dvi__emitter *out, int elements, int count, const addition *list,
                                dvi__additions *all)
{
  const int units = (elements + DVI__UNIT - 1) / DVI__UNIT;
  int folds = 0, *flag = dvi__heap_take((size_t)count * (size_t)units, sizeof *flag);
  if (flag == NULL) return DVI_NO_MEMORY;
  for (int a = 0; a < count; a++)
    for (int u = 0; u < units; u++)
      folds += flag[a * units + u] = dvi__is_one_entry(list[a].entries, u * DVI__UNIT);
  all->folds = folds == 0 ? DVI__NEVER : folds == count * units ? DVI__ALWAYS : DVI__SOMETIMES;
  if (all->folds == DVI__SOMETIMES) all->flags = dvi__emit_ints_of(out, NULL, count * units, flag);
  dvi__heap_free(flag);
  return DVI_OK;
}

/* ---- tables ---- */

static int emit_new(dvi__emitter *out, int count, const int *value)
{
  return dvi__emit_ints_of(out, NULL, count, value);
}

/* Declare a number for every addition. A table is written if they differ. */
static dvi__numbers declare_numbers(dvi__emitter *out, int count, const int *value,
                                    int (*write)(dvi__emitter *out, int count, const int *value))
{
  for (int a = 1; a < count; a++)
    if (value[a] != value[0]) return (dvi__numbers){write(out, count, value), 0};
  return (dvi__numbers){-1, value[0]};
}

static int is_listed(const dvi__entries *entries)
{
  return entries->minor.list != NULL || (entries->scale != 0 && entries->major.list != NULL);
}

/* Declare the list of an addition's entries, less `start`. */
static dvi_status declare_list(dvi__emitter *out, int elements, const dvi__entries *entries,
                               int *list, int *start)
{
  if (entries->scale == 0 && entries->minor.list != NULL) {
    *list = dvi__emit_ints(out, elements, entries->minor.list);
    *start = entries->minor.start;
    return DVI_OK;
  }
  int *entry = dvi__heap_take((size_t)elements, sizeof *entry);
  if (entry == NULL) return DVI_NO_MEMORY;
  for (int e = 0; e < elements; e++) entry[e] = (int)dvi__entry_at(entries, e);
  *list = dvi__emit_ints_of(out, NULL, elements, entry);
  *start = 0;
  dvi__heap_free(entry);
  return DVI_OK;
}

/* Declare entries, which are start + stride * e for all additions, or start + list[e] for all. */
static dvi_status declare_entry_places(dvi__emitter *out, int elements, int count,
                                       const addition *list, int *value, dvi__additions *all)
{
  int *start = value, *step = value + count;
  for (int a = 0; a < count; a++) all->listed |= is_listed(list[a].entries);
  for (int a = 0; a < count; a++) {
    const dvi__entries *entries = list[a].entries;
    start[a] = (int)dvi__entry_at(entries, 0);
    step[a] = entries->minor.stride + entries->scale * entries->major.stride;
    const dvi_status status = all->listed
                                  ? declare_list(out, elements, entries, &step[a], &start[a])
                                  : DVI_OK;
    if (status != DVI_OK) return status;
  }
  all->start = declare_numbers(out, count, start, emit_new);
  all->step = declare_numbers(out, count, step, all->listed ? dvi__emit_lists : emit_new);
  return DVI_OK;
}

static dvi_status declare_tables(dvi__emitter *out, int elements, int count, const addition *list,
                                 dvi__additions *all)
{
  int *value = dvi__heap_take(2 * (size_t)count, sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  for (int a = 0; a < count; a++) {
    value[a] = list[a].row;
    value[count + a] = list[a].sign;
  }
  all->row = declare_numbers(out, count, value, emit_new);
  all->sign = declare_numbers(out, count, value + count, emit_new);
  const dvi_status status = declare_entry_places(out, elements, count, list, value, all);
  dvi__heap_free(value);
  return status != DVI_OK ? status : declare_folds(out, elements, count, list, all);
}

/* Collect the part's additions to an array, in their order. */
static int collect_additions(const dvi__part *part, int array, addition *list)
{
  int count = 0;
  for (int k = 0; k < part->target_count; k++) {
    const dvi__destination *target = &part->target[k];
    if (target->array != array) continue;
    list[count++] = (addition){&target->entry, target->output, target->negative ? -1 : 1};
    if (target->mirrored)
      list[count++] = (addition){&target->mirror, target->output, target->negative ? -1 : 1};
  }
  return count;
}

dvi_status dvi__additions_declare(dvi__emitter *out, const dvi__part *part, int array,
                                  dvi__additions *all)
{
  addition *list = dvi__heap_take(2 * (size_t)part->target_count + 1, sizeof *list);
  if (list == NULL) return DVI_NO_MEMORY;
  *all = (dvi__additions){.count = collect_additions(part, array, list)};
  const dvi_status status = all->count > 0
                                ? declare_tables(out, part->kernel->elements, all->count, list, all)
                                : DVI_OK;
  dvi__heap_free(list);
  return status;
}

/* ---- the loop ---- */

static void emit_number_of(dvi__emitter *out, dvi__numbers numbers)
{
  if (numbers.list < 0)
    dvi__emit(out, "%d", numbers.value);
  else
    dvi__emit(out, "dvi_list_%d[a]", numbers.list);
}

/* Write the entry of element first + e. */
static void emit_entry(dvi__emitter *out, const dvi__additions *all)
{
  emit_number_of(out, all->start);
  if (!all->listed && all->step.list < 0 && all->step.value == 0) return;
  dvi__emit(out, " + ");
  if (!all->listed) {
    emit_number_of(out, all->step);
    dvi__emit(out, " * (first + e)");
  } else if (all->step.list < 0) {
    dvi__emit(out, "dvi_list_%d[first + e]", all->step.value);
  } else {
    dvi__emit(out, "dvi_lists_%d[a][first + e]", all->step.list);
  }
}

/* Write `row` and `left`, the numbers that are added and how many elements they have. */
static void emit_row(dvi__emitter *out, const dvi__additions *all, int elements)
{
  dvi__emit(out, "    const double *row = y[");
  emit_number_of(out, all->row);
  dvi__emit(out, "];\n    %sint left = elements;\n", all->folds == DVI__NEVER ? "const " : "");
  if (all->folds == DVI__NEVER) return;
  dvi__emit(out, "    ");
  if (all->folds == DVI__SOMETIMES)
    dvi__emit(out, "if (dvi_list_%d[a * %d + first / %d]) ", all->flags,
              (elements + DVI__UNIT - 1) / DVI__UNIT, DVI__UNIT);
  dvi__emit(out, "dvi_fold(elements, points, row, sum), row = sum, left = 1;\n");
}

void dvi__additions_emit(dvi__emitter *out, const dvi__additions *all, const char *array,
                         int elements)
{
  if (all->count == 0) return;
  dvi__emit(out, "  for (int a = 0; a < %d; a++) {\n", all->count);
  emit_row(out, all, elements);
  dvi__emit(out,
            "    for (int e = 0; e < left; e++) {\n      DVI_INDEPENDENT\n      for (int p = 0; p "
            "< points; p++) %s[(",
            array);
  emit_entry(out, all);
  dvi__emit(out, ") * n + p] %s ", all->sign.list < 0 && all->sign.value < 0 ? "-=" : "+=");
  if (all->sign.list >= 0) dvi__emit(out, "dvi_list_%d[a] * ", all->sign.list);
  dvi__emit(out, "row[e * points + p];\n    }\n  }\n");
}
