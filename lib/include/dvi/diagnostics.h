/** Diagnostics: drift of an invariant, fitted orders, symplecticity and reversibility of a step,
 *  loop integrals, and the exchange of energy between stiff springs. */
#ifndef DVI_DIAGNOSTICS_H
#define DVI_DIAGNOSTICS_H
#include <dvi/integrator.h>

/** Blocks of a drift record. A full record joins neighbours, which halves their number. */
#define DVI_DRIFT_BLOCKS 64

/** The fewest points of a loop. */
#define DVI_LOOP_LEAST 8

/** A running record of one quantity along a run, in constant memory for any number of samples. The
 *  struct is visible so that a record can live on the stack. Read it by dvi_drift_result. */
typedef struct dvi_drift {
  double first;                   /**< the first sample, from which errors are measured */
  double largest;                 /**< largest |error| */
  double time[DVI_DRIFT_BLOCKS];  /**< sum of the times in each block */
  double error[DVI_DRIFT_BLOCKS]; /**< sum of the errors in each block */
  /** samples of a full block, samples in the last block, and all samples */
  long per_block, filled, count;
  int blocks;        /**< blocks in use */
  double start, end; /**< times of the first and of the last sample */
} dvi_drift;

/** Largest error and trend of a recorded quantity. */
typedef struct dvi_drift_fit {
  double largest; /**< largest |value - first value| */
  double slope;   /**< least-squares trend of the block means, per unit of time */
  /** slope times the length of the record, from its first sample's time to its last one's */
  double change;
  double deviation; /**< standard error of the slope, from the scatter of the block means */
  /** |slope| / deviation. A value below 3 is no evidence for a drift. NaN with fewer than 8
   *  blocks */
  double significance;
} dvi_drift_fit;

/** An order fitted to errors. */
typedef struct dvi_order_fit {
  double slope;    /**< slope of log error over log h in the window */
  int first, last; /**< indices of the window in the arrays. first = -1 if there is no window */
} dvi_order_fit;

#ifdef __cplusplus
extern "C" {
#endif

/** Start a record. */
void dvi_drift_init(dvi_drift *drift);

/** Add a sample, the quantity's value at time t. */
void dvi_drift_add(dvi_drift *drift, double t, double value);

/** Evaluate a record.
 *
 *  Oscillating errors are correlated from sample to sample. The means over (up to 64) blocks are
 *  not, so the slope's standard error comes from the block means. */
void dvi_drift_result(const dvi_drift *drift, dvi_drift_fit *fit);

/** Fit error = C h^slope over the longest window of consecutive step sizes whose errors lie above
 *  the floor and below `ceiling`.
 *
 *  @param      count     number of step sizes
 *  @param      h, error  [count], h positive and descending
 *  @param      floor     errors up to this are left out, because roundoff, or the error of the
 *                        reference solution, decides them
 *  @param      ceiling   errors above this are left out, because they are pre-asymptotic. Default:
 *                        no such limit
 *  @param[out] fit       the slope and its window
 *  @retval DVI_BAD_SIZE  fewer than two errors lie in a window. fit->slope is NaN */
dvi_status dvi_order(int count, const double *h, const double *error, double floor, double ceiling,
                     dvi_order_fit *fit);

/** Measure how far the map of one step is from symplectic: |M^T J M - J| for its differenced
 *  derivative M, in the maximum norm, in coordinates scaled to unit size.
 *
 *  With holonomic constraints the map is one of the states that fulfil phi = 0 and G v + phi_t = 0.
 *  Shifted states are projected onto them, and the defect is |M^T J M - D^T J D| with the
 *  derivative D of the projected starts. Nonholonomic constraints keep no two-form, and have a
 *  defect.
 *
 *  Each column of M is extrapolated from central differences over descending lengths until rounding
 *  ends the gain. The choice looks at the column alone, never at the defect. Differences cannot
 *  resolve 1e-14 to 1e-11, which is the floor of this measure. The floor grows with the number of
 *  wavelengths of a force that fit into a coordinate's size (3e-10 for a pendulum at an angle of
 *  1e6). A length whose steps fail with a positive status or DVI_SINGULAR is replaced by shorter
 *  ones, so that a domain's edge (|v| < 1, say) may be near.
 *
 *  The step is the first one after a start. Methods that choose their steps
 *  (dvi_integrator_chooses_steps) begin with an ordinary step of h. Only that step is measured for
 *  sem, whose later steps conserve dq ^ dp - dt ^ dE and not dq ^ dp at a fixed h.
 *
 *  A second integrator of the same method takes the steps: 16 to 27 n of them where the map is
 *  smooth over lengths near unit size, at most 250 n. The memory is 8 n^2 numbers.
 *  @param      integrator  gives the method and the system, and the E0 of its start if it is
 *                          time-transformed (dvi/transform.h). Its state is left alone
 *  @param      t, q, p     the state. q and p may be the integrator's own
 *  @param      h           the step
 *  @param[out] defect      the defect. Not written on failure
 *  @retval DVI_BAD_ARGUMENT     a pointer is NULL, or h is zero, not finite, or so small that t + h
 *                               = t
 *  @retval DVI_UNSUPPORTED      the system has more coordinates than degrees of freedom, which are
 *                               not canonical. Or the system is degenerate, with a one-form or a
 *                               Hamiltonian with constraints, and its states fill only a part of
 *                               phase space. Use dvi_loop_integral over a loop of states instead
 *  @retval DVI_NO_MEMORY        memory could not be allocated
 *  @retval DVI_NOT_CONVERGED    the step at (q, p) or the inverse Legendre map there fails so. Or
 *                               too many of the lengths tried have failed, the last one so
 *  @retval DVI_NOT_FINITE       as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_RETRY   as DVI_NOT_CONVERGED
 *  @retval DVI_SINGULAR         as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_FAILED  a callback failed for good in one of the steps
 *  @retval DVI_SOLVER_FAILED    a solver library failed */
dvi_status dvi_symplecticity(dvi_integrator *integrator, double t, const double *q, const double *p,
                             double h, double *defect);

/** Measure how far `steps` steps of h and as many of -h end from the start: the largest difference
 *  in q, relative to max(1,|q|).
 *
 *  @param      integrator  ends at the end of the way back. After a failed step the integrator is
 *                          at the state before that step, after a failed start as before the call
 *  @param      t, q, p     the start. q and p may be the integrator's own
 *  @param      h           the step
 *  @param      steps       at least 1
 *  @param[out] defect      the difference. Not written on failure
 *  @retval DVI_BAD_ARGUMENT     a pointer is NULL, or h is zero, not finite, or too small to change
 *                               the time
 *  @retval DVI_BAD_SIZE         steps is below 1
 *  @retval DVI_NO_MEMORY        memory could not be allocated
 *  @retval DVI_NOT_CONVERGED    the start or a step fails so, see dvi_integrator_start and
 *                               dvi_integrator_step
 *  @retval DVI_NOT_FINITE       as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_RETRY   as DVI_NOT_CONVERGED
 *  @retval DVI_SINGULAR         as DVI_NOT_CONVERGED
 *  @retval DVI_CALLBACK_FAILED  as DVI_NOT_CONVERGED
 *  @retval DVI_SOLVER_FAILED    as DVI_NOT_CONVERGED */
dvi_status dvi_reversibility(dvi_integrator *integrator, double t, const double *q, const double *p,
                             double h, long steps, double *defect);

/** Integrate p dq, the sum over i of oint p_i dq_i, along a closed curve through `count` points.
 *  The loop integral is Poincare's first integral invariant.
 *
 *  A symplectic map conserves the integral for every loop of states. With a one-form p = alpha(q),
 *  and the integral is the noncanonical invariant oint alpha(q).dq, the flux of the two-form
 *  through the loop. The points lie at equal distances of the curve's parameter, and the last point
 *  comes before the first. The curve is the trigonometric polynomial through the points, for which
 *  the integral is exact up to roundoff. For an analytic loop the error falls exponentially with
 *  the number of points. The call takes 2 n count^2 operations.
 *
 *  @param      n         coordinates, at least 1
 *  @param      count     points, at least DVI_LOOP_LEAST
 *  @param      q, p      [n*count] component by component. Coordinate i of point k is
 *                        q[i*count + k]
 *  @param[out] integral  the integral. Not written on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_BAD_SIZE      n or count is too small
 *  @retval DVI_NOT_FINITE    a number of a point is not finite
 *
 *  Sources: Fornberg 1996 (the derivative), Marsden and Ratiu 1999 (the invariant). */
dvi_status dvi_loop_integral(int n, int count, const double *q, const double *p, double *integral);

/** Measure how far a step turns a stiff spring, and how fast slow forces carry energy from one such
 *  spring to another.
 *
 *  Springs of frequency omega that slow forces couple exchange their energies slowly, over times of
 *  omega. Where a method turns the springs by theta a step, their frequency is theta/h. For the
 *  implicit midpoint step this is (2/h) atan(h omega/2). The exchange is right where the slow
 *  forces change theta as they should, whether theta itself is right or not. The measurement takes
 *  steps of x'' = -omega^2 x - kappa x, whose first part is declared fast, for small kappa. The
 *  rate is that at which the phases of two springs part, in units of the exact rate. The
 *  measurement neglects the effect of errors of the slow motion, and assumes that h omega is the
 *  same for all springs that exchange energy.
 *
 *  @param      method   the specification of a method that takes potentials
 *  @param      h_omega  from 1e-3 to 1e5
 *  @param[out] turn     the angle, between 0 and 2 pi. Whole turns are lost. Not written on failure
 *  @param[out] rate     the rate of the exchange over the exact one. Not written on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, h_omega is out of range, or the step turns the
 *                            spring by no angle or by a multiple of pi, where the method is
 *                            unstable or resonates
 *  @retval (others)          as dvi_integrator_create, dvi_integrator_start and dvi_integrator_step
 *
 *  Sources: Hairer, Lubich and Wanner 2006, sec. XIII.4, and Stern 2009, sec. 2.2.5. */
dvi_status dvi_exchange(const char *method, double h_omega, double *turn, double *rate);

/** Find the least and the largest frequency of a system's fast potentials. These are the potentials
 *  declared `fast`, which must be `quadratic`, too, with a constant mass. Modes that do not
 *  oscillate do not count.
 *
 *  @param[out] least, most  the frequencies. Not written on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_UNSUPPORTED   no potential is declared fast, a fast potential is not quadratic, the
 *                            mass is not constant, or nothing oscillates
 *  @retval DVI_BAD_SIZE      more coordinates are coupled than the normal modes can be computed for
 *  @retval DVI_SINGULAR      the mass is not positive
 *  @retval DVI_NO_MEMORY     memory could not be allocated
 *  @retval (others)          as the Hessian's callback fails */
dvi_status dvi_fast_frequencies(const dvi_system *system, double *least, double *most);

#ifdef __cplusplus
}
#endif
#endif
