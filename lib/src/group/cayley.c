/* Cayley's map on SO(3), (I - W/2)^-1 (I + W/2), W = hat(w), gives the rotation of the quaternion
 * (1, w/2). */
#include <dvi/group.h>
#include <float.h>

#include "core/status.h"
#include "group/vector.h"

void dvi_so3_cayley(const double w[3], double R[9])
{
  const double q[4] = {1, 0.5 * w[0], 0.5 * w[1], 0.5 * w[2]};
  dvi_so3_from_quaternion(q, R);
}

dvi_status dvi_so3_cayley_inverse(const double R[9], double w[3])
{
  double q[4];
  DVI_TRY(dvi_so3_quaternion(R, q));
  if (q[0] < DBL_MIN)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "Cayley's map: it does not reach a half turn; the exponential does");
  for (int i = 0; i < 3; i++) w[i] = 2 * q[1 + i] / q[0];
  return DVI_OK;
}

void dvi_so3_dcayley(const double w[3], const double v[3], double u[3])
{
  const double shrink = 1 / (1 + 0.25 * dvi__dot(w, w));
  double turned[3];
  dvi__cross(w, v, turned);
  for (int i = 0; i < 3; i++) u[i] = shrink * (v[i] + 0.5 * turned[i]);
}

void dvi_so3_dcayley_inverse(const double w[3], const double v[3], double u[3])
{
  const double along = 0.25 * dvi__dot(w, v);
  double turned[3];
  dvi__cross(w, v, turned);
  for (int i = 0; i < 3; i++) u[i] = v[i] - 0.5 * turned[i] + along * w[i];
}
