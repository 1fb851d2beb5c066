#include "support/suite.h"

#include <dvi/status.h>
#include <stdlib.h>
#include <string.h>

int is_short_run(void)
{
  return getenv("DVI_TEST_FEWER") != NULL;
}

int repeats(int often)
{
  return is_short_run() ? often / 10 : often;
}

enum { STRIDE = 3 };

int sampled_count(int cases)
{
  return is_short_run() ? (cases + STRIDE - 1) / STRIDE : cases;
}

int sampled_case(int i)
{
  return is_short_run() ? STRIDE * i : i;
}

void check_words(const char *words)
{
  ck_assert_msg(strstr(dvi_last_error(), words) != NULL, "\"%s\" is not in \"%s\"", words,
                dvi_last_error());
}
