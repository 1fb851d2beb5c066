/* Kicks and drifts of one slot on local numbers. They are compiled into the drift of one state and
 * into loops over members of ensembles, whose lanes have the bits of one. */
#ifndef DVI_STEP_LIE_SLOT_H
#define DVI_STEP_LIE_SLOT_H
#include "group/turn_core.h"

/* Kicks by h times the covector V_q. */
FUSED_INLINE void dvi__slot_kick_circle(double h, const double *V_q, const double *y, double *p,
                                        double *compensation)
{
  dvi__add_compensated(p, compensation, -h * (y[0] * V_q[1] - y[1] * V_q[0]));
}

FUSED_INLINE void dvi__slot_kick_body(double h, const double *V_q, const double *R, double *p,
                                      double *compensation)
{
  double moment[3] = {0};
  for (int j = 0; j < 3; j++) {
    const double x[] = {R[j], R[3 + j], R[6 + j]}, f[] = {V_q[j], V_q[3 + j], V_q[6 + j]};
    double product[3];
    dvi__cross(x, f, product);
    for (int i = 0; i < 3; i++) moment[i] += product[i];
  }
  for (int i = 0; i < 3; i++)
    dvi__add_compensated(p + i, compensation + i,
                         -h * (R[i] * moment[0] + R[3 + i] * moment[1] + R[6 + i] * moment[2]));
}

FUSED_INLINE void dvi__slot_kick_direction(double h, const double *V_q, const double *y, double *p,
                                           double *compensation)
{
  const double radial = dvi__dot(y, V_q) / dvi__dot(y, y);
  for (int i = 0; i < 3; i++)
    dvi__add_compensated(p + i, compensation + i, -h * (V_q[i] - radial * y[i]));
}

/* Return sin(a)/tan(a/2), for angles up to a quarter turn. */
FUSED_INLINE double dvi__slot_one_and_cosine(double sine)
{
  return 1 + sqrt((1 - sine) * (1 + sine));
}

/* Turn an angle y = (cos, sin, 0) by one with this sine. */
FUSED_INLINE void dvi__slot_turn_circle(double sine, double y[3], double y_compensation[3])
{
  const double w[] = {0, 0, -sine / dvi__slot_one_and_cosine(sine)};
  const dvi__turn turn = dvi__turn_made(w);
  dvi__turn_row(&turn, y, y_compensation);
}

/* Turn a direction by a about mu, with sin(a) = |h mu/m|. The rotation keeps mu. Returns the sine,
 * and the displacement that dvi__slot_stretch has to stretch. Where the sine is not below 1 there
 * is no such rotation. */
FUSED_INLINE double dvi__slot_turn_direction(double h, double mass, double *y,
                                             double *y_compensation, double *p,
                                             double *p_compensation, double *displacement)
{
  dvi__twofold mu[3];
  double w[3];
  dvi__turn_angular_of(y, y_compensation, p, p_compensation, mu);
  for (int i = 0; i < 3; i++) w[i] = h * (mu[i].head / mass);
  const double sine = sqrt(dvi__dot(w, w));
  dvi__cross(w, y, displacement);
  for (int i = 0; i < 3; i++) w[i] /= -dvi__slot_one_and_cosine(sine);
  const dvi__turn turn = dvi__turn_made(w);
  dvi__turn_row(&turn, y, y_compensation);
  dvi__turn_momentum_of(mu, DVI__TURN_ANY, y, y_compensation, p, p_compensation);
  return sine;
}

/* Return a/sin(a). */
FUSED_INLINE double dvi__slot_stretch(double sine)
{
  return sine > 0 ? asin(sine) / sine : 1;
}

/* Compute rho x R^T p_x of a rigid motion with the centre of mass rho. */
FUSED_INLINE void dvi__slot_moment(const double centre[3], const double *R, const double *p_x,
                                   double moment[3])
{
  double turned[3];
  for (int i = 0; i < 3; i++) turned[i] = R[i] * p_x[0] + R[3 + i] * p_x[1] + R[6 + i] * p_x[2];
  dvi__cross(centre, turned, moment);
}

/* Add sign rho x R^T p_x to Pi of a rigid motion with the momenta p [6]. A sign of -1 gives the
 * momentum about the centre of mass. */
FUSED_INLINE void dvi__slot_shift(double sign, const double centre[3], const double *R, double *p,
                                  double *compensation)
{
  double moment[3];
  dvi__slot_moment(centre, R, p + 3, moment);
  for (int i = 0; i < 3; i++) dvi__add_compensated(p + i, compensation + i, sign * moment[i]);
}

/* Compute dx = h p_x/m - R (F - I) rho of the rotation F by w. */
FUSED_INLINE void dvi__slot_place(double mass, const double centre[3], double h, const double *R,
                                  const double *p_x, const double *w, double *dx)
{
  const double reversed[] = {-w[0], -w[1], -w[2]};
  const dvi__turn back = dvi__turn_made(reversed);
  double moved[3];
  dvi__turn_changed(&back, centre, moved);
  for (int i = 0; i < 3; i++) dx[i] = h * (p_x[i] / mass) - dvi__dot(R + 3 * i, moved);
}

#endif
