/** GSL's explicit Runge-Kutta method of Prince and Dormand, order 8, as a peer. In builds with
 * DVI_GSL alone: GSL is under the GPL, and so is a command that holds it. */
#ifndef RK8PD_H
#define RK8PD_H
#include "problem.h"

/** Integrate Hamilton's equations from t = 0 to t_end. q and p [n]: the start, then the end;
 * unchanged on failure. The tolerance is relative and, in units of q and p alike, absolute. Of the
 * report steps and evaluations are filled.
 *
 *  @param[out] reason  [size] on failure, a sentence
 *  @retval DVI_NO_MEMORY
 *  @retval DVI_UNSUPPORTED       a term that it does not provide for
 *  @retval DVI_REFERENCE_FAILED  it stopped before the end */
dvi_status rk8pd_solve(const problem *scene, double t_end, double tolerance, double *q, double *p,
                       dvi_reference_report *report, char *reason, size_t size);

/** The version of GSL. */
const char *rk8pd_version(void);
#endif
