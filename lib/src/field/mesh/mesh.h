/* What a mesh stores. */
#ifndef DVI_FIELD_MESH_MESH_H
#define DVI_FIELD_MESH_MESH_H
#include <stdatomic.h>

#include "field/mesh/shape.h"

enum { DVI__DEGREES = DVI_MESH_DIMENSION_MAX + 1 };

/* A part with the cells of each degree up to its own, ascending. */
typedef struct dvi__part {
  char *name;
  int degree;
  int64_t count[DVI__DEGREES], total[DVI__DEGREES]; /* here, and of the whole mesh */
  int *cell[DVI__DEGREES];
} dvi__part;

typedef struct dvi__share dvi__share;

struct dvi_mesh {
  atomic_int owners;
  dvi_cell_kind kind;
  int n, space;
  double metric[DVI_MESH_SPACE_MAX], period[DVI_MESH_SPACE_MAX];
  int64_t count[DVI__DEGREES];
  double *point;              /* [vertices*space] */
  int *corner[DVI__DEGREES];  /* [count*corners] of the k-cells, NULL for k = 0 */
  int *facet[DVI__DEGREES];   /* [count*facets] of the k-cells: row i of d_{k-1}, NULL for k = 0 */
  int8_t *sign[DVI__DEGREES]; /* [count*facets] */
  int8_t *orientation;        /* [cells], NULL if the mesh is not orientable */
  int *coface;                /* [2*facets] the first two n-cells at each facet, or -1 */
  int64_t branching;          /* a facet of more than two n-cells, or -1 */
  dvi__part *part;
  int parts;
  dvi__share *share; /* of a larger mesh, or NULL (field/mesh/share.h) */
};

/* Name a k-cell by its number and its vertices, for messages, in 96 characters. */
typedef struct dvi__cell_name {
  char text[96];
} dvi__cell_name;
dvi__cell_name dvi__name_cell(const dvi_mesh *mesh, int k, int64_t cell);

/* Name a k-cell in the singular, "vertex", "edge", "triangle" and so on. */
const char *dvi__degree_name(dvi_cell_kind kind, int k);

/* Return the number of k-cells that a part of the whole mesh has, or -1 if there is no part. */
int64_t dvi__part_total(const dvi_mesh *mesh, const char *name, int k);

/* Give the difference of two points, b - a, in a mesh whose space may repeat itself. */
void dvi__mesh_difference(const dvi_mesh *mesh, int a, int b, double *difference);

#endif
