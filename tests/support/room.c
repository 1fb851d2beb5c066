/* The test program of a room: `test_<room> THING...` runs the suites of these names, and no other.
 * CMake writes suites.def, a line HAS_SUITE(thing) for each test_<thing>.c of the room. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

enum { USAGE = 2, SKIPPED = 77 };

#define HAS_SUITE(thing) void suite_of_##thing(TCase *tests);
#include "suites.def"
#undef HAS_SUITE

typedef struct test_suite {
  const char *name;
  void (*add_cases)(TCase *tests);
} test_suite;

static const test_suite suites[] = {
#define HAS_SUITE(thing) {#thing, suite_of_##thing},
#include "suites.def"
#undef HAS_SUITE
};
enum { SUITES = sizeof suites / sizeof *suites };

static const test_suite *find_suite(const char *name)
{
  for (int i = 0; i < SUITES; i++)
    if (strcmp(suites[i].name, name) == 0) return &suites[i];
  return NULL;
}

/* Runs a suite. One without cases has shown nothing and is skipped. */
static int run_suite(const test_suite *suite)
{
  TCase *cases = tcase_create(suite->name);
  suite->add_cases(cases);
  Suite *all = suite_create(suite->name);
  suite_add_tcase(all, cases);
  SRunner *runner = srunner_create(all);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner), run = srunner_ntests_run(runner);
  srunner_free(runner);
  if (failed > 0) return EXIT_FAILURE;
  return run > 0 ? EXIT_SUCCESS : SKIPPED;
}

static int refuse_name(const char *program, const char *name)
{
  (void)fprintf(stderr, "%s: there is no suite '%s'; there are", program, name);
  for (int i = 0; i < SUITES; i++) (void)fprintf(stderr, " %s", suites[i].name);
  (void)fprintf(stderr, "\n");
  return USAGE;
}

int main(int argc, char **argv)
{
  if (argc < 2) return refuse_name(argv[0], "");
  for (int i = 1; i < argc; i++)
    if (find_suite(argv[i]) == NULL) return refuse_name(argv[0], argv[i]);
  int result = EXIT_SUCCESS;
  for (int i = 1; i < argc; i++) {
    const int outcome = run_suite(find_suite(argv[i]));
    if (outcome != EXIT_SUCCESS && result != EXIT_FAILURE) result = outcome;
  }
  return result;
}
