/* How steep a front may be. A tent takes its field from the front below, so that the front must not
 * be steeper than light anywhere. Tents know the slopes of edges only. If all edges of a cell have
 * slopes of at most 1, the slope of the cell is at most
 *
 *     max |sum_i t_i grad lambda_i|   over all times t_i with |t_i - t_j| <= |x_i - x_j|,
 *
 * which is 1 on a line, and on a triangle 1/cos(theta/2) with its largest angle theta. The maximum
 * is at times for which the edges with the slope 1 connect all corners. With edges that are less
 * steep by this factor, a front is causal whatever the order of tents, and its lowest vertex can
 * always rise. Source: Erickson, Guoy, Sullivan and Ungor 2005, for the condition of causality. */
#include <math.h>

#include "field/mesh/volume.h"
#include "field/tents/front.h"

/* Edges may be too long by this part, because they were rounded. */
static const double rounding = 1e-12;

typedef struct search {
  int n, space;
  double length[DVI__SIMPLEX_CORNERS][DVI__SIMPLEX_CORNERS];
  dvi__twofold gradient[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX];
  double t[DVI__SIMPLEX_CORNERS];
  double most;
} search;

static double slope_of(const search *s)
{
  double square = 0;
  for (int l = 0; l < s->space; l++) {
    double component = 0;
    for (int i = 0; i <= s->n; i++) component += s->t[i] * s->gradient[i][l].head;
    square += component * component;
  }
  return sqrt(square);
}

static int is_allowed(const search *s, int known, int corner)
{
  for (int i = 0; i <= s->n; i++)
    if (known >> i & 1 && fabs(s->t[i] - s->t[corner]) > (1 + rounding) * s->length[i][corner])
      return 0;
  return 1;
}

/* Give one more corner a time by an edge with the slope 1 to one of those in `known`. */
static void try_corners(search *s, int known)
{
  if (known == (1 << (s->n + 1)) - 1) s->most = fmax(s->most, slope_of(s));
  for (int corner = 1; corner <= s->n; corner++)
    for (int choice = 0; choice < 2 * (s->n + 1); choice++) {
      const int from = choice / 2;
      if (known >> corner & 1 || !(known >> from & 1)) continue;
      s->t[corner] = s->t[from] + (choice % 2 ? -1 : 1) * s->length[from][corner];
      if (is_allowed(s, known, corner)) try_corners(s, known | 1 << corner);
    }
}

double dvi__steepest(const dvi_mesh *mesh, int64_t cell)
{
  dvi__placed placed;
  double volume;
  search s = {.n = mesh->n, .space = mesh->space};
  dvi__place_cell(mesh, mesh->n, cell, &placed);
  (void)dvi__covectors_of(&placed, mesh->n, s.gradient, &volume);
  for (int i = 0; i <= s.n; i++)
    for (int j = 0; j <= s.n; j++) {
      double edge[DVI_MESH_SPACE_MAX], square = 0;
      dvi__placed_edge(&placed, i, j, edge);
      for (int l = 0; l < s.space; l++) square += edge[l] * edge[l];
      s.length[i][j] = sqrt(square);
    }
  try_corners(&s, 1);
  return s.most;
}
