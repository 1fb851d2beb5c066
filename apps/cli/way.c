#include "cli/way.h"

#include <math.h>

#include "cli/command.h"

/* dvi_run has the same limit. Beyond it a number of double precision cannot count steps. */
static const double steps_max = 0x1p53;

int way_check(const char *command, double h, double way, double t_end, bool counted)
{
  if (h == 0.0) return usage_error("%s: steps of 0 lead nowhere", command);
  const double steps = way / h;
  if (steps < 0.0)
    return usage_error("%s: steps of %g lead away from --t-end %g; change the sign of one", command,
                       h, t_end);
  if (!counted || steps <= steps_max) return DONE;
  return usage_error("%s: --t-end %g is %.3g steps of %g away, and at most 2^53 (9e15) can be "
                     "counted; give an --h of %.2g or "
                     "a nearer end",
                     /* the two printed digits may be a twentieth too small */
                     command, t_end, steps, h, 1.1 * way / steps_max);
}
