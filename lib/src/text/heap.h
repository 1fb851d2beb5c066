/* The heap of what reads scenes: libdvi's own (core/memory.h), charged to a ledger that bounds what
 * one scene may take. */
#ifndef DVI_TEXT_HEAP_H
#define DVI_TEXT_HEAP_H
#include <dvi/status.h>
#include <stdatomic.h>
#include <stddef.h>

/* Zero: nothing taken. It must outlive what is charged to it, and may be charged by several
 * threads. */
typedef struct dvi__ledger {
  atomic_size_t taken; /* bytes; at most 1 GiB */
} dvi__ledger;

/* Charge what this thread takes from now on to a ledger (NULL: to none, and without a limit).
 * Returns the one that was charged before. */
dvi__ledger *dvi__heap_charge(dvi__ledger *ledger);

/* Zeroed memory for `count` things of `size` bytes, aligned for any of them; NULL if there is none
 * left, the ledger is full, or the product overflows. A count of 0 gives some, too. */
void *dvi__heap_take(size_t count, size_t size);

/* Room for one more than `count` things of `size` bytes: `items` if it has room, else they are
 * moved to where there is twice as much. NULL as above, and then `items` stays. For rows that grow
 * by one at a time, from NULL; what is new is not zeroed. */
void *dvi__heap_grow(void *items, size_t count, size_t size);

/* Free; NULL is allowed. */
void dvi__heap_free(void *memory);

/* Why this thread was last refused since the ledger was named: DVI_BAD_SIZE, it asked for more than
 * is left there; or DVI_NO_MEMORY. */
dvi_status dvi__heap_refusal(void);

#endif
