/** Independent integrators by SUNDIALS: IDA judges the methods, CVODE and ARKODE are run beside
 * them. */
#ifndef DVI_REFERENCE_H
#define DVI_REFERENCE_H
#include <dvi/system.h>

/** The codes.
 *
 *  With factors they integrate quaternions for rotations, and directions and angles as vectors of
 *  any length, whose length has no part in the equations, with the momenta: rotations and unit
 *  vectors are found on the manifold to rounding. IDA's Jacobian is differenced then, and dense: up
 *  to 2000 unknowns. */
typedef enum dvi_reference_code {
  DVI_IDA, /**< variable-order BDF on the implicit Euler-Lagrange equations: qdot = v, pdot = L_q, 0 = p - L_v (index 1); with a one-form on
                        Omega(q) qdot = H_q; with a Hamiltonian on its equations, the multiplier of constraints eliminated; with factors as above */
  DVI_CVODE_ADAMS, /**< on qdot = v(q,p), pdot = L_q; with a one-form on qdot = v(q) alone */
  DVI_CVODE_BDF,
  DVI_ARKODE,     /**< explicit Runge-Kutta, order 8 (Fehlberg 13-7-8) */
  DVI_IDA_INDEX_2 /**< for one-forms: IDA on qdot = v, pdot = L_q, 0 = p - alpha(q), of index 2, without v in the error test; for constraints
                        on qdot = H_p + phi_p^T lambda, pdot = -H_q - phi_q^T lambda, 0 = phi, without lambda in it */
} dvi_reference_code;

/** Options; zero means default. */
typedef struct dvi_reference_options {
  dvi_reference_code code;
  double
      /** 0: 1e-12, or 1e-9 for a general Lagrangian without a gradient, whose differences are noise
       * below 1e-11; 1e-9 at index 2 */
      relative_tolerance;
  double absolute_tolerance; /**< in units of q and p alike; 0: the relative one */
  long max_steps;            /**< 0: 50 million */
  double max_seconds;        /**< of process time, looked at in every evaluation; 0: any number */
} dvi_reference_options;

/** What a reference run did. */
typedef struct dvi_reference_report {
  /** dvi_reference_judge: max-norm of the difference of q between the two runs;
   * dvi_reference_solve: NaN */
  double error;
  double relative_tolerance; /**< of the (tighter) run */
  long steps;                /**< of the (tighter) run */
  long evaluations;          /**< points at which gradients were evaluated */
  double cpu_seconds;        /**< process time */
} dvi_reference_report;

#ifdef __cplusplus
extern "C" {
#endif

/** Integrate from (t, q, p) to t_end with one code at one tolerance.
 *
 *  @param[in,out] q, p [nq], [nv]: initial state, then the state at t_end; unchanged on failure.
 *  With a one-form p must be alpha(q), with constraints phi(q,p) 0
 *  @param         options NULL: IDA at its defaults
 *  @param[out]    report  may be NULL
 *  @retval DVI_REFERENCE_FAILED  the code stopped early; the error sentence has its reason and time
 *  @retval DVI_UNSUPPORTED       DVI_IDA_INDEX_2 for a system without a one-form or constraints;
 *                               DVI_IDA for factors with too many unknowns
 *  @retval DVI_BAD_ARGUMENT      with factors: q is not on their manifold, or p not tangent to it,
 *                               up to rounding */
dvi_status dvi_reference_solve(const dvi_system *system, double t, double t_end, double *q,
                               double *p, const dvi_reference_options *options,
                               dvi_reference_report *report);

/** The same, run twice, at the tolerance and at a tenth of it: gives the second result and its
 *  distance from the first, which is taken as the judge's own error. */
dvi_status dvi_reference_judge(const dvi_system *system, double t, double t_end, double *q,
                               double *p, const dvi_reference_options *options,
                               dvi_reference_report *report);

/** Name of a code ("ida", "cvode-adams", "cvode-bdf", "arkode"); NULL if out of range. */
const char *dvi_reference_name(dvi_reference_code code);

/** The SUNDIALS version that is linked, for example "6.4.1". */
const char *dvi_reference_version(void);

#ifdef __cplusplus
}
#endif
#endif
