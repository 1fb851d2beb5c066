/** Lie groups for configurations that are not vectors: SO(3), SE(3), the sphere S^2, the circle
 *  U(1).
 *
 *  A rotation R [9] is stored row by row, R_ij in R[3i+j], and so is any 3 x 3 matrix here. The
 *  matrix hat(w) is defined by hat(w) v = w x v. An element of SE(3) is [12], R and then the
 *  translation x, and maps a point X to R X + x. Its tangent vectors are [6], the rotation vector w
 *  and then the shift u.
 *
 *  The derivative of exp(w) in the direction v, moved back to the identity, is dexp_w v:
 *
 *      d/dt exp(w(t)) = hat(dexp_w w') exp(w) = exp(w) hat(dexp_{-w} w'),
 *      dexp_w = sum_n ad_w^n / (n+1)!,      ad_w v = w x v on SO(3).
 *
 *  So a body with R = R_0 exp(w) has the body velocity dexp_{-w} w'. On SO(3) the transpose of
 *  dexp_w is dexp_{-w}, and the transpose of its inverse is that of dexp_{-w}.
 *
 *  Nothing is allocated. Finite arguments have finite results as long as products of a few of them
 *  are finite. Where |w| is beyond 1e154, and |w|^2 is not finite, exp and dexp are the identity.
 *  Results are right to a few ulp of their size (for rotations by many turns, of the angle). Tests
 *  compare the results with quadruple precision. Outputs may overwrite inputs of the same size,
 *  unless a function says otherwise. Sources: Iserles, Munthe-Kaas, Norsett and Zanna 2000, and
 *  Marsden and Ratiu 1999, ch. 9 and sec. 14.7. */
#ifndef DVI_GROUP_H
#define DVI_GROUP_H
#include <dvi/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Compute the rotation about w by |w|, R = exp(hat(w)).
 *
 *  @param      w  [3] radians
 *  @param[out] R  [9] orthogonal to 1 ulp, without bias. The product of N such factors leaves the
 *                 group by about sqrt(N) ulp */
void dvi_so3_exp(const double w[3], double R[9]);

/** Compute the shortest w with exp(hat(w)) = R, |w| <= pi but for rounding. At a half turn w and -w
 *  are equally short, and the result is the one whose largest component is positive.
 *
 *  @param      R  [9] a rotation
 *  @param[out] w  [3] radians
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, see dvi_so3_project. w is
 *                            unchanged */
dvi_status dvi_so3_log(const double R[9], double w[3]);

/** Compute u = dexp_w v = v + (1 - cos a)/a^2 w x v + (a - sin a)/a^3 w x (w x v), a = |w|. All
 *  vectors are [3]. */
void dvi_so3_dexp(const double w[3], const double v[3], double u[3]);

/** Compute u = dexp_w^-1 v = v - (w x v)/2 + (1 - (a/2) cot(a/2))/a^2 w x (w x v), a = |w|. All
 *  vectors are [3].
 *
 *  The result has a pole at full turns. Errors grow as 1/|2 pi - a| there, as those of a itself
 *  do. */
void dvi_so3_dexp_inverse(const double w[3], const double v[3], double u[3]);

/** Compute the derivative by w of the body velocity dexp_{-w} v at constant v.
 *
 *  @param      w, v  [3], which may be the same array
 *  @param[out] D     [9] D_ij = d(dexp_{-w} v)_i / dw_j. D must not overlap w or v */
void dvi_so3_velocity_derivative(const double w[3], const double v[3], double D[9]);

/** Compute Cayley's map, R = (I - hat(w)/2)^-1 (I + hat(w)/2), the rotation about w by
 *  2 atan(|w|/2). The map agrees with exp to second order.
 *
 *  @param      w  [3]
 *  @param[out] R  [9] orthogonal to 1 ulp */
void dvi_so3_cayley(const double w[3], double R[9]);

/** Compute the w with cayley(w) = R.
 *
 *  @param      R  [9] a rotation
 *  @param[out] w  [3]
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, or a half turn, where w would
 *                            be infinite. w is unchanged */
dvi_status dvi_so3_cayley_inverse(const double R[9], double w[3]);

/** Compute u = dcayley_w v = (v + (w x v)/2) / (1 + |w|^2/4). All vectors are [3].
 *
 *      d/dt cayley(w) = hat(dcayley_w w') cayley(w) = cayley(w) hat(dcayley_{-w} w') */
void dvi_so3_dcayley(const double w[3], const double v[3], double u[3]);

/** Compute u = dcayley_w^-1 v = v - (w x v)/2 + w (w.v)/4. All vectors are [3]. */
void dvi_so3_dcayley_inverse(const double w[3], const double v[3], double u[3]);

/** Compute the rotation of a quaternion, by which v becomes q v q^-1.
 *
 *  @param      q  [4] real part first, of any length. A zero quaternion counts as 1
 *  @param[out] R  [9] orthogonal to 1 ulp, also where q is not of length 1 */
void dvi_so3_from_quaternion(const double q[4], double R[9]);

/** Compute the unit quaternion of a rotation with q[0] >= 0. At a half turn (q[0] = 0) the largest
 *  component is positive.
 *
 *  @param      R  [9] a rotation
 *  @param[out] q  [4] real part first
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, see dvi_so3_project. q is
 *                            unchanged */
dvi_status dvi_so3_quaternion(const double R[9], double q[4]);

/** Compute the rotation that is closest to a matrix in the sum of squares of its entries. If
 *  det M > 0 this is the orthogonal factor of the polar decomposition.
 *
 *  If several rotations are equally close (M of rank 1, or M that turns right into left and is as
 *  far from several), the result is one of them. For M = 0 the result is the identity.
 *  @param      M  [9] any matrix
 *  @param[out] R  [9] orthogonal to 1 ulp. May be M
 *
 *  Source: Horn 1987. */
void dvi_so3_project(const double M[9], double R[9]);

/** Return the distance of a matrix M [9] from SO(3): |M - R|, the root of the sum of squares of the
 *  entries, with R from dvi_so3_project. */
double dvi_so3_distance(const double M[9]);

/** Compute the rigid motion of a constant twist, g = exp([hat(w), u; 0, 0]): the rotation
 *  exp(hat(w)) and the translation dexp_w u.
 *
 *  @param      xi  [6] w, then u
 *  @param[out] g   [12] R, then x */
void dvi_se3_exp(const double xi[6], double g[12]);

/** Compute the xi with exp(xi) = g and the shortest w. At a half turn w is that of dvi_so3_log.
 *
 *  @param      g   [12] R, then x
 *  @param[out] xi  [6] w, then u
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation. xi is unchanged */
dvi_status dvi_se3_log(const double g[12], double xi[6]);

/** Compute Cayley's map, g = (I - A/2)^-1 (I + A/2), A = [hat(w), u; 0, 0]: the rotation cayley(w)
 *  and the translation (I - hat(w)/2)^-1 u.
 *
 *  @param      xi  [6] w, then u
 *  @param[out] g   [12] R, then x */
void dvi_se3_cayley(const double xi[6], double g[12]);

/** Compute u = dexp_xi v, all [6], as on SO(3), with ad_(w,u) (a,b) = (w x a, w x b + u x a).
 *
 *  The body velocity (Omega, V) of g_0 exp(xi) is dexp_{-xi} xi', with R' = R hat(Omega) and
 *  x' = R V. The transpose of dexp_xi is not dexp_{-xi}. */
void dvi_se3_dexp(const double xi[6], const double v[6], double u[6]);

/** Compute u = dexp_xi^-1 v, all [6]. The result has poles at full turns, as on SO(3), but double
 *  ones. */
void dvi_se3_dexp_inverse(const double xi[6], const double v[6], double u[6]);

/** Compute the point at this angle on the unit circle, (cos, sin).
 *
 *  @param      angle  radians
 *  @param[out] y      [2] */
void dvi_u1_exp(double angle, double y[2]);

/** Return the angle of a point of the circle, in [-pi, pi]. The angle is pi for (-1, 0) and 0 for
 *  (0, 0).
 *
 *  @param y  [2] of any length */
double dvi_u1_log(const double y[2]);

/** Compute the point that a great circle reaches from y by the tangent vector t,
 *  cos|t| y + t sin|t|/|t|.
 *
 *  @param      y  [3] of length 1
 *  @param      t  [3] orthogonal to y
 *  @param[out] z  [3] of length 1 to 1 ulp, though y and t may have roundoff */
void dvi_s2_exp(const double y[3], const double t[3], double z[3]);

/** Compute the shortest tangent vector t at y that leads to z, |t| <= pi but for rounding. To
 *  z = -y every direction leads. The result then points towards the coordinate axis of the smallest
 *  |y_i|, the first of equals.
 *
 *  @param      y, z  [3] of length 1
 *  @param[out] t     [3] orthogonal to y to roundoff */
void dvi_s2_log(const double y[3], const double z[3], double t[3]);

#ifdef __cplusplus
}
#endif
#endif
