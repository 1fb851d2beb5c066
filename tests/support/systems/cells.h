/* More systems with factors: what the mass leaves alone, and what it ties together in unusual
 * ways. */
#ifndef TESTS_SUPPORT_CELLS_H
#define TESTS_SUPPORT_CELLS_H
#include "support/systems/bodies.h"

/* All in a potential that has to do with every pair of neighbours. loose: a direction, an angle, a
 * rigid motion whose centre of mass is not its origin, no mass between them. lines: two
 * coordinates, an angle. wedged: an angle whose mass is not a multiple of the identity, tied to a
 * rotation whose mass is not a body's. */
typedef enum cells_kind { LOOSE, LINES, WEDGED, CELLS } cells_kind;

/* To be destroyed by destroy_body. */
void make_cells(cells_kind kind, body *of);

/* A free body; the inertia [9] may be any. */
void make_free_body(const double *inertia, const double *Omega, body *of);

#endif
