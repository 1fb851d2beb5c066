/* Integrators whose steps follow a monitor. The test fails if one cannot be created. */
#ifndef SUPPORT_PACED_H
#define SUPPORT_PACED_H
#include "problem.h"

/* Create an integrator with transformed time, or with controlled steps. */
dvi_status create_transformed(const dvi_system *system, const dvi_monitor *monitor,
                              const char *method, dvi_integrator **integrator);
dvi_status create_controlled(const dvi_system *system, const dvi_monitor *monitor,
                             const char *method, dvi_integrator **integrator);

/* Points to one of these functions. */
typedef dvi_status (*paced_create)(const dvi_system *system, const dvi_monitor *monitor,
                                   const char *method, dvi_integrator **integrator);

/* Reads a monitor from its specification. */
dvi_monitor read_monitor(const char *specification);

/* Creates an integrator, and starts it at the problem's start. */
dvi_integrator *start_paced_integrator(const problem *model, paced_create create,
                                       const char *monitor, const char *method);

/* Runs to a time, which must succeed. */
void run_to(dvi_integrator *integrator, double h, double t_end);

#endif
