/** Multisymplectic Galerkin integrators: fields on a lattice of cells in space and time.
 *
 *  In a cell, a box times a step, the field is the multilinear function of its values at the
 *  corners, and the action of the cell is a product quadrature of the density l(t, x, u, u_t, d u).
 *  Each axis, and time, has two points at the distances sqrt(1 - 4 a)/2 of the cell's length d from
 *  its middle, so that the mass of the values at its ends is
 *
 *      d [[1/2 - a, a], [a, 1/2 - a]]
 *
 *  with a weight a from 0 to 1/4: 0 is the trapezoidal rule (the ends), 1/4 the midpoint (the box
 *  scheme), 1/6 Gauss's rule, exact for quadratic densities, and 1/12 has order 4 for quadratic
 *  densities with constant coefficients. All others have order 2. The values make the sum of all
 *  cells' actions stationary. At a vertex this is the discrete Euler-Lagrange equation, a sum over
 *  the 2^(axes+1) cells around it, and gives the next level from two others.
 *
 *  The steps conserve the multisymplectic form, and with it what belongs to each symmetry of the
 *  density that acts on the values by a linear map (Marsden, Patrick and Shkoller 1998; Leok 2004,
 *  sec. 5.1.3; docs/fields/multisymplectic.md).
 *
 *  Steps are explicit if all weights are 0. Otherwise the equations of a level are solved by
 *  Newton's method with a matrix that is kept as long as it serves, and which is factored once if
 *  all is quadratic that is not at the levels. */
#ifndef DVI_MULTISYMPLECTIC_H
#define DVI_MULTISYMPLECTIC_H
#include <dvi/density.h>
#include <dvi/march.h>

/** Weights a of the axes and of time, 0 to 1/4. Zero is the trapezoidal rule. */
typedef struct dvi_multisymplectic_weights {
  double space[DVI_AXES_MAX];
  double time;
  /** not 0 to take potentials (DVI_DENSITY_POTENTIAL) at the levels, by the trapezoidal rule in
   *  time, so that their forces are known before a step, and the matrix of the steps is constant */
  int levels;
  /** number of axes that the weights are of, which must be that of the lattice. 0 for any */
  int axes;
} dvi_multisymplectic_weights;

/** A symmetry of the density: l does not change if u moves along xi(u). */
typedef struct dvi_multisymplectic_symmetry {
  const char *name; /**< of what is conserved, an observable of the march. Copied */
  /** xi [components*count] at values u [components*count], component by component. Linear with a
   *  constant. Returns 0, or another number for a failure */
  int (*field)(int64_t count, const double *u, double *xi, void *user);
  void *user;
} dvi_multisymplectic_symmetry;

/** What a march on a lattice consists of. Zero means the default. */
typedef struct dvi_multisymplectic_terms {
  size_t size; /**< sizeof(dvi_multisymplectic_terms) */
  /** [axes] With nodes, these are the ends of the cells. An axis needs no kind */
  const dvi_axis *axis;
  int axes;                /**< 1 to DVI_AXES_MAX */
  int cells[DVI_AXES_MAX]; /**< equal cells of each axis without nodes, at least 2 */
  int components;          /**< 1 to DVI_COMPONENTS_MAX */
  /** [parts] of the density, whose variables are values, rates and first derivatives along one
   *  axis. DVI_DENSITY_ONE_FORM is refused */
  const dvi_density_part *part;
  int parts;
  /** [conditions] of parts of the boundary: "left", "right" (first axis), "bottom", "top", "back",
   *  "front", "boundary". Of two values the first counts. Fluxes add up */
  const dvi_density_condition *condition;
  int conditions;
  dvi_multisymplectic_weights weights;
  double step;     /**< the step, above 0. Default: `fraction` of the largest stable one */
  double fraction; /**< of the largest stable step, at most 1. Default: 0.5 */
  double span;     /**< with a fraction, a whole number of steps makes this span */
  /** not 0 if E of a start is minus the mean rate over the first step, (u(t) - u(t+dt))/dt: both
   *  first levels are known. Default: the rate at t, from which the first step is made with an
   *  error of O(dt^3) */
  int mean_rate;
  const dvi_multisymplectic_symmetry *symmetry; /**< [symmetries] */
  int symmetries;
} dvi_multisymplectic_terms;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a march on a lattice.
 *
 *  Its forms are A, the values u [components*vertices], and E = -u_t. Vertices are numbered with
 *  the first axis running slowest, without the last one of a periodic axis. Between levels the
 *  values are those of the parabola through three levels. The observables are
 *
 *  - "energy" of the row of cells behind the time: 2 e(middle) - (mean of e over the points in
 *    time), with e = u_t l_{u_t} - l. It is constant but for roundings if l is quadratic and does
 *    not depend on t,
 *  - "momentum_x" and so on, of each periodic axis, -sum p (u_{i+1} - u_{i-1})/(x_{i+1} - x_{i-1})
 *    with the momenta p of the level: constant likewise if the coefficients and cells are, too,
 *  - those of the symmetries, sum p.xi(u), constant but for roundings and the equations' errors.
 *
 *  Stable steps fulfil, for l = u_t^2/2 - sum_d c^2 u_d^2/2,
 *
 *      sum_d c^2 dt^2/dx_d^2/(1 - 4 a_d) <= 1/(1 - 4 a_t).
 *
 *  In general it is dt^2 lambda <= 4/(1 - 4 a_t) with the largest eigenvalue lambda of stiffness
 *  against mass in a cell, which bounds that of the lattice. It is found from the constant second
 *  derivatives of l and from springs at the boundary (robin). Those that vary do not count. a_t =
 *  1/4 is stable for all steps.
 *
 *  @retval DVI_BAD_ARGUMENT     an argument is not as described. A step is beyond the bound, which
 *                               dvi_last_error() has. A mass has a zero mode: a weight 1/4 in space
 *                               with an even number of periodic cells, or without a fixed end
 *  @retval DVI_BAD_SIZE         a count is out of range
 *  @retval DVI_UNSUPPORTED      the density has other variables, or a part is a one-form
 *  @retval DVI_SINGULAR         the kinetic part is not positive definite, or the steps' matrix is
 *                               singular
 *  @retval DVI_CALLBACK_FAILED  a callback failed
 *  @retval DVI_NOT_FINITE       a coefficient is not finite
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_multisymplectic_create(const dvi_multisymplectic_terms *terms, dvi_march **march);

/** Return the number of vertices, and their places x [axes*vertices] axis by axis, unless it is
 *  NULL. 0 if the axes or cells are not as described. */
int64_t dvi_multisymplectic_vertices(const dvi_multisymplectic_terms *terms, double *x);

/** Measure the laws of a density on a lattice, along a motion and two motions beside it that begin
 *  at random.
 *
 *  - "multisymplectic": for a random set of cells in space and time, whose action has the second
 *    derivative H, and solutions V and W of the linearised equations, the sum of W.H V - V.H W over
 *    the vertices of the set that touch cells outside of it, which is zero.
 *  - "linearised": H V at the other vertices, likewise.
 *  - "noether": the sum of xi(u) times the action's derivative over the former vertices, of the
 *    worst symmetry. Left out without symmetries.
 *  - "energy" and "momentum": of the box scheme (all weights 1/4) the sums over axes n of
 *    D_n[z_m l_{z_n} - (n = m) l] around each vertex, with m time, or the worst axis in space. They
 *    vanish for quadratic l with constant coefficients and equal cells. Left out for other weights.
 *
 *  @param      start  of the motion. NULL for one at random, of size 1
 *  @param      steps  at least 2
 *  @param      seed   of all that is at random
 *  @param[out] law    [DVI_LAWS_MAX] errors are beside the sizes of the terms
 *  @param[out] count  number of laws
 *  @retval (others)   as dvi_multisymplectic_create and dvi_march_advance */
dvi_status dvi_multisymplectic_laws(const dvi_multisymplectic_terms *terms,
                                    const dvi_march_state *start, int steps, uint64_t seed,
                                    dvi_law *law, int *count);

/** Read a method with its weights: "multisymplectic", "multisymplectic:space=1/6,time=midpoint".
 *  `space`, of all axes, and `time` are numbers, fractions or the words trapezoid (0, the default),
 *  midpoint (1/4), exact (1/6) and fourth (1/12). "space=1/6:0" has a weight for each axis, in
 *  their order. potential=levels takes potentials at the levels.
 *
 *  @param[out] weights  unchanged on failure
 *  @retval DVI_BAD_OPTION    it is another method, or has another option or value
 *  @retval DVI_BAD_ARGUMENT  an argument is missing */
dvi_status dvi_multisymplectic_parse(const char *method, dvi_multisymplectic_weights *weights);

#ifdef __cplusplus
}
#endif
#endif
