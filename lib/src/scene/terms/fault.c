#include "scene/terms/fault.h"

#include <dvi/number.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { FAULT_SIZE = 512 };
static _Thread_local char fault_text[FAULT_SIZE];
static _Thread_local dvi_status fault_status;
static _Thread_local dvi__span fault_span;
static _Thread_local size_t fault_words; /* start of the words behind a place, or 0 */

void dvi__fault_clear(void)
{
  fault_text[0] = '\0';
  fault_status = DVI_OK;
  fault_words = 0;
}

dvi_status dvi__fault_status(void)
{
  return fault_status;
}

bool dvi__fault_place(dvi__span *span, const char **words)
{
  *span = fault_span;
  *words = fault_text + fault_words;
  return fault_words > 0;
}

const char *dvi_scene_fault(void)
{
  return fault_text;
}

/* Add to the sentence. */
static void fault_add(const char *format, ...) DVI__TEXT_PRINTF(1, 2);
static void fault_add(const char *format, ...)
{
  const size_t used = strlen(fault_text);
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(fault_text + used, sizeof fault_text - used, format, arguments);
  va_end(arguments);
}

/* Add the time, and the coordinates that the part depends on. */
static void fault_add_point(const dvi__scene_term *term, const double *t, const dvi__fault *fault)
{
  const char *word = ", where";
  if (t != NULL) fault_add(", at t = %.6g", *t);
  for (int i = 0; i < fault->count; i++) {
    const char *label = fault->variable[i].block == DVI__COORDINATES
                            ? dvi_scene_coordinate(term->scene, fault->variable[i].number)
                            : NULL;
    if (label == NULL) continue;
    fault_add("%s %s = %.6g", word, label, fault->variable[i].value);
    word = ",";
  }
}

/* Keep the part that was not finite, or has no series, at the first of the points where one is. */
static void fault_keep(const dvi__scene_term *term, int count, const double *const *x,
                       int of_series)
{
  const dvi__source *source = &term->scene->source;
  char part[FAULT_SIZE / 2] = "";
  dvi__fault fault = {.span = DVI__NOWHERE};
  int k = 0, line = 0, column = 0;
  for (; k < count && part[0] == '\0'; k++)
    dvi__function_fault(term->function, source, count, x, k, of_series, part, sizeof part, &fault);
  fault_text[0] = '\0';
  fault_words = 0;
  if (part[0] == '\0') {
    fault_add(of_series ? "%s: the Taylor series of all terms is not finite"
                        : "%s: the sum of all terms is not finite",
              source->name);
    return;
  }
  dvi__source_place(source, fault.span.first, &line, &column);
  fault_add("%s:%d:%d: ", dvi__source_name(source, fault.span.first), line, column);
  fault_span = fault.span;
  fault_words = strlen(fault_text);
  fault_add("%s", part);
  fault_add_point(term, x[DVI__TIME] != NULL ? &x[DVI__TIME][k - 1] : NULL, &fault);
}

const char *dvi__too_large(dvi_status status)
{
  return status == DVI_NO_MEMORY ? "memory ran out"
                                 : "too large: its derivatives need more than 2000000 parts, "
                                   "20000000 pairs, 16384 numbers at a time, or 1 GiB";
}

int dvi__fault_check(const dvi__scene_term *term, int count, const double *const *x, int of_series,
                     int returned)
{
  if (returned == 0) return 0;
  fault_status = returned > 0 ? DVI_NOT_FINITE : (dvi_status)returned;
  if (returned > 0)
    fault_keep(term, count, x, of_series);
  else
    (void)snprintf(fault_text, sizeof fault_text, "%s: %s", term->scene->source.name,
                   dvi__too_large(fault_status));
  return returned;
}

bool(dvi__scene_too_large)(dvi_scene *scene, const char *what, dvi_status status)
{
  return dvi__complain(scene->complaint, status, DVI__NOWHERE, "%s: %s", what,
                       dvi__too_large(status));
}
