/* What all fields have: a k-form q with the discrete Lagrangian
 *
 *     L = q'.M_k q'/2 - (d_k q).M_{k+1} (d_k q)/2 + load.q
 *
 * Rows and columns of the cells that are held are taken away, and what their values pull at their
 * neighbours is added to the load. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

void dvi_field_destroy(dvi_field **field)
{
  if (field == NULL || *field == NULL) return;
  dvi_field *f = *field;
  dvi_star_destroy(&f->star);
  int *const ints[] = {f->unknown,     f->number,         f->component, f->mass_start,
                       f->stiff_start, f->diagonal_start, f->no_start,  f->damping_start};
  double *const doubles[] = {f->fixed, f->load, f->weight, f->point};
  for (size_t i = 0; i < sizeof ints / sizeof *ints; i++) dvi__release(ints[i]);
  for (size_t i = 0; i < sizeof doubles / sizeof *doubles; i++) dvi__release(doubles[i]);
  for (int i = 0; i < f->translations; i++) dvi__csr_clear(&f->translation[i].D);
  for (int i = 0; i < f->currents; i++) {
    dvi__release(f->current[i].unknown);
    dvi__release(f->current[i].weight);
  }
  for (int i = 0; i < f->probes; i++) dvi__probe_clear(f->probe + i);
  dvi__release(f->current);
  dvi__release(f->probe);
  dvi__csr_clear(&f->damping);
  dvi__csr_clear(&f->mass);
  dvi__csr_clear(&f->stiffness);
  dvi__release(f);
  *field = NULL;
}

/* ---- matrices ---- */

dvi_status dvi__field_select(const dvi_field *field, const dvi_matrix *A, dvi__csr *part)
{
  const dvi__selection unknowns = {.row = field->number,
                                   .column = field->number,
                                   .rows = field->unknowns,
                                   .columns = field->unknowns};
  return dvi__csr_select(A, &unknowns, part);
}

/* Give an entry of a diagonal. */
static double entry_at(const dvi_matrix *M, int64_t i)
{
  for (int64_t e = dvi__first_entry(M, i); e < dvi__first_entry(M, i + 1); e++)
    if (dvi__entry_column(M, i, e) == i) return dvi__entry_value(M, e);
  return 0;
}

/* Tell what has other entries. Shares have few stars that are not diagonal. */
static const char *remedy_of(const dvi_field *field)
{
  const int is_share = field->mesh->share != NULL;
  if (field->degree == 0)
    return is_share ? "take a barycentric star and midpoint, other points, or another density"
                    : "take a barycentric star, other points, or another density";
  return is_share ? "repair the mesh (dvi mesh tells how), or take other points, or a Whitney star "
                    "in one process"
                  : "take a Whitney star, repair the mesh (dvi mesh tells how), or other points";
}

static dvi_status refuse_entry(const dvi_field *field, int k, int64_t cell, double entry)
{
  const dvi__cell_name name = dvi__name_cell(field->mesh, k, cell);
  return dvi__fail(DVI_SINGULAR, "field: M_%d has the entry %g at %s, which is not positive: %s", k,
                   entry, name.text, remedy_of(field));
}

static dvi_status make_mass(dvi_field *field)
{
  dvi_matrix M;
  DVI_TRY(dvi_star_matrix(field->star, field->degree, &M));
  for (int64_t i = 0; i < field->unknowns; i++) {
    const double entry = entry_at(&M, field->unknown[i]);
    if (!(entry > 0) && dvi__owns(field->mesh, field->degree, field->unknown[i]))
      return refuse_entry(field, field->degree, field->unknown[i], entry);
  }
  field->mass_is_diagonal = M.column == NULL;
  return dvi__field_select(field, &M, &field->mass);
}

static double diagonal_of(const dvi__csr *matrix, int64_t i)
{
  const int64_t at = dvi__csr_find(matrix, i, (int)i);
  return at >= 0 ? fabs(matrix->value[at]) : 0;
}

/* Let unknowns of other processes have the masses that these find. Their stars are cut. */
static dvi_status refresh_mass(dvi_field *field, double *form)
{
  if (field->mesh->share == NULL) return DVI_OK;
  if (!field->mass_is_diagonal)
    return dvi__refuse_share_but(field->mesh, "field: a star that is not diagonal",
                                 "the circumcentric star");
  for (int64_t i = 0; i < field->unknowns; i++) form[field->unknown[i]] = field->mass.value[i];
  DVI_TRY(dvi__refresh(field->mesh, field->degree, form));
  for (int64_t i = 0; i < field->unknowns; i++) field->mass.value[i] = form[field->unknown[i]];
  return DVI_OK;
}

/* Leave out what roundings made of zeros, as at the edges of Kuhn's simplices without a dual. They
 * are judged beside their own row and column, because other places may be much stiffer. `diagonal`
 * is [cells]. */
static dvi_status drop_roundings(const dvi_field *field, double *diagonal, dvi__csr *matrix)
{
  const int *cell = field->unknown;
  for (int64_t i = 0; i < matrix->rows; i++) diagonal[cell[i]] = diagonal_of(matrix, i);
  DVI_TRY(dvi__refresh(field->mesh, field->degree, diagonal));
  for (int64_t i = 0; i < matrix->rows; i++)
    for (int64_t e = matrix->start[i]; e < matrix->start[i + 1]; e++) {
      const int j = matrix->column[e];
      const double least = fmin(diagonal[cell[i]], diagonal[cell[j]]);
      if (j != i && fabs(matrix->value[e]) < 1e-15 * least) matrix->value[e] = 0;
    }
  dvi__csr_drop_zeros(matrix);
  return DVI_OK;
}

dvi_status dvi__field_take_rest(dvi_field *field, double factor, const double *form)
{
  const dvi_mesh *mesh = field->mesh;
  dvi__block_sum sum = {.count = 0};
  double part;
  for (int64_t v = 0; v < field->cells; v++) {
    const double term = factor * field->fixed[v] * form[v];
    if (mesh->share == NULL)
      field->rest -= term;
    else if (dvi__owns(mesh, field->degree, v))
      dvi__block_sum_add(&sum, term);
  }
  if (mesh->share == NULL) return DVI_OK;
  DVI_TRY(dvi__sum_of_all(mesh, dvi__block_sum_end(&sum), &part));
  field->rest -= part;
  return DVI_OK;
}

/* The load gets minus the columns of the fixed values f. Their own energy, f.K f/2 - load.f with
 * the load before that, is -f.K f/2 - load.f with the load after it. */
dvi_status dvi__field_make_matrices(dvi_field *field, double *load)
{
  dvi__csr whole = {0};
  dvi_status status = make_mass(field);
  if (status == DVI_OK) status = dvi__stiffness(field->star, field->degree, &whole);
  const dvi_matrix view = dvi__csr_view(&whole, 1);
  double *pull = DVI_NEW(double, field->cells);
  if (status == DVI_OK)
    status = pull != NULL ? dvi__field_select(field, &view, &field->stiffness)
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for a load");
  status = dvi__agree(field->mesh, status);
  if (status == DVI_OK) status = refresh_mass(field, pull);
  if (status == DVI_OK) status = drop_roundings(field, pull, &field->stiffness);
  if (status == DVI_OK) {
    dvi_matrix_multiply(&view, 0, field->fixed, pull);
    for (int64_t v = 0; v < field->cells; v++) load[v] -= pull[v];
    status = dvi__field_take_rest(field, 0.5, pull);
  }
  dvi__release(pull);
  dvi__csr_clear(&whole);
  return status;
}

/* ---- questions ---- */

double dvi__field_row(const dvi_field *field, const dvi__csr *A, int64_t i, const double *form)
{
  double sum = 0;
  for (int64_t e = A->start[i]; e < A->start[i + 1]; e++)
    sum += A->value[e] * form[field->unknown[A->column[e]]];
  return sum;
}

int dvi_field_degree(const dvi_field *field)
{
  return field != NULL ? field->degree : 0;
}

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
  memcpy(u, field->fixed, (size_t)field->cells * sizeof *u);
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

dvi_status dvi_field_locate(const dvi_field *field, const double *at, int *cell, double *weight)
{
  int64_t number;
  if (field == NULL || at == NULL || cell == NULL || weight == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field, a point and room for a cell are needed");
  DVI_TRY(dvi__locate_first(field->mesh, at, weight, &number));
  if (number < 0) return dvi__fail(DVI_BAD_ARGUMENT, "field: the point lies outside of the mesh");
  *cell = (int)dvi__find_number(field->mesh, field->mesh->n, number);
  return DVI_OK;
}

/* Add the numbers of the cells that this process owns. */
static dvi_status add_terms(const dvi_field *f, int64_t count, const int *cell,
                            dvi_field_term *term, void *user, dvi__block_sum *sum)
{
  if (cell == NULL) count = f->mesh->count[f->degree];
  for (int64_t i = 0; i < count; i++) {
    const int64_t c = cell != NULL ? cell[i] : i;
    double number;
    if (!dvi__owns(f->mesh, f->degree, c)) continue;
    const int failed = term(c, &number, user);
    if (failed != 0)
      return dvi__fail(DVI_CALLBACK_FAILED, "field: the term of a sum at %s failed with code %d",
                       dvi__name_cell(f->mesh, f->degree, c).text, failed);
    dvi__block_sum_add(sum, number);
  }
  return DVI_OK;
}

dvi_status dvi_field_sum(const dvi_field *field, int64_t count, const int *cell,
                         dvi_field_term *term, void *user, double *sum)
{
  dvi__block_sum block = {.count = 0};
  double total;
  if (field == NULL || count < 0 || term == NULL || sum == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field, a term and a place for a sum are needed");
  DVI_TRY(dvi__agree(field->mesh, add_terms(field, count, cell, term, user, &block)));
  DVI_TRY(dvi__sum_of_all(field->mesh, dvi__block_sum_end(&block), &total));
  if (!isfinite(total)) return dvi__fail(DVI_NOT_FINITE, "field: a sum is not finite");
  *sum = total;
  return DVI_OK;
}
