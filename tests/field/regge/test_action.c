/* The action of complexes of simplices: digits, gradients, Hessians, boundaries, refusals. */
#include <dvi/regge.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A complex of a generated mesh. */
static dvi_regge *complex_of(const char *name, const dvi_generator_options *options, double lambda)
{
  dvi_mesh *mesh = NULL;
  dvi_regge *regge = NULL;
  ck_assert_int_eq(dvi_mesh_generate(name, options, &mesh), DVI_OK);
  const dvi_regge_terms terms = {.size = sizeof terms, .mesh = mesh, .lambda = lambda};
  ck_assert_int_eq(dvi_regge_create(&terms, &regge), DVI_OK);
  dvi_mesh_destroy(&mesh);
  return regge;
}

static int64_t edges_of(const dvi_regge *regge)
{
  return dvi_mesh_count(dvi_regge_mesh(regge), 1);
}

/* The lengths of the points, changed by up to `part` of them. */
static double *lengths_of(const dvi_regge *regge, double part)
{
  const int64_t edges = edges_of(regge);
  double *length = calloc((size_t)edges, sizeof *length);
  ck_assert_int_eq(dvi_regge_lengths(regge, length), DVI_OK);
  for (int64_t e = 0; e < edges; e++) length[e] *= 1 + part * sin(3.1 * (double)(e * e) + 1);
  return length;
}

static dvi_regge_measures measures_of(const char *name)
{
  dvi_regge *regge = complex_of(name, NULL, 0);
  double *length = lengths_of(regge, 0);
  dvi_regge_measures m;
  ck_assert_int_eq(dvi_regge_measure(regge, length, &m), DVI_OK);
  free(length);
  dvi_regge_destroy(&regge);
  return m;
}

/* Hinges of a regular complex with k cells of dimension n at each have 2 pi - k arccos(1/n). */
static void check_regular(const char *name, int n, int k, int64_t hinges, double volume)
{
  const dvi_regge_measures m = measures_of(name);
  const double deficit = 2 * pi - k * acos(1.0 / n), size = n == 3 ? 1 : sqrt(3) / 4;
  ck_assert_int_eq(m.hinges, hinges);
  ck_assert_int_eq(m.boundary_hinges, 0);
  ck_assert_double_eq_tol(m.deficit_min, deficit, 2e-15);
  ck_assert_double_eq_tol(m.deficit_max, deficit, 2e-15);
  ck_assert_double_eq_tol(m.action, (double)hinges * size * deficit, 1e-14 * m.action + 1e-12);
  ck_assert_double_eq_tol(m.volume / volume, 1, 1e-14);
  ck_assert_double_le(m.schlaefli, 1e-15);
}

START_TEST(regular_polytopes_have_their_deficits_and_actions)
{
  const double tetrahedron = sqrt(2) / 12, simplex = sqrt(5) / 96;
  check_regular("simplex-4", 3, 3, 10, 5 * tetrahedron);
  check_regular("cell-16", 3, 4, 24, 16 * tetrahedron);
  check_regular("cell-600", 3, 5, 720, 600 * tetrahedron);
  check_regular("simplex-5", 4, 3, 20, 6 * simplex);
  check_regular("cross-5", 4, 4, 80, 32 * simplex);
}
END_TEST

/* The digits of mpmath. An angle has an error of half a rounding, 1e-16, and the 600-cell has 3600
 * angles. */
START_TEST(actions_of_unit_edges_have_their_digits)
{
  static const struct {
    const char *name;
    double deficit, action;
  } expected[] = {{"cell-600", 0.128388220475713, 92.439518742513},
                  {"simplex-4", 2.590307055157262, 25.903070551573},
                  {"simplex-5", 2.328837092221132, 20.168320831390}};
  for (int i = 0; i < 3; i++) {
    const dvi_regge_measures m = measures_of(expected[i].name);
    ck_assert_double_eq_tol(m.deficit_min, expected[i].deficit, 2e-15);
    ck_assert_double_eq_tol(m.action, expected[i].action, i == 0 ? 1e-12 : 5e-13);
  }
}
END_TEST

/* 1/2 int R of a 3-sphere of radius r is 6 pi^2 r. The 600-cell of the same volume is within
 * 2 %. */
START_TEST(the_action_is_half_of_the_integral_of_the_scalar_curvature)
{
  const dvi_regge_measures m = measures_of("cell-600");
  const double radius = cbrt(m.volume / (2 * pi * pi));
  ck_assert_double_eq_tol(m.action / (6 * pi * pi * radius), 1, 0.025);
}
END_TEST

/* In three dimensions, without Lambda, dS/dl_e = eps_e. */
START_TEST(gradients_in_three_dimensions_are_the_deficits)
{
  dvi_regge *regge = complex_of("cell-600", NULL, 0);
  double *length = lengths_of(regge, 0.02), gradient[720], deficit[720];
  ck_assert_int_eq(dvi_regge_action(regge, length, NULL, gradient), DVI_OK);
  ck_assert_int_eq(dvi_regge_hinges(regge, length, NULL, deficit), DVI_OK);
  for (int e = 0; e < 720; e++) ck_assert_double_eq_tol(gradient[e], deficit[e], 1e-15);
  free(length);
  dvi_regge_destroy(&regge);
}
END_TEST

/* A flat ball: inner deficits vanish, and the action is that of the boundary's curvature. */
START_TEST(a_flat_complex_has_no_deficits)
{
  const dvi_generator_options three = {.size = sizeof three, .cells = {3, 3, 3}},
                              four = {.size = sizeof four, .cells = {2, 2, 2, 2}};
  for (int i = 0; i < 2; i++) {
    dvi_regge *regge = complex_of("kuhn", i == 0 ? &three : &four, 0);
    double *length = lengths_of(regge, 0);
    dvi_regge_measures m;
    ck_assert_int_eq(dvi_regge_measure(regge, length, &m), DVI_OK);
    ck_assert_double_eq_tol(m.deficit_min, 0, 1e-14);
    ck_assert_double_eq_tol(m.deficit_max, 0, 1e-14);
    ck_assert_double_eq_tol(m.volume, 1, 1e-14);
    /* A cube has 12 edges of length 1 with pi/2, and a 4-cube has 24 squares. */
    ck_assert_double_eq_tol(m.action, (i == 0 ? 12 : 24) * pi / 2, 1e-12);
    free(length);
    dvi_regge_destroy(&regge);
  }
}
END_TEST

/* Differences of S with step d have errors of d^2 = 1e-10 and of 1e-14/d, and are improved once by
 * Richardson's extrapolation. */
static double difference(const dvi_regge *regge, double *length, int64_t e, double d)
{
  double up, down;
  const double old = length[e];
  length[e] = old + d;
  ck_assert_int_eq(dvi_regge_action(regge, length, &up, NULL), DVI_OK);
  length[e] = old - d;
  ck_assert_int_eq(dvi_regge_action(regge, length, &down, NULL), DVI_OK);
  length[e] = old;
  return (up - down) / (2 * d);
}

static const struct {
  const char *name;
  int cells[4];
} complexes[] = {{"cell-16", {0}},
                 {"cross-5", {0}},
                 {"simplex-5", {0}},
                 {"kuhn", {2, 2, 2}},
                 {"kuhn", {1, 1, 1, 1}}};

static dvi_regge *case_of(int i, double **length)
{
  dvi_generator_options options = {.size = sizeof options};
  memcpy(options.cells, complexes[i].cells, sizeof options.cells);
  dvi_regge *regge = complex_of(complexes[i].name, &options, 0.7);
  *length = lengths_of(regge, 0.02);
  return regge;
}

START_TEST(gradients_are_those_of_differences)
{
  double *length;
  dvi_regge *regge = case_of(_i, &length);
  const int64_t edges = edges_of(regge);
  double *gradient = calloc((size_t)edges, sizeof *gradient);
  ck_assert_int_eq(dvi_regge_action(regge, length, NULL, gradient), DVI_OK);
  for (int64_t e = 0; e < edges; e += 1 + edges / 12) {
    const double coarse = difference(regge, length, e, 2e-3),
                 fine = difference(regge, length, e, 1e-3),
                 finest = difference(regge, length, e, 5e-4), first = (4 * fine - coarse) / 3,
                 second = (4 * finest - fine) / 3;
    ck_assert_double_eq_tol(gradient[e], (16 * second - first) / 15, 1e-9);
  }
  free(gradient);
  free(length);
  dvi_regge_destroy(&regge);
}
END_TEST

START_TEST(hessians_are_symmetric_and_those_of_differences)
{
  double *length;
  dvi_regge *regge = case_of(_i, &length);
  const int64_t edges = edges_of(regge);
  const double d = 1e-4;
  dvi_matrix *hessian = NULL;
  double *up = calloc((size_t)edges, sizeof *up), *down = calloc((size_t)edges, sizeof *down),
         *unit = calloc((size_t)edges, sizeof *unit), *column = calloc((size_t)edges, sizeof *unit),
         *row = calloc((size_t)edges, sizeof *row);
  ck_assert_int_eq(dvi_regge_hessian_create(regge, length, &hessian), DVI_OK);
  for (int64_t e = 0; e < edges; e += 1 + edges / 12) {
    const double old = length[e];
    length[e] = old + d;
    ck_assert_int_eq(dvi_regge_action(regge, length, NULL, up), DVI_OK);
    length[e] = old - d;
    ck_assert_int_eq(dvi_regge_action(regge, length, NULL, down), DVI_OK);
    length[e] = old;
    unit[e] = 1;
    dvi_matrix_multiply(hessian, 0, unit, column);
    dvi_matrix_multiply(hessian, 1, unit, row);
    unit[e] = 0;
    for (int64_t f = 0; f < edges; f++) {
      ck_assert_double_eq_tol(column[f], (up[f] - down[f]) / (2 * d), 1e-5);
      ck_assert(column[f] == row[f]);
    }
  }
  free(up);
  free(down);
  free(unit);
  free(column);
  free(row);
  free(length);
  dvi_matrix_destroy(&hessian);
  dvi_regge_destroy(&regge);
}
END_TEST

/* S has the dimension n - 2 of lengths: sum_e l_e dS/dl_e = (n - 2) S - 2 Lambda V for n - 2 of V's
 * n. */
START_TEST(the_action_is_homogeneous)
{
  for (int i = 0; i < 5; i++) {
    double *length, sum = 0;
    dvi_regge *regge = case_of(i, &length);
    const int64_t edges = edges_of(regge);
    const int n = dvi_mesh_dimension(dvi_regge_mesh(regge));
    double *gradient = calloc((size_t)edges, sizeof *gradient);
    dvi_regge_measures m;
    ck_assert_int_eq(dvi_regge_measure(regge, length, &m), DVI_OK);
    ck_assert_int_eq(dvi_regge_action(regge, length, NULL, gradient), DVI_OK);
    for (int64_t e = 0; e < edges; e++) sum += length[e] * gradient[e];
    ck_assert_double_eq_tol(sum, (n - 2) * m.action - 2 * 0.7 * m.volume, 1e-11);
    free(gradient);
    free(length);
    dvi_regge_destroy(&regge);
  }
}
END_TEST

START_TEST(hinges_have_volumes_and_deficits)
{
  dvi_regge *regge = complex_of("cross-5", NULL, 0);
  double *length = lengths_of(regge, 0), volume[80], deficit[80];
  ck_assert_int_eq(dvi_regge_hinges(regge, length, volume, deficit), DVI_OK);
  for (int h = 0; h < 80; h++) {
    ck_assert_double_eq_tol(volume[h], sqrt(3) / 4, 1e-15);
    ck_assert_double_eq_tol(deficit[h], 2 * pi - 4 * acos(0.25), 2e-15);
  }
  ck_assert_int_eq(dvi_regge_hinges(regge, length, NULL, deficit), DVI_OK);
  ck_assert_int_eq(dvi_regge_hinges(regge, length, volume, NULL), DVI_OK);
  free(length);
  dvi_regge_destroy(&regge);
}
END_TEST

START_TEST(lengths_that_violate_inequalities_are_refused_with_their_simplex)
{
  dvi_regge *regge = complex_of("simplex-5", NULL, 0);
  double *length = lengths_of(regge, 0), action;
  length[0] = 2.5;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_BAD_ARGUMENT);
  check_words("triangle 0 (vertices 0 1 2) does not exist with the lengths 2.5 (0 1), 1 (0 2), 1 "
              "(1 2)");
  length[0] = 1.8;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_BAD_ARGUMENT);
  check_words("tetrahedron 0 (vertices 0 1 2 3) does not exist in Euclidean space with the lengths "
              "1.8 (0 1)");
  /* The 4-simplex needs a length below sqrt(8/3) = 1.632993, and the tetrahedron below sqrt(3). */
  length[0] = 1.7;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_BAD_ARGUMENT);
  check_words(
      "4-simplex 0 (vertices 0 1 2 3 ..) does not exist in Euclidean space with the lengths "
      "1.7 (0 1), 1 (0 2), 1 (0 3), 1 (0 4), 1 (1 2)");
  length[0] = -1;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_BAD_ARGUMENT);
  check_words("edge 0 (vertices 0 1) has the length -1");
  length[0] = NAN;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_BAD_ARGUMENT);
  check_words("edge 0 (vertices 0 1) has the length nan");
  length[0] = 1e99;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_BAD_ARGUMENT);
  check_words("edge 0 (vertices 0 1) has the length 1e+99, and 1e-60 to 1e+60 are possible");
  free(length);
  dvi_regge_destroy(&regge);
}
END_TEST

START_TEST(overflows_are_refused)
{
  dvi_regge *regge = complex_of("simplex-4", NULL, 1e300);
  double *length = lengths_of(regge, 0), action;
  for (int e = 0; e < 10; e++) length[e] *= 1e30;
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_NOT_FINITE);
  check_words("not finite with Lambda = 1e+300");
  free(length);
  dvi_regge_destroy(&regge);
}
END_TEST

/* The action of tetrahedra of the boundary of a 4-simplex. Tetrahedron c lacks point c, and one
 * tetrahedron alone is number 0. */
static double action_of_part(int first, int cells)
{
  static const double point[20] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  int vertex[20];
  for (int c = 0; c < 5; c++)
    for (int i = 0; i < 4; i++) vertex[4 * c + i] = i + (i >= c);
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 3,
                                .space = 4,
                                .points = cells == 1 ? 4 : 5,
                                .point = cells == 1 ? point + 4 : point,
                                .cells = cells,
                                .vertex = cells == 1 ? vertex + 16 : vertex + 4 * first};
  dvi_mesh *mesh = NULL;
  dvi_regge *regge = NULL;
  double length[10], action;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_int_eq(
      dvi_regge_create(&(dvi_regge_terms){.size = sizeof(dvi_regge_terms), .mesh = mesh}, &regge),
      DVI_OK);
  ck_assert_int_eq(dvi_regge_lengths(regge, length), DVI_OK);
  ck_assert_int_eq(dvi_regge_action(regge, length, &action, NULL), DVI_OK);
  dvi_regge_destroy(&regge);
  dvi_mesh_destroy(&mesh);
  return action;
}

/* Deficits of the boundary add up to those inside (Hartle and Sorkin 1981). The tetrahedron that is
 * left out has the points 1 to 4, and all its edges the length sqrt(2). */
START_TEST(actions_of_complexes_that_are_glued_add_up)
{
  ck_assert_double_eq_tol(action_of_part(1, 4) + action_of_part(0, 1), action_of_part(0, 5), 1e-13);
}
END_TEST

START_TEST(meshes_of_other_cells_are_refused)
{
  dvi_mesh *mesh = NULL;
  dvi_regge *regge = NULL;
  ck_assert_int_eq(dvi_mesh_generate("icosphere", NULL, &mesh), DVI_OK);
  dvi_regge_terms terms = {.size = sizeof terms, .mesh = mesh};
  ck_assert_int_eq(dvi_regge_create(&terms, &regge), DVI_UNSUPPORTED);
  check_words("'triangle'");
  dvi_mesh_destroy(&mesh);
  const dvi_generator_options options = {.size = sizeof options, .cells = {2, 2, 2}};
  ck_assert_int_eq(dvi_mesh_generate("box", &options, &mesh), DVI_OK);
  terms.mesh = mesh;
  ck_assert_int_eq(dvi_regge_create(&terms, &regge), DVI_UNSUPPORTED);
  check_words("divide boxes");
  terms.mesh = NULL;
  ck_assert_int_eq(dvi_regge_create(&terms, &regge), DVI_BAD_ARGUMENT);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Allocate one block less each time, until the call succeeds. */
START_TEST(no_memory_is_reported)
{
  dvi_mesh *mesh = NULL;
  dvi_matrix *hessian = NULL;
  dvi_regge_measures m;
  int failures = 0;
  ck_assert_int_eq(dvi_mesh_generate("cell-16", NULL, &mesh), DVI_OK);
  const dvi_regge_terms terms = {.size = sizeof terms, .mesh = mesh};
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; failures++) {
    dvi_regge *regge = NULL;
    double length[24], action;
    for (int e = 0; e < 24; e++) length[e] = 1;
    dvi__fail_allocations_after(failures);
    status = dvi_regge_create(&terms, &regge);
    if (status == DVI_OK) status = dvi_regge_action(regge, length, &action, NULL);
    if (status == DVI_OK) status = dvi_regge_measure(regge, length, &m);
    if (status == DVI_OK) status = dvi_regge_hessian_create(regge, length, &hessian);
    dvi__fail_allocations_after(-1);
    if (status != DVI_OK) ck_assert_int_eq(status, DVI_NO_MEMORY);
    dvi_matrix_destroy(&hessian);
    dvi_regge_destroy(&regge);
  }
  ck_assert_int_gt(failures, 15);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(action)
{
  tcase_add_test(tests, regular_polytopes_have_their_deficits_and_actions);
  tcase_add_test(tests, actions_of_unit_edges_have_their_digits);
  tcase_add_test(tests, the_action_is_half_of_the_integral_of_the_scalar_curvature);
  tcase_add_test(tests, gradients_in_three_dimensions_are_the_deficits);
  tcase_add_test(tests, a_flat_complex_has_no_deficits);
  tcase_add_loop_test(tests, gradients_are_those_of_differences, 0, 5);
  tcase_add_loop_test(tests, hessians_are_symmetric_and_those_of_differences, 0, 5);
  tcase_add_test(tests, the_action_is_homogeneous);
  tcase_add_test(tests, hinges_have_volumes_and_deficits);
  tcase_add_test(tests, lengths_that_violate_inequalities_are_refused_with_their_simplex);
  tcase_add_test(tests, overflows_are_refused);
  tcase_add_test(tests, actions_of_complexes_that_are_glued_add_up);
  tcase_add_test(tests, meshes_of_other_cells_are_refused);
  tcase_add_test(tests, no_memory_is_reported);
}
