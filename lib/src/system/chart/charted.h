/* A system with factors in the charts at one point of its configuration space: an ordinary
 * Lagrangian of xi and its rate,
 *
 *     L(t, xi, xi') = L(t, y(xi), y'(xi, xi')),      y(0) = the centre
 *
 * for everything that knows R^n alone. It belongs to one user, who moves its centre, and has work
 * memory, so it is not shared. */
#ifndef DVI_SYSTEM_CHARTED_H
#define DVI_SYSTEM_CHARTED_H
#include "num/simd/lanes.h"
#include "system/chart/centring.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__charted dvi__charted;

/* `system` must have factors, and outlive it. Counters, which must outlive it, count the points at
 * which `system` itself is evaluated; they must be those of every evaluator of the new system.
 * `reduced`: the Lagrangian as one of the group's own velocity, which the centre does not change
 * (system/chart/reduced.h); DVI_UNSUPPORTED if it is none. */
dvi_status dvi__charted_create(const dvi_system *system, int reduced, dvi_counters *counters,
                               dvi__charted **charted);
void dvi__charted_destroy(dvi__charted **charted);

/* The Lagrangian in the charts, in nx coordinates. */
const dvi_system *dvi__charted_system(const dvi__charted *charted);

/* Centre the charts at a point [nq]. */
void dvi__charted_centre(dvi__charted *charted, const double *q);

/* L_vv at the centre, in the order of the new system's vv: the mass as the tangent spaces there
 * have it. */
void dvi__charted_mass(dvi__charted *charted, double *mass);

/* Make room for the centring of paths with `nodes` points in a batch, and fill it in. Once. */
dvi_status dvi__charted_centring(dvi__charted *charted, int nodes, dvi__centring *centring);

/* The status of what was asked of the new system, in the terms of `system`: if a callback of the
 * new one is to blame, the failure behind it, with its sentence set again. A coordinate beyond its
 * chart's half turn is DVI_STEP_TOO_LARGE. */
dvi_status dvi__charted_explain(const dvi__charted *charted, dvi_status status);

/* From stored velocities or momenta [nv] at the centre to the chart's [nx], and back. */
void dvi__charted_enter(const dvi__charted *charted, const double *stored, double *local);
void dvi__charted_store(const dvi__charted *charted, const double *local, double *stored);

/* Move a state where the charts are centred to the end of the last path from there, xi and p in the
 * charts, all with carries: the momentum by what the path adds to the angular momentum in space
 * where there is one, else as the chart's. */
void dvi__charted_arrive(const dvi__charted *charted, const dvi__phase *local,
                         const dvi__phase *state);

/* The point q [nq] of xi, and the stored velocity v [nv] of the rate [nx]; either may be NULL. */
void dvi__charted_point(const dvi__charted *charted, const double *xi, const double *rate,
                        double *q, double *v);

/* xi [nx] of a point q [nq]. */
void dvi__charted_inverse(const dvi__charted *charted, const double *q, double *xi);

/* DVI_STEP_TOO_LARGE if a coordinate of xi is beyond its chart. */
dvi_status dvi__charted_check(const dvi__charted *charted, const double *xi);

#endif
