/* Steps in a fictitious time by a monitor (dvi/transform.h): additional data and functions of such
 * integrators. */
#ifndef DVI_INTEGRATOR_MONITORED_TIME_H
#define DVI_INTEGRATOR_MONITORED_TIME_H
#include <dvi/transform.h>

#include "method/method.h"
#include "system/rescale/transformed.h"

enum { DVI__MONITORED_POINTS = 16 };

typedef struct dvi__monitored_time {
  dvi_pacing pacing;
  dvi_monitor given;             /* the caller's monitor, for dvi_integrator_create_like */
  char name[DVI__MONITOR_NAME];  /* the monitor's name */
  dvi__transformed *transformed; /* the new system of a time transform, else NULL */
  dvi__monitor *monitor;         /* the monitor of step control, else NULL */
  double energy;                 /* E0 */
  int holds;                     /* E0 is given, and starts do not change it */
  double *q, *v, *g_q;           /* [n] work */
  /* quadrature of the physical time inside the last step (physical_time.c) */
  double node[DVI__MONITORED_POINTS], weight[DVI__MONITORED_POINTS];
  double series[DVI__MONITORED_POINTS]; /* Legendre coefficients of g on the last step's path */
  int expanded;                         /* series holds the last step's coefficients */
} dvi__monitored_time;

dvi_status dvi__monitored_time_create(const dvi_system *system, const dvi_monitor *monitor,
                                      dvi_pacing pacing, dvi_counters *counters,
                                      dvi__monitored_time **monitored);
void dvi__monitored_time_destroy(dvi__monitored_time **monitored);

/* Return the system whose steps are taken: the transformed one, or `system` itself. */
const dvi_system *dvi__monitored_time_system(const dvi__monitored_time *monitored,
                                             const dvi_system *system);

/* Evaluate the monitor g at one point, or its gradient [n]. */
dvi_status dvi__monitored_time_value(dvi__monitored_time *monitored, const double *q, double *g);
dvi_status dvi__monitored_time_gradient(dvi__monitored_time *monitored, const double *q,
                                        double *g_q);

void dvi__monitored_time_set_energy(dvi__monitored_time *monitored, double energy);

/* Set E0 for a start at q, v and p. Return the velocity w = dq/dtau of the following steps (v
 * itself under step control), and the density z = 1/g. On failure E0 is unchanged. */
dvi_status dvi__monitored_time_start(dvi_integrator *integrator, double t, const double *q,
                                     const double *v, const double *p, double *w, double *density);

/* Advance z by half a step h from `now` into `next`, and return the step's length in time. The
 * second function advances z by the other half, at the end of the step. */
dvi_status dvi__control_begin(dvi_integrator *integrator, double h, double *length);
dvi_status dvi__control_end(dvi_integrator *integrator, double h);

/* Evaluate q and v inside a transformed step, at this fraction of its physical time. */
dvi_status dvi__monitored_time_path(dvi_integrator *integrator, double fraction, double *q,
                                    double *v);

/* Describe the fictitious time in words. */
void dvi__monitored_time_explain(const dvi__monitored_time *monitored, dvi__text *text);

/* Take one step h. If the step passes t_end, or fails near t_end, take the shorter step that ends
 * at t_end instead. A time within `tolerance` of t_end becomes t_end. */
dvi_status dvi__monitored_time_step(dvi_integrator *integrator, double h, double t_end,
                                    double tolerance);

#endif
