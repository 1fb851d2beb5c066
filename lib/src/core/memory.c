#define _DEFAULT_SOURCE /* madvise */
#include "core/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static _Thread_local long allocated;
static _Thread_local long successes_left = -1;

static int allocation_may_succeed(void)
{
  if (successes_left == 0) return 0;
  if (successes_left > 0) successes_left--;
  return 1;
}

/* Align all memory to cache lines. Fixed-point iteration takes a third longer if rows of eight
 * numbers straddle cache lines. */
enum { LINE = 64 };

/* Ask for huge pages for large memory, where random places cost walks of the page table. */
enum { HUGE_PAGE = 1 << 21 };

static void *allocate_aligned(size_t bytes)
{
#ifdef MADV_HUGEPAGE
  if (bytes >= 2 * (size_t)HUGE_PAGE) {
    void *memory = aligned_alloc(HUGE_PAGE, (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE);
    if (memory != NULL) (void)madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
  }
#endif
  return aligned_alloc(LINE, bytes);
}

void *dvi__allocate(size_t count, size_t size)
{
  if (!allocation_may_succeed() || (size > 0 && count > (SIZE_MAX - HUGE_PAGE) / size)) return NULL;
  const size_t bytes = count * size, whole = bytes > 0 ? (bytes + LINE - 1) / LINE * LINE : LINE;
  void *memory = allocate_aligned(whole);
  if (memory == NULL) return NULL;
  allocated++;
  return memset(memory, 0, whole);
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
