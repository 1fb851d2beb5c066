/* Fields from coefficients, and coefficients from functions. */
#include "core/memory.h"
#include "core/status.h"
#include "field/space/kind.h"

static dvi_status check_arguments(const dvi_space *space, const int *order, const double *U,
                                  const double *values)
{
  if (space == NULL || order == NULL || U == NULL || values == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: %s missing",
                     space == NULL   ? "the space is"
                     : order == NULL ? "the orders of the derivative are"
                     : U == NULL     ? "the coefficients are"
                                     : "the array of values is");
  return dvi__space_check_order(space, order);
}

dvi_status dvi_space_apply(const dvi_space *space, const int *order, const double *U,
                           double *values)
{
  dvi__space_operator B;
  DVI_TRY(check_arguments(space, order, U, values));
  DVI_TRY(dvi__operator_make(space, order, &B));
  double *work = DVI_NEW(double, dvi__operator_work(space));
  if (work != NULL) dvi__operator_apply(&B, U, values, work);
  dvi__operator_clear(&B);
  if (work == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory for a transform");
  dvi__release(work);
  return DVI_OK;
}

dvi_status dvi__space_outside(const dvi_space *space, const double *x)
{
  char place[128] = "";
  dvi__note note = {place, sizeof place, 0};
  for (int d = 0; d < space->dimension; d++)
    dvi__note_add(&note, "%s%s = %g", d > 0 ? ", " : "", dvi_space_axis(space, d), x[d]);
  return dvi__fail(DVI_BAD_ARGUMENT, "space: the point %s lies outside of the domain", place);
}

dvi_status dvi__space_row(const dvi_space *space, const int *order, const double *x, int64_t most,
                          int *column, double *value, int64_t *count)
{
  *count = 0;
  DVI_TRY(dvi__space_check_order(space, order));
  if (most < space->row_entries)
    return dvi__fail(DVI_BAD_SIZE,
                     "space: a row has up to %lld entries, and there is place for %lld",
                     (long long)space->row_entries, (long long)most);
  return space->domain->row(space, order, x, column, value, count);
}

static dvi_status evaluate_row(const dvi_space *space, const int *order, const double *U,
                               const double *x, int *column, double *value, double *sum)
{
  int64_t entries;
  DVI_TRY(space->domain->row(space, order, x, column, value, &entries));
  if (entries == 0) return dvi__space_outside(space, x);
  *sum = 0;
  for (int64_t e = 0; e < entries; e++) *sum += value[e] * U[column[e]];
  return DVI_OK;
}

dvi_status dvi__evaluate_by_rows(const dvi_space *space, const int *order, const double *U,
                                 int64_t count, const double *x, double *values)
{
  int *column = DVI_NEW(int, space->row_entries);
  double *value = DVI_NEW(double, space->row_entries), place[DVI_AXES_MAX] = {0};
  dvi_status status = column != NULL && value != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "space: no memory");
  for (int64_t i = 0; i < count && status == DVI_OK; i++) {
    for (int d = 0; d < space->dimension; d++) place[d] = x[d * count + i];
    status = evaluate_row(space, order, U, place, column, value, &values[i]);
  }
  dvi__release(column);
  dvi__release(value);
  return status;
}

dvi_status dvi_space_evaluate(const dvi_space *space, const int *order, const double *U,
                              int64_t count, const double *x, double *values)
{
  DVI_TRY(check_arguments(space, order, U, values));
  if (count < 0 || x == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: %lld points are asked %s their coordinates",
                     (long long)count, x == NULL ? "without" : "with");
  return space->domain->evaluate(space, order, U, count, x, values);
}

dvi_status dvi_space_interpolate(const dvi_space *space,
                                 int (*f)(int64_t count, const double *x, double *f, void *user),
                                 void *user, double *U)
{
  if (space == NULL || f == NULL || U == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: %s missing",
                     space == NULL ? "the space is"
                     : f == NULL   ? "the function to interpolate is"
                                   : "the array of coefficients is");
  return space->domain->interpolate(space, &(dvi__sampled){f, user}, U);
}
