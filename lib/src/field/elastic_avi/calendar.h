/* A calendar of events: numbers with times, in the order of time and number.
 *
 * Days of one length stand in a ring. Events of the day that is open are sorted, those of later
 * days stand in lists. With some events a day, the cost of an event does not depend on how many
 * there are (Brown 1988). */
#ifndef DVI_FIELD_ELASTIC_AVI_CALENDAR_H
#define DVI_FIELD_ELASTIC_AVI_CALENDAR_H
#include <dvi/status.h>
#include <stdint.h>

typedef struct dvi__calendar_event {
  double t;
  int64_t number;
} dvi__calendar_event;

typedef struct dvi__calendar_entry {
  double t;
  int64_t link; /* the next number of its list */
} dvi__calendar_entry;

typedef struct dvi__calendar {
  int64_t count;
  double origin, days_per_time;
  int is_open;                 /* the events of today are sorted */
  int64_t today, days;         /* days since the origin, and a power of 2 */
  int64_t waiting;             /* events in lists */
  int64_t first, end;          /* of the events of today that have not happened */
  int64_t *head;               /* [days] lists of numbers, -1 at their end */
  dvi__calendar_entry *entry;  /* [numbers] of lists */
  dvi__calendar_event *event;  /* [numbers] of today */
  dvi__calendar_event *merged; /* [numbers] memory to sort them */
} dvi__calendar;

/* Create a calendar for numbers below `count`, each of which has one event at a time, at most
 * `longest` after the present. `rate` is the number of events in a unit of time. */
dvi_status dvi__calendar_create(int64_t count, double longest, double rate,
                                dvi__calendar **calendar);
void dvi__calendar_destroy(dvi__calendar **calendar);

/* Forget all events, and begin at a time. */
void dvi__calendar_clear(dvi__calendar *calendar, double origin);

/* Put an event that is not before the last one that was taken. */
void dvi__calendar_put(dvi__calendar *calendar, double t, int64_t number);

/* Return the next event, or NULL if there is none. */
const dvi__calendar_event *dvi__calendar_next(dvi__calendar *calendar);

/* Take the next event, after dvi__calendar_next. */
static inline void dvi__calendar_take(dvi__calendar *calendar)
{
  calendar->first++;
}

#endif
