#include "support/waves/damped.h"

#include <math.h>

#include "support/waves/quad_complex.h"

/* Powers by multiplication keep 30 digits over a million samples. */
void damped_sum(int count, const damped *line, double interval, int64_t samples, double *y)
{
  for (int64_t i = 0; i < samples; i++) y[i] = 0;
  for (int k = 0; k < count; k++) {
    const quad_complex z = qc_exp(
        qc(-(quad)line[k].decay * interval, (quad)line[k].frequency * interval));
    quad_complex now = qc_scale(line[k].amplitude, qc_exp(qc(0, line[k].phase)));
    for (int64_t i = 0; i < samples; i++) {
      y[i] += (double)now.re;
      now = qc_multiply(now, z);
    }
  }
}

static double uniform(uint64_t *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return ((double)(*state >> 11) + 0.5) / 9007199254740992.0;
}

/* Box and Muller 1958. */
void damped_add_noise(double deviation, uint64_t seed, int64_t samples, double *y)
{
  const double pi = 3.14159265358979323846;
  uint64_t state = seed;
  for (int64_t i = 0; i < samples; i++) {
    const double radius = sqrt(-2 * log(uniform(&state)));
    y[i] += deviation * radius * cos(2 * pi * uniform(&state));
  }
}
