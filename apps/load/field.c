#include "load/field.h"

#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "load/open.h"

enum { NAME_SIZE = 32 };

int field_open(const char *command, const char *name, const words *settings, problem **scene,
               const dvi_field **field)
{
  const int code = open_problem(name, settings, scene);
  if (code != DONE) return code;
  *field = dvi_scene_field((*scene)->scene);
  if (*field != NULL) return DONE;
  problem_destroy(scene);
  return usage_error("%s: '%s' has no field; a scene with the sections mesh and field has one",
                     command, name);
}

const dvi_mesh *field_mesh(const dvi_field *field)
{
  return dvi_star_mesh(dvi_field_star(field));
}

int field_write(const dvi_field *field, const char *path, const char *name, int count,
                const double *values)
{
  const int64_t vertices = dvi_mesh_count(field_mesh(field), 0);
  dvi_view *view = calloc((size_t)count, sizeof *view);
  char(*names)[NAME_SIZE] = calloc((size_t)count, sizeof *names);
  const bool complete = view != NULL && names != NULL;
  dvi_status status = DVI_OK;
  for (int i = 0; i < count && complete; i++) {
    if (count > 1)
      (void)snprintf(names[i], NAME_SIZE, "%s_%d", name, i + 1);
    else
      (void)snprintf(names[i], NAME_SIZE, "%s", name);
    view[i] = (dvi_view){.name = names[i], .values = values + i * vertices, .components = 1};
  }
  if (complete) status = dvi_mesh_write(field_mesh(field), path, count, view);
  free(view);
  free(names);
  if (!complete) complain("out of memory");
  return !complete ? FAILED : status == DVI_OK ? DONE : library_error(status);
}
