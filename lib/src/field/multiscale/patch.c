/* Local problems div (a grad u) = 0 on a rectangle of fine cells.
 *
 * Space: bilinear elements. Quadrature: exact, with a constant in each fine cell. The solution is
 * the stationary point of L = -1/2 sum over cells of a int |grad u|^2 among all values of the
 * unknown nodes. Source: Hou and Wu 1997, sec. 2; Leok 2004, sec. 5.7.1. */
#include "field/multiscale/patch.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { CORNERS = 4, NEIGHBOURS = 9 };

/* Set node [4] to the corners of a cell: those of its lower, then of its upper x, y in turn. */
static void corners(const dvi__patch *patch, int cell, int *node)
{
  const int i = cell / patch->ny, j = cell % patch->ny;
  for (int c = 0; c < CORNERS; c++) node[c] = (i + c / 2) * (patch->ny + 1) + j + c % 2;
}

static void number_nodes(dvi__patch *patch, dvi__patch_kind kind)
{
  const int nx = patch->nx, ny = patch->ny;
  int *number = patch->number;
  for (int i = 0; i <= nx; i++)
    for (int j = 0; j <= ny; j++) {
      int is_fixed = i == 0 || j == 0 || i == nx || j == ny;
      if (kind == DVI__PATCH_PERIODIC) is_fixed = i == nx || j == ny || (i == 0 && j == 0);
      number[i * (ny + 1) + j] = is_fixed ? -1 : patch->unknowns++;
    }
  if (kind != DVI__PATCH_PERIODIC) return;
  for (int i = 0; i <= nx; i++) number[i * (ny + 1) + ny] = number[i * (ny + 1)];
  for (int j = 0; j <= ny; j++) number[nx * (ny + 1) + j] = number[j];
}

/* ---- pattern ---- */

/* Put an unknown into the ascending list of one's neighbours. */
static void insert(int *list, int *count, int unknown)
{
  int at = 0;
  while (at < *count && list[at] < unknown) at++;
  if (at < *count && list[at] == unknown) return;
  memmove(list + at + 1, list + at, (size_t)(*count - at) * sizeof *list);
  list[at] = unknown;
  ++*count;
}

static void list_neighbours(const dvi__patch *patch, int *list, int *count)
{
  for (int cell = 0; cell < patch->nx * patch->ny; cell++) {
    int node[CORNERS];
    corners(patch, cell, node);
    for (int k = 0; k < CORNERS * CORNERS; k++) {
      const int a = patch->number[node[k / CORNERS]], b = patch->number[node[k % CORNERS]];
      if (a >= 0 && b >= 0) insert(list + (ptrdiff_t)a * NEIGHBOURS, count + a, b);
    }
  }
}

static dvi_status make_pattern(dvi__patch *patch)
{
  const int n = patch->unknowns;
  dvi__pattern *pattern = &patch->pattern;
  int *list = DVI_NEW(int, (size_t)n *NEIGHBOURS), *count = DVI_NEW(int, n);
  *pattern = (dvi__pattern){n, n, DVI_NEW(int, n + 1), DVI_NEW(int, (size_t)n *NEIGHBOURS)};
  const int has_memory = list && count && pattern->start && pattern->row;
  if (has_memory) {
    list_neighbours(patch, list, count);
    for (int a = 0; a < n; a++) {
      pattern->start[a + 1] = pattern->start[a] + count[a];
      memcpy(pattern->row + pattern->start[a], list + (ptrdiff_t)a * NEIGHBOURS,
             (size_t)count[a] * sizeof *list);
    }
  }
  dvi__release(list);
  dvi__release(count);
  return has_memory ? DVI_OK : DVI_NO_MEMORY;
}

/* ---- creation ---- */

static dvi_status allocate(dvi__patch *patch, dvi__patch_kind kind)
{
  const size_t cells = (size_t)patch->nx * (size_t)patch->ny;
  patch->number = DVI_NEW(int, ((size_t)patch->nx + 1) * ((size_t)patch->ny + 1));
  patch->matrix = DVI_NEW(double, cells *CORNERS *CORNERS);
  if (!patch->number || !patch->matrix) return DVI_NO_MEMORY;
  number_nodes(patch, kind);
  if (patch->unknowns == 0) return DVI_OK;
  DVI_TRY(make_pattern(patch));
  patch->value = DVI_NEW(double, dvi__pattern_entries(&patch->pattern));
  patch->right = DVI_NEW(double, patch->unknowns);
  if (!patch->value || !patch->right) return DVI_NO_MEMORY;
  return dvi__linear_create(&patch->pattern, DVI__LINEAR_DEFINITE, NULL, &patch->factor);
}

dvi_status dvi__patch_create(int nx, int ny, dvi__patch_kind kind, dvi__patch *patch)
{
  *patch = (dvi__patch){.nx = nx, .ny = ny};
  const dvi_status status = allocate(patch, kind);
  if (status == DVI_OK) return DVI_OK;
  dvi__patch_clear(patch);
  return dvi__fail(status, "msfem: no memory for %d x %d fine cells", nx, ny);
}

void dvi__patch_clear(dvi__patch *patch)
{
  dvi__linear_destroy(&patch->factor);
  dvi__pattern_clear(&patch->pattern);
  dvi__release(patch->number);
  dvi__release(patch->matrix);
  dvi__release(patch->value);
  dvi__release(patch->right);
  *patch = (dvi__patch){0};
}

/* ---- solution ---- */

/* Set K [16] to a int grad phi_k . grad phi_l on a rectangle, by products of those of two axes. */
static void set_cell_matrix(double a, double hx, double hy, double *K)
{
  for (int k = 0; k < CORNERS; k++)
    for (int l = 0; l < CORNERS; l++) {
      const int same_x = k / 2 == l / 2, same_y = k % 2 == l % 2;
      K[k * CORNERS + l] = a * (hy / hx * (same_x ? 1 : -1) * (same_y ? 1. / 3 : 1. / 6) +
                                hx / hy * (same_y ? 1 : -1) * (same_x ? 1. / 3 : 1. / 6));
    }
}

static void add_cell_matrix(dvi__patch *patch, int cell)
{
  const double *K = patch->matrix + (ptrdiff_t)cell * CORNERS * CORNERS;
  int node[CORNERS];
  corners(patch, cell, node);
  for (int k = 0; k < CORNERS * CORNERS; k++) {
    const int a = patch->number[node[k / CORNERS]], b = patch->number[node[k % CORNERS]];
    if (a >= 0 && b >= 0) patch->value[dvi__pattern_find(&patch->pattern, a, b)] += K[k];
  }
}

dvi_status dvi__patch_factor(dvi__patch *patch, const double *hx, const double *hy,
                             const double *coefficient)
{
  const int cells = patch->nx * patch->ny;
  for (int cell = 0; cell < cells; cell++)
    set_cell_matrix(coefficient[cell], hx[cell / patch->ny], hy[cell % patch->ny],
                    patch->matrix + (ptrdiff_t)cell * CORNERS * CORNERS);
  if (patch->factor == NULL) return DVI_OK;
  memset(patch->value, 0, (size_t)dvi__pattern_entries(&patch->pattern) * sizeof *patch->value);
  for (int cell = 0; cell < cells; cell++) add_cell_matrix(patch, cell);
  return dvi__linear_factor(patch->factor, patch->value);
}

dvi_status dvi__patch_solve(dvi__patch *patch, double *u)
{
  if (patch->factor == NULL) return DVI_OK;
  memset(patch->right, 0, (size_t)patch->unknowns * sizeof *patch->right);
  for (int cell = 0; cell < patch->nx * patch->ny; cell++) {
    const double *K = patch->matrix + (ptrdiff_t)cell * CORNERS * CORNERS;
    int node[CORNERS];
    corners(patch, cell, node);
    for (int k = 0; k < CORNERS * CORNERS; k++) {
      const int a = patch->number[node[k / CORNERS]];
      if (a >= 0) patch->right[a] -= K[k] * u[node[k % CORNERS]];
    }
  }
  DVI_TRY(dvi__linear_solve(patch->factor, patch->right));
  for (int node = 0; node < (patch->nx + 1) * (patch->ny + 1); node++)
    if (patch->number[node] >= 0) u[node] += patch->right[patch->number[node]];
  return DVI_OK;
}

double dvi__patch_product(const dvi__patch *patch, const double *u, const double *v)
{
  long double sum = 0;
  for (int cell = 0; cell < patch->nx * patch->ny; cell++) {
    const double *K = patch->matrix + (ptrdiff_t)cell * CORNERS * CORNERS;
    int node[CORNERS];
    corners(patch, cell, node);
    for (int k = 0; k < CORNERS * CORNERS; k++)
      sum += (long double)K[k] * u[node[k / CORNERS]] * v[node[k % CORNERS]];
  }
  return (double)sum;
}
