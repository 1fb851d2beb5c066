/* Boundaries of regular polytopes as meshes: counts, edges of one length, spheres. */
#include <dvi/mesh.h>
#include <math.h>

#include "support/suite.h"

/* Coxeter 1973, table I. */
static const struct {
  const char *name;
  int dimension;
  int64_t count[5];
} polytope[] = {{"simplex-4", 3, {5, 10, 10, 5}},
                {"simplex-5", 4, {6, 15, 20, 15, 6}},
                {"cell-16", 3, {8, 24, 32, 16}},
                {"cell-600", 3, {120, 720, 1200, 600}},
                {"cross-5", 4, {10, 40, 80, 80, 32}}};

static dvi_mesh *generated(const char *name, double length)
{
  const dvi_generator_options options = {.size = sizeof options, .extent = {length}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate(name, &options, &mesh), DVI_OK);
  return mesh;
}

START_TEST(polytopes_have_their_cells)
{
  dvi_mesh *mesh = generated(polytope[_i].name, 0);
  ck_assert_int_eq(dvi_mesh_dimension(mesh), polytope[_i].dimension);
  ck_assert_int_eq(dvi_mesh_space(mesh), polytope[_i].dimension + 1);
  for (int k = 0; k <= polytope[_i].dimension; k++)
    ck_assert_int_eq(dvi_mesh_count(mesh, k), polytope[_i].count[k]);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(polytopes_are_spheres)
{
  dvi_mesh *mesh = generated(polytope[_i].name, 0);
  int64_t betti[5], boundary;
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  for (int k = 0; k <= polytope[_i].dimension; k++)
    ck_assert_int_eq(betti[k], k == 0 || k == polytope[_i].dimension);
  (void)dvi_mesh_part_cells(mesh, "boundary", polytope[_i].dimension - 1, &boundary);
  ck_assert_int_eq(boundary, 0);
  ck_assert_ptr_nonnull(dvi_mesh_orientation(mesh));
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(edges_of_polytopes_have_one_length)
{
  for (int given = 0; given < 2; given++) {
    const double length = given ? 2.5 : 0;
    dvi_mesh *mesh = generated(polytope[_i].name, length);
    const int space = dvi_mesh_space(mesh), *vertex = dvi_mesh_vertices(mesh, 1, &(int){0});
    const double *point = dvi_mesh_points(mesh), expected = length > 0 ? length : 1;
    for (int64_t e = 0; e < dvi_mesh_count(mesh, 1); e++) {
      double square = 0;
      for (int i = 0; i < space; i++)
        square += pow(point[vertex[2 * e] * space + i] - point[vertex[2 * e + 1] * space + i], 2);
      ck_assert_double_eq_tol(sqrt(square) / expected, 1, 4e-16);
    }
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(polytopes_take_no_cells)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {2}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate(polytope[_i].name, &options, &mesh), DVI_BAD_OPTION);
  check_words("a further number of cells cannot be 2");
}
END_TEST

SUITE(polytopes)
{
  const int count = sizeof polytope / sizeof *polytope;
  tcase_add_loop_test(tests, polytopes_have_their_cells, 0, count);
  tcase_add_loop_test(tests, polytopes_are_spheres, 0, count);
  tcase_add_loop_test(tests, edges_of_polytopes_have_one_length, 0, count);
  tcase_add_loop_test(tests, polytopes_take_no_cells, 0, count);
}
