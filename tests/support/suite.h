/* The main function of a test executable. */
#ifndef TESTS_SUPPORT_SUITE_H
#define TESTS_SUPPORT_SUITE_H
#include <check.h>

/* Run one suite of one case; what main returns. Frees both. */
int run_tests(const char *name, TCase *tests);

#endif
