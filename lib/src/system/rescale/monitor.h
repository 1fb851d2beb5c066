/* A monitor g(q) > 0, evaluated as the potential of a system of its own: with batches, differences
 * and checks of what callbacks return. */
#ifndef DVI_SYSTEM_MONITOR_H
#define DVI_SYSTEM_MONITOR_H
#include <dvi/transform.h>

#include "system/evaluate/evaluator.h"

typedef struct dvi__monitor dvi__monitor;

enum { DVI__MONITOR_NAME = 96 }; /* a longer name is cut */

/* For batches of up to `capacity` points of the system. Counts what it asks the system for;
 * counters must outlive it. */
dvi_status dvi__monitor_create(const dvi_system *system, const dvi_monitor *given, int capacity,
                               dvi__derivatives most, dvi_counters *counters,
                               dvi__monitor **monitor);
void dvi__monitor_destroy(dvi__monitor **monitor);

const char *dvi__monitor_name(const dvi__monitor *monitor);

/* dvi__hessian_noise of g. */
double dvi__monitor_noise(const dvi__monitor *monitor);

/* E0, for the monitor of arc lengths. */
void dvi__monitor_set_energy(dvi__monitor *monitor, double energy);

/* g [count]; g_q [n*count]; g_qq [n*n*count], full, entry-major, only with DVI__HESSIANS.
 * DVI_NOT_FINITE unless g is positive and finite. */
dvi_status dvi__monitor_value(dvi__monitor *monitor, int count, const double *q, double *g);
dvi_status dvi__monitor_gradient(dvi__monitor *monitor, int count, const double *q, double *g_q);
dvi_status dvi__monitor_hessian(dvi__monitor *monitor, int count, const double *q, double *g_qq);

/* ---- the built-in ones, for monitor.c ---- */

/* What a built-in monitor's callbacks get as `user`. */
typedef struct dvi__built_in {
  const dvi_system *system;
  double power, energy; /* E0 */
  int n, bodies, dimension;
  dvi__evaluator *evaluator; /* of the system; NULL: only distances are asked for */
  double *g, *square, *rate; /* [capacity] g; a pair's r^2 and r^-power */
  double *zero, *V_q, *a;    /* [n*capacity] no velocity, V_q, M^-1 V_q */
  double *V_qq;              /* [entries*capacity] */
} dvi__built_in;

/* Fill in the callbacks (distance.c, motion.c). */
void dvi__distance_callbacks(dvi_potential *function);
void dvi__arclength_callbacks(dvi_potential *function);
void dvi__acceleration_callbacks(dvi_potential *function);

#endif
