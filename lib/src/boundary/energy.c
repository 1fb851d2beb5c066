/* The energy along a path. Steps that follow a motion keep the energy. Solutions of the discrete
 * equations with too long steps follow no motion. They change the energy by a large part of the
 * kinetic energy, from node to node or over the whole path. */
#include <math.h>

#include "core/status.h"
#include "boundary/path_struct.h"
#include "system/evaluate/evaluator.h"

/* A path that changes the energy by more than this part of the kinetic energy is not resolved. This
 * limit refused 266 of 295 random paths with a step that misses the motion by 0.3 of itself or
 * more, and 2 of 2651 whose steps follow the motion to 0.03 (docs/paths.md). */
static const double resolved_below = 0.1;

/* The advised number of steps brings the change of energy, by the order of the method, to this aim.
 * It is at least twice the present number, because steps that follow no motion have no order
 * yet. */
static const double aim = 0.01, least_ratio = 2;

/* Return node k. The index `room` chooses one of two arrays for its velocity. */
static dvi__instant energy_node(dvi_path *path, int k, int room)
{
  const size_t n = (size_t)path->n;
  const double t = path->start + k * (dvi__path_span(path, path->trial) / path->steps);
  const double *q = dvi__path_at(path, path->trial, k), *p = path->trial_p + (size_t)k * n;
  return (dvi__instant){.t = t, .q = q, .p = p, .v = path->probe + (size_t)room * n};
}

/* The nodes with the smallest and the largest energy so far. */
typedef struct energy_range {
  int lowest, highest;
  double least, most;
} energy_range;

static dvi_status widen_energy_range(dvi_path *path, int k, const dvi__instant *at, energy_range *r)
{
  double E;
  DVI_TRY(dvi__invariant(path->energies, at->t, at->q, at->v, at->p, 0, &E));
  if (E < r->least) r->least = E, r->lowest = k;
  if (E > r->most) r->most = E, r->highest = k;
  return DVI_OK;
}

static dvi_status measure_step(dvi_path *path, int k, energy_range *r, dvi_path_report *report)
{
  const dvi__instant before = energy_node(path, k, 0), after = energy_node(path, k + 1, 1);
  double change, kinetic;
  DVI_TRY(dvi__energy_change(path->energies, &before, &after, NULL, &change, &kinetic));
  if (k == 0) DVI_TRY(widen_energy_range(path, 0, &before, r));
  DVI_TRY(widen_energy_range(path, k + 1, &after, r));
  const double jump = change > 0 ? change / kinetic : 0;
  if (jump > report->energy_jump) report->jump_step = k, report->energy_jump = jump;
  report->kinetic = fmax(report->kinetic, kinetic);
  return DVI_OK;
}

dvi_status dvi__path_energies(dvi_path *path, dvi_path_report *report)
{
  energy_range r = {.least = HUGE_VAL, .most = -HUGE_VAL};
  double kinetic;
  report->energy_spread = report->energy_jump = report->kinetic = (double)NAN;
  if (!path->system->autonomous) return DVI_OK;
  report->energy_jump = report->kinetic = 0;
  for (int k = 0; k < path->steps; k++) {
    const dvi_status status = measure_step(path, k, &r, report);
    if (status != DVI_OK)
      return dvi__fail_in(status, "energy in step %d of %d", k + 1, path->steps);
  }
  const dvi__instant lowest = energy_node(path, r.lowest, 0),
                     highest = energy_node(path, r.highest, 1);
  return dvi__energy_change(path->energies, &lowest, &highest, NULL, &report->energy_spread,
                            &kinetic);
}

/* Return the spread relative to the largest kinetic energy. A path at rest has the spread 0. */
static double relative_spread(const dvi_path_report *report)
{
  return report->kinetic > 0 ? report->energy_spread / report->kinetic : 0;
}

dvi_status dvi__path_check_resolved(const dvi_path *path, const dvi_path_report *report)
{
  const double spread = relative_spread(report), worst = fmax(spread, report->energy_jump);
  if (!(worst > resolved_below)) return DVI_OK;
  const double ratio = pow(fmin(worst, 1) / aim, 1.0 / path->order);
  const double advised = ceil(path->steps * fmax(ratio, least_ratio));
  const int k = report->jump_step;
  const double from = dvi_path_time(path, k), to = dvi_path_time(path, k + 1);
  return dvi__fail(DVI_STEP_TOO_LARGE,
                   "path: %d steps do not resolve the path that was found: from node %d to %d, "
                   "t = %.6g to %.6g, the energy changes by %.2g of the kinetic energy there, and "
                   "over the path by %.2g of the largest, where at most %g is left by steps that "
                   "follow a motion; try about %.0f steps",
                   path->steps, k, k + 1, from, to, report->energy_jump, spread, resolved_below,
                   advised);
}
