/* Systems whose one-form has constant components. */
#ifndef DVI_SYSTEM_TERM_CONSTANT_COMPONENTS_H
#define DVI_SYSTEM_TERM_CONSTANT_COMPONENTS_H
#include "system/system.h"

/* Set is_x [n] to 0 for the constant components of the one-form and to 1 for the others, if just
 * half of them are constant.
 *
 * A component is constant if its column of the declared gradients is empty, or if all its
 * derivatives vanish at all points of a fixed cloud at which the callbacks can be evaluated. A
 * method that relies on this checks again at its own points. The function allocates.
 *
 * Otherwise return DVI_UNSUPPORTED. The sentence names the components among which the two-form
 * vanishes, so that a gauge can remove them, or says that there is no such choice, or that the
 * two-form has a row of zeros. */
dvi_status dvi__form_constant_components(const dvi_system *system, int *is_x);

#endif
