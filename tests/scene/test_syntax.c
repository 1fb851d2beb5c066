#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/text/syntax.h"
#include "support/scene/scene_text.h"
#include "support/suite.h"

static scene_text scene;

static const dvi__expression *expression_of_bytes(const char *text, size_t size)
{
  close_text(&scene);
  open_text(&scene, text, size);
  const dvi__expression *expression = NULL;
  const bool fine = dvi__expression_parse(&scene.source, (dvi__span){0, size}, &scene.arena,
                                          &scene.complaint, &expression);
  ck_assert(fine == (expression != NULL));
  ck_assert(fine == (scene.complaint.status == DVI_OK));
  return expression;
}

static const dvi__expression *expression_of(const char *text)
{
  const dvi__expression *expression = expression_of_bytes(text, strlen(text));
  ck_assert_msg(expression != NULL, "%s", scene.message);
  return expression;
}

/* An expression in Lisp's manner, which says what is part of what. */
static void put_expression(const dvi__expression *e, FILE *to)
{
  static const char *const head[] = {"",   "",        "index", "member", "'",    "-",    "+",
                                     "-",  "*",       "/",     "^",      "call", "list", "sum",
                                     "if", "compare", "not",   "and",    "or"};
  if (e->form == DVI__FORM_NUMBER)
    fprintf(to, "%.17g", e->number);
  else if (e->form == DVI__FORM_NAME)
    fprintf(to, "%s", e->name);
  if (e->form <= DVI__FORM_NAME) return;
  fprintf(to, "(%s", head[e->form]);
  if (e->name != NULL) fprintf(to, " %s", e->name);
  if (e->name2 != NULL) fprintf(to, "<%s", e->name2);
  for (int k = 0; k < e->count; k++) {
    fputc(' ', to);
    put_expression(e->part[k], to);
  }
  fputc(')', to);
}

static void check_means(const char *text, const char *expected)
{
  char written[512] = "";
  FILE *to = tmpfile();
  put_expression(expression_of(text), to);
  rewind(to);
  ck_assert_ptr_nonnull(fgets(written, sizeof written, to));
  fclose(to);
  ck_assert_str_eq(written, expected);
}

static void check_refused(const char *text, const char *message)
{
  ck_assert_ptr_null(expression_of_bytes(text, strlen(text)));
  check_complaint(&scene, DVI_BAD_FILE, message);
}

START_TEST(operators_bind_as_on_paper)
{
  check_means("a + b*c", "(+ a (* b c))");
  check_means("a - b - c", "(- (- a b) c)");
  check_means("a/b/c*d", "(* (/ (/ a b) c) d)");
  check_means("a*(b + c)", "(* a (+ b c))");
  check_means("a*-b", "(* a (- b))");
  check_means("+a - -b", "(- a (- b))");
}
END_TEST

START_TEST(powers_bind_to_the_right_and_before_the_sign)
{
  check_means("-x^2", "(- (^ x 2))");
  check_means("2^3^2", "(^ 2 (^ 3 2))");
  check_means("2^-x^2", "(^ 2 (- (^ x 2)))");
  check_means("a*x^2", "(* a (^ x 2))");
  check_means("x'^2", "(^ (' x) 2)");
  check_means("(-x)^2", "(^ (- x) 2)");
}
END_TEST

START_TEST(rates_indices_and_members_follow_what_they_belong_to)
{
  check_means("x'", "(' x)");
  check_means("bob'[2]", "(index (' bob) 2)");
  check_means("q[i+1][2]", "(index (index q (+ i 1)) 2)");
  check_means("A[i, j]", "(index A i j)");
  check_means("B.R[1,2]", "(index (member R B) 1 2)");
  check_means("B.x'", "(' (member x B))");
  check_means("(a + b)'", "(' (+ a b))");
}
END_TEST

START_TEST(calls_lists_and_sums_have_parts)
{
  check_means("atan2(y, x)", "(call atan2 y x)");
  check_means("[x + 1, [2, 3]]", "(list (+ x 1) (list 2 3))");
  check_means("sum(i, x[i])", "(sum i (index x i))");
  check_means("sum(i = 1..N-1, 2)", "(sum i 2 1 (- N 1))");
  check_means("sum(i<j, m[i]*m[j])", "(sum i<j (* (index m i) (index m j)))");
  check_means("sum(i<j = a..b, 1)", "(sum i<j 1 a b)");
  check_means("sum", "sum");
}
END_TEST

START_TEST(blanks_breaks_and_comments_are_nothing)
{
  check_means(" a\n\t+ # first\r\n b # last", "(+ a b)");
}
END_TEST

START_TEST(numbers_have_digits_a_fraction_and_an_exponent)
{
  check_means("12", "12");
  check_means("0.25", "0.25");
  check_means(".5 + 2.", "(+ 0.5 2)");
  check_means("1e3 + 1E-1 + 1.5e+2", "(+ (+ 1000 0.10000000000000001) 150)");
  check_means("sum(i=1..3, i)", "(sum i i 1 3)");
  check_means("sum(i=1...5, i)", "(sum i i 1 0.5)");
}
END_TEST

START_TEST(numbers_are_right_to_the_last_bit)
{
  ck_assert(expression_of("0.1")->number == 0x1.999999999999ap-4);
  ck_assert(expression_of("9007199254740993")->number == 0x1p53); /* a tie rounds to even */
  ck_assert(expression_of("9007199254740993.00000000000000000000001")->number ==
            0x1.0000000000001p53);
  ck_assert(expression_of("2.2250738585072011e-308")->number == 0x0.fffffffffffffp-1022);
  ck_assert(expression_of("1.7976931348623157e308")->number == 0x1.fffffffffffffp1023);
  ck_assert(expression_of("1e-400")->number == 0.0);
}
END_TEST

START_TEST(spans_are_where_the_parts_stand)
{
  const dvi__expression *e = expression_of("1 + (a + b)'*sin( c ) # end");
  check_span(&scene, e->span, "1 + (a + b)'*sin( c )");
  const dvi__expression *product = e->part[1];
  check_span(&scene, product->span, "(a + b)'*sin( c )");
  check_span(&scene, product->part[0]->span, "(a + b)'");
  check_span(&scene, product->part[0]->part[0]->span, "(a + b)");
  check_span(&scene, product->part[1]->span, "sin( c )");
}
END_TEST

START_TEST(a_part_of_the_source_is_all_that_is_read)
{
  open_text(&scene, "x: a + bc", 9);
  const dvi__expression *expression = NULL;
  ck_assert(dvi__expression_parse(&scene.source, (dvi__span){3, 5}, &scene.arena, &scene.complaint,
                                  &expression));
  check_span(&scene, expression->part[1]->span, "b");
  ck_assert(!dvi__expression_parse(&scene.source, (dvi__span){3, 3}, &scene.arena, &scene.complaint,
                                   &expression));
  check_complaint(&scene, DVI_BAD_FILE,
                  "s.yaml:1:7: found the end where a number, a name or a bracket is expected\n  x: "
                  "a + bc\n        ^");
}
END_TEST

START_TEST(usual_slips_get_a_remedy)
{
  check_refused("2x",
                "s.yaml:1:2: an operator is missing here; write 2*x for a product\n  2x\n   ^");
  check_refused("2e",
                "s.yaml:1:2: an operator is missing here; write 2*e for a product\n  2e\n   ^");
  check_refused(
      "2(x)", "s.yaml:1:2: an operator is missing here; write 2*(..) for a product\n  2(x)\n   ^");
  check_refused("sin x", "s.yaml:1:5: an operator is missing here; write sin*x for a product, "
                         "sin(x) for a function\n  sin x\n      ^");
  check_refused("x**2", "s.yaml:1:2: powers are written x^2, not x**2\n  x**2\n   ^~");
  check_refused("x''", "s.yaml:1:3: there are no second rates x'': expressions have positions and "
                       "velocities\n  x''\n    ^");
  check_refused("|x|", "s.yaml:1:1: '|' has no meaning in expressions; write abs(x) of a number, "
                       "norm(a) of a vector\n  |x|\n  ^");
  check_refused("sum(i=1:N, x)", "s.yaml:1:8: ':' has no meaning in expressions; a range is a..b\n "
                                 " sum(i=1:N, x)\n         ^");
  check_refused(
      "\xCE\xB8",
      "s.yaml:1:1: '\xCE\xB8' has no meaning in expressions; write theta\n  \xCE\xB8\n  ^");
  check_refused("a \xE2\x88\x92 b", "s.yaml:1:3: '\xE2\x88\x92' has no meaning in expressions; "
                                    "write -\n  a \xE2\x88\x92 b\n    ^");
  check_refused("\xC3\xA9", "s.yaml:1:1: '\xC3\xA9' has no meaning in expressions; names are made "
                            "of the letters a-z and A-Z, digits and _\n"
                            "  \xC3\xA9\n  ^");
  check_refused("1e400",
                "s.yaml:1:1: this number is too large; numbers end at 1.8e308\n  1e400\n  ^~~~~");
  check_refused("sum(i<i, x)",
                "s.yaml:1:7: the two indices of a pair need two names\n  sum(i<i, x)\n        ^");
}
END_TEST

START_TEST(brackets_are_told_where_they_open)
{
  check_refused("a*(b + c", "s.yaml:1:3: this '(' is never closed\n  a*(b + c\n    ^");
  check_refused("sin(f[1)",
                "s.yaml:1:8: found ')' where ',' or ']' is expected\n  sin(f[1)\n         ^");
  check_refused("(a))", "s.yaml:1:4: this ')' closes nothing\n  (a))\n     ^");
  check_refused("[1, 2", "s.yaml:1:1: this '[' is never closed\n  [1, 2\n  ^");
  check_refused("sum(i, x", "s.yaml:1:4: this '(' is never closed\n  sum(i, x\n     ^");
}
END_TEST

START_TEST(conditions_bind_not_before_and_before_or)
{
  check_means("if(x < 0, a, b)", "(if (compare < x 0) a b)");
  check_means("if(x<=y+1 or not p==q and r!=2, a, b)",
              "(if (or (compare <= x (+ y 1)) (and (not (compare == p q)) (compare != r 2))) a b)");
  check_means("if(0 < x <= 1 > y, a, b)",
              "(if (and (compare < 0 x) (compare <= x 1) (compare > 1 y)) a b)");
  check_means("if((x < 0 or y >= 0) and (z + 1)*2 > 3, a, b)",
              "(if (and (or (compare < x 0) (compare >= y 0)) (compare > (* (+ z 1) 2) 3)) a b)");
  check_means("if(not not x < 1, max(a, b), order)",
              "(if (not (not (compare < x 1))) (call max a b) order)");
  check_means("(not x > 1)", "(not (compare > x 1))");
  check_means("notx + android", "(+ notx android)");
}
END_TEST

START_TEST(conditions_end_where_they_must)
{
  check_refused("if(x < 0, a)",
                "s.yaml:1:12: found ')' where ',' is expected\n  if(x < 0, a)\n             ^");
  check_refused("if(x = 0, a, b)",
                "s.yaml:1:6: equality is written ==\n  if(x = 0, a, b)\n       ^");
  check_refused("if(x <, a, b)", "s.yaml:1:7: found ',' where a number, a name or a bracket is "
                                 "expected\n  if(x <, a, b)\n        ^");
  check_refused("2 - not x", "s.yaml:1:5: found 'not' where a number, a name or a bracket is "
                             "expected\n  2 - not x\n      ^~~");
  check_refused("x and", "s.yaml:1:6: found the end where a number, a name or a bracket is "
                         "expected\n  x and\n       ^");
  check_refused(
      "if(x & y, a, b)",
      "s.yaml:1:6: '&' has no meaning in expressions; write and\n  if(x & y, a, b)\n       ^");
}
END_TEST

START_TEST(what_was_found_and_what_was_expected_is_told)
{
  check_refused("", "s.yaml:1:1: an expression is missing here");
  check_refused("# a", "s.yaml:1:1: an expression is missing here\n  # a\n  ^");
  check_refused("a + # b", "s.yaml:1:4: found the end where a number, a name or a bracket is "
                           "expected\n  a + # b\n     ^");
  check_refused(
      "a + * b",
      "s.yaml:1:5: found '*' where a number, a name or a bracket is expected\n  a + * b\n      ^");
  check_refused(
      "f()", "s.yaml:1:3: found ')' where a number, a name or a bracket is expected\n  f()\n    ^");
  check_refused("a = b",
                "s.yaml:1:3: found '=' where an operator or the end is expected\n  a = b\n    ^");
  check_refused("sum(2, x)",
                "s.yaml:1:5: found '2' where a name is expected\n  sum(2, x)\n      ^");
  check_refused("sum(i=1, x)",
                "s.yaml:1:8: found ',' where '..' is expected\n  sum(i=1, x)\n         ^");
  check_refused("sum(i)",
                "s.yaml:1:6: found ')' where ',', '=' or '<' is expected\n  sum(i)\n       ^");
  check_refused("B.", "s.yaml:1:3: found the end where a name is expected\n  B.\n    ^");
}
END_TEST

/* A text of `count` times `begin`, then x, then as often `end`. */
static const dvi__expression *repeated(size_t count, const char *begin, const char *end)
{
  static char text[1 << 20];
  size_t size = 0;
  for (size_t k = 0; k < count; k++) size += (size_t)sprintf(text + size, "%s", begin);
  text[size++] = 'x';
  for (size_t k = 0; k < count; k++) size += (size_t)sprintf(text + size, "%s", end);
  return expression_of_bytes(text, size);
}

START_TEST(nesting_ends_at_64_levels)
{
  static const char *const pair[][2] = {{"(", ")"},  {"f(", ")"}, {"[", "]"},
                                        {"x[", "]"}, {"-", ""},   {"2^", ""},
                                        {"", ".a"},  {"", "[1]"}, {"sum(i,", ")"}};
  for (size_t k = 0; k < sizeof pair / sizeof *pair; k++) {
    ck_assert_msg(repeated(64, pair[k][0], pair[k][1]) != NULL, "%s", scene.message);
    ck_assert_ptr_null(repeated(65, pair[k][0], pair[k][1]));
    ck_assert_int_eq(scene.complaint.status, DVI_BAD_SIZE);
    ck_assert_ptr_nonnull(
        strstr(scene.message, "more than 64 levels of nesting; name a part of it in definitions"));
    ck_assert_ptr_null(repeated(100000, pair[k][0], pair[k][1]));
  }
}
END_TEST

START_TEST(chains_may_be_as_long_as_the_file)
{
  const dvi__expression *e = repeated(200000, "x'+", "*x");
  ck_assert_ptr_nonnull(e);
  int terms = 1;
  for (; e->form == DVI__FORM_ADD; e = e->part[0]) terms++;
  ck_assert_int_eq(terms, 200001);
}
END_TEST

/* Wherever memory runs out. */
START_TEST(missing_memory_is_told)
{
  static const char text[] = "-[1, x']/f(a.b, 2^c) + sum(i<j=1..2, x[i,j])";
  bool fine = false;
  for (size_t room = 0; !fine; room += 16) {
    close_text(&scene);
    open_text(&scene, text, sizeof text - 1);
    limit_memory(&scene, room);
    const dvi__expression *expression = NULL;
    fine = dvi__expression_parse(&scene.source, (dvi__span){0, sizeof text - 1}, &scene.arena,
                                 &scene.complaint, &expression);
    if (!fine) check_complaint(&scene, DVI_NO_MEMORY, "s.yaml: memory ran out");
    ck_assert_uint_lt(room, 8192);
  }
}
END_TEST

static void release(void)
{
  close_text(&scene);
}

SUITE(syntax)
{
  tcase_add_checked_fixture(tests, NULL, release);
  tcase_add_test(tests, operators_bind_as_on_paper);
  tcase_add_test(tests, powers_bind_to_the_right_and_before_the_sign);
  tcase_add_test(tests, rates_indices_and_members_follow_what_they_belong_to);
  tcase_add_test(tests, calls_lists_and_sums_have_parts);
  tcase_add_test(tests, blanks_breaks_and_comments_are_nothing);
  tcase_add_test(tests, numbers_have_digits_a_fraction_and_an_exponent);
  tcase_add_test(tests, numbers_are_right_to_the_last_bit);
  tcase_add_test(tests, spans_are_where_the_parts_stand);
  tcase_add_test(tests, a_part_of_the_source_is_all_that_is_read);
  tcase_add_test(tests, usual_slips_get_a_remedy);
  tcase_add_test(tests, brackets_are_told_where_they_open);
  tcase_add_test(tests, conditions_bind_not_before_and_before_or);
  tcase_add_test(tests, conditions_end_where_they_must);
  tcase_add_test(tests, what_was_found_and_what_was_expected_is_told);
  tcase_add_test(tests, nesting_ends_at_64_levels);
  tcase_add_test(tests, missing_memory_is_told);
  tcase_add_test(tests, chains_may_be_as_long_as_the_file);
}
