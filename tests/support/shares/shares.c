#include "support/shares/shares.h"

#include <dvi/maxwell.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

/* ---- fields ---- */

static double mean_x(const dvi_mesh *mesh, int width, const int *vertex)
{
  const double *point = dvi_mesh_points(mesh);
  double sum = 0;
  for (int c = 0; c < width; c++) sum += point[(int64_t)vertex[c] * dvi_mesh_space(mesh)];
  return sum / width;
}

dvi_mesh *with_core_and_exit(dvi_mesh *plain, const double *period)
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

dvi_field *lossy_field(const dvi_mesh *mesh)
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

dvi_field *cavity_field(const dvi_mesh *mesh)
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

dvi_field *driven_wave(const dvi_mesh *mesh)
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

/* ---- runs ---- */

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

void run_whole(const dvi_mesh *mesh, whole_run *t)
{
  dvi_field *field = t->make(mesh);
  ck_assert_msg(field != NULL, "%s", dvi_last_error());
  dvi_march *march = begin(mesh, field);
  ck_assert_msg(march != NULL, "%s", dvi_last_error());
  t->step = step_of(march);
  t->cells = dvi_march_size(march, DVI_FORM_E);
  t->faces = dvi_march_size(march, DVI_FORM_B);
  for (int s = 0; s < SHARED_STEPS; s++) {
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

int64_t run_share(const dvi_mesh *share, int rank, const whole_run *t)
{
  dvi_field *field = t->make(share);
  dvi_march *march = field != NULL ? begin(share, field) : NULL;
  if (march == NULL) {
    dvi_field_destroy(&field);
    return -1;
  }
  const int degree = dvi_field_degree(field);
  double *form = malloc((size_t)dvi_march_size(march, DVI_FORM_E) * sizeof *form),
         *B = malloc((size_t)dvi_march_size(march, DVI_FORM_B) * sizeof *B),
         seen[SHARED_OBSERVED] = {0};
  int64_t wrong = step_of(march) != t->step;
  for (int s = 0; s < SHARED_STEPS; s++) {
    wrong += dvi_march_advance(march, (s + 0.8) * t->step) != DVI_OK;
    (void)dvi_march_sample(march, DVI_FORM_E, 0, NULL, form);
    (void)dvi_march_sample(march, DVI_FORM_B, 0, NULL, B);
    wrong += compare(share, rank, degree, form, t->form[s]);
    wrong += compare(share, rank, degree + 1, B, t->form[s] + t->cells);
    observe(march, seen);
    for (int i = 0; i < SHARED_OBSERVED; i++) wrong += seen[i] != t->seen[s][i];
  }
  free(form);
  free(B);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  return wrong;
}

void whole_run_clear(whole_run *t)
{
  for (int s = 0; s < SHARED_STEPS; s++) free(t->form[s]);
}
