#include "picture/skin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { FACES = 6 };

/* The faces of each kind of cell, around each face. */
typedef struct shape {
  int faces, corners;
  int corner[FACES][4];
} shape;

static const shape shapes[] = {
    [VTU_LINE] = {0, 0, {{0}}},
    [VTU_TRIANGLE] = {1, 3, {{0, 1, 2, 0}}},
    [VTU_PIXEL] = {1, 4, {{0, 1, 3, 2}}},
    [VTU_TETRAHEDRON] = {4, 3, {{1, 2, 3, 0}, {0, 2, 3, 0}, {0, 1, 3, 0}, {0, 1, 2, 0}}},
    [VTU_VOXEL] =
        {6,
         4,
         {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}},
};

/* ---- faces ---- */

static void sort_corners(int count, const int64_t *vertex, int64_t *sorted)
{
  memcpy(sorted, vertex, (size_t)count * sizeof *sorted);
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && sorted[j - 1] > sorted[j]; j--) {
      const int64_t other = sorted[j];
      sorted[j] = sorted[j - 1];
      sorted[j - 1] = other;
    }
}

static int compare_faces(const void *first, const void *second)
{
  const skin_face *a = first, *b = second;
  int64_t left[4], right[4];
  sort_corners(a->corners, a->vertex, left);
  sort_corners(b->corners, b->vertex, right);
  for (int i = 0; i < a->corners; i++)
    if (left[i] != right[i]) return left[i] < right[i] ? -1 : 1;
  return 0;
}

/* Keep the faces that stand once in the sorted list. */
static int64_t keep_single(int64_t count, skin_face *face)
{
  int64_t kept = 0;
  for (int64_t first = 0, last; first < count; first = last) {
    for (last = first + 1; last < count && compare_faces(face + first, face + last) == 0;) last++;
    if (last == first + 1) face[kept++] = face[first];
  }
  return kept;
}

static bool find_faces(const vtu_grid *g, skin *s)
{
  const shape *of = &shapes[g->kind];
  s->face = calloc((size_t)(g->cells * of->faces) + 1, sizeof *s->face);
  if (s->face == NULL) return false;
  for (int64_t c = 0; c < g->cells; c++)
    for (int f = 0; f < of->faces; f++) {
      skin_face *face = &s->face[s->faces++];
      *face = (skin_face){.corners = of->corners, .cell = c};
      for (int i = 0; i < of->corners; i++)
        face->vertex[i] = g->vertex[c * g->corners + of->corner[f][i]];
    }
  if (of->faces > 1) {
    qsort(s->face, (size_t)s->faces, sizeof *s->face, compare_faces);
    s->faces = keep_single(s->faces, s->face);
  }
  return true;
}

/* ---- edges ---- */

static int compare_edges(const void *first, const void *second)
{
  const int64_t *a = first, *b = second;
  if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
  return a[1] < b[1] ? -1 : a[1] > b[1];
}

static void add_edge(skin *s, int64_t from, int64_t to)
{
  int64_t *edge = s->edge + 2 * s->edges++;
  edge[0] = from < to ? from : to;
  edge[1] = from < to ? to : from;
}

/* Collect the edges around the faces, each once. */
static bool find_edges(const vtu_grid *g, skin *s)
{
  const int64_t lines = g->kind == VTU_LINE ? g->cells : 0;
  s->edge = calloc((size_t)(4 * s->faces + lines) + 1, 2 * sizeof *s->edge);
  if (s->edge == NULL) return false;
  for (int64_t c = 0; c < lines; c++) add_edge(s, g->vertex[2 * c], g->vertex[2 * c + 1]);
  for (int64_t f = 0; f < s->faces; f++)
    for (int i = 0; i < s->face[f].corners; i++)
      add_edge(s, s->face[f].vertex[i], s->face[f].vertex[(i + 1) % s->face[f].corners]);
  qsort(s->edge, (size_t)s->edges, 2 * sizeof *s->edge, compare_edges);
  int64_t kept = 0;
  for (int64_t e = 0; e < s->edges; e++)
    if (e == 0 || compare_edges(s->edge + 2 * e, s->edge + 2 * (e - 1)) != 0) {
      s->edge[2 * kept] = s->edge[2 * e];
      s->edge[2 * kept++ + 1] = s->edge[2 * e + 1];
    }
  s->edges = kept;
  return true;
}

/* ---- points ---- */

bool skin_is_flat(const vtu_grid *g)
{
  for (int64_t i = 1; i < g->points; i++)
    if (g->point[3 * i + 2] != g->point[2]) return false;
  return true;
}

static void find_axes(const viewpoint *from, double axis[3][3])
{
  const double degree = acos(-1.0) / 180, a = from->azimuth * degree, e = from->elevation * degree,
               turned[3][3] = {{-sin(a), cos(a), 0},
                               {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)},
                               {cos(e) * cos(a), cos(e) * sin(a), sin(e)}},
               flat[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  memcpy(axis, from->is_flat ? flat : turned, sizeof turned);
}

static bool turn_points(const vtu_grid *g, const viewpoint *from, skin *s)
{
  double axis[3][3];
  find_axes(from, axis);
  s->points = g->points;
  s->point = calloc((size_t)g->points * 3, sizeof *s->point);
  if (s->point == NULL) return false;
  for (int l = 0; l < 3; l++) {
    s->least[l] = HUGE_VAL;
    s->most[l] = -HUGE_VAL;
    for (int64_t i = 0; i < g->points; i++) {
      const double *x = g->point + 3 * i,
                   y = axis[l][0] * x[0] + axis[l][1] * x[1] + axis[l][2] * x[2];
      s->point[3 * i + l] = y;
      s->least[l] = fmin(s->least[l], y);
      s->most[l] = fmax(s->most[l], y);
    }
  }
  return true;
}

void skin_turn(const viewpoint *from, const double *vector, double *turned)
{
  double axis[3][3];
  find_axes(from, axis);
  for (int l = 0; l < 3; l++)
    turned[l] = axis[l][0] * vector[0] + axis[l][1] * vector[1] + axis[l][2] * vector[2];
}

bool skin_make(const vtu_grid *g, const viewpoint *from, skin *s)
{
  memset(s, 0, sizeof *s);
  if (turn_points(g, from, s) && find_faces(g, s) && find_edges(g, s)) return true;
  complain("out of memory");
  skin_clear(s);
  return false;
}

void skin_clear(skin *s)
{
  free(s->point);
  free(s->face);
  free(s->edge);
  memset(s, 0, sizeof *s);
}
