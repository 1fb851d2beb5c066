/* Numbers are read and written in the C locale, which is set for this thread meanwhile. The program
 * that uses the library may have set a locale with a decimal comma. */
#define _POSIX_C_SOURCE 200809L /* newlocale */
#include <dvi/number.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Set the C locale for this thread, and return the locale before for leave_plain_locale. */
static locale_t enter_plain_locale(locale_t *plain)
{
  *plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  return uselocale(*plain);
}

static void leave_plain_locale(locale_t plain, locale_t before)
{
  (void)uselocale(before);
  if (plain != (locale_t)0) freelocale(plain);
}

const char *dvi_number_read(const char *text, double *number)
{
  char *end;
  locale_t plain;
  const locale_t before = enter_plain_locale(&plain);
  const double value = strtod(text, &end);
  leave_plain_locale(plain, before);
  if (end == text || strspn(text, "+-.0123456789eE") < (size_t)(end - text)) return text;
  *number = value;
  return end;
}

int dvi_number_vprint(char *text, size_t size, const char *format, va_list arguments)
{
  locale_t plain;
  const locale_t before = enter_plain_locale(&plain);
  const int length = vsnprintf(text, size, format, arguments);
  leave_plain_locale(plain, before);
  return length;
}

void dvi_number_write(double number, char *text)
{
  locale_t plain;
  const locale_t before = enter_plain_locale(&plain);
  int digits = 15;
  do (void)snprintf(text, DVI_NUMBER_SIZE, "%.*g", digits++, number);
  while (digits <= 17 && strtod(text, NULL) != number);
  leave_plain_locale(plain, before);
}
