/** The machine of a measurement. Times mean nothing without it. */
#ifndef MACHINE_H
#define MACHINE_H
#include <dvi/study.h>
#include <stdio.h>

/** Print processor, compiler with its flags, and the versions of dvi and SUNDIALS, in a line
 * each. */
void machine_print(FILE *stream);

/** Measure the process time in seconds of 1e8 multiplications, each of which waits for the one
 * before. A tenth of them are run. The time tells how fast the processor is at the moment. */
double machine_multiplications(void);

/** Print a line about repeated calls of machine_multiplications. */
void machine_print_calibration(FILE *stream, const dvi_study_spread *seconds);

/** Measure the bytes a second that y <- y + a x moves in process time, in place, for n numbers in x
 * and in y. Each element takes 24 bytes, for two numbers read and one written. This is the share of
 * the machine's memory bandwidth that a loop with hardly any arithmetic gets. NaN without
 * memory. */
double machine_axpy(int n);

/** Return the bytes that malloc has handed out and not got back, or NaN where the C library does
 * not tell. */
double machine_heap(void);
#endif
