#include "field/elastic/assemble.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* ---- neighbours ---- */

/* The neighbours of each vertex and itself, ascending. */
typedef struct neighbours {
  int64_t *start; /* [vertices+1] */
  int *vertex;
  int *offset; /* of each neighbour: number of unknowns of those before it */
  int *first;  /* [vertices+1] unknowns of the vertices before each */
} neighbours;

static void clear(neighbours *of)
{
  dvi__release(of->start);
  dvi__release(of->vertex);
  dvi__release(of->offset);
  dvi__release(of->first);
}

static void count(const dvi_elastic *e, neighbours *of)
{
  const int *edge = e->mesh->corner[1];
  for (int64_t v = 0; v < e->vertices; v++) of->start[v + 1] = 1;
  for (int64_t k = 0; k < 2 * e->mesh->count[1]; k++) of->start[edge[k] + 1]++;
  for (int64_t v = 0; v < e->vertices; v++) {
    of->start[v + 1] += of->start[v];
    of->first[v + 1] = of->first[v];
    for (int i = 0; i < e->n; i++) of->first[v + 1] += e->unknown[v * e->n + i] >= 0;
  }
}

/* Edges are numbered by their smaller vertex, then by the other. `next` is where the next neighbour
 * of each vertex goes. */
static void fill(const dvi_elastic *e, int64_t *next, neighbours *of)
{
  const int *edge = e->mesh->corner[1];
  const int64_t edges = e->mesh->count[1];
  memcpy(next, of->start, (size_t)e->vertices * sizeof *next);
  for (int64_t k = 0; k < edges; k++) of->vertex[next[edge[2 * k + 1]]++] = edge[2 * k];
  for (int64_t v = 0; v < e->vertices; v++) of->vertex[next[v]++] = (int)v;
  for (int64_t k = 0; k < edges; k++) of->vertex[next[edge[2 * k]]++] = edge[2 * k + 1];
  for (int64_t v = 0; v < e->vertices; v++) {
    int sum = 0;
    for (int64_t k = of->start[v]; k < of->start[v + 1]; k++) {
      of->offset[k] = sum;
      sum += of->first[of->vertex[k] + 1] - of->first[of->vertex[k]];
    }
  }
}

static dvi_status find_neighbours(const dvi_elastic *e, neighbours *of)
{
  const int64_t entries = e->vertices + 2 * e->mesh->count[1];
  int64_t *next = DVI_NEW(int64_t, e->vertices);
  of->start = DVI_NEW(int64_t, e->vertices + 1);
  of->first = DVI_NEW(int, e->vertices + 1);
  of->vertex = DVI_NEW(int, entries);
  of->offset = DVI_NEW(int, entries);
  dvi_status status = DVI_OK;
  if (next && of->start && of->first && of->vertex && of->offset) {
    count(e, of);
    fill(e, next, of);
  } else {
    status = dvi__fail(DVI_NO_MEMORY, "elastic: no memory for the neighbours of %lld vertices",
                       (long long)e->vertices);
  }
  dvi__release(next);
  return status;
}

/* Return the place of a neighbour. */
static int64_t find(const neighbours *of, int vertex, int other)
{
  int64_t low = of->start[vertex], high = of->start[vertex + 1] - 1;
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (of->vertex[middle] < other)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* ---- patterns ---- */

static int64_t count_entries(const dvi_elastic *e, const neighbours *of)
{
  int64_t entries = 0;
  for (int64_t v = 0; v < e->vertices; v++) {
    const int64_t last = of->start[v + 1] - 1;
    const int width = of->offset[last] + of->first[of->vertex[last] + 1] -
                      of->first[of->vertex[last]];
    entries += (int64_t)width * (of->first[v + 1] - of->first[v]);
  }
  return entries;
}

static void fill_matrix(const dvi_elastic *e, const neighbours *of, dvi__csr *matrix)
{
  int64_t entries = 0;
  for (int64_t v = 0; v < e->vertices; v++)
    for (int row = of->first[v]; row < of->first[v + 1]; row++) {
      matrix->start[row] = entries;
      for (int64_t k = of->start[v]; k < of->start[v + 1]; k++)
        for (int c = of->first[of->vertex[k]]; c < of->first[of->vertex[k] + 1]; c++)
          matrix->column[entries++] = c;
    }
  matrix->start[matrix->rows] = entries;
}

static void find_places(const dvi_elastic *e, const neighbours *of, int *place)
{
  const int nodes = e->n + 1;
  for (int64_t c = 0; c < e->cells; c++)
    for (int a = 0; a < nodes; a++)
      for (int b = 0; b < nodes; b++) {
        const int *vertex = e->vertex + c * nodes;
        place[(c * nodes + a) * nodes + b] = of->offset[find(of, vertex[a], vertex[b])];
      }
}

dvi_status dvi__solid_pattern_create(const dvi_elastic *e, dvi__solid_pattern *pattern)
{
  neighbours of = {0};
  *pattern = (dvi__solid_pattern){.place = NULL};
  dvi_status status = find_neighbours(e, &of);
  if (status == DVI_OK)
    status = dvi__csr_allocate(e->unknowns, e->unknowns, count_entries(e, &of), &pattern->matrix);
  if (status == DVI_OK) {
    pattern->place = DVI_NEW(int, e->cells *(e->n + 1) * (e->n + 1));
    if (pattern->place == NULL)
      status = dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a matrix of %lld cells",
                         (long long)e->cells);
  }
  if (status == DVI_OK) {
    fill_matrix(e, &of, &pattern->matrix);
    find_places(e, &of, pattern->place);
  } else {
    dvi__solid_pattern_clear(pattern);
  }
  clear(&of);
  return status;
}

void dvi__solid_pattern_clear(dvi__solid_pattern *pattern)
{
  dvi__csr_clear(&pattern->matrix);
  dvi__release(pattern->place);
  pattern->place = NULL;
}

/* ---- sums over cells ---- */

void dvi__solid_add_matrix(const dvi_elastic *e, const dvi__solid_pattern *pattern, int64_t cell,
                           const double *K, double *value)
{
  const int n = e->n, nodes = n + 1, *vertex = e->vertex + cell * nodes;
  for (int a = 0; a < nodes; a++)
    for (int i = 0; i < n; i++) {
      const int row = e->unknown[(int64_t)vertex[a] * n + i];
      const double *of_row = K + (a * n + i) * nodes * n;
      for (int b = 0; b < nodes && row >= 0; b++) {
        const int *unknown = e->unknown + (int64_t)vertex[b] * n;
        int64_t entry = pattern->matrix.start[row] + pattern->place[(cell * nodes + a) * nodes + b];
        for (int j = 0; j < n; j++)
          if (unknown[j] >= 0) value[entry++] += of_row[b * n + j];
      }
    }
}

int dvi__solid_gather_unknowns(const dvi_elastic *e, int64_t cell, double t, const double *q,
                               double *u)
{
  const int n = e->n, *vertex = e->vertex + cell * (n + 1);
  if (e->unknowns == e->vertices * n) {
    dvi__solid_gather(e, cell, q, u);
    return 0;
  }
  for (int a = 0; a <= n; a++) {
    const int returned = dvi__solid_place(e, vertex[a], t, q, u + a * n, NULL);
    if (returned != 0) return -abs(returned);
  }
  return 0;
}

int dvi__solid_driven_rates(const dvi_elastic *e, int64_t cell, double t, double *rate)
{
  const int n = e->n, *vertex = e->vertex + cell * (n + 1);
  int found = 0;
  for (int a = 0; a <= n; a++) {
    double u[DVI_ELASTIC_DIMENSION_MAX], *own = rate + a * n;
    const int is_driven = dvi__solid_node_is_driven(e, vertex[a]);
    for (int i = 0; i < n; i++) own[i] = 0;
    const int returned = is_driven ? dvi__solid_given(e, vertex[a], t, u, own) : 0;
    if (returned != 0) return -abs(returned);
    found |= is_driven;
  }
  return found;
}

dvi_status dvi__solid_rest_pattern(const dvi_elastic *e, dvi__solid_pattern *pattern)
{
  DVI_TRY(dvi__solid_pattern_create(e, pattern));
  for (int64_t c = 0; c < e->cells; c++) {
    double own[DVI__SOLID_NUMBERS * DVI__SOLID_NUMBERS];
    (void)dvi__solid_stiffness(e, c, NULL, own);
    dvi__solid_add_matrix(e, pattern, c, own, pattern->matrix.value);
  }
  return DVI_OK;
}

dvi_status dvi__solid_rest_stiffness(const dvi_elastic *e, dvi__csr *K)
{
  dvi__solid_pattern pattern;
  DVI_TRY(dvi__solid_rest_pattern(e, &pattern));
  *K = pattern.matrix;
  pattern.matrix = (dvi__csr){0};
  dvi__solid_pattern_clear(&pattern);
  return DVI_OK;
}
