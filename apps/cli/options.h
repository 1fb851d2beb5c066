/** Command lines: options declared as a table, parsed strictly, explained by --help. */
#ifndef OPTIONS_H
#define OPTIONS_H
#include <stdbool.h>

enum { WORDS_MAX = 64 };

/** The values of an option that may be given several times. */
typedef struct words {
  int count;
  const char *word[WORDS_MAX];
} words;

/** One option. Exactly one of the pointers is set; it says what kind of value the option takes and
 * where it goes. */
typedef struct option {
  const char *name;  /**< without the dashes */
  bool *flag;        /**< takes no value */
  double *number;    /**< any finite number */
  long *count;       /**< a whole number from 1 */
  const char **word; /**< any text */
  words *words;      /**< any text, may be repeated */
  const char *value; /**< how the help text spells the value: "H" */
  const char *help;
} option;

/** One subcommand, as its --help tells it. */
typedef struct command_line {
  const char *name;
  const char *synopsis; /**< after "dvi <name> " */
  const char
      *operand; /**< what the one operand is, for messages: "PROBLEM"; NULL if there is none */
  const char *summary;   /**< what it does: some lines, each ended by a newline */
  const option *options; /**< ended by one without a name */
  /** after the options: paragraphs, for example of columns; ended by NULL */
  const char *const *details;
} command_line;

/** Parse the arguments after the subcommand's name.
 *
 *  @param[out] operand    the operand
 *  @param[out] exit_code  set if the command is to end now: --help was asked for, or the line makes
 *                         no sense
 *  @return true to go on */
bool options_parse(const command_line *command, int argc, char **argv, const char **operand,
                   int *exit_code);

/** Refuse values of --name of which two are the same: rows of a table could not be told apart.
 * Returns DONE, or complains and returns USAGE. */
int words_distinct(const char *command, const char *name, const words *given);

/** A whole text as a finite number. */
bool parse_number(const char *text, double *number);
#endif
