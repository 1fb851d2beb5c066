#include "num/pattern.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

int dvi__pattern_entries(const dvi__pattern *pattern)
{
  return pattern->start[pattern->columns];
}

void dvi__pattern_clear(dvi__pattern *pattern)
{
  dvi__release(pattern->start);
  dvi__release(pattern->row);
  *pattern = (dvi__pattern){0};
}

static dvi_status pattern_allocate(int rows, int columns, size_t entries, dvi__pattern *pattern)
{
  if (entries > 0x7fffffff)
    return dvi__fail(DVI_BAD_SIZE, "pattern: %zu entries are too many; declare a sparse pattern",
                     entries);
  *pattern = (dvi__pattern){rows, columns, DVI_NEW(int, (size_t)columns + 1),
                            DVI_NEW(int, entries)};
  if (pattern->start != NULL && pattern->row != NULL) return DVI_OK;
  dvi__pattern_clear(pattern);
  return dvi__fail(DVI_NO_MEMORY, "pattern: no memory for %d columns with %zu entries", columns,
                   entries);
}

dvi_status dvi__pattern_empty(int n, dvi__pattern *pattern)
{
  return pattern_allocate(n, n, 0, pattern);
}

dvi_status dvi__pattern_diagonal(int n, dvi__pattern *pattern)
{
  DVI_TRY(pattern_allocate(n, n, (size_t)n, pattern));
  for (int j = 0; j < n; j++) pattern->start[j] = pattern->row[j] = j;
  pattern->start[n] = n;
  return DVI_OK;
}

static dvi_status pattern_full(int rows, int columns, dvi__pattern *pattern)
{
  DVI_TRY(pattern_allocate(rows, columns, (size_t)rows * (size_t)columns, pattern));
  for (int j = 0; j < columns; j++) {
    pattern->start[j] = j * rows;
    for (int i = 0; i < rows; i++) pattern->row[j * rows + i] = i;
  }
  pattern->start[columns] = rows * columns;
  return DVI_OK;
}

/* Check all starts before any row is read, because start[n] is then the number of the caller's
 * rows. */
static dvi_status validate_starts(const dvi_pattern *declared, int n, const char *name)
{
  if (declared->start == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "%s: the pattern has rows but no column starts", name);
  if (declared->start[0] != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "%s: the pattern's first column starts at %d, not 0", name,
                     declared->start[0]);
  for (int j = 0; j < n; j++)
    if (declared->start[j + 1] < declared->start[j])
      return dvi__fail(DVI_BAD_ARGUMENT, "%s: the pattern's column %d ends before it starts", name,
                       j);
  if (declared->start[n] > 0 && declared->row == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "%s: the pattern has column starts but no rows", name);
  return DVI_OK;
}

static dvi_status validate_column(const dvi_pattern *declared, int n, int j, const char *name)
{
  for (int e = declared->start[j]; e < declared->start[j + 1]; e++) {
    const int row = declared->row[e];
    if (row < 0 || row >= n)
      return dvi__fail(DVI_BAD_ARGUMENT, "%s: row %d in column %d of the pattern is outside 0..%d",
                       name, row, j, n - 1);
    if (e > declared->start[j] && row <= declared->row[e - 1])
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "%s: the rows in column %d of the pattern are not ascending", name, j);
  }
  return DVI_OK;
}

dvi_status dvi__pattern_copy_rectangular(const dvi_pattern *declared, int rows, int columns,
                                         const char *name, dvi__pattern *copy)
{
  *copy = (dvi__pattern){0};
  if (declared->start == NULL && declared->row == NULL) return pattern_full(rows, columns, copy);
  DVI_TRY(validate_starts(declared, columns, name));
  for (int j = 0; j < columns; j++) DVI_TRY(validate_column(declared, rows, j, name));
  DVI_TRY(pattern_allocate(rows, columns, (size_t)declared->start[columns], copy));
  memcpy(copy->start, declared->start, ((size_t)columns + 1) * sizeof(int));
  if (declared->start[columns] > 0)
    memcpy(copy->row, declared->row, (size_t)declared->start[columns] * sizeof(int));
  return DVI_OK;
}

dvi_status dvi__pattern_copy(const dvi_pattern *declared, int n, const char *name,
                             dvi__pattern *copy)
{
  return dvi__pattern_copy_rectangular(declared, n, n, name, copy);
}

/* Merge two ascending columns. The rows are written if out is not NULL. Returns their number. */
static int merge_column(const dvi__pattern *a, const dvi__pattern *b, int j, int *out)
{
  int i = a->start[j], k = b->start[j], count = 0;
  while (i < a->start[j + 1] || k < b->start[j + 1]) {
    const int from_a = i < a->start[j + 1] ? a->row[i] : a->rows;
    const int from_b = k < b->start[j + 1] ? b->row[k] : b->rows;
    const int row = from_a < from_b ? from_a : from_b;
    i += from_a == row;
    k += from_b == row;
    if (out != NULL) out[count] = row;
    count++;
  }
  return count;
}

dvi_status dvi__pattern_union(const dvi__pattern *a, const dvi__pattern *b, dvi__pattern *sum)
{
  size_t entries = 0;
  for (int j = 0; j < a->columns; j++) entries += (size_t)merge_column(a, b, j, NULL);
  DVI_TRY(pattern_allocate(a->rows, a->columns, entries, sum));
  for (int j = 0; j < a->columns; j++)
    sum->start[j + 1] = sum->start[j] + merge_column(a, b, j, sum->row + sum->start[j]);
  return DVI_OK;
}

dvi_status dvi__pattern_transpose(const dvi__pattern *pattern, dvi__pattern *transpose)
{
  DVI_TRY(pattern_allocate(pattern->columns, pattern->rows, (size_t)dvi__pattern_entries(pattern),
                           transpose));
  for (int e = 0; e < dvi__pattern_entries(pattern); e++) transpose->start[pattern->row[e] + 1]++;
  for (int i = 0; i < pattern->rows; i++) transpose->start[i + 1] += transpose->start[i];
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      transpose->row[transpose->start[pattern->row[e]]++] = j;
  /* The starts have moved to the ends, and are moved back. */
  for (int i = pattern->rows; i > 0; i--) transpose->start[i] = transpose->start[i - 1];
  transpose->start[0] = 0;
  return DVI_OK;
}

static void fill_blocks(const dvi__pattern *pattern, const int *first, dvi__pattern *blocks)
{
  int at = 0;
  for (int j = 0; j < pattern->columns; j++)
    for (int column = first[j]; column < first[j + 1]; column++) {
      for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
        for (int row = first[pattern->row[e]]; row < first[pattern->row[e] + 1]; row++)
          blocks->row[at++] = row;
      blocks->start[column + 1] = at;
    }
}

dvi_status dvi__pattern_uneven_blocks(const dvi__pattern *pattern, const int *first,
                                      dvi__pattern *blocks)
{
  const int columns = first[pattern->columns];
  size_t entries = 0;
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      const int i = pattern->row[e];
      entries += (size_t)(first[j + 1] - first[j]) * (size_t)(first[i + 1] - first[i]);
    }
  *blocks = (dvi__pattern){0};
  if (entries > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE,
                     "action: the Jacobian would have %zu entries; declare sparse Hessians",
                     entries);
  *blocks = (dvi__pattern){columns, columns, DVI_NEW(int, (size_t)columns + 1),
                           DVI_NEW(int, entries)};
  if (blocks->start == NULL || blocks->row == NULL) {
    dvi__pattern_clear(blocks);
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for a Jacobian of %zu entries", entries);
  }
  fill_blocks(pattern, first, blocks);
  return DVI_OK;
}

dvi_status dvi__pattern_blocks(const dvi__pattern *pattern, int size, dvi__pattern *blocks)
{
  if ((size_t)pattern->columns * (size_t)size > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "action: %d blocks of %d rows are more than an int can count",
                     pattern->columns, size);
  int *first = DVI_NEW(int, (size_t)pattern->columns + 1);
  *blocks = (dvi__pattern){0};
  if (first == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d blocks", pattern->columns);
  for (int j = 0; j <= pattern->columns; j++) first[j] = j * size;
  const dvi_status status = dvi__pattern_uneven_blocks(pattern, first, blocks);
  dvi__release(first);
  return status;
}

int dvi__pattern_find(const dvi__pattern *pattern, int row, int column)
{
  int low = pattern->start[column], high = pattern->start[column + 1] - 1;
  while (low <= high) {
    const int middle = low + (high - low) / 2;
    if (pattern->row[middle] == row) return middle;
    if (pattern->row[middle] < row)
      low = middle + 1;
    else
      high = middle - 1;
  }
  return -1;
}

/* Fill-in stays between the first entry of a row or column and the diagonal. */
double dvi__pattern_operations(const dvi__pattern *pattern)
{
  const double n = pattern->columns, full = 2 * n * n * n / 3;
  double band = 0;
  for (int j = 0; j < pattern->columns && band < full; j++) {
    const int first = pattern->start[j] < pattern->start[j + 1] ? pattern->row[pattern->start[j]]
                                                                : j;
    const double width = first < j ? 1 + j - first : 1;
    band += 2 * width * width;
  }
  return band < full ? band : full;
}

void dvi__pattern_embed(const dvi__pattern *part, const dvi__pattern *whole, int *where)
{
  for (int j = 0; j < part->columns; j++)
    for (int e = part->start[j]; e < part->start[j + 1]; e++)
      where[e] = dvi__pattern_find(whole, part->row[e], j);
}

/* Find the smallest group none of whose columns meets column j. taken[g] == j marks the groups that
 * do. There are at most j of them. */
static int free_group(const dvi__pattern *pattern, const dvi__pattern *transpose, const int *group,
                      int j, int *taken)
{
  for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
    const int row = pattern->row[e];
    for (int f = transpose->start[row]; f < transpose->start[row + 1]; f++) {
      const int neighbour = transpose->row[f];
      if (neighbour < j) taken[group[neighbour]] = j;
    }
  }
  int g = 0;
  while (taken[g] == j) g++;
  return g;
}

/* A full pattern needs no search, because every column meets every other. */
static int is_full(const dvi__pattern *pattern)
{
  return (size_t)dvi__pattern_entries(pattern) == (size_t)pattern->rows * (size_t)pattern->columns;
}

dvi_status dvi__pattern_groups(const dvi__pattern *pattern, int *group, int *groups)
{
  if (is_full(pattern)) {
    for (int j = 0; j < pattern->columns; j++) group[j] = j;
    *groups = pattern->columns;
    return DVI_OK;
  }
  dvi__pattern transpose;
  DVI_TRY(dvi__pattern_transpose(pattern, &transpose));
  int *taken = DVI_NEW(int, pattern->columns);
  if (taken == NULL) {
    dvi__pattern_clear(&transpose);
    return dvi__fail(DVI_NO_MEMORY, "pattern: no memory to group %d columns", pattern->columns);
  }
  *groups = 0;
  for (int j = 0; j < pattern->columns; j++) taken[j] = -1;
  for (int j = 0; j < pattern->columns; j++) {
    group[j] = free_group(pattern, &transpose, group, j, taken);
    if (group[j] >= *groups) *groups = group[j] + 1;
  }
  dvi__release(taken);
  dvi__pattern_clear(&transpose);
  return DVI_OK;
}

dvi_status dvi__pattern_copy_symmetric(const dvi_pattern *declared, int n, const char *name,
                                       dvi__pattern *copy)
{
  DVI_TRY(dvi__pattern_copy(declared, n, name, copy));
  for (int j = 0; j < n; j++)
    for (int e = copy->start[j]; e < copy->start[j + 1]; e++)
      if (dvi__pattern_find(copy, j, copy->row[e]) < 0)
        return dvi__fail(DVI_BAD_ARGUMENT,
                         "%s: the pattern holds (%d,%d) but not (%d,%d); both triangles are needed",
                         name, copy->row[e], j, j, copy->row[e]);
  return DVI_OK;
}
