/* Memory for one-point callbacks and differences, only as far as the system's missing callbacks
 * need it. */
#include "core/memory.h"
#include "core/status.h"
#include "system/term/force.h"
#include "system/term/term.h"
#include "system/term/vector.h"

static int larger_count(int a, int b)
{
  return a > b ? a : b;
}

static int longest_of(const dvi__lagrangian_term *term)
{
  const int qq = dvi__pattern_entries(&term->qq), qv = dvi__pattern_entries(&term->qv),
            vv = dvi__pattern_entries(&term->vv);
  return larger_count(larger_count(qq, qv), vv);
}

int dvi__longest_hessian(const dvi_system *system, int hessians)
{
  int longest = system->n;
  for (int k = 0; k < system->potential_count && hessians; k++)
    longest = larger_count(longest, dvi__pattern_entries(&system->potentials[k].qq));
  for (int k = 0; k < system->force_count && hessians && system->slot_count == 0; k++)
    longest = larger_count(longest, larger_count(dvi__pattern_entries(&system->forces[k].by_q),
                                                 dvi__pattern_entries(&system->forces[k].by_v)));
  if (system->vector != NULL) {
    const int second = hessians ? dvi__pattern_entries(&system->vector->qq) : 0;
    longest = larger_count(longest, dvi__pattern_entries(&system->vector->gradients));
    longest = larger_count(longest, second);
  }
  if (system->lagrangian == NULL) return longest;
  if (system->constraint != NULL)
    longest = larger_count(longest, longest_of(&system->constraint->weighted));
  return larger_count(longest, longest_of(system->lagrangian));
}

int dvi__lacks_gradient(const dvi_system *system)
{
  int lacks = system->lagrangian != NULL && !dvi__general_has_gradient(system->lagrangian);
  for (int k = 0; k < system->potential_count; k++)
    lacks |= !dvi__potential_has_gradient(&system->potentials[k]);
  return lacks;
}

/* The inverse Legendre map always needs a general Lagrangian's Hessian. */
static int lacks_hessian(const dvi_system *system, int hessians)
{
  int lacks = system->lagrangian != NULL && !dvi__general_has_hessian(system->lagrangian);
  lacks |= system->constraint != NULL && system->constraint->callbacks.hessian == NULL;
  for (int k = 0; k < system->holonomic_count; k++)
    lacks |= system->holonomics[k].callbacks.hessian == NULL;
  for (int k = 0; k < system->nonholonomic_count; k++)
    lacks |= system->nonholonomics[k].callbacks.derivative == NULL;
  for (int k = 0; k < system->potential_count && hessians; k++)
    lacks |= !dvi__potential_has_hessian(&system->potentials[k]);
  for (int k = 0; k < system->force_count && hessians && system->slot_count == 0; k++)
    lacks |= !dvi__force_has_jacobian(&system->forces[k]);
  if (system->vector != NULL && hessians) lacks |= !dvi__vector_has_hessian(system->vector);
  return lacks;
}

double dvi__hessian_noise(const dvi_system *system)
{
  const dvi__lagrangian_term *term = system->lagrangian;
  if (term != NULL && term->computed != NULL) return term->computed->noise(term->of);
  if (!lacks_hessian(system, 1)) return 0;
  return dvi__lacks_gradient(system) ? 1e-7 : 1e-10;
}

int dvi__differences_allocate(size_t numbers, dvi__differences *d)
{
  *d = (dvi__differences){.moved = DVI_NEW(double, numbers),
                          .step = DVI_NEW(double, numbers),
                          .plus = DVI_NEW(double, numbers),
                          .minus = DVI_NEW(double, numbers),
                          .plus_v = DVI_NEW(double, numbers),
                          .minus_v = DVI_NEW(double, numbers)};
  return d->moved && d->step && d->plus && d->minus && d->plus_v && d->minus_v;
}

void dvi__differences_clear(dvi__differences *d)
{
  dvi__release(d->moved);
  dvi__release(d->step);
  dvi__release(d->plus);
  dvi__release(d->minus);
  dvi__release(d->plus_v);
  dvi__release(d->minus_v);
}

int dvi__only_potentials(const dvi_system *system)
{
  return system->lagrangian == NULL && system->constraint == NULL && system->vector == NULL &&
         system->force_count == 0 && system->row_count == 0 && system->slot_count == 0;
}

static int allocate_points(const dvi_system *system, int hessians, dvi__scratch *s)
{
  s->point_q = DVI_NEW(double, system->n);
  s->point_v = DVI_NEW(double, system->n);
  for (int k = 0; k < 3; k++)
    s->result[k] = DVI_NEW(double, dvi__longest_hessian(system, hessians));
  return s->point_q && s->point_v && s->result[0] && s->result[1] && s->result[2];
}

static int scratch_allocate(const dvi_system *system, int capacity, int hessians, dvi__scratch *s)
{
  const size_t numbers = (size_t)system->n * (size_t)capacity;
  const int in_place = capacity == 1 && !hessians && dvi__only_potentials(system);
  if (!in_place && !allocate_points(system, hessians, s)) return 0;
  if (system->vector != NULL) {
    const size_t entries = (size_t)dvi__pattern_entries(&system->vector->gradients);
    s->vector_q = DVI_NEW(double, entries *(size_t)capacity);
    if (s->vector_q == NULL) return 0;
  }
  if (dvi__lacks_gradient(system) && !dvi__differences_allocate(numbers, &s->of_value)) return 0;
  return !lacks_hessian(system, hessians) || dvi__differences_allocate(numbers, &s->of_gradient);
}

dvi_status dvi__scratch_create(const dvi_system *system, int capacity, int hessians,
                               dvi__scratch *scratch)
{
  *scratch = (dvi__scratch){.n = system->n, .nv = system->nv, .capacity = capacity};
  const dvi__lagrangian_term *term = system->lagrangian;
  if (term != NULL && term->computed != NULL) DVI_TRY(term->computed->reserve(term->of, capacity));
  if (scratch_allocate(system, capacity, hessians, scratch)) return DVI_OK;
  dvi__scratch_clear(scratch);
  return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory for %d points in %d dimensions", capacity,
                   system->n);
}

void dvi__scratch_clear(dvi__scratch *scratch)
{
  dvi__release(scratch->point_q);
  dvi__release(scratch->point_v);
  for (int k = 0; k < 3; k++) dvi__release(scratch->result[k]);
  dvi__release(scratch->vector_q);
  dvi__differences_clear(&scratch->of_value);
  dvi__differences_clear(&scratch->of_gradient);
  *scratch = (dvi__scratch){0};
}
