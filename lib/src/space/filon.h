/* Filon-Lobatto quadrature of functions f(x, phi) with a fast phase phi = nu (x - 1/2), periodic in
 * phi.
 *
 * Samples at 2 harmonics + 1 phases give the harmonics of f(x, .) up to `harmonics`. Their
 * amplitudes are interpolated in x at the n Lobatto nodes,
 *
 *     f = sum_k f_k(x) e^{i k phi},      integral of f = sum_k sum_j f_k(c_j) m_j(k nu),
 *     m_j(nu) = integral of l_j(x) e^{i nu (x - 1/2)} over [0,1].
 *
 * The resulting weights of the samples are real numbers. The rule is exact for amplitudes of degree
 * n-1, and of degree 2n-3 for k = 0. Source: Leok 2004, sec. 5.7.2, after Iserles. The samples in
 * the phase are our addition. With them the method serves any Lagrangian. */
#ifndef DVI_SPACE_FILON_H
#define DVI_SPACE_FILON_H

/* Limits of the arguments n and harmonics, 2 <= n <= DVI__FILON_NODES_MOST and
 * 0 <= harmonics <= DVI__FILON_HARMONICS_MOST. nu is of any size and sign. */
enum { DVI__FILON_NODES_MOST = 16, DVI__FILON_HARMONICS_MOST = 4 };

/* Compute the real and imaginary parts [n] of m_j(nu). */
void dvi__filon_moments(int n, long double nu, long double *real, long double *imaginary);

/* Compute node [n] and weight[j*(2 harmonics + 1) + m] for sample m of node j at the phase nu
 * (node[j] - 1/2) + 2 pi m/(2 harmonics + 1). The first sample of each node is on the path. As nu
 * goes to 0 it takes the whole weight, and the rule becomes Lobatto's. */
void dvi__filon_rule(int n, int harmonics, long double nu, long double *node, long double *weight);

#endif
