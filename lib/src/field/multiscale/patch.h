/* Bilinear elements on a rectangle of fine cells, each with a constant coefficient. */
#ifndef DVI_FIELD_MULTISCALE_PATCH_H
#define DVI_FIELD_MULTISCALE_PATCH_H
#include "num/linear.h"

/* Node (i,j) has the place i (ny+1) + j, and cell (i,j) the place i ny + j. */
typedef struct dvi__patch {
  int nx, ny;
  int unknowns;
  int *number;    /* [(nx+1)(ny+1)] unknowns of nodes, -1 for fixed ones */
  double *matrix; /* [nx*ny][16] of the cells */
  double *value;  /* of the pattern */
  double *right;  /* [unknowns] */
  dvi__pattern pattern;
  dvi__linear *factor; /* NULL without unknowns */
} dvi__patch;

typedef enum dvi__patch_kind {
  DVI__PATCH_EDGES_FIXED, /* the nodes inside are unknown */
  DVI__PATCH_PERIODIC     /* opposite edges are one, and one node is fixed */
} dvi__patch_kind;

/* Create a patch. DVI_NO_MEMORY. On failure nothing is owned. */
dvi_status dvi__patch_create(int nx, int ny, dvi__patch_kind kind, dvi__patch *patch);
void dvi__patch_clear(dvi__patch *patch);

/* Set the sizes of the cells, hx [nx] and hy [ny], and their coefficient [nx*ny]. DVI_SINGULAR if
 * roundoff hides the smallest coefficients, DVI_NO_MEMORY. */
dvi_status dvi__patch_factor(dvi__patch *patch, const double *hx, const double *hy,
                             const double *coefficient);

/* Change u [(nx+1)(ny+1)] at the unknowns so that div (a grad u) = 0 there. A periodic u may be a
 * linear function and a periodic one. */
dvi_status dvi__patch_solve(dvi__patch *patch, double *u);

/* Return the integral of a grad u . grad v. */
double dvi__patch_product(const dvi__patch *patch, const double *u, const double *v);

#endif
