/* What processes that share a solid tell each other for their callers. */
#include "core/status.h"
#include "field/elastic/elastic.h"
#include "field/mesh/share.h"

dvi_status dvi_elastic_agree(const dvi_elastic *elastic, dvi_status status)
{
  return elastic != NULL ? dvi__agree(elastic->mesh, status) : status;
}

dvi_status dvi_elastic_locate(const dvi_elastic *elastic, const double *at, int *cell,
                              double *weight)
{
  int64_t number;
  if (elastic == NULL || at == NULL || cell == NULL || weight == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a solid, a point and room for a cell are needed");
  const dvi_mesh *mesh = elastic->mesh;
  DVI_TRY(dvi__locate_first(mesh, at, weight, &number));
  if (number < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: the point (%g, %g, %g) is outside of the mesh",
                     at[0], at[1], mesh->n > 2 ? at[2] : 0.0);
  const int64_t found = dvi__find_number(mesh, mesh->n, number);
  *cell = found >= 0 && dvi__owns(mesh, mesh->n, found) ? (int)found : -1;
  return DVI_OK;
}

dvi_status dvi_elastic_sum(const dvi_elastic *elastic, int count, double *number)
{
  if (elastic == NULL || number == NULL || count < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a solid and numbers are needed");
  for (int i = 0; i < count; i++) {
    dvi__accumulator sum = {.terms = 0}; /* of a single -0 it is 0, for any number of processes */
    dvi__accumulate(&sum, number[i]);
    DVI_TRY(dvi__sum_of_all(elastic->mesh, &sum, number + i));
  }
  return DVI_OK;
}
