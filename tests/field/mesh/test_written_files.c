/* Writing meshes: what is written is read as the same mesh, VTK's files have the arrays that they
 * describe, and what a format cannot hold is refused. */
#include <dvi/mesh.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/volume.h"
#include "support/comma.h"
#include "support/field/generated.h"
#include "support/files.h"
#include "support/suite.h"

static double volume_of(const dvi_mesh *mesh)
{
  double sum = 0;
  const int n = dvi_mesh_dimension(mesh);
  for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++) sum += dvi__cell_volume(mesh, n, c);
  return sum;
}

/* ---- what is written is read ---- */

static void check_cells(const dvi_mesh *a, const dvi_mesh *b)
{
  const int n = dvi_mesh_dimension(a);
  ck_assert_int_eq(dvi_mesh_dimension(b), n);
  ck_assert_int_eq(dvi_mesh_kind(b), dvi_mesh_kind(a));
  for (int k = 0; k <= n; k++) {
    int width;
    ck_assert_int_eq(dvi_mesh_count(b, k), dvi_mesh_count(a, k));
    if (k > 0)
      ck_assert_mem_eq(dvi_mesh_vertices(b, k, NULL), dvi_mesh_vertices(a, k, &width),
                       (size_t)(dvi_mesh_count(a, k) * width) * sizeof(int));
  }
  const int8_t *of_a = dvi_mesh_orientation(a), *of_b = dvi_mesh_orientation(b);
  ck_assert_int_eq(of_a == NULL, of_b == NULL);
  if (of_a != NULL) ck_assert_mem_eq(of_a, of_b, (size_t)dvi_mesh_count(a, n));
}

static void check_parts(const dvi_mesh *a, const dvi_mesh *b)
{
  int i = 0;
  for (; dvi_mesh_part_name(a, i) != NULL; i++) {
    const char *name = dvi_mesh_part_name(a, i);
    for (int k = 0; k <= dvi_mesh_part_degree(a, i); k++) {
      int64_t of_a, of_b;
      const int *in_a = dvi_mesh_part_cells(a, name, k, &of_a),
                *in_b = dvi_mesh_part_cells(b, name, k, &of_b);
      ck_assert_msg(of_a == of_b, "part %s has %d cells of degree %d, not %d", name, (int)of_b, k,
                    (int)of_a);
      if (of_a > 0) ck_assert_mem_eq(in_b, in_a, (size_t)of_a * sizeof *in_a);
    }
  }
  int last = 0;
  while (dvi_mesh_part_name(b, last) != NULL) last++;
  ck_assert_int_eq(last, i);
}

/* Numbers come back bit for bit, so that volumes are equal. Coordinates that are zero at all points
 * may be lost. */
static void check_returns(const dvi_mesh *mesh, const char *name, int has_parts)
{
  const char *path = path_in_folder(name);
  dvi_mesh *again;
  ck_assert_msg(dvi_mesh_write(mesh, path, 0, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_mesh_read(path, NULL, &again) == DVI_OK, "%s", dvi_last_error());
  check_cells(mesh, again);
  if (dvi_mesh_space(again) == dvi_mesh_space(mesh))
    ck_assert_mem_eq(dvi_mesh_points(mesh), dvi_mesh_points(again),
                     (size_t)dvi_mesh_count(mesh, 0) * (size_t)dvi_mesh_space(mesh) * 8);
  ck_assert_double_eq(volume_of(again), volume_of(mesh));
  if (has_parts) {
    ck_assert_int_eq(dvi_mesh_space(again), dvi_mesh_space(mesh));
    check_parts(mesh, again);
  }
  dvi_mesh_destroy(&again);
}

/* But for polytopes, which have four coordinates or five. */
START_TEST(every_generated_mesh_returns)
{
  for (int i = 0; dvi_mesh_generator_name(i) != NULL; i++) {
    const char *name = dvi_mesh_generator_name(i);
    dvi_mesh *mesh = generated(name, (dvi_generator_options){.size = 0});
    if (dvi_mesh_space(mesh) <= 3) check_returns(mesh, "mesh.msh", 1);
    if (dvi_mesh_dimension(mesh) == 2 && strcmp(name, "kuhn-torus") != 0) {
      check_returns(mesh, "mesh.off", 0);
      check_returns(mesh, "mesh.ply", 0);
    }
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

static const struct {
  const char *name;
  dvi_generator_options options;
} solids[] = {
    {"interval", {.cells = {4}, .periodic = {1}}},
    {"kuhn", {.cells = {5}, .grading = {1.5}}},
    {"kuhn", {.cells = {2, 3, 2}, .extent = {1, 0.1, 3}}},
    {"kuhn-torus", {.cells = {3, 3, 3}, .extent = {1, 2, 0.3}}},
    {"box", {.cells = {2, 3, 2}, .grading = {1, 2, 3}}},
    {"box", {.cells = {3, 4, 2}, .periodic = {1, 1, 0}}},
};

START_TEST(meshes_of_other_dimensions_return)
{
  dvi_mesh *mesh = generated(solids[_i].name, solids[_i].options);
  check_returns(mesh, "mesh.msh", 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A strip of Moebius of five triangles. */
START_TEST(a_surface_without_orientation_returns)
{
  static const int vertex[] = {0, 1, 2, 1, 2, 3, 2, 3, 4, 0, 3, 4, 0, 1, 4};
  static const double point[] = {0, 0, 0, 1, 0, 0.1, 0, 1, 0.3, 0.2, 0.1, 1, 1, 1, 1.5};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 3,
                                .points = 5,
                                .point = point,
                                .cells = 5,
                                .vertex = vertex};
  dvi_mesh *mesh;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_ptr_null(dvi_mesh_orientation(mesh));
  check_returns(mesh, "mesh.msh", 1);
  check_returns(mesh, "mesh.off", 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Two triangles in a plane of space, and parts that overlap, of all degrees. */
static dvi_mesh *mesh_with_parts(const char *name, const double *metric)
{
  static const double point[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  static const int vertex[] = {0, 1, 3, 0, 3, 2}, both[] = {0, 1}, second[] = {1},
                   edges[] = {0, 1, 1, 3}, edge[] = {1, 3}, corners[] = {0, 3};
  const dvi_mesh_part part[] = {{"whole", 2, 2, NULL, both},   {"upper", 2, 1, NULL, second},
                                {"rim", 1, 2, edges, NULL},    {name, 1, 1, edge, NULL},
                                {"ends", 0, 2, NULL, corners}, {"end", 0, 1, corners, NULL}};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 3,
                                .points = 4,
                                .point = point,
                                .cells = 2,
                                .vertex = vertex,
                                .part = part,
                                .parts = 6,
                                .metric = metric};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

START_TEST(parts_that_overlap_return)
{
  static const double metric[] = {-1, 1, 1};
  dvi_mesh *mesh = mesh_with_parts("right <side> & more", metric);
  check_returns(mesh, "mesh.msh", 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(numbers_are_written_with_a_point)
{
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {3, 3}});
  set_comma_locale();
  const dvi_status status = dvi_mesh_write(mesh, path_in_folder("mesh.msh"), 0, NULL);
  set_point_locale();
  ck_assert_int_eq(status, DVI_OK);
  check_returns(mesh, "mesh.msh", 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- VTU ---- */

enum { ARRAYS = 8 };

/* A file of VTK, taken apart. */
typedef struct vtu {
  bytes file;
  long points, cells;
  int arrays;
  const unsigned char *at[ARRAYS]; /* behind the size */
  uint64_t size[ARRAYS];
} vtu;

static uint64_t integer_at(const unsigned char *at)
{
  uint64_t value = 0;
  for (int i = 7; i >= 0; i--) value = value << 8 | at[i];
  return value;
}

static double real_at(const unsigned char *at)
{
  const uint64_t bits = integer_at(at);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static const char *behind(const char *text, const char *words)
{
  const char *found = strstr(text, words);
  ck_assert_msg(found != NULL, "there is no %s", words);
  return found + strlen(words);
}

/* Each offset leads to a size, from which the next offset follows, and behind the last array the
 * file ends. */
static vtu taken_apart(const char *path)
{
  static const char end[] = "\n  </AppendedData>\n</VTKFile>\n";
  vtu v = {.file = read_bytes(path)};
  const char *text = (const char *)v.file.at, *offset = text;
  const unsigned char *first = (const unsigned char *)behind(text,
                                                             "<AppendedData encoding=\"raw\">\n_");
  uint64_t expected = 0;
  v.points = strtol(behind(text, "NumberOfPoints=\""), NULL, 10);
  v.cells = strtol(behind(text, "NumberOfCells=\""), NULL, 10);
  while (strstr(offset, "offset=\"") != NULL) {
    ck_assert_int_lt(v.arrays, ARRAYS);
    offset = behind(offset, "offset=\"");
    ck_assert_uint_eq(strtoul(offset, NULL, 10), expected);
    v.at[v.arrays] = first + expected + 8;
    v.size[v.arrays] = integer_at(first + expected);
    expected += 8 + v.size[v.arrays++];
  }
  ck_assert_uint_eq((uint64_t)(first - v.file.at) + expected + strlen(end), v.file.count);
  ck_assert_mem_eq(first + expected, end, strlen(end));
  return v;
}

START_TEST(a_grid_of_vtk_has_points_cells_and_views)
{
  dvi_mesh *mesh = mesh_with_parts("side", NULL);
  static const double height[] = {1, 2, 3, NAN}, flux[] = {1, 2, 3, 4};
  static const unsigned triangle[] = {0, 1, 3, 0, 3, 2};
  const dvi_view view[] = {{"flux & <more>", flux, 2, 2}, {"height", height, 1, 0}};
  const char *path = path_in_folder("mesh.vtu");
  ck_assert_msg(dvi_mesh_write(mesh, path, 2, view) == DVI_OK, "%s", dvi_last_error());
  vtu v = taken_apart(path);
  ck_assert(v.points == 4 && v.cells == 2 && v.arrays == 6);
  (void)behind((const char *)v.file.at,
               "Name=\"flux &amp; &lt;more&gt;\" NumberOfComponents=\"2\"");
  ck_assert(v.size[0] == 32 && real_at(v.at[0] + 8) == 2 && isnan(real_at(v.at[0] + 24)));
  ck_assert(v.size[1] == 32 && real_at(v.at[1] + 24) == 4);
  ck_assert_uint_eq(v.size[2], 4 * 24);
  for (int i = 0; i < 12; i++)
    ck_assert_double_eq(real_at(v.at[2] + 8 * i), dvi_mesh_points(mesh)[i]);
  ck_assert_uint_eq(v.size[3], 6 * 8);
  for (int i = 0; i < 6; i++) ck_assert_uint_eq(integer_at(v.at[3] + (size_t)(8 * i)), triangle[i]);
  ck_assert(v.size[4] == 16 && integer_at(v.at[4]) == 3 && integer_at(v.at[4] + 8) == 6);
  ck_assert(v.size[5] == 2 && v.at[5][0] == 5 && v.at[5][1] == 5);
  free(v.file.at);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static const struct {
  const char *name;
  int cells[3], type, corners;
} types[] = {
    {"interval", {3}, 3, 2},    {"kuhn", {2}, 3, 2},   {"kuhn", {2, 2}, 5, 3},
    {"kuhn", {1, 1, 1}, 10, 4}, {"box", {2, 2}, 8, 4}, {"box", {2, 1, 1}, 11, 8},
};

START_TEST(cells_have_the_types_of_vtk)
{
  const int *cells = types[_i].cells;
  dvi_mesh *mesh = generated(types[_i].name,
                             (dvi_generator_options){.cells = {cells[0], cells[1], cells[2]}});
  ck_assert_int_eq(dvi_mesh_write(mesh, path_in_folder("mesh.vtu"), 0, NULL), DVI_OK);
  vtu v = taken_apart(path_in_folder("mesh.vtu"));
  const long count = (long)dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  ck_assert(v.cells == count && v.points == (long)dvi_mesh_count(mesh, 0));
  ck_assert_uint_eq(v.size[1], (uint64_t)(8 * count * types[_i].corners));
  ck_assert_uint_eq(v.size[3], (uint64_t)count);
  for (long c = 0; c < count; c++) {
    ck_assert_int_eq(v.at[3][c], types[_i].type);
    ck_assert_uint_eq(integer_at(v.at[2] + 8 * c), (uint64_t)((c + 1) * types[_i].corners));
  }
  free(v.file.at);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Sum the areas of the triangles that are drawn. */
static double drawn_area(const vtu *v)
{
  double sum = 0;
  for (long c = 0; c < v->cells; c++) {
    double x[3], y[3];
    for (int i = 0; i < 3; i++) {
      const uint64_t at = integer_at(v->at[2] + 8 * (3 * c + i));
      ck_assert_uint_lt(at, (uint64_t)v->points);
      x[i] = real_at(v->at[1] + 24 * at);
      y[i] = real_at(v->at[1] + 24 * at + 8);
    }
    sum += ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) / 2;
  }
  return sum;
}

/* The torus is drawn as a rectangle. Its area is right to some roundings, and all triangles turn to
 * the left, or the sum would be smaller. Copies of points have the values of their vertices. */
START_TEST(a_torus_is_drawn_without_folds)
{
  double value[12];
  dvi_mesh *mesh = generated("kuhn-torus",
                             (dvi_generator_options){.cells = {4, 3}, .extent = {2, 3}});
  for (int i = 0; i < 12; i++) value[i] = dvi_mesh_points(mesh)[2 * i];
  const dvi_view view = {"x", value, 1, 0};
  ck_assert_int_eq(dvi_mesh_write(mesh, path_in_folder("mesh.vtu"), 1, &view), DVI_OK);
  vtu v = taken_apart(path_in_folder("mesh.vtu"));
  ck_assert_int_gt(v.points, 12);
  ck_assert_double_eq_tol(drawn_area(&v), 6, 1e-14);
  for (long i = 0; i < v.points; i++) {
    const double x = real_at(v.at[1] + 24 * i);
    ck_assert_double_eq_tol(real_at(v.at[0] + 8 * i), x - 2 * floor(x / 2), 1e-15);
  }
  free(v.file.at);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- refusals ---- */

static const struct {
  const char *name;
  dvi_generator_options options;
  const char *file;
  dvi_status status;
  const char *words;
} refusals[] = {
    {"kuhn", {.cells = {1, 1, 1, 1}}, "m.msh", DVI_UNSUPPORTED, "MSH cannot hold a mesh of dim"},
    {"kuhn", {.cells = {1, 1, 1, 1}}, "m.vtu", DVI_UNSUPPORTED, "in 4 coordinates, but 3 at most"},
    {"kuhn",
     {.cells = {1, 1, 1}},
     "m.off",
     DVI_UNSUPPORTED,
     "but only surfaces: take .msh or .vtu"},
    {"interval", {.cells = {1}}, "m.ply", DVI_UNSUPPORTED, "PLY cannot hold a mesh of dimension 1"},
    {"kuhn-torus", {.cells = {3, 3}}, "m.off", DVI_UNSUPPORTED, "in a space that repeats itself"},
    {"kuhn", {.cells = {2, 2}}, "m.stl", DVI_BAD_OPTION, "its name must end with .msh, .off, .ply"},
    {"kuhn", {.cells = {2, 2}}, "m", DVI_BAD_OPTION, "cannot tell the format of"},
};

START_TEST(meshes_that_a_format_cannot_hold_are_refused)
{
  dvi_mesh *mesh = generated(refusals[_i].name, refusals[_i].options);
  ck_assert_int_eq(dvi_mesh_write(mesh, path_in_folder(refusals[_i].file), 0, NULL),
                   refusals[_i].status);
  check_words(refusals[_i].words);
  ck_assert_int_eq(count_files_in_folder(), 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static const double one[9];
static const struct {
  dvi_view view[2];
  int views;
  dvi_status status;
  const char *file, *words;
} bad_views[] = {
    {{{"a", one, 1, 0}}, 1, DVI_UNSUPPORTED, "m.msh", "MSH cannot hold views: take .vtu"},
    {{{"a", one, 1, 0}}, -1, DVI_BAD_ARGUMENT, "m.vtu", "-1 views"},
    {{{"", one, 1, 0}}, 1, DVI_BAD_ARGUMENT, "m.vtu", "view 0: a name of printable characters"},
    {{{"a\n", one, 1, 0}}, 1, DVI_BAD_ARGUMENT, "m.vtu", "view 0: a name of printable characters"},
    {{{"a", NULL, 1, 0}}, 1, DVI_BAD_ARGUMENT, "m.vtu", "view \"a\": needs values"},
    {{{"a", one, 0, 0}}, 1, DVI_BAD_ARGUMENT, "m.vtu", "view \"a\": needs values, with 1 compon"},
    {{{"a", one, 1, 1}}, 1, DVI_BAD_ARGUMENT, "m.vtu", "the degree is 1, and must be 0 for vert"},
    {{{"a", one, 1, 0}, {"a", one, 2, 0}}, 2, DVI_BAD_ARGUMENT, "m.vtu", "two views with the name"},
};

START_TEST(bad_views_are_refused)
{
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {2, 2}});
  ck_assert_int_eq(dvi_mesh_write(mesh, path_in_folder(bad_views[_i].file), bad_views[_i].views,
                                  bad_views[_i].view),
                   bad_views[_i].status);
  check_words(bad_views[_i].words);
  ck_assert_int_eq(count_files_in_folder(), 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_name_with_a_quote_does_not_fit_into_msh)
{
  dvi_mesh *mesh = mesh_with_parts("two \"words\"", NULL);
  ck_assert_int_eq(dvi_mesh_write(mesh, path_in_folder("m.msh"), 0, NULL), DVI_UNSUPPORTED);
  check_words("MSH cannot hold the name of part \"two \"words\"\", which has a quote");
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The old file stays as it is, and no other one is left beside it. */
START_TEST(a_failure_leaves_the_old_file)
{
  static const char *const names[] = {"m.msh", "m.off", "m.ply", "m.vtu"};
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {2, 2}});
  const char *path = path_in_folder(names[_i]);
  write_bytes(path, (const unsigned char *)"old", 3);
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_mesh_write(mesh, path, 0, NULL);
    dvi__fail_allocations_after(-1);
    if (status == DVI_OK) break;
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    const bytes file = read_bytes(path);
    ck_assert_mem_eq(file.at, "old", 3);
    ck_assert_uint_eq(file.count, 3);
    free(file.at);
  }
  ck_assert_int_eq(count_files_in_folder(), 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_missing_folder_is_told)
{
  char path[400];
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {2, 2}});
  (void)snprintf(path, sizeof path, "%s/m.off", path_in_folder("none"));
  ck_assert_int_eq(dvi_mesh_write(mesh, path, 0, NULL), DVI_IO_ERROR);
  check_words("cannot write");
  ck_assert_int_eq(dvi_mesh_write(NULL, path, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_mesh_write(mesh, NULL, 0, NULL), DVI_BAD_ARGUMENT);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- series ---- */

START_TEST(a_series_lists_files_at_their_times)
{
  static const double time[] = {0, 0.1};
  static const char *const file[] = {"a-0.vtu", "a&\"b\"-1.vtu"};
  static const char expected[] =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n"
      "    <DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"a-0.vtu\"/>\n"
      "    <DataSet timestep=\"0.1\" group=\"\" part=\"0\" file=\"a&amp;&quot;b&quot;-1.vtu\"/>\n"
      "  </Collection>\n"
      "</VTKFile>\n";
  const char *path = path_in_folder("a.pvd");
  ck_assert_msg(dvi_series_write(path, 2, time, file) == DVI_OK, "%s", dvi_last_error());
  const bytes written = read_bytes(path);
  ck_assert_uint_eq(written.count, strlen(expected));
  ck_assert_mem_eq(written.at, expected, strlen(expected));
  free(written.at);
}
END_TEST

START_TEST(a_bad_series_is_refused)
{
  static const double time[] = {0, INFINITY};
  static const char *const file[] = {"a.vtu", ""};
  ck_assert_int_eq(dvi_series_write(path_in_folder("a.xml"), 1, time, file), DVI_BAD_OPTION);
  check_words("must end with .pvd");
  const char *path = path_in_folder("a.pvd");
  ck_assert_int_eq(dvi_series_write(path, 2, time, file), DVI_BAD_ARGUMENT);
  check_words("series: time 1 is inf, and must be finite");
  ck_assert_int_eq(dvi_series_write(path, 1, time, file + 1), DVI_BAD_ARGUMENT);
  check_words("series: file 0 needs a name");
  ck_assert_int_eq(dvi_series_write(path, 1, NULL, file), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_series_write(path, -1, time, file), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_series_write(NULL, 1, time, file), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(count_files_in_folder(), 0);
}
END_TEST

SUITE(written_files)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, every_generated_mesh_returns);
  tcase_add_loop_test(tests, meshes_of_other_dimensions_return, 0, sizeof solids / sizeof *solids);
  tcase_add_test(tests, a_surface_without_orientation_returns);
  tcase_add_test(tests, parts_that_overlap_return);
  tcase_add_test(tests, numbers_are_written_with_a_point);
  tcase_add_test(tests, a_grid_of_vtk_has_points_cells_and_views);
  tcase_add_loop_test(tests, cells_have_the_types_of_vtk, 0, sizeof types / sizeof *types);
  tcase_add_test(tests, a_torus_is_drawn_without_folds);
  tcase_add_loop_test(tests, meshes_that_a_format_cannot_hold_are_refused, 0,
                      sizeof refusals / sizeof *refusals);
  tcase_add_loop_test(tests, bad_views_are_refused, 0, sizeof bad_views / sizeof *bad_views);
  tcase_add_test(tests, a_name_with_a_quote_does_not_fit_into_msh);
  tcase_add_loop_test(tests, a_failure_leaves_the_old_file, 0, 4);
  tcase_add_test(tests, a_missing_folder_is_told);
  tcase_add_test(tests, a_series_lists_files_at_their_times);
  tcase_add_test(tests, a_bad_series_is_refused);
}
