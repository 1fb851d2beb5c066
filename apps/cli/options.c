#include "cli/options.h"

#include <dvi/number.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

enum { OPTIONS_MAX = 32, HELP_COLUMN = 26, WORD_SIZE = 64 };

bool parse_number(const char *text, double *number)
{
  double value;
  const char *end = dvi_number_read(text, &value);
  if (end == text || *end != '\0' || !isfinite(value)) return false;
  *number = value;
  return true;
}

static bool option_parse_count(const char *text, long *count)
{
  /* strtol would accept blanks and signs */
  if (strspn(text, "0123456789") != strlen(text) || text[0] == '0') return false;
  errno = 0;
  const long value = strtol(text, NULL, 10);
  if (errno != 0 || value < 1) return false;
  *count = value;
  return true;
}

static const char *option_name(int k, const void *list)
{
  return ((const option *)list)[k].name;
}

static void print_help(const command_line *command)
{
  (void)printf("Usage: dvi %s %s\n\n%s\nOptions:\n", command->name, command->synopsis,
               command->summary);
  for (const option *o = command->options; o->name != NULL; o++) {
    const int width = printf("  --%s%s%s", o->name, o->value != NULL ? " " : "",
                             o->value != NULL ? o->value : "");
    (void)printf("%*s%s\n", width < HELP_COLUMN ? HELP_COLUMN - width : 1, "", o->help);
  }
  (void)printf("%-*s%s\n", HELP_COLUMN, "  --help", "print this text");
  for (const char *const *paragraph = command->details; *paragraph != NULL; paragraph++)
    (void)printf("\n%s", *paragraph);
}

/* Return the option that argument --name or --name=value names, or -1. */
static int find_option(const command_line *command, const char *name, size_t length)
{
  for (int k = 0; command->options[k].name != NULL; k++)
    if (strlen(command->options[k].name) == length &&
        strncmp(command->options[k].name, name, length) == 0)
      return k;
  return -1;
}

/* Names of some options in other programs and in scenes. */
static const struct {
  const char *other, *name;
} other_names[] = {{"step", "h"},         {"steps", "h"},    {"dt", "h"},
                   {"step-size", "h"},    {"timestep", "h"}, {"until", "t-end"},
                   {"end", "t-end"},      {"tmax", "t-end"}, {"time", "t-end"},
                   {"duration", "t-end"}, {"output", "out"}, {"param", "set"},
                   {"parameter", "set"},  {"grid", "set"}};

static int unknown_option(const command_line *command, const char *text, size_t length)
{
  char name[WORD_SIZE];
  (void)snprintf(name, sizeof name, "%.*s", (int)length, text);
  const char *near = NULL;
  for (size_t k = 0; k < sizeof other_names / sizeof *other_names && near == NULL; k++)
    if (strcmp(name, other_names[k].other) == 0 &&
        find_option(command, other_names[k].name, strlen(other_names[k].name)) >= 0)
      near = other_names[k].name;
  if (near == NULL) near = nearest_word(name, option_name, command->options);
  if (near != NULL)
    return usage_error("%s: unknown option '--%s' (did you mean '--%s'?); see dvi %s --help",
                       command->name, name, near, command->name);
  return usage_error("%s: unknown option '--%s'; see dvi %s --help", command->name, name,
                     command->name);
}

static int missing_value(const command_line *command, const option *o)
{
  return usage_error("%s: --%s needs a value: --%s %s", command->name, o->name, o->name, o->value);
}

static int store_words(const command_line *command, const option *o, const char *text,
                       words *stored)
{
  if (stored->count == WORDS_MAX)
    return usage_error("%s: --%s is given more than %d times", command->name, o->name,
                       (int)WORDS_MAX);
  stored->word[stored->count++] = text;
  return DONE;
}

/* A file of CSV under a name of HDF5 could be read by nothing. */
static int check_ending(const command_line *command, const option *o, const char *text)
{
  static const char ending[] = ".h5";
  const size_t length = strlen(text), end = sizeof ending - 1;
  if (!o->is_csv || length <= end || strcmp(text + length - end, ending) != 0) return DONE;
  return usage_error("%s: --%s %s: CSV is written there, and names that end in .h5 are of HDF5; "
                     "give another name",
                     command->name, o->name, text);
}

static int store_value(const command_line *command, const option *o, const char *text, void *value)
{
  if ((o->kind == OPTION_WORD || o->kind == OPTION_WORDS) && text[0] == '\0')
    return missing_value(command, o);
  if (check_ending(command, o, text) != DONE) return USAGE;
  switch (o->kind) {
  case OPTION_NUMBER:
    if (parse_number(text, value)) return DONE;
    return usage_error("%s: --%s wants a finite number, not '%s'", command->name, o->name, text);
  case OPTION_COUNT:
    if (option_parse_count(text, value)) return DONE;
    return usage_error("%s: --%s wants a whole number from 1, in plain digits, not '%s'",
                       command->name, o->name, text);
  case OPTION_WORDS: return store_words(command, o, text, value);
  case OPTION_WORD: *(const char **)value = text; return DONE;
  case OPTION_LIST: return missing_value(command, o); /* a shell lists no files behind "=" */
  default: return usage_error("%s: --%s takes no value", command->name, o->name);
  }
}

/* A command line while it is read. */
typedef struct reading {
  const command_line *command;
  int argc;
  char **argv;
  int at; /* index of the argument being read */
  bool given[OPTIONS_MAX];
  void *request;
} reading;

/* Take all arguments up to the next option. */
static void take_list(reading *r, word_list *list)
{
  *list = (word_list){.word = r->argv + r->at + 1};
  while (r->at + 1 < r->argc && strncmp(r->argv[r->at + 1], "--", 2) != 0) {
    list->count++;
    r->at++;
  }
}

/* Take the option at argv[at], and its value from there or from the next argument. */
static int take_option(reading *r)
{
  const command_line *command = r->command;
  const char *name = r->argv[r->at] + 2;
  const size_t length = strcspn(name, "=");
  const int k = find_option(command, name, length);
  if (k < 0) return unknown_option(command, name, length);
  const option *o = &command->options[k];
  void *value = (char *)r->request + o->place;
  if (r->given[k] && o->kind != OPTION_WORDS)
    return usage_error("%s: --%s is given twice", command->name, o->name);
  r->given[k] = true;
  if (name[length] == '=') return store_value(command, o, name + length + 1, value);
  if (o->kind == OPTION_FLAG) {
    *(bool *)value = true;
    return DONE;
  }
  if (r->at + 1 == r->argc || strncmp(r->argv[r->at + 1], "--", 2) == 0)
    return missing_value(command, o);
  if (o->kind == OPTION_LIST) {
    take_list(r, value);
    return DONE;
  }
  return store_value(command, o, r->argv[++r->at], value);
}

static int take_operand(const command_line *command, const char *text, const char **operand)
{
  /* -h is not taken for help, because a user who writes -h 0.1 means the step. */
  if (strcmp(text, "-h") == 0)
    return usage_error(
        "%s: unknown option '-h'; %sdvi %s --help explains all options", command->name,
        find_option(command, "h", 1) >= 0 ? "--h sets the step, " : "", command->name);
  if (text[0] == '-' && text[1] != '\0')
    return usage_error("%s: unknown option '%s'; options begin with two dashes, see dvi %s --help",
                       command->name, text, command->name);
  if (*operand != NULL)
    return usage_error("%s: one %s is enough, '%s' is too many", command->name, command->operand,
                       text);
  *operand = text;
  return DONE;
}

bool options_parse(const command_line *command, int argc, char **argv, void *request,
                   const char **operand, int *exit_code)
{
  reading r = {.command = command, .argc = argc, .argv = argv, .request = request};
  *operand = NULL;
  for (; r.at < argc; r.at++) {
    const char *text = argv[r.at];
    if (strcmp(text, "--help") == 0) {
      print_help(command);
      *exit_code = DONE;
      return false;
    }
    *exit_code = strncmp(text, "--", 2) == 0 ? take_option(&r)
                                             : take_operand(command, text, operand);
    if (*exit_code != DONE) return false;
  }
  if (*operand == NULL) {
    *exit_code = usage_error("%s: %s is missing; usage: dvi %s %s", command->name, command->operand,
                             command->name, command->synopsis);
    return false;
  }
  return true;
}

int words_distinct(const char *command, const char *name, const words *given)
{
  for (int i = 0; i < given->count; i++)
    for (int j = 0; j < i; j++)
      if (strcmp(given->word[i], given->word[j]) == 0)
        return usage_error("%s: --%s names %s twice", command, name, given->word[i]);
  return DONE;
}
