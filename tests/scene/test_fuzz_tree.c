/* Any text makes a tree whose parts stand where they say, or a sentence that can be printed. */
#include <stdio.h>
#include <string.h>

#include "scene/text/tree.h"
#include "text/utf8.h"
#include "support/scene/fuzz.h"
#include "support/scene/scene_text.h"
#include "support/suite.h"

static const char *const corpus[] = {
    "parameters:\n  m: 0.2 # bob\ncoordinates:\n  x: scalar\n  [y, z]: vector(3)\ninitial: {x: 0, "
    "y: 1}\n",
    "lagrangian: >- # header\n  M/2*x'^2\n    + m/2*dot(bob', bob')\n\n  - V # no comment\nnext: "
    "|2\n    a\n\n  b\n",
    "--- # start\na: \"a +\n  b\"\nb: 'c \xCE\xB8'\n? d\n: - 1\n  - - 2\n    - {e: f, g}\n  - [h: "
    "i, \"j\" : k]\n...\n",
    "a: plain text\n  over lines\n\n  and a blank one\nb:\n- c\n- d: e\n  f:\n  - g\n", NULL};

static const char *const tokens[] = {"\n",
                                     "\r\n",
                                     "\r",
                                     " ",
                                     "  ",
                                     "\t",
                                     ": ",
                                     ":",
                                     "- ",
                                     "? ",
                                     "[",
                                     "]",
                                     "{",
                                     "}",
                                     ", ",
                                     "&a ",
                                     "*a",
                                     "!t ",
                                     "!",
                                     "!!x ",
                                     "|",
                                     "|2\n",
                                     ">-\n",
                                     ">+",
                                     "'",
                                     "''",
                                     "\"",
                                     "\\n",
                                     "\\0",
                                     "#",
                                     " # c\n",
                                     "---",
                                     "---\n",
                                     "...\n",
                                     "%YAML 1.1\n",
                                     "%TAG ! x\n",
                                     "@",
                                     "`",
                                     "\xCE\xB8",
                                     "\xE2\x80\xA8",
                                     "\xC2\x85",
                                     "\xEF\xBB\xBF",
                                     "\xF0\x9D\x84\x9E",
                                     "\xC0\x80",
                                     "a: b\n",
                                     "<<: ",
                                     "~",
                                     "x",
                                     NULL};

static scene_text scene;

/* Gives the next character that is no blank, with the text behind it, or 0 at the end. */
static unsigned next_seen(const char **at, const char *end)
{
  while (*at < end) {
    unsigned code = 0;
    const size_t width = dvi__utf8(*at, (size_t)(end - *at), &code);
    fuzz_requires(width > 0);
    *at += width;
    if (code != ' ' && code != '\t' && code != '\n' && code != '\r') return code;
  }
  return 0;
}

/* But for blanks, value and source are the same characters. */
static void check_text(const dvi__tree *scalar)
{
  const char *value = scalar->text;
  const char *value_end = value + strlen(value);
  const char *at = scene.source.text + scalar->span.first;
  const char *end = at + scalar->span.size;
  unsigned code = 0;
  do {
    code = next_seen(&at, end);
    fuzz_requires(next_seen(&value, value_end) == code);
  } while (code != 0);
}

static size_t end_of(dvi__span span)
{
  return span.first + span.size;
}

/* The node stands inside of its parent, behind `before`. Returns how many nodes it has, itself
 * included. */
static int check_node(const dvi__tree *node, size_t before, size_t end, int level)
{
  fuzz_requires(node->span.first >= before);
  fuzz_requires(node->span.size == 0 || end_of(node->span) <= end);
  fuzz_requires(end_of(node->span) <= scene.source.size);
  if (node->kind == DVI__SCALAR) {
    check_text(node);
    fuzz_requires(node->count == 0);
    return 1;
  }
  fuzz_requires(level <= 64);
  int nodes = 1;
  before = node->span.first;
  for (int k = 0; k < node->count; k++) {
    if (node->kind == DVI__MAPPING) {
      fuzz_requires(node->key[k]->kind == DVI__SCALAR);
      nodes += check_node(node->key[k], before, end_of(node->span), level + 1);
      before = end_of(node->key[k]->span);
      fuzz_requires(dvi__tree_find(node, node->key[k]->text) != NULL);
    }
    nodes += check_node(node->child[k], before, end_of(node->span), level + 1);
    before = end_of(node->child[k]->span);
  }
  return nodes;
}

static unsigned try_tree(const char *text, size_t size)
{
  open_text(&scene, text, size);
  const dvi__tree *root = NULL;
  const bool fine = dvi__tree_read(&scene.source, &scene.arena, &scene.complaint, &root);
  fuzz_requires(fine == (root != NULL) && fine == (scene.complaint.status == DVI_OK));
  unsigned outcome = fuzz_hash(scene.message);
  if (fine)
    outcome = (unsigned)check_node(root, 0, size, 1) % 256; /* more nodes are nothing new */
  else
    check_printable(&scene);
  close_text(&scene);
  return outcome;
}

START_TEST(any_text_makes_a_tree_or_a_sentence)
{
  ck_assert_int_gt(fuzz(&(fuzz_target){"tree", corpus, tokens, try_tree, NULL}), 0);
}
END_TEST

SUITE(fuzz_tree)
{
  tcase_set_timeout(tests, fuzz_timeout());
  tcase_add_test(tests, any_text_makes_a_tree_or_a_sentence);
}
