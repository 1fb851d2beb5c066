/* Functions of the cells of a box that solve div (a grad phi) = 0 in each, one for each node.
 *
 * Points, boundary and interpolation at the nodes are those of products of axes. The quadrature is
 * that of Gauss in each fine cell. Source: Hou and Wu 1997. */
#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multiscale/multiscale.h"
#include "field/space/interpolate.h"
#include "field/space/msfem.h"

typedef struct plane {
  dvi__multiscale functions;
  int points; /* Gauss points of a part along each axis */
  double place[DVI__MSFEM_POINTS_MOST];
} plane;

static void plane_destroy(void *own)
{
  plane *p = own;
  if (p == NULL) return;
  dvi__multiscale_clear(&p->functions);
  dvi__release(p);
}

/* Both axes share all options but the number of cells. */
static dvi_status check_values(const dvi_space *space)
{
  const dvi__line *line = space->line;
  for (int k = DVI__MSFEM_CELLS + 1; k < DVI__SPACE_KEYS; k++)
    if (line[0].value[k] != line[1].value[k])
      return dvi__fail(DVI_BAD_OPTION,
                       "space: msfem: %s=%d on axis %s, but %d on axis %s; take one for both",
                       line[0].kind->form.key[k].name, line[0].value[k], line[0].name,
                       line[1].value[k], line[1].name);
  return DVI_OK;
}

static dvi__multiscale_terms terms_of(const dvi_space_options *options, const dvi__line *line)
{
  const int *value = line[0].value, fine = value[DVI__MSFEM_FINE];
  const int overlap = value[DVI__MSFEM_OVERLAP];
  return (dvi__multiscale_terms){
      .node = {line[0].node, line[1].node},
      .cells = {(int)line[0].cells, (int)line[1].cells},
      .is_periodic = {line[0].periodic, line[1].periodic},
      .fine = fine,
      .edges = (dvi__edges)value[DVI__MSFEM_EDGES],
      .overlap = overlap != 0 ? overlap : (fine + 1) / 2,
      .threads = value[DVI__MSFEM_THREADS],
      .coefficient = {"space: msfem", 2, options->coefficient, options->user}};
}

static dvi_status plane_create(const dvi_space_options *options, dvi_space *space)
{
  DVI_TRY(check_values(space));
  const dvi__multiscale_terms terms = terms_of(options, space->line);
  DVI_TRY(dvi__multiscale_check_size(&terms));
  DVI_TRY(dvi__box.create(options, space));
  plane *p = space->own = DVI_NEW(plane, 1);
  double weight[DVI__MSFEM_POINTS_MOST];
  if (p == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  p->points = dvi__msfem_points(&space->line[0], 2);
  DVI_TRY(dvi_quadrature(DVI_GAUSS, p->points, p->place, weight));
  return dvi__multiscale_create(&terms, &p->functions);
}

static dvi_status plane_matrix(const dvi_space *space, const int *order, dvi__csr *made)
{
  const plane *p = space->own;
  const int64_t along = dvi__line_points(&space->line[1]);
  DVI_TRY(dvi__csr_allocate(space->points, space->functions, space->points * DVI__MULTISCALE_LOCALS,
                            made));
  for (int64_t i = 0; i < space->points; i++) {
    const int at[2] = {(int)(i / along), (int)(i % along)};
    const int part[2] = {at[0] / p->points, at[1] / p->points};
    const double place[2] = {p->place[at[0] % p->points], p->place[at[1] % p->points]};
    const int64_t start = made->start[i];
    made->start[i + 1] = start + dvi__multiscale_row(&p->functions, order, part, place,
                                                     made->column + start, made->value + start);
  }
  return DVI_OK;
}

static dvi_status plane_row(const dvi_space *space, const int *order, const double *x, int *column,
                            double *value, int64_t *count)
{
  const plane *p = space->own;
  int part[2];
  double place[2];
  *count = 0;
  for (int d = 0; d < 2; d++)
    if (!dvi__fine_axis_locate(&p->functions.axis[d], x[d], &part[d], &place[d])) return DVI_OK;
  *count = dvi__multiscale_row(&p->functions, order, part, place, column, value);
  return DVI_OK;
}

static void plane_explain(const dvi_space *space, dvi__note *note)
{
  const plane *p = space->own;
  const dvi__line *line = space->line;
  const int fine = line->value[DVI__MSFEM_FINE];
  dvi__note_add(note, "axes %s and %s: msfem, %lld x %lld cells: %lld functions, %s edges\n",
                line[0].name, line[1].name, (long long)line[0].cells, (long long)line[1].cells,
                (long long)space->functions, dvi__msfem_edges[line->value[DVI__MSFEM_EDGES]]);
  dvi__note_add(
      note,
      "%d x %d fine cells in each with %d x %d Gauss points, from whose centres the means "
      "of a and 1/a differ by %.1e from those of twice as many\n",
      fine, fine, p->points, p->points, p->functions.defect);
}

const dvi__domain dvi__msfem_plane = {
    .create = plane_create,
    .destroy = plane_destroy,
    .matrix = plane_matrix,
    .row = plane_row,
    .evaluate = dvi__evaluate_by_rows,
    .interpolate = dvi__box_interpolate,
    .explain = plane_explain,
};
