/* Create problems and integrators, and take steps. The test fails if one of these calls fails. */
#ifndef SUPPORT_RUNS_H
#define SUPPORT_RUNS_H
#include "problem.h"

/* Writes a method's specification by printf's rules. It is valid until the eighth next call. */
const char *method_spec(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Creates a problem of the catalogue with at most one setting "name=value" (default NULL, none). */
problem *create_problem(const char *name, const char *setting);

/* Creates one whose quadratic potentials are not declared so. No iteration takes them implicitly,
 * and stiff steps need Newton's methods. */
problem *create_undeclared_problem(const char *name, const char *setting);

/* Create an integrator or an ensemble. start_integrator() also starts it at the problem's start. */
dvi_integrator *create_integrator(const dvi_system *system, const char *method);
dvi_integrator *start_integrator(const problem *model, const char *method);

dvi_ensemble *create_ensemble(const dvi_system *system, const char *method,
                              dvi_ensemble_options options);

/* Takes steps. */
void advance(dvi_integrator *integrator, double h, long steps);

/* Give the largest |a_i - b_i|, and the largest |a_i|. */
double distance(int n, const double *a, const double *b);
double magnitude(int n, const double *a);

#endif
