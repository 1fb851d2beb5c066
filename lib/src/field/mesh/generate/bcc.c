/* The body-centred cubic lattice in a torus: points at the corners and at the centres of the cubes.
 * The four tetrahedra around the edge between the centres of two neighbours have an edge of the
 * cubes' common face each. All of them are congruent if the cubes are, and hold the circumcentres
 * of themselves and of all their faces. */
#include "core/status.h"
#include "field/mesh/generate/draft.h"

/* Give a corner, or with `centre` the centre, of the cube at a place that may lie outside by one
 * period. */
static int node(const dvi__sizes *sizes, const int *at, int centre)
{
  int index = centre, stride = 1;
  for (int a = 0; a < 3; a++) {
    index += stride * ((at[a] + sizes->cells[a]) % sizes->cells[a]) * 2;
    stride *= sizes->cells[a];
  }
  return index;
}

static void fill_points(const dvi__sizes *sizes, const int *at, double *point)
{
  for (int centre = 0; centre < 2; centre++) {
    double *x = point + 3 * (int64_t)node(sizes, at, centre);
    for (int a = 0; a < 3; a++)
      x[a] = sizes->origin[a] + sizes->extent[a] * (at[a] + 0.5 * centre) / sizes->cells[a];
  }
}

/* The tetrahedra around the edge from this cube's centre to that of the next one along an axis. */
static int *fill_edge(const dvi__sizes *sizes, const int *at, int axis, int *vertex)
{
  static const int round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  int next[3] = {at[0], at[1], at[2]}, corner[4];
  next[axis]++;
  for (int i = 0; i < 4; i++) {
    int place[3] = {next[0], next[1], next[2]};
    place[(axis + 1) % 3] += round[i][0];
    place[(axis + 2) % 3] += round[i][1];
    corner[i] = node(sizes, place, 0);
  }
  for (int i = 0; i < 4; i++) {
    *vertex++ = node(sizes, at, 1);
    *vertex++ = node(sizes, next, 1);
    *vertex++ = corner[i];
    *vertex++ = corner[(i + 1) % 4];
  }
  return vertex;
}

dvi_status dvi__generate_bcc(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int *cells = sizes->cells;
  const double cubes = (double)cells[0] * cells[1] * cells[2];
  draft->terms.dimension = 3;
  for (int a = 0; a < 3; a++) draft->period[a] = sizes->extent[a];
  DVI_TRY(dvi__draft_allocate(draft, "bcc-torus", 2 * cubes, 12 * cubes));
  int *vertex = draft->vertex;
  for (int z = 0; z < cells[2]; z++)
    for (int y = 0; y < cells[1]; y++)
      for (int x = 0; x < cells[0]; x++) {
        const int at[3] = {x, y, z};
        fill_points(sizes, at, draft->point);
        for (int axis = 0; axis < 3; axis++) vertex = fill_edge(sizes, at, axis, vertex);
      }
  return DVI_OK;
}
