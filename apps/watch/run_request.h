/** The request of dvi run's command line. */
#ifndef RUN_REQUEST_H
#define RUN_REQUEST_H
#include <stdbool.h>

#include "cli/options.h"
#include "load/pacing.h"

typedef struct run_request {
  const char *method, *momenta, *columns, *out, *events, *checkpoint, *resume, *plot, *map, *map_of,
      *pvd;
  double h, t_end, tolerance; /**< the tolerance is NaN, or refused */
  pacing how;
  long every, checkpoint_every; /**< 0 if not given */
  long threads;                 /**< of a field's march, 0 if not given */
  bool project, final;
  bool verify;
  long digits;     /**< number of digits that --verify must find, 0 if not given */
  const char *csv; /**< file of --verify */
  words settings, alarms;
  char *command; /**< the command line */
} run_request;
#endif
