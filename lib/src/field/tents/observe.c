/* Starts of tents, and what is seen of them. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/tents/front.h"

/* Give entry i of d_degree form. */
static double derivative(const dvi_mesh *mesh, int degree, const double *form, int64_t i)
{
  double sum = 0;
  for (int j = 0; j < degree + 2; j++) {
    const int64_t at = i * (degree + 2) + j;
    sum += mesh->sign[degree + 1][at] * form[mesh->facet[degree + 1][at]];
  }
  return sum;
}

/* Set charge = d_{k-1}^T row, and size to the sums of the sizes of its terms. Both are NaN where
 * something is held, whose row is not zero. */
static void find_charge(const dvi__tents *w, double *charge, double *size)
{
  const dvi_mesh *mesh = w->mesh;
  const int k = w->k;
  memset(charge, 0, (size_t)mesh->count[k - 1] * sizeof *charge);
  memset(size, 0, (size_t)mesh->count[k - 1] * sizeof *size);
  for (int64_t i = 0; i < mesh->count[k]; i++)
    for (int j = 0; j <= k; j++) {
      const int64_t at = i * (k + 1) + j;
      const double term = w->held[i] ? (double)NAN : mesh->sign[k][at] * w->front.row[i];
      charge[mesh->facet[k][at]] += term;
      size[mesh->facet[k][at]] += fabs(term);
    }
}

/* On a level front the row of a k-cell is M_k E. */
void dvi__tents_start(dvi__tents *w, const dvi_march_state *state)
{
  dvi__front *front = &w->front;
  const dvi_mesh *mesh = w->mesh;
  const double *mass = w->star->diagonal[w->k];
  for (int64_t v = 0; v < mesh->count[0]; v++) {
    front->time[v] = state->t;
    front->rises[v] = 0;
  }
  for (int64_t i = 0; i < mesh->count[w->k]; i++) {
    front->A[i] = state->A != NULL ? state->A[i] : 0;
    front->row[i] = state->E != NULL && !w->held[i] ? mass[i] * state->E[i] : 0;
  }
  for (int64_t i = 0; i < mesh->count[w->k + 1]; i++)
    w->base[i] = state->B != NULL ? state->B[i] - derivative(mesh, w->k, front->A, i) : 0;
  if (w->k > 0) find_charge(w, w->charge, w->charge + mesh->count[w->k - 1]);
  front->tents = 0;
  dvi__front_order(w, front);
  w->t = state->t;
  *w->level_time = (double)NAN;
}

/* ---- observe ---- */

/* Give one value of a form on the level front. */
static double value_of(const dvi__tents *w, dvi_march_form form, int64_t i)
{
  const dvi__front *front = w->level;
  if (form == DVI_FORM_A) return front->A[i];
  if (form == DVI_FORM_B) return w->base[i] + derivative(w->mesh, w->k, front->A, i);
  return w->held[i] ? 0 : front->row[i] / w->star->diagonal[w->k][i];
}

dvi_status dvi__tents_sample(const dvi__tents *w, dvi_march_form form, int64_t count,
                             const int *cell, double *values)
{
  DVI_TRY(dvi__tents_level(w));
  for (int64_t i = 0; i < count; i++) values[i] = value_of(w, form, cell != NULL ? cell[i] : i);
  return DVI_OK;
}

dvi_status dvi__tents_energy(const dvi__tents *w, double *energy)
{
  double sum = 0;
  DVI_TRY(dvi__tents_level(w));
  for (int64_t i = 0; i < w->mesh->count[w->k]; i++) {
    const double E = value_of(w, DVI_FORM_E, i);
    sum += 0.5 * w->star->diagonal[w->k][i] * E * E;
    if (w->force != NULL) sum -= w->force[i] * value_of(w, DVI_FORM_A, i);
  }
  for (int64_t i = 0; i < w->mesh->count[w->k + 1]; i++) {
    const double B = value_of(w, DVI_FORM_B, i);
    sum += 0.5 * w->star->diagonal[w->k + 1][i] * B * B;
  }
  *energy = sum;
  return DVI_OK;
}

double dvi__tents_force_energy(const dvi__tents *w)
{
  double sum = 0;
  for (int64_t i = 0; i < w->mesh->count[w->k] && w->force != NULL; i++)
    sum -= w->force[i] * w->level->A[i];
  return sum;
}

double dvi__tents_charge_error(const dvi__tents *w)
{
  double worst = 0, largest = 0;
  if (w->k == 0) return 0;
  const int64_t count = w->mesh->count[w->k - 1];
  double *now = w->charge + count, *size = now + count;
  find_charge(w, now, size);
  for (int64_t i = 0; i < count; i++) {
    if (isnan(now[i])) continue;
    worst = fmax(worst, fabs(now[i] - w->charge[i]));
    largest = fmax(largest, fabs(w->charge[i]) + size[i]);
  }
  return largest > 0 ? worst / largest : 0;
}
