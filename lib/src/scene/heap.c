#include "scene/heap.h"

#include <stdint.h>
#include <stdlib.h>

static _Thread_local long successes_left = -1;

static int may_succeed(void)
{
  if (successes_left == 0) return 0;
  if (successes_left > 0) successes_left--;
  return 1;
}

void *dvi__heap_take(size_t count, size_t size)
{
  return may_succeed() ? calloc(count > 0 ? count : 1, size) : NULL;
}

void *dvi__heap_grow(void *items, size_t count, size_t size)
{
  const int full = (count & (count - 1)) == 0; /* the room is the least power of two that is not below the count */
  if (!full) return items;
  const size_t room = count == 0 ? 1 : 2 * count;
  return may_succeed() && room <= SIZE_MAX / size ? realloc(items, room * size) : NULL;
}

void dvi__heap_free(void *memory)
{
  free(memory);
}

void dvi__heap_fail_after(long successes)
{
  successes_left = successes;
}
