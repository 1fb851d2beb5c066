#include "watch/alarms.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

enum { NAME_SIZE = 64, HINT_SIZE = 128 };

static const char *invariant_at(int k, const void *list)
{
  return dvi_system_invariant_name(((const problem *)list)->system, k);
}

static int alarm_read(const problem *scene, const char *text, alarm_bound *alarm)
{
  const size_t length = strcspn(text, "=");
  *alarm = (alarm_bound){.passed = (double)NAN};
  if (text[length] != '=' || !parse_number(text + length + 1, &alarm->bound) ||
      !(alarm->bound > 0.0))
    return usage_error("run: --alarm wants NAME=BOUND with a positive number, not '%s'", text);
  for (; alarm->invariant < dvi_system_invariant_count(scene->system); alarm->invariant++) {
    alarm->name = dvi_system_invariant_name(scene->system, alarm->invariant);
    if (strncmp(alarm->name, text, length) == 0 && alarm->name[length] == '\0') return DONE;
  }
  char name[NAME_SIZE], hint[HINT_SIZE];
  (void)snprintf(name, sizeof name, "%.*s", (int)length, text);
  return usage_error("run: --alarm %s: %s has no invariant '%s'%s", text, scene->name, name,
                     suggestion(name, invariant_at, scene, hint, sizeof hint));
}

static int refuse_second_alarm(const alarm_list *list, const alarm_bound *alarm)
{
  for (int i = 0; i < list->count; i++)
    if (list->alarm[i].invariant == alarm->invariant)
      return usage_error("run: --alarm %s is given twice; an invariant has one bound", alarm->name);
  return DONE;
}

int alarms_read(alarm_list *list, const problem *scene, const words *asked)
{
  int code = DONE;
  for (list->count = 0; list->count < asked->count && code == DONE; list->count++) {
    alarm_bound *alarm = &list->alarm[list->count];
    code = alarm_read(scene, asked->word[list->count], alarm);
    if (code == DONE) code = refuse_second_alarm(list, alarm);
  }
  return code;
}

bool alarms_look(alarm_list *list, dvi_integrator *integrator)
{
  const double t = dvi_integrator_time(integrator);
  for (int i = 0; i < list->count; i++) {
    alarm_bound *alarm = &list->alarm[i];
    double value = 0.0;
    const dvi_status status = dvi_integrator_invariant(integrator, alarm->invariant, &value);
    if (status != DVI_OK) {
      (void)library_error(status);
      return false;
    }
    if (isnan(alarm->passed) && fabs(value) > alarm->bound) alarm->passed = t;
    if (!(fabs(value) > fabs(alarm->largest))) continue;
    alarm->largest = value;
    alarm->largest_t = t;
  }
  return true;
}

void alarms_tell(const alarm_list *list)
{
  for (int i = 0; i < list->count; i++) {
    const alarm_bound *alarm = &list->alarm[i];
    if (isnan(alarm->passed)) continue;
    complain("run: alarm: %s passed %g at t = %.6g; at most it was %.6g, at t = %.6g", alarm->name,
             alarm->bound, alarm->passed, alarm->largest, alarm->largest_t);
  }
}
