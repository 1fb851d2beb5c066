/* The start: initial values by coordinate, and what follows from them. */
#include <string.h>

#include "scene/callbacks.h"
#include "scene/heap.h"
#include "scene/sections.h"
#include "scene/shape.h"
#include "scene/start.h"

/* What was given of q, v and p: a mark for every number. */
typedef struct given {
  char *q, *v, *p;
  int velocities, momenta;
} given;

/* How a number was given: by a formula or a list, which one for a single member overrides. */
enum { BY_ALL = 1, BY_ONE = 2 };

static bool put(dvi_scene *scene, const dvi__target *target, int number, double value, double *to, char *mark)
{
  const char how = target->index != NULL ? BY_ONE : BY_ALL;
  if (mark[number] == how) return dvi__scene_refuse(scene, target->span, "a number of %s is given twice", target->x->name);
  if (mark[number] == BY_ONE) return true;
  mark[number] = how;
  to[number] = value;
  return true;
}

/* Number k of the value, for every element. */
static bool put_component(dvi__context *c, const dvi__target *target, const dvi__expression *e, dvi__node node,
                          dvi__numbering numbering, int k, double *to, char *mark)
{
  double *each, all = 0;
  if (!dvi__node_numbers(c, e, node, &each, &all)) return false;
  bool good = true;
  for (int i = 0; i < c->elements && good; i++) {
    const int number = numbering.number != NULL ? numbering.number[i] : numbering.base + numbering.stride * i;
    good = put(c->scene, target, number + k, each != NULL ? each[i] : all, to, mark);
  }
  dvi__heap_free(each);
  return good;
}

static bool read_entry(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree, given *g)
{
  dvi__context c;
  dvi__target target;
  dvi__value value;
  dvi__numbering numbering;
  const dvi__expression *e;
  if (!dvi__read_target(scene, key, &target) || !dvi__context_make(&c, scene, 0, "a start")) return false;
  double *to = target.says == DVI__SAYS_Q ? scene->q : target.says == DVI__SAYS_V ? scene->v : scene->p;
  char *mark = target.says == DVI__SAYS_Q ? g->q : target.says == DVI__SAYS_V ? g->v : g->p;
  g->velocities |= target.says == DVI__SAYS_V;
  g->momenta |= target.says == DVI__SAYS_P;
  bool good = dvi__target_value(&c, &target, tree, &value, &numbering, &e);
  for (int k = 0; good && k < dvi__value_size(value); k++)
    good = put_component(&c, &target, e, dvi__value_at(value, k), numbering, k, to, mark);
  dvi__context_free(&c);
  return good;
}

/* The first number of a list that was not given, as a coordinate. */
static bool all_given(dvi_scene *scene, const dvi__tree *section, const char *mark, const char *what)
{
  for (int k = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    for (int i = 0; i < x->size * x->components; i++)
      if (!mark[x->first + i]) return dvi__scene_refuse(scene, section->span, what, x->name);
  }
  return true;
}

/* What must be given, and what may not. */
static bool complete(dvi_scene *scene, const dvi__tree *section, const given *g)
{
  if (!all_given(scene, section, g->q, "the start of %s is not given")) return false;
  if (scene->terms.one_form != NULL && (g->velocities || g->momenta))
    return dvi__scene_refuse(scene, section->span,
                             "with a one-form velocities and momenta follow from the coordinates, and are not given");
  if (scene->terms.hamiltonian != NULL && g->velocities)
    return dvi__scene_refuse(scene, section->span, "with constraints momenta are given, p(x), and no velocities");
  if (g->velocities && g->momenta) return dvi__scene_refuse(scene, section->span, "give velocities or momenta, not both");
  scene->momenta_given = g->momenta || scene->terms.hamiltonian != NULL;
  return !scene->momenta_given || all_given(scene, section, g->p, "the momentum p(%s) is not given");
}

bool dvi__read_initial(dvi_scene *scene, const dvi__tree *section)
{
  const size_t n = (size_t)scene->n;
  if (!dvi__want_mapping(scene, section, "initial")) return false;
  double *numbers = dvi__arena_take(&scene->arena, 3 * n, sizeof *numbers);
  if (numbers == NULL) return dvi__scene_no_memory(scene);
  scene->q = numbers;
  scene->v = numbers + n;
  scene->p = numbers + 2 * n;
  char *marks = dvi__heap_take(3 * n, 1);
  if (marks == NULL) return dvi__scene_no_memory(scene);
  given g = {.q = marks, .v = marks + n, .p = marks + 2 * n};
  bool good = true;
  for (int i = 0; i < section->count && good; i++) good = read_entry(scene, section->key[i], section->child[i], &g);
  good = good && complete(scene, section, &g);
  dvi__heap_free(marks);
  return good;
}

bool dvi__scene_complete_start(dvi_scene *scene)
{
  dvi_status status = DVI_OK;
  dvi__blame_nobody();
  if (scene->terms.one_form != NULL || scene->momenta_given)
    status = dvi_system_velocity(scene->system, 0.0, scene->q, scene->p, scene->v);
  if (status == DVI_OK && !scene->momenta_given) status = dvi_system_momentum(scene->system, 0.0, scene->q, scene->v, scene->p);
  if (status == DVI_OK) return true;
  if (status == DVI_CALLBACK_FAILED) status = dvi__blame_status();
  const char *blame = dvi_scene_blame();
  return dvi__complain(scene->complaint, status, DVI__NOWHERE, "at the start: %s%s%s", dvi_last_error(), *blame != '\0' ? "; " : "",
                       blame);
}
