/** Steps of Galerkin variational integrators in quadruple precision, from their definition. */
#ifndef QUAD_STEP_H
#define QUAD_STEP_H
#include "mechanics/quad_motion.h"

#ifdef QUAD_EXISTS
/** A degree and a quadrature. */
typedef struct quad_step quad_step;

/** Read what a galerkin integrator calls itself, dvi_integrator_method. NULL: another method, a
 *  quadrature without a polynomial whose zeros it has, or no memory. n: coordinates. */
quad_step *quad_step_create(const char *method, int n);
void quad_step_destroy(quad_step **step);

/** Take a step of h from t with z = (q, p) [2 n]; v [n]: the velocity there. False if the iteration
 *  does not converge. The motion's mass is that of a place near by. */
bool quad_step_take(quad_step *step, quad_motion *motion, quad t, quad h, const quad *v, quad *z);
#endif

#endif
