/* Marches of solids (field/elastic_avi/engine.h has the discrete action and its source). */
#include "field/elastic_avi/march.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic_avi/plan.h"
#include "field/mesh/share.h"
#include "field/step/bound.h"
#include "field/step/classes.h"
#include "march/kind.h"

/* ---- what is asked for ---- */

static dvi_status find_method(const dvi__march_plan *plan, const char *text,
                              dvi__solid_request *request)
{
  const size_t length = strcspn(text, ":");
  const char *rest = text[length] == ':' ? text + length + 1 : "";
  if (length == 6 && strncmp(text, "verlet", length) == 0) {
    dvi__march_plan named = *plan;
    named.options = rest;
    request->is_equal = 1;
    return dvi__refuse_options("verlet", &named);
  }
  if (length == 3 && strncmp(text, "avi", length) == 0)
    return dvi__read_classes(rest, &request->is_free, &request->band);
  return dvi__fail(DVI_BAD_OPTION,
                   "march: there is no method \"%.*s\" for solids; there are avi and verlet",
                   (int)length, text);
}

dvi_status dvi__solid_ask(const dvi_elastic *solid, const dvi_march_options *options,
                          dvi__solid_request *request)
{
  const dvi_march_options defaults = {.size = sizeof defaults};
  dvi__march_plan plan;
  if (solid == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "march: a solid is needed");
  if (options == NULL) options = &defaults;
  DVI_TRY(dvi__plan_march(options, &plan));
  *request = (dvi__solid_request){
      .step = plan.step, .fraction = plan.fraction, .span = plan.span, .threads = plan.threads};
  return find_method(&plan, options->method != NULL ? options->method : "avi", request);
}

/* ---- motion ---- */

static void destroy(void *self)
{
  dvi__solid_avi *avi = self;
  dvi__solid_avi_destroy(&avi);
}

/* E = -u' */
static dvi_status start(void *self, const dvi_march_state *state)
{
  dvi__solid_avi *avi = self;
  const int64_t size = avi->vertices * avi->n;
  double *rate = state->E != NULL ? DVI_NEW(double, size) : NULL;
  dvi_status status = DVI_OK;
  if (state->E != NULL && rate == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "%s: no memory for a start", avi->method);
  for (int64_t i = 0; i < size && rate != NULL; i++) rate[i] = -state->E[i];
  status = dvi__agree(avi->solid->mesh, status);
  if (status == DVI_OK) status = dvi__solid_avi_start(avi, state->t, state->A, rate);
  dvi__release(rate);
  return status;
}

static dvi_status advance(void *self, double t)
{
  return dvi__solid_avi_advance(self, t);
}

static double time(const void *self)
{
  return ((const dvi__solid_avi *)self)->clock.t;
}

/* ---- what can be seen ---- */

static int64_t size(const void *self, dvi_march_form form)
{
  const dvi__solid_avi *avi = self;
  return form == DVI_FORM_B ? 0 : avi->vertices * avi->n;
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  const dvi__solid_avi *avi = self;
  if (form == DVI_FORM_A) return dvi__solid_avi_sample(avi, count, cell, values, NULL);
  DVI_TRY(dvi__solid_avi_sample(avi, count, cell, NULL, values));
  if (cell == NULL) count = avi->vertices * avi->n;
  for (int64_t i = 0; i < count; i++) values[i] = -values[i];
  return DVI_OK;
}

enum { ENERGY, KINETIC, STORED, LOAD, GROWTH, HITS, MOMENTA };

/* The observables of a solid in their order: energies, momenta, turns, growth and hits. */
static int what_of(const dvi__solid_avi *avi, int i)
{
  const int momenta = avi->n == 3 ? 6 : 3;
  if (i <= LOAD) return i;
  if (i <= LOAD + momenta) return MOMENTA + i - LOAD - 1;
  return i == LOAD + momenta + 1 ? GROWTH : HITS;
}

static int observables(const void *self)
{
  const dvi__solid_avi *avi = self;
  return LOAD + 1 + (avi->n == 3 ? 6 : 3) + 1 + (avi->solid->obstacles > 0);
}

static const char *observable(const void *self, int i)
{
  static const char *const name[] = {"energy", "kinetic", "stored", "load", "growth", "hits"};
  static const char *const in_plane[] = {"momentum_x", "momentum_y", "angular"};
  static const char *const in_space[] = {"momentum_x", "momentum_y", "momentum_z",
                                         "angular_x",  "angular_y",  "angular_z"};
  const dvi__solid_avi *avi = self;
  const int what = what_of(avi, i);
  if (what < MOMENTA) return name[what];
  return (avi->n == 3 ? in_space : in_plane)[what - MOMENTA];
}

static dvi_status observe(const void *self, int i, double *value)
{
  const dvi__solid_avi *avi = self;
  const int what = what_of(avi, i);
  DVI_TRY(dvi__solid_avi_look(avi));
  const dvi_elastic_energies *e = &avi->view->energies;
  const double energies[] = {e->kinetic + e->stored + e->load,
                             e->kinetic,
                             e->stored,
                             e->load,
                             avi->view->growth,
                             avi->view->hits};
  double size;
  if (what > HITS) return dvi__solid_momentum(avi, what - MOMENTA, value, &size);
  *value = energies[what];
  return DVI_OK;
}

static void facts(const void *self, dvi_march_facts *facts)
{
  const dvi__solid_avi *avi = self;
  facts->step = avi->shortest;
  facts->longest = avi->longest;
  facts->bound = avi->bound;
  facts->steps = avi->is_equal ? avi->clock.slot : avi->clock.events;
  facts->updates = avi->clock.events;
}

static dvi_status save(const void *self, dvi__sections_writer *writer)
{
  return dvi__solid_avi_save(self, writer);
}

static dvi_status load(void *self, const dvi__sections *sections)
{
  return dvi__solid_avi_load(self, sections);
}

/* ---- processes ---- */

static dvi_status agree(const void *self, dvi_status status)
{
  return dvi__agree(((const dvi__solid_avi *)self)->solid->mesh, status);
}

static int writes(const void *self)
{
  return dvi__is_first(((const dvi__solid_avi *)self)->solid->mesh);
}

static int is_lost(const void *self)
{
  return ((const dvi__solid_avi *)self)->is_lost;
}

/* What needs values of other processes' nodes within a slot is refused on shares. */
static dvi_status check_share(const dvi_elastic *e, const dvi__solid_request *request)
{
  int is_viscous = 0;
  for (int i = 0; i < e->material_count; i++) is_viscous |= e->materials[i].beta > 0;
  if (is_viscous) DVI_TRY(dvi__refuse_share(e->mesh, "march: a damping beta"));
  if (request->is_free && e->mesh->share != NULL &&
      (e->mesh->share->ranks.send == NULL || e->mesh->share->ranks.receive == NULL))
    return dvi__fail(DVI_UNSUPPORTED, "march: processes that share avi:classes=no need send and "
                                      "receive of dvi_ranks");
  return request->is_free && request->threads > 1
             ? dvi__refuse_share_but(e->mesh, "march: avi:classes=no on several threads",
                                     "one thread, avi")
             : DVI_OK;
}

/* ---- create ---- */

#define KIND(called)                                                                      \
  {                                                                                       \
    .name = called, .destroy = destroy, .start = start, .advance = advance, .time = time, \
    .size = size, .sample = sample, .observables = observables, .observable = observable, \
    .observe = observe, .facts = facts, .save = save, .load = load, .agree = agree,       \
    .writes = writes, .is_lost = is_lost, .has_parts = 1,                                 \
  }

static const dvi__march_kind kind_avi = KIND("avi"), kind_verlet = KIND("verlet");

dvi_status dvi_elastic_march_create(const dvi_elastic *elastic, const dvi_march_options *options,
                                    dvi_march **march)
{
  dvi__solid_request request;
  dvi__solid_avi *avi;
  if (march == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "march: a place for the march is needed");
  *march = NULL;
  DVI_TRY(dvi__solid_ask(elastic, options, &request));
  DVI_TRY(check_share(elastic, &request));
  DVI_TRY(dvi__solid_avi_create(elastic, &request, &avi));
  const dvi_status status = dvi__agree(
      elastic->mesh, dvi__march_wrap(request.is_equal ? &kind_verlet : &kind_avi, avi, march));
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}
