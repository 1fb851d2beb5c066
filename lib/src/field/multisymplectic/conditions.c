/* Fixed values of a lattice, and its unknowns. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/lattice.h"

/* ---- parts of the boundary ---- */

/* An end of an axis. */
static const char *const side_name[DVI_AXES_MAX][2] = {
    {"left", "right"}, {"bottom", "top"}, {"back", "front"}};

static int is_on(const dvi__lattice *lattice, int64_t vertex, const char *part)
{
  const int is_all = strcmp(part, "boundary") == 0;
  double x[DVI_AXES_MAX];
  dvi__lattice_vertex(lattice, vertex, x);
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    for (int end = 0; end < 2 && !a->is_periodic; end++)
      if ((is_all || strcmp(part, side_name[d][end]) == 0) && x[d] == a->node[end * a->cells])
        return 1;
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
  if (given->kind != DVI_FIXED && (given->datum != NULL || given->robin != 0))
    return dvi__fail(DVI_UNSUPPORTED,
                     "multisymplectic: the condition on %s has a flux; free ends have none here",
                     given->part);
  for (int64_t v = 0; v < lattice->vertices; v++)
    if (is_on(lattice, v, given->part)) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "multisymplectic: there is no part \"%s\" of the boundary; ends of axes that are "
      "not periodic have the names left and right, bottom and top, back and front",
      given->part);
}

/* ---- places ---- */

static int is_of(const dvi_density_condition *given, int component)
{
  return given->component < 0 || given->component == component;
}

/* Take the places of a condition that no earlier one has: count them, or keep them too. Taken ones
 * are -2. */
static int64_t take_places(const dvi__lattice *lattice, const dvi_density_condition *given,
                           dvi__lattice_condition *kept)
{
  int64_t count = 0;
  for (int64_t i = 0; i < lattice->size; i++) {
    const int64_t v = i % lattice->vertices;
    if (lattice->unknown[i] == -2 || !is_of(given, (int)(i / lattice->vertices)) ||
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
  kept->declared = *given;
  kept->declared.part = NULL;
  kept->count = take_places(lattice, given, NULL);
  kept->place = DVI_NEW(int, kept->count);
  kept->x = DVI_NEW(double, kept->count * lattice->axes);
  kept->datum = DVI_NEW(double, kept->count);
  if (kept->place == NULL || kept->x == NULL || kept->datum == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for conditions");
  (void)take_places(lattice, given, kept);
  for (int64_t i = 0; i < kept->count; i++) lattice->unknown[kept->place[i]] = -2;
  return DVI_OK;
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
    if (terms->condition[i].kind != DVI_FIXED) continue;
    DVI_TRY(
        keep_condition(lattice, &terms->condition[i], &lattice->condition[lattice->conditions++]));
  }
  for (int64_t i = 0; i < lattice->size; i++)
    lattice->unknown[i] = lattice->unknown[i] == -2 ? -1 : lattice->unknowns++;
  if (lattice->unknowns > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: the boundary fixes all values");
}

/* ---- values ---- */

/* Find out that numbers of a callback are finite. */
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

static void put(const dvi__lattice_condition *c, double *u)
{
  for (int64_t i = 0; i < c->count; i++) u[c->place[i]] = c->datum[i];
}

dvi_status dvi__lattice_fix(const dvi__lattice *lattice, double t, double *u, double *rate)
{
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    const dvi_density_condition *given = &c->declared;
    const double at = given->rate != NULL ? t : 0;
    memset(c->datum, 0, (size_t)c->count * sizeof *c->datum);
    if (given->datum != NULL && c->count > 0)
      DVI_TRY(check_datum(c, t, given->datum(c->count, at, c->x, c->datum, given->user)));
    put(c, u);
    if (rate == NULL) continue;
    memset(c->datum, 0, (size_t)c->count * sizeof *c->datum);
    if (given->rate != NULL && c->count > 0)
      DVI_TRY(check_datum(c, t, given->rate(c->count, t, c->x, c->datum, NULL, given->user)));
    put(c, rate);
  }
  return DVI_OK;
}
