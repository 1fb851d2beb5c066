/* Closed surfaces with holes: a torus, and a surface of genus 2. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/generate/draft.h"

static const double pi = 3.14159265358979323846;

/* ---- a torus ---- */

/* Rows of points go around the axis. Their number is even, because odd ones are turned. */
dvi_status dvi__generate_torus(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int around = sizes->cells[0], rows = sizes->cells[1];
  const double major = sizes->extent[0], minor = sizes->extent[1];
  if (rows % 2 != 0)
    return dvi__fail(DVI_BAD_OPTION, "mesh torus: %d cells around the tube are odd", rows);
  if (!(minor < major))
    return dvi__fail(DVI_BAD_OPTION, "mesh torus: the tube's radius %g is not below the other, %g",
                     minor, major);
  draft->terms.dimension = 2;
  draft->terms.space = 3;
  DVI_TRY(dvi__draft_allocate(draft, "torus", (double)around * rows, 2.0 * around * rows));
  int *vertex = draft->vertex;
  for (int j = 0; j < rows; j++) {
    const double tube = 2 * pi * j / rows, radius = major + minor * cos(tube);
    for (int m = 0; m < around; m++) {
      const double angle = 2 * pi * (m + 0.5 * (j % 2)) / around,
                   place[] = {radius * cos(angle), radius * sin(angle), minor * sin(tube)};
      for (int a = 0; a < 3; a++)
        draft->point[3 * ((int64_t)j * around + m) + a] = sizes->origin[a] + place[a];
    }
    vertex = dvi__band_fill(around, j, (j + 1) % rows, vertex);
  }
  return DVI_OK;
}

/* ---- a surface of genus 2 ---- */

/* The surface of a plate of 5 x 3 x 1 blocks without the second and the fourth in the middle row.
 * Each square of a block's side is divided into n x n squares, and each of these into two
 * triangles. */
enum { LONG = 5, WIDE = 3, SQUARES = 2 * (LONG * WIDE - 2) + 2 * (LONG + WIDE) + 8 };

static int is_solid(int n, int x, int y, int z)
{
  if (x < 0 || y < 0 || z < 0 || x >= LONG * n || y >= WIDE * n || z >= n) return 0;
  return y / n != 1 || x / n % 2 == 0;
}

typedef struct plate {
  const dvi__sizes *sizes;
  dvi__draft *draft;
  int n, points, *number; /* [nodes] of the point at a node of the blocks' grid, plus 1 */
  int *vertex;
} plate;

static int point_at(plate *p, const int *at)
{
  const int across = LONG * p->n + 1, up = WIDE * p->n + 1;
  int *number = p->number + ((int64_t)at[2] * up + at[1]) * across + at[0];
  if (*number == 0) {
    double *x = p->draft->point + 3 * (int64_t)p->points;
    for (int a = 0; a < 3; a++) x[a] = p->sizes->origin[a] + p->sizes->extent[0] * at[a] / p->n;
    *number = ++p->points;
  }
  return *number - 1;
}

/* Add the square at the near or far end of a cube along an axis. */
static void add_square(plate *p, const int *cube, int axis, int far)
{
  static const int round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  int corner[4];
  for (int i = 0; i < 4; i++) {
    int at[3] = {cube[0], cube[1], cube[2]};
    at[axis] += far;
    at[(axis + 1) % 3] += round[i][0];
    at[(axis + 2) % 3] += round[i][1];
    corner[i] = point_at(p, at);
  }
  const int two[] = {corner[0], corner[1], corner[2], corner[0], corner[2], corner[3]};
  memcpy(p->vertex, two, sizeof two);
  p->vertex += 6;
}

static void add_cube(plate *p, const int *cube)
{
  if (!is_solid(p->n, cube[0], cube[1], cube[2])) return;
  for (int axis = 0; axis < 3; axis++)
    for (int far = 0; far < 2; far++) {
      int beside[3] = {cube[0], cube[1], cube[2]};
      beside[axis] += far ? 1 : -1;
      if (!is_solid(p->n, beside[0], beside[1], beside[2])) add_square(p, cube, axis, far);
    }
}

dvi_status dvi__generate_genus(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int n = sizes->cells[0];
  const double squares = (double)SQUARES * n * n, nodes = (5.0 * n + 1) * (3.0 * n + 1) * (n + 1.0);
  plate p = {.sizes = sizes, .draft = draft, .n = n};
  draft->terms.dimension = 2;
  draft->terms.space = 3;
  DVI_TRY(dvi__draft_allocate(draft, "genus-2", squares - 2, 2 * squares));
  p.vertex = draft->vertex;
  p.number = DVI_NEW(int, nodes);
  if (p.number == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh genus-2: no memory");
  for (int z = 0; z < n; z++)
    for (int y = 0; y < WIDE * n; y++)
      for (int x = 0; x < LONG * n; x++) add_cube(&p, (const int[]){x, y, z});
  dvi__release(p.number);
  return DVI_OK;
}
