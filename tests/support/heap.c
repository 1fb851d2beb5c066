#include "support/heap.h"

#include <errno.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define REPLACED_ALREADY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define REPLACED_ALREADY
#endif
#endif

static atomic_long calls, bytes, successes_left = -1;

void heap_fail_after(long successes)
{
  successes_left = successes;
}

long heap_calls(void)
{
  return calls;
}

long heap_bytes(void)
{
  return bytes;
}

/* Calls by pointers, as another program would. The compiler could inline malloc's body of this file
 * even if another replacement came first. */
int heap_is_counted(void)
{
  void *(*volatile take)(size_t size) = malloc;
  void (*volatile give_back)(void *memory) = free;
  const long before = calls;
  give_back(take(1));
  return calls == before + 2;
}

#if defined(__GLIBC__) && !defined(REPLACED_ALREADY)
/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the doors that glibc
 * leaves open for replacements */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *memory);
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

int posix_memalign(void **memory, size_t alignment, size_t size);

static int may_succeed(void)
{
  return successes_left < 0 || successes_left-- > 0;
}

static void *taken(void *memory)
{
  calls++;
  bytes += (long)malloc_usable_size(memory);
  return memory;
}

void *malloc(size_t size)
{
  return may_succeed() ? taken(__libc_malloc(size)) : NULL;
}

void *calloc(size_t count, size_t size)
{
  return may_succeed() ? taken(__libc_calloc(count, size)) : NULL;
}

void *realloc(void *memory, size_t size)
{
  const long before = (long)malloc_usable_size(memory);
  void *moved = may_succeed() ? __libc_realloc(memory, size) : NULL;
  if (moved != NULL || size == 0) bytes -= before;
  return taken(moved);
}

void *memalign(size_t alignment, size_t size)
{
  return may_succeed() ? taken(__libc_memalign(alignment, size)) : NULL;
}

void *aligned_alloc(size_t alignment, size_t size)
{
  return memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
  void *made = memalign(alignment, size);
  if (made == NULL) return ENOMEM;
  *memory = made;
  return 0;
}

void free(void *memory)
{
  if (memory == NULL) return;
  calls++;
  bytes -= (long)malloc_usable_size(memory);
  __libc_free(memory);
}
#endif
