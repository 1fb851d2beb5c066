/* A system with factors in the charts at one point of its configuration space. It is an ordinary
 * Lagrangian of xi and its rate,
 *
 *     L(t, xi, xi') = L(t, y(xi), y'(xi, xi')),      y(0) = the centre
 *
 * for all code that knows R^n alone. A charted system belongs to one user, who moves its centre. It
 * has work memory, so it is not shared. */
#ifndef DVI_SYSTEM_CHART_CHARTED_H
#define DVI_SYSTEM_CHART_CHARTED_H
#include "num/simd/lanes.h"
#include "system/chart/centring.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__charted dvi__charted;

/* Create the charted system of a `system` with factors, which must outlive it. Counters count the
 * points at which `system` itself is evaluated. They must outlive the charted system, and be those
 * of every evaluator of the new system. If `reduced` is set, the Lagrangian is written in the
 * group's own velocity, which the centre does not change (system/chart/reduced.h). DVI_UNSUPPORTED
 * says that this is impossible. */
dvi_status dvi__charted_create(const dvi_system *system, int reduced, dvi_counters *counters,
                               dvi__charted **charted);
void dvi__charted_destroy(dvi__charted **charted);

/* Return the Lagrangian in the charts, in nx coordinates. */
const dvi_system *dvi__charted_system(const dvi__charted *charted);

/* Centre the charts at a point [nq]. */
void dvi__charted_centre(dvi__charted *charted, const double *q);

/* Compute L_vv at the centre, in the order of the new system's vv. This is the mass on the tangent
 * spaces there. */
void dvi__charted_mass(dvi__charted *charted, double *mass);

/* Make room for the centring of paths with `nodes` points in a batch, and fill in `centring`. This
 * may be called once. */
dvi_status dvi__charted_centring(dvi__charted *charted, int nodes, dvi__centring *centring);

/* Translate a status of the new system into the terms of `system`. If a callback of the new system
 * failed, the failure behind it is returned, and its sentence is set again. A coordinate beyond its
 * chart's half turn gives DVI_STEP_TOO_LARGE. */
dvi_status dvi__charted_explain(const dvi__charted *charted, dvi_status status);

/* Convert stored velocities or momenta [nv] at the centre to the chart's [nx], and back. */
void dvi__charted_enter(const dvi__charted *charted, const double *stored, double *local);
void dvi__charted_store(const dvi__charted *charted, const double *local, double *stored);

/* Move a state from the charts' centre to the end of the last path from there, with xi and p in the
 * charts, all compensated. The momentum changes with the angular momentum in space where there is
 * one, and else as the chart's momentum. */
void dvi__charted_arrive(const dvi__charted *charted, const dvi__phase *local,
                         const dvi__phase *state);

/* Compute the point q [nq] of xi, and the stored velocity v [nv] of the rate [nx]. Either may be
 * NULL. */
void dvi__charted_point(const dvi__charted *charted, const double *xi, const double *rate,
                        double *q, double *v);

/* Add what forces supply at a point of a path, times a weight, to the energy and to the momenta of
 * the symmetries, [1 + symmetries]. */
dvi_status dvi__charted_supply(dvi__charted *charted, double t, const double *xi,
                               const double *rate, double weight, double *supply);

/* Centre the charts at the end q [nq] of a path from their centre, `end` [nx] in them. `points`
 * [nx*s] are points of the path, coordinate i of point m at i*s + m and the last one its end. They
 * become offsets from the path's start in the new charts. */
void dvi__charted_follow(dvi__charted *charted, const double *q, const double *end, int s,
                         double *points);

/* Factor the matrix of index 1 of holonomic constraints, with the mass and phi_xi at a point,
 * for an evaluator of states. Then solve G M^-1 G^T lambda = r in place, lambda [rows]. *moved
 * is the largest coordinate of M^-1 G^T lambda in the charts. */
dvi_status dvi__charts_factor_rows(dvi__evaluator *e, double t, const double *q);
dvi_status dvi__charts_solve_rows(const dvi__evaluator *e, double t, double *lambda, double *moved);

/* Return DVI_STEP_TOO_LARGE if a coordinate of xi is beyond its chart. */
dvi_status dvi__charted_check(const dvi__charted *charted, const double *xi);

#endif
