/* The parts of the cells that members let have their events (visits.c tells how). */
#ifndef DVI_FIELD_ELASTIC_AVI_PARTS_H
#define DVI_FIELD_ELASTIC_AVI_PARTS_H
#include "field/elastic_avi/calendar.h"
#include "field/elastic_avi/plan.h"
#include "num/team.h"

/* An event: its slot, or with free steps its time, and the own number of its cell. */
typedef struct dvi__part_event {
  double at;
  int64_t cell;
} dvi__part_event;

/* The first event of a node that has not happened and cannot in a visit. */
typedef struct dvi__part_hold {
  dvi__part_event first; /* infinite for none */
  int64_t visit;         /* the last one in which it was found */
} dvi__part_hold;

typedef struct dvi__solid_part {
  int64_t count;                         /* of cells */
  const int *cell;                       /* [count] own numbers, ascending */
  int64_t class_end[DVI__SOLID_CLASSES]; /* in `cell` */
  dvi__calendar *calendar;               /* of free steps */
  int64_t slot, next, due; /* of classes: the slot to go on in, a place in `cell`, and the end */
  int64_t nodes, edge;     /* nodes, and the first of them, that others have, too */
  dvi__part_hold *hold;    /* [nodes] */
  uint64_t *mark;          /* bits of all vertices: those of the edge, and with a hold */
  int64_t *foreign_start;  /* [edge+1] */
  int *foreign;            /* own numbers of the cells of others */
  dvi__part_event *late, *later; /* [room] events that were put off, in their order */
  int64_t room, lates;
  /* What a run did. Only the member writes here. */
  dvi__solid_halt halt;
  double t;                       /* of the last event */
  int64_t events, visits, delays; /* since the march has been made */
  char rest_of_lines[64];
} dvi__solid_part;

typedef struct dvi__solid_parts {
  int count;
  dvi__solid_part *part; /* [count] one a member */
  dvi__team *team;       /* NULL for a single one, and then there are no edges */
  int *cell;             /* [active] part by part */
  int *corner;           /* [active*(n+1)] by own numbers of cells: nodes by numbers of the part */
  _Atomic double *after; /* [active] slots or times of the next events, by own numbers */
} dvi__solid_parts;

/* Make avi->parts, one a thread. On failure nothing is owned. */
dvi_status dvi__solid_parts_create(dvi__solid_avi *avi);
void dvi__solid_parts_destroy(dvi__solid_parts **parts);

#endif
