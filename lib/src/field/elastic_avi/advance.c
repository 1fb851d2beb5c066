/* The run, its failures, and the alarm. Steps of their own are never stable, only slow to show it.
 * So the energy is looked at once in 64 of the longest steps, at times that do not depend on how
 * the way is cut. The state of the last look is kept: after a failure the run begins there again,
 * and ends before the event that failed. */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "field/elastic_avi/borders.h"
#include "field/mesh/share.h"
#include "field/step/alarm.h"

enum { STEPS_BETWEEN_CHECKS = 64 };

static const double roundings = 4 * DBL_EPSILON;

/* Say what stopped a run. */
static dvi_status refuse(const dvi__solid_avi *avi, const dvi__solid_halt *halt)
{
  const int n = avi->n, *corner = avi->cell[halt->cell].corner;
  for (int a = 0; a <= n; a++) {
    double u[DVI__SOLID_AXES], rate[DVI__SOLID_AXES];
    if (!(avi->node_kind[corner[a]] & DVI__NODE_DRIVEN)) continue;
    const int returned = dvi__solid_given(avi->solid, corner[a], halt->t, u, rate);
    if (returned != 0) return dvi__solid_refuse_given(avi->solid, corner[a], returned);
  }
  (void)dvi__solid_refuse(avi->solid, avi->cell[halt->cell].name, halt->returned);
  return halt->returned > 0 ? DVI_SINGULAR : DVI_CALLBACK_FAILED;
}

/* Events up to this time happen in a run to t. */
static double limit_of(const dvi__solid_avi *avi, double t)
{
  return t + roundings * fmax(fabs(t), fabs(avi->clock.t0));
}

/* Let the events since the last look up to a limit happen again, in the order by time. */
static dvi__solid_halt redo(dvi__solid_avi *avi, double limit)
{
  dvi__solid_take_back(avi);
  const dvi__solid_halt halt = dvi__solid_run_in_order(avi, limit);
  dvi__solid_order(avi);
  return halt;
}

/* Stand before the first event that fails up to a limit, in the order by time. If none fails
 * again, the callback that did has changed its mind, and the march stands where it was. */
static dvi_status stand_before(dvi__solid_avi *avi, double limit, dvi__solid_halt first)
{
  const double before = avi->clock.t;
  const dvi__solid_halt again = redo(avi, limit);
  const int fails_again = again.returned != 0;
  const dvi__solid_halt halt = fails_again ? again : first;
  (void)redo(avi, fails_again ? nextafter(halt.t, -INFINITY) : limit_of(avi, before));
  avi->clock.t = fmin(fmax(avi->clock.t, before), limit);
  return dvi__fail_in(refuse(avi, &halt), "%s: at t = %g", avi->method, halt.t);
}

/* Give the time of the first event that has failed on any process, or infinity. A run in which
 * values did not arrive is lost, as is one whose end nobody knows. */
static dvi_status find_first_failure(dvi__solid_avi *avi, dvi__solid_halt halt, double *t)
{
  double first = halt.returned != 0 ? -halt.t : -(double)INFINITY;
  if (avi->is_lost)
    return dvi__fail(DVI_CALLBACK_FAILED,
                     "%s: after t = %g the processes could not tell each other where nodes are",
                     avi->method, avi->kept_clock.t);
  const dvi_status status = dvi__largest_of_all(avi->solid->mesh, 1, &first);
  avi->is_lost = status != DVI_OK;
  *t = -first;
  return status;
}

/* Let the events since the last look up to a limit happen again on all processes. What fails even
 * now, as a callback may at any call, sets a limit before it. */
static dvi_status go_back(dvi__solid_avi *avi, double limit)
{
  double first = INFINITY;
  do {
    const dvi__solid_halt halt = redo(avi, limit);
    DVI_TRY(find_first_failure(avi, halt, &first));
    limit = nextafter(first, -INFINITY);
  } while (isfinite(first));
  return dvi__solid_complete(avi);
}

/* The same as stand_before where processes share the solid. Each of them has its events in order,
 * and failures change later times alone. */
static dvi_status stand_before_first(dvi__solid_avi *avi, double limit, dvi__solid_halt halt)
{
  const double before = avi->clock.t;
  double first = INFINITY;
  DVI_TRY(find_first_failure(avi, halt, &first));
  if (isfinite(first) && avi->threads > 1) {
    /* threads leave open which event is the first to fail */
    halt = redo(avi, limit);
    DVI_TRY(find_first_failure(avi, halt, &first));
  }
  if (isinf(first)) return dvi__solid_complete(avi);
  dvi_status status = go_back(avi, nextafter(first, -INFINITY));
  avi->clock.t = fmin(fmax(avi->clock.t, before), limit);
  if (status != DVI_OK) return status;
  if (halt.returned != 0 && halt.t == first)
    status = dvi__fail_in(refuse(avi, &halt), "%s: at t = %g", avi->method, halt.t);
  return dvi__agree(avi->solid->mesh, status);
}

static dvi_status run(dvi__solid_avi *avi, double t)
{
  const double limit = limit_of(avi, t), before = avi->clock.t;
  avi->view->t = (double)NAN; /* events of the present time may be left after a failure */
  const dvi__solid_halt halt = dvi__solid_run(avi, limit);
  if (avi->borders != NULL) {
    avi->clock.t = before;
    DVI_TRY(stand_before_first(avi, limit, halt));
    avi->clock.t = t;
    return DVI_OK;
  }
  if (halt.returned != 0) {
    avi->clock.t = before;
    return stand_before(avi, limit, halt);
  }
  avi->clock.t = t;
  return DVI_OK;
}

static double time_of_check(const dvi__solid_avi *avi)
{
  return avi->clock.t0 + (double)(avi->clock.checks + 1) * (STEPS_BETWEEN_CHECKS * avi->longest);
}

static dvi_status compare_energy(dvi__solid_avi *avi)
{
  const dvi__alarm_words words = {
      .method = avi->method,
      .reference = "the start and what loads and conditions worked",
      .remedy = "the steps are in resonance or too long for these strains; take shorter ones, and "
                "powers of 2 of the shortest",
      .last = "shorter steps"};
  DVI_TRY(dvi__solid_avi_look(avi));
  const dvi_elastic_energies *e = &avi->view->energies;
  const dvi_status status = dvi__judge_growth(&words, avi->clock.t, e->kinetic + e->stored,
                                              avi->view->growth, &avi->clock.allowed);
  if (status == DVI_NOT_FINITE) return status;
  avi->clock.checks++;
  dvi__solid_keep(avi);
  return status;
}

static dvi_status check_nodes(const dvi__solid_avi *avi)
{
  for (int64_t v = 0; v < avi->vertices; v++)
    for (int i = 0; i < avi->n && dvi__owns(avi->solid->mesh, 0, v); i++)
      if (!isfinite(avi->state.node[v].u[i]) || !isfinite(avi->state.node[v].v[i]))
        return dvi__fail(DVI_NOT_FINITE,
                         "%s: vertex %lld is not finite at t = %g: the run cannot go on; take "
                         "shorter steps",
                         avi->method, (long long)dvi__whole_number(avi->solid->mesh, 0, v),
                         avi->clock.t);
  return DVI_OK;
}

static dvi_status advance(dvi__solid_avi *avi, double t)
{
  while (time_of_check(avi) <= t) {
    DVI_TRY(run(avi, time_of_check(avi)));
    DVI_TRY(dvi__agree(avi->solid->mesh, check_nodes(avi)));
    DVI_TRY(compare_energy(avi));
  }
  const int64_t events = avi->clock.events;
  DVI_TRY(run(avi, t));
  return avi->clock.events > events ? dvi__agree(avi->solid->mesh, check_nodes(avi)) : DVI_OK;
}

/* What is not finite is taken back: to the last look, or to the time before. */
dvi_status dvi__solid_avi_advance(dvi__solid_avi *avi, double t)
{
  const double before = avi->clock.t;
  const dvi_status status = advance(avi, t);
  if (status != DVI_NOT_FINITE) return status;
  if (avi->kept_clock.t >= before) {
    dvi__solid_take_back(avi);
  } else {
    (void)go_back(avi, limit_of(avi, before));
    avi->clock.t = before;
  }
  return status;
}
