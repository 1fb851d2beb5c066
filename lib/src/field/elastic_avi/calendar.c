#include "field/elastic_avi/calendar.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { EVENTS_A_DAY = 32, DAYS_LEAST = 64 };

void dvi__calendar_destroy(dvi__calendar **calendar)
{
  dvi__calendar *c = *calendar;
  if (c == NULL) return;
  dvi__release(c->head);
  dvi__release(c->entry);
  dvi__release(c->event);
  dvi__release(c->merged);
  dvi__release(c);
  *calendar = NULL;
}

dvi_status dvi__calendar_create(int64_t count, double longest, double rate,
                                dvi__calendar **calendar)
{
  const double most = 4 * (double)count + DAYS_LEAST;
  dvi__calendar *c = *calendar = DVI_NEW(dvi__calendar, 1);
  if (c == NULL) return dvi__fail(DVI_NO_MEMORY, "avi: no memory for a calendar");
  c->count = count;
  c->days_per_time = fmin(rate / EVENTS_A_DAY, most / longest);
  c->days = DAYS_LEAST;
  while ((double)c->days < c->days_per_time * longest + 2) c->days *= 2;
  c->head = DVI_NEW(int64_t, c->days);
  c->entry = DVI_NEW(dvi__calendar_entry, count);
  c->event = DVI_NEW(dvi__calendar_event, count);
  c->merged = DVI_NEW(dvi__calendar_event, count);
  if (c->head && c->entry && c->event && c->merged) {
    dvi__calendar_clear(c, 0);
    return DVI_OK;
  }
  dvi__calendar_destroy(calendar);
  return dvi__fail(DVI_NO_MEMORY, "avi: no memory for a calendar of %lld events", (long long)count);
}

void dvi__calendar_clear(dvi__calendar *c, double origin)
{
  c->origin = origin;
  c->today = c->waiting = c->first = c->end = 0;
  c->is_open = 0;
  for (int64_t i = 0; i < c->days; i++) c->head[i] = -1;
}

static int is_before(const dvi__calendar_event *a, const dvi__calendar_event *b)
{
  return a->t == b->t ? a->number < b->number : a->t < b->t;
}

/* Put an event of today where it belongs among those that have not happened. */
static void insert(dvi__calendar *c, dvi__calendar_event event)
{
  if (c->end == c->count) {
    memmove(c->event, c->event + c->first, (size_t)(c->end - c->first) * sizeof *c->event);
    c->end -= c->first;
    c->first = 0;
  }
  int64_t place = c->end++;
  for (; place > c->first && is_before(&event, c->event + place - 1); place--)
    c->event[place] = c->event[place - 1];
  c->event[place] = event;
}

void dvi__calendar_put(dvi__calendar *c, double t, int64_t number)
{
  /* the day of a time never falls with it, whatever the roundings */
  const int64_t day = (int64_t)((t - c->origin) * c->days_per_time);
  if (c->is_open && day == c->today) {
    insert(c, (dvi__calendar_event){t, number});
    return;
  }
  const int64_t place = day & (c->days - 1);
  c->entry[number] = (dvi__calendar_entry){t, c->head[place]};
  c->head[place] = number;
  c->waiting++;
}

static int64_t end_of_run(int64_t first, int64_t count, const dvi__calendar_event *event)
{
  if (first == count) return count;
  while (++first < count && !is_before(event + first, event + first - 1)) continue;
  return first;
}

/* Merge runs two by two until there is one. Cells of equal steps act in a row, again and again, so
 * that their events are put in the order in which they will happen. */
static void sort(dvi__calendar *c)
{
  while (end_of_run(0, c->end, c->event) < c->end) {
    dvi__calendar_event *event = c->event;
    for (int64_t i = 0, place = 0; i < c->end;) {
      const int64_t middle = end_of_run(i, c->end, event), end = end_of_run(middle, c->end, event);
      int64_t j = middle;
      while (i < middle || j < end) {
        const int is_first = j == end || (i < middle && !is_before(event + j, event + i));
        c->merged[place++] = event[is_first ? i++ : j++];
      }
      i = end;
    }
    c->event = c->merged;
    c->merged = event;
  }
}

/* Move the list of today, whose last event was put first, to the sorted events. */
static void open_day(dvi__calendar *c)
{
  int64_t *head = c->head + (c->today & (c->days - 1));
  c->first = c->end = 0;
  c->is_open = 1;
  for (int64_t i = *head; i >= 0; i = c->entry[i].link) c->end++;
  for (int64_t i = *head, place = c->end; i >= 0; i = c->entry[i].link)
    c->event[--place] = (dvi__calendar_event){c->entry[i].t, i};
  *head = -1;
  c->waiting -= c->end;
  sort(c);
}

const dvi__calendar_event *dvi__calendar_next(dvi__calendar *c)
{
  while (c->first == c->end) {
    if (c->waiting == 0) return NULL;
    c->today += c->is_open;
    open_day(c);
  }
  return c->event + c->first;
}
