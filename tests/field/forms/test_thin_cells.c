/* Thin simplices against quadruple precision, in all numberings of their corners. */
#include <dvi/audit.h>
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/quad/quad_simplex.h"
#include "support/suite.h"

/* The library computes thin cells in twice the digits, and others in doubles if they lose three
 * digits at most. */
static const double most = 1e-12;

/* How a random simplex is made thin: by factors along the axes of space, by factors along axes that
 * were turned, by one factor along such an axis, or by moving a corner close to another one. */
typedef enum thinness { ALONG_AXES, TURNED, FLAT, NEEDLE, PLAIN, KINDS } thinness;

static dvi_mesh *single(int n, int space, const double *point)
{
  static const int vertex[] = {0, 1, 2, 3, 4};
  dvi_mesh *mesh = NULL;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .space = space,
                                .points = n + 1,
                                .point = point,
                                .cells = 1,
                                .vertex = vertex};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* ---- random corners ---- */

/* Rotate every plane of two axes by a random angle. */
static void turn(int count, int space, double *point, unsigned long long *state)
{
  for (int a = 0; a < space; a++)
    for (int b = 0; b < a; b++) {
      const double angle = 6.3 * random_number(state), c = cos(angle), s = sin(angle);
      for (int i = 0; i < count; i++) {
        double *x = point + i * space, old = x[a];
        x[a] = c * old - s * x[b];
        x[b] = s * old + c * x[b];
      }
    }
}

/* The factors go down to 1e-7. */
static void make_corners(int n, int space, thinness kind, unsigned long long *state, double *point)
{
  double factor[QUAD_SPACE];
  for (int l = 0; l < space; l++)
    factor[l] = kind < FLAT && l > 0 && l < n ? pow(10, -7 * random_number(state)) : 1;
  if (kind == FLAT) factor[n - 1] = 1e-7;
  for (int i = 0; i <= n; i++)
    for (int l = 0; l < space; l++)
      point[i * space + l] = l < n ? factor[l] * random_number(state) : 0;
  if (kind != ALONG_AXES) turn(n + 1, space, point, state);
  if (kind != NEEDLE) return;
  const double distance = pow(10, -7 * random_number(state));
  for (int l = 0; l < space; l++)
    point[space + l] = point[l] + distance * (random_number(state) - 0.5);
}

/* Permutation `number` of the corners. */
static void permute(int n, int space, int number, const double *point, double *permuted)
{
  int left[] = {0, 1, 2, 3, 4};
  for (int i = 0, rest = number; i <= n; i++) {
    const int take = rest % (n + 1 - i);
    rest /= n + 1 - i;
    for (int l = 0; l < space; l++) permuted[i * space + l] = point[left[take] * space + l];
    for (int j = take; j < n - i; j++) left[j] = left[j + 1];
  }
}

/* ---- comparisons ---- */

static int mask_of(int corners, const int *vertex)
{
  int mask = 0;
  for (int c = 0; c < corners; c++) mask |= 1 << vertex[c];
  return mask;
}

static int vertex_of(const dvi_mesh *mesh, int k, int64_t face, const int **vertex)
{
  static const int all[] = {0, 1, 2, 3, 4};
  *vertex = k > 0 ? dvi_mesh_vertices(mesh, k, NULL) + face * (k + 1) : all + face;
  return mask_of(k + 1, *vertex);
}

static void check_star(const dvi_mesh *mesh)
{
  const int n = dvi_mesh_dimension(mesh);
  quad entry[QUAD_FACES], size[QUAD_FACES];
  dvi_star *star = NULL;
  quad_star(n, dvi_mesh_space(mesh), dvi_mesh_points(mesh), entry, size);
  ck_assert_msg(dvi_star_create(mesh, NULL, &star) == DVI_OK, "%s", dvi_last_error());
  for (int k = 0; k <= n; k++) {
    dvi_matrix M;
    ck_assert_int_eq(dvi_star_matrix(star, k, &M), DVI_OK);
    for (int64_t face = 0; face < M.rows; face++) {
      const int *vertex, mask = vertex_of(mesh, k, face, &vertex);
      const double error = (double)(quad_abs(M.value[face] - entry[mask]) / size[mask]);
      ck_assert_msg(error < most, "n = %d, k = %d: %g", n, k, error);
    }
  }
  dvi_star_destroy(&star);
}

/* The matrices are full, because all faces are those of one cell. */
static void check_whitney(const dvi_mesh *mesh, const quad_simplex *s)
{
  const dvi_star_options options = {.size = sizeof options, .kind = DVI_WHITNEY};
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  for (int k = 0; k < s->k; k++) {
    dvi_matrix M;
    quad largest = 0, error = 0;
    ck_assert_msg(dvi_star_matrix(star, k, &M) == DVI_OK, "%s", dvi_last_error());
    for (int64_t a = 0; a < M.rows; a++)
      for (int64_t b = 0; b < M.rows; b++) {
        const int *I, *J;
        (void)vertex_of(mesh, k, a, &I);
        (void)vertex_of(mesh, k, b, &J);
        const quad exact = quad_whitney(s, k, I, J),
                   wrong = quad_abs(M.value[a * M.rows + b] - exact);
        if (quad_abs(exact) > largest) largest = quad_abs(exact);
        if (wrong > error) error = wrong;
      }
    ck_assert_msg(error < most * largest, "n = %d, k = %d: %g", s->k, k, (double)(error / largest));
  }
  dvi_star_destroy(&star);
}

static int next_axes(int space, int k, int *axis)
{
  int i = k - 1;
  while (i >= 0 && axis[i] == space - k + i) i--;
  if (i < 0) return 0;
  axis[i]++;
  for (i++; i < k; i++) axis[i] = axis[i - 1] + 1;
  return 1;
}

/* Each form of a face by itself, relative to the largest component of all of them. */
static void check_forms(const dvi_mesh *mesh, const quad_simplex *s, double tolerance,
                        unsigned long long *state)
{
  const int *corner = dvi_mesh_vertices(mesh, s->k, NULL);
  double place[QUAD_CORNERS] = {1}, of_vertex[QUAD_CORNERS];
  for (int i = 1; i <= s->k; i++) place[0] -= place[i] = random_number(state) / s->k;
  for (int i = 0; i <= s->k; i++) of_vertex[corner[i]] = place[i];
  for (int k = 0; k <= s->k; k++) {
    const int64_t faces = dvi_mesh_count(mesh, k);
    quad largest = 0, error = 0;
    for (int64_t face = 0; face < faces; face++) {
      double form[10] = {0}, value[10];
      const int *vertex;
      int axis[] = {0, 1, 2, 3, 4}, component = 0;
      form[face] = 1;
      ck_assert_int_eq(dvi_form_evaluate(mesh, k, form, 0, place, value), DVI_OK);
      (void)vertex_of(mesh, k, face, &vertex);
      do {
        const quad exact = quad_whitney_form(s, k, vertex, of_vertex, axis),
                   wrong = quad_abs(value[component++] - exact);
        if (quad_abs(exact) > largest) largest = quad_abs(exact);
        if (wrong > error) error = wrong;
      } while (next_axes(s->space, k, axis));
    }
    ck_assert_msg(error < tolerance * largest, "n = %d, k = %d: %g", s->k, k,
                  (double)(error / largest));
  }
}

static void check_numbering(int n, int space, const double *point, unsigned long long *state)
{
  static const int all[] = {0, 1, 2, 3, 4};
  dvi_mesh *mesh = single(n, space, point);
  quad_simplex s;
  quad_simplex_of(n, space, point, all, &s);
  check_star(mesh);
  check_whitney(mesh, &s);
  check_forms(mesh, &s, most, state);
  dvi_mesh_destroy(&mesh);
}

/* The simplices of dimension _i + 1, in R^n and R^(n+1). */
START_TEST(thin_simplices_keep_their_digits)
{
  static const int numberings[] = {1, 2, 6, 24, 120};
  const int n = _i + 1, cases = is_short_run() ? KINDS : n < 4 ? 40 : 2 * KINDS;
  unsigned long long state = (unsigned)n;
  for (int i = 0; i < cases; i++) {
    double point[QUAD_CORNERS * QUAD_SPACE], permuted[QUAD_CORNERS * QUAD_SPACE];
    const int space = n + i / KINDS % 2;
    make_corners(n, space, (thinness)(i % KINDS), &state, point);
    for (int number = 0; number < numberings[n]; number++) {
      permute(n, space, number, point, permuted);
      check_numbering(n, space, permuted, &state);
    }
  }
}
END_TEST

/* Forms are as exact as their covectors in twice the digits. Without Newton's step for these, they
 * have errors of some 1e-13. */
START_TEST(flat_simplices_keep_the_digits_of_forms)
{
  static const int all[] = {0, 1, 2, 3, 4};
  unsigned long long state = 3;
  for (int i = 0; i < 300; i++) {
    double point[QUAD_CORNERS * QUAD_SPACE];
    quad_simplex s;
    make_corners(4, 4 + i % 2, FLAT, &state, point);
    dvi_mesh *mesh = single(4, 4 + i % 2, point);
    quad_simplex_of(4, 4 + i % 2, point, all, &s);
    check_forms(mesh, &s, 1e-14, &state);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* The triangle's entry at the edge across from a corner is half of the cotangent there. */
START_TEST(triangles_have_their_cotangents)
{
  for (double thin = 1e-4; thin > 5e-8; thin /= 10) {
    const double point[] = {.1, .3 * thin, 1.1, .7 * thin, 1.13, 1.7 * thin};
    for (int number = 0; number < 6; number++) {
      double permuted[6];
      permute(2, 2, number, point, permuted);
      dvi_mesh *mesh = single(2, 2, permuted);
      check_star(mesh);
      dvi_mesh_destroy(&mesh);
    }
  }
}
END_TEST

/* ---- boxes of Kuhn's simplices ---- */

static dvi_mesh *thin_box(int n, int long_axes, double thin, const double *metric)
{
  dvi_generator_options options = {.size = sizeof options, .dimension = n};
  dvi_mesh *plain = NULL, *mesh = NULL;
  for (int a = 0; a < n; a++) {
    options.cells[a] = 2;
    options.extent[a] = a < long_axes ? 1 : thin;
  }
  ck_assert_msg(dvi_mesh_generate("kuhn", &options, &plain) == DVI_OK, "%s", dvi_last_error());
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .points = dvi_mesh_count(plain, 0),
                                .point = dvi_mesh_points(plain),
                                .cells = dvi_mesh_count(plain, n),
                                .vertex = dvi_mesh_vertices(plain, n, NULL),
                                .metric = metric};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&plain);
  return mesh;
}

static void check_volume(const dvi_mesh *mesh, dvi_star_kind kind, double volume)
{
  const int n = dvi_mesh_dimension(mesh);
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  dvi_star *star = NULL;
  dvi_matrix M;
  double sum = 0;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  for (int k = 0; k <= n; k++)
    ck_assert_msg(dvi_star_matrix(star, k, &M) == DVI_OK, "%s", dvi_last_error());
  for (int64_t c = 0; c < M.rows; c++) sum += 1 / M.value[c];
  ck_assert_double_eq_tol(sum, volume, most * fabs(volume));
  dvi_star_destroy(&star);
}

START_TEST(thin_boxes_of_simplices_have_stars_and_audits)
{
  const dvi_audit_options options = {.size = sizeof options, .without_steps = 1};
  for (int n = 2; n <= 4; n++)
    for (int long_axes = 1; long_axes < n; long_axes++)
      for (double thin = 1e-1; thin > 5e-8; thin /= 10) {
        const double volume = pow(thin, n - long_axes);
        dvi_mesh *mesh = thin_box(n, long_axes, thin, NULL), *glued = NULL;
        dvi_mesh_report report;
        for (int kind = DVI_CIRCUMCENTRIC; kind <= DVI_WHITNEY; kind++)
          check_volume(mesh, (dvi_star_kind)kind, volume);
        ck_assert_msg(dvi_mesh_audit(mesh, &options, &report) == DVI_OK, "%s", dvi_last_error());
        ck_assert_double_eq_tol(report.degree[n].total, volume, most * volume);
        ck_assert_msg(dvi_mesh_glue(mesh, &glued) == DVI_OK, "%s", dvi_last_error());
        ck_assert_int_eq(dvi_mesh_count(glued, n), 1 << n);
        dvi_mesh_destroy(&glued);
        dvi_mesh_destroy(&mesh);
      }
}
END_TEST

/* ---- metrics with signs ---- */

/* A box that is short in time, whose simplices are timelike. */
START_TEST(thin_boxes_of_spacetime_have_their_volumes)
{
  static const double metric[] = {1, 1, 1, -1};
  for (int n = 2; n <= 4; n++)
    for (double thin = 1e-1; thin > 5e-8; thin /= 10) {
      dvi_mesh *mesh = thin_box(n, n - 1, thin, metric + 4 - n);
      check_volume(mesh, DVI_CIRCUMCENTRIC, -thin);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

static dvi_mesh *triangle_of_spacetime(int space, const double *point)
{
  static const double metric[] = {1, 1, -1};
  static const int vertex[] = {0, 1, 2};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = space,
                                .points = 3,
                                .point = point,
                                .cells = 1,
                                .vertex = vertex,
                                .metric = metric + 3 - space};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* 0.1 + 0.2 is not 0.3. */
START_TEST(edges_are_lightlike_up_to_roundings)
{
  const double point[] = {0, 0, .1 + .2, .3, 1, 0};
  dvi_mesh *mesh = triangle_of_spacetime(2, point);
  dvi_star *star;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_BAD_ARGUMENT);
  check_words("edge 0 (vertices 0 1) has no volume in the mesh's metric");
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* In the plane t = x cos a + y sin a all edges but those along its ray of light are spacelike, but
 * there is no area. If t is tilted by 1e-9, there is one. */
START_TEST(triangles_are_lightlike_up_to_roundings)
{
  for (int i = 1; i < 40; i++)
    for (int is_tilted = 0; is_tilted < 2; is_tilted++) {
      double point[] = {0, 0, 0, 1, .2, 0, .3, .9, 0};
      const double slope = is_tilted ? 1 - 1e-9 : 1;
      for (int c = 0; c < 9; c += 3)
        point[c + 2] = slope * (cos(.3 * i) * point[c] + sin(.3 * i) * point[c + 1]);
      dvi_mesh *mesh = triangle_of_spacetime(3, point);
      dvi_star *star = NULL;
      const dvi_status status = dvi_star_create(mesh, NULL, &star);
      ck_assert_int_eq(status, is_tilted ? DVI_OK : DVI_BAD_ARGUMENT);
      if (!is_tilted) check_words("triangle 0 (vertices 0 1 2) has no volume");
      dvi_star_destroy(&star);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

START_TEST(quality_is_that_of_euclidean_space)
{
  static const double metric[] = {1, 1, -1}, point[] = {0, 0, 0, 1, .1, .2, .3, 1, .1, .2, .4, .7};
  static const int vertex[] = {0, 1, 2, 3};
  double quality[2];
  for (int i = 0; i < 2; i++) {
    const dvi_mesh_terms terms = {.size = sizeof terms,
                                  .dimension = 3,
                                  .points = 4,
                                  .point = point,
                                  .cells = 1,
                                  .vertex = vertex,
                                  .metric = i == 0 ? metric : NULL};
    dvi_mesh *mesh = NULL;
    dvi_mesh_report report;
    ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
    ck_assert_msg(dvi_mesh_audit(mesh, NULL, &report) == DVI_OK, "%s", dvi_last_error());
    quality[i] = report.quality;
    dvi_mesh_destroy(&mesh);
  }
  ck_assert_double_eq(quality[0], quality[1]);
}
END_TEST

SUITE(thin_cells)
{
  tcase_add_loop_test(tests, thin_simplices_keep_their_digits, 0, 4);
  tcase_add_test(tests, flat_simplices_keep_the_digits_of_forms);
  tcase_add_test(tests, triangles_have_their_cotangents);
  tcase_add_test(tests, thin_boxes_of_simplices_have_stars_and_audits);
  tcase_add_test(tests, thin_boxes_of_spacetime_have_their_volumes);
  tcase_add_test(tests, edges_are_lightlike_up_to_roundings);
  tcase_add_test(tests, triangles_are_lightlike_up_to_roundings);
  tcase_add_test(tests, quality_is_that_of_euclidean_space);
}
