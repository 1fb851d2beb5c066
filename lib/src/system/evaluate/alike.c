/* Common properties of a system's terms, and the test for systems that may replace one another. */
#include <math.h>

#include "core/status.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/jet.h"
#include "system/term/term.h"
#include "system/term/vector.h"

int dvi__system_has_gradients(const dvi_system *system)
{
  for (int p = 0; p < system->potential_count; p++)
    if (!dvi__potential_has_gradient(&system->potentials[p])) return 0;
  return 1;
}

/* The largest eigenvalue of a sum is at most the sum of the largest ones. */
double dvi__system_fastest(const dvi_system *system)
{
  double square = 0;
  for (int p = 0; p < system->potential_count; p++) {
    const double fastest = system->potentials[p].callbacks.fastest;
    square += fastest * fastest;
  }
  return sqrt(square);
}

static dvi_status refuse_without_rate(const char *without)
{
  return dvi__fail(DVI_UNSUPPORTED,
                   "%s has no rate callback, and the system is not declared autonomous; give the "
                   "rate, or declare it if no callback "
                   "depends on t",
                   without);
}

dvi_status dvi__system_has_field(const dvi_system *system)
{
  if (system->autonomous || dvi__vector_has_rate(system->vector)) return DVI_OK;
  return refuse_without_rate("the vector potential");
}

dvi_status dvi__system_has_rates(const dvi_system *system)
{
  const dvi__lagrangian_term *l = system->lagrangian;
  const char *without = l != NULL && !dvi__general_has_rate(l) ? "the Lagrangian" : NULL;
  for (int p = 0; p < system->potential_count && without == NULL; p++)
    if (!dvi__potential_has_rate(&system->potentials[p])) without = system->potentials[p].name;
  if (system->vector != NULL && !dvi__vector_has_rate(system->vector) && without == NULL)
    without = "the vector potential";
  return system->autonomous || without == NULL ? DVI_OK : refuse_without_rate(without);
}

dvi_status dvi__system_has_taylor(const dvi_system *system)
{
  const dvi__lagrangian_term *l = system->lagrangian;
  const char *without = l != NULL && !dvi__general_has_taylor(l) ? l->name : NULL;
  for (int p = 0; p < system->potential_count && without == NULL; p++)
    if (!dvi__potential_has_taylor(&system->potentials[p])) without = system->potentials[p].name;
  if (system->vector != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "a vector potential A(t,q).v has no Taylor coefficients, and derivatives "
                     "beyond the second are needed; declare a general Lagrangian with them");
  if (without == NULL) return DVI_OK;
  if (system->dynamics->no_taylor != NULL)
    return dvi__fail(DVI_UNSUPPORTED, "%s", system->dynamics->no_taylor);
  return dvi__fail(DVI_UNSUPPORTED,
                   "'%s' has no taylor callback, and derivatives beyond the second are needed; "
                   "give it (dvi/taylor.h)",
                   without);
}

static int same_ranges(const dvi_system *a, const dvi_system *b)
{
  for (int p = 0; p < a->potential_count; p++) {
    const dvi_potential *here = &a->potentials[p].callbacks, *there = &b->potentials[p].callbacks;
    if ((here->gradient_range != NULL) != (there->gradient_range != NULL) ||
        here->reach != there->reach)
      return 0;
  }
  return 1;
}

static int same_derivatives(const dvi_system *a, const dvi_system *b)
{
  for (int p = 0; p < a->potential_count; p++)
    if (dvi__potential_has_gradient(&a->potentials[p]) !=
            dvi__potential_has_gradient(&b->potentials[p]) ||
        dvi__potential_has_hessian(&a->potentials[p]) !=
            dvi__potential_has_hessian(&b->potentials[p]) ||
        dvi__potential_has_rate(&a->potentials[p]) != dvi__potential_has_rate(&b->potentials[p]) ||
        dvi__potential_has_taylor(&a->potentials[p]) !=
            dvi__potential_has_taylor(&b->potentials[p]))
      return 0;
  if (a->vector != NULL &&
      (dvi__vector_has_hessian(a->vector) != dvi__vector_has_hessian(b->vector) ||
       dvi__vector_has_rate(a->vector) != dvi__vector_has_rate(b->vector)))
    return 0;
  if (a->constraint != NULL &&
      (a->constraint->callbacks.hessian != NULL) != (b->constraint->callbacks.hessian != NULL))
    return 0;
  return a->lagrangian == NULL ||
         (dvi__general_has_gradient(a->lagrangian) == dvi__general_has_gradient(b->lagrangian) &&
          dvi__general_has_hessian(a->lagrangian) == dvi__general_has_hessian(b->lagrangian) &&
          dvi__general_has_rate(a->lagrangian) == dvi__general_has_rate(b->lagrangian) &&
          dvi__general_has_taylor(a->lagrangian) == dvi__general_has_taylor(b->lagrangian));
}

dvi_status dvi__system_alike(const dvi_system *a, const dvi_system *b)
{
  dvi__declared there = b->declared;
  /* methods with noise are bound to their systems, and members may differ in its numbers */
  there.hash[DVI__DECLARED_NOISE] = a->declared.hash[DVI__DECLARED_NOISE];
  const char *difference = dvi__declared_difference(&a->declared, &there);
  if (difference != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "the systems declare different %s; integrate such systems one by one",
                     difference);
  if (a->autonomous != b->autonomous)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "one of the systems is declared autonomous, the other is not");
  if (!same_ranges(a, b))
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "a gradient_range is given in one of the systems alone, or they differ in its reach");
  if (same_derivatives(a, b)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "a derivative is given in one of the systems and differenced in the other");
}
