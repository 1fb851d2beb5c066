/* The header of every test file: its suite, and checks of the last error. */
#ifndef TESTS_SUPPORT_SUITE_H
#define TESTS_SUPPORT_SUITE_H
#include <check.h>

/* An assertion that holds leaves no trace. Check would write down its place, for the case that the
 * next one ends the process. Loops over many assertions would spend most of their time on that, and
 * sanitizers and valgrind name the place better. */
#define _mark_point(file, line) ((void)0)

/* The suite of tests/<room>/test_<thing>.c adds its cases to `tests`. The program of the room runs
 * it by its name. A suite without cases counts as skipped. */
#define SUITE(thing)                   \
  void suite_of_##thing(TCase *tests); \
  void suite_of_##thing(TCase *tests)

/* Returns a tenth of `often` where DVI_TEST_FEWER is set, else `often`. Tests repeat steps so often
 * only for the sake of their numbers. The variable is set where sanitizers or valgrind watch
 * memory, which makes a step up to fifty times as slow, and for suites with the label `long`
 * whenever they are not run in full. */
int repeats(int often);

/* Returns 1 where DVI_TEST_FEWER is set. */
int is_short_run(void);

/* Select every third case of a loop in a short run, else all. They return the number of selected
 * cases, and the number of the i-th of them. */
int sampled_count(int cases);
int sampled_case(int i);

/* Requires these words in dvi_last_error(). */
void check_words(const char *words);

#endif
