/** Many steps of one length, as studies and benches take them. */
#ifndef MARCH_H
#define MARCH_H
#include <dvi/dvi.h>

#include "cli/progress.h"

/** A function that is called after every step. A result other than 0 is a failure. May be NULL. */
typedef int (*march_look)(dvi_integrator *integrator, void *user);

/** Advance the integrator to t_end by so many steps of h, or by as many as necessary if the method
 * chooses their lengths.
 *
 *  @param progress  shown during the run, with `words`, or NULL */
dvi_status march(dvi_integrator *integrator, double h, long steps, double t_end, march_look look,
                 void *user, progress_line *progress, const char *words);

/** Measure the span of the steps' own time from the problem's start to t_end. It is t_end itself,
 * or the span of a first run with steps of h. NaN if a million of these do not reach t_end. The
 * integrator stays at the end of the run. */
dvi_status march_span(dvi_integrator *integrator, const double *q, const double *p, double h,
                      double t_end, double *span);
#endif
