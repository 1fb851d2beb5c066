/** Scalar fields on meshes: waves, their static states, and their modes.
 *
 *  A field u has a value at each vertex of a mesh, and the Lagrangian
 *
 *      L = u'.M_0 u'/2 - (d u).M_1 (d u)/2 - sum_v w_v V(x_v, u_v) + (W f + b).u
 *
 *  with the matrices of a star (dvi/forms.h): M_0 has the density and M_1 the stiffness of the
 *  material, W is M_0 without a material, w_v are its sums of rows. f is a source, and b the flux
 *  through the boundary, a du/dn with the stiffness a. In a continuum the equation of motion is
 *
 *      rho u'' = div(a grad u) - V_u + f.
 *
 *  Values on some parts of the mesh can be fixed. The others are the coordinates of a mechanical
 *  system, to which all methods of the library apply (docs/fields/waves.md; Stern 2009, sec. 1.3,
 *  3.3). */
#ifndef DVI_FIELD_H
#define DVI_FIELD_H
#include <dvi/forms.h>
#include <dvi/system.h>

/** A field. */
typedef struct dvi_field dvi_field;

/** What is known of a field on a part of the mesh. */
typedef enum dvi_condition_kind {
  DVI_FREE, /**< the flux through the boundary is given, a du/dn. 0 where nothing is said */
  DVI_FIXED /**< the values are given */
} dvi_condition_kind;

/** A condition on a part of the mesh, which is usually a part of its boundary. */
typedef struct dvi_condition {
  const char *part; /**< a part of the mesh. Copied. "boundary" and "all" are parts, too */
  dvi_condition_kind kind;
  /** The value at the point x [space], or the flux there. `normal` [space] is the outer unit
   *  normal of the boundary for a flux, and NULL for a value. Return 0, or another number for a
   *  failure. Default: 0 everywhere */
  int (*datum)(const double *x, const double *normal, double *datum, void *user);
  void *user;
} dvi_condition;

/** The density V(x, u) of a potential, at points that the field has chosen. */
typedef struct dvi_field_potential {
  /** V, its derivative V_u and its second one V_uu, [count] each, and each NULL if it is not
   *  wanted. x is [count*space], point by point, and u [count]. Return 0, or another number for a
   *  failure, as the callbacks of dvi/system.h do. Required. */
  int (*density)(int64_t count, const double *x, const double *u, double *V, double *V_u,
                 double *V_uu, void *user);
  void *user;
} dvi_field_potential;

/** What a wave consists of. Zero means the default. */
typedef struct dvi_wave_terms {
  size_t size; /**< sizeof(dvi_wave_terms) */
  /** the mesh and its materials: factor[0] is the density, factor[1] the stiffness. The field
   *  shares it. It is positive: all entries of a diagonal M_0 are above zero */
  const dvi_star *star;
  /** [conditions] Values are stronger than fluxes, and of two on a vertex the first counts. All
   *  else is free and without a flux */
  const dvi_condition *condition;
  int conditions;
  dvi_form_function *source; /**< f(x), a number. Default: 0 */
  void *source_user;
  const dvi_field_potential *potential; /**< V(x, u). Default: 0 */
} dvi_wave_terms;

/** The matrices of a field, whose rows and columns are its unknowns, the vertices that are not
 *  fixed, in their order. */
typedef enum dvi_field_operator {
  DVI_FIELD_MASS,     /**< M_0 */
  DVI_FIELD_STIFFNESS /**< K = d_0^T M_1 d_0 */
} dvi_field_operator;

/** Options of static problems. Zero means the default. */
typedef struct dvi_field_solve_options {
  size_t size; /**< sizeof(dvi_field_solve_options) */
  /** Without fixed values, the part of the right side's size that its sum may be. It is taken
   *  away, since no solution exists otherwise. Default: 1e-8 */
  double imbalance;
  double mean; /**< without fixed values, the mean of the solution by M_0. Default: 0 */
} dvi_field_solve_options;

/** What a solution took. */
typedef struct dvi_field_solve_report {
  int64_t unknowns;
  int iterations;   /**< of conjugate gradients, or of Newton's method with a potential */
  double residual;  /**< |K u - b| / |b|, or the last step of Newton's method beside u */
  double imbalance; /**< the sum of the right side beside its size. 0 with fixed values */
} dvi_field_solve_report;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a wave, or a static problem, on a mesh.
 *
 *  @retval DVI_BAD_ARGUMENT     a part is missing, or has no facet of the boundary for a flux,
 *                               every vertex is fixed, or an argument is not as described
 *  @retval DVI_SINGULAR         an entry of M_0 is zero or negative. dvi_last_error() names the
 *                               vertex
 *  @retval DVI_CALLBACK_FAILED  a datum or the source failed
 *  @retval DVI_NOT_FINITE       a datum or the source is not finite. dvi_last_error() names the
 *                               place
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_wave_create(const dvi_wave_terms *terms, dvi_field **field);

/** Release the field, and set the pointer to NULL. NULL is allowed. Systems of the field are
 *  released before. */
void dvi_field_destroy(dvi_field **field);

/** Return the degree k of a field's form: 0 for a wave, and 1 for most of Maxwell's fields
 *  (dvi/maxwell.h). What is [vertices] here is [k-cells] then. */
int dvi_field_degree(const dvi_field *field);

/** Return the star of a field, owned by the field. */
const dvi_star *dvi_field_star(const dvi_field *field);

/** Return the vertices [unknowns] that are not fixed, ascending, and their number. Owned by the
 *  field. */
const int *dvi_field_unknowns(const dvi_field *field, int64_t *unknowns);

/** Give a matrix of a field, [unknowns] in rows and columns. Its arrays are the field's.
 *
 *  @retval DVI_BAD_ARGUMENT  there is no such operator */
dvi_status dvi_field_matrix(const dvi_field *field, dvi_field_operator name, dvi_matrix *matrix);

/** Return the right side [unknowns] of the static problem K u = W f + b, with what the fixed values
 *  add to it. Owned by the field. */
const double *dvi_field_load(const dvi_field *field);

/** Solve the static problem, K u + w V_u(u) = W f + b, for the values u.
 *
 *  Without a potential the problem is linear. With one it is solved by Newton's method from u.
 *
 *  @param[in]     options  NULL for the defaults
 *  @param[in,out] u        [vertices] the start, which counts with a potential alone, and then the
 *                          solution with its fixed values. Unchanged on failure
 *  @param[out]    report   may be NULL
 *  @retval DVI_UNSUPPORTED    the field is Maxwell's
 *  @retval DVI_BAD_ARGUMENT   no value is fixed, and the right side's sum is not zero, so that no
 *                             solution exists. dvi_last_error() has the sum
 *  @retval DVI_SINGULAR       K is not positive definite
 *  @retval DVI_CALLBACK_FAILED, DVI_CALLBACK_RETRY  the potential returned a negative number, or a
 *                             positive one
 *  @retval DVI_NOT_FINITE     a derivative of the potential, or the solution, is not finite
 *  @retval DVI_NOT_CONVERGED  an iteration stopped above its tolerance
 *  @retval DVI_NO_MEMORY      there is no memory */
dvi_status dvi_field_solve(const dvi_field *field, const dvi_field_solve_options *options,
                           double *u, dvi_field_solve_report *report);

/** Compute eigenvalues of K x = lambda M x, the nearest to a shift (default: 0) that are not zero.
 *  A potential takes no part in them.
 *
 *  @param[in]  options     NULL for the defaults
 *  @param[out] eigenvalue  [count] ascending. The angular frequencies are their square roots
 *  @param[out] mode        [count][vertices] with x.M x = 1. May be NULL
 *  @param[out] zeros       number of zero eigenvalues, which are left out: the components of the
 *                          mesh without fixed values. May be NULL
 *  @retval (others)        as dvi_matrix_modes */
dvi_status dvi_field_modes(const dvi_field *field, const dvi_modes_options *options,
                           double *eigenvalue, double *mode, int64_t *zeros);

/** Bound the largest angular frequency from above, within 0.1 percent: the square root of the
 *  largest eigenvalue of M^-1 K. Verlet's method is stable with steps below 2/omega. The field
 *  keeps it.
 *
 *  @retval (others)  as dvi_matrix_modes */
dvi_status dvi_field_fastest(const dvi_field *field, double *omega);

/** Create the mechanical system of a field, whose coordinates are the unknowns.
 *
 *  It has the mass M_0, the potential "elastic" u.K u/2 - (W f + b).u with the fixed values in u,
 *  quadratic, with its largest frequency and marked as fast, and the potential "density", the sum
 *  of w V over the unknowns. On a mesh with equal surroundings of all vertices, a linear wave has
 *  the symmetries "momentum_x" and so on, of translations along the axes that repeat themselves,
 *  -p.D u with the central difference D. It is positive for waves that run along the axis, as the
 *  momentum of a density is. With the spectral star it has none.
 *
 *  @param[out] system  owned by the caller, for dvi_system_destroy before the field's end
 *  @retval (others)    as dvi_system_create and dvi_field_fastest */
dvi_status dvi_field_system(dvi_field *field, dvi_system **system);

/** Give the terms from which dvi_field_system makes a system, to add others to them. Their arrays
 *  are the field's.
 *
 *  @retval (others)  as dvi_field_fastest */
dvi_status dvi_field_system_terms(dvi_field *field, dvi_system_terms *terms);

/** Give all values u [vertices] from those of the unknowns q, and the fixed ones.
 *
 *  @retval DVI_BAD_ARGUMENT  an argument is missing */
dvi_status dvi_field_lift(const dvi_field *field, const double *q, double *u);

/** Give the coordinates q and the momenta p = M_0 u' [unknowns] of values u and rates u'
 *  [vertices]. Rates of fixed vertices are taken as 0, and their values are the field's.
 *
 *  @param u, rate  each may be NULL for 0
 *  @param q, p     each may be NULL
 *  @retval DVI_BAD_ARGUMENT  an argument is missing */
dvi_status dvi_field_project(const dvi_field *field, const double *u, const double *rate, double *q,
                             double *p);

/** Find the n-cell that contains a point. Of several that share it, the one with the lowest number
 *  in the whole mesh is taken. Called on all processes that share the field.
 *
 *  @param[in]  at      [space] the point
 *  @param[out] cell    its number, or -1 where the share of this process has it not
 *  @param[out] weight  as that of dvi_mesh_locate, if the cell is here
 *  @retval DVI_BAD_ARGUMENT  the point lies outside, or an argument is missing
 *  @retval (others)          as dvi_mesh_locate, on all processes */
dvi_status dvi_field_locate(const dvi_field *field, const double *at, int *cell, double *weight);

/** Give a number of a vertex or an edge. Return 0, or another number for a failure. */
typedef int dvi_field_term(int64_t cell, double *term, void *user);

/** Add up numbers of the field's cells, which are vertices or edges, exactly, and round the sum
 *  once. On a share all processes call this, and have the sum over all of them. The owner of a cell
 *  gives its number.
 *
 *  @param cell  [count] for a sum over some of the cells of this mesh; NULL for all. Cells of other
 *               owners are passed over
 *  @retval DVI_BAD_ARGUMENT     an argument is missing
 *  @retval DVI_CALLBACK_FAILED  `term` failed on one of the processes
 *  @retval DVI_NOT_FINITE       the sum is not finite */
dvi_status dvi_field_sum(const dvi_field *field, int64_t count, const int *cell,
                         dvi_field_term *term, void *user, double *sum);

#ifdef __cplusplus
}
#endif
#endif
