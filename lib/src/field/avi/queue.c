/* Events from a queue, a heap of the faces by their next time. Times are products t_0 + m h_f,
 * never running sums. Of faces with one time that with the lowest number is first. */
#include <math.h>

#include "core/status.h"
#include "field/avi/engine.h"
#include "field/step/heap.h"

static double time_of_next(const dvi__avi *avi, int64_t f)
{
  return avi->t0 + (double)(avi->count[f] + 1) * avi->step[f];
}

void dvi__avi_order_events(dvi__avi *avi)
{
  for (int64_t f = 0; f < avi->active_faces; f++) avi->next[f] = time_of_next(avi, f);
  dvi__heap_order(avi->next, avi->active_faces, avi->heap);
}

/* The signals may fail, and are integrated before anything is changed. */
static dvi_status find_signals(const dvi__avi *avi, int f, double t)
{
  for (int c = 0; c < avi->width && avi->extra != NULL; c++) {
    const int e = dvi__avi_number(avi->facet[(int64_t)f * avi->width + c]);
    if (avi->clock[e] < t && avi->extra[e] >= 0)
      DVI_TRY(dvi__avi_signals_at(avi, e, avi->clock[e], t,
                                  avi->half + 2 * (int64_t)avi->currents * c));
  }
  return DVI_OK;
}

static void pass_edges(dvi__avi *avi, int f, double t)
{
  for (int c = 0; c < avi->width; c++) {
    const int e = dvi__avi_number(avi->facet[(int64_t)f * avi->width + c]);
    const double span = t - avi->clock[e];
    if (!(span > 0)) continue;
    if (avi->extra != NULL && avi->extra[e] >= 0)
      dvi__avi_pass_extra(avi, e, span, avi->half + 2 * (int64_t)avi->currents * c);
    else
      dvi__avi_pass(avi, e, span);
    avi->clock[e] = t;
  }
}

static void act(dvi__avi *avi, int f)
{
  const double impulse = avi->kick[f] * dvi__avi_field(avi, f, avi->A);
  for (int c = 0; c < avi->width; c++) {
    const int code = avi->facet[(int64_t)f * avi->width + c], e = dvi__avi_number(code);
    if (e < avi->free_edges) avi->D[e] += code < 0 ? -impulse : impulse;
  }
}

dvi_status dvi__avi_run_queue(dvi__avi *avi, double limit)
{
  for (;;) {
    const int f = avi->heap[0];
    const double t = avi->next[f];
    if (!(t <= limit)) return DVI_OK;
    DVI_TRY(find_signals(avi, f, t));
    pass_edges(avi, f, t);
    act(avi, f);
    avi->count[f]++;
    avi->next[f] = time_of_next(avi, f);
    dvi__heap_sink(avi->next, avi->active_faces, avi->heap, 0);
    avi->events++;
    avi->t = fmax(avi->t, t);
  }
}
