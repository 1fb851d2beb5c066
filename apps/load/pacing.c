#include "load/pacing.h"

#include <stdio.h>

#include "cli/command.h"

void paced_name(const char *method, const pacing *how, char *text, size_t size)
{
  const char *monitor = how->transform != NULL ? how->transform : how->control;
  (void)snprintf(text, size, "%s%s%s%s", method, monitor != NULL ? " @ " : "",
                 how->control != NULL ? "control " : "", monitor != NULL ? monitor : "");
}

int pacing_check(const char *command, const pacing *how)
{
  if (how->transform == NULL || how->control == NULL) return DONE;
  return usage_error(
      "%s: --time-transform and --step-control both choose the steps; give one of them", command);
}
