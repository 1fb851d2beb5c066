/** Fields of rotations R(t,x) in SO(3), on an interval, a box or a torus: chiral models, rods whose
 *  sections turn, and lattices of bodies.
 *
 *  With the body's angular velocity Omega, R_t = R Omega^, and the bending kappa_d along the axis
 *  d, R_d = R kappa_d^, the Lagrangian density is
 *
 *      l = Omega.J Omega/2 - sum_d kappa_d.K_d kappa_d/2 - V(x, R).
 *
 *  The field has a rotation at each node of a grid. Differences along an axis are rotations, too,
 *  G = R_a^T R_{a+1}, and the sum over edges of tr((I - G) (tr(K)/2 I - K)), times the area of an
 *  edge over its length, stands for the bending. With a method on rotations, such as lie-verlet,
 *  differences along both space and time are elements of the group, so that rotations stay
 *  rotations and the total angular momentum is conserved (Leok 2004, sec. 5.1; Demoures and others
 *  2015). */
#ifndef DVI_ROTATIONS_H
#define DVI_ROTATIONS_H
#include <dvi/space.h>
#include <dvi/system.h>

/** A field of rotations. It never changes after its creation. */
typedef struct dvi_rotations dvi_rotations;

/** A potential V(x, R), per volume, and its ordinary derivatives in the nine entries of R. */
typedef struct dvi_rotations_potential {
  /** V, V_R [9] and V_RR [81], each NULL if it is not wanted, at the point x [axes] and for the
   *  rotation R [9], row by row. Returns as the callbacks of dvi/system.h do. Required */
  int (*density)(const double *x, const double *R, double *V, double *V_R, double *V_RR,
                 void *user);
  void *user;
} dvi_rotations_potential;

/** What a field of rotations consists of. Zero means the default. */
typedef struct dvi_rotations_terms {
  size_t size;             /**< sizeof(dvi_rotations_terms) */
  const dvi_axis *axis;    /**< [axes] the kind and the nodes of dvi_axis do not matter */
  int axes;                /**< 1 to DVI_AXES_MAX */
  const int *cells;        /**< [axes] equal cells along each axis, 3 or more if it is periodic */
  const double *inertia;   /**< [9] J per volume, that of a body. Copied */
  const double *stiffness; /**< [axes*9] K_d, symmetric. Copied */
  /** [2*axes] not 0 for an end, lower and upper, at which R is held. Default: free ends */
  const int *is_clamped;
  /** Gives R [9] that is held at the point x [axes] of an end. Returns 0, or another number for a
   *  failure. Required with clamped ends */
  int (*held)(const double *x, double *R, void *user);
  void *user;
  const dvi_rotations_potential *potential; /**< default: none */
} dvi_rotations_terms;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a field of rotations.
 *
 *  @retval DVI_BAD_ARGUMENT     an axis, a number of cells, an inertia or a stiffness is not as
 *                               described, all nodes are held, or a held R is no rotation
 *  @retval DVI_BAD_SIZE         an int cannot count the entries of the rotations
 *  @retval DVI_CALLBACK_FAILED  `held` failed
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_rotations_create(const dvi_rotations_terms *terms, dvi_rotations **field);

/** Release the field, and set the pointer to NULL. NULL is allowed. Systems of it are released
 *  before. */
void dvi_rotations_destroy(dvi_rotations **field);

/** Return the number of free nodes, whose rotations are the coordinates, nine for each. The points
 *  x [nodes*axes], node by node with the first axis running slowest, and the volumes [nodes] are
 *  the field's. Each pointer may be NULL. 0 for NULL. */
int64_t dvi_rotations_nodes(const dvi_rotations *field, const double **x, const double **volume);

/** Give the terms of the field's system, whose factors are the rotations, with a velocity Omega and
 *  a momentum P = volume J Omega for each. The potential "bending" is quadratic, and "potential" is
 *  V. Without V and held ends there are the momenta "momentum_x", "momentum_y" and "momentum_z",
 *  the sum of R P. Arrays are the field's. */
dvi_status dvi_rotations_system_terms(const dvi_rotations *field, dvi_system_terms *terms);

/** Create the system of the field.
 *
 *  @param[out] system  owned by the caller, for dvi_system_destroy before the field's end
 *  @retval (others)    as dvi_system_create */
dvi_status dvi_rotations_system(const dvi_rotations *field, dvi_system **system);

#ifdef __cplusplus
}
#endif
#endif
