/** Parallel work on several threads. */
#ifndef PARALLEL_H
#define PARALLEL_H

enum { THREADS_MAX = 1024 };

/** Call work(user) on so many threads at once, 1 to THREADS_MAX. The calling thread is the first.
 * If no more threads can be created, the work goes on with fewer. Returns when all threads are
 * done. */
void parallel_work(long threads, void *(*work)(void *user), void *user);

/** Return the number of cores of this machine, at most THREADS_MAX. */
long parallel_cores(void);
#endif
