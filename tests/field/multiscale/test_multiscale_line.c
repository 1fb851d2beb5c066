/* Multiscale finite elements on an interval: (a u')' = x^2 and u_tt = (a u_x)_x with
 * a = 10/(1 + 0.95 sin(2 pi x/eps)), eps = 0.025 (Leok 2004, sec. 5.7.1). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/galerkin.h"
#include "support/suite.h"

static const double pi = 3.141592653589793, eps = .025;

static int rapid(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 10 / (1 + .95 * sin(2 * pi * x[i] / eps));
  return 0;
}

static int minus_square(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = -x[i] * x[i];
  return 0;
}

static int unit(int64_t count, const double *x, double *a, void *user)
{
  (void)x;
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 1;
  return 0;
}

static dvi_space *space_with(const char *kind, const dvi_axis *axis, function_of_place *a)
{
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = axis, .axes = 1, .coefficient = a};
  dvi_space *space;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

static dvi_space *space_of(const char *kind, const dvi_axis *axis)
{
  return space_with(kind, axis, rapid);
}

static dvi_space *unit_space(const char *kind)
{
  const dvi_axis axis = {.from = 0, .to = 1};
  return space_of(kind, &axis);
}

/* The solution with u = 0 at both ends, by quadrature in closed form:
 *     a u' = x^3/3 + C,    10 u = int (x^3/3 + C)(1 + 0.95 sin(k x)) dx,    k = 2 pi/eps. */
static long double primitive(long double x, long double C)
{
  const long double k = 2 * 3.14159265358979323846264L / .025L, s = sinl(k * x), c = cosl(k * x);
  const long double cubic = -x * x * x * c / k + 3 * x * x * s / (k * k) + 6 * x * c / (k * k * k) -
                            6 * s / (k * k * k * k);
  return x * x * x * x / 12 + C * x + .95L * (cubic / 3 - C * c / k);
}

static double exact(double x)
{
  const long double at_0 = primitive(1, 0) - primitive(0, 0);
  const long double at_1 = primitive(1, 1) - primitive(0, 1);
  const long double C = -at_0 / (at_1 - at_0);
  return (double)((primitive(x, C) - primitive(0, C)) / 10);
}

START_TEST(the_exact_solution_has_its_digits)
{
  ck_assert_double_eq_tol(exact(.25), -2.021250547668496e-3, 1e-18);
  ck_assert_double_eq_tol(exact(.5), -3.598584209602927e-3, 1e-18);
}
END_TEST

/* The largest error at nodes as a share of the largest value. */
static double nodal_error(int cells, const double *U)
{
  double error = 0, size = 0;
  for (int i = 0; i <= cells; i++) {
    error = fmax(error, fabs(U[i] - exact((double)i / cells)));
    size = fmax(size, fabs(exact((double)i / cells)));
  }
  return error / size;
}

static double error_with_load(galerkin *g, int cells)
{
  double U[64];
  galerkin_solve(g, U);
  return nodal_error(cells, U);
}

static galerkin problem_of(const char *format, int cells, int fine)
{
  char kind[80];
  snprintf(kind, sizeof kind, format, cells, fine);
  dvi_space *space = unit_space(kind);
  const galerkin g = galerkin_of(space, rapid, minus_square, NULL);
  dvi_space_destroy(&space);
  return g;
}

/* With four parts a period, quadratures have no error in double precision. The phase 2 pi x/eps,
 * which grows to 250, has the roundoff 3e-14. */
START_TEST(nodes_are_exact_at_any_size_of_cells)
{
  for (int cells = 4; cells <= 32; cells *= 2) {
    galerkin g = problem_of("msfem:cells=%d,fine=%d", cells, 160 / cells);
    ck_assert_double_lt(error_with_load(&g, cells), 3e-14);
    galerkin_clear(&g);
  }
}
END_TEST

/* The load h f at nodes has the order 1 here, because f phi is not smooth within a cell. The digits
 * are those of an independent program. */
START_TEST(lumped_loads_lose_the_nodes)
{
  const double expected[] = {2.3e-2, 4.5e-3, 2.1e-3};
  for (int i = 0; i < 3; i++) {
    const int cells = 4 << i;
    galerkin g = problem_of("msfem:cells=%d,fine=%d", cells, 160 / cells);
    for (int k = 1; k < cells; k++) g.load[k - 1] = -(double)k * k / cells / cells / cells;
    ck_assert_double_eq_tol(error_with_load(&g, cells), expected[i], .05 * pow(10, -2 - (i > 0)));
    galerkin_clear(&g);
  }
}
END_TEST

/* Linear functions come from a constant coefficient, with the quadrature of 6400 points on the
 * axis. They see the arithmetic mean of a, 32.03, in place of the harmonic one, 10. The digits are
 * those of an independent program with 40000 points a cell. */
START_TEST(linear_elements_are_wrong_by_two_thirds)
{
  const dvi_axis axis = {.from = 0, .to = 1};
  const double expected[] = {.683650, .683897, .680854};
  for (int i = 0; i < 3; i++) {
    char kind[64];
    snprintf(kind, sizeof kind, "msfem:cells=%d,fine=%d", 4 << i, 800 / (4 << i));
    dvi_space *space = space_with(kind, &axis, unit);
    galerkin g = galerkin_of(space, rapid, minus_square, NULL);
    ck_assert_double_eq_tol(error_with_load(&g, 4 << i), expected[i], 1e-6);
    galerkin_clear(&g);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* ---- waves ---- */

static double lowest(galerkin g, double *highest)
{
  double *omega = malloc((size_t)g.inside * sizeof *omega);
  galerkin_frequencies(&g, omega);
  const double first = omega[0];
  if (highest != NULL) *highest = omega[g.inside - 1];
  free(omega);
  galerkin_clear(&g);
  return first;
}

/* From the matrix that carries (u, a u') over a period, by 2000 steps of Magnus and Gauss of order
 * 4, whose 40th power has no entry for u(1) from a u'(0). */
static const double first_frequency = 9.934237856985;

/* The error of 4 cells a period is of this size. */
START_TEST(the_lowest_frequency_on_a_fine_mesh)
{
  ck_assert_double_eq_tol(lowest(problem_of("fem:cells=%d,degree=4,points=%d", 160, 40), NULL),
                          first_frequency, 2e-5);
}
END_TEST

/* Digits of an independent program. Bounds of the step of leapfrog are 2 over the highest one. */
START_TEST(frequencies_and_steps_of_waves)
{
  const double expected[] = {9.997469273, 9.950195246, 9.938128061};
  const double step[] = {.0243, .0118, .0062};
  for (int i = 0; i < 3; i++) {
    double highest;
    const int cells = 8 << i;
    ck_assert_double_eq_tol(
        lowest(problem_of("msfem:cells=%d,fine=%d", cells, 160 / cells), &highest), expected[i],
        .6e-9);
    ck_assert_double_eq_tol(2 / highest, step[i], 1e-4);
  }
}
END_TEST

/* No node is exact of a wave, but the order is 2 long before a cell is as small as a period. */
START_TEST(frequencies_have_order_2_at_cells_beyond_the_period)
{
  double error[4];
  for (int i = 0; i < 4; i++) {
    const int cells = 4 << i;
    error[i] = lowest(problem_of("msfem:cells=%d,fine=%d", cells, 160 / cells), NULL) -
               first_frequency;
  }
  for (int i = 1; i < 4; i++) ck_assert_double_eq_tol(log2(error[i - 1] / error[i]), 2, .05);
}
END_TEST

/* Linear functions come from a constant coefficient, with the quadrature of 400 points a cell. The
 * digits are those of an independent program with 100000 points a cell. */
START_TEST(linear_elements_miss_the_frequency)
{
  const dvi_axis axis = {.from = 0, .to = 1};
  dvi_space *space = space_with("msfem:cells=16,fine=50", &axis, unit);
  const galerkin g = galerkin_of(space, rapid, NULL, NULL);
  dvi_space_destroy(&space);
  ck_assert_double_eq_tol(lowest(g, NULL), 17.57831372, 1e-7);
}
END_TEST

/* ---- functions ---- */

/* The integral of 1/a from 0 to x. */
static double resistance(double x)
{
  const double k = 2 * pi / eps;
  return (x + .95 * (1 - cos(k * x)) / k) / 10;
}

START_TEST(functions_are_shares_of_the_resistance)
{
  const double node[] = {0, .1, .31, 1};
  const dvi_axis axis = {.from = 0, .to = 1, .node = node, .nodes = 4};
  dvi_space *space = space_of("msfem:fine=120", &axis);
  const int value = 0, slope = 1;
  const double U[] = {0, 0, 1, 0};
  for (int i = 0; i <= 100; i++) {
    const double x = .1 + (.31 - .1) * i / 100, whole = resistance(.31) - resistance(.1);
    double u, du, a;
    ck_assert_int_eq(dvi_space_evaluate(space, &value, U, 1, &x, &u), DVI_OK);
    ck_assert_double_eq_tol(u, (resistance(x) - resistance(.1)) / whole, 1e-13);
    if (i == 100) continue; /* where the next cell begins */
    ck_assert_int_eq(dvi_space_evaluate(space, &slope, U, 1, &x, &du), DVI_OK);
    rapid(1, &x, &a, NULL);
    ck_assert_double_eq_tol(du, 1 / (a * whole), 1e-8 / whole);
  }
  dvi_space_destroy(&space);
}
END_TEST

static int straight(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = 2 + 3 * x[i];
  return 0;
}

START_TEST(coefficients_are_values_at_nodes)
{
  const double node[] = {0, .1, .31, 1};
  const dvi_axis axis = {.from = 0, .to = 1, .node = node, .nodes = 4};
  dvi_space *space = space_of("msfem:fine=40", &axis);
  double U[4];
  ck_assert_int_eq(dvi_space_interpolate(space, straight, NULL, U), DVI_OK);
  for (int i = 0; i < 4; i++) ck_assert_double_eq_tol(U[i], 2 + 3 * node[i], 1e-15);
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(the_sum_of_all_functions_is_1_on_a_circle)
{
  const dvi_axis axis = {.from = -1, .to = 1, .periodic = 1};
  for (int cells = 1; cells <= 3; cells++) {
    char kind[32];
    const double U[] = {1, 1, 1}, x = 7.3;
    const int order[] = {0, 1};
    double u;
    snprintf(kind, sizeof kind, "msfem:cells=%d,fine=200", cells);
    dvi_space *space = space_of(kind, &axis);
    ck_assert_int_eq(dvi_space_functions(space), cells);
    for (int k = 0; k < 2; k++) {
      ck_assert_int_eq(dvi_space_evaluate(space, &order[k], U, 1, &x, &u), DVI_OK);
      ck_assert_double_eq_tol(u, k == 0, 1e-14);
    }
    dvi_space_destroy(&space);
  }
}
END_TEST

START_TEST(the_space_tells_how_well_it_sees_the_coefficient)
{
  char text[400];
  dvi_space *space = unit_space("msfem:cells=8,fine=20");
  dvi_space_explain(space, text, sizeof text);
  const char *begin = "axis x, 0 to 1: msfem, 8 cells: 9 functions, 20 parts of each cell with 8 "
                      "Gauss points, from which the integrals of 1/a differ by ";
  ck_assert_msg(strncmp(text, begin, strlen(begin)) == 0, "%s", text);
  ck_assert_double_lt(strtod(text + strlen(begin), NULL), 1e-14);
  dvi_space_destroy(&space);
}
END_TEST

/* ---- refusals ---- */

typedef struct spoiled {
  double from, a; /* the coefficient from a place on */
  int answer;
} spoiled;

static int spoil(int64_t count, const double *x, double *a, void *user)
{
  const spoiled *s = user;
  for (int64_t i = 0; i < count; i++) a[i] = x[i] > s->from ? s->a : 1;
  return x[count - 1] > s->from ? s->answer : 0;
}

static void refuse(dvi_space_options options, dvi_status status, const char *words)
{
  const dvi_axis axis[3] = {{.from = 0, .to = 1}, {.from = 0, .to = 1}, {.from = 0, .to = 1}};
  dvi_space *space;
  options.size = sizeof options;
  options.axis = axis;
  ck_assert_int_eq(dvi_space_create(&options, &space), status);
  ck_assert_ptr_null(space);
  check_words(words);
}

START_TEST(coefficients_that_are_not_positive_are_refused)
{
  const double bad[] = {0, -1, NAN, INFINITY};
  for (int i = 0; i < 4; i++)
    for (int axes = 1; axes <= 2; axes++) {
      spoiled s = {.77, bad[i], 0};
      refuse(
          (dvi_space_options){
              .kind = "msfem:cells=4,fine=2", .axes = axes, .coefficient = spoil, .user = &s},
          DVI_NOT_FINITE, "space: msfem: the coefficient is ");
    }
}
END_TEST

START_TEST(callbacks_that_fail_are_reported)
{
  for (int axes = 1; axes <= 2; axes++) {
    spoiled s = {.77, 1, -3};
    refuse(
        (dvi_space_options){
            .kind = "msfem:cells=4,fine=2", .axes = axes, .coefficient = spoil, .user = &s},
        DVI_CALLBACK_FAILED, "the coefficient returned -3 instead of 0");
  }
}
END_TEST

/* Thirteen periods a cell in one part of 8 points. */
START_TEST(parts_that_do_not_see_the_coefficient_are_refused)
{
  for (int axes = 1; axes <= 2; axes++)
    refuse((dvi_space_options){.kind = "msfem:cells=3,fine=1", .axes = axes, .coefficient = rapid},
           DVI_BAD_OPTION, "fine=1 does not resolve the coefficient");
}
END_TEST

START_TEST(bad_options_are_refused)
{
  const struct {
    const char *kind;
    int axes;
    dvi_status status;
    const char *words;
  } bad[] = {
      {"msfem", 1, DVI_BAD_OPTION, "no cells"},
      {"msfem:cells=4,fine=0", 1, DVI_BAD_OPTION, "fine=0"},
      {"msfem:cells=4,fine=513", 1, DVI_BAD_OPTION, "fine=513"},
      {"msfem:cells=4,edges=bent", 2, DVI_BAD_OPTION, "solved and linear and oversampled"},
      {"msfem:cells=4,edges=linear", 1, DVI_BAD_OPTION, "edges=linear on one axis"},
      {"msfem:cells=4,edges=linear,overlap=3", 2, DVI_BAD_OPTION, "overlap=3"},
      {"msfem:cells=4", 3, DVI_UNSUPPORTED, "msfem on 3 axes"},
      {"msfem:cells=1048576,fine=512", 1, DVI_BAD_SIZE, "points asked"},
      {"msfem:cells=4096,fine=64", 2, DVI_BAD_SIZE, "are too many"},
      {"msfem:cells=256,fine=64,points=16", 2, DVI_BAD_SIZE, "points asked"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
    refuse((dvi_space_options){.kind = bad[i].kind, .axes = bad[i].axes, .coefficient = rapid},
           bad[i].status, bad[i].words);
  refuse((dvi_space_options){.kind = "msfem:cells=4", .axes = 1}, DVI_BAD_ARGUMENT,
         "set options.coefficient");
}
END_TEST

START_TEST(no_memory_is_reported)
{
  const dvi_axis axis = {.from = 0, .to = 1};
  const dvi_space_options options = {.size = sizeof options,
                                     .kind = "msfem:cells=2,fine=40",
                                     .axis = &axis,
                                     .axes = 1,
                                     .coefficient = rapid};
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

SUITE(multiscale_line)
{
  tcase_add_test(tests, the_exact_solution_has_its_digits);
  tcase_add_test(tests, nodes_are_exact_at_any_size_of_cells);
  tcase_add_test(tests, lumped_loads_lose_the_nodes);
  tcase_add_test(tests, linear_elements_are_wrong_by_two_thirds);
  tcase_add_test(tests, the_lowest_frequency_on_a_fine_mesh);
  tcase_add_test(tests, frequencies_and_steps_of_waves);
  tcase_add_test(tests, frequencies_have_order_2_at_cells_beyond_the_period);
  tcase_add_test(tests, linear_elements_miss_the_frequency);
  tcase_add_test(tests, functions_are_shares_of_the_resistance);
  tcase_add_test(tests, coefficients_are_values_at_nodes);
  tcase_add_test(tests, the_sum_of_all_functions_is_1_on_a_circle);
  tcase_add_test(tests, the_space_tells_how_well_it_sees_the_coefficient);
  tcase_add_test(tests, coefficients_that_are_not_positive_are_refused);
  tcase_add_test(tests, callbacks_that_fail_are_reported);
  tcase_add_test(tests, parts_that_do_not_see_the_coefficient_are_refused);
  tcase_add_test(tests, bad_options_are_refused);
  tcase_add_test(tests, no_memory_is_reported);
}
