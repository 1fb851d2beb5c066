/* Meshes from arrays: incidence, orientation, parts, and what is refused. */
#include <dvi/mesh.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/meshes.h"
#include "support/suite.h"

/* ---- a square of two triangles ---- */

static const double square_points[] = {0, 0, 1, 0, 0, 1, 1, 1};
static const int two_triangles[] = {0, 1, 3, 0, 3, 2};

static dvi_mesh_terms square_terms(void)
{
  return (dvi_mesh_terms){.size = sizeof(dvi_mesh_terms),
                          .dimension = 2,
                          .points = 4,
                          .point = square_points,
                          .cells = 2,
                          .vertex = two_triangles};
}

START_TEST(a_square_has_its_cells)
{
  static const int edges[] = {0, 1, 0, 2, 0, 3, 1, 3, 2, 3};
  const dvi_mesh_terms terms = square_terms();
  dvi_mesh *mesh;
  dvi_matrix d;
  int width;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 4);
  ck_assert_int_eq(dvi_mesh_count(mesh, 1), 5);
  ck_assert_int_eq(dvi_mesh_count(mesh, 2), 2);
  ck_assert_int_eq(dvi_mesh_count(mesh, 3), 0);
  ck_assert_mem_eq(dvi_mesh_vertices(mesh, 1, &width), edges, sizeof edges);
  ck_assert_int_eq(width, 2);
  /* the triangle 0 1 3 has the edges 1 3, 0 3, 0 1 in its boundary with the signs +, -, + */
  ck_assert_int_eq(dvi_mesh_incidence(mesh, 1, &d), DVI_OK);
  static const int facets[] = {3, 2, 0, 4, 2, 1};
  static const int8_t signs[] = {1, -1, 1, 1, -1, 1};
  ck_assert_mem_eq(d.column, facets, sizeof facets);
  ck_assert_mem_eq(d.sign, signs, sizeof signs);
  /* 0 1 3 turns to the left, 0 2 3 to the right */
  ck_assert_int_eq(dvi_mesh_orientation(mesh)[0], 1);
  ck_assert_int_eq(dvi_mesh_orientation(mesh)[1], -1);
  dvi_mesh_destroy(&mesh);
  ck_assert_ptr_null(mesh);
}
END_TEST

START_TEST(a_square_has_its_boundary)
{
  static const int rim[] = {0, 1, 3, 4};
  const dvi_mesh_terms terms = square_terms();
  dvi_mesh *mesh;
  int64_t count;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  const int *edge = dvi_mesh_part_cells(mesh, "boundary", 1, &count);
  ck_assert_int_eq(count, 4);
  ck_assert_mem_eq(edge, rim, sizeof rim);
  (void)dvi_mesh_part_cells(mesh, "boundary", 0, &count);
  ck_assert_int_eq(count, 4);
  (void)dvi_mesh_part_cells(mesh, "boundary", 2, &count);
  ck_assert_int_eq(count, 0);
  (void)dvi_mesh_part_cells(mesh, "all", 2, &count);
  ck_assert_int_eq(count, 2);
  ck_assert_ptr_null(dvi_mesh_part_cells(mesh, "rim", 1, &count));
  ck_assert_int_eq(count, -1);
  ck_assert_str_eq(dvi_mesh_part_name(mesh, 1), "boundary");
  ck_assert_ptr_null(dvi_mesh_part_name(mesh, 2));
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(parts_are_found_by_vertices)
{
  static const int left[] = {2, 0}, upper[] = {3, 2, 0};
  const dvi_mesh_part part[] = {{"left", 1, 1, left, NULL}, {"upper", 2, 1, upper, NULL}};
  dvi_mesh_terms terms = square_terms();
  dvi_mesh *mesh;
  int64_t count;
  terms.part = part;
  terms.parts = 2;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_part_cells(mesh, "left", 1, &count)[0], 1);
  ck_assert_int_eq(dvi_mesh_part_cells(mesh, "upper", 2, &count)[0], 1);
  (void)dvi_mesh_part_cells(mesh, "upper", 1, &count);
  ck_assert_int_eq(count, 3);
  ck_assert_int_eq(dvi_mesh_part_degree(mesh, 3), 2);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Three triangles at one edge, and a part with any of them. */
START_TEST(parts_are_found_where_cells_branch)
{
  static const double point[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
  static const int vertex[] = {0, 1, 2, 0, 1, 3, 0, 1, 4},
                   orders[][3] = {{4, 0, 1}, {4, 1, 0}, {0, 1, 4}, {1, 0, 4}, {0, 4, 1}, {1, 4, 0}};
  for (int i = 0; i < 6; i++) {
    int64_t count;
    dvi_mesh *mesh = NULL;
    const dvi_mesh_part part = {.name = "third", .degree = 2, .count = 1, .vertex = orders[i]};
    const dvi_mesh_terms terms = {.size = sizeof terms,
                                  .dimension = 2,
                                  .space = 3,
                                  .points = 5,
                                  .point = point,
                                  .cells = 3,
                                  .vertex = vertex,
                                  .part = &part,
                                  .parts = 1};
    ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi_mesh_part_cells(mesh, "third", 2, &count)[0], 2);
    ck_assert_ptr_nonnull(dvi_mesh_part_cells(mesh, "third", 2, NULL));
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- d d = 0 ---- */

static void check_complex(const dvi_mesh *mesh)
{
  for (int k = 0; k + 1 < dvi_mesh_dimension(mesh); k++) {
    dvi_matrix d, e;
    ck_assert_int_eq(dvi_mesh_incidence(mesh, k, &d), DVI_OK);
    ck_assert_int_eq(dvi_mesh_incidence(mesh, k + 1, &e), DVI_OK);
    int *sum = calloc((size_t)d.columns, sizeof *sum);
    for (int64_t row = 0; row < e.rows; row++)
      for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < e.width; i++)
          for (int j = 0; j < d.width; j++) {
            const int64_t face = e.column[row * e.width + i], at = face * d.width + j;
            if (pass == 0)
              sum[d.column[at]] += e.sign[row * e.width + i] * d.sign[at];
            else
              ck_assert_int_eq(sum[d.column[at]], 0);
          }
    free(sum);
  }
}

START_TEST(the_boundary_of_a_boundary_is_empty)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *mesh = jittered_mesh(n, n, 3, 0.1, 1);
    check_complex(mesh);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* Two cubes whose common square has its corners in another order in each of them. */
START_TEST(boxes_may_be_turned_against_each_other)
{
  double point[36];
  for (int i = 0; i < 12; i++) {
    point[3 * i] = i % 3;
    point[3 * i + 1] = i / 3 % 2;
    point[3 * i + 2] = i / 6;
  }
  /* the second cube has its first axis along y, its second one along -x, its third along z */
  static const int vertex[] = {0, 1, 3, 4, 6, 7, 9, 10, 2, 5, 1, 4, 8, 11, 7, 10};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = DVI_BOXES,
                                .dimension = 3,
                                .points = 12,
                                .point = point,
                                .cells = 2,
                                .vertex = vertex};
  dvi_mesh *mesh;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_mesh_count(mesh, 2), 11);
  ck_assert_int_eq(dvi_mesh_count(mesh, 1), 20);
  ck_assert_int_eq(dvi_mesh_orientation(mesh)[1], 1);
  check_complex(mesh);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- surfaces ---- */

/* The projective plane of six vertices, those of a simplex in five dimensions. */
START_TEST(the_projective_plane_has_no_orientation)
{
  static const int vertex[] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 1, 5,
                               1, 2, 4, 2, 4, 5, 2, 3, 5, 1, 3, 5, 1, 3, 4};
  double point[30] = {0};
  for (int i = 0; i < 5; i++) point[5 * i + i] = 1;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 5,
                                .points = 6,
                                .point = point,
                                .cells = 10,
                                .vertex = vertex};
  dvi_mesh *mesh;
  int64_t count;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  ck_assert_ptr_null(dvi_mesh_orientation(mesh));
  (void)dvi_mesh_part_cells(mesh, "boundary", 0, &count);
  ck_assert_int_eq(count, 0);
  check_complex(mesh);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A surface in space has the orientation of its first cell. */
START_TEST(a_surface_follows_its_first_cell)
{
  static const double point[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  static const int vertex[] = {2, 1, 0, 0, 1, 3, 1, 2, 3, 0, 2, 3};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 3,
                                .points = 4,
                                .point = point,
                                .cells = 4,
                                .vertex = vertex};
  dvi_mesh *mesh;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  const int8_t *sign = dvi_mesh_orientation(mesh);
  ck_assert(sign[0] == -1 && sign[1] == 1 && sign[2] == 1 && sign[3] == -1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- bad input ---- */

static void refused(const dvi_mesh_terms *terms, dvi_status status, const char *words)
{
  dvi_mesh *mesh = (dvi_mesh *)terms;
  ck_assert_int_eq(dvi_mesh_create(terms, &mesh), status);
  ck_assert_ptr_null(mesh);
  check_words(words);
}

START_TEST(counts_out_of_range_are_refused)
{
  dvi_mesh_terms terms = square_terms();
  terms.size = 0;
  refused(&terms, DVI_BAD_ARGUMENT, "sizeof(dvi_mesh_terms)");
  terms = square_terms();
  terms.dimension = 5;
  refused(&terms, DVI_BAD_SIZE, "the dimension is 5");
  terms = square_terms();
  terms.space = 1;
  refused(&terms, DVI_BAD_SIZE, "1 coordinates");
  terms = square_terms();
  terms.space = -3;
  refused(&terms, DVI_BAD_SIZE, "-3 coordinates");
  terms = square_terms();
  terms.points = -4;
  refused(&terms, DVI_BAD_SIZE, "-4 are given");
  terms = square_terms();
  terms.cells = (int64_t)1 << 40;
  refused(&terms, DVI_BAD_SIZE, "needs cells");
  terms = square_terms();
  terms.vertex = NULL;
  refused(&terms, DVI_BAD_ARGUMENT, "needs cells");
  terms = square_terms();
  terms.parts = 1;
  refused(&terms, DVI_BAD_ARGUMENT, "1 parts");
  ck_assert_int_eq(dvi_mesh_create(NULL, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

/* In the plane two of three triangles at an edge overlap, in whatever order they are given. */
START_TEST(overlapping_triangles_are_refused)
{
  static const double point[] = {0, 0, 1, 0, 0, 1, 0, -1, 1, 1};
  static const int orders[][9] = {
      {0, 1, 2, 0, 1, 3, 0, 1, 4}, {0, 1, 2, 0, 1, 4, 0, 1, 3}, {0, 1, 3, 0, 1, 2, 0, 1, 4}};
  for (int i = 0; i < 3; i++) {
    const dvi_mesh_terms terms = {.size = sizeof terms,
                                  .dimension = 2,
                                  .points = 5,
                                  .point = point,
                                  .cells = 3,
                                  .vertex = orders[i]};
    refused(&terms, DVI_BAD_ARGUMENT, "more than two cells");
  }
}
END_TEST

START_TEST(bad_axes_are_refused)
{
  static const double metric[] = {1, 0.5}, period[] = {-1, 0}, short_period[] = {2, 0};
  dvi_mesh_terms terms = square_terms();
  terms.metric = metric;
  refused(&terms, DVI_BAD_ARGUMENT, "metric of axis 1 is 0.5");
  terms = square_terms();
  terms.period = period;
  refused(&terms, DVI_BAD_ARGUMENT, "period of axis 0 is -1");
  terms.period = short_period;
  refused(&terms, DVI_BAD_ARGUMENT, "as long as half of the period 2 of axis 0");
}
END_TEST

START_TEST(bad_cells_are_refused)
{
  static const struct {
    int vertex[6];
    const char *words;
  } cases[] = {
      {{0, 1, 4, 0, 3, 2}, "triangle 0 has vertex 4"},
      {{0, 1, 3, 0, -3, 2}, "triangle 1 has vertex -3"},
      {{0, 1, 3, 2, 3, 2}, "triangle 1 is degenerate: it has vertex 2 twice"},
      {{0, 1, 3, 3, 1, 0}, "point 2 belongs to no cell"},
      {{0, 1, 3, 0, 2, 1}, "lie on the same side of their common edge"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    dvi_mesh_terms terms = square_terms();
    terms.vertex = cases[i].vertex;
    refused(&terms, DVI_BAD_ARGUMENT, cases[i].words);
  }
}
END_TEST

START_TEST(bad_points_are_refused)
{
  double point[8];
  dvi_mesh_terms terms = square_terms();
  memcpy(point, square_points, sizeof point);
  terms.point = point;
  point[3] = NAN;
  refused(&terms, DVI_BAD_ARGUMENT, "coordinate 1 of point 1 is nan");
  point[3] = 1, point[2] = 0.5, point[3] = 0.5; /* on the diagonal */
  refused(&terms, DVI_BAD_ARGUMENT, "triangle 0 (vertices 0 1 3) is degenerate");
}
END_TEST

START_TEST(cells_given_twice_are_refused)
{
  static const int vertex[] = {0, 1, 3, 0, 3, 2, 3, 0, 1};
  dvi_mesh_terms terms = square_terms();
  terms.cells = 3;
  terms.vertex = vertex;
  refused(&terms, DVI_BAD_ARGUMENT, "triangle 2 (vertices 0 1 3) is given twice, and is cell 0");
}
END_TEST

START_TEST(boxes_that_are_not_rectangular_are_refused)
{
  static const double skew[] = {0, 0, 1, 0, 0.2, 1, 1.2, 1};
  static const int corners[] = {0, 1, 2, 3}, twisted[] = {0, 1, 3, 2};
  dvi_mesh_terms terms = square_terms();
  terms.kind = DVI_BOXES;
  terms.cells = 1;
  terms.vertex = corners;
  terms.point = skew;
  refused(&terms, DVI_BAD_ARGUMENT, "rectangle 0 (vertices 0 1 2 3) is not rectangular");
  terms.point = square_points;
  terms.vertex = twisted;
  refused(&terms, DVI_BAD_ARGUMENT, "not rectangular");
}
END_TEST

START_TEST(bad_parts_are_refused)
{
  static const int edge[] = {1, 2}, far[] = {0, 9}, number[] = {2};
  const struct {
    dvi_mesh_part part;
    const char *words;
  } cases[] = {
      {{NULL, 1, 1, edge, NULL}, "part 0 has no name"},
      {{"boundary", 1, 1, edge, NULL}, "every mesh has a part \"boundary\""},
      {{"rim", 3, 1, edge, NULL}, "degree 3"},
      {{"rim", 1, 0, edge, NULL}, "needs cells"},
      {{"rim", 1, 1, edge, edge}, "needs cells"},
      {{"rim", 1, 1, NULL, number}, "needs the vertices of its cells"},
      {{"rim", 1, 1, edge, NULL}, "edge 0 with the vertices 1, 2, which the mesh has not"},
      {{"rim", 1, 1, far, NULL}, "part \"rim\" has vertex 9"},
      {{"core", 2, 1, NULL, number}, "cell 2 of degree 2, beyond the 2"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    dvi_mesh_terms terms = square_terms();
    terms.part = &cases[i].part;
    terms.parts = 1;
    refused(&terms, DVI_BAD_ARGUMENT, cases[i].words);
  }
}
END_TEST

START_TEST(lack_of_memory_is_reported)
{
  static const int left[] = {2, 0};
  const dvi_mesh_part part = {"left", 1, 1, left, NULL};
  dvi_mesh_terms terms = square_terms();
  terms.part = &part;
  terms.parts = 1;
  long successes = 0;
  dvi_status status = DVI_NO_MEMORY;
  for (; status == DVI_NO_MEMORY && successes < 1000; successes++) {
    dvi_mesh *mesh;
    dvi__fail_allocations_after(successes);
    status = dvi_mesh_create(&terms, &mesh);
    dvi__fail_allocations_after(-1);
    dvi_mesh_destroy(&mesh);
  }
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_gt(successes, 10);
}
END_TEST

START_TEST(a_shared_mesh_lives_until_its_last_owner)
{
  const dvi_mesh_terms terms = square_terms();
  dvi_mesh *mesh;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  dvi_mesh *other = dvi_mesh_share(mesh);
  dvi_mesh_destroy(&mesh);
  ck_assert_int_eq(dvi_mesh_count(other, 0), 4);
  dvi_mesh_destroy(&other);
  dvi_mesh_destroy(&other);
}
END_TEST

SUITE(mesh)
{
  tcase_add_test(tests, a_square_has_its_cells);
  tcase_add_test(tests, a_square_has_its_boundary);
  tcase_add_test(tests, parts_are_found_by_vertices);
  tcase_add_test(tests, parts_are_found_where_cells_branch);
  tcase_add_test(tests, overlapping_triangles_are_refused);
  tcase_add_test(tests, the_boundary_of_a_boundary_is_empty);
  tcase_add_test(tests, boxes_may_be_turned_against_each_other);
  tcase_add_test(tests, the_projective_plane_has_no_orientation);
  tcase_add_test(tests, a_surface_follows_its_first_cell);
  tcase_add_test(tests, counts_out_of_range_are_refused);
  tcase_add_test(tests, bad_axes_are_refused);
  tcase_add_test(tests, bad_cells_are_refused);
  tcase_add_test(tests, bad_points_are_refused);
  tcase_add_test(tests, cells_given_twice_are_refused);
  tcase_add_test(tests, boxes_that_are_not_rectangular_are_refused);
  tcase_add_test(tests, bad_parts_are_refused);
  tcase_add_test(tests, lack_of_memory_is_reported);
  tcase_add_test(tests, a_shared_mesh_lives_until_its_last_owner);
}
