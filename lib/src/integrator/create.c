/* Creation and destruction of integrators. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/attempt.h"
#include "integrator/hits.h"
#include "space/user_basis.h"
#include "system/evaluate/dynamics.h"

/* ---- create ---- */

static dvi_status refuse_memory(size_t n)
{
  return dvi__fail(DVI_NO_MEMORY, "integrator: no memory for %zu coordinates", n);
}

dvi_status dvi__integrator_equip(dvi_integrator *I)
{
  dvi__attempt_extend(I);
  I->stepper.memory = DVI_NEW(double, I->stepper.memory_count);
  I->memory_before = DVI_NEW(double, I->stepper.memory_count);
  if (I->stepper.memory == NULL || I->memory_before == NULL)
    return refuse_memory((size_t)I->system->n);
  DVI_TRY(dvi__attempt_allocate(I));
  return dvi__evaluator_create(I->system, 1, DVI__STATES, &I->counters, &I->evaluator);
}

dvi_status dvi__integrator_velocities(dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n;
  if (I->v != NULL) return DVI_OK;
  I->v = DVI_NEW(double, 2 * n);
  if (I->v == NULL) return refuse_memory(n);
  I->last_v = I->v + n;
  return DVI_OK;
}

/* Lay out the present state, and the two others, which share the compensations of one. */
static dvi_status allocate_states(dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n, supplied = 2 * I->balances;
  double *at = I->numbers = DVI_NEW(double, 10 * n + 3 * supplied + I->balances);
  if (I->numbers == NULL) return refuse_memory(n);
  dvi__state_lay_out(I, &I->now, &at);
  dvi__state_lay_out(I, &I->last, &at);
  I->next.q = at;
  I->next.p = at + n;
  at += 2 * n;
  dvi__share_compensations(I);
  if (I->balances > 0) I->next.supplied = at, I->next.supplied_compensation = at + I->balances;
  I->at_start = at + supplied;
  return DVI_OK;
}

static dvi_status allocate_integrator(dvi_integrator *I)
{
  DVI_TRY(allocate_states(I));
  DVI_TRY(dvi__integrator_equip(I));
  if (I->stepper.follows || I->monitored != NULL || I->system->contact_count > 0)
    DVI_TRY(dvi__integrator_velocities(I));
  return dvi__hits_create(I);
}

static dvi_status copy_shapes(dvi_integrator *I, const dvi_shapes *shapes)
{
  if (shapes == NULL) return DVI_OK;
  I->shapes = dvi__shapes_copy(shapes);
  return I->shapes != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "integrator: no memory for the shapes %s", shapes->name);
}

static dvi_status make_stepper(dvi_integrator *I, const dvi_integrator_options *o)
{
  DVI_TRY(copy_shapes(I, o->shapes));
  if (o->pacing != DVI_STEPS_OF_TIME)
    DVI_TRY(
        dvi__monitored_time_create(I->system, o->monitor, o->pacing, &I->counters, &I->monitored));
  DVI_TRY(dvi__stepper_create(dvi__monitored_time_system(I->monitored, I->system), o->method,
                              I->shapes, &I->counters, &I->stepper));
  return allocate_integrator(I);
}

static dvi_status check_monitored_method(const dvi_integrator *I)
{
  const char *symmetric = I->system->dynamics->symmetric;
  if (I->system->contact_count > 0)
    return dvi__fail(DVI_UNSUPPORTED, "the system declares contacts, whose hits divide a step of "
                                      "time; take steps of equal length");
  if (I->stepper.method->chooses_steps)
    return dvi__fail(DVI_UNSUPPORTED, "%s chooses the lengths of its steps itself",
                     I->stepper.method->name);
  if (I->monitored->pacing == DVI_TIME_TRANSFORM || I->stepper.symmetric) return DVI_OK;
  return dvi__fail(
      DVI_UNSUPPORTED,
      "%s is not symmetric, and only that keeps energies from drifting when steps change; "
      "choose %s",
      I->stepper.specification,
      symmetric != NULL ? symmetric
                        : "a symmetric quadrature, one-step method or type, or the time transform");
}

static dvi_status make_integrator(const dvi_system *system, const dvi_integrator_options *o,
                                  dvi_integrator **integrator)
{
  const long before = dvi__allocation_count();
  dvi_integrator *I = DVI_NEW(dvi_integrator, 1);
  if (I == NULL) return dvi__fail(DVI_NO_MEMORY, "integrator: no memory");
  I->system = system;
  I->balances = o->balances ? 1 + (size_t)system->symmetry_count : 0;
  dvi_status status = make_stepper(I, o);
  I->counters.allocations = dvi__allocation_count() - before;
  if (status == DVI_OK && I->monitored != NULL) status = check_monitored_method(I);
  if (status != DVI_OK) dvi_integrator_destroy(&I);
  *integrator = I;
  return status;
}

static dvi_status make_monitored_integrator(const dvi_system *system,
                                            const dvi_integrator_options *o,
                                            dvi_integrator **integrator)
{
  const char *what = o->pacing == DVI_TIME_TRANSFORM
                         ? "time transform, a general Lagrangian with the mass M/g"
                         : "step control";
  if (system->dynamics->on_manifold)
    return dvi__fail(DVI_UNSUPPORTED,
                     "%s: the system has factors, and monitors are functions of coordinates of "
                     "R^n; take steps of equal length",
                     what);
  const dvi_status status = make_integrator(system, o, integrator);
  if (status == DVI_UNSUPPORTED) (void)dvi__fail_in(status, "%s", what);
  return status;
}

/* Copy the options. The caller's struct may be that of an older header, without the last fields.
 * Every field, and so every such size, takes a multiple of a pointer's size. */
static dvi_status read_options(const dvi_integrator_options *given, dvi_integrator_options *o)
{
  *o = (dvi_integrator_options){0};
  if (given->size < sizeof given->size || given->size > sizeof *o ||
      given->size % sizeof(void *) != 0)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "integrator: the options' size is %zu; set it to sizeof(dvi_integrator_options), %zu",
        given->size, sizeof *o);
  memcpy(o, given, given->size);
  if (o->pacing < DVI_STEPS_OF_TIME || o->pacing > DVI_STEP_CONTROL)
    return dvi__fail(DVI_BAD_ARGUMENT, "integrator: there is no pacing number %d", (int)o->pacing);
  if (o->pacing != DVI_STEPS_OF_TIME && o->monitor == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "integrator: the monitor is NULL");
  if (o->pacing == DVI_STEPS_OF_TIME && o->monitor != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "integrator: a monitor is given, but the pacing is steps of time; choose "
                     "DVI_TIME_TRANSFORM or DVI_STEP_CONTROL, or leave it out");
  if (o->method == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "integrator: the method is NULL");
  return o->shapes != NULL ? dvi__shapes_check(o->shapes) : DVI_OK;
}

dvi_status dvi_integrator_create_with(const dvi_system *system,
                                      const dvi_integrator_options *options,
                                      dvi_integrator **integrator)
{
  dvi_integrator_options o;
  if (integrator == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "integrator: no place for the result");
  *integrator = NULL;
  if (system == NULL || options == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "integrator: the %s NULL",
                     system == NULL ? "system is" : "options are");
  DVI_TRY(read_options(options, &o));
  return o.pacing == DVI_STEPS_OF_TIME ? make_integrator(system, &o, integrator)
                                       : make_monitored_integrator(system, &o, integrator);
}

dvi_status dvi_integrator_create(const dvi_system *system, const char *method,
                                 dvi_integrator **integrator)
{
  return dvi_integrator_create_with(
      system, &(dvi_integrator_options){.size = sizeof(dvi_integrator_options), .method = method},
      integrator);
}

dvi_status dvi_integrator_create_like(const dvi_integrator *I, dvi_integrator **integrator)
{
  if (I == NULL || integrator == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "integrator: an argument is NULL");
  const dvi_integrator_options options = {
      .size = sizeof options,
      .method = I->stepper.specification,
      .shapes = I->shapes,
      .balances = I->balances > 0,
      .pacing = I->monitored != NULL ? I->monitored->pacing : DVI_STEPS_OF_TIME,
      .monitor = I->monitored != NULL ? &I->monitored->given : NULL};
  DVI_TRY(dvi_integrator_create_with(dvi__declared_system(I), &options, integrator));
  if (I->monitored == NULL) return DVI_OK;
  (*integrator)->monitored->holds = I->monitored->holds || I->started;
  dvi__monitored_time_set_energy((*integrator)->monitored, I->monitored->energy);
  return DVI_OK;
}

/* ---- destroy ---- */

void dvi__integrator_strip(dvi_integrator *I)
{
  dvi__release(I->stepper.memory);
  dvi__stepper_destroy(&I->stepper);
  dvi__evaluator_destroy(&I->evaluator);
  dvi__release(I->memory_before);
  dvi__attempt_clear(I);
}

void dvi_integrator_destroy(dvi_integrator **integrator)
{
  if (integrator == NULL || *integrator == NULL) return;
  dvi_integrator *I = *integrator;
  dvi__hits_destroy(I);
  dvi__integrator_strip(I);
  dvi__monitored_time_destroy(&I->monitored);
  dvi__release(I->numbers);
  dvi__release(I->v);
  dvi__release(I->shapes);
  dvi__release(I);
  *integrator = NULL;
}
