#include "text/heap.h"

#include <stdint.h>
#include <string.h>

#include "core/memory.h"

static const size_t limit = (size_t)1 << 30;

/* Header in front of each block. */
typedef struct header {
  _Alignas(16) dvi__ledger *ledger;
  size_t size; /* in bytes, header included */
} header;

static _Thread_local dvi__ledger *charged;
static _Thread_local dvi_status refusal = DVI_NO_MEMORY;

dvi__ledger *dvi__heap_charge(dvi__ledger *ledger)
{
  dvi__ledger *before = charged;
  charged = ledger;
  refusal = DVI_NO_MEMORY;
  return before;
}

static void *heap_refuse(dvi_status why)
{
  refusal = why;
  return NULL;
}

dvi_status dvi__heap_refusal(void)
{
  return refusal;
}

static void ledger_pay_back(dvi__ledger *ledger, size_t bytes)
{
  if (ledger != NULL) atomic_fetch_sub_explicit(&ledger->taken, bytes, memory_order_relaxed);
}

/* Charge the ledger if it has so much left. Tells whether it has. */
static int ledger_charge(dvi__ledger *ledger, size_t bytes)
{
  if (ledger == NULL) return 1;
  if (bytes <= limit &&
      atomic_fetch_add_explicit(&ledger->taken, bytes, memory_order_relaxed) <= limit - bytes)
    return 1;
  if (bytes <= limit) ledger_pay_back(ledger, bytes);
  return 0;
}

/* Give the bytes of a block, or SIZE_MAX if they are too many. */
static size_t block_bytes(size_t count, size_t size)
{
  return size > 0 && count > (SIZE_MAX - sizeof(header)) / size ? SIZE_MAX
                                                                : sizeof(header) + count * size;
}

void *dvi__heap_take(size_t count, size_t size)
{
  const size_t bytes = block_bytes(count, size);
  if (bytes == SIZE_MAX || !ledger_charge(charged, bytes)) return heap_refuse(DVI_BAD_SIZE);
  header *made = dvi__allocate(1, bytes);
  if (made == NULL) {
    ledger_pay_back(charged, bytes);
    return heap_refuse(DVI_NO_MEMORY);
  }
  *made = (header){charged, bytes};
  return made + 1;
}

void *dvi__heap_grow(void *items, size_t count, size_t size)
{
  const int full = (count & (count - 1)) ==
                   0; /* the room is the least power of two that is not below the count */
  if (items == NULL) return dvi__heap_take(1, size);
  if (!full) return items;
  header *old = (header *)items - 1;
  dvi__ledger *ledger = old->ledger;
  const size_t bytes = block_bytes(2 * count, size), more = bytes - old->size;
  if (bytes == SIZE_MAX || !ledger_charge(ledger, more)) return heap_refuse(DVI_BAD_SIZE);
  header *moved = dvi__allocate(1, bytes);
  if (moved == NULL) {
    ledger_pay_back(ledger, more);
    return heap_refuse(DVI_NO_MEMORY);
  }
  memcpy(moved, old, old->size);
  moved->size = bytes;
  dvi__release(old);
  return moved + 1;
}

void dvi__heap_free(void *memory)
{
  if (memory == NULL) return;
  header *own = (header *)memory - 1;
  ledger_pay_back(own->ledger, own->size);
  dvi__release(own);
}
