/** What a measurement was made on: times mean nothing without it. */
#ifndef MACHINE_H
#define MACHINE_H
#include <stdio.h>

#include "study/samples.h"

/** Print processor, compiler with its flags, and the versions of dvi, SUNDIALS and, if it is there,
 * GSL, a line each. */
void machine_print(FILE *stream);

/** Process time of 1e8 multiplications of which each waits for the one before, in seconds; a tenth
 * of them are run. It says how fast the processor is at the moment. */
double machine_multiplications(void);

/** Print a line about repeated calls of that. */
void machine_print_calibration(FILE *stream, const spread *seconds);

/** Bytes a second that y <- y + a x moves in process time, in place, for n numbers in x and in y:
 * 24 of them for each, two numbers read and one written. What a loop gets from the machine's memory
 * if it does hardly anything else. NaN if there is no memory. */
double machine_axpy(int n);

/** Bytes that malloc has handed out and not got back; NaN where the C library does not tell. */
double machine_heap(void);
#endif
