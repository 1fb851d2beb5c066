#include "core/status.h"

#include <dvi/number.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static _Thread_local char sentence[DVI__SENTENCE_SIZE], reason[DVI__SENTENCE_SIZE];

const char *dvi_status_name(dvi_status status)
{
  switch (status) {
#define NAME_CASE(name, number, meaning) \
  case name: return #name;
    DVI_STATUS_LIST(NAME_CASE)
#undef NAME_CASE
  }
  return "unknown status";
}

const char *dvi_status_meaning(dvi_status status)
{
  switch (status) {
#define MEANING_CASE(name, number, meaning) \
  case name: return meaning;
    DVI_STATUS_LIST(MEANING_CASE)
#undef MEANING_CASE
  }
  return "unknown status";
}

const char *dvi_last_error(void)
{
  return sentence;
}

/* Both functions write to a local text first, because an argument may be the last sentence
 * itself. */
dvi_status dvi__fail(dvi_status status, const char *format, ...)
{
  char text[DVI__SENTENCE_SIZE];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  memcpy(sentence, text, sizeof text);
  return status;
}

dvi_status dvi__fail_in(dvi_status status, const char *format, ...)
{
  char text[DVI__SENTENCE_SIZE] = "";
  va_list arguments;
  va_start(arguments, format);
  const int length = dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  if (length >= 0 && length < DVI__SENTENCE_SIZE - 3 && sentence[0] != '\0')
    (void)snprintf(text + length, sizeof text - (size_t)length, ": %.*s",
                   DVI__SENTENCE_SIZE - 3 - length, sentence);
  memcpy(sentence, text, sizeof text);
  return status;
}

int dvi__return_because(int returned, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(reason, sizeof reason, format, arguments);
  va_end(arguments);
  return returned;
}

void dvi__take_reason(char *text)
{
  memcpy(text, reason, sizeof reason);
  reason[0] = '\0';
}
