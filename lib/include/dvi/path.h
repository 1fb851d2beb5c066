/** A whole path at once, on which the discrete action of all its steps is stationary.
 *
 *      S(q_0, .. , q_N) = sum_k Ld(t_k, q_k, q_(k+1)),      t_k = start + k h,   h = span/N,
 *
 *  with the discrete Lagrangian Ld of a method that is one element of the action: galerkin,
 *  midpoint, trapezoidal, and hp and hamiltonian of types 1 to 3. `ends` says which q_k may be
 *  varied. The stationarity conditions are the steps of that method, joined:
 *
 *      p_k = -D1 Ld(q_k, q_(k+1)) = D2 Ld(q_(k-1), q_k).
 *
 *  They are one sparse system with the bands of a chain, solved by Newton's method with line search
 *  (KINSOL) and KLU. Work and memory are proportional to N. Source: Marsden and West 2001, sec. 1.3
 *  and 2.2. */
#ifndef DVI_PATH_H
#define DVI_PATH_H
#include <dvi/integrator.h>

/** Boundary conditions of a path. */
typedef enum dvi_ends {
  DVI_ENDS_FIXED = 1, /**< q_0 and q_N are given, as in Hamilton's principle */
  DVI_ENDS_INITIAL,   /**< q_0 and p_0 are given. This is N steps forward, as one system */
  /** q_N = A q_0 + a. The path closes, or closes up to a symmetry, and p_0 = A^T p_N follows */
  DVI_ENDS_PERIODIC,
  /** each coordinate of q_0 and of q_N is given, or free with its momentum given. These are the
   *  natural boundary conditions of the calculus of variations */
  DVI_ENDS_MIXED
} dvi_ends;

/** Options of a path. All of them are copied. */
typedef struct dvi_path_options {
  dvi_ends ends;
  int steps;    /**< N, at least 1 (with fixed ends at least 2, or 1 from degree 2 on) */
  double start; /**< the time t_0 */
  /** time from the first to the last node, > 0. With free_span it is a guess */
  double span;
  /** length of each of the arrays below, nq. May be 0 if all of them are NULL */
  int dimension;
  const double *q0; /**< first node, for fixed, initial and mixed ends (guesses where free) */
  const double *q1; /**< last node, for fixed and mixed ends (guesses where free) */
  const double *p0; /**< first momentum, for initial and mixed ends */
  const double *p1; /**< last momentum, for mixed ends */
  /** not 0 for the coordinates of q_0, and of q_N, that are free. Their momenta are those of p0 and
   *  p1. For mixed ends. NULL: none is free */
  const char *free0, *free1;
  /** A [nq x nq] by columns, or on a pattern, for periodic ends (default the identity). A must be a
   *  symmetry of the Lagrangian. A symmetry that exchanges bodies makes them follow each other on
   *  one curve (a choreography of which this path is one part). A rotation makes the path
   *  relatively periodic. */
  const double *symmetry;
  dvi_pattern symmetry_pattern; /**< rows and columns of `symmetry` (default: a full matrix) */
  /** a [nq], added to the last node (an angle that has turned by 2 pi), for periodic ends. Default:
   *  0 */
  const double *shift;
  /** not 0 if the span is an unknown, and the path has the discrete energy below. For periodic ends
   *  of autonomous systems */
  int free_span;
  double energy; /**< the discrete energy -dS/dspan with free_span, else 0 */
} dvi_path_options;

/** Results of a solve. */
typedef struct dvi_path_report {
  double action; /**< S, over the span */
  /** -dS/dspan, the mean of the steps' discrete energies. NaN if the system is not declared
   *  autonomous */
  double energy;
  double span; /**< the time from the first to the last node */
  /** The largest minus the smallest energy at the nodes, from q and p there, beyond roundings. A
   *  motion keeps its energy. NaN if the system is not declared autonomous. */
  double energy_spread;
  /** largest kinetic energy |p.v|/2 at the nodes. NaN if the system is not declared autonomous */
  double kinetic;
  /** largest |E_(k+1) - E_k| over a step, beyond roundings, relative to the larger kinetic energy
   *  of its two nodes. Inf if both are at rest. NaN if the system is not declared autonomous */
  double energy_jump;
  int jump_step; /**< the k of the step of energy_jump. 0 if there is none */
  /** largest |dS/dX| over nodes and inner unknowns, relative to the largest momentum. It is the
   *  residual of stationarity */
  double gradient;
  /** Number of negative eigenvalues of the second variation on the paths with these ends, at this
   *  span.
   *
   *  An eigenvalue lambda of d2S = lambda / span^2 times the kinetic weight sum_k h |L_vv| dq_k^2
   *  is called zero if |lambda| < zero_below. If negative is 0, the action has a minimum there,
   *  else a saddle. For fixed ends negative is the number of conjugate points (Morse). It is -1
   *  where it is not defined (initial ends) or could not be found. It is also -1 where zero <
   *  symmetries. Such steps are too long: symmetries do not have the eigenvalue 0, and the signs of
   *  other eigenvalues are not resolved. Take more steps. */
  long negative;
  /** number of zero eigenvalues, directions along which the action stays as it is. -1 where it is
   *  not defined or could not be found */
  long zero;
  /** number of directions along which a periodic path may be moved at will: time, and declared
   *  symmetries that the ends keep */
  int symmetries;
  /** largest |lambda| that is called zero. It is 1e-6, or the effect of roundoff on a zero
   *  eigenvalue for N beyond 2e4 */
  double zero_below;
  int iterations; /**< iterations of KINSOL and Newton's method */
} dvi_path_report;

/** A path: its nodes, and the workspace that makes it stationary. */
typedef struct dvi_path dvi_path;

#ifdef __cplusplus
extern "C" {
#endif

/** Make a path. Its first guess is the straight line between fixed ends, else a path at rest, at q0
 *  or, for periodic ends, at 0.
 *
 *  The system must outlive the path. One symbolic analysis of the whole Jacobian happens here.
 *  @param      method  specification of galerkin, midpoint or trapezoidal, or of hp or hamiltonian
 *                      of types 1 to 3, see dvi/method.h. Without `solver`
 *  @param[out] path    owned by the caller. NULL on failure
 *  @retval DVI_BAD_OPTION    the method is none of these, or its specification makes no sense
 *  @retval DVI_UNSUPPORTED   the system declares a one-form, whose equations are of first order
 *  @retval DVI_BAD_ARGUMENT  the span is not positive and finite. Or an array is missing, not
 *                            finite, or given although these ends do not use it. Or free_span is
 *                            set without periodic ends, or for a system that is not declared
 *                            autonomous. Or an energy is given without free_span, or a
 *                            symmetry_pattern without symmetry
 *  @retval DVI_BAD_SIZE      steps is out of range, dimension is not nq, or there are more unknowns
 *                            or entries than an int can count
 *  @retval DVI_NO_MEMORY     also for absurdly many steps */
dvi_status dvi_path_create(const dvi_system *system, const char *method,
                           const dvi_path_options *options, dvi_path **path);

/** Free a path and set the pointer to NULL. NULL is allowed. */
void dvi_path_destroy(dvi_path **path);

/** Guess the path from points on it, joined by straight lines. Given ends stay.
 *
 *  @param points     number of points, at least 2
 *  @param dimension  must be nq
 *  @param t          [points] ascending. The first time is taken for the path's start, the last one
 *                    for its end
 *  @param q          [points*nq], point after point
 *  @retval DVI_BAD_SIZE      points or dimension is out of range
 *  @retval DVI_BAD_ARGUMENT  a number is not finite, or the times are not ascending. The guess is
 *                            unchanged */
dvi_status dvi_path_guess(dvi_path *path, int points, int dimension, const double *t,
                          const double *q);

/** Guess the path as last + ratio (last - before), the predictor of continuation. Both are solved
 *  paths of the same shape (dimension, ends, steps, degree), for example of the same problem with
 *  other parameters.
 *
 *  @param before  NULL makes `last` the guess
 *  @retval DVI_BAD_SIZE      the shapes differ
 *  @retval DVI_BAD_ARGUMENT  ratio is not finite. The guess is unchanged */
dvi_status dvi_path_guess_along(dvi_path *path, const dvi_path *last, const dvi_path *before,
                                double ratio);

/** Make the action stationary, from the guess or from the path of the last solve. On failure the
 *  path is unchanged, except for DVI_STEP_TOO_LARGE.
 *
 *  @param[out] report  may be NULL
 *  @retval DVI_STEP_TOO_LARGE  the path is stationary, but its steps follow no motion. Over the
 *                              path, or in a step, the energy changes by more than a tenth of the
 *                              kinetic energy. Path and report are those that were found
 *  @retval DVI_NOT_CONVERGED   no stationary path was found from there, or (with many conjugate
 *                              points ahead) there is none
 *  @retval DVI_SINGULAR        the path that was found is not isolated, beyond its symmetries. The
 *                              ends are conjugate, and neighbouring paths are stationary, too, or
 *                              roundoff decided between them
 *  @retval DVI_BAD_ARGUMENT    `symmetry` is no symmetry of the Lagrangian, or the span is no
 *                              period of a time-dependent one. At the guess's first node, or at a
 *                              node of the path that was found, the image has another L, L_q or L_v
 *  @retval DVI_NOT_FINITE, DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  from the callbacks
 *  @retval DVI_NO_MEMORY       also if KLU could not allocate memory */
dvi_status dvi_path_solve(dvi_path *path, dvi_path_report *report);

/** Return the number of steps N. There are N+1 nodes. 0 for NULL. */
int dvi_path_steps(const dvi_path *path);

/** Return the time of node k, 0 <= k <= N. NaN if k is out of range, or for NULL. */
double dvi_path_time(const dvi_path *path, int k);

/** Return the coordinates [nq] of node k. NULL if k is out of range. Owned by the path, valid until
 *  its next call. */
const double *dvi_path_q(const dvi_path *path, int k);

/** Return the momenta [nv] of node k. NULL if k is out of range, or if the path was not solved.
 *  Owned by the path, valid until its next call. */
const double *dvi_path_p(const dvi_path *path, int k);

/** Return the method's full specification. Owned by the path. NULL for NULL. */
const char *dvi_path_method(const dvi_path *path);

/** Copy the counters since the path's creation. All are 0 for NULL. `steps` counts nothing here. */
void dvi_path_counters(const dvi_path *path, dvi_counters *counters);

#ifdef __cplusplus
}
#endif
#endif
