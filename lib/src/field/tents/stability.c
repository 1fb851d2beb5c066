/* The growth of fields under tents.
 *
 * The lowest vertex rises by the least that its edges allow, so that without random parts each
 * vertex has a step of its own. If all of them are equal, a level front is level again after each
 * of them, and a slab of spacetime repeats itself. Other steps hardly ever have a common period,
 * and then roundings decide which of two neighbours at one time rises first, which changes the
 * cells of spacetime between them. Such tents are followed as a run has them. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/step/growth.h"
#include "field/tents/front.h"

/* Tents that a search may cost, unless the user asks for a span. */
static const double tents_wanted = 2e6;

/* Steps may differ by this part if they are equal but for roundings. */
static const double near = 1e-9;

typedef struct slabs {
  dvi__tents *tents;
  dvi__flow flow;
  dvi__schedule schedule;
  double shortest;
  int *cell, *number; /* [n] free k-cells, and [k-cells] their numbers */
  int *facet;
  double *M1, *inverse, *M2, *A, *D, *bias, *work, *step;
} slabs;

/* ---- passages ---- */

static void begin(slabs *s)
{
  dvi__tents *w = s->tents;
  dvi__tents_start(w, &(dvi_march_state){.size = sizeof(dvi_march_state)});
  for (int64_t i = 0; i < s->flow.n; i++) {
    w->front.A[s->cell[i]] = s->A[i];
    w->front.row[s->cell[i]] = s->D[i];
  }
  memcpy(w->base, s->bias, (size_t)s->flow.strains * sizeof *w->base);
}

static dvi_status carry(void *of, double t)
{
  slabs *s = of;
  const dvi__front *front = &s->tents->front;
  begin(s);
  DVI_TRY(dvi__tents_advance(s->tents, t + near * t));
  for (int64_t i = 0; i < s->flow.n; i++) {
    s->A[i] = front->A[s->cell[i]];
    s->D[i] = front->row[s->cell[i]];
  }
  return DVI_OK;
}

static dvi_status energy_at(void *of, double t, double *energy)
{
  slabs *s = of;
  if (t > 0)
    DVI_TRY(dvi__tents_advance(s->tents, t));
  else
    begin(s);
  return dvi__tents_energy(s->tents, energy);
}

/* ---- arrays ---- */

static void clear(slabs *s)
{
  void *const owned[] = {s->cell, s->number, s->facet, s->M1,   s->inverse, s->M2,
                         s->A,    s->D,      s->bias,  s->work, s->step};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
}

static dvi_status allocate(slabs *s)
{
  const dvi__tents *w = s->tents;
  const int64_t cells = w->mesh->count[w->k], faces = w->mesh->count[w->k + 1];
  s->cell = DVI_NEW(int, cells);
  s->number = DVI_NEW(int, cells);
  s->facet = DVI_NEW(int, faces *(w->k + 2));
  s->M1 = DVI_NEW(double, cells);
  s->inverse = DVI_NEW(double, cells);
  s->M2 = dvi__duplicate(w->star->diagonal[w->k + 1], (size_t)faces, sizeof *s->M2);
  s->A = DVI_NEW(double, cells);
  s->D = DVI_NEW(double, cells);
  s->bias = DVI_NEW(double, faces);
  s->work = DVI_NEW(double, faces);
  s->step = DVI_NEW(double, w->mesh->count[0]);
  if (s->cell && s->number && s->facet && s->M1 && s->inverse && s->M2 && s->A && s->D && s->bias &&
      s->work && s->step)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "stability: no memory for %lld cells", (long long)cells);
}

/* Free k-cells have the first numbers. */
static void number_cells(slabs *s)
{
  const dvi__tents *w = s->tents;
  const double *mass = w->star->diagonal[w->k];
  int64_t n = 0, held = w->mesh->count[w->k];
  for (int i = 0; i < w->mesh->count[w->k]; i++) {
    s->number[i] = (int)(w->held[i] ? --held : n);
    if (w->held[i]) continue;
    s->cell[n] = i;
    s->M1[n] = mass[i];
    s->inverse[n++] = 1 / mass[i];
  }
  s->flow.n = n;
}

static void write_codes(slabs *s)
{
  const dvi__tents *w = s->tents;
  const int k = w->k;
  for (int64_t i = 0; i < w->mesh->count[k + 1] * (k + 2); i++) {
    const int number = s->number[w->mesh->facet[k + 1][i]];
    s->facet[i] = w->mesh->sign[k + 1][i] < 0 ? ~number : number;
  }
}

static void find_steps(slabs *s)
{
  const dvi__tents *w = s->tents;
  const int64_t vertices = w->mesh->count[0];
  double longest = 0;
  s->shortest = INFINITY;
  for (int64_t v = 0; v < vertices; v++) {
    s->step[v] = INFINITY;
    for (int64_t i = w->edges.start[v]; i < w->edges.start[v + 1]; i++)
      s->step[v] = fmin(s->step[v], w->reach[w->edges.cell[i]]);
    s->shortest = fmin(s->shortest, s->step[v]);
    longest = fmax(longest, s->step[v]);
  }
  s->schedule = (dvi__schedule){
      .count = vertices, .step = s->step, .longest = longest, .events = tents_wanted};
}

static dvi_status prepare(slabs *s)
{
  const dvi__tents *w = s->tents;
  DVI_TRY(allocate(s));
  number_cells(s);
  write_codes(s);
  find_steps(s);
  s->flow = (dvi__flow){.n = s->flow.n,
                        .strains = w->mesh->count[w->k + 1],
                        .strain = &dvi__strain_of_forms,
                        .width = w->k + 2,
                        .facet = s->facet,
                        .M1 = s->M1,
                        .inverse = s->inverse,
                        .M2 = s->M2,
                        .bound = s->shortest,
                        .A = s->A,
                        .D = s->D,
                        .bias = s->bias,
                        .work = s->work,
                        .carry = carry,
                        .energy = energy_at,
                        .of = s};
  return DVI_OK;
}

/* ---- the report ---- */

static void describe(const slabs *s, dvi_stability *report)
{
  const double from = s->shortest, to = s->schedule.longest, least = s->tents->least;
  if (report->period > 0)
    dvi__say_schedule(report, "equal tents of %.6g", to);
  else if (least == 1)
    dvi__say_schedule(report, "tents from %.6g to %.6g, which do not repeat", from, to);
  else
    dvi__say_schedule(report, "random tents from %.6g to %.6g", least * from, to);
}

static dvi_status find_growth(slabs *s, double span, dvi_stability *report)
{
  DVI_TRY(prepare(s));
  const double longest = s->schedule.longest;
  const int is_equal = s->tents->least == 1 && longest <= (1 + near) * s->shortest;
  report->period = is_equal ? longest : 0;
  DVI_TRY(dvi__find_growth(&s->flow, &s->schedule, span, report));
  report->is_stable = report->growth <= 1 + report->resolution;
  describe(s, report);
  return DVI_OK;
}

dvi_status dvi__tents_stability(dvi__tents *tents, double span, dvi_stability *report)
{
  slabs s = {.tents = tents};
  dvi__release(tents->force);
  tents->force = NULL;
  dvi_stability found = {0};
  const dvi_status status = find_growth(&s, span, &found);
  if (status == DVI_OK) *report = found;
  clear(&s);
  return status;
}
