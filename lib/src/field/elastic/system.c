/* A solid as a mechanical system, whose coordinates are the displacements that are not given, with
 * the Lagrangian of elastic.h. */
#include "field/elastic/system.h"

#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/potentials.h"
#include "field/mesh/share.h"

void dvi__solid_system_destroy(dvi__solid_system **system)
{
  dvi__solid_system *s = *system;
  if (s == NULL) return;
  dvi__solid_pattern_clear(&s->pattern);
  void *const arrays[] = {s->start, s->no_start, s->mass,    s->pull,
                          s->load,  s->damping,  s->contact, s->contact_term};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  dvi__release(s);
  *system = NULL;
}

/* ---- what the terms need ---- */

static dvi_status lay_out(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  DVI_TRY(dvi__solid_rest_pattern(e, &s->pattern));
  const dvi__csr *matrix = &s->pattern.matrix;
  if (matrix->start[matrix->rows] > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "elastic: an int cannot count %lld entries of a system's matrix",
                     (long long)matrix->start[matrix->rows]);
  s->start = DVI_NEW(int, e->unknowns + 1);
  s->no_start = DVI_NEW(int, e->unknowns + 1);
  s->mass = DVI_NEW(double, e->unknowns);
  if (s->start == NULL || s->no_start == NULL || s->mass == NULL)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a system");
  for (int64_t i = 0; i <= e->unknowns; i++) s->start[i] = (int)matrix->start[i];
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    if (e->unknown[k] >= 0) s->mass[e->unknown[k]] = e->mass[k / e->n];
  return DVI_OK;
}

/* A solid of linear laws has its matrix as one potential, unless displacements move, which matrices
 * of the unknowns have not. */
static int add_stored(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  const int is_linear = dvi__solid_is_linear(e);
  const char *name = e->is_split ? "stiffness" : "stored";
  int count = 0;
  s->part[0] = (dvi__solid_potential){.system = s, .share = DVI__SOLID_STIFFNESS};
  s->part[1] = (dvi__solid_potential){.system = s,
                                      .share = e->is_split ? DVI__SOLID_REST : DVI__SOLID_STORED};
  if (is_linear || e->is_split)
    s->potential[count++] = e->is_driven ? dvi__solid_cell_potential(&s->part[0], name)
                                         : dvi__solid_matrix_potential(s, name);
  if (!is_linear)
    s->potential[count++] = dvi__solid_cell_potential(&s->part[1], e->is_split ? "rest" : "stored");
  return count;
}

static dvi_status make(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  DVI_TRY(lay_out(s));
  DVI_TRY(dvi__solid_find_fastest(e, &s->pattern.matrix, s->mass));
  DVI_TRY(dvi__solid_make_pull(s));
  DVI_TRY(dvi__solid_make_load(s));
  DVI_TRY(dvi__solid_make_damping(s));
  DVI_TRY(dvi__solid_make_contacts(s));
  DVI_TRY(dvi__solid_find_symmetries(s));
  int potentials = add_stored(s);
  if (e->load_count > 0) s->potential[potentials++] = dvi__solid_load_potential(s);
  s->terms = (dvi_system_terms){.dimension = (int)e->unknowns,
                                .mass = {.diagonal = s->mass},
                                .potentials = s->potential,
                                .potential_count = potentials,
                                .symmetries = s->symmetries > 0 ? s->symmetry_term : NULL,
                                .symmetry_count = s->symmetries,
                                .forces = s->damping != NULL ? &s->force : NULL,
                                .force_count = s->damping != NULL,
                                .contacts = s->contacts > 0 ? s->contact_term : NULL,
                                .contact_count = s->contacts,
                                .autonomous = !e->is_driven && e->has_steady_loads};
  return DVI_OK;
}

/* A share tells what the whole solid keeps. */
static dvi_status make_of_share(dvi__solid_system *s)
{
  DVI_TRY(dvi__agree(s->elastic->mesh, dvi__solid_make_load(s)));
  DVI_TRY(dvi__solid_find_symmetries(s));
  s->terms = (dvi_system_terms){.dimension = (int)s->elastic->unknowns,
                                .symmetries = s->symmetries > 0 ? s->symmetry_term : NULL,
                                .symmetry_count = s->symmetries};
  return DVI_OK;
}

/* ---- the system ---- */

dvi_status dvi_elastic_system_terms(dvi_elastic *elastic, dvi_system_terms *terms)
{
  if (elastic == NULL || terms == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a solid and a place for terms are needed");
  if (elastic->system == NULL) {
    elastic->system = DVI_NEW(dvi__solid_system, 1);
    dvi_status status = elastic->system != NULL
                            ? DVI_OK
                            : dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a system");
    status = dvi__agree(elastic->mesh, status);
    if (status == DVI_OK && elastic->system != NULL) {
      elastic->system->elastic = elastic;
      status = (elastic->mesh->share != NULL ? make_of_share : make)(elastic->system);
    }
    if (status != DVI_OK) {
      dvi__solid_system_destroy(&elastic->system);
      return status;
    }
  }
  *terms = elastic->system->terms;
  return DVI_OK;
}

dvi_status dvi_elastic_system(dvi_elastic *elastic, dvi_system **system)
{
  dvi_system_terms terms;
  if (system == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a place for the system is needed");
  *system = NULL;
  if (elastic != NULL)
    DVI_TRY(dvi__refuse_share(elastic->mesh, "elastic: the mechanical system of a solid"));
  DVI_TRY(dvi_elastic_system_terms(elastic, &terms));
  return dvi_system_create(&terms, system);
}
