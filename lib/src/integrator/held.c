/* The bodies of contacts that may be held, and which of them steps. */
#include "integrator/held.h"

#include "core/memory.h"
#include "core/status.h"
#include "integrator/attempt.h"
#include "integrator/hits_struct.h"
#include "system/declare/held.h"

static void exchange(dvi_integrator *I, dvi__body *body)
{
  const dvi__body own = {I->system,        I->stepper, I->evaluator,
                         I->memory_before, I->learned, I->first};
  I->system = body->system;
  I->stepper = body->stepper;
  I->evaluator = body->evaluator;
  I->memory_before = body->memory_before;
  I->learned = body->learned;
  I->first = body->first;
  *body = own;
}

int dvi__bodies_held(const dvi_integrator *I)
{
  return I->hits != NULL ? I->hits->bodies.held : -1;
}

void dvi__bodies_choose(dvi_integrator *I, int k)
{
  if (I->hits == NULL || I->hits->bodies.held == k) return;
  dvi__bodies *b = &I->hits->bodies;
  if (b->held >= 0) exchange(I, &b->body[b->held]);
  if (k >= 0) exchange(I, &b->body[k]);
  b->held = k;
}

static dvi_status fill_body(dvi_integrator *I, int k)
{
  const char *method = I->stepper.specification;
  dvi__body *body = &I->hits->bodies.body[k];
  DVI_TRY(dvi__held_create(I->system, k, &body->system));
  dvi__bodies_choose(I, k);
  dvi_status status = dvi__stepper_create(I->system, method, I->shapes, &I->counters, &I->stepper);
  if (status == DVI_OK) status = dvi__integrator_equip(I);
  dvi__bodies_choose(I, -1);
  return status;
}

dvi_status dvi__bodies_create(dvi_integrator *I)
{
  const int contacts = I->system->contact_count;
  dvi__bodies *b = &I->hits->bodies;
  b->body = DVI_NEW(dvi__body, (size_t)contacts);
  b->start = DVI_NEW(double, 3 * (size_t)I->system->n);
  if (b->body == NULL || b->start == NULL)
    return dvi__fail(DVI_NO_MEMORY, "integrator: no memory for %d contacts", contacts);
  for (int k = 0; k < contacts; k++) {
    if (!I->system->contacts[k].callbacks.hold) continue;
    const dvi_status status = fill_body(I, k);
    if (status != DVI_OK)
      return dvi__fail_in(status, "contact '%s', which may be held",
                          dvi_system_contact_name(I->system, k));
  }
  return DVI_OK;
}

void dvi__bodies_destroy(dvi_integrator *I)
{
  dvi__bodies *b = &I->hits->bodies;
  dvi__bodies_choose(I, -1);
  for (int k = 0; b->body != NULL && k < I->system->contact_count; k++) {
    if (b->body[k].system == NULL) continue;
    dvi__bodies_choose(I, k);
    dvi__integrator_strip(I);
    dvi__bodies_choose(I, -1);
    dvi__held_destroy(&b->body[k].system);
  }
  dvi__release(b->body);
  dvi__release(b->start);
}

size_t dvi__bodies_memory(const dvi_integrator *I)
{
  const dvi__bodies *b = &I->hits->bodies;
  size_t most = I->stepper.memory_count;
  for (int k = 0; b->body != NULL && k < I->system->contact_count; k++)
    if (b->body[k].stepper.memory_count > most) most = b->body[k].stepper.memory_count;
  return most;
}

const dvi_system *dvi__declared_system(const dvi_integrator *I)
{
  const int k = dvi__bodies_held(I);
  return k >= 0 ? I->hits->bodies.body[k].system : I->system;
}

int dvi_integrator_may_hold(const dvi_integrator *I, int k)
{
  return I != NULL && I->hits != NULL && I->hits->divide && k >= 0 &&
         k < I->system->contact_count && I->system->contacts[k].callbacks.hold;
}

int dvi__bodies_may_hold(const dvi_integrator *I)
{
  for (int k = 0; k < I->system->contact_count; k++)
    if (dvi_integrator_may_hold(I, k)) return 1;
  return 0;
}
