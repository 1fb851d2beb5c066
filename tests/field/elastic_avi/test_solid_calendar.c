/* labels: unit */
/* The calendar of asynchronous steps: events come in the order of time and number. */
#include <math.h>
#include <stdlib.h>

#include "field/elastic_avi/calendar.h"
#include "support/suite.h"

enum { COUNT = 500, AHEAD = 12, EVENTS = 20000 };

typedef struct walk {
  dvi__calendar *calendar;
  double next[COUNT], step[COUNT];
  uint64_t seed;
} walk;

static double random_part(walk *w)
{
  w->seed = w->seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(w->seed >> 11) * 0x1p-53;
}

/* Steps from 1 to `ratio`, of which every fifth one is 1 so that times are equal. */
static walk walk_of(double ratio, uint64_t seed)
{
  walk w = {.seed = seed};
  double rate = 0, longest = 0;
  for (int i = 0; i < COUNT; i++) {
    w.step[i] = i % 5 == 0 ? 1 : pow(ratio, random_part(&w));
    longest = fmax(longest, w.step[i]);
    rate += 1 / w.step[i];
  }
  ck_assert(dvi__calendar_create(COUNT, longest, rate, AHEAD, &w.calendar) == DVI_OK);
  dvi__calendar_clear(w.calendar, 1);
  for (int i = 0; i < COUNT; i++)
    dvi__calendar_put(w.calendar, w.next[i] = w.step[i], 3 * (int64_t)i);
  return w;
}

/* Give the first event of all by a look at each. */
static int first_of(const walk *w)
{
  int first = 0;
  for (int i = 1; i < COUNT; i++)
    if (w->next[i] < w->next[first]) first = i;
  return first;
}

static void put_next(walk *w, int i, double t)
{
  w->next[i] = t;
  dvi__calendar_put(w->calendar, t, 3 * (int64_t)i);
}

static const double ratios[] = {1, 3, 1000, 1e6};

START_TEST(events_come_in_the_order_of_time_and_number)
{
  walk w = walk_of(ratios[_i], 7);
  for (int k = 0; k < repeats(EVENTS); k++) {
    const int first = first_of(&w);
    const dvi__calendar_event *event = dvi__calendar_next(w.calendar);
    ck_assert_int_eq(event->number, 3 * first);
    ck_assert(event->t == w.next[first]);
    dvi__calendar_take(w.calendar);
    put_next(&w, first, w.next[first] + w.step[first]);
  }
  dvi__calendar_destroy(&w.calendar);
}
END_TEST

/* Some numbers have their events later than others that follow, and the next ones before those. */
START_TEST(events_may_be_put_before_those_that_were_taken)
{
  enum { HELD = 20 };
  walk w = walk_of(ratios[_i], 9);
  for (int k = 0; k < repeats(EVENTS) / HELD; k++) {
    int held[HELD];
    double t[HELD];
    for (int i = 0; i < HELD; i++) {
      held[i] = first_of(&w);
      t[i] = w.next[held[i]];
      ck_assert_int_eq(dvi__calendar_next(w.calendar)->number, 3 * held[i]);
      dvi__calendar_take(w.calendar);
      w.next[held[i]] = INFINITY;
    }
    for (int i = 0; i < HELD; i++) put_next(&w, held[i], t[i] + w.step[held[i]]);
  }
  dvi__calendar_destroy(&w.calendar);
}
END_TEST

START_TEST(later_events_are_known)
{
  walk w = walk_of(ratios[_i], 11);
  for (int k = 0; k < COUNT - AHEAD; k++) {
    const dvi__calendar_event next = *dvi__calendar_next(w.calendar);
    const dvi__calendar_event *late = dvi__calendar_ahead(w.calendar, AHEAD);
    ck_assert(late != NULL && late->t >= next.t);
    dvi__calendar_take(w.calendar);
  }
  for (int k = 0; k < AHEAD; k++, dvi__calendar_take(w.calendar))
    ck_assert(dvi__calendar_next(w.calendar) != NULL);
  ck_assert(dvi__calendar_next(w.calendar) == NULL);
  dvi__calendar_destroy(&w.calendar);
}
END_TEST

SUITE(solid_calendar)
{
  const int count = sizeof ratios / sizeof *ratios;
  tcase_add_loop_test(tests, events_come_in_the_order_of_time_and_number, 0, count);
  tcase_add_loop_test(tests, events_may_be_put_before_those_that_were_taken, 0, count);
  tcase_add_loop_test(tests, later_events_are_known, 0, count);
}
