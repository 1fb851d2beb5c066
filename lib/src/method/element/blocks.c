#include "method/element/blocks.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/small_inverse.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"

/* Largest block. Inverting and multiplying it takes the cubes and squares of its size, where
 * factors of its sparse pattern may take less. */
enum { MOST_ROWS = DVI__SMALL_INVERSE_MOST };

struct dvi__blocks {
  int count;
  int *first;       /* [count+1] place of each block's first unknown in the list below */
  int *unknown;     /* [unknowns] unknowns of the Jacobian, block by block */
  size_t entries;   /* numbers of all blocks, column by column */
  int *source;      /* [entries] entry of the Jacobian, -1 for 0 */
  double *jacobian; /* values of a Jacobian */
};

/* ---- create ---- */

static int root_of(int *root, int i)
{
  while (root[i] != i) i = root[i] = root[root[i]];
  return i;
}

/* Join the coordinates that meet in the pattern of the mass. Each root is the least of its set. */
static void join_coordinates(const dvi__pattern *vv, int *root)
{
  for (int i = 0; i < vv->columns; i++) root[i] = i;
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++) {
      const int a = root_of(root, j), b = root_of(root, vv->row[e]);
      root[a > b ? a : b] = a > b ? b : a;
    }
}

/* List the unknowns of each set, and the sets in the order of their roots. `next` [n] is work. */
static void list_unknowns(int n, int s, int *root, int *next, dvi__blocks *made)
{
  for (int i = 0; i < n; i++) next[i] = 0;
  for (int i = 0; i < n; i++) next[root_of(root, i)] += s;
  for (int i = 0, at = 0; i < n; i++) {
    const int size = next[i];
    next[i] = at;
    at += size;
    if (size > 0) made->first[++made->count] = at;
  }
  for (int i = 0; i < n; i++)
    for (int k = 0; k < s; k++) made->unknown[next[root_of(root, i)]++] = i * s + k;
}

static void find_sources(const dvi__pattern *jacobian, dvi__blocks *made)
{
  int *source = made->source;
  for (int b = 0; b < made->count; b++)
    for (int j = made->first[b]; j < made->first[b + 1]; j++)
      for (int i = made->first[b]; i < made->first[b + 1]; i++)
        *source++ = dvi__pattern_find(jacobian, made->unknown[i], made->unknown[j]);
}

/* Count the entries of all blocks. Returns the largest number of rows. */
static int count_entries(dvi__blocks *made)
{
  int most = 0;
  for (int b = 0; b < made->count; b++) {
    const int rows = made->first[b + 1] - made->first[b];
    made->entries += (size_t)rows * (size_t)rows;
    if (rows > most) most = rows;
  }
  return most;
}

static dvi_status refuse_memory_of_blocks(void)
{
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for blocks of the Jacobian");
}

static dvi_status blocks_fill(const dvi__pattern *vv, const dvi__pattern *jacobian, int s,
                              dvi__blocks *made, int *most)
{
  const int n = vv->columns;
  int *root = DVI_NEW(int, 2 * (size_t)n);
  made->first = DVI_NEW(int, (size_t)n + 1);
  made->unknown = DVI_NEW(int, (size_t)n *(size_t)s);
  if (root == NULL || made->first == NULL || made->unknown == NULL) {
    dvi__release(root);
    return refuse_memory_of_blocks();
  }
  join_coordinates(vv, root);
  list_unknowns(n, s, root, root + n, made);
  dvi__release(root);
  *most = count_entries(made);
  if (*most > MOST_ROWS) return DVI_OK;
  made->source = DVI_NEW(int, made->entries);
  made->jacobian = DVI_NEW(double, dvi__pattern_entries(jacobian));
  if (made->source == NULL || made->jacobian == NULL) return refuse_memory_of_blocks();
  find_sources(jacobian, made);
  return DVI_OK;
}

dvi_status dvi__blocks_create(const dvi__pattern *vv, const dvi__pattern *jacobian, int s,
                              dvi__blocks **blocks)
{
  int most = 0;
  dvi__blocks *made = *blocks = DVI_NEW(dvi__blocks, 1);
  if (made == NULL) return refuse_memory_of_blocks();
  const dvi_status status = blocks_fill(vv, jacobian, s, made, &most);
  if (status != DVI_OK || most > MOST_ROWS) dvi__blocks_destroy(blocks);
  return status;
}

void dvi__blocks_destroy(dvi__blocks **blocks)
{
  dvi__blocks *b = *blocks;
  if (b == NULL) return;
  dvi__release(b->first);
  dvi__release(b->unknown);
  dvi__release(b->source);
  dvi__release(b->jacobian);
  dvi__release(b);
  *blocks = NULL;
}

size_t dvi__blocks_numbers(const dvi__blocks *blocks)
{
  return 1 + 2 * blocks->entries;
}

double *dvi__blocks_jacobian(dvi__blocks *blocks)
{
  return blocks->jacobian;
}

/* ---- inverses ---- */

dvi_status dvi__blocks_invert(dvi__blocks *blocks, double *numbers)
{
  double *A = numbers + 1;
  int sign = 1;
  for (size_t e = 0; e < blocks->entries; e++)
    A[e] = blocks->source[e] >= 0 ? blocks->jacobian[blocks->source[e]] : 0;
  A = memcpy(A + blocks->entries, A, blocks->entries * sizeof *A);
  for (int b = 0; b < blocks->count && sign != 0; b++) {
    const int m = blocks->first[b + 1] - blocks->first[b];
    sign *= dvi__small_invert(m, A);
    A += m * m;
  }
  *numbers = sign;
  return sign != 0 ? DVI_OK : dvi__fail(DVI_SINGULAR, "a block of the Jacobian is singular");
}

void dvi__blocks_add_moved(const dvi__blocks *blocks, const double *numbers, const double *x,
                           double *sum)
{
  const double *A = numbers + 1;
  for (int b = 0; b < blocks->count; b++)
    for (int j = blocks->first[b]; j < blocks->first[b + 1]; j++)
      for (int i = blocks->first[b]; i < blocks->first[b + 1]; i++, A++)
        sum[blocks->unknown[i]] += fabs(*A * x[blocks->unknown[j]]);
}

static inline void add_column(int m, double by, const double *restrict column, double *restrict sum)
{
  for (int i = 0; i < m; i++) sum[i] += column[i] * by;
}

WIDE static void solve_blocks(const dvi__blocks *blocks, const double *A, double *R)
{
  for (int b = 0; b < blocks->count; b++) {
    const int m = blocks->first[b + 1] - blocks->first[b],
              *unknown = blocks->unknown + blocks->first[b];
    double sum[MOST_ROWS] = {0};
    for (int j = 0; j < m; j++, A += m) add_column(m, R[unknown[j]], A, sum);
    for (int i = 0; i < m; i++) R[unknown[i]] = sum[i];
  }
}

void dvi__blocks_solve(const dvi__blocks *blocks, const double *numbers, double *R)
{
  solve_blocks(blocks, numbers + 1 + blocks->entries, R);
}

INLINE void add_products(size_t width, const double *restrict column, const double *restrict by,
                         double *restrict sum)
{
  for (size_t k = 0; k < width; k++) sum[k] += column[k] * by[k];
}

WIDE static void solve_members(const dvi__blocks *blocks, size_t width, size_t stride,
                               const double *A, double *R, double *sum)
{
  for (int b = 0; b < blocks->count; b++) {
    const int m = blocks->first[b + 1] - blocks->first[b],
              *unknown = blocks->unknown + blocks->first[b];
    memset(sum, 0, (size_t)m * width * sizeof *sum);
    for (int j = 0; j < m; j++)
      for (int i = 0; i < m; i++, A += stride)
        add_products(width, A, R + (size_t)unknown[j] * width, sum + (size_t)i * width);
    for (int i = 0; i < m; i++)
      memcpy(R + (size_t)unknown[i] * width, sum + (size_t)i * width, width * sizeof *sum);
  }
}

void dvi__blocks_solve_members(const dvi__blocks *blocks, int width, int stride,
                               const double *inverses, double *R, double *work)
{
  solve_members(blocks, (size_t)width, (size_t)stride, inverses, R, work);
}

size_t dvi__blocks_inverses(const dvi__blocks *blocks)
{
  return 1 + blocks->entries;
}
