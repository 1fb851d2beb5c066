/** The clock of work on several threads. That of one thread is dvi_study_clock. */
#ifndef CLOCK_H
#define CLOCK_H

/** Return the elapsed time in seconds since some moment. */
double elapsed_now(void);
#endif
