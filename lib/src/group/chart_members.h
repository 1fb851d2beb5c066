/* Charts of members of an ensemble side by side, each with a centre of its own. The operations are
 * those of one chart, in their order, and so are the bits. */
#ifndef DVI_GROUP_CHART_MEMBERS_H
#define DVI_GROUP_CHART_MEMBERS_H
#include "group/chart_nodes.h"

/* Charts of `width` members, 4 at least. Rows of numbers are [width], and the rows of
 * dvi__chart_nodes have node j of member k at j*width + k. */
typedef struct dvi__chart_members {
  dvi__chart_kind kind;
  int width;
  const double *y0, *basis; /* rows of centres, and [6*width] of their bases */
} dvi__chart_members;

/* Compute the functions, y and v as dvi__chart_place_nodes. */
double dvi__chart_place_members(const dvi__chart_members *charts, const dvi__chart_nodes *nodes);

/* Compute the gradients of dvi__chart_differentiate_nodes, or with an `inertia` those of
 * dvi__chart_move_nodes. */
void dvi__chart_move_members(const dvi__chart_members *charts, const double *inertia,
                             const dvi__chart_nodes *nodes);

/* A path of each member that turns, from its chart's centre to xi. */
typedef struct dvi__chart_paths {
  int nodes;
  double h;
  const double *weight;  /* [nodes] b_j */
  const double *moment;  /* N, [3] rows at all nodes */
  const double *xi;      /* rows at the end */
  const double *p0, *dp; /* rows of the momenta at the start, and of h sum_j b_j L_xi_j */
  double *impulse;       /* [3*width] rows of mu1 - mu0 */
  double *correction;    /* rows of C (system/chart/centring.h) */
} dvi__chart_paths;

void dvi__chart_correct_members(const dvi__chart_members *charts, const dvi__chart_paths *paths);

#endif
