/* Stars of meshes of spacetime, whose metric is that of Minkowski. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double minkowski[] = {1, -1, 0, 0};

static dvi_mesh *mesh_of(dvi_mesh_terms terms)
{
  dvi_mesh *mesh = NULL;
  terms.size = sizeof terms;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static dvi_star *star_of(const dvi_mesh *mesh)
{
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, NULL, &star) == DVI_OK, "%s", dvi_last_error());
  return star;
}

/* ---- a slab of right triangles ---- */

enum { ACROSS = 8, UP = 8 };

/* Each rectangle dx x dt between the times j and j+1 is divided along the diagonal from (i+1, j) to
 * (i, j+1), as tents from left to right do. */
static dvi_mesh *slab(double dt)
{
  const double dx = 1.0 / ACROSS, period[] = {1, 0};
  double point[2 * ACROSS * (UP + 1)];
  int vertex[6 * ACROSS * UP], count = 0;
  for (int j = 0; j <= UP; j++)
    for (int i = 0; i < ACROSS; i++) {
      point[2 * (j * ACROSS + i)] = i * dx;
      point[2 * (j * ACROSS + i) + 1] = j * dt;
    }
  for (int j = 0; j < UP; j++)
    for (int i = 0; i < ACROSS; i++) {
      const int a = j * ACROSS + i, b = j * ACROSS + (i + 1) % ACROSS,
                triangles[] = {a, b, a + ACROSS, b, a + ACROSS, b + ACROSS};
      for (int c = 0; c < 6; c++) vertex[count++] = triangles[c];
    }
  return mesh_of((dvi_mesh_terms){.dimension = 2,
                                  .points = ACROSS * (UP + 1),
                                  .point = point,
                                  .cells = count / 3,
                                  .vertex = vertex,
                                  .metric = minkowski,
                                  .period = period});
}

/* Edges in space have dt/dx, those in time -dx/dt, diagonals 0. Duals at the ends of the slab are
 * half as long. */
START_TEST(right_triangles_have_the_weights_of_leapfrog)
{
  const double dx = 1.0 / ACROSS, dt = dx / 2;
  dvi_mesh *mesh = slab(dt);
  dvi_star *star = star_of(mesh);
  dvi_matrix M;
  int width;
  const int *end = dvi_mesh_vertices(mesh, 1, &width);
  ck_assert_int_eq(dvi_star_matrix(star, 1, &M), DVI_OK);
  for (int64_t e = 0; e < M.rows; e++) {
    const int low = end[2 * e] / ACROSS, high = end[2 * e + 1] / ACROSS,
              is_pole = end[2 * e] % ACROSS == end[2 * e + 1] % ACROSS,
              is_rim = low == 0 || low == UP;
    const double weight = low == high ? dt / dx / (1 + is_rim) : is_pole ? -dx / dt : 0;
    ck_assert_double_eq_tol(M.value[e], weight, 1e-15);
  }
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(diagonals_along_light_are_refused)
{
  dvi_mesh *mesh = slab(1.0 / ACROSS);
  dvi_star *star = NULL;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(star);
  check_words("edge");
  check_words("has no volume in the mesh's metric");
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- single triangles ---- */

/* In two dimensions w_ab = -1/2 (u.v)/A, with u and v from the opposite vertex to a and b, and the
 * area A > 0 of their parallelogram. Edges near light's cone are left out: there w grows, and
 * relative errors are those of u.u. */
START_TEST(weights_of_a_triangle_are_products_of_edges)
{
  int tried = 0;
  for (unsigned seed = 1; tried < repeats(200); seed++) {
    dvi_mesh *mesh = random_simplex(2, 2, minkowski, seed);
    const double *p = dvi_mesh_points(mesh);
    dvi_matrix M;
    int width, is_near_light = 0;
    const int *end = dvi_mesh_vertices(mesh, 1, &width);
    for (int e = 0; e < 3; e++) {
      const double x = p[2 * end[2 * e + 1]] - p[2 * end[2 * e]],
                   t = p[2 * end[2 * e + 1] + 1] - p[2 * end[2 * e] + 1];
      is_near_light |= fabs(x * x - t * t) < 0.1 * (x * x + t * t);
    }
    dvi_star *star = is_near_light ? NULL : star_of(mesh);
    for (int e = 0; e < 3 && star != NULL; e++) {
      const int a = end[2 * e], b = end[2 * e + 1], o = 3 - a - b;
      const double u[] = {p[2 * a] - p[2 * o], p[2 * a + 1] - p[2 * o + 1]},
                   v[] = {p[2 * b] - p[2 * o], p[2 * b + 1] - p[2 * o + 1]},
                   area = fabs(u[0] * v[1] - u[1] * v[0]);
      ck_assert_int_eq(dvi_star_matrix(star, 1, &M), DVI_OK);
      const double size = hypot(u[0], u[1]) * hypot(v[0], v[1]) / area;
      ck_assert_double_eq_tol(M.value[e], -(u[0] * v[0] - u[1] * v[1]) / (2 * area), 1e-13 * size);
    }
    tried += star != NULL;
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- boosts ---- */

/* Give the mesh of the same cells in the frame of an observer with the velocity v along x. */
static dvi_mesh *boosted(const dvi_mesh *mesh, const double *metric, double v)
{
  const int n = dvi_mesh_dimension(mesh);
  const int64_t points = dvi_mesh_count(mesh, 0);
  const double *old = dvi_mesh_points(mesh), gamma = 1 / sqrt(1 - v * v);
  double *point = calloc((size_t)(points * n), sizeof *point);
  int width;
  for (int64_t p = 0; p < points; p++) {
    const double x = old[p * n], t = old[p * n + n - 1];
    for (int l = 1; l < n - 1; l++) point[p * n + l] = old[p * n + l];
    point[p * n] = gamma * (x - v * t);
    point[p * n + n - 1] = gamma * (t - v * x);
  }
  dvi_mesh *made = mesh_of((dvi_mesh_terms){.dimension = n,
                                            .points = points,
                                            .point = point,
                                            .cells = dvi_mesh_count(mesh, n),
                                            .vertex = dvi_mesh_vertices(mesh, n, &width),
                                            .metric = metric});
  free(point);
  return made;
}

/* Lengths in the metric are the same for all observers. Corners are rounded in the other frame,
 * which changes a weight by some roundings times the condition of its cells: points are moved by so
 * little that no face of Kuhn's simplices of cubes that are 0.4 high comes near to light's cone. */
START_TEST(boosts_leave_every_star_unchanged)
{
  for (int n = 2; n <= 4; n++) {
    double metric[4] = {1, 1, 1, 1};
    metric[n - 1] = -1;
    dvi_mesh *flat = jittered_mesh(n, n, n < 4 ? 4 : 2, 0.02, 7);
    const int64_t points = dvi_mesh_count(flat, 0);
    double *low = calloc((size_t)(points * n), sizeof *low);
    int width;
    for (int64_t i = 0; i < points * n; i++)
      low[i] = dvi_mesh_points(flat)[i] * (i % n == n - 1 ? 0.4 : 1);
    dvi_mesh *mesh = mesh_of((dvi_mesh_terms){.dimension = n,
                                              .points = points,
                                              .point = low,
                                              .cells = dvi_mesh_count(flat, n),
                                              .vertex = dvi_mesh_vertices(flat, n, &width),
                                              .metric = metric}),
             *moving = boosted(mesh, metric, 0.6);
    dvi_star *star = star_of(mesh), *other = star_of(moving);
    for (int k = 0; k <= n; k++) {
      dvi_matrix M, N;
      double most = 0;
      ck_assert_int_eq(dvi_star_matrix(star, k, &M), DVI_OK);
      ck_assert_int_eq(dvi_star_matrix(other, k, &N), DVI_OK);
      for (int64_t i = 0; i < M.rows; i++) most = fmax(most, fabs(M.value[i]));
      for (int64_t i = 0; i < M.rows; i++)
        ck_assert_double_eq_tol(N.value[i], M.value[i], 1e-14 * most);
    }
    dvi_star_destroy(&star);
    dvi_star_destroy(&other);
    dvi_mesh_destroy(&mesh);
    dvi_mesh_destroy(&moving);
    dvi_mesh_destroy(&flat);
    free(low);
  }
}
END_TEST

SUITE(spacetime)
{
  tcase_add_test(tests, right_triangles_have_the_weights_of_leapfrog);
  tcase_add_test(tests, diagonals_along_light_are_refused);
  tcase_add_test(tests, weights_of_a_triangle_are_products_of_edges);
  tcase_add_test(tests, boosts_leave_every_star_unchanged);
}
