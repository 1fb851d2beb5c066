/* Deficits, volumes and actions of complexes of simplices with given lengths, in quadruple
 * precision, by Gram's matrices and the angles between barycentric gradients. */
#ifndef SUPPORT_QUAD_REGGE_H
#define SUPPORT_QUAD_REGGE_H
#include <dvi/mesh.h>

#include "quad_real.h"

/* Set deficit and volume [hinges of degree n - 2] of lengths [edges], n from 2 to 4. At the
 * boundary pi stands for 2 pi. The volume of a vertex is 1. Returns the volume of all simplices. */
quad quad_hinges(const dvi_mesh *mesh, const quad *length, quad *deficit, quad *volume);

/* Return sum |h| eps_h - lambda V. */
quad quad_regge_action(const dvi_mesh *mesh, double lambda, const quad *length);

/* Return the sum of |h| d eps_h/dl_e for an edge, by differences. */
quad quad_schlaefli(const dvi_mesh *mesh, quad *length, int64_t e);

#endif
