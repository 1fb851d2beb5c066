/** Clocks of measurements. */
#ifndef CLOCK_H
#define CLOCK_H

/** Process time in seconds. */
double cpu_now(void);

/** Elapsed time in seconds, from some moment on: for work on several threads. */
double elapsed_now(void);

/** How often something that takes so many seconds is to be run in one measurement, so that the
 * clock can tell. */
long clock_repeats(double seconds);
#endif
