/* The start. The kicks of t_0 are half as large as the later ones, so that the run begins with the
 * values of E, not with those half a step before. */
#include <math.h>

#include "core/status.h"
#include "field/avi/engine.h"

void dvi__avi_rewind(dvi__avi *avi, double t)
{
  avi->t0 = avi->t = t;
  avi->slot = avi->events = avi->checks = 0;
  avi->view->t = (double)NAN;
  for (int64_t i = 0; i < avi->extra_count; i++) {
    dvi__avi_extra *extra = avi->extras + i;
    extra->delivered = extra->excess = extra->worked = 0;
  }
  for (int64_t e = 0; e < avi->edges && avi->is_queued; e++) avi->clock[e] = t;
  for (int64_t f = 0; f < avi->active_faces && avi->is_queued; f++) avi->count[f] = 0;
  if (avi->is_queued) dvi__avi_order_events(avi);
}

static void take_values(dvi__avi *avi, const double *A, const double *E, const double *B)
{
  for (int64_t e = 0; e < avi->edges; e++) {
    const int name = avi->edge_name[e];
    avi->A[e] = A != NULL ? A[name] : 0;
    avi->D[e] = E != NULL && e < avi->free_edges ? avi->M1[e] * E[name] : 0;
  }
  for (int64_t f = 0; f < avi->faces; f++) {
    avi->bias[f] = 0;
    if (B != NULL) avi->bias[f] = B[avi->face_name[f]] - dvi__avi_field(avi, f, avi->A);
  }
}

static void sum_charges(dvi__avi *avi)
{
  for (int64_t v = 0; v < avi->nodes; v++) avi->charge[v] = 0;
  for (int64_t i = 0; i < avi->free_edges * avi->node_width && avi->nodes > 0; i++) {
    const int code = avi->node[i];
    const double D = avi->D[i / avi->node_width];
    avi->charge[dvi__avi_number(code)] += code < 0 ? -D : D;
  }
}

/* Kick by what the faces owe at the start, the half of a kick where no damping is. What a damping
 * adds to the half counts as charge that has yet to flow in. */
static void kick_first(dvi__avi *avi)
{
  for (int64_t f = 0; f < avi->active_faces; f++) {
    const double kick = avi->kick[f] * dvi__avi_field(avi, f, avi->A);
    for (int c = 0; c < avi->width; c++) {
      const int code = avi->facet[f * avi->width + c], e = dvi__avi_number(code);
      if (e >= avi->free_edges) continue;
      const double signed_kick = code < 0 ? -kick : kick,
                   part = -dvi__avi_owed_time(avi, e, f, 0) / avi->step[f];
      avi->D[e] += signed_kick * part;
      if (avi->extra != NULL && avi->extra[e] >= 0)
        avi->extras[avi->extra[e]].delivered -= signed_kick * (part - 0.5);
    }
  }
}

/* The energy is summed before anything is changed. */
static dvi_status check_energy(const dvi__avi *avi, const double *A, const double *E,
                               const double *B, double *energy)
{
  double sum = 0;
  for (int64_t e = 0; e < avi->free_edges && E != NULL; e++) {
    const double value = E[avi->edge_name[e]];
    sum += value * (value * avi->M1[e]); /* a square may overflow, or vanish */
  }
  for (int64_t f = 0; f < avi->faces; f++) {
    double value = B != NULL ? B[avi->face_name[f]] : 0;
    for (int c = 0; c < avi->width && B == NULL && A != NULL; c++) {
      const int code = avi->facet[f * avi->width + c];
      const double a = A[avi->edge_name[dvi__avi_number(code)]];
      value += code < 0 ? -a : a;
    }
    sum += value * (value * avi->M2[f]);
  }
  *energy = 0.5 * sum;
  if (isfinite(*energy)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "avi: the energy of the start is not finite");
}

dvi_status dvi__avi_start(dvi__avi *avi, double t, const double *A, const double *E,
                          const double *B)
{
  double energy;
  DVI_TRY(check_energy(avi, A, E, B, &energy));
  take_values(avi, A, E, B);
  dvi__avi_rewind(avi, t);
  sum_charges(avi);
  kick_first(avi);
  avi->start_energy = energy;
  avi->allowed = avi->band;
  return DVI_OK;
}
