#include "step/joint.h"

#include <limits.h>

#include "core/memory.h"
#include "core/status.h"

static dvi_status joint_join(const dvi_system *system, const dvi__pattern *more,
                             dvi__pattern *joint)
{
  dvi__pattern vq = {0}, mixed = {0}, own = {0}, second = {0}, diagonal = {0};
  dvi__pattern lagrangian = {0}, forces = {0}, whole = {0};
  dvi_status status = dvi__pattern_transpose(&system->qv, &vq);
  if (status == DVI_OK) status = dvi__pattern_union(&system->qv, &vq, &mixed);
  if (status == DVI_OK)
    status = (system->terms & (DVI__ONE_FORM | DVI__HAMILTONIAN)) != 0
                 ? dvi__pattern_diagonal(system->n, &own)
                 : dvi__pattern_empty(system->n, &own);
  if (status == DVI_OK) status = dvi__pattern_union(&system->vv, &own, &second);
  if (status == DVI_OK) status = dvi__pattern_union(&system->qq, &second, &diagonal);
  if (status == DVI_OK) status = dvi__pattern_union(&mixed, &diagonal, &lagrangian);
  if (status == DVI_OK) status = dvi__pattern_union(&system->by_q, &system->by_v, &forces);
  if (status == DVI_OK) status = dvi__pattern_union(&lagrangian, &forces, &whole);
  if (status == DVI_OK) status = dvi__pattern_union(&whole, more != NULL ? more : &whole, joint);
  dvi__pattern_clear(&vq);
  dvi__pattern_clear(&mixed);
  dvi__pattern_clear(&own);
  dvi__pattern_clear(&second);
  dvi__pattern_clear(&diagonal);
  dvi__pattern_clear(&lagrangian);
  dvi__pattern_clear(&forces);
  dvi__pattern_clear(&whole);
  return status;
}

dvi_status dvi__joint_check(const dvi_system *system, int size, int most)
{
  const size_t n = (size_t)system->n, each = (size_t)(most > size ? most : size);
  if (n * each >= INT_MAX)
    return dvi__fail(DVI_BAD_SIZE,
                     "action: %d coordinates with %zu numbers each make %zu, more than an int can "
                     "count; take a lower degree, or fewer nodes or stages",
                     system->n, each, n * each);
  const size_t least = dvi__system_least_entries(system) * (size_t)size * (size_t)size;
  if (least < INT_MAX) return DVI_OK;
  return dvi__fail(
      DVI_BAD_SIZE,
      "action: the Jacobian would have %zu entries or more, which an int cannot count; "
      "declare a sparse pattern of each Hessian, or take a lower degree",
      least);
}

dvi_status dvi__joint_create(const dvi_system *system, const dvi__pattern *more,
                             dvi__pattern *joint, dvi__joint_entry **block)
{
  DVI_TRY(joint_join(system, more, joint));
  *block = DVI_NEW(dvi__joint_entry, dvi__pattern_entries(joint));
  if (*block == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for the Jacobian");
  for (int j = 0; j < joint->columns; j++)
    for (int e = joint->start[j]; e < joint->start[j + 1]; e++) {
      const int i = joint->row[e];
      (*block)[e] = (dvi__joint_entry){
          dvi__pattern_find(&system->qq, i, j),   dvi__pattern_find(&system->qv, i, j),
          dvi__pattern_find(&system->qv, j, i),   dvi__pattern_find(&system->vv, i, j),
          dvi__pattern_find(&system->by_q, i, j), dvi__pattern_find(&system->by_v, i, j)};
    }
  return DVI_OK;
}
