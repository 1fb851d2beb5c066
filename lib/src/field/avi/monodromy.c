/* The growth of a field under asynchronous steps. */
#include "field/avi/monodromy.h"

#include <float.h>
#include <math.h>

#include "core/status.h"
#include "field/step/classes.h"

/* Events that a search may cost, unless the user asks for a span. */
static const double events_wanted = 5e7;

static double common_period(const dvi__avi *avi)
{
  if (!avi->is_queued) return avi->longest;
  return dvi__common_period(avi->active_faces, avi->step, avi->shortest, avi->longest);
}

/* ---- passages ---- */

/* Run from (A, D) right after the events of the time 0 to the time `t`, at which all faces act or
 * will act next. */
static dvi_status carry(void *of, double t)
{
  dvi__avi *avi = of;
  const double limit = t * (1 + 4 * DBL_EPSILON);
  dvi__avi_rewind(avi, 0);
  return (avi->is_queued ? dvi__avi_run_queue : dvi__avi_run_slots)(avi, limit);
}

static dvi_status energy_at(void *of, double t, double *energy)
{
  dvi__avi *avi = of;
  if (t > 0) {
    avi->t = t;
    DVI_TRY(dvi__avi_run_queue(avi, t));
  } else {
    dvi__avi_rewind(avi, 0);
    avi->start_energy = 1;
  }
  return dvi__avi_energy(avi, energy, NULL);
}

dvi__flow dvi__avi_flow(dvi__avi *avi)
{
  return (dvi__flow){.n = avi->free_edges,
                     .strains = avi->active_faces,
                     .strain = &dvi__strain_of_forms,
                     .width = avi->width,
                     .facet = avi->facet,
                     .M1 = avi->M1,
                     .inverse = avi->inverse,
                     .M2 = avi->M2,
                     .bound = avi->bound,
                     .A = avi->A,
                     .D = avi->D,
                     .bias = avi->bias,
                     .has_losses = avi->extra_count > 0,
                     .work = avi->impulse,
                     .carry = carry,
                     .energy = energy_at,
                     .of = avi};
}

/* ---- the report ---- */

static dvi_status find_growth(dvi__avi *avi, double span, dvi_stability *report)
{
  const dvi__flow flow = dvi__avi_flow(avi);
  const dvi__schedule schedule = {.count = avi->active_faces,
                                  .step = avi->step,
                                  .longest = avi->longest,
                                  .events = events_wanted};
  report->period = common_period(avi);
  return dvi__find_growth(&flow, &schedule, span, report);
}

dvi_status dvi__avi_stability(const dvi__avi_terms *terms, double span, dvi_stability *report)
{
  dvi__avi *avi;
  dvi_stability found = {0};
  dvi__avi_terms bare = *terms;
  bare.current = NULL;
  bare.currents = 0;
  DVI_TRY(dvi__avi_create(&bare, &avi));
  const dvi_status status = find_growth(avi, span, &found);
  if (status == DVI_OK) {
    found.is_stable = found.growth <= 1 + found.resolution;
    dvi__say_steps(&found, avi->shortest, avi->longest, avi->is_queued ? 0 : avi->classes);
    *report = found;
  }
  dvi__avi_destroy(&avi);
  return status;
}
