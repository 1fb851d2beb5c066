/** Regge calculus: spaces of flat simplices, whose edges have lengths and whose curvature is at the
 *  hinges, the faces of dimension n - 2.
 *
 *  A complex of n-simplices, n = 3 or 4, has the action
 *
 *      S = sum_h |h| eps_h - Lambda V,    dS/dl_e = sum_h eps_h d|h|/dl_e - Lambda dV/dl_e,
 *
 *  where |h| is the volume of hinge h, the deficit eps_h is 2 pi less the dihedral angles at h,
 *  and V is the volume of all simplices. At hinges of the boundary pi stands for 2 pi (Hartle and
 *  Sorkin 1981). S is the value of 1/2 int (R - 2 Lambda). The changes of the angles drop out of
 *  dS/dl_e, because sum_h |h| d eps_h = 0 (Schlaefli's identity; Regge 1961). Signature is
 *  Euclidean, but for dvi_regge_universe. docs/fields/regge.md has more. */
#ifndef DVI_REGGE_H
#define DVI_REGGE_H
#include <dvi/mesh.h>

/** A complex with its action. It never changes after its creation. Any number of threads may use
 *  it. */
typedef struct dvi_regge dvi_regge;

/** What a complex consists of. Zero means the default. */
typedef struct dvi_regge_terms {
  size_t size;          /**< sizeof(dvi_regge_terms) */
  const dvi_mesh *mesh; /**< tetrahedra or 4-simplices, closed or with a boundary. Shared */
  double lambda;        /**< Lambda, the cosmological constant. Default: 0 */
} dvi_regge_terms;

/** What the lengths of a complex say. */
typedef struct dvi_regge_measures {
  double action;                   /**< S */
  double volume;                   /**< V */
  int64_t hinges, boundary_hinges; /**< all, and those of the boundary */
  double deficit_min, deficit_max; /**< of inner hinges. 0 if there is none */
  double gradient_max;             /**< largest |dS/dl_e| of edges off the boundary */
  /** largest |sum_h |h| d eps_h/dl_e| of an edge, divided by the sum of the terms' sizes, which is
   *  0 but for roundings */
  double schlaefli;
  double length_min, length_max;
} dvi_regge_measures;

/** How lengths are made stationary. Zero means the default. */
typedef struct dvi_regge_options {
  size_t size;        /**< sizeof(dvi_regge_options) */
  const int8_t *held; /**< [edges] not 0 for lengths that stay. Default: those of the boundary */
  int iterations;     /**< at most. Default: 100 */
} dvi_regge_options;

/** How it went. */
typedef struct dvi_regge_report {
  int iterations;   /**< Hessians that were factored */
  double residual;  /**< largest |dS/dl_e| of a length that is not held */
  double action;    /**< S at the end */
  int64_t unknowns; /**< lengths that are not held */
  /** Directions of the unknowns along which the gradient does not change. Near flat solutions they
   *  are the moves of inner vertices, n for each. No step goes along them, which is how the gauge
   *  is fixed */
  int64_t null_directions;
  /** log2 of |det(H + 2 i delta)/det(H + i delta)| with the Hessian H of the unknowns, and delta
   *  1e-7 of its largest entry. Null directions add 1, and others of eigenvalues lambda about
   *  2 (delta/lambda)^2. Rounded it is null_directions. If it is not near a whole number, the gauge
   *  freedom is broken a little, and some directions are determined poorly */
  double softness;
} dvi_regge_report;

/** A universe whose spatial sections are all alike. Zero means the default. */
typedef struct dvi_regge_universe_options {
  size_t size;   /**< sizeof(dvi_regge_universe_options) */
  double strut;  /**< m > 0, the length of the edges between two sections */
  int steps;     /**< number of layers between sections, at least 1 */
  int euclidean; /**< not 0 for struts that are lengths. Default: proper times */
} dvi_regge_universe_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a complex.
 *
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, Lambda is not finite, or a facet has more than
 *                            two simplices
 *  @retval DVI_UNSUPPORTED   the mesh has no tetrahedra or 4-simplices. A surface's action does not
 *                            depend on its lengths (Gauss and Bonnet)
 *  @retval DVI_BAD_SIZE      an int cannot number the entries of the Hessian
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_regge_create(const dvi_regge_terms *terms, dvi_regge **regge);

/** Release the complex, and set the pointer to NULL. NULL is allowed. */
void dvi_regge_destroy(dvi_regge **regge);

/** Return the mesh, owned by the complex. */
const dvi_mesh *dvi_regge_mesh(const dvi_regge *regge);

/** Give the lengths [edges] that the mesh's points have in Euclidean space.
 *
 *  @retval DVI_BAD_ARGUMENT  an argument is missing */
dvi_status dvi_regge_lengths(const dvi_regge *regge, double *length);

/** Compute the action and its gradient.
 *
 *  @param      length    [edges] of the mesh's edges, in their order
 *  @param[out] action    S. May be NULL
 *  @param[out] gradient  [edges] dS/dl_e. May be NULL
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, a length is not 1e-60 to 1e60, or lengths
 *                            violate the inequality of a triangle, a tetrahedron or a 4-simplex.
 *                            dvi_last_error() names that simplex, its vertices and its lengths
 *  @retval DVI_NOT_FINITE    Lambda is so large that numbers overflow
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_regge_action(const dvi_regge *regge, const double *length, double *action,
                            double *gradient);

/** Compute the Hessian of the action by the lengths, symmetric and sparse: edges of one n-simplex
 *  are coupled.
 *
 *  @param[out] hessian  for dvi_matrix_destroy. NULL after a failure
 *  @retval (others)     as dvi_regge_action */
dvi_status dvi_regge_hessian_create(const dvi_regge *regge, const double *length,
                                    dvi_matrix **hessian);

/** Compute volumes and deficits of the hinges, which are the mesh's cells of degree n - 2.
 *
 *  @param[out] volume   [hinges] |h|. May be NULL
 *  @param[out] deficit  [hinges] eps_h, with pi for 2 pi at the boundary. May be NULL
 *  @retval (others)     as dvi_regge_action */
dvi_status dvi_regge_hinges(const dvi_regge *regge, const double *length, double *volume,
                            double *deficit);

/** Compute all measures at once.
 *
 *  @retval (others)  as dvi_regge_action */
dvi_status dvi_regge_measure(const dvi_regge *regge, const double *length,
                             dvi_regge_measures *measures);

/** Make the action stationary in the lengths that are not held, by KINSOL's Newton method with line
 *  search, with the sparse Hessian H and steps of least norm, -H (H^2 + delta^2)^{-1} dS/dl, delta
 *  = 1e-7 of H's largest entry or more. Steps are shortened until all simplices exist and the
 *  gradient falls. If no length is held, all are first multiplied by the number that makes the
 *  action stationary.
 *
 *  @param[in]     options  NULL for the defaults
 *  @param[in,out] length   [edges] a guess, and the solution. Unchanged after a failure
 *  @param[out]    report   may be NULL. Set also if the iteration does not converge
 *  @retval DVI_BAD_ARGUMENT   as dvi_regge_action, or all lengths are held, or those of the size
 *                             that Lambda gives are out of range
 *  @retval DVI_NOT_CONVERGED  the gradient falls no more, or not fast enough. dvi_last_error()
 *                             names the simplex that stops it, if one does
 *  @retval DVI_SINGULAR       the Hessian vanishes
 *  @retval DVI_NO_MEMORY      there is no memory */
dvi_status dvi_regge_solve(const dvi_regge *regge, const dvi_regge_options *options, double *length,
                           dvi_regge_report *report);

/** Let a closed universe expand from its moment of rest. All edges of section i have the length
 *  l_i, and struts of length m join the vertices of sections i and i + 1 (Collins and Williams
 *  1973).
 *
 *  The action S(l_i, l_{i+1}, m) of the layer, whose cells are frusta of regular tetrahedra, is a
 *  discrete Lagrangian. p_i = -D_1 S and p_{i+1} = D_2 S give the lengths from p_0 = 0 on. The
 *  struts are the lapse, which is a choice of gauge. Their equation dS/dm = 0, the constraint,
 *  holds up to errors of order 2 in m.
 *
 *  @param      regge       its mesh is the sections: closed, of tetrahedra, with equally many at
 *                          each edge, Lambda > 0
 *  @param[out] length      [steps+1] l_i
 *  @param[out] constraint  [steps] dS/dm of each layer, over the volume's part of it. May be NULL
 *  @retval DVI_BAD_ARGUMENT    an argument is missing or out of range
 *  @retval DVI_UNSUPPORTED     the mesh is not as described
 *  @retval DVI_STEP_TOO_LARGE  a layer does not exist: its equation has no solution. The lengths
 *                              before it are set, those behind it are 0 */
dvi_status dvi_regge_universe(const dvi_regge *regge, const dvi_regge_universe_options *options,
                              double *length, double *constraint);

#ifdef __cplusplus
}
#endif
#endif
