/* The sine-Gordon equation u_tt = u_xx - sin u on [0,2pi), periodic, in Fourier's modes
 * u = c_0 + sum_k c_k cos kx + s_k sin kx, k <= K, with q = (c_0, c_1, s_1, c_2, ..):
 *
 *     L = pi [2 c_0'^2 + sum_k (c_k'^2 + s_k'^2)]/2 - pi sum_k k^2 (c_k^2 + s_k^2)/2
 *         - 2pi/M sum_j (1 - cos u(x_j)),   x_j = 2pi j/M.
 *
 * The last potential couples all modes, and is declared without a Hessian on demand. */
#ifndef SUPPORT_SINE_GORDON_H
#define SUPPORT_SINE_GORDON_H
#include <dvi/dvi.h>

#include "num/fft/fft.h"

enum { SINE_GORDON_MODES = 2000 };

typedef struct sine_gordon {
  dvi_system *system;
  int n, M; /* n = 2 K + 1 */
  dvi__fft *fft;
  double *values, *work; /* [M] and for the transform */
  void *pull;
  double mass[2 * SINE_GORDON_MODES + 1], q[2 * SINE_GORDON_MODES + 1],
      p[2 * SINE_GORDON_MODES + 1]; /* the start u0 = 1.5 + 0.5 cos x, u_t = 0.3 sin x */
} sine_gordon;

/* Create the system. strength multiplies 1 - cos u. Its symmetry 0 is the translation in x. */
void sine_gordon_create(int K, int M, double strength, int without_hessian, sine_gordon *made);
void sine_gordon_destroy(sine_gordon *made);

#endif
