#include "scaling/triad.h"

#include <math.h>
#include <stdlib.h>

#include "cli/command.h"
#include "scaling/timed.h"
#include "study/clock.h"

enum { COUNT = 1 << 22 /* numbers, 32 MiB in each array */ };

/* Use the processor's best instructions, because the loop serves as a yardstick. */
#if defined(__x86_64__) && defined(__gnu_linux__) && (!defined(__clang__) || __clang_major__ >= 14)
__attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#endif
static void
triad(size_t n, double s, const double *restrict b, const double *restrict c, double *restrict a)
{
  for (size_t i = 0; i < n; i++) a[i] = b[i] + s * c[i];
}

/* Returns the seconds of the slowest process, or NaN. */
static double one_round(int workers, double *room)
{
  double ready, slowest = 0;
  if (!slowest_of(workers, 0, &ready)) return (double)NAN;
  const double began = elapsed_now();
  if (room != NULL) triad(COUNT, 3, room + COUNT, room + 2 * COUNT, room);
  return slowest_of(workers, elapsed_now() - began, &slowest) ? slowest : (double)NAN;
}

double triad_together(int workers, long rounds)
{
  double *room = malloc(3 * (size_t)COUNT * sizeof *room), least = INFINITY;
  if (room == NULL) complain("out of memory for the triad");
  for (size_t i = 0; i < 3 * (size_t)COUNT && room != NULL; i++) room[i] = 1;
  for (long round = 0; round <= rounds; round++) least = fmin(least, one_round(workers, room));
  const bool good = room != NULL && isfinite(least);
  free(room);
  return good ? 24.0 * COUNT * workers / least : (double)NAN;
}
