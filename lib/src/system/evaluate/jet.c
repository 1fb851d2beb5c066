#include "system/evaluate/jet.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/term/term.h"

struct dvi__jet {
  const dvi_system *system;
  dvi_counters *counters, own;
  double *term; /* one potential's V, V_q and V_qq, before they are added to the others' */
};

/* ---- one term ---- */

int dvi__potential_has_taylor(const dvi__potential_term *p)
{
  return p->callbacks.taylor != NULL;
}

int dvi__general_has_taylor(const dvi__lagrangian_term *l)
{
  return l->computed == NULL && l->callbacks.taylor != NULL;
}

/* Every coefficient that was asked for must be finite. */
static dvi_status check_series(const char *name, const char *what, int degree, int entries,
                               const double *series)
{
  const ptrdiff_t bad = series != NULL
                            ? dvi__first_not_finite((size_t)(degree + 1) * (size_t)entries, series)
                            : -1;
  if (bad < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE,
                   "%s: the taylor callback gave %g for coefficient %td of %s (entry %td)", name,
                   series[bad], bad / entries, what, bad % entries);
}

dvi_status dvi__potential_taylor(const dvi__potential_term *p, int n, int degree, const double *t,
                                 const double *q, double *V, double *V_q, double *V_qq)
{
  const int returned = p->callbacks.taylor(degree, t, q, V, V_q, V_qq, p->callbacks.user);
  DVI_TRY(dvi__verdict(returned, 0, 0, NULL, p->name, "taylor", ""));
  DVI_TRY(check_series(p->name, "V", degree, 1, V));
  DVI_TRY(check_series(p->name, "V_q", degree, n, V_q));
  return V_qq == NULL ? DVI_OK
                      : check_series(p->name, "V_qq", degree, dvi__pattern_entries(&p->qq), V_qq);
}

dvi_status dvi__general_taylor(const dvi__lagrangian_term *l, int n, int degree, const double *t,
                               const double *q, const double *v, const dvi__jets *wanted)
{
  const dvi__jets *w = wanted;
  const int returned = l->callbacks.taylor(degree, t, q, v, w->L, w->L_q, w->L_v, w->L_qq, w->L_qv,
                                           w->L_vv, l->callbacks.user);
  DVI_TRY(dvi__verdict(returned, 0, 0, NULL, l->name, "taylor", ""));
  DVI_TRY(check_series(l->name, "L", degree, 1, w->L));
  DVI_TRY(check_series(l->name, "L_q", degree, n, w->L_q));
  DVI_TRY(check_series(l->name, "L_v", degree, n, w->L_v));
  DVI_TRY(check_series(l->name, "L_qq", degree, dvi__pattern_entries(&l->qq), w->L_qq));
  DVI_TRY(check_series(l->name, "L_qv", degree, dvi__pattern_entries(&l->qv), w->L_qv));
  return check_series(l->name, "L_vv", degree, dvi__pattern_entries(&l->vv), w->L_vv);
}

/* ---- creation ---- */

dvi_status dvi__jet_create(const dvi_system *system, int degree, dvi__derivatives most,
                           dvi_counters *counters, dvi__jet **jet)
{
  *jet = NULL;
  DVI_TRY(dvi__system_has_taylor(system));
  if (most == DVI__HESSIANS) DVI_TRY(dvi__system_prepare_hessian(system));
  dvi__jet *made = DVI_NEW(dvi__jet, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "Taylor coefficients: no memory");
  const size_t longest = 1 + (size_t)system->n +
                         (size_t)dvi__longest_hessian(system, most == DVI__HESSIANS);
  made->system = system;
  made->counters = counters != NULL ? counters : &made->own;
  made->term = DVI_NEW(double, ((size_t)degree + 1) * longest);
  if (made->term == NULL) {
    dvi__jet_destroy(&made);
    return dvi__fail(DVI_NO_MEMORY, "Taylor coefficients: no memory for degree %d in %d dimensions",
                     degree, system->n);
  }
  *jet = made;
  return DVI_OK;
}

void dvi__jet_destroy(dvi__jet **jet)
{
  if (*jet == NULL) return;
  dvi__release((*jet)->term);
  dvi__release(*jet);
  *jet = NULL;
}

/* ---- v.Mv/2 ---- */

/* Return M as entries of the pattern vv, whatever its form. */
static const double *mass_entries(const dvi_system *s)
{
  return s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
}

static void add_momentum(const dvi_system *s, const double *v, double *p)
{
  for (int j = 0; j < s->vv.columns; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++)
      p[s->vv.row[e]] += mass_entries(s)[e] * v[j];
}

/* Compute v.Mw/2. */
static double half_product(const dvi_system *s, const double *v, const double *w)
{
  double sum = 0;
  for (int j = 0; j < s->vv.columns; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++)
      sum += mass_entries(s)[e] * v[s->vv.row[e]] * w[j];
  return 0.5 * sum;
}

static void kinetic_series(const dvi_system *s, int degree, const double *v,
                           const dvi__jets *wanted)
{
  const size_t n = (size_t)s->n, coefficients = (size_t)degree + 1,
               entries = (size_t)dvi__pattern_entries(&s->vv);
  if (wanted->L_v != NULL) memset(wanted->L_v, 0, coefficients * n * sizeof(double));
  if (wanted->L_q != NULL) memset(wanted->L_q, 0, coefficients * n * sizeof(double));
  if (wanted->L_vv != NULL) memset(wanted->L_vv, 0, coefficients * entries * sizeof(double));
  if (wanted->L_vv != NULL) memcpy(wanted->L_vv, mass_entries(s), entries * sizeof(double));
  for (size_t k = 0; k < coefficients; k++) {
    if (wanted->L_v != NULL) add_momentum(s, v + k * n, wanted->L_v + k * n);
    if (wanted->L == NULL) continue;
    wanted->L[k] = 0;
    for (size_t j = 0; j <= k; j++) wanted->L[k] += half_product(s, v + j * n, v + (k - j) * n);
  }
}

/* ---- the sum ---- */

static void subtract_series(size_t count, const double *from, double *sum)
{
  for (size_t i = 0; i < count; i++) sum[i] -= from[i];
}

/* Add the values of a term's Hessian at their places in the whole. */
static void embed_series(int degree, const dvi__pattern *part, const int *where,
                         const dvi__pattern *whole, double sign, const double *values, double *sum)
{
  const size_t entries = (size_t)dvi__pattern_entries(part),
               all = (size_t)dvi__pattern_entries(whole);
  for (size_t k = 0; k <= (size_t)degree; k++)
    for (size_t e = 0; e < entries; e++)
      sum[k * all + (size_t)where[e]] += sign * values[k * entries + e];
}

static dvi_status subtract_potential(dvi__jet *jet, const dvi__potential_term *p, int degree,
                                     const double *t, const double *q, const dvi__jets *wanted)
{
  const dvi_system *s = jet->system;
  const size_t coefficients = (size_t)degree + 1, n = (size_t)s->n;
  double *const V = jet->term, *const V_q = V + coefficients, *const V_qq = V_q + coefficients * n;
  DVI_TRY(dvi__potential_taylor(p, s->n, degree, t, q, wanted->L != NULL ? V : NULL,
                                wanted->L_q != NULL ? V_q : NULL,
                                wanted->L_qq != NULL ? V_qq : NULL));
  if (wanted->L != NULL) subtract_series(coefficients, V, wanted->L);
  if (wanted->L_q != NULL) subtract_series(coefficients * n, V_q, wanted->L_q);
  if (wanted->L_qq != NULL) embed_series(degree, &p->qq, p->in_qq, &s->qq, -1, V_qq, wanted->L_qq);
  return DVI_OK;
}

/* Evaluate the general Lagrangian. Its L_qq goes by the work array to its places. */
static dvi_status general_series(dvi__jet *jet, int degree, const double *t, const double *q,
                                 const double *v, const dvi__jets *wanted)
{
  const dvi_system *s = jet->system;
  dvi__jets own = *wanted;
  if (own.L_qq != NULL) own.L_qq = jet->term;
  DVI_TRY(dvi__general_taylor(s->lagrangian, s->n, degree, t, q, v, &own));
  if (wanted->L_qq != NULL)
    embed_series(degree, &s->lagrangian->qq, s->lagrangian->in_qq, &s->qq, 1, jet->term,
                 wanted->L_qq);
  return DVI_OK;
}

dvi_status dvi__jet_along(dvi__jet *jet, int degree, const double *t, const double *q,
                          const double *v, const dvi__jets *wanted)
{
  const dvi_system *s = jet->system;
  const long coefficients = degree + 1;
  if (wanted->L != NULL) jet->counters->values += coefficients;
  if (wanted->L_q != NULL || (s->lagrangian != NULL && wanted->L_v != NULL))
    jet->counters->gradients += coefficients;
  if (wanted->L_qq != NULL) jet->counters->hessians += coefficients;
  if (wanted->L_qq != NULL)
    memset(wanted->L_qq, 0,
           (size_t)coefficients * (size_t)dvi__pattern_entries(&s->qq) * sizeof(double));
  if (s->lagrangian != NULL)
    DVI_TRY(general_series(jet, degree, t, q, v, wanted));
  else
    kinetic_series(s, degree, v, wanted);
  for (int p = 0; p < s->potential_count; p++)
    DVI_TRY(subtract_potential(jet, &s->potentials[p], degree, t, q, wanted));
  return DVI_OK;
}
