/** The mechanical system, a Lagrangian, or a Hamiltonian, with constraints or without, declared as
 *  terms.
 *
 *      L(t,q,v) = K(t,q,v) - sum_k V_k(t,q),     q, v in R^n,
 *      K = v.M v/2  or  a general Lagrangian  or  alpha(q).v with a one-form alpha.
 *
 *  A vector potential A(t,q) adds A(t,q).v to the Lagrangian of a constant mass, as that of a
 *  charge in a magnetic field does. The momenta are then p = M v + A.
 *
 *  Forces F(t,q,v) without a potential may act beside a mass or a general Lagrangian. By the
 *  principle of Lagrange and d'Alembert the equations of motion are then d/dt L_v = L_q + F.
 *
 *  A mass or a general Lagrangian may have holonomic constraints phi(t,q) = 0, as rods and joints
 *  are. With G = d phi/dq the equations of motion are then
 *
 *      d/dt L_v = L_q + F - G^T lambda,     phi(t,q) = 0,
 *
 *  and with nonholonomic ones, A(t,q) v + a(t,q) = 0, A stands for G (Bloch 2003, sec. 1.3).
 *
 *  With a one-form the Lagrangian is degenerate. It is linear in v, the potentials' sum is the
 *  Hamiltonian H(t,q), and the momenta are p = alpha(q). The equations of motion are of first
 *  order, Omega(q) v = dH/dq with the two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j.
 *
 *  A Hamiltonian H(t,q,p) stands alone, and the equations of motion are q' = H_p, p' = -H_q. No
 *  derivative of H need be regular. The Hamiltonian may have an even number of constraints
 *  phi(q,p) = 0 of second class, whose bracket matrix {phi_a, phi_b} is regular. The equations of
 *  motion are then
 *
 *      q' = H_p + phi_p^T lambda,     p' = -H_q - phi_q^T lambda
 *
 *  with the multipliers lambda that keep phi = 0 (Dirac 1964).
 *
 *  Callbacks return 0 for success, and a negative number for a failure for good. They return a
 *  positive number if a smaller step might help. The step then fails and the state stays, unless an
 *  iteration can avoid that point. Callbacks get the `user` pointer of the term that declares them.
 *  They must depend on their arguments alone, because the library may call them at any point, in
 *  any order.
 *
 *  Missing derivatives are differenced with steps made for coordinates and velocities of size 0.01
 *  and more. Choose such units, or give the derivatives.
 *
 *  Each callback comes in two shapes. Declare one of them (both are refused). The one-point shape
 *  is the plain one. The batch shape gets `count` points stored component by component. Coordinate
 *  i of point k is q[i*count + k], entry e of a Hessian of point k is values[e*count + k], and t[k]
 *  is the time of point k. One loop over k then serves all quadrature points of a step. A
 *  potential's gradient has a third shape, for chains and meshes, which computes a range of
 *  coordinates of one point from their neighbours alone. */
#ifndef DVI_SYSTEM_H
#define DVI_SYSTEM_H
#include <dvi/status.h>

/** The nonzero pattern of a matrix by compressed columns. By default (all zero) every entry may be
 *  nonzero, column by column.
 *
 *  Column j holds rows row[start[j]] .. row[start[j+1]-1], ascending. Symmetric matrices store both
 *  triangles. */
typedef struct dvi_pattern {
  const int *start; /**< [columns+1], start[0] = 0, not descending */
  const int *row;   /**< [start[columns]] */
} dvi_pattern;

/** A general Lagrangian L(t,q,v): the kinetic part, and any force that follows from a function of q
 *  and v. That of a magnetic field beside a constant mass is a dvi_vector_potential. Friction and
 *  other forces are dvi_force. */
typedef struct dvi_lagrangian {
  /** The value L. Required (or value_batch). */
  int (*value)(double t, const double *q, const double *v, double *L, void *user);
  int (*value_batch)(int count, const double *t, const double *q, const double *v, double *L,
                     void *user);
  /** dL/dq [n] and dL/dv [n]. By default the value is differenced, which takes 12 n calls a point
   *  (near a singularity up to four times as many) and loses about three digits. */
  int (*gradient)(double t, const double *q, const double *v, double *L_q, double *L_v, void *user);
  int (*gradient_batch)(int count, const double *t, const double *q, const double *v, double *L_q,
                        double *L_v, void *user);
  /** In the order of the patterns qq, qv (row q, column v) and vv. Default: differences. */
  int (*hessian)(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                 double *L_vv, void *user);
  int (*hessian_batch)(int count, const double *t, const double *q, const double *v, double *L_qq,
                       double *L_qv, double *L_vv, void *user);
  dvi_pattern qq, qv, vv;
  void *user;
  /** The rate L_t, the derivative in time alone. Required by methods for which time is an unknown,
   *  unless the system is autonomous. */
  int (*rate)(double t, const double *q, const double *v, double *L_t, void *user);
  int (*rate_batch)(int count, const double *t, const double *q, const double *v, double *L_t,
                    void *user);
  /** Taylor coefficients along a curve, as in dvi_potential. v has its own [(degree+1)*n], which
   *  need not be those of q's rate. L is [degree+1], L_q and L_v are [(degree+1)*n], L_qq, L_qv and
   *  L_vv are [(degree+1)*entries of the pattern]. Each may be NULL. */
  int (*taylor)(int degree, const double *t, const double *q, const double *v, double *L,
                double *L_q, double *L_v, double *L_qq, double *L_qv, double *L_vv, void *user);
  /** Whether L is defined at q, asked once a step, at its end. Default: everywhere. */
  int (*admit)(double t, const double *q, void *user);
} dvi_lagrangian;

/** A one-form alpha(q), for degenerate Lagrangians alpha(q).v - H, such as magnetic field lines,
 *  guiding centres, point vortices, predators and their prey.
 *
 *  Its callbacks have the one-point shape alone. */
typedef struct dvi_one_form {
  /** alpha [n]. Required. */
  int (*value)(const double *q, double *alpha, void *user);
  /** The gradients of alpha's components in the order of the pattern `gradients`. Column j holds
   *  d alpha_j/dq. Required. */
  int (*gradient)(const double *q, double *alpha_q, void *user);
  /** The Hessian of the function alpha(q).w, w [n] fixed, in the order of the pattern `qq`.
   *  By default the gradients are differenced. */
  int (*hessian)(const double *q, const double *w, double *alpha_w_qq, void *user);
  dvi_pattern gradients, qq;
  void *user;
} dvi_one_form;

/** A function f(q) whose gradient is added to a one-form. The gauge alpha + grad f has the same
 *  two-form and the same motion, but other momenta.
 *
 *  Methods may need a gauge in which some components are constant (docs/methods/dvrk.md). The value
 *  of f does not matter. The callbacks have the one-point shape alone. */
typedef struct dvi_gauge {
  /** grad f [n]. Required. */
  int (*gradient)(const double *q, double *f_q, void *user);
  /** The Hessian of f in the order of the pattern. Required. */
  int (*hessian)(const double *q, double *f_qq, void *user);
  /** The Hessian of the function w.grad f, w [n] fixed, in the order of the pattern. Default:
   *  differences of the gradients of alpha + grad f. */
  int (*third)(const double *q, const double *w, double *f_w_qq, void *user);
  dvi_pattern qq;
  void *user;
} dvi_gauge;

/** A Hamiltonian H(t,q,p) on phase space. H is the whole Hamiltonian, and potentials are refused
 *  beside it. Its motion may be constrained (dvi_constraint).
 *
 *  Its callbacks have the one-point shape alone. */
typedef struct dvi_hamiltonian {
  /** The value H. Required. */
  int (*value)(double t, const double *q, const double *p, double *H, void *user);
  /** dH/dq [n] and dH/dp [n]. Required. */
  int (*gradient)(double t, const double *q, const double *p, double *H_q, double *H_p, void *user);
  /** Second derivatives in the order of the patterns qq, qp (row q, column p) and pp. Default:
   *  differences of the gradient. */
  int (*hessian)(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                 double *H_pp, void *user);
  dvi_pattern qq, qp, pp;
  void *user;
} dvi_hamiltonian;

/** The constraints phi(q,p) = 0 of a Hamiltonian system. Examples are particles on curves,
 *  Lagrangians of which only some coordinates have mass (p = alpha(q) for the others), and
 *  p = alpha(q) for all coordinates.
 *
 *  Their callbacks have the one-point shape alone. */
typedef struct dvi_constraint {
  int count; /**< number of constraints m, even, 2 to 2 n */
  /** phi [m]. Required. */
  int (*value)(const double *q, const double *p, double *phi, void *user);
  /** The gradients of phi's components in the order of the pattern `gradients`, of m columns and
   *  2 n rows. Column a holds d phi_a/dq, rows 0 to n-1, and d phi_a/dp, rows n to 2n-1.
   *  Required. */
  int (*gradient)(const double *q, const double *p, double *phi_z, void *user);
  /** The second derivatives of the function phi(q,p).w, w [m] fixed, in the order of the patterns
   *  qq, qp and pp. By default the gradients are differenced. */
  int (*hessian)(const double *q, const double *p, const double *w, double *phi_w_qq,
                 double *phi_w_qp, double *phi_w_pp, void *user);
  dvi_pattern gradients, qq, qp, pp;
  void *user;
} dvi_constraint;

/** A potential V(t,q). The Lagrangian holds -V. */
typedef struct dvi_potential {
  const char *name; /**< name in messages (default "potential"). Copied */
  /** The value V. Required (or value_batch). */
  int (*value)(double t, const double *q, double *V, void *user);
  int (*value_batch)(int count, const double *t, const double *q, double *V, void *user);
  /** dV/dq [n]. By default the value is differenced, which takes 6 n calls a point (near a
   *  singularity up to four times as many) and loses about three digits. */
  int (*gradient)(double t, const double *q, double *V_q, void *user);
  int (*gradient_batch)(int count, const double *t, const double *q, double *V_q, void *user);
  /** d2V/dq2 in the order of the pattern. By default the gradient is differenced by column groups.
   *  A method without Hessians spends neither memory nor time on them, whether they are given or
   *  not. */
  int (*hessian)(double t, const double *q, double *V_qq, void *user);
  int (*hessian_batch)(int count, const double *t, const double *q, double *V_qq, void *user);
  dvi_pattern qq;
  void *user;
  /** dV/dq of the coordinates first to last-1, of one point, into V_q [last-first].
   *
   *  The result depends on q[first-reach] to q[last-1+reach] alone (as far as there are such
   *  coordinates). q is the whole array, and its other entries belong to other times. The bits of
   *  an entry may not depend on the range of the call, and must be those of `gradient` or
   *  `gradient_batch`, if one of them is declared, too. dvi_system_check tests this. With
   *  gradient_range explicit methods take a long chain through memory once a step
   *  (docs/methods/verlet.md). With several threads the callback runs on all of them at one time.
   *  Declared alone, gradient_range serves every method, because 0 to n is the whole gradient. */
  int (*gradient_range)(double t, const double *q, int first, int last, double *V_q, void *user);
  /** Reach of gradient_range, 0 or more: the distance from a coordinate to its farthest neighbour,
   *  in the order of the coordinates */
  int reach;
  /** The rate V_t, the derivative in time alone. Required by methods for which time is an unknown,
   *  unless the system is autonomous. */
  int (*rate)(double t, const double *q, double *V_t, void *user);
  int (*rate_batch)(int count, const double *t, const double *q, double *V_t, void *user);
  /** not 0 if the forces are stiff, or far above the others. Splitting methods treat them apart
   *  (docs/methods/imex.md). Fixed-point iteration evaluates the others less often, with the same
   *  solutions but for last digits (docs/methods/galerkin.md) */
  int fast;
  /** not 0 if V = q.Kq/2 + b(t).q + c(t) with a constant K. dvi_system_check tests this */
  int quadratic;
  /** not 0 if no Hessian of V is to be formed, such as a dense one of a large space, and none by
   *  differences. Fixed-point iteration alone solves steps, and methods with Hessians refuse V */
  int without_hessian;
  /** bound of the angular frequencies of a quadratic potential, with a one-form of the motion of
   *  first order. By it methods refuse unstable steps, verlet beyond 2/fastest. 0 if not known */
  double fastest;
  /** Taylor coefficients of V, V_q and V_qq along the curve t(s) = sum_k t[k] s^k,
   *  q_i(s) = sum_k q[k*n + i] s^k, k from 0 to the degree (at most DVI_TAYLOR_MAX).
   *
   *  V is [degree+1], V_q is [(degree+1)*n], and V_qq is [(degree+1)*entries of the pattern] with
   *  coefficient k of entry e at [k*entries + e]. Each may be NULL. Required by methods that use
   *  higher derivatives than the second. dvi/taylor.h has the arithmetic of series. The callback
   *  has one shape, beside either of the other callbacks' shapes. */
  int (*taylor)(int degree, const double *t, const double *q, double *V, double *V_q, double *V_qq,
                void *user);
} dvi_potential;

/** A vector potential A(t,q), which adds A(t,q).v to the Lagrangian of a constant mass. A charge e
 *  in a magnetic field has e times the field's vector potential.
 *
 *  The momenta are p = M v + A. The equations of motion are, with the field
 *  B_ij = dA_j/dq_i - dA_i/dq_j, M v' = -V_q + B(t,q) v - A_t. For n = 3 this is Lorentz's force,
 *  B v = v x curl A. A gauge A + grad f(q) has the same motion and other momenta. The energy is
 *  v.M v/2 + V (Landau and Lifshitz 1975, sec. 16). */
typedef struct dvi_vector_potential {
  /** A [n]. Required (or value_batch). */
  int (*value)(double t, const double *q, double *A, void *user);
  int (*value_batch)(int count, const double *t, const double *q, double *A, void *user);
  /** The gradients of A's components in the order of the pattern `gradients`. Column j holds
   *  dA_j/dq. Required (or gradient_batch). */
  int (*gradient)(double t, const double *q, double *A_q, void *user);
  int (*gradient_batch)(int count, const double *t, const double *q, double *A_q, void *user);
  /** The Hessian of the function A(t,q).w, w [n] fixed, in the order of the pattern `qq`. Default:
   *  differences of the gradients. */
  int (*hessian)(double t, const double *q, const double *w, double *A_w_qq, void *user);
  int (*hessian_batch)(int count, const double *t, const double *q, const double *w, double *A_w_qq,
                       void *user);
  dvi_pattern gradients, qq;
  /** The rate A_t [n], the derivative in time alone. Required by `boris`, and by methods for which
   *  time is an unknown, unless the system is autonomous. */
  int (*rate)(double t, const double *q, double *A_t, void *user);
  int (*rate_batch)(int count, const double *t, const double *q, double *A_t, void *user);
  void *user;
} dvi_vector_potential;

/** A force F(t,q,v) without a potential, such as friction, a drive, or a control (Marsden and West
 *  2001, sec. 3.1.1). It does work, so that energy and momenta are no longer conserved, but
 *  balanced (dvi_integrator_balance).
 *
 *  With factors F has a number for each number of the stored velocity, [nv] for q [nq] and v [nv],
 *  and acts on it: torques in the body's frame, forces in the frame of space. */
typedef struct dvi_force {
  const char *name; /**< copied. Used in messages */
  /** The force F [n]. Required (or value_batch). */
  int (*value)(double t, const double *q, const double *v, double *F, void *user);
  int (*value_batch)(int count, const double *t, const double *q, const double *v, double *F,
                     void *user);
  /** The derivatives dF_i/dq_j and dF_i/dv_j in the order of the patterns by_q and by_v (row i,
   *  column j). Default: differences of the force. With factors they are refused */
  int (*jacobian)(double t, const double *q, const double *v, double *F_q, double *F_v, void *user);
  int (*jacobian_batch)(int count, const double *t, const double *q, const double *v, double *F_q,
                        double *F_v, void *user);
  dvi_pattern by_q, by_v;
  /** not 0 if the force is a function of t and q alone. Its callbacks get v = NULL then, and F_v =
   *  NULL. by_v is left out */
  int without_velocity;
  void *user;
} dvi_force;

enum { DVI_HOLONOMIC_POINTS = 64 }; /**< most points in a batch of holonomic constraints */

/** Holonomic constraints phi(t,q) = 0 of some rows, such as a rod, a rail or a joint (dvi/joint.h).
 *
 *  With factors phi is a function of all stored coordinates, of any smooth continuation off the
 *  manifold, as potentials are. Rows may be dependent (docs/mechanics/constraints.md). */
typedef struct dvi_holonomic {
  const char *name; /**< copied. Used in messages */
  int count;        /**< number of rows, at least 1 */
  /** phi [count]. Required (or value_batch). */
  int (*value)(double t, const double *q, double *phi, void *user);
  /** d phi_a/dq as column a of the pattern `gradients`. Required (or gradient_batch). */
  int (*gradient)(double t, const double *q, double *phi_q, void *user);
  /** The Hessian of phi.w, w [count] fixed, in the order of `qq`. Default: it is differenced. */
  int (*hessian)(double t, const double *q, const double *w, double *phi_w_qq, void *user);
  /** The rates d phi/dt [count] at fixed q. Default: the constraints do not depend on time. */
  int (*rate)(double t, const double *q, double *phi_t, void *user);
  dvi_pattern gradients, qq;
  void *user;
  const char *const *row_names; /**< [count], copied. Default: the name with a row's number */
  int (*value_batch)(int points, const double *t, const double *q, double *phi, void *user);
  int (*gradient_batch)(int points, const double *t, const double *q, double *phi_q, void *user);
} dvi_holonomic;

/** Nonholonomic constraints A(t,q) v + a(t,q) = 0, of wheels and blades. A start refuses dependent
 *  rows, and those of functions phi(t,q). The callbacks have the one-point shape alone. */
typedef struct dvi_nonholonomic {
  const char *name; /**< copied. Used in messages */
  int count;        /**< number of rows, at least 1 */
  /** A in the order of `transposed` [n x count], whose column a holds row a of A. Required. */
  int (*value)(double t, const double *q, double *A, void *user);
  int (*affine)(double t, const double *q, double *a, void *user); /**< a [count] (default 0) */
  /** d(A v + a)/dq in the order of `by_q` [count x n]. Default: differences. */
  int (*derivative)(double t, const double *q, const double *v, double *Av_q, void *user);
  dvi_pattern transposed, by_q;
  void *user;
} dvi_nonholonomic;

/** A constant mass matrix in exactly one of the three forms. The matrix must be regular. It may be
 *  indefinite, since a Lagrangian with -M and -V has the motion of that with M and V. */
typedef struct dvi_mass {
  double scalar;          /**< M = scalar times the identity. 0 if another form is used */
  const double *diagonal; /**< [n] */
  const double *values;   /**< a sparse symmetric matrix in the order of the pattern */
  dvi_pattern pattern;
} dvi_mass;

/** Kinds of factors of a configuration space. */
typedef enum dvi_factor_kind {
  DVI_RN, /**< R^n: n coordinates */
  /** rotations R, the nine entries row by row. v is the angular velocity Omega in the body's frame,
   *  R' = R Omega^, and p = Pi its momentum */
  DVI_SO3,
  /** rigid motions, the nine entries of R, then the position x of the body's origin. v = (Omega,
   *  x'), with x' in the frame of space */
  DVI_SE3,
  /** directions, a unit vector q. v = q' and its momentum p are three numbers, orthogonal to q */
  DVI_S2,
  DVI_U1 /**< angles, (cos, sin). v is the angular rate */
} dvi_factor_kind;

/** A factor of a configuration space that is not R^n alone: bodies that turn, directions, angles.
 *
 *  The Lagrangian is a function of the stored coordinates of all factors in a row, q [nq],
 *
 *      L = q'.M q'/2 - V(t,q)
 *
 *  with a constant M, the sum of the factors' masses and inertias and of the system's mass, if it
 *  has one. Potentials have ordinary gradients and Hessians in the nq numbers, of any smooth
 *  continuation of V off the manifold (for a body's weight m g (R rho)_3 those of this formula).
 *  Only their tangent parts count.
 *
 *  An inertia J enters the mass as tr(J)/2 I - J. There a principal moment below 1e-16 of the
 *  others is rounded away. Such a mass is singular, and nothing starts. */
typedef struct dvi_factor {
  dvi_factor_kind kind;
  int size; /**< n for R^n, 0 for the others */
  /** mass of every coordinate of R^n, mass of the body of SE(3), m l^2 of S^2, or moment of inertia
   *  of U(1). By default the mass is in the system's mass alone */
  double mass;
  /** [9] inertia of SO(3) or SE(3) about the body's origin, symmetric. Copied. By default the
   *  inertia is in the system's mass alone */
  const double *inertia;
  /** [3] centre of mass of SE(3) in the body's frame (default: its origin) */
  const double *centre;
} dvi_factor;

/** A one-parameter symmetry q -> q + epsilon xi(q), with the momentum map J = p.xi(q). With factors
 *  xi is a velocity [nv], as v is (a body turned in space about e has R^T e). */
typedef struct dvi_symmetry {
  const char *name; /**< the momentum's name in tables. Copied */
  int (*generator)(const double *q, double *xi, void *user);
  void *user;
} dvi_symmetry;

/** Any other function I(t,q,p) to be watched along a run. */
typedef struct dvi_invariant {
  const char *name; /**< copied */
  int (*value)(double t, const double *q, const double *p, double *I, void *user);
  void *user;
} dvi_invariant;

/** The terms of a system. Only declared terms exist. All are copied, but not the data at `user`.
 *
 *  Exactly one kind of dynamics is declared: a constant mass (by `mass`, by `factors`, or by both,
 *  which are added), or `lagrangian`, or `one_form`, or `hamiltonian`. Potentials may stand beside
 *  all kinds but a Hamiltonian. Forces and constraints may stand beside a mass and beside a general
 *  Lagrangian, but beside factors no nonholonomic ones. Contacts, noise: dvi/contact.h, noise.h. */
typedef struct dvi_system_terms {
  /** number n of coordinates, at least 1, even with a one-form. 0 with factors, which tell it */
  int dimension;
  dvi_mass mass;                    /**< a constant mass */
  const dvi_lagrangian *lagrangian; /**< a general Lagrangian */
  const dvi_one_form *one_form;     /**< a one-form alpha */
  const dvi_gauge *gauge; /**< makes a one-form alpha that of alpha + grad f. May be NULL */
  const dvi_potential *potentials;
  int potential_count;
  const dvi_symmetry *symmetries;
  int symmetry_count;
  const dvi_invariant *invariants;
  int invariant_count;
  int autonomous; /**< not 0 if no callback depends on t (dvi_system_check); without rates then */
  const dvi_hamiltonian *hamiltonian; /**< a Hamiltonian, without potentials */
  const dvi_constraint *constraint;   /**< constraints of the Hamiltonian (default none) */
  const dvi_factor *factors;          /**< factors of the configuration space (default: R^n) */
  int factor_count;
  const dvi_force *forces; /**< forces without a potential (default none) */
  int force_count;
  const dvi_holonomic *holonomics; /**< holonomic constraints (default none) */
  int holonomic_count;
  /** vector potential beside a constant mass without factors and constraints (default none) */
  const dvi_vector_potential *vector_potential;
  const dvi_nonholonomic *nonholonomics; /**< nonholonomic constraints (default none) */
  int nonholonomic_count;
  const struct dvi_contact *contacts; /**< contacts phi(t,q) >= 0 (dvi/contact.h; default none) */
  int contact_count;
  double damping; /**< rate gamma >= 0 of friction -gamma p, p = L_v (docs/mechanics/forces.md) */
  const struct dvi_noise *noise; /**< a heat bath (dvi/noise.h; default none) */
} dvi_system_terms;

/** A system. It never changes after its creation, so integrators on several threads may share
 *  it. */
typedef struct dvi_system dvi_system;

#ifdef __cplusplus
extern "C" {
#endif

/** Make a system from its terms.
 *
 *  @param[out] system  owned by the caller. NULL on failure. It must outlive every integrator made
 *                      from it.
 *  @retval DVI_BAD_SIZE      dimension (also odd with a one-form), a count (also an odd count of
 *                            constraints) or a reach is out of range
 *  @retval DVI_BAD_ARGUMENT  a term is missing, given twice, or without its value callback. Or a
 *                            reach has no gradient_range, a pattern is not sorted, an autonomous
 *                            system has a rate, or a gauge has no one-form. Or an inertia is that
 *                            of no body (its principal moments must be positive, none above the sum
 *                            of the others). Or a constraint has no Hamiltonian, or a Hamiltonian
 *                            has potentials beside it. Or the damping is negative or not finite
 *  @retval DVI_SINGULAR      the constant mass is singular or not finite. With factors the mass is
 *                            not finite, or there is none at all at a factor's coordinates
 *  @retval DVI_UNSUPPORTED   factors beside a general Lagrangian, a one-form or a Hamiltonian. Or
 *                            forces, damping or constraints beside the latter two. Or nonholonomic
 *                            ones beside factors, a vector potential beside other than a mass, or
 *                            damping beside it, constraints or contacts
 *  @retval DVI_NO_MEMORY     memory could not be allocated */
dvi_status dvi_system_create(const dvi_system_terms *terms, dvi_system **system);

/** Free a system and set the pointer to NULL. NULL is allowed. */
void dvi_system_destroy(dvi_system **system);

/** Return the number of stored coordinates. 0 for NULL. */
int dvi_system_nq(const dvi_system *system);

/** Return the size of v and p. 0 for NULL. It is the number of degrees of freedom, but directions
 *  have three numbers for their two. */
int dvi_system_nv(const dvi_system *system);

/** Return 1 if the system was declared autonomous, else 0. 0 for NULL. */
int dvi_system_autonomous(const dvi_system *system);

/** Return the number of constraints phi(q,p) = 0 of a Hamiltonian, or of rows of holonomic
 *  constraints and of nonholonomic ones behind them. 0 for other systems, and for NULL. */
int dvi_system_constraint_count(const dvi_system *system);

/** Evaluate the Lagrangian at (t, q [nq], v [nv]). The call allocates.
 *
 *  @retval DVI_UNSUPPORTED  the system has a Hamiltonian
 *  @retval (others)         as the callbacks fail */
dvi_status dvi_system_lagrangian(const dvi_system *system, double t, const double *q,
                                 const double *v, double *L);

/** Evaluate the Legendre map p = L_v(t,q,v) [nv] (Marsden and West 2001, sec. 1.2.5). The call
 *  allocates.
 *
 *  @retval DVI_UNSUPPORTED  the system has a Hamiltonian, where a v may have several p, or none
 *  @retval (others)         as the callbacks fail */
dvi_status dvi_system_momentum(const dvi_system *system, double t, const double *q, const double *v,
                               double *p);

/** Evaluate the inverse Legendre map, the v [nv] with L_v(t,q,v) = p, by Newton's method from the
 *  given v.
 *
 *  If the iteration does not converge, velocities along p are tried as guesses. A degenerate
 *  Lagrangian alpha.v - H has no such map. There v is that of the equations of motion,
 *  Omega(q) v = dH/dq, and p does not matter. With a Hamiltonian v = H_p, with constraints
 *  v = H_p + phi_p^T lambda.
 *  @param[in,out] v  [nv] a starting guess (read for general Lagrangians only), then the velocity.
 *                    Unchanged on failure
 *  @retval DVI_SINGULAR       L_vv is singular at every guess, or Omega or the constraints' bracket
 *                             matrix is singular
 *  @retval DVI_NOT_CONVERGED  Newton's method did not converge from any guess
 *  @retval DVI_BAD_ARGUMENT   an argument is NULL
 *  @retval DVI_NOT_FINITE     an argument, or the velocity that was found, is not finite
 *  @retval DVI_NO_MEMORY      memory could not be allocated
 *  @retval (others)           as the callbacks fail */
dvi_status dvi_system_velocity(const dvi_system *system, double t, const double *q, const double *p,
                               double *v);

/** Return the distance of q [nq] from the configuration space of a system with factors: the largest
 *  distance from a rotation (dvi_so3_distance) or ||q| - 1|. 0 without factors. NaN for NULL, and
 *  if a coordinate of a factor is NaN. */
double dvi_system_distance(const dvi_system *system, const double *q);

/** Project q [nq] onto the configuration space, on the nearest rotations and unit vectors.
 *
 *  Integrators never project, and refuse to start farther off than rounding. Call this function
 *  where a projection is meant.
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, a vector is zero, or a matrix is singular or nearer
 *                            to a reflection than to a rotation. q is unchanged then
 *  @retval DVI_NOT_FINITE    a number is not finite */
dvi_status dvi_system_project(const dvi_system *system, double *q);

/** Compute the two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j of a system with a one-form, and
 *  its condition number. The call allocates.
 *
 *  @param[out] Omega      [n*n] column by column, antisymmetric. May be NULL
 *  @param[out] condition  |Omega| |Omega^-1| in the norm of the largest column sum, infinite where
 *                         Omega is singular. May be NULL
 *  @retval DVI_UNSUPPORTED   the system has no one-form
 *  @retval DVI_BAD_ARGUMENT  system or q is NULL
 *  @retval DVI_NOT_FINITE    q is not finite
 *  @retval DVI_NO_MEMORY     memory could not be allocated
 *  @retval (others)          as the one-form's callback fails */
dvi_status dvi_system_two_form(const dvi_system *system, const double *q, double *Omega,
                               double *condition);

/** Compute the bracket matrix B_ab = {phi_a, phi_b} = phi_a,q.phi_b,p - phi_a,p.phi_b,q of a
 *  Hamiltonian's m constraints, and its condition number. The call allocates.
 *
 *  @param[out] bracket    [m*m] column by column, antisymmetric. May be NULL
 *  @param[out] condition  |B| |B^-1| in the norm of the largest column sum, infinite where B is
 *                         singular. May be NULL
 *  @retval DVI_UNSUPPORTED  the system has no constraints phi(q,p) */
dvi_status dvi_system_bracket(const dvi_system *system, const double *q, const double *p,
                              double *bracket, double *condition);

/** Return the number of watched invariants. They are the energy, one momentum for each symmetry,
 *  and the declared ones, in this order. 0 for NULL. */
int dvi_system_invariant_count(const dvi_system *system);

/** Return the name of invariant i. Invariant 0 is "energy". NULL if i is out of range. */
const char *dvi_system_invariant_name(const dvi_system *system, int i);

/** Evaluate all invariants at (t, q [nq], p [nv]). The call allocates. dvi_integrator_invariants
 *  does not.
 *
 *  The energy is p.v - L with v from the inverse Legendre map. With a one-form, or a Hamiltonian,
 *  the energy is H.
 *  @param[out] value  [dvi_system_invariant_count] */
dvi_status dvi_system_invariants(const dvi_system *system, double t, const double *q,
                                 const double *p, double *value);

/** Findings of the derivative check. */
typedef struct dvi_derivative_check {
  double gradient_error; /**< largest difference of a gradient, relative to the largest entry */
  double hessian_error;  /**< largest difference of a Hessian on the pattern, relative */
  /** largest differenced entry outside the pattern, relative. If it exceeds roundoff, the pattern
   *  is wrong */
  double outside;
  /** place of `outside`, or of the worst Hessian entry if nothing is outside */
  int row, column;
  /** the worst finding in words, for example "potential 'gravity': d2V/dq2 (3,1) is not in the
   *  pattern" */
  char where[96];
  int range_row;       /**< first coordinate for which a gradient_range breaks its promise, or -1 */
  double rate_error;   /**< largest difference of a rate, relative to the rate */
  int depends_on_time; /**< 1 if declared autonomous, but a callback's results change with t */
  int not_quadratic;   /**< 1 if a Hessian of a potential declared quadratic changes with q or t */
  /** largest difference of a Taylor coefficient and the one-point callbacks, or differences of the
   *  coefficient below it, relative */
  double taylor_error;
} dvi_derivative_check;

/** Compare every gradient, Hessian, pattern and rate of the system with differences of the values
 *  at one point. Derivatives of forces and of rows A count as Hessians. A may not be integrable.
 *
 *  Every gradient_range is compared, bit for bit, with the whole gradient, over short and long
 *  ranges, with NaN outside its reach. In an autonomous system every callback must give the same
 *  numbers at two other times. The gradient of a quadratic potential must be linear in q. Taylor
 *  coefficients, up to DVI_TAYLOR_MAX of them, are compared with the other callbacks. Each is also
 *  compared with differences of the one below it along a curve through the point, as far as
 *  rounding permits. The coefficients may not depend on the degree of the call, nor on which
 *  results are NULL.
 *
 *  The check uses central differences of order 6 and n^2 gradient calls. It is meant for tests and
 *  for moderate n.
 *  @param      q, v       [nq], [nv] a point in general position. With a Hamiltonian v stands for p
 *  @param      tolerance  largest relative difference to accept (default 1e-6)
 *  @param[out] check      the findings. May be NULL
 *  @retval DVI_OK            all callbacks agree
 *  @retval DVI_BAD_ARGUMENT  a callback does not agree, and the error sentence names it. Or an
 *                            argument is NULL, or the tolerance is negative
 *  @retval DVI_NOT_FINITE    the point is not finite
 *  @retval DVI_NO_MEMORY     memory could not be allocated
 *  @retval (others)          as the callbacks fail */
dvi_status dvi_system_check(const dvi_system *system, double t, const double *q, const double *v,
                            double tolerance, dvi_derivative_check *check);

#ifdef __cplusplus
}
#endif
#endif
