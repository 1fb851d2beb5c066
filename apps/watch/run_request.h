/** What the command line of dvi run asks for. */
#ifndef RUN_REQUEST_H
#define RUN_REQUEST_H
#include <stdbool.h>

#include "cli/options.h"
#include "load/pacing.h"

typedef struct run_request {
  const char *method, *momenta, *columns, *out, *events, *checkpoint, *resume, *plot;
  double h, t_end, tolerance; /**< tolerance: NaN, or refused */
  pacing how;
  long every, checkpoint_every; /**< 0: not given */
  bool project, final;
  bool verify;
  long digits;     /**< that --verify is to find; 0: not given */
  const char *csv; /**< of --verify */
  words settings, alarms;
} run_request;
#endif
