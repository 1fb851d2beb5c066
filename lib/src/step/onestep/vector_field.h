/* The Hamiltonian vector field of a Lagrangian, or of a Hamiltonian, on phase space, z = (q,p),
 * with its first derivatives, at a number of points.
 *
 *     q' = H_p = v,     p' = -H_q = L_q(t,q,v),     v from p = L_v(t,q,v)
 *
 * The second derivatives of H follow from those of L. For a motion (a,b) of (q,p) that of v is
 * w = L_vv^-1 (b - L_vq a), and
 *     H_qq a + H_qp b = -(L_qq a + L_qv w),     H_pq a + H_pp b = w.
 * A Hamiltonian gives its own derivatives. */
#ifndef DVI_STEP_ONESTEP_VECTOR_FIELD_H
#define DVI_STEP_ONESTEP_VECTOR_FIELD_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__vector_field dvi__vector_field;

dvi_status dvi__vector_field_create(const dvi_system *system, int points, dvi_counters *counters,
                                    dvi__vector_field **field);
void dvi__vector_field_destroy(dvi__vector_field **field);

/* Start the searches for velocities from v [n], which affects no more than their last digits. */
void dvi__vector_field_guess(dvi__vector_field *field, const double *v);

/* Put point k at (t, q, p), and write rate [2n] of z there. */
dvi_status dvi__vector_field_place(dvi__vector_field *field, int k, double t, const double *q,
                                   const double *p, double *rate);

/* Compute the second derivatives at `count` placed points, from point `first` on. */
dvi_status dvi__vector_field_differentiate(dvi__vector_field *field, int first, int count);

/* Select point k for the products below. */
dvi_status dvi__vector_field_select(dvi__vector_field *field, int k);

/* Compute products at the selected point. product [2n] is the second derivative of H times motion
 * [2n]. gradient [2n] is that of L(t, q, v(t,q,p)) in z. */
void dvi__vector_field_product(dvi__vector_field *field, const double *motion, double *product);
void dvi__vector_field_lagrangian(dvi__vector_field *field, double *gradient);

/* Compute image [2n] = h f_z motion, or h f_z^T costate, at the selected point with f = (H_p,
 * -H_q). */
void dvi__vector_field_push(dvi__vector_field *field, double h, const double *motion,
                            double *image);
void dvi__vector_field_pull(dvi__vector_field *field, double h, const double *costate,
                            double *image);

/* The time and place of point k, and the velocity there. */
typedef struct dvi__vector_field_point {
  double t;
  const double *q, *v;
} dvi__vector_field_point;

dvi__vector_field_point dvi__vector_field_point_at(const dvi__vector_field *field, int k);
dvi__vector_field_point dvi__vector_field_selected(const dvi__vector_field *field);

/* The functions below are for Lagrangians. This one computes dp [n] from point k to (t, q [n]) with
 * the velocity changed by dv [n]. */
dvi_status dvi__vector_field_impulse(dvi__vector_field *field, int k, double t, const double *q,
                                     const double *dv, double *dp);

/* Map a motion [2n] of (q,v) at point k to the change [n] of p = L_v. dvi__vector_field_lower is
 * the transpose, from covector [n] to [2n]. */
void dvi__vector_field_lift(dvi__vector_field *field, int k, const double *motion, double *dp);
void dvi__vector_field_lower(dvi__vector_field *field, int k, const double *covector,
                             double *image);

/* Compute size [n], the momentum of a unit of velocity at (t,q,v). */
dvi_status dvi__vector_field_mass(dvi__vector_field *field, double t, const double *q,
                                  const double *v, double *size);

#endif
