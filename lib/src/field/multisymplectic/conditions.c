/* Fixed values and fluxes of a lattice, and its unknowns. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/lattice.h"

/* ---- parts of the boundary ---- */

int dvi__lattice_is_part(const char *part, const dvi__lattice_axis *axis, int end)
{
  return strcmp(part, "boundary") == 0 || strcmp(part, axis->side[end]) == 0;
}

static int is_on(const dvi__lattice *lattice, int64_t vertex, const char *part)
{
  int index[DVI_AXES_MAX];
  dvi__lattice_vertex_index(lattice, vertex, index);
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    for (int end = 0; end < 2 && !a->is_periodic; end++)
      if (index[d] == end * a->cells && dvi__lattice_is_part(part, a, end)) return 1;
  }
  return 0;
}

static dvi_status check_condition(const dvi__lattice *lattice, const dvi_density_condition *given,
                                  int number)
{
  if (given->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: condition %d has no part", number);
  if (given->component < -1 || given->component >= lattice->components)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: the condition on %s is of component %d; -1 for all, and 0 "
                     "to %d are possible",
                     given->part, given->component, lattice->components - 1);
  if (!isfinite(given->robin))
    return dvi__fail(DVI_NOT_FINITE, "multisymplectic: the condition on %s has robin = %g",
                     given->part, given->robin);
  for (int64_t v = 0; v < lattice->vertices; v++)
    if (is_on(lattice, v, given->part)) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "multisymplectic: there is no part \"%s\" of the boundary; ends of axes that are "
      "not periodic have the names left and right, bottom and top, back and front",
      given->part);
}

/* ---- places ---- */

int dvi__lattice_is_of(const dvi_density_condition *given, int component)
{
  return given->component < 0 || given->component == component;
}

/* Take the places of fixed values that no earlier condition has: count them, or keep them too.
 * Taken ones are -2. */
static int64_t take_places(const dvi__lattice *lattice, const dvi_density_condition *given,
                           dvi__lattice_condition *kept)
{
  int64_t count = 0;
  for (int64_t i = 0; i < lattice->size; i++) {
    const int64_t v = i % lattice->vertices;
    if (lattice->unknown[i] == -2 || !dvi__lattice_is_of(given, (int)(i / lattice->vertices)) ||
        !is_on(lattice, v, given->part))
      continue;
    if (kept != NULL) {
      double x[DVI_AXES_MAX];
      dvi__lattice_vertex(lattice, v, x);
      for (int d = 0; d < lattice->axes; d++) kept->x[d * kept->count + count] = x[d];
      kept->place[count] = (int)i;
    }
    count++;
  }
  return count;
}

static dvi_status keep_condition(const dvi__lattice *lattice, const dvi_density_condition *given,
                                 dvi__lattice_condition *kept)
{
  const int is_fixed = given->kind == DVI_FIXED;
  kept->declared = *given;
  kept->corners = is_fixed ? 1 : lattice->corners / 2;
  kept->count = is_fixed ? take_places(lattice, given, NULL)
                         : dvi__lattice_take_faces(lattice, given, NULL);
  kept->place = DVI_NEW(int, kept->count * kept->corners);
  kept->shape = DVI_NEW(double, kept->count * kept->corners);
  kept->x = DVI_NEW(double, kept->count * lattice->axes);
  kept->datum = DVI_NEW(double, kept->count);
  kept->weight = DVI_NEW(double, kept->count);
  if (kept->place == NULL || kept->shape == NULL || kept->x == NULL || kept->datum == NULL ||
      kept->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for conditions");
  if (is_fixed)
    (void)take_places(lattice, given, kept);
  else
    (void)dvi__lattice_take_faces(lattice, given, kept);
  for (int64_t i = 0; i < kept->count && is_fixed; i++) lattice->unknown[kept->place[i]] = -2;
  kept->declared.part = NULL;
  return DVI_OK;
}

static int does_nothing(const dvi_density_condition *given)
{
  return given->kind != DVI_FIXED && given->datum == NULL && given->robin == 0;
}

dvi_status dvi__lattice_make_conditions(const dvi_multisymplectic_terms *terms,
                                        dvi__lattice *lattice)
{
  if (terms->conditions < 0 || (terms->conditions > 0 && terms->condition == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: %d conditions are announced, and not given",
                     terms->conditions);
  lattice->unknown = DVI_NEW(int, lattice->size);
  lattice->condition = DVI_NEW(dvi__lattice_condition, terms->conditions);
  if (lattice->unknown == NULL || lattice->condition == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for conditions");
  for (int i = 0; i < terms->conditions; i++) {
    DVI_TRY(check_condition(lattice, &terms->condition[i], i));
    if (does_nothing(&terms->condition[i])) continue;
    DVI_TRY(
        keep_condition(lattice, &terms->condition[i], &lattice->condition[lattice->conditions++]));
  }
  for (int64_t i = 0; i < lattice->size; i++)
    lattice->unknown[i] = lattice->unknown[i] == -2 ? -1 : lattice->unknowns++;
  if (lattice->unknowns > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: the boundary fixes all values");
}

/* ---- values ---- */

static dvi_status check_datum(const dvi__lattice_condition *c, double t, int failed)
{
  if (failed != 0)
    return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                     "multisymplectic: a datum of the boundary failed with %d at t = %g", failed,
                     t);
  for (int64_t i = 0; i < c->count; i++)
    if (!isfinite(c->datum[i]))
      return dvi__fail(DVI_NOT_FINITE,
                       "multisymplectic: a datum of the boundary is %g at t = %g, x = %g",
                       c->datum[i], t, c->x[i]);
  return DVI_OK;
}

dvi_status dvi__lattice_datum(const dvi__lattice_condition *c, double t)
{
  const dvi_density_condition *given = &c->declared;
  const double at = given->rate != NULL ? t : 0;
  memset(c->datum, 0, (size_t)c->count * sizeof *c->datum);
  if (given->datum == NULL || c->count == 0) return DVI_OK;
  return check_datum(c, t, given->datum(c->count, at, c->x, c->datum, given->user));
}

static dvi_status find_rate(const dvi__lattice_condition *c, double t)
{
  const dvi_density_condition *given = &c->declared;
  memset(c->datum, 0, (size_t)c->count * sizeof *c->datum);
  if (given->rate == NULL || c->count == 0) return DVI_OK;
  return check_datum(c, t, given->rate(c->count, t, c->x, c->datum, NULL, given->user));
}

static void put(const dvi__lattice_condition *c, double *u)
{
  for (int64_t i = 0; i < c->count; i++) u[c->place[i]] = c->datum[i];
}

dvi_status dvi__lattice_fix(const dvi__lattice *lattice, double t, double *u, double *rate)
{
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    if (c->declared.kind != DVI_FIXED) continue;
    DVI_TRY(dvi__lattice_datum(c, t));
    put(c, u);
    if (rate == NULL) continue;
    DVI_TRY(find_rate(c, t));
    put(c, rate);
  }
  return DVI_OK;
}
