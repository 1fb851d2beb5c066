/* Subjects of studies that are no motions: rules of quadrature, and a boundary value problem. */
#ifndef TESTS_APPS_STUDY_SUBJECTS_H
#define TESTS_APPS_STUDY_SUBJECTS_H
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "study/subject.h"

/* --- Rules on the unit interval, refined by their panels. --- */

typedef struct rule {
  double (*integrand)(double x);
  double exact;
  int order;     /* 2 for trapezoids, 4 for Simpson's rule */
  double offset; /* a mistake that no refinement mends */
  int odd_fails; /* levels of an odd number of panels have no result */
  long evaluations;
} rule;

static inline double smooth(double x)
{
  return exp(x);
}

/* Its integral has no more than the order 3/2. */
static inline double with_root(double x)
{
  return sqrt(x);
}

static inline double value(rule *r, double x)
{
  r->evaluations++;
  return r->integrand(x);
}

static inline double integral(rule *r, double panels)
{
  const double h = 1.0 / panels;
  double sum = 0.0;
  r->evaluations = 0;
  for (long i = 0; i < lround(panels); i++) {
    const double left = value(r, (double)i * h), right = value(r, (double)(i + 1) * h);
    const double middle = r->order == 4 ? value(r, ((double)i + 0.5) * h) : 0.0;
    sum += r->order == 4 ? h * (left + 4.0 * middle + right) / 6.0 : h * (left + right) / 2.0;
  }
  return sum + r->offset;
}

static inline dvi_status rule_run(void *user, double panels, study_level *level)
{
  rule *r = user;
  if (r->odd_fails && lround(panels) % 2 == 1) return DVI_NOT_CONVERGED;
  const double found = integral(r, panels);
  level->parts = panels;
  level->length = 1.0 / panels;
  level->error = fabs(found - r->exact);
  level->counted[0] = (double)r->evaluations;
  if (level->number != NULL) level->number[0] = found;
  return DVI_OK;
}

static inline dvi_status rule_repeat(void *user, double panels, double *preparation)
{
  (void)preparation;
  return integral(user, panels) > 0.0 ? DVI_OK : DVI_NOT_FINITE;
}

static inline const char *rule_reason(void *user)
{
  (void)user;
  return "the number of panels is odd";
}

static inline const char *rule_say(study_phrase phrase, double extent, char *text, size_t size)
{
  if (phrase == STUDY_REACH) {
    (void)snprintf(text, size, "on (0, %g)", extent);
    return text;
  }
  return phrase == STUDY_FINER ? "take more" : NULL;
}

static const table_column evaluations[] = {{"evaluations", "%.0f"}, {NULL, NULL}};
static const study_words rule_words = {"rule",          "integrand", "width",     "panels",
                                       "setup_seconds", NULL,        evaluations, rule_say};

static inline study_subject subject_of(rule *r, const char *name, int claimed)
{
  return (study_subject){.name = name,
                         .problem = "exp",
                         .words = &rule_words,
                         .extent = 1.0,
                         .order = claimed,
                         .span = 1.0,
                         .first_parts = 2.0,
                         .size = r->exact,
                         .judge = "the antiderivative",
                         .judge_error = DBL_EPSILON,
                         .run = rule_run,
                         .repeat = rule_repeat,
                         .reason = rule_reason,
                         .user = r};
}

static inline rule simpson(void)
{
  return (rule){.integrand = smooth, .exact = exp(1.0) - 1.0, .order = 4};
}

static inline rule trapezoids(void)
{
  return (rule){.integrand = smooth, .exact = exp(1.0) - 1.0, .order = 2};
}

/* --- A boundary value problem: -u'' = f, refined by its cells, with two errors. --- */

static inline dvi_status poisson_run(void *user, double cells, study_level *level)
{
  const int n = (int)lround(cells) - 1;
  const double h = 1.0 / cells, pi = acos(-1.0);
  double *c = calloc(2 * (size_t)n + 1, sizeof *c), *u = c + n;
  if (c == NULL) return DVI_NO_MEMORY;
  for (int i = 0; i < n; i++) { /* Thomas's algorithm for (-1, 2, -1) */
    const double below = i > 0 ? c[i - 1] : 0.0, before = i > 0 ? u[i - 1] : 0.0;
    c[i] = 1.0 / (2.0 - below);
    u[i] = (h * h * pi * pi * sin(pi * (i + 1) * h) + before) * c[i];
  }
  for (int i = n - 2; i >= 0; i--) u[i] += c[i] * u[i + 1];
  level->error = 0.0;
  for (int i = 0; i < n; i++) level->error = fmax(level->error, fabs(u[i] - sin(pi * (i + 1) * h)));
  level->further[0] = fabs(u[0] / h -
                           pi); /* the slope at the end, of first order because sin'' = 0 */
  level->parts = cells;
  level->length = h;
  level->counted[0] = n;
  if (level->number != NULL) {
    level->number[0] = u[n / 2];
    level->number[1] = u[n / 4];
    level->number[2] = u[0] / h;
  }
  (void)user;
  free(c);
  return DVI_OK;
}

static inline dvi_status poisson_watch(void *user, double cells, study_level *level)
{
  study_level again = {.number = NULL};
  const dvi_status status = poisson_run(user, cells, &again);
  level->further[0] = again.further[0];
  return status;
}

static inline dvi_status poisson_repeat(void *user, double cells, double *preparation)
{
  study_level level = {.number = NULL};
  (void)preparation;
  return poisson_run(user, cells, &level);
}

static inline dvi_status poisson_roundoff(void *user, double cells, double *moved)
{
  (void)user;
  *moved = DBL_EPSILON * cells; /* of the differences that the scheme takes */
  return DVI_OK;
}

static inline study_subject poisson(void)
{
  static const table_column slopes[] = {{"slope_error", "%.1e"}, {NULL, NULL}},
                            unknowns[] = {{"unknowns", "%.0f"}, {NULL, NULL}};
  static const study_words in_words = {"scheme", "equation", "h",      "cells",
                                       "",       slopes,     unknowns, NULL};
  return (study_subject){.name = "differences",
                         .problem = "poisson",
                         .words = &in_words,
                         .order = 2,
                         .span = 1.0,
                         .first_parts = 8.0,
                         .size = 1.0,
                         .judge_error = DBL_EPSILON,
                         .run = poisson_run,
                         .watch = poisson_watch,
                         .repeat = poisson_repeat,
                         .roundoff = poisson_roundoff};
}

#endif
