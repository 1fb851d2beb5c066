/** What dvi bench --scale ranks= prints and writes. */
#ifndef RANKS_REPORT_H
#define RANKS_REPORT_H
#include "scaling/ranks_bench.h"

/** Fit the model, print it with its assumptions, and write what is asked for. Returns an exit code.
 */
int ranks_report(ranks_bench *b);
#endif
