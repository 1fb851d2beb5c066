/** Steps of Galerkin variational integrators in quadruple precision, from their definition. */
#ifndef QUAD_STEP_H
#define QUAD_STEP_H
#include "mechanics/quad_motion.h"

#ifdef QUAD_EXISTS
/** A degree and a quadrature. */
typedef struct quad_step quad_step;

/** Read the name of a galerkin integrator, dvi_integrator_method, with n coordinates. NULL for
 * another method, for a quadrature whose nodes are not the zeros of a polynomial known here, or
 * without memory. */
quad_step *quad_step_create(const char *method, int n);
void quad_step_destroy(quad_step **step);

/** Take a step of h from t with z = (q, p) [2 n]. v [n] is the velocity there. Returns false if the
 * iteration does not converge. The motion's mass is that of a place near by. */
bool quad_step_take(quad_step *step, quad_motion *motion, quad t, quad h, const quad *v, quad *z);
#endif

#endif
