#include "support/suite.h"

#include <dvi/status.h>
#include <stdlib.h>
#include <string.h>

int run_tests(const char *name, TCase *tests)
{
  Suite *suite = suite_create(name);
  suite_add_tcase(suite, tests);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}

int repeats(int often)
{
  return getenv("DVI_TEST_FEWER") != NULL ? often / 10 : often;
}

void check_words(const char *words)
{
  ck_assert_msg(strstr(dvi_last_error(), words) != NULL, "\"%s\" is not in \"%s\"", words, dvi_last_error());
}
