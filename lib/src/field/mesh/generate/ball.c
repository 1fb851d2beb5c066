/* A ball of tetrahedra in n shells: the cones of the icosahedron's 20 triangles to the centre, with
 * their corners O, A, B, C in ascending order, divided as Kuhn's simplex
 *
 *     n >= x_1 >= x_2 >= x_3 >= 0
 *
 * is by the simplices of the unit cubes. The point x is in shell x_1, in the direction of
 * (x_1 - x_2) A + (x_2 - x_3) B + x_3 C. Neighbours divide their common side in the same way,
 * because the order of its corners is the same in both. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/generate/draft.h"

enum { CORNERS = 12, EDGES = 30, CONES = 20, SURFACE = 1 };

typedef struct ball {
  const dvi__sizes *sizes;
  dvi__draft *draft;
  int n;
  double corner[3 * CORNERS];
  int cone[CONES][3];         /* ascending corners */
  int edge[CORNERS][CORNERS]; /* number of the edge of two corners */
  int *vertex;
} ball;

/* ---- points ---- */

/* Count the points of shells below s that lie inside a side (k = 2) or a cone (k = 3). */
static int count_below(int k, int s)
{
  const double t = s - 1; /* doubles: the products may exceed an int before they are divided */
  return (int)(k == 2 ? t * (t - 1) / 2 : t * (t - 1) * (t - 2) / 6);
}

/* Number a point by where it lies: the centre, rays to the corners, sides between rays, cones. The
 * weights of the corners are positive for as many as `count`. */
static int number_of(const ball *b, int cone, int s, int count, const int *corner,
                     const int *weight)
{
  const int n = b->n, in_side = count_below(2, n + 1), in_cone = count_below(3, n + 1);
  if (count == 0) return 0;
  if (count == 1) return 1 + corner[0] * n + s - 1;
  if (count == 2)
    return 1 + CORNERS * n + b->edge[corner[0]][corner[1]] * in_side + count_below(2, s) +
           weight[1] - 1;
  return 1 + CORNERS * n + EDGES * in_side + cone * in_cone + count_below(3, s) +
         count_below(2, s - weight[0]) + weight[2] - 1;
}

static void place_point(const ball *b, int v, int s, int count, const int *corner,
                        const int *weight)
{
  double x[3] = {0, 0, 0}, square = 0;
  for (int a = 0; a < 3; a++) {
    for (int i = 0; i < count; i++) x[a] += weight[i] * b->corner[3 * corner[i] + a];
    square += x[a] * x[a];
  }
  const double scale = s > 0 ? b->sizes->extent[0] * s / (b->n * sqrt(square)) : 0;
  for (int a = 0; a < 3; a++)
    b->draft->point[3 * (int64_t)v + a] = b->sizes->origin[a] + scale * x[a];
  b->draft->side[v] = s == b->n ? SURFACE : 0;
}

/* Find the point of a cone with these x, and place it. */
static int point_at(const ball *b, int cone, const int *x)
{
  const int all[] = {x[0] - x[1], x[1] - x[2], x[2]};
  int corner[3] = {0}, weight[3] = {0}, count = 0;
  for (int i = 0; i < 3; i++) {
    if (all[i] == 0) continue;
    corner[count] = b->cone[cone][i];
    weight[count++] = all[i];
  }
  const int v = number_of(b, cone, x[0], count, corner, weight);
  place_point(b, v, x[0], count, corner, weight);
  return v;
}

/* ---- tetrahedra ---- */

/* Add those simplices of the cube at x that lie in the cone. */
static void add_cube(ball *b, int cone, const int *x)
{
  static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < 6; i++) {
    int at[4][3], inside = 1;
    for (int step = 0; step < 4; step++) {
      for (int a = 0; a < 3; a++) at[step][a] = step > 0 ? at[step - 1][a] : x[a];
      if (step > 0) at[step][order[i][step - 1]]++;
      inside = inside && at[step][0] >= at[step][1] && at[step][1] >= at[step][2];
    }
    for (int step = 0; step < 4 && inside; step++) *b->vertex++ = point_at(b, cone, at[step]);
  }
}

static void sort_corners(ball *b)
{
  int edges = 0;
  for (int c = 0; c < CONES; c++) {
    int *v = b->cone[c];
    for (int i = 0; i < 3; i++) v[i] = dvi__icosahedron[c][i];
    for (int i = 0; i < 3; i++)
      for (int j = i + 1; j < 3; j++) {
        const int low = v[i] < v[j] ? v[i] : v[j], high = v[i] < v[j] ? v[j] : v[i];
        v[i] = low;
        v[j] = high;
      }
  }
  for (int c = 0; c < CONES; c++)
    for (int i = 0; i < 3; i++)
      for (int j = i + 1; j < 3; j++) {
        int *edge = &b->edge[b->cone[c][i]][b->cone[c][j]];
        if (*edge < 0) *edge = edges++;
      }
}

dvi_status dvi__generate_ball(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int n = sizes->cells[0];
  const double shells = n, on_spheres = 10 * shells * (shells + 1) * (2 * shells + 1) / 6;
  draft->terms.dimension = 3;
  draft->name[0] = "surface";
  DVI_TRY(dvi__draft_allocate(draft, "ball", 1 + on_spheres + 2 * shells,
                              CONES * shells * shells * shells));
  ball b = {.sizes = sizes, .draft = draft, .n = n, .vertex = draft->vertex};
  for (int i = 0; i < CORNERS * CORNERS; i++) b.edge[i / CORNERS][i % CORNERS] = -1;
  dvi__icosahedron_points(b.corner);
  sort_corners(&b);
  for (int c = 0; c < CONES; c++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j <= i; j++)
        for (int k = 0; k <= j; k++) add_cube(&b, c, (const int[]){i, j, k});
  return DVI_OK;
}
