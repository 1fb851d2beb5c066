/* Generated meshes that are no grids: disks, spheres, tori and so on. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field/mesh/volume.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_mesh *generated(const char *name, int first, int second)
{
  dvi_generator_options options = {.size = sizeof options, .cells = {first, second}};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static double volume_of(const dvi_mesh *mesh, int k, const char *part)
{
  double sum = 0;
  int64_t count;
  const int *cell = dvi_mesh_part_cells(mesh, part, k, &count);
  for (int64_t i = 0; i < count; i++) sum += dvi__cell_volume(mesh, k, cell[i]);
  return sum;
}

/* ---- topology ---- */

static const struct {
  const char *name;
  int cells[2];
  int64_t vertices, tops, betti[4];
} shapes[] = {
    {"disk", {1}, 7, 6, {1, 0, 0}},
    {"disk", {5}, 91, 150, {1, 0, 0}},
    {"annulus", {1, 4}, 8, 8, {1, 1, 0}},
    {"annulus", {3, 10}, 40, 60, {1, 1, 0}},
    {"icosphere", {2}, 162, 320, {1, 0, 1}},
    {"torus", {3, 4}, 12, 24, {1, 2, 1}},
    {"torus", {8, 6}, 48, 96, {1, 2, 1}},
    {"genus-2", {1}, 48, 100, {1, 4, 1}},
    {"genus-2", {3}, 448, 900, {1, 4, 1}},
    {"cylinder", {1, 1}, 14, 18, {1, 0, 0, 0}},
    {"cylinder", {3, 2}, 111, 324, {1, 0, 0, 0}},
    {"ball", {1}, 13, 20, {1, 0, 0, 0}},
    {"ball", {4}, 309, 1280, {1, 0, 0, 0}},
};

START_TEST(shapes_have_their_topology)
{
  int64_t betti[5];
  dvi_mesh *mesh = generated(shapes[_i].name, shapes[_i].cells[0], shapes[_i].cells[1]);
  const int n = dvi_mesh_dimension(mesh);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), shapes[_i].vertices);
  ck_assert_int_eq(dvi_mesh_count(mesh, n), shapes[_i].tops);
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  for (int k = 0; k <= n; k++) ck_assert_int_eq(betti[k], shapes[_i].betti[k]);
  ck_assert_ptr_nonnull(dvi_mesh_orientation(mesh));
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Each facet of the boundary belongs to one of the named parts. */
START_TEST(sides_make_up_the_boundary)
{
  dvi_mesh *mesh = generated(shapes[_i].name, shapes[_i].cells[0], shapes[_i].cells[1]);
  const int n = dvi_mesh_dimension(mesh);
  char *parts = calloc((size_t)dvi_mesh_count(mesh, n - 1), 1);
  int64_t count;
  for (int i = 2; dvi_mesh_part_name(mesh, i) != NULL; i++) {
    ck_assert_int_eq(dvi_mesh_part_degree(mesh, i), n - 1);
    const int *facet = dvi_mesh_part_cells(mesh, dvi_mesh_part_name(mesh, i), n - 1, &count);
    ck_assert(count > 0);
    for (int64_t k = 0; k < count; k++) parts[facet[k]]++;
  }
  const int *rim = dvi_mesh_part_cells(mesh, "boundary", n - 1, &count);
  for (int64_t k = 0; k < count; k++) ck_assert_int_eq(parts[rim[k]]--, 1);
  for (int64_t f = 0; f < dvi_mesh_count(mesh, n - 1); f++) ck_assert_int_eq(parts[f], 0);
  free(parts);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Each row of d_{k+1} d_k is zero, in integers. */
START_TEST(boundaries_have_no_boundary)
{
  dvi_mesh *mesh = generated(shapes[_i].name, shapes[_i].cells[0], shapes[_i].cells[1]);
  for (int k = 0; k + 1 < dvi_mesh_dimension(mesh); k++) {
    dvi_matrix d, after;
    ck_assert_int_eq(dvi_mesh_incidence(mesh, k, &d), DVI_OK);
    ck_assert_int_eq(dvi_mesh_incidence(mesh, k + 1, &after), DVI_OK);
    double *x = calloc((size_t)(d.columns + d.rows + after.rows), sizeof *x), *y = x + d.columns,
           *z = y + d.rows;
    for (int64_t i = 0; i < d.columns; i++) x[i] = (double)(i * i % 1009);
    dvi_matrix_multiply(&d, 0, x, y);
    dvi_matrix_multiply(&after, 0, y, z);
    for (int64_t i = 0; i < after.rows; i++) ck_assert(z[i] == 0);
    free(x);
  }
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- sizes ---- */

static const struct {
  const char *name, *part;
  int k, cells[2];
  double size;
} sizes[] = {
    {"disk", "all", 2, {4}, 3.14159265358979323846},
    {"disk", "rim", 1, {4}, 2 * 3.14159265358979323846},
    {"annulus", "all", 2, {2, 16}, 0.75 * 3.14159265358979323846},
    {"annulus", "inner", 1, {2, 16}, 3.14159265358979323846},
    {"icosphere", "all", 2, {1}, 4 * 3.14159265358979323846},
    {"torus", "all", 2, {16, 8}, 2 * 9.86960440108935861883},
    {"cylinder", "all", 3, {2, 2}, 2 * 3.14159265358979323846},
    {"cylinder", "side", 2, {2, 2}, 4 * 3.14159265358979323846},
    {"cylinder", "top", 2, {2, 2}, 3.14159265358979323846},
    {"ball", "all", 3, {3}, 4 * 3.14159265358979323846 / 3},
    {"ball", "surface", 2, {3}, 4 * 3.14159265358979323846},
};

START_TEST(sizes_converge_with_second_order)
{
  double last = 0;
  for (int level = 0; level < 4; level++) {
    const int is_sphere = strcmp(sizes[_i].name, "icosphere") == 0;
    const int first = is_sphere ? sizes[_i].cells[0] + level : sizes[_i].cells[0] << level;
    if (level == 3 && sizes[_i].k == 3) break;
    dvi_mesh *mesh = generated(sizes[_i].name, first, sizes[_i].cells[1] << level);
    const double error = fabs(volume_of(mesh, sizes[_i].k, sizes[_i].part) - sizes[_i].size);
    if (level > 0)
      ck_assert_msg(log2(last / error) > 1.8 && log2(last / error) < 2.2, "%s: order %g",
                    sizes[_i].name, log2(last / error));
    last = error;
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(surface_of_genus_two_has_its_area)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {2}, .extent = {0.5}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("genus-2", &options, &mesh), DVI_OK);
  ck_assert_double_eq_tol(volume_of(mesh, 2, "all"), 50 * 0.25, 1e-12);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- the theorem of Gauss and Bonnet ---- */

static double angle_at(const dvi_mesh *mesh, const int *v, int at)
{
  const int space = dvi_mesh_space(mesh);
  const double *x = dvi_mesh_points(mesh);
  double a[3] = {0}, b[3] = {0};
  for (int l = 0; l < space; l++) {
    a[l] = x[v[(at + 1) % 3] * space + l] - x[v[at] * space + l];
    b[l] = x[v[(at + 2) % 3] * space + l] - x[v[at] * space + l];
  }
  const double c[] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
  return atan2(sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]),
               a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* The sum over inner vertices of 2 pi less the angles around them, and over those of the boundary
 * of pi less these, is 2 pi times Euler's number. Summed vertex by vertex the numbers are small. */
static double total_curvature(const dvi_mesh *mesh)
{
  int64_t rim;
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  const int *vertex = dvi_mesh_vertices(mesh, 2, NULL),
            *on_rim = dvi_mesh_part_cells(mesh, "boundary", 0, &rim);
  double *deficit = calloc((size_t)vertices, sizeof *deficit), total = 0;
  for (int64_t v = 0; v < vertices; v++) deficit[v] = 2 * pi;
  for (int64_t i = 0; i < rim; i++) deficit[on_rim[i]] = pi;
  for (int64_t c = 0; c < dvi_mesh_count(mesh, 2); c++)
    for (int i = 0; i < 3; i++) deficit[vertex[3 * c + i]] -= angle_at(mesh, vertex + 3 * c, i);
  for (int64_t v = 0; v < vertices; v++) total += deficit[v];
  free(deficit);
  return total;
}

static const struct {
  const char *name;
  int cells[2], euler;
} surfaces[] = {{"icosphere", {2}, 2},  {"torus", {12, 8}, 0},  {"genus-2", {1}, -2},
                {"disk", {3}, 1},       {"annulus", {2, 9}, 0}, {"icosphere", {4}, 2},
                {"torus", {40, 20}, 0}, {"genus-2", {2}, -2}};

START_TEST(curvature_sums_to_eulers_number)
{
  dvi_mesh *mesh = generated(surfaces[_i].name, surfaces[_i].cells[0], surfaces[_i].cells[1]);
  ck_assert_double_eq_tol(total_curvature(mesh), 2 * pi * surfaces[_i].euler, 1e-12);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- the body-centred torus ---- */

START_TEST(body_centred_torus_has_its_star)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {3}};
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_matrix edges, faces;
  int64_t betti[4], light = 0;
  ck_assert_int_eq(dvi_mesh_generate("bcc-torus", &options, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 54);
  ck_assert_int_eq(dvi_mesh_count(mesh, 3), 12 * 27);
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  ck_assert(betti[0] == 1 && betti[1] == 3 && betti[2] == 3 && betti[3] == 1);
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 1, &edges), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 2, &faces), DVI_OK);
  for (int64_t e = 0; e < edges.rows; e++) {
    const int is_light = edges.value[e] < 1.0 / 12;
    ck_assert_double_eq_tol(edges.value[e], (is_light ? 1 : 3) / 24.0, 1e-14);
    light += is_light;
  }
  ck_assert_int_eq(light, 6 * 27); /* between equal points of neighbouring cubes */
  for (int64_t f = 0; f < faces.rows; f++) ck_assert_double_eq_tol(faces.value[f], 3, 1e-13);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- a surface with one side ---- */

/* A tube whose end meets its start with a reflection, in four dimensions. */
START_TEST(kleins_bottle_has_one_side)
{
  enum { AROUND = 6, ALONG = 5 };
  double point[4 * AROUND * ALONG];
  int vertex[6 * AROUND * ALONG], *v = vertex;
  for (int j = 0; j < ALONG; j++)
    for (int i = 0; i < AROUND; i++) {
      const double tube = 2 * pi * i / AROUND, angle = 2 * pi * j / ALONG;
      const double x[] = {(2 + cos(tube)) * cos(angle), (2 + cos(tube)) * sin(angle),
                          sin(tube) * cos(0.5 * angle), sin(tube) * sin(0.5 * angle)};
      memcpy(point + 4 * (j * AROUND + i), x, sizeof x);
      const int next = (i + 1) % AROUND, turned = j + 1 == ALONG;
      const int a = j * AROUND + i, b = j * AROUND + next,
                c = turned ? (AROUND - i) % AROUND : a + AROUND,
                d = turned ? (AROUND - next) % AROUND : b + AROUND;
      const int two[] = {a, b, c, b, c, d};
      for (int k = 0; k < 6; k++) *v++ = two[k];
    }
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 4,
                                .points = AROUND * ALONG,
                                .point = point,
                                .cells = 2 * AROUND * ALONG,
                                .vertex = vertex};
  dvi_mesh *mesh = NULL;
  int64_t betti[3], rim;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  (void)dvi_mesh_part_cells(mesh, "boundary", 1, &rim);
  ck_assert_int_eq(rim, 0);
  ck_assert_ptr_null(dvi_mesh_orientation(mesh));
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  ck_assert(betti[0] == 1 && betti[1] == 1 && betti[2] == 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(options_of_shapes_are_checked)
{
  static const struct {
    const char *name;
    dvi_generator_options options;
    const char *words;
  } refused[] = {{"torus", {.cells = {6, 5}}, "5 cells around the tube are odd"},
                 {"torus", {.extent = {1, 1.5}}, "radius"},
                 {"annulus", {.extent = {1, 1}}, "not below"},
                 {"annulus", {.cells = {2, 2}}, "number 1 of cells is 2"},
                 {"annulus", {.cells = {16, 6}}, "fold: take more cells around"},
                 {"disk", {.origin = {0, 0, 1}}, "origin"},
                 {"disk", {.periodic = {0, 1}}, "periodic"},
                 {"box", {.cells = {2, 2}, .periodic = {0, 0, 1}}, "further periodic"},
                 {"disk", {.cells = {2, 2}}, "further number of cells"},
                 {"ball", {.dimension = 3}, "dimension"},
                 {"bcc-torus", {.cells = {2, 3, 3}}, "may be 3"},
                 {"cylinder", {.extent = {1, -1}}, "size"},
                 {"ball", {.cells = {2000}}, "too many"}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    dvi_mesh *mesh = NULL;
    dvi_generator_options options = refused[i].options;
    options.size = sizeof options;
    ck_assert_int_eq(dvi_mesh_generate(refused[i].name, &options, &mesh), DVI_BAD_OPTION);
    check_words(refused[i].words);
  }
}
END_TEST

#define COUNT(table) (int)(sizeof(table) / sizeof *(table))

SUITE(curved)
{
  tcase_add_loop_test(tests, shapes_have_their_topology, 0, COUNT(shapes));
  tcase_add_loop_test(tests, sides_make_up_the_boundary, 0, COUNT(shapes));
  tcase_add_loop_test(tests, boundaries_have_no_boundary, 0, COUNT(shapes));
  tcase_add_loop_test(tests, sizes_converge_with_second_order, 0, COUNT(sizes));
  tcase_add_test(tests, surface_of_genus_two_has_its_area);
  tcase_add_loop_test(tests, curvature_sums_to_eulers_number, 0, COUNT(surfaces));
  tcase_add_test(tests, body_centred_torus_has_its_star);
  tcase_add_test(tests, kleins_bottle_has_one_side);
  tcase_add_test(tests, options_of_shapes_are_checked);
}
