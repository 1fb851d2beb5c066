/* Exponential and logarithm of SO(3), and their action on velocities.
 *
 * The exponential of w is the rotation of the quaternion (cos |w|/2, w sin(|w|/2) / |w|). */
#include <dvi/group.h>
#include <math.h>

#include "group/quaternion.h"
#include "group/stumpff.h"
#include "group/vector.h"

void dvi_so3_exp(const double w[3], double R[9])
{
  double c[4];
  dvi__stumpff_four(0.25 * dvi__dot(w, w), c);
  const double half = 0.5 * c[1], q[4] = {c[0], half * w[0], half * w[1], half * w[2]};
  dvi__rotation(q, R);
}

dvi_status dvi_so3_log(const double R[9], double w[3])
{
  double q[4];
  const dvi_status status = dvi_so3_quaternion(R, q);
  if (status != DVI_OK) return status;
  const double sine = sqrt(dvi__dot(q + 1, q + 1)),
               ratio = sine > 0 ? 2 * atan2(sine, q[0]) / sine : 2;
  for (int i = 0; i < 3; i++) w[i] = ratio * q[1 + i];
  return DVI_OK;
}

void dvi_so3_dexp(const double w[3], const double v[3], double u[3])
{
  double c[4];
  dvi__stumpff_four(dvi__dot(w, w), c);
  dvi__about(w, c[2], c[3], v, u);
}

/* With x = |w|/2 the factor (1 - x cot x) / (4 x^2) is (c_2 - c_3) / (4 c_1) at x^2. Nothing
 * cancels below a full turn. */
void dvi_so3_dexp_inverse(const double w[3], const double v[3], double u[3])
{
  double c[4];
  dvi__stumpff_four(0.25 * dvi__dot(w, w), c);
  dvi__about(w, -0.5, c[1] != 0 ? (c[2] - c[3]) / (4 * c[1]) : 0, v, u);
}

/* The velocity is v - c_2 w x v + c_3 (w (w.v) - |w|^2 v). The derivatives of c_2 and c_3 in w are
 * (2 c_4 - c_3) w and (3 c_5 - c_4) w. */
void dvi_so3_velocity_derivative(const double w[3], const double v[3], double D[9])
{
  double c[9], once[3], inner[3], stretch[3];
  dvi__stumpff(dvi__dot(w, w), c);
  dvi__cross(w, v, once);
  for (int i = 0; i < 3; i++) inner[i] = (c[3] - 2 * c[4]) * v[i] + (3 * c[5] - c[4]) * once[i];
  dvi__cross(w, inner, stretch);
  const double along = c[3] * dvi__dot(w, v), x = c[2] * v[0], y = c[2] * v[1], z = c[2] * v[2];
  const double turn[9] = {along, -z, y, z, along, -x, -y, x, along};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      D[3 * i + j] = turn[3 * i + j] + c[3] * w[i] * v[j] + (stretch[i] - 2 * c[3] * v[i]) * w[j];
}
