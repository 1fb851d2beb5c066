/* Fields with densities that are refused, and why. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/densities.h"
#include "support/suite.h"

static const dvi_jet rate = {.rate = 1}, value = {0}, second = {.order = {2}};

static int bad_number(int count, double t, const double *x, const double *z, double *l, double *l_z,
                      double *l_zz, void *user)
{
  (void)t, (void)x, (void)z;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0;
    if (l_z != NULL) l_z[k] = 0;
    if (l_zz != NULL) l_zz[k] = *(const double *)user;
  }
  return 0;
}

static int failing(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)count, (void)t, (void)x, (void)z, (void)l, (void)l_z, (void)l_zz, (void)user;
  return -3;
}

static int no_rate_in_time(int count, double t, const double *x, const double *z, double *l_t,
                           void *user)
{
  (void)count, (void)t, (void)x, (void)z, (void)l_t, (void)user;
  return 0;
}

/* Tries terms on a space, and requires a status with some words. */
static void refuse_on(const char *kind, int periodic, dvi_density_terms terms, dvi_status status,
                      const char *words)
{
  dvi_space *space = make_density_space(kind, 1, 0, 1, periodic);
  dvi_density *density = NULL;
  terms.size = sizeof terms;
  terms.space = space;
  if (terms.components == 0) terms.components = 1;
  const dvi_status found = dvi_density_create(&terms, &density);
  ck_assert_msg(found == status, "%s: %s", words, found == DVI_OK ? "taken" : dvi_last_error());
  ck_assert(density == NULL);
  check_words(words);
  dvi_space_destroy(&space);
}

static void refuse_part(dvi_density_part part, dvi_status status, const char *words)
{
  refuse_on("fem:degree=2,cells=4", 0, (dvi_density_terms){.part = &part, .parts = 1}, status,
            words);
}

static void refuse_condition(dvi_density_condition condition, dvi_status status, const char *words)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  refuse_on(
      "fem:degree=2,cells=4", 0,
      (dvi_density_terms){.part = parts, .parts = 2, .condition = &condition, .conditions = 1},
      status, words);
}

START_TEST(terms_without_sense_are_refused)
{
  dvi_space *space = make_density_space("fem:degree=1,cells=4", 1, 0, 1, 0);
  dvi_density *density = NULL;
  dvi_density_terms terms = {.space = space};
  ck_assert_int_eq(dvi_density_create(NULL, &density), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_create(&terms, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_create(&terms, &density), DVI_BAD_ARGUMENT);
  check_words("set terms.size");
  terms = (dvi_density_terms){.size = sizeof terms};
  ck_assert_int_eq(dvi_density_create(&terms, &density), DVI_BAD_ARGUMENT);
  check_words("a space is needed");
  terms.space = space;
  ck_assert_int_eq(dvi_density_create(&terms, &density), DVI_BAD_ARGUMENT);
  check_words("0 components asked, 1 to 16 possible");
  terms.components = 1;
  ck_assert_int_eq(dvi_density_create(&terms, &density), DVI_BAD_ARGUMENT);
  check_words("there is no part");
  terms.conditions = 1;
  ck_assert_int_eq(dvi_density_create(&terms, &density), DVI_BAD_ARGUMENT);
  check_words("1 conditions are announced");
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(parts_without_sense_are_refused)
{
  static const int above[1][2] = {{0, 1}}, twice[2][2] = {{0, 0}, {0, 0}};
  const dvi_jet other = {.component = 1}, negative = {.order = {-1}}, across = {.order = {0, 1}};
  const dvi_jet same[] = {value, value};
  dvi_density_part part = elastic_part;
  part.kind = 9;
  refuse_part(part, DVI_BAD_ARGUMENT, "part 0 has no kind 9");
  part = elastic_part, part.density = NULL;
  refuse_part(part, DVI_BAD_ARGUMENT, "part 'elastic' has no callback `density`");
  part = elastic_part, part.variables = 65;
  refuse_part(part, DVI_BAD_ARGUMENT, "has 65 variables, 1 to 64 possible");
  part = elastic_part, part.variable = &other;
  refuse_part(part, DVI_BAD_ARGUMENT, "has component 1, 0 to 0 possible");
  part = elastic_part, part.variable = &negative;
  refuse_part(part, DVI_BAD_ARGUMENT, "has -1 derivatives along axis 0");
  part = elastic_part, part.variable = &across;
  refuse_part(part, DVI_BAD_ARGUMENT, "has 1 derivatives along axis 1 of 1");
  part = elastic_part, part.variable = same, part.variables = 2;
  refuse_part(part, DVI_BAD_ARGUMENT, "variables 0 and 1 of part 'elastic' are the same");
  part = elastic_part, part.pair = above, part.pairs = 1;
  refuse_part(part, DVI_BAD_ARGUMENT, "pair 0 of part 'elastic' is (0,1)");
  part = elastic_part, part.pair = twice, part.pairs = 2;
  refuse_part(part, DVI_BAD_ARGUMENT, "pairs 0 and 1 of part 'elastic' are the same");
  part = elastic_part, part.pairs = 2;
  refuse_part(part, DVI_BAD_ARGUMENT, "has 2 pairs: give them with their count");
  part = elastic_part, part.time_derivative = no_rate_in_time;
  refuse_part(part, DVI_BAD_ARGUMENT, "has a derivative in time, and does not depend on time");
}
END_TEST

START_TEST(parts_of_other_kinds_are_refused)
{
  dvi_density_part part = kinetic_part;
  part.variable = &value;
  refuse_part(part, DVI_BAD_ARGUMENT, "kinetic part 'kinetic' has a variable that is no rate");
  part = kinetic_part, part.depends_on_time = 1;
  refuse_part(part, DVI_BAD_ARGUMENT, "kinetic part 'kinetic' depends on time");
  part = elastic_part, part.variable = &rate;
  refuse_part(part, DVI_BAD_ARGUMENT, "quadratic part 'elastic' has a rate");
  part = sine_gordon_part, part.variable = &rate;
  refuse_part(part, DVI_BAD_ARGUMENT, "potential part 'pendula' has a rate");
  part.variable = &value, part.kind = DVI_DENSITY_ONE_FORM;
  refuse_part(part, DVI_BAD_ARGUMENT, "one-form 'pendula' has no rate");
  part = sine_gordon_part, part.kind = DVI_DENSITY_QUADRATIC;
  refuse_part(part, DVI_BAD_ARGUMENT, "part 'pendula' is not quadratic: its kind is potential");
  part = sine_gordon_part, part.kind = DVI_DENSITY_KINETIC, part.variable = &rate;
  refuse_part(part, DVI_BAD_ARGUMENT, "is not a quadratic form of rates: its kind is general");
  part = kinetic_part, part.kind = DVI_DENSITY_ONE_FORM;
  refuse_part(part, DVI_BAD_ARGUMENT, "is not linear in its rates");
}
END_TEST

START_TEST(parts_that_do_not_go_together_are_refused)
{
  static const dvi_jet pair[] = {{.order = {1}}, {.rate = 1}};
  double zero = 0;
  const dvi_density_part form = {.kind = DVI_DENSITY_ONE_FORM,
                                 .variable = pair + 1,
                                 .variables = 1,
                                 .density = bad_number,
                                 .user = &zero};
  const dvi_density_part parts[] = {form, kinetic_part};
  refuse_on("fem:degree=2,cells=4", 0, (dvi_density_terms){.part = parts, .parts = 2},
            DVI_UNSUPPORTED, "a one-form does not go with a kinetic part");
}
END_TEST

START_TEST(derivatives_that_a_space_has_not_are_refused)
{
  dvi_density_part part = elastic_part;
  part.variable = &second;
  refuse_part(part, DVI_UNSUPPORTED, "density: variable 0 of part 'elastic'");
}
END_TEST

START_TEST(failures_of_callbacks_are_named)
{
  double nan = NAN;
  dvi_density_part part = elastic_part;
  part.density = failing;
  refuse_part(part, DVI_CALLBACK_FAILED, "part 'elastic' returned -3");
  part.density = bad_number, part.user = &nan;
  refuse_part(part, DVI_NOT_FINITE, "part 'elastic' is not finite at x = ");
}
END_TEST

START_TEST(singular_masses_name_a_component)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  double zero = 0;
  refuse_on("fem:degree=2,cells=4", 0,
            (dvi_density_terms){.components = 2, .part = parts, .parts = 2}, DVI_SINGULAR,
            "the mass of component 1 is singular");
  dvi_density_part massless = kinetic_part;
  massless.density = bad_number, massless.user = &zero;
  refuse_part(massless, DVI_SINGULAR, "the mass of component 0 is singular");
  /* two points a cell cannot tell the functions of degree 3 apart */
  refuse_on("fem:degree=3,cells=4,points=2", 0, (dvi_density_terms){.part = parts, .parts = 2},
            DVI_SINGULAR, "the mass of component 0 is singular: take more quadrature points");
}
END_TEST

/* l = u_x u_t/2. */
static int circle_form(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0.5 * z[k] * z[count + k];
    if (l_z != NULL) l_z[k] = 0.5 * z[count + k], l_z[count + k] = 0.5 * z[k];
    if (l_zz != NULL) l_zz[k] = l_zz[2 * count + k] = 0, l_zz[count + k] = 0.5;
  }
  return 0;
}

START_TEST(singular_two_forms_are_refused)
{
  static const dvi_jet pair[] = {{.order = {1}}, {.rate = 1}};
  dvi_density_part parts[] = {
      {.kind = DVI_DENSITY_ONE_FORM, .variable = pair, .variables = 2, .density = circle_form},
      elastic_part,
      sine_gordon_part};
  const dvi_density_terms terms = {.part = parts, .parts = 2};
  refuse_on("spline:degree=3,cells=10", 1, terms, DVI_SINGULAR,
            "the two-form of an odd number of coordinates, 9 without the constants, is singular: "
            "take one cell more or less");
  /* with a potential of u the constants cannot be left out */
  dvi_density_terms bound = terms;
  bound.parts = 3;
  refuse_on("spline:degree=3,cells=10", 1, bound, DVI_SINGULAR, "the two-form is singular");
  refuse_on("spline:degree=3,cells=11", 1, bound, DVI_SINGULAR, "an odd number of coordinates, 11");
}
END_TEST

/* ---- conditions ---- */

static int nan_datum(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = NAN;
  return 0;
}

static int failing_datum(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)count, (void)t, (void)x, (void)datum, (void)user;
  return 2;
}

static int still(int64_t count, double t, const double *x, double *first, double *more, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) first[k] = 0;
  for (int64_t k = 0; k < count && more != NULL; k++) more[k] = 0;
  return 0;
}

START_TEST(conditions_without_sense_are_refused)
{
  refuse_condition((dvi_density_condition){0}, DVI_BAD_ARGUMENT,
                   "condition 0 has no part of the boundary");
  refuse_condition((dvi_density_condition){.part = "left", .kind = 7}, DVI_BAD_ARGUMENT,
                   "the condition on \"left\" has no kind 7");
  refuse_condition((dvi_density_condition){.part = "left", .component = 1}, DVI_BAD_ARGUMENT,
                   "is for component 1");
  refuse_condition((dvi_density_condition){.part = "top"}, DVI_BAD_ARGUMENT,
                   "a condition is set on \"top\", which is no part of the boundary");
  refuse_condition((dvi_density_condition){.part = "left", .kind = DVI_FIXED, .rate = still},
                   DVI_BAD_ARGUMENT, "the datum on \"left\" has a rate, and no value");
  refuse_condition((dvi_density_condition){.part = "left", .robin = INFINITY}, DVI_NOT_FINITE,
                   "`robin` on \"left\" is inf");
  refuse_condition((dvi_density_condition){.part = "left", .kind = DVI_FIXED, .robin = 1},
                   DVI_BAD_ARGUMENT, "values on \"left\" are fixed, and `robin` is set");
  refuse_condition((dvi_density_condition){.part = "left", .kind = DVI_FIXED, .datum = nan_datum},
                   DVI_NOT_FINITE, "the datum on \"left\" is nan at x = 0");
  refuse_condition((dvi_density_condition){.part = "right", .datum = nan_datum}, DVI_NOT_FINITE,
                   "the datum on \"right\" is nan at x = 1");
  refuse_condition(
      (dvi_density_condition){.part = "left", .kind = DVI_FIXED, .datum = failing_datum},
      DVI_CALLBACK_FAILED, "the datum on \"left\" returned 2");
}
END_TEST

START_TEST(conditions_that_a_field_cannot_have_are_refused)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  const dvi_density_condition all = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_density_terms terms = {.part = parts, .parts = 2, .condition = &all, .conditions = 1};
  refuse_on("fourier:modes=3", 1, terms, DVI_BAD_ARGUMENT,
            "which is no part of the boundary: fourier has none");
  refuse_on("fem:degree=1,cells=1", 0, terms, DVI_BAD_ARGUMENT,
            "all 2 coefficients are fixed, and nothing is unknown");
}
END_TEST

static int zero_datum(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = 0;
  return 0;
}

static const dvi_density_condition moving = {
    .part = "left", .kind = DVI_FIXED, .datum = zero_datum, .rate = still};

/* Tries terms on a square, and requires a status with some words. */
static void refuse_on_square(const char *kind, int periodic, dvi_density_terms terms,
                             dvi_status status, const char *words)
{
  dvi_space *space = make_density_space(kind, 2, 0, 1, periodic);
  dvi_density *density = NULL;
  terms.size = sizeof terms;
  terms.space = space;
  if (terms.components == 0) terms.components = 1;
  const dvi_status found = dvi_density_create(&terms, &density);
  ck_assert_msg(found == status, "%s: %s", words, found == DVI_OK ? "taken" : dvi_last_error());
  check_words(words);
  dvi_space_destroy(&space);
}

START_TEST(values_move_where_functions_have_nodes)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d};
  const dvi_density_terms terms = {
      .part = parts, .parts = 2, .condition = &moving, .conditions = 1};
  refuse_on_square("spline:degree=2,cells=3", 0, terms, DVI_UNSUPPORTED,
                   "values on \"left\" move, and functions are not 1 at nodes: take kind=fem");
}
END_TEST

START_TEST(values_of_one_forms_do_not_move)
{
  static const dvi_jet pair[] = {{.order = {1}}, {.rate = 1}};
  const dvi_density_part form = {
      .kind = DVI_DENSITY_ONE_FORM, .variable = pair, .variables = 2, .density = circle_form};
  const dvi_density_terms terms = {
      .part = &form, .parts = 1, .condition = &moving, .conditions = 1};
  refuse_on("fem:degree=1,cells=4", 0, terms, DVI_UNSUPPORTED,
            "values move on the boundary of a field of first order");
}
END_TEST

/* l = u u_t^2/2 as a general part, and l = u^2 v_t as a one-form. */
static int product(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  const double power = *(const double *)user; /* of the rate */
  (void)t, (void)x;
  for (int k = 0; k < count; k++) {
    const double u = z[k], v = z[count + k];
    const int is_form = power == 1;
    if (l != NULL) l[k] = is_form ? u * u * v : 0.5 * u * v * v;
    if (l_z != NULL) {
      l_z[k] = is_form ? 2 * u * v : 0.5 * v * v;
      l_z[count + k] = is_form ? u * u : u * v;
    }
    if (l_zz != NULL) {
      l_zz[k] = is_form ? 2 * v : 0;
      l_zz[count + k] = is_form ? 2 * u : v;
      l_zz[2 * count + k] = is_form ? 0 : u;
    }
  }
  return 0;
}

START_TEST(full_matrices_of_many_modes_are_refused)
{
  static const dvi_jet own[] = {{0}, {.rate = 1}}, pair[] = {{0}, {.component = 1, .rate = 1}};
  double power = 2;
  dvi_density_part part = {.kind = DVI_DENSITY_GENERAL,
                           .variable = own,
                           .variables = 2,
                           .density = product,
                           .user = &power};
  dvi_density_terms terms = {.part = &part, .parts = 1};
  refuse_on_square("fourier:modes=9", 1, terms, DVI_UNSUPPORTED,
                   "general parts have full Hessians on fourier, which are for at most 300 "
                   "coordinates, not 361");
  power = 1;
  part.kind = DVI_DENSITY_ONE_FORM, part.variable = pair;
  terms.components = 2;
  refuse_on_square("fourier:modes=6", 1, terms, DVI_UNSUPPORTED,
                   "a one-form that is not linear with constant coefficients has a full matrix on "
                   "fourier, which is for at most 300 coordinates, not 338");
}
END_TEST

START_TEST(static_states_of_too_many_modes_are_refused)
{
  const dvi_density_part parts[] = {elastic_part_2d, sine_gordon_part};
  density_field field = make_density(make_density_space("fourier:modes=23,points=48", 2, 0, 1, 1),
                                     parts, 2, NULL, 0);
  field.U[0] = 1;
  ck_assert_int_eq(dvi_density_solve(field.density, field.U, NULL), DVI_UNSUPPORTED);
  check_words("part 'pendula' has a full Hessian on fourier, which is for at most 2000 "
              "coordinates, not 2209");
  end_density(&field);
}
END_TEST

/* l = -exp(u) has no static state, and cubes of infinite numbers are not finite. */
static int without_end(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = -exp(z[k]);
    if (l_z != NULL) l_z[k] = -exp(z[k]);
    if (l_zz != NULL) l_zz[k] = -exp(z[k]);
  }
  return 0;
}

START_TEST(static_states_that_do_not_exist_are_not_found)
{
  dvi_density_part part = sine_gordon_part;
  part.density = without_end;
  density_field field = make_density(make_density_space("fem:degree=1,cells=4", 1, 0, 1, 0), &part,
                                     1, NULL, 0);
  ck_assert_int_eq(dvi_density_solve(field.density, field.U, NULL), DVI_NOT_CONVERGED);
  check_words("Newton's method stopped after 60 iterations");
  ck_assert_double_eq(field.U[0], 0);
  field.U[0] = 1e9;
  ck_assert_int_eq(dvi_density_solve(field.density, field.U, NULL), DVI_NOT_FINITE);
  check_words("the gradient of the start is not finite");
  end_density(&field);
}
END_TEST

START_TEST(fluxes_want_facets_of_the_boundary)
{
  const dvi_generator_options square = {.size = sizeof square, .dimension = 2, .cells = {2, 2}};
  static const int corner[] = {0};
  dvi_mesh *mesh = NULL, *marked = NULL;
  dvi_space *space = NULL;
  dvi_density *density = NULL;
  int width;
  ck_assert_int_eq(dvi_mesh_generate("kuhn", &square, &mesh), DVI_OK);
  const dvi_mesh_part point = {.name = "corner", .degree = 0, .count = 1, .vertex = corner};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 2,
                                .points = dvi_mesh_count(mesh, 0),
                                .point = dvi_mesh_points(mesh),
                                .kind = dvi_mesh_kind(mesh),
                                .cells = dvi_mesh_count(mesh, 2),
                                .vertex = dvi_mesh_vertices(mesh, 2, &width),
                                .part = &point,
                                .parts = 1};
  ck_assert_msg(dvi_mesh_create(&terms, &marked) == DVI_OK, "%s", dvi_last_error());
  const dvi_space_options options = {
      .size = sizeof options, .kind = "fem:degree=1", .mesh = marked};
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d};
  const dvi_density_condition flux = {.part = "corner", .datum = zero_datum};
  const dvi_density_terms field = {.size = sizeof field,
                                   .space = space,
                                   .components = 1,
                                   .part = parts,
                                   .parts = 2,
                                   .condition = &flux,
                                   .conditions = 1};
  ck_assert_int_eq(dvi_density_create(&field, &density), DVI_BAD_ARGUMENT);
  check_words("a flux is given on \"corner\", which has no facet of the boundary");
  dvi_space_destroy(&space);
  dvi_mesh_destroy(&marked);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(modes_are_as_many_as_unknowns)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  const dvi_modes_options many = {.size = sizeof many, .count = 6};
  double eigenvalue[6];
  density_field field = make_density(make_density_space("fem:degree=1,cells=4", 1, 0, 1, 0), parts,
                                     2, NULL, 0);
  ck_assert_int_eq(dvi_density_modes(field.density, &many, NULL, eigenvalue, NULL), DVI_BAD_SIZE);
  check_words("6 modes of 5 unknowns asked");
  end_density(&field);
}
END_TEST

/* ---- questions ---- */

START_TEST(questions_without_an_answer_are_refused)
{
  density_field field = make_density(make_density_space("fem:degree=1,cells=4", 1, 0, 1, 0),
                                     &sine_gordon_part, 1, NULL, 0);
  dvi_matrix matrix;
  double number, U[5] = {0};
  dvi_system_terms terms;
  const dvi_density *d = field.density;
  ck_assert_int_eq(dvi_density_matrix(d, DVI_FIELD_MASS, &matrix), DVI_UNSUPPORTED);
  check_words("the field has no mass, since it has no kinetic part");
  ck_assert_int_eq(dvi_density_matrix(d, DVI_FIELD_STIFFNESS, &matrix), DVI_UNSUPPORTED);
  check_words("the field has no stiffness, since it has no quadratic part");
  ck_assert_int_eq(dvi_density_matrix(d, 5, &matrix), DVI_BAD_ARGUMENT);
  check_words("there is no operator 5");
  ck_assert_int_eq(dvi_density_fastest(d, &number), DVI_UNSUPPORTED);
  check_words("the field has no mass, and no frequencies");
  ck_assert_int_eq(dvi_density_fastest_at(d, U, &number), DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_density_modes(d, NULL, NULL, &number, NULL), DVI_UNSUPPORTED);
  check_words("the field has no mass");
  ck_assert_int_eq(dvi_density_system_terms(d, &terms), DVI_UNSUPPORTED);
  check_words("the field has no rates");
  ck_assert_int_eq(dvi_density_project(d, U, NULL, NULL, NULL, U), DVI_UNSUPPORTED);
  check_words("no momenta");
  ck_assert_int_eq(dvi_density_matrix(NULL, DVI_FIELD_MASS, &matrix), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_fastest(NULL, &number), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_fastest_at(d, NULL, &number), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_modes(NULL, NULL, NULL, &number, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_system_terms(NULL, &terms), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_project(NULL, NULL, NULL, NULL, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_lift(d, 0, NULL, U), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_density_solve(d, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert(dvi_density_space(NULL) == NULL && dvi_density_components(NULL) == 0);
  ck_assert(dvi_density_unknowns(NULL, NULL) == NULL);
  end_density(&field);
}
END_TEST

/* Newton's method keeps the start where it fails. */
START_TEST(static_states_keep_their_start_on_failure)
{
  const dvi_density_condition ends = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_density_part parts[] = {
      elastic_part,
      {.kind = DVI_DENSITY_POTENTIAL, .variable = &value, .variables = 1, .density = failing}};
  density_field field = make_density(make_density_space("fem:degree=1,cells=4", 1, 0, 1, 0), parts,
                                     2, &ends, 1);
  field.U[2] = 3;
  ck_assert_int_eq(dvi_density_solve(field.density, field.U, NULL), DVI_CALLBACK_FAILED);
  check_words("returned -3 in potential");
  ck_assert_double_eq(field.U[2], 3);
  end_density(&field);
}
END_TEST

/* ---- memory ---- */

/* Creates a field, and its system. */
static dvi_status create(const dvi_density_terms *terms)
{
  dvi_density *density = NULL;
  const dvi_status status = dvi_density_create(terms, &density);
  dvi_density_destroy(&density);
  return status;
}

START_TEST(every_failing_allocation_is_survived)
{
  static const char *const kinds[] = {"fem:degree=2,cells=3", "fourier:modes=3"};
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  const dvi_density_condition ends[] = {{.part = "left", .kind = DVI_FIXED},
                                        {.part = "right", .robin = 1}};
  for (int i = 0; i < 2; i++) {
    dvi_space *space = make_density_space(kinds[i], 1, 0, 1, i);
    const dvi_density_terms terms = {.size = sizeof terms,
                                     .space = space,
                                     .components = 1,
                                     .part = parts,
                                     .parts = 3,
                                     .condition = ends,
                                     .conditions = i == 0 ? 2 : 0};
    dvi_status status = DVI_NO_MEMORY;
    for (long successes = 0; status == DVI_NO_MEMORY; successes++) {
      dvi__fail_allocations_after(successes);
      status = create(&terms);
      dvi__fail_allocations_after(-1);
    }
    ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
    dvi_space_destroy(&space);
  }
}
END_TEST

SUITE(density_refusals)
{
  tcase_add_test(tests, terms_without_sense_are_refused);
  tcase_add_test(tests, parts_without_sense_are_refused);
  tcase_add_test(tests, parts_of_other_kinds_are_refused);
  tcase_add_test(tests, parts_that_do_not_go_together_are_refused);
  tcase_add_test(tests, derivatives_that_a_space_has_not_are_refused);
  tcase_add_test(tests, failures_of_callbacks_are_named);
  tcase_add_test(tests, singular_masses_name_a_component);
  tcase_add_test(tests, singular_two_forms_are_refused);
  tcase_add_test(tests, conditions_without_sense_are_refused);
  tcase_add_test(tests, conditions_that_a_field_cannot_have_are_refused);
  tcase_add_test(tests, values_move_where_functions_have_nodes);
  tcase_add_test(tests, values_of_one_forms_do_not_move);
  tcase_add_test(tests, full_matrices_of_many_modes_are_refused);
  tcase_add_test(tests, static_states_of_too_many_modes_are_refused);
  tcase_add_test(tests, static_states_that_do_not_exist_are_not_found);
  tcase_add_test(tests, fluxes_want_facets_of_the_boundary);
  tcase_add_test(tests, modes_are_as_many_as_unknowns);
  tcase_add_test(tests, questions_without_an_answer_are_refused);
  tcase_add_test(tests, static_states_keep_their_start_on_failure);
  tcase_add_test(tests, every_failing_allocation_is_survived);
}
