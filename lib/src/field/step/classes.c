#include "field/step/classes.h"

#include <math.h>
#include <string.h>
#include <dvi/number.h>

#include "core/status.h"

enum { DENOMINATOR_MOST = 64, PERIOD_MOST = 1000 };

/* ---- options ---- */

static dvi_status bad_option(const char *text, int length)
{
  return dvi__fail(DVI_BAD_OPTION,
                   "avi: \"%.*s\" is no option; classes=yes, classes=no and band=NUMBER, above 1, "
                   "are possible",
                   length, text);
}

static int is_text(const char *text, int length, const char *other)
{
  return (int)strlen(other) == length && strncmp(text, other, (size_t)length) == 0;
}

static dvi_status read_option(const char *text, int length, int *is_free, double *band)
{
  double found = 0;
  if (is_text(text, length, "classes=yes") || is_text(text, length, "classes=no")) {
    *is_free = text[length - 1] == 'o';
    return DVI_OK;
  }
  if (strncmp(text, "band=", 5) != 0 || dvi_number_read(text + 5, &found) != text + length ||
      !(found > 1) || isinf(found))
    return bad_option(text, length);
  *band = found;
  return DVI_OK;
}

dvi_status dvi__read_classes(const char *text, int *is_free, double *band)
{
  while (*text != '\0') {
    const int length = (int)strcspn(text, ",");
    DVI_TRY(read_option(text, length, is_free, band));
    text += length;
    if (*text == ',' && *++text == '\0') return bad_option("", 0);
  }
  return DVI_OK;
}

/* ---- the common period ---- */

static int64_t greatest_divisor(int64_t a, int64_t b)
{
  while (b != 0) {
    const int64_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/* The common multiple of the steps in units of shortest/q, or 0 if one is no multiple of the unit,
 * or if it is above `most` units. */
static int64_t common_multiple(int64_t count, const double *step, double shortest, int q,
                               double most)
{
  int64_t multiple = 1, last = 0;
  for (int64_t c = 0; c < count; c++) {
    const double units = step[c] / shortest * q;
    if (fabs(units - rint(units)) > 1e-10 * units) return 0;
    const int64_t p = (int64_t)rint(units);
    if (p == last) continue;
    last = p;
    multiple = multiple / greatest_divisor(multiple, p) * p;
    if ((double)multiple > most) return 0;
  }
  return multiple;
}

double dvi__common_period(int64_t count, const double *step, double shortest, double longest)
{
  if (longest > 1e6 * shortest) return 0;
  for (int q = 1; q <= DENOMINATOR_MOST; q++) {
    const int64_t multiple = common_multiple(count, step, shortest, q,
                                             PERIOD_MOST * longest / shortest * q);
    if (multiple > 0) return (double)multiple * shortest / q;
  }
  return 0;
}
