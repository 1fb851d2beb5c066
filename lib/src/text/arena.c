#include "text/arena.h"

#include <stdint.h>
#include <string.h>

#include "text/heap.h"

enum { BLOCK_SIZE = 1 << 16, ALIGNMENT = 16 };

struct dvi__arena_block {
  struct dvi__arena_block *before;
  size_t used, size; /* bytes used and bytes of `byte` */
  _Alignas(ALIGNMENT) unsigned char byte[];
};

/* Add a zeroed block with room for so many bytes. NULL if there is no memory. */
static struct dvi__arena_block *arena_new_block(dvi__arena *arena, size_t wanted)
{
  const size_t size = wanted > BLOCK_SIZE ? wanted : BLOCK_SIZE;
  struct dvi__arena_block *block = dvi__heap_take(1, sizeof *block + size);
  if (block == NULL) return NULL;
  block->before = arena->last;
  block->size = size;
  arena->last = block;
  return block;
}

void *dvi__arena_take(dvi__arena *arena, size_t count, size_t size)
{
  const size_t most = SIZE_MAX / 2; /* an amount that is refused */
  const size_t wanted = size != 0 && count > most / size
                            ? most
                            : (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  struct dvi__arena_block *block = arena->last;
  if (block == NULL || wanted > block->size - block->used) block = arena_new_block(arena, wanted);
  if (block == NULL) {
    arena->failed = 1;
    return NULL;
  }
  void *taken = block->byte + block->used;
  block->used += wanted;
  return taken;
}

char *dvi__arena_text(dvi__arena *arena, const char *text, size_t length)
{
  char *copy = dvi__arena_take(arena, length + 1, 1);
  if (copy != NULL) memcpy(copy, text, length);
  return copy;
}

void *dvi__arena_grow(dvi__arena *arena, void *items, size_t count, size_t size)
{
  const int full = (count & (count - 1)) ==
                   0; /* the room is the least power of two that is not below the count */
  if (!full) return items;
  void *more = dvi__arena_take(arena, count == 0 ? 1 : 2 * count, size);
  if (more != NULL && count > 0) memcpy(more, items, count * size);
  return more;
}

void dvi__arena_free(dvi__arena *arena)
{
  while (arena->last != NULL) {
    struct dvi__arena_block *before = arena->last->before;
    dvi__heap_free(arena->last);
    arena->last = before;
  }
  *arena = (dvi__arena){0};
}
