/* The steps of the faces.
 *
 * An edge gives an equal part of its M1 to each of its faces. A face with these parts alone has the
 * frequency sqrt(lambda_f), and the largest of them is not below the largest frequency of all:
 *
 *     lambda_f = M2_f sum over free e in f of n_e/M1_e,     h_f = fraction 2/sqrt(lambda_f).
 *
 * With classes the steps are h 2^j, h the shortest of the h_f, and j as large as h 2^j <= h_f
 * allows. All steps then have a common period, that of the longest one. Steps of their own have
 * resonances at any fraction, which are only slow (Fong, Darve and Lew 2008). */
#include "field/avi/plan.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/avi/engine.h"
#include "march/kind.h"

static const double negligible = 1e-14, rounding = 1e-12;

void dvi__avi_plan_clear(dvi__avi_plan *plan)
{
  dvi__release(plan->sharing);
  dvi__release(plan->strongest);
  dvi__release(plan->bound);
  dvi__release(plan->step);
  dvi__release(plan->face_class);
  *plan = (dvi__avi_plan){0};
}

static int is_free(const dvi__avi_terms *terms, int e)
{
  return terms->is_fixed == NULL || !terms->is_fixed[e];
}

/* ---- which faces have events ---- */

static void find_strongest(const dvi__avi_terms *terms, dvi__avi_plan *plan)
{
  for (int64_t f = 0; f < terms->faces; f++)
    for (int c = 0; c < terms->width; c++) {
      double *strongest = plan->strongest + terms->facet[f * terms->width + c];
      *strongest = fmax(*strongest, fabs(terms->M2[f]));
    }
}

/* A face does nothing if its edges are fixed, or if its M2 is but a rounding beside that of others
 * at each of its edges. */
static int has_events(const dvi__avi_terms *terms, const dvi__avi_plan *plan, int64_t f)
{
  double least = INFINITY;
  for (int c = 0; c < terms->width; c++) {
    const int e = terms->facet[f * terms->width + c];
    if (is_free(terms, e)) least = fmin(least, plan->strongest[e]);
  }
  return isfinite(least) && fabs(terms->M2[f]) > negligible * least;
}

static dvi_status find_events(const dvi__avi_terms *terms, dvi__avi_plan *plan)
{
  find_strongest(terms, plan);
  for (int64_t f = 0; f < terms->faces; f++) {
    plan->bound[f] = plan->step[f] = INFINITY;
    if (!has_events(terms, plan, f)) continue;
    if (!(terms->M2[f] > 0))
      return dvi__fail(DVI_SINGULAR,
                       "avi: the star has the entry %g at %s, so that no step is stable; repair "
                       "the mesh",
                       terms->M2[f], dvi__avi_name(terms, 1, f).text);
    plan->bound[f] = 0;
    for (int c = 0; c < terms->width; c++) plan->sharing[terms->facet[f * terms->width + c]]++;
  }
  for (int64_t e = 0; e < terms->edges; e++)
    if (is_free(terms, (int)e) && plan->sharing[e] == 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "avi: %s belongs to no cell of the next degree with an entry of the star "
                       "above zero, so that nothing moves it; use leapfrog",
                       dvi__avi_name(terms, 0, e).text);
  return DVI_OK;
}

/* ---- bounds ---- */

static double frequency_squared(const dvi__avi_terms *terms, const dvi__avi_plan *plan, int64_t f)
{
  double sum = 0;
  for (int c = 0; c < terms->width; c++) {
    const int e = terms->facet[f * terms->width + c];
    if (is_free(terms, e)) sum += plan->sharing[e] / terms->M1[e];
  }
  return terms->M2[f] * sum;
}

static dvi_status find_bounds(const dvi__avi_terms *terms, dvi__avi_plan *plan)
{
  plan->tightest = INFINITY;
  for (int64_t f = 0; f < terms->faces; f++) {
    if (isinf(plan->bound[f])) continue;
    plan->bound[f] = 2 / sqrt(frequency_squared(terms, plan, f));
    if (!(plan->bound[f] > 0) || isinf(plan->bound[f]))
      return dvi__fail(DVI_NOT_FINITE, "avi: the longest stable step of %s is %g",
                       dvi__avi_name(terms, 1, f).text, plan->bound[f]);
    if (plan->bound[f] < plan->tightest) plan->tightest_face = f;
    plan->tightest = fmin(plan->tightest, plan->bound[f]);
  }
  if (isfinite(plan->tightest)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "avi: no cell is free, so that nothing moves");
}

/* ---- steps ---- */

static dvi_status find_fraction(const dvi__avi_terms *terms, const dvi__avi_plan *plan,
                                double *fraction)
{
  *fraction = terms->fraction > 0 ? terms->fraction : 0.5;
  if (terms->shortest > 0) *fraction = terms->shortest / plan->tightest;
  if (*fraction < 1) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "avi: steps of %g times their bounds are not stable; the least bound is %.9g, of "
      "%s, take a shorter step",
      *fraction, plan->tightest, dvi__avi_name(terms, 1, plan->tightest_face).text);
}

static void choose_classes(const dvi__avi_terms *terms, double fraction, dvi__avi_plan *plan)
{
  plan->shortest = dvi__fit_step(fraction * plan->tightest, terms->span);
  for (int64_t f = 0; f < terms->faces; f++) {
    if (isinf(plan->bound[f])) continue;
    const double ratio = fraction * plan->bound[f] / plan->shortest * (1 + rounding);
    const int j = ilogb(fmin(fmax(ratio, 1), ldexp(1, DVI__AVI_CLASSES - 1)));
    plan->face_class[f] = j;
    plan->step[f] = ldexp(plan->shortest, j);
    if (j >= plan->classes) plan->classes = j + 1;
  }
}

static void choose_free(const dvi__avi_terms *terms, double fraction, dvi__avi_plan *plan)
{
  for (int64_t f = 0; f < terms->faces; f++)
    if (isfinite(plan->bound[f]))
      plan->step[f] = dvi__fit_step(fraction * plan->bound[f], terms->span);
}

static dvi_status take_steps(const dvi__avi_terms *terms, dvi__avi_plan *plan)
{
  for (int64_t f = 0; f < terms->faces; f++) {
    if (isinf(plan->bound[f])) continue;
    if (!(terms->step[f] > 0) || isinf(terms->step[f]))
      return dvi__fail(DVI_BAD_ARGUMENT, "avi: %s has a step of %g",
                       dvi__avi_name(terms, 1, f).text, terms->step[f]);
    plan->step[f] = terms->step[f];
  }
  return DVI_OK;
}

static dvi_status choose(const dvi__avi_terms *terms, dvi__avi_plan *plan)
{
  double fraction;
  plan->classes = 1;
  if (terms->step != NULL) {
    DVI_TRY(take_steps(terms, plan));
  } else {
    DVI_TRY(find_fraction(terms, plan, &fraction));
    (terms->is_free ? choose_free : choose_classes)(terms, fraction, plan);
  }
  plan->shortest = INFINITY;
  for (int64_t f = 0; f < terms->faces; f++) {
    plan->shortest = fmin(plan->shortest, plan->step[f]);
    if (isfinite(plan->step[f])) plan->longest = fmax(plan->longest, plan->step[f]);
  }
  return DVI_OK;
}

dvi_status dvi__avi_plan_make(const dvi__avi_terms *terms, dvi__avi_plan *plan)
{
  *plan = (dvi__avi_plan){.sharing = DVI_NEW(int, terms->edges),
                          .strongest = DVI_NEW(double, terms->edges),
                          .bound = DVI_NEW(double, terms->faces),
                          .step = DVI_NEW(double, terms->faces),
                          .face_class = DVI_NEW(int, terms->faces)};
  if (!plan->sharing || !plan->strongest || !plan->bound || !plan->step || !plan->face_class) {
    dvi__avi_plan_clear(plan);
    return dvi__fail(DVI_NO_MEMORY, "avi: no memory for the steps of %lld cells",
                     (long long)terms->faces);
  }
  dvi_status status = find_events(terms, plan);
  if (status == DVI_OK) status = find_bounds(terms, plan);
  if (status == DVI_OK) status = choose(terms, plan);
  if (status != DVI_OK) dvi__avi_plan_clear(plan);
  return status;
}
