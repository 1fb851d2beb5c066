/* The members of a drift, for lie_drift.c and lie_drift_members.c. */
#ifndef DVI_STEP_LIE_LIE_DRIFT_STRUCT_H
#define DVI_STEP_LIE_LIE_DRIFT_STRUCT_H
#include "step/lie/coupled_drift.h"
#include "step/lie/lie_drift.h"
#include "step/lie/mass_blocks.h"

struct dvi__lie_drift {
  dvi__mass_blocks blocks;
  dvi__moser_veselov_map by;
  dvi__coupled_drift *together; /* NULL without coupled slots */
};

#endif
