#include "csv/events.h"

#include <dvi/scene.h>
#include <stdlib.h>

#include "cli/command.h"
#include "csv/table.h"

struct watched_event {
  const dvi_scene_event *event;
  int index;
  long found;
  event_seen seen;
  void *user;
};

static int event_value(double t, const double *q, const double *v, double *g, void *user)
{
  const dvi_scene_event *event = ((const watched_event *)user)->event;
  return event->value(t, q, v, g, event->user);
}

static int event_counted(double t, const double *q, const double *v, void *user)
{
  watched_event *w = user;
  w->found++;
  return w->seen != NULL ? w->seen(w->index, t, q, v, w->user) : 0;
}

int events_count(const problem *scene)
{
  int count = 0;
  while (scene->scene != NULL && dvi_scene_event_at(scene->scene, count) != NULL) count++;
  return count;
}

bool events_list(event_list *list, const problem *scene, event_seen seen, void *user)
{
  const int count = events_count(scene);
  *list = (event_list){.count = 0};
  if (count == 0) return true;
  list->event = calloc((size_t)count, sizeof *list->event);
  list->watched = calloc((size_t)count, sizeof *list->watched);
  if (list->event == NULL || list->watched == NULL) {
    complain("out of memory");
    return false;
  }
  for (list->count = 0; list->count < count; list->count++) {
    const dvi_scene_event *event = dvi_scene_event_at(scene->scene, list->count);
    watched_event *w = &list->watched[list->count];
    *w = (watched_event){.event = event, .index = list->count, .seen = seen, .user = user};
    list->event[list->count] = (dvi_event){.name = event->name,
                                           .value = event_value,
                                           .direction = event->direction,
                                           .terminal = event->terminal,
                                           .occurred = event_counted,
                                           .user = w};
  }
  return true;
}

void events_tell(const event_list *list, const char *command, const dvi_run_report *report)
{
  for (int i = 0; i < list->count; i++)
    complain("%s: event '%s': found %ld time%s", command, list->event[i].name,
             list->watched[i].found, list->watched[i].found == 1 ? "" : "s");
  if (report->end == DVI_RUN_EVENT)
    complain("%s: event '%s' ended the run at t = %.17g", command, list->event[report->event].name,
             report->event_time);
}

void events_header(const problem *scene, FILE *stream)
{
  (void)fputs("event,t", stream);
  for (int i = 0; i < scene->nq; i++) {
    (void)fputc(',', stream);
    csv_text(stream, scene->coordinate[i]);
  }
  for (int i = 0; i < scene->nv; i++) {
    (void)fputc(',', stream);
    csv_text(stream, dvi_scene_velocity(scene->scene, i));
  }
  (void)fputc('\n', stream);
}

void events_row(const problem *scene, const char *name, double t, const double *q, const double *v,
                FILE *stream)
{
  csv_text(stream, name);
  (void)fprintf(stream, ",%.17g", t);
  for (int i = 0; i < scene->nq; i++) (void)fprintf(stream, ",%.17g", q[i]);
  for (int i = 0; i < scene->nv; i++) (void)fprintf(stream, ",%.17g", v[i]);
  (void)fputc('\n', stream);
}

void events_clear(event_list *list)
{
  free(list->event);
  free(list->watched);
  *list = (event_list){.count = 0};
}

void events_print(const problem *scene)
{
  static const char *const direction[] = {"falling", "both directions", "rising"};
  const dvi_scene_event *event;
  for (int i = 0; scene->scene != NULL && (event = dvi_scene_event_at(scene->scene, i)) != NULL;
       i++)
    (void)printf("%s%s (%s%s)", i > 0 ? ", " : "", event->name, direction[event->direction + 1],
                 event->terminal ? ", ends the run" : "");
}

void events_passed(const char *command, const problem *scene)
{
  if (events_count(scene) > 0)
    complain("%s: the events of %s are not looked for: dvi run and dvi sweep find them; here the "
             "motion goes on past them",
             command, scene->name);
}
