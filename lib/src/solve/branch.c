#include "solve/branch.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "solve/solver_struct.h"

/* The first part of the step, and the least part by which the branch goes on. */
static const double first_part = 1.0 / 16, least_part = 1.0 / DVI__BRANCH_PARTS;

/* A guess is in the domain of Newton's method if the second correction is this part of the first.
 * Elsewhere, and where the Jacobian is not exact, solutions have to be closer to their guesses. */
static const double contraction = 0.5, at_first = 0.4, closer = 0.1;

/* Rounding may be a large part of corrections below this size relative to the unknowns. */
static const double negligible = 1e-6;

/* The solutions found last, the latest first. */
typedef struct branch_history {
  int count, solved; /* number of points, and of those that were solved for */
  double part[DVI__BRANCH_POINTS];
  double *x[DVI__BRANCH_POINTS];
  double *first; /* start of the branch, or the first solution */
} branch_history;

static void add_to_history(branch_history *past, size_t unknowns, double part, const double *x)
{
  double *oldest = past->x[DVI__BRANCH_POINTS - 1];
  for (int k = DVI__BRANCH_POINTS - 1; k > 0; k--) {
    past->part[k] = past->part[k - 1];
    past->x[k] = past->x[k - 1];
  }
  past->part[0] = part;
  past->x[0] = oldest;
  memcpy(oldest, x, unknowns * sizeof *x);
  if (past->count < DVI__BRANCH_POINTS) past->count++;
}

/* Extrapolate the polynomial in the length of the step through the last solutions. */
static void extrapolate_branch(const branch_history *past, size_t unknowns, double part, double *x)
{
  memset(x, 0, unknowns * sizeof *x);
  for (int k = 0; k < past->count; k++) {
    double weight = 1;
    for (int l = 0; l < past->count; l++)
      if (l != k) weight *= (part - past->part[l]) / (past->part[k] - past->part[l]);
    for (size_t i = 0; i < unknowns; i++) x[i] += weight * past->x[k][i];
  }
}

/* Measure how far a solution is from its guess. Unknowns with other units, and of small parts of a
 * system, count as much as large ones. */
static double distance_of_guess(const dvi__branch *branch, const dvi__solver *solver,
                                const branch_history *past, double part, const double *guess,
                                const double *x)
{
  const size_t unknowns = (size_t)solver->equations.unknowns,
               group = (size_t)solver->equations.group;
  const double least = dvi__solver_least_part(solver) *
                       fmax(branch->size, dvi__largest(unknowns, x));
  double worst = 0;
  if (branch->distance != NULL) return branch->distance(branch->of, guess, x);
  for (size_t first = 0; first < unknowns; first += group) {
    double away = 0, come = DBL_MIN;
    for (size_t i = first; i < unknowns && i < first + group; i++) {
      away = fmax(away, fabs(x[i] - guess[i]));
      come = fmax(come, fmax(fabs(x[i] - past->first[i]), part * fabs(x[i])));
      for (int k = 0; k < past->count; k++) come = fmax(come, fabs(past->x[k][i] - past->first[i]));
    }
    worst = fmax(worst, away / fmax(come, least));
  }
  return worst;
}

/* Tell whether a solution is near its guess. The first guesses of a motion that begins at rest are
 * no measure. Short steps, whose equations are nearly linear, have no other solution near. */
static int is_near(const dvi__branch *branch, const dvi__solver *solver, const branch_history *past,
                   double part, const double *guess, const double *x,
                   const dvi__solve_report *report)
{
  const size_t unknowns = (size_t)solver->equations.unknowns;
  const int measurable = branch->distance != NULL || past->solved >= 2;
  if (branch->distance == NULL && past->count < DVI__BRANCH_POINTS &&
      dvi__branch_is_straight(report))
    return 1;
  const double away = measurable ? distance_of_guess(branch, solver, past, part, guess, x) : 0;
  const int contracts = report->contraction <= (measurable ? contraction : at_first) ||
                        report->largest_first <= negligible * dvi__largest(unknowns, x);
  const double near = contracts ? branch->near : closer * branch->near;
  return measurable ? away <= near : contracts;
}

/* Guess by the caller's function until there are two points. */
static dvi_status guess_at(const dvi__branch *branch, const branch_history *past, size_t unknowns,
                           double part, double *x)
{
  DVI_TRY(branch->place(branch->of, part));
  if (past->count < 2) return branch->guess(branch->of, part, x);
  extrapolate_branch(past, unknowns, part, x);
  return DVI_OK;
}

static dvi_status solve_branch_at(const dvi__branch *branch, dvi__solver *solver,
                                  const branch_history *past, double part, double *x, double *guess,
                                  dvi__solve_report *report)
{
  const size_t unknowns = (size_t)solver->equations.unknowns;
  DVI_TRY(guess_at(branch, past, unknowns, part, guess));
  memcpy(x, guess, unknowns * sizeof *x);
  return dvi__solve(solver, DVI__NEWTON, branch->size, 0, 0, x, report);
}

static void branch_begin(const dvi__branch *branch, size_t unknowns, branch_history *past)
{
  *past = (branch_history){0};
  past->first = branch->room + unknowns;
  for (size_t k = 0; k < DVI__BRANCH_POINTS; k++) past->x[k] = past->first + (k + 1) * unknowns;
  memset(past->first, 0, unknowns * sizeof(double));
  if (branch->from_zero) add_to_history(past, unknowns, 0, past->first);
}

/* Tell whether the last solution is beyond a fold. `sign` is that of the determinant before, if any
 * solutions were found. */
static int is_folded(const dvi__branch *branch, const dvi__solver *solver, int solved, int sign)
{
  if (branch->definite != 0 && !dvi__solver_is_definite(solver, branch->definite)) return 1;
  return branch->signs && solved > 0 && dvi__solver_sign(solver) != sign;
}

dvi_status dvi__branch_follow(const dvi__branch *branch, dvi__solver *solver, double *x,
                              dvi__branch_end *end)
{
  const size_t unknowns = (size_t)solver->equations.unknowns;
  const double most_part = 1.0 / branch->parts;
  double part = fmin(first_part, most_part), *guess = branch->room;
  branch_history past;
  int sign = 0;
  branch_begin(branch, unknowns, &past);
  *end = (dvi__branch_end){0};
  while (end->reached < 1 && part >= least_part) {
    const double next = fmin(1, end->reached + part);
    end->status = solve_branch_at(branch, solver, &past, next, x, guess, &end->report);
    if (end->status < 0) return end->status;
    const int solved = end->status == DVI_OK,
              folded = solved && is_folded(branch, solver, past.solved, sign);
    if (!solved || folded || !is_near(branch, solver, &past, next, guess, x, &end->report)) {
      end->ends = !solved || folded || end->report.contraction > contraction;
      if (solved) end->status = dvi__fail(DVI_NOT_CONVERGED, "the next solution is not near");
      part *= 0.5;
      continue;
    }
    if (past.solved > 0) part = fmin(2 * part, most_part); /* the first part is taken twice */
    sign = dvi__solver_sign(solver);
    if (past.count == 0) memcpy(past.first, x, unknowns * sizeof *x);
    add_to_history(&past, unknowns, next, x);
    past.solved++;
    end->reached = next;
  }
  if (end->reached == 1) return DVI_OK;
  if (past.solved > 0) memcpy(x, past.x[0], unknowns * sizeof *x);
  return DVI_STEP_TOO_LARGE;
}

int dvi__branch_is_near(const dvi__solve_report *report)
{
  return report->iterations == 1 || (report->bend <= 0.05 && report->first <= 0.01);
}

int dvi__branch_is_straight(const dvi__solve_report *report)
{
  return report->bend <= 1e-3;
}

void dvi__branch_note(dvi_status status, const dvi__solver *solver, dvi__branch_failure *failure)
{
  failure->status = status;
  failure->unsolved = status != DVI_OK && solver->unsolved;
  (void)snprintf(failure->sentence, sizeof failure->sentence, "%s",
                 status == DVI_OK ? "" : dvi_last_error());
}

static int is_callback(dvi_status status)
{
  return status != DVI_OK && status != DVI_NOT_CONVERGED;
}

/* The branch may go on where motions are so fast that its shortest parts are long. */
static dvi_status tell_far(const dvi__branch_end *end, double h)
{
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "a step too large: the solution that continues those of shorter steps is found up to h = "
      "%.4g; that of h = %.4g is too far from its guess to tell whether it continues them "
      "(%d iterations, residual %.1e)",
      end->reached * h, (end->reached + least_part) * h, end->report.iterations, end->report.row);
}

dvi_status dvi__branch_tell(const dvi__branch_end *end, double h, const dvi__branch_failure *whole)
{
  const double reached = end->reached * h;
  if (is_callback(whole->status))
    return dvi__fail(whole->status,
                     "%s; solutions that continue those of shorter steps reach h = %.4g",
                     whole->sentence, reached);
  if (is_callback(end->status))
    return dvi__fail_in(end->status, "the solution continues those of shorter steps up to h = %.4g",
                        reached);
  if (!end->ends && !whole->unsolved) return tell_far(end, h);
  if (end->reached == 0)
    return dvi__fail_in(
        DVI_NOT_CONVERGED,
        "not solved, not even for a step of h = %.3g (%d iterations, residual %.1e)",
        least_part * h, end->report.iterations, end->report.row);
  if (whole->unsolved)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "%s; solutions that continue those of shorter steps are found up to h = %.4g",
                     whole->sentence, reached);
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "a step too large: the solution that continues those of shorter steps ends at h = %.4g; "
      "beyond, Newton's method finds none near it (%d iterations, residual %.1e)",
      reached, end->report.iterations, end->report.row);
}
