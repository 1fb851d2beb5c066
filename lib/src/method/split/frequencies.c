/* The fast frequencies that a system declares help a caller to plan steps. */
#include <dvi/diagnostics.h>

#include "step/split/modes.h"
#include "core/status.h"
#include "system/part.h"

static dvi_status frequencies_find(const dvi_system *part, double *least, double *most)
{
  dvi_counters counters = {0};
  dvi__modes *modes;
  double low, high;
  DVI_TRY(dvi__modes_create(part, DVI__MODES_BLOCK_MOST, &counters, &modes));
  dvi__modes_range(modes, &low, &high);
  dvi__modes_destroy(&modes);
  if (high == 0) return dvi__fail(DVI_UNSUPPORTED, "nothing oscillates in the fast potentials");
  *least = low;
  *most = high;
  return DVI_OK;
}

dvi_status dvi_fast_frequencies(const dvi_system *system, double *least, double *most)
{
  dvi_system *part;
  if (!system || !least || !most)
    return dvi__fail(DVI_BAD_ARGUMENT, "frequencies: an argument is NULL");
  if (!(system->terms & DVI__FAST) || !(system->terms & DVI__CONSTANT_MASS) ||
      !dvi__system_fast_is_quadratic(system))
    return dvi__fail(DVI_UNSUPPORTED, "frequencies: they are known of potentials that are declared "
                                      "fast and quadratic, with a constant mass");
  DVI_TRY(dvi__system_fast_part(system, &part));
  const dvi_status status = frequencies_find(part, least, most);
  dvi_system_destroy(&part);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "frequencies");
}
