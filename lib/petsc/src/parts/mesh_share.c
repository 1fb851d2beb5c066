/* What the cells and parts of a share are in the whole mesh. The k-cells of a whole mesh, but for
 * its n-cells, are in the order of their vertices, so that they are numbered where those with the
 * same lowest vertex meet. */
#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "division.h"
#include "meeting.h"
#include "mesh_read.h"

enum { ANSWERS = 2 }; /* to a cell: its number and its owner */

/* ---- numbers and owners ---- */

/* Fill in the vertices of each k-cell [count*width], ascending, and its first n-cell in the share
 * with the owner. */
static void write_rows(const dvi__mesh_reader *r, const dvi_mesh *mesh, int k, const int *first,
                       int *row)
{
  int corners;
  const int *corner = dvi_mesh_vertices(mesh, k, &corners), n = r->head.n;
  if (k == 0) corners = 1;
  for (int64_t c = 0; c < dvi_mesh_count(mesh, k); c++, row += corners + ANSWERS) {
    for (int i = 0; i < corners; i++) {
      const int vertex = r->vertex[k == 0 ? c : corner[c * corners + i]];
      int at = i;
      for (; at > 0 && row[at - 1] > vertex; at--) row[at] = row[at - 1];
      row[at] = vertex;
    }
    row[corners] = r->number[first[c]];
    row[corners + 1] = r->given.owner[n][first[c]];
  }
}

/* Number the cells that meet here one after another. A cell belongs to the owner of the first
 * n-cell around it. Returns how many there are, and with a first number answers. */
static int64_t number_rows(const dvi__meeting *m, int64_t number, int *answer)
{
  const int corners = m->width - ANSWERS;
  int64_t cells = 0;
  for (int64_t i = 0, first = 0; i < m->count; i++) {
    if (i == 0 || !dvi__meeting_same(m, first, i, corners)) first = i, cells++;
    if (answer == NULL) continue;
    answer[ANSWERS * m->order[i]] = (int)(number + cells - 1);
    answer[ANSWERS * m->order[i] + 1] = m->row[(int64_t)m->order[first] * m->width + corners + 1];
  }
  return cells;
}

/* The file's own count of the cells is that of the numbers. */
static dvi_status check_total(const dvi__mesh_reader *r, int k)
{
  if (r->block[k].total == r->head.count[k]) return DVI_OK;
  return dvi__slabs_refuse(r->file, "its cells have %lld faces of degree %d, and it counts %lld",
                           (long long)r->block[k].total, k, (long long)r->head.count[k]);
}

static dvi_status answer_rows(dvi__mesh_reader *r, int k, const dvi__meeting *m, int *answer)
{
  void *memory;
  dvi__block block;
  DVI_TRY(dvi__block_after(r->world, number_rows(m, 0, NULL), &block));
  r->block[k] = block;
  DVI_TRY(check_total(r, k));
  DVI_TRY(dvi__allocate_all(r->world, ANSWERS * m->count, sizeof(int), &memory));
  (void)number_rows(m, block.first, memory);
  const dvi_status status = dvi__scatter(r->world, m->forest, (dvi__row){MPI_INT, ANSWERS}, memory,
                                         answer);
  dvi__release(memory);
  return status;
}

/* Take the answers to the cells of a degree. */
static dvi_status take_answers(dvi__mesh_reader *r, int k, int64_t cells, const int *answer)
{
  void *memory;
  DVI_TRY(dvi__allocate_all(r->world, cells, sizeof(int64_t), &memory));
  r->given.number[k] = memory;
  DVI_TRY(dvi__allocate_all(r->world, cells, sizeof(int), &memory));
  r->given.owner[k] = memory;
  for (int64_t c = 0; c < cells; c++) {
    r->given.number[k][c] = answer[ANSWERS * c];
    r->given.owner[k][c] = answer[ANSWERS * c + 1];
  }
  return DVI_OK;
}

static dvi_status number_degree(dvi__mesh_reader *r, const dvi_mesh *mesh, int k, const int *first)
{
  int corners = 1;
  if (k > 0) (void)dvi_mesh_vertices(mesh, k, &corners);
  const int64_t cells = dvi_mesh_count(mesh, k);
  const int width = corners + ANSWERS;
  const dvi__block vertices = dvi__block_of(r->world, r->head.count[0]);
  void *row, *answer = NULL;
  dvi__meeting meeting = {0};
  dvi_status status = dvi__allocate_all(r->world, cells * width, sizeof(int), &row);
  if (status == DVI_OK) {
    write_rows(r, mesh, k, first, row);
    status = dvi__meet(&vertices, cells, width, row, &meeting);
  }
  dvi__release(row);
  if (status == DVI_OK) status = dvi__allocate_all(r->world, ANSWERS * cells, sizeof(int), &answer);
  if (status == DVI_OK) status = answer_rows(r, k, &meeting, answer);
  dvi__meeting_clear(&meeting);
  if (status == DVI_OK) status = take_answers(r, k, cells, answer);
  dvi__release(answer);
  return status;
}

/* Find the first n-cell [k-cells] of the share around each k-cell by those around (k+1)-cells. */
static dvi_status find_first(const dvi__mesh_reader *r, const dvi_mesh *mesh, int k,
                             const int *above, int **first)
{
  dvi_matrix d = {0};
  void *memory;
  DVI_TRY(dvi__allocate_all(r->world, dvi_mesh_count(mesh, k), sizeof(int), &memory));
  int *found = *first = memory;
  (void)dvi_mesh_incidence(mesh, k, &d);
  for (int64_t c = 0; c < d.columns; c++) found[c] = INT_MAX;
  for (int64_t i = 0; i < d.rows * d.width; i++) {
    const int cell = above != NULL ? above[i / d.width] : (int)(i / d.width);
    if (cell < found[d.column[i]]) found[d.column[i]] = cell;
  }
  return DVI_OK;
}

dvi_status dvi__number_share(dvi__mesh_reader *r, const dvi_mesh *mesh)
{
  dvi_status status = DVI_OK;
  int *above = NULL;
  for (int k = r->head.n - 1; k >= 0 && status == DVI_OK; k--) {
    int *first = NULL;
    status = find_first(r, mesh, k, above, &first);
    if (status == DVI_OK) status = number_degree(r, mesh, k, first);
    dvi__release(above);
    above = first;
  }
  dvi__release(above);
  return status;
}

/* ---- parts ---- */

/* Lists of a part's k-cells are ascending. `number` is the part of this process, and the one before
 * it if `before` is 1. */
static dvi_status check_list(const dvi__mesh_reader *r, const dvi__slab *slab, int before, int k,
                             const int *number)
{
  for (int64_t i = 0; i < slab->rows; i++)
    if (number[i] < 0 || number[i] >= r->head.count[k] || (i > 0 && number[i] <= number[i - 1]))
      return dvi__slabs_refuse(r->file, "\"%s\" has the number %d in row %lld of %lld cells",
                               slab->name, number[i], (long long)(slab->first + i - before),
                               (long long)r->head.count[k]);
  return DVI_OK;
}

/* Mark the k-cells [cells of the block] of the whole mesh that a dataset lists. */
static dvi_status mark_block(const dvi__mesh_reader *r, const char *path, int k, int64_t total,
                             char *mark)
{
  const dvi__block listed = dvi__block_of(r->world, total);
  const int before = listed.first > 0 && listed.last > listed.first;
  const dvi__slab slab = {.name = path,
                          .type = DVI__INT32,
                          .first = listed.first - before,
                          .rows = listed.last - listed.first + before};
  void *number, *ones = NULL;
  PetscSF forest = NULL;
  dvi_status status = dvi__allocate_all(r->world, slab.rows, sizeof(int), &number);
  if (status == DVI_OK) status = dvi__slabs_read(r->file, &slab, number);
  if (status == DVI_OK) status = check_list(r, &slab, before, k, number);
  status = dvi__world_agree(r->world, status);
  if (status == DVI_OK) status = dvi__allocate_all(r->world, slab.rows, 1, &ones);
  if (status == DVI_OK) {
    memset(ones, 1, (size_t)slab.rows);
    status = dvi__forest_of(r->block + k, slab.rows, number, 1, &forest);
  }
  if (status == DVI_OK)
    status = dvi__place(r->world, forest, (dvi__row){MPI_SIGNED_CHAR, 1}, ones, mark);
  (void)PetscSFDestroy(&forest);
  dvi__release(number);
  dvi__release(ones);
  return status;
}

/* Give the share its k-cells of a part. `forest` joins its k-cells to those of the whole mesh. */
static dvi_status read_cells(const dvi__mesh_reader *r, dvi_mesh *share, int p,
                             dvi__given_part *part, int k, PetscSF forest)
{
  char path[DVI__PART_PATH];
  int width = 0;
  void *mark = NULL, *marked = NULL;
  const dvi__block *b = r->block + k;
  dvi_status status = dvi__slabs_shape(r->file, dvi__cells_path(path, p, k), part->total + k,
                                       &width);
  if (status == DVI_OK && width != 0)
    status = dvi__slabs_refuse(r->file, "\"%s\" has two axes", path);
  status = dvi__world_agree(r->world, status);
  if (status == DVI_OK) status = dvi__allocate_all(r->world, b->last - b->first, 1, &mark);
  if (status == DVI_OK) status = mark_block(r, path, k, part->total[k], mark);
  if (status == DVI_OK) status = dvi__allocate_all(r->world, dvi_mesh_count(share, k), 1, &marked);
  if (status == DVI_OK)
    status = dvi__spread(r->world, forest, (dvi__row){MPI_SIGNED_CHAR, 1}, mark, marked);
  dvi__release(mark);
  if (status == DVI_OK)
    status = dvi__world_agree(r->world, dvi__share_part(share, p, part, k, marked));
  dvi__release(marked);
  return status;
}

/* Give the share all of its cells as the part "all". */
static dvi_status take_all(const dvi__mesh_reader *r, dvi_mesh *share)
{
  dvi__given_part part = {.name = "all", .degree = r->head.n};
  dvi_status status = DVI_OK;
  for (int k = 0; k <= r->head.n && status == DVI_OK; k++) {
    void *marked;
    part.total[k] = r->head.count[k];
    DVI_TRY(dvi__allocate_all(r->world, dvi_mesh_count(share, k), 1, &marked));
    memset(marked, 1, (size_t)dvi_mesh_count(share, k));
    status = dvi__world_agree(r->world, dvi__share_part(share, 0, &part, k, marked));
    dvi__release(marked);
  }
  return status;
}

/* Find the degree of a part, to which it has lists. */
static dvi_status read_degree(const dvi__mesh_reader *r, int p, dvi__given_part *part)
{
  char path[DVI__PART_PATH];
  part->degree = -1;
  while (part->degree < r->head.n &&
         dvi__slabs_have(r->file, dvi__cells_path(path, p, part->degree + 1)))
    part->degree++;
  if (part->degree >= 0 && (p > 1 || part->degree == r->head.n - 1)) return DVI_OK;
  return dvi__slabs_refuse(r->file, "part %d has no cells", p);
}

static dvi_status read_part(const dvi__mesh_reader *r, dvi_mesh *share, int p,
                            const PetscSF *forest)
{
  char path[DVI__PART_PATH], name[DVI__PART_NAME];
  dvi__given_part part = {.name = name};
  dvi_status status = dvi__slabs_read_text(r->file, dvi__part_path(path, p, "/name"), sizeof name,
                                           name);
  for (int before = 0; before < p && status == DVI_OK; before++)
    if (strcmp(name, dvi_mesh_part_name(share, before)) == 0)
      status = dvi__slabs_refuse(r->file, "parts %d and %d both are \"%s\"", before, p, name);
  if (status == DVI_OK && (strcmp(name, "boundary") == 0) != (p == 1))
    status = dvi__slabs_refuse(r->file, "part %d is not \"boundary\", as part 1 is alone", p);
  if (status == DVI_OK) status = read_degree(r, p, &part);
  status = dvi__world_agree(r->world, status);
  for (int k = 0; k <= part.degree && status == DVI_OK; k++)
    status = read_cells(r, share, p, &part, k, forest[k]);
  return status;
}

static dvi_status plant(const dvi__mesh_reader *r, const dvi_mesh *share, int k, PetscSF *forest)
{
  const int64_t cells = dvi_mesh_count(share, k), *number = dvi_mesh_share_numbers(share, k);
  void *memory;
  DVI_TRY(dvi__allocate_all(r->world, cells, sizeof(int), &memory));
  for (int64_t c = 0; c < cells; c++) ((int *)memory)[c] = (int)number[c];
  const dvi_status status = dvi__forest_of(r->block + k, cells, memory, 1, forest);
  dvi__release(memory);
  return status;
}

dvi_status dvi__read_parts(const dvi__mesh_reader *r, dvi_mesh *share)
{
  PetscSF forest[DVI__DEGREES] = {NULL};
  dvi_status status = take_all(r, share);
  for (int k = 0; k <= r->head.n && status == DVI_OK; k++) status = plant(r, share, k, forest + k);
  for (int p = 1; p < r->head.parts && status == DVI_OK; p++)
    status = read_part(r, share, p, forest);
  for (int k = 0; k < DVI__DEGREES; k++) (void)PetscSFDestroy(forest + k);
  return status;
}
