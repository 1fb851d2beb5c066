/* The inner products of the edges of a simplex in a metric, and what follows from them. */
#ifndef DVI_FIELD_FORMS_GRAM_H
#define DVI_FIELD_FORMS_GRAM_H
#include "field/mesh/placed.h"

/* A simplex with these corners of a placed cell. */
typedef struct dvi__simplex {
  int k;
  int kappa;     /* 1, -1 if the simplex is timelike, 0 if it has no volume in the metric */
  double volume; /* at least 0 */
  double square[DVI__SIMPLEX_CORNERS]; /* grad lambda_i . grad lambda_i */
  double centre[DVI__SIMPLEX_CORNERS]; /* barycentric coordinates of the circumcentre */
} dvi__simplex;

/* Compute a simplex with k + 1 corners. */
void dvi__simplex_of(const dvi__placed *placed, int k, const int *corner, dvi__simplex *simplex);

/* Give the differentials of the barycentric coordinates of a placed n-simplex, and its volume. They
 * have twice the digits where their wedge products would lose digits of doubles. Returns kappa. */
int dvi__covectors_of(const dvi__placed *placed, int n,
                      dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX],
                      double *volume);

/* Compute the squares of the edges of a placed box along its axes, in the metric. */
void dvi__box_squares(const dvi__placed *placed, int k, double *square);

/* Give the volume of a k-cell in the metric, negative if the cell is timelike, 0 if it has none. */
double dvi__metric_volume(const dvi_mesh *mesh, int k, int64_t cell);

#endif
