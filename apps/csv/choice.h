/** The choice of a table's columns by their names. */
#ifndef CHOICE_H
#define CHOICE_H
#include "cli/spelling.h"

/** Chosen columns. `scene` and `method` stand in messages. */
typedef struct column_choice {
  const char *scene, *method;
  word_at name_at; /**< gives the names of all columns */
  const void *list;
  int *place; /**< [count] places of the chosen ones, with room for all */
  int count;
} column_choice;

/** Choose the column of a name. The column t opens every row anyway, and is passed over. Returns
 * DONE, or complains of a name that is none, with the nearest one or a list, or of one that is
 * chosen already, and returns the exit code. */
int choice_add(column_choice *choice, const char *name);

/** Choose the columns "A,B,..". Returns as choice_add. */
int choice_add_all(column_choice *choice, const char *names);
#endif
