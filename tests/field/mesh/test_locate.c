/* Cells that contain points. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

enum { POINTS = 300 };

static dvi_mesh *generated(const char *name, const dvi_generator_options *sizes)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = *sizes;
  options.size = sizeof options;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* Points at random in the unit cube, moved and stretched. */
static double *random_points(int n, double origin, double length)
{
  double *x = malloc((size_t)(POINTS * n) * sizeof *x);
  unsigned long long seed = 9;
  for (int i = 0; i < POINTS * n; i++) x[i] = origin + length * random_number(&seed);
  return x;
}

/* A linear function, or on a torus a constant one, has its values at all points that are found. */
static int check_values(const dvi_mesh *mesh, const double *x, int is_periodic)
{
  const int n = dvi_mesh_dimension(mesh), width = dvi_mesh_kind(mesh) == DVI_BOXES ? n : n + 1;
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  const double *point = dvi_mesh_points(mesh);
  double *u = calloc((size_t)vertices, sizeof *u), *weight = calloc(POINTS * 5, sizeof *weight);
  int cell[POINTS], found = 0;
  for (int64_t v = 0; v < vertices; v++)
    for (int a = 0; a < n; a++) u[v] += is_periodic ? 0.25 : (a + 1) * point[v * n + a];
  ck_assert_msg(dvi_mesh_locate(mesh, POINTS, x, cell, weight) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < POINTS; i++) {
    double value, expected = 0;
    if (cell[i] < 0) continue;
    found++;
    for (int a = 0; a < n; a++) expected += is_periodic ? 0.25 : (a + 1) * x[i * n + a];
    ck_assert_int_eq(dvi_form_evaluate(mesh, 0, u, cell[i], weight + i * width, &value), DVI_OK);
    ck_assert_double_eq_tol(value, expected, 1e-9);
  }
  free(u), free(weight);
  return found;
}

START_TEST(points_inside_are_found)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *simplices = jittered_mesh(n, n, n < 4 ? 4 : 2, 0.15, 3);
    dvi_generator_options options = {.dimension = n};
    for (int a = 0; a < n; a++) {
      options.cells[a] = 3;
      options.grading[a] = 2;
    }
    dvi_mesh *boxes = generated("box", &options);
    double *x = random_points(n, 0, 1);
    ck_assert_int_eq(check_values(simplices, x, 0), POINTS);
    ck_assert_int_eq(check_values(boxes, x, 0), POINTS);
    free(x);
    dvi_mesh_destroy(&simplices);
    dvi_mesh_destroy(&boxes);
  }
}
END_TEST

START_TEST(points_outside_have_no_cell)
{
  const double far[] = {3, 0, 0, -1.2, 1e300, 0};
  int cell[3];
  double weight[9];
  dvi_mesh *disk = generated("disk", &(dvi_generator_options){.cells = {6}});
  ck_assert_int_eq(dvi_mesh_locate(disk, 3, far, cell, weight), DVI_OK);
  for (int i = 0; i < 3; i++) ck_assert_int_eq(cell[i], -1);
  double *x = random_points(2, -1, 2);
  const int found = check_values(disk, x, 0);
  int within = 0;
  for (int i = 0; i < POINTS; i++) within += hypot(x[2 * i], x[2 * i + 1]) < cos(0.1);
  ck_assert(found >= within && found < POINTS);
  free(x);
  dvi_mesh_destroy(&disk);
}
END_TEST

START_TEST(points_of_tori_are_found_in_any_period)
{
  dvi_mesh *tori[] = {generated("kuhn-torus", &(dvi_generator_options){.cells = {3, 4, 5}}),
                      generated("bcc-torus", &(dvi_generator_options){.cells = {3, 3, 3}}),
                      generated("box", &(dvi_generator_options){
                                           .cells = {5, 3}, .periodic = {1, 1}, .origin = {2, 3}})};
  for (size_t i = 0; i < sizeof tori / sizeof *tori; i++) {
    double *x = random_points(dvi_mesh_dimension(tori[i]), -2.5, 6);
    ck_assert_int_eq(check_values(tori[i], x, 1), POINTS);
    free(x);
    dvi_mesh_destroy(&tori[i]);
  }
}
END_TEST

START_TEST(vertices_belong_to_their_first_cell)
{
  dvi_mesh *mesh = staggered_mesh(4, 4);
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  int *cell = malloc((size_t)vertices * sizeof *cell), width;
  double *weight = malloc((size_t)(3 * vertices) * sizeof *weight);
  const int *corner = dvi_mesh_vertices(mesh, 2, &width);
  ck_assert_int_eq(dvi_mesh_locate(mesh, vertices, dvi_mesh_points(mesh), cell, weight), DVI_OK);
  for (int v = 0; v < vertices; v++) {
    int first = 0;
    while (corner[3 * first] != v && corner[3 * first + 1] != v && corner[3 * first + 2] != v)
      first++;
    ck_assert_int_eq(cell[v], first);
  }
  free(cell), free(weight);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(wrong_points_are_refused)
{
  const double wrong[] = {0.5, NAN};
  int cell;
  double weight[4];
  dvi_mesh *disk = generated("disk", &(dvi_generator_options){.cells = {2}}),
           *sphere = generated("icosphere", &(dvi_generator_options){.cells = {1}});
  ck_assert_int_eq(dvi_mesh_locate(disk, 1, wrong, &cell, weight), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_mesh_locate(disk, -1, wrong, &cell, weight), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_mesh_locate(sphere, 1, weight, &cell, weight), DVI_UNSUPPORTED);
  dvi_mesh_destroy(&disk);
  dvi_mesh_destroy(&sphere);
}
END_TEST

SUITE(locate)
{
  tcase_add_test(tests, points_inside_are_found);
  tcase_add_test(tests, points_outside_have_no_cell);
  tcase_add_test(tests, points_of_tori_are_found_in_any_period);
  tcase_add_test(tests, vertices_belong_to_their_first_cell);
  tcase_add_test(tests, wrong_points_are_refused);
}
