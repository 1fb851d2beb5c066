/** The same work on several threads. */
#ifndef CREW_H
#define CREW_H

enum { CREW_MAX = 1024 };

/** Do work(user) on so many threads at once, 1 to CREW_MAX, of which this one is the first: where others cannot be had it goes on without them. Returns when all
 *  are done. */
void crew_work(long threads, void *(*work)(void *user), void *user);

/** The cores of this machine, CREW_MAX at most. */
long crew_cores(void);
#endif
