/* labels: invariant */
/* Any text is a scene or gives a sentence that can be printed. The callbacks of a scene give
 * finite numbers or a sentence, and it can be written as C. Texts are made of the scenes of the
 * catalogue. */
#define _POSIX_C_SOURCE 200809L /* glob */
#include <dvi/scene.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/utf8.h"
#include "support/files.h"
#include "support/scene/fuzz.h"
#include "support/scene/scene_calls.h"
#include "support/suite.h"

static const char *const tokens[] = {"coordinates:",
                                     "lagrangian: ",
                                     "kinetic: ",
                                     "potentials:",
                                     "hamiltonian: ",
                                     "one_form:",
                                     "constraints:",
                                     "definitions:",
                                     "include: {a: part.yaml, b: part.yaml}",
                                     "a_x",
                                     "parameters: {",
                                     "initial:",
                                     "symmetries:",
                                     "invariants:",
                                     "events:",
                                     "sweep:",
                                     "report:",
                                     "zero: ",
                                     "direction: rising",
                                     "stop: yes",
                                     "from: ",
                                     "count: ",
                                     "every: ",
                                     "columns: [",
                                     "title: ",
                                     "step: ",
                                     "until: ",
                                     "method: ",
                                     "scalar",
                                     "rotation",
                                     "motion",
                                     "direction",
                                     "angle",
                                     "omega(R)",
                                     "B.R",
                                     "B.x'",
                                     "R*[0, 0, 1]",
                                     "turn([0, 0, 1], 1)",
                                     "vector(2)",
                                     "vector(3)",
                                     "[N]",
                                     "x[1]",
                                     "q[i]",
                                     "x'",
                                     "q[i]'",
                                     "p(x)",
                                     "p(q[i])",
                                     "sum(i, ",
                                     "sum(i<j, ",
                                     "sum(i=1..N, ",
                                     "sum(i<j=1..3, ",
                                     "norm(",
                                     "dot(q[1], q[2])",
                                     "cross(",
                                     "transpose(",
                                     "sqrt(",
                                     "log(",
                                     "atan2(y, x)",
                                     "hypot(",
                                     "abs(",
                                     "max(x, 0)",
                                     "min(",
                                     "floor(",
                                     "if(x < 0, ",
                                     "if(",
                                     " <= ",
                                     " and not ",
                                     "u[N,3]",
                                     "u[i,j]",
                                     "sum(i, sum(j, ",
                                     "^",
                                     "^-1",
                                     "^0.5",
                                     "/",
                                     "*",
                                     "+",
                                     "-",
                                     "(",
                                     ")",
                                     "[",
                                     "]",
                                     "[1, 2]",
                                     "[[1, 2], [3, 4]]",
                                     "0",
                                     "1",
                                     "2",
                                     "1e-300",
                                     "1e300",
                                     "1e9",
                                     "0.5",
                                     "100000",
                                     "t",
                                     "pi",
                                     "N",
                                     "\n",
                                     "\n  ",
                                     ": ",
                                     ", ",
                                     "{",
                                     "}",
                                     "\"",
                                     "y",
                                     "x",
                                     NULL};

enum { MESSAGE_SIZE = 1024, COORDINATES_MAX = 300 };

static char message[MESSAGE_SIZE];

static void check_message(void)
{
  const size_t length = strlen(message);
  unsigned code = 0;
  fuzz_requires(length > 0);
  for (size_t k = 0, width = 0; k < length; k += width) {
    width = dvi__utf8(message + k, length - k, &code);
    fuzz_requires(width > 0 && dvi__utf8_printable(code));
  }
}

static int count_bytes(const char *text, size_t size, void *user)
{
  fuzz_requires(memchr(text, '\0', size) == NULL);
  *(size_t *)user += size;
  return 0;
}

/* Gives a number for the scene, from its form and from its derivatives. */
static unsigned kind_of(const dvi_scene *scene)
{
  dvi_scene_facts facts;
  dvi_scene_facts_of(scene, &facts);
  fuzz_requires(facts.form != NULL);
  return fuzz_hash(facts.form) + 5U * (facts.mass != NULL ? fuzz_hash(facts.mass) : 0) +
         17U * (unsigned)facts.kernels + 257U * (unsigned)(facts.hessian_operations % 64);
}

static unsigned try_scene(const dvi_scene *scene)
{
  size_t written = 0;
  const int n = dvi_system_nq(dvi_scene_system(scene)), nv = dvi_system_nv(dvi_scene_system(scene));
  fuzz_requires(dvi_scene_coordinate(scene, n - 1) != NULL &&
                dvi_scene_momentum(scene, nv - 1) != NULL);
  if (n > COORDINATES_MAX) return (unsigned)n % 16;
  char kept[32];
  (void)dvi_scene_invariance(scene, kept, sizeof kept);
  fuzz_requires(strlen(kept) < sizeof kept);
  const int code = call_all(scene);
  const dvi_status status = dvi_scene_emit_c(scene, "s", count_bytes, &written);
  fuzz_requires(status == DVI_OK || status == DVI_BAD_SIZE);
  return kind_of(scene) + (unsigned)(code + 1) + 3U * (unsigned)status;
}

static unsigned try_scene_text(const char *text, size_t size)
{
  dvi_scene *scene = NULL;
  const dvi_status status = dvi_scene_parse(path_in_folder("s.yaml"), text, size, 0, NULL, &scene,
                                            message, sizeof message);
  fuzz_requires((status == DVI_OK) == (scene != NULL));
  if (status == DVI_OK) {
    const unsigned kind = try_scene(scene);
    dvi_scene_destroy(&scene);
    return kind;
  }
  check_message();
  return 0; /* what is no scene leads to no other scene */
}

/* Try a text as a component that is included twice. */
static unsigned try_component(const char *text, size_t size)
{
  static const char outer[] = "include: {a: part.yaml, b: part.yaml}\nstep: 0.1\nuntil: 1\n";
  write_bytes(path_in_folder("part.yaml"), (const unsigned char *)text, size);
  return try_scene_text(outer, sizeof outer - 1);
}

static char *read_text(const char *path)
{
  enum { SIZE = 8192 };
  FILE *file = fopen(path, "rb");
  char *text = calloc(SIZE, 1);
  ck_assert_ptr_nonnull(file);
  ck_assert_ptr_nonnull(text);
  ck_assert_uint_gt(fread(text, 1, SIZE - 1, file), 0);
  fclose(file);
  return text;
}

static void fuzz_with(const char *name, unsigned (*try)(const char *, size_t))
{
  enum { SCENES_MAX = 64 };
  static const char part[] = "coordinates: {x: scalar}\nlagrangian: x'^2 - x^2\n"
                             "initial: {x: 1}\nparameters: {k: 2}\n";
  char *corpus[SCENES_MAX + 1] = {NULL};
  glob_t found;
  write_bytes(path_in_folder("part.yaml"), (const unsigned char *)part, sizeof part - 1);
  ck_assert_int_eq(glob(DVI_SCENES "/*.yaml", 0, NULL, &found), 0);
  ck_assert_uint_le(found.gl_pathc, SCENES_MAX);
  for (size_t k = 0; k < found.gl_pathc; k++) corpus[k] = read_text(found.gl_pathv[k]);
  const fuzz_target target = {name, (const char *const *)corpus, tokens, try, NULL};
  ck_assert_int_gt(fuzz(&target), 0);
  for (size_t k = 0; k < found.gl_pathc; k++) free(corpus[k]);
  globfree(&found);
}

START_TEST(any_text_is_a_scene_or_a_sentence)
{
  fuzz_with("scene", try_scene_text);
}
END_TEST

START_TEST(any_component_is_merged_or_a_sentence)
{
  fuzz_with("component", try_component);
}
END_TEST

SUITE(fuzz_scene)
{
  tcase_set_timeout(tests, fuzz_timeout());
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, any_text_is_a_scene_or_a_sentence);
  tcase_add_test(tests, any_component_is_merged_or_a_sentence);
}
