/** The memory bandwidth of a machine, by the triad of STREAM (McCalpin 1995). */
#ifndef TRIAD_H
#define TRIAD_H

/** Measure the bytes a second that a[i] = b[i] + s c[i] moves in elapsed time, of arrays far larger
 * than caches, with 24 bytes for each i. All working processes measure at the same time: give their
 * number, and get the sum of what they have. NaN without memory, or if they cannot be reached. */
double triad_together(int workers, long rounds);
#endif
