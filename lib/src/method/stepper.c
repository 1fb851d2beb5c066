/* Make a stepper. The specification is parsed, and the method must be able to use every term that
 * the system declares. */
#include <dvi/method.h>
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/damping.h"
#include "system/declare/held.h"
#include "system/term_name.h"

/* Return the terms that the system declares and the method cannot use. */
static unsigned surplus(const dvi__method *method, const dvi_system *system)
{
  return system->terms & ((~method->uses & ~(unsigned)DVI__KINDS) | method->refuses);
}

static int can_use(const dvi__method *method, const dvi_system *system)
{
  return surplus(method, system) == 0 && (method->needs & ~system->terms) == 0;
}

/* Test if a stepper's method can hold contacts that may be held, of which one stands for all. */
static int can_hold(const dvi__stepper *stepper)
{
  const dvi_system *system = stepper->system, *held;
  dvi_counters counters = {0};
  dvi__stepper tried;
  int k = 0;
  while (k < system->contact_count && !system->contacts[k].callbacks.hold) k++;
  if (k == system->contact_count || stepper->method->takes_contacts) return 1;
  if (dvi__held_create(system, k, &held) != DVI_OK) return 0;
  const dvi_status status = dvi__stepper_create(held, stepper->specification, NULL, &counters,
                                                &tried);
  if (status == DVI_OK) dvi__stepper_destroy(&tried);
  dvi__held_destroy(&held);
  return status == DVI_OK;
}

/* Test if a method can be made for the system. Some methods take terms one by one that they refuse
 * together. A method that needs keys passes. */
static int fits(const char *name, const dvi_system *system)
{
  dvi_counters counters = {0};
  dvi__stepper tried;
  if (!can_use(dvi__find_method(name, strlen(name)), system)) return 0;
  const dvi_status status = dvi__stepper_create(system, name, NULL, &counters, &tried);
  if (status != DVI_OK) return status == DVI_BAD_OPTION;
  const int good = can_hold(&tried);
  dvi__stepper_destroy(&tried);
  return good;
}

/* Write which methods take the system, or that none does. Steppers that are made for this, and
 * those inside of them, do not try others in turn. */
static void name_others(const dvi_system *system, dvi__text *words)
{
  static _Thread_local int trying;
  const char *before = "methods for this system: ";
  if (trying) return;
  trying = 1;
  for (int i = 0; i < dvi_method_count(); i++) {
    const char *name = dvi_method_name(i);
    if (!fits(name, system->held_of != NULL ? system->held_of : system)) continue;
    dvi__text_add(words, "%s%s", before, name);
    before = ", ";
  }
  trying = 0;
  if (words->length == 0) dvi__text_add(words, "no method takes all that it declares");
}

/* Write the kinds of dynamics that the method takes. */
static void name_dynamics(const dvi__method *method, dvi__text *names)
{
  for (unsigned term = 1; term <= DVI__LAST_TERM; term <<= 1)
    if (method->uses & term & DVI__DYNAMICS)
      dvi__text_add(names, "%s%s", names->length > 0 ? " or " : "", dvi__term_name(term));
}

static dvi_status refuse_canonical(const dvi__method *method, const char *others)
{
  char dynamics[DVI__SENTENCE_SIZE] = "";
  name_dynamics(method, &(dvi__text){dynamics, sizeof dynamics, 0});
  return dvi__fail(DVI_UNSUPPORTED, "%s: the system declares %s, and this method needs %s; %s",
                   method->name, dvi__term_name(DVI__HAMILTONIAN), dynamics, others);
}

static dvi_status stepper_check_terms(const dvi__method *method, const dvi_system *system)
{
  char names[DVI__SENTENCE_SIZE] = "";
  if (can_use(method, system)) return DVI_OK;
  name_others(system, &(dvi__text){names, sizeof names, 0});
  if (surplus(method, system) & DVI__HAMILTONIAN) return refuse_canonical(method, names);
  for (unsigned term = 1; term <= DVI__LAST_TERM; term <<= 1)
    if (surplus(method, system) & term)
      return dvi__fail(DVI_UNSUPPORTED,
                       "%s: the system declares %s, which this method cannot use; %s", method->name,
                       dvi__term_name(term), names);
  for (unsigned term = 1; term <= DVI__LAST_TERM; term <<= 1)
    if (method->needs & term & ~system->terms)
      return dvi__fail(DVI_UNSUPPORTED,
                       "%s: the method needs %s, which the system does not declare; %s",
                       method->name, dvi__term_name(term), names);
  return DVI_OK;
}

static dvi_status check_shapes(const dvi__method *method, const dvi_shapes *shapes)
{
  if (shapes == NULL || method->takes_shapes) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION,
                   "%s: its space is its own, and not the shapes %s; %s-galerkin takes them, and a "
                   "composition of it",
                   method->name, shapes->name, shapes->flow != NULL ? "flow" : "shaped");
}

static dvi_status spell_out(dvi__stepper *stepper)
{
  char *steps = dvi__spell_steps(stepper->method, &stepper->settings);
  stepper->specification = dvi__spell_out(stepper->method, &stepper->settings);
  if (steps != NULL) stepper->steps = dvi__hash(DVI__HASH_START, strlen(steps), steps);
  const int spelled = steps != NULL && stepper->specification != NULL;
  dvi__release(steps);
  return spelled ? DVI_OK
                 : dvi__fail(DVI_NO_MEMORY, "%s: no memory for its specification",
                             stepper->method->name);
}

static dvi_status stepper_choose_method(dvi__stepper *stepper, const char *specification)
{
  DVI_TRY(dvi__parse(specification, &stepper->method, &stepper->settings));
  DVI_TRY(stepper_check_terms(stepper->method, stepper->system));
  return check_shapes(stepper->method, stepper->shapes);
}

/* Name the method that refuses a potential without a Hessian, unless the sentence does so. */
static dvi_status refuse_by_name(const dvi__stepper *stepper, dvi_status status)
{
  const char *name = stepper->method->name;
  const int named = strncmp(dvi_last_error(), name, strlen(name)) == 0;
  if (status != DVI_UNSUPPORTED || named || dvi__system_without_hessian(stepper->system) == NULL)
    return status;
  return dvi__fail_in(status, "%s", name);
}

static dvi_status stepper_create_method(dvi__stepper *stepper)
{
  const dvi_status status = stepper->method->create(stepper);
  if (status != DVI_OK) return refuse_by_name(stepper, status);
  DVI_TRY(dvi__damping_create(stepper));
  return spell_out(stepper);
}

dvi_status dvi__stepper_create(const dvi_system *system, const char *specification,
                               const dvi_shapes *shapes, dvi_counters *counters,
                               dvi__stepper *stepper)
{
  *stepper = (dvi__stepper){
      .system = system, .shapes = shapes, .counters = counters, .fingerprinted = "contents"};
  dvi_status status = stepper_choose_method(stepper, specification);
  if (status != DVI_OK)
    stepper->method = NULL; /* the method has nothing to destroy yet */
  else
    status = stepper_create_method(stepper);
  if (status != DVI_OK) dvi__stepper_destroy(stepper);
  return status;
}

dvi_status dvi__stepper_create_inner(dvi__stepper *self, const char *method,
                                     const dvi_system *system, const dvi_shapes *shapes,
                                     dvi__stepper *inner)
{
  char **rest = &self->settings.rest;
  char *specification = dvi__written("%s%s%s", method, *rest != NULL ? ":" : "",
                                     *rest != NULL ? *rest : "");
  if (specification == NULL)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory for its specification", method);
  const dvi_status status = dvi__stepper_create(system, specification, shapes, self->counters,
                                                inner);
  dvi__release(specification);
  if (status != DVI_OK) return status;
  self->late_hessians |= inner->late_hessians;
  const char *keys = strchr(inner->specification, ':');
  dvi__release(*rest);
  *rest = keys != NULL ? dvi__written("%s", keys + 1) : NULL;
  return keys == NULL || *rest != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "%s: no memory for its specification", method);
}

dvi_status dvi__stepper_check_step(const dvi__stepper *stepper, double h)
{
  const double fastest = stepper->stable > 0 ? dvi__system_fastest(stepper->system) : 0;
  if (fabs(h) * fastest <= stepper->stable) return DVI_OK;
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "%s is unstable with h = %.9g: the system's frequencies reach %.9g, and h may be "
      "%.9g at most; take shorter steps, or %s",
      stepper->method->name, h, fastest, stepper->stable / fastest,
      (stepper->system->terms & DVI__ONE_FORM) != 0
          ? "vprk, which has no such bound"
          : "an implicit method such as imex or galerkin");
}

void dvi__stepper_start(dvi__stepper *stepper, const double *v)
{
  if (stepper->method->start != NULL) stepper->method->start(stepper, v);
}

dvi_status dvi__inner_step(dvi__stepper *self, dvi__stepper *inner, dvi__state *state, double h)
{
  inner->follow = self->follow;
  inner->doubt = DVI__SURE;
  inner->bend = inner->worked = 0;
  inner->work = NULL;
  inner->asks_work = 1;
  const dvi_status status = dvi__take_step(inner, state, h);
  if (inner->doubt > self->doubt) self->doubt = inner->doubt;
  self->bend = fmax(self->bend, inner->bend);
  self->worked += inner->work != NULL ? *inner->work : (double)NAN;
  self->work = isnan(self->worked) ? NULL : &self->worked;
  return status;
}

void dvi__trail_add(dvi__trail *trail, const dvi__state *state)
{
  const size_t row = (size_t)trail->rows++, nq = (size_t)trail->nq, nv = (size_t)trail->nv;
  trail->wait = trail->every;
  trail->t[row] = state->t;
  if (trail->q != NULL) memcpy(trail->q + row * nq, state->q, nq * sizeof(double));
  if (trail->p != NULL) memcpy(trail->p + row * nv, state->p, nv * sizeof(double));
}

dvi_status dvi__stepper_prepare_lanes(dvi__stepper *stepper, int capacity)
{
  if (stepper->method->prepare_lanes == NULL) return DVI_OK;
  return stepper->method->prepare_lanes(stepper, capacity);
}

void dvi__stepper_destroy(dvi__stepper *stepper)
{
  if (stepper->method != NULL && stepper->lanes != NULL) stepper->method->clear_lanes(stepper);
  if (stepper->method != NULL) stepper->method->destroy(stepper);
  dvi__damping_destroy(stepper);
  dvi__settings_clear(&stepper->settings);
  dvi__release(stepper->specification);
  *stepper = (dvi__stepper){0};
}
