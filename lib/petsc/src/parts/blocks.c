#include "blocks.h"

#include "core/memory.h"
#include "core/status.h"
#include "owners.h"

dvi__block dvi__block_of(const dvi__world *world, int64_t total)
{
  return (dvi__block){.world = world,
                      .total = total,
                      .first = total * world->rank / world->count,
                      .last = total * (world->rank + 1) / world->count};
}

dvi_status dvi__block_after(const dvi__world *world, int64_t count, dvi__block *block)
{
  int64_t last = count, total = count;
  if (MPI_Scan(&count, &last, 1, MPI_INT64_T, MPI_SUM, world->comm) != MPI_SUCCESS ||
      MPI_Allreduce(&count, &total, 1, MPI_INT64_T, MPI_SUM, world->comm) != MPI_SUCCESS)
    return dvi__world_fail(world);
  *block = (dvi__block){.world = world, .total = total, .first = last - count, .last = last};
  return DVI_OK;
}

dvi_status dvi__allocate_all(const dvi__world *world, int64_t count, size_t size, void **memory)
{
  *memory = dvi__allocate((size_t)count, size);
  return dvi__world_agree(
      world, *memory != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a share"));
}

/* ---- forests ---- */

static PetscErrorCode make_forest(const dvi__block *block, int64_t count, const PetscInt *root,
                                  PetscSF *forest)
{
  PetscLayout layout;
  PetscCall(PetscLayoutCreateFromSizes(block->world->comm, (PetscInt)(block->last - block->first),
                                       (PetscInt)block->total, 1, &layout));
  PetscCall(PetscSFCreate(block->world->comm, forest));
  PetscCall(PetscSFSetGraphLayout(*forest, layout, (PetscInt)count, NULL, PETSC_COPY_VALUES, root));
  PetscCall(PetscSFSetUp(*forest));
  return PetscLayoutDestroy(&layout);
}

dvi_status dvi__forest_of(const dvi__block *block, int64_t count, const int *number, int stride,
                          PetscSF *forest)
{
  void *memory = NULL;
  dvi_status status = dvi__allocate_all(block->world, count, sizeof(PetscInt), &memory);
  PetscInt *root = memory;
  *forest = NULL;
  for (int64_t i = 0; i < count && status == DVI_OK; i++) root[i] = number[i * stride];
  if (status == DVI_OK)
    status = dvi__world_agree(block->world,
                              dvi__check_petsc(make_forest(block, count, root, forest)));
  dvi__release(memory);
  return status;
}

/* ---- rows ---- */

typedef PetscErrorCode (*transport)(PetscSF forest, MPI_Datatype type, const void *from, void *to);

static PetscErrorCode spread(PetscSF forest, MPI_Datatype type, const void *root, void *leaf)
{
  PetscCall(PetscSFBcastBegin(forest, type, root, leaf, MPI_REPLACE));
  return PetscSFBcastEnd(forest, type, root, leaf, MPI_REPLACE);
}

static PetscErrorCode place(PetscSF forest, MPI_Datatype type, const void *leaf, void *root)
{
  PetscCall(PetscSFReduceBegin(forest, type, leaf, root, MPI_REPLACE));
  return PetscSFReduceEnd(forest, type, leaf, root, MPI_REPLACE);
}

static PetscErrorCode gather(PetscSF forest, MPI_Datatype type, const void *leaf, void *roots)
{
  PetscCall(PetscSFGatherBegin(forest, type, leaf, roots));
  return PetscSFGatherEnd(forest, type, leaf, roots);
}

static PetscErrorCode scatter(PetscSF forest, MPI_Datatype type, const void *roots, void *leaf)
{
  PetscCall(PetscSFScatterBegin(forest, type, roots, leaf));
  return PetscSFScatterEnd(forest, type, roots, leaf);
}

static dvi_status carry(const dvi__world *world, PetscSF forest, dvi__row row, transport by,
                        const void *from, void *to)
{
  MPI_Datatype type = row.type;
  if (row.width > 1 && (MPI_Type_contiguous(row.width, row.type, &type) != MPI_SUCCESS ||
                        MPI_Type_commit(&type) != MPI_SUCCESS))
    return dvi__world_fail(world);
  const dvi_status status = dvi__check_petsc(by(forest, type, from, to));
  if (row.width > 1) (void)MPI_Type_free(&type);
  return dvi__world_agree(world, status);
}

dvi_status dvi__spread(const dvi__world *world, PetscSF forest, dvi__row row, const void *root,
                       void *leaf)
{
  return carry(world, forest, row, spread, root, leaf);
}

dvi_status dvi__place(const dvi__world *world, PetscSF forest, dvi__row row, const void *leaf,
                      void *root)
{
  return carry(world, forest, row, place, leaf, root);
}

dvi_status dvi__gather(const dvi__world *world, PetscSF forest, dvi__row row, const void *leaf,
                       void *roots)
{
  return carry(world, forest, row, gather, leaf, roots);
}

dvi_status dvi__scatter(const dvi__world *world, PetscSF forest, dvi__row row, const void *roots,
                        void *leaf)
{
  return carry(world, forest, row, scatter, roots, leaf);
}

static PetscErrorCode count_leaves(PetscSF forest, const PetscInt **degree)
{
  PetscCall(PetscSFComputeDegreeBegin(forest, degree));
  return PetscSFComputeDegreeEnd(forest, degree);
}

dvi_status dvi__count_leaves(const dvi__world *world, PetscSF forest, const PetscInt **degree)
{
  return dvi__world_agree(world, dvi__check_petsc(count_leaves(forest, degree)));
}
