/* Every heap call of the program, seen: a test that includes this header is linked with malloc and
 * its kin replaced (heap.c), so that the calls of KLU, SUNDIALS and LAPACK count too. */
#ifndef SUPPORT_HEAP_H
#define SUPPORT_HEAP_H

/* 0 if another replacement came first (sanitizers, valgrind) or the C library is not glibc: then
 * nothing is counted. */
int heap_is_counted(void);

/* Let the next `successes` requests of the program succeed and all later ones fail; negative: all
 * succeed again. */
void heap_fail_after(long successes);

/* Calls so far that take, change or give back memory, and the bytes that are taken now. */
long heap_calls(void);
long heap_bytes(void);

#endif
