/* Meshes that are shares of larger ones, held by several processes. All k-cells of the n-cells that
 * a process owns have all of their neighbours in its share, so that what is assembled for them is
 * what the whole mesh has. Sums over all processes are exact until they are rounded once
 * (num/accumulator.h), and do not depend on the division. */
#ifndef DVI_FIELD_MESH_SHARE_H
#define DVI_FIELD_MESH_SHARE_H
#include "field/mesh/mesh.h"
#include "num/accumulator.h"

struct dvi__share {
  dvi_ranks ranks;
  int64_t *number[DVI__DEGREES];    /* [cells] in the whole mesh, ascending */
  int *owner[DVI__DEGREES];         /* [cells] */
  int64_t total[DVI__DEGREES];      /* cells of the whole mesh */
  double least[DVI_MESH_SPACE_MAX]; /* coordinates of the whole mesh */
};

void dvi__share_destroy(dvi__share *share);

/* Tell whether a k-cell belongs to this process. All cells of a whole mesh do. */
static inline int dvi__owns(const dvi_mesh *mesh, int k, int64_t cell)
{
  return mesh->share == NULL || mesh->share->owner[k][cell] == mesh->share->ranks.rank;
}

/* Tell whether this process speaks for all of them, as when a file is written. */
static inline int dvi__is_first(const dvi_mesh *mesh)
{
  return mesh->share == NULL || mesh->share->ranks.rank == 0;
}

/* Return the number of a k-cell in the whole mesh, and how many there are. */
static inline int64_t dvi__whole_number(const dvi_mesh *mesh, int k, int64_t cell)
{
  return mesh->share == NULL ? cell : mesh->share->number[k][cell];
}
int64_t dvi__whole_count(const dvi_mesh *mesh, int k);

/* Return the least coordinate of the whole mesh, which is `here` unless the mesh is a share. */
static inline double dvi__least_coordinate(const dvi_mesh *mesh, int axis, double here)
{
  return mesh->share == NULL ? here : mesh->share->least[axis];
}

/* Tell whether a facet is of the whole mesh's boundary, and not of the edge of a share alone. */
int dvi__is_outer(const dvi_mesh *mesh, int64_t facet);

/* Return the k-cell of a number in the whole mesh, or -1 if it is not of this share. */
int64_t dvi__find_number(const dvi_mesh *mesh, int k, int64_t number);

/* The following functions are called on all processes. DVI_CALLBACK_FAILED on all of them if one
 * cannot speak with the others. They do nothing else on a whole mesh. */

/* Agree whether all have succeeded so far. If not, all fail with the same status. Whatever may fail
 * on one process alone is agreed on before the next call of a function of this list. */
dvi_status dvi__agree(const dvi_mesh *mesh, dvi_status status);

/* The same for processes without meshes. */
dvi_status dvi__agree_among(const dvi_ranks *ranks, dvi_status status);

/* Set the values [k-cells] of cells that others own to theirs. */
dvi_status dvi__refresh(const dvi_mesh *mesh, int k, double *values);

/* Give the sum of all processes' sums, rounded once. */
dvi_status dvi__sum_of_all(const dvi_mesh *mesh, dvi__accumulator *sum, double *value);

/* Replace numbers by their sums, or by the largest ones, over all processes. */
dvi_status dvi__count_all(const dvi_mesh *mesh, int count, int64_t *number);
dvi_status dvi__largest_of_all(const dvi_mesh *mesh, int count, double *number);

/* Rows of the whole mesh, of which each process has some. A row is words of 8 bytes. */
typedef struct dvi__whole_rows {
  int64_t total, listed; /* rows of all processes, and those that this one lists */
  const int64_t *number; /* [listed] ascending numbers of these. NULL if they are all rows */
  int width;             /* words of a row */
  /* Fill the i-th row of the list, or leave it alone if it is another process's. Exactly one
   * process fills a row. */
  void (*fill)(const void *of, int64_t i, int64_t *word);
  const void *of;
} dvi__whole_rows;

/* Give all rows in their order, block by block, to `put` on all processes: `count` words, of whole
 * rows. Every bit is as it was. `room` is dvi__whole_room words. */
dvi_status dvi__gather_rows(const dvi_mesh *mesh, const dvi__whole_rows *rows, int64_t *room,
                            void (*put)(void *to, int64_t count, const int64_t *word), void *to);
int64_t dvi__whole_room(int width);

/* Find the first n-cell of the whole mesh at a point, and the place in it, as dvi_mesh_locate does.
 * The number is that in the whole mesh, or -1. A process that has not the cell has no place. */
dvi_status dvi__locate_first(const dvi_mesh *mesh, const double *at, double *place,
                             int64_t *number);

/* Refuse k-cells of other processes. */
dvi_status dvi__check_owned(const dvi_mesh *mesh, int k, int64_t count, const int *cell);

/* Refuse a share for what needs a whole mesh, such as "march: avi". Beside one process there may be
 * another remedy, such as "leapfrog". */
dvi_status dvi__refuse_share(const dvi_mesh *mesh, const char *what);
dvi_status dvi__refuse_share_but(const dvi_mesh *mesh, const char *what, const char *remedy);

#endif
