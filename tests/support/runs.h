/* Making problems and integrators that must be made, taking steps that must succeed, and measuring orders. */
#ifndef SUPPORT_RUNS_H
#define SUPPORT_RUNS_H
#include "problem.h"

enum { COORDINATES_MOST = 64 };

/* A method's specification by printf's rules; valid until the eighth next call. */
const char *spec(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A problem of the catalogue with at most one setting "name=value" (NULL: none). Fails the test if there is none. */
problem *made_problem(const char *name, const char *setting);

/* An integrator; started() puts it at the problem's start. */
dvi_integrator *made_integrator(const dvi_system *system, const char *method);
dvi_integrator *started(const problem *of, const char *method);

/* Take steps; the test fails if one of them does. */
void advance(dvi_integrator *integrator, double h, long steps);

/* Largest |a_i - b_i|, and largest |a_i|. */
double distance(int n, const double *a, const double *b);
double magnitude(int n, const double *a);

enum { QUARTERS = 4 };

/* What is known of the solution at the quarters of a span. */
typedef struct judged {
  const problem *of;
  double quarter; /* length of one */
  double q[QUARTERS][COORDINATES_MOST], p[QUARTERS][COORDINATES_MOST];
  double error;   /* of this knowledge, relative to the largest coordinate or momentum */
} judged;

/* The quadruple-precision judge on a problem made with this setting. */
void judge_by_quad(const problem *of, const char *setting, double t_end, judged *solution);

/* A study of an order: the largest error at the four quarters (one time alone might lie where errors change sign), in `levels` numbers of
 * steps, from `first` a quarter on, each `ratio` times the one before. */
typedef struct order_study {
  const char *method;
  int first, levels; /* levels at most 16 */
  double ratio;
  double floor;      /* errors up to this, relative, are roundoff's or the judge's */
} order_study;

/* The slope of the error over the finest four to five step sizes above the floor must be within 0.2 of `order`. */
void check_order(const judged *solution, const order_study *study, double order);

#endif
