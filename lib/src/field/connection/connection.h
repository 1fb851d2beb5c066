/* What a connection stores. */
#ifndef DVI_FIELD_CONNECTION_CONNECTION_H
#define DVI_FIELD_CONNECTION_CONNECTION_H
#include <dvi/curvature.h>

#include "field/connection/ring.h"
#include "field/connection/spin.h"

struct dvi_connection {
  dvi_mesh *mesh;
  int n;
  int is_own;        /* the rotations were given, or adjusted */
  double *length;    /* [edges] or NULL for those of the points */
  double *frame;     /* [cells*n*space] or NULL with lengths */
  double *gauge;     /* [cells*n*n] from Gram and Schmidt's frames to the present ones, or NULL */
  double *rotation;  /* [facets*n*n] from the first to the second cell of each inner facet */
  double *lifted;    /* [facets*dvi__spin_size] or NULL */
  dvi__rings rings;
  int64_t loops;
  int64_t *loop_start; /* [loops+1] */
  int *loop_cell;
};

/* Copy a connection without its lift. The copy may be changed before it is given away. */
dvi_status dvi__connection_copy(const dvi_connection *connection, dvi_connection **copy);

/* Choose lifts of the rotations whose signs suit all hinges. */
dvi_status dvi__connection_lift(dvi_connection *connection);

/* Give the plane normal to a hinge, in the frame of the first cell of its ring. */
dvi_status dvi__hinge_plane(const dvi_connection *connection, int64_t hinge, dvi__plane *plane);

/* Multiply a rotation [n*n] and a lift, which may be NULL, by those of the step from a cell through
 * its facet without a corner. */
void dvi__connection_step(const dvi_connection *connection, int64_t cell, int slot, double *R,
                          double *lift);

/* Find the loops of a surface. */
dvi_status dvi__find_loops(dvi_connection *connection);

#endif
