/* Names of columns, x, theta_1, q_2_x, R_11, u_cos, B_2_x_y. Velocities and momenta have v_, omega_
 * or rate_ and p_ in front. Labels are made when the first one is asked for, since a long chain
 * that is only run needs none. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/sections/columns.h"
#include "scene/sections/sections.h"

enum { ROOM = 40 }; /* characters beside the name itself */

typedef enum which { OF_Q, OF_V, OF_P } which;

static const char *prefix_of(const dvi__coordinate *x, which of)
{
  if (of != OF_V) return of == OF_Q ? "" : "p_";
  return x->kind == DVI__ROTATION ? "omega_" : x->kind == DVI__ANGLE ? "rate_" : "v_";
}

/* Write the end of a label for number k of a member. */
static void write_component(const dvi__coordinate *x, which of, int k, char *text, size_t size)
{
  const int components = of == OF_Q ? x->q.components : x->v.components;
  text[0] = '\0';
  if (x->kind == DVI__ROTATION && of == OF_Q)
    (void)snprintf(text, size, "_%c%c", "123"[k / 3], "123"[k % 3]);
  else if (x->kind == DVI__ANGLE)
    (void)snprintf(text, size, "%s", of != OF_Q ? "" : k == 0 ? "_cos" : "_sin");
  else if (x->shape.rank > 0 && components <= 3)
    (void)snprintf(text, size, "_%c", "xyz"[k]);
  else if (x->shape.rank > 0)
    (void)snprintf(text, size, "_%d", k + 1);
}

/* Write what follows the name in the label of number k of member i, at most ROOM characters. */
static void write_ending(const dvi__coordinate *x, which of, int i, int k, char *text)
{
  char member[24] = "", component[ROOM / 3];
  /* omega(B) has no R, p(B.R) has one */
  const int names_part = x->part_name != 0 && (of != OF_V || x->kind != DVI__ROTATION);
  const char part[3] = {names_part ? '_' : '\0', x->part_name, '\0'};
  if (x->family == 1) (void)snprintf(member, sizeof member, "_%d", i + 1);
  if (x->family > 1)
    (void)snprintf(member, sizeof member, "_%d_%d", i / x->columns + 1, i % x->columns + 1);
  write_component(x, of, k, component, sizeof component);
  (void)snprintf(text, ROOM, "%s%s%s", member, part, component);
}

static void write_label(const dvi__coordinate *x, which of, int i, int k, char *text, size_t size)
{
  char ending[ROOM];
  write_ending(x, of, i, k, ending);
  (void)snprintf(text, size, "%s%s%s", prefix_of(x, of), x->name, ending);
}

static bool label_coordinate(dvi_scene *scene, const dvi__coordinate *x, which of, char **label)
{
  const dvi__slots *places = of == OF_Q ? &x->q : &x->v;
  const size_t size = strlen(x->name) + ROOM;
  if (x->kind == DVI__MOTION)
    return label_coordinate(scene, &x->part[0], of, label) &&
           label_coordinate(scene, &x->part[1], of, label);
  char *text = dvi__arena_take(&scene->label_arena, (size_t)x->size * (size_t)places->components,
                               size);
  if (text == NULL) return false;
  for (int i = 0; i < x->size; i++)
    for (int k = 0; k < places->components; k++, text += size) {
      write_label(x, of, i, k, text, size);
      label[dvi__slots_at(places, i) + k] = text;
    }
  return true;
}

/* Make the labels of q, v or p. NULL if there is no memory for them. */
static char **labels_of(dvi_scene *scene, which of)
{
  pthread_mutex_lock(&scene->labels_mutex);
  dvi__ledger *const other = dvi__heap_charge(&scene->ledger);
  if (scene->label[of] == NULL) {
    char **made = dvi__arena_take(&scene->label_arena, (size_t)(of == OF_Q ? scene->n : scene->nv),
                                  sizeof *made);
    for (int k = 0; k < scene->coordinate_count && made != NULL; k++)
      if (!label_coordinate(scene, &scene->coordinate[k], of, made)) made = NULL;
    scene->label[of] = made;
  }
  char **label = scene->label[of];
  (void)dvi__heap_charge(other);
  pthread_mutex_unlock(&scene->labels_mutex);
  return label;
}

static const char *label_at(const dvi_scene *scene, which of, int i)
{
  if (scene == NULL || i < 0 || i >= (of == OF_Q ? scene->n : scene->nv)) return NULL;
  char **label = labels_of((dvi_scene *)scene, of);
  return label == NULL ? NULL : label[i];
}

const char *dvi_scene_coordinate(const dvi_scene *scene, int i)
{
  return label_at(scene, OF_Q, i);
}

const char *dvi_scene_velocity(const dvi_scene *scene, int i)
{
  return label_at(scene, OF_V, i);
}

const char *dvi_scene_momentum(const dvi_scene *scene, int i)
{
  return label_at(scene, OF_P, i);
}

/* ---- differences between columns ---- */

/* Return the number after an underscore, less 1, or -1 without one. */
static long number_after_underscore(const char *underscore)
{
  return underscore != NULL && *underscore == '_' ? strtol(underscore + 1, NULL, 10) - 1 : -1;
}

/* Return the member, from 0, that an ending names, or -1. */
static long member_of_ending(const dvi__coordinate *x, const char *ending)
{
  const long first = x->family > 0 ? number_after_underscore(ending) : 0;
  if (x->family < 2) return first;
  const long second = ending[0] != '\0' ? number_after_underscore(strchr(ending + 1, '_')) : -1;
  const bool inside = first >= 0 && first < dvi__extent(x, 0) && second >= 0 &&
                      second < dvi__extent(x, 1);
  return inside ? first * x->columns + second : -1;
}

/* Return true if a label of x ends so behind its name. The ending names the member, and of long
 * vectors the component. */
static bool has_ending(const dvi__coordinate *x, which of, const char *ending)
{
  if (x->kind == DVI__MOTION)
    return has_ending(&x->part[0], of, ending) || has_ending(&x->part[1], of, ending);
  const int components = of == OF_Q ? x->q.components : x->v.components;
  const long i = member_of_ending(x, ending),
             only = components > 12 ? number_after_underscore(strrchr(ending, '_')) : -1;
  char own[ROOM];
  if (i < 0 || i >= x->size) return false;
  for (int k = 0; k < components; k++) {
    if (only >= 0 && k != only) continue;
    write_ending(x, of, (int)i, k, own);
    if (strcmp(own, ending) == 0) return true;
  }
  return false;
}

/* Return true if a label consists of this prefix and text. The text is, up to its end or to some
 * underscore, the name of a coordinate other than `but`. `name` has room for the text. */
static bool is_label(const dvi_scene *scene, const char *prefix, const char *text,
                     const dvi__coordinate *but, char *name)
{
  const size_t length = strlen(text), least = length > ROOM ? length - ROOM : 0;
  memcpy(name, text, length + 1);
  for (size_t end = length; end > least; end--) {
    if (text[end] != '_' && text[end] != '\0') continue;
    name[end] = '\0';
    const dvi__name *known = dvi__names_find(&scene->names, name);
    const dvi__coordinate *x = known != NULL && known->sort == DVI__COORDINATE
                                   ? &scene->coordinate[known->number]
                                   : but;
    for (which of = OF_Q; x != but && of <= OF_P; of++)
      if ((of != OF_V || dvi__has_factors(scene)) && strcmp(prefix_of(x, of), prefix) == 0 &&
          has_ending(x, of, text + end))
        return true;
  }
  return false;
}

/* Return true for columns that have no coordinate. */
static bool is_reserved(const dvi_scene *scene, const char *text)
{
  return strcmp(text, "t") == 0 || strcmp(text, "energy") == 0 ||
         (strcmp(text, "distance") == 0 && dvi__has_factors(scene)) ||
         (strcmp(text, "gap") == 0 && dvi__tree_find(scene->tree, "contacts") != NULL) ||
         (strcmp(text, "constraint") == 0 && (dvi__tree_find(scene->tree, "constraints") != NULL ||
                                              dvi__tree_find(scene->tree, "joints") != NULL ||
                                              dvi__tree_find(scene->tree, "nonholonomic") != NULL ||
                                              dvi__tree_find(scene->tree, "one_form") != NULL));
}

bool dvi__column_is_new(dvi_scene *scene, const char *text, dvi__span span,
                        const dvi__coordinate *of)
{
  static const char *const prefix[] = {"", "p_", "v_", "omega_", "rate_"};
  if (!dvi__want_name(scene, text, span)) return false;
  char *room = dvi__heap_take(strlen(text) + 1, 1);
  if (room == NULL) return dvi__scene_no_memory(scene);
  bool there = is_reserved(scene, text);
  for (size_t k = 0; k < sizeof prefix / sizeof *prefix && !there; k++) {
    const size_t length = strlen(prefix[k]);
    there = strncmp(text, prefix[k], length) == 0 &&
            is_label(scene, prefix[k], text + length, of, room);
  }
  dvi__heap_free(room);
  return !there || dvi__scene_refuse(scene, span,
                                     "there is a column '%s' already; choose another name", text);
}

/* Check the first label alone. If two coordinates share a label, the first one of one of them is
 * among the other's. */
static bool first_label_is_new(dvi_scene *scene, const dvi__coordinate *x,
                               const dvi__coordinate *part)
{
  const size_t size = strlen(x->name) + ROOM;
  char *label = dvi__heap_take(size, 1);
  if (label == NULL) return dvi__scene_no_memory(scene);
  write_label(part, OF_Q, 0, 0, label, size);
  const bool is_new = dvi__column_is_new(scene, label, x->span, x);
  dvi__heap_free(label);
  return is_new;
}

bool dvi__labels_differ(dvi_scene *scene)
{
  for (int k = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    const bool moves = x->kind == DVI__MOTION;
    if (!first_label_is_new(scene, x, moves ? &x->part[0] : x) ||
        (moves && !first_label_is_new(scene, x, &x->part[1])))
      return false;
  }
  return true;
}
