/* Fields with a density: their creation and end. The action of a field of coordinates q is
 *
 *     S = int dt L,    L(t,q,q') = sum over parts and points of w_k l(t, x_k, B q, B q') + G-terms
 *
 * with B the rows of derivatives at the points, and G the values that the boundary moves. A
 * function of time alone is left out of L. Source: Leok 2004, sec. 5.1. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

/* ---- checks ---- */

static dvi_status check_terms(const dvi_density_terms *terms)
{
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: set terms.size to sizeof(dvi_density_terms)");
  if (terms->space == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "density: a space is needed");
  if (terms->components < 1 || terms->components > DVI_COMPONENTS_MAX)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: %d components asked, 1 to %d possible",
                     terms->components, (int)DVI_COMPONENTS_MAX);
  if (terms->conditions < 0 || (terms->conditions > 0 && terms->condition == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "density: %d conditions are announced, and none is given",
                     terms->conditions);
  if (dvi_space_functions(terms->space) <= INT32_MAX / terms->components) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "density: an int cannot count %d times %lld coefficients",
                   terms->components, (long long)dvi_space_functions(terms->space));
}

static dvi_status check_together(const dvi_density *density)
{
  const int *count = density->count;
  if (count[DVI_DENSITY_ONE_FORM] > 0 &&
      count[DVI_DENSITY_KINETIC] + count[DVI_DENSITY_GENERAL] > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: a one-form does not go with a %s part: make all parts with rates "
                     "one-forms, or general",
                     count[DVI_DENSITY_KINETIC] > 0 ? "kinetic" : "general");
  if (count[DVI_DENSITY_ONE_FORM] > 0 && density->moving > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: values move on the boundary of a field of first order, whose "
                     "one-form does not depend on time: fix them, or take a general part");
  return DVI_OK;
}

/* ---- integrals ---- */

static void begin(const dvi_density *density, dvi__integral *integral)
{
  *integral = (dvi__integral){.density = density, .has_rate = 1};
}

/* Make the integral of all parts of one kind, or of two. */
static dvi_status make_integral(dvi_density *density, dvi_density_kind kind, dvi_density_kind other,
                                double sign, unsigned second, dvi__integral *integral)
{
  begin(density, integral);
  for (int p = 0; p < density->parts; p++)
    if (density->part[p].given.kind == kind || density->part[p].given.kind == other)
      DVI_TRY(dvi__integral_add(integral, density->part + p));
  return integral->parts > 0 ? dvi__integral_make(density, sign, second, integral) : DVI_OK;
}

dvi_status dvi__density_make_one_form(dvi_density *density)
{
  return make_integral(density, DVI_DENSITY_ONE_FORM, DVI_DENSITY_ONE_FORM, 1, DVI__QQ | DVI__QV,
                       &density->one_form);
}

static dvi_status make_potential(dvi_density *density, dvi__density_part *part)
{
  dvi__integral *integral = density->potential + density->potentials++;
  begin(density, integral);
  DVI_TRY(dvi__integral_add(integral, part));
  return dvi__integral_make(density, -1, DVI__QQ, integral);
}

/* The potential of what quadratic parts of Fourier fields have beside a constant matrix. */
static dvi_status make_rest(dvi_density *density)
{
  dvi__integral *rest = density->potential + density->potentials++;
  DVI_TRY(make_integral(density, DVI_DENSITY_QUADRATIC, DVI_DENSITY_QUADRATIC, -1, DVI__QQ, rest));
  rest->less = &density->stiffness;
  rest->load = density->load;
  rest->less_value = density->rest;
  return DVI_OK;
}

/* A general part takes the kinetic ones into its Lagrangian. */
static dvi_status make_integrals(dvi_density *density)
{
  const int is_general = density->count[DVI_DENSITY_GENERAL] > 0;
  density->potential = DVI_NEW(dvi__integral, density->parts + 1);
  if (density->potential == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory");
  if (is_general && density->is_fourier && density->unknowns > DVI__MODES_WITH_HESSIAN)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: general parts have full Hessians on fourier, which are for at most "
                     "%d coordinates, not %lld: take kind=spline or fem",
                     (int)DVI__MODES_WITH_HESSIAN, (long long)density->unknowns);
  begin(density, &density->kinetic);
  begin(density, &density->lagrangian);
  if (is_general)
    DVI_TRY(make_integral(density, DVI_DENSITY_GENERAL, DVI_DENSITY_KINETIC, 1,
                          DVI__QQ | DVI__QV | DVI__VV, &density->lagrangian));
  else
    DVI_TRY(make_integral(density, DVI_DENSITY_KINETIC, DVI_DENSITY_KINETIC, 1, DVI__VV,
                          &density->kinetic));
  DVI_TRY(make_integral(density, DVI_DENSITY_QUADRATIC, DVI_DENSITY_QUADRATIC, -1, DVI__QQ,
                        &density->quadratic));
  for (int p = 0; p < density->parts; p++)
    if (density->part[p].given.kind == DVI_DENSITY_POTENTIAL)
      DVI_TRY(make_potential(density, density->part + p));
  return DVI_OK;
}

/* ---- create ---- */

static dvi_status make_first_order(dvi_density *density)
{
  begin(density, &density->one_form);
  if (density->count[DVI_DENSITY_ONE_FORM] == 0) return DVI_OK;
  DVI_TRY(dvi__density_make_one_form(density));
  DVI_TRY(dvi__density_fix_gauge(density));
  return dvi__density_check_two_form(density);
}

/* Where quadratic parts do not depend on time, K and the load stand for their points. */
static void forget_quadratic_points(dvi_density *density)
{
  dvi__integral *quadratic = &density->quadratic;
  if (density->is_fourier || quadratic->depends_on_time) return;
  for (int p = 0; p < quadratic->parts; p++) dvi__density_unbind(quadratic->part[p]);
  dvi__pattern_clear(&quadratic->patterns.qq);
}

static dvi_status make_rooms(dvi_density *density)
{
  const int64_t doubles = dvi__density_room(density);
  dvi__rooms_destroy(&density->rooms);
  return doubles > 0 ? dvi__rooms_create(doubles, &density->rooms) : DVI_OK;
}

static dvi_status make(dvi_density *density, const dvi_density_terms *terms)
{
  density->space = dvi_space_share(terms->space);
  density->dimension = dvi_space_dimension(terms->space);
  density->components = terms->components;
  density->functions = dvi_space_functions(terms->space);
  density->places = density->components * density->functions;
  density->is_fourier = dvi__space_is_fourier(terms->space);
  DVI_TRY(dvi__density_copy_parts(density, terms));
  DVI_TRY(dvi__density_check_kinds(density));
  DVI_TRY(dvi__density_fix(density, terms));
  DVI_TRY(dvi__density_add_fluxes(density, terms));
  DVI_TRY(check_together(density));
  DVI_TRY(make_rooms(density));
  for (int p = 0; p < density->parts; p++) DVI_TRY(dvi__density_bind(density, density->part + p));
  DVI_TRY(make_first_order(density));
  DVI_TRY(make_integrals(density));
  DVI_TRY(dvi__density_make_mass(density));
  DVI_TRY(dvi__density_make_stiffness(density));
  forget_quadratic_points(density);
  if (density->has_rest) DVI_TRY(make_rest(density));
  DVI_TRY(dvi__density_find_fastest(density));
  return dvi__density_make_terms(density, terms);
}

dvi_status dvi_density_create(const dvi_density_terms *terms, dvi_density **density)
{
  if (terms == NULL || density == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: terms and a place for the field are needed");
  *density = NULL;
  DVI_TRY(check_terms(terms));
  dvi_density *made = DVI_NEW(dvi_density, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory");
  const dvi_status status = make(made, terms);
  if (status == DVI_OK)
    *density = made;
  else
    dvi_density_destroy(&made);
  return status;
}

static void clear_integrals(dvi_density *d)
{
  dvi__integral_clear(&d->kinetic);
  dvi__integral_clear(&d->quadratic);
  dvi__integral_clear(&d->one_form);
  dvi__integral_clear(&d->lagrangian);
  for (int i = 0; i < d->potentials; i++) dvi__integral_clear(d->potential + i);
}

void dvi_density_destroy(dvi_density **density)
{
  if (density == NULL || *density == NULL) return;
  dvi_density *d = *density;
  clear_integrals(d);
  for (int p = 0; p < d->parts; p++) dvi__density_part_clear(d->part + p);
  for (int i = 0; i < d->movers; i++) dvi__release(d->mover[i].x);
  void *const arrays[] = {
      d->unknown,    d->number,          d->fixed,          d->site, d->mover,          d->constant,
      d->part,       d->gauge,           d->potential,      d->load, d->potential_term, d->no_start,
      d->mass_start, d->stiffness_start, d->gradients_start};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  dvi__csr_clear(&d->mass);
  dvi__csr_clear(&d->stiffness);
  dvi__csr_clear(&d->gradients);
  dvi__rooms_destroy(&d->rooms);
  dvi_space_destroy(&d->space);
  dvi__release(d);
  *density = NULL;
}

/* ---- questions ---- */

const dvi_space *dvi_density_space(const dvi_density *density)
{
  return density != NULL ? density->space : NULL;
}

int dvi_density_components(const dvi_density *density)
{
  return density != NULL ? density->components : 0;
}

const int *dvi_density_unknowns(const dvi_density *density, int64_t *unknowns)
{
  if (unknowns != NULL) *unknowns = density != NULL ? density->unknowns : 0;
  return density != NULL ? density->unknown : NULL;
}
