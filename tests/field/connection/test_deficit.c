/* Deficits of hinges, and Gauss and Bonnet's theorem. */
#include <dvi/curvature.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field/connection/cell.h"
#include "support/field/complexes.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

#define COUNT(table) (int)(sizeof(table) / sizeof *(table))

/* Lengths of a mesh's edges, each longer by up to `part` of it at random. */
static double *lengths_of(const dvi_mesh *mesh, double part, unsigned long long seed)
{
  const int *end = dvi_mesh_vertices(mesh, 1, NULL), space = dvi_mesh_space(mesh);
  const double *point = dvi_mesh_points(mesh);
  double *length = calloc((size_t)dvi_mesh_count(mesh, 1), sizeof *length);
  ck_assert_ptr_nonnull(length);
  for (int64_t e = 0; e < dvi_mesh_count(mesh, 1); e++) {
    double square = 0;
    for (int l = 0; l < space; l++) {
      const double side = point[end[2 * e] * space + l] - point[end[2 * e + 1] * space + l];
      square += side * side;
    }
    length[e] = sqrt(square) * (1 + part * random_number(&seed));
  }
  return length;
}

/* ---- Gauss and Bonnet ---- */

static const struct {
  const char *name;
  int cells[2];
  int euler;
} surfaces[] = {
    {"icosphere", {1}, 2}, {"icosphere", {3}, 2}, {"torus", {24, 12}, 0},
    {"genus-2", {2}, -2},  {"disk", {5}, 1},      {"annulus", {4, 24}, 0},
};

static dvi_mesh *surface(int i)
{
  return generated(surfaces[i].name,
                   (dvi_generator_options){.size = sizeof(dvi_generator_options),
                                           .cells = {surfaces[i].cells[0], surfaces[i].cells[1]}});
}

/* Angles have an error of some 1e-22. */
START_TEST(deficits_and_turning_sum_to_two_pi_chi)
{
  dvi_gauss_bonnet report;
  dvi_mesh *mesh = surface(_i);
  ck_assert_int_eq(dvi_gauss_bonnet_of(mesh, NULL, &report), DVI_OK);
  ck_assert_int_eq(report.euler, surfaces[_i].euler);
  ck_assert_double_le(fabs(report.difference), 1e-19);
  ck_assert_double_eq_tol(report.deficits + report.turning, 2 * pi * surfaces[_i].euler, 1e-14);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* So have those from lengths. */
START_TEST(any_lengths_have_the_same_sum)
{
  dvi_gauss_bonnet report;
  dvi_mesh *mesh = surface(_i);
  double *length = lengths_of(mesh, 0.2, 7);
  ck_assert_int_eq(dvi_gauss_bonnet_of(mesh, length, &report), DVI_OK);
  ck_assert_double_le(fabs(report.difference), 1e-19);
  free(length);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Five equilateral triangles at each of six vertices: 6 pi/3. */
START_TEST(projective_plane_has_the_curvature_two_pi)
{
  dvi_gauss_bonnet report;
  dvi_mesh *mesh = projective_plane();
  ck_assert_ptr_null(dvi_mesh_orientation(mesh));
  ck_assert_int_eq(dvi_gauss_bonnet_of(mesh, NULL, &report), DVI_OK);
  ck_assert_int_eq(report.euler, 1);
  ck_assert_double_le(fabs(report.difference), 1e-19);
  ck_assert_double_eq_tol(report.least, pi / 3, 1e-15);
  ck_assert_double_eq_tol(report.most, pi / 3, 1e-15);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- regular polytopes ---- */

/* 2 pi - 5 acos(1/3), 2 pi - 3 acos(1/3), 2 pi - 3 acos(1/4). */
static const struct {
  const char *name;
  double deficit;
} polytopes[] = {
    {"cell-600", 0.128388220475713},
    {"simplex-4", 2.590307055157262},
    {"simplex-5", 2.328837092221132},
};

/* The numbers have 15 decimals. The points of the 600-cell are rounded. */
START_TEST(regular_polytopes_have_their_deficits)
{
  dvi_mesh *mesh = generated(polytopes[_i].name,
                             (dvi_generator_options){.size = sizeof(dvi_generator_options)});
  const int64_t hinges = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh) - 2);
  double *deficit = calloc((size_t)hinges, sizeof *deficit), *length = lengths_of(mesh, 0, 1);
  for (int64_t e = 0; e < dvi_mesh_count(mesh, 1); e++) length[e] = 1;
  for (int with_lengths = 0; with_lengths < 2; with_lengths++) {
    ck_assert_int_eq(dvi_hinge_deficits(mesh, with_lengths ? length : NULL, deficit), DVI_OK);
    for (int64_t h = 0; h < hinges; h++)
      ck_assert_double_eq_tol(deficit[h], polytopes[_i].deficit, 2e-15);
  }
  free(deficit);
  free(length);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- flat and thin ---- */

/* The coordinates are multiples of 1/4, and all is flat without a rounding. */
START_TEST(flat_spaces_have_no_deficits)
{
  dvi_generator_options options = {.size = sizeof options, .dimension = 2 + _i};
  for (int a = 0; a < options.dimension; a++) options.cells[a] = 4;
  dvi_mesh *mesh = generated("kuhn-torus", options);
  const int64_t hinges = dvi_mesh_count(mesh, _i);
  double *deficit = calloc((size_t)hinges, sizeof *deficit);
  ck_assert_int_eq(dvi_hinge_deficits(mesh, NULL, deficit), DVI_OK);
  for (int64_t h = 0; h < hinges; h++) ck_assert_double_le(fabs(deficit[h]), 1e-20);
  free(deficit);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A tetrahedron of the height h over a triangle has the angles atan(h/distance) there. */
START_TEST(angles_of_flat_tetrahedra_have_all_digits)
{
  for (int step = 0; step < 6; step++) {
    const double height = pow(0.01, step);
    const double point[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, height};
    const int vertex[] = {0, 1, 2, 3};
    const dvi_mesh_terms terms = {.size = sizeof terms,
                                  .dimension = 3,
                                  .points = 4,
                                  .point = point,
                                  .cells = 1,
                                  .vertex = vertex};
    dvi__laid_cell laid;
    dvi_mesh *mesh = NULL;
    ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
    ck_assert_int_eq(dvi__lay_cell(mesh, NULL, 0, &laid), DVI_OK);
    const double exact = atan2(height, 0.25), slanted = atan2(height, sqrt(0.125));
    ck_assert_double_eq_tol(dvi__laid_angle(&laid, 2, 3).head, exact, 4e-16 * exact);
    ck_assert_double_eq_tol(dvi__laid_angle(&laid, 1, 3).head, exact, 4e-16 * exact);
    ck_assert_double_eq_tol(dvi__laid_angle(&laid, 0, 3).head, slanted, 4e-16 * slanted);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

static dvi_mesh *one_simplex(int n)
{
  double corner[12] = {0};
  int vertex[4] = {0, 1, 2, 3};
  for (int i = 0; i < n; i++) corner[(i + 1) * n + i] = 1;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .points = n + 1,
                                .point = corner,
                                .cells = 1,
                                .vertex = vertex};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  return mesh;
}

/* Two sides of length 1 and one of 2 - 2^-40: the angle between the first two is pi less
 * 2 acos(1 - 2^-41) = 4 asin(2^-21). */
START_TEST(deficits_of_thin_triangles_have_all_digits)
{
  const double length[] = {1, 1, 2 - ldexp(1, -40)}, exact = 4 * asin(ldexp(1, -21));
  double deficit[3];
  dvi_mesh *mesh = one_simplex(2);
  ck_assert_int_eq(dvi_hinge_deficits(mesh, length, deficit), DVI_OK);
  ck_assert_double_eq_tol(deficit[0] / exact, 1, 4e-16);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- refusals ---- */

/* The corners of a rectangle, and a triangle whose sides lie on a line. No facet is inside. */
START_TEST(flat_simplices_are_refused_everywhere)
{
  static const double flat[][6] = {{3, 4, 5, 5, 4, 3}, {1, 2, 1, 1, 1, 1}};
  for (int i = 0; i < 2; i++) {
    double deficit[6];
    dvi_mesh *mesh = one_simplex(3);
    const dvi_connection_options options = {.size = sizeof options, .length = flat[i]};
    dvi_connection *c = NULL;
    ck_assert_int_eq(dvi_hinge_deficits(mesh, flat[i], deficit), DVI_BAD_ARGUMENT);
    check_words("or of a flat one");
    ck_assert_int_eq(dvi_connection_create(mesh, &options, &c), DVI_BAD_ARGUMENT);
    check_words("or of a flat one");
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(lengths_of_no_simplex_are_refused)
{
  dvi_mesh *mesh = generated("simplex-4",
                             (dvi_generator_options){.size = sizeof(dvi_generator_options)});
  double length[10], deficit[10];
  for (int e = 0; e < 10; e++) length[e] = 1;
  length[0] = 3;
  ck_assert_int_eq(dvi_hinge_deficits(mesh, length, deficit), DVI_BAD_ARGUMENT);
  check_words("a face of tetrahedron");
  length[0] = 1.7321; /* above sqrt 3 */
  ck_assert_int_eq(dvi_hinge_deficits(mesh, length, deficit), DVI_BAD_ARGUMENT);
  check_words("are those of no tetrahedron");
  length[0] = -1;
  ck_assert_int_eq(dvi_hinge_deficits(mesh, length, deficit), DVI_BAD_ARGUMENT);
  check_words("lengths are positive");
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(meshes_without_angles_are_refused)
{
  dvi_gauss_bonnet report;
  double deficit[64];
  dvi_mesh *boxes = generated(
      "box", (dvi_generator_options){.size = sizeof(dvi_generator_options), .cells = {2, 2}});
  dvi_mesh *ball = generated(
      "ball", (dvi_generator_options){.size = sizeof(dvi_generator_options), .cells = {1}});
  const double metric[] = {1, -1};
  dvi_mesh *spacetime = random_simplex(2, 2, metric, 3);
  ck_assert_int_eq(dvi_hinge_deficits(boxes, NULL, deficit), DVI_UNSUPPORTED);
  check_words("cells of kind 'rectangle', and triangles, tetrahedra or 4-simplices are needed");
  ck_assert_int_eq(dvi_gauss_bonnet_of(ball, NULL, &report), DVI_UNSUPPORTED);
  check_words("is for triangles");
  ck_assert_int_eq(dvi_hinge_deficits(spacetime, NULL, deficit), DVI_UNSUPPORTED);
  check_words("axis 1 is timelike");
  dvi_mesh_destroy(&boxes);
  dvi_mesh_destroy(&ball);
  dvi_mesh_destroy(&spacetime);
}
END_TEST

SUITE(deficit)
{
  tcase_add_loop_test(tests, deficits_and_turning_sum_to_two_pi_chi, 0, COUNT(surfaces));
  tcase_add_loop_test(tests, any_lengths_have_the_same_sum, 0, COUNT(surfaces));
  tcase_add_test(tests, projective_plane_has_the_curvature_two_pi);
  tcase_add_loop_test(tests, regular_polytopes_have_their_deficits, 0, COUNT(polytopes));
  tcase_add_loop_test(tests, flat_spaces_have_no_deficits, 0, 3);
  tcase_add_test(tests, angles_of_flat_tetrahedra_have_all_digits);
  tcase_add_test(tests, deficits_of_thin_triangles_have_all_digits);
  tcase_add_test(tests, flat_simplices_are_refused_everywhere);
  tcase_add_test(tests, lengths_of_no_simplex_are_refused);
  tcase_add_test(tests, meshes_without_angles_are_refused);
}
