/* Lattices from their terms: checks, copies, and the parts of the density. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/lattice.h"

/* ---- parts of the density ---- */

static const char *const kind_name[] = {"kinetic", "quadratic", "potential", "one-form", "general"};

static dvi_status check_part(const dvi_density_part *given, int number)
{
  if (given->kind > DVI_DENSITY_GENERAL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: part %d has the kind %d, which is none",
                     number, (int)given->kind);
  if (given->kind == DVI_DENSITY_ONE_FORM)
    return dvi__fail(DVI_UNSUPPORTED,
                     "multisymplectic: part %d is a one-form; fields of first order are for the "
                     "methods of dvi_density_system",
                     number);
  if (given->variables < 1 || given->variables > DVI_JETS_MAX || given->variable == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: part %d has %d variables; 1 to %d are possible", number,
                     given->variable != NULL ? given->variables : 0, DVI_JETS_MAX);
  if (given->density == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: part %d has no density", number);
  if (given->pairs < 0 || (given->pairs > 0 && given->pair == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: %d pairs of part %d are announced, and not given",
                     given->pairs, number);
  return DVI_OK;
}

/* A variable is a value, a rate, or a first derivative along one axis. */
static dvi_status take_variable(const dvi__lattice *lattice, const dvi_jet *jet,
                                const dvi__lattice_part *part, dvi__lattice_variable *kept)
{
  int total = 0;
  *kept = (dvi__lattice_variable){jet->component, jet->rate != 0, -1};
  if (jet->component < 0 || jet->component >= lattice->components)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: the density %s has a variable of component %d of %d",
                     part->name, jet->component, lattice->components);
  for (int d = 0; d < DVI_AXES_MAX; d++) {
    if (jet->order[d] == 0) continue;
    total += jet->order[d] < 0 || d >= lattice->axes ? 2 : jet->order[d];
    kept->axis = d;
  }
  if (total + kept->is_rate > 1)
    return dvi__fail(DVI_UNSUPPORTED,
                     "multisymplectic: the density %s has a variable that is no value, no rate and "
                     "no first derivative along one axis",
                     part->name);
  const dvi_density_kind kind = part->declared.kind;
  if ((kind == DVI_DENSITY_KINETIC && !kept->is_rate) ||
      ((kind == DVI_DENSITY_QUADRATIC || kind == DVI_DENSITY_POTENTIAL) && kept->is_rate))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: the density %s is %s, and has a variable that %s",
                     part->name, kind_name[kind], kept->is_rate ? "is a rate" : "is no rate");
  return DVI_OK;
}

static dvi_status take_pairs(const dvi_density_part *given, dvi__lattice_part *part)
{
  int count = 0;
  for (int a = 0; a < part->variables && given->pair == NULL; a++)
    for (int b = 0; b <= a; b++, count++) part->pair[count][0] = a, part->pair[count][1] = b;
  for (int k = 0; given->pair != NULL && k < part->pairs; k++) {
    const int a = given->pair[k][0], b = given->pair[k][1];
    if (a < b || b < 0 || a >= part->variables)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "multisymplectic: the density %s has the pair (%d, %d); variables a >= b "
                       "from 0 to %d are possible",
                       part->name, a, b, part->variables - 1);
    part->pair[k][0] = a, part->pair[k][1] = b;
  }
  return DVI_OK;
}

static dvi_status make_part(const dvi_multisymplectic_terms *terms, const dvi__lattice *lattice,
                            int number, dvi__lattice_part *part)
{
  const dvi_density_part *given = &terms->part[number];
  const int all = given->variables * (given->variables + 1) / 2;
  const int levels = terms->weights.levels != 0 && given->kind == DVI_DENSITY_POTENTIAL,
            is_constant = given->kind == DVI_DENSITY_KINETIC; /* rates are, from level to level */
  DVI_TRY(check_part(given, number));
  snprintf(part->name, sizeof part->name, "%s",
           given->name != NULL ? given->name : kind_name[given->kind]);
  part->declared = *given;
  part->declared.name = NULL, part->declared.variable = NULL, part->declared.pair = NULL;
  part->variables = given->variables;
  part->pairs = given->pair != NULL ? given->pairs : all;
  part->time = dvi__two_points_of(is_constant ? 0.25 : levels ? 0 : lattice->time_weight);
  part->variable = DVI_NEW(dvi__lattice_variable, part->variables);
  part->pair = (int(*)[2])dvi__allocate((size_t)part->pairs, sizeof *part->pair);
  part->varies = DVI_NEW(char, part->pairs);
  part->is_zero = DVI_NEW(char, part->pairs);
  if (part->variable == NULL || part->pair == NULL || part->varies == NULL || part->is_zero == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for the density %s", part->name);
  for (int a = 0; a < part->variables; a++)
    DVI_TRY(take_variable(lattice, &given->variable[a], part, &part->variable[a]));
  return take_pairs(given, part);
}

/* Second derivatives in a step's matrix are constant if parts say so, or stand at the levels. */
static int is_linear(const dvi__lattice_part *part)
{
  const dvi_density_kind kind = part->declared.kind;
  return kind == DVI_DENSITY_KINETIC || kind == DVI_DENSITY_QUADRATIC ||
         (kind == DVI_DENSITY_POTENTIAL && part->time.value[0][1] == 0);
}

static dvi_status make_parts(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice)
{
  if (terms->parts < 1 || terms->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: the density has no parts");
  lattice->part = DVI_NEW(dvi__lattice_part, terms->parts);
  if (lattice->part == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for parts");
  lattice->is_linear = 1;
  for (; lattice->parts < terms->parts; lattice->parts++) {
    dvi__lattice_part *part = &lattice->part[lattice->parts];
    const dvi_status status = make_part(terms, lattice, lattice->parts, part);
    if (status != DVI_OK) {
      lattice->parts++;
      return status;
    }
    lattice->is_linear = lattice->is_linear && is_linear(part);
  }
  return DVI_OK;
}

/* ---- symmetries ---- */

static dvi_status make_symmetries(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice)
{
  size_t length = 0;
  if (terms->symmetries < 0 || (terms->symmetries > 0 && terms->symmetry == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: %d symmetries are announced, and not given",
                     terms->symmetries);
  for (int i = 0; i < terms->symmetries; i++) {
    const dvi_multisymplectic_symmetry *s = &terms->symmetry[i];
    if (s->name == NULL || s->name[0] == '\0' || s->field == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: symmetry %d has no name or no field", i);
    length += strlen(s->name) + 1;
  }
  lattice->symmetry = dvi__duplicate(terms->symmetry, (size_t)terms->symmetries,
                                     sizeof *lattice->symmetry);
  lattice->names = DVI_NEW(char, length);
  if (lattice->symmetry == NULL || lattice->names == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for symmetries");
  char *next = lattice->names;
  for (int i = 0; i < terms->symmetries; i++) {
    const size_t size = strlen(terms->symmetry[i].name) + 1;
    memcpy(next, terms->symmetry[i].name, size);
    lattice->symmetry[i].name = next;
    next += size;
  }
  lattice->symmetries = terms->symmetries;
  return DVI_OK;
}

/* ---- weights ---- */

static int is_held(const dvi__lattice *lattice, int d, int end)
{
  for (int64_t i = 0; i < lattice->size; i++) {
    int index[DVI_AXES_MAX];
    dvi__lattice_vertex_index(lattice, i % lattice->vertices, index);
    if (index[d] == end * lattice->axis[d].cells && lattice->unknown[i] >= 0) return 0;
  }
  return 1;
}

/* With the midpoint in space the mass does not see values that alternate along an axis. */
static dvi_status check_masses(const dvi__lattice *lattice)
{
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    if (a->weight < 0.25) continue;
    if (lattice->time_weight < 0.25)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "multisymplectic: axis %s has the weight 1/4, with which no step is stable "
                       "unless the weight of time, which is %g, is 1/4, too",
                       a->name, lattice->time_weight);
    if (a->is_periodic && a->cells % 2 == 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "multisymplectic: the midpoint in space does not see values that alternate "
                       "along axis %s, which has %d periodic cells; take an odd number of cells",
                       a->name, a->cells);
    if (!a->is_periodic && !is_held(lattice, d, 0) && !is_held(lattice, d, 1))
      return dvi__fail(
          DVI_BAD_ARGUMENT,
          "multisymplectic: the midpoint in space does not see values that alternate "
          "along axis %s, whose ends are free; fix one of them, or take another weight",
          a->name);
  }
  return DVI_OK;
}

/* ---- create ---- */

dvi_status dvi__lattice_make(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice)
{
  DVI_TRY(dvi__lattice_make_axes(terms, lattice));
  lattice->time_weight = terms->weights.time;
  DVI_TRY(dvi__check_weight(lattice->time_weight, "time"));
  DVI_TRY(dvi__lattice_make_cells(lattice));
  DVI_TRY(make_parts(terms, lattice));
  DVI_TRY(make_symmetries(terms, lattice));
  DVI_TRY(dvi__lattice_make_conditions(terms, lattice));
  DVI_TRY(check_masses(lattice));
  lattice->work = DVI_NEW(double, dvi__batch_work(lattice));
  if (lattice->work == NULL) return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for work");
  DVI_TRY(dvi__lattice_probe(lattice));
  return dvi__lattice_find_bound(lattice);
}

static void clear_part(dvi__lattice_part *part)
{
  dvi__release(part->variable);
  dvi__release(part->pair);
  dvi__release(part->varies);
  dvi__release(part->is_zero);
}

static void clear_condition(dvi__lattice_condition *condition)
{
  dvi__release(condition->place);
  dvi__release(condition->x);
  dvi__release(condition->datum);
  dvi__release(condition->weight);
  dvi__release(condition->shape);
}

void dvi__lattice_clear(dvi__lattice *lattice)
{
  for (int d = 0; d < DVI_AXES_MAX; d++) dvi__release(lattice->axis[d].node);
  for (int i = 0; i < lattice->parts; i++) clear_part(&lattice->part[i]);
  for (int i = 0; i < lattice->conditions; i++) clear_condition(&lattice->condition[i]);
  dvi__release(lattice->corner);
  dvi__release(lattice->part);
  dvi__release(lattice->condition);
  dvi__release(lattice->symmetry);
  dvi__release(lattice->names);
  dvi__release(lattice->unknown);
  dvi__release(lattice->work);
  dvi__pattern_clear(&lattice->pattern);
  *lattice = (dvi__lattice){0};
}
