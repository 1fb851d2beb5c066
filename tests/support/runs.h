/* Making problems and integrators that must be made, and taking steps that must succeed. */
#ifndef SUPPORT_RUNS_H
#define SUPPORT_RUNS_H
#include "problem.h"

/* A method's specification by printf's rules; valid until the eighth next call. */
const char *spec(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A problem of the catalogue with at most one setting "name=value" (NULL: none). Fails the test if
 * there is none. */
problem *made_problem(const char *name, const char *setting);

/* An integrator; started() puts it at the problem's start. */
dvi_integrator *made_integrator(const dvi_system *system, const char *method);
dvi_integrator *started(const problem *of, const char *method);

/* Take steps; the test fails if one of them does. */
void advance(dvi_integrator *integrator, double h, long steps);

/* Largest |a_i - b_i|, and largest |a_i|. */
double distance(int n, const double *a, const double *b);
double magnitude(int n, const double *a);

#endif
