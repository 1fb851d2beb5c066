/* Generated meshes: counts, Betti numbers, volumes, parts, and options that are refused. */
#include <dvi/mesh.h>
#include <math.h>
#include <string.h>

#include "field/mesh/volume.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_mesh *generated(const char *name, const int *cells, int count)
{
  dvi_generator_options options = {.size = sizeof options};
  dvi_mesh *mesh = NULL;
  for (int i = 0; i < count; i++) options.cells[i] = cells[i];
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static double volume_of(const dvi_mesh *mesh)
{
  double sum = 0;
  const int n = dvi_mesh_dimension(mesh);
  for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++) sum += dvi__cell_volume(mesh, n, c);
  return sum;
}

/* The counts and Betti numbers up to the mesh's dimension. */
static const struct {
  const char *name;
  int cells[4];
  int64_t count[5], betti[5];
  double volume;
} meshes[] = {
    {"interval", {5}, {6, 5}, {1, 0}, 1},
    {"box", {2, 3}, {12, 17, 6}, {1, 0, 0}, 1},
    {"box", {2, 2, 2}, {27, 54, 36, 8}, {1, 0, 0, 0}, 1},
    {"box", {1, 1, 1, 1}, {16, 32, 24, 8, 1}, {1, 0, 0, 0, 0}, 1},
    {"kuhn", {4}, {5, 4}, {1, 0}, 1},
    {"kuhn", {2, 2}, {9, 16, 8}, {1, 0, 0}, 1},
    {"kuhn", {2, 2, 2}, {27, 98, 120, 48}, {1, 0, 0, 0}, 1},
    {"kuhn", {1, 1, 1, 1}, {16, 65, 110, 84, 24}, {1, 0, 0, 0, 0}, 1},
    {"kuhn-torus", {3}, {3, 3}, {1, 1}, 1},
    {"kuhn-torus", {3, 3}, {9, 27, 18}, {1, 2, 1}, 1},
    {"kuhn-torus", {3, 3, 3}, {27, 189, 324, 162}, {1, 3, 3, 1}, 1},
    {"kuhn-torus", {3, 3, 3, 3}, {81, 1215, 4050, 4860, 1944}, {1, 4, 6, 4, 1}, 1},
    {"staggered", {8, 8}, {85, 220, 136}, {1, 0, 0}, 1},
    {"icosphere", {1}, {42, 120, 80}, {1, 0, 1}, 0},
};

START_TEST(meshes_have_their_counts)
{
  int n = 0;
  int64_t betti[5];
  dvi_mesh *mesh = generated(meshes[_i].name, meshes[_i].cells, 4);
  for (; n < 5 && meshes[_i].count[n] > 0; n++)
    ck_assert_int_eq(dvi_mesh_count(mesh, n), meshes[_i].count[n]);
  ck_assert_int_eq(dvi_mesh_dimension(mesh), n - 1);
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  for (int k = 0; k < n; k++)
    ck_assert_msg(betti[k] == meshes[_i].betti[k], "b_%d is %d", k, (int)betti[k]);
  ck_assert_ptr_nonnull(dvi_mesh_orientation(mesh));
  if (meshes[_i].volume > 0) ck_assert_double_eq_tol(volume_of(mesh), meshes[_i].volume, 1e-13);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_periodic_box_is_a_torus)
{
  int64_t betti[4];
  dvi_mesh *mesh;
  const dvi_generator_options options = {
      .size = sizeof options, .cells = {4, 3, 5}, .extent = {1, 2, 3}, .periodic = {1, 1, 1}};
  ck_assert_int_eq(dvi_mesh_generate("box", &options, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  ck_assert(betti[0] == 1 && betti[1] == 3 && betti[2] == 3 && betti[3] == 1);
  ck_assert_double_eq_tol(volume_of(mesh), 6, 1e-13);
  ck_assert_ptr_null(dvi_mesh_part_name(mesh, 2));
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A boundary of one surface, and the six sides that make it. */
START_TEST(a_box_has_its_sides)
{
  static const char *const names[] = {"left", "right", "bottom", "top", "back", "front"};
  const int cells[] = {2, 3, 4};
  for (int kuhn = 0; kuhn < 2; kuhn++) {
    dvi_mesh *mesh = generated(kuhn ? "kuhn" : "box", cells, 3);
    int64_t all, count, sum = 0;
    for (int i = 0; i < 6; i++) {
      const int *facet = dvi_mesh_part_cells(mesh, names[i], 2, &count);
      ck_assert_int_eq(count, (kuhn ? 2 : 1) * 24 / cells[i / 2]);
      for (int64_t f = 0; f < count; f++) {
        int width;
        const int *corner = dvi_mesh_vertices(mesh, 2, &width) + 0;
        for (int c = 0; c < width; c++)
          ck_assert_double_eq_tol(
              dvi_mesh_points(mesh)[3 * corner[(int64_t)facet[f] * width + c] + i / 2], i % 2,
              1e-15);
      }
      sum += count;
    }
    (void)dvi_mesh_part_cells(mesh, "boundary", 2, &all);
    ck_assert_int_eq(sum, all);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(grids_are_graded)
{
  dvi_mesh *mesh;
  const dvi_generator_options options = {
      .size = sizeof options, .cells = {4}, .extent = {2}, .origin = {1}, .grading = {2}};
  ck_assert_int_eq(dvi_mesh_generate("interval", &options, &mesh), DVI_OK);
  for (int i = 0; i <= 4; i++)
    ck_assert_double_eq_tol(dvi_mesh_points(mesh)[i], 1 + 2 * i * i / 16.0, 1e-15);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(the_sphere_has_its_area)
{
  double last = 0;
  for (int level = 2; level <= 5; level++) {
    dvi_mesh *mesh = generated("icosphere", &level, 1);
    const double error = 4 * pi - volume_of(mesh);
    ck_assert_double_gt(error, 0);
    if (last > 0) ck_assert_double_eq_tol(log2(last / error), 2, 0.05);
    last = error;
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- bad options ---- */

static const struct {
  const char *name;
  dvi_generator_options options;
  const char *words;
} refusals[] = {
    {"cube", {.cells = {1}}, "no generator \"cube\"; there are interval, box, kuhn"},
    {"interval", {.cells = {2, 2}}, "a further number of cells"},
    {"box", {.cells = {-1, 2}}, "number 0 of cells is -1, and may be 1 to"},
    {"box", {.cells = {2, 0, 2}}, "a further number of cells"},
    {"box", {.cells = {2, 2}, .periodic = {1}}, "number 0 of cells is 2, and may be 3 to"},
    {"kuhn", {.cells = {2000, 2000, 2000}}, "too many"},
    {"kuhn", {.cells = {2147483647, 2147483647}}, "number 0 of cells is 2147483647"},
    {"kuhn", {.cells = {2, 2}, .extent = {-1}}, "a size cannot be -1"},
    {"kuhn", {.cells = {2, 2}, .extent = {NAN}}, "a size cannot be nan"},
    {"kuhn", {.cells = {2, 2}, .extent = {1, 1, 1}}, "a size cannot be 1"},
    {"kuhn", {.cells = {2, 2}, .grading = {-2}}, "a grading cannot be -2"},
    {"kuhn", {.cells = {2, 2}, .origin = {INFINITY}}, "an origin cannot be inf"},
    {"staggered", {.cells = {2, 2}, .grading = {2}}, "a grading cannot be 2"},
    {"staggered", {.cells = {2, 2, 2}}, "a further number of cells"},
    {"staggered", {.cells = {3, 3}, .periodic = {1}}, "periodic cannot be 1"},
    {"icosphere", {.cells = {20}}, "is 20, and may be 1 to 12"},
    {"icosphere", {.dimension = 2}, "dimension cannot be 2"},
};

START_TEST(bad_options_are_refused)
{
  dvi_generator_options options = refusals[_i].options;
  dvi_mesh *mesh = NULL;
  options.size = sizeof options;
  ck_assert_int_eq(dvi_mesh_generate(refusals[_i].name, &options, &mesh), DVI_BAD_OPTION);
  ck_assert_ptr_null(mesh);
  check_words(refusals[_i].words);
}
END_TEST

START_TEST(generators_are_listed)
{
  int i = 0;
  for (; dvi_mesh_generator_name(i) != NULL; i++) {
    dvi_mesh *mesh;
    ck_assert_msg(dvi_mesh_generate(dvi_mesh_generator_name(i), NULL, &mesh) == DVI_OK, "%s",
                  dvi_last_error());
    dvi_mesh_destroy(&mesh);
  }
  ck_assert_int_ge(i, 6);
  ck_assert_ptr_null(dvi_mesh_generator_name(-1));
}
END_TEST

SUITE(generators)
{
  tcase_add_loop_test(tests, meshes_have_their_counts, 0, sizeof meshes / sizeof *meshes);
  tcase_add_test(tests, a_periodic_box_is_a_torus);
  tcase_add_test(tests, a_box_has_its_sides);
  tcase_add_test(tests, grids_are_graded);
  tcase_add_test(tests, the_sphere_has_its_area);
  tcase_add_loop_test(tests, bad_options_are_refused, 0, sizeof refusals / sizeof *refusals);
  tcase_add_test(tests, generators_are_listed);
}
