#include <dvi/audit.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/largest.h"
#include "field/audit/pinch.h"
#include "field/forms/gram.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

enum { HOLES_MAX = 200000 };

/* A dual cell vanishes if it is this part of the largest one of its degree. */
static const double negligible = 1e-12;

/* ---- cells ---- */

static void measure_cells(const dvi_mesh *mesh, int k, dvi_degree_report *d)
{
  d->count = mesh->count[k];
  (void)dvi_mesh_part_cells(mesh, "boundary", k < mesh->n ? k : mesh->n - 1, &d->boundary);
  if (k == mesh->n) d->boundary = 0;
  d->smallest = INFINITY;
  for (int64_t c = 0; c < mesh->count[k]; c++) {
    const double volume = dvi__cell_volume(mesh, k, c);
    d->smallest = fmin(d->smallest, volume);
    d->largest = fmax(d->largest, volume);
    d->total += volume;
  }
}

static double length_of(int space, const double *x)
{
  double sum = 0;
  for (int l = 0; l < space; l++) sum += x[l] * x[l];
  return sqrt(sum);
}

/* n r/R with the radii r = n V/(sum of the facets) and R, as in Euclidean space in any metric. */
static double quality_of_simplex(const dvi_mesh *mesh, int64_t cell)
{
  const int n = mesh->n, all[] = {0, 1, 2, 3, 4};
  double facets = 0, centre[DVI_MESH_SPACE_MAX] = {0};
  dvi__placed placed;
  dvi__simplex s;
  dvi__place_cell(mesh, n, cell, &placed);
  placed.metric = dvi__euclidean;
  dvi__simplex_of(&placed, n, all, &s);
  for (int j = 0; j <= n; j++) {
    facets += dvi__cell_volume(mesh, n - 1, mesh->facet[n][cell * (n + 1) + j]);
    for (int l = 0; l < mesh->space; l++) centre[l] += s.centre[j] * placed.x[j][l];
  }
  return n * n * dvi__cell_volume(mesh, n, cell) / facets / length_of(mesh->space, centre);
}

static double quality_of_box(const dvi_mesh *mesh, int64_t cell)
{
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX], least = INFINITY, most = 0;
  dvi__cell_edges(mesh, mesh->n, cell, edge);
  for (int i = 0; i < mesh->n; i++) {
    const double length = length_of(mesh->space, edge + (ptrdiff_t)i * mesh->space);
    least = fmin(least, length);
    most = fmax(most, length);
  }
  return least / most;
}

static void measure_quality(const dvi_mesh *mesh, dvi_mesh_report *report)
{
  report->quality = INFINITY;
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    const double quality = mesh->n == 1              ? 1
                           : mesh->kind == DVI_BOXES ? quality_of_box(mesh, c)
                                                     : quality_of_simplex(mesh, c);
    report->mean_quality += quality / (double)mesh->count[mesh->n];
    if (quality >= report->quality) continue;
    report->quality = quality;
    report->worst_cell = c;
  }
}

static void measure_length(const dvi_mesh *mesh, dvi_mesh_report *report)
{
  double span[DVI_MESH_SPACE_MAX];
  for (int l = 0; l < mesh->space; l++) {
    double least = INFINITY, most = -INFINITY;
    for (int64_t v = 0; v < mesh->count[0]; v++) {
      least = fmin(least, mesh->point[v * mesh->space + l]);
      most = fmax(most, mesh->point[v * mesh->space + l]);
    }
    span[l] = mesh->period[l] > 0 ? mesh->period[l] : most - least;
  }
  report->length = length_of(mesh->space, span);
}

/* ---- dual cells ---- */

static void count_duals(const dvi_star *star, int k, dvi_degree_report *d)
{
  const double *dual = star->dual[k], *entry = star->diagonal[k];
  double most = 0;
  d->smallest_star = INFINITY;
  for (int64_t c = 0; c < d->count; c++) {
    most = fmax(most, fabs(dual[c]));
    if (entry[c] >= d->smallest_star) continue;
    d->smallest_star = entry[c];
    d->worst = c;
  }
  for (int64_t c = 0; c < d->count; c++) {
    d->zero += fabs(dual[c]) <= negligible * most;
    d->negative += dual[c] < -negligible * most;
  }
}

static void measure_edges(const dvi_star *star, dvi_mesh_report *report)
{
  const dvi_mesh *mesh = star->mesh;
  double most = 0;
  report->dual_ratio = INFINITY;
  for (int64_t e = 0; e < mesh->count[1]; e++) most = fmax(most, star->dual[1][e]);
  for (int64_t e = 0; e < mesh->count[1]; e++)
    if (star->dual[1][e] > negligible * most)
      report->dual_ratio = fmin(report->dual_ratio,
                                star->dual[1][e] / dvi__cell_volume(mesh, 1, e));
}

static int is_of_space(const dvi_mesh *mesh)
{
  for (int l = 0; l < mesh->space; l++)
    if (mesh->metric[l] < 0) return 0;
  return 1;
}

/* Tell if an inner edge of triangles has a negative dual, which a flip may mend. */
static int can_be_flipped(const dvi_star *star)
{
  const dvi_mesh *mesh = star->mesh;
  double most = 0;
  if (mesh->n != 2 || mesh->kind != DVI_SIMPLICES || !is_of_space(mesh)) return 0;
  for (int64_t e = 0; e < mesh->count[1]; e++) most = fmax(most, fabs(star->dual[1][e]));
  for (int64_t e = 0; e < mesh->count[1]; e++)
    if (mesh->coface[2 * e + 1] >= 0 && star->dual[1][e] < -negligible * most) return 1;
  return 0;
}

/* M_k is positive, and M_{k+1} is not negative. */
static int has_frequencies(const dvi_star *star, int k, const dvi_mesh_report *report)
{
  const dvi_degree_report *d = report->degree + k;
  return is_of_space(star->mesh) && k < star->mesh->n && d->negative == 0 && d->zero == 0 &&
         d[1].negative == 0;
}

static dvi_status find_frequency(const dvi_star *star, int k, dvi_mesh_report *report)
{
  dvi_degree_report *d = report->degree + k;
  dvi__csr stiffness = {0};
  dvi_matrix M;
  double bound = 0;
  if (!has_frequencies(star, k, report)) return DVI_OK;
  DVI_TRY(dvi_star_matrix(star, k, &M));
  DVI_TRY(dvi__stiffness(star, k, &stiffness));
  const dvi_matrix K = dvi__csr_view(&stiffness, 1);
  const dvi__pencil pencil = {.K = &K, .M = &M, .dimension = star->mesh->n};
  const dvi_status status = dvi__largest_eigenvalue(&pencil, NULL, &bound);
  dvi__csr_clear(&stiffness);
  if (status != DVI_OK) return status;
  d->fastest = sqrt(bound);
  d->step = 2 / d->fastest;
  d->steps = report->length / d->step;
  return DVI_OK;
}

/* ---- the whole ---- */

static int can_be_glued(const dvi_mesh *mesh)
{
  dvi_mesh *glued = NULL;
  const int made = dvi_mesh_glue(mesh, &glued) == DVI_OK;
  dvi_mesh_destroy(&glued);
  return made;
}

static unsigned advise(const dvi_mesh *mesh, const dvi_mesh_report *report)
{
  const int n = mesh->n, is_simplicial = mesh->kind == DVI_SIMPLICES;
  int64_t negative = 0, zero = 0;
  for (int k = 0; k <= n; k++) {
    negative += report->degree[k].negative;
    zero += report->degree[k].zero;
  }
  unsigned advice = negative > 0 || zero > 0 ? DVI_ADVICE_STAR : 0;
  /* each of the n! simplices of a box has n - 1 facets inside of it */
  if (is_simplicial && n > 1 && 2 * report->degree[n - 1].zero >= (n - 1) * report->degree[n].count)
    advice |= can_be_glued(mesh) ? DVI_ADVICE_GLUE : 0;
  return advice;
}

static dvi_status find_holes(const dvi_mesh *mesh, int64_t most, dvi_mesh_report *report)
{
  int64_t betti[DVI__DEGREES];
  for (int k = 0; k <= mesh->n; k++) report->degree[k].betti = -1;
  if (mesh->count[mesh->n] > most) return DVI_OK;
  DVI_TRY(dvi_mesh_betti(mesh, betti));
  for (int k = 0; k <= mesh->n; k++) report->degree[k].betti = betti[k];
  return DVI_OK;
}

/* A facet of more than two cells has no dual edge, so that such a mesh has no star. */
static dvi_status audit_duals(const dvi_mesh *mesh, int without_steps, dvi_mesh_report *report)
{
  dvi_star *star = NULL;
  if (mesh->branching >= 0) return DVI_OK;
  DVI_TRY(dvi_star_create(mesh, NULL, &star));
  for (int k = 0; k <= mesh->n; k++) count_duals(star, k, report->degree + k);
  measure_edges(star, report);
  if (can_be_flipped(star)) report->advice = DVI_ADVICE_FLIP;
  dvi_status status = DVI_OK;
  for (int k = 0; k < mesh->n && status == DVI_OK && !without_steps; k++)
    status = find_frequency(star, k, report);
  dvi_star_destroy(&star);
  return status;
}

dvi_status dvi_mesh_audit(const dvi_mesh *mesh, const dvi_audit_options *options,
                          dvi_mesh_report *report)
{
  const dvi_audit_options defaults = {.size = sizeof defaults};
  if (mesh == NULL || report == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "audit: a mesh and a report are needed");
  if (options == NULL) options = &defaults;
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "audit: set options.size to sizeof(dvi_audit_options)");
  DVI_TRY(dvi__refuse_share(mesh, "audit: a report"));
  *report = (dvi_mesh_report){.dimension = mesh->n,
                              .space = mesh->space,
                              .branching = mesh->branching,
                              .is_orientable = mesh->orientation != NULL,
                              .dual_ratio = NAN};
  for (int k = 0; k <= mesh->n; k++) {
    dvi_degree_report *d = report->degree + k;
    *d = (dvi_degree_report){.smallest_star = NAN, .fastest = NAN, .step = NAN, .steps = NAN};
    measure_cells(mesh, k, d);
  }
  measure_length(mesh, report);
  measure_quality(mesh, report);
  DVI_TRY(dvi__find_pinches(mesh, &report->pinches, &report->pinched));
  report->is_manifold = mesh->branching < 0 && report->pinches == 0;
  DVI_TRY(find_holes(mesh, options->holes_max > 0 ? options->holes_max : HOLES_MAX, report));
  DVI_TRY(audit_duals(mesh, options->without_steps, report));
  report->advice |= advise(mesh, report);
  return DVI_OK;
}
