/* A density at the points of some cells between two levels.
 *
 *     S = sum over cells, points in space and points in time of  |cell| dt/points  l(t, x, z)
 *
 * with the variables z of the multilinear function of the corners' values on both levels. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/lattice.h"
#include "num/finite.h"

/* ---- memory ---- */

int64_t dvi__batch_work(const dvi__lattice *lattice)
{
  int variables = 0, pairs = 0;
  for (int i = 0; i < lattice->parts; i++) {
    variables = variables > lattice->part[i].variables ? variables : lattice->part[i].variables;
    pairs = pairs > lattice->part[i].pairs ? pairs : lattice->part[i].pairs;
  }
  return (int64_t)DVI__BATCH * (2 + 2 * lattice->axes + 3 * variables + pairs);
}

/* Move to the next cell, the last axis first. */
static void next_cell(const dvi__lattice *lattice, int *index)
{
  int d = lattice->axes - 1;
  while (d > 0 && index[d] + 1 == lattice->axis[d].cells) index[d--] = 0;
  index[d]++;
}

/* Set the widths of a batch's cells, and the places and weights in space of their points. */
static void place_points(const dvi__batch *b)
{
  const dvi__lattice *lattice = b->lattice;
  int index[DVI_AXES_MAX];
  dvi__lattice_cell(lattice, b->cell, index);
  for (int c = 0, i = 0; c < b->cells; c++, next_cell(lattice, index)) {
    double volume = 1;
    for (int d = 0; d < lattice->axes; d++) {
      const double *ends = lattice->axis[d].node + index[d];
      b->width[d * b->cells + c] = ends[1] - ends[0];
      volume *= ends[1] - ends[0];
    }
    for (int q = 0; q < lattice->points; q++, i++) {
      b->weight[i] = volume / lattice->points;
      for (int d = 0; d < lattice->axes; d++) {
        const dvi__lattice_axis *a = &lattice->axis[d];
        const double *ends = a->node + index[d], *value = a->rule.value[lattice->at[q][d]];
        b->x[d * b->count + i] = value[0] * ends[0] + value[1] * ends[1];
      }
    }
  }
}

dvi__batch dvi__batch_begin(const dvi__lattice *lattice, const dvi__lattice_part *part,
                            int64_t cell, int most)
{
  const int64_t left = lattice->cells - cell;
  dvi__batch b = {.lattice = lattice, .part = part, .cell = cell};
  b.cells = left < most ? (int)left : most;
  b.count = b.cells * lattice->points;
  const size_t count = (size_t)b.count, variables = (size_t)part->variables;
  b.weight = lattice->work;
  b.l = b.weight + count;
  b.x = b.l + count;
  b.width = b.x + (size_t)lattice->axes * count;
  b.z = b.width + (size_t)lattice->axes * count;
  b.l_z = b.z + variables * count;
  b.more = b.l_z + variables * count;
  b.l_zz = b.more + variables * count;
  place_points(&b);
  return b;
}

/* ---- variables ---- */

/* The values of a variable at the corners of a cell, whose function gives the variable. */
static void corner_values(const dvi__batch *b, const dvi__row *row, const dvi__lattice_variable *v,
                          const int *corner, double *value)
{
  const dvi__lattice *lattice = b->lattice;
  const size_t first = (size_t)v->component * (size_t)lattice->vertices;
  const double *lower = row->u[0] + first, *upper = row->u[1] + first;
  for (int c = 0; c < lattice->corners; c++) {
    const int i = corner[c];
    if (v->is_rate && row->rate != NULL)
      value[c] = row->rate[first + (size_t)i];
    else if (v->is_rate)
      value[c] = (upper[i] - lower[i]) / lattice->dt;
    else
      value[c] = b->level[0] * lower[i] + b->level[1] * upper[i];
  }
}

double dvi__batch_width(const dvi__batch *b, const dvi__lattice_variable *v, int cell)
{
  return v->axis < 0 ? 1 : b->width[v->axis * b->cells + cell];
}

void dvi__batch_variables(const dvi__batch *b, const dvi__row *row, double *z)
{
  const dvi__lattice *lattice = b->lattice;
  for (int a = 0; a < b->part->variables; a++) {
    const dvi__lattice_variable *v = &b->part->variable[a];
    double *to = z + (size_t)a * (size_t)b->count;
    for (int c = 0; c < b->cells; c++, to += lattice->points) {
      double value[DVI__CORNERS];
      const int64_t cell = b->cell + c;
      const double width = dvi__batch_width(b, v, c);
      corner_values(b, row, v, lattice->corner + cell * lattice->corners, value);
      for (int q = 0; q < lattice->points; q++) {
        const double *shape = lattice->shape[1 + v->axis][q];
        double sum = 0;
        for (int k = 0; k < lattice->corners; k++) sum += shape[k] * value[k];
        to[q] = sum / width;
      }
    }
  }
}

void dvi__batch_add(const dvi__batch *b, const double *g, double *lower, double *upper)
{
  const dvi__lattice *lattice = b->lattice;
  for (int a = 0; a < b->part->variables; a++) {
    const dvi__lattice_variable *v = &b->part->variable[a];
    const size_t first = (size_t)v->component * (size_t)lattice->vertices;
    const double *from = g + (size_t)a * (size_t)b->count, *w = b->weight;
    const double down = b->duration * (v->is_rate ? -1 / lattice->dt : b->level[0]),
                 up = b->duration * (v->is_rate ? 1 / lattice->dt : b->level[1]);
    for (int c = 0; c < b->cells; c++, from += lattice->points, w += lattice->points) {
      const int64_t cell = b->cell + c;
      const int *corner = lattice->corner + cell * lattice->corners;
      const double width = dvi__batch_width(b, v, c);
      for (int k = 0; k < lattice->corners; k++) {
        double sum = 0;
        for (int q = 0; q < lattice->points; q++)
          sum += lattice->shape[1 + v->axis][q][k] * w[q] * from[q];
        lower[first + (size_t)corner[k]] += down * (sum / width);
        upper[first + (size_t)corner[k]] += up * (sum / width);
      }
    }
  }
}

void dvi__batch_second(const dvi__batch *b, const double *z, double *g)
{
  const size_t count = (size_t)b->count;
  memset(g, 0, (size_t)b->part->variables * count * sizeof *g);
  for (int p = 0; p < b->part->pairs; p++) {
    const size_t row = (size_t)b->part->pair[p][0] * count,
                 column = (size_t)b->part->pair[p][1] * count;
    const double *l_zz = b->l_zz + (size_t)p * count;
    for (size_t i = 0; i < count; i++) g[row + i] += l_zz[i] * z[column + i];
    for (size_t i = 0; i < count && row != column; i++) g[column + i] += l_zz[i] * z[row + i];
  }
}

/* ---- the density ---- */

/* Find the first number that is not finite, and name its point. */
static dvi_status check_finite(const dvi__batch *b, const char *name, size_t count, const double *x)
{
  const ptrdiff_t at = dvi__first_not_finite(count, x);
  if (at < 0) return DVI_OK;
  const ptrdiff_t point = at % b->count;
  const long long cell = b->cell + point / b->lattice->points;
  return dvi__fail(DVI_NOT_FINITE,
                   "multisymplectic: %s of the density %s is %g at t = %g, %s = %g in cell %lld",
                   name, b->part->name, x[at], b->t, b->lattice->axis[0].name, b->x[point], cell);
}

dvi_status dvi__batch_evaluate(const dvi__batch *b, int wants)
{
  const dvi_density_part *given = &b->part->declared;
  const size_t count = (size_t)b->count;
  double *l = wants & DVI__WANT_L ? b->l : NULL, *l_z = wants & DVI__WANT_L_Z ? b->l_z : NULL,
         *l_zz = wants & DVI__WANT_L_ZZ ? b->l_zz : NULL;
  const int failed = given->density(b->count, b->t, b->x, b->z, l, l_z, l_zz, given->user);
  if (failed != 0)
    return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                     "multisymplectic: the density %s failed with %d at t = %g", b->part->name,
                     failed, b->t);
  if (l != NULL) DVI_TRY(check_finite(b, "l", count, l));
  if (l_z != NULL) DVI_TRY(check_finite(b, "l_z", (size_t)b->part->variables * count, l_z));
  if (l_zz == NULL) return DVI_OK;
  return check_finite(b, "l_zz", (size_t)b->part->pairs * count, l_zz);
}
