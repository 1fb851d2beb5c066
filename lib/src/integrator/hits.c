#include "integrator/hits.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/hits_struct.h"

/* ---- create, start ---- */

/* Flights between hits shrink by the restitution e, from a part (1 - e)/e of a step in which they
 * end, to the part below which hits accumulate. */
static int most_hits(const dvi_system *system)
{
  double most = DVI__HITS_LEAST;
  for (int k = 0; k < system->contact_count; k++) {
    const double e = system->contacts[k].callbacks.restitution;
    if (!system->contacts[k].callbacks.hold || e == 0 || e == 1) continue;
    const double flights = log((1 - e) / e / dvi__accumulation) / -log(e);
    most = fmax(most, DVI__HITS_LEAST + flights);
  }
  return (int)fmin(DVI__HITS_MOST, most);
}

static size_t step_numbers(const dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n, most = (size_t)I->hits->most;
  return (3 * most + 1) * n + 2 * most + 2 * dvi__state_numbers(I) + dvi__bodies_memory(I);
}

static void lay_out_step(const dvi_integrator *I, dvi__hit_step *step, double **at)
{
  const size_t n = (size_t)I->system->n, most = (size_t)I->hits->most;
  double **const list[] = {&step->q, &step->v, &step->after};
  for (int i = 0; i < 3; i++, *at += most * n) *list[i] = *at;
  step->elapsed = *at;
  step->t = *at + most;
  step->start = *at + 2 * most;
  *at += 2 * most + n;
  dvi__state_lay_out(I, &step->now, at);
  dvi__state_lay_out(I, &step->last, at);
  step->memory = *at;
  *at += dvi__bodies_memory(I);
}

static dvi_status allocate_contacts(dvi_integrator *I)
{
  struct dvi__hits *s = I->hits;
  const size_t n = (size_t)I->system->n, contacts = (size_t)I->system->contact_count;
  double *at = s->numbers = DVI_NEW(double,
                                    9 * n + contacts + (s->divide ? 2 * step_numbers(I) : 0));
  s->touch = s->touches = DVI_NEW(dvi__touch, 2 * contacts);
  s->opens = DVI_NEW(int, contacts);
  s->records = DVI_NEW(dvi_hit, 2 * (size_t)s->most);
  if (at == NULL || s->touch == NULL || s->opens == NULL || s->records == NULL)
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
  s->kept.hit = s->records;
  s->made.hit = s->records + s->most;
  return DVI_OK;
}

dvi_status dvi__hits_create(dvi_integrator *I)
{
  if (I->system->contact_count == 0) return DVI_OK;
  struct dvi__hits *s = I->hits = DVI_NEW(struct dvi__hits, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "integrator: no memory");
  s->divide = !I->stepper.method->takes_contacts;
  s->most = s->divide ? most_hits(I->system) : 0;
  s->bodies.held = s->let_go = -1;
  if (s->divide) DVI_TRY(dvi__bodies_create(I));
  return allocate_contacts(I);
}

void dvi__hits_destroy(dvi_integrator *I)
{
  if (I->hits == NULL) return;
  dvi__bodies_destroy(I);
  dvi__release(I->hits->numbers);
  dvi__release(I->hits->touches);
  dvi__release(I->hits->opens);
  dvi__release(I->hits->records);
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
  dvi__hits_forget(I);
  return DVI_OK;
}

void dvi__hits_forget(dvi_integrator *I)
{
  if (I->hits != NULL) I->hits->kept.count = 0;
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
  made->held = dvi__bodies_held(I);
  I->hits->elapsed = 0;
  I->hits->let_go = -1;
  dvi__state_copy(I, &I->now, &made->now);
  dvi__state_copy(I, &I->last, &made->last);
  memcpy(made->memory, I->stepper.memory, I->stepper.memory_count * sizeof(double));
  made->last_h = I->last_h;
}

static void return_to_start(dvi_integrator *I, const dvi__hit_step *step)
{
  dvi__bodies_choose(I, step->held);
  dvi__state_copy(I, &step->now, &I->now);
  dvi__state_copy(I, &step->last, &I->last);
  memcpy(I->stepper.memory, step->memory, I->stepper.memory_count * sizeof(double));
  I->last_h = step->last_h;
}

const char *dvi__closed_remedy(const dvi_integrator *I, int k)
{
  const int held = dvi__bodies_held(I);
  if (held >= 0 && held != k)
    return "another contact is held already, and one is at a time; take moreau-jean";
  return I->system->contacts[k].callbacks.hold
             ? "it cannot be held there; take moreau-jean"
             : "declare it with `hold`, end before, or take moreau-jean";
}

dvi_status dvi__refuse_closed(const dvi_integrator *I, int k, double t)
{
  return dvi__fail(DVI_UNSUPPORTED,
                   "contact '%s' stays closed from t = %.12g, pressed by forces; %s",
                   dvi_system_contact_name(I->system, k), t, dvi__closed_remedy(I, k));
}

/* Look at the contact that is held. It is released if its force pulls. */
static dvi_status look_at_held(dvi_integrator *I, double *N, int *changes)
{
  struct dvi__hits *s = I->hits;
  const int k = s->bodies.held;
  s->offset[k] = s->touch[k].gap;
  s->opens[k] = DVI__IS_HELD;
  if (s->made.h < 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "contact '%s' is held closed, and steps back in time cannot tell since when",
                     dvi_system_contact_name(I->system, k));
  DVI_TRY(dvi__held_force(I, I->now.t, I->now.q, s->v, N, NULL));
  *changes = *N < 0;
  return *changes ? dvi__let_go(I) : DVI_OK;
}

/* Look at contact k at the start of a piece. */
static dvi_status look_at_contact(dvi_integrator *I, int k, int *hit, int *changes)
{
  struct dvi__hits *s = I->hits;
  const double h = s->made.h;
  const dvi__touch *touch = &s->touch[k];
  const int closed = dvi__touch_is_closed(touch, h), grazes = dvi__touch_is_grazing(touch);
  if (!closed && touch->gap < 0) return dvi__refuse_closed(I, k, I->now.t);
  s->offset[k] = closed ? touch->gap : 0;
  s->opens[k] = !closed ? -1 : !grazes;
  if (closed && !grazes && touch->rate * h < 0 && *hit < 0) *hit = k;
  return closed && grazes ? dvi__hold(I, k, I->now.t, changes) : DVI_OK;
}

/* Look at all contacts at the start of a piece. A closed one that goes on closing is hit at once,
 * and its index is returned. *changes is 1 if a contact is held or released there. *N is the force
 * of the one that is held. */
static dvi_status look_at_start(dvi_integrator *I, int *hit, double *N, int *changes)
{
  struct dvi__hits *s = I->hits;
  *hit = -1;
  *changes = 0;
  DVI_TRY(dvi__integrator_velocity(I, s->v));
  if (s->elapsed == 0 && s->made.count == 0)
    memcpy(s->made.start, s->v, (size_t)I->system->n * sizeof(double));
  DVI_TRY(dvi__touches(I, I->now.t, I->now.q, s->v, s->touch));
  if (s->bodies.held >= 0) DVI_TRY(look_at_held(I, N, changes));
  for (int k = 0; k < I->system->contact_count && !*changes; k++)
    if (k != s->bodies.held) DVI_TRY(look_at_contact(I, k, hit, changes));
  return DVI_OK;
}

/* Return 1 if the rest of the step does not move the time. */
static int is_done(const dvi_integrator *I, double rest)
{
  return rest == 0 || (rest > 0) != (I->hits->made.h > 0) ||
         dvi__check_step(I->now.t, rest) != DVI_OK;
}

/* Take the held piece up to its release, if that comes before the hit that was found. */
static dvi_status end_hold(dvi_integrator *I, double N, double length, dvi__found *found, int *ends)
{
  double tau;
  *ends = 0;
  if (I->hits->bodies.held < 0) return DVI_OK;
  DVI_TRY(dvi__find_release(I, N, &tau));
  *ends = tau <= (found->contact >= 0 ? found->tau : 1);
  if (!*ends) return DVI_OK;
  DVI_TRY(dvi__locate_release(I, tau, &length));
  I->hits->elapsed += length;
  return dvi__let_go(I);
}

/* Take one piece of the step, up to the next hit, or to the end. */
static dvi_status make_piece(dvi_integrator *I, int *done)
{
  struct dvi__hits *s = I->hits;
  double length = s->made.h - s->elapsed, N = 0;
  dvi__found found;
  int hits, changes;
  DVI_TRY(look_at_start(I, &found.contact, &N, &changes));
  if (changes) return DVI_OK;
  if (found.contact >= 0) return dvi__impact(I, found.contact);
  *done = is_done(I, length);
  if (*done) return DVI_OK;
  DVI_TRY(dvi__integrator_smooth_step(I, length));
  DVI_TRY(dvi__find_hit(I, &found));
  s->let_go = -1;
  DVI_TRY(end_hold(I, N, length, &found, &changes));
  if (changes) return DVI_OK;
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
  for (int piece = 0; !done && piece < 4 * I->hits->most; piece++) DVI_TRY(make_piece(I, &done));
  return done ? DVI_OK
              : dvi__fail(DVI_NOT_CONVERGED, "contacts nearly close too often within the step");
}

dvi_status dvi__hits_step(dvi_integrator *I, double h)
{
  struct dvi__hits *s = I->hits;
  const long steps = I->counters.steps, failed = I->counters.failed_steps;
  keep_start(I, h);
  const dvi_status status = make_step(I);
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

int dvi_integrator_held(const dvi_integrator *I)
{
  return I != NULL ? dvi__bodies_held(I) : -1;
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
  return I->last_h == 0 || (t - I->hits->kept.t[count - 1]) * I->hits->kept.h <= 0;
}

/* Hermite's cubic from the hit, or the start, before t to the hit at or behind it. */
dvi_status dvi__hits_path(const dvi_integrator *I, double t, double *q, double *v)
{
  const dvi__hit_step *step = &I->hits->kept;
  const size_t n = (size_t)I->system->n;
  int i = 0;
  while (i < step->count - 1 && (t - step->t[i]) * step->h > 0) i++;
  const double from = i > 0 ? step->t[i - 1] : step->now.t, h = step->t[i] - from;
  const dvi__cubic cubic = {h, i > 0 ? step->q + (size_t)(i - 1) * n : step->now.q,
                            i > 0 ? step->after + (size_t)(i - 1) * n : step->start,
                            step->q + (size_t)i * n, step->v + (size_t)i * n};
  dvi__cubic_point((int)n, &cubic, h != 0 ? fmin(1, (t - from) / h) : 1, q, v);
  return DVI_OK;
}
