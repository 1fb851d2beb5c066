/* The one door to the heap of what reads scenes: tests can make it fail. */
#ifndef DVI_SCENE_HEAP_H
#define DVI_SCENE_HEAP_H
#include <stddef.h>

/* Zeroed memory for `count` things of `size` bytes; NULL if there is none left, or the product overflows. A count of 0 gives some, too. */
void *dvi__heap_take(size_t count, size_t size);

/* Room for one more than `count` things of `size` bytes: `items` if it has room, else they are moved to where there is twice as much. NULL as above,
 * and then `items` stays. For rows that grow by one at a time, from NULL; what is new is not zeroed. */
void *dvi__heap_grow(void *items, size_t count, size_t size);

/* Free; NULL is allowed. */
void dvi__heap_free(void *memory);

/* For tests: let the next `successes` requests of this thread succeed and all later ones fail; negative: all succeed again. */
void dvi__heap_fail_after(long successes);

#endif
