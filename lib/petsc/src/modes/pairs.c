#include "pairs.h"

#include "core/memory.h"
#include "core/status.h"

static void drop_arrays(const dvi__pairs *pairs)
{
  dvi__release(pairs->value);
  dvi__release(pairs->residual);
  dvi__release(pairs->vector);
}

dvi_status dvi__pairs_reserve(PetscInt more, dvi__pairs *pairs)
{
  const PetscInt room = pairs->count + more;
  if (room <= pairs->room) return DVI_OK;
  dvi__pairs larger = {.count = pairs->count,
                       .room = room,
                       .value = DVI_NEW(double, room),
                       .residual = DVI_NEW(double, room),
                       .vector = DVI_NEW(Vec, room)};
  const int has_memory = larger.value != NULL && larger.residual != NULL && larger.vector != NULL;
  for (PetscInt i = 0; i < pairs->count && has_memory; i++) {
    larger.value[i] = pairs->value[i];
    larger.residual[i] = pairs->residual[i];
    larger.vector[i] = pairs->vector[i];
  }
  drop_arrays(has_memory ? pairs : &larger);
  if (has_memory) *pairs = larger;
  return has_memory ? DVI_OK
                    : dvi__fail(DVI_NO_MEMORY, "modes: no memory for %lld modes", (long long)room);
}

void dvi__pairs_swap(PetscInt a, PetscInt b, dvi__pairs *pairs)
{
  const double value = pairs->value[a], residual = pairs->residual[a];
  const Vec vector = pairs->vector[a];
  pairs->value[a] = pairs->value[b];
  pairs->residual[a] = pairs->residual[b];
  pairs->vector[a] = pairs->vector[b];
  pairs->value[b] = value;
  pairs->residual[b] = residual;
  pairs->vector[b] = vector;
}

void dvi__pairs_shorten(PetscInt count, dvi__pairs *pairs)
{
  while (pairs->count > count) (void)VecDestroy(pairs->vector + --pairs->count);
}

void dvi__pairs_clear(dvi__pairs *pairs)
{
  dvi__pairs_shorten(0, pairs);
  drop_arrays(pairs);
  *pairs = (dvi__pairs){.count = 0};
}
