#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

static _Thread_local long allocated;
static _Thread_local long successes_left = -1;

static int may_succeed(void)
{
  if (successes_left == 0) return 0;
  if (successes_left > 0) successes_left--;
  return 1;
}

void *dvi__allocate(size_t count, size_t size)
{
  if (!may_succeed()) return NULL;
  void *memory = count == 0 ? calloc(1, 1) : calloc(count, size);
  if (memory != NULL) allocated++;
  return memory;
}

void *dvi__duplicate(const void *original, size_t count, size_t size)
{
  void *copy = dvi__allocate(count, size);
  if (copy != NULL && count > 0) memcpy(copy, original, count * size);
  return copy;
}

void dvi__release(void *memory)
{
  free(memory);
}

long dvi__allocation_count(void)
{
  return allocated;
}

void dvi__fail_allocations_after(long successes)
{
  successes_left = successes;
}
