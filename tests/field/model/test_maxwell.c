/* Electromagnetic fields on meshes: their modes and static fields, walls, media, and sources. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;
static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};

/* Make a field on a mesh, which the field owns then. */
static dvi_field *make_field(dvi_mesh *mesh, dvi_star_kind kind, int walls)
{
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &pec, .walls = walls};
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

static dvi_mesh *generate(const char *name, const dvi_generator_options *options)
{
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate(name, options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static dvi_mesh *staggered(int n)
{
  return generate("staggered",
                  &(dvi_generator_options){.size = sizeof(dvi_generator_options), .cells = {n, n}});
}

/* Compute frequencies, and release the field. Returns the number of static fields. */
static int64_t frequencies(dvi_field *field, int count, double *omega)
{
  int64_t zeros = -1;
  const dvi_modes_options options = {.size = sizeof options, .count = count};
  ck_assert_msg(dvi_field_modes(field, &options, omega, NULL, &zeros) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < count; i++) omega[i] = sqrt(omega[i]);
  dvi_field_destroy(&field);
  return zeros;
}

/* ---- cavities ---- */

/* The digits come from a full eigenvalue solver in other code, and are rounded to 1e-12. */
START_TEST(a_square_cavity_of_triangles_has_known_frequencies)
{
  double omega[3], fastest;
  static const double known[] = {3.132012610332, 3.138417260339, 4.428354888445},
                      whitney[] = {3.139062672770, 3.142393240304, 4.444855983430};
  dvi_field *field = make_field(staggered(8), DVI_CIRCUMCENTRIC, 1);
  ck_assert(dvi_field_fastest(field, &fastest) == DVI_OK);
  ck_assert(fastest >= 44.07810352 && fastest < 44.07810352 * 1.0006);
  (void)frequencies(field, 3, omega);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(omega[i], known[i], 1e-11);
  (void)frequencies(make_field(staggered(8), DVI_WHITNEY, 1), 3, omega);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(omega[i], whitney[i], 1e-9);
}
END_TEST

/* 2 sin(k h/2)/h along each axis, added in squares. Static are the gradients of the functions that
 * vanish at electric walls, or of all but constants. */
START_TEST(a_box_has_the_frequencies_and_the_static_fields_of_its_grid)
{
  const dvi_generator_options box = {
      .size = sizeof box, .cells = {5, 4, 3}, .extent = {1, 0.8, 0.6}};
  double omega[3], expected[3];
  static const int order[3][3] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  for (int i = 0; i < 3; i++) {
    double sum = 0;
    for (int a = 0; a < 3; a++) {
      const double h = box.extent[a] / box.cells[a], k = order[i][a] * pi / box.extent[a];
      sum += pow(2 * sin(k * h / 2) / h, 2);
    }
    expected[i] = sqrt(sum);
  }
  ck_assert_int_eq(frequencies(make_field(generate("box", &box), DVI_CIRCUMCENTRIC, 1), 3, omega),
                   24);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(omega[i], expected[i], 1e-12);
  ck_assert_int_eq(frequencies(make_field(generate("box", &box), DVI_CIRCUMCENTRIC, 0), 3, omega),
                   119);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(omega[i], expected[i], 1e-12);
}
END_TEST

/* The mesh's symmetry makes the lowest frequency twelvefold. Static are all gradients and the three
 * constant fields. */
START_TEST(a_body_centred_torus_has_known_frequencies)
{
  static const double known[] = {0.971896990257, 0.984083664540};
  for (int n = 3; n <= 4; n++) {
    double omega[13];
    const dvi_generator_options cells = {.size = sizeof cells, .cells = {n, n, n}};
    const int64_t zeros = frequencies(
        make_field(generate("bcc-torus", &cells), DVI_CIRCUMCENTRIC, 0), 13, omega);
    ck_assert_int_eq(zeros, 2 * n * n * n + 2);
    for (int i = 0; i < 12; i++) ck_assert_double_eq_tol(omega[i] / (2 * pi), known[n - 3], 1e-11);
    ck_assert(omega[12] > 1.01 * omega[11]);
  }
}
END_TEST

/* 53 of 188 are static. */
START_TEST(more_modes_than_there_are_are_refused)
{
  dvi_field *field = make_field(staggered(8), DVI_CIRCUMCENTRIC, 1);
  double lambda[136] = {7};
  dvi_modes_options options = {.size = sizeof options, .count = 136};
  ck_assert_int_eq(dvi_field_modes(field, &options, lambda, NULL, NULL), DVI_BAD_SIZE);
  check_words("136 modes of 188 unknowns, of which 53 are static: take 1 to 135");
  options.count = 2;
  options.shift = (double)NAN;
  ck_assert_int_eq(dvi_field_modes(field, &options, lambda, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_double_eq(lambda[0], 7);
  options.shift = 0;
  options.count = 135;
  ck_assert_int_eq(dvi_field_modes(field, &options, lambda, NULL, NULL), DVI_OK);
  ck_assert_double_lt(sqrt(lambda[134]), 44.07810353);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- materials ---- */

/* Make a field on a mesh with a factor of degree 1, and a conductivity, and asynchronous steps of
 * it if they are wanted. */
static dvi_status try_field(dvi_mesh *mesh, dvi_star_kind kind, dvi_maxwell_terms terms,
                            const double *factor, int has_steps)
{
  const double *factors[4] = {NULL, factor};
  const dvi_march_options avi = {.size = sizeof avi, .method = "avi"};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  dvi_march *march = NULL;
  const dvi_star_options options = {.size = sizeof options, .kind = kind, .factor = factors};
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  terms.size = sizeof terms;
  terms.star = star;
  dvi_status status = dvi_maxwell_create(&terms, &field);
  if (status == DVI_OK && has_steps) status = dvi_march_create(field, &avi, &march);
  dvi_march_destroy(&march);
  dvi_star_destroy(&star);
  dvi_field_destroy(&field);
  return status;
}

static dvi_status try_conductor(dvi_mesh *mesh, dvi_star_kind kind, const double *sigma)
{
  return try_field(mesh, kind, (dvi_maxwell_terms){.conductivity = sigma}, NULL,
                   kind == DVI_CIRCUMCENTRIC);
}

/* An obtuse triangle beside an acute one. Both together have a dual of positive length at their
 * common edge, 0.22, and the obtuse one alone a negative one, -0.14. */
START_TEST(conductors_with_negative_duals_are_refused)
{
  static const double point[] = {0, 0, 1, 0, 0.5, 0.378, 0.5, -0.978};
  static const int vertex[] = {0, 1, 2, 0, 1, 3};
  static const double in_obtuse[] = {1, 0}, in_acute[] = {0, 1}, in_both[] = {1, 1};
  const dvi_mesh_terms kite = {.size = sizeof kite,
                               .dimension = 2,
                               .points = 4,
                               .point = point,
                               .cells = 2,
                               .vertex = vertex};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(&kite, &mesh) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(try_conductor(mesh, DVI_CIRCUMCENTRIC, in_obtuse), DVI_SINGULAR);
  check_words("edge 0");
  ck_assert_int_eq(try_conductor(mesh, DVI_CIRCUMCENTRIC, in_acute), DVI_OK);
  ck_assert_int_eq(try_conductor(mesh, DVI_CIRCUMCENTRIC, in_both), DVI_OK);
  ck_assert_int_eq(try_conductor(mesh, DVI_WHITNEY, in_obtuse), DVI_OK);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Right angles leave duals that are roundings of zero, of either sign. */
START_TEST(conductors_with_right_angles_are_taken)
{
  const dvi_generator_options triangles = {.size = sizeof triangles, .cells = {5, 7}};
  dvi_mesh *mesh = generate("staggered", &triangles);
  const int64_t cells = dvi_mesh_count(mesh, 2);
  double *sigma = calloc((size_t)cells, sizeof *sigma);
  for (int64_t c = 0; c < cells; c++) {
    sigma[c] = 1;
    ck_assert_msg(try_conductor(mesh, DVI_CIRCUMCENTRIC, sigma) == DVI_OK, "%s", dvi_last_error());
    sigma[c] = 0;
  }
  free(sigma);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The permittivity of E as a 1-form, and the permeability of E as a 0-form. */
START_TEST(negative_materials_are_refused)
{
  const dvi_maxwell_terms terms = {.scalar = _i};
  dvi_mesh *mesh = staggered(2);
  const int64_t cells = dvi_mesh_count(mesh, 2);
  double *factor = calloc((size_t)cells, sizeof *factor);
  for (int64_t c = 0; c < cells; c++) factor[c] = 1;
  factor[3] = -0.01;
  ck_assert_int_eq(try_field(mesh, DVI_WHITNEY, terms, factor, 0), DVI_SINGULAR);
  check_words("triangle 3");
  factor[3] = 0.01;
  ck_assert_int_eq(try_field(mesh, DVI_WHITNEY, terms, factor, 0), DVI_OK);
  free(factor);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(maxwell)
{
  tcase_add_test(tests, conductors_with_negative_duals_are_refused);
  tcase_add_test(tests, conductors_with_right_angles_are_taken);
  tcase_add_loop_test(tests, negative_materials_are_refused, 0, 2);
  tcase_add_test(tests, a_square_cavity_of_triangles_has_known_frequencies);
  tcase_add_test(tests, a_box_has_the_frequencies_and_the_static_fields_of_its_grid);
  tcase_add_test(tests, more_modes_than_there_are_are_refused);
  tcase_add_test(tests, a_body_centred_torus_has_known_frequencies);
}
