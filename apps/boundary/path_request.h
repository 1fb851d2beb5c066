/** The path that the command line asks for. */
#ifndef PATH_REQUEST_H
#define PATH_REQUEST_H
#include <stdbool.h>

#include "cli/options.h"

/** Words and numbers as they are given. NULL or NaN if they are not. */
typedef struct path_request {
  const char *method, *ends, *from, *to, *momentum, *symmetry, *guess, *follow, *out;
  long steps; /**< 0 if not given */
  double t_end, period, energy;
  bool free_period;
  words settings;
} path_request;
#endif
