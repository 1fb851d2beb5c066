/* Derivatives of a field at the quadrature points, as operators on its coefficients. */
#include <string.h>

#include "core/status.h"
#include "field/space/kind.h"

static dvi_status check_order(const dvi_space *space, const int *order)
{
  for (int d = 0; d < space->dimension; d++) {
    const char *name = dvi_space_axis(space, d);
    if (order[d] < 0)
      return dvi__fail(DVI_BAD_ARGUMENT, "space: a derivative of order %d along %s is asked",
                       order[d], name);
    if (order[d] > space->smoothness[d])
      return dvi__fail(DVI_UNSUPPORTED,
                       "space: a derivative of order %d along %s is asked, but functions of this "
                       "space have %d; splines of a higher degree have more",
                       order[d], name, space->smoothness[d]);
  }
  return DVI_OK;
}

dvi_status dvi__space_check_order(const dvi_space *space, const int *order)
{
  DVI_TRY(check_order(space, order));
  return space->domain->check_order != NULL ? space->domain->check_order(space, order) : DVI_OK;
}

dvi_status dvi__operator_make(const dvi_space *space, const int *order, dvi__space_operator *made)
{
  *made = (dvi__space_operator){.space = space};
  DVI_TRY(dvi__space_check_order(space, order));
  memcpy(made->order, order, (size_t)space->dimension * sizeof *order);
  return space->domain->matrix != NULL ? space->domain->matrix(space, order, &made->matrix)
                                       : DVI_OK;
}

void dvi__operator_clear(dvi__space_operator *made)
{
  dvi__csr_clear(&made->matrix);
  *made = (dvi__space_operator){0};
}

int64_t dvi__operator_work(const dvi_space *space)
{
  return space->work;
}

static void multiply(const dvi__csr *B, const double *U, double *values)
{
  for (int64_t i = 0; i < B->rows; i++) {
    double sum = 0;
    for (int64_t e = B->start[i]; e < B->start[i + 1]; e++) sum += B->value[e] * U[B->column[e]];
    values[i] = sum;
  }
}

static void add_transposed(const dvi__csr *B, const double *values, double *U)
{
  for (int64_t i = 0; i < B->rows; i++) {
    const double value = values[i];
    for (int64_t e = B->start[i]; e < B->start[i + 1]; e++) U[B->column[e]] += B->value[e] * value;
  }
}

void dvi__operator_apply(const dvi__space_operator *B, const double *U, double *values,
                         double *work)
{
  const dvi__domain *domain = B->space->domain;
  if (domain->apply != NULL)
    domain->apply(B, U, values, work);
  else
    multiply(&B->matrix, U, values);
}

void dvi__operator_add_transposed(const dvi__space_operator *B, const double *values, double *U,
                                  double *work)
{
  const dvi__domain *domain = B->space->domain;
  if (domain->add_transposed != NULL)
    domain->add_transposed(B, values, U, work);
  else
    add_transposed(&B->matrix, values, U);
}
