/* A shot takes one-step methods from node to node of a quadrature, on phase space z = (q,p). It
 * gives the derivatives of its end and of the sum along it.
 *
 *     z_{m+1} = Psi(z_m), of length h (c_{m+1} - c_m),
 *     S(z_0) = h sum_m b_m L(t_m, q_m, v(t_m,q_m,p_m)),     m = 0..pieces
 * A piece has stages with increments W_j = h_m f(Z_j), Z_j = z_m + sum_k a_jk W_k, and
 * z_{m+1} = z_m + sum_j b_j W_j. The costates, from the end to the start, give the gradient of
 * S + e.z_pieces exactly.
 *     Gamma_j = b_j lambda_{m+1} + sum_k a_kj h_m f_z(Z_k)^T Gamma_k,
 *     lambda_m = lambda_{m+1} + sum_j h_m f_z(Z_j)^T Gamma_j + h b_m L_z(z_m)
 * On phase space f_z consists of second derivatives of L alone (step/onestep/vector_field.h). For a
 * constant mass this is the shot in (q,v).
 *
 * Source: Leok and Shingel 2012, sec. 3; Hager 2000 (the costates of a Runge-Kutta method). */
#ifndef DVI_STEP_ONESTEP_SHOT_H
#define DVI_STEP_ONESTEP_SHOT_H
#include <dvi/taylor.h>

#include "step/onestep/vector_field.h"
#include "step/onestep/runge_kutta.h"

enum { DVI__PIECES_MOST = 256 };

/* The course has the nodes in the order of the shot, and their weights. A weight of 0 omits the
 * Lagrangian there, except at the ends. */
typedef struct dvi__course {
  int pieces;
  double c[DVI__PIECES_MOST + 1], b[DVI__PIECES_MOST + 1];
  /* number of Taylor coefficients of L at both ends (step/onestep/end_terms.h), with their weights;
   * 0 for a quadrature by values alone */
  int count;
  double weight[DVI_TAYLOR_MAX + 1];
} dvi__course;

typedef struct dvi__shot dvi__shot;

dvi_status dvi__shot_create(const dvi_system *system, const dvi__runge_kutta *method,
                            const dvi__course *course, dvi_counters *counters, dvi__shot **shot);
void dvi__shot_destroy(dvi__shot **shot);
dvi__vector_field *dvi__shot_vector_field(dvi__shot *shot);

/* Aim the next shots from time t0 and q [n], which the caller keeps unchanged, with length h. unit
 * [n] is the momentum that moves q by one unit in h. */
void dvi__shot_aim(dvi__shot *shot, double t0, double h, const double *q, const double *unit);

/* Shoot from (q, p [n]). reach [2n] is the motion of z. */
dvi_status dvi__shot_fire(dvi__shot *shot, const double *p, double *reach);

/* Compute the time that passes along the last shot of a time-transformed system, h sum_m b_m
 * g(q_m). */
dvi_status dvi__shot_duration(dvi__shot *shot, double *duration);

/* Compute the gradient [2n] of S + end.z_pieces of the last shot at its start, without end [2n]
 * itself. dvi__shot_trace, which evaluates second derivatives along the shot, comes first. */
dvi_status dvi__shot_trace(dvi__shot *shot);
dvi_status dvi__shot_costate(dvi__shot *shot, const double *end, double *gain);

/* Map 2n motions [2n] of the start, one after the other, to motions of the end, in place. */
dvi_status dvi__shot_move(dvi__shot *shot, double *motion);

#endif
