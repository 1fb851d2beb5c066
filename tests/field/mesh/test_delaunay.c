/* Delaunay's triangulation: empty spheres, and what is refused. */
#include <dvi/mesh.h>
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

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

/* ---- balls ---- */

enum { LARGEST = 700 };

/* Count the boundary's facets at each of its ridges: two, if the boundary has no end and nowhere
 * meets itself along one. */
static void check_ridges(const dvi_mesh *mesh, int n)
{
  int64_t facets;
  const int *facet = dvi_mesh_part_cells(mesh, "boundary", n - 1, &facets);
  dvi_matrix incidence;
  char *count = calloc((size_t)dvi_mesh_count(mesh, n - 2), 1);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, n - 2, &incidence), DVI_OK);
  for (int64_t i = 0; i < facets; i++)
    for (int k = 0; k < n; k++) count[incidence.column[(int64_t)facet[i] * n + k]]++;
  for (int64_t r = 0; r < dvi_mesh_count(mesh, n - 2); r++)
    ck_assert_msg(count[r] == 0 || count[r] == 2, "%d facets at ridge %d", count[r], (int)r);
  free(count);
}

/* The cells around a vertex are a cone over a sphere, or over a ball at the boundary. Euler's
 * numbers of these are 1 + (-1)^(n-1) and 1. */
static void check_links(const dvi_mesh *mesh, int n)
{
  const int64_t points = dvi_mesh_count(mesh, 0);
  int64_t outer;
  int *euler = calloc((size_t)points, sizeof *euler);
  for (int64_t v = 0; v < points; v++) euler[v] = n % 2 ? -2 : 0;
  const int *vertex = dvi_mesh_part_cells(mesh, "boundary", 0, &outer);
  for (int64_t i = 0; i < outer; i++) euler[vertex[i]] = -1;
  for (int k = 1; k <= n; k++) {
    const int *corner = dvi_mesh_vertices(mesh, k, NULL);
    for (int64_t i = 0; i < dvi_mesh_count(mesh, k) * (k + 1); i++)
      euler[corner[i]] += k % 2 ? 1 : -1;
  }
  for (int64_t v = 0; v < points; v++) ck_assert_int_eq(euler[v], 0);
  free(euler);
}

static void check_ball(const dvi_mesh *mesh)
{
  int64_t betti[5];
  const int n = dvi_mesh_dimension(mesh);
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  for (int k = 0; k <= n; k++) ck_assert_int_eq(betti[k], k == 0);
  check_ridges(mesh, n);
  check_links(mesh, n);
}

static double volume_of(const dvi_mesh *mesh)
{
  const int n = dvi_mesh_dimension(mesh);
  double volume = 0;
  for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++) volume += dvi__cell_volume(mesh, n, c);
  return volume;
}

static dvi_mesh *triangulated(int n, int points, const double *point)
{
  dvi_mesh *mesh;
  ck_assert_msg(dvi_mesh_delaunay(n, points, point, &mesh) == DVI_OK, "%d points in %d: %s", points,
                n, dvi_last_error());
  check_ball(mesh);
  return mesh;
}

/* Give the points of a grid, each moved by up to `jitter`. Returns their number. */
static int grid_points(int n, int side, double spacing, double jitter, unsigned long long *state,
                       double *point)
{
  int points = 1;
  for (int l = 0; l < n; l++) points *= side;
  for (int i = 0; i < points; i++)
    for (int l = 0, rest = i; l < n; l++, rest /= side)
      point[n * i + l] = rest % side * spacing + jitter * (2 * random_number(state) - 1);
  return points;
}

/* Turn points in the planes of each axis and the next one. */
static void rotate(int n, int points, double angle, double *point)
{
  for (int i = 0; i < points; i++)
    for (int l = 0; l + 1 < n; l++) {
      double *x = point + n * i + l, a = x[0], b = x[1];
      x[0] = cos(angle) * a - sin(angle) * b;
      x[1] = sin(angle) * a + cos(angle) * b;
    }
}

/* Points of a grid lie on spheres with 2^n of them, and on the sides of the hull. Each cube has n!
 * simplices, and each of the 2n (side-1)^(n-1) squares of the boundary (n-1)!. */
START_TEST(grids_are_divided_as_by_kuhn)
{
  static const double spacing[] = {1, 0.1, 1 / 3.0}, offset[] = {0, 1e6, -1e9};
  static const int factorial[] = {1, 1, 2, 6, 24};
  double point[4 * LARGEST];
  unsigned long long state = 1;
  for (int n = 2; n <= 4; n++)
    for (int side = 2; side <= (n == 4 ? 4 : 5); side++)
      for (int i = 0; i < 3; i++) {
        const int points = grid_points(n, side, i == 0 ? 1 : spacing[i], 0, &state, point);
        for (int j = 0; j < n * points && i == 0; j++) point[j] += offset[side % 3];
        dvi_mesh *mesh = triangulated(n, points, point);
        const double cubes = pow(side - 1, n), squares = 2 * n * pow(side - 1, n - 1);
        int64_t outer;
        (void)dvi_mesh_part_cells(mesh, "boundary", n - 1, &outer);
        ck_assert_int_eq(outer, (int64_t)squares * factorial[n - 1]);
        ck_assert_int_eq(dvi_mesh_count(mesh, n), (int64_t)cubes * factorial[n]);
        /* rounding errors of 1e-16 in each of at most 1944 cells */
        ck_assert_double_eq_tol(volume_of(mesh), cubes * pow(spacing[i], n), 1e-12 * cubes);
        dvi_mesh_destroy(&mesh);
      }
}
END_TEST

/* After a rotation, spheres and sides hold the points of a grid up to rounding only. At the hull
 * simplices are lost that are flatter than 2.4e-7 at most, fewer than 10 for each cube. */
START_TEST(grids_that_are_not_exact_are_balls)
{
  double point[4 * LARGEST];
  unsigned long long state = 5;
  for (int n = 2; n <= 4; n++)
    for (int k = 0; k < (n == 4 ? 24 : 48); k++) {
      const int side = n == 4 ? 3 : 2 + k % 4;
      const double jitter = k % 12 == 0 ? 0 : pow(10, -17 + k % 12), size = pow(side - 1, n);
      const int points = grid_points(n, side, 1, jitter, &state, point);
      if (k % 2) rotate(n, points, 1 + k, point);
      dvi_mesh *mesh = triangulated(n, points, point);
      ck_assert_double_eq_tol(volume_of(mesh), size, (4 * n * jitter + 2.4e-6) * size);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

/* A unit square beside one point that is far away: the mesh has the digits that it needs. */
START_TEST(far_points_belong_to_the_mesh)
{
  static const double far[] = {0, 1e6, 1e9};
  double point[4 * (POINTS + 1)];
  unsigned long long state = 3;
  for (int n = 2; n <= 4; n++)
    for (int i = 0; i < 30; i++) {
      for (int j = 0; j < n * POINTS; j++) point[j] = random_number(&state);
      for (int l = 0; l < n; l++) point[i % POINTS * n + l] = 2 + far[i % 3];
      dvi_mesh *mesh = triangulated(n, POINTS, point);
      dvi_mesh_destroy(&mesh);
      for (int j = 0; j < n * POINTS; j++) point[j] = random_number(&state) + far[i % 3];
      mesh = triangulated(n, POINTS, point);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

START_TEST(clusters_are_triangulated)
{
  enum { CLUSTERS = 8, MEMBERS = 6 };
  double point[4 * CLUSTERS * MEMBERS];
  unsigned long long state = 11;
  for (int n = 2; n <= 4; n++)
    for (int i = 0; i < 20; i++) {
      for (int c = 0; c < CLUSTERS * n; c++) {
        const double centre = random_number(&state);
        for (int m = 0; m < MEMBERS; m++)
          point[(c / n * MEMBERS + m) * n + c % n] = centre + 1e-6 * random_number(&state);
      }
      dvi_mesh *mesh = triangulated(n, CLUSTERS * MEMBERS, point);
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
  check_words("delaunay: points 1 and 3 are equal");
  ck_assert_int_eq(dvi_mesh_delaunay(2, 3, undefined, &mesh), DVI_BAD_ARGUMENT);
  check_words("coordinate 1 of point 2 is nan");
  ck_assert_int_eq(dvi_mesh_delaunay(5, 9, line, &mesh), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_mesh_delaunay(2, -1, line, &mesh), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_mesh_delaunay(2, 4, NULL, &mesh), DVI_BAD_ARGUMENT);
}
END_TEST

/* Points in a thin box fill their hull as they do in a cube: flat is what is flat beside others. */
START_TEST(thin_boxes_are_filled)
{
  static const double thin[] = {1e-3, 1e-5, 1e-6, 1e-7};
  for (int n = 2; n <= 4; n++)
    for (int i = 0; i < 4; i++) {
      double point[POINTS * 4], wide[POINTS * 4], volume[2];
      unsigned long long seed = 1;
      for (int k = 0; k < POINTS * n; k++) {
        wide[k] = random_number(&seed);
        point[k] = wide[k] * (k % n == 0 ? 1 : thin[i]);
      }
      for (int k = 0; k < 2; k++) {
        dvi_mesh *mesh = NULL;
        ck_assert_msg(dvi_mesh_delaunay(n, POINTS, k ? point : wide, &mesh) == DVI_OK, "%s",
                      dvi_last_error());
        volume[k] = 0;
        dvi_star *star = NULL;
        const dvi_star_options options = {.size = sizeof options, .kind = DVI_BARYCENTRIC};
        dvi_matrix M;
        ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_OK);
        ck_assert_int_eq(dvi_star_matrix(star, 0, &M), DVI_OK);
        for (int v = 0; v < POINTS; v++) volume[k] += M.value[v];
        dvi_star_destroy(&star);
        dvi_mesh_destroy(&mesh);
      }
      const double scale = pow(thin[i], n - 1);
      ck_assert_msg(fabs(volume[1] / scale / volume[0] - 1) < 1e-6, "n = %d, 1:%g: %g of %g", n,
                    thin[i], volume[1] / scale, volume[0]);
    }
}
END_TEST

SUITE(delaunay)
{
  tcase_add_test(tests, circles_of_triangles_are_empty);
  tcase_add_test(tests, grids_are_divided_as_by_kuhn);
  tcase_add_test(tests, grids_that_are_not_exact_are_balls);
  tcase_add_test(tests, far_points_belong_to_the_mesh);
  tcase_add_test(tests, clusters_are_triangulated);
  tcase_add_test(tests, three_points_are_a_triangle);
  tcase_add_test(tests, bad_points_are_refused);
  tcase_add_test(tests, thin_boxes_are_filled);
}
