/* A binary heap: the numbers from 0 to count-1 in the order of their keys, and by themselves where
 * keys are equal. The first one is heap[0]. */
#ifndef DVI_FIELD_STEP_HEAP_H
#define DVI_FIELD_STEP_HEAP_H
#include <stdint.h>

static inline int dvi__heap_is_before(const double *key, int a, int b)
{
  return key[a] == key[b] ? a < b : key[a] < key[b];
}

/* Let the number at a place sink to where it belongs, after its key has grown. */
static inline void dvi__heap_sink(const double *key, int64_t count, int *heap, int64_t place)
{
  const int number = heap[place];
  for (int64_t child; (child = 2 * place + 1) < count; place = child) {
    if (child + 1 < count && dvi__heap_is_before(key, heap[child + 1], heap[child])) child++;
    if (dvi__heap_is_before(key, number, heap[child])) break;
    heap[place] = heap[child];
  }
  heap[place] = number;
}

static inline void dvi__heap_order(const double *key, int64_t count, int *heap)
{
  for (int64_t i = 0; i < count; i++) heap[i] = (int)i;
  for (int64_t place = count / 2; place-- > 0;) dvi__heap_sink(key, count, heap, place);
}

#endif
