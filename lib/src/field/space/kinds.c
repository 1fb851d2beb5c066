/* The list of kinds of axes. */
#include "field/space/kind.h"

const dvi__kind *const dvi__kinds[] = {
    &dvi__fem,   &dvi__spline, &dvi__legendre_element, &dvi__chebyshev_element, &dvi__fourier,
    &dvi__msfem, NULL};
