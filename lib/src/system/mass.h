/* The constant mass of a system, with that of its factors. */
#ifndef DVI_SYSTEM_MASS_H
#define DVI_SYSTEM_MASS_H
#include "system/system.h"

/* Copy the mass into a system whose coordinates are laid out (factor.h). Return DVI_BAD_ARGUMENT or
 * DVI_SINGULAR for a bad mass. */
dvi_status dvi__mass_copy(const dvi_system_terms *terms, dvi_system *system);

#endif
