#include "field/step/alarm.h"

#include <math.h>

#include "core/status.h"

static const double hopeless = 1e100;

dvi_status dvi__judge_growth(const dvi__alarm_words *words, double t, double energy, double growth,
                             double *allowed)
{
  const double limit = *allowed;
  if (!isfinite(energy) || growth > hopeless)
    return dvi__fail(DVI_NOT_FINITE,
                     "%s: the energy has grown to %g at t = %g, and the run cannot go on; take %s",
                     words->method, energy, t, words->last);
  if (!(growth > limit)) return DVI_OK;
  *allowed = 2 * fmax(growth, limit);
  return dvi__fail(DVI_STEP_TOO_LARGE,
                   "%s: at t = %g the energy is %.3g times that of %s, above %g: %s", words->method,
                   t, growth, words->reference, limit, words->remedy);
}
