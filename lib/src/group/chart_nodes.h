/* A chart at many points at once, such as the nodes of a path. The iterations of a step spend their
 * time here. */
#ifndef DVI_GROUP_CHART_NODES_H
#define DVI_GROUP_CHART_NODES_H
#include <stddef.h>

#include "group/chart.h"

enum { DVI__NODE_FUNCTIONS = 6 };

/* Rows of numbers at `count` nodes. Those of xi, rate and the derivatives by them are `local`
 * numbers apart, all others `count`. */
typedef struct dvi__chart_nodes {
  int count;
  size_t local;
  const double *xi, *rate;
  double *functions; /* [DVI__NODE_FUNCTIONS*count] Stumpff's functions */
  double *y, *v;     /* points, and velocities */
  const double *a, *b;
  double *in_xi, *in_rate;
} dvi__chart_nodes;

/* Compute the functions, y and, unless v is NULL, v. Returns the first |xi| that is not below the
 * chart's bound, else 0. */
double dvi__chart_place_nodes(const dvi__chart *chart, const dvi__chart_nodes *nodes);

/* Compute the gradients of a.y(xi) + b.v(xi,rate) in xi and in rate. */
void dvi__chart_differentiate_nodes(const dvi__chart *chart, const dvi__chart_nodes *nodes);

/* Compute the gradients of a.y(xi) and the kinetic energy of an even mass, which has no moment,
 *
 *     line, circle   m rate^2/2
 *     sphere         m (c_1^2 |rate|^2 + g sigma^2)/2,    g = (1 - c_1^2)/|xi|^2 = c_3 (1 + c_1)
 *     rotation       Omega.J Omega/2,   Omega = dexp_{-xi} rate
 *
 * with sigma = xi.rate. `inertia` is m, or J [9]. */
void dvi__chart_move_nodes(const dvi__chart *chart, const double *inertia,
                           const dvi__chart_nodes *nodes);

/* Compute the moments N = y x a + v x (b - m v) of a rotation or a direction. Rows of N are
 * `stride` apart. m [3] are masses of the vectors, whose own momenta have no moment. Without m
 * nothing but y x a is computed. */
void dvi__chart_moments_of_nodes(const dvi__chart *chart, const double *mass,
                                 const dvi__chart_nodes *nodes, size_t stride, double *N);

#endif
