/* The sections initial and final, values by coordinate. */
#include <dvi/group.h>
#include <math.h>
#include <string.h>

#include "scene/elaborate/shape.h"
#include "scene/sections/sections.h"
#include "scene/sections/target.h"
#include "text/heap.h"

/* The numbers of q, v and p that are read, and a mark for every number that has a value. */
typedef struct start_marks {
  double *to_q, *to_v, *to_p;
  char *q, *v, *p;
  int velocities, momenta;
} start_marks;

/* Put a number. Its mark is 1 for a formula or a list, and 1 more for every index that was a
 * number. A more specific value of a member has priority. */
static bool put_number(dvi_scene *scene, const dvi__target *target, int number, double value,
                       double *to, char *mark)
{
  const char how = (char)(1 + target->fixed);
  if (mark[number] == how)
    return dvi__scene_refuse(scene, target->span, "a number of %s is given twice", target->x->name);
  scene->start_overlaps |= mark[number] != 0;
  if (mark[number] > how) return true;
  mark[number] = how;
  to[number] = value;
  return true;
}

static int first_number(dvi__numbering numbering, int element)
{
  return numbering.number != NULL ? numbering.number[element]
                                  : numbering.base + numbering.stride * element;
}

/* Put stored number k of the value, for every element. */
static bool put_component(dvi__context *c, const dvi__target *target, const dvi__expression *e,
                          dvi__node node, dvi__numbering numbering, int k, double *to, char *mark)
{
  double *each, all = 0;
  if (!dvi__node_numbers(c, e, node, &each, &all)) return false;
  bool good = true;
  for (int i = 0; i < c->elements && good; i++) {
    const int number = first_number(numbering, i);
    good = put_number(c->scene, target, number + dvi__target_place(target, k),
                      each != NULL ? each[i] : all, to, mark);
  }
  dvi__heap_free(each);
  return good;
}

/* Find the stored numbers of a value. Angles, which are given as numbers, are stored as cosine and
 * sine. */
static bool stored_value(dvi__context *c, const dvi__target *target, dvi__value *value)
{
  if (target->x->kind != DVI__ANGLE || target->mentions != DVI__MENTIONS_Q) return true;
  const int count = dvi__value_size(*value);
  dvi__value stored = dvi__value_make(c, 1, 2 * count, 1);
  for (int i = 0; !dvi__failed(stored) && i < 2 * count; i++)
    stored.node[i] = dvi__apply(c->graph, i % 2 == 0 ? DVI__OP_COS : DVI__OP_SIN,
                                dvi__value_at(*value, i / 2), 0);
  *value = stored;
  return !dvi__failed(stored);
}

/* Rounding of numbers that another program has computed. */
static const double near_enough = 1e-12;

/* Check a member that was put. Rotations must be rotations, and directions of length 1. */
static bool is_right(dvi_scene *scene, const dvi__target *target, const dvi__expression *e,
                     const double *q)
{
  const dvi__coordinate *x = target->x;
  if (target->mentions != DVI__MENTIONS_Q) return true;
  if (x->kind == DVI__ROTATION) {
    const double distance = dvi_so3_distance(q);
    return distance <= near_enough ||
           dvi__scene_refuse(scene, e->span,
                             "this is no rotation for %s: off by %.2g; say it by turn(axis, angle)",
                             x->name, distance);
  }
  if (x->kind != DVI__DIRECTION) return true;
  const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
  return fabs(length - 1) <= near_enough ||
         dvi__scene_refuse(
             scene, e->span,
             "the direction %s is of length %.17g, and must be of length 1; divide it by norm(..)",
             x->name, length);
}

/* Check all members that a value has set. */
static bool are_right(const dvi__context *c, const dvi__target *target, const dvi__expression *e,
                      dvi__numbering numbering, int size, const double *q)
{
  bool good = true;
  for (int i = 0; i < c->elements; i++)
    for (int k = 0; k < size && good; k += target->places->components)
      good = is_right(c->scene, target, e,
                      q + first_number(numbering, i) + dvi__target_place(target, k));
  return good;
}

static bool read_entry(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                       start_marks *g)
{
  dvi__context c;
  dvi__target target;
  dvi__value value;
  dvi__numbering numbering;
  const dvi__expression *e;
  if (!dvi__read_target(scene, key, &target) || !dvi__context_make(&c, scene, 0, "a start"))
    return false;
  double *to = target.mentions == DVI__MENTIONS_Q   ? g->to_q
               : target.mentions == DVI__MENTIONS_V ? g->to_v
                                                    : g->to_p;
  char *mark = target.mentions == DVI__MENTIONS_Q   ? g->q
               : target.mentions == DVI__MENTIONS_V ? g->v
                                                    : g->p;
  g->velocities |= target.mentions == DVI__MENTIONS_V;
  g->momenta |= target.mentions == DVI__MENTIONS_P;
  bool good = dvi__target_value(&c, &target, tree, &value, &numbering, &e) &&
              stored_value(&c, &target, &value);
  for (int k = 0; good && k < dvi__value_size(value); k++)
    good = put_component(&c, &target, e, dvi__value_at(value, k), numbering, k, to, mark);
  good = good && are_right(&c, &target, e, numbering, dvi__value_size(value), to);
  dvi__context_free(&c);
  return good;
}

/* Return a coordinate with a number that has no value, or NULL. */
static const dvi__coordinate *find_missing(const dvi__coordinate *x, const dvi__slots *places,
                                           const char *mark)
{
  for (int i = 0; i < x->size; i++)
    for (int k = 0; k < places->components; k++)
      if (!mark[dvi__slots_at(places, i) + k]) return x;
  return NULL;
}

/* Refuse the first coordinate of which a number has no value. */
static bool all_numbers_set(dvi_scene *scene, const dvi__tree *section, unsigned mentions,
                            const char *mark)
{
  for (int k = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k], *found = NULL;
    for (int i = 0; i < (x->kind == DVI__MOTION ? 2 : 1) && found == NULL; i++) {
      const dvi__coordinate *part = x->kind == DVI__MOTION ? &x->part[i] : x;
      found = find_missing(part, mentions == DVI__MENTIONS_Q ? &part->q : &part->v, mark);
    }
    if (found == NULL) continue;
    const char dot[3] = {found->part_name != 0 ? '.' : '\0', found->part_name, '\0'};
    return dvi__scene_refuse(scene, section->span,
                             mentions == DVI__MENTIONS_Q ? "the start of %s%s is not given"
                                                         : "the momentum p(%s%s) is not given",
                             x->name, dot);
  }
  return true;
}

/* Check that velocities and momenta of directions are orthogonal to them. */
static bool directions_are_orthogonal(dvi_scene *scene, const dvi__tree *section,
                                      const double *second)
{
  for (int k = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    for (int i = 0; i < x->size && x->kind == DVI__DIRECTION; i++) {
      const double *q = scene->q + x->q.first + (ptrdiff_t)3 * i,
                   *w = second + x->v.first + (ptrdiff_t)3 * i;
      const double along = q[0] * w[0] + q[1] * w[1] + q[2] * w[2],
                   size = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
      if (!(fabs(along) <= near_enough * size))
        return dvi__scene_refuse(scene, section->span,
                                 "the velocity or momentum of the direction %s is not orthogonal "
                                 "to it: off by %.2g; say it as "
                                 "cross(omega, %s)",
                                 x->name, fabs(along), x->name);
    }
  }
  return true;
}

/* Check that all numbers are finite. Formulas may have no value for a member that has a value of
 * its own, so this waits until all values are there. */
static bool start_is_finite(dvi_scene *scene, const dvi__tree *section)
{
  for (int i = 0; i < scene->n + 2 * scene->nv; i++) {
    if (isfinite(scene->q[i])) continue;
    const int of_v = i >= scene->n, number = of_v ? (i - scene->n) % scene->nv : i;
    return dvi__scene_refuse(scene, section->span, "the start of %s is not finite",
                             scene->coordinate[dvi__coordinate_at(scene, number, of_v)].name);
  }
  return true;
}

/* Check that the necessary values are there, and no others. */
static bool start_is_complete(dvi_scene *scene, const dvi__tree *section, const start_marks *g)
{
  if (!all_numbers_set(scene, section, DVI__MENTIONS_Q, g->q)) return false;
  if (scene->terms.one_form != NULL && (g->velocities || g->momenta))
    return dvi__scene_refuse(
        scene, section->span,
        "with a one-form velocities and momenta follow from the coordinates, and are not given");
  if (scene->terms.hamiltonian != NULL && g->velocities)
    return dvi__scene_refuse(scene, section->span,
                             "with a hamiltonian momenta are given, p(x), and no velocities");
  if (g->velocities && g->momenta)
    return dvi__scene_refuse(scene, section->span, "give velocities or momenta, not both");
  scene->momenta_given = g->momenta || scene->terms.hamiltonian != NULL;
  if (scene->momenta_given && !all_numbers_set(scene, section, DVI__MENTIONS_P, g->p)) return false;
  return start_is_finite(scene, section) &&
         directions_are_orthogonal(scene, section, scene->momenta_given ? scene->p : scene->v);
}

bool dvi__read_initial(dvi_scene *scene, const dvi__tree *section)
{
  const size_t n = (size_t)scene->n, nv = (size_t)scene->nv;
  scene->reads = DVI__IN_START;
  if (scene->density != NULL) return dvi__density_read_start(scene, section);
  if (scene->field != NULL) return dvi__read_field_start(scene, section);
  if (!dvi__want_mapping(scene, section, "initial")) return false;
  double *numbers = dvi__arena_take(&scene->arena, n + 2 * nv, sizeof *numbers);
  if (numbers == NULL) return dvi__scene_no_memory(scene);
  scene->q = numbers;
  scene->v = numbers + n;
  scene->p = numbers + n + nv;
  char *marks = dvi__heap_take(n + 2 * nv, 1);
  if (marks == NULL) return dvi__scene_no_memory(scene);
  start_marks g = {scene->q, scene->v, scene->p, marks, marks + n, marks + n + nv, 0, 0};
  bool good = true;
  for (int i = 0; i < section->count && good; i++)
    good = read_entry(scene, section->key[i], section->child[i], &g);
  good = good && start_is_complete(scene, section, &g);
  dvi__heap_free(marks);
  return good;
}

/* ---- the end of a control problem ---- */

/* Check that momenta can be made of the velocities that are given. */
static bool final_is_complete(dvi_scene *scene, const dvi__tree *section, const start_marks *g)
{
  if (g->velocities && g->momenta)
    return dvi__scene_refuse(scene, section->span, "give velocities or momenta, not both");
  const int moves = scene->terms.lagrangian != NULL || scene->terms.vector_potential != NULL,
            single = scene->mass_diagonal != NULL && scene->terms.mass.values == NULL && !moves;
  for (int i = 0; i < scene->n && g->velocities && !single; i++)
    if (!g->v[i] || (moves && !g->q[i]))
      return dvi__scene_refuse(scene, section->span,
                               "velocities that the mass couples must all be given, and the "
                               "coordinates on which the mass depends; or give momenta, p(x)");
  return true;
}

bool dvi__read_final(dvi_scene *scene, const dvi__tree *section)
{
  const size_t n = (size_t)scene->n;
  if (scene->density != NULL) return true; /* which has read it already */
  if (!dvi__want_mapping(scene, section, "final")) return false;
  if (scene->control_count == 0)
    return dvi__scene_refuse(scene, section->span,
                             "an end is for controls, and the scene has no section controls");
  double *numbers = dvi__arena_take(&scene->arena, 3 * n, sizeof *numbers);
  char *marks = dvi__arena_take(&scene->arena, 3 * n, 1);
  if (numbers == NULL || marks == NULL) return dvi__scene_no_memory(scene);
  memcpy(numbers, scene->q, n * sizeof *numbers);
  start_marks g = {numbers, numbers + n, numbers + 2 * n, marks, marks + n, marks + 2 * n, 0, 0};
  for (int i = 0; i < section->count; i++)
    if (!read_entry(scene, section->key[i], section->child[i], &g)) return false;
  if (!final_is_complete(scene, section, &g)) return false;
  for (size_t i = 0; i < n; i++) {
    g.p[i] = g.p[i] || g.v[i];
    g.q[i] = !g.q[i];
    g.p[i] = !g.p[i];
  }
  scene->final_q = g.to_q;
  scene->final_v = g.to_v;
  scene->final_p = g.to_p;
  scene->free_q = g.q;
  scene->final_has_v = g.v;
  scene->free_p = g.p;
  return true;
}
