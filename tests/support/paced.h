/* Integrators whose steps follow a monitor, and that must be made. */
#ifndef SUPPORT_PACED_H
#define SUPPORT_PACED_H
#include "problem.h"

/* An integrator of a transformed time, or of controlled steps. */
dvi_status create_transformed(const dvi_system *system, const dvi_monitor *monitor,
                              const char *method, dvi_integrator **integrator);
dvi_status create_controlled(const dvi_system *system, const dvi_monitor *monitor,
                             const char *method, dvi_integrator **integrator);

/* One of these. */
typedef dvi_status (*paced_create)(const dvi_system *system, const dvi_monitor *monitor,
                                   const char *method, dvi_integrator **integrator);

/* A monitor by its specification. */
dvi_monitor monitor_of(const char *specification);

/* An integrator at the problem's start. */
dvi_integrator *paced(const problem *of, paced_create create, const char *monitor,
                      const char *method);

/* Run to a time; the test fails if that does. */
void run_to(dvi_integrator *integrator, double h, double t_end);

#endif
