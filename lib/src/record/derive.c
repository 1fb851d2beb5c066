/* Parts of a recording that follow from its times, coordinates and momenta. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "record/recording.h"

dvi_status dvi__recording_derive_row(const dvi_recording *r, int64_t row, dvi__evaluator *e,
                                     double *v, double *invariants)
{
  const double t = r->part[DVI__ROW_T].number[row], *q = r->part[DVI__ROW_Q].number + row * r->nq,
               *p = r->part[DVI__ROW_P].number + row * r->nv;
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  return invariants != NULL ? dvi__invariants(e, t, q, v, p, invariants) : DVI_OK;
}

/* Evaluate all rows. A velocity is the guess for the next. */
static dvi_status derive_rows(const dvi_recording *r, dvi__evaluator *e, double *v, double *value)
{
  const size_t nv = (size_t)r->nv, count = (size_t)dvi_system_invariant_count(r->system);
  for (size_t k = 0; k < (size_t)r->rows; k++) {
    if (k > 0) memcpy(v + k * nv, v + (k - 1) * nv, nv * sizeof *v);
    DVI_TRY(dvi__recording_derive_row(r, (int64_t)k, e, v + k * nv,
                                      value != NULL ? value + k * count : NULL));
  }
  return DVI_OK;
}

/* Keep the numbers of a part, unless it has some. */
static void keep_part(dvi_recording *r, dvi__row_part part, unsigned parts, double **number)
{
  if ((parts >> part & 1) == 0 || r->part[part].number != NULL) return;
  r->part[part].number = *number;
  r->part[part].width = dvi__row_width(r->system, 1u << part);
  *number = NULL;
}

static dvi_status derive_parts(dvi_recording *r, unsigned parts, dvi__evaluator *e)
{
  const size_t count = (size_t)dvi_system_invariant_count(r->system);
  double *v = DVI_NEW(double, r->rows * r->nv), *value = DVI_NEW(double, (size_t)r->rows *count);
  const int wanted = (parts & DVI_RECORD_INVARIANTS) != 0;
  dvi_status status = v != NULL && value != NULL
                          ? derive_rows(r, e, v, wanted ? value : NULL)
                          : dvi__fail(DVI_NO_MEMORY, "recording: no memory for %lld rows",
                                      (long long)r->rows);
  if (status == DVI_OK) keep_part(r, DVI__ROW_V, parts, &v);
  if (status == DVI_OK) keep_part(r, DVI__ROW_INVARIANTS, parts, &value);
  dvi__release(v);
  dvi__release(value);
  return status;
}

dvi_status dvi_recording_derive(dvi_recording *r, unsigned parts)
{
  dvi__evaluator *evaluator = NULL;
  if (r == NULL || (parts & ~(unsigned)(DVI_RECORD_V | DVI_RECORD_INVARIANTS)) != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "recording: %s",
                     r == NULL ? "it is NULL" : "only velocities and invariants can be derived");
  if (r->part[DVI__ROW_Q].number == NULL || r->part[DVI__ROW_P].number == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "recording: it has no coordinates or no momenta, from which "
                                       "velocities and invariants follow");
  dvi_status status = dvi__evaluator_create(r->system, 1, DVI__STATES, NULL, &evaluator);
  if (status == DVI_OK) status = derive_parts(r, parts, evaluator);
  dvi__evaluator_destroy(&evaluator);
  return status;
}
