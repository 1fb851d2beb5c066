/* The Hamiltonian vector field of a Lagrangian, or of a Hamiltonian, on phase space, z = (q,p),
 * with its first derivatives, at a number of points.
 *
 *     q' = H_p = v,     p' = -H_q = L_q(t,q,v),     v from p = L_v(t,q,v)
 * Second derivatives of L are all that H's need: for a motion (a,b) of (q,p) that of v is w =
 * L_vv^-1 (b - L_vq a), and
 *     H_qq a + H_qp b = -(L_qq a + L_qv w),     H_pq a + H_pp b = w.
 * A Hamiltonian gives its own. */
#ifndef DVI_ACTION_FIELD_H
#define DVI_ACTION_FIELD_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__vector_field dvi__vector_field;

dvi_status dvi__vector_field_create(const dvi_system *system, int points, dvi_counters *counters,
                                    dvi__vector_field **field);
void dvi__vector_field_destroy(dvi__vector_field **field);

/* Start the searches for velocities from v [n], which changes no more than their last digits. */
void dvi__vector_field_guess(dvi__vector_field *field, const double *v);

/* Put point k at (t, q, p): rate [2n] is that of z there. */
dvi_status dvi__vector_field_place(dvi__vector_field *field, int k, double t, const double *q,
                                   const double *p, double *rate);

/* The second derivatives at `count` points that are placed, from point `first` on. */
dvi_status dvi__vector_field_differentiate(dvi__vector_field *field, int first, int count);

/* Take point k for the products that follow. */
dvi_status dvi__vector_field_select(dvi__vector_field *field, int k);

/* There: product [2n] = second derivatives of H times motion [2n]; the gradient of L(t, q,
 * v(t,q,p)) in z, [2n]. */
void dvi__vector_field_product(dvi__vector_field *field, const double *motion, double *product);
void dvi__vector_field_lagrangian(dvi__vector_field *field, double *gradient);

/* There, with f = (H_p, -H_q): image [2n] = h f_z motion; h f_z^T costate. */
void dvi__vector_field_push(dvi__vector_field *field, double h, const double *motion,
                            double *image);
void dvi__vector_field_pull(dvi__vector_field *field, double h, const double *costate,
                            double *image);

/* What point k was placed at; v is the velocity there. */
typedef struct dvi__vector_field_point {
  double t;
  const double *q, *v;
} dvi__vector_field_point;

dvi__vector_field_point dvi__vector_field_point_at(const dvi__vector_field *field, int k);
dvi__vector_field_point dvi__vector_field_selected(const dvi__vector_field *field);

/* The rest is for Lagrangians. From point k to (t, q [n]) with the velocity changed by dv [n]: dp
 * [n]. */
dvi_status dvi__vector_field_impulse(dvi__vector_field *field, int k, double t, const double *q,
                                     const double *dv, double *dp);

/* At point k: what a motion [2n] of (q,v) makes of p = L_v, [n]; the transpose of that, covector
 * [n] to [2n]. */
void dvi__vector_field_lift(dvi__vector_field *field, int k, const double *motion, double *dp);
void dvi__vector_field_lower(dvi__vector_field *field, int k, const double *covector,
                             double *image);

/* size [n]: the momentum of a unit of velocity at (t,q,v). */
dvi_status dvi__vector_field_mass(dvi__vector_field *field, double t, const double *q,
                                  const double *v, double *size);

#endif
