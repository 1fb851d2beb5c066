/* Multiscale finite elements in the plane, on -div (a grad u) = 1 with the coefficient of Hou and
 * Wu 1997, sec. 5, taken at the centres of 128 x 128 fine cells. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/galerkin.h"
#include "support/suite.h"

enum { FINEST = 128, NODES = FINEST + 1, ALL = NODES * NODES };

static const double pi = 3.141592653589793;
static const dvi_axis square[] = {{.from = 0, .to = 1}, {.from = 0, .to = 1}};

/* `user` is eps. */
static int hou_wu(int64_t count, const double *x, double *a, void *user)
{
  const double *eps = user;
  for (int64_t i = 0; i < count; i++) {
    const double sx = sin(2 * pi * x[i] / *eps), y = 2 * pi * x[count + i] / *eps;
    a[i] = (2 + 1.8 * sx) / (2 + 1.8 * cos(y)) + (2 + sin(y)) / (2 + 1.8 * sx);
  }
  return 0;
}

/* The same at the centre of the fine cell. */
static int hou_wu_in_cells(int64_t count, const double *x, double *a, void *user)
{
  for (int64_t i = 0; i < count; i++) {
    const double centre[] = {(floor(x[i] * FINEST) + .5) / FINEST,
                             (floor(x[count + i] * FINEST) + .5) / FINEST};
    hou_wu(1, centre, &a[i], user);
  }
  return 0;
}

/* Layers across x, of a thickness that changes. */
static int layers(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 2 + 1.5 * sin(20 * x[i] * x[i]);
  return 0;
}

static dvi_space *space_of(const char *kind, const dvi_axis *axis, function_of_place *a, double eps)
{
  const dvi_space_options options = {.size = sizeof options,
                                     .kind = kind,
                                     .axis = axis,
                                     .axes = 2,
                                     .coefficient = a,
                                     .user = &eps};
  dvi_space *space;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

static void set_places(double *x)
{
  for (int i = 0; i < ALL; i++) {
    const int row = i / NODES, column = i % NODES;
    x[i] = (double)row / FINEST;
    x[ALL + i] = (double)column / FINEST;
  }
}

/* Set u [ALL] to the solution at the fine nodes. Releases the space. */
static void solve(dvi_space *space, double eps, double *u)
{
  const int order[2] = {0, 0};
  galerkin g = galerkin_of(space, hou_wu_in_cells, NULL, &eps);
  double *U = malloc((size_t)g.functions * sizeof *U), *x = malloc(2 * ALL * sizeof *x);
  set_places(x);
  galerkin_solve(&g, U);
  ck_assert_int_eq(dvi_space_evaluate(space, order, U, ALL, x, u), DVI_OK);
  dvi_space_destroy(&space);
  galerkin_clear(&g);
  free(U);
  free(x);
}

static const double eps = 1. / 16;

/* The solution by 128 x 128 bilinear elements, which are cells of one part. */
static double *fine_solution(void)
{
  double *u = malloc(ALL * sizeof *u);
  solve(space_of("msfem:cells=128,fine=1,edges=linear", square, hou_wu, eps), eps, u);
  return u;
}

/* ---- errors ---- */

/* The relative error at the fine nodes. Releases the space. */
static double error_of(dvi_space *space, const double *fine)
{
  double *u = malloc(ALL * sizeof *u), sum = 0, whole = 0;
  solve(space, eps, u);
  for (int i = 0; i < ALL; i++) {
    sum += (u[i] - fine[i]) * (u[i] - fine[i]);
    whole += fine[i] * fine[i];
  }
  free(u);
  return sqrt(sum / whole);
}

static dvi_space *coarse_space(int cells, const char *edges, function_of_place *a)
{
  char kind[80];
  snprintf(kind, sizeof kind, "msfem:cells=%d,fine=%d,edges=%s", cells, FINEST / cells, edges);
  return space_of(kind, square, a, eps);
}

/* Digits of independent programs. Cells of the size of eps resonate with linear edges, whose error
 * grows. */
START_TEST(errors_at_coarse_cells)
{
  const struct {
    const char *edges;
    double error[2];
  } expected[] = {
      {"linear", {.0487, .0639}}, {"solved", {.0295, .0238}}, {"oversampled", {.0248, .0117}}};
  double *fine = fine_solution();
  ck_assert_double_eq_tol(fine[FINEST / 2 * NODES + FINEST / 2], .0206313799, .6e-10);
  for (int e = 0; e < 3; e++)
    for (int i = 0; i < 2; i++)
      ck_assert_double_eq_tol(error_of(coarse_space(8 << i, expected[e].edges, hou_wu), fine),
                              expected[e].error[i], .6e-4);
  free(fine);
}
END_TEST

static int unit(int64_t count, const double *x, double *a, void *user)
{
  (void)x;
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 1;
  return 0;
}

/* Bilinear functions on coarse cells are those of a constant coefficient. */
START_TEST(bilinear_functions_do_not_see_the_coefficient)
{
  double *fine = fine_solution();
  ck_assert_double_eq_tol(error_of(coarse_space(8, "solved", unit), fine), .197, .6e-3);
  ck_assert_double_eq_tol(error_of(coarse_space(16, "solved", unit), fine), .187, .6e-3);
  free(fine);
}
END_TEST

/* ---- functions ---- */

static double value_at(const dvi_space *space, const double *U, int dx, int dy, double x, double y)
{
  const int order[2] = {dx, dy};
  const double place[2] = {x, y};
  double value;
  ck_assert_msg(dvi_space_evaluate(space, order, U, 1, place, &value) == DVI_OK, "%s",
                dvi_last_error());
  return value;
}

/* 3 x 2 cells, and the function of their node (1,1). */
static const double nodes_x[] = {0, .3, .5, 1}, nodes_y[] = {0, .7, 1};
static const dvi_axis uneven[] = {{.from = 0, .to = 1, .node = nodes_x, .nodes = 4},
                                  {.from = 0, .to = 1, .node = nodes_y, .nodes = 3}};
static const double middle[12] = {[4] = 1};

/* In layers the function of an axis times a linear one solves the equation, also on fine cells. */
START_TEST(functions_of_layers_are_products)
{
  dvi_space *space = space_of("msfem:fine=12", uneven, layers, 0);
  double whole = 0, sum = 0;
  for (int i = 0; i < 12; i++) {
    const double centre = .3 * (i + .5) / 12;
    double a;
    layers(1, &centre, &a, NULL);
    whole += 1 / a;
  }
  for (int i = 0; i < 12; i++) {
    const double centre = .3 * (i + .5) / 12;
    double a;
    for (int j = 0; j <= 5; j++)
      ck_assert_double_eq_tol(value_at(space, middle, 0, 0, .3 * i / 12, .7 * j / 5),
                              sum / whole * j / 5, 1e-14);
    layers(1, &centre, &a, NULL);
    sum += 1 / a;
    ck_assert_double_eq_tol(value_at(space, middle, 1, 0, centre, .7), 12 / .3 / a / whole, 1e-11);
    ck_assert_double_eq_tol(value_at(space, middle, 0, 1, .3 * (i + 1) / 12 - 1e-9, .2),
                            sum / whole / .7, 1e-6);
  }
  dvi_space_destroy(&space);
}
END_TEST

static int wave(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = 1 + x[i] + x[i] * x[count + i];
  return 0;
}

START_TEST(coefficients_are_values_at_nodes)
{
  const char *kinds[] = {"msfem:fine=7", "msfem:fine=7,edges=linear",
                         "msfem:fine=7,edges=oversampled"};
  for (int k = 0; k < 3; k++) {
    dvi_space *space = space_of(kinds[k], uneven, hou_wu, 1);
    double U[12], f;
    ck_assert_int_eq(dvi_space_functions(space), 12);
    ck_assert_int_eq(dvi_space_interpolate(space, wave, NULL, U), DVI_OK);
    for (int i = 0; i < 12; i++) {
      const double x[2] = {nodes_x[i / 3], nodes_y[i % 3]};
      wave(1, x, &f, NULL);
      ck_assert_double_eq_tol(U[i], f, 1e-15);
      ck_assert_double_eq_tol(value_at(space, U, 0, 0, x[0], x[1]), f, 1e-14);
    }
    dvi_space_destroy(&space);
  }
}
END_TEST

/* The functions of neighbours have the same problem on their edge. Oversampled ones have not. */
START_TEST(edges_agree_unless_they_are_oversampled)
{
  const char *kinds[] = {"msfem:fine=8", "msfem:fine=8,edges=linear",
                         "msfem:fine=8,edges=oversampled"};
  for (int k = 0; k < 3; k++) {
    dvi_space *space = space_of(kinds[k], uneven, hou_wu, .5);
    double jump = 0;
    for (int i = 0; i <= 16; i++) {
      const double y = i / 16.;
      jump = fmax(jump, fabs(value_at(space, middle, 0, 0, nextafter(.3, 0), y) -
                             value_at(space, middle, 0, 0, .3, y)));
    }
    if (k < 2)
      ck_assert_double_lt(jump, 1e-13);
    else
      ck_assert_double_gt(jump, 1e-3);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* Patches of cells at the boundary end there, with linear edges. */
START_TEST(functions_inside_vanish_at_the_boundary)
{
  const char *kinds[] = {"msfem:fine=8", "msfem:fine=8,edges=oversampled,overlap=5"};
  for (int k = 0; k < 2; k++) {
    dvi_space *space = space_of(kinds[k], uneven, hou_wu, .5);
    int64_t count;
    const int *at = dvi_space_boundary(space, "boundary", &count);
    double U[12];
    for (int i = 0; i < 12; i++) U[i] = 1;
    ck_assert_int_eq(count, 10);
    for (int i = 0; i < count; i++) U[at[i]] = 0;
    for (int i = 0; i <= 20; i++) {
      const double s = i / 20.;
      ck_assert_double_eq_tol(value_at(space, U, 0, 0, s, 0), 0, 1e-14);
      ck_assert_double_eq_tol(value_at(space, U, 0, 0, s, 1), 0, 1e-14);
      ck_assert_double_eq_tol(value_at(space, U, 0, 0, 0, s), 0, 1e-14);
      ck_assert_double_eq_tol(value_at(space, U, 0, 0, 1, s), 0, 1e-14);
    }
    dvi_space_destroy(&space);
  }
}
END_TEST

/* A torus looks the same from another origin: what is a cell of it does not depend on where its
 * axes are cut. */
START_TEST(cells_of_a_torus_go_round)
{
  const dvi_axis torus[] = {{.from = 0, .to = 1, .periodic = 1},
                            {.from = 0, .to = 1, .periodic = 1}};
  const dvi_axis moved[] = {{.from = .25, .to = 1.25, .periodic = 1},
                            {.from = .5, .to = 1.5, .periodic = 1}};
  const char *kinds[] = {"msfem:cells=4,fine=8", "msfem:cells=4,fine=8,edges=oversampled"};
  for (int k = 0; k < 2; k++) {
    dvi_space *space = space_of(kinds[k], torus, hou_wu, .5);
    dvi_space *other = space_of(kinds[k], moved, hou_wu, .5);
    double U[16] = {1}, V[16] = {0};
    V[3 * 4 + 2] = 1;
    ck_assert_int_eq(dvi_space_functions(space), 16);
    for (int i = 0; i < 64; i++) {
      const double x = .23 * (i % 8 - 4) / 4 + 1e-3, y = .23 * (i / 8. - 4) / 4 + 1e-3;
      ck_assert_double_eq_tol(value_at(space, U, 0, 0, x, y), value_at(other, V, 0, 0, x, y),
                              1e-12);
    }
    dvi_space_destroy(&space);
    dvi_space_destroy(&other);
  }
}
END_TEST

START_TEST(the_sum_of_all_functions_is_1)
{
  const dvi_axis torus[] = {{.from = 0, .to = 1, .periodic = 1}, {.from = 0, .to = 1}};
  const char *kinds[] = {"msfem:cells=1,fine=8", "msfem:cells=2,fine=4,edges=linear",
                         "msfem:cells=3,fine=4,edges=oversampled"};
  for (int k = 0; k < 3; k++) {
    dvi_space *space = space_of(kinds[k], torus, hou_wu, .5);
    double U[12];
    for (int i = 0; i < 12; i++) U[i] = 1;
    ck_assert_int_eq(dvi_space_functions(space), (k + 1) * (k + 2));
    ck_assert_double_eq_tol(value_at(space, U, 0, 0, -3.3, .7), 1, 1e-13);
    ck_assert_double_eq_tol(value_at(space, U, 1, 0, -3.3, .7), 0, 1e-12);
    ck_assert_double_eq_tol(value_at(space, U, 0, 1, -3.3, .7), 0, 1e-12);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* ---- threads, words and memory ---- */

START_TEST(bits_do_not_depend_on_threads)
{
  const int order[2] = {1, 0};
  double U[12];
  for (int i = 0; i < 12; i++) U[i] = sin(i);
  for (int e = 0; e < 2; e++) {
    double values[2][6 * 64 * 4];
    for (int t = 0; t < 2; t++) {
      char kind[80];
      snprintf(kind, sizeof kind, "msfem:fine=8,edges=%s,threads=%d",
               e == 0 ? "solved" : "oversampled", 1 + 2 * t);
      dvi_space *space = space_of(kind, uneven, hou_wu, .5);
      ck_assert_int_eq(dvi_space_points(space, NULL, NULL), 6 * 64 * 4);
      ck_assert_int_eq(dvi_space_apply(space, order, U, values[t]), DVI_OK);
      dvi_space_destroy(&space);
    }
    ck_assert_mem_eq(values[0], values[1], sizeof values[0]);
  }
}
END_TEST

START_TEST(the_space_tells_how_well_it_sees_the_coefficient)
{
  char text[400];
  dvi_space *space = space_of("msfem:fine=12,edges=oversampled", uneven, layers, 0);
  dvi_space_explain(space, text, sizeof text);
  const char *begin = "axes x and y: msfem, 3 x 2 cells: 12 functions, oversampled edges\n"
                      "12 x 12 fine cells in each with 2 x 2 Gauss points, from whose centres the "
                      "means of a and 1/a differ by ";
  ck_assert_msg(strncmp(text, begin, strlen(begin)) == 0, "%s", text);
  const double defect = strtod(text + strlen(begin), NULL);
  ck_assert(defect > 0 && defect < .1);
  dvi_space_destroy(&space);
}
END_TEST

static void refuse(const dvi_axis *axis, const char *kind, dvi_status status, const char *words)
{
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = axis, .axes = 2, .coefficient = layers};
  dvi_space *space;
  ck_assert_int_eq(dvi_space_create(&options, &space), status);
  check_words(words);
}

START_TEST(axes_that_do_not_go_together_are_refused)
{
  const dvi_axis mixed[] = {{.from = 0, .to = 1}, {.from = 0, .to = 1, .kind = "fem:cells=4"}};
  const dvi_axis others[] = {{.from = 0, .to = 1},
                             {.from = 0, .to = 1, .kind = "msfem:cells=4,fine=3"}};
  refuse(mixed, "msfem:cells=4", DVI_UNSUPPORTED, "axis x is msfem and axis y is fem");
  refuse(others, "msfem:cells=4,fine=8", DVI_BAD_OPTION, "fine=8 on axis x, but 3 on axis y");
}
END_TEST

START_TEST(no_memory_is_reported)
{
  const dvi_space_options options = {.size = sizeof options,
                                     .kind = "msfem:fine=8,threads=2",
                                     .axis = uneven,
                                     .axes = 2,
                                     .coefficient = layers};
  dvi_status status = DVI_NO_MEMORY;
  for (int i = 0; status != DVI_OK; i++) {
    dvi_space *space;
    dvi__fail_allocations_after(i);
    status = dvi_space_create(&options, &space);
    dvi__fail_allocations_after(-1);
    if (status != DVI_OK) ck_assert_int_eq(status, DVI_NO_MEMORY);
    dvi_space_destroy(&space);
  }
}
END_TEST

SUITE(multiscale_plane)
{
  tcase_add_test(tests, errors_at_coarse_cells);
  tcase_add_test(tests, bilinear_functions_do_not_see_the_coefficient);
  tcase_add_test(tests, functions_of_layers_are_products);
  tcase_add_test(tests, coefficients_are_values_at_nodes);
  tcase_add_test(tests, edges_agree_unless_they_are_oversampled);
  tcase_add_test(tests, functions_inside_vanish_at_the_boundary);
  tcase_add_test(tests, cells_of_a_torus_go_round);
  tcase_add_test(tests, the_sum_of_all_functions_is_1);
  tcase_add_test(tests, bits_do_not_depend_on_threads);
  tcase_add_test(tests, the_space_tells_how_well_it_sees_the_coefficient);
  tcase_add_test(tests, axes_that_do_not_go_together_are_refused);
  tcase_add_test(tests, no_memory_is_reported);
}
