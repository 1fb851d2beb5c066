/* Filon-Lobatto quadrature of functions with a fast phase, f(x, phi) with phi = nu (x - 1/2),
 * periodic in phi.
 *
 * Of f(x, .) the harmonics up to `harmonics` are taken from samples at 2 harmonics + 1 phases, and
 * their amplitudes are interpolated in x at the n Lobatto nodes:
 *
 *     f = sum_k f_k(x) e^{i k phi},      integral of f = sum_k sum_j f_k(c_j) m_j(k nu),      m_j(nu) = integral of l_j(x) e^{i nu (x - 1/2)} over [0,1].
 *
 * Put together, the weights of the samples are real numbers. Exact for amplitudes of degree n-1,
 * and of degree 2n-3 for k = 0. Source: Leok 2004, sec. 5.7.2, after Iserles. Samples in the phase
 * are ours: they make the method one for any Lagrangian. */
#ifndef DVI_SPACE_FILON_H
#define DVI_SPACE_FILON_H

/* nu is of any size and sign, 2 <= n <= DVI__FILON_NODES_MOST, 0 <= harmonics <=
 * DVI__FILON_HARMONICS_MOST. */
enum { DVI__FILON_NODES_MOST = 16, DVI__FILON_HARMONICS_MOST = 4 };

/* m_j(nu) [n]: real part and imaginary part. */
void dvi__filon_moments(int n, long double nu, long double *real, long double *imaginary);

/* node [n] and, for sample m of node j at the phase nu (node[j] - 1/2) + 2 pi m/(2 harmonics + 1),
 * weight[j*(2 harmonics + 1) + m]. The first sample of each node is on the path: as nu goes to 0 it
 * takes the whole weight, and the rule becomes Lobatto's. */
void dvi__filon_rule(int n, int harmonics, long double nu, long double *node, long double *weight);

#endif
