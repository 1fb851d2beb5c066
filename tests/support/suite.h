/* What every test executable has: its main function, and a look at the last error. */
#ifndef TESTS_SUPPORT_SUITE_H
#define TESTS_SUPPORT_SUITE_H
#include <check.h>

/* Run one suite of one case; what main returns. Frees both. */
int run_tests(const char *name, TCase *tests);

/* dvi_last_error() must hold these words. */
void check_words(const char *words);

#endif
