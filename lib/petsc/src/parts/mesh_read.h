/* A share that is made of a file, without the whole mesh. The steps below are called on all
 * processes in this order, and all of them fail if one does. */
#ifndef DVI_PETSC_MESH_READ_H
#define DVI_PETSC_MESH_READ_H
#include <dvi/petsc.h>

#include "blocks.h"
#include "field/mesh/given.h"
#include "mesh_file.h"

typedef struct dvi__mesh_reader {
  dvi_division *division;
  const dvi__world *world;
  dvi__slabs *file;
  dvi__mesh_head head;
  dvi__block block[DVI_MESH_DIMENSION_MAX + 1]; /* of the k-cells of the whole mesh */
  int *corner;         /* [cells of the block * corners] vertices in the whole mesh */
  int8_t *orientation; /* [cells of the block] */
  int *owner;          /* [cells of the block] */
  int *number;         /* [cells] of the share's n-cells, ascending */
  int64_t cells;
  int *vertex; /* [points] of the share's vertices, ascending */
  int64_t points;
  dvi__given_share given;
} dvi__mesh_reader;

/* Find the owners of the block's cells by the division's partitioner. */
dvi_status dvi__own_cells(dvi__mesh_reader *reader);

/* Find the n-cells of the share: those of this process, and others that touch them. */
dvi_status dvi__find_cells(dvi__mesh_reader *reader);

/* Number the share's cells of all degrees, and find their owners. `mesh` is made of the n-cells. */
dvi_status dvi__number_share(dvi__mesh_reader *reader, const dvi_mesh *mesh);

/* Read the parts of a share whose cells have numbers. */
dvi_status dvi__read_parts(const dvi__mesh_reader *reader, dvi_mesh *share);

#endif
