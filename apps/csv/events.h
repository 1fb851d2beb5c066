/** The events of a scene, in the form that a run takes. */
#ifndef EVENTS_H
#define EVENTS_H
#include <stdbool.h>
#include <stdio.h>

#include "problem.h"

typedef struct watched_event watched_event;

/** All events of a problem. Problems of the catalogue have none. */
typedef struct event_list {
  int count;
  dvi_event *event;       /**< [count] for dvi_run */
  watched_event *watched; /**< [count] arguments of its callbacks */
} event_list;

/** A function that is called when an event is found, at its time. If it does not return 0, the run
 * fails. */
typedef int (*event_seen)(int index, double t, const double *q, const double *v, void *user);

/** List the events. `seen` is called for each event that is found, and may be NULL. Complains and
 * returns false without memory. */
bool events_list(event_list *list, const problem *scene, event_seen seen, void *user);

/** Report how often each event was found, and which event ended the run. */
void events_tell(const event_list *list, const char *command, const dvi_run_report *report);

/** Write the names of a table's columns, which are event, t, the coordinates and the velocities. */
void events_header(const problem *scene, FILE *stream);

/** Write one row of this table. Hits have the name of their contact. */
void events_row(const problem *scene, const char *name, double t, const double *q, const double *v,
                FILE *stream);

void events_clear(event_list *list);

/** Return the number of events of the problem. */
int events_count(const problem *scene);

/** Print the events in words, such as "ground (falling, ends the run), top (falling)". */
void events_print(const problem *scene);

/** Warn that a command goes past events, if the problem has any. */
void events_passed(const char *command, const problem *scene);
#endif
