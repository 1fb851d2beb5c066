/* A monitor g(q) > 0, evaluated as the potential of a system of its own. So batches, differences
 * and checks of callbacks are shared. */
#ifndef DVI_SYSTEM_RESCALE_MONITOR_H
#define DVI_SYSTEM_RESCALE_MONITOR_H
#include <dvi/transform.h>

#include "system/evaluate/evaluator.h"

typedef struct dvi__monitor dvi__monitor;

enum { DVI__MONITOR_NAME = 96 }; /* a longer name is cut */

/* Create a monitor for batches of up to `capacity` points of the system. counters counts
 * evaluations of the system, and must outlive the monitor. */
dvi_status dvi__monitor_create(const dvi_system *system, const dvi_monitor *given, int capacity,
                               dvi__derivatives most, dvi_counters *counters,
                               dvi__monitor **monitor);
void dvi__monitor_destroy(dvi__monitor **monitor);

const char *dvi__monitor_name(const dvi__monitor *monitor);

/* Return dvi__hessian_noise of g. */
double dvi__monitor_noise(const dvi__monitor *monitor);

/* Set E0 for the monitor of arc lengths. */
void dvi__monitor_set_energy(dvi__monitor *monitor, double energy);

/* Compute g [count], g_q [n*count], and g_qq [n*n*count], full, entry-major, which needs
 * DVI__HESSIANS. Return DVI_NOT_FINITE unless g is positive and finite. dvi__monitor_rates computes
 * both g and g_q. */
dvi_status dvi__monitor_value(dvi__monitor *monitor, int count, const double *q, double *g);
dvi_status dvi__monitor_gradient(dvi__monitor *monitor, int count, const double *q, double *g_q);
dvi_status dvi__monitor_rates(dvi__monitor *monitor, int count, const double *q, double *g,
                              double *g_q);
dvi_status dvi__monitor_hessian(dvi__monitor *monitor, int count, const double *q, double *g_qq);

/* ---- built-in monitors, for monitor.c ---- */

/* The data that a built-in monitor's callbacks receive as `user`. */
typedef struct dvi__built_in {
  const dvi_system *system;
  double power, energy; /* exponent p, and E0 */
  int n, bodies, dimension;
  dvi__evaluator *evaluator; /* evaluator of the system, NULL if only distances are needed */
  /* g, left there by every gradient, and r^2 and r^-power of a pair, or V_q.a, [capacity] */
  double *g, *square, *rate;
  /* zero velocity, V_q, and M^-1 V_q or the differences of a pair, [n*capacity] */
  double *zero, *V_q, *a;
  double *V_qq; /* Hessian [entries*capacity] */
} dvi__built_in;

/* Fill in the callbacks (distance.c, motion.c). */
void dvi__distance_callbacks(dvi_potential *function);
void dvi__arclength_callbacks(dvi_potential *function);
void dvi__acceleration_callbacks(dvi_potential *function);

#endif
