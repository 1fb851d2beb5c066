#include "system/declare/held.h"

#include "core/memory.h"
#include "core/status.h"
#include "system/evaluate/dynamics.h"
#include "system/term/holonomic.h"

/* Make the pattern of the gap's Hessian. A coordinate without an entry in the gradient is none of
 * the gap's, so that the pattern is the product of the gradient's with itself. */
static dvi_status curvature_of(const dvi__pattern *gradients, dvi__pattern *qq)
{
  const int n = gradients->rows, count = gradients->start[1];
  *qq = (dvi__pattern){n, n, DVI_NEW(int, (size_t)n + 1),
                       DVI_NEW(int, (size_t)count *(size_t)count)};
  if (qq->start == NULL || qq->row == NULL) {
    dvi__pattern_clear(qq);
    return dvi__fail(DVI_NO_MEMORY, "system: no memory for a contact that is held");
  }
  for (int j = 0, e = 0; j < n; j++) {
    qq->start[j + 1] = qq->start[j];
    if (e == count || gradients->row[e] != j) continue;
    for (int i = 0; i < count; i++) qq->row[qq->start[j + 1]++] = gradients->row[i];
    e++;
  }
  return DVI_OK;
}

static dvi_status add_gap(dvi_system *s, const dvi__contact_term *contact)
{
  const dvi__pattern *gradients = &contact->gap.gradients;
  dvi__pattern qq;
  DVI_TRY(curvature_of(gradients, &qq));
  dvi_holonomic gap = contact->gap.callbacks;
  gap.gradients = (dvi_pattern){gradients->start, gradients->row};
  gap.qq = (dvi_pattern){qq.start, qq.row};
  dvi_status status = dvi__holonomics_copy(
      s, &(dvi_system_terms){.holonomics = &gap, .holonomic_count = 1});
  if (status == DVI_OK) status = dvi__rows_join(s);
  dvi__pattern_clear(&qq);
  return status;
}

/* The patterns of second derivatives are completed before they are shared. */
dvi_status dvi__held_create(const dvi_system *system, int k, const dvi_system **held)
{
  *held = NULL;
  if (system->vector != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "contact '%s' cannot be held beside a vector potential; declare a general "
                     "Lagrangian with both the mass and it",
                     system->contacts[k].gap.name);
  DVI_TRY(dvi__system_prepare_hessian(system));
  dvi_system *made = DVI_NEW(dvi_system, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for a contact that is held");
  *made = *system;
  made->held_of = system;
  made->dynamics = system->lagrangian != NULL ? &dvi__dynamics_constrained_lagrangian
                                              : &dvi__dynamics_constrained_mass;
  *held = made;
  const dvi_status status = add_gap(made, &system->contacts[k]);
  if (status != DVI_OK) dvi__held_destroy(held);
  return status;
}

void dvi__held_destroy(const dvi_system **held)
{
  dvi_system *s = (dvi_system *)(uintptr_t)*held;
  if (s == NULL) return;
  for (int k = 0; k < s->holonomic_count; k++) dvi__holonomic_clear(&s->holonomics[k]);
  dvi__release(s->holonomics);
  dvi__pattern_clear(&s->rows_q);
  dvi__pattern_clear(&s->rows_qq);
  dvi__release(s);
  *held = NULL;
}
