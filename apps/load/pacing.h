/** What the steps of a method follow, as the command line says it. */
#ifndef PACING_H
#define PACING_H
#include <stddef.h>

/** What the steps of a method follow: one monitor's specification at most; none: steps are steps of
 * time. */
typedef struct pacing {
  const char *transform, *control; /**< --time-transform, --step-control */
} pacing;

enum { PACED_NAME = 320 };

/** How tables name the method: its specification, and " @ " and what its steps follow. */
void paced_name(const char *method, const pacing *how, char *text, size_t size);

/** DONE; or complain that both are given, and return USAGE. */
int pacing_check(const char *command, const pacing *how);
#endif
