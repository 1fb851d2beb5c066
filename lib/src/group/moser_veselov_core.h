/* Newton's method of moser_veselov.h on local numbers. It is compiled into the solution of one body
 * and into loops over members of ensembles, whose lanes have the bits of one. */
#ifndef DVI_GROUP_MOSER_VESELOV_CORE_H
#define DVI_GROUP_MOSER_VESELOV_CORE_H
#include "group/moser_veselov.h"
#include "group/stumpff.h"
#include "group/turn_core.h"

enum { DVI__BODY_ITERATIONS = 60 };

/* Turn rows into the principal axes or back. */
FUSED_INLINE void dvi__body_turn(const dvi__body *body, const dvi__turn *turn, const double x[3],
                                 double y[3])
{
  double change[3] = {0};
  if (body->turned) dvi__turn_changed(turn, x, change);
  for (int i = 0; i < 3; i++) y[i] = x[i] + change[i];
}

/* The coefficients a = 1 + more_a, b, c = least_c + more_c at s, and their derivatives. */
typedef struct dvi__body_coefficients {
  double more_a, b, least_c, more_c, a_s, b_s, c_s;
} dvi__body_coefficients;

FUSED_INLINE dvi__body_coefficients dvi__body_coefficients_at(dvi__moser_veselov_map by, double s)
{
  double c[9];
  if (by == DVI__BY_CAYLEY)
    return (dvi__body_coefficients){.b = 1, .least_c = 0.5, .more_c = 0.5 * s, .c_s = 0.5};
  dvi__stumpff(s, c);
  return (dvi__body_coefficients){.more_a = -s * c[3],
                                  .b = c[2],
                                  .least_c = 1,
                                  .a_s = 0.5 * (c[3] - c[2]),
                                  .b_s = 0.5 * (2 * c[4] - c[3])};
}

/* slant_i f_j f_k */
FUSED_INLINE void dvi__body_slants(const dvi__body *body, const double f[3], double product[3])
{
  for (int i = 0; i < 3; i++) product[i] = body->slant[i] * f[(i + 1) % 3] * f[(i + 2) % 3];
}

/* Guess f by two passes of Cayley's equation, solved for its linear term. The error is of fourth
 * order in the angle. */
FUSED_INLINE void dvi__body_guess(const dvi__body *body, dvi__moser_veselov_map by,
                                  const double g[3], double f[3])
{
  double product[3];
  for (int i = 0; i < 3; i++) f[i] = 0.5 * g[i];
  for (int pass = 0; pass < 2; pass++) {
    const double c = 0.5 * (1 + dvi__dot(f, f));
    dvi__body_slants(body, f, product);
    for (int i = 0; i < 3; i++) f[i] = c * g[i] - product[i];
  }
  const double stretch = 2 / (1 + dvi__dot(f, f) / 3); /* 2 atan(x)/x to the second order */
  for (int i = 0; i < 3 && by == DVI__BY_EXPONENTIAL; i++) f[i] *= stretch;
}

/* Guess f for h Pi, which becomes `inside` the principal axes. Return 0 if there is no F. */
FUSED_INLINE int dvi__body_begin(const dvi__body *body, dvi__moser_veselov_map by,
                                 const double impulse[3], double inside[3], double f[3])
{
  double g[3];
  dvi__body_turn(body, &body->into, impulse, inside);
  for (int i = 0; i < 3; i++) g[i] = inside[i] / body->moment[i];
  dvi__body_guess(body, by, g, f);
  return dvi__dot(impulse, impulse) <= body->largest * body->largest;
}

/* Compute the residual of the equation at f. Only c h Pi and J f at f = 0 are rounded to their own
 * size, because small terms are added last. */
FUSED_INLINE void dvi__body_residual(const dvi__body *body, const dvi__body_coefficients *at,
                                     const double impulse[3], const double f[3], double r[3])
{
  const double *d = body->second;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double Jf = d[j] * f[i] + d[k] * f[i], product = f[j] * f[k],
                 turned = d[j] * product - d[k] * product;
    r[i] = (at->least_c * impulse[i] - Jf) +
           (at->more_c * impulse[i] - at->more_a * Jf - at->b * turned);
  }
}

/* Compute Newton's correction at f. Return the determinant of the derivative. */
FUSED_INLINE double dvi__body_correction(const dvi__body *body, dvi__moser_veselov_map by,
                                         const double impulse[3], const double f[3],
                                         double delta[3])
{
  const dvi__body_coefficients at = dvi__body_coefficients_at(by, dvi__dot(f, f));
  double product[3], r[3], row[3][3], minor[3][3];
  dvi__body_slants(body, f, product);
  dvi__body_residual(body, &at, impulse, f, r);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double right_side = at.c_s * impulse[i] / body->moment[i];
    const double along = 2 * (at.a_s * f[i] + at.b_s * product[i] - right_side);
    r[i] /= body->moment[i];
    row[i][i] = (1 + at.more_a) + along * f[i];
    row[i][j] = at.b * body->slant[i] * f[k] + along * f[j];
    row[i][k] = at.b * body->slant[i] * f[j] + along * f[k];
  }
  for (int i = 0; i < 3; i++) dvi__cross(row[(i + 1) % 3], row[(i + 2) % 3], minor[i]);
  const double determinant = dvi__dot(row[0], minor[0]);
  for (int i = 0; i < 3; i++)
    delta[i] = (r[0] * minor[0][i] + r[1] * minor[1][i] + r[2] * minor[2][i]) / determinant;
  return determinant;
}

/* Iterate once from f. Return 1 if the new f is the solution. An iterate off the branch goes half
 * of the way back to `last`, the last one on it. */
FUSED_INLINE int dvi__body_iterate(const dvi__body *body, dvi__moser_veselov_map by,
                                   const double impulse[3], double f[3], double last[3])
{
  const double half_turn = 3.14159265358979323846,
               most = by == DVI__BY_CAYLEY ? HUGE_VAL : half_turn * half_turn;
  double delta[3];
  const double determinant = dvi__body_correction(body, by, impulse, f, delta),
               size = sqrt(dvi__dot(f, f));
  const int inside = (determinant > 0) & (size * size < most);
  for (int i = 0; i < 3; i++) {
    const double here = f[i], ahead = here + delta[i], back = 0.5 * (here + last[i]);
    f[i] = inside ? ahead : back;
    last[i] = inside ? here : last[i];
  }
  /* The next correction would be about |delta|^2 / determinant. */
  return inside & (dvi__dot(delta, delta) <= 1e-17 * determinant * size);
}

#endif
