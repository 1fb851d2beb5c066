#include "meeting.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "owners.h"

static int compare(const void *a, const void *b, void *user)
{
  const dvi__meeting *m = user;
  const int *first = m->row + (int64_t)(*(const PetscInt *)a) * m->width,
            *second = m->row + (int64_t)(*(const PetscInt *)b) * m->width;
  for (int i = 0; i < m->width; i++)
    if (first[i] != second[i]) return first[i] < second[i] ? -1 : 1;
  return 0;
}

int dvi__meeting_same(const dvi__meeting *m, int64_t a, int64_t b, int numbers)
{
  return memcmp(m->row + (int64_t)m->order[a] * m->width, m->row + (int64_t)m->order[b] * m->width,
                (size_t)numbers * sizeof(int)) == 0;
}

/* PETSc 3.18 reads before a list of no numbers. */
static PetscErrorCode sort(dvi__meeting *m)
{
  for (int64_t i = 0; i < m->count; i++) m->order[i] = (PetscInt)i;
  if (m->count < 2) return 0;
  return PetscTimSort((PetscInt)m->count, m->order, sizeof *m->order, compare, m);
}

dvi_status dvi__meet(const dvi__block *vertices, int64_t count, int width, const int *row,
                     dvi__meeting *m)
{
  const PetscInt *degree;
  void *memory;
  *m = (dvi__meeting){.world = vertices->world, .width = width};
  DVI_TRY(dvi__forest_of(vertices, count, row, width, &m->forest));
  DVI_TRY(dvi__count_leaves(m->world, m->forest, &degree));
  for (int64_t v = 0; v < vertices->last - vertices->first; v++) m->count += degree[v];
  DVI_TRY(dvi__world_agree(m->world, m->count < PETSC_MAX_INT
                                         ? DVI_OK
                                         : dvi__fail(DVI_BAD_SIZE,
                                                     "petsc: %lld cells of one "
                                                     "process are too many",
                                                     (long long)m->count)));
  DVI_TRY(dvi__allocate_all(m->world, m->count * width, sizeof *m->row, &memory));
  m->row = memory;
  DVI_TRY(dvi__allocate_all(m->world, m->count, sizeof *m->order, &memory));
  m->order = memory;
  DVI_TRY(dvi__gather(m->world, m->forest, (dvi__row){MPI_INT, width}, row, m->row));
  return dvi__world_agree(m->world, dvi__check_petsc(sort(m)));
}

void dvi__meeting_clear(dvi__meeting *m)
{
  (void)PetscSFDestroy(&m->forest);
  dvi__release(m->row);
  dvi__release(m->order);
  *m = (dvi__meeting){0};
}
