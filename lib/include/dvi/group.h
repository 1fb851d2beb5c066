/** Lie groups for configurations that are not vectors: SO(3), SE(3), the sphere S^2, the circle
 * U(1).
 *
 *  A rotation R [9] is stored row by row, R_ij in R[3i+j]; so is any 3 x 3 matrix here. hat(w) v =
 *  w x v. An element of SE(3) is [12]: R, then the translation x, and maps a point X to R X + x.
 *  Its tangent vectors are [6]: the turn w, then the shift u.
 *
 *  The derivative of exp(w) in the direction v, moved back to the identity, is dexp_w v:
 *
 *      d/dt exp(w(t)) = hat(dexp_w w') exp(w) = exp(w) hat(dexp_{-w} w'),      dexp_w = sum_n ad_w^n / (n+1)!,      ad_w v = w x v on SO(3).
 *
 *  So a body with R = R_0 exp(w) has the body velocity dexp_{-w} w'. On SO(3) the transpose of
 *  dexp_w is dexp_{-w}, and that of its inverse likewise.
 *
 *  Nothing is allocated, and finite arguments have finite results as long as products of a few of
 *  them are finite; where |w| is beyond 1e154, and |w|^2 is not, exp and dexp are the identity.
 *  Results are right to a few ulp of their size (for rotations by many turns: of the angle); tests
 *  compare them with quadruple precision. Outputs may overwrite inputs of the same size, unless a
 *  function says otherwise. Sources: Iserles, Munthe-Kaas, Norsett and Zanna 2000; Marsden and
 *  Ratiu 1999, ch. 9 and sec. 14.7. */
#ifndef DVI_GROUP_H
#define DVI_GROUP_H
#include <dvi/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The rotation about w by |w|, R = exp(hat(w)).
 *
 *  @param      w  [3] radians
 *  @param[out] R  [9] orthogonal to 1 ulp, without bias: of N factors the product leaves the group
 *                 by about sqrt(N) ulp */
void dvi_so3_exp(const double w[3], double R[9]);

/** The shortest w with exp(hat(w)) = R, |w| <= pi but for rounding. At a half turn, where w and -w
 * are as short: the one whose largest component is positive.
 *
 *  @param      R  [9] a rotation
 *  @param[out] w  [3] radians
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, see dvi_so3_project; w is as
 *                            it was */
dvi_status dvi_so3_log(const double R[9], double w[3]);

/** u = dexp_w v = v + (1 - cos a)/a^2 w x v + (a - sin a)/a^3 w x (w x v), a = |w|. All [3]. */
void dvi_so3_dexp(const double w[3], const double v[3], double u[3]);

/** u = dexp_w^-1 v = v - (w x v)/2 + (1 - (a/2) cot(a/2))/a^2 w x (w x v), a = |w|. All [3].
 *
 *  It has a pole at full turns, and errors grow as 1/|2 pi - a| there: those of a itself do so. */
void dvi_so3_dexp_inverse(const double w[3], const double v[3], double u[3]);

/** The derivative in w of the body velocity dexp_{-w} v, with v held.
 *
 *  @param      w, v  [3]
 *  @param[out] D     [9] D_ij = d(dexp_{-w} v)_i / dw_j; neither w nor v */
void dvi_so3_velocity_derivative(const double w[3], const double v[3], double D[9]);

/** Cayley's map, R = (I - hat(w)/2)^-1 (I + hat(w)/2): the rotation about w by 2 atan(|w|/2). It
 * agrees with exp to second order.
 *
 *  @param      w  [3]
 *  @param[out] R  [9] orthogonal to 1 ulp */
void dvi_so3_cayley(const double w[3], double R[9]);

/** The w with cayley(w) = R.
 *
 *  @param      R  [9] a rotation
 *  @param[out] w  [3]
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, or a half turn, where w would
 *                            be infinite; w is as it was */
dvi_status dvi_so3_cayley_inverse(const double R[9], double w[3]);

/** u = dcayley_w v = (v + (w x v)/2) / (1 + |w|^2/4): d/dt cayley(w) = hat(dcayley_w w') cayley(w)
 * = cayley(w) hat(dcayley_{-w} w'). All [3]. */
void dvi_so3_dcayley(const double w[3], const double v[3], double u[3]);

/** u = dcayley_w^-1 v = v - (w x v)/2 + w (w.v)/4. All [3]. */
void dvi_so3_dcayley_inverse(const double w[3], const double v[3], double u[3]);

/** The rotation of a quaternion: v becomes q v q^-1.
 *
 *  @param      q  [4] real part first, of any length; 0 is taken for 1
 *  @param[out] R  [9] orthogonal to 1 ulp, also where q is not of length 1 */
void dvi_so3_from_quaternion(const double q[4], double R[9]);

/** The unit quaternion of a rotation, of the two the one with q[0] >= 0; at a half turn (q[0] = 0)
 * the one whose largest component is positive.
 *
 *  @param      R  [9] a rotation
 *  @param[out] q  [4] real part first
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, see dvi_so3_project; q is as
 *                            it was */
dvi_status dvi_so3_quaternion(const double R[9], double q[4]);

/** The rotation that is closest to a matrix in the sum of squares of its entries: the orthogonal
 * factor of its polar decomposition, if det M > 0.
 *
 *  Of several closest ones (M of rank 1, M that turns right into left and is as far from several)
 *  one is taken, of M = 0 the identity.
 *  @param      M  [9] any matrix
 *  @param[out] R  [9] orthogonal to 1 ulp; may be M
 *  Source: Horn 1987. */
void dvi_so3_project(const double M[9], double R[9]);

/** The distance of a matrix M [9] from SO(3): |M - R|, the root of the sum of squares of the
 * entries, R from dvi_so3_project. */
double dvi_so3_distance(const double M[9]);

/** The rigid motion of a constant twist, g = exp([hat(w), u; 0, 0]): the rotation exp(hat(w)) and
 * the translation dexp_w u.
 *
 *  @param      xi  [6] w, then u
 *  @param[out] g   [12] R, then x */
void dvi_se3_exp(const double xi[6], double g[12]);

/** The xi with exp(xi) = g and the shortest w; at a half turn as dvi_so3_log.
 *
 *  @param      g   [12] R, then x
 *  @param[out] xi  [6] w, then u
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation; xi is as it was */
dvi_status dvi_se3_log(const double g[12], double xi[6]);

/** Cayley's map, g = (I - A/2)^-1 (I + A/2), A = [hat(w), u; 0, 0]: the rotation cayley(w) and the
 * translation (I - hat(w)/2)^-1 u.
 *
 *  @param      xi  [6] w, then u
 *  @param[out] g   [12] R, then x */
void dvi_se3_cayley(const double xi[6], double g[12]);

/** u = dexp_xi v, all [6]: as on SO(3), with ad_(w,u) (a,b) = (w x a, w x b + u x a). dexp_{-xi}
 *  xi' is the body velocity (Omega, V) of g_0 exp(xi), with R' = R hat(Omega), x' = R V. Its
 *  transpose is not that of the opposite twist. */
void dvi_se3_dexp(const double xi[6], const double v[6], double u[6]);

/** u = dexp_xi^-1 v, all [6]. Poles at full turns, as on SO(3), but double ones. */
void dvi_se3_dexp_inverse(const double xi[6], const double v[6], double u[6]);

/** The point at this angle on the unit circle, (cos, sin).
 *
 *  @param      angle  radians
 *  @param[out] y      [2] */
void dvi_u1_exp(double angle, double y[2]);

/** The angle of a point of the circle, in [-pi, pi]; pi for (-1, 0), 0 for (0, 0).
 *
 *  @param y  [2] of any length */
double dvi_u1_log(const double y[2]);

/** The point that a great circle reaches from y by the tangent vector t: cos|t| y + t sin|t|/|t|.
 *
 *  @param      y  [3] of length 1
 *  @param      t  [3] orthogonal to y
 *  @param[out] z  [3] of length 1 to 1 ulp, though y and t may have roundoff */
void dvi_s2_exp(const double y[3], const double t[3], double z[3]);

/** The shortest tangent vector t at y that leads to z, |t| <= pi but for rounding. For z = -y,
 *  where every direction does, the one towards the coordinate axis of the smallest |y_i|, the first
 *  of equals.
 *
 *  @param      y, z  [3] of length 1
 *  @param[out] t     [3] orthogonal to y to roundoff */
void dvi_s2_log(const double y[3], const double z[3], double t[3]);

#ifdef __cplusplus
}
#endif
#endif
