/** Facts about a run, which become attributes of its file. */
#ifndef FACTS_H
#define FACTS_H
#include <stdbool.h>

#include "cli/options.h"
#include "hdf5/hdf5_module.h"
#include "problem.h"

enum { FACTS_MAX = 16, FACTS_OWNED_MAX = 4 };

/** The facts. All zero is none. */
typedef struct fact_list {
  int count;
  hdf5_fact fact[FACTS_MAX];
  int owned_count;
  char *owned[FACTS_OWNED_MAX]; /**< texts that the list frees */
} fact_list;

/** Add a text, or a number, which must outlive the list. One that decides is the same in all files
 * to which rows may be appended. NULL is no text, and adds nothing. */
void facts_add_text(fact_list *list, const char *name, const char *text, bool decides);
void facts_add_number(fact_list *list, const char *name, double number, bool decides);

/** Add what wrote the file, by which command line, and the problem with the text of its scene.
 * Complains and returns false without memory. */
bool facts_add_problem(fact_list *list, const problem *scene, const char *command);

/** Add those settings that do not merely place the start. Complains and returns false without
 * memory. */
bool facts_add_settings(fact_list *list, const problem *scene, const words *settings);

void facts_clear(fact_list *list);
#endif
