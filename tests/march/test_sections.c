/* labels: unit */
/* Sections of a saved state are read as they were written, and damaged or unknown ones are
 * refused. */
#include "march/sections.h"

#include <string.h>

#include "core/memory.h"
#include "support/suite.h"

static const double numbers[3] = {1, 2, 3};

static dvi__sections_writer write_sections(void)
{
  dvi__sections_writer w;
  dvi__sections_start(&w, 1);
  dvi__section_open(&w, "first", 1);
  dvi__section_put(&w, numbers, sizeof numbers);
  dvi__section_open(&w, "text", 2);
  dvi__section_put(&w, "odd", 3);
  dvi__section_put(&w, "", 1);
  dvi__section_open(&w, "empty", 1);
  ck_assert_int_eq(dvi__sections_finish(&w), DVI_OK);
  return w;
}

START_TEST(sections_are_found_by_name_version_and_size)
{
  dvi__sections_writer w = write_sections();
  dvi__sections s = {0};
  dvi__section found;
  ck_assert_int_eq(dvi__sections_check(&s, "state", w.bytes, w.size), DVI_OK);
  ck_assert_int_eq(dvi__section_find(&s, "first", 1, sizeof numbers, &found), DVI_OK);
  ck_assert_mem_eq(found.content, numbers, sizeof numbers);
  ck_assert_int_eq(dvi__section_find(&s, "text", 2, DVI__ANY_SIZE, &found), DVI_OK);
  ck_assert_str_eq((const char *)found.content, "odd");
  ck_assert_int_eq(dvi__section_find(&s, "empty", 1, 0, &found), DVI_OK);
  ck_assert_int_eq(dvi__section_find(&s, "text", 1, DVI__ANY_SIZE, &found), DVI_BAD_FILE);
  ck_assert_str_eq(dvi_last_error(),
                   "state: section 'text' is of version 2; this libdvi reads version 1");
  ck_assert_int_eq(dvi__section_find(&s, "first", 1, 8, &found), DVI_BAD_FILE);
  ck_assert_str_eq(dvi_last_error(), "state: section 'first' has 24 bytes instead of 8");
  ck_assert_int_eq(dvi__section_find(&s, "last", 1, 8, &found), DVI_BAD_FILE);
  ck_assert_str_eq(dvi_last_error(),
                   "state: it has no section 'last': another method has saved it");
  dvi__release(w.bytes);
}
END_TEST

START_TEST(every_cut_and_every_flipped_bit_is_refused)
{
  dvi__sections_writer w = write_sections();
  dvi__sections s = {0};
  for (size_t size = 0; size < w.size; size++)
    ck_assert_int_eq(dvi__sections_check(&s, "state", w.bytes, size), DVI_BAD_FILE);
  for (size_t at = 0; at < w.size; at++)
    for (int bit = 0; bit < 8; bit++) {
      w.bytes[at] ^= (unsigned char)(1 << bit);
      ck_assert_int_eq(dvi__sections_check(&s, "state", w.bytes, w.size), DVI_BAD_FILE);
      w.bytes[at] ^= (unsigned char)(1 << bit);
    }
  ck_assert_int_eq(dvi__sections_check(&s, "state", w.bytes, w.size), DVI_OK);
  dvi__release(w.bytes);
}
END_TEST

START_TEST(a_writer_without_memory_says_so)
{
  for (long successes = 0; successes < 4; successes++) {
    dvi__sections_writer w;
    dvi__fail_allocations_after(successes);
    dvi__sections_start(&w, 1);
    dvi__section_open(&w, "first", 1);
    dvi__section_put(&w, numbers, sizeof numbers);
    const dvi_status status = dvi__sections_finish(&w);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, successes < 4 && w.bytes == NULL ? DVI_NO_MEMORY : DVI_OK);
    dvi__release(w.bytes);
  }
}
END_TEST

SUITE(sections)
{
  tcase_add_test(tests, sections_are_found_by_name_version_and_size);
  tcase_add_test(tests, every_cut_and_every_flipped_bit_is_refused);
  tcase_add_test(tests, a_writer_without_memory_says_so);
}
