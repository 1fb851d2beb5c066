/** Lie groups for configurations that are not vectors: SO(3), SE(3), the sphere S^2, the circle U(1).
 *
 *  A rotation R [9] is stored row by row, R_ij in R[3i+j]; so is any 3 x 3 matrix here. hat(w) v = w x v. An element of SE(3) is [12]: R, then the
 *  translation x, and maps a point X to R X + x. Its tangent vectors are [6]: the turn w, then the shift u.
 *
 *  The derivative of exp(w) in the direction v, moved back to the identity, is dexp_w v:
 *
 *      d/dt exp(w(t)) = hat(dexp_w w') exp(w) = exp(w) hat(dexp_{-w} w'),      dexp_w = sum_n ad_w^n / (n+1)!,      ad_w v = w x v on SO(3).
 *
 *  So a body with R = R_0 exp(w) has the body velocity dexp_{-w} w'. On SO(3) the transpose of dexp_w is dexp_{-w}, and that of its inverse likewise.
 *
 *  Nothing is allocated, and finite arguments have finite results as long as products of their sizes are finite. Where exp, dexp and dcayley are asked for
 *  rotations by |w| beyond 1e154, whose angles no double can tell, they are taken for rotations by 0. Results are right to a few ulp of their size (for
 *  rotations by many turns: of the angle); tests compare them with quadruple precision. Outputs may overwrite inputs of the same size, unless a function
 *  says otherwise.
 *  Sources: Iserles, Munthe-Kaas, Norsett and Zanna 2000; Marsden and Ratiu 1999, ch. 9 and sec. 14.7. */
#ifndef DVI_GROUP_H
#define DVI_GROUP_H
#include <dvi/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The rotation about w by |w|, R = exp(hat(w)).
 *
 *  @param      w  [3] radians
 *  @param[out] R  [9] orthogonal to 1 ulp, without bias: of N factors the product leaves the group by about sqrt(N) ulp */
void dvi_so3_exp(const double w[3], double R[9]);

/** The shortest w with exp(hat(w)) = R, |w| <= pi. At a half turn, where w and -w are as short: the one whose largest component is positive.
 *
 *  @param      R  [9] a rotation
 *  @param[out] w  [3] radians
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, see dvi_so3_project; w is as it was */
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

/** Cayley's map, R = (I - hat(w)/2)^-1 (I + hat(w)/2): the rotation about w by 2 atan(|w|/2). It agrees with exp to second order.
 *
 *  @param      w  [3]
 *  @param[out] R  [9] orthogonal to 1 ulp */
void dvi_so3_cayley(const double w[3], double R[9]);

/** The w with cayley(w) = R.
 *
 *  @param      R  [9] a rotation
 *  @param[out] w  [3]
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, or a half turn, where w would be infinite; w is as it was */
dvi_status dvi_so3_cayley_inverse(const double R[9], double w[3]);

/** u = dcayley_w v = (v + (w x v)/2) / (1 + |w|^2/4): d/dt cayley(w) = hat(dcayley_w w') cayley(w) = cayley(w) hat(dcayley_{-w} w'). All [3]. */
void dvi_so3_dcayley(const double w[3], const double v[3], double u[3]);

/** u = dcayley_w^-1 v = v - (w x v)/2 + w (w.v)/4. All [3]. */
void dvi_so3_dcayley_inverse(const double w[3], const double v[3], double u[3]);

/** The rotation of a quaternion: v becomes q v q^-1.
 *
 *  @param      q  [4] real part first, of any length; 0 is taken for 1
 *  @param[out] R  [9] orthogonal to 1 ulp, also where q is not of length 1 */
void dvi_so3_from_quaternion(const double q[4], double R[9]);

/** The unit quaternion of a rotation, of the two the one with q[0] >= 0; at a half turn (q[0] = 0) the one whose largest component is positive.
 *
 *  @param      R  [9] a rotation
 *  @param[out] q  [4] real part first
 *  @retval DVI_BAD_ARGUMENT  R is further than 1e-8 from a rotation, see dvi_so3_project; q is as it was */
dvi_status dvi_so3_quaternion(const double R[9], double q[4]);

#ifdef __cplusplus
}
#endif
#endif
