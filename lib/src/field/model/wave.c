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
#include "field/model/field.h"

void dvi_field_destroy(dvi_field **field)
{
  if (field == NULL || *field == NULL) return;
  dvi_field *f = *field;
  dvi_star_destroy(&f->star);
  int *const ints[] = {f->unknown,    f->number,      f->component,
                       f->mass_start, f->stiff_start, f->diagonal_start};
  double *const doubles[] = {f->fixed, f->load, f->weight, f->point};
  for (size_t i = 0; i < sizeof ints / sizeof *ints; i++) dvi__release(ints[i]);
  for (size_t i = 0; i < sizeof doubles / sizeof *doubles; i++) dvi__release(doubles[i]);
  for (int i = 0; i < f->translations; i++) dvi__csr_clear(&f->translation[i].D);
  dvi__csr_clear(&f->mass);
  dvi__csr_clear(&f->stiffness);
  dvi__release(f);
  *field = NULL;
}

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

static dvi_status check_mass(const dvi_field *field, const dvi_matrix *M)
{
  for (int64_t i = 0; i < field->unknowns; i++) {
    const int64_t v = field->unknown[i];
    double entry = 0;
    for (int64_t e = dvi__first_entry(M, v); e < dvi__first_entry(M, v + 1); e++)
      if (dvi__entry_column(M, v, e) == v) entry = dvi__entry_value(M, e);
    if (entry > 0) continue;
    const dvi__cell_name name = dvi__name_cell(field->mesh, 0, v);
    return dvi__fail(DVI_SINGULAR,
                     "field: M_0 has the entry %g at %s, which is not positive: take a "
                     "barycentric star, other points, or another density",
                     entry, name.text);
  }
  return DVI_OK;
}

/* ---- matrices ---- */

/* Take rows and columns of the unknowns. */
static dvi_status select_unknowns(const dvi_field *field, const dvi_matrix *A, dvi__csr *part)
{
  const dvi__selection unknowns = {.row = field->number,
                                   .column = field->number,
                                   .rows = field->unknowns,
                                   .columns = field->unknowns};
  return dvi__csr_select(A, &unknowns, part);
}

static dvi_status make_mass(dvi_field *field)
{
  dvi_matrix M;
  DVI_TRY(dvi_star_matrix(field->star, 0, &M));
  DVI_TRY(check_mass(field, &M));
  field->mass_is_diagonal = M.column == NULL;
  return select_unknowns(field, &M, &field->mass);
}

static double diagonal_of(const dvi__csr *matrix, int64_t i)
{
  const int64_t at = dvi__csr_find(matrix, i, (int)i);
  return at >= 0 ? fabs(matrix->value[at]) : 0;
}

/* Leave out what roundings made of zeros, as at the edges of Kuhn's simplices without a dual. They
 * are judged beside their own row and column, because other places may be much stiffer. */
static void drop_roundings(dvi__csr *matrix)
{
  for (int64_t i = 0; i < matrix->rows; i++)
    for (int64_t e = matrix->start[i]; e < matrix->start[i + 1]; e++) {
      const int j = matrix->column[e];
      const double least = fmin(diagonal_of(matrix, i), diagonal_of(matrix, j));
      if (j != i && fabs(matrix->value[e]) < 1e-15 * least) matrix->value[e] = 0;
    }
  dvi__csr_drop_zeros(matrix);
}

/* The load gets minus the columns of the fixed values f. Their own energy, f.K f/2 - load.f with
 * the load before that, is -f.K f/2 - load.f with the load after it. */
static dvi_status make_stiffness(dvi_field *field, double *load)
{
  dvi__csr whole = {0};
  DVI_TRY(dvi__stiffness(field->star, 0, &whole));
  const dvi_matrix view = dvi__csr_view(&whole, 1);
  double *pull = DVI_NEW(double, field->vertices);
  dvi_status status = pull != NULL ? select_unknowns(field, &view, &field->stiffness)
                                   : dvi__fail(DVI_NO_MEMORY, "field: no memory for a load");
  if (status == DVI_OK) {
    drop_roundings(&field->stiffness);
    dvi_matrix_multiply(&view, 0, field->fixed, pull);
    for (int64_t v = 0; v < field->vertices; v++) {
      load[v] -= pull[v];
      field->rest -= 0.5 * field->fixed[v] * pull[v];
    }
  }
  dvi__release(pull);
  dvi__csr_clear(&whole);
  return status;
}

/* ---- loads ---- */

static dvi_status evaluate_source(const dvi_field *field, const dvi_wave_terms *terms, double *f)
{
  const int space = field->mesh->space;
  for (int64_t v = 0; v < field->vertices; v++) {
    const int failed = terms->source(field->mesh->point + v * space, f + v, terms->source_user);
    DVI_TRY(dvi__field_check_datum(field, "source", failed, f[v], 0, v));
  }
  return DVI_OK;
}

/* Add W f, and keep the sums of the rows of W. */
static dvi_status add_source(dvi_field *field, const dvi_wave_terms *terms, const dvi_matrix *W,
                             double *load)
{
  double *f = DVI_NEW(double, 2 * field->vertices);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for a source");
  double *product = f + field->vertices;
  for (int64_t v = 0; v < field->vertices; v++) f[v] = 1;
  dvi_matrix_multiply(W, 0, f, product);
  for (int64_t i = 0; i < field->unknowns; i++) field->weight[i] = product[field->unknown[i]];
  dvi_status status = DVI_OK;
  if (terms->source != NULL) {
    status = evaluate_source(field, terms, f);
    if (status == DVI_OK) dvi_matrix_multiply(W, 0, f, product);
    for (int64_t v = 0; v < field->vertices && status == DVI_OK; v++) load[v] += product[v];
  }
  dvi__release(f);
  return status;
}

/* W is M_0 without a density. */
static dvi_status add_loads(dvi_field *field, const dvi_wave_terms *terms, double *load)
{
  const dvi_star_options plain = {.size = sizeof plain, .kind = field->star->kind};
  dvi_star *bare = NULL;
  dvi_matrix W;
  dvi_status status = DVI_OK;
  if (field->star->factor[0] != NULL) status = dvi_star_create(field->mesh, &plain, &bare);
  if (status == DVI_OK) status = dvi_star_matrix(bare != NULL ? bare : field->star, 0, &W);
  if (status == DVI_OK) status = add_source(field, terms, &W, load);
  if (status == DVI_OK) status = dvi__field_add_fluxes(field, terms, load);
  dvi_star_destroy(&bare);
  return status;
}

static dvi_status make_equations(dvi_field *field, const dvi_wave_terms *terms)
{
  const int space = field->mesh->space;
  double *load = DVI_NEW(double, field->vertices);
  field->load = DVI_NEW(double, field->unknowns);
  field->weight = DVI_NEW(double, field->unknowns);
  field->point = DVI_NEW(double, field->unknowns *space);
  dvi_status status = load && field->load && field->weight && field->point
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for %lld unknowns",
                                      (long long)field->unknowns);
  if (status == DVI_OK) status = make_mass(field);
  if (status == DVI_OK) status = make_stiffness(field, load);
  if (status == DVI_OK) status = add_loads(field, terms, load);
  for (int64_t v = 0; v < field->vertices && status == DVI_OK; v++)
    field->rest -= field->fixed[v] * load[v];
  for (int64_t i = 0; i < field->unknowns && status == DVI_OK; i++) {
    const int64_t v = field->unknown[i];
    field->load[i] = load[v];
    status = dvi__field_check_datum(field, "sum of source, flux and fixed values", 0, load[v], 0,
                                    v);
    memcpy(field->point + i * space, field->mesh->point + v * space,
           (size_t)space * sizeof(double));
  }
  dvi__release(load);
  return status;
}

/* ---- create ---- */

static dvi_status make(dvi_field *field, const dvi_wave_terms *terms)
{
  field->star = dvi_star_share(terms->star);
  field->mesh = field->star->mesh;
  field->vertices = field->mesh->count[0];
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
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory");
  const dvi_status status = make(f, terms);
  *field = f;
  if (status != DVI_OK) dvi_field_destroy(field);
  return status;
}

/* ---- questions ---- */

const dvi_star *dvi_field_star(const dvi_field *field)
{
  return field != NULL ? field->star : NULL;
}

const int *dvi_field_unknowns(const dvi_field *field, int64_t *unknowns)
{
  if (unknowns != NULL) *unknowns = field != NULL ? field->unknowns : 0;
  return field != NULL ? field->unknown : NULL;
}

const double *dvi_field_load(const dvi_field *field)
{
  return field != NULL ? field->load : NULL;
}

dvi_status dvi_field_matrix(const dvi_field *field, dvi_field_operator name, dvi_matrix *matrix)
{
  if (field == NULL || matrix == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field and a matrix are needed");
  if (name != DVI_FIELD_MASS && name != DVI_FIELD_STIFFNESS)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: there is no operator %d", (int)name);
  *matrix = dvi__csr_view(name == DVI_FIELD_MASS ? &field->mass : &field->stiffness, 1);
  if (name == DVI_FIELD_MASS && field->mass_is_diagonal)
    *matrix = (dvi_matrix){.rows = field->unknowns,
                           .columns = field->unknowns,
                           .width = 1,
                           .symmetric = 1,
                           .value = field->mass.value};
  return DVI_OK;
}

dvi_status dvi_field_lift(const dvi_field *field, const double *q, double *u)
{
  if (field == NULL || q == NULL || u == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field, unknowns and values are needed");
  memcpy(u, field->fixed, (size_t)field->vertices * sizeof *u);
  for (int64_t i = 0; i < field->unknowns; i++) u[field->unknown[i]] = q[i];
  return DVI_OK;
}

/* p = M u' with the rates of the unknowns. */
static dvi_status weigh(const dvi_field *field, const double *rate, double *p)
{
  const dvi_matrix M = dvi__csr_view(&field->mass, 1);
  double *v = DVI_NEW(double, field->unknowns);
  if (v == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for rates");
  for (int64_t i = 0; i < field->unknowns && rate != NULL; i++) v[i] = rate[field->unknown[i]];
  dvi_matrix_multiply(&M, 0, v, p);
  dvi__release(v);
  return DVI_OK;
}

dvi_status dvi_field_project(const dvi_field *field, const double *u, const double *rate, double *q,
                             double *p)
{
  if (field == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "field: a field is needed");
  if (p != NULL) DVI_TRY(weigh(field, rate, p));
  for (int64_t i = 0; i < field->unknowns && q != NULL; i++)
    q[i] = u != NULL ? u[field->unknown[i]] : 0;
  return DVI_OK;
}
