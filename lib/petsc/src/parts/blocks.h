/* Arrays of the whole mesh of which each process holds a block of consecutive rows, and rows that
 * other processes need of them. */
#ifndef DVI_PETSC_BLOCKS_H
#define DVI_PETSC_BLOCKS_H
#include <dvi/status.h>
#include <petscsf.h>

#include "world.h"

/* The rows `first` to `last`-1 of `total` are this process's. */
typedef struct dvi__block {
  const dvi__world *world;
  int64_t total, first, last;
} dvi__block;

/* Give each process about the same number of rows. */
dvi__block dvi__block_of(const dvi__world *world, int64_t total);

/* The functions below are called on all processes, and all of them fail if one does. */

/* Give each process the rows that it has counted itself. */
dvi_status dvi__block_after(const dvi__world *world, int64_t count, dvi__block *block);

/* Allocate memory for dvi__release. */
dvi_status dvi__allocate_all(const dvi__world *world, int64_t count, size_t size, void **memory);

/* Make the star forest, for PetscSFDestroy, of which leaf i [count] is row number[i * stride]. All
 * numbers are of rows that there are. */
dvi_status dvi__forest_of(const dvi__block *block, int64_t count, const int *number, int stride,
                          PetscSF *forest);

/* A row of an array. */
typedef struct dvi__row {
  MPI_Datatype type;
  int width; /* of numbers of this type */
} dvi__row;

/* Give leaves the rows of their roots; rows of roots those of one of their leaves; roots those of
 * all of their leaves one after another; and leaves theirs of these. */
dvi_status dvi__spread(const dvi__world *world, PetscSF forest, dvi__row row, const void *root,
                       void *leaf);
dvi_status dvi__place(const dvi__world *world, PetscSF forest, dvi__row row, const void *leaf,
                      void *root);
dvi_status dvi__gather(const dvi__world *world, PetscSF forest, dvi__row row, const void *leaf,
                       void *roots);
dvi_status dvi__scatter(const dvi__world *world, PetscSF forest, dvi__row row, const void *roots,
                        void *leaf);

/* Count the leaves of each root. Owned by the forest. */
dvi_status dvi__count_leaves(const dvi__world *world, PetscSF forest, const PetscInt **degree);

#endif
