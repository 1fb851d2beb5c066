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
                   "tents: \"%.*s\" is no option: \"least=\" a part above 0 and at most 1, and "
                   "\"seed=\" a whole number of at least 0, are",
                   (int)strcspn(text, ","), text);
}

/* Take one option. Returns the text behind it, or the text itself if it is none. */
static const char *take(const char *text, dvi__tents_options *options)
{
  const int is_least = begins_with(text, "least=");
  double number = -1;
  if (!is_least && !begins_with(text, "seed=")) return text;
  const char *rest = dvi_number_read(strchr(text, '=') + 1, &number);
  const int is_good = is_least ? number > 0 && number <= 1
                               : number >= 0 && number <= seed_most && number == floor(number);
  if (!is_good || (*rest != '\0' && *rest != ',')) return text;
  if (is_least)
    options->least = number;
  else
    options->seed = (uint64_t)number;
  return rest;
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
