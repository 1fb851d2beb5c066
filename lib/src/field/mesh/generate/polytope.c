/* Boundaries of regular polytopes whose facets are simplices: all corners of a facet are nearest
 * neighbours of each other, and all such sets of corners are facets. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/generate/draft.h"

enum { CORNERS = 120, MOST_SPACE = 5 };

/* The corners, with edges of length 1. */
typedef struct polytope {
  int space, corners;
  double point[CORNERS][MOST_SPACE];
} polytope;

/* Corner v of d + 1 ones is at v/sqrt(2v(v+1)) of axis v, and those before it are at
 * -1/sqrt(2v(v+1)). */
static void place_simplex(int space, polytope *p)
{
  p->space = space;
  p->corners = space + 1;
  for (int v = 0; v <= space; v++)
    for (int axis = 1; axis <= space; axis++)
      p->point[v][axis - 1] = (v < axis    ? -1
                               : v == axis ? axis
                                           : 0) /
                              sqrt(2.0 * axis * (axis + 1));
}

static void place_cross(int space, polytope *p)
{
  p->space = space;
  p->corners = 2 * space;
  for (int v = 0; v < 2 * space; v++) p->point[v][v / 2] = (v % 2 == 0 ? 1 : -1) / sqrt(2);
}

/* The even permutations of (0,1,2,3). */
static const int even[12][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2},
                                {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 1, 3, 0},
                                {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 2, 1, 0}};

/* The icosians: the even permutations of (+-golden, +-1, +-1/golden, 0)/2, (+-1, +-1, +-1, +-1)/2
 * and +-1 along the axes, on a sphere of the golden ratio as radius. */
static void place_cell_600(polytope *p)
{
  const double golden = 0.5 * (1 + sqrt(5)), value[3] = {golden, 1, golden - 1};
  int v = 0;
  p->space = 4;
  p->corners = CORNERS;
  for (int i = 0; i < 8; i++) p->point[v++][i / 2] = i % 2 == 0 ? golden : -golden;
  for (int i = 0; i < 16; i++, v++)
    for (int a = 0; a < 4; a++) p->point[v][a] = 0.5 * (i >> a & 1 ? -golden : golden);
  for (int i = 0; i < 96; i++, v++)
    for (int a = 0; a < 3; a++)
      p->point[v][even[i / 8][a]] = 0.5 * (i >> a & 1 ? -golden : golden) * value[a];
}

static int are_near(const polytope *p, int a, int b)
{
  double square = 0;
  for (int i = 0; i < p->space; i++) {
    const double difference = p->point[b][i] - p->point[a][i];
    square += difference * difference;
  }
  return square < 1.2;
}

/* Add all facets whose first `count` corners are given. Returns how many there are, and writes them
 * unless `vertex` is NULL. */
static int add_facets(const polytope *p, int count, int *corner, int *vertex)
{
  int facets = 0;
  if (count == p->space) {
    for (int i = 0; i < count && vertex != NULL; i++) vertex[i] = corner[i];
    return 1;
  }
  for (int v = count > 0 ? corner[count - 1] + 1 : 0; v < p->corners; v++) {
    int fits = 1;
    for (int i = 0; i < count && fits; i++) fits = are_near(p, corner[i], v);
    if (!fits) continue;
    corner[count] = v;
    facets += add_facets(p, count + 1, corner, vertex != NULL ? vertex + facets * p->space : NULL);
  }
  return facets;
}

static dvi_status fill(const dvi__sizes *sizes, const char *name, const polytope *p,
                       dvi__draft *draft)
{
  int corner[MOST_SPACE];
  draft->terms.dimension = p->space - 1;
  draft->terms.space = p->space;
  DVI_TRY(dvi__draft_allocate(draft, name, p->corners, add_facets(p, 0, corner, NULL)));
  (void)add_facets(p, 0, corner, draft->vertex);
  for (int v = 0; v < p->corners; v++)
    for (int i = 0; i < p->space; i++)
      draft->point[v * p->space + i] = (i < 4 ? sizes->origin[i] : 0) +
                                       sizes->extent[0] * p->point[v][i];
  return DVI_OK;
}

dvi_status dvi__generate_simplex_4(const dvi__sizes *sizes, dvi__draft *draft)
{
  polytope p = {0};
  place_simplex(4, &p);
  return fill(sizes, "simplex-4", &p, draft);
}

dvi_status dvi__generate_simplex_5(const dvi__sizes *sizes, dvi__draft *draft)
{
  polytope p = {0};
  place_simplex(5, &p);
  return fill(sizes, "simplex-5", &p, draft);
}

dvi_status dvi__generate_cell_16(const dvi__sizes *sizes, dvi__draft *draft)
{
  polytope p = {0};
  place_cross(4, &p);
  return fill(sizes, "cell-16", &p, draft);
}

dvi_status dvi__generate_cross_5(const dvi__sizes *sizes, dvi__draft *draft)
{
  polytope p = {0};
  place_cross(5, &p);
  return fill(sizes, "cross-5", &p, draft);
}

dvi_status dvi__generate_cell_600(const dvi__sizes *sizes, dvi__draft *draft)
{
  polytope p = {0};
  place_cell_600(&p);
  return fill(sizes, "cell-600", &p, draft);
}
