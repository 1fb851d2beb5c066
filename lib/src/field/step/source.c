/* A wave's load has W f + b and what fixed values pull at their neighbours. Marches know of the
 * latter by B, which is d of all values, and need the former alone. */
#include "field/step/source.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* Add d^T M_{k+1} d of the fixed values to the load. Returns how many of them are more
 * than roundings. */
static int64_t add_pull(const dvi_field *field, const double *pull, double *source)
{
  int64_t needed = 0;
  for (int64_t i = 0; i < field->unknowns; i++) {
    const double load = field->load[i], added = pull[field->unknown[i]];
    source[i] = load + added;
    needed += fabs(source[i]) > 1e-14 * (fabs(load) + fabs(added)) &&
              dvi__owns(field->mesh, field->degree, field->unknown[i]);
  }
  return needed;
}

dvi_status dvi__wave_source(const dvi_field *field, double **source)
{
  dvi_matrix d, M2;
  *source = NULL;
  if (!field->is_wave) return DVI_OK;
  DVI_TRY(dvi_mesh_incidence(field->mesh, field->degree, &d));
  DVI_TRY(dvi_star_matrix(field->star, field->degree + 1, &M2));
  double *B = DVI_NEW(double, 2 * d.rows + d.columns);
  double *H = B != NULL ? B + d.rows : NULL, *pull = B != NULL ? H + d.rows : NULL;
  *source = DVI_NEW(double, field->unknowns);
  int64_t needed = 0;
  if (B != NULL && *source != NULL) {
    dvi_matrix_multiply(&d, 0, field->fixed, B);
    dvi_matrix_multiply(&M2, 0, B, H);
    dvi_matrix_multiply(&d, 1, H, pull);
    needed = add_pull(field, pull, *source);
  }
  dvi_status status = B != NULL && *source != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "march: no memory for a source");
  dvi__release(B);
  status = dvi__agree(field->mesh, status);
  if (status == DVI_OK) status = dvi__count_all(field->mesh, 1, &needed);
  if (status != DVI_OK || needed == 0) {
    dvi__release(*source);
    *source = NULL;
  }
  return status;
}
