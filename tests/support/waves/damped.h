/* Series of damped oscillations, summed in quadruple precision. */
#ifndef SUPPORT_WAVES_DAMPED_H
#define SUPPORT_WAVES_DAMPED_H
#include <stdint.h>

/* amplitude exp(-decay t) cos(frequency t + phase). */
typedef struct damped {
  double frequency, decay, amplitude, phase;
} damped;

/* Set y [samples] to the sum at t = i*interval. */
void damped_sum(int count, const damped *line, double interval, int64_t samples, double *y);

/* Add noise of a normal distribution with this standard deviation. Equal seeds give equal noise. */
void damped_add_noise(double deviation, uint64_t seed, int64_t samples, double *y);

#endif
