#include "mechanics/field_motion.h"

#include <dvi/study.h>
#include <dvi/scene.h>
#include <math.h>

/* Look at the energy, the first observable. */
static dvi_status look(const dvi_march *march, double *first, double *error)
{
  double energy;
  const dvi_status status = dvi_march_observe(march, 0, &energy);
  if (status == DVI_OK && isnan(*first)) *first = energy;
  if (status == DVI_OK) *error = fmax(*error, fabs(energy - *first));
  return status;
}

static dvi_status watch(dvi_march *march, double steps, double t_end, field_motion_end *end)
{
  double first = (double)NAN;
  end->energy_error = 0;
  dvi_status status = look(march, &first, &end->energy_error);
  for (double i = 1; i <= steps && status == DVI_OK; i++) {
    status = dvi_march_advance(march, i == steps ? t_end : i * t_end / steps);
    if (status == DVI_OK) status = look(march, &first, &end->energy_error);
  }
  return status;
}

dvi_status field_motion(const problem *scene, const char *method, double steps, double t_end,
                        bool watched, double *q, field_motion_end *end)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .step = t_end / steps, .potential = q != NULL};
  field_motion_end unasked;
  dvi_march_facts facts;
  dvi_march *march = NULL;
  if (end == NULL) end = &unasked;
  *end = (field_motion_end){.energy_error = (double)NAN};
  const double began = dvi_study_clock();
  dvi_status status = dvi_scene_march_create(scene->scene, &options, &march);
  end->seconds = dvi_study_clock() - began;
  if (status == DVI_OK)
    status = watched ? watch(march, steps, t_end, end) : dvi_march_advance(march, t_end);
  if (status == DVI_OK && q != NULL) status = dvi_scene_march_state(scene->scene, march, q, NULL);
  dvi_march_facts_of(march, &facts);
  end->steps = (double)facts.steps;
  end->updates = (double)facts.updates;
  dvi_march_destroy(&march);
  return status;
}
