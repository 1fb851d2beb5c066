/** Bounds of invariants that dvi run watches. It reports when a bound is passed, and goes on. */
#ifndef ALARMS_H
#define ALARMS_H
#include "cli/options.h"
#include "problem.h"

typedef struct alarm_bound {
  int invariant;
  const char *name;
  double bound;              /**< bound of the size */
  double passed;             /**< time when it was first passed, or NaN */
  double largest, largest_t; /**< invariant where its size was largest, and that time */
} alarm_bound;

typedef struct alarm_list {
  int count;
  alarm_bound alarm[WORDS_MAX];
} alarm_list;

/** Read alarms "NAME=BOUND". Returns DONE, or complains and returns USAGE. */
int alarms_read(alarm_list *list, const problem *scene, const words *asked);

/** Check the bounds at the state. Complains and returns false if an invariant is not finite. */
bool alarms_look(alarm_list *list, dvi_integrator *integrator);

/** Report the bounds that were passed. */
void alarms_tell(const alarm_list *list);
#endif
