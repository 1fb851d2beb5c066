/* With u = sum_n i^n J_n(kr) exp(i n phi) for the plane wave, the field outside has b_n H_n(kr) in
 * addition, and the one inside is c_n J_n(m k r). At r = a, x = ka, the field and its derivative
 * times 1 (TM) or 1/m^2 (TE) are continuous: with q = m or 1/m,
 *
 *     b_n = (J_n'(x) J_n(mx) - q J_n(x) J_n'(mx)) / (q H_n(x) J_n'(mx) - H_n'(x) J_n(mx)).
 *
 * Source: Bohren and Huffman 1983, sec. 8.4.1. */
#include "support/waves/scattering.h"

/* Orders beyond which the series is below roundoff. */
static int orders_of(quad x)
{
  return (int)(x + 30 + 8 * quad_sqrt(x));
}

static void hankel(int most, quad x, quad_complex *H)
{
  quad_complex J[BESSEL_ORDER + 2];
  quad Y[BESSEL_ORDER + 2];
  bessel_j(most, qc(x, 0), J);
  bessel_y(most, x, Y);
  for (int n = 0; n <= most; n++) H[n] = qc(J[n].re, Y[n]);
}

void cylinder_solve(cylinder_case polarization, double k, double radius, double index,
                    double absorption, cylinder *c)
{
  quad_complex J[BESSEL_ORDER + 2], H[BESSEL_ORDER + 2], M[BESSEL_ORDER + 2];
  const quad x = (quad)k * radius;
  const quad_complex m = qc(index, absorption);
  const quad_complex q = polarization == CYLINDER_TM ? m : qc_divide(qc(1, 0), m);
  *c = (cylinder){.orders = orders_of(x), .k = k, .radius = radius, .index = m};
  bessel_j(c->orders + 1, qc(x, 0), J);
  hankel(c->orders + 1, x, H);
  bessel_j(c->orders + 1, qc_scale(x, m), M);
  for (int n = 0; n < c->orders; n++) {
    const quad_complex slope = qc_multiply(q, bessel_slope(M, n)),
                       above = qc_subtract(qc_multiply(bessel_slope(J, n), M[n]),
                                           qc_multiply(J[n], slope)),
                       below = qc_subtract(qc_multiply(H[n], slope),
                                           qc_multiply(bessel_slope(H, n), M[n]));
    c->outside[n] = qc_divide(above, below);
    c->inside[n] = qc_divide(qc_add(J[n], qc_multiply(c->outside[n], H[n])), M[n]);
  }
}

/* b_{-n} = b_n. */
void cylinder_efficiencies(const cylinder *c, double *extinction, double *scattering)
{
  quad lost = 0, sent = 0;
  for (int n = 0; n < c->orders; n++) {
    lost -= (n == 0 ? 1 : 2) * c->outside[n].re;
    sent += (n == 0 ? 1 : 2) * qc_square(c->outside[n]);
  }
  *extinction = (double)(2 * lost / (c->k * c->radius));
  *scattering = (double)(2 * sent / (c->k * c->radius));
}

/* Set f and slope to the radial functions of all orders at r, and their derivatives. */
static void radial(const cylinder *c, quad r, quad_complex *f, quad_complex *slope)
{
  quad_complex J[BESSEL_ORDER + 2], H[BESSEL_ORDER + 2];
  const int is_inside = r < c->radius;
  const quad_complex k = is_inside ? qc_scale(c->k, c->index) : qc(c->k, 0);
  bessel_j(c->orders + 1, qc_scale(r, k), J);
  if (!is_inside) hankel(c->orders + 1, c->k * r, H);
  for (int n = 0; n < c->orders; n++) {
    f[n] = J[n];
    slope[n] = bessel_slope(J, n);
    if (is_inside) {
      f[n] = qc_multiply(c->inside[n], f[n]);
      slope[n] = qc_multiply(c->inside[n], slope[n]);
    } else {
      f[n] = qc_add(f[n], qc_multiply(c->outside[n], H[n]));
      slope[n] = qc_add(slope[n], qc_multiply(c->outside[n], bessel_slope(H, n)));
    }
    slope[n] = qc_multiply(k, slope[n]);
  }
}

/* exp(i n phi) and exp(-i n phi) together are 2 cos(n phi), and J_{-n} i^-n = J_n i^n. */
void cylinder_field(const cylinder *c, double x, double y, quad_complex *field,
                    quad_complex *along_x, quad_complex *along_y)
{
  quad_complex f[BESSEL_ORDER], slope[BESSEL_ORDER], along_r = qc(0, 0), along_phi = qc(0, 0);
  const quad r = quad_sqrt((quad)x * x + (quad)y * y), cosine = x / r, sine = y / r;
  quad_complex power = qc(1, 0), turn = qc(1, 0); /* i^n, exp(i n phi) */
  radial(c, r, f, slope);
  *field = qc(0, 0);
  for (int n = 0; n < c->orders; n++) {
    const int sides = n == 0 ? 1 : 2;
    *field = qc_add(*field, qc_scale(sides * turn.re, qc_multiply(power, f[n])));
    along_r = qc_add(along_r, qc_scale(sides * turn.re, qc_multiply(power, slope[n])));
    along_phi = qc_add(along_phi, qc_scale(-sides * n * turn.im, qc_multiply(power, f[n])));
    power = qc_multiply(power, qc(0, 1));
    turn = qc_multiply(turn, qc(cosine, sine));
  }
  *along_x = qc_subtract(qc_scale(cosine, along_r), qc_scale(sine / r, along_phi));
  *along_y = qc_add(qc_scale(sine, along_r), qc_scale(cosine / r, along_phi));
}
