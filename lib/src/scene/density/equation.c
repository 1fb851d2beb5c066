/* The equation of dvi/schroedinger.h that the section schroedinger stands for, with the states and
 * the methods that it has beside the mechanical system. It is made when it is first asked for. */
#include <dvi/schroedinger.h>
#include <stdio.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "text/heap.h"

enum { PARTS_SIZE = 512 };

static int potential(int64_t count, double t, const double *x, double *V, void *user)
{
  const struct dvi__scene_density *s = user;
  return dvi__local_value(s->potential, count, t, x, V);
}

static int interaction(int64_t count, const double *x, double *beta, void *user)
{
  const struct dvi__scene_density *s = user;
  return dvi__local_value(s->interaction, count, 0, x, beta);
}

/* List the parts where the field is 0. The equation has no other conditions but free ones. */
static bool list_fixed(const struct dvi__scene_density *s, char *parts)
{
  parts[0] = '\0';
  for (int k = 0; k < s->conditions; k++) {
    const dvi_density_condition *condition = s->condition + k;
    if (condition->datum != NULL || condition->robin < 0 || condition->robin > 0) return false;
    if (condition->kind != DVI_FIXED || condition->component != 0) continue;
    const size_t used = strlen(parts);
    if (used + strlen(condition->part) + 2 > PARTS_SIZE) return false;
    (void)dvi__print(parts + used, PARTS_SIZE - used, " %s", condition->part);
  }
  if (parts[0] == '\0') (void)dvi__print(parts, PARTS_SIZE, "none");
  return true;
}

static dvi_status make(struct dvi__scene_density *s)
{
  char fixed[PARTS_SIZE];
  if (!list_fixed(s, fixed)) return DVI_UNSUPPORTED;
  const dvi_schroedinger_terms terms = {.size = sizeof terms,
                                        .space = s->space,
                                        .hbar = s->hbar,
                                        .mass = s->mass,
                                        .potential = potential,
                                        .depends_on_time = s->potential->has_time,
                                        .interaction_at = s->interaction->term != NULL ? interaction
                                                                                       : NULL,
                                        .user = s,
                                        .fixed = fixed};
  return dvi_schroedinger_create(&terms, &s->equation);
}

dvi_status dvi_scene_schroedinger(const dvi_scene *scene, const dvi_schroedinger **equation)
{
  if (equation == NULL) return DVI_BAD_ARGUMENT;
  *equation = NULL;
  if (dvi_scene_density(scene) == NULL || scene->density->potential == NULL) return DVI_UNSUPPORTED;
  dvi_scene *own = (dvi_scene *)scene;
  (void)pthread_mutex_lock(&own->labels_mutex);
  const dvi_status status = own->density->equation != NULL ? DVI_OK : make(own->density);
  (void)pthread_mutex_unlock(&own->labels_mutex);
  *equation = own->density->equation;
  return status;
}
