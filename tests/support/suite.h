/* What every test file has: its suite, and a look at the last error. */
#ifndef TESTS_SUPPORT_SUITE_H
#define TESTS_SUPPORT_SUITE_H
#include <check.h>

/* An assertion that holds leaves no trace. Check would write down where it stands, for the case
 * that the next one ends the process: by far the most of what loops over many assertions cost, and
 * sanitizers and valgrind tell the place better. */
#define _mark_point(file, line) ((void)0)

/* The suite of tests/<room>/test_<thing>.c adds its cases to `tests`. The program of the room runs
 * it by its name. A suite without cases counts as skipped. */
#define SUITE(thing)                   \
  void suite_of_##thing(TCase *tests); \
  void suite_of_##thing(TCase *tests)

/* How often to do what is done `often` times for the sake of its numbers: a tenth of it where
 * DVI_TEST_FEWER is set. That is where sanitizers or valgrind watch memory, and each time takes up
 * to fifty times as long, and in suites with the label `long` whenever they are not run in full. */
int repeats(int often);

/* 1 where DVI_TEST_FEWER is set. */
int is_short_run(void);

/* A loop over very many cases, of which a short run takes every third: how many it takes of
 * `cases`, and the number of the i-th of them. */
int sampled_count(int cases);
int sampled_case(int i);

/* dvi_last_error() must hold these words. */
void check_words(const char *words);

#endif
