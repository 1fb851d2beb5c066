/* The reflection of the momentum at a hit (hits.h). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "integrator/hits_struct.h"

/* Hits of a contact that follow each other within this part of a step accumulate. */
static const double accumulation = 1e-8;

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

/* Return the time at which the hits of a contact accumulate, by the ratio of the last two gaps. */
static double accumulation_time(const dvi__hit_step *made, const double elapsed[3])
{
  const double before = elapsed[1] - elapsed[2], last = elapsed[0] - elapsed[1],
               ratio = before != 0 ? last / before : 0;
  return made->now.t + elapsed[0] + (ratio > 0 && ratio < 1 ? last * ratio / (1 - ratio) : 0);
}

/* Refuse a hit that follows the same contact's last one too soon, or has no room. */
static dvi_status check_rate_of_hits(const dvi_integrator *I, int k)
{
  const struct dvi__hits *s = I->hits;
  const dvi__hit_step *made = &s->made;
  double elapsed[3] = {s->elapsed};
  int found = 1;
  for (int i = made->count - 1; i >= 0 && found < 3; i--)
    if (made->hit[i].contact == k) elapsed[found++] = made->elapsed[i];
  const int soon = found > 1 && fabs(elapsed[0] - elapsed[1]) < accumulation * fabs(made->h);
  if (!soon && made->count < DVI__HITS_MOST) return DVI_OK;
  if (found < 3) elapsed[2] = elapsed[1] = elapsed[0];
  return dvi__fail(
      DVI_UNSUPPORTED,
      "the hits of contact '%s' accumulate (%d in the step) at about t = %.15g, and it "
      "stays closed from there; end before, or take moreau-jean",
      dvi_system_contact_name(I->system, k), made->count, accumulation_time(made, elapsed));
}

/* Refuse another closed contact that closes, too, and whose rate the impulse changes. Which of the
 * two hits comes first would decide about the motion. */
static dvi_status check_corner(dvi_integrator *I, int k)
{
  struct dvi__hits *s = I->hits;
  for (int j = 0; j < I->system->contact_count; j++) {
    dvi__touch before, after;
    if (j == k) continue;
    DVI_TRY(dvi__contact_touch(&I->system->contacts[j], I->now.t, I->now.q, s->v, s->G, &before));
    if (!dvi__touch_is_closed(&before, s->made.h) || dvi__touch_is_grazing(&before) ||
        before.rate * s->made.h > 0)
      continue;
    DVI_TRY(
        dvi__contact_touch(&I->system->contacts[j], I->now.t, I->now.q, s->moved, s->G, &after));
    if (fabs(after.rate - before.rate) <= 1e-9 * before.speed) continue;
    return dvi__fail(DVI_UNSUPPORTED,
                     "contacts '%s' and '%s' close together at t = %.12g, in a corner where the "
                     "order of hits decides; round the corner, or take moreau-jean",
                     dvi_system_contact_name(I->system, k), dvi_system_contact_name(I->system, j),
                     I->now.t);
  }
  return DVI_OK;
}

/* ---- a hit ---- */

/* Add what the impulse supplies to the energy and to the momenta of symmetries. */
static dvi_status supply_impact(dvi_integrator *I)
{
  const struct dvi__hits *s = I->hits;
  for (size_t i = 0; i < I->balances; i++) {
    double before, after;
    DVI_TRY(dvi__invariant(I->evaluator, I->now.t, I->now.q, s->v, I->now.p, (int)i, &before));
    DVI_TRY(dvi__invariant(I->evaluator, I->now.t, I->now.q, s->moved, s->p, (int)i, &after));
    I->now.supplied[i] += after - before;
  }
  return DVI_OK;
}

static void record_hit(dvi_integrator *I, int k, double rate, const impulse *x)
{
  struct dvi__hits *s = I->hits;
  dvi__hit_step *made = &s->made;
  const size_t n = (size_t)I->system->n, at = (size_t)made->count * n, bytes = n * sizeof(double);
  made->hit[made->count] = (dvi_hit){
      .contact = k, .t = I->now.t, .before = rate, .after = x->rate, .impulse = x->lambda};
  made->elapsed[made->count] = s->elapsed;
  memcpy(made->q + at, I->now.q, bytes);
  memcpy(made->v + at, s->v, bytes);
  memcpy(made->after + at, s->moved, bytes);
  made->count++;
}

dvi_status dvi__impact(dvi_integrator *I, int k)
{
  struct dvi__hits *s = I->hits;
  const dvi__contact_term *term = &I->system->contacts[k];
  const dvi__pattern *pattern = &term->gap.gradients;
  const size_t bytes = (size_t)I->system->n * sizeof(double);
  dvi__touch touch;
  impulse x;
  if (s->made.h < 0 && term->callbacks.restitution < 1)
    return dvi__fail(DVI_UNSUPPORTED,
                     "contact '%s' has the restitution %g, and its hits cannot be undone by steps "
                     "back in time; only hits with 1 can",
                     term->gap.name, term->callbacks.restitution);
  DVI_TRY(check_rate_of_hits(I, k));
  DVI_TRY(dvi__integrator_velocity(I, s->v));
  DVI_TRY(dvi__contact_touch(term, I->now.t, I->now.q, s->v, s->G, &touch));
  memset(s->full, 0, bytes);
  for (int e = 0; e < pattern->start[1]; e++) s->full[pattern->row[e]] = s->G[e];
  DVI_TRY(find_impulse(I, term, touch.rate, &x));
  DVI_TRY(check_corner(I, k));
  DVI_TRY(supply_impact(I));
  record_hit(I, k, touch.rate, &x);
  memcpy(I->now.p, s->p, bytes);
  memset(I->now.p_compensation, 0, bytes);
  memcpy(I->last.p, s->moved, bytes);
  dvi__integrator_begin(I, s->moved);
  return DVI_OK;
}
