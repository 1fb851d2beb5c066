/* A factor A = P^T L D L^T P of a sparse positive definite matrix, in dense blocks of columns.
 *
 * Neighbouring columns of L with nearly the same rows make a supernode, which is stored densely. So
 * most operations are products of dense matrices, and the rows of a supernode are listed once.
 * That pays where L has many operations for each entry, as for large meshes. Sources: Ng and Peyton
 * 1993; Ashcraft and Grimes 1989 for supernodes with some zeros. */
#ifndef DVI_NUM_SUPERNODAL_SUPERNODES_H
#define DVI_NUM_SUPERNODAL_SUPERNODES_H
#include <dvi/status.h>

typedef struct dvi__supernodes dvi__supernodes;

/* A matrix with both triangles, by columns, and its order of elimination. Column k of L belongs to
 * column order[k] of the matrix. The order must be a postorder of the elimination tree. */
typedef struct dvi__elimination {
  int n;
  const int *start, *row;     /* pattern of the matrix */
  const int *order, *place;   /* [n] permutation and its inverse */
  const int *parent, *length; /* [n] of each column: parent or -1, and entries below the diagonal */
} dvi__elimination;

/* Set order [n] to a postorder of the elimination tree. work is [3 n]. */
void dvi__elimination_postorder(int n, const int *parent, int *order, int *work);

/* Make room for a factor. The elimination and its arrays must outlive it. DVI_NO_MEMORY. */
dvi_status dvi__supernodes_create(const dvi__elimination *elimination, dvi__supernodes **made);
void dvi__supernodes_destroy(dvi__supernodes **supernodes);

/* Factor the matrix with these values, and set D [n]. Returns the number of columns that are done,
 * n if all pivots are positive. */
int dvi__supernodes_factor(dvi__supernodes *supernodes, const double *values, double *D);

/* Replace y [n], in the order of elimination, by L^-T D^-1 L^-1 y. work is [n]. */
void dvi__supernodes_solve(const dvi__supernodes *supernodes, const double *D, double *y,
                           double *work);

/* Return the numbers that the factor stores. */
double dvi__supernodes_entries(const dvi__supernodes *supernodes);

#endif
