/* Oscillators with noise, and the maps of their steps. */
#ifndef SUPPORT_SYSTEMS_NOISY_H
#define SUPPORT_SYSTEMS_NOISY_H
#include <dvi/dvi.h>

enum { NOISY_MOST = 4 };

/* Oscillators m q'^2/2 - k q^2/2 with noise. A coupled mass has 0.3 m beside the diagonal. */
typedef struct noisy_oscillators {
  int n;
  double k;
  dvi_noise noise;
  dvi_system *system;
} noisy_oscillators;

void make_noisy(int n, double m, double k, int coupled, dvi_noise noise, noisy_oscillators *made);
void destroy_noisy(noisy_oscillators *made);

/* Covariances of the stationary state (q,p) of steps of one oscillator, and the mean of the
 * temperature that the integrator reports there. */
typedef struct noisy_covariance {
  double qq, qp, pp, temperature;
} noisy_covariance;

/* Finds them from the linear map of a step by `method`, that is from steps from unit vectors
 * without noise, and from 0 with known normal numbers, `draws` of them (1 or 2) a step. Nothing is
 * sampled. */
noisy_covariance find_covariance(const char *method, double m, double k, dvi_noise noise, double h,
                                 int draws);

#endif
