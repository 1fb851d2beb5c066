/* An electromagnetic field, with the discrete Lagrangian of its potential A, a k-form,
 *
 *     L = A'.M_k A'/2 - (d A).M_{k+1} (d A)/2 + J.A
 *
 * with the permittivity in M_k and the inverse permeability in M_{k+1}. Perfect electric conductors
 * hold A on their cells. Source: Stern 2009, secs. 3.2 and 3.3. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

/* ---- checks ---- */

static dvi_status check_arrays(const dvi_maxwell_terms *terms)
{
  const struct {
    const char *what;
    int count;
    const void *array;
  } list[] = {{"walls", terms->walls, terms->wall},
              {"currents", terms->currents, terms->current},
              {"probes", terms->probes, terms->probe}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (list[i].count < 0 || (list[i].count > 0 && list[i].array == NULL))
      return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: %d %s are announced, and none is given",
                       list[i].count, list[i].what);
  if (terms->currents > DVI__CURRENTS)
    return dvi__fail(DVI_BAD_SIZE, "maxwell: %d currents; at most %d are possible", terms->currents,
                     DVI__CURRENTS);
  return DVI_OK;
}

static dvi_status check_terms(const dvi_maxwell_terms *terms)
{
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: set terms.size to sizeof(dvi_maxwell_terms)");
  if (terms->star == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a star is needed");
  const dvi_mesh *mesh = terms->star->mesh;
  for (int l = 0; l < mesh->space; l++)
    if (mesh->metric[l] < 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "maxwell: axis %d of the mesh's metric is timelike: the field has a mesh of "
                       "space alone",
                       l);
  if (mesh->n > 3)
    return dvi__fail(DVI_UNSUPPORTED, "maxwell: the mesh has %d dimensions, 1 to 3 are possible",
                     mesh->n);
  return check_arrays(terms);
}

static dvi_status check_wall(const dvi_field *field, const dvi_wall *wall)
{
  int64_t count;
  if (wall->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a wall has no part of the mesh");
  if ((unsigned)wall->kind > DVI_ABSORBING)
    return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: the wall on part \"%s\" has no kind %d",
                     wall->part, (int)wall->kind);
  (void)dvi_mesh_part_cells(field->mesh, wall->part, 0, &count);
  if (count >= 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a wall is on part \"%s\", which the mesh has not",
                   wall->part);
}

/* Matrices that are not diagonal are sums over cells, positive if the factors are. */
static dvi_status check_factors(const dvi_field *field, int k)
{
  const double *factor = field->star->factor[k];
  dvi_matrix M;
  DVI_TRY(dvi_star_matrix(field->star, k, &M));
  for (int64_t c = 0; c < field->mesh->count[field->mesh->n]; c++) {
    if (M.column == NULL || factor == NULL || factor[c] >= 0) continue;
    const dvi__cell_name name = dvi__name_cell(field->mesh, field->mesh->n, c);
    return dvi__fail(DVI_SINGULAR,
                     "maxwell: the factor of M_%d is %g in %s, so that waves would grow; 0 or more "
                     "is possible",
                     k, factor[c], name.text);
  }
  return DVI_OK;
}

/* A negative M_{k+1} makes waves grow. */
static dvi_status check_permeability(const dvi_field *field)
{
  dvi_matrix M;
  DVI_TRY(dvi_star_matrix(field->star, field->degree + 1, &M));
  if (M.column != NULL) return DVI_OK;
  int64_t worst = -1;
  for (int64_t f = 0; f < M.rows; f++)
    if (dvi__owns(field->mesh, field->degree + 1, f) && (worst < 0 || M.value[f] < M.value[worst]))
      worst = f;
  if (worst < 0 || M.value[worst] >= 0) return DVI_OK;
  const dvi__cell_name name = dvi__name_cell(field->mesh, field->degree + 1, worst);
  return dvi__fail(DVI_SINGULAR,
                   "maxwell: M_%d has the entry %g at %s, so that waves would grow: take a "
                   "Whitney star, repair the mesh (dvi mesh tells how), or other points",
                   field->degree + 1, M.value[worst], name.text);
}

/* ---- create ---- */

/* Hold the cells of an electric wall. One that has vertices alone would be lost without a word. */
static dvi_status hold_wall(dvi_field *field, const dvi_wall *wall)
{
  int64_t count;
  const int *cell = dvi_mesh_part_cells(field->mesh, wall->part, field->degree, &count);
  for (int64_t c = 0; c < count; c++) field->number[cell[c]] = -1;
  if (dvi__part_total(field->mesh, wall->part, field->degree) > 0 ||
      dvi__part_total(field->mesh, wall->part, 0) == 0)
    return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: the wall on part \"%s\" has no edge", wall->part);
}

static dvi_status hold_conductors(dvi_field *field, const dvi_maxwell_terms *terms)
{
  field->unknown = DVI_NEW(int, field->cells);
  field->number = DVI_NEW(int, field->cells);
  field->fixed = DVI_NEW(double, field->cells);
  if (field->unknown == NULL || field->number == NULL || field->fixed == NULL)
    return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for %lld cells", (long long)field->cells);
  for (int i = 0; i < terms->walls; i++) {
    DVI_TRY(check_wall(field, terms->wall + i));
    if (terms->wall[i].kind == DVI_PEC) DVI_TRY(hold_wall(field, terms->wall + i));
  }
  return DVI_OK;
}

static dvi_status make_matrices(dvi_field *field)
{
  field->load = DVI_NEW(double, field->unknowns);
  double *pull = DVI_NEW(double, field->cells);
  dvi_status status = field->load && pull
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for %lld unknowns",
                                      (long long)field->unknowns);
  status = dvi__agree(field->mesh, status);
  if (status == DVI_OK) status = dvi__field_make_matrices(field, pull);
  dvi__release(pull);
  return status;
}

static dvi_status make(dvi_field *field, const dvi_maxwell_terms *terms)
{
  field->star = dvi_star_share(terms->star);
  field->mesh = field->star->mesh;
  field->degree = terms->scalar || field->mesh->n == 1 ? 0 : 1;
  field->cells = field->mesh->count[field->degree];
  DVI_TRY(dvi__agree(field->mesh, hold_conductors(field, terms)));
  DVI_TRY(dvi__field_number(field));
  dvi_status status = check_permeability(field);
  for (int k = field->degree; k <= field->degree + 1 && status == DVI_OK; k++)
    status = check_factors(field, k);
  DVI_TRY(dvi__agree(field->mesh, status));
  DVI_TRY(make_matrices(field));
  if (field->degree == 0) DVI_TRY(dvi__field_find_components(field));
  DVI_TRY(dvi__agree(field->mesh, dvi__maxwell_make_damping(field, terms)));
  DVI_TRY(dvi__maxwell_make_currents(field, terms));
  return dvi__maxwell_make_probes(field, terms);
}

dvi_status dvi_maxwell_create(const dvi_maxwell_terms *terms, dvi_field **field)
{
  if (terms == NULL || field == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: terms and a place for the field are needed");
  *field = NULL;
  DVI_TRY(check_terms(terms));
  dvi_field *f = DVI_NEW(dvi_field, 1);
  dvi_status status = f != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "maxwell: no memory");
  status = dvi__agree(terms->star->mesh, status);
  if (status == DVI_OK) status = make(f, terms);
  *field = f;
  if (status != DVI_OK) dvi_field_destroy(field);
  return status;
}
