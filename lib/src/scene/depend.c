/* The public functions of derivatives by parameters. */
#include <math.h>
#include <stdio.h>

#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"
#include "text/heap.h"

dvi_status dvi_scene_depend(dvi_scene *scene, dvi_dependence *dependence, char *message,
                            size_t size)
{
  if (scene == NULL || dependence == NULL) return DVI_BAD_ARGUMENT;
  if (message != NULL && size > 0) message[0] = '\0';
  if (scene->terms.lagrangian == NULL && scene->kinetic == NULL) return DVI_UNSUPPORTED;
  if (dvi__has_factors(scene) || scene->density != NULL) return DVI_UNSUPPORTED;
  if (scene->varied_second == NULL) {
    dvi__complaint complaint = {
        .source = &scene->source, .message = message, .size = message != NULL ? size : 0};
    dvi__ledger *const other = dvi__heap_charge(&scene->ledger);
    scene->complaint = &complaint;
    const bool read = dvi__read_dependence(scene);
    scene->complaint = NULL;
    (void)dvi__heap_charge(other);
    if (!read) return complaint.status != DVI_OK ? complaint.status : DVI_NO_MEMORY;
  }
  *dependence = dvi__scene_dependence(scene);
  return DVI_OK;
}

dvi_status dvi_scene_start_tangent(const dvi_scene *scene, double *by_q, double *by_p)
{
  if (scene == NULL || by_q == NULL || by_p == NULL) return DVI_BAD_ARGUMENT;
  if (scene->varied_second == NULL) return DVI_BAD_STATE;
  const size_t n = (size_t)scene->n, all = n * (size_t)scene->parameter_count;
  double *room = dvi__heap_take(n * n + all, sizeof *room);
  if (room == NULL) return DVI_NO_MEMORY;
  int returned = dvi__scene_start_tangent(scene, by_q, by_p, room, room + n * n);
  dvi__heap_free(room);
  for (size_t k = 0; k < all && returned == 0; k++)
    returned = !isfinite(by_q[k]) || !isfinite(by_p[k]);
  return returned == 0 ? DVI_OK : DVI_NOT_FINITE;
}

const dvi_objective *dvi_scene_objective(const dvi_scene *scene)
{
  if (scene == NULL || (scene->objective_end == NULL && scene->objective_rate == NULL)) return NULL;
  return &scene->objective;
}
