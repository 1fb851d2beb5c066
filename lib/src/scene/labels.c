/* Names for columns: x, theta_1, q_2_x; v_ and p_ in front for velocities and momenta. Made when the first one is asked for: a long chain that is only run needs none. */
#include <stdio.h>
#include <string.h>

#include "scene/model.h"

enum { ROOM = 32 }; /* beside the name itself */

/* The label of component k of member i. */
static void write_label(const dvi__coordinate *x, const char *prefix, int i, int k, char *text, size_t size)
{
  char member[ROOM / 2] = "", component[ROOM / 2] = "";
  if (x->family) (void)snprintf(member, sizeof member, "_%d", i + 1);
  if (x->shape.rank > 0 && x->components <= 3)
    (void)snprintf(component, sizeof component, "_%c", "xyz"[k]);
  else if (x->shape.rank > 0)
    (void)snprintf(component, sizeof component, "_%d", k + 1);
  (void)snprintf(text, size, "%s%s%s%s", prefix, x->name, member, component);
}

static void label_coordinate(dvi_scene *scene, const dvi__coordinate *x, const char *prefix, char **label)
{
  const size_t size = strlen(x->name) + ROOM;
  char *text = dvi__arena_take(&scene->label_arena, (size_t)x->size * (size_t)x->components, size);
  if (text == NULL) return;
  for (int i = 0; i < x->size; i++)
    for (int k = 0; k < x->components; k++, text += size) {
      write_label(x, prefix, i, k, text, size);
      label[x->first + i * x->components + k] = text;
    }
}

/* Labels of q, v or p; NULL if there is no memory for them. */
static char **labels_of(dvi_scene *scene, int which)
{
  static const char *const prefix[] = {"", "v_", "p_"};
  pthread_mutex_lock(&scene->labels_mutex);
  dvi__ledger *const other = dvi__heap_charge(&scene->ledger);
  if (scene->label[which] == NULL) {
    char **made = dvi__arena_take(&scene->label_arena, (size_t)scene->n, sizeof *made);
    for (int k = 0; k < scene->coordinate_count && made != NULL; k++)
      label_coordinate(scene, &scene->coordinate[k], prefix[which], made);
    scene->label[which] = made;
  }
  char **label = scene->label[which];
  (void)dvi__heap_charge(other);
  pthread_mutex_unlock(&scene->labels_mutex);
  return label;
}

static const char *label_at(const dvi_scene *scene, int which, int i)
{
  if (scene == NULL || i < 0 || i >= scene->n) return NULL;
  char **label = labels_of((dvi_scene *)scene, which);
  return label == NULL ? NULL : label[i];
}

const char *dvi_scene_coordinate(const dvi_scene *scene, int i)
{
  return label_at(scene, 0, i);
}

const char *dvi_scene_velocity(const dvi_scene *scene, int i)
{
  return label_at(scene, 1, i);
}

const char *dvi_scene_momentum(const dvi_scene *scene, int i)
{
  return label_at(scene, 2, i);
}
