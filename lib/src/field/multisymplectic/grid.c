/* Axes, cells and vertices of a lattice, and the functions of a cell's corners. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/lattice.h"

static const int most_cells = 1 << 24;

/* ---- axes ---- */

/* The points of a weight a: at (1 +- sqrt(1 - 4 a))/2, where the mean of the products of the
 * straight functions is 1/2 - a and a. Both are one point if a = 1/4. */
dvi__two_points dvi__two_points_of(double weight)
{
  const double distance = sqrt(1 - 4 * weight), near = (1 + distance) / 2, far = (1 - distance) / 2;
  return (dvi__two_points){.count = distance > 0 ? 2 : 1, .value = {{near, far}, {far, near}}};
}

static dvi_status check_axis(const dvi_axis *given, const dvi__lattice_axis *a)
{
  const int is_even = given->node == NULL;
  if (a->cells < 2 || a->cells > most_cells)
    return dvi__fail(DVI_BAD_SIZE, "multisymplectic: axis %s has %d cells; 2 to %d are possible",
                     a->name, a->cells, most_cells);
  if (!isfinite(given->from) || !isfinite(given->to) || !(given->from < given->to))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: axis %s goes from %g to %g; finite ends in ascending order "
                     "are needed",
                     a->name, given->from, given->to);
  for (int i = 0; i < a->cells && !is_even; i++)
    if (!isfinite(given->node[i + 1]) || !(given->node[i] < given->node[i + 1]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "multisymplectic: axis %s has the nodes %g and %g; they "
                       "ascend",
                       a->name, given->node[i], given->node[i + 1]);
  if (!is_even && (given->node[0] != given->from || given->node[a->cells] != given->to))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: the nodes of axis %s go from %g to %g, and the axis from %g "
                     "to %g",
                     a->name, given->node[0], given->node[a->cells], given->from, given->to);
  return DVI_OK;
}

dvi_status dvi__check_weight(double weight, const char *axis)
{
  if (weight >= 0 && weight <= 0.25) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "multisymplectic: the weight of %s is %g; 0 (trapezoidal rule) to 1/4 "
                   "(midpoint) are possible",
                   axis, weight);
}

static dvi_status make_axis(const dvi_multisymplectic_terms *terms, int d, dvi__lattice_axis *a)
{
  static const char *const usual[] = {"x", "y", "z"};
  static const char *const sides[][2] = {{"left", "right"}, {"bottom", "top"}, {"back", "front"}};
  const dvi_axis *given = &terms->axis[d];
  const int has_nodes = given->node != NULL || given->nodes != 0;
  const char *name = given->name != NULL ? given->name : usual[d];
  if (name[0] == '\0' || strlen(name) >= sizeof a->name)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: the name of axis %d has %zu letters; 1 to %zu are possible",
                     d, strlen(name), sizeof a->name - 1);
  snprintf(a->name, sizeof a->name, "%s", name);
  snprintf(a->momentum, sizeof a->momentum, "momentum_%s", name);
  if (has_nodes && given->node == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: the nodes of axis %s are missing",
                     a->name);
  a->cells = has_nodes ? given->nodes - 1 : terms->cells[d];
  DVI_TRY(check_axis(given, a));
  DVI_TRY(dvi__check_weight(terms->weights.space[d], a->name));
  for (int end = 0; end < 2; end++) a->side[end] = sides[d][end];
  a->is_periodic = given->periodic != 0;
  a->vertices = a->cells + !a->is_periodic;
  a->weight = terms->weights.space[d];
  a->rule = dvi__two_points_of(a->weight);
  a->node = DVI_NEW(double, a->cells + 1);
  if (a->node == NULL) return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for nodes");
  for (int i = 0; i <= a->cells; i++)
    a->node[i] = has_nodes ? given->node[i]
                           : given->from + (given->to - given->from) * ((double)i / a->cells);
  return DVI_OK;
}

dvi_status dvi__lattice_make_axes(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice)
{
  if (terms == NULL || terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, terms == NULL ? "multisymplectic: terms are needed"
                                                     : "multisymplectic: set terms.size to "
                                                       "sizeof(dvi_multisymplectic_terms)");
  if (terms->axes < 1 || terms->axes > DVI_AXES_MAX || terms->axis == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: %d axes; 1 to %d are possible",
                     terms->axis != NULL ? terms->axes : 0, DVI_AXES_MAX);
  if (terms->components < 1 || terms->components > DVI_COMPONENTS_MAX)
    return dvi__fail(DVI_BAD_SIZE, "multisymplectic: %d components; 1 to %d are possible",
                     terms->components, DVI_COMPONENTS_MAX);
  if (terms->weights.axes != 0 && terms->weights.axes != terms->axes)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: the method has weights of %d axes, and the field has %d; "
                     "give one weight for all axes, or one for each",
                     terms->weights.axes, terms->axes);
  lattice->axes = terms->axes;
  lattice->components = terms->components;
  lattice->corners = 1 << terms->axes;
  lattice->cells = lattice->vertices = lattice->points = 1;
  for (int d = 0; d < terms->axes; d++) {
    dvi__lattice_axis *a = &lattice->axis[d];
    DVI_TRY(make_axis(terms, d, a));
    lattice->cells *= a->cells;
    lattice->vertices *= a->vertices;
    lattice->points *= a->rule.count;
    if (lattice->vertices * terms->components > INT_MAX / DVI__CORNERS)
      return dvi__fail(DVI_BAD_SIZE,
                       "multisymplectic: there are too many vertices; take fewer cells");
  }
  lattice->size = lattice->vertices * terms->components;
  return DVI_OK;
}

/* ---- numbers ---- */

static void split(const dvi__lattice *lattice, int64_t number, int of_cells, int *index)
{
  for (int d = lattice->axes - 1; d >= 0; d--) {
    const int count = of_cells ? lattice->axis[d].cells : lattice->axis[d].vertices;
    index[d] = (int)(number % count);
    number /= count;
  }
}

void dvi__lattice_cell(const dvi__lattice *lattice, int64_t cell, int *index)
{
  split(lattice, cell, 1, index);
}

void dvi__lattice_vertex_index(const dvi__lattice *lattice, int64_t vertex, int *index)
{
  split(lattice, vertex, 0, index);
}

void dvi__lattice_vertex(const dvi__lattice *lattice, int64_t vertex, double *x)
{
  int index[DVI_AXES_MAX];
  split(lattice, vertex, 0, index);
  for (int d = 0; d < lattice->axes; d++) x[d] = lattice->axis[d].node[index[d]];
}

int64_t dvi__lattice_cell_at(const dvi__lattice *lattice, int64_t vertex, int corner)
{
  int index[DVI_AXES_MAX];
  int64_t cell = 0;
  split(lattice, vertex, 0, index);
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    int i = index[d] - (corner >> d & 1);
    if (i < 0 && a->is_periodic) i += a->cells;
    if (i < 0 || i >= a->cells) return -1;
    cell = cell * a->cells + i;
  }
  return cell;
}

int64_t dvi_multisymplectic_vertices(const dvi_multisymplectic_terms *terms, double *x)
{
  dvi__lattice lattice = {0};
  int64_t vertices = 0;
  if (dvi__lattice_make_axes(terms, &lattice) == DVI_OK) vertices = lattice.vertices;
  for (int64_t v = 0; v < vertices && x != NULL; v++) {
    double place[DVI_AXES_MAX];
    dvi__lattice_vertex(&lattice, v, place);
    for (int d = 0; d < lattice.axes; d++) x[d * vertices + v] = place[d];
  }
  dvi__lattice_clear(&lattice);
  return vertices;
}

/* ---- cells ---- */

static int number_corner(const dvi__lattice *lattice, const int *cell, int corner)
{
  int vertex = 0;
  for (int d = 0; d < lattice->axes; d++) {
    const int count = lattice->axis[d].vertices, i = cell[d] + (corner >> d & 1);
    vertex = vertex * count + (i < count ? i : i - count);
  }
  return vertex;
}

/* The product of the axes' functions at a point, or of differences on one of the axes. */
static double corner_function(const dvi__lattice *lattice, int point, int corner, int difference)
{
  double product = 1;
  for (int d = 0; d < lattice->axes; d++) {
    const int end = corner >> d & 1;
    product *= d == difference ? 2 * end - 1
                               : lattice->axis[d].rule.value[lattice->at[point][d]][end];
  }
  return product;
}

static void make_shapes(dvi__lattice *lattice)
{
  for (int q = 0; q < lattice->points; q++) {
    for (int d = 0, rest = q; d < lattice->axes; d++) {
      lattice->at[q][d] = rest % lattice->axis[d].rule.count;
      rest /= lattice->axis[d].rule.count;
    }
    for (int c = 0; c < lattice->corners; c++)
      for (int d = -1; d < lattice->axes; d++)
        lattice->shape[1 + d][q][c] = corner_function(lattice, q, c, d);
  }
}

dvi_status dvi__lattice_make_cells(dvi__lattice *lattice)
{
  lattice->corner = DVI_NEW(int, (size_t)lattice->cells *(size_t)lattice->corners);
  if (lattice->corner == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for %lld cells",
                     (long long)lattice->cells);
  for (int64_t cell = 0; cell < lattice->cells; cell++) {
    int index[DVI_AXES_MAX];
    dvi__lattice_cell(lattice, cell, index);
    for (int c = 0; c < lattice->corners; c++)
      lattice->corner[cell * lattice->corners + c] = number_corner(lattice, index, c);
  }
  make_shapes(lattice);
  return DVI_OK;
}
