/* Hostile texts for readers: made by mutation of good ones, the same in every run, so that a
 * failure comes again. */
#ifndef TESTS_SUPPORT_FUZZ_H
#define TESTS_SUPPORT_FUZZ_H
#include <stddef.h>

#include "support/suite.h"

typedef struct fuzz_target {
  /* the text on trial is kept in the file fuzz-NAME.txt, which stays where the trial fails */
  const char *name;
  const char *const *corpus; /* good texts, ended by NULL */
  const char *const *tokens; /* words of the language, ended by NULL */
  /* Try a text of which exactly `size` bytes can be read, and fail the test if something is wrong.
   * The result says what happened: a text with a new one joins the corpus. */
  unsigned (*one)(const char *text, size_t size);
} fuzz_target;

/* Try texts for as long as DVI_FUZZ_SECONDS says; else 30 s where the address sanitizer watches, 2
 * s where not. With DVI_FUZZ_TEXT try the text in this file alone. Returns how many were tried. */
long fuzz(const fuzz_target *target);

/* As ck_assert, which writes a line each time: far too many in `one`. */
#define fuzz_requires(condition)                      \
  do {                                                \
    if (!(condition)) ck_abort_msg("%s", #condition); \
  } while (0)

/* How long a case of Check may take that fuzzes. */
int fuzz_timeout(void);

/* A number for what a message says: its first line, but for digits and what stands in quotes. */
unsigned fuzz_hash(const char *message);

#endif
