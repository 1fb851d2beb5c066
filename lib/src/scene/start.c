#include "scene/start.h"

#include "scene/sections/sections.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

/* Check that each rotation has a mass. (R[1,1]')^2 has rates of all its numbers, but not of all its
 * velocities. */
static dvi_status try_mass(dvi_scene *scene)
{
  double *v = dvi__heap_take((size_t)scene->nv, sizeof *v);
  if (v == NULL) return DVI_NO_MEMORY;
  const dvi_status status = dvi_system_velocity(scene->system, 0.0, scene->q, scene->p, v);
  dvi__heap_free(v);
  return status == DVI_SINGULAR ? status : DVI_OK;
}

/* Make momenta of the velocities of the end, where these are given. */
static dvi_status complete_final(dvi_scene *scene)
{
  int given = 0;
  for (int i = 0; i < scene->n; i++) given = given || scene->final_has_v[i];
  if (!given) return DVI_OK;
  return dvi_system_momentum(scene->system, scene->plan.t_end, scene->final_q, scene->final_v,
                             scene->final_p);
}

bool dvi__scene_complete_start(dvi_scene *scene)
{
  dvi_status status = DVI_OK;
  dvi__fault_clear();
  if (scene->terms.one_form != NULL || scene->momenta_given)
    status = dvi_system_velocity(scene->system, 0.0, scene->q, scene->p, scene->v);
  if (status == DVI_OK && !scene->momenta_given)
    status = dvi_system_momentum(scene->system, 0.0, scene->q, scene->v, scene->p);
  if (status == DVI_OK && !scene->momenta_given && dvi__has_factors(scene))
    status = try_mass(scene);
  if (status == DVI_OK && scene->final_q != NULL) status = complete_final(scene);
  if (status == DVI_OK) return true;
  if (status == DVI_NO_MEMORY) return dvi__scene_no_memory(scene);
  if (status == DVI_CALLBACK_FAILED) status = dvi__fault_status();
  const char *words;
  dvi__span span;
  if (status == DVI_CALLBACK_RETRY && dvi__fault_place(&span, &words))
    return dvi__complain(scene->complaint, status, span, "at the start: %s", words);
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial"),
                  *cause = status == DVI_SINGULAR || initial == NULL ? dvi__motion_section(scene)
                                                                     : initial;
  return dvi__complain(scene->complaint, status, cause->span, "at the start: %s%s%s",
                       dvi_last_error(), dvi_scene_fault()[0] != '\0' ? "; " : "",
                       dvi_scene_fault());
}
