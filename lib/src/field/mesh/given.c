#include "field/mesh/given.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/part.h"
#include "field/mesh/share.h"

dvi_status dvi__share_given(dvi_mesh *mesh, const dvi__given_share *given)
{
  dvi__share *share = DVI_NEW(dvi__share, 1);
  if (share == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for a share");
  const dvi_status status = dvi__parts_resize(mesh, given->parts);
  if (status != DVI_OK) {
    dvi__release(share);
    return status;
  }
  share->ranks = given->ranks;
  memcpy(share->number, given->number, sizeof share->number);
  memcpy(share->owner, given->owner, sizeof share->owner);
  memcpy(share->total, given->total, sizeof share->total);
  memcpy(share->least, given->least, sizeof share->least);
  dvi__release(mesh->orientation);
  mesh->orientation = given->orientation;
  mesh->share = share;
  return DVI_OK;
}

dvi_status dvi__share_part(dvi_mesh *mesh, int p, const dvi__given_part *part, int k,
                           const char *marked)
{
  dvi__part whole = {.name = (char *)part->name, .degree = part->degree};
  memcpy(whole.total, part->total, sizeof whole.total);
  return dvi__part_take(mesh, p, &whole, k, marked);
}

void dvi__share_end(dvi_mesh *mesh)
{
  dvi__share_destroy(mesh->share);
  mesh->share = NULL;
}

void dvi__mesh_axes(const dvi_mesh *mesh, const double **metric, const double **period)
{
  *metric = mesh->metric;
  *period = mesh->period;
}
