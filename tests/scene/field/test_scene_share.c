/* Scenes on shares of their mesh: marches have the bits of the whole mesh, and what needs the whole
 * mesh is refused. */
#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/field/ranks.h"
#include "support/files.h"
#include "support/suite.h"

enum { PROCESSES = 3, SEEN = 48, MESSAGE_SIZE = 512 };

/* A scene's file, and what each process observes. */
typedef struct shared_scene {
  const char *path;
  dvi_status status[PROCESSES];
  double seen[PROCESSES][SEEN];
  char message[PROCESSES][MESSAGE_SIZE];
} shared_scene;

/* `user` is the share. */
static dvi_status take(const dvi_mesh *mesh, dvi_mesh **share, void *user)
{
  (void)mesh;
  *share = dvi_mesh_share(user);
  return DVI_OK;
}

/* Give what a wave or a solid keeps, and its probes. */
static dvi_status probe(const dvi_scene *scene, const dvi_march *march, double *seen)
{
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  double *q = calloc(2 * (size_t)terms->dimension + 1, sizeof *q), *p = q + terms->dimension;
  const dvi_status status = dvi_scene_march_state(scene, march, q, p);
  *seen++ = terms->symmetry_count;
  for (int i = 0; i < terms->invariant_count && status == DVI_OK; i++) {
    const dvi_invariant *of = terms->invariants + i;
    ck_assert_int_eq(of->value(dvi_march_time(march), q, p, seen++, of->user), 0);
  }
  free(q);
  return status;
}

static dvi_status observe(const dvi_scene *scene, double *seen)
{
  dvi_march *march = NULL;
  dvi_status status = dvi_scene_march_create(scene, NULL, &march);
  if (status == DVI_OK) status = dvi_march_advance(march, 0.7);
  for (int i = 0; status == DVI_OK && dvi_march_observable(march, i) != NULL; i++, seen++)
    status = dvi_march_observe(march, i, seen);
  if (status == DVI_OK && dvi_march_size(march, DVI_FORM_A) > 0) status = probe(scene, march, seen);
  dvi_march_destroy(&march);
  return status;
}

static void read_share(const dvi_mesh *share, int rank, void *user)
{
  shared_scene *s = user;
  dvi_scene *scene = NULL;
  const dvi_scene_division division = {
      .size = sizeof division, .divide = take, .user = (dvi_mesh *)share};
  s->status[rank] = dvi_scene_read_share(s->path, &division, 0, NULL, &scene, s->message[rank],
                                         MESSAGE_SIZE);
  if (s->status[rank] != DVI_OK) return;
  ck_assert_ptr_null(dvi_scene_system(scene));
  s->status[rank] = observe(scene, s->seen[rank]);
  dvi_scene_destroy(&scene);
}

enum { CELLS = 144 };

/* Write tetrahedra to the file layers.msh: one part of half of them, one in it, and one beside it,
 * of which some are in it. */
static dvi_mesh *layers(void)
{
  static const int first[] = {0, 10, 60}, last[] = {72, 40, 80};
  static const char *const name[] = {"half", "core", "torn"};
  int corners, number[CELLS];
  dvi_mesh *whole = generated("kuhn", (dvi_generator_options){.cells = {4, 3, 2}}), *made;
  dvi_mesh_part part[3];
  for (int c = 0; c < CELLS; c++) number[c] = c;
  for (int p = 0; p < 3; p++)
    part[p] = (dvi_mesh_part){
        .name = name[p], .degree = 3, .count = last[p] - first[p], .cell = number + first[p]};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 3,
                                .points = dvi_mesh_count(whole, 0),
                                .point = dvi_mesh_points(whole),
                                .cells = CELLS,
                                .vertex = dvi_mesh_vertices(whole, 3, &corners),
                                .part = part,
                                .parts = 3};
  ck_assert_msg(dvi_mesh_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_mesh_write(made, path_in_folder("layers.msh"), 0, NULL), DVI_OK);
  dvi_mesh_destroy(&whole);
  return made;
}

/* Read a scene on all shares of a box of 4*3*2 cells, or of these cut into tetrahedra. */
static void read_shares(const char *text, shared_scene *s)
{
  const dvi_generator_options options = {.cells = {4, 3, 2}};
  dvi_mesh *mesh = strstr(text, "layers") != NULL
                       ? layers()
                       : generated(strstr(text, "kuhn") != NULL ? "kuhn" : "box", options);
  int owner[CELLS];
  for (int c = 0; c < CELLS; c++) owner[c] = c % PROCESSES;
  s->path = path_in_folder("share.yaml");
  write_bytes(s->path, (const unsigned char *)text, strlen(text));
  run_ranks(mesh, PROCESSES, owner, read_share, s);
  dvi_mesh_destroy(&mesh);
}

#define MAXWELL                                                                  \
  "mesh: {generator: box, cells: [4, 3, 2]}\nfield: maxwell\nmethod: leapfrog\n" \
  "step: {fraction: 0.5}\nuntil: 1\n"
#define WAVE                                                                  \
  "mesh: {generator: box, cells: [4, 3, 2]}\nfield: wave\nmethod: leapfrog\n" \
  "step: {fraction: 0.5}\nuntil: 1\ninitial: {u: x*(1 - y)}\n"

#define SOLID                                                                          \
  "mesh: {generator: kuhn, cells: [4, 3, 2]}\nfield: elastic\nstep: {fraction: 0.5}\n" \
  "until: 1\nmethod: verlet\n"

#define LAYERS                                                                            \
  "mesh: {file: layers.msh}\nfield: elastic\nstep: {fraction: 0.5}\nuntil: 1\n"           \
  "method: avi\nloads: {gravity: [0, 0, -0.1]}\nprobes: {work: {of: load}}\nmaterials: {" \
  "all: {law: svk, lambda: 1, mu: 1, rho: 2}, half: {law: svk, lambda: 1, mu: 1, rho: 3}, "

/* All processes observe what one observes on the whole mesh. */
static void check_observed(const char *text)
{
  shared_scene s = {.path = NULL};
  double whole[SEEN] = {0};
  dvi_scene *scene = NULL;
  read_shares(text, &s);
  ck_assert_msg(dvi_scene_read(s.path, 0, NULL, &scene, s.message[0], MESSAGE_SIZE) == DVI_OK, "%s",
                s.message[0]);
  ck_assert_int_eq(observe(scene, whole), DVI_OK);
  dvi_scene_destroy(&scene);
  for (int r = 0; r < PROCESSES; r++) {
    ck_assert_msg(s.status[r] == DVI_OK, "%s", s.message[r]);
    for (int i = 0; i < SEEN; i++) ck_assert_double_eq(s.seen[r][i], whole[i]);
  }
}

static void check_refused(const char *text, dvi_status status, const char *words)
{
  shared_scene s = {.path = NULL};
  read_shares(text, &s);
  for (int r = 0; r < PROCESSES; r++) {
    ck_assert_int_eq(s.status[r], status);
    if (words != NULL) ck_assert_msg(strstr(s.message[r], words) != NULL, "%s", s.message[r]);
  }
}

START_TEST(gravity_knows_the_materials_of_the_whole_mesh)
{
  check_observed(LAYERS "core: {law: svk, lambda: 2, mu: 1, rho: 0.5}}\n");
  check_refused(LAYERS "torn: {law: svk, lambda: 2, mu: 1, rho: 0.5}}\n", DVI_BAD_FILE,
                "the part 'torn' must lie in one other material, and its cells have several");
}
END_TEST

START_TEST(marches_have_the_bits_of_the_whole_mesh)
{
  check_observed(WAVE "boundary: fixed\nmaterials: {all: {rho: 1 + x, a: 1 + y}}\n");
  check_observed(WAVE "boundary: {left: fixed}\n"
                      "probes: {a: {at: [0.5, 0.5, 0.5]}, b: {at: [0.9, 0.1, 0.7]},\n"
                      "  c: {integral: u^2*x}, d: {integral: 1 + u, over: all}}\n");
  check_observed(MAXWELL "materials: {all: {eps: 1 + x, sigma: 0.2}}\n"
                         "boundary: {boundary: pec, left: absorbing}\n"
                         "initial: {E: [y*(1 - y), 0, x]}\n"
                         "sources: {ring: {at: [0.5, 0.5, 0.5], current: [0, 0, sin(9*t)]}}\n"
                         "probes: {e: {of: E, at: [0.3, 0.4, 0.5], along: [1, 0.2, 0]}}\n");
  check_observed(SOLID "materials: {all: {law: neo-hookean, lambda: 1, mu: 1, alpha: 0.2}}\n"
                       "boundary: {left: {fixed: \"[0, 0.1*sin(t), 0]\"}, back: {fixed: {z: 0}}}\n"
                       "loads: {gravity: [0, 0, -0.1], right: {traction: -0.1*normal}}\n"
                       "initial: {u': \"[0, 0.1*x, 0.05*x*y]\"}\n"
                       "probes: {tip: {of: x, at: [1, 1, 1]}, inside: {at: [0.5, 0.5, 0.5]}, "
                       "rate: {of: u', at: [0.25, 0.3, 0.1]}, pull: {of: stress, "
                       "at: [0.5, 0.5, 0.5]}, mises: {of: von_mises, at: [0.7, 0.1, 0.2]}, "
                       "part: {of: kinetic, part: all}}\n");
  check_observed(SOLID "materials: {all: {law: svk, lambda: 1, mu: 1}}\n"
                       "initial: {u': \"[0.2*y, -0.1*z, 0.15*x*z]\"}\n");
}
END_TEST

START_TEST(what_needs_the_whole_mesh_is_refused)
{
  check_refused(WAVE "boundary: fixed\nprobes: {a: {at: [0.5, 0.5, 5]}}\n", DVI_BAD_FILE,
                "the probe 'a' is outside of the mesh");
  check_refused(SOLID "obstacles: {floor: {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, "
                      "restitution: 1}}\nmaterials: {all: {law: svk, lambda: 1, mu: 1}}\n",
                DVI_UNSUPPORTED, "an obstacle needs a whole mesh");
  check_refused(SOLID "materials: {all: {law: svk, lambda: 1, mu: 1}, stiff: {law: svk, lambda: 9, "
                      "mu: 9}}\nloads: {gravity: [0, 0, -1]}\n",
                DVI_BAD_FILE, "no part 'stiff'");
  check_refused(MAXWELL "star: whitney\nboundary: {boundary: pec}\n", DVI_UNSUPPORTED,
                "not diagonal needs a whole mesh, which 3 processes share: take the circumcentric");
  check_refused("mesh: {generator: kuhn, cells: [2, 2]}\nspace: fem:degree=1\nfields: {u: scalar}\n"
                "density: u'^2/2\ninitial: {u: x}\nmethod: midpoint\nstep: 0.1\nuntil: 1\n",
                DVI_UNSUPPORTED,
                ":4:10: several processes share fields of waves, Maxwell's and "
                "solids, and no densities");
  check_refused("coordinates: {q: scalar}\nlagrangian: q'^2/2\ninitial: {q: 1}\nmethod: verlet\n"
                "step: 0.1\nuntil: 1\n",
                DVI_UNSUPPORTED,
                ":2:13: several processes share fields of waves, Maxwell's and "
                "solids on meshes, and this scene has none: run it in one");
}
END_TEST

/* Give 0.1 at each vertex, a failure at that of number *user, and no number at the next one. */
static int term_of(int64_t vertex, double *term, void *user)
{
  const int64_t *at = user;
  *term = vertex == *at + 1 ? (double)NAN : 0.1;
  return vertex == *at;
}

START_TEST(sums_over_a_field_are_rounded_once)
{
  shared_scene s = {.path = NULL};
  dvi_scene *scene = NULL;
  const int cell[] = {0, 5, 9};
  int64_t nowhere = -2, failing = 7, after = 4;
  double sum = -1;
  read_shares(WAVE, &s);
  ck_assert_int_eq(dvi_scene_read(s.path, 0, NULL, &scene, NULL, 0), DVI_OK);
  const dvi_field *field = dvi_scene_field(scene);
  ck_assert_int_eq(dvi_field_sum(field, 3, cell, term_of, &failing, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_field_sum(field, -1, cell, term_of, &failing, &sum), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_field_sum(field, 0, NULL, term_of, &failing, &sum), DVI_CALLBACK_FAILED);
  ck_assert_int_eq(dvi_field_sum(field, 3, cell, term_of, &after, &sum), DVI_NOT_FINITE);
  ck_assert_double_eq(sum, -1);
  ck_assert_int_eq(dvi_field_sum(field, 3, cell, term_of, &nowhere, &sum), DVI_OK);
  ck_assert_double_eq(sum, 0.30000000000000004);
  ck_assert_int_eq(dvi_field_sum(field, 0, NULL, term_of, &nowhere, &sum), DVI_OK);
  ck_assert_double_eq(sum, 6); /* 60 vertices, where one after the other gives 5.999999999999997 */
  dvi_scene_destroy(&scene);
}
END_TEST

START_TEST(a_scene_needs_a_division)
{
  dvi_scene *scene;
  char message[MESSAGE_SIZE];
  const dvi_scene_division none = {.size = sizeof none}, old = {.size = 1, .divide = take};
  ck_assert_int_eq(dvi_scene_read_share("a.yaml", NULL, 0, NULL, &scene, message, MESSAGE_SIZE),
                   DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(scene);
  ck_assert_int_eq(dvi_scene_read_share("a.yaml", &none, 0, NULL, &scene, NULL, 0),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_read_share("a.yaml", &old, 0, NULL, &scene, NULL, 0),
                   DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(scene_share)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, gravity_knows_the_materials_of_the_whole_mesh);
  tcase_add_test(tests, marches_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, what_needs_the_whole_mesh_is_refused);
  tcase_add_test(tests, sums_over_a_field_are_rounded_once);
  tcase_add_test(tests, a_scene_needs_a_division);
}
