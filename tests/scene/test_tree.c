#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/text/tree.h"
#include "support/scene/scene_text.h"
#include "support/suite.h"

static scene_text scene;

static const dvi__tree *tree_of_bytes(const char *text, size_t size)
{
  close_text(&scene);
  open_text(&scene, text, size);
  const dvi__tree *root = NULL;
  const bool fine = dvi__tree_read(&scene.source, &scene.arena, &scene.complaint, &root);
  ck_assert(fine == (root != NULL));
  ck_assert(fine == (scene.complaint.status == DVI_OK));
  return root;
}

static const dvi__tree *tree_of(const char *text)
{
  const dvi__tree *root = tree_of_bytes(text, strlen(text));
  ck_assert_msg(root != NULL, "%s", scene.message);
  return root;
}

static void check_refused(const char *text, const char *message)
{
  ck_assert_ptr_null(tree_of_bytes(text, strlen(text)));
  check_complaint(&scene, DVI_BAD_FILE, message);
}

/* The scalar of a key has this value, and stands at these characters of the source. */
static void check_scalar(const dvi__tree *mapping, const char *key, const char *value,
                         const char *characters)
{
  const dvi__tree *found = dvi__tree_find(mapping, key);
  ck_assert_ptr_nonnull(found);
  ck_assert_int_eq(found->kind, DVI__SCALAR);
  ck_assert_str_eq(found->text, value);
  check_span(&scene, found->span, characters);
}

START_TEST(a_mapping_keeps_its_order)
{
  const dvi__tree *root = tree_of("b: 1\na: {c: 2, d: [3, x y]}\n");
  ck_assert_int_eq(root->kind, DVI__MAPPING);
  ck_assert_int_eq(root->count, 2);
  ck_assert_str_eq(root->key[0]->text, "b");
  ck_assert_str_eq(root->child[0]->text, "1");
  const dvi__tree *list = dvi__tree_find(dvi__tree_find(root, "a"), "d");
  ck_assert_int_eq(list->kind, DVI__SEQUENCE);
  ck_assert_int_eq(list->count, 2);
  ck_assert_str_eq(list->child[1]->text, "x y");
  ck_assert_ptr_null(dvi__tree_find(root, "c"));
  ck_assert_ptr_null(dvi__tree_find(list, "c"));
}
END_TEST

START_TEST(spans_are_the_characters_in_the_source)
{
  const dvi__tree *root = tree_of("plain: a + b # no part\n"
                                  "lines: a +\n  b\n\n"
                                  "double: \"a + b\"\n"
                                  "single: 'a + \"b\"'\n"
                                  "quotes: ''\n"
                                  "empty:\n");
  check_scalar(root, "plain", "a + b", "a + b");
  check_scalar(root, "lines", "a + b", "a +\n  b");
  check_scalar(root, "double", "a + b", "a + b");
  check_scalar(root, "single", "a + \"b\"", "a + \"b\"");
  check_scalar(root, "quotes", "", "");
  check_scalar(root, "empty", "", "");
  ck_assert_int_eq(dvi__tree_find(root, "plain")->plain, 1);
  ck_assert_int_eq(dvi__tree_find(root, "double")->plain, 0);
}
END_TEST

START_TEST(blocks_begin_after_the_line_of_their_header)
{
  const dvi__tree *root = tree_of(
      "literal: |\n  a +\n    b\n\n"
      "folded: >- # a comment of the header\n\n  a +\n  b # no comment\n\n\n"
      "indented: |2\n     a\n# outside\n"
      "none: |\n"
      "last: |+\n  z\n\n");
  check_scalar(root, "literal", "a +\n  b\n", "a +\n    b");
  check_scalar(root, "folded", "\na + b # no comment", "a +\n  b # no comment");
  check_scalar(root, "indented", "   a\n", "a");
  check_scalar(root, "none", "", "");
  check_scalar(root, "last", "z\n\n", "z");
  ck_assert_int_eq(dvi__tree_find(root, "literal")->plain, 0);
}
END_TEST

/* libyaml counts characters. */
START_TEST(spans_count_bytes_behind_letters_of_several)
{
  const dvi__tree *root = tree_of(
      "title: \xCE\xB8 \xE2\x88\x91 \xF0\x9D\x84\x9E\r\na: [\"\xC3\xA9\", x]\r\nb: y\n");
  check_scalar(root, "title", "\xCE\xB8 \xE2\x88\x91 \xF0\x9D\x84\x9E",
               "\xCE\xB8 \xE2\x88\x91 \xF0\x9D\x84\x9E");
  check_scalar(root, "b", "y", "y");
  check_span(&scene, dvi__tree_find(root, "a")->child[0]->span, "\xC3\xA9");
}
END_TEST

START_TEST(spans_of_collections_end_with_what_they_hold)
{
  const dvi__tree *root = tree_of(
      "a: [x, {b: c}] # flow\nb:\n  c: 1\n  d: 'e'\n  # comment\nf:\n- g\n- |\n  h\n\ni: 1\n");
  check_span(&scene, dvi__tree_find(root, "a")->span, "[x, {b: c}]");
  check_span(&scene, dvi__tree_find(root, "a")->child[1]->span, "{b: c}");
  check_span(&scene, dvi__tree_find(root, "b")->span, "c: 1\n  d: 'e'");
  check_span(&scene, dvi__tree_find(root, "f")->span, "- g\n- |\n  h");
  root = tree_of("a:\n  b: 1\n  c:\nd:\n-\ne: []\n");
  check_span(&scene, dvi__tree_find(root, "a")->span, "b: 1\n  c:");
  check_span(&scene, dvi__tree_find(root, "d")->span, "-");
  check_span(&scene, dvi__tree_find(root, "e")->span, "[]");
}
END_TEST

START_TEST(a_list_may_be_a_key)
{
  const dvi__tree *root = tree_of("[x, y]: scalar\n");
  check_scalar(root, "[x, y]", "scalar", "scalar");
  ck_assert_int_eq(root->key[0]->kind, DVI__SCALAR);
  check_span(&scene, root->key[0]->span, "[x, y]");
}
END_TEST

START_TEST(a_marker_may_begin_and_end_the_document)
{
  check_scalar(tree_of("--- # a comment\na: 1\n...\n"), "a", "1", "1");
}
END_TEST

START_TEST(anchors_aliases_tags_and_directives_are_refused)
{
  check_refused("a: &b 1\n", "s.yaml:1:4: anchors (&) are not for scenes; write the value where it "
                             "is needed\n  a: &b 1\n     ^");
  check_refused("a: &b [1]\n", "s.yaml:1:4: anchors (&) are not for scenes; write the value where "
                               "it is needed\n  a: &b [1]\n     ^");
  check_refused("a: *b\n", "s.yaml:1:4: aliases (*) are not for scenes; write the value, or put "
                           "quotes around the text\n  a: *b\n     ^~");
  check_refused("a: !!int 1\n", "s.yaml:1:4: tags (!) are not for scenes; leave it out, or put "
                                "quotes around the text\n  a: !!int 1\n     ^");
  check_refused("a: ! 1\n", "s.yaml:1:4: tags (!) are not for scenes; leave it out, or put quotes "
                            "around the text\n  a: ! 1\n     ^");
  check_refused("--- !t\na: 1\n", "s.yaml:1:5: tags (!) are not for scenes; leave it out, or put "
                                  "quotes around the text\n  --- !t\n      ^");
  check_refused(
      "%YAML 1.1\n---\na: 1\n",
      "s.yaml:1:1: directives (%) are not for scenes; leave the line out\n  %YAML 1.1\n  ^");
  check_refused(
      "%TAG ! x\n---\na: 1\n",
      "s.yaml:1:1: directives (%) are not for scenes; leave the line out\n  %TAG ! x\n  ^");
}
END_TEST

START_TEST(one_document_is_expected)
{
  check_refused("a: 1\n---\nb: 2\n",
                "s.yaml:2:1: a second document begins here; a scene is one\n  ---\n  ^");
  static const char empty[] = "s.yaml: the file is empty, and no scene: that is a YAML mapping "
                              "with coordinates, lagrangian, "
                              "initial, step and until; dvi init NAME.yaml writes one";
  check_refused("", empty);
  check_refused("# nothing\n", empty);
}
END_TEST

START_TEST(keys_are_names_that_differ)
{
  check_refused(
      "a: 1\nb: {c: 1, 'c': 2}\n",
      "s.yaml:2:12: the key 'c' stands in line 2 already\n  b: {c: 1, 'c': 2}\n             ^");
  check_refused("? {a: b}\n: 1\n", "s.yaml:1:3: a key is a name, or a list of names, and no "
                                   "mapping or sequence\n  ? {a: b}\n    ^");
  check_refused("? - a\n: 1\n", "s.yaml:1:3: a key is a name, or a list of names, and no mapping "
                                "or sequence\n  ? - a\n    ^");
}
END_TEST

START_TEST(escapes_are_refused)
{
  check_refused("a: \"x\\n\"\n", "s.yaml:1:6: a backslash in double quotes makes text that does "
                                 "not stand here; write it without\n  a: \"x\\n\"\n       ^");
  check_refused("a: 'x''y'\n", "s.yaml:1:6: '' in single quotes stands for one '; write double "
                               "quotes around the text\n  a: 'x''y'\n       ^~");
}
END_TEST

START_TEST(other_encodings_and_control_characters_are_refused)
{
  check_refused("a: \xC3(\n",
                "s.yaml:1:4: this byte is no UTF-8; save the file as UTF-8\n  a: ?(\n     ^");
  /* overlong */
  check_refused("a: \xC0\xAF\n",
                "s.yaml:1:4: this byte is no UTF-8; save the file as UTF-8\n  a: ??\n     ^");
  /* surrogate */
  check_refused("a: \xED\xA0\x80\n",
                "s.yaml:1:4: this byte is no UTF-8; save the file as UTF-8\n  a: ???\n     ^");
  /* cut short */
  check_refused("a: \xE2\x88",
                "s.yaml:1:4: this byte is no UTF-8; save the file as UTF-8\n  a: ??\n     ^");
  check_refused("a: \x07\n",
                "s.yaml:1:4: the character U+0007 cannot stand in a scene\n  a: ?\n     ^");
  check_refused("\xEF\xBB\xBF"
                "a: 1\n",
                "s.yaml: the file begins with a byte order mark; save it as UTF-8 without one");
  check_refused("\xFF\xFE"
                "a",
                "s.yaml: the file is UTF-16; save it as UTF-8");
  check_refused("a: \xE2\x80\xA8\n",
                /* a break of lines in YAML 1.1 */
                "s.yaml:1:4: the character U+2028 cannot stand in a scene\n  a: ?\n     ^");
  ck_assert_ptr_null(tree_of_bytes("a: \0\n", 5));
  check_complaint(&scene, DVI_BAD_FILE,
                  "s.yaml:1:4: the character U+0000 cannot stand in a scene\n  a: ?\n     ^");
}
END_TEST

START_TEST(what_is_no_yaml_gets_a_remedy)
{
  check_refused("a: [x[1], y]\n", "s.yaml:1:6: this is no YAML: did not find expected ',' or ']' "
                                  "while parsing a flow sequence; an element with "
                                  "brackets or commas needs quotes, as \"[x[1], y[1]]\" does as a "
                                  "whole\n  a: [x[1], y]\n       ^");
  check_refused("a:\n\tb: 1\n", "s.yaml:2:1: this is no YAML: found character that cannot start "
                                "any token while scanning for the next token; "
                                "indent by blanks, not by tabs, and put quotes around texts that "
                                "begin with @, ` or %\n  \tb: 1\n  ^");
  check_refused("a: b: c\n",
                "s.yaml:1:5: this is no YAML: mapping values are not allowed in this context; a "
                "text with a colon and a blank needs "
                "quotes, and keys of one mapping the same indentation\n  a: b: c\n      ^");
}
END_TEST

START_TEST(what_never_ends_is_shown_where_it_begins)
{
  check_refused("a: 1\nb: {c: 1\n", "s.yaml:2:4: this is no YAML: did not find expected ',' or '}' "
                                    "while parsing a flow mapping; an element with "
                                    "brackets or commas needs quotes\n  b: {c: 1\n     ^");
  check_refused("a: \"b\nc: 1\n", "s.yaml:1:4: this is no YAML: found unexpected end of stream "
                                  "while scanning a quoted scalar\n  a: \"b\n     ^");
}
END_TEST

/* `count` openings, a scalar, and as many closings. */
static const dvi__tree *nested(size_t count)
{
  static char text[4096];
  memset(text, '[', count);
  text[count] = 'x';
  memset(text + count + 1, ']', count);
  return tree_of_bytes(text, 2 * count + 1);
}

START_TEST(nesting_ends_at_64_levels)
{
  ck_assert_ptr_nonnull(nested(64));
  ck_assert_ptr_null(nested(65));
  ck_assert_int_eq(scene.complaint.status, DVI_BAD_SIZE);
  ck_assert_ptr_nonnull(strstr(scene.message, "s.yaml:1:65: more than 64 levels of nesting"));
  ck_assert_ptr_null(nested(2000)); /* far beyond what libyaml takes */
}
END_TEST

START_TEST(files_end_at_one_mebibyte)
{
  const size_t size = 1 << 20;
  char *text = malloc(size + 1);
  memset(text, 'x', size + 1);
  ck_assert_ptr_nonnull(tree_of_bytes(text, size));
  ck_assert_ptr_null(tree_of_bytes(text, size + 1));
  check_complaint(&scene, DVI_BAD_SIZE, "s.yaml: the file has more than 1 MiB");
  free(text);
}
END_TEST

/* A mapping of 1 MiB. Neither duplicates nor places take quadratic time, which would be minutes. */
START_TEST(many_keys_take_no_longer_each)
{
  enum { KEYS = 90000, ROOM = 16 };
  char *text = malloc((size_t)KEYS * ROOM);
  size_t size = 0;
  for (int k = 0; k < KEYS; k++) size += (size_t)snprintf(text + size, ROOM, "a%d: \xCE\xB8\n", k);
  const dvi__tree *root = tree_of_bytes(text, size);
  ck_assert_ptr_nonnull(root);
  ck_assert_int_eq(root->count, KEYS);
  check_scalar(root, "a89999", "\xCE\xB8", "\xCE\xB8");
  close_text(&scene);
  free(text);
}
END_TEST

/* Wherever memory runs out. */
START_TEST(missing_memory_is_told)
{
  static const char text[] = "a: [1, {b: 2, c: 3}]\n[d, e]: 4\n";
  bool fine = false;
  for (size_t room = 0; !fine; room += 16) {
    close_text(&scene);
    open_text(&scene, text, sizeof text - 1);
    limit_memory(&scene, room);
    const dvi__tree *root = NULL;
    fine = dvi__tree_read(&scene.source, &scene.arena, &scene.complaint, &root);
    if (!fine) check_complaint(&scene, DVI_NO_MEMORY, "s.yaml: memory ran out");
    ck_assert_uint_lt(room, 4096);
  }
}
END_TEST

static void release(void)
{
  close_text(&scene);
}

SUITE(tree)
{
  tcase_add_checked_fixture(tests, NULL, release);
  tcase_add_test(tests, a_mapping_keeps_its_order);
  tcase_add_test(tests, spans_are_the_characters_in_the_source);
  tcase_add_test(tests, blocks_begin_after_the_line_of_their_header);
  tcase_add_test(tests, spans_count_bytes_behind_letters_of_several);
  tcase_add_test(tests, spans_of_collections_end_with_what_they_hold);
  tcase_add_test(tests, a_list_may_be_a_key);
  tcase_add_test(tests, a_marker_may_begin_and_end_the_document);
  tcase_add_test(tests, anchors_aliases_tags_and_directives_are_refused);
  tcase_add_test(tests, one_document_is_expected);
  tcase_add_test(tests, keys_are_names_that_differ);
  tcase_add_test(tests, escapes_are_refused);
  tcase_add_test(tests, other_encodings_and_control_characters_are_refused);
  tcase_add_test(tests, what_is_no_yaml_gets_a_remedy);
  tcase_add_test(tests, what_never_ends_is_shown_where_it_begins);
  tcase_add_test(tests, nesting_ends_at_64_levels);
  tcase_add_test(tests, files_end_at_one_mebibyte);
  tcase_add_test(tests, missing_memory_is_told);
  tcase_add_test(tests, many_keys_take_no_longer_each);
}
