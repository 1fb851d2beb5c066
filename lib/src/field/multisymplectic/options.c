/* The words of the method: "multisymplectic:space=1/6:0,time=midpoint,potential=levels". */
#include <dvi/number.h>
#include <string.h>

#include "core/status.h"
#include "field/multisymplectic/lattice.h"

static const struct {
  const char *word;
  double weight;
} words[] = {{"trapezoid", 0}, {"midpoint", 1.0 / 4}, {"exact", 1.0 / 6}, {"fourth", 1.0 / 12}};

/* Returns the text behind a word with its end, or NULL. */
static const char *behind(const char *text, const char *word)
{
  const size_t length = strlen(word);
  return strncmp(text, word, length) == 0 ? text + length : NULL;
}

static int ends(const char *text)
{
  return *text == '\0' || *text == ',' || *text == ':';
}

/* Read a weight: a word, a number, or a fraction. Returns the text behind it, or NULL. */
static const char *read_weight(const char *text, double *weight)
{
  double below = 1;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    const char *rest = behind(text, words[i].word);
    if (rest == NULL || !ends(rest)) continue;
    *weight = words[i].weight;
    return rest;
  }
  const char *rest = dvi_number_read(text, weight);
  if (rest == text) return NULL;
  if (*rest == '/') {
    const char *number = rest + 1;
    rest = dvi_number_read(number, &below);
    if (rest == number) return NULL;
    *weight /= below;
  }
  return *weight >= 0 && *weight <= 0.25 && ends(rest) ? rest : NULL;
}

/* Read a weight of all axes, or one for each of some. */
static const char *read_axes(const char *text, dvi_multisymplectic_weights *weights)
{
  int axes = 1;
  const char *rest = read_weight(text, weights->space);
  while (rest != NULL && *rest == ':' && axes < DVI_AXES_MAX)
    rest = read_weight(rest + 1, weights->space + axes++);
  weights->axes = axes > 1 ? axes : 0;
  for (; axes < DVI_AXES_MAX; axes++) weights->space[axes] = weights->space[axes - 1];
  return rest;
}

/* Take one option. Returns the text behind it, or NULL if it is none. */
static const char *take(const char *text, dvi_multisymplectic_weights *weights)
{
  const char *value = behind(text, "time=");
  if (value != NULL) return read_weight(value, &weights->time);
  value = behind(text, "space=");
  if (value != NULL) return read_axes(value, weights);
  value = behind(text, "potential=levels");
  if (value == NULL || !ends(value)) return NULL;
  weights->levels = 1;
  return value;
}

dvi_status dvi_multisymplectic_parse(const char *method, dvi_multisymplectic_weights *weights)
{
  dvi_multisymplectic_weights found = {.time = 0};
  if (method == NULL || weights == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: a method and a place are needed");
  const char *text = behind(method, "multisymplectic");
  if (text == NULL || (*text != '\0' && *text != ':'))
    return dvi__fail(DVI_BAD_OPTION, "multisymplectic: \"%s\" is another method", method);
  if (*text == ':') text++;
  while (*text != '\0') {
    const char *rest = take(text, &found);
    if (rest == NULL)
      return dvi__fail(DVI_BAD_OPTION,
                       "multisymplectic: \"%.*s\" is no option: \"space=\" and \"time=\" have a "
                       "weight from 0 to 1/4 or one of the words trapezoid, midpoint, exact and "
                       "fourth, \"space=\" perhaps one for each axis with colons between them, and "
                       "potentials can be \"potential=levels\"",
                       (int)strcspn(text, ","), text);
    text = *rest == ',' ? rest + 1 : rest;
  }
  *weights = found;
  return DVI_OK;
}
