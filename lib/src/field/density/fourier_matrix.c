/* Matrices of constant coefficients between orthonormal Fourier modes. A derivative of a mode is a
 * number times a mode, so that a row has few entries:
 *
 *     sum_ij c_ab int (D_a phi_i) (D_b phi_j) dx = c_ab f_a(i) f_b(j)
 *
 * if both give one mode, else 0. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

/* Coefficients that vary by less than this part are constant. */
static const double roundoff = 1e-13;

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for matrices");
}

/* ---- coefficients ---- */

/* Give the means of l_zz [pairs] where the field vanishes. */
static dvi_status find_means(const dvi__density_part *part, double *mean, int *is_constant)
{
  const int64_t points = part->points;
  const dvi_density_part *given = &part->given;
  double *z = DVI_NEW(double, given->variables *points);
  double *l_zz = DVI_NEW(double, given->pairs *points);
  dvi_status status = z != NULL && l_zz != NULL ? DVI_OK : no_memory();
  const int failed = status == DVI_OK
                         ? given->density((int)points, 0, part->x, z, NULL, NULL, l_zz, given->user)
                         : 0;
  if (failed != 0)
    status = dvi__fail(DVI_CALLBACK_FAILED, "density: part '%s' returned %d", part->name, failed);
  for (int e = 0; e < given->pairs && status == DVI_OK; e++) {
    const double *c = l_zz + e * points;
    double sum = 0, weight = 0, most = 0;
    for (int64_t k = 0; k < points; k++) {
      sum += part->weight[k] * (c[k] - c[0]);
      weight += part->weight[k];
      most = fmax(most, fabs(c[k]));
    }
    mean[e] = c[0] + sum / weight;
    for (int64_t k = 0; k < points; k++)
      if (!(fabs(c[k] - c[0]) <= roundoff * most)) *is_constant = 0;
  }
  dvi__release(z);
  dvi__release(l_zz);
  return status;
}

/* ---- rows ---- */

/* A row that is being summed. */
typedef struct row {
  const dvi_density *density;
  int of_one_form; /* rows are those of rates, and columns those of values */
  int count;
  int *column;
  double *value;
} row;

static void add_entry(row *r, int column, double value)
{
  int at = r->count;
  while (at > 0 && r->column[at - 1] > column) at--;
  if (at > 0 && r->column[at - 1] == column) {
    r->value[at - 1] += value;
    return;
  }
  memmove(r->column + at + 1, r->column + at, (size_t)(r->count - at) * sizeof *r->column);
  memmove(r->value + at + 1, r->value + at, (size_t)(r->count - at) * sizeof *r->value);
  r->column[at] = column;
  r->value[at] = value;
  r->count++;
}

/* Add the product of derivative a of function i with derivative b. Derivatives of one kind map
 * modes to modes and back, so that the mode of b is that of b's image. */
static void add_product(row *r, int64_t i, const dvi_jet *a, const dvi_jet *b, double c)
{
  const dvi_space *space = r->density->space;
  const dvi__fourier_image image = dvi__fourier_derivative(space, a->order, i);
  const int64_t j = dvi__fourier_derivative(space, b->order, image.other).other;
  const dvi__fourier_image of_j = dvi__fourier_derivative(space, b->order, j);
  const int column = r->density->number[b->component * r->density->functions + j];
  const double value = c * image.factor * of_j.factor;
  if (value != 0 && column >= 0 && of_j.other == image.other) add_entry(r, column, value);
}

static int is_wanted(const row *r, int component, const dvi_jet *a, const dvi_jet *b)
{
  return a->component == component && (!r->of_one_form || (a->rate && !b->rate));
}

static void add_part(row *r, int64_t i, int component, const dvi__density_part *part,
                     const double *mean)
{
  for (int e = 0; e < part->given.pairs; e++) {
    const dvi_jet *a = part->given.variable + part->given.pair[e][0],
                  *b = part->given.variable + part->given.pair[e][1];
    if (is_wanted(r, component, a, b)) add_product(r, i, a, b, mean[e]);
    if (a != b && is_wanted(r, component, b, a)) add_product(r, i, b, a, mean[e]);
  }
}

static void sum_row(row *r, const dvi__integral *integral, int64_t coordinate, double *const *mean)
{
  const int place = r->density->unknown[coordinate];
  const int component = (int)(place / r->density->functions);
  r->count = 0;
  for (int p = 0; p < integral->parts; p++)
    add_part(r, place - component * r->density->functions, component, integral->part[p], mean[p]);
}

static dvi_status fill(row *r, const dvi__integral *integral, double *const *mean, dvi__csr *matrix)
{
  const int64_t n = r->density->unknowns;
  int64_t entries = 0;
  for (int64_t i = 0; i < n; i++) {
    sum_row(r, integral, i, mean);
    entries += r->count;
  }
  DVI_TRY(dvi__csr_allocate(n, n, entries, matrix));
  for (int64_t i = 0; i < n; i++) {
    sum_row(r, integral, i, mean);
    const int64_t at = matrix->start[i];
    for (int e = 0; e < r->count; e++) {
      matrix->column[at + e] = r->column[e];
      matrix->value[at + e] = integral->sign * r->value[e];
    }
    matrix->start[i + 1] = at + r->count;
  }
  return DVI_OK;
}

dvi_status dvi__fourier_matrix(const dvi__integral *integral, dvi__csr *matrix, int *is_constant)
{
  int pairs = 0;
  for (int p = 0; p < integral->parts; p++) pairs += integral->part[p]->given.pairs;
  row r = {.density = integral->density,
           .of_one_form = integral->part[0]->given.kind == DVI_DENSITY_ONE_FORM,
           .column = DVI_NEW(int, 2 * pairs + 1),
           .value = DVI_NEW(double, 2 * pairs + 1)};
  double *room = DVI_NEW(double, pairs), **mean = DVI_NEW(double *, integral->parts);
  dvi_status status = r.column && r.value && room && mean ? DVI_OK : no_memory();
  *is_constant = 1;
  for (int p = 0, first = 0; p < integral->parts && status == DVI_OK; p++) {
    mean[p] = room + first;
    first += integral->part[p]->given.pairs;
    status = find_means(integral->part[p], mean[p], is_constant);
  }
  if (status == DVI_OK) status = fill(&r, integral, mean, matrix);
  dvi__release(r.column);
  dvi__release(r.value);
  dvi__release(room);
  dvi__release(mean);
  return status;
}
