/* Coefficients of functions on products of axes.
 *
 * f is sampled on a product of points: the nodes of an axis that interpolates, else its quadrature
 * points. Along an axis of the second sort samples become coefficients by the least squares of the
 * quadrature, M U = B^T W f with the mass M = B^T W B. Axes follow one another, because the
 * matrices are Kronecker products. */
#include "field/space/interpolate.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"

static const char *const coordinate[DVI_AXES_MAX] = {"x", "y", "z"};

dvi_status dvi__space_sample(int dimension, const dvi__sampled *f, int64_t count, const double *x,
                             double *values)
{
  char place[128] = "";
  dvi__note note = {place, sizeof place, 0};
  if (f->f(count, x, values, f->user) != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "space: the function to interpolate failed");
  for (int64_t i = 0; i < count; i++) {
    if (isfinite(values[i])) continue;
    for (int d = 0; d < dimension; d++)
      dvi__note_add(&note, "%s%s = %g", d > 0 ? ", " : "", coordinate[d], x[d * count + i]);
    return dvi__fail(DVI_NOT_FINITE, "space: the function to interpolate is %g at %s", values[i],
                     place);
  }
  return DVI_OK;
}

/* ---- one axis ---- */

/* The samples of an axis, and how they become coefficients. */
typedef struct fit {
  int64_t samples, functions;
  double *x; /* [samples] */
  dvi__csr B;
  double *weight; /* [samples], NULL if samples are coefficients */
  dvi__definite mass;
} fit;

static void clear_fit(fit *f)
{
  dvi__release(f->x);
  dvi__release(f->weight);
  dvi__csr_clear(&f->B);
  dvi__definite_clear(&f->mass);
}

static dvi_status factor_mass(fit *f)
{
  const dvi_matrix B = dvi__csr_view(&f->B, 0), W = {.rows = f->samples,
                                                     .columns = f->samples,
                                                     .width = 1,
                                                     .symmetric = 1,
                                                     .value = f->weight};
  dvi__csr mass;
  DVI_TRY(dvi__csr_square(&B, &W, &mass));
  const dvi_matrix view = dvi__csr_view(&mass, 1);
  const dvi_status status = dvi__definite_create(&view, 1, &f->mass);
  dvi__csr_clear(&mass);
  return status == DVI_SINGULAR
             ? dvi__fail_in(status, "space: more points a cell are needed to interpolate")
             : status;
}

static dvi_status take_points(const dvi__line *line, fit *f)
{
  f->samples = dvi__line_points(line);
  f->x = DVI_NEW(double, f->samples);
  f->weight = DVI_NEW(double, f->samples);
  if (f->x == NULL || f->weight == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  for (int64_t i = 0; i < f->samples; i++) f->x[i] = dvi__line_point(line, i, f->weight + i);
  DVI_TRY(dvi__line_operator(line, 0, &f->B));
  return factor_mass(f);
}

static dvi_status take_nodes(const dvi__line *line, fit *f)
{
  f->samples = line->functions;
  f->x = DVI_NEW(double, f->samples);
  if (f->x == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  for (int64_t i = 0; i < f->samples; i++) {
    const int64_t cell = i / line->stride < line->cells ? i / line->stride : line->cells - 1;
    const double s = line->mark[i - cell * line->stride], start = line->node[cell];
    f->x[i] = s == 1 ? line->node[cell + 1] : start + s * (line->node[cell + 1] - start);
  }
  return DVI_OK;
}

/* Replace samples along an axis, whose neighbours are `stride` apart, by coefficients. `work` has
 * place for both. */
static dvi_status solve_line(const fit *f, const double *samples, double *U, int64_t stride,
                             double *work)
{
  double *load = work, *solution = work + f->functions;
  memset(load, 0, (size_t)f->functions * sizeof *load);
  for (int64_t i = 0; i < f->samples; i++)
    for (int64_t e = f->B.start[i]; e < f->B.start[i + 1]; e++)
      load[f->B.column[e]] += f->B.value[e] * f->weight[i] * samples[i * stride];
  DVI_TRY(dvi__definite_solve(&f->mass, load, solution, NULL));
  for (int64_t i = 0; i < f->functions; i++) U[i * stride] = solution[i];
  return DVI_OK;
}

/* ---- the product ---- */

static int64_t product_of(const fit *f, int from, int to, int of_samples)
{
  int64_t product = 1;
  for (int d = from; d < to; d++) product *= of_samples ? f[d].samples : f[d].functions;
  return product;
}

/* Samples of the axes before d are coefficients already. */
static dvi_status fit_axis(const fit *f, int axes, int d, double **values)
{
  const int64_t before = product_of(f, 0, d, 0), after = product_of(f, d + 1, axes, 1);
  if (f[d].weight == NULL) return DVI_OK;
  double *U = DVI_NEW(double, before *f[d].functions *after),
         *work = DVI_NEW(double, 2 * f[d].functions);
  dvi_status status = U != NULL && work != NULL ? DVI_OK
                                                : dvi__fail(DVI_NO_MEMORY, "space: no memory");
  for (int64_t b = 0; b < before && status == DVI_OK; b++)
    for (int64_t a = 0; a < after && status == DVI_OK; a++)
      status = solve_line(&f[d], *values + b * f[d].samples * after + a,
                          U + b * f[d].functions * after + a, after, work);
  dvi__release(work);
  dvi__release(*values);
  *values = U;
  return status;
}

static void lay_out_samples(const fit *f, int axes, double *x)
{
  const int64_t all = product_of(f, 0, axes, 1);
  for (int d = 0; d < axes; d++) {
    const int64_t after = product_of(f, d + 1, axes, 1);
    for (int64_t i = 0; i < all; i++) x[d * all + i] = f[d].x[i / after % f[d].samples];
  }
}

static dvi_status sample_product(const fit *f, int axes, const dvi__sampled *sampled,
                                 double **values)
{
  const int64_t all = product_of(f, 0, axes, 1);
  double *x = DVI_NEW(double, axes *all);
  *values = DVI_NEW(double, all);
  if (x == NULL || *values == NULL) {
    dvi__release(x);
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %lld samples", (long long)all);
  }
  lay_out_samples(f, axes, x);
  const dvi_status status = dvi__space_sample(axes, sampled, all, x, *values);
  dvi__release(x);
  return status;
}

dvi_status dvi__box_interpolate(const dvi_space *space, const dvi__sampled *sampled, double *U)
{
  const int axes = space->dimension;
  fit f[DVI_AXES_MAX] = {{0}};
  double *values = NULL;
  dvi_status status = DVI_OK;
  for (int d = 0; d < axes && status == DVI_OK; d++) {
    const dvi__line *line = &space->line[d];
    f[d].functions = line->functions;
    status = (line->mark != NULL ? take_nodes : take_points)(line, &f[d]);
  }
  if (status == DVI_OK) status = sample_product(f, axes, sampled, &values);
  for (int d = 0; d < axes && status == DVI_OK; d++) status = fit_axis(f, axes, d, &values);
  if (status == DVI_OK) memcpy(U, values, (size_t)space->functions * sizeof *U);
  for (int d = 0; d < axes; d++) clear_fit(&f[d]);
  dvi__release(values);
  return status;
}
