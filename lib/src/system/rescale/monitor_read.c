/* Specifications name[:key=value,...] of the built-in monitors. */
#include <dvi/number.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "system/rescale/monitor.h"

static const char *const names[] = {"distance", "arclength", "acceleration"};
static const dvi_monitor_kind kinds[] = {DVI_MONITOR_DISTANCE, DVI_MONITOR_ARCLENGTH,
                                         DVI_MONITOR_ACCELERATION};
enum { NAMES = sizeof names / sizeof *names };

/* Return 1 if the text begins with the word and ends there, or goes on after one of the stops. */
static int begins_with(const char *text, const char *word, const char *stops)
{
  const size_t length = strlen(word);
  return strncmp(text, word, length) == 0 &&
         (text[length] == 0 || strchr(stops, text[length]) != NULL);
}

static dvi_status read_name(const char *specification, dvi_monitor *monitor)
{
  for (int k = 0; k < NAMES; k++)
    if (begins_with(specification, names[k], ":")) {
      monitor->kind = kinds[k];
      return DVI_OK;
    }
  return dvi__fail(DVI_BAD_OPTION,
                   "monitor: '%.*s' is unknown; there are distance, arclength and acceleration",
                   (int)strcspn(specification, ":"), specification);
}

/* Read a number up to the next comma. */
static int read_monitor_number(const char *text, double *number)
{
  const char *end = dvi_number_read(text, number);
  return end != text && (*end == 0 || *end == ',') && isfinite(*number) && *number > 0;
}

static dvi_status read_key(const char *name, const char *at, dvi_monitor *monitor)
{
  const char *equals = at + strcspn(at, "=,");
  const int distance = monitor->kind == DVI_MONITOR_DISTANCE, length = (int)strcspn(at, ",");
  double number;
  int *whole = distance && begins_with(at, "bodies", "=")      ? &monitor->bodies
               : distance && begins_with(at, "dimension", "=") ? &monitor->dimension
                                                               : NULL;
  const int power = monitor->kind != DVI_MONITOR_ARCLENGTH && begins_with(at, "power", "=");
  if (whole == NULL && !power)
    return dvi__fail(DVI_BAD_OPTION, "monitor %s: unknown key '%.*s'; it takes %s", name,
                     (int)(equals - at), at,
                     distance                                    ? "power, bodies, dimension"
                     : monitor->kind == DVI_MONITOR_ACCELERATION ? "power"
                                                                 : "none");
  if (*equals != '=' || !read_monitor_number(equals + 1, &number))
    return dvi__fail(DVI_BAD_OPTION, "monitor %s: '%.*s' is not key=value with a positive number",
                     name, length, at);
  if (whole != NULL ? *whole != 0 : monitor->power != 0)
    return dvi__fail(DVI_BAD_OPTION, "monitor %s: key '%.*s' is given twice", name,
                     (int)(equals - at), at);
  if (whole != NULL && (floor(number) != number || number > 1e9))
    return dvi__fail(DVI_BAD_OPTION, "monitor %s: '%.*s' is not a whole number", name, length, at);
  if (whole != NULL)
    *whole = (int)number;
  else
    monitor->power = number;
  return DVI_OK;
}

dvi_status dvi_monitor_read(const char *specification, dvi_monitor *monitor)
{
  dvi_monitor read = {0};
  if (specification == NULL || monitor == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "monitor: an argument is NULL");
  DVI_TRY(read_name(specification, &read));
  const char *name = names[(int)read.kind - 1], *at = specification + strlen(name);
  while (*at == ':' || *at == ',') {
    DVI_TRY(read_key(name, at + 1, &read));
    at += 1 + strcspn(at + 1, ",");
  }
  *monitor = read;
  return DVI_OK;
}
