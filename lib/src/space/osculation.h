/* Quadrature and interpolation by Taylor coefficients at both ends of the unit interval.
 *
 * A function f has the coefficients a_j of tau^j at 0 and b_j of (tau - 1)^j at 1. Rules are
 * symmetric,
 *
 *     int_0^1 f  is about  sum_j w_j (a_j + (-1)^j b_j).
 *
 * Over a step of length h coefficients in time are first multiplied by h^j, and the sum by h. */
#ifndef DVI_SPACE_OSCULATION_H
#define DVI_SPACE_OSCULATION_H
#include <dvi/taylor.h>

/* The two families of rules.
 *
 * Euler-Maclaurin has `terms` terms beside the trapezoid, 0 to DVI_TAYLOR_MAX/2. The weights are
 * w_0 = 1/2 and w_{2l-1} = B_{2l}/(2l), with Bernoulli's numbers, and 0 else. The order is 2 terms
 * + 2, exact for polynomials of a lower degree. The rule does not converge as terms are added.
 *
 * Hermite integrates the polynomial of degree 2 terms - 1 that has the coefficients below `terms`,
 * 1 to DVI_TAYLOR_MAX. The order is 2 terms. */
typedef enum dvi__osculation { DVI__EULER_MACLAURIN, DVI__HERMITE } dvi__osculation;

/* Compute weight [dvi__osculation_count], right to some ulp. Bernoulli's numbers come from the
 * tangent numbers, which are positive (Brent and Harvey 2011). */
void dvi__osculation_weights(dvi__osculation rule, int terms, double *weight);

/* Count the coefficients that a rule takes of each end. The trapezoid takes 1, Euler-Maclaurin 2
 * terms, Hermite `terms`. */
int dvi__osculation_count(dvi__osculation rule, int terms);

int dvi__osculation_order(dvi__osculation rule, int terms);

/* Compute weights [N] for the coefficient a_N of the polynomial of degree 2N-1 that has given a_j
 * and b_j, j < N,
 *
 *     a_N = sum_j (from_a[j] a_j + from_b[j] b_j),
 *     (-1)^N b_N = sum_j (-1)^j (from_a[j] b_j + from_b[j] a_j).
 *
 * N is 1 to DVI_TAYLOR_MAX. The weights are whole numbers up to binomial(2N-1, N). */
void dvi__hermite_next(int N, double *from_a, double *from_b);

/* Compute at tau the values and derivatives [N] of the polynomials phi_j of degree 2N-1 that have
 * a_j = 1 and no other coefficient below N. The polynomial with given coefficients is sum_j
 * (phi_j(tau) a_j + (-1)^j phi_j(1-tau) b_j). */
void dvi__hermite_functions(int N, double tau, double *value, double *slope);

#endif
