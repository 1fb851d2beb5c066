/* Newton's method with line search from the guess, and the checks of the path that it finds. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "boundary/path_struct.h"

/* Largest gradient of a stationary path, relative to the largest momentum. */
static const double stationary_below = 1e-9;

/* From this residual Newton's method converges, unless the Hessian is singular. */
static const double nearly_stationary = 1e-8;

/* A gradient up to this size, with the path held in place, may vanish after a shift in time. A
 * residual up to this size may vanish on a neighbouring path. */
static const double nearly_in_time = 1e-4;

/* Directions that move the guess alike, up to these parts, count as one. On a circle rotation moves
 * a path as time does, but on a rough guess the two differ. If a path cannot be held in place along
 * both (equal), they are taken for one (alike). */
static const double equal = 1e-6, alike = 0.5;

static dvi_status not_found(dvi_path *path, dvi_status status, const dvi__solve_report *solved)
{
  static const char fixed[] = "a better guess, more steps or a longer span, or come by "
                              "continuation; conjugate ends may have no path";
  const char *const advice[] = {
      [DVI_ENDS_FIXED] = fixed,
      [DVI_ENDS_MIXED] = "a better guess, more steps, other ends, or come by continuation",
      [DVI_ENDS_INITIAL] = "a guess from steps with dvi_run, or a shorter span",
      [DVI_ENDS_PERIODIC] = "a better guess, more steps, another period, or come by continuation",
  };
  if (status < 0) return status;
  if (status != DVI_NOT_CONVERGED)
    return dvi__fail_in(status, "no stationary path was found; the path is unchanged");
  if (solved->residual < nearly_stationary)
    return dvi__fail(DVI_SINGULAR,
                     "Newton's method came to a residual of %.1e but does not settle: the path is "
                     "not isolated, one of many with "
                     "these ends; the path is unchanged; try another span, or declare the "
                     "symmetries that move it",
                     solved->residual);
  if (path->ends == DVI_ENDS_PERIODIC && solved->residual < nearly_in_time)
    return dvi__fail(status,
                     "Newton's method comes near a stationary path (residual %.1e) but does not "
                     "settle: no path has just this period, or "
                     "many have it, which %d steps tell apart by too little; the path is "
                     "unchanged; try more steps, then another period",
                     solved->residual, path->steps);
  return dvi__fail(status,
                   "no stationary path of %d steps over %g was found from this guess (%d "
                   "iterations, residual %.1e); the path "
                   "is unchanged; try %s",
                   path->steps, path->span, solved->iterations, solved->residual,
                   advice[path->ends]);
}

static dvi_status held_in_place(double gradient)
{
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the path that was found is stationary only while it is held in place (gradient "
                   "%.1e of the momenta): no "
                   "path of this period is near the guess, or the steps are too long; the path is "
                   "unchanged; try another period or "
                   "guess, a free period, or more steps",
                   gradient);
}

/* Measure the gradient relative to the momenta, and the action. For a path at rest the gradient is
 * relative to a momentum that would cross the path's own size. */
static dvi_status measure_path(dvi_path *path, double size, dvi_path_report *report)
{
  const double *x = path->trial;
  report->span = dvi__path_span(path, x);
  if (!(report->span > 0))
    return dvi__fail(DVI_NOT_CONVERGED,
                     "the period shrank to %g; the path is unchanged; try a better guess",
                     report->span);
  DVI_TRY(dvi__path_gradient(path, x, path->trial_p, &report->gradient));
  double momentum = dvi__largest((size_t)(path->steps + 1) * (size_t)path->n, path->trial_p);
  momentum = fmax(momentum, dvi__largest((size_t)path->n, path->kinetic) * size / report->span *
                                stationary_below);
  if (momentum > 0) report->gradient /= momentum;
  if (!(report->gradient <= stationary_below)) return held_in_place(report->gradient);
  return dvi__path_action(path, x, &report->action, &report->energy);
}

/* Check that symmetries explain all zero eigenvalues. Otherwise the path is one of many, or
 * roundoff chose it. One zero may belong to a free span, which the energy fixes. */
static dvi_status check_isolated(const dvi_path *path, const dvi_path_report *report)
{
  if (report->zero <= report->symmetries + path->free_span) return DVI_OK;
  return dvi__fail(DVI_SINGULAR,
                   "along %ld direction%s, of which %d are symmetries, the action does not change "
                   "to second order (below %.0e): "
                   "%s; the path is unchanged; try another span",
                   report->zero, report->zero == 1 ? "" : "s", report->symmetries,
                   report->zero_below,
                   path->ends != DVI_ENDS_PERIODIC
                       ? "its ends are conjugate, so that there are many such paths or none"
                       : "it is not isolated");
}

/* Find out whether Newton's method failed because the Hessian is singular. The Hessian is tested at
 * the last iterate, if that is nearly stationary, and at the guess. Otherwise the status stays. */
static dvi_status check_singular(dvi_path *path, dvi_status status, const dvi__solve_report *solved)
{
  dvi_path_report found = {.symmetries = path->in_use};
  const int tells = dvi__first_not_finite((size_t)path->unknowns, path->trial) < 0 &&
                    solved->residual < nearly_stationary;
  for (int at_guess = !tells; at_guess < 2 && status == DVI_NOT_CONVERGED; at_guess++) {
    if (at_guess) memcpy(path->trial, path->x, (size_t)path->unknowns * sizeof(double));
    if (dvi__path_index(path, &found) == DVI_OK && check_isolated(path, &found) == DVI_SINGULAR)
      status = DVI_SINGULAR;
  }
  return status;
}

static void accept_path(dvi_path *path)
{
  const size_t n = (size_t)path->n;
  double *x = path->x, *p = path->p;
  path->x = path->trial;
  path->trial = x;
  path->p = path->trial_p;
  path->trial_p = p;
  for (int k = 0; k <= path->steps; k++)
    memcpy(path->q + (size_t)k * n, dvi__path_at(path, path->x, k), n * sizeof(double));
  path->solved = 1;
}

/* Solve once more with the path released in time. Steps that are too long give the discrete motion
 * slightly preferred times, and Newton's method moves the path to one of them. */
static dvi_status settle_in_time(dvi_path *path, double size, dvi_path_report *report)
{
  dvi__solve_report solved;
  const double gradient = report->gradient;
  if (!dvi__path_release_time(path)) return DVI_NOT_CONVERGED;
  const dvi_status status = dvi__solve(path->solver, DVI__KINSOL, size, 0, 0, path->trial, &solved);
  if (status > 0) return held_in_place(gradient);
  if (status < 0) return not_found(path, status, &solved);
  report->iterations += solved.iterations;
  return measure_path(path, size, report);
}

/* Solve from the guess, held in place along directions that are independent to this part. */
static dvi_status solve_from_guess(dvi_path *path, double least_own_part, dvi_path_report *report)
{
  dvi__solve_report solved;
  memcpy(path->trial, path->x, (size_t)path->unknowns * sizeof(double));
  DVI_TRY(dvi__path_scale(path, path->trial));
  DVI_TRY(dvi__path_fix_gauge(path, path->trial, least_own_part));
  const double size = dvi__largest((size_t)path->core, path->trial);
  const dvi_status status = dvi__solve(path->solver, DVI__KINSOL, size, 0, 0, path->trial, &solved);
  if (status != DVI_OK && check_singular(path, status, &solved) == DVI_SINGULAR)
    return DVI_SINGULAR;
  if (status != DVI_OK) return not_found(path, status, &solved);
  report->iterations = solved.iterations;
  report->symmetries = path->in_use;
  const dvi_status measured = measure_path(path, size, report);
  return measured == DVI_NOT_CONVERGED && report->gradient < nearly_in_time
             ? settle_in_time(path, size, report)
             : measured;
}

static dvi_status solve_path(dvi_path *path, dvi_path_report *report)
{
  DVI_TRY(dvi__path_check_symmetry(path, path->x, 1));
  dvi_status status = solve_from_guess(path, equal, report);
  if (status == DVI_NOT_CONVERGED && path->in_use > 1)
    status = solve_from_guess(path, alike, report);
  if (status != DVI_OK) return status;
  DVI_TRY(dvi__path_check_symmetry(path, path->trial, path->steps));
  DVI_TRY(dvi__path_index(path, report));
  DVI_TRY(check_isolated(path, report));
  return dvi__path_energies(path, report);
}

dvi_status dvi_path_solve(dvi_path *path, dvi_path_report *report)
{
  if (path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "path: no path to solve");
  dvi_path_report found = {0};
  const dvi_status status = solve_path(path, &found);
  if (status != DVI_OK) return dvi__fail_in(status, "path");
  accept_path(path);
  if (report != NULL) *report = found;
  return dvi__path_check_resolved(path, &found);
}
