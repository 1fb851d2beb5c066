/* The mesh on which functions of a space are shown. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/space/space.h"
#include "support/suite.h"

/* Make a space of some axes of these kinds from 0 to 1, 2 and 3, all periodic or none, and the mesh
 * for it. */
static dvi_mesh *mesh_of(int axes, const char *const *kind, int periodic, dvi_space **space)
{
  dvi_axis axis[DVI_AXES_MAX];
  dvi_mesh *mesh = NULL;
  for (int d = 0; d < axes; d++)
    axis[d] = (dvi_axis){.to = d + 1, .periodic = periodic, .kind = kind[d]};
  const dvi_space_options options = {.size = sizeof options, .axis = axis, .axes = axes};
  ck_assert_msg(dvi_space_create(&options, space) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_space_mesh(*space, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static int64_t count_vertices(const char *kind, int periodic)
{
  dvi_space *space;
  dvi_mesh *mesh = mesh_of(1, &kind, periodic, &space);
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  ck_assert_int_eq(dvi_mesh_count(mesh, 1), vertices - 1);
  ck_assert_double_eq(dvi_mesh_points(mesh)[0], 0);
  ck_assert_double_eq(dvi_mesh_points(mesh)[vertices - 1], 1);
  dvi_mesh_destroy(&mesh);
  dvi_space_destroy(&space);
  return vertices;
}

START_TEST(cells_have_as_many_parts_as_degrees)
{
  ck_assert_int_eq(count_vertices("fem:degree=3,cells=5", 0), 16);
  ck_assert_int_eq(count_vertices("fem:degree=3,cells=5", 1), 16);
  ck_assert_int_eq(count_vertices("spline:degree=2,cells=5", 0), 11);
  ck_assert_int_eq(count_vertices("legendre:degree=9", 0), 10);
  ck_assert_int_eq(count_vertices("chebyshev:degree=9", 0), 10);
}
END_TEST

/* The ends of the circle are two vertices. */
START_TEST(a_circle_has_as_many_parts_as_functions)
{
  ck_assert_int_eq(count_vertices("fourier:modes=7", 1), 16);
}
END_TEST

START_TEST(long_axes_have_no_more_vertices_than_can_be_seen)
{
  ck_assert_int_eq(count_vertices("fem:degree=1,cells=4096", 0), 4097);
  ck_assert_int_eq(count_vertices("fem:degree=1,cells=100001", 0), 4002);
  ck_assert_int_eq(count_vertices("fourier:modes=4096", 1), 2732);
}
END_TEST

START_TEST(ends_of_cells_are_vertices)
{
  const double node[] = {-1, 0, 4};
  const dvi_axis axis = {.from = -1, .to = 4, .kind = "fem:degree=2", .node = node, .nodes = 3};
  const double place[] = {-1, -0.5, 0, 2, 4};
  dvi_space *space;
  dvi_mesh *mesh;
  ck_assert_int_eq(
      dvi_space_create(
          &(dvi_space_options){.size = sizeof(dvi_space_options), .axis = &axis, .axes = 1},
          &space),
      DVI_OK);
  ck_assert_int_eq(dvi_space_mesh(space, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 5);
  for (int i = 0; i < 5; i++) ck_assert_double_eq(dvi_mesh_points(mesh)[i], place[i]);
  dvi_mesh_destroy(&mesh);
  dvi_space_destroy(&space);
}
END_TEST

/* All cells of a mesh that fills R^n are oriented as R^n is, and their measures add up. */
START_TEST(boxes_fill_their_domain)
{
  static const char *const kind[] = {"fem:degree=2,cells=2", "fem:degree=1,cells=3",
                                     "spline:degree=1,cells=2"};
  for (int axes = 1; axes <= 3; axes++) {
    dvi_space *space;
    dvi_mesh *mesh = mesh_of(axes, kind, 0, &space);
    int width;
    const int *vertex = dvi_mesh_vertices(mesh, axes, &width);
    const int64_t cells = dvi_mesh_count(mesh, axes);
    const double *point = dvi_mesh_points(mesh);
    double sum = 0, whole = 1;
    ck_assert_int_eq(width, 1 << axes);
    for (int64_t c = 0; c < cells; c++) {
      double measure = 1;
      for (int d = 0; d < axes; d++)
        measure *= point[vertex[c * width + (1 << d)] * axes + d] -
                   point[vertex[c * width] * axes + d];
      ck_assert(measure > 0);
      sum += measure;
    }
    for (int d = 0; d < axes; d++) whole *= d + 1;
    ck_assert_double_eq_tol(sum, whole, 1e-14);
    dvi_mesh_destroy(&mesh);
    dvi_space_destroy(&space);
  }
}
END_TEST

START_TEST(the_first_axis_of_the_vertices_runs_slowest)
{
  static const char *const kind[] = {"fem:degree=1,cells=2", "fem:degree=1,cells=4"};
  dvi_space *space;
  dvi_mesh *mesh = mesh_of(2, kind, 0, &space);
  const double *point = dvi_mesh_points(mesh);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 15);
  ck_assert_double_eq(point[2 * 6], 0.5);
  ck_assert_double_eq(point[2 * 6 + 1], 0.5);
  dvi_mesh_destroy(&mesh);
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(the_mesh_of_a_space_is_shared)
{
  dvi_mesh *own, *mesh;
  dvi_space *space;
  ck_assert_int_eq(dvi_mesh_generate("disk", NULL, &own), DVI_OK);
  const dvi_space_options options = {.size = sizeof options, .kind = "fem:degree=2", .mesh = own};
  ck_assert_int_eq(dvi_space_create(&options, &space), DVI_OK);
  ck_assert_int_eq(dvi_space_mesh(space, &mesh), DVI_OK);
  ck_assert_ptr_eq(mesh, own);
  dvi_mesh_destroy(&mesh);
  dvi_space_destroy(&space);
  dvi_mesh_destroy(&own);
}
END_TEST

START_TEST(missing_arguments_are_named)
{
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_space_mesh(NULL, &mesh), DVI_BAD_ARGUMENT);
  ck_assert_str_eq(dvi_last_error(), "space: the space is missing");
  ck_assert_int_eq(dvi_space_mesh(NULL, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(a_mesh_without_memory_leaks_nothing)
{
  static const char *const kind[] = {"fem:degree=2,cells=3"};
  dvi_status status = DVI_NO_MEMORY;
  dvi_space *space;
  dvi_mesh *mesh = mesh_of(1, kind, 0, &space);
  for (long allowed = 0; status != DVI_OK; allowed++) {
    dvi_mesh_destroy(&mesh);
    dvi__fail_allocations_after(allowed);
    status = dvi_space_mesh(space, &mesh);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "%s", dvi_last_error());
    ck_assert((mesh != NULL) == (status == DVI_OK));
  }
  dvi_mesh_destroy(&mesh);
  dvi_space_destroy(&space);
}
END_TEST

SUITE(space_output)
{
  tcase_add_test(tests, cells_have_as_many_parts_as_degrees);
  tcase_add_test(tests, a_circle_has_as_many_parts_as_functions);
  tcase_add_test(tests, long_axes_have_no_more_vertices_than_can_be_seen);
  tcase_add_test(tests, ends_of_cells_are_vertices);
  tcase_add_test(tests, boxes_fill_their_domain);
  tcase_add_test(tests, the_first_axis_of_the_vertices_runs_slowest);
  tcase_add_test(tests, the_mesh_of_a_space_is_shared);
  tcase_add_test(tests, missing_arguments_are_named);
  tcase_add_test(tests, a_mesh_without_memory_leaks_nothing);
}
