/* The translations and turns that conditions, loads, obstacles and laws of a solid allow. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/status.h"
#include "field/elastic/system.h"
#include "field/mesh/share.h"

enum { AXES = DVI_ELASTIC_DIMENSION_MAX };

/* ---- generators ---- */

static int translate(const double *q, double *xi, void *user)
{
  const dvi__solid_symmetry *of = user;
  const dvi_elastic *e = of->elastic;
  (void)q;
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    if (e->unknown[k] >= 0) xi[e->unknown[k]] = k % e->n == of->axis;
  return 0;
}

/* A turn about an axis moves the two components behind it, in a cycle, a and b. */
static int turn(const double *q, double *xi, void *user)
{
  const dvi__solid_symmetry *of = user;
  const dvi_elastic *e = of->elastic;
  const int a = (of->axis + 1) % AXES, b = (of->axis + 2) % AXES;
  memset(xi, 0, (size_t)e->unknowns * sizeof *xi);
  for (int64_t v = 0; v < e->vertices; v++) {
    const int *k = e->unknown + v * e->n;
    const double *X = e->point + v * e->n;
    xi[k[a]] = -(X[b] + (of->is_small ? 0 : q[k[b]]));
    xi[k[b]] = X[a] + (of->is_small ? 0 : q[k[a]]);
  }
  return 0;
}

/* ---- what allows them ---- */

/* Count the nodes on all processes whose components are given, or have a load, as far as is known.
 * Unsteady loads touch all. */
static dvi_status count_touched(const dvi__solid_system *s, int64_t touched[AXES])
{
  const dvi_elastic *e = s->elastic;
  for (int i = 0; i < AXES; i++) touched[i] = e->load_count > 0 && !e->has_steady_loads;
  for (int64_t i = 0; i < e->vertices * e->n; i++) {
    const int k = e->unknown[i], is_loaded = k >= 0 && s->load != NULL && s->load[k] != 0;
    if (dvi__owns(e->mesh, 0, i / e->n)) touched[i % e->n] += k < 0 || is_loaded;
  }
  return dvi__count_all(e->mesh, AXES, touched);
}

/* Tell if no obstacle is in the way of a translation or of a turn. */
static int passes_obstacles(const dvi_elastic *e, int axis, int is_turn)
{
  const int a = (axis + 1) % AXES, b = (axis + 2) % AXES;
  for (int i = 0; i < e->obstacles; i++) {
    const dvi_obstacle *o = e->obstacle + i;
    const int is_plane = o->kind == DVI_OBSTACLE_PLANE;
    const double *fixed = is_plane ? o->normal : o->point;
    if (o->friction > 0) return 0;
    if (is_turn ? fixed[a] != 0 || fixed[b] != 0 : !is_plane || o->normal[axis] != 0) return 0;
  }
  return 1;
}

/* An energy has the same values after rotations if P F^T, which is J times Cauchy's stress, is
 * symmetric. */
static int is_objective(int n, const dvi__solid_material *m)
{
  double H[DVI__SOLID_ENTRIES] = {0}, P[DVI__SOLID_ENTRIES] = {0};
  for (int sample = 1; sample <= 3; sample++) {
    double most = 0, skew = 0;
    for (int k = 0; k < n * n; k++) H[k] = 0.05 * sample * sin(1.7 * k + sample);
    if (dvi__law_stress(n, m, H, P) != 0) return 0;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        double sum = P[i * n + j] - P[j * n + i];
        for (int k = 0; k < n; k++)
          sum += P[i * n + k] * H[j * n + k] - P[j * n + k] * H[i * n + k];
        skew = fmax(skew, fabs(sum));
        most = fmax(most, fabs(P[i * n + j]));
      }
    if (skew > 1e-10 * most) return 0;
  }
  return 1;
}

int dvi__solid_is_linear(const dvi_elastic *e)
{
  for (int m = 0; m < e->material_count; m++)
    if (e->materials[m].law != DVI_ELASTIC_LINEAR) return 0;
  return 1;
}

static int are_objective(const dvi_elastic *e)
{
  for (int m = 0; m < e->material_count; m++)
    if (!is_objective(e->n, e->materials + m)) return 0;
  return 1;
}

/* ---- terms ---- */

static void add(dvi__solid_system *s, int axis, int is_turn, const char *name)
{
  dvi__solid_symmetry *of = s->symmetry + s->symmetries;
  *of = (dvi__solid_symmetry){.elastic = s->elastic,
                              .axis = axis,
                              .is_turn = is_turn,
                              .is_small = dvi__solid_is_linear(s->elastic)};
  (void)snprintf(of->name, sizeof of->name, "%s", name);
  const int has_generator = s->elastic->mesh->share == NULL;
  s->symmetry_term[s->symmetries++] = (dvi_symmetry){.name = of->name,
                                                     .generator = !has_generator ? NULL
                                                                  : is_turn      ? turn
                                                                                 : translate,
                                                     .user = of};
}

int dvi__solid_has_turns(const dvi_elastic *e)
{
  return dvi__solid_is_linear(e) || are_objective(e);
}

dvi_status dvi__solid_find_symmetries(dvi__solid_system *s)
{
  static const char *const momentum[] = {"momentum_x", "momentum_y", "momentum_z"},
                           *const angular[] = {"angular_x", "angular_y", "angular_z"};
  const dvi_elastic *e = s->elastic;
  const int turns = dvi__solid_has_turns(e);
  int64_t touched[AXES];
  DVI_TRY(count_touched(s, touched));
  for (int i = 0; i < e->n && i < AXES; i++)
    if (touched[i] == 0 && passes_obstacles(e, i, 0)) add(s, i, 0, momentum[i]);
  for (int i = e->n == 3 ? 0 : 2; i < AXES && turns; i++)
    if (touched[(i + 1) % AXES] == 0 && touched[(i + 2) % AXES] == 0 && passes_obstacles(e, i, 1))
      add(s, i, 1, e->n == 3 ? angular[i] : "angular");
  return DVI_OK;
}
