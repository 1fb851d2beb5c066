#include "csv/reactions.h"

#include <stdio.h>
#include <string.h>

int reaction_count(const problem *scene)
{
  int count = 0;
  for (int k = 0; k < scene->terms->holonomic_count; k++)
    count += scene->terms->holonomics[k].count;
  for (int k = 0; k < scene->terms->nonholonomic_count; k++)
    count += scene->terms->nonholonomics[k].count;
  return count;
}

/* The names of a constraint's rows. */
typedef struct named_rows {
  const char *name, *const *row_names; /* row_names may be NULL */
  int count;
} named_rows;

static const char *name_of_row(const named_rows *rows, int a)
{
  return rows->row_names != NULL ? rows->row_names[a] : rows->name;
}

/* Write the number of a row among its neighbours of the same name, 0 if it has none. */
static int number_of_row(const named_rows *rows, int a)
{
  int first = a, last = a;
  while (first > 0 && strcmp(name_of_row(rows, first - 1), name_of_row(rows, a)) == 0) first--;
  while (last + 1 < rows->count && strcmp(name_of_row(rows, last + 1), name_of_row(rows, a)) == 0)
    last++;
  return first < last ? a - first + 1 : 0;
}

static void name_rows(const named_rows *rows, char (*name)[REACTION_NAME_SIZE])
{
  for (int a = 0; a < rows->count; a++) {
    const int number = number_of_row(rows, a);
    char suffix[16] = "";
    if (number > 0) (void)snprintf(suffix, sizeof suffix, "_%d", number);
    (void)snprintf(name[a], sizeof *name, "lambda_%s%s", name_of_row(rows, a), suffix);
  }
}

void force_name(const problem *scene, int contact, char name[REACTION_NAME_SIZE])
{
  (void)snprintf(name, REACTION_NAME_SIZE, "force_%s",
                 dvi_system_contact_name(scene->system, contact));
}

void reaction_names(const problem *scene, char (*name)[REACTION_NAME_SIZE])
{
  for (int k = 0; k < scene->terms->holonomic_count; k++) {
    const dvi_holonomic *term = &scene->terms->holonomics[k];
    const named_rows rows = {term->name != NULL ? term->name : "constraint", term->row_names,
                             term->count};
    name_rows(&rows, name);
    name += term->count;
  }
  for (int k = 0; k < scene->terms->nonholonomic_count; k++) {
    const dvi_nonholonomic *term = &scene->terms->nonholonomics[k];
    const named_rows rows = {term->name != NULL ? term->name : "nonholonomic", NULL, term->count};
    name_rows(&rows, name);
    name += term->count;
  }
}
