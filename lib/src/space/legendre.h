/* Legendre polynomials as seen from one end of the unit interval. */
#ifndef DVI_SPACE_LEGENDRE_H
#define DVI_SPACE_LEGENDRE_H

/* Compute value[k] = P_k(1 - 2y) and difference[k] = P_k - P_{k-1} there, k = 0..degree
 * (difference[0] = 0). y is the distance from the end where every P_k is 1. */
void dvi__legendre(int degree, long double y, long double *value, long double *difference);

#endif
