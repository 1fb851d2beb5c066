/** Bounds of invariants that dvi run watches: it says when one is passed, and goes on. */
#ifndef ALARMS_H
#define ALARMS_H
#include "cli/options.h"
#include "problem.h"

typedef struct alarm_bound {
  int invariant;
  const char *name;
  double bound;              /**< of the size */
  double passed;             /**< when it was passed first; NaN: not yet */
  double largest, largest_t; /**< the invariant where its size was largest, and when */
} alarm_bound;

typedef struct alarm_list {
  int count;
  alarm_bound alarm[WORDS_MAX];
} alarm_list;

/** Read alarms "NAME=BOUND". Returns DONE, or complains and returns USAGE. */
int alarms_read(alarm_list *list, const problem *scene, const words *asked);

/** Look at the state. False, with a complaint, if an invariant is no number. */
bool alarms_look(alarm_list *list, dvi_integrator *integrator);

/** Say which bounds were passed. */
void alarms_tell(const alarm_list *list);
#endif
