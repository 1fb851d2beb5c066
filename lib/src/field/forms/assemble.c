#include "field/forms/assemble.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/complex.h"

/* ---- the faces of one cell ---- */

static int bits_of(int mask)
{
  int count = 0;
  for (; mask != 0; mask &= mask - 1) count++;
  return count;
}

/* Simplices have a face for each set of k + 1 corners. Boxes have 2^(n-k) faces for each set of k
 * axes. */
static int count_faces(dvi_cell_kind kind, int n, int k)
{
  int count = 0;
  const int simplex = kind == DVI_SIMPLICES, sets = 1 << (n + simplex);
  for (int set = 0; set < sets; set++) count += bits_of(set) == k + simplex;
  return simplex ? count : count << (n - k);
}

/* Give set number i of those with `members` bits, in ascending order. */
static int set_number(int members, int i)
{
  int set = 0;
  for (;; set++)
    if (bits_of(set) == members && i-- == 0) return set;
}

/* Spread the low bits of a number over the bits of a set. */
static int spread(int number, int set)
{
  int bits = 0;
  for (int bit = 0; set >> bit != 0; bit++)
    if (set >> bit & 1) {
      bits |= (number & 1) << bit;
      number >>= 1;
    }
  return bits;
}

static void find_face(dvi_cell_kind kind, int n, int k, int i, int *corner)
{
  if (kind == DVI_SIMPLICES) {
    const int set = set_number(k + 1, i);
    for (int c = 0, at = 0; c <= n; c++)
      if (set >> c & 1) corner[at++] = c;
    return;
  }
  const int axes = set_number(k, i >> (n - k)), others = ((1 << n) - 1) & ~axes,
            place = spread(i & ((1 << (n - k)) - 1), others);
  for (int c = 0; c < 1 << k; c++) corner[c] = place | spread(c, axes);
}

void dvi__find_local_faces(dvi_cell_kind kind, int n, int k, dvi__local_faces *faces)
{
  faces->count = count_faces(kind, n, k);
  for (int i = 0; i < faces->count; i++) find_face(kind, n, k, i, faces->corner[i]);
}

/* ---- the sum ---- */

/* The k-cells of all n-cells, and the n-cells of all k-cells. */
typedef struct assembly {
  const dvi_star *star;
  int k, width;
  int64_t rows, cells;
  dvi__local_faces local;
  int *face;      /* [cells*width] */
  int8_t *sign;   /* [cells*width] orientation of the face relative to the mesh's cell */
  int64_t *start; /* [rows+1] */
  int *cell;      /* [cells*width] the n-cells of each k-cell, from start on */
  int *seen;      /* [rows] the last row with this column */
} assembly;

static void find_faces(assembly *a, int64_t cell)
{
  const dvi_mesh *mesh = a->star->mesh;
  const int n = mesh->n, corners = dvi__corners(mesh->kind, a->k),
            *corner = mesh->corner[n] + cell * dvi__corners(mesh->kind, n);
  for (int i = 0; i < a->width; i++) {
    int vertex[DVI__CORNERS];
    const int64_t at = cell * a->width + i;
    for (int c = 0; c < corners; c++) vertex[c] = corner[a->local.corner[i][c]];
    const int64_t face = a->k == n ? cell : dvi__complex_find(mesh, a->k, vertex);
    a->face[at] = (int)face;
    a->sign[at] = 1;
    if (a->k > 0)
      a->sign[at] = (int8_t)dvi__relative_orientation(mesh->kind, a->k, vertex,
                                                      mesh->corner[a->k] + face * corners);
  }
}

static void transpose_faces(assembly *a)
{
  const int64_t places = a->cells * a->width;
  for (int64_t at = 0; at < places; at++) a->start[a->face[at] + 1]++;
  for (int64_t row = 0; row < a->rows; row++) a->start[row + 1] += a->start[row];
  for (int64_t cell = 0; cell < a->cells; cell++)
    for (int i = 0; i < a->width; i++)
      a->cell[a->start[a->face[cell * a->width + i]]++] = (int)cell;
  for (int64_t row = a->rows; row > 0; row--) a->start[row] = a->start[row - 1];
  a->start[0] = 0;
}

static dvi_status prepare(assembly *a)
{
  const int64_t places = a->cells * a->width;
  a->face = DVI_NEW(int, places);
  a->sign = DVI_NEW(int8_t, places);
  a->start = DVI_NEW(int64_t, a->rows + 1);
  a->cell = DVI_NEW(int, places);
  a->seen = DVI_NEW(int, a->rows);
  if (!a->face || !a->sign || !a->start || !a->cell || !a->seen)
    return dvi__fail(DVI_NO_MEMORY, "forms: no memory for the faces of %lld cells",
                     (long long)a->cells);
  for (int64_t cell = 0; cell < a->cells; cell++) find_faces(a, cell);
  transpose_faces(a);
  return DVI_OK;
}

/* Enter the columns of a row in ascending order, if there is room for them, and count them. */
static int64_t lay_out_row(assembly *a, int64_t row, int *column)
{
  int64_t count = 0;
  for (int64_t e = a->start[row]; e < a->start[row + 1]; e++)
    for (int i = 0; i < a->width; i++) {
      const int other = a->face[(int64_t)a->cell[e] * a->width + i];
      if (a->seen[other] == row) continue;
      a->seen[other] = (int)row;
      int64_t at = count++;
      if (column == NULL) continue;
      for (; at > 0 && column[at - 1] > other; at--) column[at] = column[at - 1];
      column[at] = other;
    }
  return count;
}

static dvi_status lay_out(assembly *a, dvi__csr *sum)
{
  sum->rows = sum->columns = a->rows;
  sum->start = DVI_NEW(int64_t, a->rows + 1);
  if (sum->start == NULL) return dvi__fail(DVI_NO_MEMORY, "forms: no memory for a matrix");
  for (int64_t row = 0; row < a->rows; row++) a->seen[row] = -1;
  for (int64_t row = 0; row < a->rows; row++)
    sum->start[row + 1] = sum->start[row] + lay_out_row(a, row, NULL);
  sum->column = DVI_NEW(int, sum->start[a->rows]);
  sum->value = DVI_NEW(double, sum->start[a->rows]);
  if (sum->column == NULL || sum->value == NULL)
    return dvi__fail(DVI_NO_MEMORY, "forms: no memory for a matrix");
  for (int64_t row = 0; row < a->rows; row++) a->seen[row] = -1;
  for (int64_t row = 0; row < a->rows; row++)
    (void)lay_out_row(a, row, sum->column + sum->start[row]);
  return DVI_OK;
}

static dvi_status add_cells(const assembly *a, dvi__local_matrix *local, dvi__csr *sum)
{
  double matrix[DVI__LOCAL_FACES * DVI__LOCAL_FACES];
  for (int64_t cell = 0; cell < a->cells; cell++) {
    const int *face = a->face + cell * a->width;
    const int8_t *sign = a->sign + cell * a->width;
    DVI_TRY(local(a->star, a->k, cell, &a->local, matrix));
    for (int i = 0; i < a->width; i++)
      for (int j = 0; j < a->width; j++)
        sum->value[dvi__csr_find(sum, face[i], face[j])] += sign[i] * sign[j] *
                                                            matrix[i * a->width + j];
  }
  return DVI_OK;
}

dvi_status dvi__assemble(const dvi_star *star, int k, dvi__local_matrix *local, dvi__csr *sum)
{
  const dvi_mesh *mesh = star->mesh;
  assembly a = {.star = star, .k = k, .rows = mesh->count[k], .cells = mesh->count[mesh->n]};
  dvi__find_local_faces(mesh->kind, mesh->n, k, &a.local);
  a.width = a.local.count;
  dvi_status status = prepare(&a);
  if (status == DVI_OK) status = lay_out(&a, sum);
  if (status == DVI_OK) status = add_cells(&a, local, sum);
  dvi__release(a.face);
  dvi__release(a.sign);
  dvi__release(a.start);
  dvi__release(a.cell);
  dvi__release(a.seen);
  if (status == DVI_OK) return status;
  dvi__csr_clear(sum);
  return status;
}
