/* Connections: holonomy, lifts, frames, and transport. */
#include <dvi/curvature.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field/connection/spin.h"
#include "support/field/complexes.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* Products of up to 20 rotations, whose entries are rounded once. */
static const double roundoff = 4e-15;

#define COUNT(table) (int)(sizeof(table) / sizeof *(table))

static const struct {
  const char *name;
  int cells[3];
} spaces[] = {
    {"icosphere", {2}}, {"torus", {12, 6}}, {"genus-2", {1}},          {"disk", {3}},
    {"ball", {2}},      {"cell-600", {0}},  {"simplex-4", {0}},        {"cell-16", {0}},
    {"simplex-5", {0}}, {"cross-5", {0}},   {"kuhn-torus", {3, 3, 3}},
};

static dvi_mesh *space(int i)
{
  dvi_generator_options options = {.size = sizeof options};
  memcpy(options.cells, spaces[i].cells, sizeof spaces[i].cells);
  return generated(spaces[i].name, options);
}

static dvi_connection *connect(const dvi_mesh *mesh, const double *length, int spin)
{
  const dvi_connection_options options = {.size = sizeof options, .length = length, .spin = spin};
  dvi_connection *c = NULL;
  ck_assert_msg(dvi_connection_create(mesh, &options, &c) == DVI_OK, "%s", dvi_last_error());
  return c;
}

static char *boundary_of(const dvi_mesh *mesh, int k)
{
  int64_t count;
  const int *cell = dvi_mesh_part_cells(mesh, "boundary", k, &count);
  char *mark = calloc((size_t)dvi_mesh_count(mesh, k), 1);
  for (int64_t i = 0; i < count; i++) mark[cell[i]] = 1;
  return mark;
}

/* Require that holonomy turns the plane normal to each inner hinge by its deficit, modulo 2 pi or 4
 * pi, and fixes the rest. */
static void check_turns(const dvi_connection *c, const double *length, double period)
{
  const dvi_mesh *mesh = dvi_connection_mesh(c);
  const int n = dvi_mesh_dimension(mesh);
  const int64_t hinges = dvi_mesh_count(mesh, n - 2);
  char *on_boundary = boundary_of(mesh, n - 2);
  double *deficit = calloc((size_t)hinges, sizeof *deficit);
  ck_assert_int_eq(dvi_hinge_deficits(mesh, length, deficit), DVI_OK);
  for (int64_t h = 0; h < hinges; h++) {
    double angle, rest;
    if (on_boundary[h]) {
      ck_assert_int_eq(dvi_connection_turn(c, h, &angle, &rest), DVI_BAD_ARGUMENT);
      continue;
    }
    ck_assert_int_eq(dvi_connection_turn(c, h, &angle, &rest), DVI_OK);
    ck_assert_double_le(fabs(remainder(angle - deficit[h], period)), roundoff);
    ck_assert_double_le(rest, roundoff);
  }
  free(on_boundary);
  free(deficit);
}

/* ---- holonomy ---- */

START_TEST(holonomy_turns_by_the_deficit)
{
  dvi_mesh *mesh = space(_i);
  dvi_connection *plain = connect(mesh, NULL, 0), *lifted = connect(mesh, NULL, 1);
  check_turns(plain, NULL, 2 * pi);
  check_turns(lifted, NULL, 4 * pi);
  dvi_connection_destroy(&plain);
  dvi_connection_destroy(&lifted);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Unit lengths, longer by up to a twentieth. No frame in space is needed. */
START_TEST(lengths_alone_make_a_connection)
{
  static const char *const name[] = {"icosphere", "simplex-4", "cell-600", "simplex-5"};
  unsigned long long state = 5;
  dvi_mesh *mesh = generated(name[_i],
                             (dvi_generator_options){.size = sizeof(dvi_generator_options)});
  double *length = calloc((size_t)dvi_mesh_count(mesh, 1), sizeof *length);
  for (int64_t e = 0; e < dvi_mesh_count(mesh, 1); e++)
    length[e] = 1 + 0.05 * random_number(&state);
  dvi_connection *c = connect(mesh, length, 1);
  check_turns(c, length, 4 * pi);
  ck_assert_ptr_null(dvi_connection_frame(c, 0));
  free(length);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* k equilateral triangles have the deficit (6 - k) pi/3, down to -6 pi. SO(2) does not tell it from
 * its remainder modulo 2 pi, and Spin(2) tells multiples of 4 pi from others. */
START_TEST(lifts_tell_full_turns_from_double_ones)
{
  const int count = 3 + _i;
  const double deficit = (6 - count) * pi / 3;
  double length[64], R[4], lift[2];
  dvi_mesh *mesh = fan_mesh(count, length);
  dvi_connection *c = connect(mesh, length, 1);
  ck_assert_int_eq(dvi_connection_holonomy(c, 0, R, lift), DVI_OK);
  ck_assert_double_eq_tol(R[0], cos(deficit), roundoff);
  ck_assert_double_eq_tol(R[2], sin(deficit), roundoff);
  ck_assert_double_eq_tol(lift[0], cos(deficit / 2), roundoff);
  ck_assert_double_eq_tol(lift[1], sin(deficit / 2), roundoff);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Two neighbours in a ring share a facet, and all cells at the hinge are there once. */
START_TEST(rings_go_around_their_hinges)
{
  dvi_mesh *mesh = space(_i);
  const int n = dvi_mesh_dimension(mesh);
  dvi_connection *c = connect(mesh, NULL, 0);
  int64_t all = 0, count;
  double R[16];
  for (int64_t h = 0; h < dvi_mesh_count(mesh, n - 2); h++) {
    const int *ring = dvi_connection_ring(c, h, &count);
    ck_assert_int_eq(dvi_connection_along(c, count, ring, R, NULL), DVI_OK);
    all += count;
  }
  ck_assert_int_eq(all, dvi_mesh_count(mesh, n) * n * (n + 1) / 2);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- one side, and no spin ---- */

/* Around each vertex of the plane with one side there are two sides. */
START_TEST(meshes_with_one_side_have_holonomy_and_no_lift)
{
  const dvi_connection_options with_spin = {.size = sizeof with_spin, .spin = 1};
  dvi_mesh *mesh = projective_plane();
  dvi_connection *c = connect(mesh, NULL, 0), *lifted = NULL;
  double R[4], angle;
  for (int64_t v = 0; v < 6; v++) {
    ck_assert_int_eq(dvi_connection_holonomy(c, v, R, NULL), DVI_OK);
    ck_assert_double_eq_tol(R[0] * R[3] - R[1] * R[2], 1, roundoff);
    ck_assert_int_eq(dvi_connection_turn(c, v, &angle, NULL), DVI_OK);
    ck_assert_double_eq_tol(angle, pi / 3, roundoff);
  }
  ck_assert_int_eq(dvi_connection_create(mesh, &with_spin, &lifted), DVI_UNSUPPORTED);
  check_words("not orientable");
  ck_assert_ptr_null(lifted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The second Stiefel-Whitney class of the complex projective plane does not vanish (Milnor and
 * Stasheff 1974, sec. 14). */
START_TEST(complex_projective_plane_has_no_spin_structure)
{
  const dvi_connection_options with_spin = {.size = sizeof with_spin, .spin = 1};
  dvi_mesh *mesh = complex_projective_plane();
  dvi_connection *c = connect(mesh, NULL, 0), *lifted = NULL;
  check_turns(c, NULL, 2 * pi);
  ck_assert_int_eq(dvi_connection_create(mesh, &with_spin, &lifted), DVI_UNSUPPORTED);
  check_words("no spin structure");
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- frames ---- */

/* Rotations by the products of turns of coordinate planes. */
static double *random_rotations(int n, int64_t count, unsigned long long seed)
{
  double *all = calloc((size_t)(count * n * n), sizeof *all);
  for (int64_t i = 0; i < count; i++) {
    double *R = all + i * n * n, turn[16], old[16];
    dvi__rotation_one(n, R);
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++) {
        dvi__plane plane = {.first = {a == 0, a == 1, a == 2, a == 3},
                            .second = {b == 0, b == 1, b == 2, b == 3}};
        dvi__rotation_turn(n, &plane, 6 * random_number(&seed), turn);
        memcpy(old, R, (size_t)(n * n) * sizeof *old);
        dvi__rotation_times(n, turn, old, R);
      }
  }
  return all;
}

static double distance(int count, const double *a, const double *b)
{
  double most = 0;
  for (int i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* Vectors in space stay as they are when components and frames change. */
START_TEST(gauge_conjugates_holonomies)
{
  static const char *const name[] = {"icosphere", "simplex-4", "simplex-5"};
  const int n = 2 + _i;
  dvi_mesh *mesh = generated(name[_i],
                             (dvi_generator_options){.size = sizeof(dvi_generator_options)});
  dvi_connection *c = connect(mesh, NULL, 1), *changed = NULL, *twice = NULL;
  double *g = random_rotations(n, dvi_mesh_count(mesh, n), 11);
  ck_assert_int_eq(dvi_connection_gauge(c, g, &changed), DVI_OK);
  ck_assert_int_eq(dvi_connection_gauge(changed, g, &twice), DVI_OK);
  check_turns(changed, NULL, 4 * pi);
  check_turns(twice, NULL, 4 * pi);
  for (int64_t h = 0; h < dvi_mesh_count(mesh, n - 2); h++) {
    double H[16], other[16], half[16], wanted[16], inverse[16];
    const double *of_first = g + dvi_connection_ring(c, h, NULL)[0] * n * n;
    ck_assert_int_eq(dvi_connection_holonomy(c, h, H, NULL), DVI_OK);
    ck_assert_int_eq(dvi_connection_holonomy(changed, h, other, NULL), DVI_OK);
    dvi__rotation_inverse(n, of_first, inverse);
    dvi__rotation_times(n, H, inverse, half);
    dvi__rotation_times(n, of_first, half, wanted);
    ck_assert_double_le(distance(n * n, other, wanted), roundoff);
  }
  free(g);
  dvi_connection_destroy(&c);
  dvi_connection_destroy(&changed);
  dvi_connection_destroy(&twice);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(frames_are_orthonormal_and_coherent)
{
  dvi_mesh *mesh = space(_i);
  const int n = dvi_mesh_dimension(mesh), wide = dvi_mesh_space(mesh);
  dvi_connection *c = connect(mesh, NULL, 0);
  for (int64_t cell = 0; cell < dvi_mesh_count(mesh, n); cell++) {
    const double *frame = dvi_connection_frame(c, cell);
    for (int i = 0; i < n; i++)
      for (int j = 0; j <= i; j++) {
        double sum = 0;
        for (int l = 0; l < wide; l++) sum += frame[i * wide + l] * frame[j * wide + l];
        ck_assert_double_eq_tol(sum, i == j, 1e-15);
      }
  }
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- transport ---- */

/* In the plane a constant vector stays constant, whichever way it goes. */
START_TEST(flat_transport_keeps_vectors_of_space)
{
  dvi_mesh *mesh = generated(
      "disk", (dvi_generator_options){.size = sizeof(dvi_generator_options), .cells = {4}});
  dvi_connection *c = connect(mesh, NULL, 0);
  int64_t count;
  const int *ring = dvi_connection_ring(c, 0, &count);
  const double *first = dvi_connection_frame(c, ring[0]);
  const double start[2] = {0.6 * first[0] + 0.8 * first[1], 0.6 * first[2] + 0.8 * first[3]};
  double moved[64];
  ck_assert_int_le((int)count, 32);
  ck_assert_int_eq(dvi_connection_transport(c, count, ring, start, moved), DVI_OK);
  for (int64_t i = 0; i < count; i++) {
    const double *frame = dvi_connection_frame(c, ring[i]);
    ck_assert_double_eq_tol(moved[2 * i] * frame[0] + moved[2 * i + 1] * frame[2], 0.6, roundoff);
    ck_assert_double_eq_tol(moved[2 * i] * frame[1] + moved[2 * i + 1] * frame[3], 0.8, roundoff);
  }
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* There and back again. */
START_TEST(ways_back_undo_ways)
{
  dvi_mesh *mesh = space(_i);
  const int n = dvi_mesh_dimension(mesh);
  dvi_connection *c = connect(mesh, NULL, 1);
  int64_t count;
  int path[128];
  double R[16], lift[8], one[16];
  const int *ring = dvi_connection_ring(c, dvi_mesh_count(mesh, n - 2) / 2, &count);
  for (int64_t i = 0; i < count; i++) path[i] = path[2 * count - 1 - i] = ring[i];
  memmove(path + count, path + count + 1, (size_t)(count - 1) * sizeof *path);
  ck_assert_int_eq(dvi_connection_along(c, 2 * count - 1, path, R, lift), DVI_OK);
  dvi__rotation_one(n, one);
  ck_assert_double_le(distance(n * n, R, one), roundoff);
  dvi__spin_one(n, one);
  ck_assert_double_le(distance(dvi__spin_size(n), lift, one), roundoff);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- own connections ---- */

START_TEST(own_rotations_are_those_that_paths_multiply)
{
  dvi_mesh *mesh = generated("simplex-5",
                             (dvi_generator_options){.size = sizeof(dvi_generator_options)});
  double *own = random_rotations(4, dvi_mesh_count(mesh, 3), 3), R[16];
  const dvi_connection_options options = {.size = sizeof options, .rotation = own};
  dvi_connection *c = NULL;
  ck_assert_int_eq(dvi_connection_create(mesh, &options, &c), DVI_OK);
  for (int first = 0; first < 6; first++)
    for (int second = first + 1; second < 6; second++) {
      const int path[] = {first, second};
      int seen = 0;
      ck_assert_int_eq(dvi_connection_along(c, 2, path, R, NULL), DVI_OK);
      for (int64_t f = 0; f < dvi_mesh_count(mesh, 3); f++)
        seen += distance(16, R, own + 16 * f) == 0;
      ck_assert_int_eq(seen, 1);
    }
  dvi_connection_destroy(&c);
  own[5] += 1e-7;
  ck_assert_int_eq(dvi_connection_create(mesh, &options, &c), DVI_BAD_ARGUMENT);
  check_words("no rotation");
  free(own);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The plane with one side has no frames without a side, but own rotations may be those of a
 * bundle that has. */
START_TEST(own_rotations_may_have_a_lift_on_one_side)
{
  dvi_mesh *mesh = projective_plane();
  double *own = random_rotations(2, dvi_mesh_count(mesh, 1), 3);
  for (int64_t e = 0; e < dvi_mesh_count(mesh, 1); e++) dvi__rotation_one(2, own + 4 * e);
  const dvi_connection_options options = {.size = sizeof options, .rotation = own, .spin = 1};
  dvi_connection *c = NULL;
  ck_assert_int_eq(dvi_connection_create(mesh, &options, &c), DVI_OK);
  for (int64_t v = 0; v < 6; v++) {
    double lift[2];
    ck_assert_int_eq(dvi_connection_holonomy(c, v, NULL, lift), DVI_OK);
    ck_assert_double_eq_tol(lift[0], 1, roundoff);
  }
  dvi_connection_destroy(&c);
  for (int i = 2; i < 4; i++) own[i] = -own[i];
  ck_assert_int_eq(dvi_connection_create(mesh, &options, &c), DVI_UNSUPPORTED);
  check_words("turns right into left");
  free(own);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- refusals ---- */

START_TEST(vectors_that_are_no_numbers_are_refused)
{
  dvi_mesh *mesh = space(0);
  dvi_connection *c = connect(mesh, NULL, 0);
  const int path[] = {0};
  double moved[2], *component = calloc(2 * (size_t)dvi_mesh_count(mesh, 2), sizeof *component),
                   *vector = calloc(3 * (size_t)dvi_mesh_count(mesh, 2), sizeof *vector);
  ck_assert_int_eq(dvi_connection_transport(c, 1, path, (const double[]){1, NAN}, moved),
                   DVI_BAD_ARGUMENT);
  check_words("component 1 of the vectors is nan");
  ck_assert_int_eq(dvi_connection_transport(c, 1, path, (const double[]){1e301, 0}, moved),
                   DVI_BAD_ARGUMENT);
  check_words("component 0 of the vectors is 1e+301, and 1e+300 is the largest size");
  component[7] = -INFINITY;
  ck_assert_int_eq(dvi_connection_vectors(c, component, vector), DVI_BAD_ARGUMENT);
  check_words("component 7 of the vectors is -inf");
  free(component);
  free(vector);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(paths_that_jump_are_refused)
{
  dvi_mesh *mesh = space(0);
  dvi_connection *c = connect(mesh, NULL, 0);
  const int jump[] = {0, 100}, beyond[] = {0, 4000};
  double R[4], lift[2];
  ck_assert_int_eq(dvi_connection_along(c, 2, jump, R, NULL), DVI_BAD_ARGUMENT);
  check_words("which share no edge");
  ck_assert_int_eq(dvi_connection_along(c, 2, beyond, R, NULL), DVI_BAD_ARGUMENT);
  check_words("the path has cell 4000");
  ck_assert_int_eq(dvi_connection_along(c, 1, jump, R, lift), DVI_BAD_STATE);
  check_words("no lift");
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Two triangles that share a vertex alone. */
START_TEST(pinched_hinges_are_refused)
{
  const double point[] = {0, 0, 1, 0, 0, 1, -1, 0, 0, -1};
  const int vertex[] = {0, 1, 2, 0, 3, 4};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = 5,
                                .point = point,
                                .cells = 2,
                                .vertex = vertex};
  dvi_mesh *mesh = NULL;
  dvi_connection *c = NULL;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_connection_create(mesh, NULL, &c), DVI_BAD_ARGUMENT);
  check_words("vertex 0");
  check_words("do not hang together");
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(connection)
{
  tcase_add_loop_test(tests, holonomy_turns_by_the_deficit, 0, COUNT(spaces));
  tcase_add_loop_test(tests, lengths_alone_make_a_connection, 0, 4);
  tcase_add_loop_test(tests, lifts_tell_full_turns_from_double_ones, 0, 22);
  tcase_add_loop_test(tests, rings_go_around_their_hinges, 0, COUNT(spaces));
  tcase_add_test(tests, meshes_with_one_side_have_holonomy_and_no_lift);
  tcase_add_test(tests, complex_projective_plane_has_no_spin_structure);
  tcase_add_loop_test(tests, gauge_conjugates_holonomies, 0, 3);
  tcase_add_loop_test(tests, frames_are_orthonormal_and_coherent, 0, COUNT(spaces));
  tcase_add_test(tests, flat_transport_keeps_vectors_of_space);
  tcase_add_loop_test(tests, ways_back_undo_ways, 0, COUNT(spaces));
  tcase_add_test(tests, own_rotations_are_those_that_paths_multiply);
  tcase_add_test(tests, own_rotations_may_have_a_lift_on_one_side);
  tcase_add_test(tests, vectors_that_are_no_numbers_are_refused);
  tcase_add_test(tests, paths_that_jump_are_refused);
  tcase_add_test(tests, pinched_hinges_are_refused);
}
