/* Trivial connections with given singularities, and fields of directions. */
#include <dvi/curvature.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field/connection/connection.h"
#include "support/field/complexes.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A factor's roundings, which the condition of some thousands enlarges. */
static const double roundoff = 2e-13;

#define COUNT(table) (int)(sizeof(table) / sizeof *(table))

static dvi_mesh *surface(const char *name, int first, int second)
{
  return generated(name, (dvi_generator_options){.size = sizeof(dvi_generator_options),
                                                 .cells = {first, second}});
}

static dvi_connection *connect(const dvi_mesh *mesh)
{
  dvi_connection *c = NULL;
  ck_assert_msg(dvi_connection_create(mesh, NULL, &c) == DVI_OK, "%s", dvi_last_error());
  return c;
}

static dvi_connection *adjust(const dvi_connection *c, const dvi_adjust_options *options)
{
  dvi_connection *adjusted = NULL;
  ck_assert_msg(dvi_connection_adjust(c, options, &adjusted) == DVI_OK, "%s", dvi_last_error());
  return adjusted;
}

/* The angle of a rotation of the plane along a path. */
static double angle_along(const dvi_connection *c, int64_t count, const int *cell)
{
  double R[4];
  ck_assert_int_eq(dvi_connection_along(c, count, cell, R, NULL), DVI_OK);
  return atan2(R[2], R[0]);
}

/* ---- holonomy ---- */

static const struct {
  const char *name;
  int cells[2], symmetry, count;
  dvi_singularity at[8];
} fields[] = {
    {"icosphere", {2}, 1, 1, {{7, 2}}},
    {"icosphere", {2}, 1, 2, {{0, 1}, {100, 1}}},
    {"icosphere", {2}, 1, 3, {{0, 1}, {50, 2}, {100, -1}}},
    {"icosphere", {2}, 2, 4, {{0, 0.5}, {30, 0.5}, {60, 0.5}, {90, 0.5}}},
    {"icosphere",
     {1},
     4,
     8,
     {{0, .25}, {5, .25}, {10, .25}, {15, .25}, {20, .25}, {25, .25}, {30, .25}, {35, .25}}},
    {"torus", {12, 6}, 1, 0, {{0, 0}}},
    {"torus", {12, 6}, 1, 2, {{3, 1}, {40, -1}}},
    {"genus-2", {1}, 1, 2, {{0, -1}, {20, -1}}},
    {"genus-2", {2}, 1, 1, {{11, -2}}},
    {"disk", {4}, 1, 1, {{0, 1}}},
    {"disk", {4}, 1, 2, {{0, 2}, {60, -1}}},
    {"annulus", {4, 24}, 1, 0, {{0, 0}}},
    {"annulus", {4, 24}, 1, 2, {{0, 1}, {119, -1}}},
};

static double index_of(int i, int64_t vertex)
{
  for (int k = 0; k < fields[i].count; k++)
    if (fields[i].at[k].vertex == vertex) return fields[i].at[k].index;
  return 0;
}

static void check_vertices(const dvi_connection *c, int i)
{
  const dvi_mesh *mesh = dvi_connection_mesh(c);
  for (int64_t v = 0; v < dvi_mesh_count(mesh, 0); v++) {
    double angle;
    if (dvi_connection_turn(c, v, &angle, NULL) != DVI_OK) continue;
    ck_assert_double_le(fabs(remainder(angle - 2 * pi * index_of(i, v), 2 * pi)), roundoff);
  }
}

/* Directions that are transported through any facet are those behind it. */
START_TEST(trivial_connections_make_one_field)
{
  dvi_mesh *mesh = surface(fields[_i].name, fields[_i].cells[0], fields[_i].cells[1]);
  dvi_connection *c = connect(mesh);
  const dvi_adjust_options options = {.size = sizeof options,
                                      .singularity = fields[_i].at,
                                      .singularities = fields[_i].count,
                                      .symmetry = fields[_i].symmetry};
  dvi_connection *adjusted = adjust(c, &options);
  double *direction = calloc(2 * (size_t)dvi_mesh_count(mesh, 2), sizeof *direction), mismatch;
  check_vertices(adjusted, _i);
  ck_assert_int_eq(
      dvi_connection_directions(adjusted, 3, 0.7, fields[_i].symmetry, direction, &mismatch),
      DVI_OK);
  ck_assert_double_le(mismatch, 20 * roundoff);
  ck_assert_double_eq_tol(direction[6], cos(0.7), 1e-15);
  free(direction);
  dvi_connection_destroy(&adjusted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Twice the genus. */
START_TEST(loops_are_closed_and_independent_of_vertices)
{
  static const struct {
    const char *name;
    int cells[2], loops;
  } of[] = {{"icosphere", {1}, 0}, {"torus", {12, 6}, 2},   {"genus-2", {2}, 4},
            {"disk", {3}, 0},      {"annulus", {3, 12}, 0}, {"ball", {1}, 0}};
  for (int i = 0; i < COUNT(of); i++) {
    dvi_mesh *mesh = surface(of[i].name, of[i].cells[0], of[i].cells[1]);
    dvi_connection *c = connect(mesh);
    ck_assert_int_eq(dvi_connection_loops(c), of[i].loops);
    for (int l = 0; l < of[i].loops; l++) {
      int64_t count;
      const int *loop = dvi_connection_loop(c, l, &count);
      ck_assert_int_ge((int)count, 4);
      ck_assert_int_eq(loop[0], loop[count - 1]);
      (void)angle_along(c, count, loop);
    }
    dvi_connection_destroy(&c);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(loops_turn_as_they_are_told)
{
  const double turn[] = {0.3, -1.1, 2, 0.5};
  const dvi_singularity at = {11, -2};
  const dvi_adjust_options options = {
      .size = sizeof options, .singularity = &at, .singularities = 1, .turn = turn};
  dvi_mesh *mesh = surface("genus-2", 2, 0);
  dvi_connection *c = connect(mesh), *adjusted = adjust(c, &options);
  for (int l = 0; l < 4; l++) {
    int64_t count;
    const int *loop = dvi_connection_loop(adjusted, l, &count);
    ck_assert_double_eq_tol(angle_along(adjusted, count, loop), turn[l], 20 * roundoff);
  }
  dvi_connection_destroy(&adjusted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- least adjustment ---- */

/* The weight (cot a + cot b)/2 of an edge, from points in space. */
static double weight_of(const dvi_mesh *mesh, int a, int b)
{
  const int *vertex = dvi_mesh_vertices(mesh, 2, NULL);
  const double *x = dvi_mesh_points(mesh);
  double sum = 0;
  for (int64_t c = 0; c < dvi_mesh_count(mesh, 2); c++) {
    int other = -1, shared = 0;
    for (int i = 0; i < 3; i++) {
      const int v = vertex[3 * c + i];
      if (v == a || v == b)
        shared++;
      else
        other = v;
    }
    if (shared < 2) continue;
    double uu = 0, uv = 0, vv = 0;
    for (int l = 0; l < 3; l++) {
      const double u = x[3 * a + l] - x[3 * other + l], v = x[3 * b + l] - x[3 * other + l];
      uu += u * u;
      uv += u * v;
      vv += v * v;
    }
    sum += 0.5 * uv / sqrt(uu * vv - uv * uv);
  }
  return sum;
}

/* The adjustment through an edge from the first to the second cell, divided by the weight. */
static double slope_between(const dvi_connection *c, const dvi_connection *adjusted, int from,
                            int to, double weight)
{
  const int path[] = {from, to};
  return remainder(angle_along(adjusted, 2, path) - angle_along(c, 2, path), 2 * pi) / weight;
}

/* Adjustments that change no holonomy are differences of a function of the triangles. The least sum
 * of phi^2/w is orthogonal to all of them: phi/w sums to zero around each triangle. */
START_TEST(adjustments_are_the_least)
{
  const dvi_singularity at[] = {{5, 1}, {30, -1}};
  const dvi_adjust_options options = {
      .size = sizeof options, .singularity = at, .singularities = 2};
  dvi_mesh *mesh = surface("torus", 8, 6);
  dvi_connection *c = connect(mesh), *adjusted = adjust(c, &options);
  const int *vertex = dvi_mesh_vertices(mesh, 2, NULL);
  const int64_t cells = dvi_mesh_count(mesh, 2);
  for (int64_t s = 0; s < cells; s++) {
    double sum = 0, size = 0;
    for (int64_t t = 0; t < cells; t++) {
      int shared[3], count = 0;
      for (int i = 0; i < 3 && t != s; i++)
        for (int j = 0; j < 3; j++)
          if (vertex[3 * s + i] == vertex[3 * t + j]) shared[count++] = vertex[3 * s + i];
      if (count < 2) continue;
      const double slope = slope_between(c, adjusted, (int)s, (int)t,
                                         weight_of(mesh, shared[0], shared[1]));
      sum += slope;
      size += fabs(slope);
    }
    ck_assert_double_le(fabs(sum), 1e-12 * (1 + size));
  }
  dvi_connection_destroy(&adjusted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* In the plane nothing is to be adjusted, if the field turns as little as the boundary asks. */
START_TEST(constant_fields_of_the_plane_need_no_adjustment)
{
  dvi_mesh *mesh = surface("disk", 4, 0);
  const int64_t rim = dvi_mesh_count(mesh, 0) - 1;
  const dvi_singularity at = {rim, 1};
  const dvi_adjust_options options = {
      .size = sizeof options, .singularity = &at, .singularities = 1};
  dvi_connection *c = connect(mesh), *adjusted = adjust(c, &options);
  double direction[2 * 96], vector[2 * 96];
  ck_assert_int_eq(dvi_mesh_count(mesh, 2), 96);
  ck_assert_int_eq(dvi_connection_directions(adjusted, 0, 0.4, 1, direction, NULL), DVI_OK);
  ck_assert_int_eq(dvi_connection_vectors(adjusted, direction, vector), DVI_OK);
  for (int i = 2; i < 2 * 96; i++) ck_assert_double_eq_tol(vector[i], vector[i - 2], 1e-13);
  dvi_connection_destroy(&adjusted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A field without turns along loops costs more than one whose loops turn as they like. */
START_TEST(loops_may_stay_as_they_come)
{
  const dvi_adjust_options options = {.size = sizeof options, .is_least = 1};
  dvi_mesh *mesh = surface("torus", 12, 6);
  dvi_connection *c = connect(mesh), *free_loops = adjust(c, &options);
  double angle;
  for (int64_t v = 0; v < dvi_mesh_count(mesh, 0); v++) {
    ck_assert_int_eq(dvi_connection_turn(free_loops, v, &angle, NULL), DVI_OK);
    ck_assert_double_le(fabs(angle), roundoff);
  }
  dvi_connection_destroy(&free_loops);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- random surfaces ---- */

/* Lengths of one side and a fifth more at most are those of triangles. */
static dvi_connection *random_connection(const dvi_mesh *mesh, unsigned long long *state)
{
  const int64_t edges = dvi_mesh_count(mesh, 1);
  double *length = calloc((size_t)edges, sizeof *length);
  for (int64_t e = 0; e < edges; e++) length[e] = 1 + 0.2 * random_number(state);
  const dvi_connection_options options = {.size = sizeof options, .length = length};
  dvi_connection *c = NULL;
  ck_assert_msg(dvi_connection_create(mesh, &options, &c) == DVI_OK, "%s", dvi_last_error());
  free(length);
  return c;
}

/* Three different vertices, with indices in N-ths. */
static void random_singularities(const dvi_mesh *mesh, int N, unsigned long long *state,
                                 dvi_singularity at[3])
{
  const int64_t vertices = dvi_mesh_count(mesh, 0),
                euler = vertices - dvi_mesh_count(mesh, 1) + dvi_mesh_count(mesh, 2);
  const int part = (int)vertices / 3;
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    at[i].vertex = i * part + (int)(part * random_number(state));
    at[i].index = (floor(7 * random_number(state)) - 3) / N;
    sum += i < 2 ? at[i].index : 0;
  }
  at[2].index = (double)euler - sum;
}

/* Genus 0, 1 and 2, with four symmetries. Indices that do not add up are refused. */
START_TEST(random_surfaces_have_fields_if_their_indices_add_up)
{
  static const char *const name[] = {"icosphere", "torus", "genus-2"};
  unsigned long long state = (unsigned)_i + 3;
  dvi_mesh *mesh = surface(name[_i], _i == 1 ? 9 : 1, _i == 1 ? 8 : 0);
  double *direction = calloc(2 * (size_t)dvi_mesh_count(mesh, 2), sizeof *direction), mismatch;
  for (int N = 1; N <= 4; N++) {
    dvi_singularity at[3];
    dvi_connection *c = random_connection(mesh, &state);
    random_singularities(mesh, N, &state, at);
    const dvi_adjust_options options = {
        .size = sizeof options, .singularity = at, .singularities = 3, .symmetry = N};
    dvi_connection *adjusted = adjust(c, &options), *none = NULL;
    ck_assert_int_eq(dvi_connection_directions(adjusted, 0, 1, N, direction, &mismatch), DVI_OK);
    ck_assert_double_le(mismatch, 20 * roundoff);
    at[1].index += 1.0 / N;
    ck_assert_int_eq(dvi_connection_adjust(c, &options, &none), DVI_BAD_ARGUMENT);
    check_words("the indices sum to");
    dvi_connection_destroy(&adjusted);
    dvi_connection_destroy(&c);
  }
  free(direction);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- lifts ---- */

/* Lift the rotations of a trivial connection of the icosphere with singularities of one index. */
static dvi_status lift(double index, int count, int symmetry, dvi_connection **lifted)
{
  dvi_singularity at[4];
  for (int i = 0; i < count; i++) at[i] = (dvi_singularity){.vertex = 30 * i, .index = index};
  const dvi_adjust_options field = {
      .size = sizeof field, .singularity = at, .singularities = count, .symmetry = symmetry};
  dvi_mesh *mesh = surface("icosphere", 2, 0);
  dvi_connection *c = connect(mesh), *adjusted = adjust(c, &field);
  const dvi_connection_options options = {
      .size = sizeof options, .rotation = adjusted->rotation, .spin = 1};
  const dvi_status status = dvi_connection_create(mesh, &options, lifted);
  dvi_connection_destroy(&adjusted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
  return status;
}

/* A half turn may be lifted to pi or to -pi, all else to 0. */
START_TEST(half_turns_of_own_rotations_are_lifted_to_either_sense)
{
  dvi_connection *lifted = NULL;
  ck_assert_int_eq(lift(0.5, 4, 2, &lifted), DVI_OK);
  for (int v = 0; v < 162; v++) {
    double angle;
    ck_assert_int_eq(dvi_connection_turn(lifted, v, &angle, NULL), DVI_OK);
    ck_assert_double_eq_tol(fabs(angle), v % 30 == 0 && v < 120 ? pi : 0, roundoff);
  }
  dvi_connection_destroy(&lifted);
}
END_TEST

/* Three turns by -2 pi/3 on a sphere have the lift -1 together, although the sphere has a spin
 * structure. */
START_TEST(own_rotations_whose_shorter_turns_contradict_have_no_lift)
{
  dvi_connection *lifted = NULL;
  ck_assert_int_eq(lift(2.0 / 3, 3, 3, &lifted), DVI_UNSUPPORTED);
  check_words("the own rotations have no lift that turns by the shorter way");
  ck_assert_ptr_null(lifted);
}
END_TEST

/* ---- refusals ---- */

static void refuse(const dvi_connection *c, int count, const dvi_singularity *at, dvi_status status,
                   const char *words)
{
  const dvi_adjust_options options = {
      .size = sizeof options, .singularity = at, .singularities = count};
  dvi_connection *adjusted = NULL;
  ck_assert_int_eq(dvi_connection_adjust(c, &options, &adjusted), status);
  check_words(words);
  ck_assert_ptr_null(adjusted);
}

START_TEST(indices_that_no_field_has_are_refused)
{
  dvi_mesh *sphere = surface("icosphere", 1, 0), *annulus = surface("annulus", 3, 12),
           *one_sided = projective_plane(), *ball = surface("ball", 1, 0);
  dvi_connection *c = connect(sphere), *ring = connect(annulus), *plane = connect(one_sided),
                 *solid = connect(ball);
  const dvi_singularity one = {4, 1}, beyond = {4000, 2}, broken = {4, 1.5},
                        twice[] = {{4, 1}, {4, 1}}, rims[] = {{0, 1}, {1, -1}}, none = {4, NAN},
                        third = {4, 1.0 / 3}, odd = {4, 0.123}, large[] = {{3, 20002}, {4, -20000}};
  refuse(c, 0, NULL, DVI_BAD_ARGUMENT, "the indices sum to 0, and on this surface they sum to 2");
  refuse(c, 1, &one, DVI_BAD_ARGUMENT, "the indices sum to 1");
  refuse(c, 1, &beyond, DVI_BAD_ARGUMENT, "index 2 at vertex 4000");
  refuse(
      c, 1, &broken, DVI_BAD_ARGUMENT,
      "index 1.5 at vertex 4 is no multiple of 1/1, as fields of symmetry 1 have them; fields of "
      "symmetry 2 have such an index");
  refuse(c, 1, &third, DVI_BAD_ARGUMENT, "fields of symmetry 3 have such an index");
  refuse(c, 1, &odd, DVI_BAD_ARGUMENT, "index 0.123 at vertex 4 is no multiple of 1/1");
  refuse(c, 1, &none, DVI_BAD_ARGUMENT, "index nan at vertex 4, and indices are -10000 to 10000");
  refuse(c, 2, large, DVI_BAD_ARGUMENT, "index 20002 at vertex 3");
  refuse(c, 2, twice, DVI_BAD_ARGUMENT, "vertices 4 and 4 have indices, and are the same");
  refuse(ring, 2, rims, DVI_BAD_ARGUMENT, "are on the same boundary");
  refuse(plane, 1, &one, DVI_UNSUPPORTED, "is not orientable");
  refuse(solid, 1, &one, DVI_UNSUPPORTED, "cells of another dimension");
  dvi_connection_destroy(&c);
  dvi_connection_destroy(&ring);
  dvi_connection_destroy(&plane);
  dvi_connection_destroy(&solid);
  dvi_mesh_destroy(&sphere);
  dvi_mesh_destroy(&annulus);
  dvi_mesh_destroy(&one_sided);
  dvi_mesh_destroy(&ball);
}
END_TEST

START_TEST(turns_that_are_not_finite_are_refused)
{
  const double turn[] = {0.5, INFINITY}, none[] = {NAN, 0};
  dvi_adjust_options options = {.size = sizeof options, .turn = turn};
  dvi_mesh *mesh = surface("torus", 12, 6);
  dvi_connection *c = connect(mesh), *adjusted = NULL;
  ck_assert_int_eq(dvi_connection_adjust(c, &options, &adjusted), DVI_BAD_ARGUMENT);
  check_words("turn inf along loop 1");
  options.turn = none;
  ck_assert_int_eq(dvi_connection_adjust(c, &options, &adjusted), DVI_BAD_ARGUMENT);
  check_words("turn nan along loop 0");
  ck_assert_ptr_null(adjusted);
  dvi_connection_destroy(&c);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(directions)
{
  tcase_add_loop_test(tests, trivial_connections_make_one_field, 0, COUNT(fields));
  tcase_add_test(tests, loops_are_closed_and_independent_of_vertices);
  tcase_add_test(tests, loops_turn_as_they_are_told);
  tcase_add_test(tests, adjustments_are_the_least);
  tcase_add_test(tests, constant_fields_of_the_plane_need_no_adjustment);
  tcase_add_test(tests, loops_may_stay_as_they_come);
  tcase_add_loop_test(tests, random_surfaces_have_fields_if_their_indices_add_up, 0, 3);
  tcase_add_test(tests, half_turns_of_own_rotations_are_lifted_to_either_sense);
  tcase_add_test(tests, own_rotations_whose_shorter_turns_contradict_have_no_lift);
  tcase_add_test(tests, indices_that_no_field_has_are_refused);
  tcase_add_test(tests, turns_that_are_not_finite_are_refused);
}
