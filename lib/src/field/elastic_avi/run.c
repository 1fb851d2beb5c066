/* Events in their order: by classes, or from a calendar. A slot is one of the shortest steps, and
 * in slot n all cells act whose class j divides it, 2^j | n. They are the first ones. Times are
 * products t_0 + j h_K, never running sums. */
#include <math.h>

#include "field/elastic_avi/engine.h"

int dvi__solid_class_of_slot(const dvi__solid_avi *avi, int64_t slot)
{
  int j = 0;
  while (j < avi->classes - 1 && slot % (INT64_C(2) << j) == 0) j++;
  return j;
}

static dvi__solid_halt run_slots(dvi__solid_avi *avi, double limit)
{
  for (;;) {
    const double t = dvi__solid_slot_time(avi, avi->clock.slot + 1);
    if (!(t <= limit)) return (dvi__solid_halt){0};
    const int64_t end = avi->class_end[dvi__solid_class_of_slot(avi, avi->clock.slot + 1)];
    for (int64_t c = 0; c < end; c++) {
      const int returned = dvi__solid_act(avi, c, t);
      if (returned != 0) return (dvi__solid_halt){returned, c, t};
    }
    avi->clock.slot++;
    avi->clock.events += end;
    avi->clock.t = fmax(avi->clock.t, t);
  }
}

static dvi__solid_halt run_calendar(dvi__solid_avi *avi, double limit)
{
  for (;;) {
    const dvi__calendar_event next = *dvi__calendar_next(avi->calendar);
    if (!(next.t <= limit)) return (dvi__solid_halt){0};
    const int returned = dvi__solid_act(avi, next.number, next.t);
    if (returned != 0) return (dvi__solid_halt){returned, next.number, next.t};
    dvi__calendar_take(avi->calendar);
    const int64_t count = ++avi->state.count[next.number];
    dvi__calendar_put(avi->calendar, dvi__solid_event_time(avi, next.number, count + 1),
                      next.number);
    avi->clock.events++;
    avi->clock.t = fmax(avi->clock.t, next.t);
  }
}

dvi__solid_halt dvi__solid_run(dvi__solid_avi *avi, double limit)
{
  return (avi->is_free ? run_calendar : run_slots)(avi, limit);
}

void dvi__solid_order(dvi__solid_avi *avi)
{
  if (!avi->is_free) return;
  dvi__calendar_clear(avi->calendar, avi->clock.t0);
  for (int64_t c = 0; c < avi->active; c++)
    dvi__calendar_put(avi->calendar, dvi__solid_event_time(avi, c, avi->state.count[c] + 1), c);
}
