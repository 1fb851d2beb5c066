/** Function spaces of your own: paths of polynomials and of functions that you give by their values and derivatives.
 *
 *      q(t0 + tau h) = q0 + sum_k Y_k (e_k(tau) - e_k(0)),      e_k: tau, .., tau^degree, f_1(tau), .., f_m(tau),      0 <= tau <= 1,
 *      Ld(q0,q1) = ext over such paths from q0 to q1 of  h sum_j b_j L(t0 + c_j h, q_j, q'_j/h).
 *
 *  The f_k are yours: sin(omega h tau), exp(-tau), truncated powers max(0, tau - 1/2)^3, tau^7. Constants and polynomials are in the space by themselves, and so the
 *  start q0 is any point, and straight motion is exact. The quadrature is one of the library's, or yours.
 *
 *  What follows from the action holds in every such space and with every such quadrature: steps are symplectic, and keep the momenta of linear symmetries if all
 *  coordinates that the symmetry turns into each other have the same functions. How accurate they are is up to the functions. docs/shapes.md has a complete program.
 *
 *  They are the `shapes` of dvi_integrator_options. Its method is then `shaped-galerkin`, with keys `degree` (of the
 *  polynomials; default 1), `quadrature` and `nodes` as of galerkin (default: gauss, as many as there are functions and
 *  degrees; more of them pay, for functions that are no polynomials), or a composition of it:
 *  "composition:order=6,base=shaped-galerkin,nodes=4". The system is as for galerkin, without factors, one-form or
 *  constraints.
 *
 *  Creation checks the functions: each number is written and finite; derivatives agree with differences of values; no
 *  function is a combination of those before it, of polynomials and a constant, as the quadrature sees it, nor changes
 *  by 100 times what the derivatives that it sees allow; nodes lie in [0,1], weights sum to 1. Whether the step is
 *  symmetric is found out. At another length of the step numbers, nodes and weights are checked again; a function of
 *  which less than 1e-8 of itself is left, as of sin(omega h tau) at a tiny omega h, is left out there. It fails by
 *
 *  - DVI_BAD_ARGUMENT: the functions, the points or the coordinates are not as described; the sentence names function
 *    and place;
 *  - DVI_BAD_SIZE: a count is out of range;
 *  - DVI_BAD_OPTION: another method; a key or a value that it cannot take; fewer points than functions;
 *  - DVI_NOT_FINITE: a callback gave NaN or Inf, or left a number out;
 *  - DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED: a callback failed.
 *
 *  Steps fail by the last three statuses, too, where a new length of the step does. dvi_integrator_create_like, the
 *  diagnostics, checkpoints and dense output know the functions; a checkpoint of a space of another name, or with other
 *  values, is refused. Source: Marsden and West 2001, sec. 2.2.6; Hall and Leok 2015. */
#ifndef DVI_SHAPES_H
#define DVI_SHAPES_H
#include <dvi/integrator.h>

/** Most functions, and most points of a quadrature of your own. */
#define DVI_SHAPES_MOST 40
#define DVI_SHAPES_POINTS_MOST 1000

/** Functions of one step, and what goes with them; what is zero means default.
 *
 *  Callbacks return 0; a positive number if a smaller step may help, a negative one if nothing will. They depend on their arguments alone: a value is asked for as often
 *  as the library likes. Backward steps, and substeps of compositions, have negative lengths. */
typedef struct dvi_shapes {
  /** Names the space in specifications, sentences and checkpoints: 1 to 40 letters, digits, '-', '_' or '.'. */
  const char *name;
  /** How many functions f_k, 1 to DVI_SHAPES_MOST. */
  int functions;
  /** f_k and df_k/dtau [functions] at tau, 0 <= tau <= 1, for a step of length h. The size of a function, and constants in it, do not matter: the library makes an
   *  orthonormal basis. */
  int (*evaluate)(double h, double tau, double *value, double *derivative, void *user);
  /** Other than 0: functions or points depend on the step, and this is a length at which creation checks them. 0: they do not; callbacks get h = 1. */
  double h;
  /** [coordinate_count] coordinates that have the functions, numbered from 0; all others have the polynomials alone. NULL: all have them. */
  const int *coordinates;
  int coordinate_count;
  /** A quadrature of your own: where point j is in [0,1], its weight b_j, and f_k and df_k/dtau [functions] there. NULL: that of the keys `quadrature` and `nodes`.
   *
   *  The weights sum to 1. A point need not lie on the path: a rule for oscillations samples several phases of one time (docs/methods/multiscale.md); values are then
   *  those of the sample. Only where point points-1-j mirrors point j the method can be found to be symmetric. */
  int (*point)(double h, int j, double *tau, double *weight, double *value, double *derivative, void *user);
  /** How many points `point` has, 1 to DVI_SHAPES_POINTS_MOST. */
  int points;
  /** The order that you claim, which dvi_integrator_order tells. 0: what the polynomials alone claim, min(2 d, u, 2 (u-d+1)) for degree d and a quadrature of order u. */
  int order;
  /** Handed to the callbacks; must outlive the integrator. */
  void *user;
} dvi_shapes;

#endif
