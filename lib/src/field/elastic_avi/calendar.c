#include "field/elastic_avi/calendar.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { EVENTS_A_DAY = 64, DAYS_LEAST = 64, PAGE = DVI__CALENDAR_PAGE };

void dvi__calendar_destroy(dvi__calendar **calendar)
{
  dvi__calendar *c = *calendar;
  if (c == NULL) return;
  dvi__release(c->day);
  dvi__release(c->page);
  dvi__release(c->event);
  dvi__release(c->merged);
  dvi__release(c);
  *calendar = NULL;
}

dvi_status dvi__calendar_create(int64_t count, double longest, double rate, int ahead,
                                dvi__calendar **calendar)
{
  const double most = 4 * (double)count + DAYS_LEAST;
  dvi__calendar *c = *calendar = DVI_NEW(dvi__calendar, 1);
  if (c == NULL) return dvi__fail(DVI_NO_MEMORY, "avi: no memory for a calendar");
  c->count = count;
  c->ahead = ahead;
  c->days_per_time = fmin(rate / EVENTS_A_DAY, most / longest);
  c->days = DAYS_LEAST;
  while ((double)c->days < c->days_per_time * longest + 2) c->days *= 2;
  c->pages = count / PAGE + (c->days < count ? c->days : count) + 1;
  c->day = DVI_NEW(dvi__calendar_day, c->days);
  c->page = DVI_NEW(dvi__calendar_page, c->pages);
  c->event = DVI_NEW(dvi__calendar_event, count);
  c->merged = DVI_NEW(dvi__calendar_event, count);
  if (c->day && c->page && c->event && c->merged) {
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
  c->empty = 0;
  for (int64_t i = 0; i < c->days; i++) c->day[i] = (dvi__calendar_day){.page = -1};
  for (int64_t i = 0; i < c->pages; i++) c->page[i].before = (int)i + 1;
}

static int is_before(const dvi__calendar_event *a, const dvi__calendar_event *b)
{
  return a->t == b->t ? a->number < b->number : a->t < b->t;
}

/* Move the events that have not happened to the begin. */
static void close_gap(dvi__calendar *c)
{
  memmove(c->event, c->event + c->first, (size_t)(c->end - c->first) * sizeof *c->event);
  c->end -= c->first;
  c->first = 0;
}

/* Put an event of today, or an earlier one, where it belongs among those that have not happened. */
static void insert(dvi__calendar *c, dvi__calendar_event event)
{
  if (c->end == c->count) close_gap(c);
  int64_t place = c->end++;
  for (; place > c->first && is_before(&event, c->event + place - 1); place--)
    c->event[place] = c->event[place - 1];
  c->event[place] = event;
}

void dvi__calendar_put(dvi__calendar *c, double t, int64_t number)
{
  /* the day of a time never falls with it, whatever the roundings */
  const int64_t day = (int64_t)((t - c->origin) * c->days_per_time);
  if (c->is_open && day <= c->today) {
    insert(c, (dvi__calendar_event){t, number});
    return;
  }
  dvi__calendar_day *on = c->day + (day & (c->days - 1));
  const int64_t place = on->events++ % PAGE;
  if (place == 0) {
    const int page = c->empty;
    c->empty = c->page[page].before;
    c->page[page].before = on->page;
    on->page = page;
  }
  c->page[on->page].event[place] = (dvi__calendar_event){t, number};
  c->waiting++;
}

static int64_t end_of_run(int64_t first, int64_t count, const dvi__calendar_event *event)
{
  if (first == count) return count;
  while (++first < count && !is_before(event + first, event + first - 1)) continue;
  return first;
}

/* Merge runs of the events from `start` on two by two until there is one. Cells of equal steps act
 * in a row, again and again, so that their events are put in the order of their times. */
static void sort(dvi__calendar *c, int64_t start)
{
  dvi__calendar_event *event = c->event, *merged = c->merged;
  while (end_of_run(start, c->end, event) < c->end) {
    for (int64_t i = start, place = start; i < c->end;) {
      const int64_t middle = end_of_run(i, c->end, event), end = end_of_run(middle, c->end, event);
      int64_t j = middle;
      while (i < middle || j < end) {
        const int is_first = j == end || (i < middle && !is_before(event + j, event + i));
        merged[place++] = event[is_first ? i++ : j++];
      }
      i = end;
    }
    dvi__calendar_event *swap = event;
    event = merged;
    merged = swap;
  }
  if (event != c->event)
    memcpy(c->event + start, event + start, (size_t)(c->end - start) * sizeof *event);
}

/* Fetch the last page of a day. */
#define FETCH_PAGE(page)                                                      \
  for (size_t line = 0; line < sizeof *(page); line += 64) /* of the cache */ \
  __builtin_prefetch((const char *)(page) + line)

/* Move the pages of a day, the last one first, to a place of the sorted events. */
static void take_pages(dvi__calendar *c, dvi__calendar_day *day, int64_t start)
{
  for (int64_t left = day->events; left > 0;) {
    dvi__calendar_page *page = c->page + day->page;
    const int before = page->before, count = (int)(left - 1) % PAGE + 1;
    left -= count;
    memcpy(c->event + start + left, page->event, (size_t)count * sizeof *page->event);
    page->before = c->empty;
    c->empty = day->page;
    day->page = before;
  }
}

/* Sort the events of the next day behind the others. */
static void open_day(dvi__calendar *c)
{
  c->today += c->is_open;
  c->is_open = 1;
  dvi__calendar_day *day = c->day + (c->today & (c->days - 1));
  const dvi__calendar_day *next = c->day + ((c->today + 1) & (c->days - 1));
  if (next->events > 0) FETCH_PAGE(c->page + next->page);
  if (day->events == 0) return;
  close_gap(c);
  const int64_t start = c->end;
  take_pages(c, day, start);
  c->end += day->events;
  c->waiting -= day->events;
  day->events = 0;
  sort(c, start);
}

const dvi__calendar_event *dvi__calendar_next(dvi__calendar *c)
{
  while (c->end - c->first <= c->ahead && c->waiting > 0) open_day(c);
  return c->first < c->end ? c->event + c->first : NULL;
}
