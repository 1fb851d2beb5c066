/* The action of a row of cells between two levels, and its derivatives. */
#include <string.h>

#include "core/status.h"
#include "field/multisymplectic/lattice.h"

static void leave_out(const dvi__batch *b, const char *is_in)
{
  for (int c = 0; c < b->cells; c++)
    for (int q = 0; q < b->lattice->points && !is_in[b->cell + c]; q++)
      b->weight[c * b->lattice->points + q] = 0;
}

/* Visit all cells at a time of which both levels have a part. */
static dvi_status visit_at(const dvi__lattice *lattice, const dvi__row *row, dvi__batch *times,
                           int wants, dvi__batch_visitor *visit, void *of)
{
  for (int64_t cell = 0; cell < lattice->cells;) {
    dvi__batch b = dvi__batch_begin(lattice, times->part, cell, DVI__BATCH / lattice->points);
    b.level[0] = times->level[0], b.level[1] = times->level[1];
    b.t = times->t;
    b.duration = times->duration;
    if (row->is_in != NULL) leave_out(&b, row->is_in);
    dvi__batch_variables(&b, row, b.z);
    DVI_TRY(dvi__batch_evaluate(&b, wants));
    DVI_TRY(visit(of, &b));
    cell += b.cells;
  }
  return DVI_OK;
}

/* Tell if a part depends on both levels at a point in time. */
static int is_of_both(const dvi__lattice_part *part, const double *value)
{
  int has_rate = 0;
  for (int a = 0; a < part->variables; a++) has_rate |= part->variable[a].is_rate;
  return has_rate || (value[0] > 0 && value[1] > 0);
}

dvi_status dvi__row_visit(const dvi__lattice *lattice, const dvi__row *row, int wants,
                          dvi__batch_visitor *visit, void *of)
{
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    for (int k = 0; k < part->time.count; k++) {
      const double *value = part->time.value[k];
      dvi__batch times = {.part = part,
                          .t = row->t + value[1] * lattice->dt,
                          .level = {value[0], value[1]},
                          .duration = lattice->dt / part->time.count};
      if (!(wants & DVI__OF_BOTH_LEVELS) || is_of_both(part, value))
        DVI_TRY(visit_at(lattice, row, &times, wants, visit, of));
    }
  }
  return DVI_OK;
}

/* ---- derivatives ---- */

typedef struct sums {
  double *lower, *upper;
  const dvi__row *v;
} sums;

static void clear(const dvi__lattice *lattice, const sums *s)
{
  memset(s->lower, 0, (size_t)lattice->size * sizeof *s->lower);
  memset(s->upper, 0, (size_t)lattice->size * sizeof *s->upper);
}

static dvi_status add_first(void *of, const dvi__batch *b)
{
  const sums *s = of;
  dvi__batch_add(b, b->l_z, s->lower, s->upper);
  return DVI_OK;
}

static dvi_status add_second(void *of, const dvi__batch *b)
{
  const sums *s = of;
  dvi__batch_variables(b, s->v, b->z);
  dvi__batch_second(b, b->z, b->more);
  dvi__batch_add(b, b->more, s->lower, s->upper);
  return DVI_OK;
}

dvi_status dvi__row_gradient(const dvi__lattice *lattice, const dvi__row *row, double *lower,
                             double *upper)
{
  sums s = {lower, upper, NULL};
  clear(lattice, &s);
  DVI_TRY(dvi__row_visit(lattice, row, DVI__WANT_L_Z, add_first, &s));
  return dvi__row_add_fluxes(lattice, row, lower, upper);
}

dvi_status dvi__row_second(const dvi__lattice *lattice, const dvi__row *row, const dvi__row *v,
                           double *lower, double *upper)
{
  sums s = {lower, upper, v};
  clear(lattice, &s);
  dvi__row_add_second_of_fluxes(lattice, v, lower, upper);
  return dvi__row_visit(lattice, row, DVI__WANT_L_ZZ, add_second, &s);
}

/* ---- momenta ---- */

/* p = sum over points in space of l_{u_t} times the function of the vertex. */
static dvi_status add_momenta(void *of, const dvi__batch *b)
{
  const dvi__lattice *lattice = b->lattice;
  double *p = of;
  for (int a = 0; a < b->part->variables; a++) {
    const dvi__lattice_variable *v = &b->part->variable[a];
    const double *from = b->l_z + (size_t)a * (size_t)b->count, *w = b->weight;
    for (int c = 0; c < b->cells && v->is_rate; c++, from += lattice->points, w += lattice->points)
      for (int k = 0; k < lattice->corners; k++) {
        const int corner = lattice->corner[(b->cell + c) * lattice->corners + k];
        for (int q = 0; q < lattice->points; q++)
          p[(size_t)v->component * (size_t)lattice->vertices + (size_t)corner] +=
              lattice->shape[0][q][k] * w[q] * from[q];
      }
  }
  return DVI_OK;
}

dvi_status dvi__row_momenta(const dvi__lattice *lattice, const dvi__row *row, double *p)
{
  memset(p, 0, (size_t)lattice->size * sizeof *p);
  for (int i = 0; i < lattice->parts; i++) {
    dvi__batch times = {.part = &lattice->part[i], .t = row->t, .level = {1, 0}};
    DVI_TRY(visit_at(lattice, row, &times, DVI__WANT_L_Z, add_momenta, p));
  }
  return DVI_OK;
}

/* ---- energy ---- */

typedef struct energy {
  double sum, factor;
} energy;

/* e = u_t l_{u_t} - l */
static dvi_status add_energy(void *of, const dvi__batch *b)
{
  energy *e = of;
  for (int i = 0; i < b->count; i++) {
    double density = -b->l[i];
    for (int a = 0; a < b->part->variables; a++) {
      const size_t at = (size_t)a * (size_t)b->count + (size_t)i;
      if (b->part->variable[a].is_rate) density += b->z[at] * b->l_z[at];
    }
    e->sum += e->factor * b->weight[i] * density;
  }
  return DVI_OK;
}

/* Of a quadratic e, with the levels m -+ D/2, the values at the points in time are m -+ s D/2. What
 * the steps conserve is e at m less s^2/4 times e of D, and the mean over the points is e at m plus
 * that. */
dvi_status dvi__row_energy(const dvi__lattice *lattice, const dvi__row *row, double *found)
{
  energy e = {0, 0};
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    dvi__batch times = {.part = part, .t = row->t + lattice->dt / 2, .level = {0.5, 0.5}};
    e.factor = part->time.count > 1 ? 2 : 1;
    DVI_TRY(visit_at(lattice, row, &times, DVI__WANT_L | DVI__WANT_L_Z, add_energy, &e));
    for (int k = 0; k < part->time.count && part->time.count > 1; k++) {
      const double *value = part->time.value[k];
      times.t = row->t + value[1] * lattice->dt;
      times.level[0] = value[0], times.level[1] = value[1];
      e.factor = -1.0 / part->time.count;
      DVI_TRY(visit_at(lattice, row, &times, DVI__WANT_L | DVI__WANT_L_Z, add_energy, &e));
    }
  }
  DVI_TRY(dvi__row_add_energy_of_fluxes(lattice, row, &e.sum));
  *found = e.sum;
  return DVI_OK;
}
