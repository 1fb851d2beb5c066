/** GSL's explicit Runge-Kutta method of Prince and Dormand, order 8, as a peer. Only builds with
 * DVI_GSL have it, because GSL is under the GPL, and so is a command that holds it. */
#ifndef RK8PD_H
#define RK8PD_H
#include "problem.h"

/** Integrate Hamilton's equations from t = 0 to t_end. q and p [n] are the start, then the end, and
 * unchanged on failure. The tolerance is relative and, in units of q and p alike, absolute. Of the
 * report, steps and evaluations are filled.
 *
 *  @param[out] reason  [size] on failure, a sentence
 *  @retval DVI_NO_MEMORY
 *  @retval DVI_UNSUPPORTED       a term is not provided for
 *  @retval DVI_REFERENCE_FAILED  the integration stopped before the end */
dvi_status rk8pd_solve(const problem *scene, double t_end, double tolerance, double *q, double *p,
                       dvi_reference_report *report, char *reason, size_t size);

/** Return the version of GSL. */
const char *rk8pd_version(void);
#endif
