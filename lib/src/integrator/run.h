/* A run whose rows are kept in arrays, also those of steps that are taken together. */
#ifndef DVI_INTEGRATOR_RUN_H
#define DVI_INTEGRATOR_RUN_H
#include <dvi/run.h>
#include "method/method.h"

/* What keeps rows of a run's steps that are taken together, without an observer between them. */
typedef struct dvi__keeper {
  /* Give the trail room for rows after DVI__TOGETHER steps. */
  dvi_status (*open)(void *user, dvi__trail *trail);
  dvi_status (*close)(void *user, const dvi__trail *trail);
  void *user;
} dvi__keeper;

/* Run as dvi_run. If a keeper (or NULL) is given, the options' observer is called after the other
 * steps. */
dvi_status dvi__run(dvi_integrator *integrator, const dvi_run_options *options,
                    const dvi__keeper *keeper, dvi_run_report *report);

/* Tell whether a run to t_end is at its end, from which a sum of steps differs by roundings. */
int dvi__run_is_at_end(const dvi_integrator *integrator, double t_end);

#endif
