/** Clocks of measurements. */
#ifndef CLOCK_H
#define CLOCK_H

/** Return the process time in seconds. */
double cpu_now(void);

/** Return the elapsed time in seconds since some moment, for work on several threads. */
double elapsed_now(void);

/** Return how many runs of so many seconds each make one measurement that the clock resolves. */
long clock_repeats(double seconds);
#endif
