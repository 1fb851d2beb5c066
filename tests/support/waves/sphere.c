/* Mie's coefficients with psi_n = x j_n, xi_n = x (j_n + i y_n) and D_n = psi_n'(mx)/psi_n(mx),
 *
 *     a_n = ((D_n/m + n/x) psi_n - psi_{n-1}) / ((D_n/m + n/x) xi_n - xi_{n-1}),
 *
 * and b_n with m D_n for D_n/m. Source: Bohren and Huffman 1983, sec. 4.4 and 4.8. */
#include "support/waves/scattering.h"

/* The functions of all orders at the surface. */
typedef struct surface {
  int orders;
  quad x;
  quad_complex m, j[BESSEL_ORDER + 1], inner[BESSEL_ORDER + 1];
  quad y[BESSEL_ORDER + 1];
} surface;

static quad_complex coefficient(const surface *s, int n, int magnetic)
{
  const quad_complex z = qc_scale(s->x, s->m),
                     D = qc_subtract(qc_divide(s->inner[n - 1], s->inner[n]),
                                     qc_divide(qc(n, 0), z)),
                     weight = magnetic ? qc_multiply(D, s->m) : qc_divide(D, s->m),
                     factor = qc_add(weight, qc(n / s->x, 0));
  const quad_complex xi = qc(s->j[n].re, s->y[n]), before = qc(s->j[n - 1].re, s->y[n - 1]);
  return qc_divide(qc_subtract(qc_scale(s->j[n].re, factor), qc(s->j[n - 1].re, 0)),
                   qc_subtract(qc_multiply(factor, xi), before));
}

static quad real_product(quad_complex a, quad_complex b)
{
  return a.re * b.re + a.im * b.im;
}

/* The sums of the efficiencies over all orders. */
static sphere_efficiencies sum_up(const surface *s)
{
  quad extinction = 0, scattering = 0, turned = 0;
  quad_complex back = qc(0, 0), forward = qc(0, 0), a = coefficient(s, 1, 0),
               b = coefficient(s, 1, 1);
  for (int n = 1; n < s->orders; n++) {
    const quad_complex next_a = coefficient(s, n + 1, 0), next_b = coefficient(s, n + 1, 1);
    const quad weight = 2 * n + 1, pair = (quad)(n * (n + 2)) / (n + 1),
               own = weight / (n * (n + 1));
    extinction += weight * (a.re + b.re);
    scattering += weight * (qc_square(a) + qc_square(b));
    turned += pair * (real_product(a, next_a) + real_product(b, next_b)) + own * real_product(a, b);
    back = qc_add(back, qc_scale(n % 2 == 0 ? weight : -weight, qc_subtract(a, b)));
    forward = qc_add(forward, qc_scale(weight / 2, qc_add(a, b)));
    a = next_a;
    b = next_b;
  }
  const quad area = s->x * s->x;
  return (sphere_efficiencies){.extinction = (double)(2 * extinction / area),
                               .scattering = (double)(2 * scattering / area),
                               .backscattering = (double)(qc_square(back) / area),
                               .asymmetry = (double)(2 * turned / scattering),
                               .forward_re = (double)forward.re,
                               .forward_im = (double)forward.im};
}

sphere_efficiencies sphere_solve(double x, double index, double absorption)
{
  surface s = {.orders = (int)(x + 30 + 8 * quad_sqrt(x)), .x = x, .m = qc(index, absorption)};
  spherical_j(s.orders, qc(x, 0), s.j);
  spherical_y(s.orders, x, s.y);
  spherical_j(s.orders, qc_scale(x, s.m), s.inner);
  return sum_up(&s);
}
