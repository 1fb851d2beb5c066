/* Events of classes in their order. A slot is one of the shortest steps, and
 * in slot n all cells act whose class j divides it, 2^j | n. They are the first ones. Times are
 * products t_0 + j h_K, never running sums. */
#include <math.h>

#include "field/elastic_avi/borders.h"
#include "field/elastic_avi/neighbours.h"

int dvi__solid_class_of_slot(const dvi__solid_avi *avi, int64_t slot)
{
  int j = 0;
  while (j < avi->classes - 1 && slot % (INT64_C(2) << j) == 0) j++;
  return j;
}

/* Let the events of a slot happen up to one that fails. */
static dvi__solid_halt run_slot(dvi__solid_avi *avi, int class, double t)
{
  const int64_t end = avi->class_end[class];
  for (int64_t c = 0; c < end; c++) {
    if (c + DVI__CELL_AHEAD < end) DVI__FETCH_CELL(avi->cell + c + DVI__CELL_AHEAD);
    const int returned = dvi__solid_act(avi, c, t);
    if (returned != 0) return (dvi__solid_halt){returned, c, t};
  }
  return (dvi__solid_halt){0};
}

/* A process whose events have failed goes on to speak with the others, who do not know yet. What it
 * says from then on counts for later times alone. */
dvi__solid_halt dvi__solid_run_slots(dvi__solid_avi *avi, double limit)
{
  dvi__solid_halt halt = {0};
  for (;;) {
    const double t = dvi__solid_slot_time(avi, avi->clock.slot + 1);
    if (!(t <= limit) || avi->is_lost) return halt;
    const int class = dvi__solid_class_of_slot(avi, avi->clock.slot + 1);
    const dvi__solid_halt trade = dvi__solid_trade(avi, class, t);
    if (halt.returned == 0) halt = trade.returned != 0 ? trade : run_slot(avi, class, t);
    if (halt.returned != 0 && avi->borders == NULL) return halt;
    avi->clock.slot++;
    avi->clock.events += avi->class_events[class];
    avi->clock.t = fmax(avi->clock.t, t);
  }
}

/* Let the events up to a slot happen on the threads of a process. All processes count them. */
static dvi__solid_halt run_on_threads(dvi__solid_avi *avi, int64_t slot)
{
  const int64_t before = avi->clock.slot, events = avi->clock.events;
  const dvi__solid_halt halt = dvi__solid_run_parts(avi, dvi__solid_slot_time(avi, slot));
  avi->clock.events = events;
  for (int64_t s = before + 1; s <= slot; s++)
    avi->clock.events += avi->class_events[dvi__solid_class_of_slot(avi, s)];
  return halt;
}

/* Threads of a process go through all slots up to the next one in which cells between processes
 * act. What has failed is found again on a single thread, in its order. */
static dvi__solid_halt run_slots_on_threads(dvi__solid_avi *avi, double limit)
{
  dvi__solid_halt halt = {0};
  for (;;) {
    int64_t slot = avi->clock.slot + 1;
    const double t = dvi__solid_slot_time(avi, slot);
    if (!(t <= limit) || avi->is_lost) return halt;
    const dvi__solid_halt trade = dvi__solid_trade(avi, dvi__solid_class_of_slot(avi, slot), t);
    while (dvi__solid_class_of_slot(avi, slot + 1) < avi->borders->first_class &&
           dvi__solid_slot_time(avi, slot + 1) <= limit)
      slot++;
    if (halt.returned == 0) halt = trade.returned != 0 ? trade : run_on_threads(avi, slot);
    avi->clock.slot = slot;
    avi->clock.t = fmax(avi->clock.t, dvi__solid_slot_time(avi, slot));
  }
}

dvi__solid_halt dvi__solid_run(dvi__solid_avi *avi, double limit)
{
  if (avi->neighbours != NULL) return dvi__solid_run_shared(avi, limit);
  if (avi->borders != NULL && avi->parts != NULL) return run_slots_on_threads(avi, limit);
  return avi->parts != NULL ? dvi__solid_run_parts(avi, limit) : dvi__solid_run_slots(avi, limit);
}
