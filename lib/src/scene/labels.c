/* Names for columns: x, theta_1, q_2_x, R_11, u_cos, B_2_x_y; v_, omega_ or rate_ and p_ in front for velocities and momenta. Made when the first one is asked for: a long
 * chain that is only run needs none. */
#include <stdio.h>
#include <string.h>

#include "scene/model.h"

enum { ROOM = 40 }; /* beside the name itself */

typedef enum which { OF_Q, OF_V, OF_P } which;

static const char *prefix_of(const dvi__coordinate *x, which of)
{
  if (of != OF_V) return of == OF_Q ? "" : "p_";
  return x->kind == DVI__ROTATION ? "omega_" : x->kind == DVI__ANGLE ? "rate_" : "v_";
}

/* The end of a label for number k of a member. */
static void write_component(const dvi__coordinate *x, which of, int k, char *text, size_t size)
{
  const int components = of == OF_Q ? x->q.components : x->v.components;
  text[0] = '\0';
  if (x->kind == DVI__ROTATION && of == OF_Q)
    (void)snprintf(text, size, "_%d%d", k / 3 + 1, k % 3 + 1);
  else if (x->kind == DVI__ANGLE)
    (void)snprintf(text, size, "%s", of != OF_Q ? "" : k == 0 ? "_cos" : "_sin");
  else if (x->shape.rank > 0 && components <= 3)
    (void)snprintf(text, size, "_%c", "xyz"[k]);
  else if (x->shape.rank > 0)
    (void)snprintf(text, size, "_%d", k + 1);
}

/* The label of number k of member i. */
static void write_label(const dvi__coordinate *x, which of, int i, int k, char *text, size_t size)
{
  char member[ROOM / 3] = "", component[ROOM / 3];
  const int says_part = x->part_name != 0 && (of != OF_V || x->kind != DVI__ROTATION); /* omega(B), p(B.R) */
  const char part[3] = {says_part ? '_' : '\0', x->part_name, '\0'};
  if (x->family) (void)snprintf(member, sizeof member, "_%d", i + 1);
  write_component(x, of, k, component, sizeof component);
  (void)snprintf(text, size, "%s%s%s%s%s", prefix_of(x, of), x->name, member, part, component);
}

static bool label_coordinate(dvi_scene *scene, const dvi__coordinate *x, which of, char **label)
{
  const dvi__slots *places = of == OF_Q ? &x->q : &x->v;
  const size_t size = strlen(x->name) + ROOM;
  if (x->kind == DVI__MOTION)
    return label_coordinate(scene, &x->part[0], of, label) && label_coordinate(scene, &x->part[1], of, label);
  char *text = dvi__arena_take(&scene->label_arena, (size_t)x->size * (size_t)places->components, size);
  if (text == NULL) return false;
  for (int i = 0; i < x->size; i++)
    for (int k = 0; k < places->components; k++, text += size) {
      write_label(x, of, i, k, text, size);
      label[places->first + i * places->stride + k] = text;
    }
  return true;
}

/* Labels of q, v or p; NULL if there is no memory for them. */
static char **labels_of(dvi_scene *scene, which of)
{
  pthread_mutex_lock(&scene->labels_mutex);
  dvi__ledger *const other = dvi__heap_charge(&scene->ledger);
  if (scene->label[of] == NULL) {
    char **made = dvi__arena_take(&scene->label_arena, (size_t)(of == OF_Q ? scene->n : scene->nv), sizeof *made);
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
