/* The heap of scenes. It is that of libdvi (core/memory.h), charged to a ledger that bounds the
 * memory of one scene. */
#ifndef DVI_TEXT_HEAP_H
#define DVI_TEXT_HEAP_H
#include <dvi/status.h>
#include <stdatomic.h>
#include <stddef.h>

/* A ledger of memory, with nothing taken if zero. It must outlive the memory that is charged to it.
 * Several threads may charge it. */
typedef struct dvi__ledger {
  atomic_size_t taken; /* in bytes, at most 1 GiB */
} dvi__ledger;

/* Charge memory that this thread takes from now on to a ledger. NULL stands for none, without a
 * limit. Returns the ledger that was charged before. */
dvi__ledger *dvi__heap_charge(dvi__ledger *ledger);

/* Give zeroed memory for `count` things of `size` bytes, aligned for any of them. NULL if there is
 * none left, the ledger is full, or the product overflows. A count of 0 gives some memory, too. */
void *dvi__heap_take(size_t count, size_t size);

/* Give room for one more than `count` things of `size` bytes. Returns `items` if it has room, else
 * moves them to where there is twice as much. NULL as above, and then `items` stays. For rows that
 * grow by one at a time, from NULL. New room is not zeroed. */
void *dvi__heap_grow(void *items, size_t count, size_t size);

/* Free memory. NULL is allowed. */
void dvi__heap_free(void *memory);

/* Tell why this thread was last refused memory since the ledger was named. DVI_BAD_SIZE if it asked
 * for more than is left there, else DVI_NO_MEMORY. */
dvi_status dvi__heap_refusal(void);

#endif
