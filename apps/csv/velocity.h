/** The velocity of a state whose coordinates may have left their manifold. */
#ifndef VELOCITY_H
#define VELOCITY_H
#include "problem.h"

/** Compute the velocity of the nearest state on the manifold, for a system with factors, q [nq] and
 * p [nv].
 *
 *  @param      room  [nq + nv]
 *  @param[out] v     [nv] */
dvi_status velocity_near(const problem *scene, double t, const double *q, const double *p,
                         double *room, double *v);
#endif
