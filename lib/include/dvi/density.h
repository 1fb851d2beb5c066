/** Fields with a Lagrangian density, on a function space.
 *
 *  A field of some components, u_c(t,x) = sum_i U_ci(t) phi_i(x), has the action
 *
 *      S = int dt L,    L = sum over quadrature points x_k of w_k l(t, x_k, u, u', d u, ..)
 *
 *  with a density l of the components, their rates, and derivatives of both in space. l is a sum of
 *  parts, of which each says how it depends on the field. L is the Lagrangian of a mechanical
 *  system whose coordinates are the coefficients U_ci that the boundary leaves free, so that all
 *  methods of the library apply (Leok 2004, sec. 5.1; docs/fields/densities.md). */
#ifndef DVI_DENSITY_H
#define DVI_DENSITY_H
#include <dvi/field.h>
#include <dvi/space.h>

/** A field with a density. It never changes after its creation. */
typedef struct dvi_density dvi_density;

enum {
  DVI_COMPONENTS_MAX = 16, /**< components of a field */
  DVI_JETS_MAX = 64        /**< variables of a part */
};

/** A variable of a density: a derivative of a component in space, or the rate of one. */
typedef struct dvi_jet {
  int component;
  int rate;                /**< not 0 for the rate in time */
  int order[DVI_AXES_MAX]; /**< derivatives along each axis */
} dvi_jet;

/** How a part of a density depends on the field. All parts are parts of l, so that an energy comes
 *  with a minus sign. */
typedef enum dvi_density_kind {
  DVI_DENSITY_KINETIC,   /**< a quadratic form of rates whose coefficients depend on x alone */
  DVI_DENSITY_QUADRATIC, /**< at most quadratic, without rates. Only linear terms depend on t */
  DVI_DENSITY_POTENTIAL, /**< any function without rates */
  DVI_DENSITY_ONE_FORM,  /**< linear in rates, without t. The field is of first order then */
  DVI_DENSITY_GENERAL    /**< any function */
} dvi_density_kind;

/** A part of a density. */
typedef struct dvi_density_part {
  const char *name; /**< copied. In messages, and of the potential. Default: of the kind */
  dvi_density_kind kind;
  const dvi_jet *variable; /**< [variables] all different. Copied */
  int variables;
  /** [pairs] the variables a >= b by which there are second derivatives. Default (NULL): all of
   *  them, row by row of the lower triangle. Not NULL with 0 pairs: there are none. Copied */
  const int (*pair)[2];
  int pairs;
  /** l [count], its derivatives l_z [variables*count] and second ones l_zz [pairs*count], variable
   *  by variable. Each may be NULL. x is [dimension*count] axis by axis, z [variables*count].
   *  Several threads may call at a time. Returns as the callbacks of dvi/system.h do. Required */
  int (*density)(int count, double t, const double *x, const double *z, double *l, double *l_z,
                 double *l_zz, void *user);
  /** l_t [count], the derivative in time alone. Default: the part does not depend on t, or methods
   *  for which time is an unknown refuse the field */
  int (*time_derivative)(int count, double t, const double *x, const double *z, double *l_t,
                         void *user);
  void *user;
  int depends_on_time; /**< not 0 if l depends on t. Kinetic parts do not */
} dvi_density_part;

/** What is known at a part of the boundary. */
typedef struct dvi_density_condition {
  const char *part; /**< as in dvi_space_boundary. Copied */
  int component;    /**< -1 for all */
  dvi_condition_kind kind;
  /** The value, or the flux g that adds g u to l on the boundary, [count] at points x axis by axis.
   *  With `rate`, as a function of time; otherwise it is that of t = 0. Default: 0 */
  int (*datum)(int64_t count, double t, const double *x, double *datum, void *user);
  /** the first and second derivatives in time [count] of a value that moves. The second one may be
   *  NULL. Default: the value does not move */
  int (*rate)(int64_t count, double t, const double *x, double *rate, double *second, void *user);
  double robin; /**< of DVI_FREE: a adds -a u^2/2 to l on the boundary */
  void *user;
} dvi_density_condition;

/** A translation in space or another symmetry of the density is a symmetry of the system. */
typedef struct dvi_density_terms {
  size_t size;            /**< sizeof(dvi_density_terms) */
  const dvi_space *space; /**< shared */
  int components;         /**< 1 to DVI_COMPONENTS_MAX */
  const dvi_density_part *part;
  int parts;
  const dvi_density_condition *condition; /**< [conditions], default: all free without flux */
  int conditions;
  int translations; /**< not 0 if l does not depend on x: momenta along periodic axes are watched */
  /** bit a is 1 if l depends on the coordinate of axis a, whose momentum is then not watched */
  unsigned placed_axes;
} dvi_density_terms;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a field.
 *
 *  @retval DVI_BAD_ARGUMENT     a part of the boundary is missing, all coefficients are fixed, a
 *                               part is not of its kind, or an argument is not as described
 *  @retval DVI_SINGULAR         the mass or the two-form is singular. dvi_last_error() has a remedy
 *  @retval DVI_UNSUPPORTED      the space has no such derivative, or parts do not go together
 *  @retval DVI_CALLBACK_FAILED  a callback failed
 *  @retval DVI_NOT_FINITE       a coefficient or a datum is not finite
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_density_create(const dvi_density_terms *terms, dvi_density **density);

/** Release the field, and set the pointer to NULL. NULL is allowed. Systems of it are released
 *  before. */
void dvi_density_destroy(dvi_density **density);

/** Return the space, owned by the field. */
const dvi_space *dvi_density_space(const dvi_density *density);

/** Return the number of components. */
int dvi_density_components(const dvi_density *density);

/** Return the places [unknowns] in U [components*functions] of the coordinates, and their number.
 *  Coordinates of one function stand together. They follow the order of the functions, but on a
 *  circle of a sparse space that of 0, n-1, 1, n-2, .., where neighbours are near each other. Owned
 *  by the field. */
const int *dvi_density_unknowns(const dvi_density *density, int64_t *unknowns);

/** Give the mass or the stiffness, the Hessian of the quadratic parts with a minus sign, of the
 *  coordinates. Its arrays are the field's.
 *
 *  @retval DVI_UNSUPPORTED  the field has no such matrix */
dvi_status dvi_density_matrix(const dvi_density *density, dvi_field_operator name,
                              dvi_matrix *matrix);

/** Bound the largest angular frequency of the quadratic parts from above, within 0.1 percent.
 *
 *  @retval DVI_UNSUPPORTED  the field has no mass
 *  @retval (others)         as dvi_matrix_modes */
dvi_status dvi_density_fastest(const dvi_density *density, double *omega);

/** Estimate the largest angular frequency of small oscillations about a state at t = 0, with the
 *  Hessian of all parts without rates, those that depend on time or are not quadratic, too. Without
 *  such parts it is that of dvi_density_fastest.
 *
 *  @param      q      [unknowns] coordinates
 *  @param[out] omega  0 if nothing oscillates
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_UNSUPPORTED   the field has no mass, or its full Hessian has too many unknowns
 *  @retval (others)          as the callbacks fail */
dvi_status dvi_density_fastest_at(const dvi_density *density, const double *q, double *omega);

/** Find the least eigenvalue of the quadratic parts against the mass, if it is negative, and 0
 *  otherwise. With lambda < 0 a small field can grow as exp(sqrt(-lambda) t), and without
 *  potentials that stop it the energy is not bounded from below. Quadratic parts whose density is
 *  positive semidefinite at each point take no matrices. A negative definite mass, as of a kinetic
 *  part with a wrong sign, has the eigenvalues of both with the other sign.
 *
 *  @retval DVI_UNSUPPORTED  the field has no mass, or too many unknowns in three dimensions
 *  @retval DVI_SINGULAR     the mass is indefinite
 *  @retval (others)         as dvi_matrix_modes */
dvi_status dvi_density_least(const dvi_density *density, double *lambda);

/** Compute the eigenvalues of K x = lambda M x nearest to a shift, with K the Hessian of all parts
 *  without rates at a static state. Of a field of first order they are the eigenvalues lambda of
 *  H x = lambda N x, with N the density of the norm (docs/fields/schroedinger.md).
 *
 *  @param      U           [components*functions] the state. NULL for 0
 *  @param[out] eigenvalue  [options->count] ascending
 *  @param[out] mode        [count][components*functions] with x.M x = 1. May be NULL
 *  @retval (others)        as dvi_matrix_modes */
dvi_status dvi_density_modes(const dvi_density *density, const dvi_modes_options *options,
                             const double *U, double *eigenvalue, double *mode);

/** Solve for a static state, where the derivative of L without rates vanishes, by Newton's method
 *  from U with its fixed values.
 *
 *  @param[in,out] U       [components*functions] unchanged on failure
 *  @param[out]    report  may be NULL
 *  @retval DVI_SINGULAR       the Hessian is singular. dvi_last_error() has a remedy
 *  @retval DVI_NOT_CONVERGED  the iteration stopped above its tolerance
 *  @retval (others)           as the callbacks fail */
dvi_status dvi_density_solve(const dvi_density *density, double *U, dvi_field_solve_report *report);

/** Create the mechanical system of a field, whose coordinates are the unknowns.
 *
 *  With kinetic parts it has a constant mass, the potential "quadratic", which is fast, and one
 *  potential for each other part. With a one-form it is of first order, and with general parts a
 *  general Lagrangian. Periodic axes give momenta "momentum_x" and so on, -int u' u_x for a mass
 *  1, if the terms say so and the space keeps translations (fourier).
 *
 *  Values that move, G(t), stay in L, with a vector potential A(t) = M_ID G' of the masses M_ID
 *  between coordinates and them, unless these are 0, as lumped ones are. Where a one-form does not
 *  change with constants added to a component of which no part takes values, the first coefficient
 *  of the component stays 0.
 *
 *  A part with a potential has a full Hessian on fourier, which is declared for up to 300
 *  coordinates. Above it is without_hessian. Coefficients of quadratic parts on fourier that vary
 *  in x leave a potential beside that of their means.
 *
 *  @param[out] system  owned by the caller, for dvi_system_destroy before the field's end
 *  @retval (others)    as dvi_system_create and dvi_density_fastest */
dvi_status dvi_density_system(const dvi_density *density, dvi_system **system);

/** Give the terms from which dvi_density_system makes a system, to add others to them. Their arrays
 *  are the field's. */
dvi_status dvi_density_system_terms(const dvi_density *density, dvi_system_terms *terms);

/** Give all coefficients U [components*functions] from coordinates q, at time t. */
dvi_status dvi_density_lift(const dvi_density *density, double t, const double *q, double *U);

/** Give the rates of all coefficients [components*functions] from velocities v, at time t.
 *
 *  @retval (others)  as the callbacks fail */
dvi_status dvi_density_lift_rate(const dvi_density *density, double t, const double *v,
                                 double *rate);

/** Give coordinates q, velocities v, and momenta p of coefficients U and their rates
 *  [components*functions] at time 0. What is fixed or moves is as the conditions say. U and rate
 *  may be NULL for 0, and q, v and p NULL if they are not wanted.
 *
 *  @retval (others)  as the callbacks fail */
dvi_status dvi_density_project(const dvi_density *density, const double *U, const double *rate,
                               double *q, double *v, double *p);

/** Write what was built: kinds, sizes and entries of the terms, one a line. Cut off at size. */
void dvi_density_explain(const dvi_density *density, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
