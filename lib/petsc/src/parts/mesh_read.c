/* A mesh read in parts: each process reads a block of the points and cells, and gets those of its
 * share from the others. */
#include "mesh_read.h"

#include <limits.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "division.h"

/* ---- the block ---- */

static dvi_status check_corners(const dvi__mesh_reader *r)
{
  const dvi__block *b = r->block + r->head.n;
  const int corners = r->head.corners;
  for (int64_t c = b->first; c < b->last; c++)
    for (int i = 0; i < corners; i++) {
      const int vertex = r->corner[(c - b->first) * corners + i];
      if (vertex < 0 || vertex >= r->head.count[0])
        return dvi__slabs_refuse(r->file, "cell %lld has vertex %d of %lld", (long long)c, vertex,
                                 (long long)r->head.count[0]);
    }
  return DVI_OK;
}

static dvi_status read_cells(dvi__mesh_reader *r)
{
  const dvi__block *b = r->block + r->head.n;
  dvi__slab slab = {.name = "cells",
                    .type = DVI__INT32,
                    .first = b->first,
                    .rows = b->last - b->first,
                    .width = r->head.corners};
  void *memory;
  DVI_TRY(dvi__allocate_all(r->world, slab.rows * slab.width, sizeof *r->corner, &memory));
  r->corner = memory;
  dvi_status status = dvi__slabs_read(r->file, &slab, r->corner);
  if (status == DVI_OK) status = check_corners(r);
  DVI_TRY(dvi__world_agree(r->world, status));
  if (!r->head.is_oriented) return DVI_OK;
  slab.name = "orientation";
  slab.type = DVI__INT8;
  slab.width = 0;
  DVI_TRY(dvi__allocate_all(r->world, slab.rows, 1, &memory));
  r->orientation = memory;
  status = dvi__slabs_read(r->file, &slab, r->orientation);
  for (int64_t c = b->first; c < b->last && status == DVI_OK; c++) {
    const int8_t turn = r->orientation[c - b->first];
    if (turn != 1 && turn != -1)
      status = dvi__slabs_refuse(r->file, "cell %lld has the orientation %d", (long long)c, turn);
  }
  return dvi__world_agree(r->world, status);
}

static dvi_status begin(dvi__mesh_reader *r, const char *path)
{
  DVI_TRY(dvi__slabs_open(r->world, path, &r->file));
  DVI_TRY(dvi__world_agree(r->world, dvi__read_head(r->file, &r->head)));
  DVI_TRY(dvi__check_enough(r->world->count, r->head.count[r->head.n]));
  r->block[0] = dvi__block_of(r->world, r->head.count[0]);
  r->block[r->head.n] = dvi__block_of(r->world, r->head.count[r->head.n]);
  return read_cells(r);
}

/* ---- the cells of the share ---- */

/* Give the share what the block has of its cells: owners and orientations. */
static dvi_status take_cells(dvi__mesh_reader *r, PetscSF forest, int *corner)
{
  const int n = r->head.n;
  void *memory;
  DVI_TRY(dvi__spread(r->world, forest, (dvi__row){MPI_INT, r->head.corners}, r->corner, corner));
  DVI_TRY(dvi__allocate_all(r->world, r->cells, sizeof(int), &memory));
  r->given.owner[n] = memory;
  DVI_TRY(dvi__spread(r->world, forest, (dvi__row){MPI_INT, 1}, r->owner, memory));
  DVI_TRY(dvi__allocate_all(r->world, r->cells, sizeof(int64_t), &memory));
  r->given.number[n] = memory;
  for (int64_t c = 0; c < r->cells; c++) r->given.number[n][c] = r->number[c];
  if (!r->head.is_oriented) return DVI_OK;
  DVI_TRY(dvi__allocate_all(r->world, r->cells, 1, &memory));
  r->given.orientation = memory;
  return dvi__spread(r->world, forest, (dvi__row){MPI_SIGNED_CHAR, 1}, r->orientation, memory);
}

/* Number the corners by the share's own vertices. */
static dvi_status number_corners(const dvi__mesh_reader *r, int *corner)
{
  for (int64_t i = 0; i < r->cells * r->head.corners; i++) {
    PetscInt at;
    if (PetscFindMPIInt(corner[i], (PetscInt)r->points, r->vertex, &at) != 0 || at < 0)
      return dvi__fail(DVI_SOLVER_FAILED, "petsc: vertex %d did not arrive", corner[i]);
    corner[i] = (int)at;
  }
  return DVI_OK;
}

/* Find the least coordinates of all points, of which this process has a block. */
static dvi_status find_least(dvi__mesh_reader *r, const double *point)
{
  double most[DVI_MESH_SPACE_MAX];
  const int space = r->head.space;
  for (int l = 0; l < DVI_MESH_SPACE_MAX; l++) most[l] = -INFINITY;
  for (int64_t i = 0; i < (r->block->last - r->block->first) * space; i++)
    if (-point[i] > most[i % space]) most[i % space] = -point[i];
  if (dvi__world_largest(space, most, (void *)r->world) != MPI_SUCCESS)
    return dvi__world_fail(r->world);
  for (int l = 0; l < space; l++) r->given.least[l] = -most[l];
  return DVI_OK;
}

static dvi_status read_points(dvi__mesh_reader *r, double *mine)
{
  const dvi__slab slab = {.name = "points",
                          .type = DVI__DOUBLE,
                          .first = r->block->first,
                          .rows = r->block->last - r->block->first,
                          .width = r->head.space};
  void *point;
  PetscSF forest = NULL;
  dvi_status status = dvi__allocate_all(r->world, slab.rows * slab.width, sizeof(double), &point);
  if (status == DVI_OK) status = dvi__world_agree(r->world, dvi__slabs_read(r->file, &slab, point));
  if (status == DVI_OK) status = find_least(r, point);
  if (status == DVI_OK) status = dvi__forest_of(r->block, r->points, r->vertex, 1, &forest);
  if (status == DVI_OK)
    status = dvi__spread(r->world, forest, (dvi__row){MPI_DOUBLE, slab.width}, point, mine);
  (void)PetscSFDestroy(&forest);
  dvi__release(point);
  return status;
}

/* Release what is known of the block's cells. */
static void drop_block(dvi__mesh_reader *r)
{
  dvi__release(r->corner);
  dvi__release(r->orientation);
  dvi__release(r->owner);
  r->corner = r->owner = NULL;
  r->orientation = NULL;
}

static dvi_status fetch_cells(dvi__mesh_reader *r, int *corner)
{
  PetscSF forest = NULL;
  dvi_status status = dvi__forest_of(r->block + r->head.n, r->cells, r->number, 1, &forest);
  if (status == DVI_OK) status = take_cells(r, forest, corner);
  (void)PetscSFDestroy(&forest);
  drop_block(r);
  return status == DVI_OK ? dvi__world_agree(r->world, number_corners(r, corner)) : status;
}

/* Make a mesh of the share's cells. */
static dvi_status make_mesh(dvi__mesh_reader *r, dvi_mesh **mesh)
{
  const dvi__mesh_head *h = &r->head;
  void *corner = NULL, *point = NULL;
  dvi_status status = dvi__allocate_all(r->world, r->cells * h->corners, sizeof(int), &corner);
  if (status == DVI_OK) status = fetch_cells(r, corner);
  if (status == DVI_OK)
    status = dvi__allocate_all(r->world, r->points * h->space, sizeof(double), &point);
  if (status == DVI_OK) status = read_points(r, point);
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = h->kind,
                                .dimension = h->n,
                                .space = h->space,
                                .points = r->points,
                                .point = point,
                                .cells = r->cells,
                                .vertex = corner,
                                .metric = h->metric,
                                .period = h->period};
  if (status == DVI_OK) status = dvi__world_agree(r->world, dvi_mesh_create(&terms, mesh));
  dvi__release(corner);
  dvi__release(point);
  return status;
}

/* ---- the share ---- */

static dvi_status complete(dvi__mesh_reader *r, dvi_mesh *mesh)
{
  DVI_TRY(dvi__number_share(r, mesh));
  r->given.ranks = dvi__division_ranks(r->division);
  r->given.parts = r->head.parts;
  for (int k = 0; k <= r->head.n; k++) r->given.total[k] = r->head.count[k];
  const dvi_status status = dvi__share_given(mesh, &r->given);
  if (status == DVI_OK) r->given = (dvi__given_share){0}; /* they are the mesh's */
  DVI_TRY(dvi__world_agree(r->world, status));
  DVI_TRY(dvi__read_parts(r, mesh));
  return dvi__division_join(r->division, mesh, r->head.count);
}

static dvi_status make(dvi__mesh_reader *r, const char *path, dvi_mesh **share)
{
  DVI_TRY(begin(r, path));
  DVI_TRY(dvi__own_cells(r));
  DVI_TRY(dvi__find_cells(r));
  DVI_TRY(make_mesh(r, share));
  return complete(r, *share);
}

static void clear(dvi__mesh_reader *r)
{
  (void)dvi__slabs_end(&r->file, 0);
  drop_block(r);
  dvi__release(r->number);
  dvi__release(r->vertex);
  for (int k = 0; k <= DVI_MESH_DIMENSION_MAX; k++) {
    dvi__release(r->given.number[k]);
    dvi__release(r->given.owner[k]);
  }
  dvi__release(r->given.orientation);
}

dvi_status dvi_mesh_read_divided(const char *path, const dvi_division_options *options,
                                 dvi_mesh **share, dvi_division **division)
{
  if (path == NULL || share == NULL || division == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a path and places for results are needed");
  *share = NULL;
  *division = NULL;
  dvi_division *made = NULL;
  dvi_status status = dvi__division_begin(options, &made);
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  if (status == DVI_OK && made != NULL) {
    dvi__mesh_reader r = {.division = made, .world = &made->world};
    status = make(&r, path, share);
    clear(&r);
  }
  (void)PetscPopErrorHandler();
  if (status != DVI_OK) {
    dvi_mesh_destroy(share);
    dvi_division_destroy(&made);
  }
  *division = made;
  return status;
}

dvi_status dvi_mesh_read_whole(const char *path, dvi_mesh **mesh)
{
  const dvi_division_options alone = {
      .size = sizeof alone, .comm = MPI_COMM_SELF, .partitioner = "blocks"};
  dvi_division *division = NULL;
  DVI_TRY(dvi_mesh_read_divided(path, &alone, mesh, &division));
  dvi__share_end(*mesh);
  dvi_division_destroy(&division);
  return DVI_OK;
}
