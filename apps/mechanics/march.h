/** Many steps of one length, as studies and benches take them. */
#ifndef MARCH_H
#define MARCH_H
#include <dvi/dvi.h>

#include "cli/progress.h"

/** Called after every step; not 0: a failure. NULL: nobody looks. */
typedef int (*march_look)(dvi_integrator *integrator, void *user);

/** From where the integrator stands to t_end: so many steps of h, or, if their lengths are chosen,
 * as many as it takes.
 *
 *  @param progress  shown while it lasts, with `words`; NULL: none */
dvi_status march(dvi_integrator *integrator, double h, long steps, double t_end, march_look look,
                 void *user, progress_line *progress, const char *words);

/** How much of their own time the steps take from the problem's start to t_end: t_end itself, or
 * that of a first run with steps of h; NaN if a million of these do not come to t_end. The
 * integrator is left where the run ends. */
dvi_status march_span(dvi_integrator *integrator, const double *q, const double *p, double h,
                      double t_end, double *span);
#endif
