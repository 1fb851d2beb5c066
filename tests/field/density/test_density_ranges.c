/* Gradients by ranges of coordinates, and the shorter ways of large fields: points that are
 * coordinates, rows that repeat, and steps that are taken together. */
#include <dvi/run.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/field/densities.h"
#include "support/suite.h"

static const char *const kinds[] = {
    "fem:degree=1,cells=61,lumped=yes", "fem:degree=2,cells=40,lumped=yes",
    "fem:degree=3,cells=33,lumped=yes", "fem:degree=1,cells=64", "spline:degree=3,cells=70"};
enum { KINDS = sizeof kinds / sizeof *kinds, LUMPED = 3 };

/* V = (1 + x^3) (1 - cos u), which is not periodic in x. A second variable, the slope, does nothing
 * but keep points from being coordinates. */
static int uneven_pendula(int count, double t, const double *x, const double *z, double *l,
                          double *l_z, double *l_zz, void *user)
{
  const int variables = user != NULL ? 2 : 1;
  (void)t;
  for (int k = 0; k < count; k++) {
    const double c = 1 + x[k] * x[k] * x[k];
    if (l != NULL) l[k] = c * (cos(z[k]) - 1);
    if (l_z != NULL) l_z[k] = -c * sin(z[k]);
    if (l_z != NULL && variables == 2) l_z[count + k] = 0;
    if (l_zz != NULL) l_zz[k] = -c * cos(z[k]);
    for (int e = 1; e <= 2 && l_zz != NULL && variables == 2; e++) l_zz[e * count + k] = 0;
  }
  return 0;
}

static const dvi_jet value_and_slope[] = {{.order = {0}}, {.order = {1}}};
static const dvi_density_part uneven_part = {.kind = DVI_DENSITY_POTENTIAL,
                                             .variable = value_and_slope,
                                             .variables = 1,
                                             .density = uneven_pendula},
                              general_part = {.kind = DVI_DENSITY_POTENTIAL,
                                              .variable = value_and_slope,
                                              .variables = 2,
                                              .density = uneven_pendula,
                                              .user = (void *)value_and_slope};

static int one_and_a_half(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = 1.5;
  return 0;
}

static density_field make(const char *kind, int periodic, int fixed, const dvi_density_part *last)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, *last};
  const dvi_density_condition left = {.part = "left", .kind = DVI_FIXED, .datum = one_and_a_half};
  return make_density(make_density_space(kind, 1, 0.25, 2, periodic), parts, 3, &left, fixed);
}

static density_field make_plane(const char *kind)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, uneven_part};
  return make_density(make_density_space(kind, 2, 0.25, 2, 0), parts, 3, NULL, 0);
}

static dvi_system_terms terms_of(const density_field *field)
{
  dvi_system_terms terms;
  ck_assert_int_eq(dvi_density_system_terms(field->density, &terms), DVI_OK);
  return terms;
}

/* On a circle neighbours are two numbers apart, and 2 degree of them are coupled. */
START_TEST(circles_have_ranges_of_a_short_reach)
{
  static const int reach[] = {2, 4, 6, 2, 6};
  for (int i = 0; i < KINDS; i++) {
    density_field field = make(kinds[i], 1, 0, &uneven_part);
    const dvi_system_terms terms = terms_of(&field);
    for (int k = 0; k < terms.potential_count; k++) {
      ck_assert(terms.potentials[k].gradient_range != NULL);
      ck_assert_int_le(terms.potentials[k].reach, i < LUMPED && k == 1 ? 0 : reach[i]);
    }
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* A node is coupled to the one behind the next of the next row. Gauss's points of two rows of cells
 * touch a coordinate, and those of the nodes one. */
START_TEST(planes_have_ranges_of_a_row_where_points_are_nodes)
{
  for (int lumped = 0; lumped < 2; lumped++) {
    density_field field = make_plane(lumped ? "fem:degree=1,cells=20,lumped=yes"
                                            : "fem:degree=1,cells=20");
    const dvi_system_terms terms = terms_of(&field);
    ck_assert(terms.potentials[0].gradient_range != NULL);
    ck_assert_int_le(terms.potentials[0].reach, 22);
    ck_assert_int_eq(terms.potentials[1].gradient_range != NULL, lumped);
    ck_assert_int_eq(terms.potentials[1].reach, 0);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* A sum of two roundings for each of two points beside one of both: a few units of the largest
 * entry, which is about 9 (1 + x^3) w with a weight w of 0.05 at most. */
static void compare_potentials(const char *kind, int periodic, int fixed)
{
  density_field one = make(kind, periodic, fixed, &uneven_part),
                other = make(kind, periodic, fixed, &general_part);
  const dvi_potential *a = &terms_of(&one).potentials[1], *b = &terms_of(&other).potentials[1];
  double first[200], second[200], V[2];
  ck_assert_int_le(one.n, 200);
  ck_assert_int_eq(one.n, other.n);
  for (int64_t i = 0; i < one.n; i++) one.q[i] = 2 * sin(1.3 * (double)i);
  ck_assert_int_eq(a->gradient(0, one.q, first, a->user), 0);
  ck_assert_int_eq(b->gradient(0, one.q, second, b->user), 0);
  for (int64_t i = 0; i < one.n; i++)
    ck_assert_msg(fabs(first[i] - second[i]) <= 2e-16, "%s: %d: %g and %g", kind, (int)i, first[i],
                  second[i]);
  ck_assert_int_eq(a->value(0, one.q, V, a->user), 0);
  ck_assert_int_eq(b->value(0, one.q, V + 1, b->user), 0);
  ck_assert_double_eq_tol(V[0], V[1], 1e-14 * fabs(V[1]));
  end_density(&one);
  end_density(&other);
}

START_TEST(points_that_are_coordinates_give_what_others_give)
{
  for (int i = 0; i < LUMPED; i++) {
    compare_potentials(kinds[i], 0, 0);
    compare_potentials(kinds[i], 1, 0);
    compare_potentials(kinds[i], 0, 1);
  }
}
END_TEST

/* V = (1 + x^3) (u^2 w + w^2). A third variable, the slope of u, does nothing. */
static int coupled(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  const double *u = z, *w = z + count;
  (void)t, (void)l_zz;
  for (int k = 0; k < count; k++) {
    const double c = -(1 + x[k] * x[k] * x[k]);
    if (l != NULL) l[k] = c * (u[k] * u[k] * w[k] + w[k] * w[k]);
    if (l_z == NULL) continue;
    l_z[k] = c * 2 * u[k] * w[k];
    l_z[count + k] = c * (u[k] * u[k] + 2 * w[k]);
    if (user != NULL) l_z[2 * count + k] = 0;
  }
  return 0;
}

static density_field make_pair(const char *kind, int periodic, int variables)
{
  static const dvi_jet rates[] = {{.rate = 1}, {.rate = 1, .component = 1}},
                       values[] = {{.order = {0}}, {.component = 1}, {.order = {1}}};
  dvi_density_part parts[] = {kinetic_part, kinetic_part, kinetic_part};
  parts[0].variable = rates;
  parts[1].variable = rates + 1;
  parts[2] = (dvi_density_part){.kind = DVI_DENSITY_POTENTIAL,
                                .variable = values,
                                .variables = variables,
                                .density = coupled,
                                .user = variables == 3 ? (void *)values : NULL};
  const dvi_density_terms terms = {.components = 2, .part = parts, .parts = 3};
  return make_density_of(make_density_space(kind, 1, 0.25, 2, periodic), terms);
}

/* Entries are at most 9 (|2 u w| + ..) w, about 1, and are sums of two. Ranges also end between the
 * components of a node. */
static void compare_pairs(const char *kind, int periodic)
{
  density_field one = make_pair(kind, periodic, 2), other = make_pair(kind, periodic, 3);
  const dvi_potential *a = &terms_of(&one).potentials[0], *b = &terms_of(&other).potentials[0];
  double whole[400], second[400], part[400];
  ck_assert_int_le(one.n, 400);
  for (int64_t i = 0; i < one.n; i++) one.q[i] = sin(1.3 * (double)i);
  ck_assert_int_eq(a->gradient(0, one.q, whole, a->user), 0);
  ck_assert_int_eq(b->gradient(0, one.q, second, b->user), 0);
  for (int64_t i = 0; i < one.n; i++) ck_assert_double_eq_tol(whole[i], second[i], 5e-16);
  for (int first = 0; first < one.n; first += 7)
    for (int last = first + 1; last <= one.n; last += 5) {
      ck_assert_int_eq(a->gradient_range(0, one.q, first, last, part, a->user), 0);
      ck_assert_mem_eq(part, whole + first, (size_t)(last - first) * sizeof *part);
    }
  end_density(&one);
  end_density(&other);
}

START_TEST(points_that_are_coordinates_of_several_components_give_what_others_give)
{
  for (int i = 0; i < LUMPED; i++) {
    compare_pairs(kinds[i], 0);
    compare_pairs(kinds[i], 1);
  }
}
END_TEST

/* The stiffness of equal cells repeats. Its product by repeated rows is that of its entries, to the
 * last bit, and so is that of any part of it. */
static void compare_products(const char *kind, int periodic)
{
  density_field field = make(kind, periodic, 0, &uneven_part);
  const dvi_potential *K_q = &terms_of(&field).potentials[0];
  dvi_matrix K;
  double whole[200], part[200], product[200];
  ck_assert_int_le(field.n, 200);
  for (int64_t i = 0; i < field.n; i++) field.q[i] = sin(1.3 * (double)i);
  ck_assert_int_eq(dvi_density_matrix(field.density, DVI_FIELD_STIFFNESS, &K), DVI_OK);
  dvi_matrix_multiply(&K, 0, field.q, product);
  ck_assert_int_eq(K_q->gradient(0, field.q, whole, K_q->user), 0);
  ck_assert_mem_eq(whole, product, (size_t)field.n * sizeof *whole);
  for (int first = 0; first < field.n; first += 7)
    for (int last = first + 1; last <= field.n; last += 5) {
      ck_assert_int_eq(K_q->gradient_range(0, field.q, first, last, part, K_q->user), 0);
      ck_assert_mem_eq(part, whole + first, (size_t)(last - first) * sizeof *part);
    }
  end_density(&field);
}

START_TEST(repeated_rows_have_the_bits_of_entries)
{
  for (int i = 0; i < KINDS; i++) {
    compare_products(kinds[i], 0);
    compare_products(kinds[i], 1);
  }
}
END_TEST

/* A hundred equal cells of a circle have equal weights, to the last bit. */
START_TEST(equal_cells_of_a_circle_have_one_mass)
{
  density_field field = make("fem:degree=1,cells=100,lumped=yes", 1, 0, &uneven_part);
  ck_assert_double_eq(terms_of(&field).mass.scalar, 1.75 / 100);
  end_density(&field);
}
END_TEST

/* ---- runs ---- */

static void run_in(const density_field *field, const char *method, int together, double *end)
{
  const double h = 0x1p-13;
  const int steps = 101;
  const size_t bytes = (size_t)field->n * sizeof(double);
  dvi_integrator *integrator = NULL;
  dvi_counters counters;
  ck_assert_msg(dvi_integrator_create(field->system, method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, field->q, field->p), DVI_OK);
  const dvi_run_options options = {.h = h, .t_end = h * steps};
  dvi_run_report report;
  if (together) ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  if (together) ck_assert_int_eq(report.steps, steps);
  for (int i = 0; i < steps && !together; i++)
    ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_OK);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.steps, steps);
  ck_assert_double_eq(dvi_integrator_time(integrator), h * steps);
  ck_assert_double_eq(dvi_integrator_last_step(integrator), h);
  memcpy(end, dvi_integrator_q(integrator), bytes);
  memcpy(end + field->n, dvi_integrator_p(integrator), bytes);
  dvi_integrator_destroy(&integrator);
}

START_TEST(steps_that_are_taken_together_have_the_bits_of_single_ones)
{
  static const char *const methods[] = {"verlet:blocking=none", "verlet:blocking=temporal",
                                        "verlet:threads=2", "composition:order=4"};
  enum { MOST = 6000 };
  static double single[2 * MOST], end[2 * MOST];
  for (int kind = 0; kind < 3; kind++) { /* an interval, a circle, a plane */
    density_field field = kind == 2
                              ? make_plane("fem:degree=1,cells=40,lumped=yes")
                              : make("fem:degree=2,cells=2000,lumped=yes", kind, 0, &uneven_part);
    ck_assert_int_le(field.n, MOST);
    for (int64_t i = 0; i < field.n; i++) field.q[i] = sin(0.01 * (double)i);
    for (int m = 0; m < 4; m++) {
      run_in(&field, methods[m], 0, m == 0 || m == 3 ? single : end);
      if (m == 1 || m == 2) ck_assert_mem_eq(single, end, 2 * (size_t)field.n * sizeof(double));
      run_in(&field, methods[m], 1, end);
      ck_assert_mem_eq(single, end, 2 * (size_t)field.n * sizeof(double));
    }
    end_density(&field);
  }
}
END_TEST

/* l = u^4, by which a field of 5 is not finite soon after 0.07. */
static int explosive(int count, double t, const double *x, const double *z, double *l, double *l_z,
                     double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = pow(z[k], 4);
    if (l_z != NULL) l_z[k] = 4 * pow(z[k], 3);
    if (l_zz != NULL) l_zz[k] = 12 * z[k] * z[k];
  }
  return 0;
}

static const dvi_density_part explosive_part = {.kind = DVI_DENSITY_POTENTIAL,
                                                .variable = value_and_slope,
                                                .variables = 1,
                                                .density = explosive};

START_TEST(a_run_that_fails_ends_where_single_steps_end)
{
  density_field field = make("fem:degree=2,cells=2000,lumped=yes", 1, 0, &explosive_part);
  const size_t bytes = (size_t)field.n * sizeof(double);
  const dvi_run_options options = {.h = 0x1p-13, .t_end = 1};
  dvi_integrator *run = NULL, *single = NULL;
  dvi_run_report report;
  long steps = 0;
  for (int64_t i = 0; i < field.n; i++) field.q[i] = 5;
  ck_assert_int_eq(dvi_integrator_create(field.system, "verlet", &run), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(field.system, "verlet", &single), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(run, 0, field.q, field.p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(single, 0, field.q, field.p), DVI_OK);
  const dvi_status status = dvi_run(run, &options, &report);
  while (dvi_integrator_step(single, options.h) == DVI_OK) steps++;
  ck_assert_int_ne(status, DVI_OK);
  ck_assert_int_gt(steps, 33);
  ck_assert_int_eq(report.steps, steps);
  ck_assert_double_eq(dvi_integrator_time(run), dvi_integrator_time(single));
  ck_assert_mem_eq(dvi_integrator_q(run), dvi_integrator_q(single), bytes);
  ck_assert_mem_eq(dvi_integrator_p(run), dvi_integrator_p(single), bytes);
  dvi_integrator_destroy(&run);
  dvi_integrator_destroy(&single);
  end_density(&field);
}
END_TEST

SUITE(density_ranges)
{
  tcase_add_test(tests, a_run_that_fails_ends_where_single_steps_end);
  tcase_add_test(tests, circles_have_ranges_of_a_short_reach);
  tcase_add_test(tests, planes_have_ranges_of_a_row_where_points_are_nodes);
  tcase_add_test(tests, points_that_are_coordinates_give_what_others_give);
  tcase_add_test(tests, points_that_are_coordinates_of_several_components_give_what_others_give);
  tcase_add_test(tests, repeated_rows_have_the_bits_of_entries);
  tcase_add_test(tests, equal_cells_of_a_circle_have_one_mass);
  tcase_add_test(tests, steps_that_are_taken_together_have_the_bits_of_single_ones);
}
