/* Counts every heap call of the program. A test that includes this header is linked with
 * replacements of malloc and the like (heap.c), so that calls of KLU, SUNDIALS and LAPACK count,
 * too. */
#ifndef SUPPORT_HEAP_H
#define SUPPORT_HEAP_H

/* Returns 0 if nothing is counted, because another replacement came first (sanitizers, valgrind) or
 * the C library is not glibc. */
int heap_is_counted(void);

/* Let the next `successes` requests of the program succeed and all later ones fail. With a negative
 * number all requests succeed again. */
void heap_fail_after(long successes);

/* Give the number of calls so far that take, change or give back memory, and the bytes that are
 * taken now. */
long heap_calls(void);
long heap_bytes(void);

#endif
