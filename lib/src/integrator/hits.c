#include "integrator/hits.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/hits_struct.h"

/* ---- create, start ---- */

static size_t step_numbers(const dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n;
  return (3 * DVI__HITS_MOST + 1) * n + 2 * dvi__state_numbers(I) + I->stepper.memory_count;
}

static void lay_out_step(const dvi_integrator *I, dvi__hit_step *step, double **at)
{
  const size_t n = (size_t)I->system->n;
  double **const list[] = {&step->q, &step->v, &step->after};
  for (int i = 0; i < 3; i++, *at += DVI__HITS_MOST * n) *list[i] = *at;
  step->start = *at;
  *at += n;
  dvi__state_lay_out(I, &step->now, at);
  dvi__state_lay_out(I, &step->last, at);
  step->memory = *at;
  *at += I->stepper.memory_count;
}

dvi_status dvi__hits_create(dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n, contacts = (size_t)I->system->contact_count;
  if (contacts == 0) return DVI_OK;
  struct dvi__hits *s = I->hits = DVI_NEW(struct dvi__hits, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "integrator: no memory");
  s->divide = !I->stepper.method->takes_contacts;
  double *at = s->numbers = DVI_NEW(double,
                                    9 * n + contacts + (s->divide ? 2 * step_numbers(I) : 0));
  s->touch = s->touches = DVI_NEW(dvi__touch, 2 * contacts);
  s->opens = DVI_NEW(int, contacts);
  if (at == NULL || s->touch == NULL || s->opens == NULL)
    return dvi__fail(DVI_NO_MEMORY, "integrator: no memory for %zu contacts", contacts);
  s->touch_before = s->touch + contacts;
  double **const work[] = {&s->v,    &s->moved, &s->q,       &s->G,    &s->full,
                           &s->dual, &s->p,     &s->v_start, &s->v_end};
  for (int i = 0; i < 9; i++, at += n) *work[i] = at;
  s->offset = at;
  at += contacts;
  if (!s->divide) return DVI_OK;
  lay_out_step(I, &s->kept, &at);
  lay_out_step(I, &s->made, &at);
  return DVI_OK;
}

void dvi__hits_destroy(dvi_integrator *I)
{
  if (I->hits == NULL) return;
  dvi__release(I->hits->numbers);
  dvi__release(I->hits->touches);
  dvi__release(I->hits->opens);
  dvi__release(I->hits);
}

dvi_status dvi__hits_start(dvi_integrator *I, double t, const double *q, const double *v)
{
  struct dvi__hits *s = I->hits;
  if (s == NULL) return DVI_OK;
  DVI_TRY(dvi__touches(I, t, q, v, s->touch));
  for (int k = 0; k < I->system->contact_count; k++)
    if (dvi__contact_is_inside(&s->touch[k]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "the gap of contact '%s' is %.9g at the start; start outside, with a gap of "
                       "0 or more",
                       dvi_system_contact_name(I->system, k), s->touch[k].gap);
  s->kept.count = 0;
  return DVI_OK;
}

int dvi__hits_divide(const dvi_integrator *I)
{
  return I->hits != NULL && I->hits->divide;
}

/* ---- one step ---- */

static void keep_start(dvi_integrator *I, double h)
{
  dvi__hit_step *made = &I->hits->made;
  made->h = h;
  made->count = 0;
  I->hits->elapsed = 0;
  dvi__state_copy(I, &I->now, &made->now);
  dvi__state_copy(I, &I->last, &made->last);
  memcpy(made->memory, I->stepper.memory, I->stepper.memory_count * sizeof(double));
  made->last_h = I->last_h;
}

static void return_to_start(dvi_integrator *I, const dvi__hit_step *step)
{
  dvi__state_copy(I, &step->now, &I->now);
  dvi__state_copy(I, &step->last, &I->last);
  memcpy(I->stepper.memory, step->memory, I->stepper.memory_count * sizeof(double));
  I->last_h = step->last_h;
}

static dvi_status refuse_inside(const dvi_integrator *I, int k)
{
  return dvi__fail(DVI_UNSUPPORTED,
                   "contact '%s' stays closed from t = %.12g, pressed by forces; moreau-jean takes "
                   "contacts that stay closed",
                   dvi_system_contact_name(I->system, k), I->now.t);
}

/* Look at all contacts at the start of a piece. A closed one that goes on closing is hit at once,
 * and its index is returned. */
static dvi_status look_at_start(dvi_integrator *I, int *hit)
{
  struct dvi__hits *s = I->hits;
  const double h = s->made.h;
  *hit = -1;
  DVI_TRY(dvi__integrator_velocity(I, s->v));
  if (s->elapsed == 0 && s->made.count == 0)
    memcpy(s->made.start, s->v, (size_t)I->system->n * sizeof(double));
  DVI_TRY(dvi__touches(I, I->now.t, I->now.q, s->v, s->touch));
  for (int k = 0; k < I->system->contact_count; k++) {
    const dvi__touch *touch = &s->touch[k];
    const int closed = dvi__touch_is_closed(touch, h);
    if (!closed && touch->gap < 0) return refuse_inside(I, k);
    const int grazes = dvi__touch_is_grazing(touch);
    s->offset[k] = closed ? touch->gap : 0;
    s->opens[k] = !closed ? -1 : !grazes;
    if (closed && !grazes && touch->rate * h < 0 && *hit < 0) *hit = k;
  }
  return DVI_OK;
}

/* Return 1 if the rest of the step does not move the time. */
static int is_done(const dvi_integrator *I, double rest)
{
  return rest == 0 || (rest > 0) != (I->hits->made.h > 0) ||
         dvi__check_step(I->now.t, rest) != DVI_OK;
}

/* Take one piece of the step, up to the next hit, or to the end. */
static dvi_status make_piece(dvi_integrator *I, int *done)
{
  struct dvi__hits *s = I->hits;
  double length = s->made.h - s->elapsed;
  dvi__found found;
  int hits;
  DVI_TRY(look_at_start(I, &found.contact));
  if (found.contact >= 0) return dvi__impact(I, found.contact);
  *done = is_done(I, length);
  if (*done) return DVI_OK;
  DVI_TRY(dvi__integrator_smooth_step(I, length));
  DVI_TRY(dvi__find_hit(I, &found));
  *done = found.contact < 0;
  if (*done) return DVI_OK;
  DVI_TRY(dvi__locate_hit(I, &found, &length, &hits));
  s->elapsed += length;
  return hits ? dvi__impact(I, found.contact) : DVI_OK;
}

static dvi_status make_step(dvi_integrator *I)
{
  int done = 0;
  /* pieces without a hit, where gaps nearly close, count, too */
  for (int piece = 0; !done && piece < 4 * DVI__HITS_MOST; piece++) DVI_TRY(make_piece(I, &done));
  return done ? DVI_OK
              : dvi__fail(DVI_NOT_CONVERGED, "contacts nearly close too often within the step");
}

dvi_status dvi__hits_step(dvi_integrator *I, double h)
{
  struct dvi__hits *s = I->hits;
  const long steps = I->counters.steps, failed = I->counters.failed_steps;
  keep_start(I, h);
  const dvi_status status = make_step(I);
  I->counters.hits += s->made.count;
  if (status != DVI_OK) {
    return_to_start(I, &s->made);
    I->counters.steps = steps;
    I->counters.failed_steps = failed + 1;
    return dvi__fail_in(status,
                        "%s: step %ld from t = %.9g with h = %.3g failed; the state is "
                        "unchanged",
                        I->stepper.method->name, steps + 1, I->now.t, h);
  }
  I->counters.steps = steps + 1;
  const dvi__hit_step before = s->kept;
  s->kept = s->made;
  s->made = before;
  return DVI_OK;
}

void dvi__hits_take_back(dvi_integrator *I)
{
  return_to_start(I, &I->hits->kept);
  I->hits->kept.count = 0;
  I->counters.steps--;
}

/* ---- queries ---- */

int dvi_integrator_hit_count(const dvi_integrator *I)
{
  return I != NULL && I->hits != NULL ? I->hits->kept.count : 0;
}

dvi_hit dvi_integrator_hit(const dvi_integrator *I, int i)
{
  if (i < 0 || i >= dvi_integrator_hit_count(I)) return (dvi_hit){.contact = -1};
  return I->hits->kept.hit[i];
}

dvi_status dvi_integrator_gap(dvi_integrator *I, double *gap, int *contact)
{
  int least = 0;
  if (I == NULL || gap == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "gap: an argument is NULL");
  if (I->hits == NULL) return dvi__fail(DVI_UNSUPPORTED, "gap: the system declares no contacts");
  if (!I->started)
    return dvi__fail(DVI_BAD_STATE,
                     "gap: the integrator has no state yet; call dvi_integrator_start first");
  for (int k = 0; k < I->system->contact_count; k++) {
    double phi;
    DVI_TRY(dvi__holonomic_value(&I->system->contacts[k].gap, I->now.t, I->now.q, &phi));
    if (k == 0 || phi < *gap) *gap = phi, least = k;
  }
  if (contact != NULL) *contact = least;
  return DVI_OK;
}

double dvi__hits_length(const dvi_integrator *I)
{
  return I->hits->kept.h;
}

double dvi__hits_first_time(const dvi_integrator *I)
{
  return I->hits->kept.now.t;
}

int dvi__hits_before(const dvi_integrator *I, double t)
{
  const int count = dvi_integrator_hit_count(I);
  if (count == 0) return 0;
  /* a hit at the step's end leaves no path behind it */
  return I->last_h == 0 || (t - I->hits->kept.hit[count - 1].t) * I->hits->kept.h <= 0;
}

/* Hermite's cubic from the hit, or the start, before t to the hit at or behind it. */
dvi_status dvi__hits_path(const dvi_integrator *I, double t, double *q, double *v)
{
  const dvi__hit_step *step = &I->hits->kept;
  const size_t n = (size_t)I->system->n;
  int i = 0;
  while (i < step->count - 1 && (t - step->hit[i].t) * step->h > 0) i++;
  const double from = i > 0 ? step->hit[i - 1].t : step->now.t, h = step->hit[i].t - from;
  const dvi__cubic cubic = {h, i > 0 ? step->q + (size_t)(i - 1) * n : step->now.q,
                            i > 0 ? step->after + (size_t)(i - 1) * n : step->start,
                            step->q + (size_t)i * n, step->v + (size_t)i * n};
  dvi__cubic_point((int)n, &cubic, h != 0 ? fmin(1, (t - from) / h) : 1, q, v);
  return DVI_OK;
}
