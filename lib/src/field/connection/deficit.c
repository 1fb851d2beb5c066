/* Deficits, 2 pi less the dihedral angles at a hinge (Regge 1961), and Gauss and Bonnet's theorem
 * for them: each triangle has the angles pi, and 2 E = 3 F + B with B edges on the boundary. */
#include <dvi/curvature.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/cell.h"
#include "field/connection/lengths.h"
#include "field/forms/duals.h"
#include "field/regge/simplex.h"
#include "field/mesh/angle.h"

/* Give the angles of a cell, in the order of dvi__pair. */
static dvi_status find_angles(const dvi_mesh *mesh, const double *length, int64_t cell,
                              dvi__twofold *angle)
{
  dvi__laid_cell laid;
  DVI_TRY(dvi__lay_cell(mesh, length, cell, &laid));
  for (int i = 0; i <= mesh->n; i++)
    for (int j = i + 1; j <= mesh->n; j++)
      angle[dvi__pair(mesh->n, i, j)] = dvi__laid_angle(&laid, i, j);
  return DVI_OK;
}

static dvi_status subtract_angles(const dvi_mesh *mesh, const double *length, dvi__twofold *deficit)
{
  const int whole = (2 << mesh->n) - 1;
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    int64_t number[DVI__CORNER_SETS];
    dvi__twofold angle[DVI__PAIRS] = {{0, 0}};
    DVI_TRY(find_angles(mesh, length, c, angle));
    dvi__number_faces(mesh, c, number);
    for (int i = 0; i <= mesh->n; i++)
      for (int j = i + 1; j <= mesh->n; j++) {
        dvi__twofold *of = deficit + number[whole & ~(1 << i | 1 << j)];
        *of = dvi__twofold_plus(*of, dvi__twofold_scaled(angle[dvi__pair(mesh->n, i, j)], -1));
      }
  }
  return DVI_OK;
}

/* Compute the deficits [hinges] in twice the digits. */
static dvi_status find_deficits(const dvi_mesh *mesh, const double *length, dvi__twofold *deficit)
{
  int64_t count;
  const int *rim = dvi_mesh_part_cells(mesh, "boundary", mesh->n - 2, &count);
  for (int64_t h = 0; h < mesh->count[mesh->n - 2]; h++)
    deficit[h] = dvi__twofold_scaled(dvi__twofold_pi, 2);
  for (int64_t i = 0; i < count; i++) deficit[rim[i]] = dvi__twofold_pi;
  return subtract_angles(mesh, length, deficit);
}

static dvi_status check(const dvi_mesh *mesh, const double *length, const void *result)
{
  DVI_TRY(dvi__check_metric(mesh, length));
  if (result == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a place for the deficits is needed");
  return DVI_OK;
}

dvi_status dvi_hinge_deficits(const dvi_mesh *mesh, const double *length, double *deficit)
{
  DVI_TRY(check(mesh, length, deficit));
  const int64_t hinges = mesh->count[mesh->n - 2];
  dvi__twofold *exact = DVI_NEW(dvi__twofold, hinges);
  if (exact == NULL) return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for deficits");
  const dvi_status status = find_deficits(mesh, length, exact);
  for (int64_t h = 0; h < hinges && status == DVI_OK; h++) deficit[h] = exact[h].head;
  dvi__release(exact);
  return status;
}

/* ---- Gauss and Bonnet ---- */

/* The deficits of a surface, and the vertices of its boundary. */
typedef struct vertices {
  dvi__twofold *deficit;
  char *on_boundary;
} vertices;

static void note_extremes(const dvi_mesh *mesh, const vertices *of, dvi_gauss_bonnet *report)
{
  report->at_least = report->at_most = -1;
  report->least = report->most = 0;
  for (int64_t v = 0; v < mesh->count[0]; v++) {
    const double deficit = of->deficit[v].head;
    if (of->on_boundary[v]) continue;
    if (report->at_least < 0 || deficit < report->least) {
      report->at_least = v;
      report->least = deficit;
    }
    if (report->at_most < 0 || deficit > report->most) {
      report->at_most = v;
      report->most = deficit;
    }
  }
}

static void sum_deficits(const dvi_mesh *mesh, const vertices *of, dvi_gauss_bonnet *report)
{
  dvi__twofold sum[2] = {{0, 0}, {0, 0}};
  for (int64_t v = 0; v < mesh->count[0]; v++) {
    dvi__twofold *part = sum + of->on_boundary[v];
    *part = dvi__twofold_plus(*part, of->deficit[v]);
  }
  report->euler = mesh->count[0] - mesh->count[1] + mesh->count[2];
  const dvi__twofold turns = {-2 * (double)report->euler, 0};
  report->deficits = sum[0].head;
  report->turning = sum[1].head;
  report->difference =
      dvi__twofold_add_product(dvi__twofold_plus(sum[0], sum[1]), turns, dvi__twofold_pi).head;
}

static dvi_status make_report(const dvi_mesh *mesh, const double *length, const vertices *of,
                              dvi_gauss_bonnet *report)
{
  int64_t count;
  const int *rim = dvi_mesh_part_cells(mesh, "boundary", 0, &count);
  DVI_TRY(find_deficits(mesh, length, of->deficit));
  for (int64_t i = 0; i < count; i++) of->on_boundary[rim[i]] = 1;
  sum_deficits(mesh, of, report);
  note_extremes(mesh, of, report);
  return DVI_OK;
}

dvi_status dvi_gauss_bonnet_of(const dvi_mesh *mesh, const double *length, dvi_gauss_bonnet *report)
{
  DVI_TRY(check(mesh, length, report));
  if (mesh->n != 2)
    return dvi__fail(DVI_UNSUPPORTED,
                     "curvature: Gauss and Bonnet's theorem is for triangles, and the cells have "
                     "dimension %d",
                     mesh->n);
  const vertices of = {.deficit = DVI_NEW(dvi__twofold, mesh->count[0]),
                       .on_boundary = DVI_NEW(char, mesh->count[0])};
  const dvi_status status = of.deficit != NULL && of.on_boundary != NULL
                                ? make_report(mesh, length, &of, report)
                                : dvi__fail(DVI_NO_MEMORY, "curvature: no memory for deficits");
  dvi__release(of.deficit);
  dvi__release(of.on_boundary);
  return status;
}
