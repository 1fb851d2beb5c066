/* Angles in more digits than a double has. */
#ifndef DVI_NUM_ANGLE_H
#define DVI_NUM_ANGLE_H
#include "num/compensated.h"

/* pi. */
extern const dvi__twofold dvi__twofold_pi;

/* Give the angle of the vector (x, y) from -pi to pi, to some 1e-22, so that small differences of
 * sums of angles have their digits. The angle is 0 for (0, 0). */
dvi__twofold dvi__twofold_angle(dvi__twofold x, dvi__twofold y);

#endif
