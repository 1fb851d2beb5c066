/* What can be seen at a time between events, beside the state.
 *
 * Edges go on from their last event, and faces pay for what lies between t and the middle of the
 * interval that they have paid for,
 *
 *     A_e(t) = A_e - E_e (t - t_e),    D_e(t) = D_e + sum over f of sign H_f(t) (t - t_f - h_f/2),
 *
 * which is of order 2 at any t, and with equal steps E halfway between two of its values. With a
 * damping both are those of passage.c and decay.h. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/avi/engine.h"

/* ---- clocks ---- */

static double time_of_class(const dvi__avi *avi, int class)
{
  return dvi__avi_slot_time(avi, avi->slot >> class << class);
}

static double time_of_edge(const dvi__avi *avi, int64_t e)
{
  return avi->is_queued ? avi->clock[e] : time_of_class(avi, avi->edge_class[e]);
}

static double time_of_face(const dvi__avi *avi, int64_t f)
{
  return avi->is_queued ? avi->t0 + (double)avi->count[f] * avi->step[f]
                        : time_of_class(avi, avi->face_class[f]);
}

/* ---- single cells ---- */

/* Forget the values of another time. Between two looks at one time nothing happens without a run,
 * which sets view->t to NaN. */
static void begin(const dvi__avi *avi)
{
  dvi__avi_view *view = avi->view;
  if (view->t == avi->t) return;
  if (++view->stamp == 0) {
    memset(view->made, 0, (size_t)(avi->edges + avi->faces) * sizeof *view->made);
    view->summed = 0;
    view->stamp = 1;
  }
  view->t = avi->t;
}

static dvi_status make_edge(const dvi__avi *avi, int64_t e)
{
  dvi__avi_view *view = avi->view;
  if (view->made[e] == view->stamp) return DVI_OK;
  view->A[e] = avi->A[e];
  view->D[e] = avi->D[e];
  if (e < avi->free_edges) {
    const double last = time_of_edge(avi, e), span = avi->t - last;
    if (avi->extra != NULL && avi->extra[e] >= 0) {
      DVI_TRY(dvi__avi_signals_at(avi, e, last, avi->t, view->half));
      const dvi__avi_passage passage = dvi__avi_passage_of(avi, e, span, view->half);
      view->A[e] = passage.A;
      view->D[e] = passage.D;
      view->worked[avi->extra[e]] = passage.worked;
    } else {
      view->A[e] -= avi->D[e] * avi->inverse[e] * span;
    }
  }
  view->made[e] = view->stamp;
  return DVI_OK;
}

static dvi_status see_B(const dvi__avi *avi, int64_t f, double *B)
{
  dvi__avi_view *view = avi->view;
  unsigned *made = view->made + avi->edges + f;
  if (*made != view->stamp) {
    for (int c = 0; c < avi->width; c++)
      DVI_TRY(make_edge(avi, dvi__avi_number(avi->facet[f * avi->width + c])));
    view->B[f] = dvi__avi_field(avi, f, view->A);
    *made = view->stamp;
  }
  *B = view->B[f];
  return DVI_OK;
}

static dvi_status see_A(const dvi__avi *avi, int64_t e, double *A)
{
  DVI_TRY(make_edge(avi, e));
  *A = avi->view->A[e];
  return DVI_OK;
}

static dvi_status see_D(const dvi__avi *avi, int64_t e, double *D)
{
  *D = 0;
  if (e >= avi->free_edges) return DVI_OK;
  DVI_TRY(make_edge(avi, e));
  *D = avi->view->D[e];
  for (int64_t i = avi->coface_start[e]; i < avi->coface_start[e + 1]; i++) {
    const int code = avi->coface[i], f = dvi__avi_number(code);
    double B;
    DVI_TRY(see_B(avi, f, &B));
    const double owed = avi->M2[f] * B *
                        dvi__avi_owed_time(avi, e, f, avi->t - time_of_face(avi, f));
    *D += code < 0 ? -owed : owed;
  }
  return DVI_OK;
}

static dvi_status see_E(const dvi__avi *avi, int64_t e, double *E)
{
  DVI_TRY(see_D(avi, e, E));
  *E *= avi->inverse[e];
  return DVI_OK;
}

/* ---- observations ---- */

dvi_status dvi__avi_sample(const dvi__avi *avi, dvi_march_form form, int64_t count, const int *cell,
                           double *values)
{
  dvi_status (*const see)(const dvi__avi *, int64_t, double *) =
      form == DVI_FORM_A ? see_A : (form == DVI_FORM_E ? see_E : see_B);
  const int *number = form == DVI_FORM_B ? avi->face_number : avi->edge_number;
  const int64_t all = form == DVI_FORM_B ? avi->faces : avi->edges;
  begin(avi);
  for (int64_t i = 0; i < (cell != NULL ? count : all); i++)
    DVI_TRY(see(avi, number[cell != NULL ? cell[i] : i], values + i));
  return DVI_OK;
}

static dvi_status sum_energy(const dvi__avi *avi)
{
  dvi__avi_view *view = avi->view;
  double sum = 0, reference = avi->start_energy;
  for (int64_t e = 0; e < avi->free_edges; e++) {
    double D;
    DVI_TRY(see_D(avi, e, &D));
    sum += D * (D * avi->inverse[e]); /* a square may overflow, or vanish */
  }
  for (int64_t f = 0; f < avi->faces; f++) {
    double B;
    DVI_TRY(see_B(avi, f, &B));
    sum += B * (B * avi->M2[f]);
  }
  for (int64_t i = 0; i < avi->extra_count; i++)
    reference += avi->extras[i].worked + view->worked[i];
  view->energy = 0.5 * sum;
  view->growth = reference > 0 ? view->energy / reference : 1;
  view->summed = view->stamp;
  return DVI_OK;
}

dvi_status dvi__avi_energy(const dvi__avi *avi, double *energy, double *growth)
{
  const dvi__avi_view *view = avi->view;
  begin(avi);
  if (view->summed != view->stamp) DVI_TRY(sum_energy(avi));
  *energy = view->energy;
  if (growth != NULL) *growth = view->growth;
  return DVI_OK;
}

/* ---- charges ---- */

/* The kicks of a face cancel at each node, so that D with what the currents delivered keeps its sum
 * there, at all times between whole events. The state is summed, not its view. */
static void sum_nodes(const dvi__avi *avi, double *sum, double *size)
{
  memset(sum, 0, (size_t)avi->nodes * sizeof *sum);
  memset(size, 0, (size_t)avi->nodes * sizeof *size);
  for (int64_t i = 0; i < avi->free_edges * avi->node_width; i++) {
    const int64_t e = i / avi->node_width;
    const int v = dvi__avi_number(avi->node[i]);
    double delivered = 0;
    if (avi->extra != NULL && avi->extra[e] >= 0) {
      const dvi__avi_extra *extra = avi->extras + avi->extra[e];
      delivered = extra->delivered - extra->excess;
    }
    sum[v] += avi->node[i] < 0 ? -(avi->D[e] + delivered) : avi->D[e] + delivered;
    size[v] += fabs(avi->D[e]) + fabs(delivered);
  }
}

double dvi__avi_gauss(const dvi__avi *avi)
{
  double worst = 0, largest = 0, *const sum = avi->view->node_sum, *const size = sum + avi->nodes;
  if (avi->nodes == 0) return 0;
  sum_nodes(avi, sum, size);
  for (int64_t v = 0; v < avi->nodes; v++) {
    if (avi->node_open[v]) continue;
    worst = fmax(worst, fabs(sum[v] - avi->charge[v]));
    largest = fmax(largest, size[v]);
  }
  return largest > 0 ? worst / largest : 0;
}

void dvi__avi_facts(const dvi__avi *avi, dvi_march_facts *facts)
{
  facts->step = avi->shortest;
  facts->longest = avi->longest;
  facts->bound = avi->bound;
  facts->steps = facts->updates = avi->events;
}
