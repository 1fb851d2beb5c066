/** The same work on several threads. */
#ifndef PARALLEL_H
#define PARALLEL_H

enum { THREADS_MAX = 1024 };

/** Do work(user) on so many threads at once, 1 to THREADS_MAX, of which this one is the first.
 *  Where others cannot be had it goes on without them. Returns when all are done. */
void parallel_work(long threads, void *(*work)(void *user), void *user);

/** The cores of this machine, THREADS_MAX at most. */
long parallel_cores(void);
#endif
