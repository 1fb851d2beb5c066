#define _POSIX_C_SOURCE 200809L
#include "csv/choice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { HINT_SIZE = 512, NAMED_MOST = 12 };

/* Write a hint at the nearest name, or else the first of all names. */
static const char *hint_at_name(const column_choice *c, const char *name, char hint[HINT_SIZE])
{
  const char *known;
  size_t length = 0;
  int there = 0;
  if (suggestion(name, c->name_at, c->list, hint, HINT_SIZE)[0] != '\0') return hint;
  for (; (known = c->name_at(there, c->list)) != NULL; there++)
    if (there < NAMED_MOST && length < HINT_SIZE)
      length += (size_t)snprintf(hint + length, HINT_SIZE - length, "%s%s",
                                 there > 0 ? ", " : "; it has ", known);
  if (there > NAMED_MOST && length < HINT_SIZE)
    (void)snprintf(hint + length, HINT_SIZE - length, " and %d others", there - NAMED_MOST);
  return hint;
}

int choice_add(column_choice *c, const char *name)
{
  const char *known;
  int k = 0;
  if (strcmp(name, "t") == 0) return DONE;
  while ((known = c->name_at(k, c->list)) != NULL && strcmp(known, name) != 0) k++;
  if (known == NULL) {
    char hint[HINT_SIZE];
    return usage_error("run: %s by %s has no column '%s'%s", c->scene, c->method, name,
                       hint_at_name(c, name, hint));
  }
  for (int i = 0; i < c->count; i++)
    if (c->place[i] == k) return usage_error("run: column '%s' is asked for twice", name);
  c->place[c->count++] = k;
  return DONE;
}

int choice_add_all(column_choice *c, const char *names)
{
  int code = DONE;
  char *copy = strdup(names);
  if (copy == NULL) return library_error(DVI_NO_MEMORY);
  for (char *name = copy, *next; name != NULL && code == DONE; name = next) {
    next = strchr(name, ',');
    if (next != NULL) *next++ = '\0';
    code = choice_add(c, name);
  }
  free(copy);
  return code;
}
