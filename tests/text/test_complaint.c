#include <stdio.h>
#include <string.h>

#include "support/scene/scene_text.h"
#include "support/suite.h"

/* The message about a part of a text. */
static const char *complaint_at(const char *text, size_t first, size_t size, const char *sentence)
{
  static scene_text scene;
  open_text(&scene, text, strlen(text));
  ck_assert(
      !dvi__complain(&scene.complaint, DVI_BAD_FILE, (dvi__span){first, size}, "%s", sentence));
  return scene.message;
}

START_TEST(a_complaint_shows_the_line_and_a_caret)
{
  ck_assert_str_eq(complaint_at("a: 1\nb: thet\nc: 2\n", 8, 4, "there is no 'thet'"),
                   "s.yaml:2:4: there is no 'thet'\n  b: thet\n     ^~~~");
}
END_TEST

START_TEST(the_first_complaint_stays)
{
  scene_text scene;
  open_text(&scene, "x", 1);
  ck_assert(!dvi__complain(&scene.complaint, DVI_BAD_SIZE, DVI__NOWHERE, "%d apples", 3));
  ck_assert(!dvi__complain(&scene.complaint, DVI_BAD_FILE, DVI__NOWHERE, "pears"));
  check_complaint(&scene, DVI_BAD_SIZE, "s.yaml: 3 apples");
}
END_TEST

START_TEST(a_span_over_several_lines_is_marked_on_its_first)
{
  ck_assert_str_eq(complaint_at("ab cd\nef\n", 3, 5, "no"), "s.yaml:1:4: no\n  ab cd\n     ^~");
}
END_TEST

START_TEST(lines_end_with_lf_cr_or_both)
{
  ck_assert_str_eq(complaint_at("a\r\nb\rc\nd", 7, 1, "no"), "s.yaml:4:1: no\n  d\n  ^");
  ck_assert_str_eq(complaint_at("a\r\nb\rc\nd", 5, 1, "no"), "s.yaml:3:1: no\n  c\n  ^");
}
END_TEST

START_TEST(the_end_of_the_text_is_a_place)
{
  ck_assert_str_eq(complaint_at("ab", 2, 0, "no"), "s.yaml:1:3: no\n  ab\n    ^");
  ck_assert_str_eq(complaint_at("ab\n", 3, 0, "no"), "s.yaml:2:1: no");
  ck_assert_str_eq(complaint_at("ab", 3, 0, "no"), "s.yaml: no");
}
END_TEST

START_TEST(columns_count_characters_and_tabs_stay)
{
  ck_assert_str_eq(complaint_at("\xCE\xB8\t\xC3\xA9: x", 7, 1, "no"),
                   "s.yaml:1:6: no\n  \xCE\xB8\t\xC3\xA9: x\n   \t   ^");
}
END_TEST

START_TEST(nothing_is_shown_that_a_terminal_would_obey)
{
  ck_assert_str_eq(complaint_at("\x1B[2J \xC2\x9B \xFF x", 9, 1, "no\x1B\n"),
                   "s.yaml:1:9: no??\n  ?[2J ? ? x\n          ^");
}
END_TEST

START_TEST(long_lines_are_cut_around_the_caret)
{
  char text[1001];
  memset(text, 'x', 1000);
  text[1000] = '\0';
  char cut[121];
  memset(cut, 'x', 120);
  memcpy(cut, "  ..", 4);
  memcpy(cut + 118, "..", 3);
  char expected[400];
  (void)snprintf(expected, sizeof expected, "s.yaml:1:501: no\n%.118s..\n%74s^~~~", cut, "");
  ck_assert_str_eq(complaint_at(text, 500, 4, "no"), expected);
  (void)snprintf(expected, sizeof expected, "s.yaml:1:1: no\n  %.114s..\n  ^", text);
  ck_assert_str_eq(complaint_at(text, 0, 1, "no"), expected);
  (void)snprintf(expected, sizeof expected, "s.yaml:1:1000: no\n  ..%.71s\n%74s^", text, "");
  ck_assert_str_eq(complaint_at(text, 999, 1, "no"), expected);
}
END_TEST

START_TEST(a_message_that_does_not_fit_ends_with_a_whole_character)
{
  scene_text scene;
  open_text(&scene, "\xCE\xB8", 2);
  scene.complaint.size = 11;
  (void)dvi__complain(&scene.complaint, DVI_BAD_FILE, DVI__NOWHERE,
                      "a\xCE\xB8"
                      "b");
  ck_assert_str_eq(scene.message, "s.yaml: a");
  open_text(&scene, "", 0);
  scene.complaint.message = NULL;
  ck_assert(!dvi__complain(&scene.complaint, DVI_BAD_FILE, (dvi__span){0, 0}, "no"));
  ck_assert_int_eq(scene.complaint.status, DVI_BAD_FILE);
}
END_TEST

static const char *hint_for(const char *word)
{
  static const char *const known[] = {"theta", "x", "theta_dot", "momentum", "l"};
  static char hint[80];
  return dvi__nearest(word, 5, known, hint, sizeof hint);
}

START_TEST(the_nearest_name_is_offered)
{
  ck_assert_str_eq(hint_for("thet"), "; did you mean theta?");  /* a beginning */
  ck_assert_str_eq(hint_for("Theta"), "; did you mean theta?"); /* the other case */
  ck_assert_str_eq(hint_for("tehat"), "; did you mean theta?"); /* two exchanges */
  ck_assert_str_eq(hint_for("momemtmu"),
                   "; did you mean momentum?"); /* an exchange and a replacement */
  ck_assert_str_eq(hint_for("X"), "; did you mean x?");
}
END_TEST

START_TEST(what_is_far_from_all_names_gets_no_hint)
{
  ck_assert_str_eq(hint_for("y"),
                   ""); /* one letter is exchanged for another, and nothing is left of it */
  ck_assert_str_eq(hint_for("energy"), "");
  ck_assert_str_eq(hint_for(""), "");
  ck_assert_str_eq(hint_for("a_name_of_more_than_sixty_three_letters_is_not_compared_with_others"),
                   "");
  char hint[8];
  ck_assert_str_eq(dvi__nearest("x", 0, NULL, hint, sizeof hint), "");
}
END_TEST

SUITE(complaint)
{
  tcase_add_test(tests, a_complaint_shows_the_line_and_a_caret);
  tcase_add_test(tests, the_first_complaint_stays);
  tcase_add_test(tests, a_span_over_several_lines_is_marked_on_its_first);
  tcase_add_test(tests, lines_end_with_lf_cr_or_both);
  tcase_add_test(tests, the_end_of_the_text_is_a_place);
  tcase_add_test(tests, columns_count_characters_and_tabs_stay);
  tcase_add_test(tests, nothing_is_shown_that_a_terminal_would_obey);
  tcase_add_test(tests, long_lines_are_cut_around_the_caret);
  tcase_add_test(tests, a_message_that_does_not_fit_ends_with_a_whole_character);
  tcase_add_test(tests, the_nearest_name_is_offered);
  tcase_add_test(tests, what_is_far_from_all_names_gets_no_hint);
}
