/* Threads that wait for work: made once, so that handing out work makes none and takes no memory. */
#ifndef DVI_CORE_POOL_H
#define DVI_CORE_POOL_H
#include <dvi/status.h>

typedef struct dvi__pool dvi__pool;

/* One item of work; `thread` says which of the pool's threads does it, 0 to threads-1. */
typedef void (*dvi__work)(void *of, int thread, int item);

/* For so many threads, the caller's own among them: one makes none. Signals stay with the threads that the program made itself.
 * DVI_NO_MEMORY if the system gives no more. */
dvi_status dvi__pool_create(int threads, dvi__pool **pool);
void dvi__pool_destroy(dvi__pool **pool);

/* Do items 0 to count-1, each once, in any order, on the pool's threads and the caller's; returns when all are done. One caller at a time. */
void dvi__pool_run(dvi__pool *pool, int count, dvi__work work, void *of);

#endif
