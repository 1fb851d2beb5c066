/** Diagnostics: drift of an invariant, fitted orders, symplecticity and reversibility of a step,
 * loop integrals; stiff springs. */
#ifndef DVI_DIAGNOSTICS_H
#define DVI_DIAGNOSTICS_H
#include <dvi/integrator.h>

/** Blocks of a drift record; the record halves their number by joining neighbours when it is
 * full. */
#define DVI_DRIFT_BLOCKS 64

/** The fewest points of a loop. */
#define DVI_LOOP_LEAST 8

/** A running record of one quantity along a run: constant memory for any number of samples. Visible
 *  so that it can live on the stack; read it through dvi_drift_result. */
typedef struct dvi_drift {
  double first;                  /**< the first sample; errors are measured from it */
  double largest;                /**< largest |error| */
  double time[DVI_DRIFT_BLOCKS]; /**< sums over each block */
  double error[DVI_DRIFT_BLOCKS];
  long per_block, filled, count; /**< samples a full block holds; in the last block; in all */
  int blocks;
  double start, end; /**< times of the first and of the last sample */
} dvi_drift;

/** Largest error and trend of a recorded quantity. */
typedef struct dvi_drift_fit {
  double largest; /**< largest |value - first value| */
  double slope;   /**< least-squares trend of the block means, per unit of time */
  /** slope times the length of the record, from its first sample's time to its last one's */
  double change;
  double deviation; /**< standard error of the slope, from the scatter of the block means */
  /** |slope| / deviation: below 3 there is no evidence for a drift; NaN with fewer than 8 blocks */
  double significance;
} dvi_drift_fit;

/** An order fitted to errors. */
typedef struct dvi_order_fit {
  double slope;    /**< of log error over log h in the window */
  int first, last; /**< the window: indices into the arrays; first = -1 if there is none */
} dvi_order_fit;

#ifdef __cplusplus
extern "C" {
#endif

/** Start a record. */
void dvi_drift_init(dvi_drift *drift);

/** Add a sample: the quantity's value at time t. */
void dvi_drift_add(dvi_drift *drift, double t, double value);

/** Evaluate a record.
 *
 *  Oscillating errors are correlated from sample to sample; the means over (up to 64) blocks are
 *  not, so the slope's standard error comes from them. */
void dvi_drift_result(const dvi_drift *drift, dvi_drift_fit *fit);

/** Fit error = C h^slope over the longest window of consecutive step sizes whose errors lie above
 * the floor and below `ceiling`.
 *
 *  @param      count     number of step sizes
 *  @param      h, error  [count], h positive and descending
 *  @param      floor     errors up to this are judged by roundoff, or by the judge's own error, and
 *                        left out
 *  @param      ceiling   errors above this are pre-asymptotic and left out; 0: no such limit
 *  @param[out] fit       the slope and its window
 *  @retval DVI_BAD_SIZE  fewer than two errors lie in a window; fit->slope is NaN */
dvi_status dvi_order(int count, const double *h, const double *error, double floor, double ceiling,
                     dvi_order_fit *fit);

/** How far the map of one step is from symplectic: |M^T J M - J| for its differenced derivative M,
 *  in the maximum norm, in coordinates scaled to unit size.
 *
 *  Each column of M is extrapolated from central differences over descending lengths until rounding
 *  ends the gain; the choice looks at the column alone, never at the defect. What differences can
 *  not resolve, 1e-14 to 1e-11, is the floor; it grows with the number of wavelengths of a force
 *  that fit into a coordinate's size (3e-10 for a pendulum at an angle of 1e6). A length whose
 *  steps fail with a positive status or DVI_SINGULAR is replaced by shorter ones, so that a
 *  domain's edge (|v| < 1, say) may be near.
 *
 *  The step is one from a start. Methods that choose their steps (dvi_integrator_chooses_steps)
 *  begin with an ordinary step of h, and that alone is measured for sem: its later steps conserve
 *  dq ^ dp - dt ^ dE, not dq ^ dp at a fixed h.
 *
 *  Takes 16 to 27 n steps where the map is smooth over lengths near unit size, at most 250 n. A
 *  second integrator of the same method takes them. Memory (2n)^2 numbers.
 *  @param      integrator  its method and system are used, and the E0 of its start if it is
 *                          time-transformed (dvi/transform.h); it is left alone
 *  @param      t, q, p     where; q and p may be the integrator's own
 *  @param      h           the step
 *  @param[out] defect      the defect; not written on failure
 *  @retval DVI_BAD_ARGUMENT     a pointer is NULL, or h is zero, not finite, or so small that t + h
 *                               = t
 *  @retval DVI_UNSUPPORTED      the system has more coordinates than freedoms: they are not
 *                               canonical; or it is degenerate, with a one-form or a Hamiltonian
 *                               with constraints: its states fill only a part of phase space. Take
 *                               dvi_loop_integral over a loop of them
 *  @retval DVI_NO_MEMORY
 *  @retval DVI_NOT_CONVERGED    the step at (q, p) fails so, or the inverse Legendre map there; or
 *                               too many of the lengths tried have failed, this one last
 *  @retval DVI_NOT_FINITE       as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_RETRY   as DVI_NOT_CONVERGED
 *  @retval DVI_SINGULAR         as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_FAILED  a callback failed for good in one of the steps
 *  @retval DVI_SOLVER_FAILED    a solver library did */
dvi_status dvi_symplecticity(dvi_integrator *integrator, double t, const double *q, const double *p,
                             double h, double *defect);

/** How far `steps` steps of h and as many of -h end from the start: the largest difference in q,
 * relative to max(1,|q|).
 *
 *  @param      integrator  left at the end of the way back; on failure before the step that failed,
 *                          or, if the start fails, as it was
 *  @param      t, q, p     the start; q and p may be the integrator's own
 *  @param      h           the step
 *  @param      steps       at least 1
 *  @param[out] defect      the difference; not written on failure
 *  @retval DVI_BAD_ARGUMENT     a pointer is NULL, or h is zero, not finite, or too small to change
 *                               the time
 *  @retval DVI_BAD_SIZE         steps is below 1
 *  @retval DVI_NO_MEMORY
 *  @retval DVI_NOT_CONVERGED    the start or a step fails so, see dvi_integrator_start and
 *                               dvi_integrator_step
 *  @retval DVI_NOT_FINITE       as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_RETRY   as DVI_NOT_CONVERGED
 *  @retval DVI_SINGULAR         as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_FAILED  as DVI_NOT_CONVERGED
 *  @retval DVI_SOLVER_FAILED    as DVI_NOT_CONVERGED */
dvi_status dvi_reversibility(dvi_integrator *integrator, double t, const double *q, const double *p,
                             double h, long steps, double *defect);

/** The loop integral of p dq, the sum over i of oint p_i dq_i, along a closed curve through `count`
 * points: Poincare's first integral invariant.
 *
 *  A symplectic map conserves it for every loop of states. With a one-form p = alpha(q), and this
 *  is the noncanonical invariant oint alpha(q).dq, the flux of the two-form through the loop. The
 *  points lie at equal distances of the curve's parameter, the last one before the first; the curve
 *  is the trigonometric polynomial through them, and the integral is exact for it up to roundoff:
 *  for an analytic loop the error falls exponentially with the number of points. Takes 2 n count^2
 *  operations.
 *
 *  @param      n         coordinates, at least 1
 *  @param      count     points, at least DVI_LOOP_LEAST
 *  @param      q, p [n*count], component by component: coordinate i of point k is q[i*count + k]
 *  @param[out] integral  not written on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_BAD_SIZE      n or count is too small
 *  @retval DVI_NOT_FINITE    a number of a point is not finite
 *
 *  Source: Fornberg 1996 (the derivative); Marsden and Ratiu 1999 (the invariant). */
dvi_status dvi_loop_integral(int n, int count, const double *q, const double *p, double *integral);

/** How far a step turns a stiff spring, and how fast it lets slow forces carry energy from one such
 * spring to another.
 *
 *  Springs of frequency omega that slow forces couple exchange their energies slowly, over times of
 *  omega. Where a method turns them by theta a step, their frequency is theta/h: that of the
 *  implicit midpoint step is (2/h) atan(h omega/2). The exchange is right where the slow forces
 *  change theta as they should, whether theta itself is right or not. It is measured by steps of
 *  x'' = -omega^2 x - kappa x, whose first part is declared fast, for small kappa: the rate is that
 *  of the phases that part, with the exact one as the unit. It leaves aside what errors of the slow
 *  motion change, and assumes that h omega is the same for all springs that exchange energy.
 *
 *  @param      method   a specification, of a method that takes potentials
 *  @param      h_omega  from 1e-3 to 1e5
 *  @param[out] turn     the angle, between 0 and 2 pi: what exceeds a turn is lost
 *  @param[out] rate     of the exchange, over the exact one; both are not written on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, h_omega is out of range, or the step does not turn,
 *                            or by a multiple of pi: there the method is unstable, or resonates
 *  @retval others            as dvi_integrator_create, dvi_integrator_start and dvi_integrator_step
 *
 *  Source: Hairer, Lubich and Wanner 2006, sec. XIII.4; Stern 2009, sec. 2.2.5. */
dvi_status dvi_exchange(const char *method, double h_omega, double *turn, double *rate);

/** The least and the largest frequency of a system's fast potentials: of those declared `fast`,
 *  which must be `quadratic`, too, with a constant mass. Modes that do not oscillate do not count.
 *
 *  @param[out] least, most  not written on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_UNSUPPORTED   no potential is declared fast, one that is is not quadratic, the mass
 *                            is not constant, or nothing oscillates
 *  @retval DVI_BAD_SIZE      more coordinates are coupled than modes can be had of
 *  @retval DVI_SINGULAR      the mass is not positive
 *  @retval others            of the Hessian's callback; DVI_NO_MEMORY */
dvi_status dvi_fast_frequencies(const dvi_system *system, double *least, double *most);

#ifdef __cplusplus
}
#endif
#endif
