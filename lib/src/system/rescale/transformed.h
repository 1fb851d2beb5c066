/* The time-transformed system of dvi/transform.h. Its general Lagrangian is
 *
 *     Lg(q,w) = g(q) [ L(q, w/g(q)) + E0 ],        dt/dtau = g(q)
 *
 * A transformed system belongs to one integrator, whose start chooses E0. It has work memory, so it
 * is not shared. */
#ifndef DVI_SYSTEM_RESCALE_TRANSFORMED_H
#define DVI_SYSTEM_RESCALE_TRANSFORMED_H
#include "system/rescale/monitor.h"

typedef struct dvi__transformed dvi__transformed;

/* Create the transformed system of an autonomous `system`, which must outlive it. Counters count
 * the points at which `system` itself is evaluated. They must outlive the transformed system, and
 * be those of every evaluator of it. */
dvi_status dvi__transformed_create(const dvi_system *system, const dvi_monitor *monitor,
                                   dvi_counters *counters, dvi__transformed **transformed);
void dvi__transformed_destroy(dvi__transformed **transformed);

/* Return the new system. Its general Lagrangian calls this file (system/term/term.c). */
const dvi_system *dvi__transformed_system(const dvi__transformed *transformed);

/* Return the transformed system behind a system, or NULL if there is none. */
dvi__transformed *dvi__transformed_of(const dvi_system *system);

/* Return the monitor, which is valid until room is made for larger batches. */
dvi__monitor *dvi__transformed_monitor(const dvi__transformed *transformed);

/* Return the masses [n] of L = v.Mv/2 - V with a constant mass without coupling, and NULL for all
 * other systems. */
const double *dvi__transformed_masses(const dvi__transformed *transformed);

/* Compute what Lg and its derivatives are made of then, at `count` places: g and V - E0 [count],
 * g_q and V_q [n*count]. */
typedef struct dvi__rescaled {
  double *g, *g_q, *V, *V_q;
} dvi__rescaled;

dvi_status dvi__transformed_evaluate(dvi__transformed *transformed, int count, const double *t,
                                     const double *q, const dvi__rescaled *at);

/* Return the system that was transformed. */
const dvi_system *dvi__transformed_base(const dvi__transformed *transformed);

/* Compute what Lg's Hessian at one place is made of, but for g_qq: g, v.L_vv v, g_q [n], d [n] and
 * L_vv v [n] (transformed.c), and the Hessians of L in the order of their patterns. The arrays are
 * valid until another evaluation. */
typedef struct dvi__curvature {
  double g, vMv;
  const double *g_q, *d, *Mv, *L_qq, *L_qv, *L_vv;
} dvi__curvature;

dvi_status dvi__transformed_curvature(dvi__transformed *transformed, double t, const double *q,
                                      const double *w, dvi__curvature *at);

/* Set E0, which is NaN before. */
void dvi__transformed_set_energy(dvi__transformed *transformed, double energy);

#endif
