/* Runs of scenes by one call, and columns of their recordings by name. */
#include <string.h>

#include "core/status.h"
#include "scene/elaborate/model.h"
#include "text/heap.h"

static int event_count(const dvi_scene *scene)
{
  int count = 0;
  while (dvi_scene_event_at(scene, count) != NULL) count++;
  return count;
}

/* Make the scene's events those of a run. NULL if there are none, or no memory. */
static dvi_event *events_of(const dvi_scene *scene, int count)
{
  dvi_event *events = count > 0 ? dvi__heap_take((size_t)count, sizeof *events) : NULL;
  for (int k = 0; k < count && events != NULL; k++) {
    const dvi_scene_event *event = dvi_scene_event_at(scene, k);
    events[k] = (dvi_event){.name = event->name,
                            .value = event->value,
                            .direction = event->direction,
                            .terminal = event->terminal,
                            .user = event->user};
  }
  return events;
}

/* Put the integrator at the start of the options, or else of the scene. */
static dvi_status start_run(const dvi_scene *scene, const dvi_scene_run_options *options,
                            dvi_integrator *integrator)
{
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  if (options->q != NULL) q = options->q;
  if (options->v != NULL) return dvi_integrator_start_velocity(integrator, 0, q, options->v);
  return dvi_integrator_start(integrator, 0, q, options->p != NULL ? options->p : p);
}

static dvi_status record_run(const dvi_scene *scene, const dvi_scene_run_options *options,
                             dvi_integrator *integrator, dvi_recording **recording)
{
  const dvi_scene_plan *plan = dvi_scene_plan_of(scene);
  const dvi_record_options record = {.size = sizeof record,
                                     .parts = options->parts,
                                     .times = options->times,
                                     .time_count = options->time_count};
  dvi_run_options run = {.h = options->h != 0 ? options->h : plan->h,
                         .t_end = options->t_end != 0 ? options->t_end : plan->t_end,
                         .every = options->every != 0 ? options->every : plan->every,
                         .event_count = event_count(scene),
                         .cancel = options->cancel};
  dvi_event *events = events_of(scene, run.event_count);
  if (run.event_count > 0 && events == NULL)
    return dvi__fail(DVI_NO_MEMORY, "scene: no memory for %d events", run.event_count);
  run.events = events;
  dvi_status status = start_run(scene, options, integrator);
  if (status == DVI_OK) status = dvi_record(integrator, &run, &record, recording);
  dvi__heap_free(events);
  return status;
}

static dvi_status check_run(const dvi_scene *scene, const dvi_scene_run_options *options)
{
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "scene: set options.size to sizeof(dvi_scene_run_options)");
  if (options->v != NULL && options->p != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "scene: a start has either velocities or momenta");
  if (options->q != NULL && options->v == NULL && options->p == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "scene: a start in q has velocities or momenta, too");
  if (dvi_scene_system(scene) == NULL)
    return dvi__fail_in(DVI_UNSUPPORTED, "scene: it has no system to run");
  if (options->method == NULL && dvi_scene_plan_of(scene)->method == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "scene: neither it nor the options name a method");
  return DVI_OK;
}

dvi_status dvi_scene_run(const dvi_scene *scene, const dvi_scene_run_options *options,
                         dvi_recording **recording)
{
  const dvi_scene_run_options none = {.size = sizeof none};
  dvi_integrator *integrator = NULL;
  if (scene == NULL || recording == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "scene: an argument is NULL");
  *recording = NULL;
  if (options == NULL) options = &none;
  dvi_status status = check_run(scene, options);
  const char *method = options->method != NULL ? options->method : dvi_scene_plan_of(scene)->method;
  if (status == DVI_OK)
    status = dvi_integrator_create(dvi_scene_system(scene), method, &integrator);
  if (status == DVI_OK) status = record_run(scene, options, integrator, recording);
  dvi_integrator_destroy(&integrator);
  return status;
}

/* ---- columns ---- */

typedef const char *(*name_of)(const dvi_scene *scene, int i);

static const char *invariant_name(const dvi_scene *scene, int i)
{
  return dvi_system_invariant_name(dvi_scene_system(scene), i);
}

/* Find the place of a name among those of a part, -1 if it has another one. */
static int place_of(const dvi_scene *scene, name_of name, int width, const char *wanted)
{
  for (int i = 0; i < width; i++)
    if (strcmp(name(scene, i), wanted) == 0) return i;
  return -1;
}

const double *dvi_scene_column(const dvi_scene *scene, const dvi_recording *recording,
                               const char *name, int *stride)
{
  static const struct {
    dvi_record_part part;
    name_of name;
  } parts[] = {{DVI_RECORD_Q, dvi_scene_coordinate},
               {DVI_RECORD_V, dvi_scene_velocity},
               {DVI_RECORD_P, dvi_scene_momentum},
               {DVI_RECORD_INVARIANTS, invariant_name}};
  if (scene == NULL || recording == NULL || name == NULL || stride == NULL) return NULL;
  if (strcmp(name, "t") == 0) return dvi_recording_part(recording, DVI_RECORD_T, stride);
  for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
    const double *rows = dvi_recording_part(recording, parts[k].part, stride);
    const int place = rows != NULL ? place_of(scene, parts[k].name, *stride, name) : -1;
    if (place >= 0) return rows + place;
  }
  return NULL;
}
