/** Command lines. A table declares the options, which are parsed strictly and explained by
 * --help. */
#ifndef OPTIONS_H
#define OPTIONS_H
#include <stdbool.h>

enum { WORDS_MAX = 64 };

/** The values of an option that may be given several times. */
typedef struct words {
  int count;
  const char *word[WORDS_MAX];
} words;

/** One option. Exactly one of the pointers is set. It gives the kind of the value and the place
 * where the value is stored. */
typedef struct option {
  const char *name;  /**< name without the dashes */
  bool *flag;        /**< set by an option without value */
  double *number;    /**< any finite number */
  long *count;       /**< whole number from 1 */
  const char **word; /**< any text */
  words *words;      /**< any text, may be repeated */
  const char *value; /**< spelling of the value in the help text, such as "H" */
  const char *help;
} option;

/** One subcommand, as its --help describes it. */
typedef struct command_line {
  const char *name;
  const char *synopsis; /**< text after "dvi <name> " */
  /** name of the operand in messages, such as "PROBLEM", or NULL if there is none */
  const char *operand;
  const char *summary;   /**< purpose of the command, in lines that end with a newline */
  const option *options; /**< array that ends with an option without a name */
  /** paragraphs after the options, for example on columns. The array ends with NULL. */
  const char *const *details;
} command_line;

/** Parse the arguments after the subcommand's name.
 *
 *  @param[out] operand    the operand
 *  @param[out] exit_code  set if the command is to end now, because --help was asked for or the
 *                         line makes no sense
 *  @return true to go on */
bool options_parse(const command_line *command, int argc, char **argv, const char **operand,
                   int *exit_code);

/** Refuse equal values of --name, because rows of a table could not be told apart. Returns DONE, or
 * complains and returns USAGE. */
int words_distinct(const char *command, const char *name, const words *given);

/** Read a whole text as a finite number. */
bool parse_number(const char *text, double *number);
#endif
