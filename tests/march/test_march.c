/* labels: unit */
/* The loop of a run serves objects without coordinates and without steps of one length. Here they
 * are a set of clocks, each of which advances when it is due. */
#include "march/march.h"

#include <math.h>

#include "support/suite.h"

enum { CLOCKS = 3 };

/* Clocks of periods 1, sqrt(2) and pi. An advance moves the one that is due first. */
typedef struct clocks {
  double now, before; /* time of the last tick, and of the one before */
  double due[CLOCKS], due_before[CLOCKS];
  long ticks;
  int observed, saved, occurred, rejected, fails_at;
} clocks;

static const double period[CLOCKS] = {1, 1.4142135623730951, 3.141592653589793};

static clocks create_clocks(void)
{
  return (clocks){.due = {1, 1.4142135623730951, 3.141592653589793}, .fails_at = -1};
}

static double time_of(const void *user)
{
  return ((const clocks *)user)->now;
}

static double time_left(const void *user, double t_end)
{
  return t_end - time_of(user);
}

static long ticks_of(const void *user)
{
  return ((const clocks *)user)->ticks;
}

static dvi_status advance(void *user, double h, double t_end, double tolerance)
{
  clocks *c = user;
  int first = 0;
  (void)h, (void)tolerance;
  for (int k = 1; k < CLOCKS; k++)
    if (c->due[k] < c->due[first]) first = k;
  c->before = c->now;
  for (int k = 0; k < CLOCKS; k++) c->due_before[k] = c->due[k];
  c->ticks++;
  c->now = fmin(c->due[first], t_end);
  if (c->now == c->due[first]) c->due[first] += period[first];
  return DVI_OK;
}

static void take_back(void *user)
{
  clocks *c = user;
  c->now = c->before;
  for (int k = 0; k < CLOCKS; k++) c->due[k] = c->due_before[k];
  c->ticks--;
}

static dvi_status reject(void *user, dvi_status status)
{
  take_back(user);
  ((clocks *)user)->rejected++;
  return status;
}

static dvi__watched event(const void *user, int k)
{
  (void)user;
  return (dvi__watched){.direction = 1, .terminal = k == 1};
}

/* Event 0 is at 2.5, event 1 at 7.25. */
static dvi_status value(void *user, int k, double t, double *g)
{
  const clocks *c = user;
  if (c->fails_at >= 0 && t > c->fails_at) return DVI_NOT_FINITE;
  *g = t - (k == 0 ? 2.5 : 7.25);
  return DVI_OK;
}

static dvi_status value_at_start(void *user, int k, double *g)
{
  return value(user, k, time_of(user), g);
}

static dvi_status occurred(void *user, int k, double t, int *returned)
{
  clocks *c = user;
  *returned = 0;
  c->occurred++;
  ck_assert(fabs(t - (k == 0 ? 2.5 : 7.25)) < 1e-12);
  return DVI_OK;
}

static int observe(void *user)
{
  ((clocks *)user)->observed++;
  return 0;
}

static int saves;

static dvi_status save(const void *user, const char *path)
{
  (void)user;
  ck_assert_str_eq(path, "there");
  saves++;
  return DVI_OK;
}

static const dvi__marcher marcher = {
    time_of, time_left,      ticks_of, advance, take_back, reject, event,
    value,   value_at_start, occurred, observe, save,      NULL,   0};

START_TEST(clocks_that_tick_when_they_are_due_run_to_the_end)
{
  clocks c = create_clocks();
  dvi_run_report report = {0};
  const dvi__march_options options = {
      .h = 1, .t_end = 10, .chooses_steps = 1, .checkpoint = "there", .checkpoint_every = 5};
  saves = 0;
  ck_assert_int_eq(dvi__march(&c, &marcher, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_COMPLETE);
  ck_assert_double_eq(c.now, 10);
  ck_assert_int_eq(report.steps, 10 + 7 + 3); /* ticks at 1..10, at sqrt(2) k and at pi k */
  ck_assert_int_eq(c.observed, 1 + 20);
  ck_assert_int_eq(saves, 4 + 1);
}
END_TEST

START_TEST(events_are_located_between_ticks_and_end_the_run_at_their_time)
{
  clocks c = create_clocks();
  dvi_run_report report = {0};
  const dvi__march_options options = {.h = 1, .t_end = 10, .chooses_steps = 1, .event_count = 2};
  ck_assert_int_eq(dvi__march(&c, &marcher, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_EVENT);
  ck_assert_int_eq(report.event, 1);
  ck_assert_int_eq(report.events, 2);
  ck_assert_int_eq(c.occurred, 2);
  ck_assert(fabs(c.now - 7.25) < 1e-12);
  ck_assert_double_eq(c.due[0], 8); /* the tick behind the event was taken back */
}
END_TEST

START_TEST(a_step_whose_event_fails_is_rejected)
{
  clocks c = create_clocks();
  dvi_run_report report = {0};
  const dvi__march_options options = {.h = 1, .t_end = 10, .chooses_steps = 1, .event_count = 2};
  c.fails_at = 4;
  ck_assert_int_eq(dvi__march(&c, &marcher, &options, &report), DVI_NOT_FINITE);
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
  ck_assert_int_eq(c.rejected, 1);
  ck_assert_double_eq(c.now, 4);
}
END_TEST

SUITE(march)
{
  tcase_add_test(tests, clocks_that_tick_when_they_are_due_run_to_the_end);
  tcase_add_test(tests, events_are_located_between_ticks_and_end_the_run_at_their_time);
  tcase_add_test(tests, a_step_whose_event_fails_is_rejected);
}
