/* Nets of masses and springs in two and three dimensions: their Hessians have the graph of a
 * mesh. */
#ifndef SUPPORT_SYSTEMS_NET_H
#define SUPPORT_SYSTEMS_NET_H
#include <dvi/dvi.h>

/* `side`^dimension masses 1 at the points of a grid of spacing 1, each free to move in all
 * dimensions, bound to its neighbours in the grid, and at the border to the wall, by springs of
 * stiffness k and rest length 0.8. q are the displacements; q = 0 is at rest. */
typedef struct net {
  int dimension, side;
  double k;
  int masses, coordinates;
  int *start, *row; /* the pattern of the Hessian */
  double *q, *p;    /* [coordinates] a start: a smooth bulge, at rest */
  dvi_system *system;
} net;

/* Fails the test if there is no memory. `declared`: with the pattern; else the Hessian counts as
 * full. */
void make_net(int dimension, int side, double k, int declared, net *made);
void free_net(net *made);

#endif
