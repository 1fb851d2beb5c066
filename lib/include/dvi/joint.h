/** Joints between bodies and the ground, as ready holonomic constraints.
 *
 *  A machine is assembled once, at stored coordinates q in which all joints fit. Points and axes of
 *  joints are given in space, there. dvi_joints_create finds out where they are in the bodies, and
 *  makes a dvi_holonomic of all joints, with exact derivatives and patterns:
 *
 *      dvi_joint hinge = {.kind = DVI_HINGE, .body = {DVI_GROUND, 0}, .axis = {1, 0, 0}};
 *      dvi_joints *joints;
 *      dvi_status status = dvi_joints_create(&factor, 1, &hinge, 1, q, &joints);
 *      terms.holonomics = dvi_joints_constraints(joints);
 *      terms.holonomic_count = 1;
 *
 *  With the points a on the first body and b on the second, d = b - a, axes u of the first body and
 *  w of the second, and v, v' orthogonal to u at the first body, the rows are (Haug 1989, ch. 9)
 *
 *      ball       d = 0
 *      hinge      d = 0, v.w = 0, v'.w = 0
 *      universal  d = 0, u.w = 0
 *      slider     d.v = 0, d.v' = 0, and as a weld turns
 *      planar     d.u = 0, v.w = 0, v'.w = 0
 *      weld       d = 0, e_1.f_2 = 0, e_1.f_3 = 0, e_2.f_3 = 0 with frames e and f that coincide
 *      distance   (d.d - l^2)/2 = 0
 *
 *  All rows are quadratic in q. Joints that close a loop may be redundant
 *  (docs/mechanics/constraints.md). */
#ifndef DVI_JOINT_H
#define DVI_JOINT_H
#include <dvi/system.h>

/** The body that does not move. */
enum { DVI_GROUND = -1 };

/** Kinds of joints. */
typedef enum dvi_joint_kind {
  DVI_BALL,      /**< the bodies have a point in common: 3 rows */
  DVI_HINGE,     /**< and an axis: 5 rows */
  DVI_UNIVERSAL, /**< a point, and an axis of each, orthogonal to the other's (Cardan's): 4 rows */
  DVI_SLIDER,    /**< one slides along an axis of the other, and does not turn: 5 rows */
  DVI_PLANAR,    /**< a point of the second stays in a plane of the first, and the plane's normal is
                      one of the second, too: 3 rows */
  DVI_WELD,      /**< both move as one: 6 rows */
  DVI_DISTANCE   /**< points of both keep their distance: 1 row */
} dvi_joint_kind;

/** A joint of an assembled machine. All points and axes are those of space. */
typedef struct dvi_joint {
  const char *name; /**< copied. Used in messages (default "joint") */
  dvi_joint_kind kind;
  /** indices of two factors, or DVI_GROUND for one of them. A body is a factor DVI_SE3, or DVI_SO3,
   *  whose point 0 stays at the origin, or a point mass, DVI_RN of size 3. Points have balls and
   *  distances alone */
  int body[2];
  double at[3]; /**< the point of the joint. Of DVI_DISTANCE the point of the first body */
  double to[3]; /**< of DVI_DISTANCE alone: the point of the second body */
  /** axis of the hinge, the slider, or the first body's axis of DVI_UNIVERSAL. The normal of
   *  DVI_PLANAR. Of any length but 0 */
  double axis[3];
  double
      second_axis[3]; /**< of DVI_UNIVERSAL alone: the second body's axis, orthogonal to `axis` */
} dvi_joint;

/** Constraints of some joints. */
typedef struct dvi_joints dvi_joints;

#ifdef __cplusplus
extern "C" {
#endif

/** Make the constraints of joints.
 *
 *  @param      factors  [factor_count] those of the system, read during the call only
 *  @param      joints   [joint_count] read during the call only
 *  @param      q        [nq] the stored coordinates of the assembled machine
 *  @param[out] made     owned by the caller. Must outlive the system. NULL on failure
 *  @retval DVI_BAD_ARGUMENT a pointer is NULL, a joint is of no known kind, names no body, or one
 *                           body twice, asks a point for axes, has no axis, axes that are not
 *                           orthogonal, or points at distance 0
 *  @retval DVI_NOT_FINITE   a number is not finite
 *  @retval DVI_NO_MEMORY    memory could not be allocated */
dvi_status dvi_joints_create(const dvi_factor *factors, int factor_count, const dvi_joint *joints,
                             int joint_count, const double *q, dvi_joints **made);

/** Return the constraints, with the rows of one joint after the other, for dvi_system_terms. They
 *  belong to `joints`. NULL for NULL. */
const dvi_holonomic *dvi_joints_constraints(const dvi_joints *joints);

/** Free joints, which no system may use any more. *joints becomes NULL. */
void dvi_joints_destroy(dvi_joints **joints);

#ifdef __cplusplus
}
#endif
#endif
