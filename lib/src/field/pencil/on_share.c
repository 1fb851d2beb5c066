#include "field/pencil/on_share.h"

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/largest.h"
#include "field/mesh/share.h"

/* The unknowns among those of the whole mesh, and room for a component of all cells. */
typedef struct numbered {
  const dvi__cell_unknowns *of;
  int64_t *number;
  char *is_own;
  double *form; /* [cells] */
} numbered;

static dvi_status prepare(const dvi__cell_unknowns *of, numbered *u)
{
  const int components = of->components;
  *u = (numbered){.of = of,
                  .number = DVI_NEW(int64_t, of->count),
                  .is_own = DVI_NEW(char, of->count),
                  .form = DVI_NEW(double, dvi_mesh_count(of->mesh, of->degree))};
  if (!u->number || !u->is_own || !u->form)
    return dvi__fail(DVI_NO_MEMORY, "field: no memory for a frequency");
  for (int64_t i = 0; i < of->count; i++) {
    const int64_t cell = of->place[i] / components;
    u->number[i] = dvi__whole_number(of->mesh, of->degree, cell) * components +
                   of->place[i] % components;
    u->is_own[i] = (char)dvi__owns(of->mesh, of->degree, cell);
  }
  return DVI_OK;
}

/* ---- what processes do together ---- */

static dvi_status refresh(void *of, double *x)
{
  const numbered *u = of;
  const dvi__cell_unknowns *all = u->of;
  for (int k = 0; k < all->components && all->mesh->share != NULL; k++) {
    for (int64_t i = 0; i < all->count; i++)
      if (all->place[i] % all->components == k) u->form[all->place[i] / all->components] = x[i];
    DVI_TRY(dvi__refresh(all->mesh, all->degree, u->form));
    for (int64_t i = 0; i < all->count; i++)
      if (all->place[i] % all->components == k) x[i] = u->form[all->place[i] / all->components];
  }
  return DVI_OK;
}

static dvi_status sum(const void *mesh, dvi__accumulator *terms, double *value)
{
  return dvi__sum_of_all(mesh, terms, value);
}

static dvi_status largest(const void *mesh, double *value)
{
  return dvi__largest_of_all(mesh, 1, value);
}

static dvi_status agree(const void *mesh, dvi_status status)
{
  return dvi__agree(mesh, status);
}

dvi_status dvi__largest_on_share(const dvi__pencil *pencil, const dvi__cell_unknowns *unknowns,
                                 double *bound)
{
  numbered u;
  dvi_status status = dvi__agree(unknowns->mesh, prepare(unknowns, &u));
  const dvi__rows rows = {.total = unknowns->total,
                          .number = u.number,
                          .is_own = u.is_own,
                          .refresh = refresh,
                          .sum = sum,
                          .largest = largest,
                          .agree = agree,
                          .of = &u,
                          .all = unknowns->mesh};
  if (status == DVI_OK) status = dvi__largest_eigenvalue(pencil, &rows, bound);
  dvi__release(u.number);
  dvi__release(u.is_own);
  dvi__release(u.form);
  return status;
}
