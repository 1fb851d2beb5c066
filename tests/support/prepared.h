/* Counts heap calls of steps that prepare no solver. A test that uses them includes support/heap.h,
 * too. */
#ifndef SUPPORT_PREPARED_H
#define SUPPORT_PREPARED_H
#include <dvi/dvi.h>

#include "support/heap.h"

/* More solvers than any integrator prepares. A composition of imex keeps nine factors. */
enum { PREPARATIONS_MOST = 16 };

static inline dvi_counters read_counters(const dvi_integrator *integrator)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  return counters;
}

/* Takes a step, and returns the number of its heap calls and of blocks of the library's own, or 0
 * if it prepared a solver. */
static inline long count_calls_of_step(dvi_integrator *integrator, double h, dvi_status *status)
{
  const dvi_counters before = read_counters(integrator);
  const long calls = heap_calls();
  *status = dvi_integrator_step(integrator, h);
  const long made = heap_calls() - calls;
  const dvi_counters after = read_counters(integrator);
  if (after.preparations > before.preparations) return 0;
  return made + (after.allocations - before.allocations);
}

#endif
