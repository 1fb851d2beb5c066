/* Cells of each degree are found as the facets of those one degree above. Each facet of each cell
 * is a tuple of vertices. The tuples are sorted by their smallest vertex, by counting, and then
 * among those with this vertex in common, which are few. Equal tuples are one cell. The cost grows
 * linearly with the number of cells. */
#include "field/mesh/complex.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* A facet of a cell with its vertices in ascending order. */
typedef struct tuple {
  int vertex[DVI__FACET_CORNERS];
  int at; /* its place: facets per cell times cell, plus slot */
} tuple;

/* The facets of the k-cells while they are sorted. */
typedef struct facets {
  dvi_mesh *mesh;
  int k, slots, width; /* facets of a cell, corners of a facet */
  int64_t total;
  int local[DVI__FACETS][DVI__FACET_CORNERS]; /* corners of the facets in the cell */
  int *order;                                 /* [total] places by smallest vertex */
  int *start;                                 /* [vertices+1] in `order` */
  tuple *bucket, *merged;                     /* [largest bucket] */
} facets;

static void sort_vertices(int count, int *vertex)
{
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && vertex[j - 1] > vertex[j]; j--) {
      const int other = vertex[j];
      vertex[j] = vertex[j - 1];
      vertex[j - 1] = other;
    }
}

static void vertices_of(const facets *f, int at, int *vertex)
{
  const int corners = dvi__corners(f->mesh->kind, f->k);
  const int *corner = f->mesh->corner[f->k] + (size_t)(at / f->slots) * (size_t)corners,
            *local = f->local[at % f->slots];
  for (int c = 0; c < f->width; c++) vertex[c] = corner[local[c]];
}

static int smallest(const facets *f, int at)
{
  int vertex[DVI__FACET_CORNERS] = {0};
  vertices_of(f, at, vertex);
  int least = vertex[0];
  for (int c = 1; c < f->width; c++)
    if (vertex[c] < least) least = vertex[c];
  return least;
}

/* Sort the facets by their smallest vertex. Returns the largest number with one such vertex. */
static int sort_by_counting(facets *f)
{
  const int64_t vertices = f->mesh->count[0];
  int largest = 0;
  for (int at = 0; at < f->total; at++) f->start[smallest(f, at) + 1]++;
  for (int64_t v = 0; v < vertices; v++) {
    if (f->start[v + 1] > largest) largest = f->start[v + 1];
    f->start[v + 1] += f->start[v];
  }
  for (int at = 0; at < f->total; at++) f->order[f->start[smallest(f, at)]++] = at;
  for (int64_t v = vertices; v > 0; v--) f->start[v] = f->start[v - 1];
  f->start[0] = 0;
  return largest;
}

static int compare(const facets *f, const tuple *a, const tuple *b)
{
  for (int c = 1; c < f->width; c++)
    if (a->vertex[c] != b->vertex[c]) return a->vertex[c] < b->vertex[c] ? -1 : 1;
  return 0;
}

static void merge(const facets *f, const tuple *a, int left, int right, tuple *out)
{
  int i = 0, j = 0;
  while (i < left || j < right)
    if (j == right || (i < left && compare(f, a + i, a + left + j) <= 0))
      out[i + j] = a[i], i++;
    else
      out[i + j] = a[left + j], j++;
}

/* Sort by insertion in runs, then merge the runs. Equal tuples stay in their order. */
static void sort_bucket(facets *f, int count)
{
  enum { RUN = 24 };
  tuple *a = f->bucket;
  for (int first = 0; first < count; first += RUN)
    for (int i = first + 1; i < count && i < first + RUN; i++) {
      const tuple moved = a[i];
      int j = i;
      for (; j > first && compare(f, a + j - 1, &moved) > 0; j--) a[j] = a[j - 1];
      a[j] = moved;
    }
  for (int run = RUN; run < count; run *= 2)
    for (int first = 0; first + run < count; first += 2 * run) {
      const int right = count - first - run < run ? count - first - run : run;
      merge(f, a + first, run, right, f->merged);
      memcpy(a + first, f->merged, (size_t)(run + right) * sizeof *a);
    }
}

static void fill_bucket(facets *f, const int *order, int count)
{
  for (int i = 0; i < count; i++) {
    vertices_of(f, order[i], f->bucket[i].vertex);
    sort_vertices(f->width, f->bucket[i].vertex);
    f->bucket[i].at = order[i];
  }
}

static dvi_status refuse_twisted(const facets *f, int at, int64_t facet)
{
  const dvi__cell_name cell = dvi__name_cell(f->mesh, f->k, at / f->slots),
                       face = dvi__name_cell(f->mesh, f->k - 1, facet);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "mesh: %s has the corners of %s of another box, but not its edges", cell.text,
                   face.text);
}

/* Note that the facet at this place is the cell `facet`, whose corners are known. */
static dvi_status note_facet(facets *f, int at, int64_t facet)
{
  dvi_mesh *mesh = f->mesh;
  int vertex[DVI__FACET_CORNERS] = {0};
  vertices_of(f, at, vertex);
  const int *known = mesh->corner[f->k - 1] + facet * f->width,
            relative = mesh->kind == DVI_SIMPLICES
                           ? 1
                           : dvi__relative_orientation(mesh->kind, f->k - 1, vertex, known);
  if (relative == 0) return refuse_twisted(f, at, facet);
  mesh->facet[f->k][at] = (int)facet;
  mesh->sign[f->k][at] = (int8_t)(relative * dvi__facet_sign(mesh->kind, at % f->slots));
  return DVI_OK;
}

static dvi_status number_bucket(facets *f, int count, int64_t *facet)
{
  for (int i = 0; i < count; i++) {
    const int is_new = i == 0 || compare(f, f->bucket + i - 1, f->bucket + i) != 0;
    if (is_new) {
      int *corner = f->mesh->corner[f->k - 1] + *facet * f->width;
      vertices_of(f, f->bucket[i].at, corner);
      ++*facet;
    }
    DVI_TRY(note_facet(f, f->bucket[i].at, *facet - 1));
  }
  return DVI_OK;
}

static dvi_status number_facets(facets *f)
{
  int64_t facet = 0;
  for (int64_t v = 0; v < f->mesh->count[0]; v++) {
    const int count = f->start[v + 1] - f->start[v];
    fill_bucket(f, f->order + f->start[v], count);
    sort_bucket(f, count);
    DVI_TRY(number_bucket(f, count, &facet));
  }
  f->mesh->count[f->k - 1] = facet;
  return DVI_OK;
}

static dvi_status no_memory(const dvi_mesh *mesh)
{
  return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for the faces of %lld cells",
                   (long long)mesh->count[mesh->n]);
}

/* Copy the corners of the facets that there are. */
static dvi_status trim_corners(dvi_mesh *mesh, int k, int width)
{
  int *whole = mesh->corner[k];
  mesh->corner[k] = dvi__duplicate(whole, (size_t)mesh->count[k] * (size_t)width, sizeof *whole);
  dvi__release(whole);
  return mesh->corner[k] != NULL ? DVI_OK : no_memory(mesh);
}

static dvi_status sort_facets(facets *f)
{
  f->order = DVI_NEW(int, f->total);
  f->start = DVI_NEW(int, f->mesh->count[0] + 1);
  f->mesh->corner[f->k - 1] = DVI_NEW(int, f->total * f->width);
  if (f->order == NULL || f->start == NULL || f->mesh->corner[f->k - 1] == NULL)
    return no_memory(f->mesh);
  const int largest = sort_by_counting(f);
  f->bucket = DVI_NEW(tuple, largest);
  f->merged = DVI_NEW(tuple, largest);
  if (f->bucket == NULL || f->merged == NULL) return no_memory(f->mesh);
  DVI_TRY(number_facets(f));
  return trim_corners(f->mesh, f->k - 1, f->width);
}

static dvi_status facets_create(dvi_mesh *mesh, int k, facets *f)
{
  *f = (facets){.mesh = mesh,
                .k = k,
                .slots = dvi__facets(mesh->kind, k),
                .width = dvi__corners(mesh->kind, k - 1)};
  f->total = mesh->count[k] * f->slots;
  if (f->total > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE,
                     "mesh: the %lld facets of %lld cells of dimension %d are too many",
                     (long long)f->total, (long long)mesh->count[k], k);
  for (int slot = 0; slot < f->slots; slot++)
    dvi__facet_corners(mesh->kind, k, slot, f->local[slot]);
  mesh->facet[k] = DVI_NEW(int, f->total);
  mesh->sign[k] = DVI_NEW(int8_t, f->total);
  return mesh->facet[k] != NULL && mesh->sign[k] != NULL ? DVI_OK : no_memory(mesh);
}

static void facets_clear(facets *f)
{
  dvi__release(f->order);
  dvi__release(f->start);
  dvi__release(f->bucket);
  dvi__release(f->merged);
}

/* The facets of edges are their vertices. */
static void take_vertices(const facets *f)
{
  for (int at = 0; at < f->total; at++) {
    vertices_of(f, at, &f->mesh->facet[1][at]);
    f->mesh->sign[1][at] = (int8_t)dvi__facet_sign(f->mesh->kind, at % f->slots);
  }
}

dvi_status dvi__complex_build(dvi_mesh *mesh)
{
  dvi_status status = DVI_OK;
  for (int k = mesh->n; k > 0 && status == DVI_OK; k--) {
    facets f;
    status = facets_create(mesh, k, &f);
    if (status == DVI_OK && k > 1) status = sort_facets(&f);
    if (status == DVI_OK && k == 1) take_vertices(&f);
    facets_clear(&f);
  }
  return status;
}

/* ---- search ---- */

/* Compare the vertices of a cell, sorted, with those that are looked for. */
static int compare_cell(const dvi_mesh *mesh, int k, int64_t cell, const int *sorted)
{
  int vertex[DVI__CORNERS];
  const int width = dvi__corners(mesh->kind, k);
  memcpy(vertex, mesh->corner[k] + cell * width, (size_t)width * sizeof *vertex);
  sort_vertices(width, vertex);
  for (int c = 0; c < width; c++)
    if (vertex[c] != sorted[c]) return vertex[c] < sorted[c] ? -1 : 1;
  return 0;
}

int64_t dvi__complex_find(const dvi_mesh *mesh, int k, const int *vertex)
{
  int sorted[DVI__CORNERS];
  const int width = dvi__corners(mesh->kind, k);
  memcpy(sorted, vertex, (size_t)width * sizeof *sorted);
  sort_vertices(width, sorted);
  if (k == 0) return sorted[0];
  int64_t low = 0, high = mesh->count[k];
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    const int order = compare_cell(mesh, k, middle, sorted);
    if (order == 0) return middle;
    if (order < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return -1;
}
