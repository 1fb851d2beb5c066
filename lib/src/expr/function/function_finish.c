/* Stores and additions of a sum. The first thing added to an entry is stored there, if it is alone
 * in its kernel. Arrays that are stored in full need not be zero before. */
#include "expr/function/function_parts.h"
#include "text/heap.h"

/* An array of a result. */
typedef struct array {
  int number, left;       /* `left` counts the entries that nothing is added to yet */
  unsigned char *touched; /* [size] 1 if something is added to the entry already */
} array;

/* Let the target store if nothing is there yet. */
static void array_touch(array *own, dvi__destination *target)
{
  const ptrdiff_t entry = target->single, mirror = target->mirrored ? target->single_mirror : entry;
  target->sets = !own->touched[entry] && !own->touched[mirror];
  own->left -= !own->touched[entry];
  own->touched[entry] = 1;
  own->left -= !own->touched[mirror];
  own->touched[mirror] = 1;
}

/* Return 1 if only kernels of one element add to an array. */
static int has_singles_alone(const dvi__function_sum *sum, int number)
{
  for (int k = 0; k < sum->part_count; k++) {
    const dvi__part *part = &sum->part[k];
    for (int i = 0; i < part->target_count && part->kernel->elements > 1; i++)
      if (part->target[i].array == number) return 0;
  }
  return 1;
}

static void touch_all(const dvi__function_sum *sum, array *own)
{
  for (int k = 0; k < sum->part_count; k++)
    for (int i = 0; i < sum->part[k].target_count; i++)
      if (sum->part[k].target[i].array == own->number) array_touch(own, &sum->part[k].target[i]);
}

static void find_singles(const dvi__function_sum *sum)
{
  for (int k = 0; k < sum->part_count; k++)
    for (int i = 0; i < sum->part[k].target_count; i++) {
      dvi__destination *target = &sum->part[k].target[i];
      target->single = dvi__entry_at(&target->entry, 0);
      target->single_mirror = dvi__entry_at(&target->mirror, 0);
    }
}

dvi_status dvi__sum_finish(dvi__function_sum *sum)
{
  find_singles(sum);
  for (int a = 0; a < sum->array_count; a++) {
    if (!sum->wanted[a]) continue;
    sum->clear[a] = 1;
    if (!has_singles_alone(sum, a)) continue;
    array own = {
        .number = a, .left = sum->size[a], .touched = dvi__heap_take((size_t)sum->size[a], 1)};
    if (own.touched == NULL) return DVI_NO_MEMORY;
    touch_all(sum, &own);
    if (own.left == 0) sum->clear[a] = 0;
    dvi__heap_free(own.touched);
  }
  return DVI_OK;
}
