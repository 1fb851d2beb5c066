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

/* Set d_{k-1}^T row, to NaN where something is held, whose row is not zero. */
static void find_charge(const dvi__tents *w, const double *row, double *charge)
{
  const dvi_mesh *mesh = w->mesh;
  const int k = w->k;
  memset(charge, 0, (size_t)mesh->count[k - 1] * sizeof *charge);
  for (int64_t i = 0; i < mesh->count[k]; i++)
    for (int j = 0; j <= k; j++) {
      const int64_t at = i * (k + 1) + j;
      charge[mesh->facet[k][at]] += w->held[i] ? (double)NAN : mesh->sign[k][at] * row[i];
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
  if (w->charge != NULL) find_charge(w, front->row, w->charge);
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
  }
  for (int64_t i = 0; i < w->mesh->count[w->k + 1]; i++) {
    const double B = value_of(w, DVI_FORM_B, i);
    sum += 0.5 * w->star->diagonal[w->k + 1][i] * B * B;
  }
  *energy = sum;
  return DVI_OK;
}

double dvi__tents_gauss(const dvi__tents *w)
{
  double most = 0;
  if (w->charge == NULL) return 0;
  const int64_t count = w->mesh->count[w->k - 1];
  double *now = w->charge + count;
  find_charge(w, w->front.row, now);
  for (int64_t i = 0; i < count; i++)
    if (!isnan(now[i])) most = fmax(most, fabs(now[i] - w->charge[i]));
  return most;
}
