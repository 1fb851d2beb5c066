/* Methods by their names. */
#include <dvi/number.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/schroedinger/steps.h"

/* A method, and the one option that it may have. */
static const struct {
  const char *name, *option;
  dvi__schroedinger_method method; /* without the option */
  int least, most, by;             /* values of the option */
} methods[] = {{"midpoint", NULL, {.stages = 1}, 0, 0, 1},
               {"gauss", "stages=", {.stages = 2}, 1, DVI__STAGES_MAX, 1},
               {"split", "order=", {.is_split = 1, .order = 2}, 2, 6, 2}};

enum { METHODS = sizeof methods / sizeof *methods };

const char *dvi_schroedinger_method_name(int i)
{
  return i >= 0 && i < METHODS ? methods[i].name : NULL;
}

static int begins_with(const char *text, const char *word)
{
  return strncmp(text, word, strlen(word)) == 0;
}

static dvi_status refuse_name(const char *text, size_t length)
{
  if (length == strlen("verlet") && begins_with(text, "verlet"))
    return dvi__fail(DVI_UNSUPPORTED,
                     "schroedinger: verlet on the real and imaginary parts does not keep the norm; "
                     "take midpoint, gauss or split");
  return dvi__fail(DVI_BAD_OPTION,
                   "schroedinger: there is no method \"%.*s\"; there are midpoint, gauss:stages=2 "
                   "and split:order=4",
                   (int)length, text);
}

/* Read the option of method i from what stands behind the colon. */
static dvi_status read_option(int i, const char *text, dvi__schroedinger_method *method)
{
  double number = -1;
  const char *option = methods[i].option;
  if (option == NULL)
    return dvi__fail(DVI_BAD_OPTION, "schroedinger: %s has no options, but is given \"%s\"",
                     methods[i].name, text);
  const char *rest = text;
  if (begins_with(text, option)) rest = dvi_number_read(text + strlen(option), &number);
  if (*rest != '\0' || !(number >= methods[i].least && number <= methods[i].most) ||
      fmod(number, methods[i].by) != 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "schroedinger: \"%s\" is no option of %s, which has \"%s\" with %s from %d to "
                     "%d",
                     text, methods[i].name, option,
                     methods[i].by == 2 ? "an even number" : "a number", methods[i].least,
                     methods[i].most);
  *(methods[i].method.is_split ? &method->order : &method->stages) = (int)number;
  return DVI_OK;
}

dvi_status dvi__schroedinger_read_method(const char *text, dvi__schroedinger_method *method)
{
  const size_t length = strcspn(text, ":");
  for (int i = 0; i < METHODS; i++) {
    if (strlen(methods[i].name) != length || !begins_with(text, methods[i].name)) continue;
    *method = methods[i].method;
    return text[length] == ':' ? read_option(i, text + length + 1, method) : DVI_OK;
  }
  return refuse_name(text, length);
}
