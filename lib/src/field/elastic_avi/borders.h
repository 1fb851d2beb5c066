/* Solids on shares of a mesh: what processes tell each other about the nodes between them.
 *
 * A process lets the events of all cells happen that have one of its nodes. So those between
 * processes happen on several of them, with the same bits. What such a cell needs beside the
 * process's own nodes is where the others are, before it pulls at them. Their owners tell it. Kicks
 * are computed where a node is owned, from all of its cells in their order, and are not sent.
 *
 * The times of all events are known beforehand. So with classes all processes know the slots in
 * which cells between them act, and go through the others without a word. */
#ifndef DVI_FIELD_ELASTIC_AVI_BORDERS_H
#define DVI_FIELD_ELASTIC_AVI_BORDERS_H
#include "field/elastic_avi/plan.h"

/* Nodes of a share, ordered by the least class of the cells between processes that they have. */
typedef struct dvi__solid_borders {
  int *lent, *borrowed; /* own nodes that others need, and nodes of others that are needed here */
  int64_t lent_end[DVI__SOLID_CLASSES], borrowed_end[DVI__SOLID_CLASSES]; /* up to a class */
  int first_class; /* the least class of a cell between any two processes */
  double *value;   /* [n][vertices] */
} dvi__solid_borders;

/* Tell whether events of a cell happen on this process. */
int dvi__solid_acts_here(const dvi_elastic *e, int64_t cell);

/* The following functions are called on all processes, and do nothing on a whole mesh. */

/* Make avi->borders, after the cells have been numbered. On failure nothing is owned. */
dvi_status dvi__solid_borders_create(dvi__solid_avi *avi);
void dvi__solid_borders_destroy(dvi__solid_borders **borders);

/* Before the events of a slot at the time t whose cells have at most this class: tell where own
 * nodes are, and learn where those of others are. Returns what a condition returned, with one of
 * the cells of its node. Sets avi->is_lost if values do not arrive. */
dvi__solid_halt dvi__solid_trade(dvi__solid_avi *avi, int class, double t);

/* Set the nodes of others to what their owners have, between two runs. */
dvi_status dvi__solid_complete(dvi__solid_avi *avi);

/* Set numbers [vertices*n] of others' nodes to what their owners have. */
dvi_status dvi__solid_refresh(const dvi__solid_avi *avi, double *number);

#endif
