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

/* The solution of q - 2 + 1/q = (h/dt)^2 (z - 2 + 1/z) in the upper half plane. */
static quad_complex wave_factor(quad_complex z, quad h, quad dt)
{
  const quad_complex back = qc_divide(qc(1, 0), z),
                     half = qc_scale(h * h / (2 * dt * dt), qc(z.re + back.re - 2, z.im + back.im)),
                     middle = qc(1 + half.re, half.im),
                     root = qc_sqrt(qc_subtract(qc_multiply(middle, middle), qc(1, 0)));
  const quad_complex q = qc_add(middle, root);
  return q.im >= 0 ? q : qc_subtract(middle, root);
}

/* f(q) = z - q - b(qz - 1) is what a wave leaves of the condition. */
static quad_complex mur_defect(quad_complex q, quad_complex z, quad b)
{
  const quad_complex product = qc_multiply(q, z);
  return qc_subtract(qc_subtract(z, q), qc_scale(b, qc(product.re - 1, product.im)));
}

double grid_mur_reflection(double w, double decay, double h, double dt, double *growth)
{
  const quad b = ((quad)dt - h) / ((quad)dt + h);
  const quad_complex z = qc_exp(qc(-(quad)decay * dt, (quad)w * dt)), q = wave_factor(z, h, dt),
                     back = qc_divide(qc(1, 0), q);
  *growth = (double)qc_size(q);
  return (double)(qc_size(mur_defect(q, z, b)) / qc_size(mur_defect(back, z, b)));
}
