/* The constant mass of a system, with that of its factors. */
#ifndef DVI_SYSTEM_MASS_H
#define DVI_SYSTEM_MASS_H
#include "system/system.h"

/* Of a system whose coordinates are laid out (factor.h). DVI_BAD_ARGUMENT, DVI_SINGULAR. */
dvi_status dvi__mass_copy(const dvi_system_terms *terms, dvi_system *system);

#endif
