/* Fields at random on meshes at random, divided at random: marches of shares have every byte of the
 * state of the whole mesh, at every step and after they have loaded a state of another division.
 * What one process refuses, or cannot do, ends all of them. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/generated.h"
#include "support/field/ranks.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { STEPS = 5, OBSERVED = 12, PROCESSES = 12, MOST = 4, PARTS = 3 };

static const char *const part_name[] = {"core", "rim", "points", "boundary", "all"};

/* What a march shows. */
typedef struct shown {
  dvi_status made, begun, recorded, advanced[STEPS], observed[STEPS][OBSERVED];
  double step, value[STEPS][OBSERVED];
  size_t size;
  unsigned char *bytes[STEPS + 1];
} shown;

/* What goes wrong on one process, and whether all others notice. */
typedef enum failure { NONE, SIGNAL, MEMORY } failure;

typedef struct trial {
  unsigned long long seed;
  const dvi_mesh *whole;
  double period[DVI_MESH_SPACE_MAX];
  int count;
  int *owner;
  failure failure;
  int failing;    /* process */
  long successes; /* of allocations before */
  shown of_whole;
  dvi_status end[PROCESSES];
  char wrong[PROCESSES][256];
} trial;

static int below(unsigned long long *state, int most)
{
  return (int)(most * random_number(state));
}

/* A number that belongs to a cell of the whole mesh. */
static double of_cell(int64_t number, int salt)
{
  unsigned long long state = (unsigned long long)(number * 37 + salt + 11);
  (void)random_number(&state);
  return random_number(&state);
}

static int64_t whole_number(const dvi_mesh *mesh, int k, int64_t cell)
{
  const int64_t *number = dvi_mesh_share_numbers(mesh, k);
  return number != NULL ? number[cell] : cell;
}

/* ---- meshes ---- */

/* A strip of triangles in space, whose ends are glued together with a twist. */
static dvi_mesh *moebius(int length)
{
  double *point = malloc((size_t)length * 6 * sizeof *point);
  int *vertex = malloc((size_t)length * 6 * sizeof *vertex);
  for (int i = 0; i < length; i++) {
    const double s = 6.283185307179586 * i / length;
    const int next = i + 1 < length ? 2 * i + 2 : 1, other = i + 1 < length ? 2 * i + 3 : 0;
    const int cell[] = {2 * i, 2 * i + 1, next, 2 * i + 1, next, other};
    memcpy(vertex + (ptrdiff_t)6 * i, cell, sizeof cell);
    for (int side = 0; side < 2; side++) {
      const double w = side == 0 ? -0.4 : 0.4, r = 1 + w * cos(s / 2);
      const double x[] = {r * cos(s), r * sin(s), w * sin(s / 2)};
      memcpy(point + (ptrdiff_t)3 * (2 * i + side), x, sizeof x);
    }
  }
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 3,
                                .points = 2 * (int64_t)length,
                                .point = point,
                                .cells = 2 * (int64_t)length,
                                .vertex = vertex};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  free(point);
  free(vertex);
  return mesh;
}

static dvi_mesh *grid(trial *t, unsigned long long *state, const char *name, int most, int torus)
{
  dvi_generator_options options = {.dimension = 1 + below(state, most)};
  const int cells = options.dimension == 4 ? 2 : options.dimension == 3 ? 3 : 7;
  for (int a = 0; a < options.dimension; a++) {
    options.periodic[a] = torus < 0 && below(state, 3) == 0;
    const int least = torus > 0 || options.periodic[a] ? 3 : 1;
    options.cells[a] = least + below(state, cells);
    options.extent[a] = 1;
    options.grading[a] = below(state, 2) == 0 ? 1 : 1.25;
    if (torus > 0 || options.periodic[a]) t->period[a] = 1;
  }
  return generated(name, options);
}

static dvi_mesh *draw_plain(trial *t, unsigned long long *state)
{
  switch (below(state, 12)) {
  case 0: return grid(t, state, "box", 4, -1);
  case 1: return grid(t, state, "kuhn", 4, -1);
  case 2: return grid(t, state, "kuhn-torus", 3, 1);
  case 3:
    t->period[0] = t->period[1] = t->period[2] = 1;
    return generated("bcc-torus", (dvi_generator_options){.cells = {3, 3, 3}, .extent = {1, 1, 1}});
  case 4: return staggered_mesh(3 + below(state, 6), 2 + below(state, 7));
  case 5: return generated("disk", (dvi_generator_options){.cells = {2 + below(state, 4)}});
  case 6: return generated("annulus", (dvi_generator_options){.cells = {1 + below(state, 3), 14}});
  case 7: return generated("icosphere", (dvi_generator_options){.cells = {1 + below(state, 2)}});
  case 8: return generated("torus", (dvi_generator_options){.cells = {9, 6}});
  case 9: return moebius(7 + below(state, 9));
  case 10: return generated("cell-16", (dvi_generator_options){.size = 0});
  default: return jittered_mesh(2 + below(state, 2), 3, 2 + below(state, 2), 0.1, *state);
  }
}

/* Give the mesh parts of cells, of facets of the boundary and inside, and of points. */
static dvi_mesh *draw_mesh(trial *t, unsigned long long *state)
{
  dvi_mesh *plain = draw_plain(t, state), *mesh = NULL;
  const int n = dvi_mesh_dimension(plain);
  int corners, width = 1;
  const int *vertex = dvi_mesh_vertices(plain, n, &corners),
            *of_facet = dvi_mesh_vertices(plain, n - 1, &width);
  const int64_t cells = dvi_mesh_count(plain, n), facets = dvi_mesh_count(plain, n - 1),
                points = dvi_mesh_count(plain, 0);
  if (n == 1) width = 1;
  int64_t count[PARTS] = {0}, rims;
  int *list[PARTS] = {malloc((size_t)cells * sizeof(int)),
                      malloc((size_t)(facets * width) * sizeof(int)),
                      malloc((size_t)points * sizeof(int))};
  const int *rim = dvi_mesh_part_cells(plain, "boundary", n - 1, &rims);
  const double rate = random_number(state);
  for (int64_t c = 0; c < cells; c++)
    if (c == 0 || random_number(state) < rate) list[0][count[0]++] = (int)c;
  for (int64_t f = 0; f < (rims > 0 ? rims : facets); f++) {
    const int64_t at = rims > 0 ? rim[f] : f;
    if (f > 0 && random_number(state) >= rate) continue;
    for (int c = 0; c < width; c++)
      list[1][count[1] * width + c] = n > 1 ? of_facet[at * width + c] : (int)at;
    count[1]++;
  }
  for (int64_t v = 0; v < points; v++)
    if (v == 0 || random_number(state) < 0.2 * rate) list[2][count[2]++] = (int)v;
  const dvi_mesh_part part[PARTS] = {
      {.name = part_name[0], .degree = n, .count = count[0], .cell = list[0]},
      {.name = part_name[1], .degree = n - 1, .count = count[1], .vertex = list[1]},
      {.name = part_name[2], .count = count[2], .cell = list[2]}};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = dvi_mesh_kind(plain),
                                .dimension = n,
                                .space = dvi_mesh_space(plain),
                                .points = points,
                                .point = dvi_mesh_points(plain),
                                .cells = cells,
                                .vertex = vertex,
                                .period = t->period,
                                .part = part,
                                .parts = PARTS};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&plain);
  for (int i = 0; i < PARTS; i++) free(list[i]);
  return mesh;
}

/* ---- fields ---- */

/* A signal, which may fail on one process. */
typedef struct tone {
  int fails;
} tone;

static int ring(double t, double *value, void *user)
{
  *value = sin(9 * t + 1) * exp(-t);
  return ((const tone *)user)->fails && t > 0.05;
}

static int spread(const double *x, double *value, void *user)
{
  for (int i = 0; i < *(const int *)user; i++)
    value[i] = exp(-3 * (x[0] - 0.6) * (x[0] - 0.6)) / (1 + i);
  return 0;
}

static int height(const double *x, const double *normal, double *datum, void *user)
{
  (void)user;
  *datum = normal != NULL ? normal[0] * x[0] : 0.1 * x[0];
  return 0;
}

/* A factor of each cell, which is rarely negative in one of them. */
static double *draw_factor(const dvi_mesh *mesh, int salt, int64_t negative)
{
  const int n = dvi_mesh_dimension(mesh);
  double *factor = malloc((size_t)dvi_mesh_count(mesh, n) * sizeof *factor);
  for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++) {
    const int64_t number = whole_number(mesh, n, c);
    factor[c] = number == negative ? -9 : 0.5 + of_cell(number, salt);
  }
  return factor;
}

static dvi_status draw_star(const dvi_mesh *mesh, const trial *t, unsigned long long *state,
                            dvi_star **star)
{
  const int n = dvi_mesh_dimension(mesh);
  double *owned[DVI_MESH_DIMENSION_MAX + 1] = {NULL};
  const double *factor[DVI_MESH_DIMENSION_MAX + 1] = {NULL};
  for (int k = 0; k <= n; k++) {
    const int is_wanted = below(state, 2), is_negative = below(state, 40) == 0,
              cell = below(state, (int)dvi_mesh_count(t->whole, n));
    if (is_wanted) factor[k] = owned[k] = draw_factor(mesh, k, is_negative ? cell : -1);
  }
  const dvi_star_options options = {.size = sizeof options,
                                    .kind = below(state, 20) == 0 ? DVI_BARYCENTRIC
                                                                  : DVI_CIRCUMCENTRIC,
                                    .factor = factor};
  const dvi_status status = dvi_star_create(mesh, &options, star);
  for (int k = 0; k <= n; k++) free(owned[k]);
  return status;
}

/* Draw a place: anywhere, at a vertex, or in the middle of a cell of any degree. */
static void draw_place(const trial *t, unsigned long long *state, double *at)
{
  const int n = dvi_mesh_dimension(t->whole), space = dvi_mesh_space(t->whole),
            k = below(state, n + 1);
  const int64_t cell = below(state, (int)dvi_mesh_count(t->whole, k));
  double *centre = malloc((size_t)(dvi_mesh_count(t->whole, k) * space) * sizeof *centre);
  (void)dvi_mesh_centres(t->whole, k, centre);
  for (int l = 0; l < n && l < space; l++) at[l] = centre[cell * space + l];
  if (below(state, 3) == 0)
    for (int l = 0; l < n; l++) at[l] += 0.03 * (random_number(state) - 0.5);
  free(centre);
}

static const char *draw_part(unsigned long long *state)
{
  return part_name[below(state, 5)];
}

static dvi_status draw_maxwell(const dvi_star *star, const trial *t, unsigned long long *state,
                               tone *of_process, dvi_field **field)
{
  const dvi_mesh *mesh = dvi_star_mesh(star);
  const int n = dvi_mesh_dimension(mesh), fills = n == dvi_mesh_space(mesh);
  int components = n == 1 ? 1 : dvi_mesh_space(mesh);
  dvi_wall wall[MOST] = {{0}};
  dvi_current current[MOST] = {{0}};
  dvi_field_probe probe[MOST] = {{0}};
  static const char *const name[MOST] = {"a", "b", "c", "d"}, *const of[] = {"E", "B", "flux",
                                                                             "energy"};
  dvi_maxwell_terms terms = {.size = sizeof terms, .star = star, .scalar = below(state, 3) == 0};
  if (terms.scalar) components = 1;
  terms.walls = below(state, 3);
  terms.currents = below(state, 3);
  terms.probes = below(state, MOST + 1);
  for (int i = 0; i < terms.walls; i++)
    wall[i] = (dvi_wall){.part = part_name[below(state, 4)],
                         .kind = (dvi_wall_kind)below(state, DVI_ABSORBING + 1)};
  for (int i = 0; i < terms.currents; i++) {
    current[i] = (dvi_current){.along = {1, 0.5, -0.2}, .signal = ring, .user = of_process};
    if (!fills || below(state, 2) == 0) {
      current[i].density = spread;
      current[i].density_user = &components;
    }
    draw_place(t, state, current[i].at);
  }
  for (int i = 0; i < terms.probes; i++) {
    probe[i] = (dvi_field_probe){.name = name[i],
                                 .of = of[fills ? below(state, 4) : 2 + below(state, 2)],
                                 .along = {0.3, 1, 0.7},
                                 .part = part_name[below(state, 2)]};
    draw_place(t, state, probe[i].at);
  }
  double *sigma = below(state, 2) == 0 ? draw_factor(mesh, 77, -1) : NULL;
  for (int64_t c = 0; sigma != NULL && c < dvi_mesh_count(mesh, n); c++)
    if (of_cell(whole_number(mesh, n, c), 78) < 0.7) sigma[c] = 0;
  terms.wall = wall;
  terms.current = current;
  terms.probe = probe;
  terms.conductivity = sigma;
  const dvi_status status = dvi_maxwell_create(&terms, field);
  free(sigma);
  return status;
}

static dvi_status draw_wave(const dvi_star *star, unsigned long long *state, dvi_field **field)
{
  dvi_condition condition[MOST] = {{0}};
  int one = 1;
  const int conditions = below(state, MOST);
  for (int i = 0; i < conditions; i++) {
    const int is_fixed = below(state, 2);
    condition[i] = (dvi_condition){.part = is_fixed ? draw_part(state) : part_name[1],
                                   .kind = is_fixed ? DVI_FIXED : DVI_FREE,
                                   .datum = below(state, 3) == 0 ? NULL : height};
    if (is_fixed && below(state, 3) > 0) condition[i].part = part_name[2];
  }
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = condition,
                                .conditions = conditions,
                                .source = below(state, 2) == 0 ? spread : NULL,
                                .source_user = &one};
  return dvi_wave_create(&terms, field);
}

/* The field of a trial is the same on all processes. */
static dvi_status draw_field(const dvi_mesh *mesh, const trial *t, tone *of_process,
                             dvi_field **field)
{
  unsigned long long state = t->seed + 5;
  dvi_star *star = NULL;
  dvi_status status = draw_star(mesh, t, &state, &star);
  if (status == DVI_OK)
    status = dvi_mesh_dimension(mesh) > 3 || below(&state, 3) == 0
                 ? draw_wave(star, &state, field)
                 : draw_maxwell(star, t, &state, of_process, field);
  dvi_star_destroy(&star);
  return status;
}

/* ---- marches ---- */

static double *draw_form(const dvi_mesh *mesh, int rank, int k, int salt)
{
  const int64_t cells = dvi_mesh_count(mesh, k);
  const int *owner = dvi_mesh_share_owners(mesh, k);
  double *form = malloc((size_t)cells * sizeof *form);
  for (int64_t c = 0; c < cells; c++) /* what is given for cells of others does not matter */
    form[c] = owner == NULL || owner[c] == rank ? of_cell(whole_number(mesh, k, c), salt) - 0.5
                                                : 1e3;
  return form;
}

static dvi_status begin(const dvi_field *field, const trial *t, int rank, dvi_march **march)
{
  const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
  const dvi_march_options options = {.size = sizeof options, .potential = t->seed % 3 == 0};
  const int k = dvi_field_degree(field);
  const dvi_status made = dvi_march_create(field, &options, march);
  if (made != DVI_OK) return made;
  double *E = draw_form(mesh, rank, k, 1), *A = draw_form(mesh, rank, k, 2),
         *B = draw_form(mesh, rank, k + 1, 3);
  const dvi_march_state state = {.size = sizeof state,
                                 .E = E,
                                 .A = t->seed % 4 > 0 ? A : NULL,
                                 .B = t->seed % 4 < 2 ? B : NULL};
  const dvi_status status = dvi_march_start(*march, &state);
  free(E);
  free(A);
  free(B);
  return status;
}

static double step_of(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return facts.step;
}

static unsigned char *state_of(const dvi_march *march, size_t *size)
{
  *size = 0;
  if (dvi_march_save_memory(march, NULL, 0, size) != DVI_OK) return NULL;
  unsigned char *bytes = malloc(*size);
  const size_t capacity = *size;
  if (dvi_march_save_memory(march, bytes, capacity, size) == DVI_OK) return bytes;
  free(bytes);
  return NULL;
}

static void show_step(const dvi_march *march, int s, shown *to)
{
  for (int i = 0; dvi_march_observable(march, i) != NULL && i < OBSERVED; i++)
    to->observed[s][i] = dvi_march_observe(march, i, &to->value[s][i]);
  to->bytes[s] = state_of(march, &to->size);
}

static dvi_status record(dvi_march *march, double step)
{
  dvi_recording *recording = NULL;
  const dvi_march_record_options options = {.size = sizeof options,
                                            .t_end = (STEPS + 2) * step,
                                            .every = step,
                                            .parts = DVI_RECORD_T | DVI_RECORD_E |
                                                     DVI_RECORD_OBSERVABLES};
  const dvi_status status = dvi_march_record(march, &options, &recording);
  dvi_recording_destroy(&recording);
  return status;
}

/* Run the march, or what can be run. `failing` is not 0 on the process that fails. */
static void run(const dvi_mesh *mesh, const trial *t, int rank, int failing, shown *to)
{
  tone of_process = {.fails = failing && t->failure == SIGNAL};
  dvi_field *field = NULL;
  dvi_march *march = NULL;
  *to = (shown){.made = draw_field(mesh, t, &of_process, &field)};
  if (to->made == DVI_OK) to->begun = begin(field, t, rank, &march);
  if (to->made == DVI_OK && to->begun == DVI_OK) {
    to->step = step_of(march);
    for (int s = 0; s < STEPS; s++) {
      to->advanced[s] = dvi_march_advance(march, (s + 0.8) * to->step);
      show_step(march, s, to);
    }
    to->recorded = record(march, to->step);
  }
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

static void forget(shown *of)
{
  for (int s = 0; s <= STEPS; s++) free(of->bytes[s]);
}

/* ---- comparisons ---- */

#define DIFFERS(...) ((void)snprintf(wrong, 256, __VA_ARGS__))

/* Stars that are not diagonal need a whole mesh. */
static int is_refused(const shown *here)
{
  return here->made == DVI_UNSUPPORTED || here->begun == DVI_UNSUPPORTED;
}

static void compare(const shown *here, const shown *whole, char *wrong)
{
  if (is_refused(here)) return;
  if ((here->made == DVI_OK) != (whole->made == DVI_OK))
    DIFFERS("the field: %d, not %d: %.150s", here->made, whole->made, dvi_last_error());
  else if ((here->begun == DVI_OK) != (whole->begun == DVI_OK))
    DIFFERS("the march: %d, not %d: %.150s", here->begun, whole->begun, dvi_last_error());
  if (*wrong != '\0' || whole->made != DVI_OK || whole->begun != DVI_OK) return;
  if (here->step != whole->step) DIFFERS("the step %.17g, not %.17g", here->step, whole->step);
  if (here->recorded != whole->recorded) DIFFERS("a recording: %d", here->recorded);
  for (int s = 0; s < STEPS && *wrong == '\0'; s++) {
    if (here->advanced[s] != whole->advanced[s]) DIFFERS("step %d: %d", s, here->advanced[s]);
    for (int i = 0; i < OBSERVED; i++)
      if (here->observed[s][i] != whole->observed[s][i] ||
          memcmp(&here->value[s][i], &whole->value[s][i], sizeof(double)) != 0)
        DIFFERS("observable %d after step %d: %.17g, not %.17g", i, s, here->value[s][i],
                whole->value[s][i]);
    if (here->bytes[s] == NULL || whole->bytes[s] == NULL || here->size != whole->size)
      DIFFERS("state %d of %zu bytes, not %zu", s, here->size, whole->size);
    else if (memcmp(here->bytes[s], whole->bytes[s], here->size) != 0)
      DIFFERS("the bytes of state %d", s);
  }
}

/* Load a state of the whole mesh, and go on. */
static void go_on(const dvi_mesh *mesh, const trial *t, int rank, char *wrong)
{
  tone of_process = {0};
  dvi_field *field = NULL;
  dvi_march *march = NULL;
  size_t size = 0;
  const dvi_march_options options = {.size = sizeof options, .potential = t->seed % 3 == 0};
  (void)rank;
  if (draw_field(mesh, t, &of_process, &field) != DVI_OK ||
      dvi_march_create(field, &options, &march) != DVI_OK ||
      dvi_march_load_memory(march, t->of_whole.bytes[1], t->of_whole.size) != DVI_OK ||
      dvi_march_advance(march, (STEPS - 1 + 0.8) * t->of_whole.step) != DVI_OK) {
    DIFFERS("loading: %.200s", dvi_last_error());
  } else {
    unsigned char *bytes = state_of(march, &size);
    if (bytes == NULL || memcmp(bytes, t->of_whole.bytes[STEPS - 1], size) != 0)
      DIFFERS("the bytes after loading");
    free(bytes);
  }
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

static int runs(const shown *whole)
{
  return whole->made == DVI_OK && whole->begun == DVI_OK;
}

static void run_share(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  shown here;
  run(share, t, rank, 0, &here);
  compare(&here, &t->of_whole, t->wrong[rank]);
  forget(&here);
  if (runs(&here) && t->wrong[rank][0] == '\0') go_on(share, t, rank, t->wrong[rank]);
}

/* Fail on one process, and keep the status of what fails first. */
static void run_failing(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  shown here;
  if (rank == t->failing && t->failure == MEMORY) dvi__fail_allocations_after(t->successes);
  run(share, t, rank, rank == t->failing, &here);
  dvi__fail_allocations_after(-1);
  t->end[rank] = here.made != DVI_OK ? here.made : here.begun;
  for (int s = 0; s < STEPS && t->end[rank] == DVI_OK; s++) t->end[rank] = here.advanced[s];
  if (t->end[rank] == DVI_OK) t->end[rank] = here.recorded;
  forget(&here);
}

static void draw_owners(trial *t, unsigned long long *state)
{
  const int64_t cells = dvi_mesh_count(t->whole, dvi_mesh_dimension(t->whole));
  const int style = below(state, 3);
  t->count = 1 + below(state, cells < PROCESSES ? (int)cells : PROCESSES);
  t->owner = malloc((size_t)cells * sizeof *t->owner);
  for (int64_t c = 0; c < cells; c++)
    t->owner[c] = style == 0   ? below(state, t->count)
                  : style == 1 ? (int)(c * t->count / cells)
                               : 0; /* all but one process have a single cell */
  for (int r = 0; r < t->count; r++) t->owner[style == 2 ? cells - 1 - r : r] = r;
}

static void check_trial(unsigned long long seed)
{
  unsigned long long state = seed * 7919 + 3;
  trial t = {.seed = seed};
  dvi_mesh *mesh = draw_mesh(&t, &state);
  t.whole = mesh;
  draw_owners(&t, &state);
  run(mesh, &t, 0, 0, &t.of_whole);
  run_ranks(mesh, t.count, t.owner, run_share, &t);
  for (int r = 0; r < t.count; r++)
    ck_assert_msg(t.wrong[r][0] == '\0', "trial %llu, process %d of %d: %s", seed, r, t.count,
                  t.wrong[r]);
  t.failing = below(&state, t.count);
  t.failure = below(&state, 2) == 0 ? SIGNAL : MEMORY;
  t.successes = below(&state, 150);
  run_ranks(mesh, t.count, t.owner, run_failing, &t);
  for (int r = 1; r < t.count; r++)
    ck_assert_msg(t.end[r] == t.end[0], "trial %llu: process %d of %d ends with %d, not %d", seed,
                  r, t.count, t.end[r], t.end[0]);
  forget(&t.of_whole);
  free(t.owner);
  dvi_mesh_destroy(&mesh);
}

START_TEST(all_divisions_have_the_bytes_of_the_whole_mesh)
{
  /* One has damping, but a process without unknowns, one has shares that end in a wall. */
  const unsigned long long special[] = {406, 634};
  for (int i = 0; i < 2; i++) check_trial(special[i]);
  for (int i = 0; i < repeats(20); i++) check_trial((unsigned long long)i);
}
END_TEST

SUITE(divided)
{
  tcase_add_test(tests, all_divisions_have_the_bytes_of_the_whole_mesh);
}
