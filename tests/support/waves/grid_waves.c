#include "support/waves/grid_waves.h"

#include "support/waves/quad_complex.h"

static quad pi_quad(void)
{
  return quad_acos(-1);
}

static quad arc_sine(quad x)
{
  return pi_quad() / 2 - quad_acos(x);
}

static quad frequency_of(int axes, const quad *h, quad dt, const quad *k)
{
  quad sum = 0;
  for (int i = 0; i < axes; i++) {
    const quad part = quad_sin(k[i] * h[i] / 2) / h[i];
    sum += part * part;
  }
  return 2 / dt * arc_sine(dt * quad_sqrt(sum));
}

double grid_frequency(int axes, const double *h, double dt, const double *k)
{
  quad spacing[3], wave[3];
  for (int i = 0; i < axes; i++) {
    spacing[i] = h[i];
    wave[i] = k[i];
  }
  return (double)frequency_of(axes, spacing, dt, wave);
}

double grid_box_frequency(int axes, const double *side, const int *cells, double dt,
                          const int *half_waves)
{
  quad spacing[3], wave[3];
  for (int i = 0; i < axes; i++) {
    spacing[i] = (quad)side[i] / cells[i];
    wave[i] = pi_quad() * half_waves[i] / side[i];
  }
  return (double)frequency_of(axes, spacing, dt, wave);
}

/* (1+s) z^2 - (2 - (2 sin(w dt/2))^2) z + 1 - s = 0. */
void grid_lossy_mode(double w, double dt, double sigma, double *frequency, double *decay)
{
  const quad s = (quad)sigma * dt / 2, sine = quad_sin((quad)w * dt / 2),
             half = (1 - 2 * sine * sine) / (1 + s), product = (1 - s) / (1 + s);
  const quad_complex root = qc_sqrt(qc(half * half - product, 0)),
                     exponent = qc_log(qc_add(qc(half, 0), root));
  *frequency = (double)(quad_abs(exponent.im) / dt);
  *decay = (double)(-exponent.re / dt);
}

/* f(q) = z - q - b(qz - 1) is what a wave q^j z^n leaves of the condition at j = 0. */
static quad_complex mur_defect(quad_complex q, quad_complex z, quad b)
{
  const quad_complex product = qc_multiply(q, z);
  return qc_subtract(qc_subtract(z, q), qc_scale(b, qc(product.re - 1, product.im)));
}

double grid_mur_reflection(double w, double h, double dt)
{
  const quad b = ((quad)dt - h) / ((quad)dt + h),
             kh = 2 * arc_sine(quad_sin((quad)w * dt / 2) * h / dt);
  const quad_complex z = qc_exp(qc(0, (quad)w * dt)), q = qc_exp(qc(0, kh)),
                     back = qc_exp(qc(0, -kh));
  return (double)(qc_size(mur_defect(q, z, b)) / qc_size(mur_defect(back, z, b)));
}
