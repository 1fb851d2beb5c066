/** A motion in quadruple precision, with a scene's Lagrangian and its exact flow. */
#ifndef QUAD_MOTION_H
#define QUAD_MOTION_H
#include <dvi/scene.h>

#include "mechanics/quad.h"

#ifdef QUAD_EXISTS
/** The Lagrangian, and the mass at a place. */
typedef struct quad_motion {
  const dvi_scene *scene;
  int n;
  quad *inverse; /**< [n][n] inverse of L_vv at the last quad_motion_settle, to a dozen digits */
  quad *tracked; /**< [n][n] the inverse as Broyden's method updates it along a flow */
  double q_size, p_size; /**< sizes that distances of q and of p are relative to, at first 1 */
  quad *room;            /**< working memory */
  dvi_pair *pair;        /**< [4 n] */
} quad_motion;

/** Take the Lagrangian of a scene of n coordinates. Returns false without memory. Clear it in
 * either case. */
bool quad_motion_init(quad_motion *motion, const dvi_scene *scene, int n);
void quad_motion_clear(quad_motion *motion);

/** Evaluate the Lagrangian's derivatives. Returns false if there are none at that point. */
bool quad_motion_gradient(quad_motion *motion, quad t, const quad *q, const quad *v, quad *L_q,
                          quad *L_v);

/** Compute the mass at a point, for later calls near that place. Returns false if it has no
 * inverse. */
bool quad_motion_settle(quad_motion *motion, quad t, const quad *q, const quad *v);

/** Solve p = L_v(t,q,v) for v [n], whose value is the guess. */
bool quad_motion_velocity(quad_motion *motion, quad t, const quad *q, const quad *p, quad *v);

/** Advance z = (q, p) [2 n] from t by `span`, along the solution. v [n] is a guess of the velocity.
 * *error is the wanted error on entry, and on return the distance of the last two results with ever
 * more steps. */
bool quad_motion_flow(quad_motion *motion, quad t, quad span, const quad *v, quad *z,
                      double *error);

/** Return the distance of two states (q, p) [2 n], relative to the motion's sizes. */
double quad_motion_distance(const quad_motion *motion, const quad *z, const quad *other);
#endif

#endif
