/* Products of axes, and what is refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/space/space.h"
#include "support/field/function_spaces.h"
#include "support/meshes.h"
#include "support/suite.h"

/* Axes of three kinds: a periodic one of splines, open elements, and one polynomial. */
static dvi_space *mixed_space(int axes)
{
  static const double node[] = {-1, -0.5, 0.2, 1};
  const dvi_axis axis[] = {
      {.to = 2, .periodic = 1, .kind = "spline:degree=3,cells=5"},
      {.name = "height", .from = -1, .to = 1, .node = node, .nodes = 4},
      {.from = 3, .to = 4, .kind = "chebyshev:degree=3"},
  };
  const dvi_space_options options = {
      .size = sizeof options, .kind = "fem:degree=2", .axis = axis, .axes = axes};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

static double *random_array(int64_t count, unsigned long long seed)
{
  double *array = malloc((size_t)count * sizeof *array);
  for (int64_t i = 0; i < count; i++) array[i] = 2 * random_number(&seed) - 1;
  return array;
}

/* ---- products ---- */

/* Rows are found from the axes, and the matrix is multiplied from theirs. */
START_TEST(evaluation_at_the_points_is_the_operator)
{
  const int orders[][3] = {{0, 0, 0}, {2, 0, 0}, {1, 1, 1}, {3, 0, 2}};
  for (int axes = 1; axes <= 3; axes++)
    for (int o = 0; o < 4; o++) {
      dvi_space *space = mixed_space(axes);
      const double *x;
      const int64_t points = dvi_space_points(space, &x, NULL);
      double *U = random_array(dvi_space_functions(space), 1), *u = random_array(points, 2),
             *v = random_array(points, 3);
      ck_assert_int_eq(dvi_space_apply(space, orders[o], U, u), DVI_OK);
      ck_assert_int_eq(dvi_space_evaluate(space, orders[o], U, points, x, v), DVI_OK);
      for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], v[k], 1e-9);
      free(U);
      free(u);
      free(v);
      dvi_space_destroy(&space);
    }
}
END_TEST

START_TEST(the_first_axis_runs_slowest)
{
  dvi_space *space = mixed_space(3);
  const double *x;
  const int64_t points = dvi_space_points(space, &x, NULL);
  ck_assert_int_eq(dvi_space_functions(space), 5 * 7 * 4);
  ck_assert_int_eq(points, 20 * 9 * 4);
  ck_assert(x[0] == x[1] && x[points] == x[points + 1] && x[2 * points] < x[2 * points + 1]);
  ck_assert(x[0] == x[4] && x[points] < x[points + 4] && x[2 * points] == x[2 * points + 4]);
  ck_assert(x[0] < x[36] && x[points] == x[points + 36] && x[2 * points] == x[2 * points + 36]);
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(the_transposed_operator_is_the_adjoint)
{
  const int order[] = {1, 0, 1};
  for (int axes = 1; axes <= 3; axes++) {
    dvi_space *space = mixed_space(axes);
    dvi__space_operator B;
    const int64_t n = dvi_space_functions(space), points = dvi_space_points(space, NULL, NULL);
    double *U = random_array(n, 1), *u = random_array(points, 2), *f = random_array(points, 3),
           *F = random_array(n, 4), before = 0, after = 0, forth = 0;
    ck_assert_int_eq(dvi__operator_work(space), 0);
    ck_assert_int_eq(dvi__operator_make(space, order, &B), DVI_OK);
    for (int64_t i = 0; i < n; i++) before += F[i] * U[i];
    dvi__operator_apply(&B, U, u, NULL);
    dvi__operator_add_transposed(&B, f, F, NULL);
    for (int64_t i = 0; i < n; i++) after += F[i] * U[i];
    for (int64_t k = 0; k < points; k++) forth += u[k] * f[k];
    ck_assert_double_eq_tol(after - before, forth, 1e-11 * (1 + fabs(forth)));
    dvi__operator_clear(&B);
    free(U);
    free(u);
    free(f);
    free(F);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* A polynomial of degree 3 along the last axis, 2 along the others, and constant around. */
static int polynomial(int64_t count, const double *x, double *f, void *user)
{
  const int axes = *(int *)user;
  for (int64_t i = 0; i < count; i++) {
    f[i] = 1.5;
    if (axes > 1) f[i] += x[count + i] * x[count + i] - x[count + i];
    if (axes > 2) f[i] += x[count + i] * pow(x[2 * count + i] - 3.3, 3);
  }
  return 0;
}

START_TEST(interpolation_joins_nodes_and_least_squares)
{
  for (int axes = 1; axes <= 3; axes++) {
    dvi_space *space = mixed_space(axes);
    ck_assert_double_eq_tol(interpolation_error(space, polynomial, &axes), 0, 1e-13);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* Tensor products add eigenvalues: that of the square is the sum of those of its sides. */
START_TEST(largest_eigenvalues_of_axes_add)
{
  double line[8], square[64];
  dvi_space *side = space_on_line("fem:degree=2,cells=4", 0, 4, 1),
            *whole = space_on_box("fem:degree=2,cells=4", 2, 4, 1);
  space_forms forms = forms_of_space(side);
  space_eigenvalues(&forms, line);
  free_space_forms(&forms);

  /* The stiffness of a product has the mass of the other axis. */
  forms = forms_of_space(whole);
  space_eigenvalues(&forms, square);
  free_space_forms(&forms);
  ck_assert_double_eq_tol(line[7], 60, 1e-12);
  ck_assert_double_eq_tol(square[63], 120, 1e-11);
  dvi_space_destroy(&side);
  dvi_space_destroy(&whole);
}
END_TEST

static void check_part(const dvi_space *space, const char *part, int expected)
{
  int64_t count;
  const int *function = dvi_space_boundary(space, part, &count);
  ck_assert_msg((function != NULL) == (expected > 0) && count == expected, "%s: %lld functions",
                part, (long long)count);
  for (int64_t i = 1; i < count; i++) ck_assert_int_lt(function[i - 1], function[i]);
}

START_TEST(sides_of_a_box_have_their_functions)
{
  dvi_space *cube = space_on_box("fem:degree=2,cells=2", 3, 1, 0), *mixed = mixed_space(3);
  const char *const sides[] = {"left", "right", "bottom", "top", "back", "front"};
  for (int i = 0; i < 6; i++) check_part(cube, sides[i], 25);
  check_part(cube, "boundary", 125 - 27);
  check_part(cube, "middle", 0);
  check_part(mixed, "left", 0);
  check_part(mixed, "right", 0);
  check_part(mixed, "bottom", 5 * 4);
  check_part(mixed, "front", 5 * 7);
  check_part(mixed, "boundary", 5 * (28 - 10));
  dvi_space_destroy(&cube);
  dvi_space_destroy(&mixed);
}
END_TEST

/* ---- what a space tells ---- */

START_TEST(a_shared_space_lives_until_its_last_owner)
{
  dvi_space *space = mixed_space(2), *other = dvi_space_share(space), *none = NULL;
  ck_assert_ptr_eq(space, other);
  dvi_space_destroy(&space);
  ck_assert_ptr_null(space);
  ck_assert_int_eq(dvi_space_dimension(other), 2);
  dvi_space_destroy(&other);
  dvi_space_destroy(&none);
  dvi_space_destroy(NULL);
  ck_assert_ptr_null(dvi_space_share(NULL));
}
END_TEST

START_TEST(a_space_tells_its_axes_and_their_derivatives)
{
  dvi_space *space = mixed_space(3);
  ck_assert_str_eq(dvi_space_axis(space, 0), "x");
  ck_assert_str_eq(dvi_space_axis(space, 1), "height");
  ck_assert_str_eq(dvi_space_axis(space, 2), "z");
  ck_assert_ptr_null(dvi_space_axis(space, 3));
  ck_assert_int_eq(dvi_space_smoothness(space, 0), 3);
  ck_assert_int_eq(dvi_space_smoothness(space, 1), 1);
  ck_assert_int_eq(dvi_space_smoothness(space, 2), 3);
  ck_assert_int_eq(dvi_space_smoothness(space, 3), 0);
  ck_assert_int_eq(dvi_space_dimension(NULL), 0);
  ck_assert_int_eq(dvi_space_functions(NULL), 0);
  ck_assert_int_eq(dvi_space_points(NULL, NULL, NULL), 0);
  dvi_space_destroy(&space);
}
END_TEST

static void check_explanation(dvi_space *space, const char *words)
{
  char text[600], cut[10];
  dvi_space_explain(space, text, sizeof text);
  ck_assert_str_eq(text, words);
  dvi_space_explain(space, cut, sizeof cut);
  ck_assert_uint_eq(strlen(cut), 9);
  ck_assert_int_eq(strncmp(cut, words, 9), 0);
  dvi_space_destroy(&space);
}

START_TEST(a_space_explains_itself)
{
  check_explanation(mixed_space(3),
                    "axis x, 0 to 2, periodic: spline, degree 3, 5 cells: 5 functions, 4 Gauss "
                    "points a cell, exact for polynomials of degree 7\n"
                    "axis height, -1 to 1: fem, degree 2, 3 cells: 7 functions, 3 Gauss points a "
                    "cell, exact for polynomials of degree 5\n"
                    "axis z, 3 to 4: chebyshev, degree 3, 1 cell: 4 functions, 4 Gauss points a "
                    "cell, exact for polynomials of degree 7\n"
                    "product of 3 axes: 140 functions, 720 points\n");
  check_explanation(
      space_on_line("fem:degree=2,cells=100,lumped=yes", 0, 1, 0),
      "axis x, 0 to 1: fem, degree 2, 100 cells: 201 functions, lumped: the nodes are "
      "the points, exact for polynomials of degree 3\n"
      "the mass is diagonal\n");
  check_explanation(space_on_line("legendre:degree=8", 0, 1, 0),
                    "axis x, 0 to 1: legendre, degree 8, 1 cell: 9 functions, the nodes are the "
                    "points, exact for polynomials of degree 15\n"
                    "the mass is diagonal\n");
  check_explanation(space_on_box("fourier:modes=4", 2, 1, 1),
                    "axis x, 0 to 1, periodic: fourier, modes to 4: 9 functions, 18 points, exact "
                    "for products of 4 functions\n"
                    "axis y, 0 to 1, periodic: fourier, modes to 4: 9 functions, 18 points, exact "
                    "for products of 4 functions\n"
                    "product of 2 axes: 81 functions, 324 points\n");
}
END_TEST

/* ---- refusals ---- */

static void refuse(const dvi_space_options *options, dvi_status status, const char *words)
{
  dvi_space *space = NULL;
  ck_assert_int_eq(dvi_space_create(options, &space), status);
  ck_assert_ptr_null(space);
  check_words(words);
}

static void refuse_kind(const char *kind, const char *words)
{
  const dvi_axis axis = {.to = 1};
  refuse(
      &(dvi_space_options){
          .size = sizeof(dvi_space_options), .kind = kind, .axis = &axis, .axes = 1},
      DVI_BAD_OPTION, words);
}

START_TEST(specifications_that_are_wrong_are_refused_by_name)
{
  refuse_kind(NULL, "space: axis x has no kind; set options.kind");
  refuse_kind("finite", "space: there is no kind \"finite\" here; there are fem, spline, legendre, "
                        "chebyshev, fourier");
  refuse_kind("", "space: there is no kind \"\" here");
  refuse_kind("fem", "space: fem on axis x has no cells; give cells= or the nodes of the axis");
  refuse_kind("fem:", "space: fem: \"\" is no option; write name=value");
  refuse_kind("fem:cells", "space: fem: \"cells\" is no option; write name=value");
  refuse_kind("fem:cells=4,", "space: fem: \"\" is no option; write name=value");
  refuse_kind("fem:cell=4",
              "space: fem has no option \"cell\"; it has degree, cells, lumped, points");
  refuse_kind("fem:cells=4,cells=4", "space: fem: cells is given twice");
  refuse_kind("fem:cells=0", "space: fem: cells=0; whole numbers from 1 to 1073741824 in plain");
  refuse_kind("fem:cells=04", "space: fem: cells=04; whole numbers from 1");
  refuse_kind("fem:cells=+4", "space: fem: cells=+4; whole numbers from 1");
  refuse_kind("fem:cells=4.5", "space: fem: cells=4.5; whole numbers from 1");
  refuse_kind("fem:cells=", "space: fem: cells=; whole numbers from 1");
  refuse_kind("fem:cells=99999999999999999999", "whole numbers from 1 to 1073741824");
  refuse_kind("fem:degree=9,cells=4", "space: fem: degree=9; whole numbers from 1 to 8 in plain");
  refuse_kind("fem:cells=4,lumped=true", "space: fem: lumped=true; ");
  refuse_kind("fem:cells=4,points=3,lumped=yes",
              "points=3 with lumped=yes, whose points are the nodes");
  refuse_kind("fem:cells=4,points=81", "space: fem: points=81; whole numbers from 1 to 80");
  refuse_kind("spline:degree=9,cells=4", "space: spline: degree=9; whole numbers from 1 to 8");
  refuse_kind("spline:lumped=yes",
              "space: spline has no option \"lumped\"; it has degree, cells, points");
  refuse_kind("legendre", "space: legendre has no degree; give degree=1 to 256");
  refuse_kind("legendre:degree=257", "space: legendre: degree=257; whole numbers from 1 to 256");
  refuse_kind("legendre:degree=4,points=5",
              "space: legendre has no option \"points\"; it has degree");
  refuse_kind("chebyshev:cells=4",
              "space: chebyshev has no option \"cells\"; it has degree, points");
}
END_TEST

static void refuse_axis(dvi_axis axis, const char *kind, dvi_status status, const char *words)
{
  refuse(
      &(dvi_space_options){
          .size = sizeof(dvi_space_options), .kind = kind, .axis = &axis, .axes = 1},
      status, words);
}

START_TEST(axes_that_are_wrong_are_refused)
{
  const double good[] = {0, 0.5, 1}, bad[] = {0, 0.5, 0.5, 1}, short_of[] = {0, 0.5, 0.9},
               nan[] = {0, NAN, 1};
  refuse_axis((dvi_axis){.from = 1, .to = 1}, "fem:cells=2", DVI_BAD_ARGUMENT,
              "space: axis x runs from 1 to 1; finite ends in ascending order");
  refuse_axis((dvi_axis){.to = INFINITY}, "fem:cells=2", DVI_BAD_ARGUMENT,
              "axis x runs from 0 to inf");
  refuse_axis((dvi_axis){.from = NAN, .to = 1}, "fem:cells=2", DVI_BAD_ARGUMENT,
              "axis x runs from");
  refuse_axis((dvi_axis){.to = 1, .nodes = 3}, "fem", DVI_BAD_ARGUMENT,
              "axis x has 3 nodes without an array");
  refuse_axis((dvi_axis){.to = 1, .node = good, .nodes = 1}, "fem", DVI_BAD_ARGUMENT,
              "axis x has 1 nodes with an array; give two or more, or none");
  refuse_axis((dvi_axis){.to = 1, .node = good, .nodes = 3}, "fem:cells=3", DVI_BAD_OPTION,
              "axis x has 3 nodes, but cells=3; leave cells out");
  refuse_axis((dvi_axis){.to = 1, .node = bad, .nodes = 4}, "fem", DVI_BAD_ARGUMENT,
              "nodes 1 and 2 of axis x, 0.5 and 0.5, do not ascend");
  refuse_axis((dvi_axis){.to = 1, .node = nan, .nodes = 3}, "fem", DVI_BAD_ARGUMENT,
              "nodes 0 and 1 of axis x");
  refuse_axis((dvi_axis){.to = 1, .node = short_of, .nodes = 3}, "spline", DVI_BAD_ARGUMENT,
              "the nodes of axis x run from 0 to 0.9, but the axis from 0 to 1");
  refuse_axis((dvi_axis){.to = 1, .node = good, .nodes = 3}, "legendre:degree=3", DVI_BAD_ARGUMENT,
              "axis x has nodes, but legendre has one cell");
}
END_TEST

START_TEST(options_that_are_wrong_are_refused)
{
  enum { SIZE = sizeof(dvi_space_options) };
  const dvi_axis axis[] = {{.to = 1}, {.to = 1}, {.name = "x", .to = 1}, {.to = 1}};
  const char *const kind = "fem:cells=2000";
  dvi_mesh *mesh = jittered_mesh(2, 2, 2, 0, 1);
  refuse(NULL, DVI_BAD_ARGUMENT, "space: the options are NULL");
  refuse(&(dvi_space_options){.kind = kind, .axis = axis, .axes = 1}, DVI_BAD_ARGUMENT,
         "space: set options.size to sizeof(dvi_space_options)");
  refuse(&(dvi_space_options){.size = SIZE, .kind = kind, .axis = axis}, DVI_BAD_ARGUMENT,
         "space: 0 axes asked, 1 to 3 possible without a mesh");
  refuse(&(dvi_space_options){.size = SIZE, .kind = kind, .axis = axis, .axes = 4},
         DVI_BAD_ARGUMENT, "space: 4 axes asked");
  refuse(&(dvi_space_options){.size = SIZE, .kind = kind, .axes = 1}, DVI_BAD_ARGUMENT,
         "space: the array of axes is NULL");
  refuse(&(dvi_space_options){.size = SIZE, .kind = kind, .axis = axis, .axes = 1, .mesh = mesh},
         DVI_BAD_ARGUMENT, "space: 1 axes with a mesh; give axes or a mesh");
  refuse(&(dvi_space_options){.size = SIZE, .kind = kind, .axis = axis, .axes = 3},
         DVI_BAD_ARGUMENT, "space: axes 0 and 2 have the same name, x");
  refuse(&(dvi_space_options){.size = SIZE, .kind = "fem:cells=30000", .axis = axis, .axes = 2},
         DVI_BAD_SIZE, "space: 9e+08 functions and 3.6e+09 points asked, 2147483647 possible");
  refuse(
      &(dvi_space_options){.size = SIZE, .kind = "fem:cells=1073741824", .axis = axis, .axes = 1},
      DVI_BAD_SIZE, "space: 1.07e+09 functions and 2.15e+09 points asked");
  refuse(
      &(dvi_space_options){
          .size = SIZE, .kind = "spline:cells=1000000000", .axis = axis, .axes = 1},
      DVI_BAD_SIZE, "space: 1e+09 functions and 4e+09 points asked");
  ck_assert_int_eq(dvi_space_create(NULL, NULL), DVI_BAD_ARGUMENT);
  check_words("space: the place for the space is NULL");
  dvi_mesh_destroy(&mesh);
}
END_TEST

static int fails(int64_t count, const double *x, double *f, void *user)
{
  (void)x;
  for (int64_t i = 0; i < count; i++) f[i] = 0;
  return *(int *)user;
}

static int is_not_finite(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = 1 / x[i];
  return 0;
}

START_TEST(functions_that_fail_or_are_not_finite_are_refused)
{
  dvi_space *space = space_on_box("fem:degree=1,cells=2", 2, 1, 0);
  double U[9];
  int result = 3;
  ck_assert_int_eq(dvi_space_interpolate(space, fails, &result, U), DVI_CALLBACK_FAILED);
  check_words("space: the function to interpolate failed");
  ck_assert_int_eq(dvi_space_interpolate(space, is_not_finite, NULL, U), DVI_NOT_FINITE);
  check_words("space: the function to interpolate is inf at x = 0, y = 0");
  ck_assert_int_eq(dvi_space_interpolate(space, NULL, NULL, U), DVI_BAD_ARGUMENT);
  check_words("space: the function to interpolate is missing");
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(too_few_points_for_least_squares_are_told)
{
  dvi_space *space = space_on_line("spline:degree=3,cells=4,points=1", 0, 1, 0);
  double U[7];
  int result = 0;
  ck_assert_int_eq(dvi_space_interpolate(space, fails, &result, U), DVI_SINGULAR);
  check_words("space: more points a cell are needed to interpolate");
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(derivatives_and_points_that_do_not_exist_are_refused)
{
  dvi_space *space = space_on_box("fem:degree=2,cells=2", 2, 1, 0);
  const int second[] = {0, 2}, negative[] = {-1, 0}, value[] = {0, 0};
  const double outside[] = {0.5, 1.5}, nowhere[] = {NAN, 0.5};
  double U[25] = {0}, u[36];
  ck_assert_int_eq(dvi_space_apply(space, second, U, u), DVI_UNSUPPORTED);
  check_words(
      "space: a derivative of order 2 along y is asked, but functions of this space have 1; "
      "splines of a higher degree have more");
  ck_assert_int_eq(dvi_space_apply(space, negative, U, u), DVI_BAD_ARGUMENT);
  check_words("a derivative of order -1 along x is asked");
  ck_assert_int_eq(dvi_space_apply(space, NULL, U, u), DVI_BAD_ARGUMENT);
  check_words("space: the orders of the derivative are missing");
  ck_assert_int_eq(dvi_space_evaluate(space, value, U, 1, outside, u), DVI_BAD_ARGUMENT);
  check_words("space: the point x = 0.5, y = 1.5 lies outside of the domain");
  ck_assert_int_eq(dvi_space_evaluate(space, value, U, 1, nowhere, u), DVI_BAD_ARGUMENT);
  check_words("lies outside of the domain");
  ck_assert_int_eq(dvi_space_evaluate(space, value, U, 1, NULL, u), DVI_BAD_ARGUMENT);
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(a_lack_of_memory_leaks_nothing)
{
  const char *const kinds[] = {"fem:degree=2,cells=2", "spline:cells=2", "legendre:degree=3",
                               "chebyshev:degree=3", "fourier:modes=2"};
  const dvi_axis axis[] = {{.to = 1, .periodic = 1}, {.to = 1, .periodic = 1}};
  const int slope[] = {1, 0};
  for (int i = 0; i < 5; i++) {
    const dvi_space_options options = {
        .size = sizeof options, .kind = kinds[i], .axis = axis, .axes = 2};
    dvi_space *space = NULL;
    double U[36] = {0}, u[400];
    int result = 0;
    dvi_status status = DVI_NO_MEMORY;
    for (long allowed = 0; status != DVI_OK; allowed++) {
      dvi__fail_allocations_after(allowed);
      status = dvi_space_create(&options, &space);
      if (status == DVI_OK) status = dvi_space_apply(space, slope, U, u);
      if (status == DVI_OK) status = dvi_space_evaluate(space, slope, U, 1, U, u);
      if (status == DVI_OK) status = dvi_space_interpolate(space, fails, &result, U);
      dvi__fail_allocations_after(-1);
      ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "%s", dvi_last_error());
      dvi_space_destroy(&space);
    }
  }
}
END_TEST

SUITE(space_boxes)
{
  tcase_add_test(tests, evaluation_at_the_points_is_the_operator);
  tcase_add_test(tests, the_first_axis_runs_slowest);
  tcase_add_test(tests, the_transposed_operator_is_the_adjoint);
  tcase_add_test(tests, interpolation_joins_nodes_and_least_squares);
  tcase_add_test(tests, largest_eigenvalues_of_axes_add);
  tcase_add_test(tests, sides_of_a_box_have_their_functions);
  tcase_add_test(tests, a_shared_space_lives_until_its_last_owner);
  tcase_add_test(tests, a_space_tells_its_axes_and_their_derivatives);
  tcase_add_test(tests, a_space_explains_itself);
  tcase_add_test(tests, specifications_that_are_wrong_are_refused_by_name);
  tcase_add_test(tests, axes_that_are_wrong_are_refused);
  tcase_add_test(tests, options_that_are_wrong_are_refused);
  tcase_add_test(tests, functions_that_fail_or_are_not_finite_are_refused);
  tcase_add_test(tests, too_few_points_for_least_squares_are_told);
  tcase_add_test(tests, derivatives_and_points_that_do_not_exist_are_refused);
  tcase_add_test(tests, a_lack_of_memory_leaks_nothing);
}
