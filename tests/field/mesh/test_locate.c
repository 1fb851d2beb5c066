/* Cells that contain points. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { POINTS = 300 };

static double period; /* of the mesh along all axes, 0 for none */

/* Points at random in the unit cube, moved and stretched. */
static double *random_points(int n, double origin, double length)
{
  double *x = malloc((size_t)(POINTS * n) * sizeof *x);
  unsigned long long seed = 9;
  for (int i = 0; i < POINTS * n; i++) x[i] = origin + length * random_number(&seed);
  return x;
}

/* The place of a point in its cell gives the point again, but for periods. */
static void check_place(const dvi_mesh *mesh, const double *x, int cell, const double *weight)
{
  const int n = dvi_mesh_dimension(mesh), is_box = dvi_mesh_kind(mesh) == DVI_BOXES;
  const double *point = dvi_mesh_points(mesh);
  double sum = 0, least = 0, most = 0;
  int width;
  const int *corner = dvi_mesh_vertices(mesh, n, &width) + (ptrdiff_t)cell * width;
  for (int i = 0; i < (is_box ? n : n + 1); i++) {
    sum += weight[i];
    least = fmin(least, weight[i]);
    most = fmax(most, weight[i]);
  }
  ck_assert(least >= -1e-10 && most <= 1 + 1e-10 && (is_box || fabs(sum - 1) < 1e-14));
  for (int a = 0; a < n; a++) {
    double place = point[corner[0] * n + a];
    for (int i = 0; i < n; i++) {
      double edge = point[corner[is_box ? 1 << i : i + 1] * n + a] - point[corner[0] * n + a];
      if (period > 0) edge -= period * round(edge / period);
      place += weight[is_box ? i : i + 1] * edge;
    }
    double apart = x[a] - place;
    if (period > 0) apart -= period * round(apart / period);
    ck_assert_msg(fabs(apart) < 1e-9, "axis %d: %g", a, apart);
  }
}

/* Returns how many points are found. */
static int check_places(const dvi_mesh *mesh, const double *x, double repeat)
{
  const int n = dvi_mesh_dimension(mesh), width = dvi_mesh_kind(mesh) == DVI_BOXES ? n : n + 1;
  double *weight = calloc(POINTS * 5, sizeof *weight);
  int cell[POINTS], found = 0;
  period = repeat;
  ck_assert_msg(dvi_mesh_locate(mesh, POINTS, x, cell, weight) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < POINTS; i++) {
    if (cell[i] < 0) continue;
    found++;
    check_place(mesh, x + i * n, cell[i], weight + i * width);
  }
  free(weight);
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
    dvi_mesh *boxes = generated("box", options);
    double *x = random_points(n, 0, 1);
    ck_assert_int_eq(check_places(simplices, x, 0), POINTS);
    ck_assert_int_eq(check_places(boxes, x, 0), POINTS);
    free(x);
    dvi_mesh_destroy(&simplices);
    dvi_mesh_destroy(&boxes);
  }
}
END_TEST

/* Few cells along an axis span all of it. */
START_TEST(points_of_coarse_meshes_are_found)
{
  static const int shapes[][2] = {{1, 1}, {8, 1}, {1, 5}, {2, 1}, {3, 2}, {40, 1}};
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    for (int kind = 0; kind < 2; kind++) {
      const dvi_generator_options options = {.cells = {shapes[i][0], shapes[i][1]}};
      dvi_mesh *mesh = generated(kind ? "box" : "kuhn", options);
      double *x = random_points(2, 0, 1);
      ck_assert_int_eq(check_places(mesh, x, 0), POINTS);
      free(x);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

/* A long row of boxes takes memory in proportion to its boxes. */
START_TEST(long_meshes_are_searched)
{
  const int cells = 100000;
  dvi_mesh *mesh = generated(
      "box",
      (dvi_generator_options){.dimension = 3, .cells = {cells, 1, 1}, .extent = {cells, 1, 1}});
  const double x[] = {0.5, 0.5, 0.5, 99999.25, 0.1, 0.9, 31415.5, 0.5, 0.2};
  int cell[3];
  double weight[9];
  ck_assert_int_eq(dvi_mesh_locate(mesh, 3, x, cell, weight), DVI_OK);
  ck_assert(cell[0] == 0 && cell[1] == cells - 1 && cell[2] == 31415);
  ck_assert(weight[3] == 0.25);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(points_outside_have_no_cell)
{
  const double far[] = {3, 0, 0, -1.2, 1e300, 0};
  int cell[3];
  double weight[9];
  dvi_mesh *disk = generated("disk", (dvi_generator_options){.cells = {6}});
  ck_assert_int_eq(dvi_mesh_locate(disk, 3, far, cell, weight), DVI_OK);
  for (int i = 0; i < 3; i++) ck_assert_int_eq(cell[i], -1);
  double *x = random_points(2, -1, 2);
  const int found = check_places(disk, x, 0);
  int within = 0;
  for (int i = 0; i < POINTS; i++) within += hypot(x[2 * i], x[2 * i + 1]) < cos(0.1);
  ck_assert(found >= within && found < POINTS);
  free(x);
  dvi_mesh_destroy(&disk);
}
END_TEST

START_TEST(points_of_tori_are_found_in_any_period)
{
  dvi_mesh *tori[] = {generated("kuhn-torus", (dvi_generator_options){.cells = {3, 4, 5}}),
                      generated("bcc-torus", (dvi_generator_options){.cells = {3, 3, 3}}),
                      generated("box", (dvi_generator_options){
                                           .cells = {5, 3}, .periodic = {1, 1}, .origin = {2, 3}})};
  for (size_t i = 0; i < sizeof tori / sizeof *tori; i++) {
    double *x = random_points(dvi_mesh_dimension(tori[i]), -2.5, 6);
    ck_assert_int_eq(check_places(tori[i], x, 1), POINTS);
    free(x);
    dvi_mesh_destroy(&tori[i]);
  }
}
END_TEST

START_TEST(far_points_of_a_torus_are_found)
{
  const double far[] = {1.5e161, 0.2, -3e300, 1e18};
  int cell[2];
  double weight[6];
  dvi_mesh *torus = generated("kuhn-torus", (dvi_generator_options){.cells = {5, 4}});
  ck_assert_int_eq(dvi_mesh_locate(torus, 2, far, cell, weight), DVI_OK);
  ck_assert(cell[0] >= 0 && cell[1] >= 0);
  dvi_mesh_destroy(&torus);
}
END_TEST

START_TEST(balls_and_delaunay_meshes_are_searched)
{
  dvi_mesh *ball = generated("ball", (dvi_generator_options){.cells = {4}}), *delaunay = NULL;
  double *x = random_points(3, -1, 2), *inner = random_points(3, 0.4, 0.2);
  ck_assert(check_places(ball, x, 0) > POINTS / 3);
  ck_assert_int_eq(dvi_mesh_delaunay(3, POINTS, x, &delaunay), DVI_OK);
  ck_assert_int_eq(check_places(delaunay, x, 0), POINTS);
  ck_assert_int_eq(check_places(delaunay, inner, 0), POINTS);
  free(x), free(inner);
  dvi_mesh_destroy(&ball);
  dvi_mesh_destroy(&delaunay);
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
  dvi_mesh *disk = generated("disk", (dvi_generator_options){.cells = {2}}),
           *sphere = generated("icosphere", (dvi_generator_options){.cells = {1}});
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
  tcase_add_test(tests, points_of_coarse_meshes_are_found);
  tcase_add_test(tests, long_meshes_are_searched);
  tcase_add_test(tests, points_outside_have_no_cell);
  tcase_add_test(tests, points_of_tori_are_found_in_any_period);
  tcase_add_test(tests, far_points_of_a_torus_are_found);
  tcase_add_test(tests, balls_and_delaunay_meshes_are_searched);
  tcase_add_test(tests, vertices_belong_to_their_first_cell);
  tcase_add_test(tests, wrong_points_are_refused);
}
