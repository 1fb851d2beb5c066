#define _POSIX_C_SOURCE 200809L
#include "cli/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

static const double patience = 0.25; /* seconds between two lines */

static double progress_clock(void)
{
  struct timespec t;
  (void)clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_start(progress_line *progress, bool shown)
{
  progress->shown = shown && isatty(STDERR_FILENO) == 1;
  progress->dirty = false;
  progress->began = progress->spoken = progress_clock();
}

void progress_show(progress_line *progress, double fraction, const char *what)
{
  if (!progress->shown) return;
  const double t = progress_clock();
  if (t - progress->spoken < patience) return;
  progress->spoken = t;
  progress->dirty = true;
  const double elapsed = t - progress->began;
  if (fraction > 0.0)
    (void)fprintf(stderr, "\r\033[K%s: %.0f %%, %.0f s left", what, 100.0 * fraction,
                  elapsed * (1.0 - fraction) / fraction);
  else
    (void)fprintf(stderr, "\r\033[K%s: %.0f s", what, elapsed);
  (void)fflush(stderr);
}

void progress_end(progress_line *progress)
{
  if (progress->dirty) (void)fputs("\r\033[K", stderr);
  progress->dirty = false;
}
