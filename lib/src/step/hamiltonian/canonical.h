/* One step by a Galerkin discrete Hamiltonian, for a Hamiltonian H(t,q,p) that may be degenerate.
 *
 *     q(tau) = q0 + sum_k psi_k(tau) Y_k,  psi_k(0) = 0,   k = 1..s,
 *     P_j = p0 + Pi_j at the points c_j,   j = 1..r
 *     S = sum_j b_j ( P_j.q'(c_j) - h H(t0 + c_j h, q(c_j), P_j) ),
 *     H+(q0,p1) = ext ( p1.q(1) - S )
 *
 * The discrete Hamilton's equations q1 = D2 H+(q0,p1), p0 = D1 H+(q0,p1) are q1 = q(1), p1 = p0 - h
 * sum_j b_j H_q_j and, with these,
 *
 *     sum_k psi_k'(c_j) Y_k - h H_p_j = 0,
 *     sum_j b_j ( psi_k' Pi - h (psi_k - psi_k(1)) H_q )_j = 0.
 *
 * H-(p0,q1) = -p0.q0 - S and, where H_pp is regular, Ld(q0,q1) = S generate the same map. With
 * r = s this is a partitioned Runge-Kutta method that needs no second derivative to be regular.
 * With r > s the first r equations need a regular H_pp, because they determine q' by s values only.
 *
 * Source: Leok and Zhang 2011, secs. 2 and 3. The increments Pi, and the elimination of p1, are
 * ours.
 *
 * Unknowns and rows are stored component by component, m = s + r of each. x[i*m + k] holds Y_k and
 * then Pi_j in the units of p_i. The rows are the first s of the first equations, the second
 * equations, and the rest of the first equations. With this order no row has a 0 on the diagonal
 * for small h. */
#ifndef DVI_STEP_HAMILTONIAN_CANONICAL_H
#define DVI_STEP_HAMILTONIAN_CANONICAL_H
#include "step/element/action.h"

/* The largest degree, and the most points, of such a step. */
enum { DVI__CANONICAL_DEGREE = 8, DVI__CANONICAL_POINTS = 9 };

typedef struct dvi__canonical dvi__canonical;

/* Create a step for a system with DVI__HAMILTONIAN. The space's numbers must be valid, with
 * nodes >= degree. */
dvi_status dvi__canonical_create(const dvi_system *system, const dvi__action_space *space,
                                 dvi_counters *counters, dvi__canonical **canonical);
void dvi__canonical_destroy(dvi__canonical **canonical);

const dvi__pattern *dvi__canonical_pattern(const dvi__canonical *canonical);
dvi__evaluator *dvi__canonical_evaluator(const dvi__canonical *canonical);

/* Put the step at (t0, q0, p0). The caller keeps the arrays unchanged. The increments of p_i are
 * unknown in units of unit_i, unit [n] > 0. */
void dvi__canonical_place(dvi__canonical *canonical, double t0, double h, const double *q0,
                          const double *p0, const double *unit);

dvi_status dvi__canonical_residual(dvi__canonical *canonical, const double *x, double *R);
dvi_status dvi__canonical_jacobian(dvi__canonical *canonical, const double *x, double *values);
dvi_status dvi__canonical_scale(dvi__canonical *canonical, double *scale);

/* Fixed-point iteration, for steps with as many points as degrees. Begin at the unknowns x,
 * iterate, and write the unknowns of the last iteration. Each gives the largest change of an
 * increment at the points, and the largest increment, those of p in their units. */
int dvi__canonical_has_iteration(const dvi__canonical *canonical);
void dvi__canonical_begin(dvi__canonical *canonical, const double *x);
dvi_status dvi__canonical_iterate(dvi__canonical *canonical, double *change, double *whole);
void dvi__canonical_finish(const dvi__canonical *canonical, double *x);

/* Write the increments of q and p, [n] each, of the last residual or iteration. */
void dvi__canonical_ends(const dvi__canonical *canonical, const double *x, double *dq, double *dp);

/* Write x with the increments of p in their own units, for dvi__canonical_continue. */
void dvi__canonical_keep(const dvi__canonical *canonical, const double *x, double *kept);

/* Write x for a straight line along v [n] with constant p. dvi__canonical_continue continues the
 * polynomials of the last step, as dvi__canonical_keep wrote them, with ratio = h_next / h_last. */
void dvi__canonical_straight(const dvi__canonical *canonical, const double *v, double *x);
void dvi__canonical_continue(dvi__canonical *canonical, double ratio, const double *last,
                             double *x);

/* Evaluate q and v [n] at tau of a step of length h from q0 with the numbers `kept`. Either may be
 * NULL. */
void dvi__canonical_path(const dvi__canonical *canonical, const double *kept, const double *q0,
                         double h, double tau, double *q, double *v);

/* Evaluate H_pp [entries of the system's vv] at one point. */
dvi_status dvi__canonical_curvature(dvi__canonical *canonical, double t, const double *q,
                                    const double *p, const double **H_pp);

/* Set rows [n] to the sums of |d2H/dq_i dq_j| over j. */
dvi_status dvi__canonical_stiffness(dvi__canonical *canonical, double t, const double *q,
                                    const double *p, double *rows);

#endif
