/* Memory that is given back all at once: what a scene is read and compiled with. */
#ifndef DVI_TEXT_ARENA_H
#define DVI_TEXT_ARENA_H
#include <stddef.h>

/* Zero: empty. It owns its blocks. */
typedef struct dvi__arena {
  struct dvi__arena_block *last;
  int failed; /* not 0: memory ran out once */
} dvi__arena;

/* Zeroed memory for `count` things of `size` bytes, aligned for any of them; NULL if there is none
 * left, or the product overflows. */
void *dvi__arena_take(dvi__arena *arena, size_t count, size_t size);

/* A copy of so many characters, ended by NUL. */
char *dvi__arena_text(dvi__arena *arena, const char *text, size_t length);

/* Room for one more than `count` things of `size` bytes: `items` if it has room, else a copy of
 * them with twice as much. NULL as above. For rows that grow by one at a time, from NULL. */
void *dvi__arena_grow(dvi__arena *arena, void *items, size_t count, size_t size);

/* Free everything; the arena is empty again. */
void dvi__arena_free(dvi__arena *arena);

#endif
