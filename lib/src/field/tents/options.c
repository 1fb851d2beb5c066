#include "field/tents/options.h"

#include <dvi/number.h>
#include <math.h>
#include <string.h>

#include "core/status.h"

/* Whole numbers beyond this are not all doubles. */
static const double seed_most = 9007199254740992.0;

static int begins_with(const char *text, const char *word)
{
  return strncmp(text, word, strlen(word)) == 0;
}

static dvi_status refuse(const char *text)
{
  return dvi__fail(DVI_BAD_OPTION,
                   "tents: \"%.*s\" is no option: \"least=\" a part above 0 and at most 1, "
                   "\"seed=\" a whole number of at least 0, and \"band=\" a number above 1, are",
                   (int)strcspn(text, ","), text);
}

static int set_least(double number, dvi__tents_options *options)
{
  options->least = number;
  return number > 0 && number <= 1;
}

static int set_seed(double number, dvi__tents_options *options)
{
  const int is_good = number >= 0 && number <= seed_most && number == floor(number);
  if (is_good) options->seed = (uint64_t)number;
  return is_good;
}

static int set_band(double number, dvi__tents_options *options)
{
  options->band = number;
  return number > 1 && isfinite(number);
}

/* The options, which return whether their number is good. */
static const struct {
  const char *word;
  int (*set)(double number, dvi__tents_options *options);
} known[] = {{"least=", set_least}, {"seed=", set_seed}, {"band=", set_band}};

/* Take one option. Returns the text behind it, or the text itself if it is none. */
static const char *take(const char *text, dvi__tents_options *options)
{
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    double number = -1;
    if (!begins_with(text, known[i].word)) continue;
    const char *rest = dvi_number_read(text + strlen(known[i].word), &number);
    return known[i].set(number, options) && (*rest == '\0' || *rest == ',') ? rest : text;
  }
  return text;
}

dvi_status dvi__tents_read_options(const char *text, dvi__tents_options *options)
{
  while (*text != '\0') {
    const char *rest = take(text, options);
    if (rest == text) return refuse(text);
    text = *rest == ',' ? rest + 1 : rest;
  }
  return DVI_OK;
}
