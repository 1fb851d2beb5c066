/** The monitor that chooses the steps of a method, as the command line gives it. */
#ifndef PACING_H
#define PACING_H
#include <stddef.h>

/** The specification of at most one monitor. Without one, steps are steps of time. */
typedef struct pacing {
  const char *transform, *control; /**< --time-transform, --step-control */
} pacing;

enum { PACED_NAME = 320 };

/** Write the method's name in tables, which is its specification, then " @ " and the monitor. */
void paced_name(const char *method, const pacing *how, char *text, size_t size);

/** Refuse two monitors. Returns DONE, or complains and returns USAGE. */
int pacing_check(const char *command, const pacing *how);
#endif
