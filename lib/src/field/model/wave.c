/* A scalar field on a mesh, with the discrete Lagrangian of its values q at the vertices
 *
 *     L = q'.M_0 q'/2 - (d_0 q).M_1 (d_0 q)/2 - sum_v w_v V(x_v, q_v) + (W f + b).q
 *
 * Rows and columns of fixed values are taken away, and what these values pull at their neighbours
 * is added to the load. Source: Stern 2009, secs. 1.3 and 3.3, with delta d u = -Laplace u. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

/* ---- checks ---- */

static dvi_status check_terms(const dvi_wave_terms *terms)
{
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: set terms.size to sizeof(dvi_wave_terms)");
  if (terms->star == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "field: a star is needed");
  if (terms->conditions < 0 || (terms->conditions > 0 && terms->condition == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "field: %d conditions are announced, and none is given",
                     terms->conditions);
  if (terms->potential != NULL && terms->potential->density == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: the potential has no density");
  const dvi_mesh *mesh = terms->star->mesh;
  for (int l = 0; l < mesh->space; l++)
    if (mesh->metric[l] < 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "field: axis %d of the mesh's metric is timelike: a wave "
                       "has a mesh of space alone",
                       l);
  return DVI_OK;
}

/* ---- loads ---- */

static dvi_status evaluate_source(const dvi_field *field, const dvi_wave_terms *terms, double *f)
{
  const int space = field->mesh->space;
  for (int64_t v = 0; v < field->cells; v++) {
    const int failed = terms->source(field->mesh->point + v * space, f + v, terms->source_user);
    DVI_TRY(dvi__field_check_datum(field, "source", failed, f[v], 0, v));
  }
  return DVI_OK;
}

/* Add W f, and keep the sums of the rows of W. */
static dvi_status add_source(dvi_field *field, const dvi_wave_terms *terms, const dvi_matrix *W,
                             double *load)
{
  double *f = DVI_NEW(double, 2 * field->cells);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for a source");
  double *product = f + field->cells;
  for (int64_t v = 0; v < field->cells; v++) f[v] = 1;
  dvi_matrix_multiply(W, 0, f, product);
  for (int64_t i = 0; i < field->unknowns; i++) field->weight[i] = product[field->unknown[i]];
  dvi_status status = DVI_OK;
  if (terms->source != NULL) {
    status = evaluate_source(field, terms, f);
    if (status == DVI_OK) dvi_matrix_multiply(W, 0, f, product);
    for (int64_t v = 0; v < field->cells && status == DVI_OK; v++) load[v] += product[v];
  }
  dvi__release(f);
  return status;
}

/* W is M_0 without a density. */
static dvi_status add_sources(dvi_field *field, const dvi_wave_terms *terms, double *load)
{
  const dvi_star_options plain = {.size = sizeof plain, .kind = field->star->kind};
  dvi_star *bare = NULL;
  dvi_matrix W;
  dvi_status status = DVI_OK;
  if (field->star->factor[0] != NULL) status = dvi__star_create(field->mesh, &plain, &bare);
  if (status == DVI_OK) status = dvi_star_matrix(bare != NULL ? bare : field->star, 0, &W);
  if (status == DVI_OK) status = add_source(field, terms, &W, load);
  dvi_star_destroy(&bare);
  return status;
}

/* Take the load of the unknowns. */
static dvi_status take_load(dvi_field *field, const double *load)
{
  const int space = field->mesh->space;
  for (int64_t i = 0; i < field->unknowns; i++) {
    const int64_t v = field->unknown[i];
    field->load[i] = load[v];
    DVI_TRY(
        dvi__field_check_datum(field, "sum of source, flux and fixed values", 0, load[v], 0, v));
    memcpy(field->point + i * space, field->mesh->point + v * space,
           (size_t)space * sizeof(double));
  }
  return DVI_OK;
}

static dvi_status make_equations(dvi_field *field, const dvi_wave_terms *terms)
{
  const int space = field->mesh->space;
  double *load = DVI_NEW(double, field->cells);
  field->load = DVI_NEW(double, field->unknowns);
  field->weight = DVI_NEW(double, field->unknowns);
  field->point = DVI_NEW(double, field->unknowns *space);
  dvi_status status = load && field->load && field->weight && field->point
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for %lld unknowns",
                                      (long long)field->unknowns);
  status = dvi__agree(field->mesh, status);
  if (status == DVI_OK) status = dvi__field_make_matrices(field, load);
  if (status == DVI_OK) status = dvi__agree(field->mesh, add_sources(field, terms, load));
  if (status == DVI_OK) status = dvi__field_add_fluxes(field, terms, load);
  if (status == DVI_OK) status = dvi__field_take_rest(field, 1, load);
  if (status == DVI_OK) status = dvi__agree(field->mesh, take_load(field, load));
  dvi__release(load);
  return status;
}

/* ---- create ---- */

static dvi_status make(dvi_field *field, const dvi_wave_terms *terms)
{
  field->star = dvi_star_share(terms->star);
  field->mesh = field->star->mesh;
  field->cells = field->mesh->count[0];
  field->is_wave = 1;
  if (terms->potential != NULL) field->potential = *terms->potential;
  DVI_TRY(dvi__field_fix(field, terms));
  DVI_TRY(make_equations(field, terms));
  return dvi__field_find_components(field);
}

dvi_status dvi_wave_create(const dvi_wave_terms *terms, dvi_field **field)
{
  if (terms == NULL || field == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: terms and a place for the field are needed");
  *field = NULL;
  DVI_TRY(check_terms(terms));
  dvi_field *f = DVI_NEW(dvi_field, 1);
  dvi_status status = f != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "field: no memory");
  status = dvi__agree(terms->star->mesh, status);
  if (status == DVI_OK) status = make(f, terms);
  *field = f;
  if (status != DVI_OK) dvi_field_destroy(field);
  return status;
}
