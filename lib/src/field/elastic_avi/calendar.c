#include "field/elastic_avi/calendar.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { EVENTS_A_DAY = 8, DAYS_LEAST = 64, SHORT = 24 };

void dvi__calendar_destroy(dvi__calendar **calendar)
{
  dvi__calendar *c = *calendar;
  if (c == NULL) return;
  dvi__release(c->head);
  dvi__release(c->link);
  dvi__release(c->time);
  dvi__release(c->event);
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
  c->link = DVI_NEW(int64_t, count);
  c->time = DVI_NEW(double, count);
  c->event = DVI_NEW(dvi__calendar_event, count);
  if (c->head && c->link && c->time && c->event) {
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

static int compare(const void *first, const void *second)
{
  return is_before(first, second) ? -1 : is_before(second, first);
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
  c->time[number] = t;
  c->link[number] = c->head[place];
  c->head[place] = number;
  c->waiting++;
}

static void sort(int64_t count, dvi__calendar_event *event)
{
  if (count > SHORT) {
    qsort(event, (size_t)count, sizeof *event, compare);
    return;
  }
  for (int64_t i = 1; i < count; i++) {
    const dvi__calendar_event own = event[i];
    int64_t place = i;
    for (; place > 0 && is_before(&own, event + place - 1); place--)
      event[place] = event[place - 1];
    event[place] = own;
  }
}

/* Move the list of today to the sorted events. */
static void open_day(dvi__calendar *c)
{
  int64_t *head = c->head + (c->today & (c->days - 1));
  c->first = c->end = 0;
  c->is_open = 1;
  for (int64_t i = *head; i >= 0; i = c->link[i])
    c->event[c->end++] = (dvi__calendar_event){c->time[i], i};
  *head = -1;
  c->waiting -= c->end;
  sort(c->end, c->event);
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
