/* The time-transformed system of dvi/transform.h: its general Lagrangian
 *
 *     Lg(q,w) = g(q) [ L(q, w/g(q)) + E0 ],        dt/dtau = g(q)
 *
 * belongs to one integrator, whose start chooses E0, and has work memory, so it is not shared. */
#ifndef DVI_SYSTEM_TRANSFORMED_H
#define DVI_SYSTEM_TRANSFORMED_H
#include "system/rescale/monitor.h"

typedef struct dvi__transformed dvi__transformed;

/* `system` must be autonomous, and outlive it. Counters, which must outlive it, count the points at
 * which `system` itself is evaluated; they must be those of every evaluator of the transformed
 * system. */
dvi_status dvi__transformed_create(const dvi_system *system, const dvi_monitor *monitor,
                                   dvi_counters *counters, dvi__transformed **transformed);
void dvi__transformed_destroy(dvi__transformed **transformed);

/* The new system: a general Lagrangian that leads here (system/term/term.c). */
const dvi_system *dvi__transformed_system(const dvi__transformed *transformed);

/* What stands behind a system; NULL: it is not such a new one. */
dvi__transformed *dvi__transformed_of(const dvi_system *system);

/* Valid until room is made for larger batches. */
dvi__monitor *dvi__transformed_monitor(const dvi__transformed *transformed);

/* E0; NaN until it is set. */
void dvi__transformed_set_energy(dvi__transformed *transformed, double energy);

#endif
