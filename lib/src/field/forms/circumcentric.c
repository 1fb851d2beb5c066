/* The circumcentric star.
 *
 * M_k(s) = kappa |*s|/|s|. The dual cell *s consists of a piece in each n-cell T that has the face
 * s, and the piece of flags s = s_k < s_{k+1} < .. < s_n = T:
 *
 *     |*s and T| = sum over flags of  prod_j  lambda_j sqrt|a_j^2| / (n-k)!
 *
 * A step of a flag goes from a face to its facet, where a_j is the altitude of the corner that the
 * facet leaves out, and lambda_j the barycentric coordinate there of the face's circumcentre, so
 * that lambda_j a_j is the distance of the face's circumcentre from that of the facet, with a sign.
 * For a box it is half of the edge across. Summed with these signs, the pieces satisfy
 *
 *     sum over k-cells of |s| |*s| = C(n,k) |K|
 *
 * on any mesh. Dual cells are cut off at the boundary. Source: Hirani 2003, ch. 2, with signs;
 * Desbrun, Hirani, Leok and Marsden 2005, sec. 4. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/duals.h"
#include "field/forms/star.h"

/* The sums while the cells are taken one after the other. */
typedef struct sums {
  dvi_star *star;
  int n;
  double *volume[DVI__DEGREES]; /* [k-cells] kappa |s| */
} sums;

/* Add the piece of a dual cell in an n-cell. */
static void add_piece(const sums *a, int k, int64_t face, int64_t cell, double piece)
{
  dvi_star *star = a->star;
  star->dual[k][face] += piece;
  star->diagonal[k][face] += star->factor[k] != NULL ? star->factor[k][cell] * piece : piece;
}

/* ---- simplices ---- */

static dvi_status add_simplex(const sums *a, int64_t cell)
{
  dvi__placed placed;
  dvi__duals duals;
  int64_t number[DVI__CORNER_SETS];
  int corner[DVI__SIMPLEX_CORNERS];
  const dvi_mesh *mesh = a->star->mesh;
  dvi__place_cell(mesh, mesh->n, cell, &placed);
  dvi__number_faces(mesh, cell, number);
  const int null = dvi__duals_of(&placed, mesh->n, 0, &duals);
  if (null != 0) return dvi__refuse_null(mesh, dvi__corners_of_set(null, corner) - 1, number[null]);
  for (int set = (1 << (mesh->n + 1)) - 1; set > 0; set--) {
    const int k = dvi__corners_of_set(set, corner) - 1;
    add_piece(a, k, number[set], cell, duals.piece[set]);
    a->volume[k][number[set]] = duals.volume[set];
  }
  return DVI_OK;
}

/* ---- boxes ---- */

/* The k-faces of one box. */
typedef struct level {
  int count;
  int64_t number[32]; /* the 32 edges of a 4-box are the most */
  double weight[32];
} level;

static void add_flag(level *l, int64_t number, double weight)
{
  int i = 0;
  while (i < l->count && l->number[i] != number) i++;
  if (i == l->count) {
    l->number[l->count] = number;
    l->weight[l->count++] = 0;
  }
  l->weight[i] += weight;
}

/* Step from a face to its facets at both ends of each axis. */
static dvi_status step_down_box(const sums *a, int k, int64_t number, double weight, level *below)
{
  dvi__placed placed;
  const dvi_mesh *mesh = a->star->mesh;
  double square[DVI_MESH_DIMENSION_MAX], volume = 1;
  dvi__place_cell(mesh, k, number, &placed);
  dvi__box_squares(&placed, k, square);
  for (int axis = 0; axis < k; axis++) {
    if (square[axis] == 0) return dvi__refuse_null(mesh, k, number);
    const double length = sqrt(fabs(square[axis]));
    volume *= copysign(length, square[axis]);
    for (int end = 0; end < 2; end++)
      add_flag(below, mesh->facet[k][number * 2 * k + 2 * axis + end], 0.5 * weight * length);
  }
  a->volume[k][number] = volume;
  return DVI_OK;
}

static dvi_status add_box(const sums *a, int64_t cell)
{
  level levels[2] = {{.count = 1, .number = {cell}, .weight = {1}}};
  const int n = a->star->mesh->n;
  for (int k = n; k >= 0; k--) {
    const level *here = levels + (n - k) % 2;
    level *below = levels + (n - k + 1) % 2;
    below->count = 0;
    for (int i = 0; i < here->count; i++) {
      add_piece(a, k, here->number[i], cell, here->weight[i] * dvi__inverse_factorial[n - k]);
      if (k > 0) DVI_TRY(step_down_box(a, k, here->number[i], here->weight[i], below));
    }
  }
  return DVI_OK;
}

/* ---- all ---- */

static dvi_status allocate(sums *a)
{
  const dvi_mesh *mesh = a->star->mesh;
  int complete = 1;
  for (int k = 0; k <= a->n; k++) {
    a->star->dual[k] = DVI_NEW(double, mesh->count[k]);
    a->star->diagonal[k] = DVI_NEW(double, mesh->count[k]);
    a->volume[k] = DVI_NEW(double, mesh->count[k]);
    complete = complete && a->star->dual[k] && a->star->diagonal[k] && a->volume[k];
  }
  return complete ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "star: no memory for dual cells");
}

static dvi_status add_cells(const sums *a)
{
  const dvi_mesh *mesh = a->star->mesh;
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++)
    DVI_TRY(mesh->kind == DVI_BOXES ? add_box(a, c) : add_simplex(a, c));
  return DVI_OK;
}

/* A vertex has the volume 1. */
static void divide_by_volumes(const sums *a)
{
  const dvi_mesh *mesh = a->star->mesh;
  for (int k = 1; k <= a->n; k++)
    for (int64_t s = 0; s < mesh->count[k]; s++) a->star->diagonal[k][s] /= a->volume[k][s];
}

dvi_status dvi__circumcentric_star(dvi_star *star)
{
  sums a = {.star = star, .n = star->mesh->n};
  dvi_status status = allocate(&a);
  if (status == DVI_OK) status = add_cells(&a);
  if (status == DVI_OK) divide_by_volumes(&a);
  for (int k = 0; k <= a.n; k++) dvi__release(a.volume[k]);
  return status;
}
