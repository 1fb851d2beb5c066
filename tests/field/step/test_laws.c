/* The laws of electromagnetic fields, by the library's own measurement of them. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};

/* Measure the laws of a field on a mesh, which is released. Returns their number. */
static int measure_with(dvi_mesh *mesh, dvi_star_options options, dvi_maxwell_terms terms,
                        const char *method, dvi_law *law)
{
  const dvi_march_options how = {.size = sizeof how, .method = method, .fraction = 0.7};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  int count = 0;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  terms.size = sizeof terms;
  terms.star = star;
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_field_laws(field, &how, 50, law, &count) == DVI_OK, "%s", dvi_last_error());
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return count;
}

static int measure(dvi_mesh *mesh, dvi_star_kind kind, dvi_maxwell_terms terms, const char *method,
                   dvi_law *law)
{
  return measure_with(mesh, (dvi_star_options){.size = sizeof(dvi_star_options), .kind = kind},
                      terms, method, law);
}

static dvi_mesh *generate(const char *name, int n)
{
  const dvi_generator_options options = {.size = sizeof options,
                                         .cells = {n, n, strcmp(name, "staggered") == 0 ? 0 : n}};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* Laws of roundings stay at roundings, up to the number of the terms and steps. */
static void check(dvi_mesh *mesh, dvi_star_kind kind, int scalar, int expected)
{
  dvi_law law[DVI_LAWS_MAX];
  const dvi_maxwell_terms terms = {.wall = &pec, .walls = 1, .scalar = scalar};
  const int count = measure(mesh, kind, terms, "leapfrog", law);
  ck_assert_int_eq(count, expected);
  for (int i = 0; i < count; i++) {
    ck_assert(law[i].is_exact);
    ck_assert_msg(law[i].error < 1e-13, "%s: %g", law[i].name, law[i].error);
  }
}

START_TEST(leapfrog_keeps_all_laws)
{
  check(generate("box", 3), DVI_CIRCUMCENTRIC, 0, 6);
  check(generate("kuhn", 2), DVI_WHITNEY, 0, 6);
  check(generate("staggered", 6), DVI_CIRCUMCENTRIC, 0, 5);
  check(generate("staggered", 6), DVI_WHITNEY, 1, 4);
}
END_TEST

/* Of asynchronous steps the energy is bounded only. */
START_TEST(asynchronous_steps_keep_charge_and_gauge)
{
  dvi_law law[DVI_LAWS_MAX];
  const int count = measure(generate("staggered", 6), DVI_CIRCUMCENTRIC,
                            (dvi_maxwell_terms){.wall = &pec, .walls = 1}, "avi", law);
  ck_assert_int_eq(count, 3);
  for (int i = 0; i < count; i++)
    ck_assert_msg(law[i].error < (law[i].is_exact ? 1e-13 : 0.3), "%s: %g", law[i].name,
                  law[i].error);
  ck_assert(!law[0].is_exact && law[0].error > 1e-6);
}
END_TEST

/* With a contrast of eps and 1/mu, in different halves, roundings of a gradient make large fields,
 * and the law is still one of roundings. */
static void check_contrast(dvi_mesh *mesh, double contrast, const char *method)
{
  const int64_t cells = dvi_mesh_count(mesh, 2);
  double *eps = calloc((size_t)(4 * cells), sizeof *eps), *nu = eps + cells, *centre = nu + cells;
  const double *const factor[] = {NULL, eps, nu};
  dvi_law law[DVI_LAWS_MAX];
  ck_assert_int_eq(dvi_mesh_centres(mesh, 2, centre), DVI_OK);
  for (int64_t c = 0; c < cells; c++) {
    eps[c] = centre[2 * c] < 0.5 ? contrast : 1;
    nu[c] = centre[2 * c + 1] < 0.5 ? 1 : 1 / contrast;
  }
  const dvi_star_options options = {.size = sizeof options, .factor = factor};
  const dvi_maxwell_terms terms = {.wall = &pec, .walls = 1};
  const int count = measure_with(mesh, options, terms, method, law);
  ck_assert_int_eq(count, 3);
  ck_assert_str_eq(law[2].name, "gauge");
  ck_assert_msg(law[2].error < 1e-13, "%s: %g", method, law[2].error);
  free(eps);
}

START_TEST(contrasts_keep_the_gauge_law_at_roundings)
{
  const dvi_generator_options graded = {
      .size = sizeof graded, .dimension = 2, .cells = {6, 6}, .grading = {2, 2}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("box", &graded, &mesh), DVI_OK);
  check_contrast(mesh, 1000, "avi");
  check_contrast(generate("staggered", 3), 30, "tents");
}
END_TEST

/* Losses leave reciprocity, and take the energy. */
START_TEST(losses_leave_reciprocity)
{
  static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};
  double sigma[27];
  dvi_law law[DVI_LAWS_MAX];
  for (int i = 0; i < 27; i++) sigma[i] = 0.3 * (i % 4);
  const int count = measure(generate("box", 3), DVI_CIRCUMCENTRIC,
                            (dvi_maxwell_terms){.wall = &open, .walls = 1, .conductivity = sigma},
                            "leapfrog", law);
  ck_assert_int_eq(count, 4);
  ck_assert_str_eq(law[2].name, "reciprocity");
  for (int i = 0; i < count; i++)
    ck_assert_msg(law[i].error < 1e-13, "%s: %g", law[i].name, law[i].error);
}
END_TEST

SUITE(laws)
{
  tcase_add_test(tests, leapfrog_keeps_all_laws);
  tcase_add_test(tests, asynchronous_steps_keep_charge_and_gauge);
  tcase_add_test(tests, contrasts_keep_the_gauge_law_at_roundings);
  tcase_add_test(tests, losses_leave_reciprocity);
}
