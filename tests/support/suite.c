#include "support/suite.h"

#include <dvi/status.h>
#include <stdlib.h>
#include <string.h>

int repeats(int often)
{
  return getenv("DVI_TEST_FEWER") != NULL ? often / 10 : often;
}

void check_words(const char *words)
{
  ck_assert_msg(strstr(dvi_last_error(), words) != NULL, "\"%s\" is not in \"%s\"", words, dvi_last_error());
}
