/* Fluxes through free parts of the boundary.
 *
 * They add g u - a u^2/2 to the action of the faces of cells there, with the quadrature of cells:
 *     sum over points of faces and points in time of  |face| dt/points (g u - a u^2/2). */
#include "core/status.h"
#include "field/multisymplectic/lattice.h"

/* ---- faces ---- */

/* Keep a point of a face of a cell. The corners of the face stand at `end` of an axis. */
static void keep_point(const dvi__lattice *lattice, const int *cell, int64_t first, int q, int axis,
                       int end, int64_t at, dvi__lattice_condition *kept)
{
  const int64_t number = first % lattice->cells, component = first / lattice->cells;
  double weight = 1;
  int k = 0;
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    const double *ends = a->node + cell[d], *value = a->rule.value[lattice->at[q][d]];
    kept->x[d * kept->count + at] = d == axis ? ends[end] : value[0] * ends[0] + value[1] * ends[1];
    if (d != axis) weight *= (ends[1] - ends[0]) / a->rule.count;
  }
  kept->weight[at] = weight;
  for (int c = 0; c < lattice->corners; c++) {
    double shape = 1;
    if ((c >> axis & 1) != end) continue;
    for (int d = 0; d < lattice->axes; d++)
      if (d != axis) shape *= lattice->axis[d].rule.value[lattice->at[q][d]][c >> d & 1];
    kept->shape[at * kept->corners + k] = shape;
    kept->place[at * kept->corners + k++] = (int)(component * lattice->vertices) +
                                            lattice->corner[number * lattice->corners + c];
  }
}

/* Take the points of a cell's faces, one each for those of the cell that are first on the axis. */
static int64_t take_cell(const dvi__lattice *lattice, const dvi_density_condition *given,
                         int64_t first, int64_t count, dvi__lattice_condition *kept)
{
  int cell[DVI_AXES_MAX];
  dvi__lattice_cell(lattice, first % lattice->cells, cell);
  for (int d = 0; d < lattice->axes; d++)
    for (int end = 0; end < 2 && !lattice->axis[d].is_periodic; end++) {
      if (cell[d] != end * (lattice->axis[d].cells - 1) ||
          !dvi__lattice_is_part(given->part, &lattice->axis[d], end))
        continue;
      for (int q = 0; q < lattice->points; q++) {
        if (lattice->at[q][d] != 0) continue;
        if (kept != NULL) keep_point(lattice, cell, first, q, d, end, count, kept);
        count++;
      }
    }
  return count;
}

int64_t dvi__lattice_take_faces(const dvi__lattice *lattice, const dvi_density_condition *given,
                                dvi__lattice_condition *kept)
{
  int64_t count = 0;
  for (int64_t i = 0; i < lattice->cells * lattice->components; i++)
    if (dvi__lattice_is_of(given, (int)(i / lattice->cells)))
      count = take_cell(lattice, given, i, count, kept);
  return count;
}

/* ---- rows ---- */

/* The value of the field at a point of a face. */
static double value_at(const dvi__lattice_condition *c, int64_t point, const double *level,
                       const dvi__row *row)
{
  double sum = 0;
  for (int k = 0; k < c->corners; k++) {
    const int64_t i = point * c->corners + k;
    sum += c->shape[i] * (level[0] * row->u[0][c->place[i]] + level[1] * row->u[1][c->place[i]]);
  }
  return sum;
}

static void add_force(const dvi__lattice_condition *c, int64_t point, double force,
                      const double *level, double *lower, double *upper)
{
  for (int k = 0; k < c->corners; k++) {
    const int64_t i = point * c->corners + k;
    lower[c->place[i]] += level[0] * force * c->shape[i];
    upper[c->place[i]] += level[1] * force * c->shape[i];
  }
}

dvi_status dvi__row_add_fluxes(const dvi__lattice *lattice, const dvi__row *row, double *lower,
                               double *upper)
{
  const dvi__two_points time = dvi__two_points_of(lattice->time_weight);
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    for (int k = 0; k < time.count && c->declared.kind != DVI_FIXED; k++) {
      const double *level = time.value[k];
      DVI_TRY(dvi__lattice_datum(c, row->t + level[1] * lattice->dt));
      for (int64_t p = 0; p < c->count; p++) {
        const double flux = c->datum[p] - c->declared.robin * value_at(c, p, level, row);
        add_force(c, p, lattice->dt / time.count * c->weight[p] * flux, level, lower, upper);
      }
    }
  }
  return DVI_OK;
}

void dvi__row_add_second_of_fluxes(const dvi__lattice *lattice, const dvi__row *v, double *lower,
                                   double *upper)
{
  const dvi__two_points time = dvi__two_points_of(lattice->time_weight);
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    for (int k = 0; k < time.count && c->declared.kind != DVI_FIXED; k++)
      for (int64_t p = 0; p < c->count; p++) {
        const double flux = -c->declared.robin * value_at(c, p, time.value[k], v);
        add_force(c, p, lattice->dt / time.count * c->weight[p] * flux, time.value[k], lower,
                  upper);
      }
  }
}

/* Add factor times a u^2/2 - g u of the points at a time. */
static dvi_status add_energy_at(const dvi__lattice *lattice, const dvi__row *row,
                                const double *level, double factor, double *energy)
{
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    if (c->declared.kind == DVI_FIXED) continue;
    DVI_TRY(dvi__lattice_datum(c, row->t + level[1] * lattice->dt));
    for (int64_t p = 0; p < c->count; p++) {
      const double u = value_at(c, p, level, row);
      *energy += factor * c->weight[p] * (c->declared.robin * u * u / 2 - c->datum[p] * u);
    }
  }
  return DVI_OK;
}

dvi_status dvi__row_add_energy_of_fluxes(const dvi__lattice *lattice, const dvi__row *row,
                                         double *energy)
{
  static const double middle[2] = {0.5, 0.5};
  const dvi__two_points time = dvi__two_points_of(lattice->time_weight);
  DVI_TRY(add_energy_at(lattice, row, middle, time.count > 1 ? 2 : 1, energy));
  for (int k = 0; k < time.count && time.count > 1; k++)
    DVI_TRY(add_energy_at(lattice, row, time.value[k], -1.0 / time.count, energy));
  return DVI_OK;
}

/* The sum over points in time of the products of both levels is the weight of time. */
void dvi__lattice_add_matrix_of_fluxes(const dvi__lattice *lattice, double *values)
{
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    const double factor = lattice->dt * lattice->time_weight * c->declared.robin;
    for (int64_t p = 0; p < c->count && factor != 0 && c->declared.kind != DVI_FIXED; p++)
      for (int j = 0; j < c->corners * c->corners; j++) {
        const int64_t row = p * c->corners + j / c->corners,
                      column = p * c->corners + j % c->corners;
        const int to = lattice->unknown[c->place[row]], of = lattice->unknown[c->place[column]];
        const double entry = factor * c->weight[p] * c->shape[row] * c->shape[column];
        if (to >= 0 && of >= 0 && entry != 0)
          values[dvi__pattern_find(&lattice->pattern, to, of)] += entry;
      }
  }
}

/* ---- cells ---- */

/* Return the corner of a cell at a vertex, or the number of corners. */
static int corner_at(const dvi__lattice *lattice, int64_t cell, int64_t vertex)
{
  int k = 0;
  while (k < lattice->corners && lattice->corner[cell * lattice->corners + k] != vertex) k++;
  return k;
}

/* Tell if all corners of a point's face are those of a cell. */
static int is_of_cell(const dvi__lattice *lattice, const dvi__lattice_condition *c, int64_t point,
                      int64_t cell)
{
  for (int k = 0; k < c->corners; k++) {
    const int64_t vertex = c->place[point * c->corners + k] % lattice->vertices;
    if (corner_at(lattice, cell, vertex) == lattice->corners) return 0;
  }
  return 1;
}

static void add_point_to_cell(const dvi__lattice *lattice, const dvi__lattice_condition *c,
                              int64_t point, int64_t cell, double *K)
{
  const int corners = lattice->corners, n = corners * lattice->components;
  int at[DVI__CORNERS];
  for (int k = 0; k < c->corners; k++) {
    const int64_t place = c->place[point * c->corners + k];
    at[k] = (int)(place / lattice->vertices) * corners +
            corner_at(lattice, cell, place % lattice->vertices);
    if (lattice->unknown[place] < 0) at[k] = -1;
  }
  for (int i = 0; i < c->corners; i++)
    for (int j = 0; j < c->corners; j++)
      if (at[i] >= 0 && at[j] >= 0)
        K[at[j] * n + at[i]] += c->declared.robin * c->weight[point] *
                                c->shape[point * c->corners + i] * c->shape[point * c->corners + j];
}

/* Points stand component by component, and each has those of cells in their order. */
void dvi__lattice_add_fluxes_of_cell(const dvi__lattice *lattice, int64_t cell, int64_t *taken,
                                     double *K)
{
  for (int i = 0; i < lattice->conditions; i++) {
    const dvi__lattice_condition *c = &lattice->condition[i];
    const int copies = c->declared.component < 0 ? lattice->components : 1;
    const int64_t count = c->count / copies;
    if (c->declared.kind == DVI_FIXED || !(c->declared.robin > 0)) continue;
    for (; taken[i] < count && is_of_cell(lattice, c, taken[i], cell); taken[i]++)
      for (int k = 0; k < copies; k++) add_point_to_cell(lattice, c, k * count + taken[i], cell, K);
  }
}
