/** A whole path at once: the discrete action of all its steps made stationary.
 *
 *      S(q_0, .. , q_N) = sum_k Ld(t_k, q_k, q_(k+1)),      t_k = start + k h,   h = span/N,
 *
 *  with the discrete Lagrangian Ld of a method that is one element of the action: galerkin,
 *  midpoint, trapezoidal, and hp and hamiltonian of types 1 to 3. Which q_k may be varied is what
 *  `ends` says; the stationarity conditions are the steps of that method, joined: p_k = -D1 Ld(q_k,
 *  q_(k+1)) = D2 Ld(q_(k-1), q_k). They are one sparse system with the bands of a chain, solved by
 *  Newton's method with line search (KINSOL) and KLU: work and memory in proportion to N. Source:
 *  Marsden and West 2001, sec. 1.3 and 2.2. */
#ifndef DVI_PATH_H
#define DVI_PATH_H
#include <dvi/integrator.h>

/** What is known of the ends of a path. */
typedef enum dvi_ends {
  DVI_ENDS_FIXED = 1, /**< q_0 and q_N are given: Hamilton's principle */
  DVI_ENDS_INITIAL,   /**< q_0 and p_0 are given: N steps forward, as one system */
  /** q_N = A q_0 + a: closed, or closed up to a symmetry; p_0 = A^T p_N follows */
  DVI_ENDS_PERIODIC
} dvi_ends;

/** What a path is to be; all of it is copied. */
typedef struct dvi_path_options {
  dvi_ends ends;
  int steps;    /**< N, at least 1 (fixed ends: 2, or 1 from degree 2 on) */
  double start; /**< the time t_0 */
  /** the time from the first to the last node, > 0; with free_span: a guess of it */
  double span;
  /** numbers in each of the arrays below: nq; may be 0 if all of them are NULL */
  int dimension;
  const double *q0; /**< first node; for fixed and initial ends */
  const double *q1; /**< last node; for fixed ends */
  const double *p0; /**< first momentum; for initial ends */
  /** A [nq x nq] by columns, or on a pattern; NULL: the identity. A symmetry of the Lagrangian, for
   *  periodic ends: one that exchanges bodies makes them follow each other on one curve (a
   *  choreography of which this path is one part), a rotation makes the path relatively
   * periodic. */
  const double *symmetry;
  dvi_pattern symmetry_pattern; /**< rows and columns of `symmetry`; all zero: a full matrix */
  /** a [nq], added to the last node (an angle that has turned by 2 pi); NULL: 0. For periodic
   * ends */
  const double *shift;
  /** not 0: for periodic ends of autonomous systems, the span is an unknown, too, and */
  int free_span;
  double energy; /**< the path has this discrete energy, -dS/dspan; else 0 */
} dvi_path_options;

/** How a solve went, and what it found. */
typedef struct dvi_path_report {
  double action; /**< S, over the span */
  /** -dS/dspan, the mean of the steps' discrete energies; NaN if the system is not declared
   * autonomous */
  double energy;
  double span; /**< the time from the first to the last node */
  /** The largest minus the smallest energy at the nodes, from q and p there, beyond roundings: a
   *  motion keeps its energy. NaN, as the next two, if the system is not declared autonomous. */
  double energy_spread;
  double kinetic;     /**< the largest kinetic energy |p.v|/2 at the nodes */
  double energy_jump; /**< the largest |E_(k+1) - E_k| over a step, beyond roundings, relative to
                       *   the larger kinetic energy of its two nodes; Inf if both are at rest */
  int jump_step;      /**< the k of that step; 0 if there is none */
  double
      /** largest |dS/dX| over nodes and inner unknowns, relative to the largest momentum: what is
       * left of stationarity */
      gradient;
  /** Signs of the second variation on the paths with these ends, at this span. An eigenvalue lambda
   *  of d2S = lambda / span^2 times the kinetic weight sum_k h |L_vv| dq_k^2 is called zero if
   *  |lambda| < zero_below. negative = 0: the action has a minimum there; else a saddle. Its number
   *  is that of the conjugate points, for fixed ends (Morse). -1 where it is not defined (initial
   *  ends) or could not be found, and where zero < symmetries: steps so long that symmetries do not
   *  have the eigenvalue 0 do not resolve the signs of others. Take more steps. */
  long negative;
  long
      /** the number of zeros: directions along which the action stays as it is; -1 where it is not
       * defined or could not be found */
      zero;
  /** directions along which a periodic path may be moved at will: time, and declared symmetries
   * that the ends keep */
  int symmetries;
  /** the largest |lambda| that is called zero: 1e-6, or what roundoff makes of 0 for N beyond
   * 2e4 */
  double zero_below;
  int iterations; /**< of KINSOL and Newton's method */
} dvi_path_report;

/** A path: its nodes, and all that is needed to make it stationary. */
typedef struct dvi_path dvi_path;

#ifdef __cplusplus
extern "C" {
#endif

/** Make a path; its first guess is the straight line between fixed ends, else a path at rest: at
 * q0, or at 0 for periodic ends.
 *
 *  The system must outlive it. One symbolic analysis of the whole Jacobian happens here.
 *  @param      method  specification of galerkin, midpoint or trapezoidal, or of hp or hamiltonian
 *                      of types 1 to 3, see dvi/method.h; without `solver`
 *  @param[out] path    owned by the caller; NULL on failure
 *  @retval DVI_BAD_OPTION    the method is none of these, or its specification makes no sense
 *  @retval DVI_UNSUPPORTED   the system declares a one-form: its equations are of first order
 *  @retval DVI_BAD_ARGUMENT  the span is not positive and finite; an array is missing, given
 *                            although these ends have no use for it, or not finite; free_span
 *                            without periodic ends, or for a system that is not declared
 *                            autonomous; an energy without free_span, a symmetry_pattern without
 *                            symmetry
 *  @retval DVI_BAD_SIZE      steps is out of range, dimension is not nq, or there are more unknowns
 *                            or entries than an int can count
 *  @retval DVI_NO_MEMORY     also for absurdly many steps */
dvi_status dvi_path_create(const dvi_system *system, const char *method,
                           const dvi_path_options *options, dvi_path **path);

/** Free a path and set the pointer to NULL; NULL is allowed. */
void dvi_path_destroy(dvi_path **path);

/** Guess the path from points on it, joined by straight lines; given ends stay.
 *
 *  @param points     how many, at least 2
 *  @param dimension  must be nq
 *  @param t          [points] ascending; the first one is taken for the path's start, the last one
 *                    for its end
 *  @param q          [points*nq], point after point
 *  @retval DVI_BAD_SIZE      points or dimension
 *  @retval DVI_BAD_ARGUMENT  a number is not finite, or the times are not ascending; the guess is
 *                            as before */
dvi_status dvi_path_guess(dvi_path *path, int points, int dimension, const double *t,
                          const double *q);

/** Guess the path from solved ones of the same shape (dimension, ends, steps, degree), for example
 *  of the same problem with other parameters: last + ratio (last - before). The predictor of
 *  continuation.
 *
 *  @param before  NULL: the guess is `last`
 *  @retval DVI_BAD_SIZE      the shapes differ
 *  @retval DVI_BAD_ARGUMENT  ratio is not finite; the guess is as before */
dvi_status dvi_path_guess_along(dvi_path *path, const dvi_path *last, const dvi_path *before,
                                double ratio);

/** Make the action stationary, from the guess or from the path that is there. On failure the path
 *  stays as it was, but for DVI_STEP_TOO_LARGE.
 *
 *  @param[out] report  may be NULL
 *  @retval DVI_STEP_TOO_LARGE  the path that was found is stationary, but its steps follow no
 *                              motion: over the path, or in a step, the energy changes by more than
 *                              a tenth of the kinetic energy. Path and report are those that were
 *                              found
 *  @retval DVI_NOT_CONVERGED   no stationary path was found from there, or (with many conjugate
 *                              points ahead) there is none
 *  @retval DVI_SINGULAR        the path that was found is not isolated, beyond its symmetries: the
 *                              ends are conjugate, and every path beside it is as good, or roundoff
 *                              decided which one it is
 *  @retval DVI_BAD_ARGUMENT    the Lagrangian does not have `symmetry` for a symmetry, or,
 *                              depending on time, not the period: L, L_q or L_v is another one
 *                              where they take the guess's first node, or a node of the path that
 *                              was found
 *  @retval DVI_NOT_FINITE, DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  from the callbacks
 *  @retval DVI_NO_MEMORY       KLU's own, too */
dvi_status dvi_path_solve(dvi_path *path, dvi_path_report *report);

/** Number of steps N, there are N+1 nodes; 0 for NULL. */
int dvi_path_steps(const dvi_path *path);

/** Time of node k, 0 <= k <= N; NaN if out of range, or for NULL. */
double dvi_path_time(const dvi_path *path, int k);

/** Coordinates [nq] of node k; NULL if out of range. Owned by the path; valid until its next
 * call. */
const double *dvi_path_q(const dvi_path *path, int k);

/** Momenta [nv] of node k; NULL if out of range, or if the path was not solved. Owned by the path;
 * valid until its next call. */
const double *dvi_path_p(const dvi_path *path, int k);

/** The method's full specification; owned by the path; NULL for NULL. */
const char *dvi_path_method(const dvi_path *path);

/** What was done since its creation; all 0 for NULL. `steps` counts nothing here. */
void dvi_path_counters(const dvi_path *path, dvi_counters *counters);

#ifdef __cplusplus
}
#endif
#endif
