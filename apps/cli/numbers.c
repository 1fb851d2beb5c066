#include "cli/numbers.h"

#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"

static int numbers_read_one(const char *where, const char *text, size_t length, numbers *list)
{
  if (list->count == NUMBERS_MAX)
    return usage_error("%s takes %d numbers at most", where, (int)NUMBERS_MAX);
  char *word = list->text[list->count];
  double *number = &list->number[list->count];
  if (length >= NUMBER_SIZE)
    return usage_error("%s: '%.*s' is too long for a number", where, (int)length, text);
  (void)snprintf(word, NUMBER_SIZE, "%.*s", (int)length, text);
  if (!parse_number(word, number) || !(*number > 0.0))
    return usage_error("%s wants positive numbers, separated by commas, not '%s'", where, word);
  for (int i = 0; i < list->count; i++)
    if (!(list->number[i] < *number) && !(list->number[i] > *number))
      return usage_error("%s names %s twice", where, word);
  list->count++;
  return DONE;
}

int numbers_read(const char *where, const char *text, numbers *list)
{
  int code = DONE;
  list->count = 0;
  while (text != NULL && code == DONE) {
    const size_t length = strcspn(text, ",");
    code = numbers_read_one(where, text, length, list);
    text = text[length] == ',' ? text + length + 1 : NULL;
  }
  return code;
}
