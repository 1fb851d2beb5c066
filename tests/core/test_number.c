/* Numbers as text are read to the last bit, and written so that they are read back, in any
 * locale. */
#include <dvi/number.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "support/comma.h"
#include "support/files.h"
#include "support/suite.h"

static void check_reads(const char *text, double number, const char *rest)
{
  double read = 7;
  const char *end = dvi_number_read(text, &read);
  ck_assert_msg(end != text, "%s", text);
  ck_assert_str_eq(end, rest);
  ck_assert_mem_eq(&read, &number, sizeof read);
}

static void check_all_reads(void)
{
  check_reads("0.1", 0x1.999999999999ap-4, "");
  check_reads("-.5e+1,3", -5, ",3");
  check_reads("+2.:3", 2, ":3");
  check_reads("2/3", 2, "/3");
  check_reads("1,5", 1, ",5");
  check_reads("1.5.25", 1.5, ".25");
  check_reads("3e", 3, "e");
  check_reads("-0", -0.0, "");
  check_reads("9007199254740993", 0x1p53, ""); /* a tie rounds to even */
  check_reads("9007199254740993.00000000000000000000001", 0x1.0000000000001p53, "");
  check_reads("2.2250738585072011e-308", 0x0.fffffffffffffp-1022, "");
  check_reads("1e-400", 0, "");
  check_reads("-1e400", -HUGE_VAL, "");
}

static void check_all_refusals(void)
{
  static const char *const none[] = {"",   " 1",  "\t1",  "x",   "+",    "-",      ".",  "e5",
                                     ",5", "inf", "-inf", "nan", "0x10", "-0x1p3", "--1"};
  for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
    double number = 7;
    ck_assert_msg(dvi_number_read(none[k], &number) == none[k], "'%s' is read", none[k]);
    ck_assert(number == 7);
  }
}

static void check_writes(double number, const char *text)
{
  char written[DVI_NUMBER_SIZE];
  dvi_number_write(number, written);
  ck_assert_str_eq(written, text);
}

/* Gives doubles of all sizes, with bits by a linear congruence. */
static void check_round_trips(void)
{
  uint64_t bits = 1;
  for (int k = 0; k < 20000; k++) {
    char written[DVI_NUMBER_SIZE];
    double number, back = 0;
    bits = bits * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    memcpy(&number, &bits, sizeof number);
    if (!isfinite(number)) continue;
    dvi_number_write(number, written);
    ck_assert_str_eq(dvi_number_read(written, &back), "");
    ck_assert_mem_eq(&back, &number, sizeof back);
  }
}

static void check_all_writes(void)
{
  check_writes(50, "50");
  check_writes(0.1, "0.1");
  check_writes(-1e300, "-1e+300");
  check_writes(0x1.5555555555555p-2, "0.3333333333333333");
  check_writes(0.1 + 0.2, "0.30000000000000004");
  check_writes(-2.2250738585072014e-308, "-2.2250738585072014e-308"); /* of the longest texts */
  check_round_trips();
}

START_TEST(numbers_are_read_to_the_last_bit)
{
  check_all_reads();
}
END_TEST

START_TEST(what_is_no_decimal_number_is_not_read)
{
  check_all_refusals();
}
END_TEST

START_TEST(written_numbers_are_read_back)
{
  check_all_writes();
}
END_TEST

static int print(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static int print(char *text, size_t size, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  const int length = dvi_number_vprint(text, size, format, arguments);
  va_end(arguments);
  return length;
}

START_TEST(all_is_the_same_with_a_decimal_comma)
{
  char text[64];
  set_comma_locale();
  check_all_reads();
  check_all_refusals();
  check_all_writes();
  ck_assert_int_eq(print(text, sizeof text, "%.2f and %s", 0.25, "1,5"), 12);
  ck_assert_str_eq(text, "0.25 and 1,5");
  (void)snprintf(text, sizeof text, "%.2f", 0.25);
  ck_assert_str_eq(text, "0,25"); /* the locale is as it was */
  set_point_locale();
}
END_TEST

SUITE(number)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, numbers_are_read_to_the_last_bit);
  tcase_add_test(tests, what_is_no_decimal_number_is_not_read);
  tcase_add_test(tests, written_numbers_are_read_back);
  tcase_add_test(tests, all_is_the_same_with_a_decimal_comma);
}
