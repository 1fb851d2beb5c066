/* The cells around each hinge in their order. */
#ifndef DVI_FIELD_CONNECTION_RING_H
#define DVI_FIELD_CONNECTION_RING_H
#include "field/mesh/mesh.h"

/* The cells around hinge h are cell[start[h]] .. cell[start[h+1]-1], a ring or a fan. Each is
 * entered through the facet without corner `enter`, and left through that without `leave`, in the
 * sense of dvi_connection_ring. */
typedef struct dvi__rings {
  int64_t *start; /* [hinges+1] */
  int *cell;
  int8_t *enter, *leave;
  char *is_open; /* [hinges] not 0 for a fan */
} dvi__rings;

/* DVI_BAD_ARGUMENT if the cells around a hinge do not hang together. On failure nothing is owned. */
dvi_status dvi__rings_create(const dvi_mesh *mesh, dvi__rings *rings);
void dvi__rings_clear(dvi__rings *rings);

/* Copy the rings of a mesh. */
dvi_status dvi__rings_copy(const dvi_mesh *mesh, const dvi__rings *rings, dvi__rings *copy);

/* Give the cell behind the facet of a cell without a corner, or -1. */
int dvi__cell_behind(const dvi_mesh *mesh, int64_t cell, int slot);

#endif
