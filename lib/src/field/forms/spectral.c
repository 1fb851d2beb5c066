/* The spectral star of a uniform grid of boxes that repeats itself along all axes.
 *
 * Along an axis of N cells of length h a wave exp(i k x), k = 2 pi j/(N h), has the integrals
 * h sinc(j/N) exp(i k x) over cells with their centres at x, sinc s = sin(pi s)/(pi s). So the star
 * of the axis multiplies the wave by h sinc(j/N) where a form has values at points, and by its
 * inverse where it has integrals, |j| <= N/2:
 *
 *     C_m = 1/N sum_j  h sinc(j/N) cos(2 pi j m/N),      the matrix C_{a-b} of points a, b.
 *
 * With the incidence d the eigenvalues of d^T M_1 d against M_0 are k^2 without an error. The star
 * of several axes is the product of theirs. Source: Rufat, Mason, Mullen and Desbrun 2014. */
#include <math.h>
#include <stdint.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

enum { AXES = DVI_MESH_DIMENSION_MAX, MOST_ENTRIES = 1 << 27 };

static const double pi = 3.14159265358979323846, uniform = 1e-9;

/* A grid, and the place of each k-cell in it. */
typedef struct grid {
  const dvi_mesh *mesh;
  int k, count[AXES];
  double h[AXES];
  int *at;                    /* [cells*n] place of the near corner */
  unsigned char *axes;        /* [cells] bit a: the cell extends along axis a */
  double *circulant[2][AXES]; /* [count] of points, and of cells */
} grid;

static dvi_status refuse_mesh(const char *what)
{
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "star: the spectral star needs equal boxes that fill a space which repeats "
                   "itself along all axes, and %s",
                   what);
}

/* ---- the grid ---- */

/* The boxes have one size, which divides the periods. */
static dvi_status measure_boxes(grid *g)
{
  const dvi_mesh *mesh = g->mesh;
  const int n = mesh->n;
  double points = 1, edge[AXES * DVI_MESH_SPACE_MAX];
  if (mesh->kind != DVI_BOXES) return refuse_mesh("the cells are simplices");
  if (mesh->space != n) return refuse_mesh("the space has more dimensions than the cells");
  dvi__cell_edges(mesh, n, 0, edge);
  for (int a = 0; a < n; a++) {
    if (!(mesh->period[a] > 0) || mesh->metric[a] < 0)
      return refuse_mesh("an axis does not repeat itself, or is timelike");
    g->h[a] = edge[a * n + a];
    g->count[a] = (int)lround(mesh->period[a] / fabs(g->h[a]));
    points *= g->count[a];
  }
  if (points != (double)mesh->count[0]) return refuse_mesh("the boxes do not fill it");
  return DVI_OK;
}

/* Find the axes of a cell, whose edges point along ascending axes. */
static dvi_status place_cell(grid *g, int64_t cell)
{
  const dvi_mesh *mesh = g->mesh;
  const int n = mesh->n;
  const int64_t first = g->k > 0 ? mesh->corner[g->k][cell << g->k] : cell;
  double edge[AXES * DVI_MESH_SPACE_MAX];
  int from = 0;
  if (g->k > 0) dvi__cell_edges(mesh, g->k, cell, edge);
  for (int i = 0; i < g->k; i++) {
    int a = from;
    while (a < n && !(fabs(edge[i * n + a] - g->h[a]) <= uniform * g->h[a])) a++;
    if (a == n) return refuse_mesh("a box has another size or other axes");
    g->axes[cell] |= (unsigned char)(1 << a);
    from = a + 1;
  }
  for (int a = 0; a < n; a++) {
    const double place = (mesh->point[first * n + a] - mesh->point[a]) / g->h[a];
    const int at = (int)lround(place) % g->count[a];
    if (!(fabs(place - round(place)) <= 1e-6)) return refuse_mesh("a point is off the grid");
    g->at[cell * n + a] = at < 0 ? at + g->count[a] : at;
  }
  return DVI_OK;
}

/* The symbol is even in j, so that the sum is over cosines, and in m. The second half is a copy
 * of the first, which makes the matrix symmetric to the bit. */
static void fill_circulant(int count, double h, int of_cells, double *circulant)
{
  for (int m = 0; 2 * m <= count; m++) {
    double sum = 0;
    for (int j = -((count - 1) / 2); j <= count / 2; j++) {
      const double s = pi * j / count, symbol = h * (j == 0 ? 1 : sin(s) / s);
      const int64_t turns = (int64_t)j * m % count;
      sum += (of_cells ? 1 / symbol : symbol) * cos(2 * pi * (double)turns / count);
    }
    circulant[m] = circulant[(count - m) % count] = sum / count;
  }
}

static dvi_status place_cells(grid *g)
{
  const int64_t cells = g->mesh->count[g->k];
  g->at = DVI_NEW(int, cells * g->mesh->n);
  g->axes = DVI_NEW(unsigned char, cells);
  if (g->at == NULL || g->axes == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory");
  for (int64_t c = 0; c < cells; c++) DVI_TRY(place_cell(g, c));
  return DVI_OK;
}

static dvi_status lay_out(grid *g)
{
  const int n = g->mesh->n;
  DVI_TRY(place_cells(g));
  for (int a = 0; a < n; a++)
    for (int of_cells = 0; of_cells < 2; of_cells++) {
      double *circulant = g->circulant[of_cells][a] = DVI_NEW(double, g->count[a]);
      if (circulant == NULL) return dvi__fail(DVI_NO_MEMORY, "star: no memory");
      fill_circulant(g->count[a], g->h[a], of_cells, circulant);
    }
  return DVI_OK;
}

/* ---- the matrix ---- */

static double entry_of(const grid *g, int64_t i, int64_t j)
{
  const int n = g->mesh->n;
  double entry = 1;
  for (int a = 0; a < n; a++) {
    const int apart = g->at[i * n + a] - g->at[j * n + a];
    entry *= g->circulant[g->axes[i] >> a & 1][a][apart < 0 ? apart + g->count[a] : apart];
  }
  return entry;
}

/* Cells along the same axes have all entries, others none. */
static void fill(const grid *g, dvi__csr *matrix)
{
  int64_t at = 0;
  for (int64_t i = 0; i < matrix->rows; i++) {
    for (int64_t j = 0; j < matrix->columns; j++) {
      if (g->axes[j] != g->axes[i]) continue;
      matrix->column[at] = (int)j;
      matrix->value[at++] = entry_of(g, i, j);
    }
    matrix->start[i + 1] = at;
  }
}

static dvi_status make(grid *g, dvi__csr *matrix)
{
  const int64_t cells = g->mesh->count[g->k], points = g->mesh->count[0];
  DVI_TRY(measure_boxes(g));
  if (cells > MOST_ENTRIES / points)
    return dvi__fail(DVI_BAD_SIZE,
                     "star: the spectral star has %.3g entries in degree %d, and may have %d: take "
                     "fewer boxes, or the circumcentric star",
                     (double)cells * (double)points, g->k, (int)MOST_ENTRIES);
  DVI_TRY(lay_out(g));
  DVI_TRY(dvi__csr_allocate(cells, cells, cells * points, matrix));
  fill(g, matrix);
  return DVI_OK;
}

dvi_status dvi__spectral_check(const dvi_mesh *mesh)
{
  grid g = {.mesh = mesh, .k = mesh->n};
  DVI_TRY(dvi__refuse_share(mesh, "star: the spectral star"));
  dvi_status status = measure_boxes(&g);
  if (status == DVI_OK) status = place_cells(&g);
  dvi__release(g.at);
  dvi__release(g.axes);
  return status;
}

dvi_status dvi__spectral_star(dvi_star *star, int k)
{
  grid g = {.mesh = star->mesh, .k = k};
  const dvi_status status = make(&g, &star->matrix[k]);
  for (int a = 0; a < AXES; a++)
    for (int of_cells = 0; of_cells < 2; of_cells++) dvi__release(g.circulant[of_cells][a]);
  dvi__release(g.at);
  dvi__release(g.axes);
  return status;
}
