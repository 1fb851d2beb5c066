/* The corners of a cell, and the inner products of the edges of its simplices in twice the digits.
 * Inner products square the condition of the edges, so that a cell as thin as 1:1e-7 would leave no
 * digit of a double. */
#ifndef DVI_FIELD_MESH_PLACED_H
#define DVI_FIELD_MESH_PLACED_H
#include "field/mesh/mesh.h"
#include "num/compensated.h"

enum { DVI__SIMPLEX_CORNERS = DVI_MESH_DIMENSION_MAX + 1 };

/* The corners of a cell relative to its first one, x + tail without roundings, and the metric. */
typedef struct dvi__placed {
  int corners, space;
  const double *metric;
  double x[DVI__CORNERS][DVI_MESH_SPACE_MAX], tail[DVI__CORNERS][DVI_MESH_SPACE_MAX];
} dvi__placed;

/* The metric of Euclidean space. */
extern const double dvi__euclidean[DVI_MESH_SPACE_MAX];

void dvi__place_cell(const dvi_mesh *mesh, int k, int64_t cell, dvi__placed *placed);

/* Give the edge from corner a to corner b, each component rounded once. */
void dvi__placed_edge(const dvi__placed *placed, int a, int b, double *edge);

/* The edges u_i of a simplex from the corner that makes them shortest, divided by powers of two, so
 * that their components are at most 1. The corners are numbered anew, the origin first. */
typedef struct dvi__gram {
  int k, space;
  const double *metric;
  int slot[DVI__SIMPLEX_CORNERS];              /* old numbers of the corners */
  double scale[DVI_MESH_DIMENSION_MAX];        /* by which the edges were divided */
  dvi__twofold square[DVI_MESH_DIMENSION_MAX]; /* u_i . u_i */
  dvi__twofold edge[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
  dvi__twofold inverse[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX]; /* of G_ij = u_i . u_j */
  double determinant;
} dvi__gram;

/* Invert the inner products of a simplex with k + 1 corners. Returns the sign of their determinant,
 * or 0 if it vanishes, in a metric with signs also if roundings of the edges can make it vanish. */
int dvi__gram_of(const dvi__placed *placed, int k, const int *corner, dvi__gram *gram);

/* Give the volume of the simplex, at least 0. */
double dvi__gram_volume(const dvi__gram *gram);

/* Give the differentials of the barycentric coordinates of the simplex's corners. */
void dvi__gram_covectors(const dvi__gram *gram,
                         dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX]);

#endif
