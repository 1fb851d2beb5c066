/* The slow and the fast part of a system, as systems of their own. */
#ifndef DVI_SYSTEM_PART_H
#define DVI_SYSTEM_PART_H
#include "system/system.h"

/* Create a part of a system with a constant mass and without factors. The fast part has the mass
 * and the potentials that are declared fast. The slow part has the other potentials, and the mass
 * 1, because it stands for forces alone. The caller owns the part. Symmetries and invariants stay
 * with the whole, which must outlive the fast part, because both share the factor of the mass. */
dvi_status dvi__system_slow_part(const dvi_system *whole, dvi_system **part);
dvi_status dvi__system_fast_part(const dvi_system *whole, dvi_system **part);

/* Create the system that has all terms but the noise and the watched invariants, and more forces.
 * The caller owns it, and the whole must outlive it. */
dvi_status dvi__system_without_noise(const dvi_system *whole, int more, const dvi_force *shaking,
                                     dvi_system **part);

/* Return 1 if all potentials that are declared fast are declared quadratic, too. The second
 * function returns the name of the first one that is not, or NULL. */
int dvi__system_fast_is_quadratic(const dvi_system *whole);
const char *dvi__system_fast_not_quadratic(const dvi_system *whole);

#endif
