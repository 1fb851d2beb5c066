/* Memory that is freed all at once, for reading and compiling a scene. */
#ifndef DVI_TEXT_ARENA_H
#define DVI_TEXT_ARENA_H
#include <stddef.h>

/* An arena, which owns its blocks. It is empty if zero. */
typedef struct dvi__arena {
  struct dvi__arena_block *last;
  int failed; /* memory ran out once */
} dvi__arena;

/* Give zeroed memory for `count` things of `size` bytes, aligned for any of them. NULL if there is
 * none left, or the product overflows. */
void *dvi__arena_take(dvi__arena *arena, size_t count, size_t size);

/* Copy so many characters and end them by NUL. */
char *dvi__arena_text(dvi__arena *arena, const char *text, size_t length);

/* Give room for one more than `count` things of `size` bytes. Returns `items` if it has room, else
 * a copy with twice as much. NULL as above. For rows that grow by one at a time, from NULL. */
void *dvi__arena_grow(dvi__arena *arena, void *items, size_t count, size_t size);

/* Free everything. The arena is empty again. */
void dvi__arena_free(dvi__arena *arena);

#endif
