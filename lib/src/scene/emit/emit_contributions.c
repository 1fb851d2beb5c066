/* The contributions to each entry of a result, in their order. */
#include <stdlib.h>

#include "scene/emit/emit_parts.h"
#include "text/heap.h"

static int compare_contributions(const void *first, const void *second)
{
  const dvi__contribution *a = first, *b = second;
  if (a->array != b->array) return a->array < b->array ? -1 : 1;
  if (a->entry != b->entry) return a->entry < b->entry ? -1 : 1;
  return (a->order > b->order) - (a->order < b->order);
}

static int contribution_entry(const dvi__entries *entries, int e)
{
  return dvi__place_at(&entries->minor, e) +
         (entries->scale != 0 ? entries->scale * dvi__place_at(&entries->major, e) : 0);
}

static void append_contribution(dvi__contributions *all, const dvi__part *part,
                                const dvi__destination *target, const dvi__entries *entries)
{
  const int output = all->output_count + target->output;
  for (int e = 0; e < part->kernel->elements; e++, all->count++)
    all->list[all->count] = (dvi__contribution){
        target->array, contribution_entry(entries, e), all->count, output, e, target->negative};
}

static void collect_contributions(const dvi__part *part, dvi__contributions *all)
{
  for (int i = 0; i < part->target_count; i++) {
    append_contribution(all, part, &part->target[i], &part->target[i].entry);
    if (part->target[i].mirrored)
      append_contribution(all, part, &part->target[i], &part->target[i].mirror);
  }
  all->output_count += part->program.output_count;
}

dvi_status dvi__contributions_find(int part_count, const dvi__part *part, dvi__contributions *all)
{
  size_t most = 1;
  for (int k = 0; k < part_count; k++)
    most += 2 * (size_t)part[k].target_count * (size_t)part[k].kernel->elements;
  *all = (dvi__contributions){.list = dvi__heap_take(most, sizeof *all->list)};
  if (all->list == NULL) return DVI_NO_MEMORY;
  for (int k = 0; k < part_count; k++) collect_contributions(&part[k], all);
  qsort(all->list, (size_t)all->count, sizeof *all->list, compare_contributions);
  return DVI_OK;
}

int dvi__contribution_is_first(const dvi__contributions *all, int i)
{
  return i == 0 || all->list[i].array != all->list[i - 1].array ||
         all->list[i].entry != all->list[i - 1].entry;
}

int dvi__entries_written(const dvi__contributions *all, int array)
{
  int entries = 0;
  for (int i = 0; i < all->count; i++)
    entries += all->list[i].array == array && dvi__contribution_is_first(all, i);
  return entries;
}
