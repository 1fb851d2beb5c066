/* Second derivatives of a chart at many points at once (group/chart_nodes.h). */
#ifndef DVI_GROUP_CHART_BENDS_H
#define DVI_GROUP_CHART_BENDS_H
#include "group/chart_nodes.h"

/* Rows of the results. Those of tangents are `stride` apart, and those of matrices the count of
 * nodes. Row i*size + j of a matrix [stored*size] or [size*size] is number (i,j). */
typedef struct dvi__chart_bends {
  size_t stride;
  int even; /* b has no moments, as that of an even mass, and turned_S and C_rate are left out */
  double *T, *S;               /* dv/drate = dy/dxi and dv/dxi */
  double *in_xi, *mixed;       /* second derivatives of a.y + b.v in xi, and in xi and rate */
  double *turned_T, *turned_S; /* columns W_j x y and W_j x v */
  double *C_xi, *C_rate; /* derivatives of W (y x a + v x b) in xi and rate by y and v alone */
} dvi__chart_bends;

/* Compute these numbers, the last four for a rotation or a direction with W [size*3], unless W is
 * NULL. y, v, a and b of the nodes are read. */
void dvi__chart_bend_nodes(const dvi__chart *chart, const dvi__chart_nodes *nodes, const double *W,
                           const dvi__chart_bends *bends);

#endif
