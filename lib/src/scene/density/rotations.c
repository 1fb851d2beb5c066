/* A field of rotations in a scene (dvi/rotations.h).
 *
 * The density is omega.J omega/2 - sum_d kappa_d.K_d kappa_d/2 - V(x, R). J and -K_d are its
 * constant second derivatives by omega(R) and kappa(R,x), found at points at random, and -V is what
 * is left without them. The nodes are the ends of the cells of the space, which are equal. */
#include <dvi/group.h>
#include <math.h>
#include <string.h>

#include "scene/density/rotations.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

enum { ENTRIES = 9, NUMBERS = 3, BLOCKS = 1 + DVI_AXES_MAX, POINTS = 6 };

struct dvi__scene_rotations {
  dvi__local *whole;                          /* the density */
  dvi__local *start[ENTRIES], *turn[NUMBERS]; /* R and omega(R) at the start, or NULL */
  double second[BLOCKS][ENTRIES]; /* second derivatives by omega, and by kappa along each axis */
  bool has_potential;
  dvi_rotations *made;
};

static dvi__scene_rotations *rotations_of(const dvi_scene *scene)
{
  return scene->density->rotations;
}

const dvi_rotations *dvi__rotations_made(const dvi_scene *scene)
{
  return rotations_of(scene)->made;
}

static bool make_room(dvi_scene *scene)
{
  if (scene->density->rotations != NULL) return true;
  scene->density->rotations = dvi__arena_take(&scene->arena, 1, sizeof(dvi__scene_rotations));
  return scene->density->rotations != NULL || dvi__scene_no_memory(scene);
}

/* ---- the start ---- */

bool dvi__rotations_read_start(dvi_scene *scene, const dvi__tree *section)
{
  const char *name = scene->density->field->name;
  char rate[64];
  if (!make_room(scene)) return false;
  dvi__scene_rotations *r = rotations_of(scene);
  (void)dvi__print(rate, sizeof rate, "omega(%s)", name);
  for (int i = 0; i < section->count; i++) {
    const char *key = section->key[i]->text;
    const bool is_rate = strcmp(key, rate) == 0;
    if (!is_rate && strcmp(key, name) != 0)
      return dvi__scene_refuse(scene, section->key[i]->span,
                               "the start of rotations is '%s' and '%s', and not '%s'", name, rate,
                               key);
    if (!(is_rate ? dvi__local_read(scene, section->child[i], 0, "a start", NUMBERS, r->turn)
                  : dvi__local_read_matrix(scene, section->child[i], "a start", r->start)))
      return false;
  }
  return true;
}

/* Give R at a point. Returns as callbacks do. */
static int rotation_at(const double *x, double *R, void *user)
{
  const dvi__scene_rotations *r = user;
  int failed = 0;
  for (int k = 0; k < ENTRIES && failed == 0; k++) {
    R[k] = k % 4 == 0;
    if (r->start[0] != NULL) failed = dvi__local_value(r->start[k], 1, 0, x, R + k);
  }
  return failed;
}

/* ---- the density ---- */

/* Return 0 for omega, 1 and so on for kappa along the axes, and -1 for an entry of R. */
static int block_of(const dvi_jet *jet)
{
  if (jet->component < ENTRIES) return -1;
  for (int d = 0; d < DVI_AXES_MAX; d++)
    if (jet->order[d] > 0) return 1 + d;
  return 0;
}

/* Tell if a variable is one of those that there may be. */
static bool is_known(const dvi_jet *jet)
{
  const int total = jet->order[0] + jet->order[1] + jet->order[2];
  return jet->component < ENTRIES ? !jet->rate && total == 0 : (jet->rate ? 0 : 1) == total;
}

/* Numbers from -1 to 1 that look random. */
static double draw(int *seed)
{
  const double x = sin(12.9898 * ++*seed) * 43758.5453;
  return 2 * (x - floor(x)) - 1;
}

/* Draw a rotation, and with `moves` the other variables, which are 0 without. */
static void draw_variables(const dvi__local *whole, bool moves, int *seed, double *z)
{
  double R[ENTRIES];
  dvi_so3_exp((double[]){draw(seed), draw(seed), draw(seed)}, R);
  for (int k = 0; k < whole->variables; k++) {
    const double other = draw(seed);
    z[k] = block_of(whole->variable + k) < 0 ? R[whole->variable[k].component] : moves * other;
  }
}

/* Put the second derivatives of a point into the blocks. Returns false for others, or if they are
 * not those of the points before. */
static bool take_second(dvi__scene_rotations *r, bool is_first, const double *l_zz)
{
  const dvi__local *whole = r->whole;
  for (int e = 0; e < whole->pairs; e++) {
    const dvi_jet *a = whole->variable + whole->pair[e][0],
                  *b = whole->variable + whole->pair[e][1];
    const int block = block_of(a), other = block_of(b);
    if (block < 0 && other < 0) continue;
    if (block != other) {
      if (fabs(l_zz[e]) > 1e-12) return false;
      continue;
    }
    double *of = r->second[block];
    const int i = a->component - ENTRIES, k = b->component - ENTRIES;
    if (is_first) of[NUMBERS * i + k] = of[NUMBERS * k + i] = l_zz[e];
    if (!(fabs(of[NUMBERS * i + k] - l_zz[e]) <= 1e-12 * (1 + fabs(l_zz[e])))) return false;
  }
  return true;
}

/* Tell if the density is a quadratic form of omega and of each kappa, beside a function of R. */
static bool is_quadratic(const dvi_scene *scene, double *l_zz)
{
  const struct dvi__scene_density *s = scene->density;
  dvi__scene_rotations *r = rotations_of(scene);
  double x[DVI_AXES_MAX] = {0}, z[DVI_JETS_MAX], l_z[DVI_JETS_MAX];
  int seed = 0;
  for (int point = 0; point < POINTS; point++) {
    for (int d = 0; d < s->jets.dimension; d++)
      x[d] = s->axis[d].from + (s->axis[d].to - s->axis[d].from) * (0.5 + 0.5 * draw(&seed));
    draw_variables(r->whole, true, &seed, z);
    if (dvi__local_density(1, 0, x, z, NULL, NULL, l_zz, r->whole) != 0 ||
        !take_second(r, point == 0, l_zz))
      return false;
    draw_variables(r->whole, false, &seed, z);
    if (dvi__local_density(1, 0, x, z, NULL, l_z, NULL, r->whole) != 0) return false;
    for (int k = 0; k < r->whole->variables; k++)
      if (block_of(r->whole->variable + k) >= 0 && fabs(l_z[k]) > 1e-12) return false;
  }
  return true;
}

static bool check_density(dvi_scene *scene)
{
  dvi__scene_rotations *r = rotations_of(scene);
  const struct dvi__scene_density *s = scene->density;
  for (int k = 0; k < r->whole->variables; k++) {
    if (!is_known(r->whole->variable + k))
      return dvi__scene_refuse(scene, r->whole->span[k],
                               "a density has the entries of a rotation %s, omega(%s) and "
                               "kappa(%s,%s), and no other derivatives of it",
                               s->field->name, s->field->name, s->field->name, s->jets.axis[0]);
    r->has_potential = r->has_potential || block_of(r->whole->variable + k) < 0;
  }
  if (r->whole->has_time)
    return dvi__scene_refuse(scene, s->section->span,
                             "a density of rotations does not depend on time");
  double *l_zz = dvi__heap_take((size_t)r->whole->pairs + 1, sizeof *l_zz);
  if (l_zz == NULL) return dvi__scene_no_memory(scene);
  const bool is = r->whole->term != NULL && is_quadratic(scene, l_zz);
  dvi__heap_free(l_zz);
  return is || dvi__scene_refuse(scene, s->section->span,
                                 "a density of rotations is dot(omega(%s),J*omega(%s))/2 - "
                                 "dot(kappa(%s,%s),K*kappa(%s,%s))/2 with constant J and K, "
                                 "perhaps less a function of %s and of the position",
                                 s->field->name, s->field->name, s->field->name, s->jets.axis[0],
                                 s->field->name, s->jets.axis[0], s->field->name);
}

bool dvi__rotations_take_density(dvi__context *c, dvi__node root)
{
  dvi__kernels list = {0};
  return make_room(c->scene) && dvi__kernels_add_node(c, root, &list) &&
         dvi__local_make(c->scene, &list, &rotations_of(c->scene)->whole) &&
         check_density(c->scene);
}

/* The potential V = -l at rest, and its derivatives by the entries. */
static int potential(const double *x, const double *R, double *V, double *V_R, double *V_RR,
                     void *user)
{
  const dvi__local *whole = ((const dvi__scene_rotations *)user)->whole;
  double z[DVI_JETS_MAX], l_z[DVI_JETS_MAX], l_zz[DVI_JETS_MAX * (DVI_JETS_MAX + 1) / 2];
  for (int k = 0; k < whole->variables; k++)
    z[k] = block_of(whole->variable + k) < 0 ? R[whole->variable[k].component] : 0;
  const int failed = dvi__local_density(1, 0, x, z, V, V_R != NULL ? l_z : NULL,
                                        V_RR != NULL ? l_zz : NULL, (void *)whole);
  if (failed != 0) return failed;
  if (V != NULL) *V = -*V;
  if (V_R != NULL) memset(V_R, 0, ENTRIES * sizeof *V_R);
  if (V_RR != NULL) memset(V_RR, 0, ENTRIES * ENTRIES * sizeof *V_RR);
  for (int k = 0; k < whole->variables && V_R != NULL; k++)
    if (block_of(whole->variable + k) < 0) V_R[whole->variable[k].component] = -l_z[k];
  for (int e = 0; e < whole->pairs && V_RR != NULL; e++) {
    const int i = whole->variable[whole->pair[e][0]].component,
              k = whole->variable[whole->pair[e][1]].component;
    if (i < ENTRIES && k < ENTRIES) V_RR[ENTRIES * i + k] = V_RR[ENTRIES * k + i] = -l_zz[e];
  }
  return 0;
}

/* ---- the field ---- */

/* Find the ends at which R is held where the start has it. */
static bool find_clamps(dvi_scene *scene, int *is_clamped)
{
  static const char *const side[] = {"left", "right", "bottom", "top", "back", "front"};
  const struct dvi__scene_density *s = scene->density;
  for (int i = 0; i < s->conditions; i++) {
    const dvi_density_condition *c = s->condition + i;
    if (c->datum != NULL || c->robin > 0 || c->robin < 0)
      return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "boundary")->span,
                               "ends of a field of rotations are free, or fixed where the start "
                               "has them");
    for (int k = 0; k < 2 * s->jets.dimension; k++)
      if (c->kind == DVI_FIXED && !s->axis[k / 2].periodic &&
          (strcmp(c->part, side[k]) == 0 || strcmp(c->part, "boundary") == 0))
        is_clamped[k] = 1;
  }
  return true;
}

static bool count_cells(dvi_scene *scene, int *cells)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi__tree *space = dvi__tree_find(scene->tree, "space");
  if (s->mesh != NULL)
    return dvi__scene_refuse(scene, s->place->span, "a field of rotations lives on a domain");
  for (int d = 0; d < s->jets.dimension; d++) {
    const char *kind = s->axis[d].kind;
    cells[d] = kind != NULL ? (int)dvi__axis_option(kind, "cells=", 0) : 0;
    if (cells[d] < 1 || !dvi__axis_is_linear(kind) || s->axis[d].node != NULL)
      return dvi__scene_refuse(scene, (space != NULL ? space : s->place)->span,
                               "a field of rotations has equal cells: 'space' is "
                               "'fem:degree=1,cells=100' there, and an axis has two ends");
  }
  return true;
}

static dvi_status create(dvi_scene *scene, const int *cells, const int *is_clamped)
{
  const struct dvi__scene_density *s = scene->density;
  dvi__scene_rotations *r = rotations_of(scene);
  double stiffness[DVI_AXES_MAX * ENTRIES];
  for (int i = 0; i < s->jets.dimension * ENTRIES; i++)
    stiffness[i] = -r->second[1 + i / ENTRIES][i % ENTRIES];
  const dvi_rotations_potential of = {potential, r};
  const dvi_rotations_terms terms = {.size = sizeof terms,
                                     .axis = s->axis,
                                     .axes = s->jets.dimension,
                                     .cells = cells,
                                     .inertia = r->second[0],
                                     .stiffness = stiffness,
                                     .is_clamped = is_clamped,
                                     .held = rotation_at,
                                     .user = r,
                                     .potential = r->has_potential ? &of : NULL};
  const dvi_status status = dvi_rotations_create(&terms, &r->made);
  if (status != DVI_OK) return status;
  const double damping = scene->terms.damping;
  const dvi_status made = dvi_rotations_system_terms(r->made, &scene->terms);
  scene->terms.damping = damping;
  return made;
}

/* ---- the unknowns ---- */

static bool declare_unknowns(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const int nodes = (int)dvi_rotations_nodes(rotations_of(scene)->made, NULL, NULL);
  dvi__coordinate *x = dvi__arena_take(&scene->arena, 1, sizeof *x);
  scene->n = ENTRIES * nodes;
  scene->nv = NUMBERS * nodes;
  scene->velocities = scene->n + scene->nv;
  scene->zeros = dvi__arena_take(&scene->arena, (size_t)scene->n + (size_t)scene->velocities,
                                 sizeof *scene->zeros);
  if (x == NULL || scene->zeros == NULL) return dvi__scene_no_memory(scene);
  *x = (dvi__coordinate){.name = s->field->name,
                         .span = s->field->span,
                         .kind = DVI__ROTATION,
                         .family = 1,
                         .size = nodes,
                         .columns = 1,
                         .shape = {2, 3, 3},
                         .q = {.first = 0, .stride = ENTRIES, .components = ENTRIES},
                         .v = {.first = 0, .stride = NUMBERS, .components = NUMBERS}};
  scene->coordinate = x;
  scene->coordinate_count = 1;
  for (int k = 0; k < scene->names.count; k++)
    if (scene->names.name[k].sort == DVI__COORDINATE) scene->names.name[k].number = 0;
  return true;
}

/* Evaluate the start of a node. Returns as callbacks do. */
static int start_node(const dvi_scene *scene, int node, const double *x, double volume)
{
  dvi__scene_rotations *r = rotations_of(scene);
  double *R = scene->q + (ptrdiff_t)ENTRIES * node, *omega = scene->v + (ptrdiff_t)NUMBERS * node,
         *P = scene->p + (ptrdiff_t)NUMBERS * node;
  int failed = rotation_at(x, R, r);
  for (int k = 0; k < NUMBERS && failed == 0 && r->turn[0] != NULL; k++)
    failed = dvi__local_value(r->turn[k], 1, 0, x, omega + k);
  for (int i = 0; i < NUMBERS; i++)
    for (int k = 0; k < NUMBERS; k++) P[i] += volume * r->second[0][NUMBERS * i + k] * omega[k];
  return failed;
}

static bool make_start(dvi_scene *scene)
{
  const double *x, *volume;
  const int axes = scene->density->jets.dimension,
            nodes = (int)dvi_rotations_nodes(rotations_of(scene)->made, &x, &volume);
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  scene->q = dvi__arena_take(&scene->arena, (size_t)scene->n + 2 * (size_t)scene->nv,
                             sizeof *scene->q);
  if (scene->q == NULL) return dvi__scene_no_memory(scene);
  scene->v = scene->q + scene->n;
  scene->p = scene->v + scene->nv;
  for (int a = 0; a < nodes; a++) {
    if (start_node(scene, a, x + (ptrdiff_t)axes * a, volume[a]) != 0)
      return dvi__density_complain(scene, initial, DVI_CALLBACK_FAILED);
    const double distance = dvi_so3_distance(scene->q + (ptrdiff_t)ENTRIES * a);
    if (!(distance <= 1e-12))
      return dvi__scene_refuse(scene, initial->span,
                               "the start is no rotation at %s = %.6g: off by %.2g; say it by "
                               "turn(axis, angle)",
                               scene->density->jets.axis[0], x[(ptrdiff_t)axes * a], distance);
  }
  return true;
}

bool dvi__rotations_make(dvi_scene *scene)
{
  int cells[DVI_AXES_MAX], is_clamped[2 * DVI_AXES_MAX] = {0};
  const struct dvi__scene_density *s = scene->density;
  if (!count_cells(scene, cells) || !find_clamps(scene, is_clamped)) return false;
  dvi__fault_clear();
  const dvi_status status = create(scene, cells, is_clamped);
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial");
  const bool is_of_start = initial != NULL && strstr(dvi_last_error(), "held") != NULL;
  if (status != DVI_OK)
    return dvi__density_complain(scene, is_of_start ? initial : s->section, status);
  scene->form = "separable";
  scene->mass = "inertias";
  return declare_unknowns(scene) && make_start(scene);
}

void dvi__rotations_clear(dvi_scene *scene)
{
  if (scene->density->rotations != NULL) dvi_rotations_destroy(&rotations_of(scene)->made);
}

void dvi__rotations_explain(const dvi_scene *scene, char *text, size_t size)
{
  const dvi__scene_rotations *r = rotations_of(scene);
  (void)dvi__print(text, size, "rotations at %lld nodes; bending is quadratic in their entries%s\n",
                   (long long)dvi_rotations_nodes(r->made, NULL, NULL),
                   r->has_potential ? ", beside a potential" : "");
}
