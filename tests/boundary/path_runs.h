/* Paths that must be solved, and the runs of integrators beside them. */
#ifndef TESTS_BOUNDARY_PATH_RUNS_H
#define TESTS_BOUNDARY_PATH_RUNS_H
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { NODES_MOST = 401, ROOM = NODES_MOST * 8 };

static const double pi = 3.14159265358979324;

/* The nodes of a run, point after point. */
typedef struct run {
  int n, steps;
  double span, t[NODES_MOST], q[ROOM], p[ROOM];
} run;

static inline void keep(run *r, int k, const dvi_integrator *integrator)
{
  r->t[k] = k * (r->span / r->steps);
  memcpy(r->q + (size_t)k * (size_t)r->n, dvi_integrator_q(integrator),
         (size_t)r->n * sizeof(double));
  memcpy(r->p + (size_t)k * (size_t)r->n, dvi_integrator_p(integrator),
         (size_t)r->n * sizeof(double));
}

static inline void record_run(const dvi_system *system, const double *q, const double *p,
                              const char *method, double span, int steps, run *r)
{
  *r = (run){.n = dvi_system_nq(system), .steps = steps, .span = span};
  ck_assert((steps + 1) * r->n <= ROOM);
  dvi_integrator *stepped = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(stepped, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  keep(r, 0, stepped);
  for (int k = 1; k <= steps; k++) {
    advance(stepped, span / steps, 1);
    keep(r, k, stepped);
  }
  dvi_integrator_destroy(&stepped);
}

static inline dvi_path *create_path(const dvi_system *system, const char *method,
                                    const dvi_path_options *options)
{
  dvi_path *path = NULL;
  ck_assert_msg(dvi_path_create(system, method, options, &path) == DVI_OK, "%s", dvi_last_error());
  return path;
}

static inline dvi_path_report solve_path(dvi_path *path)
{
  dvi_path_report report;
  ck_assert_msg(dvi_path_solve(path, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(report.gradient < 1e-12, "gradient %g", report.gradient);
  return report;
}

#endif
