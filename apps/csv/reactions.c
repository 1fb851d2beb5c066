#include "csv/reactions.h"

#include <stdio.h>
#include <string.h>

int reaction_count(const problem *scene)
{
  int count = 0;
  for (int k = 0; k < scene->terms->holonomic_count; k++)
    count += scene->terms->holonomics[k].count;
  return count;
}

static const char *name_of_row(const dvi_holonomic *rows, int a)
{
  if (rows->row_names != NULL) return rows->row_names[a];
  return rows->name != NULL ? rows->name : "constraint";
}

/* Write the number of a row among its neighbours of the same name, 0 if it has none. */
static int number_of_row(const dvi_holonomic *rows, int a)
{
  int first = a, last = a;
  while (first > 0 && strcmp(name_of_row(rows, first - 1), name_of_row(rows, a)) == 0) first--;
  while (last + 1 < rows->count && strcmp(name_of_row(rows, last + 1), name_of_row(rows, a)) == 0)
    last++;
  return first < last ? a - first + 1 : 0;
}

void reaction_names(const problem *scene, char (*name)[REACTION_NAME_SIZE])
{
  for (int k = 0; k < scene->terms->holonomic_count; k++) {
    const dvi_holonomic *rows = &scene->terms->holonomics[k];
    for (int a = 0; a < rows->count; a++, name++) {
      const int number = number_of_row(rows, a);
      char suffix[16] = "";
      if (number > 0) (void)snprintf(suffix, sizeof suffix, "_%d", number);
      (void)snprintf(*name, sizeof *name, "lambda_%s%s", name_of_row(rows, a), suffix);
    }
  }
}
