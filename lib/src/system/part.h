/* The slow and the fast part of a system, as systems of their own. */
#ifndef DVI_SYSTEM_PART_H
#define DVI_SYSTEM_PART_H
#include "system/system.h"

/* The fast part has the mass and the potentials that are declared fast; the slow part has the other
 * ones, and the mass 1, for it stands for forces alone. Of a constant mass without factors. The
 * caller owns the part; symmetries and invariants stay with the whole. */
dvi_status dvi__system_slow_part(const dvi_system *whole, dvi_system **part);
dvi_status dvi__system_fast_part(const dvi_system *whole, dvi_system **part);

/* Whether all potentials that are declared fast are declared quadratic, too; the name of the first
 * one that is not, or NULL. */
int dvi__system_fast_is_quadratic(const dvi_system *whole);
const char *dvi__system_fast_not_quadratic(const dvi_system *whole);

#endif
