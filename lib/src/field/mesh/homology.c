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
#include "field/mesh/mesh.h"

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

/* Enter the boundary of a cell behind the last column. Returns its number of entries. */
static int enter_boundary(reduction *r, const dvi_mesh *mesh, int k, int64_t cell)
{
  const int slots = dvi__facets(mesh->kind, k);
  entry *column = r->pool + r->length;
  for (int i = 0; i < slots; i++) {
    const int is_positive = mesh->sign[k][cell * slots + i] > 0;
    const entry new = {mesh->facet[k][cell * slots + i], is_positive ? 1 : (int)prime - 1};
    int at = i;
    for (; at > 0 && column[at - 1].row < new.row; at--) column[at] = column[at - 1];
    column[at] = new;
  }
  return slots;
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

/* Find the rank of the boundary operator of degree k, and replace the pivots `cleared` of degree
 * k + 1 by those of degree k. */
static dvi_status find_rank(const dvi_mesh *mesh, int k, reduction *r, char *cleared, int64_t *rank)
{
  for (int64_t row = 0; row < mesh->count[k - 1]; row++) r->first[row] = -1;
  r->length = 0;
  *rank = 0;
  for (int64_t cell = 0; cell < mesh->count[k]; cell++) {
    if (cleared[cell]) continue;
    DVI_TRY(make_room(r, dvi__facets(mesh->kind, k)));
    DVI_TRY(reduce(r, enter_boundary(r, mesh, k, cell)));
  }
  for (int64_t row = 0; row < mesh->count[k - 1]; row++) {
    cleared[row] = r->first[row] >= 0;
    *rank += cleared[row];
  }
  return DVI_OK;
}

static dvi_status find_ranks(const dvi_mesh *mesh, int64_t *rank)
{
  int64_t most = 0;
  for (int k = 0; k <= mesh->n; k++) most = mesh->count[k] > most ? mesh->count[k] : most;
  reduction r = {.pool = DVI_NEW(entry, most),
                 .room = most,
                 .first = DVI_NEW(int64_t, most),
                 .count = DVI_NEW(int, most)};
  char *cleared = DVI_NEW(char, most);
  dvi_status status = DVI_OK;
  if (r.pool == NULL || r.first == NULL || r.count == NULL || cleared == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "mesh: no memory for Betti numbers");
  for (int k = mesh->n; k > 0 && status == DVI_OK; k--)
    status = find_rank(mesh, k, &r, cleared, rank + k);
  dvi__release(r.pool);
  dvi__release(r.first);
  dvi__release(r.count);
  dvi__release(cleared);
  return status;
}

dvi_status dvi_mesh_betti(const dvi_mesh *mesh, int64_t *betti)
{
  int64_t rank[DVI__DEGREES + 1] = {0}; /* of the boundary of k-cells */
  if (mesh == NULL || betti == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: a mesh and an array are needed");
  DVI_TRY(find_ranks(mesh, rank));
  for (int k = 0; k <= mesh->n; k++) betti[k] = mesh->count[k] - rank[k] - rank[k + 1];
  return DVI_OK;
}
