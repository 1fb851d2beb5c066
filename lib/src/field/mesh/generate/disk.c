/* Disks, annuli and cylinders, made of rings around a centre. */
#include <math.h>

#include "core/status.h"
#include "core/memory.h"
#include "field/mesh/generate/draft.h"

static const double pi = 3.14159265358979323846;

enum { RIM = 1 };

/* ---- a disk ---- */

static double disk_points(int rings)
{
  return 1 + 3.0 * rings * (rings + 1.0);
}

static double disk_triangles(int rings)
{
  return 6.0 * rings * rings;
}

/* Give point m of a ring, counted around it from any start. */
static int on_ring(int ring, int m)
{
  return ring == 0 ? 0 : 3 * ring * (ring - 1) + 1 + m % (6 * ring);
}

/* The triangles between a ring and the next smaller one, in six sectors. */
static int *fill_ring(int ring, int *vertex)
{
  for (int sector = 0; sector < 6; sector++)
    for (int m = 0; m < ring; m++) {
      const int outer = sector * ring + m, inner = sector * (ring - 1) + m;
      *vertex++ = on_ring(ring - 1, inner);
      *vertex++ = on_ring(ring, outer);
      *vertex++ = on_ring(ring, outer + 1);
      if (m + 1 == ring) continue;
      *vertex++ = on_ring(ring - 1, inner);
      *vertex++ = on_ring(ring, outer + 1);
      *vertex++ = on_ring(ring - 1, inner + 1);
    }
  return vertex;
}

static void disk_fill(int rings, double *point, int *vertex)
{
  point[0] = point[1] = 0;
  for (int ring = 1; ring <= rings; ring++) {
    for (int m = 0; m < 6 * ring; m++) {
      const double angle = pi * m / (3 * ring);
      point[2 * on_ring(ring, m)] = ring * cos(angle) / rings;
      point[2 * on_ring(ring, m) + 1] = ring * sin(angle) / rings;
    }
    vertex = fill_ring(ring, vertex);
  }
}

dvi_status dvi__generate_disk(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int rings = sizes->cells[0];
  draft->terms.dimension = 2;
  draft->name[0] = "rim";
  DVI_TRY(dvi__draft_allocate(draft, "disk", disk_points(rings), disk_triangles(rings)));
  disk_fill(rings, draft->point, draft->vertex);
  for (int64_t i = 0; i < 2 * draft->terms.points; i++)
    draft->point[i] = sizes->origin[i % 2] + sizes->extent[0] * draft->point[i];
  for (int m = 0; m < 6 * rings; m++) draft->side[on_ring(rings, m)] = RIM;
  return DVI_OK;
}

/* ---- an annulus ---- */

int *dvi__band_fill(int around, int row, int next, int *vertex)
{
  const int is_odd = row % 2;
  for (int m = 0; m < around; m++) {
    const int a = row * around + m, b = row * around + (m + 1) % around,
              c = next * around + (m + is_odd) % around,
              d = next * around + (m + 1 + is_odd) % around;
    const int two[] = {a, b, c, b, d, c};
    for (int i = 0; i < 6; i++) *vertex++ = two[i];
  }
  return vertex;
}

/* Radii grow by a constant factor, so that the triangles of all rings have one shape. */
dvi_status dvi__generate_annulus(const dvi__sizes *sizes, dvi__draft *draft)
{
  const int rings = sizes->cells[0], around = sizes->cells[1];
  const double outer = sizes->extent[0], inner = sizes->extent[1];
  if (!(inner < outer))
    return dvi__fail(DVI_BAD_OPTION, "mesh annulus: the inner radius %g is not below the outer %g",
                     inner, outer);
  if (!(cos(pi / around) > pow(inner / outer, 1.0 / rings)))
    return dvi__fail(DVI_BAD_OPTION,
                     "mesh annulus: triangles of %d rings with %d cells around fold: take more "
                     "cells around, or fewer rings",
                     rings, around);
  draft->terms.dimension = 2;
  draft->name[0] = "outer";
  draft->name[1] = "inner";
  DVI_TRY(dvi__draft_allocate(draft, "annulus", (rings + 1.0) * around, 2.0 * rings * around));
  int *vertex = draft->vertex;
  for (int j = 0; j <= rings; j++) {
    const double radius = inner * pow(outer / inner, (double)j / rings);
    for (int m = 0; m < around; m++) {
      const int v = j * around + m;
      const double angle = 2 * pi * (m + 0.5 * (j % 2)) / around;
      draft->point[2 * v] = sizes->origin[0] + radius * cos(angle);
      draft->point[2 * v + 1] = sizes->origin[1] + radius * sin(angle);
      draft->side[v] = (unsigned char)((j == rings) | (j == 0) << 1);
    }
    if (j < rings) vertex = dvi__band_fill(around, j, j + 1, vertex);
  }
  return DVI_OK;
}

/* ---- a cylinder ---- */

/* The prism over a triangle with ascending corners: three tetrahedra, which fit to those of the
 * prisms beside it. */
static int *fill_prism(int points, int layer, const int *triangle, int *vertex)
{
  int corner[3] = {triangle[0], triangle[1], triangle[2]};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2 - i; j++)
      if (corner[j] > corner[j + 1]) {
        const int kept = corner[j];
        corner[j] = corner[j + 1];
        corner[j + 1] = kept;
      }
  for (int turn = 0; turn < 3; turn++)
    for (int i = 0; i < 4; i++) {
      const int above = i > 2 - turn; /* corners below, then from the same corner on above */
      *vertex++ = corner[above ? i - 1 : i] + points * (layer + above);
    }
  return vertex;
}

static void fill_layers(const dvi__sizes *sizes, int points, const double *plane, dvi__draft *draft)
{
  const int rings = sizes->cells[0], layers = sizes->cells[1];
  for (int layer = 0; layer <= layers; layer++)
    for (int i = 0; i < points; i++) {
      const int v = layer * points + i, is_side = i >= on_ring(rings, 0);
      double *x = draft->point + 3 * (int64_t)v;
      for (int a = 0; a < 2; a++) x[a] = sizes->origin[a] + sizes->extent[0] * plane[2 * i + a];
      x[2] = sizes->origin[2] + sizes->extent[1] * layer / layers;
      draft->side[v] = (unsigned char)(is_side | (layer == 0) << 1 | (layer == layers) << 2);
    }
}

dvi_status dvi__generate_cylinder(const dvi__sizes *sizes, dvi__draft *draft)
{
  static const char *const side[] = {"side", "bottom", "top"};
  const int rings = sizes->cells[0], layers = sizes->cells[1];
  const double points = disk_points(rings), triangles = disk_triangles(rings);
  draft->terms.dimension = 3;
  for (int i = 0; i < 3; i++) draft->name[i] = side[i];
  DVI_TRY(dvi__draft_allocate(draft, "cylinder", points * (layers + 1.0), 3 * triangles * layers));
  double *plane = DVI_NEW(double, 2 * points);
  int *triangle = DVI_NEW(int, 3 * triangles), *vertex = draft->vertex;
  const int complete = plane != NULL && triangle != NULL;
  if (complete) {
    disk_fill(rings, plane, triangle);
    fill_layers(sizes, (int)points, plane, draft);
    for (int layer = 0; layer < layers; layer++)
      for (int t = 0; t < (int)triangles; t++)
        vertex = fill_prism((int)points, layer, triangle + 3 * t, vertex);
  }
  dvi__release(plane);
  dvi__release(triangle);
  return complete ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "mesh cylinder: no memory");
}
