#include "support/solid/judged_solids.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/solid/blocks.h"

/* ---- what is given, in both precisions ---- */

/* The side swings, and turns a little about its foot. */
#define DEFINE_SWING(name, real, sine, cosine)                                    \
  static void name(real t, const real *X, int n, real *u, real *rate)             \
  {                                                                               \
    const real swing = sine(3 * t) / 16, swing_rate = 3 * cosine(3 * t) / 16;     \
    const real turn = (1 - cosine(2 * t)) / 16, turn_rate = 2 * sine(2 * t) / 16; \
    u[0] = swing + turn * X[1];                                                   \
    rate[0] = swing_rate + turn_rate * X[1];                                      \
    u[1] = turn / 2;                                                              \
    rate[1] = turn_rate / 2;                                                      \
    if (n < 3) return;                                                            \
    u[2] = -swing / 2;                                                            \
    rate[2] = -swing_rate / 2;                                                    \
  }

#define DEFINE_SHAKE(name, real, sine, cosine)                \
  static void name(real t, const real *X, int n, real *force) \
  {                                                           \
    force[0] = cosine(2 * t) / 4 + X[1] / 8;                  \
    force[1] = -X[0] / 2;                                     \
    if (n == 3) force[2] = sine(t) / 4;                       \
  }

#define DEFINE_PRESS(name, real, sine)                                            \
  static void name(real t, const real *X, const real *normal, int n, real *force) \
  {                                                                               \
    for (int i = 0; i < n; i++) force[i] = -normal[i] * (1 + sine(2 * t)) / 8;    \
    force[1] += X[0] / 8;                                                         \
  }

DEFINE_SWING(swing_double, double, sin, cos)
DEFINE_SWING(swing_quad, quad, quad_sin, quad_cos)
DEFINE_SHAKE(shake_double, double, sin, cos)
DEFINE_SHAKE(shake_quad, quad, quad_sin, quad_cos)
DEFINE_PRESS(press_double, double, sin)
DEFINE_PRESS(press_quad, quad, quad_sin)

/* The judge's functions have no place for the dimension. In a plane the third number is not
 * used. */
static void swing_of_judge(quad t, const quad *X, quad *u, quad *rate)
{
  swing_quad(t, X, 3, u, rate);
}

static void shake_of_judge(quad t, const quad *X, const quad *normal, quad *force)
{
  (void)normal;
  shake_quad(t, X, 3, force);
}

static void press_of_judge(quad t, const quad *X, const quad *normal, quad *force)
{
  press_quad(t, X, normal, 3, force);
}

static int dimension[] = {0, 1, 2, 3};

static int swing(double t, const double *X, double *u, double *rate, void *user)
{
  swing_double(t, X, *(int *)user, u, rate);
  return 0;
}

static int shake(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)normal;
  shake_double(t, X, *(int *)user, force);
  return 0;
}

static int press(double t, const double *X, const double *normal, double *force, void *user)
{
  press_double(t, X, normal, *(int *)user, force);
  return 0;
}

/* ---- meshes ---- */

/* The numbers of facets whose vertices all have the coordinate `axis` at `side`. Vertices of them
 * are written to `vertex` [count*n]. */
static int64_t facets_at(const dvi_mesh *mesh, int axis, double side, int *vertex)
{
  const int n = dvi_mesh_dimension(mesh), *facet = dvi_mesh_vertices(mesh, n - 1, NULL);
  int64_t count = 0;
  for (int64_t f = 0; f < dvi_mesh_count(mesh, n - 1); f++, facet += n) {
    int there = 0;
    for (int a = 0; a < n; a++) there += dvi_mesh_points(mesh)[facet[a] * n + axis] == side;
    if (there < n) continue;
    memcpy(vertex + count * n, facet, (size_t)n * sizeof *facet);
    count++;
  }
  return count;
}

static double *moved_points(const dvi_mesh *mesh, const solid_case *of, unsigned long long *seed)
{
  const int n = of->n, size = (int)dvi_mesh_count(mesh, 0) * n;
  const double edge = of->jitter * pow(1.0 / of->cells, of->grading);
  double *point = calloc((size_t)size, sizeof *point);
  memcpy(point, dvi_mesh_points(mesh), (size_t)size * sizeof *point);
  for (int i = 0; i < size; i++)
    if (point[i] > 0 && point[i] < 1) point[i] += edge * (2 * random_number(seed) - 1);
  return point;
}

static dvi_mesh *mesh_of_case(const solid_case *of, unsigned long long *seed)
{
  const int n = of->n;
  dvi_mesh *block = graded_block(n, of->cells, of->grading), *mesh = NULL;
  const int64_t cells = dvi_mesh_count(block, n), facets = dvi_mesh_count(block, n - 1);
  double *point = moved_points(block, of, seed);
  int *soft = calloc((size_t)cells, sizeof *soft), *side[3];
  dvi_mesh_part part[4] = {{.name = "soft", .degree = n, .cell = soft}};
  static const char *name[] = {"left", "right", "bottom"};
  for (int i = 0; i < 3; i++) {
    side[i] = calloc((size_t)(facets * n), sizeof *side[i]);
    part[i + 1] = (dvi_mesh_part){.name = name[i], .degree = n - 1, .vertex = side[i]};
    part[i + 1].count = facets_at(block, i < 2 ? 0 : n - 1, i == 1, side[i]);
  }
  for (int c = 0; c < cells; c++)
    if (c == 0 || random_number(seed) < 0.5) soft[part[0].count++] = c;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .points = dvi_mesh_count(block, 0),
                                .point = point,
                                .cells = cells,
                                .vertex = dvi_mesh_vertices(block, n, NULL),
                                .part = part,
                                .parts = 4};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < 3; i++) free(side[i]);
  free(point), free(soft);
  dvi_mesh_destroy(&block);
  return mesh;
}

/* ---- solids ---- */

static dvi_elastic_material material_of(const solid_case *of, const char *part,
                                        unsigned long long *seed)
{
  dvi_elastic_material m = {.part = part, .law = of->law, .lambda = 1, .mu = 1, .rho = 1};
  if (of->seed != 0) {
    m.mu = 0.5 + random_number(seed);
    m.lambda = -0.5 * m.mu + 2 * random_number(seed);
    m.rho = 0.5 + random_number(seed);
  }
  m.mooney = of->law == DVI_ELASTIC_MOONEY_RIVLIN ? m.mu / 4 : 0;
  if (of->traits & SOLID_DAMPED) m.alpha = 0.25 * m.mu, m.beta = 0.03125 * m.rho;
  return m;
}

judged_solid make_judged(const solid_case *of, const dvi_obstacle *obstacle, int obstacles)
{
  unsigned long long seed = of->seed;
  judged_solid s = {.mesh = mesh_of_case(of, &seed)};
  int *n = &dimension[of->n];
  const dvi_elastic_condition condition[] = {
      {.part = "left", .displacement = swing, .user = n},
      {.part = "bottom", .component = {0, of->n == 2, of->n == 3}, .is_steady = 1}};
  const dvi_elastic_load load[] = {{.part = "soft", .force = shake, .user = n},
                                   {.part = "right", .force = press, .user = n}};
  quad_displacement *const displacement[] = {swing_of_judge, NULL};
  quad_load *const of_judge[] = {shake_of_judge, press_of_judge};
  s.material[0] = material_of(of, "all", &seed);
  s.material[1] = material_of(of, "soft", &seed);
  const dvi_elastic_terms terms = {.size = sizeof terms,
                                   .mesh = s.mesh,
                                   .material = s.material,
                                   .materials = of->traits & SOLID_OF_TWO ? 2 : 1,
                                   .condition = condition,
                                   .conditions = of->traits & SOLID_MOVED ? 2 : 0,
                                   .load = load,
                                   .loads = of->traits & SOLID_LOADED ? 2 : 0,
                                   .obstacle = obstacle,
                                   .obstacles = obstacles,
                                   .split = of->split};
  ck_assert_msg(dvi_elastic_create(&terms, &s.elastic) == DVI_OK, "%s", dvi_last_error());
  s.judge = quad_solid_of(&terms, displacement, of_judge);
  return s;
}

void end_judged_solid(judged_solid *s)
{
  dvi_elastic_destroy(&s->elastic);
  quad_solid_clear(&s->judge);
  dvi_mesh_destroy(&s->mesh);
}

const char *name_solid(const solid_case *of)
{
  static const char *law[] = {"linear", "svk", "neo-Hookean", "Mooney-Rivlin"};
  static char text[160];
  (void)snprintf(text, sizeof text, "%s, %d-D, %d cells, grading %g, jitter %g, seed %llu%s%s%s%s",
                 law[of->law], of->n, of->cells, of->grading, of->jitter, of->seed,
                 of->traits & SOLID_LOADED ? ", loaded" : "",
                 of->traits & SOLID_MOVED ? ", moved" : "",
                 of->traits & SOLID_DAMPED ? ", damped" : "",
                 of->traits & SOLID_OF_TWO ? ", of two materials" : "");
  return text;
}

void start_judged(const judged_solid *s, double size, quad *u, quad *v)
{
  turning_start(&s->judge, size, u, v);
  quad_solid_give(&s->judge, 0, u, v);
}

/* ---- numbers ---- */

double *rounded(int count, const quad *x)
{
  double *numbers = calloc((size_t)count, sizeof *numbers);
  ck_assert_ptr_nonnull(numbers);
  for (int i = 0; i < count; i++) numbers[i] = (double)x[i];
  return numbers;
}

double error_of_solid(int count, const double *a, const quad *b)
{
  double most = 0;
  for (int i = 0; i < count; i++) {
    const double error = fabs((double)(a[i] - b[i]));
    if (!(error <= most)) most = error;
  }
  return most;
}
