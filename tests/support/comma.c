#define _XOPEN_SOURCE 700 /* setenv */
#include "support/comma.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/files.h"
#include "support/suite.h"

/* Writes the characters and numbers of the locale, and nothing else. Every Debian has localedef,
 * but not the files that the package locales installs for it. */
static void write_sources(void)
{
  FILE *characters = fopen(path_in_folder("characters"), "w"),
       *numbers = fopen(path_in_folder("numbers"), "w");
  ck_assert_ptr_nonnull(characters);
  ck_assert_ptr_nonnull(numbers);
  (void)fputs("<code_set_name> ANSI_X3.4-1968\n<comment_char> %\n<escape_char> /\nCHARMAP\n",
              characters);
  for (int c = 0; c < 128; c++) (void)fprintf(characters, "<U%04X> /x%02x\n", c, c);
  (void)fputs("END CHARMAP\n", characters);
  (void)fputs("LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping -1\nEND LC_NUMERIC\n",
              numbers);
  ck_assert_int_eq(fclose(characters), 0);
  ck_assert_int_eq(fclose(numbers), 0);
}

void set_comma_locale(void)
{
  char command[1024];
  write_sources();
  (void)snprintf(command, sizeof command, "localedef -c -f %s -i %s %s >%s 2>&1",
                 path_in_folder("characters"), path_in_folder("numbers"), path_in_folder("comma"),
                 path_in_folder("said"));
  (void)!system(command); /* localedef complains of missing categories, and makes the locale */
  ck_assert_int_eq(setenv("LOCPATH", path_in_folder(""), 1), 0);
  ck_assert_int_eq(setenv("LC_ALL", "comma", 1), 0);
  ck_assert_msg(setlocale(LC_ALL, "") != NULL, "localedef made no locale with a decimal comma");
  ck_assert_str_eq(localeconv()->decimal_point, ",");
}

void set_point_locale(void)
{
  char command[512];
  (void)snprintf(command, sizeof command, "rm -r %s", path_in_folder("comma"));
  ck_assert_int_eq(system(command), 0); /* NOLINT(cert-env33-c): a folder of the test's own */
  ck_assert_ptr_nonnull(setlocale(LC_ALL, "C"));
  ck_assert_int_eq(unsetenv("LC_ALL"), 0);
}
