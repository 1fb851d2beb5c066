/* Systems whose one-form has constant components. */
#ifndef DVI_SYSTEM_HALF_H
#define DVI_SYSTEM_HALF_H
#include "system/system.h"

/* is_x [n]: 0 for the components of the one-form that are constant, 1 for the others, if just half
 * of them are constant.
 *
 * A component is constant if its column of the declared gradients is empty, or if all its
 * derivatives vanish at all points of a fixed cloud at which the callbacks can be evaluated.
 * Whoever relies on it checks again where he comes. DVI_UNSUPPORTED otherwise; the sentence names
 * the components among which the two-form vanishes, so that a gauge can remove them, or says that
 * there is no such half, or that the two-form has a row of zeros. Allocates. */
dvi_status dvi__form_constant_components(const dvi_system *system, int *is_x);

#endif
