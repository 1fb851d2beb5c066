/* A calendar of events: numbers with times, in the order of time and number.
 *
 * Days of one length stand in a ring. Events of the day that is open are sorted, those of later
 * days stand on pages. With some events a day, the cost of an event does not depend on how many
 * there are (Brown 1988). Days are opened before they begin, so that some of the events that follow
 * are always known. */
#ifndef DVI_FIELD_ELASTIC_AVI_CALENDAR_H
#define DVI_FIELD_ELASTIC_AVI_CALENDAR_H
#include <dvi/status.h>
#include <stddef.h>
#include <stdint.h>

typedef struct dvi__calendar_event {
  double t;
  int64_t number;
} dvi__calendar_event;

enum { DVI__CALENDAR_PAGE = 31 };

typedef struct dvi__calendar_page {
  dvi__calendar_event event[DVI__CALENDAR_PAGE];
  int before; /* the page before, of the same day or of those that are empty. Or -1 */
} dvi__calendar_page;

typedef struct dvi__calendar_day {
  int page, events; /* the last page, which alone may have room, and all events */
} dvi__calendar_day;

typedef struct dvi__calendar {
  int64_t count, pages, ahead;
  double origin, days_per_time;
  int is_open;                 /* the events of today are sorted, too */
  int64_t today, days;         /* the last day that was opened, since the origin. A power of 2 */
  int64_t waiting;             /* events on pages */
  int64_t first, end;          /* of the sorted events that have not happened */
  int empty;                   /* an empty page */
  dvi__calendar_day *day;      /* [days] */
  dvi__calendar_page *page;    /* [pages] */
  dvi__calendar_event *event;  /* [count] in their order */
  dvi__calendar_event *merged; /* [count] memory to sort them */
} dvi__calendar;

/* Create a calendar for `count` numbers, each of which has one event at a time, at most `longest`
 * after the present. `rate` is the number of events in a unit of time, `ahead` that of
 * the events behind the next one that shall be known. */
dvi_status dvi__calendar_create(int64_t count, double longest, double rate, int ahead,
                                dvi__calendar **calendar);
void dvi__calendar_destroy(dvi__calendar **calendar);

/* Forget all events, and begin at a time. */
void dvi__calendar_clear(dvi__calendar *calendar, double origin);

/* Put an event. One before the last one that was taken is the next one. */
void dvi__calendar_put(dvi__calendar *calendar, double t, int64_t number);

/* Return the next event, or NULL if there is none. */
const dvi__calendar_event *dvi__calendar_next(dvi__calendar *calendar);

/* Return a later event, after dvi__calendar_next, or NULL if there is none. Puts may bring others
 * before it. */
static inline const dvi__calendar_event *dvi__calendar_ahead(const dvi__calendar *calendar,
                                                             int skipped)
{
  const int64_t place = calendar->first + skipped;
  return place < calendar->end ? calendar->event + place : NULL;
}

/* Take the next event, after dvi__calendar_next. */
static inline void dvi__calendar_take(dvi__calendar *calendar)
{
  calendar->first++;
}

#endif
