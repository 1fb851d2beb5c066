/* The rigid motions SE(3) are rotations and translations with the semi-direct product (R, x)(S, y)
 * = (R S, x + R y). */
#include <dvi/group.h>

#include "core/status.h"
#include "group/vector.h"

void dvi_se3_exp(const double xi[6], double g[12])
{
  dvi_so3_exp(xi, g);
  dvi_so3_dexp(xi, xi + 3, g + 9);
}

dvi_status dvi_se3_log(const double g[12], double xi[6])
{
  DVI_TRY(dvi_so3_log(g, xi));
  dvi_so3_dexp_inverse(xi, g + 9, xi + 3);
  return DVI_OK;
}

/* x = (I - W/2)^-1 u */
void dvi_se3_cayley(const double xi[6], double g[12])
{
  const double shrink = 1 / (1 + 0.25 * dvi__dot(xi, xi));
  dvi_so3_cayley(xi, g);
  dvi__about(xi, 0.5 * shrink, 0.25 * shrink, xi + 3, g + 9);
}

/* Compute the part of the shift that a turning rate a adds. With exp(w, u) = (exp w, x), x = dexp_w
 * u, the velocity moved back to the identity is (r, x' - r x x), r = dexp_w a. Here x' has the part
 * (d dexp_w u / dw) a. */
static void shift_coupling(const double xi[6], const double a[3], const double r[3],
                           double shift[3])
{
  const double opposite[3] = {-xi[0], -xi[1], -xi[2]};
  double x[3], D[9];
  dvi_so3_dexp(xi, xi + 3, x);
  dvi_so3_velocity_derivative(opposite, xi + 3, D);
  dvi__cross(x, r, shift);
  for (int i = 0; i < 3; i++) shift[i] -= dvi__dot(D + 3 * i, a);
}

void dvi_se3_dexp(const double xi[6], const double v[6], double u[6])
{
  double turn[3], shift[3];
  dvi_so3_dexp(xi, v, turn);
  shift_coupling(xi, v, turn, shift);
  dvi_so3_dexp(xi, v + 3, u + 3);
  for (int i = 0; i < 3; i++) {
    u[i] = turn[i];
    u[3 + i] += shift[i];
  }
}

void dvi_se3_dexp_inverse(const double xi[6], const double v[6], double u[6])
{
  double turn[3], shift[3];
  dvi_so3_dexp_inverse(xi, v, turn);
  shift_coupling(xi, turn, v, shift);
  for (int i = 0; i < 3; i++) shift[i] = v[3 + i] - shift[i];
  dvi_so3_dexp_inverse(xi, shift, u + 3);
  for (int i = 0; i < 3; i++) u[i] = turn[i];
}
