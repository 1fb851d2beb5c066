/* What is shown of fields with a density: their names, and a mesh for values. */
#include <dvi/moving.h>
#include <dvi/scene.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"

int dvi_scene_declared_of(const dvi_scene *scene, int i, dvi_scene_declared *field)
{
  if (dvi_scene_density(scene) == NULL || i < 0 || i >= scene->density->fields || field == NULL)
    return 0;
  const dvi__declared_field *declared = scene->density->field + i;
  *field = (dvi_scene_declared){.name = declared->name,
                                .first = declared->first,
                                .components = declared->components,
                                .is_complex = declared->is_complex};
  return 1;
}

const char *dvi_scene_axis(const dvi_scene *scene, int d)
{
  return scene == NULL || scene->density == NULL || d < 0 || d >= scene->density->jets.dimension
             ? NULL
             : scene->density->jets.axis[d];
}

const dvi_mesh *dvi__density_mesh(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  if (s == NULL) return NULL;
  if (s->moving != NULL && s->shown == NULL)
    (void)dvi_moving_mesh(dvi_scene_moving(scene), 0, scene->q, &s->shown);
  if (s->moving == NULL && s->mesh == NULL && s->space != NULL && s->shown == NULL)
    (void)dvi_space_mesh(s->space, &s->shown);
  if (s->moving == NULL && s->mesh != NULL) return s->mesh;
  return s->shown;
}
