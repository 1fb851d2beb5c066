#ifndef DVI_JOINT_JOINT_MAKE_H
#define DVI_JOINT_JOINT_MAKE_H
#include <dvi/joint.h>

#include "joint/joint_rows.h"

/* Check a joint, and find its bodies and rows. */
dvi_status dvi__joint_make(const dvi_factor *factors, int count, const char *name,
                           const dvi_joint *given, const double *q, dvi__joint *joint);

/* Return the count of stored numbers of a factor. */
int dvi__factor_numbers(const dvi_factor *factor);

#endif
