/* Evaluates a system's Lagrangian and its derivatives at batches of points.
 *
 * A system is shared and constant; an evaluator belongs to one user, owns the scratch memory and
 * counts. Nothing here allocates after create, but for the first factor of a velocity Hessian
 * (num/linear.h). Batches are component-major: coordinate i of point k is q[i*count + k]. */
#ifndef DVI_SYSTEM_EVALUATOR_H
#define DVI_SYSTEM_EVALUATOR_H
#include <dvi/integrator.h>

#include "system/system.h"

typedef struct dvi__evaluator dvi__evaluator;

/* What a user of an evaluator will ask for. With DVI__STATES, gradients and what is marked so
 * below: q [nq] with v and p [nv], on a manifold if the system has factors. All else takes v as the
 * rate of the stored coordinates then. */
typedef enum dvi__derivatives { DVI__GRADIENTS, DVI__HESSIANS, DVI__STATES } dvi__derivatives;

/* For batches of up to `capacity` points. counters may be NULL; else values, gradients and hessians
 * are counted there, and the factorisations of the mass. It must outlive the evaluator. */
dvi_status dvi__evaluator_create(const dvi_system *system, int capacity, dvi__derivatives most,
                                 dvi_counters *counters, dvi__evaluator **evaluator);
void dvi__evaluator_destroy(dvi__evaluator **evaluator);

/* Let one that was created without them evaluate Hessians, too, from now on. On failure it is as it
 * was: DVI_NO_MEMORY, DVI_BAD_SIZE. */
dvi_status dvi__evaluator_prepare_hessians(dvi__evaluator *e);

/* With a Hamiltonian all functions of the Lagrangian give H and its derivatives: p stands for v. */

/* L [count] at t [count], q and v [n*count]. Every result is finite, or the status is
 * DVI_NOT_FINITE. */
dvi_status dvi__lagrangian_value(dvi__evaluator *e, int count, const double *t, const double *q,
                                 const double *v, double *L);

/* L_q and L_v [n*count]; either may be NULL. For a constant mass L_v is M v and costs no
 * callback. */
dvi_status dvi__lagrangian_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                    const double *v, double *L_q, double *L_v);

/* V_q [n*count], the sum of the potentials' gradients: what a constant mass has for -L_q. */
dvi_status dvi__potentials_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                    double *V_q);

/* L_t [count], for a system of which dvi__system_has_rates; 0 of an autonomous one. Counted as
 * values. */
dvi_status dvi__lagrangian_rate(dvi__evaluator *e, int count, const double *t, const double *q,
                                const double *v, double *L_t);

/* Only with DVI__HESSIANS. L_qq, L_qv, L_vv: [entries*count] in the order of the system's patterns,
 * entry-major. For a constant mass L_qv is empty, and L_qv and L_vv may be NULL. */
dvi_status dvi__lagrangian_hessian(dvi__evaluator *e, int count, const double *t, const double *q,
                                   const double *v, double *L_qq, double *L_qv, double *L_vv);

/* One point of a general Lagrangian: *L_vv is owned by the evaluator, valid until its next call.
 * Potentials do not matter for it. */
dvi_status dvi__velocity_hessian(dvi__evaluator *e, double t, const double *q, const double *v,
                                 const double **L_vv);

/* One state: DVI_BAD_ARGUMENT if q is not on the manifold of the factors, or second, v or p, not in
 * its tangent space. */
dvi_status dvi__state_check(const dvi__evaluator *e, const double *q, const double *second);

/* One state: v with L_v(t,q,v) = p, or that of the equations of motion with a one-form. v holds a
 * guess for general Lagrangians; unchanged on failure. */
dvi_status dvi__legendre_inverse(dvi__evaluator *e, double t, const double *q, const double *p,
                                 double *v);

/* Up to so many rows the side of a matrix's singular points is told (dynamics.h). */
enum { DVI__SIDES_MOST = 16 };

/* One point of a one-form: alpha [n], and the gradient [n] of alpha(q).w, w [n]. */
dvi_status dvi__form_gradient(dvi__evaluator *e, const double *q, const double *w,
                              double *alpha_w_q, double *alpha);

/* Only with DVI__HESSIANS. The Hessian of alpha(q).w in the order of the system's qq, and the
 * gradients of alpha in that of its qv. */
dvi_status dvi__form_hessian(dvi__evaluator *e, const double *q, const double *w,
                             double *alpha_w_qq, double *alpha_q);

/* One state: DVI_SINGULAR if it has no velocity, or no motion. */
dvi_status dvi__legendre_regular(dvi__evaluator *e, double t, const double *q, const double *v);

/* One state: both rates v and pdot [n]; v holds a guess as above; the multipliers of a
 * Hamiltonian's constraints if they are not NULL. Not on a manifold. */
dvi_status dvi__state_rates(dvi__evaluator *e, double t, const double *q, const double *p,
                            double *v, double *pdot, double *multiplier);

/* x [n*count, component-major] = M^{-1} y for the constant mass; x may be y. Only for systems with
 * DVI__CONSTANT_MASS. */
void dvi__mass_solve(dvi__evaluator *e, int count, const double *y, double *x);

/* The sign of its determinant, 1 or -1; whether it is positive definite, of one that is not
 * factored as a full matrix. */
int dvi__mass_sign(const dvi__evaluator *e);
int dvi__mass_is_positive(const dvi__evaluator *e);

/* One state: invariant i, or all of them; v is the velocity that belongs to p, and is read by the
 * energy (i = 0) alone. */
dvi_status dvi__invariant(dvi__evaluator *e, double t, const double *q, const double *v,
                          const double *p, int i, double *value);
dvi_status dvi__invariants(dvi__evaluator *e, double t, const double *q, const double *v,
                           const double *p, double *value);

/* A state at a time; v [n]: room, with a guess of the velocity for general Lagrangians; of all
 * Lagrangians it becomes the velocity. */
typedef struct dvi__instant {
  double t;
  const double *q, *p;
  double *v;
} dvi__instant;

/* Two states of a step: by how much the energy changes, and what that is measured by: the larger
 * kinetic energy p.v/2; of a one-form, which has none, and of phase space sum |H_q dq| + |H_p dp|,
 * what the step moves between the coordinates. Not with factors. */
dvi_status dvi__energy_change(dvi__evaluator *e, const dvi__instant *before,
                              const dvi__instant *after, double *change, double *exchanged);

/* After dvi__energy_change of the same states, whose v it left there: how far the step leads from
 * where the mean of the rates at its ends does, as a part of the larger one's way: of all
 * coordinates, and of all momenta of a Lagrangian, the worst; (h omega)^2/12 for well resolved
 * motions. forces [2 n]: room. */
dvi_status dvi__motion_defect(dvi__evaluator *e, const dvi__instant *before,
                              const dvi__instant *after, double *forces, double *defect);

#endif
