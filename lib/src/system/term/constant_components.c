#include "system/term/constant_components.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/term.h"

enum { POINTS = 12, CANDIDATES_MOST = 16 };

/* Statistics over the points. They hold the sizes of the gradients' entries, and of the two-form's,
 * relative to the largest of the point. */
typedef struct probe {
  const dvi_system *system;
  double *q, *alpha_q, *work; /* work [n], [entries of qv] */
  /* Largest entry [n] of a component, and of the two-form in a coordinate's row. */
  double *form, *turn;
  double two_form[CANDIDATES_MOST][CANDIDATES_MOST];
  int seen;
} probe;

/* Entries smaller than this, relative to the largest derivative of a point, are sums that cancel
 * after a change of gauge. */
static const double negligible = 1e-12;

/* Choose a point by numbers that are equally distributed and rational multiples of nothing. The
 * first third is within (0.25, 1.25), for logarithms and radii, the next within (-1, 1), the last
 * within (0, 100). */
static void place_probe(const probe *p, int k)
{
  const double golden = 0.6180339887498949;
  for (int i = 0; i < p->system->n; i++) {
    const double number = (k + 1) * golden + (i + 1) * sqrt(2.0) + (k + 1) * (i + 1) * sqrt(3.0),
                 u = number - floor(number);
    p->q[i] = 3 * k < POINTS ? 0.25 + u : 3 * k < 2 * POINTS ? 2 * u - 1 : 100 * u;
  }
}

static double probe_entry(const probe *p, int row, int column)
{
  const int e = dvi__pattern_find(&p->system->qv, row, column);
  return e >= 0 ? p->alpha_q[e] : 0;
}

static void probe_point(probe *p, int k)
{
  const dvi__pattern *qv = &p->system->qv;
  double largest = 0;
  place_probe(p, k);
  /* the point is outside of the domain */
  if (dvi__form_gradients(p->system->lagrangian, p->q, p->alpha_q, p->work) != DVI_OK) return;
  p->seen++;
  for (int e = 0; e < dvi__pattern_entries(qv); e++) largest = fmax(largest, fabs(p->alpha_q[e]));
  for (int j = 0; j < qv->columns && largest > 0; j++)
    for (int e = qv->start[j]; e < qv->start[j + 1]; e++) {
      const int i = qv->row[e];
      const double omega = fabs(p->alpha_q[e] - probe_entry(p, j, i)) / largest;
      p->form[j] = fmax(p->form[j], fabs(p->alpha_q[e]) / largest);
      p->turn[i] = fmax(p->turn[i], omega);
      p->turn[j] = fmax(p->turn[j], omega);
      if (qv->columns <= CANDIDATES_MOST)
        p->two_form[i][j] = p->two_form[j][i] = fmax(p->two_form[i][j], omega);
    }
}

/* Choose `left` more coordinates from number `from` on, such that the two-form vanishes among all
 * of them. Chosen ones have chosen[i] = 1. Return 0 if there is no such choice. */
static int choose_constant(const probe *p, int from, int left, int *chosen)
{
  const int n = p->system->n;
  if (left == 0) return 1;
  for (int i = from; i + left <= n; i++) {
    int meets = 0;
    for (int j = 0; j < i; j++) meets |= chosen[j] && p->two_form[i][j] > negligible;
    if (meets) continue;
    chosen[i] = 1;
    if (choose_constant(p, i + 1, left - 1, chosen)) return 1;
    chosen[i] = 0;
  }
  return 0;
}

static dvi_status refuse_components(const probe *p, int constant, int *chosen)
{
  const int n = p->system->n;
  char name[128] = "", *end = name;
  const char *const needs = "half of the one-form's components must be constant";
  memset(chosen, 0, (size_t)n * sizeof *chosen);
  if (n > CANDIDATES_MOST)
    return dvi__fail(DVI_UNSUPPORTED,
                     "%s, and %d of %d are; look for a gauge alpha + grad f, or take vprk", needs,
                     constant, n);
  if (!choose_constant(p, 0, n / 2, chosen))
    return dvi__fail(DVI_UNSUPPORTED,
                     "%s, and %d of %d are; no gauge helps, as the two-form vanishes among no half "
                     "of the coordinates: take vprk",
                     needs, constant, n);
  for (int i = 0; i < n; i++)
    if (chosen[i])
      end += snprintf(end, (size_t)(name + sizeof name - end), "%sq[%d]", end > name ? ", " : "",
                      i);
  return dvi__fail(DVI_UNSUPPORTED,
                   "%s, and %d of %d are; use the gauge alpha + grad f with df/dq_i = -alpha_i for "
                   "%s, among which the two-form vanishes "
                   "(dvi_gauge), or take vprk",
                   needs, constant, n, name);
}

/* Refuse a row of the two-form that is 0 at all points. */
static dvi_status check_two_form_rows(const probe *p)
{
  for (int i = 0; i < p->system->n && p->seen > 0; i++)
    if (p->turn[i] <= negligible)
      return dvi__fail(DVI_UNSUPPORTED,
                       "the two-form of the one-form is singular at all of %d points probed, "
                       "within 1 and 100 of the origin, for "
                       "q[%d] takes no part in it; no gauge and no other method helps",
                       p->seen, i);
  return DVI_OK;
}

static dvi_status decide_components(probe *p, int *is_x)
{
  const dvi__pattern *qv = &p->system->qv;
  const int n = p->system->n;
  int constant = 0, empty = 0;
  for (int k = 0; k < POINTS; k++) probe_point(p, k);
  DVI_TRY(check_two_form_rows(p));
  for (int i = 0; i < n; i++) {
    const int without = qv->start[i] == qv->start[i + 1];
    is_x[i] = p->seen > 0 ? p->form[i] > negligible : !without;
    empty += without;
    constant += !is_x[i];
  }
  if (2 * constant == n) return DVI_OK;
  if (p->seen == 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "half of the one-form's components must be constant, and it cannot be "
                     "evaluated at any of %d points probed, within 1 and "
                     "100 of the origin; declare the pattern of its gradients, with empty columns "
                     "for them (there are %d)",
                     POINTS, empty);
  return refuse_components(p, constant, is_x);
}

dvi_status dvi__form_constant_components(const dvi_system *system, int *is_x)
{
  const size_t n = (size_t)system->n;
  probe p = {.system = system,
             .q = DVI_NEW(double, n),
             .alpha_q = DVI_NEW(double, (size_t)dvi__pattern_entries(&system->qv) + 1),
             .work = DVI_NEW(double, dvi__longest_hessian(system, 0)),
             .form = DVI_NEW(double, n),
             .turn = DVI_NEW(double, n)};
  dvi_status status = DVI_NO_MEMORY;
  if (p.q && p.alpha_q && p.work && p.form && p.turn)
    status = decide_components(&p, is_x);
  else
    (void)dvi__fail(status, "no memory to look at the one-form");
  dvi__release(p.q);
  dvi__release(p.alpha_q);
  dvi__release(p.work);
  dvi__release(p.form);
  dvi__release(p.turn);
  return status;
}
