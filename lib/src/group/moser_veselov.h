/* The Moser-Veselov step of a free body finds the rotation F of one step of discrete length h from
 * the body momentum Pi at its start,
 *
 *     F Jd - Jd F^T = (h Pi)^,     Jd = tr(J)/2 I - J,
 *
 * on the branch connected to h = 0, where F is the identity. Source: Moser and Veselov 1991; Leok
 * and Shingel 2012, sec. 2.3. */
#ifndef DVI_GROUP_MOSER_VESELOV_H
#define DVI_GROUP_MOSER_VESELOV_H
#include "group/turn.h"

/* The unknown f of Newton's method. F = exp(f^) or F = (I + f^)(I - f^)^-1. Both give the same
 * F. */
typedef enum dvi__moser_veselov_map { DVI__BY_EXPONENTIAL, DVI__BY_CAYLEY } dvi__moser_veselov_map;

/* A body in its principal axes. */
typedef struct dvi__body {
  double second[3];    /* second moments d */
  double moment[3];    /* moments J_i = d_j + d_k, i, j, k cyclic */
  double slant[3];     /* slants (J_k - J_j)/J_i = (d_j - d_k)/J_i, between -1 and 1 */
  double largest;      /* largest moment */
  int turned;          /* not 0 if the principal axes are not those of the body's frame */
  dvi__turn into, out; /* Turns of rows x^T F into the principal axes, and of rows y^T F^T back. */
} dvi__body;

/* Read a body from the symmetric Jd [9]. Return 0 unless all moments are positive. */
int dvi__body_of(const double Jd[9], dvi__body *body);

/* Find w = n tan(a/2) of the rotation F about n by a, from h Pi. Return the count of iterations, or
 * 0 if there is no such F on the branch. */
int dvi__body_moser_veselov(const dvi__body *body, dvi__moser_veselov_map by,
                            const double impulse[3], double w[3]);

/* Compute Omega = J^-1 Pi. Both may be one array. */
void dvi__body_velocity(const dvi__body *body, const double Pi[3], double Omega[3]);

#endif
