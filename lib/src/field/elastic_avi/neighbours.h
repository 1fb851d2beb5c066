/* Free steps of a solid that processes share: what neighbours tell each other event by event.
 *
 * All processes know the times of all events, and so, before anything happens, which of them come
 * before which. A process that owns a node tells the others of a cell where the node is at the
 * cell's next event, as soon as no earlier event of the node is left. It waits with an event of a
 * cell for its own share of such places alone. So nobody acts before all earlier events at its
 * nodes have happened, and no process needs to be told up to which time another one has come, by
 * what are called null messages, or to take events back.
 *
 * Each process has its events in the order by time, and what it tells is sent before it waits. So
 * nobody waits forever: the first of all events that are left waits for none, because all that
 * comes before it has happened and has been told.
 *
 * Source: Chandy and Misra 1979 for conservative simulation; Kale and Lew 2007 for such steps. */
#ifndef DVI_FIELD_ELASTIC_AVI_NEIGHBOURS_H
#define DVI_FIELD_ELASTIC_AVI_NEIGHBOURS_H
#include "field/elastic_avi/parts.h"

enum { DVI__SOLID_MESSAGE = 1024 /* numbers at most */ };

/* Another process, and what is told to it and by it. */
typedef struct dvi__solid_link {
  int rank;
  int64_t cells;
  int *cell;        /* [cells] own numbers of the cells of both, in the order of the whole mesh */
  int count;        /* of numbers to send */
  double *out, *in; /* [DVI__SOLID_MESSAGE] */
} dvi__solid_link;

/* A cell that has nodes of several processes. */
typedef struct dvi__solid_edge {
  int64_t told;   /* the last event for which the places of own nodes have been told */
  int returned;   /* what a condition returned then */
  uint8_t own;    /* bits of own nodes */
  uint8_t got[2]; /* bits of other nodes whose places are known, of even and odd events */
  int links, link[DVI__SOLID_NODES];
  int64_t place_in[DVI__SOLID_NODES];  /* of the cell among those of the link */
  double place[2][DVI__SOLID_NUMBERS]; /* of even and odd events */
} dvi__solid_edge;

typedef struct dvi__solid_neighbours {
  int links;
  dvi__solid_link *link;
  int64_t edges;
  dvi__solid_edge *edge;
  int *edge_of; /* [active] or -1 */
  int *first;   /* [vertices] of own nodes of edges: the cell with the next event. -1 of others */
} dvi__solid_neighbours;

/* Make avi->neighbours of free steps on a share. On failure nothing is owned. */
dvi_status dvi__solid_neighbours_create(dvi__solid_avi *avi);
void dvi__solid_neighbours_destroy(dvi__solid_neighbours **neighbours);

/* Let the events of all processes up to a time happen, as dvi__solid_run_in_order does. Sets
 * avi->is_lost if places do not arrive. */
dvi__solid_halt dvi__solid_run_shared(dvi__solid_avi *avi, double limit);

#endif
