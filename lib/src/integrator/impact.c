/* The reflection of the momentum at a hit (hits.h). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "integrator/hits_struct.h"

const double dvi__accumulation = 1e-8;

/* Flights that are lower than this number of roundings of the gap accumulate, too. */
static const double lowest = 1e5;

enum { MOST_ITERATIONS = 50 };

/* ---- the impulse ---- */

/* An impulse lambda on the present state: the velocity, rate and energy that belong to it. */
typedef struct impulse {
  double lambda, rate, energy;
} impulse;

/* Evaluate an impulse. The velocity stays in `moved`, the momentum in p. With `energy`
 * the energy is evaluated, too, in the frame of the wall. */
static dvi_status try_impulse(dvi_integrator *I, const dvi__contact_term *term, int energy,
                              impulse *x)
{
  struct dvi__hits *s = I->hits;
  const dvi__pattern *pattern = &term->gap.gradients;
  const size_t n = (size_t)I->system->n;
  double wall;
  DVI_TRY(dvi__holonomic_rate(&term->gap, I->now.t, I->now.q, &wall));
  for (size_t i = 0; i < n; i++) s->p[i] = I->now.p[i] + x->lambda * s->full[i];
  DVI_TRY(dvi__legendre_inverse(I->evaluator, I->now.t, I->now.q, s->p, s->moved));
  x->rate = wall;
  for (int e = 0; e < pattern->start[1]; e++)
    x->rate += s->full[pattern->row[e]] * s->moved[pattern->row[e]];
  if (!energy) return DVI_OK;
  DVI_TRY(dvi__invariant(I->evaluator, I->now.t, I->now.q, s->moved, s->p, 0, &x->energy));
  x->energy += x->lambda * wall;
  return DVI_OK;
}

/* Find the impulse with the rate `wanted` by the secant method, which is exact at once for kinetic
 * energies of second degree. */
static dvi_status search_impulse(dvi_integrator *I, const dvi__contact_term *term, double first,
                                 double wanted, impulse *x)
{
  impulse before = *x;
  x->lambda = first;
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    DVI_TRY(try_impulse(I, term, 0, x));
    if (fabs(x->rate - wanted) <= 4 * DBL_EPSILON * fabs(wanted)) return DVI_OK;
    const double slope = (x->rate - before.rate) / (x->lambda - before.lambda);
    const double change = (wanted - x->rate) / slope;
    if (!isfinite(change)) break;
    if (fabs(change) <= 2 * DBL_EPSILON * fabs(x->lambda)) return DVI_OK;
    before = *x;
    x->lambda += change;
  }
  return fabs(x->rate - wanted) <= 1e-12 * fabs(wanted)
             ? DVI_OK
             : dvi__fail(DVI_SINGULAR, "no impulse of contact '%s' reverses its rate",
                         term->gap.name);
}

/* Correct an elastic impulse until the energy is that before it. For kinetic energies of second
 * degree it is already. */
static dvi_status keep_energy(dvi_integrator *I, const dvi__contact_term *term, impulse *x)
{
  impulse before = {.lambda = 0};
  DVI_TRY(try_impulse(I, term, 1, &before));
  DVI_TRY(try_impulse(I, term, 1, x));
  const double size = fabs(before.energy) + fabs(x->lambda * before.rate);
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    const double error = x->energy - before.energy, change = error / x->rate;
    if (fabs(error) <= 16 * DBL_EPSILON * size || fabs(change) <= DBL_EPSILON * fabs(x->lambda))
      return DVI_OK;
    x->lambda -= change;
    DVI_TRY(try_impulse(I, term, 1, x));
  }
  return DVI_OK;
}

/* With a constant mass the impulse is lambda = -(1 + e) phi' / (G M^-1 G^T). */
static dvi_status find_impulse(dvi_integrator *I, const dvi__contact_term *term, double rate,
                               impulse *x)
{
  struct dvi__hits *s = I->hits;
  const size_t n = (size_t)I->system->n;
  const double e = term->callbacks.restitution;
  double along = 0, momenta = 0, velocities = 0;
  *x = (impulse){.rate = rate};
  memcpy(s->moved, s->v, n * sizeof(double));
  const int constant = (I->system->terms & DVI__CONSTANT_MASS) != 0;
  if (constant) dvi__mass_solve(I->evaluator, 1, s->full, s->dual);
  for (size_t i = 0; i < n; i++) {
    along += s->full[i] * (constant ? s->dual[i] : s->full[i]);
    momenta += I->now.p[i] * I->now.p[i];
    velocities += s->v[i] * s->v[i];
  }
  if (!constant && momenta > 0 && velocities > 0) along *= sqrt(velocities / momenta);
  x->lambda = -(1 + e) * rate / along;
  if (!(along > 0) || !isfinite(x->lambda))
    return dvi__fail(DVI_SINGULAR, "the gradient of contact '%s' is 0, or moves no mass",
                     term->gap.name);
  if (constant) return try_impulse(I, term, 0, x);
  const double first = x->lambda;
  x->lambda = 0;
  DVI_TRY(search_impulse(I, term, first, -e * rate, x));
  return e == 1 ? keep_energy(I, term, x) : DVI_OK;
}

/* ---- what is refused ---- */

/* The flights from hit to hit of a contact. */
typedef struct flights {
  int soon;    /* they are too short, or too low, to be told from rest */
  double last; /* the time of the last one */
} flights;

/* Look if a hit follows the same contact's last one so soon that its hits accumulate. A flight of
 * the time tau, which ends at the rate phi', is |phi'| tau/4 high. Times of hits are wrong by
 * 1/(4 K) of a flight whose height is K roundings of the gap. */
static flights flights_to(const dvi_integrator *I, int k, const dvi__touch *touch)
{
  const struct dvi__hits *s = I->hits;
  const dvi__hit_step *made = &s->made;
  int i = made->count - 1;
  while (i >= 0 && (made->hit[i].contact != k || made->hit[i].kind != DVI_HIT)) i--;
  if (i < 0) return (flights){.soon = 0};
  const double last = fabs(s->elapsed - made->elapsed[i]), height = fabs(touch->rate) * last / 4;
  const int low = dvi_integrator_may_hold(I, k) &&
                  I->system->contacts[k].callbacks.restitution < 1 &&
                  height < lowest * DBL_EPSILON * touch->size;
  return (flights){.soon = low || last < dvi__accumulation * fabs(made->h), .last = last};
}

/* Hold a contact whose hits accumulate, or refuse it, or a hit without room. Flights shrink by e,
 * so that their times are a geometric series. */
static dvi_status settle_or_refuse(dvi_integrator *I, int k, const flights *of)
{
  const dvi__hit_step *made = &I->hits->made;
  const double e = I->system->contacts[k].callbacks.restitution,
               t = I->now.t + (e < 1 && made->h > 0 ? of->last * e / (1 - e) : 0);
  int holds = 0;
  if (of->soon) DVI_TRY(dvi__hold(I, k, fmin(t, made->now.t + made->h), &holds));
  if (holds) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "the hits of contact '%s' accumulate (%d in the step) at about t = %.15g, and "
                   "it stays closed from there; %s",
                   dvi_system_contact_name(I->system, k), made->count, t, dvi__closed_remedy(I, k));
}

/* Refuse another closed contact that closes, too, and whose rate the impulse changes. Which of the
 * two hits comes first would decide about the motion. The impulse may open a contact that is held,
 * but not press it. */
static dvi_status check_corner(dvi_integrator *I, int k, int *opens)
{
  struct dvi__hits *s = I->hits;
  for (int j = 0; j < I->system->contact_count; j++) {
    dvi__touch before, after;
    if (j == k) continue;
    DVI_TRY(dvi__contact_touch(&I->system->contacts[j], I->now.t, I->now.q, s->v, s->G, &before));
    if (j != s->bodies.held && (!dvi__touch_is_closed(&before, s->made.h) ||
                                dvi__touch_is_grazing(&before) || before.rate * s->made.h > 0))
      continue;
    DVI_TRY(
        dvi__contact_touch(&I->system->contacts[j], I->now.t, I->now.q, s->moved, s->G, &after));
    const double change = after.rate - before.rate;
    if (fabs(change) <= 1e-9 * fmax(before.speed, after.speed)) continue;
    *opens = j == s->bodies.held && change > 0;
    if (*opens) continue;
    return dvi__fail(DVI_UNSUPPORTED,
                     "contacts '%s' and '%s' close together at t = %.12g, in a corner where the "
                     "order of hits decides; round the corner, or take moreau-jean",
                     dvi_system_contact_name(I->system, k), dvi_system_contact_name(I->system, j),
                     I->now.t);
  }
  return DVI_OK;
}

/* ---- a hit ---- */

dvi_status dvi__supply_jump(dvi_integrator *I, const double *q, const double *v, const double *p)
{
  for (size_t i = 0; i < I->balances; i++) {
    double before, after;
    DVI_TRY(dvi__invariant(I->evaluator, I->now.t, q, v, p, (int)i, &before));
    DVI_TRY(
        dvi__invariant(I->evaluator, I->now.t, I->now.q, I->hits->moved, I->now.p, (int)i, &after));
    I->now.supplied[i] += after - before;
  }
  return DVI_OK;
}

dvi_status dvi__record(dvi_integrator *I, const dvi_hit *hit, const double *q, const double *v,
                       const double *after)
{
  dvi__hit_step *made = &I->hits->made;
  const size_t n = (size_t)I->system->n, at = (size_t)made->count * n, bytes = n * sizeof(double);
  if (made->count == I->hits->most)
    return dvi__fail(DVI_UNSUPPORTED, "contacts close and open more than %d times in the step",
                     I->hits->most);
  made->hit[made->count] = *hit;
  made->elapsed[made->count] = I->hits->elapsed;
  made->t[made->count] = I->now.t;
  memcpy(made->q + at, q, bytes);
  memcpy(made->v + at, v, bytes);
  memcpy(made->after + at, after, bytes);
  made->count++;
  return DVI_OK;
}

dvi_status dvi__impact(dvi_integrator *I, int k)
{
  struct dvi__hits *s = I->hits;
  const dvi__contact_term *term = &I->system->contacts[k];
  const dvi__pattern *pattern = &term->gap.gradients;
  const size_t bytes = (size_t)I->system->n * sizeof(double);
  dvi__touch touch;
  impulse x;
  int opens = 0, holds;
  if (s->made.h < 0 && term->callbacks.restitution < 1)
    return dvi__fail(DVI_UNSUPPORTED,
                     "contact '%s' has the restitution %g, and its hits cannot be undone by steps "
                     "back in time; only hits with 1 can",
                     term->gap.name, term->callbacks.restitution);
  DVI_TRY(dvi__integrator_velocity(I, s->v));
  DVI_TRY(dvi__contact_touch(term, I->now.t, I->now.q, s->v, s->G, &touch));
  const flights of = flights_to(I, k, &touch);
  if (of.soon || s->made.count == s->most) return settle_or_refuse(I, k, &of);
  memset(s->full, 0, bytes);
  for (int e = 0; e < pattern->start[1]; e++) s->full[pattern->row[e]] = s->G[e];
  DVI_TRY(find_impulse(I, term, touch.rate, &x));
  DVI_TRY(check_corner(I, k, &opens));
  const dvi_hit hit = {
      .contact = k, .t = I->now.t, .before = touch.rate, .after = x.rate, .impulse = x.lambda};
  DVI_TRY(dvi__record(I, &hit, I->now.q, s->v, s->moved));
  memcpy(s->full, I->now.p, bytes);
  memcpy(I->now.p, s->p, bytes);
  DVI_TRY(dvi__supply_jump(I, I->now.q, s->v, s->full));
  I->counters.hits++;
  dvi__integrator_begin_anew(I, s->moved);
  if (opens) DVI_TRY(dvi__let_go(I));
  /* a rate of 0 has roundings of its own, by which the contact would seem to open */
  return term->callbacks.restitution == 0 ? dvi__hold(I, k, I->now.t, &holds) : DVI_OK;
}
