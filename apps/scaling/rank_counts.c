#include "scaling/rank_counts.h"

#include <math.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"

enum { WORD_SIZE = 32 };

static const char name[] = "ranks=", dots[] = "...";
static const double most = 1e9;

bool rank_counts_asked(const char *scaled)
{
  return scaled != NULL && strncmp(scaled, name, sizeof name - 1) == 0;
}

static int add(double number, rank_counts *counts)
{
  const double last = counts->count > 0 ? counts->number[counts->count - 1] : 0;
  if (counts->count == RANK_COUNTS_MAX)
    return usage_error("bench: --scale ranks= takes %d numbers at most", (int)RANK_COUNTS_MAX);
  if (number <= last)
    return usage_error("bench: --scale ranks= wants ascending numbers, and %.0f follows %.0f",
                       number, last);
  counts->number[counts->count++] = number;
  return DONE;
}

/* Go on by the factor between the last two numbers, to a number that is added by the caller. */
static int fill(double end, rank_counts *counts)
{
  if (counts->count < 2)
    return usage_error("bench: --scale ranks=: three dots go on by the factor between two numbers, "
                       "as in 1,2,...,1024");
  const double factor = counts->number[counts->count - 1] / counts->number[counts->count - 2];
  int code = DONE;
  for (double next = counts->number[counts->count - 1] * factor; next < end && code == DONE;
       next *= factor)
    code = add(round(next), counts);
  return code;
}

static int read_number(const char *text, size_t length, double *number)
{
  char word[WORD_SIZE] = "";
  if (length < sizeof word) memcpy(word, text, length);
  if (length < sizeof word && parse_number(word, number) && *number >= 1 && *number <= most &&
      *number == floor(*number))
    return DONE;
  return usage_error("bench: --scale ranks=: '%.*s' is no whole number from 1 to %g", (int)length,
                     text, most);
}

int rank_counts_read(const char *scaled, rank_counts *counts)
{
  const char *text = scaled + sizeof name - 1;
  bool has_dots = false;
  int code = DONE;
  counts->count = 0;
  while (text != NULL && code == DONE) {
    const size_t length = strcspn(text, ",");
    const bool is_dots = length == sizeof dots - 1 && strncmp(text, dots, length) == 0;
    double number = 0;
    if (is_dots && (has_dots || text[length] == '\0'))
      return usage_error("bench: --scale ranks=: a number stands behind three dots");
    if (!is_dots) code = read_number(text, length, &number);
    if (!is_dots && has_dots && code == DONE) code = fill(number, counts);
    if (!is_dots && code == DONE) code = add(number, counts);
    has_dots = is_dots;
    text = text[length] == ',' ? text + length + 1 : NULL;
  }
  return code;
}
