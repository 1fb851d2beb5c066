/* The local laws of energy and momentum of the box scheme.
 *
 * Cells have a field, its rate and its derivatives in their middle, z. Around each vertex z obeys a
 * box scheme, too: A D_t z_t + .. where A takes means over all other axes. For a quadratic l with
 * constant coefficients the product rule D(a b) = A a D b + D a A b gives
 *     sum over axes n of D_n T_mn = 0,    T_mn = z_m l_{z_n} - (n = m) l,
 * with m for time or an axis, where T_mn is that of the mean of z over the other axes.
 * Source: Bridges and Reich 2001. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/laws.h"

enum { JETS = 2 + DVI_AXES_MAX }; /* the rate, derivatives along the axes, and last the value */

/* A place for the field and its derivatives, and the current of it. */
typedef struct site {
  double z[DVI_COMPONENTS_MAX][JETS];
  double T[1 + DVI_AXES_MAX]; /* of each m, through n */
} site;

int dvi__has_local_laws(const dvi__lattice *lattice)
{
  if (lattice->points > 1) return 0;
  for (int i = 0; i < lattice->parts; i++)
    if (lattice->part[i].time.count > 1) return 0;
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    const double width = (a->node[a->cells] - a->node[0]) / a->cells;
    for (int i = 0; i < a->cells; i++)
      if (fabs(a->node[i + 1] - a->node[i] - width) > 1e-10 * width) return 0;
  }
  return 1;
}

static double width_of(const dvi__lattice *lattice, int axis)
{
  return lattice->axis[axis].node[1] - lattice->axis[axis].node[0];
}

/* Add `weight` times the field and its derivatives in the middle of a cell of a row. */
static void add_cell(const dvi__history *h, int row, int64_t cell, double weight, site *s)
{
  const dvi__lattice *lattice = &h->march.lattice;
  const dvi__row levels = dvi__history_row(h, h->u, row);
  for (int c = 0; c < lattice->components; c++)
    for (int k = 0; k < lattice->corners; k++) {
      const int64_t i = c * lattice->vertices + lattice->corner[cell * lattice->corners + k];
      const double lower = levels.u[0][i], upper = levels.u[1][i], mean = (lower + upper) / 2;
      s->z[c][0] += weight * lattice->shape[0][0][k] * ((upper - lower) / lattice->dt);
      for (int d = 0; d < lattice->axes; d++)
        s->z[c][1 + d] += weight * lattice->shape[1 + d][0][k] * mean / width_of(lattice, d);
      s->z[c][JETS - 1] += weight * lattice->shape[0][0][k] * mean;
    }
}

static int jet_of(const dvi__lattice_variable *v)
{
  return v->is_rate ? 0 : v->axis >= 0 ? 1 + v->axis : JETS - 1;
}

/* Set the currents through axis n. Time is axis 0 here. */
static dvi_status find_currents(const dvi__history *h, double t, int64_t cell, int n, site *s)
{
  const dvi__lattice *lattice = &h->march.lattice;
  memset(s->T, 0, sizeof s->T);
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    dvi__batch b = dvi__batch_begin(lattice, part, cell, 1);
    b.t = t;
    for (int a = 0; a < part->variables; a++)
      b.z[a] = s->z[part->variable[a].component][jet_of(&part->variable[a])];
    DVI_TRY(dvi__batch_evaluate(&b, DVI__WANT_L | DVI__WANT_L_Z));
    s->T[n] -= b.l[0];
    for (int a = 0; a < part->variables; a++)
      for (int m = 0; m <= lattice->axes && jet_of(&part->variable[a]) == n; m++)
        s->T[m] += s->z[part->variable[a].component][m] * b.l_z[a];
  }
  return DVI_OK;
}

/* The mean over the cells around a vertex on one side of an axis. Corner bits are 1 for cells below
 * the vertex. */
static void find_mean(const dvi__history *h, int level, int64_t vertex, int axis, int above,
                      site *s)
{
  const dvi__lattice *lattice = &h->march.lattice;
  memset(s->z, 0, sizeof s->z);
  for (int time = 0; time < 2; time++)
    for (int k = 0; k < lattice->corners; k++) {
      const int is_above = axis == 0 ? time : !(k >> (axis - 1) & 1);
      if (is_above != above) continue;
      add_cell(h, level - 1 + time, dvi__lattice_cell_at(lattice, vertex, k),
               1.0 / lattice->corners, s);
    }
}

/* Add the error of the laws at a vertex, and the sizes of their terms. */
static dvi_status add_vertex(const dvi__history *h, int level, int64_t vertex, double *error,
                             double *size)
{
  const dvi__lattice *lattice = &h->march.lattice;
  const double t = h->t + level * lattice->dt;
  const int64_t cell = dvi__lattice_cell_at(lattice, vertex, 0);
  double sum[1 + DVI_AXES_MAX] = {0}, terms[1 + DVI_AXES_MAX] = {0};
  for (int n = 0; n <= lattice->axes; n++)
    for (int above = 0; above < 2; above++) {
      site s;
      find_mean(h, level, vertex, n, above, &s);
      DVI_TRY(find_currents(h, t, cell, n, &s));
      const double width = n == 0 ? lattice->dt : width_of(lattice, n - 1);
      for (int m = 0; m <= lattice->axes; m++) {
        sum[m] += (above ? 1 : -1) * s.T[m] / width;
        terms[m] += fabs(s.T[m]) / width;
      }
    }
  for (int m = 0; m <= lattice->axes; m++) {
    error[m] = fmax(error[m], fabs(sum[m]));
    size[m] = fmax(size[m], terms[m]);
  }
  return DVI_OK;
}

/* Tell if cells are on all sides of a vertex. */
static int is_free(const dvi__lattice *lattice, int64_t vertex)
{
  for (int k = 0; k < lattice->corners; k++)
    if (dvi__lattice_cell_at(lattice, vertex, k) < 0) return 0;
  return 1;
}

dvi_status dvi__local_laws(const dvi__history *h, double *error)
{
  const dvi__lattice *lattice = &h->march.lattice;
  double size[1 + DVI_AXES_MAX] = {0};
  memset(error, 0, sizeof size);
  for (int n = 1; n < h->steps; n++)
    for (int64_t v = 0; v < lattice->vertices; v++)
      if (is_free(lattice, v)) DVI_TRY(add_vertex(h, n, v, error, size));
  for (int m = 0; m <= lattice->axes; m++) error[m] /= size[m] > 0 ? size[m] : 1;
  return DVI_OK;
}
