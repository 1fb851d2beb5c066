/* The rotation of a quaternion: exponential and Cayley's map are made here. */
#ifndef DVI_GROUP_QUATERNION_H
#define DVI_GROUP_QUATERNION_H

/* |q|^2 - 1 to 1e-23, for q of length 1 but for roundoff: each component is a multiple of 2^-25, whose squares add up without error, and a remainder. */
static inline double dvi__excess(const double q[4])
{
  const double shift = 0x1.8p27;
  double squares = -1, rest = 0;
  for (int i = 0; i < 4; i++) {
    const double head = (q[i] + shift) - shift;
    squares += head * head;
    rest += (q[i] - head) * (q[i] + head);
  }
  return squares + rest;
}

/* R = I + 2 (q_0 hat(u) + hat(u)^2) / |q|^2, u = (q_1, q_2, q_3), for q of length 1 but for roundoff.
 *
 * Without 1/|q|^2 = 1 - excess the roundoff of q would leave R^T R - I four times as large, and biased; a plain |q|^2 has such roundoff of its own. */
static inline void dvi__rotation(const double q[4], double R[9])
{
  const double excess = dvi__excess(q);
  const double a = 2 * (q[1] - excess * q[1]), b = 2 * (q[2] - excess * q[2]), c = 2 * (q[3] - excess * q[3]);
  const double xx = a * q[1], yy = b * q[2], zz = c * q[3];
  const double xy = a * q[2], yz = b * q[3], zx = c * q[1];
  R[0] = 1 - (yy + zz);
  R[1] = xy - c * q[0];
  R[2] = zx + b * q[0];
  R[3] = xy + c * q[0];
  R[4] = 1 - (zz + xx);
  R[5] = yz - a * q[0];
  R[6] = zx - b * q[0];
  R[7] = yz + a * q[0];
  R[8] = 1 - (xx + yy);
}

#endif
