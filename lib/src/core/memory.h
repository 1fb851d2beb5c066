/* The only access to the heap. It counts allocations, and tests can make it fail. */
#ifndef DVI_CORE_MEMORY_H
#define DVI_CORE_MEMORY_H
#include <stddef.h>

/* Allocate zeroed memory for count objects, on its own cache lines. NULL if there is none left, or
 * if count * size overflows. A count of 0 gives some memory, too. */
void *dvi__allocate(size_t count, size_t size);

/* Copy count objects into new memory. NULL as from dvi__allocate. */
void *dvi__duplicate(const void *original, size_t count, size_t size);

/* Free memory. NULL is allowed. */
void dvi__release(void *memory);

/* Return the number of blocks that this thread allocated so far. */
long dvi__allocation_count(void);

/* Let the next `successes` allocations of this thread succeed and all later ones fail. With a
 * negative number all succeed again. Meant for tests. */
void dvi__fail_allocations_after(long successes);

#define DVI_NEW(type, count) ((type *)dvi__allocate((size_t)(count), sizeof(type)))

#endif
