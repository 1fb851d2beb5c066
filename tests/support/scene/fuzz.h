/* Tries readers with hostile texts, made by mutation of good ones. They are the same in every run,
 * so that a failure comes again. */
#ifndef TESTS_SUPPORT_FUZZ_H
#define TESTS_SUPPORT_FUZZ_H
#include <stddef.h>

#include "support/suite.h"

typedef struct fuzz_target {
  /* the file fuzz-NAME.txt holds the text on trial, and stays if the trial fails */
  const char *name;
  const char *const *corpus; /* good texts, ended by NULL */
  const char *const *tokens; /* words of the language, ended by NULL */
  /* Try a text of which exactly `size` bytes can be read, and fail the test if something is wrong.
   * The result is a number of the outcome. A text with a new outcome joins the corpus. */
  unsigned (*try_text)(const char *text, size_t size);
  const size_t *size; /* of the good texts. NULL if each ends with a zero byte */
} fuzz_target;

/* Tries texts for DVI_FUZZ_SECONDS (default 2, or 30 under the address sanitizer), and returns
 * their number. With DVI_FUZZ_TEXT it tries the text in this file alone. */
long fuzz(const fuzz_target *target);

/* Asserts a condition in `try_text`, where ck_assert would write far too many lines. */
#define fuzz_requires(condition)                      \
  do {                                                \
    if (!(condition)) ck_abort_msg("%s", #condition); \
  } while (0)

/* Gives the time limit of a case of Check that fuzzes. */
int fuzz_timeout(void);

/* Gives a number for a message: its first line without digits and without text in quotes. */
unsigned fuzz_hash(const char *message);

#endif
