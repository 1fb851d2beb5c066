#include "field/mesh/placed.h"

#include <float.h>
#include <math.h>

#include "field/mesh/volume.h"
#include "num/simd/fused.h"

typedef dvi__twofold square_matrix[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX];

/* A simplex in a metric with signs is null if moves of this part of its edges can make it so. */
static const double null_part = 64 * DBL_EPSILON;

const double dvi__euclidean[DVI_MESH_SPACE_MAX] = {1, 1, 1, 1, 1, 1, 1, 1};

/* ---- corners ---- */

void dvi__place_cell(const dvi_mesh *mesh, int k, int64_t cell, dvi__placed *placed)
{
  const int corners = dvi__corners(mesh->kind, k), *corner = mesh->corner[k] + cell * corners;
  placed->corners = corners;
  placed->space = mesh->space;
  placed->metric = mesh->metric;
  for (int c = 0; c < corners; c++)
    dvi__mesh_exact_difference(mesh, corner[0], corner[c], placed->x[c], placed->tail[c]);
}

static dvi__twofold difference(const dvi__placed *p, int a, int b, int axis)
{
  const dvi__twofold from = {-p->x[a][axis], -p->tail[a][axis]},
                     to = {p->x[b][axis], p->tail[b][axis]};
  return dvi__twofold_sum(to, from);
}

void dvi__placed_edge(const dvi__placed *placed, int a, int b, double *edge)
{
  for (int l = 0; l < placed->space; l++) {
    const dvi__twofold component = difference(placed, a, b, l);
    edge[l] = component.head + component.tail;
  }
}

/* ---- edges ---- */

/* Give the slot of the corner from which the product of the edges is smallest. Their inner products
 * are then those of the best condition. */
static int find_origin(const dvi__placed *p, int k, const int *corner)
{
  int best = 0;
  double least = INFINITY;
  for (int o = 0; o <= k; o++) {
    double product = 1;
    for (int i = 0; i <= k; i++) {
      double square = 0;
      for (int l = 0; l < p->space; l++) {
        const double component = p->x[corner[i]][l] - p->x[corner[o]][l];
        square += component * component;
      }
      if (i != o) product *= sqrt(square);
    }
    if (product >= least) continue;
    least = product;
    best = o;
  }
  return best;
}

static void set_edge(const dvi__placed *p, int origin, int end, int i, dvi__gram *g)
{
  double most = 0;
  int exponent;
  for (int l = 0; l < p->space; l++) {
    const dvi__twofold component = difference(p, origin, end, l);
    g->edge[i][l] = dvi__exact_sum(component.head, component.tail);
    most = fmax(most, fabs(g->edge[i][l].head));
  }
  (void)frexp(most, &exponent);
  g->scale[i] = ldexp(1, exponent);
  for (int l = 0; l < p->space; l++)
    g->edge[i][l] = dvi__twofold_scaled(g->edge[i][l], 1 / g->scale[i]);
}

static void set_edges(const dvi__placed *p, int k, const int *corner, dvi__gram *g)
{
  const int origin = find_origin(p, k, corner);
  g->k = k;
  g->space = p->space;
  g->metric = p->metric;
  for (int i = 0; i <= k; i++) g->slot[i] = i;
  g->slot[0] = origin;
  g->slot[origin] = 0;
  for (int i = 0; i < k; i++) set_edge(p, corner[origin], corner[g->slot[i + 1]], i, g);
}

/* ---- inner products ---- */

FUSED_INLINE dvi__twofold product(const dvi__gram *g, int i, int j)
{
  dvi__twofold sum = {0, 0};
  for (int l = 0; l < g->space; l++)
    sum = dvi__twofold_add_product(sum, dvi__twofold_scaled(g->edge[i][l], g->metric[l]),
                                   g->edge[j][l]);
  return sum;
}

static void swap_rows(int k, square_matrix a, int i, int j)
{
  for (int l = 0; l < k; l++) {
    const dvi__twofold other = a[i][l];
    a[i][l] = a[j][l];
    a[j][l] = other;
  }
}

static void swap_columns(int k, square_matrix a, int i, int j)
{
  for (int l = 0; l < k; l++) {
    const dvi__twofold other = a[l][i];
    a[l][i] = a[l][j];
    a[l][j] = other;
  }
}

/* Eliminate with pivot j, and put the column of the inverse in its place (Gauss and Jordan). */
FUSED_INLINE void eliminate(int k, square_matrix a, int j)
{
  const dvi__twofold scale = dvi__twofold_inverse(a[j][j]);
  a[j][j] = (dvi__twofold){1, 0};
  for (int l = 0; l < k; l++) a[j][l] = dvi__twofold_times(a[j][l], scale);
  for (int i = 0; i < k; i++) {
    const dvi__twofold factor = a[i][j];
    if (i == j) continue;
    a[i][j] = (dvi__twofold){0, 0};
    for (int l = 0; l < k; l++) a[i][l] = dvi__twofold_less_product(a[i][l], factor, a[j][l]);
  }
}

/* Replace a matrix by its inverse. Pivots come from the whole column, because a metric with signs
 * may have zeros on the diagonal. Returns the determinant, and 0 if there is no inverse. */
FUSED_INLINE double invert(int k, square_matrix a)
{
  int pivot[DVI_MESH_DIMENSION_MAX] = {0};
  double determinant = 1;
  for (int j = 0; j < k; j++) {
    pivot[j] = j;
    for (int i = j + 1; i < k; i++)
      if (fabs(a[i][j].head) > fabs(a[pivot[j]][j].head)) pivot[j] = i;
    if (a[pivot[j]][j].head == 0) return 0;
    swap_rows(k, a, j, pivot[j]);
    determinant *= pivot[j] == j ? a[j][j].head : -a[j][j].head;
    eliminate(k, a, j);
  }
  for (int j = k - 1; j >= 0; j--) swap_columns(k, a, j, pivot[j]);
  return determinant;
}

FUSED static void invert_products(dvi__gram *g)
{
  for (int i = 0; i < g->k; i++) {
    for (int j = 0; j <= i; j++) g->inverse[i][j] = g->inverse[j][i] = product(g, i, j);
    g->square[i] = g->inverse[i][i];
  }
  g->determinant = invert(g->k, g->inverse);
}

/* The sum of |d lambda_i| |u_i|, lengths as in Euclidean space, by which a relative change of the
 * edges changes the determinant, but for a factor 2. */
static double sensitivity(const dvi__gram *g)
{
  double sum = 0;
  for (int i = 0; i < g->k; i++) {
    double covector = 0, edge = 0;
    for (int l = 0; l < g->space; l++) {
      double component = 0;
      for (int j = 0; j < g->k; j++) component += g->inverse[i][j].head * g->edge[j][l].head;
      covector += component * component;
      edge += g->edge[i][l].head * g->edge[i][l].head;
    }
    sum += sqrt(covector * edge);
  }
  return sum;
}

static int has_signs(const dvi__gram *g)
{
  for (int l = 0; l < g->space; l++)
    if (g->metric[l] < 0) return 1;
  return 0;
}

int dvi__gram_of(const dvi__placed *placed, int k, const int *corner, dvi__gram *gram)
{
  set_edges(placed, k, corner, gram);
  invert_products(gram);
  if (!has_signs(gram)) return gram->determinant > 0;
  if (gram->determinant == 0 || !(null_part * sensitivity(gram) < 1)) return 0;
  return gram->determinant > 0 ? 1 : -1;
}

double dvi__gram_volume(const dvi__gram *gram)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  double volume = sqrt(fabs(gram->determinant)) / factorial[gram->k];
  for (int i = 0; i < gram->k; i++) volume *= gram->scale[i];
  return volume;
}

/* ---- covectors ---- */

/* Set d lambda_i = sum_j (G^-1)_ij metric u_j. */
FUSED_INLINE void raise_edges(const dvi__gram *g, dvi__twofold d[][DVI_MESH_SPACE_MAX])
{
  for (int i = 0; i < g->k; i++)
    for (int l = 0; l < g->space; l++) {
      dvi__twofold sum = {0, 0};
      for (int j = 0; j < g->k; j++)
        sum = dvi__twofold_add_product(sum, g->inverse[i][j], g->edge[j][l]);
      d[i][l] = dvi__twofold_scaled(sum, g->metric[l]);
    }
}

/* What d lambda_i(u_j) lacks of 1 for i = j, and of 0. */
FUSED_INLINE dvi__twofold defect(const dvi__gram *g, const dvi__twofold *covector, int i, int j)
{
  dvi__twofold rest = {i == j, 0};
  for (int l = 0; l < g->space; l++)
    rest = dvi__twofold_less_product(rest, covector[l], g->edge[j][l]);
  return rest;
}

/* Newton's step makes up for what the inner products have lost. */
FUSED static void find_covectors(const dvi__gram *g, dvi__twofold d[][DVI_MESH_SPACE_MAX])
{
  square_matrix rest;
  dvi__twofold first[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
  raise_edges(g, first);
  for (int i = 0; i < g->k; i++)
    for (int j = 0; j < g->k; j++) rest[i][j] = defect(g, first[i], i, j);
  for (int i = 0; i < g->k; i++)
    for (int l = 0; l < g->space; l++) {
      d[i][l] = first[i][l];
      for (int j = 0; j < g->k; j++)
        d[i][l] = dvi__twofold_add_product(d[i][l], rest[i][j], first[j][l]);
    }
}

void dvi__gram_covectors(const dvi__gram *gram,
                         dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX])
{
  dvi__twofold d[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
  find_covectors(gram, d);
  for (int l = 0; l < gram->space; l++) {
    dvi__twofold all = {0, 0};
    for (int i = 0; i < gram->k; i++) {
      const dvi__twofold component = dvi__twofold_scaled(d[i][l], 1 / gram->scale[i]);
      covector[gram->slot[i + 1]][l] = component;
      all = dvi__twofold_plus(all, component);
    }
    covector[gram->slot[0]][l] = dvi__twofold_scaled(all, -1);
  }
}
