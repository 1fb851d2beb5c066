#define _POSIX_C_SOURCE 200809L
#include "study/clock.h"

#include <math.h>
#include <time.h>

static const double clock_seconds = 0.02; /* least process time of one measurement */
static const double repeats_max = 1e6;

static double clock_seconds_of(clockid_t clock)
{
  struct timespec t;
  (void)clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double cpu_now(void)
{
  return clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double elapsed_now(void)
{
  return clock_seconds_of(CLOCK_MONOTONIC);
}

long clock_repeats(double seconds)
{
  if (seconds >= clock_seconds) return 1;
  return lround(fmin(ceil(clock_seconds / fmax(seconds, 1e-9)), repeats_max));
}
