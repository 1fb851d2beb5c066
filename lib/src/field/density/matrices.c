/* The constant matrices of a field: the mass of its kinetic parts, and the stiffness K and the load
 * b of its quadratic parts,
 *
 *     L = q'.M q'/2 - q.K q/2 + b.q - rest + ..
 *
 * A time-dependent load is not in b. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/density/density.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for matrices");
}

dvi_status dvi__density_refuse(int failed, const char *where)
{
  if (failed == 0) return DVI_OK;
  if (failed == DVI_NO_MEMORY) return no_memory();
  return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "density: a callback returned %d in %s", failed, where);
}

/* ---- sparse matrices of integrals ---- */

static dvi_status refuse_entry(const dvi_density *density, int64_t row, double value,
                               const char *what)
{
  const int64_t place = density->unknown[row];
  return dvi__fail(DVI_NOT_FINITE,
                   "density: the %s has the entry %g at function %lld of component %d: look for "
                   "coefficients and fixed values that are not finite",
                   what, value, (long long)(place % density->functions),
                   (int)(place / density->functions));
}

static dvi_status check_finite(const dvi_density *density, const dvi__csr *matrix, const char *what)
{
  for (int64_t i = 0; i < matrix->rows; i++)
    for (int64_t e = matrix->start[i]; e < matrix->start[i + 1]; e++)
      if (!isfinite(matrix->value[e])) return refuse_entry(density, i, matrix->value[e], what);
  return DVI_OK;
}

dvi_status dvi__matrix_of_pattern(const dvi__pattern *pattern, dvi__csr *matrix)
{
  const int entries = dvi__pattern_entries(pattern);
  DVI_TRY(dvi__csr_allocate(pattern->rows, pattern->columns, entries, matrix));
  for (int i = 0; i <= pattern->rows; i++) matrix->start[i] = pattern->start[i];
  memcpy(matrix->column, pattern->row, (size_t)entries * sizeof(int));
  return DVI_OK;
}

/* Take roundings out, by which an entry differs from its mirror image. */
static void make_symmetric(dvi__csr *matrix)
{
  for (int64_t i = 0; i < matrix->rows; i++)
    for (int64_t e = matrix->start[i]; e < matrix->start[i + 1]; e++) {
      if (matrix->column[e] >= i) break;
      const int64_t mirror = dvi__csr_find(matrix, matrix->column[e], (int)i);
      matrix->value[e] = matrix->value[mirror] = 0.5 * (matrix->value[e] + matrix->value[mirror]);
    }
}

/* ---- the mass ---- */

static int is_diagonal(const dvi__csr *matrix)
{
  for (int64_t i = 0; i < matrix->rows; i++)
    if (matrix->start[i + 1] != matrix->start[i] + 1 || matrix->column[i] != i) return 0;
  return 1;
}

static double scalar_of(const dvi__csr *matrix)
{
  for (int64_t i = 1; i < matrix->rows; i++)
    if (matrix->value[i] != matrix->value[0]) return 0;
  return matrix->value[0];
}

static dvi_status refuse_component(int component, const char *why)
{
  return dvi__fail(DVI_SINGULAR, "density: the mass of component %d is singular: %s", component,
                   why);
}

static double diagonal_of(const dvi__csr *matrix, int64_t i)
{
  const int64_t at = dvi__csr_find(matrix, i, (int)i);
  return at >= 0 ? fabs(matrix->value[at]) : 0;
}

/* Refuse an entry of the diagonal that is 0. */
static dvi_status check_diagonal(const dvi_density *density, int may_vanish)
{
  double most = 0;
  for (int64_t i = 0; i < density->unknowns; i++) most = fmax(most, diagonal_of(&density->mass, i));
  for (int64_t i = 0; i < density->unknowns; i++)
    if (!(diagonal_of(&density->mass, i) > 1e-14 * most) && !may_vanish)
      return refuse_component(
          (int)(density->unknown[i] / density->functions),
          "give it a kinetic part that vanishes nowhere, more quadrature points, or "
          "fixed values");
  return DVI_OK;
}

/* Take the block of a component. */
static dvi_status component_block(const dvi_density *density, int component, dvi__csr *block)
{
  const dvi_matrix M = dvi__csr_view(&density->mass, 1);
  int *number = DVI_NEW(int, density->unknowns);
  int count = 0;
  if (number == NULL) return no_memory();
  for (int64_t i = 0; i < density->unknowns; i++)
    number[i] = density->unknown[i] / density->functions == component ? count++ : -1;
  const dvi__selection own = {.row = number, .column = number, .rows = count, .columns = count};
  const dvi_status status = dvi__csr_select(&M, &own, block);
  dvi__release(number);
  return status;
}

static dvi_status try_factor(const dvi_density *density, const dvi__csr *matrix)
{
  const dvi_matrix view = dvi__csr_view(matrix, 1);
  dvi__definite solver = {0};
  dvi_status status = dvi__definite_create(&view, density->dimension, &solver);
  if (status == DVI_SINGULAR) status = dvi__regular_create(&view, &solver);
  dvi__definite_clear(&solver);
  return status;
}

/* Find the component whose block is singular. */
static dvi_status check_regular(const dvi_density *density)
{
  dvi_status status = try_factor(density, &density->mass);
  if (status != DVI_SINGULAR) return status;
  for (int c = 0; c < density->components; c++) {
    dvi__csr block = {0};
    DVI_TRY(component_block(density, c, &block));
    status = block.rows > 0 ? try_factor(density, &block) : DVI_OK;
    dvi__csr_clear(&block);
    if (status == DVI_SINGULAR)
      return refuse_component(c, "take more quadrature points, or a kinetic part of one sign");
  }
  return refuse_component(density->components - 1,
                          "its rates occur beside those of other components alone: give it a "
                          "square of its own rate");
}

static dvi_status make_sparse_mass(dvi_density *density)
{
  const dvi__integral *kinetic = &density->kinetic;
  DVI_TRY(dvi__matrix_of_pattern(&kinetic->patterns.vv, &density->mass));
  const dvi__density_sums sums = {.vv = density->mass.value};
  const int failed = dvi__integral_evaluate(kinetic, &(dvi__density_point){0}, &sums);
  return dvi__density_refuse(failed, "a kinetic part");
}

dvi_status dvi__density_make_mass(dvi_density *density)
{
  int is_constant = 1;
  if (density->kinetic.parts == 0) return DVI_OK;
  if (density->is_fourier)
    DVI_TRY(dvi__fourier_matrix(&density->kinetic, &density->mass, &is_constant));
  else
    DVI_TRY(make_sparse_mass(density));
  if (!is_constant)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: the coefficients of kinetic part '%s' vary in x, which couples all "
                     "modes of fourier: take kind=spline or fem, or make the part general",
                     density->kinetic.part[0]->name);
  DVI_TRY(check_finite(density, &density->mass, "mass"));
  make_symmetric(&density->mass);
  dvi__csr_drop_zeros(&density->mass);
  density->mass_is_diagonal = is_diagonal(&density->mass);
  DVI_TRY(check_diagonal(density, !density->mass_is_diagonal && density->components > 1));
  if (!density->mass_is_diagonal) return check_regular(density);
  density->mass_scalar = scalar_of(&density->mass);
  return DVI_OK;
}

/* ---- the stiffness ---- */

static dvi_status make_sparse_stiffness(dvi_density *density, double *zero)
{
  const dvi__integral *quadratic = &density->quadratic;
  DVI_TRY(dvi__matrix_of_pattern(&quadratic->patterns.qq, &density->stiffness));
  const dvi__density_sums sums = {
      .value = &density->rest, .q = density->load, .qq = density->stiffness.value};
  const int failed = dvi__integral_evaluate(quadratic, &(dvi__density_point){.q = zero}, &sums);
  return dvi__density_refuse(failed, "a quadratic part");
}

/* Coefficients that vary leave a potential without a Hessian of the matrix. */
static dvi_status make_fourier_stiffness(dvi_density *density, double *zero)
{
  const dvi__density_sums sums = {.value = &density->rest, .q = density->load};
  int is_constant;
  DVI_TRY(dvi__fourier_matrix(&density->quadratic, &density->stiffness, &is_constant));
  density->has_rest = !is_constant || density->quadratic.depends_on_time;
  const int failed = dvi__integral_evaluate(&density->quadratic, &(dvi__density_point){.q = zero},
                                            &sums);
  return dvi__density_refuse(failed, "a quadratic part");
}

dvi_status dvi__density_make_stiffness(dvi_density *density)
{
  const int64_t n = density->unknowns;
  density->load = DVI_NEW(double, n);
  double *zero = DVI_NEW(double, n);
  dvi_status status = density->load != NULL && zero != NULL ? DVI_OK : no_memory();
  if (status == DVI_OK && density->quadratic.parts == 0)
    status = dvi__csr_allocate(n, n, 0, &density->stiffness);
  else if (status == DVI_OK)
    status = density->is_fourier ? make_fourier_stiffness(density, zero)
                                 : make_sparse_stiffness(density, zero);
  dvi__release(zero);
  for (int64_t i = 0; i < n && status == DVI_OK; i++) density->load[i] = -density->load[i];
  if (status == DVI_OK) make_symmetric(&density->stiffness);
  if (status == DVI_OK) dvi__csr_drop_zeros(&density->stiffness);
  if (status == DVI_OK) status = check_finite(density, &density->stiffness, "stiffness");
  for (int64_t i = 0; i < n && status == DVI_OK; i++) {
    density->has_load |= density->load[i] != 0;
    if (!isfinite(density->load[i])) status = refuse_entry(density, i, density->load[i], "load");
  }
  if (status == DVI_OK) dvi__find_repeated_rows(&density->stiffness, &density->repeated);
  return status;
}

/* ---- questions ---- */

dvi_status dvi_density_matrix(const dvi_density *density, dvi_field_operator name,
                              dvi_matrix *matrix)
{
  if (density == NULL || matrix == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field and a matrix are needed");
  if (name != DVI_FIELD_MASS && name != DVI_FIELD_STIFFNESS)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: there is no operator %d", (int)name);
  const int has = name == DVI_FIELD_MASS ? density->kinetic.parts : density->quadratic.parts;
  if (has == 0)
    return dvi__fail(DVI_UNSUPPORTED, "density: the field has no %s, since it has no %s part",
                     name == DVI_FIELD_MASS ? "mass" : "stiffness",
                     name == DVI_FIELD_MASS ? "kinetic" : "quadratic");
  *matrix = dvi__csr_view(name == DVI_FIELD_MASS ? &density->mass : &density->stiffness, 1);
  if (name == DVI_FIELD_MASS && density->mass_is_diagonal)
    *matrix = (dvi_matrix){.rows = density->unknowns,
                           .columns = density->unknowns,
                           .width = 1,
                           .symmetric = 1,
                           .value = density->mass.value};
  return DVI_OK;
}

dvi_status dvi_density_fastest(const dvi_density *density, double *omega)
{
  if (density == NULL || omega == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field and a place for its frequency are needed");
  if (density->kinetic.parts == 0)
    return dvi__fail(DVI_UNSUPPORTED, "density: the field has no mass, and no frequencies");
  *omega = density->fastest;
  return DVI_OK;
}
