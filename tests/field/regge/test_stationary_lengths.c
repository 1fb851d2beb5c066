/* Stationary lengths: flat solutions and their gauge freedom, Lambda, boundaries, refusals. */
#include <dvi/regge.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/suite.h"

typedef struct fixture {
  dvi_regge *regge;
  double *length;
  int64_t edges;
} fixture;

static fixture of_mesh(dvi_mesh *mesh, double lambda)
{
  fixture f = {.edges = dvi_mesh_count(mesh, 1)};
  const dvi_regge_terms terms = {.size = sizeof terms, .mesh = mesh, .lambda = lambda};
  ck_assert_int_eq(dvi_regge_create(&terms, &f.regge), DVI_OK);
  dvi_mesh_destroy(&mesh);
  f.length = calloc((size_t)f.edges, sizeof *f.length);
  ck_assert_int_eq(dvi_regge_lengths(f.regge, f.length), DVI_OK);
  return f;
}

static void clear(fixture *f)
{
  free(f->length);
  dvi_regge_destroy(&f->regge);
}

/* Change the lengths off the boundary by up to `part` of them. */
static void disturb(fixture *f, double part)
{
  int64_t rim, i = 0;
  const int *edge = dvi_mesh_part_cells(dvi_regge_mesh(f->regge), "boundary", 1, &rim);
  for (int64_t e = 0; e < f->edges; e++) {
    const int is_held = i < rim && edge[i] == e;
    i += is_held;
    if (!is_held) f->length[e] *= 1 + part * sin(3.1 * (double)(e * e) + 1);
  }
}

/* Solve, and require the flat ball of a cross polytope of volume 2^n/n! with n null directions for
 * each inner vertex. Deficits have errors of some roundings of 2 pi, over the thinness of
 * simplices. */
static void check_flat(fixture *f, double part, int n, int inner)
{
  dvi_regge_report report;
  dvi_regge_measures before, after;
  disturb(f, part);
  ck_assert_int_eq(dvi_regge_measure(f->regge, f->length, &before), DVI_OK);
  ck_assert_int_eq(dvi_regge_solve(f->regge, NULL, f->length, &report), DVI_OK);
  ck_assert_int_eq(dvi_regge_measure(f->regge, f->length, &after), DVI_OK);
  ck_assert_double_ge(before.deficit_max, part);
  ck_assert_double_eq_tol(after.deficit_min, 0, 1e-12);
  ck_assert_double_eq_tol(after.deficit_max, 0, 1e-12);
  ck_assert_double_eq_tol(after.volume, n == 3 ? 8.0 / 6 : 16.0 / 24, 1e-12);
  ck_assert_double_le(report.residual, 1e-13);
  ck_assert_double_eq_tol(report.action, after.action, 1e-12);
  ck_assert_int_eq(report.null_directions, n * inner);
  /* Roundings of the Hessian beside delta are 1e-16/1e-7 for each direction. */
  ck_assert_double_eq_tol(report.softness, n * inner, 1e-7);
  ck_assert_int_le(report.iterations, 8);
}

/* Points of a cross polytope, and others inside. */
static fixture delaunay(int n, int inner)
{
  dvi_mesh *mesh = NULL;
  double point[4 * 32] = {0};
  for (int v = 0; v < 2 * n; v++) point[v * n + v / 2] = v % 2 == 0 ? 1 : -1;
  for (int i = 0; i < n * inner; i++) point[2 * n * n + i] = 0.2 * sin(1.3 * i * i + i);
  ck_assert_int_eq(dvi_mesh_delaunay(n, 2 * n + inner, point, &mesh), DVI_OK);
  return of_mesh(mesh, 0);
}

/* The boundary of a convex polytope is rigid. It is filled by flat space, in which the inner
 * vertices may be anywhere. */
START_TEST(a_convex_boundary_is_filled_by_flat_space)
{
  for (int n = 3; n <= 4; n++)
    for (int inner = 1; inner <= 6; inner++) {
      fixture f = delaunay(n, inner);
      check_flat(&f, n == 3 ? 0.01 : 0.0003, n, inner);
      clear(&f);
    }
}
END_TEST

/* A tetrahedron of unit edges, divided by a vertex, 0. */
static fixture divided_tetrahedron(double lambda)
{
  dvi_mesh *mesh = NULL;
  static const double point[15] = {0, 0, 0, 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
  static const int vertex[16] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 3, 4, 0, 2, 3, 4};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 3,
                                .points = 5,
                                .point = point,
                                .cells = 4,
                                .vertex = vertex};
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  fixture f = of_mesh(mesh, lambda);
  for (int64_t e = 0; e < f.edges; e++) f.length[e] /= sqrt(8);
  return f;
}

/* The four inner lengths x fulfil 2 pi - 3 theta(x) = Lambda dV/dx. The root is mpmath's. Lambda
 * leaves no gauge freedom, but eigenvalues of 0.004 beside 31, which the roundings of the gradient
 * are divided by. */
START_TEST(lambda_curves_the_inside_of_a_tetrahedron)
{
  fixture f = divided_tetrahedron(0.5);
  dvi_regge_report report;
  for (int e = 0; e < 4; e++) f.length[e] *= 1 + 0.003 * e;
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_OK);
  for (int e = 0; e < 4; e++) ck_assert_double_eq_tol(f.length[e], 0.618739709659168658, 1e-12);
  for (int e = 4; e < 10; e++) ck_assert_double_eq_tol(f.length[e], 1, 1e-15);
  ck_assert_int_eq(report.unknowns, 4);
  ck_assert_int_eq(report.null_directions, 0);
  clear(&f);
}
END_TEST

/* Equal lengths of a closed complex fulfil (n - 2) S_1 l^(n-2) = n Lambda V_1 l^n, with S_1 and V_1
 * of unit edges. */
START_TEST(lambda_gives_closed_complexes_their_size)
{
  static const char *const name[] = {"simplex-4", "cell-16", "simplex-5", "cross-5"};
  const double lambda = 0.8;
  for (int i = 0; i < 4; i++) {
    dvi_mesh *mesh = NULL;
    dvi_regge_measures unit;
    dvi_regge_report report;
    ck_assert_int_eq(dvi_mesh_generate(name[i], NULL, &mesh), DVI_OK);
    const int n = dvi_mesh_dimension(mesh);
    fixture f = of_mesh(mesh, lambda);
    ck_assert_int_eq(dvi_regge_measure(f.regge, f.length, &unit), DVI_OK);
    const double action = unit.action + lambda * unit.volume,
                 length = sqrt((n - 2) * action / (n * lambda * unit.volume));
    for (int64_t e = 0; e < f.edges; e++) f.length[e] = length * (1 + 0.01 * sin((double)(e + 1)));
    ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_OK);
    for (int64_t e = 0; e < f.edges; e++) ck_assert_double_eq_tol(f.length[e], length, 1e-12);
    ck_assert_int_eq(report.unknowns, f.edges);
    clear(&f);
  }
}
END_TEST

/* The step of least norm does not move along a null direction: in the flat tetrahedron, the
 * solution nearest to a guess with four equal lengths has equal lengths. */
START_TEST(null_directions_keep_the_guess)
{
  fixture f = divided_tetrahedron(0);
  dvi_regge_report report;
  for (int e = 0; e < 4; e++) f.length[e] = 0.65;
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_OK);
  for (int e = 0; e < 4; e++) ck_assert_double_eq_tol(f.length[e], sqrt(3.0 / 8), 1e-14);
  ck_assert_int_eq(report.null_directions, 3);
  clear(&f);
}
END_TEST

START_TEST(lengths_may_be_held_one_by_one)
{
  fixture f = divided_tetrahedron(0);
  int8_t held[10] = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1};
  const dvi_regge_options options = {.size = sizeof options, .held = held};
  dvi_regge_report report;
  f.length[3] *= 1.01;
  ck_assert_int_eq(dvi_regge_solve(f.regge, &options, f.length, &report), DVI_OK);
  ck_assert_double_eq_tol(f.length[3], sqrt(3.0 / 8), 1e-14);
  ck_assert_int_eq(report.unknowns, 1);
  ck_assert_int_eq(report.null_directions, 0);
  held[3] = 1;
  ck_assert_int_eq(dvi_regge_solve(f.regge, &options, f.length, &report), DVI_BAD_ARGUMENT);
  check_words("all 10 lengths are held");
  clear(&f);
}
END_TEST

START_TEST(failures_leave_the_lengths_and_name_the_reason)
{
  fixture f = divided_tetrahedron(0);
  dvi_regge_options options = {.size = sizeof options, .iterations = 1};
  dvi_regge_report report;
  for (int e = 0; e < 4; e++) f.length[e] = 0.8 + 0.1 * e;
  ck_assert_int_eq(dvi_regge_solve(f.regge, &options, f.length, &report), DVI_NOT_CONVERGED);
  check_words("(iterations: 1): start from lengths nearer to a solution");
  ck_assert_double_eq_tol(f.length[3], 1.1, 0.0000001);
  ck_assert_double_ge(report.residual, 1e-3);
  options.iterations = -1;
  ck_assert_int_eq(dvi_regge_solve(f.regge, &options, f.length, NULL), DVI_BAD_ARGUMENT);
  f.length[0] = 0.05;
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, NULL), DVI_BAD_ARGUMENT);
  check_words("triangle");
  clear(&f);
}
END_TEST

/* No stationary lengths exist: a large Lambda wants more volume than simplices have. The sentence
 * names what stops the iteration, or that it does not converge. */
START_TEST(a_problem_without_a_solution_is_reported)
{
  fixture f = divided_tetrahedron(-50);
  dvi_regge_report report;
  const double before = f.length[0];
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_NOT_CONVERGED);
  check_words("Newton's method left a gradient of");
  ck_assert_double_eq_tol(f.length[0], before, 1e-16);
  clear(&f);
}
END_TEST

/* sum_e l_e dS/dl_e = (n-2) S. */
START_TEST(a_closed_complex_without_lambda_has_no_stationary_lengths)
{
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("cell-16", NULL, &mesh), DVI_OK);
  fixture f = of_mesh(mesh, 0);
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, NULL), DVI_NOT_CONVERGED);
  check_words("only S = 0 is stationary");
  clear(&f);
}
END_TEST

static fixture of_generator(const char *name, const dvi_generator_options *options, double lambda)
{
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate(name, options, &mesh), DVI_OK);
  return of_mesh(mesh, lambda);
}

/* Closed complexes with positive deficits and negative Lambda, and flat ones with any Lambda, can
 * only shrink to 0. */
START_TEST(closed_complexes_without_a_size_are_reported)
{
  const dvi_generator_options three = {.size = sizeof three, .cells = {3, 3, 3}};
  static const char *const name[] = {"cell-16", "simplex-5", "kuhn-torus", "kuhn-torus"};
  static const double lambda[] = {-1, -1, 1, -1};
  for (int i = 0; i < 4; i++) {
    fixture f = of_generator(name[i], i < 2 ? NULL : &three, lambda[i]);
    ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, NULL), DVI_NOT_CONVERGED);
    check_words("the guess has no size for which both are equal");
    clear(&f);
  }
}
END_TEST

/* Squares of gradients of 1e155 overflow, and the size is far from 1. */
START_TEST(lambda_may_have_any_size)
{
  dvi_regge_report report;
  fixture f = of_generator("simplex-4", NULL, 1e100);
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_OK);
  for (int64_t e = 0; e < f.edges; e++)
    ck_assert_double_eq_tol(f.length[e] / 3.8279223440995e-50, 1, 1e-12);
  clear(&f);
  f = of_generator("simplex-4", NULL, 1e200);
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_BAD_ARGUMENT);
  check_words("has the length 3.82792e-100, and 1e-60 to 1e+60 are possible");
  clear(&f);
  f = divided_tetrahedron(1e200);
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_NOT_CONVERGED);
  ck_assert_double_ge(report.residual, 1e190);
  clear(&f);
}
END_TEST

/* With Lambda the moves of the 13 inner vertices are soft, and the damping has to become small
 * beside their eigenvalues of about 0.007. With a smaller Lambda a hundred steps are not enough. */
START_TEST(lambda_holds_inner_vertices_softly)
{
  const dvi_generator_options two = {.size = sizeof two, .cells = {2}};
  const dvi_regge_options few = {.size = sizeof few, .iterations = 10};
  dvi_regge_report report;
  fixture f = of_generator("ball", &two, 0.5);
  ck_assert_int_eq(dvi_regge_solve(f.regge, NULL, f.length, &report), DVI_OK);
  ck_assert_double_le(report.residual, 1e-13);
  ck_assert_int_eq(report.null_directions, 0);
  clear(&f);
  f = of_generator("ball", &two, 0.02);
  ck_assert_int_eq(dvi_regge_solve(f.regge, &few, f.length, &report), DVI_NOT_CONVERGED);
  check_words("in curved space the moves of inner vertices are only nearly free");
  ck_assert_int_eq(report.iterations, 10);
  clear(&f);
}
END_TEST

START_TEST(no_memory_is_reported)
{
  fixture f = divided_tetrahedron(0);
  int failures = 0;
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; failures++) {
    dvi__fail_allocations_after(failures);
    status = dvi_regge_solve(f.regge, NULL, f.length, NULL);
    dvi__fail_allocations_after(-1);
    if (status != DVI_OK) ck_assert_int_eq(status, DVI_NO_MEMORY);
  }
  ck_assert_int_gt(failures, 10);
  clear(&f);
}
END_TEST

SUITE(stationary_lengths)
{
  tcase_add_test(tests, a_convex_boundary_is_filled_by_flat_space);
  tcase_add_test(tests, lambda_curves_the_inside_of_a_tetrahedron);
  tcase_add_test(tests, lambda_gives_closed_complexes_their_size);
  tcase_add_test(tests, null_directions_keep_the_guess);
  tcase_add_test(tests, lengths_may_be_held_one_by_one);
  tcase_add_test(tests, failures_leave_the_lengths_and_name_the_reason);
  tcase_add_test(tests, a_problem_without_a_solution_is_reported);
  tcase_add_test(tests, a_closed_complex_without_lambda_has_no_stationary_lengths);
  tcase_add_test(tests, closed_complexes_without_a_size_are_reported);
  tcase_add_test(tests, lambda_may_have_any_size);
  tcase_add_test(tests, lambda_holds_inner_vertices_softly);
  tcase_add_test(tests, no_memory_is_reported);
}
