/* A constant mass is checked, and copied in the form that evaluators use. */
#include "system/mass.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/factor.h"

static dvi_status check_symmetric(const dvi__pattern *pattern, const double *values)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      const int mirror = dvi__pattern_find(pattern, j, pattern->row[e]);
      if (mirror < 0 || values[mirror] != values[e])
        return dvi__fail(DVI_BAD_ARGUMENT, "system: the mass matrix is not symmetric at (%d,%d)",
                         pattern->row[e], j);
    }
  return DVI_OK;
}

/* Check with the kind of factors that an evaluator will use, so that both give the same answer.
 * Evaluators share the factor of a positive mass. */
static dvi_status factor_mass(dvi_system *s)
{
  dvi__linear **factor = &s->mass_factor;
  const dvi_status status = dvi__linear_create_symmetric(&s->vv, s->mass_values, NULL, factor);
  if (status != DVI_OK) return dvi__fail_in(status, "system: mass matrix");
  if (dvi__linear_kind_of(*factor) != DVI__LINEAR_DEFINITE) dvi__linear_destroy(factor);
  return DVI_OK;
}

static dvi_status copy_sparse_mass(dvi_system *s, const dvi_mass *mass)
{
  DVI_TRY(dvi__pattern_copy(&mass->pattern, s->n, "system: mass matrix", &s->vv));
  const size_t entries = (size_t)dvi__pattern_entries(&s->vv);
  if (dvi__first_not_finite(entries, mass->values) >= 0)
    return dvi__fail(DVI_SINGULAR, "system: the mass matrix is not finite");
  s->mass_values = dvi__duplicate(mass->values, entries, sizeof(double));
  if (s->mass_values == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its mass");
  if (s->mass_of != NULL && s->mass_of->mass_factor != NULL)
    return dvi__linear_share(s->mass_of->mass_factor, NULL, &s->mass_factor);
  DVI_TRY(check_symmetric(&s->vv, s->mass_values));
  return factor_mass(s);
}

static dvi_status copy_diagonal_mass(dvi_system *s, const dvi_mass *mass)
{
  for (int i = 0; i < s->n; i++) {
    const double m = mass->diagonal != NULL ? mass->diagonal[i] : mass->scalar;
    if (!isfinite(m) || m == 0 || !isfinite(1 / m))
      return dvi__fail(DVI_SINGULAR,
                       "system: mass %g of coordinate %d; a finite number other than 0 is needed",
                       m, i);
  }
  s->mass_scalar = mass->scalar;
  DVI_TRY(dvi__pattern_diagonal(s->n, &s->vv));
  s->mass_diagonal = DVI_NEW(double, s->n);
  if (s->mass_diagonal == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its mass");
  for (int i = 0; i < s->n; i++)
    s->mass_diagonal[i] = mass->diagonal != NULL ? mass->diagonal[i] : mass->scalar;
  return DVI_OK;
}

dvi_status dvi__mass_copy(const dvi_system_terms *terms, dvi_system *s)
{
  const dvi_mass *mass = &terms->mass;
  const int forms = (mass->scalar != 0) + (mass->diagonal != NULL) + (mass->values != NULL);
  if (forms > 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the mass is given in %d forms; one is possible",
                     forms);
  s->terms |= DVI__CONSTANT_MASS;
  DVI_TRY(dvi__pattern_empty(s->n, &s->qv));
  if (s->slots != NULL) return dvi__factors_mass(terms, s);
  return mass->values != NULL ? copy_sparse_mass(s, mass) : copy_diagonal_mass(s, mass);
}
