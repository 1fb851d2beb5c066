/* labels: invariant */
/* Beyond each limit of docs/scenes.md there is an error that names it, and soon. */
#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/scene/scene_calls.h"
#include "support/suite.h"

enum { MESSAGE_SIZE = 1024, TEXT_SIZE = 2048 };

static char message[MESSAGE_SIZE];

/* The texts of a scene of one family q[N] (default NULL, the usual ones). */
typedef struct parts {
  const char *size, *potential, *parameter, *coordinates, *step, *until;
} parts;

static const char *or_usual(const char *given, const char *usual)
{
  return given != NULL ? given : usual;
}

static dvi_status read_parts(const parts *p, dvi_scene **scene)
{
  static char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 "parameters: {N: \"%s\", a: \"%s\"}\n"
                 "coordinates: {\"q[N]\": %s}\n"
                 "kinetic: sum(i, dot(q[i]', q[i]')/2)\n"
                 "potentials: {V: \"%s\"}\n"
                 "initial: {\"q[i]\": \"i*[1, 2, 3]\"}\n"
                 "step: %s\nuntil: %s\n",
                 or_usual(p->size, "4"), or_usual(p->parameter, "1"),
                 or_usual(p->coordinates, "vector(3)"),
                 or_usual(p->potential, "a*sum(i, dot(q[i], q[i]))"), or_usual(p->step, "0.1"),
                 or_usual(p->until, "1"));
  return dvi_scene_parse("s.yaml", text, strlen(text), 0, NULL, scene, message, sizeof message);
}

static void refused(const parts *p, dvi_status status, const char *words)
{
  dvi_scene *scene = NULL;
  const dvi_status found = read_parts(p, &scene);
  dvi_scene_destroy(&scene);
  ck_assert_msg(found == status, "%s instead of %s: %s", dvi_status_name(found),
                dvi_status_name(status), message);
  ck_assert_msg(strstr(message, words) != NULL, "%s", message);
}

START_TEST(usual_parts_make_a_scene)
{
  dvi_scene *scene = NULL;
  ck_assert_msg(read_parts(&(parts){0}, &scene) == DVI_OK, "%s", message);
  ck_assert_int_eq(call_all(scene), 0);
  dvi_scene_destroy(&scene);
}
END_TEST

START_TEST(files_are_limited)
{
  enum { LIMIT = 1 << 20 };
  char *text = calloc(LIMIT + 2, 1);
  ck_assert_ptr_nonnull(text);
  memset(text, '#', LIMIT + 1);
  dvi_scene *scene = NULL;
  ck_assert_int_eq(
      dvi_scene_parse("s.yaml", text, LIMIT + 1, 0, NULL, &scene, message, sizeof message),
      DVI_BAD_SIZE);
  ck_assert_str_eq(message, "s.yaml: the file has more than 1 MiB");
  ck_assert_int_eq(dvi_scene_parse("s.yaml", text, LIMIT, 0, NULL, &scene, message, sizeof message),
                   DVI_BAD_FILE);
  free(text);
}
END_TEST

START_TEST(nesting_is_limited)
{
  char brackets[2 * 65 + 2] = "";
  memset(brackets, '(', 65);
  brackets[65] = '1';
  memset(brackets + 66, ')', 65);
  refused(&(parts){.parameter = brackets}, DVI_BAD_SIZE,
          "s.yaml:1:91: more than 64 levels of nesting; name a part of it in definitions");
}
END_TEST

START_TEST(sizes_of_families_are_whole_numbers)
{
  static const char *const sizes[] = {"0", "-1", "2.5", "1e300", "3e9", "2^31"};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
    refused(&(parts){.size = sizes[k]}, DVI_BAD_FILE,
            "the size of a family is a whole number from 1 to 2147483647, not ");
  refused(&(parts){.size = "1e308*10"}, DVI_BAD_FILE, "s.yaml:1:18: this is not a finite number");
  refused(&(parts){.size = "5e7"}, DVI_BAD_SIZE, "s.yaml:2:16: more than 100000000 coordinates");
  refused(&(parts){.size = "1e5", .coordinates = "vector(1e5)"}, DVI_BAD_SIZE,
          "s.yaml:2:16: more than 100000000 coordinates");
}
END_TEST

START_TEST(memory_is_limited)
{
  refused(&(parts){.size = "3e7"}, DVI_BAD_SIZE, "s.yaml: more than 1 GiB of memory is needed");
  refused(&(parts){.potential = "sum(i=1..19999, sum(j=1..10000, q[1][1]*i*j))"}, DVI_BAD_SIZE,
          "s.yaml: more than 1 GiB of memory is needed");
}
END_TEST

START_TEST(sums_are_limited)
{
  static const char bound[] = "a bound must be between -1e9 and 1e9, and is ";
  refused(&(parts){.potential = "sum(i=1..20001, sum(j=1..10000, q[1][1]*i*j))"}, DVI_BAD_SIZE,
          "a sum of more than 200000000 terms");
  refused(&(parts){.potential = "sum(i<j=1..20002, q[1][1]*i*j)"}, DVI_BAD_SIZE,
          "a sum of more than 200000000 terms");
  refused(&(parts){.potential = "sum(i=1..2e9, q[1][1]*i)"}, DVI_BAD_FILE, bound);
  refused(&(parts){.potential = "sum(i=-1e300..3, q[1][1]*i)"}, DVI_BAD_FILE, bound);
}
END_TEST

START_TEST(expressions_are_limited)
{
  static const char parts_max[] =
      "more than 2000000 parts of expressions, with all sums written out";
  refused(&(parts){.potential = "sqrt(sum(i=1..2000000, (q[1][1] - i)^2))"}, DVI_BAD_SIZE,
          parts_max);
  refused(&(parts){.parameter = "sum(i=1..4000000, i^2)"}, DVI_BAD_SIZE, parts_max);
  refused(&(parts){.parameter = "sum(i=1..1000, sum(j=1..4000, 0*j))"}, DVI_BAD_SIZE,
          "more than 10000000 parts of expressions, with all sums written out");
}
END_TEST

START_TEST(programs_are_limited_when_they_are_read)
{
  refused(&(parts){.size = "5400", .potential = "sqrt(sum(i, dot(q[i], q[i])))"}, DVI_BAD_SIZE,
          "s.yaml:4:18: too large: its derivatives need more than 2000000 parts, 20000000 pairs, "
          "16384 numbers at a time, or 1 GiB\n"
          "  potentials: {V: \"sqrt(sum(i, dot(q[i], q[i])))\"}\n");
}
END_TEST

START_TEST(derivatives_are_limited_when_they_are_made)
{
  dvi_scene *scene = NULL;
  const parts p = {.size = "700", .potential = "sqrt(sum(i, dot(q[i], q[i])))"};
  ck_assert_msg(read_parts(&p, &scene) == DVI_OK, "%s", message);
  ck_assert_int_eq(call_all(scene), DVI_BAD_SIZE);
  ck_assert_str_eq(dvi_scene_fault(), "s.yaml: too large: its derivatives need more than 2000000 "
                                      "parts, 20000000 pairs, 16384 numbers at a time, or 1 GiB");
  dvi_scene_destroy(&scene);
}
END_TEST

START_TEST(runs_are_limited)
{
  static const char steps[] = " steps; at most 9007199254740992 (2^53) are possible";
  refused(&(parts){.step = "1e-300", .until = "1e300"}, DVI_BAD_SIZE, steps);
  refused(&(parts){.step = "1e-9", .until = "1e7"}, DVI_BAD_SIZE,
          "s.yaml:6:7: a run of 1e+16 steps; at most ");
  refused(&(parts){.step = "0"}, DVI_BAD_FILE, "step must be positive, and is 0");
  refused(&(parts){.until = "-1"}, DVI_BAD_FILE, "until must be positive, and is -1");
}
END_TEST

SUITE(scene_limits)
{
  tcase_add_test(tests, usual_parts_make_a_scene);
  tcase_add_test(tests, files_are_limited);
  tcase_add_test(tests, nesting_is_limited);
  tcase_add_test(tests, sizes_of_families_are_whole_numbers);
  tcase_add_test(tests, memory_is_limited);
  tcase_add_test(tests, sums_are_limited);
  tcase_add_test(tests, expressions_are_limited);
  tcase_add_test(tests, programs_are_limited_when_they_are_read);
  tcase_add_test(tests, derivatives_are_limited_when_they_are_made);
  tcase_add_test(tests, runs_are_limited);
}
