/* More systems with factors, some without mass between them, some coupled by the mass in unusual
 * ways. */
#ifndef TESTS_SUPPORT_MIXED_FACTORS_H
#define TESTS_SUPPORT_MIXED_FACTORS_H
#include "support/systems/bodies.h"

/* A potential couples all neighbours.
 * LOOSE: a direction, an angle, and a rigid motion whose centre of mass is not its origin, without
 * mass between them.
 * LINES: two coordinates and an angle.
 * WEDGED: an angle whose mass is not a multiple of the identity, coupled by a mass to a rotation
 * whose mass is not a body's. */
typedef enum mixed_kind { LOOSE, LINES, WEDGED, MIXED_KINDS } mixed_kind;

/* Makes a system, which destroy_body destroys. */
void make_mixed_factors(mixed_kind kind, body *model);

/* Makes a free body with any inertia [9]. */
void make_free_body(const double *inertia, const double *Omega, body *model);

#endif
