#include "field/step/sweep.h"

#include <limits.h>

#include "core/memory.h"
#include "core/status.h"

/* ---- neighbours ---- */

void dvi__sweep_clear(dvi__sweep *sweep)
{
  dvi__team_destroy(&sweep->team);
  dvi__release(sweep->start);
  dvi__release(sweep->around);
  dvi__release(sweep->weight);
  *sweep = (dvi__sweep){0};
}

/* Tell if a (k+1)-cell acts on its k-cells. */
static int acts(const dvi__sweep *s, const dvi_matrix *M, int64_t face)
{
  return !s->is_diagonal || M->value[face] != 0;
}

/* List the (k+1)-cells that act on each k-cell, ascending. */
static void find_around(dvi__sweep *s, const dvi_matrix *M)
{
  const int64_t entries = s->faces * s->width;
  for (int64_t i = 0; i < entries; i++)
    s->start[s->facet[i] + 1] += (unsigned)acts(s, M, i / s->width);
  for (int64_t c = 0; c < s->cells; c++) s->start[c + 1] += s->start[c];
  for (int64_t i = 0; i < entries; i++)
    if (acts(s, M, i / s->width))
      s->around[s->start[s->facet[i]]++] = 2 * (unsigned)(i / s->width) + (s->sign[i] < 0);
  for (int64_t c = s->cells; c > 0; c--) s->start[c] = s->start[c - 1];
  s->start[0] = 0;
}

static void find_pattern(dvi__sweep *s)
{
  s->has_pattern = 1;
  for (int64_t i = 0; i < s->faces * s->width && s->has_pattern; i++)
    s->has_pattern = s->sign[i] == s->sign[i % s->width];
}

static dvi_status prepare(dvi__sweep *s, const dvi_matrix *M)
{
  if (s->faces > INT_MAX / 2 || s->faces * s->width > UINT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "march: a field of %lld cells of degree k+1 is too large",
                     (long long)s->faces);
  s->start = DVI_NEW(unsigned, s->cells + 1);
  s->around = DVI_NEW(unsigned, s->faces * s->width);
  s->weight = DVI_NEW(double, s->faces);
  if (!s->start || !s->around || !s->weight)
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for %lld cells", (long long)s->cells);
  for (int64_t f = 0; f < s->faces; f++)
    s->weight[f] = s->is_diagonal && M->value[f] != 0 ? M->value[f] : 1;
  find_around(s, M);
  find_pattern(s);
  return s->threads > 1 ? dvi__team_create(s->threads, &s->team) : DVI_OK;
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
                        .is_diagonal = M.column == NULL,
                        .threads = threads};
  const dvi_status status = prepare(sweep, &M);
  if (status != DVI_OK) dvi__sweep_clear(sweep);
  return status;
}

/* ---- rows ---- */

static double curl_of(const unsigned *around, unsigned count, const double *H)
{
  double sum = 0;
  for (unsigned i = 0; i < count; i++) {
    const double value = H[around[i] >> 1];
    sum += around[i] & 1 ? -value : value;
  }
  return sum;
}

/* The sum of a row with its signs as numbers. */
static inline double row_of(int width, const int *facet, const double *sign, const double *E)
{
  double sum = sign[0] * E[facet[0]];
  for (int i = 1; i < width; i++) sum += sign[i] * E[facet[i]];
  return sum;
}

double dvi__sweep_curl(const dvi__sweep *sweep, int64_t cell, const double *H)
{
  const unsigned first = sweep->start[cell];
  return curl_of(sweep->around + first, sweep->start[cell + 1] - first, H);
}

double dvi__sweep_d(const dvi__sweep *sweep, int64_t face, const double *E)
{
  double sign[DVI__FACETS] = {0};
  for (int i = 0; i < sweep->width; i++) sign[i] = sweep->sign[face * sweep->width + i];
  return row_of(sweep->width, sweep->facet + face * sweep->width, sign, E);
}

/* ---- loops ---- */

/* The work of a sweep, whose members take equal parts of the cells. */
typedef struct work {
  const dvi__sweep *sweep;
  double dt;
  const double *keep, *gain, *from;
  double *to;
} work;

/* Rows of a constant width with equal signs, which the compiler unrolls. */
static inline void update_rows(const work *w, int64_t first, int64_t last, const int width)
{
  const dvi__sweep *s = w->sweep;
  double sign[DVI__FACETS] = {0};
  for (int i = 0; i < width; i++) sign[i] = s->sign[i];
  for (int64_t f = first; f < last; f++)
    w->to[f] -= w->dt * s->weight[f] * row_of(width, s->facet + f * width, sign, w->from);
}

static void update_H(void *of, int member)
{
  const work *w = of;
  const dvi__sweep *s = w->sweep;
  const int64_t first = s->faces * member / s->threads, last = s->faces * (member + 1) / s->threads;
  switch (s->has_pattern ? s->width : 0) {
  case 2: update_rows(w, first, last, 2); break;
  case 3: update_rows(w, first, last, 3); break;
  case 4: update_rows(w, first, last, 4); break;
  default:
    for (int64_t f = first; f < last; f++)
      w->to[f] -= w->dt * s->weight[f] * dvi__sweep_d(s, f, w->from);
  }
}

static void update_E(void *of, int member)
{
  const work *w = of;
  const dvi__sweep *s = w->sweep;
  const int64_t first = s->cells * member / s->threads, last = s->cells * (member + 1) / s->threads;
  const unsigned *around = s->around + s->start[first];
  for (int64_t e = first; e < last; e++) {
    const unsigned count = s->start[e + 1] - s->start[e];
    const double change = w->gain[e] * curl_of(around, count, w->from);
    w->to[e] = (w->keep != NULL ? w->keep[e] * w->to[e] : w->to[e]) + change;
    around += count;
  }
}

static void run(const dvi__sweep *sweep, void (*part)(void *of, int member), work *w)
{
  if (sweep->team != NULL)
    dvi__team_run(sweep->team, sweep->threads, part, w);
  else
    part(w, 0);
}

void dvi__sweep_H(const dvi__sweep *sweep, double dt, const double *E, double *H)
{
  work w = {.sweep = sweep, .dt = dt, .from = E, .to = H};
  run(sweep, update_H, &w);
}

void dvi__sweep_E(const dvi__sweep *sweep, const double *keep, const double *gain, const double *H,
                  double *E)
{
  work w = {.sweep = sweep, .keep = keep, .gain = gain, .from = H, .to = E};
  run(sweep, update_E, &w);
}
