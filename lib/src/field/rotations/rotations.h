/* The parts of a field of rotations. */
#ifndef DVI_FIELD_ROTATIONS_ROTATIONS_H
#define DVI_FIELD_ROTATIONS_ROTATIONS_H
#include <dvi/rotations.h>

#include "field/algebra/csr.h"

enum { DVI__ENTRIES = 9 };

struct dvi_rotations {
  int axes, count[DVI_AXES_MAX], periodic[DVI_AXES_MAX]; /* nodes along each axis */
  double lower[DVI_AXES_MAX], length[DVI_AXES_MAX];      /* of an axis' start and of a cell */
  int is_clamped[DVI_AXES_MAX][2];
  double inertia[DVI__ENTRIES];
  double bending[DVI_AXES_MAX][DVI__ENTRIES]; /* tr(K)/2 I - K */
  dvi_rotations_potential potential;          /* without a density if there is none */
  int64_t nodes, unknowns;                    /* all nodes, and those that are free */
  int *number;                                /* [nodes] of a free node, or -1 */
  double *held;                               /* [nodes*9] R of held nodes, else 0 */
  double *x, *volume;                         /* of free nodes */
  dvi__csr hessian;                           /* of the bending, in the entries of free rotations */
  double *load, constant;                     /* bending = q.H q/2 - load.q + constant */
  int *hessian_start, *block_start, *block_row;
  dvi_factor *factor; /* [unknowns] */
  double *moment;     /* [unknowns*9] volume J */
  dvi_potential potentials[2];
  dvi_symmetry symmetry[3];
};

/* Number the nodes, and place the free ones. */
dvi_status dvi__rotations_place(dvi_rotations *field, const dvi_rotations_terms *terms);

/* Assemble the bending. */
dvi_status dvi__rotations_bend(dvi_rotations *field);

#endif
