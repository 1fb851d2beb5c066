/** Function spaces of your own: paths of polynomials and of functions that you give by their values
 *  and derivatives.
 *
 *      q(t0 + tau h) = q0 + sum_k Y_k (e_k(tau) - e_k(0)),
 *      e_k: tau, .., tau^degree, f_1(tau), .., f_m(tau),      0 <= tau <= 1,
 *      Ld(q0,q1) = ext over such paths from q0 to q1 of  h sum_j b_j L(t0 + c_j h, q_j, q'_j/h).
 *
 *  The f_k are yours, for example sin(omega h tau), exp(-tau), truncated powers
 *  max(0, tau - 1/2)^3, or tau^7. The space always holds constants and polynomials. So the start q0
 *  is any point, and straight motion is exact. The quadrature is one of the library's, or yours.
 *
 *  In every such space and with every such quadrature the steps are symplectic. They keep the
 *  momenta of linear symmetries if all coordinates that the symmetry turns into each other have the
 *  same functions. The accuracy is up to the functions. docs/shapes.md has a complete program.
 *
 *  Functions are the `shapes` of dvi_integrator_options, with the method `shaped-galerkin`. Its
 *  keys are `degree` (of the polynomials, default 1), and `quadrature` and `nodes` as of galerkin
 *  (default gauss, with as many nodes as there are functions and degrees). More nodes pay for
 *  functions that are no polynomials. A composition may use the method, as in
 *  "composition:order=6,base=shaped-galerkin,nodes=4". The system is as for galerkin, without
 *  factors, one-form or constraints.
 *
 *  Creation checks the functions:
 *    - each number is written and finite,
 *    - derivatives agree with differences of values,
 *    - no function is, at the quadrature points, a combination of those before it, of polynomials
 *      and a constant,
 *    - no function changes by 100 times the amount that its derivatives at these points allow,
 *    - nodes lie in [0,1], and weights sum to 1.
 *
 *  Creation also finds out whether the step is symmetric. At another length of the step numbers,
 *  nodes and weights are checked again. A function of which less than 1e-8 of itself remains, such
 *  as sin(omega h tau) at a tiny omega h, is left out there. Creation fails by
 *
 *  - DVI_BAD_ARGUMENT if the functions, the points or the coordinates are not as described. The
 *    sentence names function and place,
 *  - DVI_BAD_SIZE if a count is out of range,
 *  - DVI_BAD_OPTION for another method, for a key or a value that the method cannot take, or for
 *    fewer points than functions,
 *  - DVI_NOT_FINITE if a callback gave NaN or Inf, or left a number out,
 *  - DVI_CALLBACK_RETRY or DVI_CALLBACK_FAILED if a callback failed.
 *
 *  A step of a new length fails by the last three statuses, too. dvi_integrator_create_like, the
 *  diagnostics, checkpoints and dense output know the functions. A checkpoint of a space of another
 *  name, or with other values, is refused. Sources: Marsden and West 2001, sec. 2.2.6, and Hall and
 *  Leok 2015. */
#ifndef DVI_SHAPES_H
#define DVI_SHAPES_H
#include <dvi/integrator.h>

/** Most functions, and most points of a quadrature of your own. */
#define DVI_SHAPES_MOST 40
#define DVI_SHAPES_POINTS_MOST 1000

/** The flow of an integrable part H0 of the Hamiltonian H = H0 + H1, as the function space of
 *  `flow-galerkin`. The paths of a step are z(t) = phi_tau(w(t)), with z = (q,p), the flow phi of
 *  H0, the time tau from the middle of the step, and polynomials w.
 *
 *  phi must be the exact flow of H0 for every tau of either sign, phi_0 = 1 and phi_s(phi_t) =
 *  phi_{s+t}, and canonical, both to rounding, or the steps are not symplectic. Only H1 is
 *  sampled, by quadrature. A batch of points is stored component by component: coordinate i of
 *  point k is q[i*count + k], and tau[k] is the time of point k. No output is an input. Callbacks
 *  return 0, a positive number if a smaller step may help, or a negative one if nothing will. Their
 *  results depend on their arguments alone. Equations and sources are in
 *  docs/methods/split/flow_galerkin.md. */
typedef struct dvi_flow {
  /** sizeof(dvi_flow). */
  size_t size;
  /** The points (to_q,to_p) = phi_tau(q,p), [n*count] each. Required. */
  int (*move)(int count, const double *tau, const double *q, const double *p, double *to_q,
              double *to_p, void *user);
  /** The covectors (by_q,by_p) = D phi_tau(q,p)^T (lambda_q,lambda_p), [n*count] each: the
   *  derivatives by q and by p of lambda_q.to_q + lambda_p.to_p. lambda_p is NULL, and stands for
   *  0, unless there is a `rest`. Required. */
  int (*pullback)(int count, const double *tau, const double *q, const double *p,
                  const double *lambda_q, const double *lambda_p, double *by_q, double *by_p,
                  void *user);
  /** dH1/dq and dH1/dp [n*count] at times t [count]. Default: H1 is the sum of the potentials that
   *  are not declared `fast`, and H0 the kinetic energy and the fast potentials. */
  int (*rest)(int count, const double *t, const double *q, const double *p, double *H_q,
              double *H_p, void *user);
  /** Data of the callbacks. Must outlive the integrator. */
  void *user;
} dvi_flow;

/** Functions of one step, and their quadrature. Zero means default.
 *
 *  Callbacks return 0, a positive number if a smaller step may help, or a negative one if nothing
 *  will. Their results depend on their arguments alone, because the library may ask for a value any
 *  number of times. Backward steps, and substeps of compositions, have negative lengths. */
typedef struct dvi_shapes {
  /** Name of the space in specifications, sentences and checkpoints: 1 to 40 letters, digits, '-',
   *  '_' or '.'. */
  const char *name;
  /** Number of functions f_k, 1 to DVI_SHAPES_MOST, or 0 beside a flow. */
  int functions;
  /** f_k and df_k/dtau [functions] at tau, 0 <= tau <= 1, for a step of length h. The size of a
   *  function, and constants in it, do not matter, because the library makes an orthonormal
   *  basis. */
  int (*evaluate)(double h, double tau, double *value, double *derivative, void *user);
  /** A length at which creation checks functions or points that depend on the step. Default: they
   *  do not depend on it, and callbacks get h = 1. */
  double h;
  /** [coordinate_count] coordinates that have the functions, numbered from 0. All others have the
   *  polynomials alone. NULL if all have the functions. */
  const int *coordinates;
  int coordinate_count;
  /** A quadrature of your own: the place of point j in [0,1], its weight b_j, and f_k and df_k/dtau
   *  [functions] there. Default: the quadrature of the keys `quadrature` and `nodes`.
   *
   *  The weights sum to 1. A point need not lie on the path. A rule for oscillations samples
   *  several phases of one time (docs/methods/multiscale.md), and values are then those of the
   *  sample. The method can be symmetric only where point points-1-j mirrors point j. */
  int (*point)(double h, int j, double *tau, double *weight, double *value, double *derivative,
               void *user);
  /** Number of points of `point`, 1 to DVI_SHAPES_POINTS_MOST. */
  int points;
  /** Order that you claim, returned by dvi_integrator_order. Default: the order that the
   *  polynomials alone claim, min(2 d, u, 2 (u-d+1)) for degree d and a quadrature of order u. */
  int order;
  /** Data of the callbacks. Must outlive the integrator. */
  void *user;
  /** A flow in the place of functions, for `flow-galerkin`, copied. The other members but the name
   *  are then 0. Default: there are functions. */
  const dvi_flow *flow;
} dvi_shapes;

#endif
