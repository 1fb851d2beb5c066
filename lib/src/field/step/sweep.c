#include "field/step/sweep.h"

#include "core/memory.h"
#include "core/status.h"

/* ---- neighbours ---- */

void dvi__sweep_clear(dvi__sweep *sweep)
{
  dvi__team_destroy(&sweep->team);
  dvi__release(sweep->start);
  dvi__release(sweep->around);
  *sweep = (dvi__sweep){0};
}

/* List the (k+1)-cells around each k-cell, ascending. */
static void find_around(dvi__sweep *s)
{
  const int64_t entries = s->faces * s->width;
  for (int64_t i = 0; i < entries; i++) s->start[s->facet[i] + 1]++;
  for (int64_t c = 0; c < s->cells; c++) s->start[c + 1] += s->start[c];
  for (int64_t i = 0; i < entries; i++)
    s->around[s->start[s->facet[i]]++] = 2 * (unsigned)(i / s->width) + (s->sign[i] < 0);
  for (int64_t c = s->cells; c > 0; c--) s->start[c] = s->start[c - 1];
  s->start[0] = 0;
}

dvi_status dvi__sweep_create(const dvi_field *field, int threads, dvi__sweep *sweep)
{
  const int k = field->degree;
  dvi_matrix d, M;
  DVI_TRY(dvi_mesh_incidence(field->mesh, k, &d));
  DVI_TRY(dvi_star_matrix(field->star, k + 1, &M));
  *sweep = (dvi__sweep){.cells = d.columns,
                        .faces = d.rows,
                        .width = d.width,
                        .facet = d.column,
                        .sign = d.sign,
                        .M2 = M.column == NULL ? M.value : NULL,
                        .threads = threads};
  sweep->start = DVI_NEW(int64_t, d.columns + 1);
  sweep->around = DVI_NEW(unsigned, d.rows *d.width);
  dvi_status status = sweep->start && sweep->around
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "march: no memory for %lld cells",
                                      (long long)d.columns);
  if (status == DVI_OK && threads > 1) status = dvi__team_create(threads, &sweep->team);
  if (status == DVI_OK)
    find_around(sweep);
  else
    dvi__sweep_clear(sweep);
  return status;
}

/* ---- rows ---- */

double dvi__sweep_curl(const dvi__sweep *sweep, int64_t cell, const double *B)
{
  double sum = 0;
  for (int64_t i = sweep->start[cell]; i < sweep->start[cell + 1]; i++) {
    const unsigned face = sweep->around[i] >> 1;
    const double H = sweep->M2[face] * B[face];
    sum += sweep->around[i] & 1 ? -H : H;
  }
  return sum;
}

double dvi__sweep_d(const dvi__sweep *sweep, int64_t face, const double *E)
{
  double sum = 0;
  for (int64_t i = face * sweep->width; i < (face + 1) * sweep->width; i++)
    sum += sweep->sign[i] * E[sweep->facet[i]];
  return sum;
}

/* ---- loops ---- */

/* The work of a sweep, whose members take equal parts of the cells. */
typedef struct work {
  const dvi__sweep *sweep;
  double dt;
  const double *keep, *gain, *from;
  double *to;
} work;

static void update_B(void *of, int member)
{
  const work *w = of;
  const dvi__sweep *s = w->sweep;
  const int64_t first = s->faces * member / s->threads, last = s->faces * (member + 1) / s->threads;
  for (int64_t f = first; f < last; f++) w->to[f] -= w->dt * dvi__sweep_d(s, f, w->from);
}

static void update_E(void *of, int member)
{
  const work *w = of;
  const dvi__sweep *s = w->sweep;
  const int64_t first = s->cells * member / s->threads, last = s->cells * (member + 1) / s->threads;
  for (int64_t e = first; e < last; e++) {
    const double change = w->gain[e] * dvi__sweep_curl(s, e, w->from);
    w->to[e] = (w->keep != NULL ? w->keep[e] * w->to[e] : w->to[e]) + change;
  }
}

static void run(const dvi__sweep *sweep, void (*part)(void *of, int member), work *w)
{
  if (sweep->team != NULL)
    dvi__team_run(sweep->team, sweep->threads, part, w);
  else
    part(w, 0);
}

void dvi__sweep_B(const dvi__sweep *sweep, double dt, const double *E, double *B)
{
  work w = {.sweep = sweep, .dt = dt, .from = E, .to = B};
  run(sweep, update_B, &w);
}

void dvi__sweep_E(const dvi__sweep *sweep, const double *keep, const double *gain, const double *B,
                  double *E)
{
  work w = {.sweep = sweep, .keep = keep, .gain = gain, .from = B, .to = E};
  run(sweep, update_E, &w);
}
