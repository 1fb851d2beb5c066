/** A motion in quadruple precision: a scene's Lagrangian, and its exact flow. */
#ifndef QUAD_MOTION_H
#define QUAD_MOTION_H
#include <dvi/scene.h>

#include "mechanics/quad.h"

#ifdef QUAD_EXISTS
/** The Lagrangian, and the mass at a place. */
typedef struct quad_motion {
  const dvi_scene *scene;
  int n;
  quad *inverse; /**< [n][n] of L_vv where quad_motion_settle was last called, to a dozen digits */
  quad *tracked; /**< [n][n] the same, as Broyden's method follows it along a flow */
  double q_size, p_size; /**< what distances of q and of p are relative to; 1 at first */
  quad *room;            /**< what is worked in */
  dvi_pair *pair;        /**< [4 n] */
} quad_motion;

/** Take the Lagrangian of a scene of n coordinates. False: no memory. To be cleared either way. */
bool quad_motion_init(quad_motion *motion, const dvi_scene *scene, int n);
void quad_motion_clear(quad_motion *motion);

/** The Lagrangian's derivatives; false if there are none at that point. */
bool quad_motion_gradient(quad_motion *motion, quad t, const quad *q, const quad *v, quad *L_q,
                          quad *L_v);

/** Find the mass there, for what follows near that place; false if it has no inverse. */
bool quad_motion_settle(quad_motion *motion, quad t, const quad *q, const quad *v);

/** Solve p = L_v(t,q,v) for v [n], whose value is the guess. */
bool quad_motion_velocity(quad_motion *motion, quad t, const quad *q, const quad *p, quad *v);

/** Advance z = (q, p) [2 n] from t by `span`, along the solution. v [n]: a guess of the velocity.
 *  *error: the error that is wanted, then how far apart the last two results of ever more steps
 * are. */
bool quad_motion_flow(quad_motion *motion, quad t, quad span, const quad *v, quad *z,
                      double *error);

/** The distance of two states (q, p) [2 n], relative to the motion's sizes. */
double quad_motion_distance(const quad_motion *motion, const quad *z, const quad *other);
#endif

#endif
