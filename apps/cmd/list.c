/* dvi list, which shows the methods and the problems. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/options.h"
#include "problem.h"
#include "cli/spelling.h"
#include "csv/table.h"

enum { NAMES_SIZE = 1024, NAME_COLUMN = 17, KEY_COLUMN = 12, HINT_SIZE = 64 };

static const table_column method_columns[] = {
    {"method", NULL}, {"summary", NULL}, {"source", NULL}, {"keys", NULL}, {NULL, NULL}};
static const table_column problem_columns[] = {
    {"problem", NULL}, {"summary", NULL}, {"parameters", NULL}, {NULL, NULL}};

static const char *problem_list_at(int k, const void *list)
{
  (void)list;
  return k == 0 ? "methods" : k == 1 ? "problems" : NULL;
}

/* Append a word to a list of words, or leave it out if it does not fit. */
static void append_word(char *text, const char *word)
{
  const size_t length = strlen(text);
  if (length + strlen(word) + 2 <= NAMES_SIZE)
    (void)snprintf(text + length, NAMES_SIZE - length, "%s%s", length > 0 ? " " : "", word);
}

static void list_method(int i)
{
  (void)printf("%-*s %s [%s]\n", NAME_COLUMN, dvi_method_name(i), dvi_method_summary(i),
               dvi_method_citation(i));
  for (int k = 0; k < dvi_method_key_count(i); k++)
    (void)printf("    %-*s  %s\n", KEY_COLUMN, dvi_method_key_name(i, k),
                 dvi_method_key_help(i, k));
}

static void list_methods(void)
{
  for (int i = 0; i < dvi_method_count(); i++) list_method(i);
  (void)printf("\nA method is named as name[:key=value,...], for example "
               "galerkin:degree=4,quadrature=lobatto,nodes=5\n"
               "Scenes of fields on meshes have marches, too: leapfrog (also called "
               "bossavit-kettunen, and yee on boxes), avi, avi:classes=no and tents "
               "(docs/fields/maxwell.md)\n"
               "Scenes with a density on cells of linear functions have "
               "multisymplectic:space=1/6,time=1/4 (docs/fields/multisymplectic.md), and those of "
               "Schroedinger's equation have midpoint, gauss:stages=2 and split:order=4 of their "
               "own (docs/fields/schroedinger.md)\n");
}

static result_table *methods_table(void)
{
  result_table *t = table_create(method_columns);
  for (int i = 0; i < dvi_method_count(); i++) {
    char keys[NAMES_SIZE] = "";
    for (int k = 0; k < dvi_method_key_count(i); k++) append_word(keys, dvi_method_key_name(i, k));
    table_text(t, dvi_method_name(i));
    table_text(t, dvi_method_summary(i));
    table_text(t, dvi_method_citation(i));
    table_text(t, keys);
  }
  return t;
}

static void list_problem(int i)
{
  (void)printf("%-*s %s\n", NAME_COLUMN, problem_name(i), problem_summary(i));
  for (const problem_parameter *k = problem_parameters(i); k->name != NULL; k++) {
    char spelling[32];
    problem_spell(k, k->value, spelling, sizeof spelling);
    (void)printf("    %-*s  %s (default %s%s)\n", KEY_COLUMN, k->name, k->help, spelling,
                 k->start_only ? "; only places the start" : "");
  }
}

static void list_problems(void)
{
  for (int i = 0; i < problem_count(); i++) list_problem(i);
  (void)printf("\nParameters are set with --set name=value, for example dvi run kepler --method "
               "verlet --set e=0.9\n"
               "A problem of one's own is a scene, FILE.yaml in place of a name: dvi init "
               "FILE.yaml writes one to begin with\n");
}

static result_table *problems_table(void)
{
  result_table *t = table_create(problem_columns);
  for (int i = 0; i < problem_count(); i++) {
    char parameters[NAMES_SIZE] = "";
    for (const problem_parameter *k = problem_parameters(i); k->name != NULL; k++) {
      char spelling[32], pair[128];
      problem_spell(k, k->value, spelling, sizeof spelling);
      (void)snprintf(pair, sizeof pair, "%s=%s", k->name, spelling);
      append_word(parameters, pair);
    }
    table_text(t, problem_name(i));
    table_text(t, problem_summary(i));
    table_text(t, parameters);
  }
  return t;
}

/* Print the method or the problem of this name. Returns false if there is neither. */
static bool list_named(const char *name)
{
  const int methods = dvi_method_count(), found = problem_find(name);
  int method = 0;
  while (method < methods && strcmp(dvi_method_name(method), name) != 0) method++;
  if (method < methods) list_method(method);
  if (found >= 0) list_problem(found);
  return method < methods || found >= 0;
}

static int list_write_csv(const result_table *table, const char *path)
{
  whole_file csv;
  if (!table_good(table) || !file_open(&csv, path)) return FAILED;
  table_csv(table, csv.stream);
  return file_keep(&csv) ? DONE : FAILED;
}

static const char *const details[] = {
    "CSV columns: method,summary,source,keys or problem,summary,parameters; keys and parameters "
    "are\n"
    "separated by blanks, parameters stand with their defaults.\n",
    "Examples:\n"
    "  dvi list methods\n"
    "  dvi list galerkin\n"
    "  dvi list problems --csv -\n",
    NULL,
};

typedef struct list_request {
  const char *csv;
} list_request;

static const option command_options[] = {{.name = "csv",
                                          OPTION_AT(list_request, csv),
                                          .value = "-|FILE",
                                          .help = "write the list as CSV",
                                          .is_csv = true},
                                         {.name = NULL}};

static const command_line command = {
    .name = "list",
    .synopsis = "methods|problems|NAME [--csv -|FILE]",
    .operand = "word (methods, problems, or the name of one)",
    .summary =
        "List the methods with the keys of their specifications, or the problems with their\n"
        "parameters; or the one of that name.\n",
    .options = command_options,
    .details = details,
};

int list_command(int argc, char **argv)
{
  list_request r = {.csv = NULL};
  const char *what;
  int code;
  if (!options_parse(&command, argc, argv, &r, &what, &code)) return code;
  const bool methods = strcmp(what, "methods") == 0;
  const bool all = methods || strcmp(what, "problems") == 0;
  if (!all && r.csv == NULL && list_named(what)) return DONE;
  if (!all) {
    char hint[HINT_SIZE];
    return usage_error("list: there are methods, problems and the name of one to list, not '%s'%s",
                       what, suggestion(what, problem_list_at, NULL, hint, sizeof hint));
  }
  if (r.csv == NULL) {
    (methods ? list_methods : list_problems)();
    return DONE;
  }
  result_table *t = methods ? methods_table() : problems_table();
  code = list_write_csv(t, r.csv);
  table_destroy(&t);
  return code;
}
