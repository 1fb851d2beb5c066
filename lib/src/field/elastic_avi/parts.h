/* The parts of the cells that members let have their events (events.c tells how). */
#ifndef DVI_FIELD_ELASTIC_AVI_PARTS_H
#define DVI_FIELD_ELASTIC_AVI_PARTS_H
#include "field/elastic_avi/calendar.h"
#include "field/elastic_avi/plan.h"
#include "num/team.h"

typedef struct dvi__solid_part {
  int64_t count;                         /* of cells */
  const int *cell;                       /* [count] own numbers, ascending */
  int64_t class_end[DVI__SOLID_CLASSES]; /* in `cell` */
  dvi__calendar *calendar;               /* of free steps */
  int64_t slot, next, due; /* of classes: the slot to go on in, a place in `cell`, and the end */
  /* What a run did. Only the member writes here. */
  dvi__solid_halt halt;
  double t;       /* of the last event */
  int64_t events; /* since the march has been made */
  char rest_of_lines[64];
} dvi__solid_part;

/* Cells at edges have nodes in common with other parts, and numbers of their own. */
typedef struct dvi__solid_parts {
  int count;
  dvi__solid_part *part; /* [count] one a member */
  dvi__team *team;       /* NULL for a single one, and then there are no edges */
  int *cell;             /* [active] part by part */
  int64_t edges;
  int *cell_at;           /* [edges] own numbers */
  int64_t *foreign_start; /* [edges+1] */
  int *foreign;           /* the edges of other parts with a common node */
  _Atomic double *after;  /* [edges] slots or times of the next events */
} dvi__solid_parts;

/* Make avi->parts of the plan's slabs, at most one a thread. On failure nothing is owned. */
dvi_status dvi__solid_parts_create(const dvi__solid_plan *plan, dvi__solid_avi *avi);
void dvi__solid_parts_destroy(dvi__solid_parts **parts);

#endif
