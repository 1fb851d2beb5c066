/* Patterns of second derivatives. They are found for a kernel, and for all its elements together as
 * a matrix by compressed columns. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "expr/function/function_parts.h"
#include "text/heap.h"

dvi_status dvi__find_pairs(dvi__function *function, int k)
{
  const dvi__kernel *kernel = &function->kernel[k];
  dvi__derivatives *own = &function->derivatives[k];
  if (own->pair_count >= 0) return DVI_OK;
  int(*found)[2] = NULL, count = 0;
  dvi_status status = dvi__second_pattern(kernel->graph, kernel->root, kernel->input_count, &found,
                                          &count);
  if (status != DVI_OK) return status;
  own->pair = dvi__arena_take(&function->arena, (size_t)count, sizeof *own->pair);
  if (own->pair == NULL) status = DVI_NO_MEMORY;
  if (status == DVI_OK && count > 0) memcpy(own->pair, found, (size_t)count * sizeof *found);
  if (status == DVI_OK) own->pair_count = count;
  dvi__heap_free(found);
  return status;
}

/* ---- all entries of a pair of blocks, once for every element that adds to them ---- */

/* Visit an entry. Returns 1 if more are wanted. */
typedef bool visitor(void *user, int row, int column);

static inline bool visit_elements(int elements, const dvi__element_places *row,
                                  const dvi__element_places *column, visitor *visit, void *user)
{
  for (int e = 0; e < elements; e++)
    if (!visit(user, dvi__place_at(row, e), dvi__place_at(column, e))) return false;
  return true;
}

static inline bool visit_all(const dvi__function *function, dvi__block_pair pair, visitor *visit,
                             void *user)
{
  for (int k = 0; k < function->kernel_count; k++) {
    const dvi__kernel *kernel = &function->kernel[k];
    const dvi__derivatives *own = &function->derivatives[k];
    for (int e = 0; e < own->pair_count; e++) {
      const int i = own->pair[e][0], j = own->pair[e][1];
      if (kernel->input[i].is_data || kernel->input[j].is_data) continue;
      const int first = kernel->input[i].block, second = kernel->input[j].block;
      bool more = true;
      if (first == pair.rows && second == pair.columns)
        more = visit_elements(kernel->elements, &own->place[i], &own->place[j], visit, user);
      if (more && second == pair.rows && first == pair.columns && i != j)
        more = visit_elements(kernel->elements, &own->place[j], &own->place[i], visit, user);
      if (!more) return false;
    }
  }
  return true;
}

/* ---- by bits, for matrices that are not much larger than what is added to them ---- */

typedef struct bits {
  size_t rows;
  size_t count, enough; /* bits that are set, and the number above which a pattern is full */
  unsigned char *bit;   /* [rows * columns / 8] column by column */
} bits;

static bool set_bit(void *user, int row, int column)
{
  bits *all = user;
  const size_t at = (size_t)column * all->rows + (size_t)row;
  all->count += (~(unsigned)all->bit[at / 8] >> at % 8) & 1U;
  all->bit[at / 8] |= (unsigned char)(1U << at % 8);
  return all->count <= all->enough;
}

static void read_bits(const bits *all, int columns, int *start, int *row)
{
  for (int j = 0; j < columns; j++) {
    start[j + 1] = start[j];
    for (size_t i = 0; i < all->rows; i++) {
      const size_t at = (size_t)j * all->rows + i;
      if (((unsigned)all->bit[at / 8] >> at % 8 & 1U) != 0) row[start[j + 1]++] = (int)i;
    }
  }
}

/* Take room in the arena for a pattern, or none if it is nearly full. */
static dvi_status take_pattern(dvi__function *function, size_t full_size, size_t entries,
                               int columns, int **start, int **row, dvi__pair_pattern *known)
{
  *start = NULL;
  *row = NULL;
  known->full = entries > full_size - entries;
  if (known->full) entries = full_size;
  if (entries > INT_MAX) return DVI_BAD_SIZE;
  known->entries = (int)entries;
  if (known->full) return DVI_OK;
  *start = dvi__arena_take(&function->arena, (size_t)columns + 1, sizeof **start);
  *row = dvi__arena_take(&function->arena, entries, sizeof **row);
  known->pattern = (dvi_pattern){*start, *row};
  return *start != NULL && *row != NULL ? DVI_OK : DVI_NO_MEMORY;
}

/* Return how many entries a full matrix of the pair has. */
static size_t full_size_of(const dvi__function *function, dvi__block_pair pair)
{
  return (size_t)function->blocks.width[pair.rows] * (size_t)function->blocks.width[pair.columns];
}

static dvi_status pattern_by_bits(dvi__function *function, dvi__block_pair pair,
                                  dvi__pair_pattern *known)
{
  const size_t rows = (size_t)function->blocks.width[pair.rows],
               full_size = full_size_of(function, pair);
  const int columns = function->blocks.width[pair.columns];
  bits all = {.rows = rows, .enough = full_size / 2, .bit = dvi__heap_take(full_size / 8 + 1, 1)};
  int *start, *row;
  if (all.bit == NULL) return DVI_NO_MEMORY;
  (void)visit_all(function, pair, set_bit, &all);
  const dvi_status status = take_pattern(function, full_size, all.count, columns, &start, &row,
                                         known);
  if (status == DVI_OK && start != NULL) read_bits(&all, columns, start, row);
  dvi__heap_free(all.bit);
  return status;
}

/* ---- by lists, for large matrices ---- */

typedef struct lists {
  int *start; /* [columns + 2] */
  int *row;
} lists;

static bool count_entry(void *user, int row, int column)
{
  const lists *all = user;
  (void)row;
  all->start[column + 2]++;
  return true;
}

static bool append_entry(void *user, int row, int column)
{
  const lists *all = user;
  all->row[all->start[column + 1]++] = row;
  return true;
}

static int compare_rows(const void *a, const void *b)
{
  const int first = *(const int *)a, second = *(const int *)b;
  return (first > second) - (first < second);
}

/* Sort the rows of each column and drop doubles. Returns how many entries are left. */
static int sort_columns(const lists *all, int columns)
{
  int entries = 0;
  for (int j = 0, first = 0; j < columns; j++) {
    const int last = all->start[j + 1];
    qsort(all->row + first, (size_t)(last - first), sizeof *all->row, compare_rows);
    all->start[j] = entries;
    for (int e = first; e < last; e++)
      if (e == first || all->row[e] != all->row[e - 1]) all->row[entries++] = all->row[e];
    first = last;
  }
  all->start[columns] = entries;
  return entries;
}

static dvi_status pattern_by_lists(dvi__function *function, dvi__block_pair pair, size_t visits,
                                   dvi__pair_pattern *known)
{
  const int columns = function->blocks.width[pair.columns];
  lists all = {.start = dvi__heap_take((size_t)columns + 2, sizeof *all.start),
               .row = dvi__heap_take(visits + 1, sizeof *all.row)};
  dvi_status status = all.start != NULL && all.row != NULL ? DVI_OK : DVI_NO_MEMORY;
  int *start = NULL, *row = NULL;
  if (status == DVI_OK) {
    (void)visit_all(function, pair, count_entry, &all);
    for (int j = 0; j < columns; j++) all.start[j + 2] += all.start[j + 1];
    (void)visit_all(function, pair, append_entry, &all);
    const int entries = sort_columns(&all, columns);
    status = take_pattern(function, full_size_of(function, pair), (size_t)entries, columns, &start,
                          &row, known);
  }
  if (status == DVI_OK && start != NULL) {
    memcpy(start, all.start, ((size_t)columns + 1) * sizeof *start);
    memcpy(row, all.row, (size_t)known->entries * sizeof *row);
  }
  dvi__heap_free(all.start);
  dvi__heap_free(all.row);
  return status;
}

/* ---- either ---- */

/* Limit the entries that are collected, doubles among them. */
static const size_t VISITS_MAX = (size_t)1 << 28, BITS_MAX = (size_t)1 << 33;

/* Return how many entries visit_all would visit. */
static size_t count_visits(const dvi__function *function, dvi__block_pair pair)
{
  size_t visits = 0;
  for (int k = 0; k < function->kernel_count; k++) {
    const dvi__kernel *kernel = &function->kernel[k];
    const dvi__derivatives *own = &function->derivatives[k];
    for (int e = 0; e < own->pair_count; e++) {
      const dvi__kernel_input *first = &kernel->input[own->pair[e][0]],
                              *second = &kernel->input[own->pair[e][1]];
      if (first->is_data || second->is_data || !dvi__pair_has(pair, first->block, second->block))
        continue;
      visits += (size_t)kernel->elements *
                (first->block == second->block && first != second ? 2 : 1);
    }
  }
  return visits;
}

dvi_status dvi__find_pattern(dvi__function *function, int pair)
{
  const dvi__block_pair blocks = function->blocks.pair[pair];
  dvi__pair_pattern *known = &function->pattern[pair], found = {.found = 1};
  dvi_status status = DVI_OK;
  if (known->found) return DVI_OK;
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++)
    status = dvi__find_pairs(function, k);
  if (status != DVI_OK) return status;
  const size_t visits = count_visits(function, blocks), full_size = full_size_of(function, blocks);
  if (full_size <= 32 * visits && full_size <= BITS_MAX)
    status = pattern_by_bits(function, blocks, &found);
  else
    status = visits <= VISITS_MAX ? pattern_by_lists(function, blocks, visits, &found)
                                  : DVI_BAD_SIZE;
  if (status != DVI_OK) return status;
  *known = found;
  return DVI_OK;
}

int dvi__pattern_entry(const dvi_pattern *pattern, int row, int column)
{
  int first = pattern->start[column], last = pattern->start[column + 1];
  while (last - first > 1) {
    const int middle = first + (last - first) / 2;
    if (pattern->row[middle] <= row)
      first = middle;
    else
      last = middle;
  }
  return first;
}
