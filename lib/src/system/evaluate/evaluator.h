/* Evaluation of a system's Lagrangian and its derivatives at batches of points.
 *
 * A system is shared and constant. An evaluator belongs to one user, owns the scratch memory and
 * counts. Nothing here allocates after create, but for the first factor of a velocity Hessian
 * (num/linear.h). Batches are component-major. Coordinate i of point k is q[i*count + k]. */
#ifndef DVI_SYSTEM_EVALUATE_EVALUATOR_H
#define DVI_SYSTEM_EVALUATE_EVALUATOR_H
#include <dvi/integrator.h>

#include "system/system.h"

typedef struct dvi__evaluator dvi__evaluator;

/* The derivatives that a user of an evaluator needs. DVI__STATES stands for gradients and for the
 * functions of one state below, with q [nq], v and p [nv], on a manifold if the system has factors.
 * All other functions then take v as the rate of the stored coordinates. */
typedef enum dvi__derivatives { DVI__GRADIENTS, DVI__HESSIANS, DVI__STATES } dvi__derivatives;

/* Create an evaluator for batches of up to `capacity` points. counters counts values, gradients,
 * hessians and factorisations of the mass. It may be NULL, and must outlive the evaluator. */
dvi_status dvi__evaluator_create(const dvi_system *system, int capacity, dvi__derivatives most,
                                 dvi_counters *counters, dvi__evaluator **evaluator);
void dvi__evaluator_destroy(dvi__evaluator **evaluator);

/* Make the room of symmetries, which dvi__invariant otherwise makes when it is first needed, for
 * steps that call dvi__supply without declared forces. */
dvi_status dvi__evaluator_prepare_symmetries(dvi__evaluator *e);

/* Let an evaluator that was created without Hessians evaluate them, too, from now on. On failure it
 * is as it was: DVI_NO_MEMORY, DVI_BAD_SIZE. */
dvi_status dvi__evaluator_prepare_hessians(dvi__evaluator *e);

/* With a Hamiltonian all functions of the Lagrangian give H and its derivatives. p takes the place
 * of v. */

/* Compute L [count] at t [count], q and v [n*count]. Every result is finite, or the status is
 * DVI_NOT_FINITE. */
dvi_status dvi__lagrangian_value(dvi__evaluator *e, int count, const double *t, const double *q,
                                 const double *v, double *L);

/* Compute L_q and L_v [n*count]. Either may be NULL. For a constant mass L_v is M v and costs no
 * callback, but for A of a vector potential. L_q is the sum of all forces, those without a
 * potential included. */
dvi_status dvi__lagrangian_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                    const double *v, double *L_q, double *L_v);

/* Compute V_q [n*count], the sum of the potentials' gradients, less the forces F(t,q) without
 * velocity, but with factors without any forces. For a constant mass this is -L_q unless forces
 * depend on the velocity, or there is a vector potential. */
dvi_status dvi__potentials_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                    double *V_q);

/* Compute the vector potential A [n*count] of a system that has one. It counts as a gradient. */
dvi_status dvi__vector_potential(dvi__evaluator *e, int count, const double *t, const double *q,
                                 double *A);

/* Compute the gradients of A [entries*count] in the order of the system's qv, and the rate A_t
 * [n*count], which is 0 for an autonomous system. The call belongs to dvi__potentials_gradient at
 * the same points, which counts. */
dvi_status dvi__magnetic_field(dvi__evaluator *e, int count, const double *t, const double *q,
                               double *A_q, double *A_t);

/* Compute -L_q [n*count], without forces that depend on the velocity, and A [n*count] of a system
 * with a vector potential. */
dvi_status dvi__magnetic_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                  const double *v, double *V_q, double *A);

/* Compute v.Mv/2 + V of one state. The system must have DVI__CONSTANT_MASS. */
dvi_status dvi__mass_energy(dvi__evaluator *e, double t, const double *q, const double *v,
                            double *E);

/* Compute L_t [count] for a system with dvi__system_has_rates. An autonomous system has 0. Calls
 * count as values. */
dvi_status dvi__lagrangian_rate(dvi__evaluator *e, int count, const double *t, const double *q,
                                const double *v, double *L_t);

/* Tell if a general Lagrangian is defined at q, where a step ends. */
dvi_status dvi__lagrangian_admit(const dvi__evaluator *e, double t, const double *q);

/* Compute L_qq, L_qv, L_vv [entries*count] in the order of the system's patterns, entry-major. This
 * needs DVI__HESSIANS. For a constant mass L_qv is empty, or has the gradients of a vector
 * potential, and L_qv and L_vv may be NULL. */
dvi_status dvi__lagrangian_hessian(dvi__evaluator *e, int count, const double *t, const double *q,
                                   const double *v, double *L_qq, double *L_qv, double *L_vv);

/* Compute the sum F [n*count] of the forces of these kinds, DVI__FORCE or DVI__FRICTION or both,
 * and the derivatives F_q and F_v [entries*count] of all, in the order of the system's by_q and
 * by_v. The latter need DVI__HESSIANS. */
dvi_status dvi__forces(dvi__evaluator *e, unsigned kinds, int count, const double *t,
                       const double *q, const double *v, double *F);
dvi_status dvi__forces_jacobian(dvi__evaluator *e, int count, const double *t, const double *q,
                                const double *v, double *F_q, double *F_v);

/* Compute what forces F [n*count] at a batch of points supply to the energy and to the momenta of
 * the symmetries, [1 + symmetry_count], per unit of time: the sum over the points of the weight
 * times F.v, and times F.xi(q). */
dvi_status dvi__supply(dvi__evaluator *e, int count, const double *weight, const double *F,
                       const double *q, const double *v, double *supply);

/* Compute L_vv of a general Lagrangian at one point. *L_vv is owned by the evaluator and valid
 * until its next call. Potentials do not change it. */
dvi_status dvi__velocity_hessian(dvi__evaluator *e, double t, const double *q, const double *v,
                                 const double **L_vv);

/* Return DVI_BAD_ARGUMENT if q of one state is not on the manifold of the factors, or second, v or
 * p, is not in its tangent space. */
dvi_status dvi__state_check(const dvi__evaluator *e, const double *q, const double *second);

/* Find v with L_v(t,q,v) = p at one state, or the velocity of the equations of motion with a
 * one-form. v holds a guess for general Lagrangians, and is unchanged on failure. */
dvi_status dvi__legendre_inverse(dvi__evaluator *e, double t, const double *q, const double *p,
                                 double *v);

/* Largest count of rows for which the side of a matrix's singular points is found (dynamics.h). */
enum { DVI__SIDES_MOST = 16 };

/* Compute alpha [n] of a one-form at one point, and the gradient [n] of alpha(q).w, w [n]. */
dvi_status dvi__form_gradient(dvi__evaluator *e, const double *q, const double *w,
                              double *alpha_w_q, double *alpha);

/* Compute the Hessian of alpha(q).w in the order of the system's qq, and the gradients of alpha in
 * that of its qv. This needs DVI__HESSIANS. */
dvi_status dvi__form_hessian(dvi__evaluator *e, const double *q, const double *w,
                             double *alpha_w_qq, double *alpha_q);

/* Return DVI_SINGULAR if one state has no velocity, or no motion. */
dvi_status dvi__legendre_regular(dvi__evaluator *e, double t, const double *q, const double *v);

/* Compute both rates v and pdot [n] of one state, and the multipliers of a Hamiltonian's
 * constraints if `multiplier` is not NULL. v holds a guess as above. States on a manifold are
 * excluded. */
dvi_status dvi__state_rates(dvi__evaluator *e, double t, const double *q, const double *p,
                            double *v, double *pdot, double *multiplier);

/* Compute x [n*count, component-major] = M^{-1} y for the constant mass. x may be y. The system
 * must have DVI__CONSTANT_MASS. */
void dvi__mass_solve(dvi__evaluator *e, int count, const double *y, double *x);

/* Return the sign 1 or -1 of the mass's determinant, and 1 if the mass is positive definite. The
 * latter needs a mass that is not factored as a full matrix. */
int dvi__mass_sign(const dvi__evaluator *e);
int dvi__mass_is_positive(const dvi__evaluator *e);

/* Compute invariant i of one state, or all invariants. v is the velocity that belongs to p, and is
 * read by the energy (i = 0) alone. */
dvi_status dvi__invariant(dvi__evaluator *e, double t, const double *q, const double *v,
                          const double *p, int i, double *value);
dvi_status dvi__invariants(dvi__evaluator *e, double t, const double *q, const double *v,
                           const double *p, double *value);

/* A state at a time. v [n] is room, with a guess of the velocity for general Lagrangians. With all
 * Lagrangians it becomes the velocity. */
typedef struct dvi__instant {
  double t;
  const double *q, *p;
  double *v;
} dvi__instant;

/* Compute the change of the energy between two states of a step, less the work of forces, and its
 * size. `work` is what forces without a potential, and rates L_t, supplied. NULL stands for the
 * mean of the forces' power at both ends. The size is the larger kinetic energy p.v/2. A one-form
 * has none. There, and on phase space, the size is sum |H_q dq| + |H_p dp|, the energy that the
 * step moves between the coordinates. Factors are excluded. */
dvi_status dvi__energy_change(dvi__evaluator *e, const dvi__instant *before,
                              const dvi__instant *after, const double *work, double *change,
                              double *exchanged);

/* Compute the distance between a step's change and the mean of the rates at its ends, relative to
 * the larger change. The worst one of all coordinates counts, and of all momenta of a Lagrangian.
 * It is (h omega)^2/12 for well resolved motions. Call this after dvi__energy_change of the same
 * states, which leaves v there. forces [2 n] is work. */
dvi_status dvi__motion_defect(dvi__evaluator *e, const dvi__instant *before,
                              const dvi__instant *after, double *forces, double *defect);

#endif
