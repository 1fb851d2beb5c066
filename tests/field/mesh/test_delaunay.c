/* Delaunay's triangulation: empty spheres, and what is refused. */
#include <dvi/mesh.h>
#include <math.h>

#include "field/mesh/volume.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { POINTS = 60 };

/* Give the square of a point's distance from the first corner, less twice the part along `centre`:
 * negative inside of the sphere with this centre relative to the corner. */
static double power_of(const double *origin, const double *centre, const double *x)
{
  double sum = 0;
  for (int l = 0; l < 2; l++) sum += (x[l] - origin[l]) * (x[l] - origin[l] - 2 * centre[l]);
  return sum;
}

START_TEST(circles_of_triangles_are_empty)
{
  double point[2 * POINTS];
  unsigned long long state = 7;
  dvi_mesh *mesh;
  for (int i = 0; i < 2 * POINTS; i++) point[i] = random_number(&state);
  ck_assert_int_eq(dvi_mesh_delaunay(2, POINTS, point, &mesh), DVI_OK);
  for (int64_t c = 0; c < dvi_mesh_count(mesh, 2); c++) {
    const int *v = dvi_mesh_vertices(mesh, 2, NULL) + 3 * c;
    const double *p = point + 2 * v[0], u[] = {point[2 * v[1]] - p[0], point[2 * v[1] + 1] - p[1]},
                 w[] = {point[2 * v[2]] - p[0], point[2 * v[2] + 1] - p[1]},
                 area = 2 * (u[0] * w[1] - u[1] * w[0]), uu = u[0] * u[0] + u[1] * u[1],
                 ww = w[0] * w[0] + w[1] * w[1],
                 centre[] = {(w[1] * uu - u[1] * ww) / area, (u[0] * ww - w[0] * uu) / area};
    for (int i = 0; i < POINTS; i++) ck_assert_double_ge(power_of(p, centre, point + 2 * i), -1e-9);
  }
  /* Euler: V - E + F = 1 for a disk */
  ck_assert_int_eq(dvi_mesh_count(mesh, 0) - dvi_mesh_count(mesh, 1) + dvi_mesh_count(mesh, 2), 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The points of a grid lie on circles with four of them, and on the lines of the hull. */
START_TEST(a_grid_is_filled)
{
  for (int n = 2; n <= 4; n++) {
    const int side = 4;
    double point[4 * 256], volume = 0;
    int points = 1;
    dvi_mesh *mesh;
    for (int l = 0; l < n; l++) points *= side;
    for (int i = 0; i < points; i++)
      for (int l = 0, rest = i; l < n; l++, rest /= side) point[n * i + l] = rest % side / 3.0;
    ck_assert_msg(dvi_mesh_delaunay(n, points, point, &mesh) == DVI_OK, "%d: %s", n,
                  dvi_last_error());
    for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++) volume += dvi__cell_volume(mesh, n, c);
    ck_assert_double_eq_tol(volume, 1, 1e-12);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(three_points_are_a_triangle)
{
  static const double point[] = {0, 0, 0, 1, 1, 0};
  dvi_mesh *mesh;
  ck_assert_int_eq(dvi_mesh_delaunay(2, 3, point, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_count(mesh, 2), 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(bad_points_are_refused)
{
  static const double line[] = {0, 0, 1, 1, 2, 2, 3, 3}, twice[] = {0, 0, 1, 0, 0, 1, 1, 0, 3, 2},
                      undefined[] = {0, 0, 1, 0, 0, NAN};
  dvi_mesh *mesh;
  ck_assert_int_eq(dvi_mesh_delaunay(2, 4, line, &mesh), DVI_BAD_ARGUMENT);
  check_words("do they lie in a plane?");
  ck_assert_ptr_null(mesh);
  ck_assert_int_eq(dvi_mesh_delaunay(2, 5, twice, &mesh), DVI_BAD_ARGUMENT);
  check_words("delaunay: mesh: point");
  ck_assert_int_eq(dvi_mesh_delaunay(2, 3, undefined, &mesh), DVI_BAD_ARGUMENT);
  check_words("coordinate 1 of point 2 is nan");
  ck_assert_int_eq(dvi_mesh_delaunay(5, 9, line, &mesh), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_mesh_delaunay(2, -1, line, &mesh), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_mesh_delaunay(2, 4, NULL, &mesh), DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(delaunay)
{
  tcase_add_test(tests, circles_of_triangles_are_empty);
  tcase_add_test(tests, a_grid_is_filled);
  tcase_add_test(tests, three_points_are_a_triangle);
  tcase_add_test(tests, bad_points_are_refused);
}
