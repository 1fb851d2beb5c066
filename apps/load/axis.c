#include "load/axis.h"

#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "load/open.h"

/* Reserved words, which are no parameters of a problem. */
static const struct {
  const char *name;
  axis_kind kind;
  bool parallel;
} reserved[] = {
    {.name = "degree", .kind = AXIS_KEY},
    {.name = "threads", .kind = AXIS_KEY, .parallel = true},
};
enum { RESERVED = sizeof reserved / sizeof *reserved };

static void axis_classify(scale_axis *axis)
{
  axis->kind = AXIS_PARAMETER;
  axis->parallel = false;
  for (int i = 0; i < RESERVED; i++)
    if (strcmp(reserved[i].name, axis->name) == 0) {
      axis->kind = reserved[i].kind;
      axis->parallel = reserved[i].parallel;
    }
}

int axis_read(const char *text, scale_axis *axis)
{
  const size_t length = strcspn(text, "=");
  if (text[length] == '\0' || length == 0 || length >= AXIS_NAME_SIZE)
    return usage_error("bench: --scale wants a parameter of the problem, degree, threads or "
                       "members, and its values, NAME=V1,V2,..., not '%s'",
                       text);
  (void)snprintf(axis->name, sizeof axis->name, "%.*s", (int)length, text);
  axis_classify(axis);
  const int code = numbers_read("bench: --scale", text + length + 1, &axis->values);
  if (code == DONE && axis->values.count < 2)
    return usage_error(
        "bench: --scale needs two values at least: with %s there is nothing to compare", text);
  return code;
}

int axis_problem(const scale_axis *axis, int k, const char *name, const words *settings,
                 bool one_point, problem **scene)
{
  char setting[AXIS_NAME_SIZE + NUMBER_SIZE];
  words all = *settings;
  if (axis->kind == AXIS_PARAMETER) {
    (void)snprintf(setting, sizeof setting, "%s=%s", axis->name, axis->values.text[k]);
    all.word[all.count++] = setting;
  }
  return open_shaped(name, &all, one_point, scene);
}

int axis_method(const scale_axis *axis, int k, const char *method,
                char specification[SPECIFICATION_SIZE])
{
  int length;
  if (axis->kind == AXIS_KEY)
    length = snprintf(specification, SPECIFICATION_SIZE, "%s%c%s=%s", method,
                      strchr(method, ':') != NULL ? ',' : ':', axis->name, axis->values.text[k]);
  else
    length = snprintf(specification, SPECIFICATION_SIZE, "%s", method);
  if (length >= SPECIFICATION_SIZE)
    return usage_error("bench: --method %.40s... is too long for --scale", method);
  return DONE;
}

double axis_abscissa(const scale_axis *axis, int k, int n)
{
  return axis->kind == AXIS_PARAMETER ? n : axis->values.number[k];
}

const char *axis_symbol(const scale_axis *axis)
{
  return axis->kind == AXIS_PARAMETER ? "n" : axis->name;
}

const char *axis_title(const scale_axis *axis)
{
  return axis->kind == AXIS_PARAMETER ? "coordinates" : axis->name;
}
