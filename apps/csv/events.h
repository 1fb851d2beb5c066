/** The events of a scene, as a run looks for them. */
#ifndef EVENTS_H
#define EVENTS_H
#include <stdbool.h>
#include <stdio.h>

#include "problem.h"

typedef struct watched_event watched_event;

/** All events of a problem; of the catalogue's there are none. */
typedef struct event_list {
  int count;
  dvi_event *event;       /**< [count] for dvi_run */
  watched_event *watched; /**< [count] what its callbacks need */
} event_list;

/** Called when an event is found, at its time; not 0: the run fails. */
typedef int (*event_seen)(int index, double t, const double *q, const double *v, void *user);

/** List the events; `seen`, NULL for nobody, is told of each. False without memory, with a
 * complaint. */
bool events_list(event_list *list, const problem *scene, event_seen seen, void *user);

/** Tell how often each was found, and which one ended the run. */
void events_tell(const event_list *list, const char *command, const dvi_run_report *report);

/** The names of a table's columns: event, t, the coordinates, the velocities. */
void events_header(const problem *scene, FILE *stream);

/** One of its rows. */
void events_row(const problem *scene, int index, double t, const double *q, const double *v,
                FILE *stream);

void events_clear(event_list *list);

/** How many events the problem has. */
int events_count(const problem *scene);

/** Print them in words: "ground (falling, ends the run), top (falling)". */
void events_print(const problem *scene);

/** Tell that a command goes past events, if the problem has any. */
void events_passed(const char *command, const problem *scene);
#endif
