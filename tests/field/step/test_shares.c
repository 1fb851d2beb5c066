/* Fields on shares of a mesh: every bit of every step is that of the whole mesh, for any number of
 * processes and any division, and so are the bound of the steps, energies, charges and probes. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/field/ranks.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { STEPS = 12, OBSERVED = 16, PROCESSES = 6 };

/* What is measured on the whole mesh, and what differs on shares. */
typedef struct trial {
  dvi_field *(*make)(const dvi_mesh *mesh);
  int64_t cells, faces;
  double step;
  double *form[STEPS]; /* E, then B */
  double seen[STEPS][OBSERVED];
  int64_t wrong[PROCESSES];
  char sentence[PROCESSES][256];
} trial;

/* ---- fields ---- */

static double mean_x(const dvi_mesh *mesh, int width, const int *vertex)
{
  const double *point = dvi_mesh_points(mesh);
  double sum = 0;
  for (int c = 0; c < width; c++) sum += point[(int64_t)vertex[c] * dvi_mesh_space(mesh)];
  return sum / width;
}

/* Give a mesh the parts "core", of its cells with x < 0.4, and "exit", of the boundary with
 * x > 0.7 if there is one. */
static dvi_mesh *with_parts(dvi_mesh *plain, const double *period)
{
  const int n = dvi_mesh_dimension(plain);
  int corners, width = 1;
  int64_t rim, cores = 0, exits = 0;
  const int *vertex = dvi_mesh_vertices(plain, n, &corners),
            *facet = dvi_mesh_part_cells(plain, "boundary", n - 1, &rim),
            *of_facet = dvi_mesh_vertices(plain, n - 1, &width);
  const int64_t cells = dvi_mesh_count(plain, n);
  if (n == 1) width = 1;
  int *core = malloc((size_t)cells * sizeof *core),
      *leaving = malloc((size_t)(rim * width + 1) * sizeof *leaving);
  for (int64_t c = 0; c < cells; c++)
    if (mean_x(plain, corners, vertex + c * corners) < 0.4) core[cores++] = (int)c;
  for (int64_t i = 0; i < rim; i++) {
    const int *at = n > 1 ? of_facet + (int64_t)facet[i] * width : facet + i;
    if (mean_x(plain, width, at) <= 0.7) continue;
    memcpy(leaving + exits++ * width, at, (size_t)width * sizeof *at);
  }
  const dvi_mesh_part part[] = {
      {.name = "core", .degree = n, .count = cores, .cell = core},
      {.name = "exit", .degree = n - 1, .count = exits, .vertex = leaving}};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = dvi_mesh_kind(plain),
                                .dimension = n,
                                .points = dvi_mesh_count(plain, 0),
                                .point = dvi_mesh_points(plain),
                                .cells = cells,
                                .vertex = vertex,
                                .period = period,
                                .part = part,
                                .parts = exits > 0 ? 2 : 1};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&plain);
  free(core);
  free(leaving);
  return mesh;
}

/* A factor of each cell, from its centre. */
static double *materials(const dvi_mesh *mesh, double size)
{
  const int n = dvi_mesh_dimension(mesh), space = dvi_mesh_space(mesh);
  const int64_t cells = dvi_mesh_count(mesh, n);
  double *factor = malloc((size_t)cells * sizeof *factor),
         *centre = malloc((size_t)(cells * space) * sizeof *centre);
  (void)dvi_mesh_centres(mesh, n, centre);
  for (int64_t c = 0; c < cells; c++)
    factor[c] = 1 + size * centre[c * space] * (1 + centre[c * space + space - 1]);
  free(centre);
  return factor;
}

static dvi_star *star_with(const dvi_mesh *mesh, int degree)
{
  double *eps = materials(mesh, 0.7);
  const double *factor[DVI_MESH_DIMENSION_MAX + 1] = {NULL};
  factor[degree] = eps;
  const dvi_star_options options = {.size = sizeof options, .factor = factor};
  dvi_star *star = NULL;
  (void)dvi_star_create(mesh, &options, &star);
  free(eps);
  return star;
}

static int ring(double t, double *value, void *user)
{
  (void)user;
  *value = sin(9 * t) * exp(-t);
  return 0;
}

/* `user` is the number of components. */
static int spread(const double *x, double *value, void *user)
{
  for (int i = 0; i < *(const int *)user; i++)
    value[i] = exp(-20 * (x[0] - 0.6) * (x[0] - 0.6)) / (1 + i);
  return 0;
}

/* A field with materials, losses in the core, an absorbing exit, two currents and four probes. */
static dvi_field *lossy(const dvi_mesh *mesh)
{
  const int n = dvi_mesh_dimension(mesh), degree = n == 1 ? 0 : 1;
  int components = n == 1 ? 1 : n;
  int64_t count, exits;
  (void)dvi_mesh_part_cells(mesh, "exit", 0, &exits);
  const int *core = dvi_mesh_part_cells(mesh, "core", n, &count);
  double *sigma = calloc((size_t)dvi_mesh_count(mesh, n), sizeof *sigma);
  for (int64_t i = 0; i < count; i++) sigma[core[i]] = 0.3;
  const dvi_wall wall[] = {{.part = "exit", .kind = DVI_ABSORBING}};
  const dvi_current current[] = {
      {.at = {0.53, 0.41, 0.37}, .along = {1, 0.5, -0.2}, .signal = ring},
      {.density = spread, .density_user = &components, .signal = ring}};
  const dvi_field_probe probe[] = {
      {.name = "e", .of = "E", .at = {0.61, 0.3, 0.55}, .along = {0.3, 1, 0.7}},
      {.name = "b", .of = "B", .at = {0.3, 0.62, 0.2}, .along = {1, -1, 0.4}},
      {.name = "power", .of = "flux", .part = "core"},
      {.name = "stored", .of = "energy", .part = "core"}};
  dvi_star *star = star_with(mesh, degree);
  const dvi_maxwell_terms terms = {.size = sizeof terms,
                                   .star = star,
                                   .wall = wall,
                                   .walls = exits >= 0,
                                   .conductivity = sigma,
                                   .current = current,
                                   .currents = 2,
                                   .probe = probe,
                                   .probes = 4};
  dvi_field *field = NULL;
  (void)dvi_maxwell_create(&terms, &field);
  dvi_star_destroy(&star);
  free(sigma);
  return field;
}

/* Electric walls all around. */
static dvi_field *cavity(const dvi_mesh *mesh)
{
  const dvi_wall wall = {.part = "boundary", .kind = DVI_PEC};
  const dvi_star_options options = {.size = sizeof options};
  dvi_star *star = NULL;
  (void)dvi_star_create(mesh, &options, &star);
  const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star, .wall = &wall, .walls = 1};
  dvi_field *field = NULL;
  (void)dvi_maxwell_create(&terms, &field);
  dvi_star_destroy(&star);
  return field;
}

static int height(const double *x, const double *normal, double *datum, void *user)
{
  (void)user;
  *datum = normal != NULL ? normal[0] * x[0] : 0.1 * x[0];
  return 0;
}

/* A wave with a source, fixed values in the core, and a flux through the exit. */
static dvi_field *wave(const dvi_mesh *mesh)
{
  const dvi_condition condition[] = {{.part = "core", .kind = DVI_FIXED, .datum = height},
                                     {.part = "exit", .kind = DVI_FREE, .datum = height}};
  dvi_star *star = star_with(mesh, 1);
  int one = 1;
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = condition,
                                .conditions = 2,
                                .source = spread,
                                .source_user = &one};
  dvi_field *field = NULL;
  (void)dvi_wave_create(&terms, &field);
  dvi_star_destroy(&star);
  return field;
}

/* ---- trials ---- */

/* A number that depends on the cell's number in the whole mesh. */
static double start_of(int64_t number)
{
  unsigned long long state = (unsigned long long)number + 17;
  (void)random_number(&state);
  return random_number(&state) - 0.5;
}

static dvi_march *begin(const dvi_mesh *mesh, const dvi_field *field)
{
  const dvi_march_options options = {.size = sizeof options};
  const int degree = dvi_field_degree(field);
  const int64_t cells = dvi_mesh_count(mesh, degree),
                *number = dvi_mesh_share_numbers(mesh, degree);
  dvi_march *march = NULL;
  if (dvi_march_create(field, &options, &march) != DVI_OK) return NULL;
  double *E = malloc((size_t)cells * sizeof *E);
  for (int64_t c = 0; c < cells; c++) E[c] = start_of(number != NULL ? number[c] : c);
  const dvi_march_state state = {.size = sizeof state, .E = E, .A = E};
  const dvi_status status = dvi_march_start(march, &state);
  free(E);
  if (status != DVI_OK) dvi_march_destroy(&march);
  return march;
}

static double step_of(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return facts.step;
}

static void observe(const dvi_march *march, double *seen)
{
  for (int i = 0; dvi_march_observable(march, i) != NULL; i++)
    (void)dvi_march_observe(march, i, seen + i);
}

static void run_whole(const dvi_mesh *mesh, trial *t)
{
  dvi_field *field = t->make(mesh);
  ck_assert_msg(field != NULL, "%s", dvi_last_error());
  dvi_march *march = begin(mesh, field);
  ck_assert_msg(march != NULL, "%s", dvi_last_error());
  t->step = step_of(march);
  t->cells = dvi_march_size(march, DVI_FORM_E);
  t->faces = dvi_march_size(march, DVI_FORM_B);
  for (int s = 0; s < STEPS; s++) {
    ck_assert(dvi_march_advance(march, (s + 0.8) * t->step) == DVI_OK);
    t->form[s] = malloc((size_t)(t->cells + t->faces) * sizeof(double));
    ck_assert(dvi_march_sample(march, DVI_FORM_E, 0, NULL, t->form[s]) == DVI_OK);
    ck_assert(dvi_march_sample(march, DVI_FORM_B, 0, NULL, t->form[s] + t->cells) == DVI_OK);
    observe(march, t->seen[s]);
  }
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

/* Count the values of a form that are not those of the whole mesh. */
static int64_t compare(const dvi_mesh *share, int rank, int degree, const double *here,
                       const double *whole)
{
  const int64_t *number = dvi_mesh_share_numbers(share, degree);
  const int *owner = dvi_mesh_share_owners(share, degree);
  int64_t wrong = 0;
  for (int64_t i = 0; i < dvi_mesh_count(share, degree); i++)
    wrong += owner[i] == rank && memcmp(here + i, whole + number[i], sizeof *here) != 0;
  return wrong;
}

static void run_share(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  dvi_field *field = t->make(share);
  dvi_march *march = field != NULL ? begin(share, field) : NULL;
  if (march == NULL) {
    t->wrong[rank] = -1;
    (void)strncpy(t->sentence[rank], dvi_last_error(), 255);
    dvi_field_destroy(&field);
    return;
  }
  const int degree = dvi_field_degree(field);
  double *form = malloc((size_t)dvi_march_size(march, DVI_FORM_E) * sizeof *form),
         *B = malloc((size_t)dvi_march_size(march, DVI_FORM_B) * sizeof *B), seen[OBSERVED] = {0};
  t->wrong[rank] += step_of(march) != t->step;
  for (int s = 0; s < STEPS; s++) {
    t->wrong[rank] += dvi_march_advance(march, (s + 0.8) * t->step) != DVI_OK;
    (void)dvi_march_sample(march, DVI_FORM_E, 0, NULL, form);
    (void)dvi_march_sample(march, DVI_FORM_B, 0, NULL, B);
    t->wrong[rank] += compare(share, rank, degree, form, t->form[s]);
    t->wrong[rank] += compare(share, rank, degree + 1, B, t->form[s] + t->cells);
    observe(march, seen);
    for (int i = 0; i < OBSERVED; i++) t->wrong[rank] += seen[i] != t->seen[s][i];
  }
  free(form);
  free(B);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

/* Divide the cells at random, or in the order of their numbers. */
static void divide(int64_t cells, int count, int at_random, int *owner)
{
  unsigned long long state = 77 + (unsigned)count;
  for (int64_t c = 0; c < cells; c++)
    owner[c] = at_random ? (int)(count * random_number(&state)) : (int)(c * count / cells);
  for (int r = 0; r < count; r++) owner[r] = r;
}

static void check_shares(dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh))
{
  trial t = {.make = make};
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  int *owner = malloc((size_t)cells * sizeof *owner);
  run_whole(mesh, &t);
  for (int count = 1; count <= PROCESSES - 1; count++)
    for (int at_random = 0; at_random < 2; at_random++) {
      memset(t.wrong, 0, sizeof t.wrong);
      divide(cells, count, at_random, owner);
      run_ranks(mesh, count, owner, run_share, &t);
      for (int r = 0; r < count; r++)
        ck_assert_msg(t.wrong[r] == 0, "process %d of %d, division %d: %lld: %s", r, count,
                      at_random, (long long)t.wrong[r], t.sentence[r]);
    }
  for (int s = 0; s < STEPS; s++) free(t.form[s]);
  free(owner);
  dvi_mesh_destroy(&mesh);
}

START_TEST(tetrahedra_have_the_bits_of_the_whole_mesh)
{
  const dvi_generator_options bcc = {.cells = {3, 3, 3}, .extent = {1, 1, 1}};
  const double period[] = {1, 1, 1};
  check_shares(with_parts(generated("bcc-torus", bcc), period), lossy);
}
END_TEST

START_TEST(triangles_have_the_bits_of_the_whole_mesh)
{
  check_shares(with_parts(staggered_mesh(9, 10), NULL), lossy);
  check_shares(equilateral_torus(6, 8), cavity);
}
END_TEST

START_TEST(intervals_have_the_bits_of_the_whole_mesh)
{
  const dvi_generator_options options = {.cells = {40}, .grading = {1.3}};
  check_shares(with_parts(generated("interval", options), NULL), lossy);
}
END_TEST

START_TEST(boxes_have_the_bits_of_the_whole_mesh)
{
  const dvi_generator_options options = {.cells = {5, 4, 3}, .grading = {1.2, 1, 1.4}};
  check_shares(generated("box", options), cavity);
  check_shares(with_parts(generated("box", options), NULL), lossy);
}
END_TEST

START_TEST(waves_have_the_bits_of_the_whole_mesh)
{
  check_shares(with_parts(staggered_mesh(8, 9), NULL), wave);
  check_shares(with_parts(grid_mesh("box", 3, 4, 1.2), NULL), wave);
}
END_TEST

SUITE(shares)
{
  tcase_add_test(tests, tetrahedra_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, triangles_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, intervals_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, boxes_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, waves_have_the_bits_of_the_whole_mesh);
}
