/* Recordings of ensembles. */
#include <dvi/ensemble.h>

#include "core/status.h"
#include "integrator/ensemble_struct.h"
#include "integrator/integrator_struct.h"

static double *row_of(double *rows, int64_t row, size_t numbers)
{
  return rows != NULL ? rows + (size_t)row * numbers : NULL;
}

/* Copy the present states to a row. */
static dvi_status record_row(const dvi_ensemble *e, int64_t row, const dvi_ensemble_rows *rows)
{
  const dvi_system *system = e->integrators[0]->system;
  const size_t members = (size_t)e->members;
  return dvi_ensemble_state(e, row_of(rows->t, row, members),
                            row_of(rows->q, row, members * (size_t)dvi_system_nq(system)),
                            row_of(rows->p, row, members * (size_t)dvi_system_nv(system)));
}

dvi_status dvi_ensemble_record(dvi_ensemble *e, double h, long every, int64_t count,
                               const dvi_ensemble_rows *rows)
{
  if (e == NULL || rows == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: an argument is NULL");
  if (rows->size != sizeof *rows)
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: set rows.size to sizeof(dvi_ensemble_rows)");
  if (every < 1 || count < 1)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "ensemble: %lld rows every %ld steps; 1 or more are possible",
                     (long long)count, every);
  DVI_TRY(record_row(e, 0, rows));
  for (int64_t row = 1; row < count; row++) {
    DVI_TRY(dvi_ensemble_advance(e, h, every));
    DVI_TRY(record_row(e, row, rows));
  }
  return DVI_OK;
}
