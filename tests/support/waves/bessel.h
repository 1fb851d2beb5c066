/* Bessel functions of integer order, and spherical ones, in quadruple precision, and roots of real
 * functions. */
#ifndef SUPPORT_WAVES_BESSEL_H
#define SUPPORT_WAVES_BESSEL_H
#include "support/waves/quad_complex.h"

/* The highest order, and the largest size of an argument. */
enum { BESSEL_ORDER = 300, BESSEL_ARGUMENT = 250 };

/* Set J [most+1] to J_0(z) .. J_most(z). */
void bessel_j(int most, quad_complex z, quad_complex *J);

/* Set Y [most+1] to Y_0(x) .. Y_most(x), x > 0. */
void bessel_y(int most, quad x, quad *Y);

/* Set j [most+1] to j_0(z) .. j_most(z), z not 0. */
void spherical_j(int most, quad_complex z, quad_complex *j);

/* Set y [most+1] to y_0(x) .. y_most(x), x > 0. */
void spherical_y(int most, quad x, quad *y);

/* The derivative of order n of functions f_0, f_1 .. with f_n' = (f_{n-1} - f_{n+1}) / 2. */
quad_complex bessel_slope(const quad_complex *f, int n);

typedef quad root_function(quad x, const void *user);

/* Set root [most] to the first zeros of f above `from`, which are more than `apart` from each
 * other. */
void find_roots(root_function *f, const void *user, quad from, quad apart, int most, quad *root);

#endif
