/* Quadrature and interpolation by Taylor coefficients at both ends of the unit interval.
 *
 * A function f has the coefficients a_j of tau^j at 0 and b_j of (tau - 1)^j at 1. Rules are
 * symmetric:
 *     int_0^1 f  is about  sum_j w_j (a_j + (-1)^j b_j).
 * Over a step of length h coefficients in time are first multiplied by h^j, and the sum by h. */
#ifndef DVI_SPACE_OSCULATION_H
#define DVI_SPACE_OSCULATION_H
#include <dvi/taylor.h>

/* Euler-Maclaurin with so many terms beside the trapezoid, 0 to DVI_TAYLOR_MAX/2: w_0 = 1/2 and
 * w_{2l-1} = B_{2l}/(2l), Bernoulli's numbers; the other weights are 0. Of order 2 terms + 2: exact
 * for polynomials of a lower degree. It does not converge as terms are added.
 *
 * Hermite: the integral of the polynomial of degree 2 terms - 1 that has the coefficients below
 * `terms`, 1 to DVI_TAYLOR_MAX; order 2 terms. */
typedef enum dvi__osculation { DVI__EULER_MACLAURIN, DVI__HERMITE } dvi__osculation;

/* weight [dvi__osculation_count], right to some ulp. (Brent and Harvey 2011 for Bernoulli's
 * numbers, by the tangent numbers, which are positive.) */
void dvi__osculation_weights(dvi__osculation rule, int terms, double *weight);

/* How many coefficients of each end it takes: 1 for the trapezoid, 2 terms for Euler-Maclaurin,
 * `terms` for Hermite. */
int dvi__osculation_count(dvi__osculation rule, int terms);

int dvi__osculation_order(dvi__osculation rule, int terms);

/* Of the polynomial of degree 2N-1 with given a_j and b_j, j < N: its own a_N = sum_j (from_a[j]
 * a_j + from_b[j] b_j), both [N]. At the other end (-1)^N b_N = sum_j (-1)^j (from_a[j] b_j +
 * from_b[j] a_j). N is 1 to DVI_TAYLOR_MAX; the weights are whole numbers up to binomial(2N-1,
 * N). */
void dvi__hermite_next(int N, double *from_a, double *from_b);

/* The polynomials phi_j of degree 2N-1 that have a_j = 1 and no other coefficient below N, at tau,
 * and their derivatives, both [N]: the polynomial with given coefficients is sum_j (phi_j(tau) a_j
 * + (-1)^j phi_j(1-tau) b_j). */
void dvi__hermite_functions(int N, double tau, double *value, double *slope);

#endif
