/* The Betti numbers b_k = N_k - rank d_k - rank d_{k-1}, by elimination modulo a prime.
 *
 * The columns of the boundary operator of degree k, which are the rows of d_{k-1}, are reduced one
 * after the other. As long as the last entry of a column is the pivot of an earlier one, a multiple
 * of that one is subtracted. What is left is zero, or has a new pivot. A cell that is a pivot of
 * degree k + 1 is a boundary up to earlier cells, so that its own column reduces to zero and is
 * left out. Degrees are taken from the highest one down for this reason (Chen and Kerber 2011). */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/homology.h"
#include "field/mesh/mesh.h"
#include "field/mesh/share.h"

static const int64_t prime = 2147483629; /* 2^31 - 19 */

/* An entry of a column. */
typedef struct entry {
  int row;
  int value; /* 1 to prime - 1 */
} entry;

/* The reduced columns of one degree. */
typedef struct reduction {
  entry *pool; /* all columns, one behind the other, each with descending rows */
  int64_t length, room;
  int64_t *first; /* [rows+1] the column whose pivot is a row, in the pool, or -1 */
  int *count;     /* [rows] its number of entries */
  char *cleared;  /* [columns] those that reduce to zero, by the degree above */
} reduction;

static int64_t inverse(int64_t a)
{
  int64_t power = prime - 2, result = 1;
  for (; power > 0; power /= 2) {
    if (power % 2 == 1) result = result * a % prime;
    a = a * a % prime;
  }
  return result;
}

/* Make room for more entries behind the last column, and keep the column in work. */
static dvi_status make_room(reduction *r, int64_t more)
{
  if (r->length + more <= r->room) return DVI_OK;
  const int64_t room = 2 * (r->length + more);
  entry *pool = DVI_NEW(entry, room);
  if (pool == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for Betti numbers");
  memcpy(pool, r->pool, (size_t)r->room * sizeof *pool);
  dvi__release(r->pool);
  r->pool = pool;
  r->room = room;
  return DVI_OK;
}

/* Set out = a - factor b. Returns the number of entries. */
static int subtract(const entry *a, int of_a, const entry *b, int of_b, int64_t factor, entry *out)
{
  int i = 0, j = 0, count = 0;
  while (i < of_a || j < of_b) {
    const int take_a = j == of_b || (i < of_a && a[i].row >= b[j].row),
              take_b = i == of_a || (j < of_b && b[j].row >= a[i].row),
              row = take_a ? a[i].row : b[j].row;
    int64_t value = take_a ? a[i++].value : 0;
    if (take_b) value = (value + prime - factor * b[j++].value % prime) % prime;
    if (value != 0) out[count++] = (entry){row, (int)value};
  }
  return count;
}

/* Enter the boundary of a cell, without held ones, behind the last column. Returns its number of
 * entries. */
static int enter_boundary(reduction *r, const dvi_mesh *mesh, int k, int64_t cell, const char *held)
{
  const int slots = dvi__facets(mesh->kind, k);
  entry *column = r->pool + r->length;
  int count = 0;
  for (int i = 0; i < slots; i++) {
    const int is_positive = mesh->sign[k][cell * slots + i] > 0;
    const entry new = {mesh->facet[k][cell * slots + i], is_positive ? 1 : (int)prime - 1};
    if (held != NULL && held[new.row]) continue;
    int at = count++;
    for (; at > 0 && column[at - 1].row < new.row; at--) column[at] = column[at - 1];
    column[at] = new;
  }
  return count;
}

/* Reduce the column behind the last one, and keep it if it has a new pivot. */
static dvi_status reduce(reduction *r, int count)
{
  while (count > 0) {
    const int pivot = r->pool[r->length].row;
    const int64_t other = r->first[pivot];
    if (other < 0) break;
    DVI_TRY(make_room(r, 2 * (int64_t)count + r->count[pivot]));
    entry *column = r->pool + r->length, *difference = column + count;
    const int64_t factor = column->value * inverse(r->pool[other].value) % prime;
    count = subtract(column, count, r->pool + other, r->count[pivot], factor, difference);
    memmove(column, difference, (size_t)count * sizeof *column);
  }
  if (count == 0) return DVI_OK;
  const int pivot = r->pool[r->length].row;
  r->first[pivot] = r->length;
  r->count[pivot] = count;
  r->length += count;
  return DVI_OK;
}

static dvi_status create(const dvi_mesh *mesh, reduction *r)
{
  int64_t most = 0;
  for (int k = 0; k <= mesh->n; k++) most = mesh->count[k] > most ? mesh->count[k] : most;
  *r = (reduction){.pool = DVI_NEW(entry, most),
                   .room = most,
                   .first = DVI_NEW(int64_t, most),
                   .count = DVI_NEW(int, most),
                   .cleared = DVI_NEW(char, most)};
  if (r->pool == NULL || r->first == NULL || r->count == NULL || r->cleared == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for ranks");
  return DVI_OK;
}

static void clear(reduction *r)
{
  dvi__release(r->pool);
  dvi__release(r->first);
  dvi__release(r->count);
  dvi__release(r->cleared);
}

/* Find the rank of the boundary operator of degree k onto the cells that are not held, and replace
 * the pivots of degree k + 1 by those of degree k. */
static dvi_status find_rank(reduction *r, const dvi_mesh *mesh, int k, const char *held,
                            int64_t *rank)
{
  for (int64_t row = 0; row < mesh->count[k - 1]; row++) r->first[row] = -1;
  r->length = 0;
  *rank = 0;
  for (int64_t cell = 0; cell < mesh->count[k]; cell++) {
    if (r->cleared[cell]) continue;
    DVI_TRY(make_room(r, dvi__facets(mesh->kind, k)));
    DVI_TRY(reduce(r, enter_boundary(r, mesh, k, cell, held)));
  }
  for (int64_t row = 0; row < mesh->count[k - 1]; row++) {
    r->cleared[row] = r->first[row] >= 0;
    *rank += r->cleared[row];
  }
  return DVI_OK;
}

dvi_status dvi_mesh_betti(const dvi_mesh *mesh, int64_t *betti)
{
  int64_t rank[DVI__DEGREES + 1] = {0}; /* of the boundary of k-cells */
  if (mesh == NULL || betti == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: a mesh and an array are needed");
  DVI_TRY(dvi__refuse_share(mesh, "mesh: a Betti number"));
  reduction r;
  dvi_status status = create(mesh, &r);
  for (int k = mesh->n; k > 0 && status == DVI_OK; k--)
    status = find_rank(&r, mesh, k, NULL, rank + k);
  clear(&r);
  DVI_TRY(status);
  for (int k = 0; k <= mesh->n; k++) betti[k] = mesh->count[k] - rank[k] - rank[k + 1];
  return DVI_OK;
}

/* Mark the k-cells whose facets are all held. */
static void hold_surrounded(const dvi_mesh *mesh, int k, const char *held, char *surrounded)
{
  const int slots = dvi__facets(mesh->kind, k);
  for (int64_t cell = 0; cell < mesh->count[k]; cell++) {
    surrounded[cell] = 1;
    for (int i = 0; i < slots; i++)
      if (!held[mesh->facet[k][cell * slots + i]]) surrounded[cell] = 0;
  }
}

dvi_status dvi__incidence_rank(const dvi_mesh *mesh, int k, const char *held, int64_t *rank)
{
  reduction r;
  char *surrounded = DVI_NEW(char, mesh->count[k + 1]);
  dvi_status status = create(mesh, &r);
  if (status == DVI_OK && surrounded == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "mesh: no memory for ranks");
  if (status == DVI_OK) hold_surrounded(mesh, k + 1, held, surrounded);
  if (status == DVI_OK && k + 2 <= mesh->n) status = find_rank(&r, mesh, k + 2, surrounded, rank);
  if (status == DVI_OK) status = find_rank(&r, mesh, k + 1, held, rank);
  clear(&r);
  dvi__release(surrounded);
  return status;
}
