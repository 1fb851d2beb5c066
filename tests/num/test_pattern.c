#include <limits.h>
#include <string.h>

#include "num/pattern.h"
#include "support/suite.h"

/* . x .
 * x x .
 * x . .   */
static const int ragged_start[] = {0, 2, 4, 4}, ragged_row[] = {1, 2, 0, 1};
static const dvi_pattern ragged = {ragged_start, ragged_row};

static void check_pattern(const dvi__pattern *p, int n, const int *start, const int *row)
{
  ck_assert_int_eq(p->rows, n);
  ck_assert_int_eq(p->columns, n);
  ck_assert_mem_eq(p->start, start, ((size_t)n + 1) * sizeof(int));
  ck_assert_int_eq(dvi__pattern_entries(p), start[n]);
  if (start[n] > 0) ck_assert_mem_eq(p->row, row, (size_t)start[n] * sizeof(int));
}

START_TEST(a_declared_pattern_is_copied)
{
  dvi__pattern copy;
  ck_assert_int_eq(dvi__pattern_copy(&ragged, 3, "x", &copy), DVI_OK);
  check_pattern(&copy, 3, ragged_start, ragged_row);
  ck_assert_ptr_ne(copy.row, ragged_row);
  dvi__pattern_clear(&copy);
  ck_assert_ptr_null(copy.row);
}
END_TEST

START_TEST(an_undeclared_pattern_is_full_column_by_column)
{
  const int start[] = {0, 2, 4}, row[] = {0, 1, 0, 1};
  dvi__pattern copy;
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){0}, 2, "x", &copy), DVI_OK);
  check_pattern(&copy, 2, start, row);
  dvi__pattern_clear(&copy);
}
END_TEST

START_TEST(a_pattern_without_entries_is_possible)
{
  const int start[] = {0, 0, 0};
  dvi__pattern copy, empty;
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){start, NULL}, 2, "x", &copy), DVI_OK);
  check_pattern(&copy, 2, start, NULL);
  ck_assert_int_eq(dvi__pattern_empty(2, &empty), DVI_OK);
  check_pattern(&empty, 2, start, NULL);
  dvi__pattern_clear(&copy);
  dvi__pattern_clear(&empty);
}
END_TEST

static void refused(const int *start, const int *row, int n, dvi_status status, const char *words)
{
  dvi__pattern copy;
  memset(&copy, 0x55, sizeof copy);
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){start, row}, n, "gravity", &copy), status);
  check_words(words);
  ck_assert_ptr_null(copy.start);
  ck_assert_ptr_null(copy.row);
}

START_TEST(what_is_no_pattern_is_refused)
{
  refused(NULL, (int[]){0}, 1, DVI_BAD_ARGUMENT,
          "gravity: the pattern has rows but no column starts");
  refused((int[]){0, 1}, NULL, 1, DVI_BAD_ARGUMENT,
          "gravity: the pattern has column starts but no rows");
  refused((int[]){1, 2}, (int[]){0, 0}, 1, DVI_BAD_ARGUMENT, "first column starts at 1, not 0");
  refused((int[]){0, 2, 1}, (int[]){0, 1}, 2, DVI_BAD_ARGUMENT, "column 1 ends before it starts");
  refused((int[]){0, 1, 2}, (int[]){0, 2}, 2, DVI_BAD_ARGUMENT,
          "row 2 in column 1 of the pattern is outside 0..1");
  refused((int[]){0, 1, 2}, (int[]){-1, 0}, 2, DVI_BAD_ARGUMENT, "row -1 in column 0");
  refused((int[]){0, 0, 2}, (int[]){1, 0}, 2, DVI_BAD_ARGUMENT,
          "rows in column 1 of the pattern are not ascending");
  refused((int[]){0, 0, 2}, (int[]){1, 1}, 2, DVI_BAD_ARGUMENT,
          "rows in column 1 of the pattern are not ascending");
}
END_TEST

/* Under the address sanitizer this reads nothing behind the two rows, though column 0 claims a
 * thousand. */
START_TEST(starts_are_checked_before_rows_are_read)
{
  refused((int[]){0, 1000, 2}, (int[]){0, 1}, 2, DVI_BAD_ARGUMENT,
          "column 1 ends before it starts");
}
END_TEST

START_TEST(a_full_pattern_that_no_int_can_count_is_refused)
{
  refused(NULL, NULL, 46341, DVI_BAD_SIZE, "declare a sparse pattern");
  refused(NULL, NULL, INT_MAX, DVI_BAD_SIZE, "declare a sparse pattern");
}
END_TEST

START_TEST(the_diagonal_has_one_entry_a_column)
{
  const int start[] = {0, 1, 2, 3}, row[] = {0, 1, 2};
  dvi__pattern p;
  ck_assert_int_eq(dvi__pattern_diagonal(3, &p), DVI_OK);
  check_pattern(&p, 3, start, row);
  dvi__pattern_clear(&p);
}
END_TEST

START_TEST(a_union_holds_both_and_embeds_each)
{
  const int start[] = {0, 3, 5, 6}, row[] = {0, 1, 2, 0, 1, 2};
  dvi__pattern a, b, sum;
  int where[4];
  dvi__pattern_copy(&ragged, 3, "x", &a);
  dvi__pattern_diagonal(3, &b);
  ck_assert_int_eq(dvi__pattern_union(&a, &b, &sum), DVI_OK);
  check_pattern(&sum, 3, start, row);
  dvi__pattern_embed(&a, &sum, where);
  ck_assert_mem_eq(where, ((int[]){1, 2, 3, 4}), sizeof where);
  dvi__pattern_embed(&b, &sum, where);
  ck_assert_mem_eq(where, ((int[]){0, 4, 5}), 3 * sizeof(int));
  dvi__pattern_clear(&a);
  dvi__pattern_clear(&b);
  dvi__pattern_clear(&sum);
}
END_TEST

START_TEST(a_transpose_swaps_rows_and_columns)
{
  const int start[] = {0, 1, 3, 4}, row[] = {1, 0, 1, 0};
  dvi__pattern p, transpose, back;
  dvi__pattern_copy(&ragged, 3, "x", &p);
  ck_assert_int_eq(dvi__pattern_transpose(&p, &transpose), DVI_OK);
  check_pattern(&transpose, 3, start, row);
  ck_assert_int_eq(dvi__pattern_transpose(&transpose, &back), DVI_OK);
  check_pattern(&back, 3, ragged_start, ragged_row);
  dvi__pattern_clear(&p);
  dvi__pattern_clear(&transpose);
  dvi__pattern_clear(&back);
}
END_TEST

START_TEST(entries_are_found_and_missing_ones_are_not)
{
  dvi__pattern p;
  dvi__pattern_copy(&ragged, 3, "x", &p);
  ck_assert_int_eq(dvi__pattern_find(&p, 1, 0), 0);
  ck_assert_int_eq(dvi__pattern_find(&p, 2, 0), 1);
  ck_assert_int_eq(dvi__pattern_find(&p, 0, 1), 2);
  ck_assert_int_eq(dvi__pattern_find(&p, 0, 0), -1);
  ck_assert_int_eq(dvi__pattern_find(&p, 2, 1), -1);
  ck_assert_int_eq(dvi__pattern_find(&p, 1, 2), -1);
  dvi__pattern_clear(&p);
}
END_TEST

static void check_groups(const dvi__pattern *p, const int *group, int groups)
{
  for (int j = 0; j < p->columns; j++) {
    ck_assert(group[j] >= 0 && group[j] < groups);
    for (int k = 0; k < j; k++)
      for (int i = 0; group[k] == group[j] && i < p->rows; i++)
        ck_assert(dvi__pattern_find(p, i, j) < 0 || dvi__pattern_find(p, i, k) < 0);
  }
}

START_TEST(a_band_of_half_width_w_needs_2w_plus_1_groups)
{
  enum { N = 40 };
  for (int w = 0; w <= 3; w++) {
    int start[N + 1] = {0}, row[N * 7], group[N], groups;
    for (int j = 0; j < N; j++) {
      start[j + 1] = start[j];
      for (int i = j - w; i <= j + w; i++)
        if (i >= 0 && i < N) row[start[j + 1]++] = i;
    }
    dvi__pattern p;
    ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){start, row}, N, "band", &p), DVI_OK);
    ck_assert_int_eq(dvi__pattern_groups(&p, group, &groups), DVI_OK);
    ck_assert_int_eq(groups, 2 * w + 1);
    check_groups(&p, group, groups);
    dvi__pattern_clear(&p);
  }
}
END_TEST

START_TEST(full_columns_cannot_be_grouped_and_empty_ones_all_can)
{
  int group[5], groups;
  dvi__pattern p;
  dvi__pattern_copy(&(dvi_pattern){0}, 5, "x", &p);
  ck_assert_int_eq(dvi__pattern_groups(&p, group, &groups), DVI_OK);
  ck_assert_int_eq(groups, 5);
  check_groups(&p, group, groups);
  dvi__pattern_clear(&p);
  dvi__pattern_empty(5, &p);
  ck_assert_int_eq(dvi__pattern_groups(&p, group, &groups), DVI_OK);
  ck_assert_int_eq(groups, 1);
  dvi__pattern_clear(&p);
}
END_TEST

SUITE(pattern)
{
  tcase_add_test(tests, a_declared_pattern_is_copied);
  tcase_add_test(tests, an_undeclared_pattern_is_full_column_by_column);
  tcase_add_test(tests, a_pattern_without_entries_is_possible);
  tcase_add_test(tests, what_is_no_pattern_is_refused);
  tcase_add_test(tests, starts_are_checked_before_rows_are_read);
  tcase_add_test(tests, a_full_pattern_that_no_int_can_count_is_refused);
  tcase_add_test(tests, the_diagonal_has_one_entry_a_column);
  tcase_add_test(tests, a_union_holds_both_and_embeds_each);
  tcase_add_test(tests, a_transpose_swaps_rows_and_columns);
  tcase_add_test(tests, entries_are_found_and_missing_ones_are_not);
  tcase_add_test(tests, a_band_of_half_width_w_needs_2w_plus_1_groups);
  tcase_add_test(tests, full_columns_cannot_be_grouped_and_empty_ones_all_can);
}
