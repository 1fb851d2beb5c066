/* What every test executable has: its main function, and a look at the last error. */
#ifndef TESTS_SUPPORT_SUITE_H
#define TESTS_SUPPORT_SUITE_H
#include <check.h>

/* An assertion that holds leaves no trace. Check would write down where it stands, for the case that the next one ends the process: by far the
 * most of what loops over many assertions cost, and sanitizers and valgrind tell the place better. */
#define _mark_point(file, line) ((void)0)

/* Run one suite of one case; what main returns. Frees both. */
int run_tests(const char *name, TCase *tests);

/* dvi_last_error() must hold these words. */
void check_words(const char *words);

#endif
