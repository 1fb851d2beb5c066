/* The inner products of the edges of a simplex in a metric, and what follows from them. */
#ifndef DVI_FIELD_FORMS_GRAM_H
#define DVI_FIELD_FORMS_GRAM_H
#include "field/mesh/mesh.h"

enum { DVI__SIMPLEX_CORNERS = DVI_MESH_DIMENSION_MAX + 1 };

/* The corners of a cell relative to its first one, in the metric. */
typedef struct dvi__placed {
  int corners, space;
  const double *metric;
  double x[DVI__CORNERS][DVI_MESH_SPACE_MAX];
} dvi__placed;

/* A simplex with these corners of a placed cell. */
typedef struct dvi__simplex {
  int k;
  int kappa;     /* 1, -1 if the simplex is timelike, 0 if it has no volume in the metric */
  double volume; /* at least 0 */
  double gradient[DVI__SIMPLEX_CORNERS][DVI__SIMPLEX_CORNERS]; /* grad lambda_i . grad lambda_j */
  double centre[DVI__SIMPLEX_CORNERS]; /* barycentric coordinates of the circumcentre */
} dvi__simplex;

void dvi__place_cell(const dvi_mesh *mesh, int k, int64_t cell, dvi__placed *placed);

/* Compute a simplex with k + 1 corners. */
void dvi__simplex_of(const dvi__placed *placed, int k, const int *corner, dvi__simplex *simplex);

/* Compute the squares of the edges of a placed box along its axes, in the metric. */
void dvi__box_squares(const dvi__placed *placed, int k, double *square);

/* Give the volume of a k-cell in the metric, negative if the cell is timelike, 0 if it has none. */
double dvi__metric_volume(const dvi_mesh *mesh, int k, int64_t cell);

#endif
