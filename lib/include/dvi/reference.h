/** Independent integrators by SUNDIALS. IDA gives reference solutions for the methods, CVODE and
 *  ARKODE are run beside the methods. */
#ifndef DVI_REFERENCE_H
#define DVI_REFERENCE_H
#include <dvi/system.h>

/** The codes.
 *
 *  With factors the codes integrate quaternions for rotations, and vectors of any length for
 *  directions and angles, together with the momenta. The length has no part in the equations, so
 *  rotations and unit vectors lie on the manifold to rounding. IDA's Jacobian is then differenced
 *  and dense, which limits it to 2000 unknowns. */
typedef enum dvi_reference_code {
  /** IDA, variable-order BDF on implicit equations of index 1:
   *   - a Lagrangian: qdot = v, pdot = L_q, 0 = p - L_v,
   *   - a one-form: Omega(q) qdot = H_q,
   *   - a Hamiltonian: its equations of motion, the multiplier of constraints eliminated,
   *   - factors: as above */
  DVI_IDA,
  /** CVODE's Adams methods on qdot = v(q,p), pdot = L_q. With a one-form on qdot = v(q) alone */
  DVI_CVODE_ADAMS,
  DVI_CVODE_BDF,
  DVI_ARKODE, /**< explicit Runge-Kutta, order 8 (Fehlberg 13-7-8) */
  /** IDA on equations of index 2:
   *   - a one-form: qdot = v, pdot = L_q, 0 = p - alpha(q), without v in the error test,
   *   - constraints: qdot = H_p + phi_p^T lambda, pdot = -H_q - phi_q^T lambda, 0 = phi, without
   *     lambda in the error test */
  DVI_IDA_INDEX_2
} dvi_reference_code;

/** Options. Zero means default. */
typedef struct dvi_reference_options {
  dvi_reference_code code;
  /** Relative tolerance. Default 1e-12, at index 2 1e-9, for IDA with holonomic constraints 1e-11,
   *  and 1e-9 for a general Lagrangian without a gradient, whose differences are noise below
   *  1e-11 */
  double relative_tolerance;
  double absolute_tolerance; /**< in units of q and p alike (default: the relative one) */
  long max_steps;            /**< largest number of steps (default 50 million) */
  /** largest process time in seconds, tested in every evaluation (default: no limit) */
  double max_seconds;
} dvi_reference_options;

/** Results of a reference run. With dvi_reference_judge these are those of the tighter run. */
typedef struct dvi_reference_report {
  /** max-norm of the difference of q between the two runs of dvi_reference_judge. NaN from
   *  dvi_reference_solve */
  double error;
  double relative_tolerance; /**< relative tolerance of the run */
  long steps;                /**< steps of the run */
  long evaluations;          /**< points at which gradients were evaluated */
  double cpu_seconds;        /**< process time */
} dvi_reference_report;

#ifdef __cplusplus
extern "C" {
#endif

/** Integrate from (t, q, p) to t_end with one code at one tolerance.
 *
 *  @param[in,out] q, p     [nq], [nv] the initial state, then the state at t_end. Unchanged on
 *                          failure. A one-form requires p = alpha(q), constraints phi(q,p) = 0
 *  @param         options  NULL for IDA at its defaults
 *  @param[out]    report   may be NULL
 *  @retval DVI_REFERENCE_FAILED  the code stopped early. The error sentence has its reason and time
 *  @retval DVI_UNSUPPORTED       DVI_IDA_INDEX_2 for a system without a one-form or constraints, or
 *                                DVI_IDA for factors with too many unknowns
 *  @retval DVI_BAD_ARGUMENT      q is not on the manifold of its factors, or p is not tangent to
 *                                it, up to rounding */
dvi_status dvi_reference_solve(const dvi_system *system, double t, double t_end, double *q,
                               double *p, const dvi_reference_options *options,
                               dvi_reference_report *report);

/** Integrate twice, at the tolerance and at a tenth of it. The result is that of the second run.
 *  Its distance from the first result estimates the error of the reference solution. Arguments and
 *  statuses are those of dvi_reference_solve. */
dvi_status dvi_reference_judge(const dvi_system *system, double t, double t_end, double *q,
                               double *p, const dvi_reference_options *options,
                               dvi_reference_report *report);

/** Return the name of a code ("ida", "cvode-adams", "cvode-bdf", "arkode"). NULL if the code is out
 *  of range. */
const char *dvi_reference_name(dvi_reference_code code);

/** Return the version of the linked SUNDIALS, for example "6.4.1". */
const char *dvi_reference_version(void);

#ifdef __cplusplus
}
#endif
#endif
