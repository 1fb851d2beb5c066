/* The one door to the heap: it counts, and tests can make it fail. */
#ifndef DVI_CORE_MEMORY_H
#define DVI_CORE_MEMORY_H
#include <stddef.h>

/* Zeroed memory for count objects, on its own cache lines; NULL if there is none left, or if count
 * * size overflows. A count of 0 gives some, too. */
void *dvi__allocate(size_t count, size_t size);

/* A copy of count objects; NULL as above. */
void *dvi__duplicate(const void *original, size_t count, size_t size);

/* Free; NULL is allowed. */
void dvi__release(void *memory);

/* Blocks that this thread allocated so far. */
long dvi__allocation_count(void);

/* For tests: let the next `successes` allocations of this thread succeed and all later ones fail;
 * negative: all succeed again. */
void dvi__fail_allocations_after(long successes);

#define DVI_NEW(type, count) ((type *)dvi__allocate((size_t)(count), sizeof(type)))

#endif
