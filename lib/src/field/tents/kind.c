/* The kind of march that advances by tents, and its place in files. */
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/step/alarm.h"
#include "field/step/observables.h"
#include "field/step/source.h"
#include "field/tents/front.h"
#include "field/tents/options.h"
#include "march/kind.h"

static const char section_name[] = "tents";
static const double usual_band = 2;
enum { SECTION_VERSION = 2, RISES_BETWEEN_CHECKS = 64 };

/* What the alarm knows of a run. */
typedef struct watch {
  double t0, start, force; /* the time and the energies of the start */
  double interval;         /* between two looks at the energy */
  double supply;           /* the largest that the force was seen to give or take */
  double allowed;          /* the band, doubled after each alarm */
  int64_t checks;
} watch;

typedef struct march {
  const dvi_field *field;
  dvi__tents *tents;
  double band;
  watch watch;
} march;

/* What a section begins with: what identifies the march, and where it stands. */
typedef struct place {
  int64_t vertices, values;
  uint64_t hash;
  int64_t tents;
  double t;
  watch watch;
} place;

/* ---- motion ---- */

/* A tent is at most as high as the ends of its edges may be apart. */
static void facts(const void *self, dvi_march_facts *facts)
{
  const dvi__tents *w = ((const march *)self)->tents;
  const dvi_mesh *mesh = w->mesh;
  facts->step = (double)INFINITY;
  for (int64_t e = 0; e < mesh->count[1]; e++) {
    facts->step = fmin(facts->step, w->reach[e]);
    facts->longest = fmax(facts->longest, w->reach[e]);
  }
  facts->bound = facts->step / w->fraction;
  facts->steps = w->front.tents;
  for (int64_t i = 0; i < mesh->count[w->k + 1] * (w->k + 2); i++)
    facts->updates += w->front.rises[mesh->corner[w->k + 1][i]];
}

static void destroy(void *self)
{
  march *m = self;
  dvi__tents_destroy(&m->tents);
  dvi__release(m);
}

/* Tents are never known to be stable, and slow to show that they are not. So the energy is looked
 * at once in 64 of the highest tents, at times that do not depend on how the way is cut. The energy
 * of a force is apart, so that a start at rest has a measure, too. */
static dvi_status split_energy(const march *m, double *field, double *force)
{
  DVI_TRY(dvi__tents_energy(m->tents, field));
  *force = dvi__tents_force_energy(m->tents);
  *field -= *force;
  return DVI_OK;
}

static dvi_status begin_watch(march *m)
{
  dvi_march_facts known = {0};
  facts(m, &known);
  watch first = {
      .t0 = m->tents->t, .interval = RISES_BETWEEN_CHECKS * known.longest, .allowed = m->band};
  DVI_TRY(split_energy(m, &first.start, &first.force));
  m->watch = first;
  if (isfinite(first.start)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "tents: the energy of the start is not finite");
}

static dvi_status compare_energy(march *m)
{
  static const dvi__alarm_words words = {
      .method = "tents",
      .reference = "the start",
      .remedy = "the tents are in resonance; take a smaller fraction, or leapfrog",
      .last = "a smaller fraction"};
  watch *seen = &m->watch;
  double field, force;
  DVI_TRY(split_energy(m, &field, &force));
  seen->supply = fmax(seen->supply, fabs(force - seen->force));
  const double reference = seen->start + seen->supply,
               growth = reference > 0 ? field / reference : 1;
  const dvi_status status = dvi__judge_growth(&words, m->tents->t, field, growth, &seen->allowed);
  if (status != DVI_NOT_FINITE) seen->checks++;
  return status;
}

static dvi_status start(void *self, const dvi_march_state *state)
{
  march *m = self;
  const dvi_field *f = m->field;
  double *A = dvi__duplicate(f->fixed, (size_t)f->cells, sizeof *A);
  if (A == NULL) return dvi__fail(DVI_NO_MEMORY, "tents: no memory for a start");
  for (int64_t i = 0; i < f->unknowns && state->A != NULL; i++)
    A[f->unknown[i]] = state->A[f->unknown[i]];
  dvi_march_state whole = *state;
  whole.A = A;
  dvi__tents_start(m->tents, &whole);
  dvi__release(A);
  return begin_watch(m);
}

static dvi_status advance(void *self, double t)
{
  march *m = self;
  for (;;) {
    const double check = m->watch.t0 + (double)(m->watch.checks + 1) * m->watch.interval;
    if (!(check <= t)) return dvi__tents_advance(m->tents, t);
    DVI_TRY(dvi__tents_advance(m->tents, check));
    DVI_TRY(compare_energy(m));
  }
}

static double time_of(const void *self)
{
  return ((const march *)self)->tents->t;
}

/* ---- observations ---- */

static int64_t size_of(const void *self, dvi_march_form form)
{
  const dvi__tents *w = ((const march *)self)->tents;
  return w->mesh->count[form == DVI_FORM_B ? w->k + 1 : w->k];
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  return dvi__tents_sample(((const march *)self)->tents, form, count, cell, values);
}

static int observables(const void *self)
{
  return dvi__field_observables(((const march *)self)->field);
}

static const char *observable(const void *self, int i)
{
  return dvi__field_observable(((const march *)self)->field, i);
}

static dvi_status energy(const void *self, double *value)
{
  return dvi__tents_energy(((const march *)self)->tents, value);
}

static dvi_status charge_error(const void *self, double *value)
{
  *value = dvi__tents_charge_error(((const march *)self)->tents);
  return DVI_OK;
}

static dvi_status observe(const void *self, int i, double *value)
{
  const dvi__observed observed = {
      .sample = sample, .energy = energy, .charge_error = charge_error, .of = self};
  return dvi__field_observe(((const march *)self)->field, &observed, i, value);
}

/* ---- files ---- */

/* The arrays of a state, and the bytes of each. */
typedef struct arrays {
  int count;
  void *at[6];
  size_t bytes[6];
} arrays;

static arrays arrays_of(const dvi__tents *w)
{
  const dvi_mesh *mesh = w->mesh;
  const size_t number = sizeof(double), vertices = (size_t)mesh->count[0] * number,
               values = (size_t)mesh->count[w->k] * number;
  return (arrays){
      .count = w->k > 0 ? 6 : 5,
      .at = {w->front.time, w->front.rises, w->front.A, w->front.row, w->base, w->charge},
      .bytes = {vertices, vertices, values, values, (size_t)mesh->count[w->k + 1] * number,
                w->k > 0 ? (size_t)mesh->count[w->k - 1] * number : 0}};
}

static place place_of(const march *m)
{
  const dvi__tents *w = m->tents;
  const dvi_mesh *mesh = w->mesh;
  const size_t cells = (size_t)mesh->count[mesh->n];
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof w->fraction, &w->fraction);
  hash = dvi__hash(hash, sizeof w->least, &w->least);
  hash = dvi__hash(hash, sizeof w->seed, &w->seed);
  hash = dvi__hash(hash, (size_t)mesh->count[w->k], w->held);
  hash = dvi__hash(hash, (size_t)mesh->count[1] * sizeof *w->reach, w->reach);
  hash = dvi__hash(hash, cells * sizeof *w->speed, w->speed);
  hash = dvi__hash(hash, cells * sizeof *w->weight, w->weight);
  if (w->force != NULL)
    hash = dvi__hash(hash, (size_t)mesh->count[w->k] * sizeof *w->force, w->force);
  return (place){.vertices = mesh->count[0],
                 .values = mesh->count[w->k],
                 .hash = hash,
                 .tents = w->front.tents,
                 .t = w->t,
                 .watch = m->watch};
}

static dvi_status save(const void *self, dvi__sections_writer *writer)
{
  const march *m = self;
  const dvi__tents *w = m->tents;
  const place here = place_of(m);
  const arrays all = arrays_of(w);
  dvi__section_open(writer, section_name, SECTION_VERSION);
  dvi__section_put(writer, &here, sizeof here);
  for (int i = 0; i < all.count; i++) dvi__section_put(writer, all.at[i], all.bytes[i]);
  return DVI_OK;
}

static dvi_status load(void *self, const dvi__sections *sections)
{
  march *m = self;
  dvi__tents *w = m->tents;
  const place here = place_of(m);
  const arrays all = arrays_of(w);
  dvi__section section;
  place there = here;
  size_t size = sizeof there;
  for (int i = 0; i < all.count; i++) size += all.bytes[i];
  DVI_TRY(dvi__section_find(sections, section_name, SECTION_VERSION, DVI__ANY_SIZE, &section));
  if (section.size >= sizeof there) memcpy(&there, section.content, sizeof there);
  if (section.size != size || there.vertices != here.vertices || there.values != here.values ||
      there.hash != here.hash)
    return dvi__fail(DVI_BAD_FILE,
                     "%s: of tents on another mesh, or of other materials, walls or options",
                     sections->name);
  const unsigned char *from = section.content + sizeof there;
  for (int i = 0; i < all.count; from += all.bytes[i++]) memcpy(all.at[i], from, all.bytes[i]);
  w->front.tents = there.tents;
  w->t = there.t;
  m->watch = there.watch;
  *w->level_time = (double)NAN;
  dvi__front_order(w, &w->front);
  return DVI_OK;
}

static const dvi__march_kind kind = {.name = section_name,
                                     .destroy = destroy,
                                     .start = start,
                                     .advance = advance,
                                     .time = time_of,
                                     .size = size_of,
                                     .sample = sample,
                                     .observables = observables,
                                     .observable = observable,
                                     .observe = observe,
                                     .facts = facts,
                                     .save = save,
                                     .load = load};

/* ---- create ---- */

static dvi_status check_field(const dvi_field *f)
{
  const char *what = f->currents > 0       ? "currents"
                     : f->damping.rows > 0 ? "conductors or absorbing walls"
                                           : NULL;
  if (what == NULL) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "tents: the field has %s: take leapfrog or avi", what);
}

static dvi_status make(march *m, const dvi_field *f, const dvi__tents_options *options)
{
  double *source = NULL, *force = NULL;
  int8_t *held = DVI_NEW(int8_t, f->cells);
  m->field = f;
  m->band = options->band > 0 ? options->band : usual_band;
  dvi_status status = dvi__wave_source(f, &source);
  if (status == DVI_OK && source != NULL) force = DVI_NEW(double, f->cells);
  if (status == DVI_OK && (!held || (source && !force)))
    status = dvi__fail(DVI_NO_MEMORY, "tents: no memory for %lld cells", (long long)f->cells);
  if (status == DVI_OK) {
    for (int64_t c = 0; c < f->cells; c++) held[c] = f->number[c] < 0;
    for (int64_t i = 0; i < f->unknowns && force != NULL; i++) force[f->unknown[i]] = source[i];
    const dvi__tents_terms terms = {.star = f->star, .k = f->degree, .held = held, .force = force};
    status = dvi__tents_create(&terms, options, &m->tents);
  }
  dvi__release(source);
  dvi__release(force);
  dvi__release(held);
  return status;
}

/* Make the tents of a plan. What is made is the caller's on failure, too. */
static dvi_status prepare(const dvi_field *field, const dvi__march_plan *plan, march *m)
{
  dvi__tents_options options = {.fraction = plan->fraction};
  if (plan->step > 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "tents: they have no common step, as %g would be: give a fraction",
                     plan->step);
  DVI_TRY(dvi__tents_read_options(plan->options, &options));
  DVI_TRY(check_field(field));
  return make(m, field, &options);
}

dvi_status dvi__tents_march(const dvi_field *field, const dvi__march_plan *plan, dvi_march **result)
{
  march *m = DVI_NEW(march, 1);
  *result = NULL;
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "tents: no memory");
  const dvi_status status = prepare(field, plan, m);
  if (status == DVI_OK) return dvi__march_wrap(&kind, m, result);
  destroy(m);
  return status;
}

dvi_status dvi__tents_march_stability(const dvi_field *field, const dvi__march_plan *plan,
                                      double span, dvi_stability *report)
{
  march m = {.field = field};
  dvi_status status = prepare(field, plan, &m);
  if (status == DVI_OK) status = dvi__tents_stability(m.tents, span, report);
  dvi__tents_destroy(&m.tents);
  return status;
}
