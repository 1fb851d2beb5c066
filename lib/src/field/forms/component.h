/* The components of a form, by the sets of their axes. */
#ifndef DVI_FIELD_FORMS_COMPONENT_H
#define DVI_FIELD_FORMS_COMPONENT_H
#include <dvi/forms.h>

#include "num/compensated.h"

enum { DVI__COMPONENTS = 70 }; /* of a 4-form in eight dimensions, at most */

/* Set axis [k] to the first k axes, and to the next ones in the order of dictionaries. Returns 0
 * after the last ones. */
void dvi__first_axes(int k, int *axis);
int dvi__next_axes(int space, int k, int *axis);

/* Give the determinant of the components axis [k] of k vectors or covectors, vector i at
 * row[i]. */
double dvi__minor(int k, const double *const *row, const int *axis);

/* The same in twice the digits, rounded. */
double dvi__exact_minor(int k, const dvi__twofold *const *row, const int *axis);

#endif
