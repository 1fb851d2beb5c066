/* Any text makes an expression whose parts are what their own source says, or a sentence that can
 * be printed. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/text/syntax.h"
#include "support/scene/fuzz.h"
#include "support/scene/scene_text.h"
#include "support/suite.h"

static const char *const corpus[] = {
    "M/2*x'^2 + m/2*dot(bob', bob') - m*g*bob[2]",
    "sum(i<j = 1..N-1, m[i]*m[j]/norm(q[i] - q[j])) + sum(i, 0.5e-3*x[i]^2)",
    "[x + l*sin(theta), [-l*cos(theta), A[1,2]]] # comment\n+ B.R'[3]",
    "-2^-x^(1/2) - atan2(y, .5 + 2.)*(a - (b - c))",
    "if(0 < x <= 1 or not (y != 2 and z >= -1), max(x, y), if(x == 0, 1, sin(x)/x))",
    NULL};

static const char *const tokens[] = {"+",     "-",        "*",
                                     "/",     "^",        "(",
                                     ")",     "[",        "]",
                                     ",",     ".",        "..",
                                     "'",     "<",        "=",
                                     "sum(",  "sum(i<j,", "sum(i=1..2,",
                                     "x",     "y_1",      "1",
                                     "0.5",   "1e3",      "1e400",
                                     "1e",    "**",       "|",
                                     "# c\n", "\n",       " ",
                                     "\t",    "\xCE\xB8", "\xE2\x88\x92",
                                     "\xC3",  ":",        "f(",
                                     "x[",    "x'",       "(x",
                                     "-(",    "2^",       "if(",
                                     " and ", " or ",     "not ",
                                     ">",     "<=",       ">=",
                                     "==",    "!=",       "if(x<0,",
                                     NULL};

static scene_text scene;

static void check_name(const char *name)
{
  fuzz_requires(name != NULL);
  fuzz_requires(strlen(name) > 0);
  fuzz_requires(strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") ==
                strlen(name));
}

/* Checks the facts that hold for every node of a form. */
static void check_form(const dvi__expression *e)
{
  static const struct {
    int least, most;
    bool named;
  } form[] = {[DVI__FORM_NUMBER] = {0, 0, false},      [DVI__FORM_NAME] = {0, 0, true},
              [DVI__FORM_INDEX] = {2, 1 << 20, false}, [DVI__FORM_MEMBER] = {1, 1, true},
              [DVI__FORM_RATE] = {1, 1, false},        [DVI__FORM_NEGATIVE] = {1, 1, false},
              [DVI__FORM_ADD] = {2, 2, false},         [DVI__FORM_SUBTRACT] = {2, 2, false},
              [DVI__FORM_MULTIPLY] = {2, 2, false},    [DVI__FORM_DIVIDE] = {2, 2, false},
              [DVI__FORM_POWER] = {2, 2, false},       [DVI__FORM_CALL] = {1, 1 << 20, true},
              [DVI__FORM_LIST] = {1, 1 << 20, false},  [DVI__FORM_SUM] = {1, 3, true},
              [DVI__FORM_IF] = {3, 3, false},          [DVI__FORM_NOT] = {1, 1, false},
              [DVI__FORM_AND] = {2, 1 << 20, false},   [DVI__FORM_OR] = {2, 1 << 20, false},
              [DVI__FORM_COMPARE] = {2, 2, false}};
  fuzz_requires(e->count >= form[e->form].least);
  fuzz_requires(e->count <= form[e->form].most);
  fuzz_requires(e->form != DVI__FORM_SUM || e->count != 2);
  fuzz_requires(e->form == DVI__FORM_SUM || e->name2 == NULL);
  fuzz_requires(isfinite(e->number));
  if (form[e->form].named) check_name(e->name);
  if (e->form == DVI__FORM_COMPARE) fuzz_requires(strspn(e->name, "<>=!") == strlen(e->name));
  if (e->name2 != NULL) check_name(e->name2);
}

/* Checks that parts stand inside of their wholes, and returns the forms that occur, a bit for each.
 * Chains lean to the left, and only they are long. */
static unsigned check_parts(const dvi__expression *e, int level)
{
  fuzz_requires(level <= 5 * 64);
  unsigned forms = 0;
  for (bool chain = true; chain;) {
    check_form(e);
    forms |= 1U << e->form;
    for (int k = 0; k < e->count; k++) {
      fuzz_requires(e->part[k]->span.first >= e->span.first);
      fuzz_requires(e->part[k]->span.first + e->part[k]->span.size <= e->span.first + e->span.size);
    }
    chain = e->form >= DVI__FORM_ADD && e->form <= DVI__FORM_DIVIDE;
    for (int k = chain ? 1 : 0; k < e->count; k++) forms |= check_parts(e->part[k], level + 1);
    if (chain) e = e->part[0];
  }
  return forms;
}

static void check_same(const dvi__expression *a, const dvi__expression *b)
{
  fuzz_requires(a->form == b->form);
  fuzz_requires(a->count == b->count);
  fuzz_requires(memcmp(&a->number, &b->number, sizeof a->number) == 0);
  fuzz_requires(a->name == b->name || strcmp(a->name, b->name) == 0);
  fuzz_requires(a->name2 == b->name2 || strcmp(a->name2, b->name2) == 0);
  for (int k = 0; k < a->count; k++) check_same(a->part[k], b->part[k]);
}

/* Each part is read again, from its own characters. */
static void check_again(const dvi__expression *e, int levels)
{
  const dvi__expression *again = NULL;
  fuzz_requires(
      dvi__expression_parse(&scene.source, e->span, &scene.arena, &scene.complaint, &again));
  check_same(e, again);
  for (int k = 0; levels > 0 && k < e->count; k++) check_again(e->part[k], levels - 1);
}

static unsigned try_syntax(const char *text, size_t size)
{
  open_text(&scene, text, size);
  const dvi__expression *e = NULL;
  const bool fine = dvi__expression_parse(&scene.source, (dvi__span){0, size}, &scene.arena,
                                          &scene.complaint, &e);
  fuzz_requires(fine == (e != NULL) && fine == (scene.complaint.status == DVI_OK));
  unsigned outcome = fuzz_hash(scene.message);
  if (fine) {
    outcome = check_parts(e, 0);
    check_again(e, size < 300 ? 4 : 1);
  } else {
    check_printable(&scene);
  }
  close_text(&scene);
  return outcome;
}

START_TEST(any_text_makes_an_expression_or_a_sentence)
{
  ck_assert_int_gt(fuzz(&(fuzz_target){"syntax", corpus, tokens, try_syntax, NULL}), 0);
}
END_TEST

SUITE(fuzz_syntax)
{
  tcase_set_timeout(tests, fuzz_timeout());
  tcase_add_test(tests, any_text_makes_an_expression_or_a_sentence);
}
