/* Sums of matrices of the n-cells to one sparse matrix of the k-cells. */
#ifndef DVI_FIELD_FORMS_ASSEMBLE_H
#define DVI_FIELD_FORMS_ASSEMBLE_H
#include "field/forms/star.h"

/* Faces of degree k of an n-cell, at most. */
enum { DVI__LOCAL_FACES = 32 };

/* The k-faces of an n-cell. Those of a simplex follow each other in the order of the bits of their
 * corners, those of a box in the order of the bits of their axes. */
typedef struct dvi__local_faces {
  int count;
  int corner[DVI__LOCAL_FACES][DVI__CORNERS]; /* by their numbers in the cell */
} dvi__local_faces;

void dvi__find_local_faces(dvi_cell_kind kind, int n, int k, dvi__local_faces *faces);

/* Compute the matrix [faces*faces] of one n-cell, for its faces in their local order, each oriented
 * by the order of its corners. */
typedef dvi_status dvi__local_matrix(const dvi_star *star, int k, int64_t cell,
                                     const dvi__local_faces *faces, double *matrix);

/* Make the sum over all n-cells. On failure nothing is owned. */
dvi_status dvi__assemble(const dvi_star *star, int k, dvi__local_matrix *local, dvi__csr *sum);

#endif
