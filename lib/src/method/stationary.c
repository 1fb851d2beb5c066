#include "method/stationary.h"

#include <string.h>

#include "core/status.h"

static dvi_status no_chord(void *of, const double *x)
{
  (void)of, (void)x;
  return DVI_OK;
}

dvi_status dvi__stationary_create(dvi__equations *equations, dvi_counters *counters, dvi__solver **solver)
{
  equations->linear = dvi__linear_for_exchanges(equations->pattern);
  equations->prepare_chord = no_chord; /* KINSOL's rung asks for it; the chord itself belongs to fixed point iteration */
  return dvi__solver_create(equations, counters, solver);
}

dvi_status dvi__stationary_solve(dvi__solver *solver, dvi_counters *counters, double size, int unknowns, const double *guess,
                                 double *x)
{
  dvi__solve_report report;
  memcpy(x, guess, (size_t)unknowns * sizeof *x);
  const dvi_status found = dvi__solve(solver, DVI__NEWTON, size, 1, 0, x, &report);
  if (found == DVI_OK) counters->newtons++;
  if (found <= 0) return found;
  memcpy(x, guess, (size_t)unknowns * sizeof *x);
  const dvi_status status = dvi__solve(solver, DVI__KINSOL, size, 0, 0, x, &report);
  if (status <= 0) return status;
  if (status != DVI_NOT_CONVERGED) return dvi__fail_in(status, "not solved, even by KINSOL with line search");
  return dvi__fail_in(status,
                      "not solved, neither by Newton's method nor by KINSOL with line search (%d iterations, residual %.1e)",
                      report.iterations, report.residual);
}
