/* The search for the first zero of a gap in a step, and for the length of the step that ends
 * there. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "integrator/hits_struct.h"

/* Paths are searched in this many parts, and in each part at the point where the gap is least. */
enum { PARTS = 4, MOST_ITERATIONS = 60 };

const double dvi__grazing = 1e-7;

/* Part of a step by which the time of a hit may be wrong where the step's equations are solved to a
 * few digits less than all. */
static const double inexact = 1e-10;

/* The size of a gap's roundings, at a state that was located on its zero by a step of h. */
static double roundings(const dvi__touch *touch, double h)
{
  return 64 * DBL_EPSILON * (touch->size + touch->speed * fabs(h));
}

int dvi__touch_is_closed(const dvi__touch *touch, double h)
{
  const double rounding = roundings(touch, h);
  return touch->gap <= rounding && touch->gap >= -rounding - dvi__grazing * touch->speed * fabs(h);
}

int dvi__touch_is_grazing(const dvi__touch *touch)
{
  return fabs(touch->rate) <= dvi__grazing * touch->speed;
}

dvi_status dvi__touches(dvi_integrator *I, double t, const double *q, const double *v,
                        dvi__touch *touch)
{
  for (int k = 0; k < I->system->contact_count; k++)
    DVI_TRY(dvi__contact_touch(&I->system->contacts[k], t, q, v, I->hits->G, &touch[k]));
  return DVI_OK;
}

/* ---- on the path of a step ---- */

/* Evaluate the path of the last smooth step. Hermite's cubic is closer than the paths of methods of
 * order 4 or less. */
dvi_status dvi__searched_path(dvi_integrator *I, double tau, double *q, double *v)
{
  const struct dvi__hits *s = I->hits;
  if (I->stepper.order > 4) return dvi__integrator_path(I, tau, q, v);
  const dvi__cubic cubic = {I->last_h, I->last.q, s->v_start, I->now.q, s->v_end};
  dvi__cubic_point(I->system->n, &cubic, tau, q, v);
  return DVI_OK;
}

/* Evaluate contact k at tau, less its offset at the start. */
static dvi_status touch_on_path(dvi_integrator *I, int k, double tau, dvi__touch *touch)
{
  struct dvi__hits *s = I->hits;
  DVI_TRY(dvi__searched_path(I, tau, s->q, s->moved));
  DVI_TRY(dvi__contact_touch(&I->system->contacts[k], I->last.t + tau * I->last_h, s->q, s->moved,
                             s->G, touch));
  touch->gap -= s->offset[k];
  return DVI_OK;
}

/* Find the least gap between a and b, where the rate changes its sign, or a negative gap. */
static dvi_status find_least(dvi_integrator *I, int k, double a, double b, double *least,
                             dvi__touch *touch)
{
  for (int i = 0; i < 30; i++) {
    *least = 0.5 * (a + b);
    DVI_TRY(touch_on_path(I, k, *least, touch));
    if (touch->gap < 0) return DVI_OK;
    if (touch->rate * I->last_h < 0)
      a = *least;
    else
      b = *least;
  }
  return DVI_OK;
}

/* Find a zero between a, behind which the gap is positive, and b, where it is negative. */
static dvi_status bisect_path(dvi_integrator *I, int k, double a, double b, dvi__found *found)
{
  dvi__touch touch;
  for (int i = 0; i < 40; i++) {
    const double middle = 0.5 * (a + b);
    DVI_TRY(touch_on_path(I, k, middle, &touch));
    if (touch.gap < 0)
      b = middle;
    else
      a = middle;
  }
  if (found->contact >= 0 && found->tau <= b) return DVI_OK;
  *found = (dvi__found){.contact = k, .tau = b};
  return DVI_OK;
}

/* Search contact k between a and b, where it was evaluated. */
static dvi_status search_part(dvi_integrator *I, int k, double a, double b, dvi__found *found)
{
  struct dvi__hits *s = I->hits;
  const dvi__touch *here = &s->touch_before[k], *there = &s->touch[k];
  dvi__touch touch;
  double least;
  if (s->opens[k] == DVI__IS_HELD) return DVI_OK;
  if (s->opens[k] == 0) { /* neither open nor closed so far */
    const double h = I->last_h, part = roundings(there, h) + dvi__grazing * there->speed * fabs(h);
    if (there->gap < -part) return dvi__refuse_closed(I, k, I->last.t);
    if (there->gap > part) s->opens[k] = -1;
    return DVI_OK;
  }
  if (there->gap < 0) return bisect_path(I, k, a, b, found);
  if (here->rate * I->last_h >= 0 || there->rate * I->last_h <= 0) return DVI_OK;
  DVI_TRY(find_least(I, k, a, b, &least, &touch));
  if (touch.gap >= 0) return DVI_OK;
  DVI_TRY(bisect_path(I, k, a, least, found));
  found->dips = found->contact == k;
  return DVI_OK;
}

dvi_status dvi__find_hit(dvi_integrator *I, dvi__found *found)
{
  struct dvi__hits *s = I->hits;
  *found = (dvi__found){.contact = -1};
  memcpy(s->v_start, s->v, (size_t)I->system->n * sizeof(double));
  DVI_TRY(dvi__integrator_velocity(I, s->v_end));
  for (int part = 0; part < PARTS && found->contact < 0; part++) {
    const double a = part / (double)PARTS, b = (part + 1) / (double)PARTS;
    dvi__touch *before = s->touch_before;
    s->touch_before = s->touch;
    s->touch = before;
    DVI_TRY(dvi__searched_path(I, b, s->q, s->moved));
    DVI_TRY(dvi__touches(I, I->last.t + b * I->last_h, s->q, s->moved, s->touch));
    for (int k = 0; k < I->system->contact_count; k++) {
      s->touch[k].gap -= s->offset[k];
      DVI_TRY(search_part(I, k, a, b, found));
    }
  }
  return DVI_OK;
}

/* ---- the length of the step ---- */

/* Return 1 if the gap is 0 up to roundings of the state. */
static int is_located(const dvi__touch *touch, double length)
{
  return fabs(touch->gap) <= 4 * DBL_EPSILON * (touch->size + touch->speed * fabs(length));
}

/* The next fraction, by Newton's method, within the bounds. */
static double next_fraction(const dvi__touch *touch, double tau, double length, double a, double b)
{
  const double next = tau - touch->gap / (touch->rate * length);
  return next > a && next < b ? next : 0.5 * (a + b);
}

dvi_status dvi__locate_hit(dvi_integrator *I, const dvi__found *found, double *length, int *hits)
{
  struct dvi__hits *s = I->hits;
  const double whole = *length;
  double tau = found->tau, a = 0, b = 1;
  dvi__touch touch;
  for (int i = 0;; i++) {
    const double before = tau;
    dvi__integrator_smooth_back(I);
    *length = tau * whole;
    if (dvi__check_step(I->now.t, *length) != DVI_OK) {
      *length = 0;
      *hits = 1;
      return DVI_OK;
    }
    DVI_TRY(dvi__integrator_smooth_step(I, *length));
    DVI_TRY(dvi__integrator_velocity(I, s->v));
    DVI_TRY(dvi__contact_touch(&I->system->contacts[found->contact], I->now.t, I->now.q, s->v, s->G,
                               &touch));
    /* behind the zero the gap is negative, or opens again after a dip */
    if (touch.gap > 0 && !(found->dips && touch.rate * whole >= 0))
      a = tau;
    else
      b = tau;
    tau = next_fraction(&touch, tau, whole, a, b);
    if (is_located(&touch, *length) || fabs(tau - before) <= DBL_EPSILON * before ||
        i == MOST_ITERATIONS)
      break;
  }
  *hits = touch.rate * whole < 0 && !dvi__touch_is_grazing(&touch);
  if (*hits && fabs(touch.gap) > inexact * (touch.size + touch.speed * fabs(whole)))
    return dvi__fail(DVI_NOT_CONVERGED, "the time of a hit of contact '%s' was not found",
                     dvi_system_contact_name(I->system, found->contact));
  if (!*hits && touch.gap < 0 && !dvi__touch_is_closed(&touch, whole))
    return dvi__refuse_closed(I, found->contact, I->last.t);
  return DVI_OK;
}
