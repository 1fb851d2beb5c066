/* The icosahedron, whose triangles are divided into four, `level` times, with the new points moved
 * to the sphere. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/generate/draft.h"

const int dvi__icosahedron[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

/* Twelve corners of three golden rectangles. */
void dvi__icosahedron_points(double *point)
{
  const double golden = 0.5 * (1 + sqrt(5)), size = sqrt(1 + golden * golden);
  for (int v = 0; v < 12; v++) {
    const int rectangle = v / 4, first = v % 2 == 0 ? -1 : 1, second = v % 4 < 2 ? 1 : -1;
    point[3 * v + rectangle] = first / size;
    point[3 * v + (rectangle + 1) % 3] = second * golden / size;
  }
}

/* The middle of an edge, by the edge's vertices. */
typedef struct middles {
  int *high,
      *next;  /* [edges] the higher vertex of each edge, and the next one with this lower one */
  int *first; /* [vertices] the first middle with this lower vertex, or -1 */
  int count, vertices;
} middles;

static int middle_of(middles *m, int a, int b, double *point)
{
  const int low = a < b ? a : b, high = a < b ? b : a;
  int at = m->first[low];
  while (at >= 0 && m->high[at] != high) at = m->next[at];
  if (at >= 0) return m->vertices + at;
  at = m->count++;
  m->high[at] = high;
  m->next[at] = m->first[low];
  m->first[low] = at;
  double x[3], square = 0;
  for (int i = 0; i < 3; i++) {
    x[i] = point[3 * low + i] + point[3 * high + i];
    square += x[i] * x[i];
  }
  for (int i = 0; i < 3; i++) point[3 * (m->vertices + at) + i] = x[i] / sqrt(square);
  return m->vertices + at;
}

/* Divide the triangles in place, the last one first. */
static void divide(int triangles, middles *m, double *point, int *vertex)
{
  for (int t = triangles - 1; t >= 0; t--) {
    const int *v = vertex + 3 * t, a = v[0], b = v[1], c = v[2], ab = middle_of(m, a, b, point),
              bc = middle_of(m, b, c, point), ca = middle_of(m, c, a, point);
    const int four[] = {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca};
    for (int i = 0; i < 12; i++) vertex[12 * t + i] = four[i];
  }
}

static dvi_status divide_once(int triangles, int vertices, dvi__draft *draft)
{
  const int edges = triangles / 2 * 3;
  middles m = {.vertices = vertices,
               .high = DVI_NEW(int, edges),
               .next = DVI_NEW(int, edges),
               .first = DVI_NEW(int, vertices)};
  const int complete = m.high != NULL && m.next != NULL && m.first != NULL;
  for (int v = 0; v < vertices && complete; v++) m.first[v] = -1;
  if (complete) divide(triangles, &m, draft->point, draft->vertex);
  dvi__release(m.high);
  dvi__release(m.next);
  dvi__release(m.first);
  return complete ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "mesh icosphere: no memory");
}

dvi_status dvi__generate_icosphere(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int level = sizes->cells[0];
  const double triangles = 20 * pow(4, level);
  draft->terms.dimension = 2;
  draft->terms.space = 3;
  DVI_TRY(dvi__draft_allocate(draft, "icosphere", triangles / 2 + 2, triangles));
  dvi__icosahedron_points(draft->point);
  for (int t = 0; t < 60; t++) draft->vertex[t] = dvi__icosahedron[t / 3][t % 3];
  for (int i = 0, count = 20; i < level; i++, count *= 4)
    DVI_TRY(divide_once(count, count / 2 + 2, draft));
  for (int64_t i = 0; i < 3 * draft->terms.points; i++)
    draft->point[i] = sizes->origin[i % 3] + sizes->extent[0] * draft->point[i];
  return DVI_OK;
}
