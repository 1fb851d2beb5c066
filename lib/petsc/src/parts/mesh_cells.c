/* The n-cells of a share: the graph of the cells goes to a partitioner of PETSc, and each process
 * asks the vertices of its own cells for the others around them. */
#include "mesh_read.h"

#include <petscis.h>
#include <petscsection.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "division.h"
#include "field/mesh/shape.h"
#include "meeting.h"
#include "owners.h"

/* ---- the graph ---- */

/* Write the vertices of a facet, ascending, and its cell. */
static void write_facet(const int *corner, const int *local, int corners, int cell, int *row)
{
  for (int c = 0; c < corners; c++) row[c] = corner[local[c]];
  for (int i = 1; i < corners; i++)
    for (int j = i; j > 0 && row[j - 1] > row[j]; j--) {
      const int other = row[j];
      row[j] = row[j - 1];
      row[j - 1] = other;
    }
  row[corners] = cell;
}

/* Fill in the rows [cells of the block * facets] of the block's facets. */
static void write_facets(const dvi__mesh_reader *r, int *row)
{
  const dvi__mesh_head *h = &r->head;
  const int slots = dvi__facets(h->kind, h->n), corners = dvi__corners(h->kind, h->n - 1);
  const dvi__block *b = r->block + h->n;
  int local[DVI__FACET_CORNERS];
  for (int slot = 0; slot < slots; slot++) {
    dvi__facet_corners(h->kind, h->n, slot, local);
    for (int64_t c = b->first; c < b->last; c++)
      write_facet(r->corner + (c - b->first) * h->corners, local, corners, (int)c,
                  row + ((c - b->first) * slots + slot) * (corners + 1));
  }
}

/* Answer each cell at a facet with the other one, or with -1. Of more than two the first count. */
static void answer_neighbours(const dvi__meeting *m, int *answer)
{
  const int corners = m->width - 1;
  for (int64_t i = 0, first = 0; i < m->count; i++) {
    if (!dvi__meeting_same(m, first, i, corners)) first = i;
    const int64_t other = i > first ? first : i + 1;
    const int is_there = other < m->count && dvi__meeting_same(m, first, other, corners);
    answer[m->order[i]] = is_there ? m->row[(int64_t)m->order[other] * m->width + corners] : -1;
  }
}

static dvi_status find_neighbours(const dvi__mesh_reader *r, int64_t facets, int *neighbour)
{
  const int width = dvi__corners(r->head.kind, r->head.n - 1) + 1;
  void *row = NULL, *answer = NULL;
  dvi__meeting meeting = {0};
  dvi_status status = dvi__allocate_all(r->world, facets * width, sizeof(int), &row);
  if (status == DVI_OK) {
    write_facets(r, row);
    status = dvi__meet(r->block, facets, width, row, &meeting);
  }
  dvi__release(row);
  if (status == DVI_OK) status = dvi__allocate_all(r->world, meeting.count, sizeof(int), &answer);
  if (status == DVI_OK) {
    answer_neighbours(&meeting, answer);
    status = dvi__scatter(r->world, meeting.forest, (dvi__row){MPI_INT, 1}, answer, neighbour);
  }
  dvi__release(answer);
  dvi__meeting_clear(&meeting);
  return status;
}

static PetscErrorCode fill_graph(const int *neighbour, int slots, dvi__graph *g)
{
  const int64_t cells = g->last - g->first;
  PetscInt entries = 0;
  PetscCall(PetscMalloc1((size_t)(cells + 1), &g->start));
  PetscCall(PetscMalloc1((size_t)(cells * slots + 1), &g->neighbour));
  for (int64_t c = 0; c < cells; c++) {
    g->start[c] = entries;
    for (int64_t i = c * slots; i < (c + 1) * slots; i++)
      if (neighbour[i] >= 0) g->neighbour[entries++] = neighbour[i];
  }
  g->start[cells] = entries;
  return 0;
}

static dvi_status own_by_graph(dvi__mesh_reader *r)
{
  const dvi__block *b = r->block + r->head.n;
  const int slots = dvi__facets(r->head.kind, r->head.n);
  const dvi__divider divider = {
      .world = r->world, .parts = r->world->count, .partitioner = r->division->partitioner};
  dvi__graph g = {.cells = b->total, .first = b->first, .last = b->last};
  void *neighbour = NULL, *owner = NULL;
  dvi_status status = dvi__allocate_all(r->world, (b->last - b->first) * slots, sizeof(int),
                                        &neighbour);
  if (status == DVI_OK) status = find_neighbours(r, (b->last - b->first) * slots, neighbour);
  if (status == DVI_OK)
    status = dvi__world_agree(r->world, dvi__check_petsc(fill_graph(neighbour, slots, &g)));
  dvi__release(neighbour);
  if (status == DVI_OK)
    status = dvi__allocate_all(r->world, b->last - b->first, sizeof(PetscInt), &owner);
  if (status == DVI_OK)
    status = dvi__world_agree(r->world, dvi__partition(&divider, &g, owner));
  else {
    (void)PetscFree(g.start);
    (void)PetscFree(g.neighbour);
  }
  for (int64_t c = 0; c < b->last - b->first && status == DVI_OK; c++)
    r->owner[c] = (int)((PetscInt *)owner)[c];
  dvi__release(owner);
  return status;
}

dvi_status dvi__own_cells(dvi__mesh_reader *r)
{
  const dvi__block *b = r->block + r->head.n;
  void *memory;
  DVI_TRY(dvi__allocate_all(r->world, b->last - b->first, sizeof *r->owner, &memory));
  r->owner = memory;
  if (strcmp(r->division->partitioner, "blocks") != 0 && r->world->count > 1)
    return own_by_graph(r);
  for (int64_t c = b->first; c < b->last; c++)
    r->owner[c - b->first] = (int)(c * r->world->count / b->total);
  return DVI_OK;
}

/* ---- lists of numbers ---- */

/* Numbers in the whole mesh, for dvi__release. */
typedef struct list {
  int64_t count;
  int *number;
} list;

static dvi_status allocate_list(const dvi__mesh_reader *r, int64_t count, list *l)
{
  void *memory;
  const dvi_status status = dvi__allocate_all(r->world, count, sizeof *l->number, &memory);
  *l = (list){count, memory};
  return status;
}

/* Sort a list, and leave out what it has twice. */
static dvi_status sort_list(const dvi__mesh_reader *r, list *l)
{
  PetscInt count = (PetscInt)l->count;
  const dvi_status status = l->count < PETSC_MAX_INT
                                ? dvi__check_petsc(PetscSortRemoveDupsMPIInt(&count, l->number))
                                : dvi__fail(DVI_BAD_SIZE,
                                            "petsc: a share of %lld numbers is too "
                                            "large",
                                            (long long)l->count);
  l->count = count;
  return dvi__world_agree(r->world, status);
}

/* Tell the owners of the block's cells their numbers. */
static PetscErrorCode find_own(const dvi__mesh_reader *r, IS *own)
{
  const dvi__block *b = r->block + r->head.n;
  const PetscInt cells = (PetscInt)(b->last - b->first);
  PetscInt *to;
  IS owners;
  PetscCall(PetscMalloc1((size_t)cells, &to));
  for (PetscInt c = 0; c < cells; c++) to[c] = r->owner[c];
  PetscCall(ISCreateGeneral(r->world->comm, cells, to, PETSC_OWN_POINTER, &owners));
  PetscCall(ISBuildTwoSided(owners, NULL, own));
  return ISDestroy(&owners);
}

static PetscErrorCode copy_set(IS set, int *number)
{
  PetscInt count;
  const PetscInt *from;
  PetscCall(ISGetLocalSize(set, &count));
  PetscCall(ISGetIndices(set, &from));
  for (PetscInt i = 0; i < count; i++) number[i] = (int)from[i];
  return ISRestoreIndices(set, &from);
}

/* Every process has cells. */
static dvi_status check_own(const dvi__mesh_reader *r, int64_t count)
{
  int idle = count == 0 ? r->world->rank : r->world->count;
  if (MPI_Allreduce(MPI_IN_PLACE, &idle, 1, MPI_INT, MPI_MIN, r->world->comm) != MPI_SUCCESS)
    return dvi__world_fail(r->world);
  if (idle == r->world->count) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "petsc: process %d of %d has no cell of %lld: take fewer processes", idle,
                   r->world->count, (long long)r->head.count[r->head.n]);
}

static dvi_status list_own(const dvi__mesh_reader *r, list *own)
{
  IS set = NULL;
  PetscInt count = 0;
  dvi_status status = dvi__world_agree(r->world, dvi__check_petsc(find_own(r, &set)));
  if (status == DVI_OK) status = dvi__check_petsc(ISGetLocalSize(set, &count));
  status = dvi__world_agree(r->world, status);
  if (status == DVI_OK) status = allocate_list(r, count, own);
  if (status == DVI_OK)
    status = dvi__world_agree(r->world, dvi__check_petsc(copy_set(set, own->number)));
  (void)ISDestroy(&set);
  return status == DVI_OK ? check_own(r, own->count) : status;
}

/* List the vertices of some n-cells. */
static dvi_status list_vertices(const dvi__mesh_reader *r, const list *cells, list *vertices)
{
  PetscSF forest = NULL;
  dvi_status status = dvi__forest_of(r->block + r->head.n, cells->count, cells->number, 1, &forest);
  if (status == DVI_OK) status = allocate_list(r, cells->count * r->head.corners, vertices);
  if (status == DVI_OK)
    status = dvi__spread(r->world, forest, (dvi__row){MPI_INT, r->head.corners}, r->corner,
                         vertices->number);
  (void)PetscSFDestroy(&forest);
  return status == DVI_OK ? sort_list(r, vertices) : status;
}

/* ---- cells around vertices ---- */

/* The cells around the vertices of this process's block, one vertex after another. */
typedef struct around {
  PetscSF forest; /* leaves are the corners of the block's cells */
  const PetscInt *degree;
  list cells;
} around;

static dvi_status find_around(const dvi__mesh_reader *r, around *a)
{
  const dvi__block *b = r->block + r->head.n;
  const int64_t corners = (b->last - b->first) * r->head.corners;
  list cell = {0};
  int64_t count = 0;
  DVI_TRY(dvi__forest_of(r->block, corners, r->corner, 1, &a->forest));
  DVI_TRY(dvi__count_leaves(r->world, a->forest, &a->degree));
  for (int64_t v = 0; v < r->block->last - r->block->first; v++) count += a->degree[v];
  DVI_TRY(allocate_list(r, count, &a->cells));
  dvi_status status = allocate_list(r, corners, &cell);
  for (int64_t i = 0; i < corners && status == DVI_OK; i++)
    cell.number[i] = (int)(b->first + i / r->head.corners);
  if (status == DVI_OK)
    status = dvi__gather(r->world, a->forest, (dvi__row){MPI_INT, 1}, cell.number, a->cells.number);
  dvi__release(cell.number);
  return status;
}

/* Make the forest whose leaves are the cells around the vertices that are the leaves of `asked`. */
static PetscErrorCode plant_lists(const dvi__mesh_reader *r, const PetscInt *degree, PetscSF asked,
                                  PetscSF *forest, PetscInt *leaves)
{
  PetscSection here, there;
  PetscInt *offset = NULL;
  PetscCall(PetscSectionCreate(r->world->comm, &here));
  PetscCall(PetscSectionCreate(r->world->comm, &there));
  PetscCall(PetscSectionSetChart(here, 0, (PetscInt)(r->block->last - r->block->first)));
  for (PetscInt v = 0; v < r->block->last - r->block->first; v++)
    PetscCall(PetscSectionSetDof(here, v, degree[v]));
  PetscCall(PetscSectionSetUp(here));
  PetscCall(PetscSFDistributeSection(asked, here, &offset, there));
  PetscCall(PetscSFCreateSectionSF(asked, here, offset, there, forest));
  PetscCall(PetscSectionGetStorageSize(there, leaves));
  PetscCall(PetscFree(offset));
  PetscCall(PetscSectionDestroy(&here));
  return PetscSectionDestroy(&there);
}

/* List the cells that have some of the vertices. */
static dvi_status ask_vertices(const dvi__mesh_reader *r, const around *a, const list *vertices,
                               list *cells)
{
  PetscSF asked = NULL, forest = NULL;
  PetscInt leaves = 0;
  dvi_status status = dvi__forest_of(r->block, vertices->count, vertices->number, 1, &asked);
  if (status == DVI_OK)
    status = dvi__world_agree(r->world,
                              dvi__check_petsc(plant_lists(r, a->degree, asked, &forest, &leaves)));
  (void)PetscSFDestroy(&asked);
  if (status == DVI_OK) status = allocate_list(r, leaves, cells);
  if (status == DVI_OK)
    status = dvi__spread(r->world, forest, (dvi__row){MPI_INT, 1}, a->cells.number, cells->number);
  (void)PetscSFDestroy(&forest);
  return status == DVI_OK ? sort_list(r, cells) : status;
}

static dvi_status find_touching(const dvi__mesh_reader *r, const list *vertices, list *cells)
{
  around a = {0};
  dvi_status status = find_around(r, &a);
  if (status == DVI_OK) status = ask_vertices(r, &a, vertices, cells);
  (void)PetscSFDestroy(&a.forest);
  dvi__release(a.cells.number);
  return status;
}

dvi_status dvi__find_cells(dvi__mesh_reader *r)
{
  list own = {0}, vertices = {0}, cells = {0}, all = {0};
  dvi_status status = list_own(r, &own);
  if (status == DVI_OK) status = list_vertices(r, &own, &vertices);
  dvi__release(own.number);
  if (status == DVI_OK) status = find_touching(r, &vertices, &cells);
  dvi__release(vertices.number);
  if (status == DVI_OK) status = list_vertices(r, &cells, &all);
  r->number = cells.number;
  r->cells = cells.count;
  r->vertex = all.number;
  r->points = all.count;
  return status;
}
