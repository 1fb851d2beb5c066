/* Integrators whose steps are steps in a fictitious time (dvi/transform.h): what they have beside the others. */
#ifndef DVI_METHOD_PACE_H
#define DVI_METHOD_PACE_H
#include <dvi/transform.h>

#include "method/method.h"
#include "system/rescale/transformed.h"

enum { DVI__PACE_POINTS = 16 };

typedef struct dvi__pace {
  dvi_pacing pacing;
  dvi_monitor given;             /* to make another one alike */
  char name[DVI__MONITOR_NAME];  /* the monitor's */
  dvi__transformed *transformed; /* the new system, of a transform */
  dvi__monitor *monitor;         /* of control */
  double energy;                 /* E0 */
  int holds;                     /* E0 is given: starts do not choose it */
  double *q, *v, *g_q;           /* [n] work */
  /* Time inside the last step (physical_time.c): a quadrature, and g on the path by Legendre polynomials, if it is expanded. */
  double node[DVI__PACE_POINTS], weight[DVI__PACE_POINTS], series[DVI__PACE_POINTS];
  int expanded;
} dvi__pace;

dvi_status dvi__pace_create(const dvi_system *system, const dvi_monitor *monitor, dvi_pacing pacing, dvi_counters *counters,
                            dvi__pace **pace);
void dvi__pace_destroy(dvi__pace **pace);

/* The system that the steps are taken of. */
const dvi_system *dvi__pace_system(const dvi__pace *pace, const dvi_system *system);

/* The monitor at one point, and its gradient [n]. */
dvi_status dvi__pace_monitor(dvi__pace *pace, const double *q, double *g);
dvi_status dvi__pace_slope(dvi__pace *pace, const double *q, double *g_q);

void dvi__pace_set_energy(dvi__pace *pace, double energy);

/* E0 for a start at q, v and p, the velocity w = dq/dtau of the steps that follow (v itself under control), and z = 1/g. On failure E0 is as before. */
dvi_status dvi__pace_start(dvi_integrator *integrator, double t, const double *q, const double *v, const double *p, double *w,
                           double *density);

/* Control: half of z's step h from `now` into `next`, and the length of time that follows; and the other half, from the end of the step. */
dvi_status dvi__control_begin(dvi_integrator *integrator, double h, double *length);
dvi_status dvi__control_end(dvi_integrator *integrator, double h);

/* Dense output of a transformed step: q and v where this fraction of its physical time has passed. */
dvi_status dvi__pace_path(dvi_integrator *integrator, double fraction, double *q, double *v);

/* Say in words how time passes. */
void dvi__pace_explain(const dvi__pace *pace, dvi__text *text);

/* One step h; if it passes t_end, or fails where that is near, the shorter one that ends there. What is within `tolerance` of t_end is at t_end. */
dvi_status dvi__pace_step(dvi_integrator *integrator, double h, double t_end, double tolerance);

#endif
