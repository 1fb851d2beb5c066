/* Audits and repairs of meshes. */
#include <dvi/audit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "num/eigen.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/suite.h"

static dvi_mesh_report audited(const dvi_mesh *mesh)
{
  dvi_mesh_report report;
  ck_assert_msg(dvi_mesh_audit(mesh, NULL, &report) == DVI_OK, "%s", dvi_last_error());
  return report;
}

static dvi_mesh *from_arrays(int n, int space, int points, const double *point, int cells,
                             const int *vertex)
{
  dvi_mesh *mesh = NULL;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .space = space,
                                .points = points,
                                .point = point,
                                .cells = cells,
                                .vertex = vertex};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* ---- topology ---- */

START_TEST(good_meshes_are_manifolds)
{
  static const struct {
    const char *name;
    int dimension;
  } meshes[] = {{"interval", 1}, {"box", 3},  {"kuhn", 3},      {"kuhn-torus", 3}, {"kuhn", 4},
                {"disk", 0},     {"ball", 0}, {"icosphere", 0}, {"genus-2", 0},    {"cylinder", 0}};
  for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
    dvi_generator_options options = {.dimension = meshes[i].dimension};
    const int count = meshes[i].dimension > 0 ? meshes[i].dimension : 1;
    for (int a = 0; a < count; a++) options.cells[a] = count == 4 ? 2 : 3;
    dvi_mesh *mesh = generated(meshes[i].name, options);
    const dvi_mesh_report report = audited(mesh);
    ck_assert_msg(report.is_manifold && report.is_orientable, "%s", meshes[i].name);
    ck_assert_int_eq(report.pinches, 0);
    ck_assert(report.quality > 0 && report.quality <= report.mean_quality + 1e-12);
    ck_assert(report.mean_quality <= 1 + 1e-12);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* Two triangles that share a point alone. */
START_TEST(pinched_vertices_are_found)
{
  static const double point[] = {0, 0, 1, 0, 1, 1, -1, 0, -1, -1};
  static const int vertex[] = {0, 1, 2, 0, 3, 4};
  dvi_mesh *mesh = from_arrays(2, 2, 5, point, 2, vertex);
  const dvi_mesh_report report = audited(mesh);
  ck_assert(!report.is_manifold);
  ck_assert_int_eq(report.pinches, 1);
  ck_assert_int_eq(report.pinched, 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Two tetrahedra that share an edge alone: the edge and both of its ends are pinched. */
START_TEST(pinched_edges_are_counted)
{
  static const double point[] = {0, 0, -1, 0, 0, 1, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, -1, 0};
  static const int vertex[] = {0, 1, 2, 3, 0, 1, 4, 5};
  dvi_mesh *mesh = from_arrays(3, 3, 6, point, 2, vertex);
  const dvi_mesh_report report = audited(mesh);
  ck_assert(!report.is_manifold);
  ck_assert_int_eq(report.pinches, 3);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Three tetrahedra at one edge pinch it, and its two ends. */
START_TEST(an_edge_of_three_parts_counts_once)
{
  static const double point[] = {0,  0, -1, 0,  0,   1, 1,    0,  0, 1,   0.5, 0,
                                 -1, 0, 0,  -1, 0.5, 0, -0.5, -1, 0, 0.5, -1,  0};
  static const int vertex[] = {0, 1, 2, 3, 0, 1, 4, 5, 0, 1, 6, 7};
  dvi_mesh *mesh = from_arrays(3, 3, 8, point, 3, vertex);
  ck_assert_int_eq(audited(mesh).pinches, 3);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(strip_of_moebius_has_one_side)
{
  enum { AROUND = 7 };
  double point[6 * AROUND];
  int vertex[6 * AROUND];
  for (int i = 0; i < AROUND; i++) {
    const double angle = 2 * 3.14159265358979323846 * i / AROUND;
    for (int side = 0; side < 2; side++) {
      double *x = point + 6 * i + 3 * side;
      const double r = 2 + (side - 0.5) * cos(0.5 * angle);
      x[0] = r * cos(angle);
      x[1] = r * sin(angle);
      x[2] = (side - 0.5) * sin(0.5 * angle);
    }
    const int a = 2 * i, b = 2 * i + 1, last = i + 1 == AROUND, c = last ? 1 : 2 * i + 2,
              d = last ? 0 : 2 * i + 3;
    const int two[] = {a, b, c, b, d, c};
    memcpy(vertex + 6 * i, two, sizeof two);
  }
  dvi_mesh *mesh = from_arrays(2, 3, 2 * AROUND, point, 2 * AROUND, vertex);
  const dvi_mesh_report report = audited(mesh);
  ck_assert(report.is_manifold && !report.is_orientable);
  ck_assert_int_eq(report.degree[1].betti, 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(edges_of_three_triangles_are_no_manifold)
{
  static const double point[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
  static const int vertex[] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  dvi_mesh *mesh = from_arrays(2, 3, 5, point, 3, vertex);
  const dvi_mesh_report report = audited(mesh);
  ck_assert(!report.is_manifold);
  ck_assert_int_eq(report.branching, 0);
  ck_assert(isnan(report.degree[0].step));
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- duals and steps ---- */

START_TEST(kuhn_simplices_have_duals_that_vanish)
{
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {2, 2, 2}});
  const dvi_mesh_report report = audited(mesh);
  ck_assert_int_eq(report.degree[1].count, 98);
  ck_assert_int_eq(report.degree[1].zero, 44);
  ck_assert_int_eq(report.degree[2].count, 120);
  ck_assert_int_eq(report.degree[2].zero, 48);
  ck_assert_int_eq(report.degree[1].negative, 0);
  ck_assert(report.advice & DVI_ADVICE_GLUE);
  ck_assert(!isnan(report.degree[0].step) && isnan(report.degree[1].step));
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* On squares of edge h the fastest motion has alternating signs: omega = sqrt(8)/h. */
START_TEST(squares_have_a_known_step)
{
  dvi_mesh *mesh = generated("box", (dvi_generator_options){.cells = {16, 16}});
  const dvi_mesh_report report = audited(mesh);
  const double omega = sqrt(8) * 16;
  ck_assert(report.degree[0].fastest >= omega && report.degree[0].fastest < 1.001 * omega);
  ck_assert(report.degree[1].fastest >= omega * 0.99 && report.degree[1].fastest < 1.001 * omega);
  ck_assert_double_eq_tol(report.degree[0].steps, sqrt(2) / 2 * report.degree[0].fastest, 1e-9);
  ck_assert_double_eq_tol(report.dual_ratio, 0.5, 1e-12);
  ck_assert_double_eq(report.quality, 1);
  ck_assert_int_eq((int)report.advice, 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(spacetime_has_no_frequencies)
{
  static const double point[] = {0, 0, 1, 0, 0, 0.4, 1, 0.4}, metric[] = {1, -1};
  static const int vertex[] = {0, 1, 2, 1, 2, 3};
  dvi_mesh *mesh = NULL;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = 4,
                                .point = point,
                                .cells = 2,
                                .vertex = vertex,
                                .metric = metric};
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  const dvi_mesh_report report = audited(mesh);
  dvi_mesh *flipped = NULL;
  ck_assert(isnan(report.degree[0].fastest));
  ck_assert(!(report.advice & DVI_ADVICE_FLIP));
  ck_assert_int_eq(dvi_mesh_flip(mesh, &flipped, NULL), DVI_UNSUPPORTED);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- flips ---- */

/* Equilateral triangles, with the diagonal of one pair exchanged. */
static dvi_mesh *flipped_patch(int cells, const dvi_mesh_part *part, int parts)
{
  const int across = cells + 1;
  double *point = malloc((size_t)(2 * across * across) * sizeof *point);
  int *vertex = malloc((size_t)(6 * cells * cells) * sizeof *vertex), *v = vertex;
  for (int j = 0; j <= cells; j++)
    for (int i = 0; i <= cells; i++) {
      point[2 * (j * across + i)] = i + 0.5 * j;
      point[2 * (j * across + i) + 1] = 0.5 * sqrt(3) * j;
    }
  for (int j = 0; j < cells; j++)
    for (int i = 0; i < cells; i++) {
      const int a = j * across + i, b = a + 1, c = a + across, d = c + 1,
                is_turned = i == cells / 2 && j == cells / 2;
      const int usual[] = {a, b, c, b, d, c}, turned[] = {a, b, d, a, d, c};
      memcpy(v, is_turned ? turned : usual, sizeof usual);
      v += 6;
    }
  dvi_mesh *mesh = NULL;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = (int64_t)across * across,
                                .point = point,
                                .cells = 2 * (int64_t)cells * cells,
                                .vertex = vertex,
                                .part = part,
                                .parts = parts};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  free(point), free(vertex);
  return mesh;
}

START_TEST(wrong_diagonal_is_flipped)
{
  int64_t flips;
  dvi_mesh *mesh = flipped_patch(6, NULL, 0), *flipped = NULL;
  const dvi_mesh_report before = audited(mesh);
  ck_assert_int_eq(before.degree[1].negative, 1);
  ck_assert_double_eq_tol(before.degree[1].smallest_star, -0.577350269190, 1e-12);
  ck_assert(before.advice & DVI_ADVICE_FLIP);
  ck_assert(isnan(before.degree[0].step));
  ck_assert_int_eq(dvi_mesh_flip(mesh, &flipped, &flips), DVI_OK);
  const dvi_mesh_report after = audited(flipped);
  ck_assert_int_eq(flips, 1);
  ck_assert_int_eq(after.degree[1].negative, 0);
  ck_assert_double_eq_tol(after.degree[2].total, before.degree[2].total, 1e-12);
  dvi_mesh_destroy(&flipped);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Eigenvalues [count], ascending, of B = d S d^T or d^T S d with a diagonal S of any signs, between
 * the square roots of the diagonal N. B then has the eigenvalues of N against S^-1 that are not
 * zero. */
static double *eigenvalues_of(const dvi_matrix *d, int transposed, const double *S, const double *N)
{
  const int64_t n = transposed ? d->columns : d->rows, m = transposed ? d->rows : d->columns;
  double *B = calloc((size_t)(n * n), sizeof *B), *one = calloc((size_t)(n * n), sizeof *one),
         *X = calloc((size_t)(n * n), sizeof *X), *value = calloc((size_t)n, sizeof *value),
         *unit = calloc((size_t)n, sizeof *unit), *image = calloc((size_t)m, sizeof *image);
  for (int64_t i = 0; i < n; i++) {
    one[i * n + i] = unit[i] = 1;
    dvi_matrix_multiply(d, !transposed, unit, image);
    for (int64_t k = 0; k < m; k++) image[k] *= S[k];
    dvi_matrix_multiply(d, transposed, image, B + i * n);
    unit[i] = 0;
  }
  for (int64_t i = 0; i < n; i++)
    for (int64_t j = 0; j < n; j++) B[i * n + j] *= sqrt(N[i] * N[j]);
  ck_assert_int_eq(dvi__eigen_symmetric((int)n, B, one, value, X), DVI_OK);
  free(B), free(one), free(X), free(unit), free(image);
  return value;
}

/* A negative entry of M_1 lets Maxwell's equations grow as exp(2.157 t): the pencil of d^T M_2 d
 * and M_1 has the eigenvalue -4.655. Functions do not grow, because other edges of their vertices
 * outweigh it: d^T M_1 d is semidefinite. */
START_TEST(negative_dual_is_unstable_for_edges_alone)
{
  dvi_mesh *mesh = flipped_patch(6, NULL, 0);
  dvi_star *star = NULL;
  dvi_matrix d0, d1, M0, M1, M2;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, 0, &d0), DVI_OK);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, 1, &d1), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 0, &M0), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 1, &M1), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 2, &M2), DVI_OK);
  int64_t rim, vertices = M0.rows;
  double *inverse = malloc((size_t)M1.rows * sizeof *inverse),
         *share = malloc((size_t)vertices * sizeof *share);
  const int *edge = dvi_mesh_part_cells(mesh, "boundary", 1, &rim);
  for (int64_t e = 0; e < M1.rows; e++) inverse[e] = 1 / M1.value[e];
  for (int64_t i = 0; i < rim; i++) inverse[edge[i]] = 0; /* no voltage along the rim */
  for (int64_t v = 0; v < vertices; v++) share[v] = 1 / M0.value[v];
  double *maxwell = eigenvalues_of(&d1, 0, inverse, M2.value),
         *scalar = eigenvalues_of(&d0, 1, M1.value, share);
  ck_assert_msg(fabs(maxwell[0] + 4.655) < 5e-4, "%.10g", maxwell[0]);
  ck_assert_msg(scalar[0] > -1e-12 && scalar[1] > 0.01, "%g, %g", scalar[0], scalar[1]);
  free(inverse), free(share), free(maxwell), free(scalar);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The wrong diagonal, from (3,3) to (4,4), is a part. */
START_TEST(edges_of_parts_are_not_flipped)
{
  static const int edge[] = {3 * 7 + 3, 4 * 7 + 4};
  const dvi_mesh_part part = {.name = "crack", .degree = 1, .count = 1, .vertex = edge};
  int64_t flips, count;
  dvi_mesh *mesh = flipped_patch(6, &part, 1), *flipped = NULL;
  ck_assert_int_eq(dvi_mesh_flip(mesh, &flipped, &flips), DVI_OK);
  ck_assert_int_eq(flips, 0);
  ck_assert_ptr_nonnull(dvi_mesh_part_cells(flipped, "crack", 1, &count));
  ck_assert_int_eq(count, 1);
  dvi_mesh_destroy(&flipped);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(any_triangles_become_delaunays)
{
  for (unsigned long long seed = 1; seed <= 5; seed++) {
    dvi_mesh *mesh = jittered_mesh(2, 2, 10, 0.3, seed), *flipped = NULL;
    const dvi_mesh_report before = audited(mesh);
    int64_t flips;
    ck_assert_msg(dvi_mesh_flip(mesh, &flipped, &flips) == DVI_OK, "%s", dvi_last_error());
    ck_assert(before.degree[1].negative > 0 && flips > 0);
    dvi_star *star = NULL;
    ck_assert_int_eq(dvi_star_create(flipped, NULL, &star), DVI_OK);
    int64_t rim;
    const int *on_rim = dvi_mesh_part_cells(flipped, "boundary", 1, &rim);
    const double *dual = dvi_star_duals(star, 1);
    for (int64_t e = 0, at = 0; e < dvi_mesh_count(flipped, 1); e++) {
      if (at < rim && on_rim[at] == e) {
        at++;
        continue;
      }
      ck_assert_msg(dual[e] > -1e-12, "edge %d: %g", (int)e, dual[e]);
    }
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&flipped);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(surfaces_are_flipped_too)
{
  int64_t flips;
  dvi_mesh *mesh = generated("torus", (dvi_generator_options){.cells = {30, 6}}), *flipped = NULL;
  ck_assert_msg(dvi_mesh_flip(mesh, &flipped, &flips) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(audited(flipped).degree[1].negative, 0);
  dvi_mesh_destroy(&flipped);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A tetrahedron with a flat top: three triangles meet at vertex 3, and the other diagonal of each
 * two of them is an edge already. */
START_TEST(edges_whose_other_diagonal_exists_stay)
{
  static const double point[] = {0, 0, 0, 1, 0, 0, 0.5, 0.8, 0, 0.5, 0.25, 0.02};
  static const int vertex[] = {0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 2, 1};
  int64_t flips;
  dvi_mesh *mesh = from_arrays(2, 3, 4, point, 4, vertex), *flipped = NULL;
  ck_assert(audited(mesh).degree[1].negative > 0);
  ck_assert_msg(dvi_mesh_flip(mesh, &flipped, &flips) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(flips, 0);
  dvi_mesh_destroy(&flipped);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Surfaces of random points around the centre, as the boundary of their hull is not needed: a
 * sphere whose vertices are moved and whose edges are flipped at random by the library itself. */
START_TEST(rough_spheres_are_flipped)
{
  for (unsigned long long seed = 1; seed <= 20; seed++) {
    dvi_mesh *sphere = generated("icosphere", (dvi_generator_options){.cells = {2}}),
             *flipped = NULL;
    const int points = (int)dvi_mesh_count(sphere, 0), cells = (int)dvi_mesh_count(sphere, 2);
    double *x = malloc((size_t)points * 3 * sizeof *x);
    unsigned long long state = seed;
    for (int i = 0; i < points; i++) {
      const double r = 0.3 + random_number(&state);
      for (int l = 0; l < 3; l++) x[3 * i + l] = r * dvi_mesh_points(sphere)[3 * i + l];
    }
    dvi_mesh *rough = from_arrays(2, 3, points, x, cells, dvi_mesh_vertices(sphere, 2, NULL));
    const dvi_status status = dvi_mesh_flip(rough, &flipped, NULL);
    ck_assert_msg(status == DVI_OK || status == DVI_NOT_CONVERGED, "%s", dvi_last_error());
    if (status == DVI_OK) {
      const dvi_mesh_report report = audited(flipped);
      ck_assert(report.is_manifold && report.degree[2].betti == 1 && report.degree[1].betti == 0);
    }
    free(x);
    dvi_mesh_destroy(&flipped);
    dvi_mesh_destroy(&rough);
    dvi_mesh_destroy(&sphere);
  }
}
END_TEST

/* A fan over a parabola needs as many passes as points. */
START_TEST(long_fans_are_flipped_to_the_end)
{
  enum { POINTS = 500 };
  double point[2 * POINTS];
  int vertex[3 * (POINTS - 2)];
  for (int i = 0; i < POINTS; i++) {
    point[2 * i] = (double)i / POINTS;
    point[2 * i + 1] = point[2 * i] * point[2 * i];
  }
  for (int i = 0; i < POINTS - 2; i++) {
    const int fan[] = {0, i + 1, i + 2};
    memcpy(vertex + 3 * i, fan, sizeof fan);
  }
  dvi_mesh *mesh = from_arrays(2, 2, POINTS, point, POINTS - 2, vertex), *flipped = NULL;
  ck_assert_msg(dvi_mesh_flip(mesh, &flipped, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert(!(audited(flipped).advice & DVI_ADVICE_FLIP));
  dvi_mesh_destroy(&flipped);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The longest edge of an obtuse triangle is a boundary, which no flip can mend. */
START_TEST(flips_are_advised_where_they_help)
{
  static const double point[] = {0, 0, 1, 0, 0.5, 0.1};
  static const int vertex[] = {0, 1, 2};
  dvi_mesh *mesh = from_arrays(2, 2, 3, point, 1, vertex);
  const dvi_mesh_report report = audited(mesh);
  ck_assert_int_eq(report.degree[1].negative, 1);
  ck_assert_int_eq(report.advice, DVI_ADVICE_STAR);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- glue ---- */

START_TEST(kuhn_simplices_become_boxes)
{
  for (int n = 2; n <= 4; n++) {
    dvi_generator_options options = {.dimension = n};
    for (int a = 0; a < n; a++) options.cells[a] = 2 + (a == 0);
    for (int a = 0; a < n; a++) options.extent[a] = 1 + a;
    dvi_mesh *simplices = generated("kuhn", options), *boxes = generated("box", options),
             *glued = NULL;
    ck_assert_msg(dvi_mesh_glue(simplices, &glued) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi_mesh_kind(glued), DVI_BOXES);
    const dvi_mesh_report one = audited(glued), other = audited(boxes);
    for (int k = 0; k <= n; k++) {
      ck_assert_int_eq(one.degree[k].count, other.degree[k].count);
      ck_assert_double_eq_tol(one.degree[k].smallest_star, other.degree[k].smallest_star, 1e-12);
      ck_assert_double_eq_tol(one.degree[k].total, other.degree[k].total, 1e-10);
    }
    for (int i = 2; dvi_mesh_part_name(boxes, i) != NULL; i++) {
      int64_t count, expected;
      const char *name = dvi_mesh_part_name(boxes, i);
      (void)dvi_mesh_part_cells(glued, name, n - 1, &count);
      (void)dvi_mesh_part_cells(boxes, name, n - 1, &expected);
      ck_assert_int_eq(count, expected);
    }
    dvi_mesh_destroy(&glued);
    dvi_mesh_destroy(&boxes);
    dvi_mesh_destroy(&simplices);
  }
}
END_TEST

START_TEST(tori_are_glued)
{
  dvi_mesh *mesh = generated("kuhn-torus", (dvi_generator_options){.cells = {3, 4, 5}}),
           *glued = NULL;
  int64_t betti[4];
  ck_assert_msg(dvi_mesh_glue(mesh, &glued) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_mesh_count(glued, 3), 60);
  ck_assert_int_eq(dvi_mesh_betti(glued, betti), DVI_OK);
  ck_assert(betti[0] == 1 && betti[1] == 3 && betti[2] == 3 && betti[3] == 1);
  dvi_mesh_destroy(&glued);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(repairs_that_are_impossible_are_refused)
{
  dvi_mesh *kuhn = generated("kuhn", (dvi_generator_options){.cells = {2, 2, 2}}),
           *disk = generated("disk", (dvi_generator_options){.cells = {3}}), *made = NULL;
  dvi_mesh_report report;
  ck_assert_int_eq(dvi_mesh_flip(kuhn, &made, NULL), DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_mesh_glue(disk, &made), DVI_UNSUPPORTED);
  ck_assert_ptr_null(made);
  ck_assert_int_eq(dvi_mesh_glue(NULL, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_mesh_flip(disk, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_mesh_audit(disk, &(dvi_audit_options){.size = 1}, &report),
                   DVI_BAD_ARGUMENT);
  dvi_mesh_destroy(&kuhn);
  dvi_mesh_destroy(&disk);
}
END_TEST

SUITE(audit)
{
  tcase_add_test(tests, good_meshes_are_manifolds);
  tcase_add_test(tests, pinched_vertices_are_found);
  tcase_add_test(tests, pinched_edges_are_counted);
  tcase_add_test(tests, an_edge_of_three_parts_counts_once);
  tcase_add_test(tests, strip_of_moebius_has_one_side);
  tcase_add_test(tests, edges_of_three_triangles_are_no_manifold);
  tcase_add_test(tests, kuhn_simplices_have_duals_that_vanish);
  tcase_add_test(tests, squares_have_a_known_step);
  tcase_add_test(tests, spacetime_has_no_frequencies);
  tcase_add_test(tests, wrong_diagonal_is_flipped);
  tcase_add_test(tests, negative_dual_is_unstable_for_edges_alone);
  tcase_add_test(tests, edges_of_parts_are_not_flipped);
  tcase_add_test(tests, any_triangles_become_delaunays);
  tcase_add_test(tests, surfaces_are_flipped_too);
  tcase_add_test(tests, edges_whose_other_diagonal_exists_stay);
  tcase_add_test(tests, rough_spheres_are_flipped);
  tcase_add_test(tests, long_fans_are_flipped_to_the_end);
  tcase_add_test(tests, flips_are_advised_where_they_help);
  tcase_add_test(tests, kuhn_simplices_become_boxes);
  tcase_add_test(tests, tori_are_glued);
  tcase_add_test(tests, repairs_that_are_impossible_are_refused);
}
