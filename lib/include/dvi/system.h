/** The mechanical system: a Lagrangian, or a Hamiltonian, with constraints or without, declared as
 * terms.
 *
 *      L(t,q,v) = v.M v/2  or  a general Lagrangian  or  a one-form alpha(q).v,  minus the sum of the potentials V_k(t,q),     q, v in R^n.
 *
 *  With a one-form the Lagrangian is degenerate: it is linear in v, the potentials' sum is the
 *  Hamiltonian H(t,q), the momenta are p = alpha(q), and the equations of motion are of first
 *  order, Omega(q) v = dH/dq with the two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j.
 *
 *  A Hamiltonian H(t,q,p) alone moves by q' = H_p, p' = -H_q; no derivative of it need be regular.
 *  It may come with an even number of constraints phi(q,p) = 0 (of second class: their bracket
 *  matrix {phi_a, phi_b} is regular). The equations of motion are q' = H_p + phi_p^T lambda, p' =
 *  -H_q - phi_q^T lambda with the multipliers that keep phi = 0 (Dirac 1964).
 *
 *  Callbacks return 0 for success, a positive number if a smaller step might help (the step fails,
 *  the state stays, unless it can be taken without that point: iterations look for other ways
 *  first) and a negative one for a failure for good. They get the `user` pointer of the term that
 *  declares them. They must depend on their arguments alone: the library may call them at any
 *  point, in any order.
 *
 *  Missing derivatives are differenced with steps made for coordinates and velocities of size 0.01
 *  and more: choose units in which they are, or give the derivatives.
 *
 *  Each callback comes in two shapes; declare one of them (both are refused). The one-point shape
 *  is the plain one. The batch shape gets `count` points stored component by component: coordinate
 *  i of point k is q[i*count + k], entry e of a Hessian of point k is values[e*count + k], and t[k]
 *  is the time of point k. One loop over k then serves all quadrature points of a step. A
 *  potential's gradient has a third shape, for chains and meshes: a range of coordinates of one
 *  point, computed from their neighbours alone. */
#ifndef DVI_SYSTEM_H
#define DVI_SYSTEM_H
#include <dvi/status.h>

/** The nonzero pattern of a matrix by compressed columns. All zero means: every entry may be
 * nonzero, column by column.
 *
 *  Column j holds rows row[start[j]] .. row[start[j+1]-1], ascending. Symmetric matrices store both
 *  triangles. */
typedef struct dvi_pattern {
  const int *start; /**< [columns+1], start[0] = 0, not descending */
  const int *row;   /**< [start[columns]] */
} dvi_pattern;

/** A general Lagrangian L(t,q,v): kinetic part, and any force that a potential cannot say. */
typedef struct dvi_lagrangian {
  /** The value L. Needed (or value_batch). */
  int (*value)(double t, const double *q, const double *v, double *L, void *user);
  int (*value_batch)(int count, const double *t, const double *q, const double *v, double *L,
                     void *user);
  /** dL/dq [n] and dL/dv [n]. Left out: the value is differenced, 12 n calls a point (near a
   *  singularity up to four times as many), about three digits lost. */
  int (*gradient)(double t, const double *q, const double *v, double *L_q, double *L_v, void *user);
  int (*gradient_batch)(int count, const double *t, const double *q, const double *v, double *L_q,
                        double *L_v, void *user);
  /** Second derivatives in the order of the patterns qq, qv (row q, column v) and vv. Left out: the
   * gradient is differenced. */
  int (*hessian)(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                 double *L_vv, void *user);
  int (*hessian_batch)(int count, const double *t, const double *q, const double *v, double *L_qq,
                       double *L_qv, double *L_vv, void *user);
  dvi_pattern qq, qv, vv;
  void *user;
  /** The rate L_t, the derivative in time alone. Needed by methods for which time is an unknown,
   * unless the system is autonomous. */
  int (*rate)(double t, const double *q, const double *v, double *L_t, void *user);
  int (*rate_batch)(int count, const double *t, const double *q, const double *v, double *L_t,
                    void *user);
  /** Taylor coefficients along a curve, as dvi_potential's; v has its own coefficients
   *  [(degree+1)*n], which need not be those of q's rate. L [degree+1], L_q and L_v [(degree+1)*n],
   *  L_qq, L_qv and L_vv [(degree+1)*entries of the pattern]; each may be NULL. */
  int (*taylor)(int degree, const double *t, const double *q, const double *v, double *L,
                double *L_q, double *L_v, double *L_qq, double *L_qv, double *L_vv, void *user);
} dvi_lagrangian;

/** A one-form alpha(q), for degenerate Lagrangians alpha(q).v - H: magnetic field lines, guiding
 * centres, point vortices, predators and their prey.
 *
 *  Its callbacks have the one-point shape alone. */
typedef struct dvi_one_form {
  /** alpha [n]. Needed. */
  int (*value)(const double *q, double *alpha, void *user);
  /** The gradients of its components in the order of the pattern `gradients`: column j holds d
   * alpha_j/dq. Needed. */
  int (*gradient)(const double *q, double *alpha_q, void *user);
  /** The Hessian of the function alpha(q).w, w [n] fixed, in the order of the pattern `qq`. Left
   * out: the gradients are differenced. */
  int (*hessian)(const double *q, const double *w, double *alpha_w_qq, void *user);
  dvi_pattern gradients, qq;
  void *user;
} dvi_one_form;

/** A function f(q) whose gradient is added to a one-form: another gauge, alpha + grad f, with the
 * same two-form and the same motion, but other momenta.
 *
 *  Methods may need a gauge in which some components are constant (docs/methods/dvrk.md). The value
 *  of f does not matter. The callbacks have the one-point shape alone. */
typedef struct dvi_gauge {
  /** grad f [n]. Needed. */
  int (*gradient)(const double *q, double *f_q, void *user);
  /** The Hessian of f in the order of the pattern. Needed. */
  int (*hessian)(const double *q, double *f_qq, void *user);
  /** The Hessian of the function w.grad f, w [n] fixed, in the order of the pattern. Left out: the
   * gradients of alpha + grad f are differenced. */
  int (*third)(const double *q, const double *w, double *f_w_qq, void *user);
  dvi_pattern qq;
  void *user;
} dvi_gauge;

/** A Hamiltonian H(t,q,p) on phase space, all of it: potentials are no terms beside it. Its motion
 * may be constrained (dvi_constraint).
 *
 *  Its callbacks have the one-point shape alone. */
typedef struct dvi_hamiltonian {
  /** The value H. Needed. */
  int (*value)(double t, const double *q, const double *p, double *H, void *user);
  /** dH/dq [n] and dH/dp [n]. Needed. */
  int (*gradient)(double t, const double *q, const double *p, double *H_q, double *H_p, void *user);
  /** Second derivatives in the order of the patterns qq, qp (row q, column p) and pp. Left out: the
   * gradient is differenced. */
  int (*hessian)(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                 double *H_pp, void *user);
  dvi_pattern qq, qp, pp;
  void *user;
} dvi_hamiltonian;

/** The constraints phi(q,p) = 0 of a Hamiltonian system: particles on curves, Lagrangians of which
 *  only some coordinates have mass (p = alpha(q) for the others), and p = alpha(q) for all of them.
 *
 *  Their callbacks have the one-point shape alone. */
typedef struct dvi_constraint {
  int count; /**< m, even, 2 to 2 n */
  /** phi [m]. Needed. */
  int (*value)(const double *q, const double *p, double *phi, void *user);
  /** The gradients of its components in the order of the pattern `gradients`, of m columns and 2 n
   *  rows: column a holds d phi_a/dq, rows 0 to n-1, and d phi_a/dp, rows n to 2n-1. Needed. */
  int (*gradient)(const double *q, const double *p, double *phi_z, void *user);
  /** The second derivatives of the function phi(q,p).w, w [m] fixed, in the order of the patterns
   * qq, qp and pp. Left out: the gradients are differenced. */
  int (*hessian)(const double *q, const double *p, const double *w, double *phi_w_qq,
                 double *phi_w_qp, double *phi_w_pp, void *user);
  dvi_pattern gradients, qq, qp, pp;
  void *user;
} dvi_constraint;

/** A potential V(t,q); the Lagrangian holds -V. */
typedef struct dvi_potential {
  const char *name; /**< for messages; copied; NULL: "potential" */
  /** The value V. Needed (or value_batch). */
  int (*value)(double t, const double *q, double *V, void *user);
  int (*value_batch)(int count, const double *t, const double *q, double *V, void *user);
  /** dV/dq [n]. Left out: the value is differenced, 6 n calls a point (near a singularity up to
   *  four times as many), about three digits lost. */
  int (*gradient)(double t, const double *q, double *V_q, void *user);
  int (*gradient_batch)(int count, const double *t, const double *q, double *V_q, void *user);
  /** d2V/dq2 in the order of the pattern. Left out: the gradient is differenced by column groups. A
   *  method without Hessians costs neither memory nor time for them, whether they are given or
   * not. */
  int (*hessian)(double t, const double *q, double *V_qq, void *user);
  int (*hessian_batch)(int count, const double *t, const double *q, double *V_qq, void *user);
  dvi_pattern qq;
  void *user;
  /** dV/dq of the coordinates first to last-1, of one point, into V_q [last-first], from
   *  q[first-reach] to q[last-1+reach] alone (as far as there are such coordinates); q is the whole
   *  array, and what stands elsewhere in it belongs to other times. The bits of an entry may not
   *  depend on the range that it is asked in, and must be those of `gradient` or `gradient_batch`,
   *  if one of them is declared, too. With it explicit methods take a long chain through memory
   *  once a step (docs/methods/verlet.md); on several threads, if they are told to, and then it is
   *  called on all of them at one time. dvi_system_check tests all this. Alone it serves every
   *  method: 0 to n is the whole gradient. */
  int (*gradient_range)(double t, const double *q, int first, int last, double *V_q, void *user);
  /** of gradient_range, 0 or more: how far, in the order of the coordinates, the farthest neighbour
   * of one is away */
  int reach;
  /** The rate V_t, the derivative in time alone. Needed by methods for which time is an unknown,
   * unless the system is autonomous. */
  int (*rate)(double t, const double *q, double *V_t, void *user);
  int (*rate_batch)(int count, const double *t, const double *q, double *V_t, void *user);
  /** not 0: its forces are stiff. Methods that split take it apart from the others
   * (docs/methods/imex.md); to all others it is one of them */
  int fast;
  /** not 0: V = q.Kq/2 + b(t).q + c(t) with a constant K, so that its Hessian is asked for once.
   * dvi_system_check tests it */
  int quadratic;
  /** Taylor coefficients along a curve t(s) = sum_k t[k] s^k, q_i(s) = sum_k q[k*n + i] s^k, k from
   *  0 to the degree (at most DVI_TAYLOR_MAX): those of V, V_q and V_qq there, V [degree+1], V_q
   *  [(degree+1)*n], V_qq [(degree+1)*entries of the pattern], coefficient k of entry e at
   *  [k*entries + e]; each may be NULL. Needed by methods that use higher derivatives than the
   *  second; dvi/taylor.h has the arithmetic of series to write it with. One shape, beside either
   *  of the others'. */
  int (*taylor)(int degree, const double *t, const double *q, double *V, double *V_q, double *V_qq,
                void *user);
} dvi_potential;

/** A constant mass matrix: exactly one of the three forms. It must be regular, and may be
 * indefinite: a Lagrangian with -M and -V moves as that with M and V. */
typedef struct dvi_mass {
  double scalar;          /**< M = scalar times the identity; 0 if another form is used */
  const double *diagonal; /**< [n] */
  const double *values;   /**< a sparse symmetric matrix in the order of the pattern */
  dvi_pattern pattern;
} dvi_mass;

/** What a factor of a configuration space is. */
typedef enum dvi_factor_kind {
  DVI_RN, /**< R^n: n coordinates */
  /** rotations R: the nine entries, row by row; v is the angular velocity Omega in the body's
   * frame, R' = R Omega^, p = Pi its momentum */
  DVI_SO3,
  /** rigid motions: the nine entries of R, then x, the place of the body's origin; v = (Omega, x'),
   * x' in the frame of space */
  DVI_SE3,
  /** directions: a unit vector q; v = q' and its momentum p are three numbers, too, orthogonal to
   * q */
  DVI_S2,
  DVI_U1 /**< angles: (cos, sin); v is the angular rate */
} dvi_factor_kind;

/** A factor of a configuration space that is not R^n alone: bodies that turn, directions, angles.
 *
 *  The Lagrangian is one of the stored coordinates of all factors in a row, q [nq]: L = q'.M q'/2 -
 *  V(t,q) with a constant M, made of what the factors say of themselves and of the system's mass,
 *  if it has one. Potentials have ordinary gradients and Hessians in the nq numbers, of any smooth
 *  continuation of V off the manifold (for a body's weight m g (R rho)_3 those of this formula):
 *  only what is tangent counts.
 *
 *  Of an inertia J the mass has tr(J)/2 I - J, where a principal moment below 1e-16 of the others
 *  is rounded away: the mass is singular, and nothing starts. */
typedef struct dvi_factor {
  dvi_factor_kind kind;
  int size; /**< of R^n: n; of others 0 */
  double
      /** R^n: of every coordinate; SE(3): of the body; S^2: m l^2; U(1): the moment of inertia; 0:
       * in the system's mass alone */
      mass;
  const double
      /** SO(3), SE(3): [9] the inertia about the body's origin, symmetric; copied. NULL: in the
       * system's mass alone */
      *inertia;
  const double *centre; /**< SE(3): [3] the centre of mass in the body's frame; NULL: its origin */
} dvi_factor;

/** A one-parameter symmetry q -> q + epsilon xi(q); its momentum map is J = p.xi(q). With factors
 *  xi is a velocity [nv], as v is (a body turned in space about e has R^T e). */
typedef struct dvi_symmetry {
  const char *name; /**< the momentum's name in tables; copied */
  int (*generator)(const double *q, double *xi, void *user);
  void *user;
} dvi_symmetry;

/** Any other function I(t,q,p) to be watched along a run. */
typedef struct dvi_invariant {
  const char *name; /**< copied */
  int (*value)(double t, const double *q, const double *p, double *I, void *user);
  void *user;
} dvi_invariant;

/** What a system is made of. Only what is declared exists; all of it is copied (but what `user`
 * points to). */
typedef struct dvi_system_terms {
  /** n, the number of coordinates, at least 1; even with a one-form; with factors 0: they say it */
  int dimension;
  dvi_mass mass;                    /**< or: */
  const dvi_lagrangian *lagrangian; /**< or: */
  /** exactly one of mass, lagrangian, one_form and hamiltonian */
  const dvi_one_form *one_form;
  /** with a one-form, may be NULL: the system is that of alpha + grad f */
  const dvi_gauge *gauge;
  const dvi_potential *potentials;
  int potential_count;
  const dvi_symmetry *symmetries;
  int symmetry_count;
  const dvi_invariant *invariants;
  int invariant_count;
  /** not 0: no callback depends on t (dvi_system_check tests it), and no rates are given; 0: one
   * may */
  int autonomous;
  const dvi_hamiltonian *hamiltonian; /**< without potentials */
  const dvi_constraint *constraint;   /**< of the Hamiltonian; NULL: there is none */
  const dvi_factor *factors;          /**< NULL: R^n */
  int factor_count;
} dvi_system_terms;

/** A system; it never changes after its creation, so integrators on several threads may share
 * it. */
typedef struct dvi_system dvi_system;

#ifdef __cplusplus
extern "C" {
#endif

/** Make a system from its terms.
 *
 *  @param[out] system  owned by the caller; NULL on failure. It must outlive every integrator made
 *                      from it.
 *  @retval DVI_BAD_SIZE      dimension (odd with a one-form), a count (of constraints: odd, too) or
 *                            a reach is out of range
 *  @retval DVI_BAD_ARGUMENT  a term is missing, given twice, or without its value callback; a reach
 *                            has no gradient_range; a pattern is not sorted; an autonomous system
 *                            has a rate; a gauge has no one-form; an inertia is that of no body
 *                            (its principal moments must be positive, none above the sum of the
 *                            others); a constraint has no Hamiltonian, or a Hamiltonian potentials
 *                            beside it
 *  @retval DVI_SINGULAR      the constant mass is singular or not finite; with factors: not finite,
 *                            or none at all at a factor's coordinates
 *  @retval DVI_UNSUPPORTED   factors beside a general Lagrangian or a one-form
 *  @retval DVI_NO_MEMORY */
dvi_status dvi_system_create(const dvi_system_terms *terms, dvi_system **system);

/** Free a system and set the pointer to NULL; NULL is allowed. */
void dvi_system_destroy(dvi_system **system);

/** Number of stored coordinates; 0 for NULL. */
int dvi_system_nq(const dvi_system *system);

/** The size of v and p; 0 for NULL. The number of degrees of freedom, but that directions have
 * three numbers for their two. */
int dvi_system_nv(const dvi_system *system);

/** Whether the system was declared autonomous: 1 or 0; 0 for NULL. */
int dvi_system_autonomous(const dvi_system *system);

/** How many constraints phi(q,p) = 0 a Hamiltonian has; 0 for other systems, and for NULL. */
int dvi_system_constraint_count(const dvi_system *system);

/** The Lagrangian's value at (t, q [nq], v [nv]). Allocates; fails as the callbacks do;
 * DVI_UNSUPPORTED for a Hamiltonian. */
dvi_status dvi_system_lagrangian(const dvi_system *system, double t, const double *q,
                                 const double *v, double *L);

/** The Legendre map p = L_v(t,q,v) [nv] (Marsden and West 2001, sec. 1.2.5). Allocates.
 *  DVI_UNSUPPORTED for a Hamiltonian: there may be more than one p to a v, or none. */
dvi_status dvi_system_momentum(const dvi_system *system, double t, const double *q, const double *v,
                               double *p);

/** The inverse Legendre map: the v [nv] with L_v(t,q,v) = p, by Newton's method from v as given.
 *
 *  If that does not settle, velocities along p are tried as guesses. A degenerate Lagrangian
 *  alpha.v - H has no such map; there v is that of the equations of motion, Omega(q) v = dH/dq, and
 *  p does not matter. Of a Hamiltonian v = H_p, with constraints H_p + phi_p^T lambda.
 *  @param[in,out] v [nv]; a starting guess (read for general Lagrangians only), then the velocity;
 *  unchanged on failure
 *  @retval DVI_SINGULAR       L_vv is singular at every guess; or Omega is; or the constraints'
 *                             bracket matrix
 *  @retval DVI_NOT_CONVERGED  Newton's method did not settle from any guess
 *  @retval DVI_BAD_ARGUMENT   an argument is NULL
 *  @retval DVI_NOT_FINITE     an argument, or the velocity that was found, is not finite
 *  @retval DVI_NO_MEMORY
 *  @retval (others)           as the callbacks fail */
dvi_status dvi_system_velocity(const dvi_system *system, double t, const double *q, const double *p,
                               double *v);

/** How far q [nq] is from the configuration space of a system with factors: the largest distance
 *  from a rotation (dvi_so3_distance) or ||q| - 1|; 0 without factors, NaN for NULL and where a
 *  coordinate of a factor is. */
double dvi_system_distance(const dvi_system *system, const double *q);

/** Put q [nq] on the configuration space: the nearest rotations and unit vectors.
 *
 *  Integrators do this never, and refuse to start farther off than rounding: say by this call that
 *  it is meant.
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL; a vector is zero; a matrix is singular or nearer to
 *                            a reflection than to a rotation. q is unchanged then
 *  @retval DVI_NOT_FINITE    a number is not */
dvi_status dvi_system_project(const dvi_system *system, double *q);

/** The two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j of a system with a one-form, and its
 * condition number. Allocates.
 *
 *  @param[out] Omega      [n*n] column by column, antisymmetric; may be NULL
 *  @param[out] condition  |Omega| |Omega^-1| in the norm of the largest column sum; infinite where
 *                         Omega is singular; may be NULL
 *  @retval DVI_UNSUPPORTED   the system has no one-form
 *  @retval DVI_BAD_ARGUMENT  system or q is NULL
 *  @retval DVI_NOT_FINITE    q is not finite
 *  @retval DVI_NO_MEMORY
 *  @retval (others)          as the one-form's callback fails */
dvi_status dvi_system_two_form(const dvi_system *system, const double *q, double *Omega,
                               double *condition);

/** The bracket matrix B_ab = {phi_a, phi_b} = phi_a,q.phi_b,p - phi_a,p.phi_b,q of a Hamiltonian's
 * m constraints, and its condition number. Allocates.
 *
 *  @param[out] bracket    [m*m] column by column, antisymmetric; may be NULL
 *  @param[out] condition  |B| |B^-1| in the norm of the largest column sum; infinite where B is
 *                         singular; may be NULL
 *  @retval DVI_UNSUPPORTED  the system has no constraints phi(q,p) */
dvi_status dvi_system_bracket(const dvi_system *system, const double *q, const double *p,
                              double *bracket, double *condition);

/** How many invariants are watched: the energy, one momentum for each symmetry, and the declared
 * ones, in this order; 0 for NULL. */
int dvi_system_invariant_count(const dvi_system *system);

/** Name of invariant i; invariant 0 is "energy"; NULL if i is out of range. */
const char *dvi_system_invariant_name(const dvi_system *system, int i);

/** All invariants at (t, q [nq], p [nv]). Allocates; dvi_integrator_invariants does not.
 *
 *  The energy is p.v - L with v from the inverse Legendre map; with a one-form, or a Hamiltonian,
 *  it is H.
 *  @param[out] value  [dvi_system_invariant_count] */
dvi_status dvi_system_invariants(const dvi_system *system, double t, const double *q,
                                 const double *p, double *value);

/** What the derivative check found for one callback. */
typedef struct dvi_derivative_check {
  /** largest difference of given and differenced gradient, relative to the largest entry */
  double gradient_error;
  double hessian_error; /**< the same of the Hessian on the pattern */
  /** largest differenced entry outside the pattern, relative; more than roundoff: the pattern
   * lies */
  double outside;
  /** where `outside` is, or the worst Hessian entry if nothing is outside */
  int row, column;
  char where
      [96]; /**< the worst offender in words, for example "potential 'gravity': d2V/dq2 (3,1) is not in the pattern" */
  /** the first coordinate for which a gradient_range breaks its promise; -1: none does */
  int range_row;
  /** largest difference of given and differenced rate, relative to the rate */
  double rate_error;
  /** 1: the system is declared autonomous, but a callback's results change with t */
  int depends_on_time;
  /** 1: a potential is declared quadratic, but its Hessian changes with q or t */
  int not_quadratic;
  double
      /** largest difference of a Taylor coefficient and the one-point callbacks, or differences of
       * the coefficient below it, relative */
      taylor_error;
} dvi_derivative_check;

/** Compare every gradient, Hessian, pattern and rate of the system with differences of the values
 *  at one point, and every gradient_range, bit for bit, with the whole gradient: over short and
 *  long ranges, with NaN wherever it may not look. Of an autonomous system every callback must give
 *  the same numbers at two other times, and the gradient of a quadratic potential must be linear in
 *  q. Taylor coefficients, up to DVI_TAYLOR_MAX of them, are compared with the other callbacks, and
 *  each with differences of the one below it along a curve through the point, as far as rounding
 *  lets it be seen; they may not depend on the degree that is asked for, nor on which results are
 *  NULL.
 *
 *  Uses 6th order central differences; n^2 gradient calls: meant for tests and for moderate n.
 *  @param      q, v [nq], [nv]: a point in general position; with a Hamiltonian v stands for p
 *  @param      tolerance  largest relative difference to accept; 0: 1e-6
 *  @param[out] check      the findings; may be NULL
 *  @retval DVI_OK            everything agrees
 *  @retval DVI_BAD_ARGUMENT  something does not, and the error sentence names it; an argument is
 *                            NULL; the tolerance is negative
 *  @retval DVI_NOT_FINITE    the point is not finite
 *  @retval DVI_NO_MEMORY
 *  @retval (others)          as the callbacks fail */
dvi_status dvi_system_check(const dvi_system *system, double t, const double *q, const double *v,
                            double tolerance, dvi_derivative_check *check);

#ifdef __cplusplus
}
#endif
#endif
