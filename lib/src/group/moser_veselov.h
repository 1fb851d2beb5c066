/* The leap of a free body: the rotation F of one step of discrete length h, from the body momentum
 * Pi at its start,
 *
 *     F Jd - Jd F^T = (h Pi)^,     Jd = tr(J)/2 I - J,                                    Moser and Veselov 1991; Leok and Shingel 2012, sec. 2.3
 *
 * on the branch that is the identity for h = 0. */
#ifndef DVI_GROUP_LEAP_H
#define DVI_GROUP_LEAP_H
#include "group/turn.h"

/* The unknown of Newton's method: f of F = exp(f^), or f of F = (I + f^)(I - f^)^-1. Both give the
 * same F. */
typedef enum dvi__moser_veselov_map { DVI__BY_EXPONENTIAL, DVI__BY_CAYLEY } dvi__moser_veselov_map;

/* A body in its principal axes. */
typedef struct dvi__body {
  double second[3];    /* d, its second moments */
  double moment[3];    /* J_i = d_j + d_k, i, j, k cyclic */
  double slant[3];     /* (J_k - J_j)/J_i = (d_j - d_k)/J_i: between -1 and 1 */
  double largest;      /* of the moments */
  int turned;          /* not 0: the axes are not those of the body's frame, but */
  dvi__turn into, out; /* rows x F and y F^T are vectors in them, and back */
} dvi__body;

/* From Jd [9], symmetric. 0 unless all moments are positive. */
int dvi__body_of(const double Jd[9], dvi__body *body);

/* w = n tan(a/2) of the rotation F about n by a, from h Pi. The number of iterations; 0: there is
 * no such F, or none that belongs to the branch. */
int dvi__body_moser_veselov(const dvi__body *body, dvi__moser_veselov_map by,
                            const double impulse[3], double w[3]);

/* Omega = J^-1 Pi; both may be one array. */
void dvi__body_velocity(const dvi__body *body, const double Pi[3], double Omega[3]);

#endif
