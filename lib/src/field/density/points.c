/* The points of a part of a sparse field, in an order that suits the coordinates.
 *
 * Where the nodes are the points and a part has no derivatives in space, an end of several cells is
 * as many points with the same values. They become one, with the sum of their weights. Points stand
 * in the order of their first coordinates, so that neighbours on a circle, whose coordinates are
 * numbered from both ends, are near each other here, too. */
#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

/* Return the first coordinate that a row of the operators depends on, or -1. */
static int first_coordinate(const dvi_density *density, const dvi__density_part *part, int64_t row)
{
  int first = -1;
  for (int a = 0; a < part->given.variables; a++) {
    const dvi__csr *B = dvi__part_operator(part, a);
    const int *number = density->number + part->given.variable[a].component * density->functions;
    for (int64_t e = B->start[row]; e < B->start[row + 1]; e++) {
      const int i = number[B->column[e]];
      if (i >= 0 && B->value[e] != 0 && (first < 0 || i < first)) first = i;
    }
  }
  return first;
}

/* Sort the rows by their first coordinates. Rows without one come first. `first` [rows] and start
 * [unknowns+2], zeros, are for work. */
static void sort_rows(const dvi_density *density, const dvi__density_part *part, int *first,
                      int64_t *start, int64_t *row)
{
  for (int64_t k = 0; k < part->points; k++) {
    first[k] = first_coordinate(density, part, k);
    start[first[k] + 2]++;
  }
  for (int64_t i = 1; i <= density->unknowns + 1; i++) start[i] += start[i - 1];
  for (int64_t k = 0; k < part->points; k++) row[start[first[k] + 1]++] = k;
}

static int is_sorted(int64_t count, const int64_t *row)
{
  for (int64_t k = 0; k < count; k++)
    if (row[k] != k) return 0;
  return 1;
}

/* Tell if the variables are values at nodes that are points. */
static int is_pointwise(const dvi_density *density, const dvi__density_part *part)
{
  for (int a = 0; a < part->given.variables; a++)
    for (int d = 0; d < density->dimension; d++)
      if (part->given.variable[a].order[d] != 0) return 0;
  return dvi__space_is_nodal(density->space);
}

/* Tell if two rows are at the same point of the same function. */
static int is_same(const dvi_density *density, const dvi__density_part *part, int64_t one,
                   int64_t other)
{
  const dvi__csr *B = dvi__part_operator(part, 0);
  for (int d = 0; d < density->dimension; d++)
    if (part->x[d * part->points + one] != part->x[d * part->points + other]) return 0;
  return B->column[B->start[one]] == B->column[B->start[other]];
}

/* Keep one row of each point, and add the weights. Returns the number of points. */
static int64_t merge_rows(const dvi_density *density, const dvi__density_part *part, int64_t *row,
                          double *weight)
{
  const int can_merge = is_pointwise(density, part);
  int64_t count = 0;
  for (int64_t k = 0; k < part->points; k++) {
    const double own = part->weight[row[k]];
    if (can_merge && count > 0 && is_same(density, part, row[count - 1], row[k])) {
      weight[count - 1] += own;
    } else {
      weight[count] = own;
      row[count++] = row[k];
    }
  }
  return count;
}

/* Let the part have these points, with copies of their weights. */
static dvi_status take_points(const dvi_density *density, dvi__density_part *part,
                              const int64_t *row, int64_t count, const double *weight)
{
  const int dimension = density->dimension;
  part->own = DVI_NEW(double, (dimension + 1) * count);
  if (part->own == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for points");
  double *own_weight = part->own + dimension * count;
  for (int d = 0; d < dimension; d++)
    for (int64_t k = 0; k < count; k++)
      part->own[d * count + k] = part->x[d * part->points + row[k]];
  for (int64_t k = 0; k < count; k++) own_weight[k] = weight[k];
  part->x = part->own;
  part->weight = own_weight;
  part->points = count;
  return DVI_OK;
}

/* Sort and merge. `row` [points] gets the rows, and `differs` tells if they are not 0, 1, 2, .. */
static dvi_status sort_and_merge(const dvi_density *density, dvi__density_part *part, int64_t *row,
                                 int *differs)
{
  const int64_t points = part->points;
  int *first = DVI_NEW(int, points);
  int64_t *start = DVI_NEW(int64_t, density->unknowns + 2);
  double *weight = DVI_NEW(double, points);
  dvi_status status = DVI_OK;
  if (first == NULL || start == NULL || weight == NULL) {
    status = dvi__fail(DVI_NO_MEMORY, "density: no memory for points");
  } else {
    sort_rows(density, part, first, start, row);
    const int64_t count = merge_rows(density, part, row, weight);
    *differs = count < points || !is_sorted(points, row);
    if (*differs) status = take_points(density, part, row, count, weight);
  }
  dvi__release(first);
  dvi__release(start);
  dvi__release(weight);
  return status;
}

dvi_status dvi__density_order_points(const dvi_density *density, dvi__density_part *part,
                                     int64_t **row)
{
  *row = NULL;
  if (part->trace.rows > 0) return DVI_OK;
  dvi__release(part->own);
  part->own = NULL;
  part->points = dvi_space_points(density->space, &part->x, &part->weight);
  if (!dvi__density_is_circle(density) && !is_pointwise(density, part)) return DVI_OK;
  int64_t *made = DVI_NEW(int64_t, part->points);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for points");
  int differs = 0;
  const dvi_status status = sort_and_merge(density, part, made, &differs);
  if (differs)
    *row = made;
  else
    dvi__release(made);
  return status;
}
