/* Events in their order: by classes, or from a calendar. A slot is one of the shortest steps, and
 * in slot n all cells act whose class j divides it, 2^j | n. They are the first ones. Times are
 * products t_0 + j h_K, never running sums. */
#include <math.h>

#include "field/elastic_avi/members.h"

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

/* The time of the next event of the i-th cell of a list, or for NULL of all. */
static double next_time(const dvi__solid_avi *avi, const int *cell, int64_t i)
{
  const int64_t c = cell != NULL ? cell[i] : i;
  return dvi__solid_event_time(avi, c, avi->state.count[c] + 1);
}

void dvi__solid_order_some(const dvi__solid_avi *avi, int64_t count, const int *cell,
                           dvi__calendar *calendar)
{
  double first = INFINITY;
  for (int64_t i = 0; i < count; i++) first = fmin(first, next_time(avi, cell, i));
  dvi__calendar_clear(calendar, first);
  for (int64_t i = 0; i < count; i++) dvi__calendar_put(calendar, next_time(avi, cell, i), i);
}

void dvi__solid_order(dvi__solid_avi *avi)
{
  if (!avi->is_free) return;
  dvi__solid_order_some(avi, avi->active, NULL, avi->calendar);
  if (avi->members != NULL) dvi__solid_members_order(avi);
}
