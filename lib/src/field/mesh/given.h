/* Shares of a mesh that no process holds as a whole, for the library of divisions, which finds the
 * numbers and owners of their cells. */
#ifndef DVI_FIELD_MESH_GIVEN_H
#define DVI_FIELD_MESH_GIVEN_H
#include <dvi/mesh.h>

/* What a share knows of the whole mesh. Lists are [cells of the share] from dvi__allocate. */
typedef struct dvi__given_share {
  dvi_ranks ranks;
  int64_t *number[DVI_MESH_DIMENSION_MAX + 1]; /* ascending */
  int *owner[DVI_MESH_DIMENSION_MAX + 1];
  int64_t total[DVI_MESH_DIMENSION_MAX + 1]; /* cells of the whole mesh */
  double least[DVI_MESH_SPACE_MAX];          /* coordinates of the whole mesh */
  int8_t *orientation;                       /* of n-cells, NULL if there is none */
  int parts;                                 /* of the whole mesh, "all" and "boundary" included */
} dvi__given_share;

/* A part of the whole mesh, which has `total` k-cells in it. */
typedef struct dvi__given_part {
  const char *name;
  int degree;
  int64_t total[DVI_MESH_DIMENSION_MAX + 1];
} dvi__given_part;

/* Make a mesh of the share's cells a share. It takes the lists over, but not if there is no memory.
 * Its parts are then given one by one, each with its k-cells [k-cells] for k from 0 on. */
dvi_status dvi__share_given(dvi_mesh *mesh, const dvi__given_share *given);
dvi_status dvi__share_part(dvi_mesh *mesh, int p, const dvi__given_part *part, int k,
                           const char *marked);

/* Make the share of a process that is alone, and so has all cells, a whole mesh. */
void dvi__share_end(dvi_mesh *mesh);

/* Give the metric and the periods [space] of a mesh. */
void dvi__mesh_axes(const dvi_mesh *mesh, const double **metric, const double **period);

#endif
