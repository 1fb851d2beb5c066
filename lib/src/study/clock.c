/* Clocks of measurements. */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <dvi/study.h>
#include <math.h>
#include <time.h>

static const double clock_seconds = 0.02; /* least process time of one measurement */
static const double repeats_max = 1e6;

double dvi_study_clock(void)
{
  struct timespec t;
  (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

long dvi_study_repeats(double seconds)
{
  if (seconds >= clock_seconds) return 1;
  return lround(fmin(ceil(clock_seconds / fmax(seconds, 1e-9)), repeats_max));
}
