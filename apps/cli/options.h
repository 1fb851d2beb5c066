/** Command lines. A table declares the options, which are parsed strictly and explained by
 * --help. */
#ifndef OPTIONS_H
#define OPTIONS_H
#include <stdbool.h>
#include <stddef.h>

enum { WORDS_MAX = 64 };

/** The values of an option that may be given several times. */
typedef struct words {
  int count;
  const char *word[WORDS_MAX];
} words;

/** The values of an option that takes all arguments up to the next option. */
typedef struct word_list {
  int count;
  char *const *word; /**< [count] part of the command line */
} word_list;

/** Kinds of values. */
typedef enum option_kind {
  OPTION_FLAG,   /**< bool, set by an option without value */
  OPTION_NUMBER, /**< double, any finite number */
  OPTION_COUNT,  /**< long, a whole number from 1 */
  OPTION_WORD,   /**< const char *, any text */
  OPTION_WORDS,  /**< words, any text, may be repeated */
  OPTION_LIST    /**< word_list, any text, such as files that a shell lists */
} option_kind;

/** One option. */
typedef struct option {
  const char *name; /**< name without the dashes */
  option_kind kind;
  size_t place;      /**< offset of the value in the command's request, in bytes */
  const char *value; /**< spelling of the value in the help text, such as "H" */
  const char *help;
  bool is_csv; /**< it names a file of CSV that is written; names of HDF5 are refused */
} option;

/** The kind and the place of an option whose value is this member of a request of this type. */
#define OPTION_AT(type, member) \
  .kind = _Generic(((type *)NULL)->member,    \
                   bool: OPTION_FLAG,         \
                   double: OPTION_NUMBER,     \
                   long: OPTION_COUNT,        \
                   const char *: OPTION_WORD, \
                   words: OPTION_WORDS,       \
                   word_list: OPTION_LIST),   \
  .place = offsetof(type, member)

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
 *  @param[in,out] request the request that the places of the options refer to, with its defaults
 *  @param[out] operand    the operand
 *  @param[out] exit_code  set if the command is to end now, because --help was asked for or the
 *                         line makes no sense
 *  @return true to go on */
bool options_parse(const command_line *command, int argc, char **argv, void *request,
                   const char **operand, int *exit_code);

/** Refuse equal values of --name, because rows of a table could not be told apart. Returns DONE, or
 * complains and returns USAGE. */
int words_distinct(const char *command, const char *name, const words *given);

/** Read a whole text as a finite number. */
bool parse_number(const char *text, double *number);
#endif
