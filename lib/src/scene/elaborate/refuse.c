/* Refusals that belong to the whole scene. */
#include <dvi/number.h>
#include <stdarg.h>

#include "scene/elaborate/model.h"

bool(dvi__scene_refuse)(dvi_scene *scene, dvi__span span, const char *format, ...)
{
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  return dvi__complain(scene->complaint, DVI_BAD_FILE, span, "%s", text);
}

bool(dvi__scene_no_memory)(dvi_scene *scene)
{
  return dvi__complain_of_memory(scene->complaint);
}
