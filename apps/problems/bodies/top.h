/* Rigid bodies that turn about a fixed point, with or without weight. On SO(3), V = w.R^T e3 with
 * the vector w = m g X in the body's frame, X from the fixed point to the centre of mass, and e3
 * up. */
#ifndef PROBLEMS_TOP_H
#define PROBLEMS_TOP_H
#include "entry.h"

/* The parameters of a body. */
typedef struct top {
  double J[9];      /* inertia about the fixed point, in the body's frame */
  double weight[3]; /* vector w */
} top;

/* Allocate a body, which `made->parameters` then points to, at R = I and with this angular
 * velocity. J and w are still to be set. */
dvi_status top_room(problem *made, const double *Omega);

/* Set the principal inertias. */
void top_inertia(top *body, const double *J);

/* Make the system. Without weight (a vector of 0) there is no potential, and all three components
 * of the angular momentum in space are conserved. With weight only the one about the vertical
 * is. */
dvi_status top_system(problem *made, const dvi_invariant *invariant);

#define TOP_ARM(number)                                            \
  {                                                                \
    .name = "l", .value = (number), .least = 0.0, .most = 1e50,    \
    .help = "how far the centre of mass is from the pivot, from 0" \
  }
#define TOP_START(title, number)                                                     \
  {                                                                                  \
    .name = (title), .value = (number), .least = -1e6, .most = 1e6, .start_only = 1, \
    .help = "the angular velocity at the start, in the body's frame"                 \
  }
#define TOP_INERTIA(title, number)                                              \
  {                                                                             \
    .name = (title), .value = (number), .least = 1e-50, .most = 1e50,           \
    .help = "a principal inertia, positive, no more than the sum of the others" \
  }

#endif
