/* What a complex's lengths say, and how well Schlaefli's identity holds. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/regge/regge.h"

typedef struct work {
  dvi__regge_sums sums;
  double *sum, *terms; /* [edges] of |h| d theta_h/dl_e, and of its sizes */
} work;

/* Sum up |h| d theta_h of all simplices. */
static dvi_status find_defect(const dvi_regge *r, const double *length, const work *w,
                              double *worst)
{
  dvi__measured_simplex m;
  double turn[DVI__PAIRS];
  for (int64_t c = 0; c < r->cells; c++) {
    DVI_TRY(dvi__regge_measure_cell(r, length, c, &m));
    for (int h = 0; h < r->pairs; h++) {
      dvi__angle_slopes(&m, h, turn);
      for (int e = 0; e < r->pairs; e++) {
        const double part = m.hinge[h].face.volume * turn[e];
        w->sum[r->edge[c * r->pairs + e]] += part;
        w->terms[r->edge[c * r->pairs + e]] += fabs(part);
      }
    }
  }
  *worst = 0;
  for (int64_t e = 0; e < r->edges; e++) *worst = fmax(*worst, fabs(w->sum[e]) / w->terms[e]);
  return DVI_OK;
}

static void find_extremes(const dvi_regge *r, const double *length, const dvi__regge_sums *sums,
                          dvi_regge_measures *m)
{
  double least = INFINITY, most = -INFINITY;
  for (int64_t h = 0; h < r->hinges; h++) {
    if (r->outer[h]) continue;
    least = fmin(least, sums->deficit[h]);
    most = fmax(most, sums->deficit[h]);
  }
  m->deficit_min = least <= most ? least : 0;
  m->deficit_max = least <= most ? most : 0;
  m->length_min = m->length_max = length[0];
  for (int64_t e = 0; e < r->edges; e++) {
    if (!r->rim[e]) m->gradient_max = fmax(m->gradient_max, fabs(sums->gradient[e]));
    m->length_min = fmin(m->length_min, length[e]);
    m->length_max = fmax(m->length_max, length[e]);
  }
}

static dvi_status measure(const dvi_regge *r, const double *length, work *w, dvi_regge_measures *m)
{
  dvi__regge_sums *sums = &w->sums;
  if (sums->deficit == NULL || sums->size == NULL || sums->gradient == NULL || w->sum == NULL ||
      w->terms == NULL)
    return dvi__fail(DVI_NO_MEMORY, "regge: no memory for measures");
  DVI_TRY(dvi__regge_evaluate(r, length, sums));
  *m = (dvi_regge_measures){.action = sums->action,
                            .volume = sums->volume,
                            .hinges = r->hinges,
                            .boundary_hinges = r->boundary_hinges};
  find_extremes(r, length, sums, m);
  return find_defect(r, length, w, &m->schlaefli);
}

dvi_status dvi_regge_measure(const dvi_regge *regge, const double *length,
                             dvi_regge_measures *measures)
{
  DVI_TRY(dvi__regge_check(regge, length));
  if (measures == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "regge: measures are needed");
  work w = {.sums = {.deficit = DVI_NEW(double, regge->hinges),
                     .size = DVI_NEW(double, regge->hinges),
                     .gradient = DVI_NEW(double, regge->edges)},
            .sum = DVI_NEW(double, regge->edges),
            .terms = DVI_NEW(double, regge->edges)};
  const dvi_status status = measure(regge, length, &w, measures);
  dvi__release(w.sums.deficit);
  dvi__release(w.sums.size);
  dvi__release(w.sums.gradient);
  dvi__release(w.sum);
  dvi__release(w.terms);
  return status;
}
