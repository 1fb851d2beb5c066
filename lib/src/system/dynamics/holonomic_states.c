/* States on constraints: their check, their roundings, and the projection of a state.
 *
 * A momentum is moved along G^T until its velocity fulfils G v + g = 0, and a place along M^-1 G^T
 * until phi = 0, without crossing nonholonomic constraints, A dq = 0. Both use the matrix of the
 * equations of motion (holonomic.c). */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "system/dynamics/holonomic.h"
#include "system/dynamics/holonomic_rows.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/factor.h"
#include "system/term/holonomic.h"

/* A start computed in another way differs by its roundings. A larger violation is refused. */
static const double on_constraint = 1e-11;

/* A velocity is found from all momenta together, and a component that is 0 has roundings of the
 * largest. */
static const double of_velocity = 0x1p-48;

/* Return the largest fourth difference among samples of one row. */
static double largest_fourth_difference(const double *f)
{
  double largest = 0;
  for (int k = 0; k + 4 < DVI__NOISE_SAMPLES; k++, f++)
    largest = fmax(largest, fabs(f[0] - 4 * f[1] + 6 * f[2] - 4 * f[3] + f[4]));
  return largest;
}

/* Sample phi along a line through q. */
static dvi_status sample_rows(dvi__evaluator *e, double t, const double *q, double distance)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double times[DVI__NOISE_SAMPLES];
  for (int k = 0; k < DVI__NOISE_SAMPLES; k++) {
    const int from_middle = k - DVI__NOISE_SAMPLES / 2;
    const double along = from_middle * distance;
    times[k] = t;
    for (int i = 0; i < e->system->n; i++)
      r->line[i * DVI__NOISE_SAMPLES + k] = q[i] + (i % 2 ? -0.75 : 1) * along;
  }
  return dvi__rows_values(e, DVI__NOISE_SAMPLES, times, r->line, r->samples);
}

/* The summands of phi are not known, and may be larger than its gradient and q tell. Fourth
 * differences over a short distance show nothing but roundings, also those of the arguments of
 * functions in phi. The distance grows until all rows show some.
 * Source: More and Wild 2011, "Estimating computational noise". */
void dvi__rows_noise(dvi__evaluator *e, double t, const double *q, double *noise)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int m = e->system->row_count;
  const double size = fmax(dvi__largest((size_t)e->system->n, q), 0x1p-100), near = 0x1p-24 * size,
               most = 0x1p-20 * fmax(size, 1);
  int missing = e->system->place_rows;
  memset(noise, 0, (size_t)m * sizeof *noise);
  for (double d = 0x1p-40 * size; d <= near || (d <= most && missing > 0); d *= 256) {
    if (sample_rows(e, t, q, d) != DVI_OK) return;
    for (int a = 0; a < e->system->place_rows; a++) {
      if (noise[a] > 0 && d > near) continue;
      missing -= noise[a] == 0;
      noise[a] = fmax(noise[a], largest_fourth_difference(r->samples + a * DVI__NOISE_SAMPLES));
      missing += noise[a] == 0;
    }
  }
}

/* Find the name of the constraint to which a row belongs, its first row, their count, and their
 * names or NULL. */
static const char *name_of_row(const dvi_system *s, int a, int *first, int *count,
                               const char *const **names)
{
  const int velocities = a >= s->place_rows;
  int k = (velocities ? s->nonholonomic_count : s->holonomic_count) - 1;
  if (velocities)
    while (s->nonholonomics[k].first > a) k--;
  else
    while (s->holonomics[k].first > a) k--;
  *names = velocities ? NULL : (const char *const *)s->holonomics[k].row_names;
  *first = velocities ? s->nonholonomics[k].first : s->holonomics[k].first;
  *count = velocities ? s->nonholonomics[k].callbacks.count : s->holonomics[k].callbacks.count;
  return velocities ? s->nonholonomics[k].name : s->holonomics[k].name;
}

/* Sum the magnitudes of a row of G x. */
static double row_size(const dvi_system *s, const double *phi_q, int a, const double *x)
{
  double size = 0;
  for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
    size += fabs(phi_q[k] * x[s->rows_q.row[k]]);
  return size;
}

/* Sum the magnitudes of a row of G q, of which some numbers count as 1. */
static double place_size(const dvi_system *s, const dvi__rows_memory *r, int a, const double *q)
{
  double size = 0;
  for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++) {
    const int i = s->rows_q.row[k];
    size += fabs(r->phi_q[k]) * fmax(fabs(q[i]), r->unit[i]);
  }
  return size;
}

static double gradient_size(const dvi_system *s, const double *phi_q, int a)
{
  double size = 0;
  for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++) size += fabs(phi_q[k]);
  return size;
}

/* Compute the rate v [n] of a state's q, and G v + g of all rows. */
static dvi_status velocity_rows(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *v, double *rate)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *found = e->system->dynamics->on_manifold ? r->sum : v;
  memset(found, 0, (size_t)e->system->n * sizeof(double));
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, found));
  if (found != v) dvi__factors_rate(e->system, q, found, v);
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  DVI_TRY(dvi__rows_rate(e, t, q, r->phi_t));
  dvi__rows_push(e->system, r->phi_q, v, r->phi_t, rate);
  return DVI_OK;
}

static dvi_status place_distance(dvi__evaluator *e, double t, const double *q, double *distance)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  DVI_TRY(dvi__rows_value(e, t, q, r->phi));
  *distance = dvi__largest((size_t)e->system->row_count, r->phi);
  return DVI_OK;
}

/* phi counts, and A v + a. The rates of holonomic constraints do not. */
dvi_status dvi__rows_distance(dvi__evaluator *e, double t, const double *q, const double *p,
                              double *distance)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *v = r->along[0], *rate = r->along[1];
  DVI_TRY(place_distance(e, t, q, distance));
  if (s->nonholonomic_count == 0) return DVI_OK;
  DVI_TRY(velocity_rows(e, t, q, p, v, rate));
  for (int a = s->place_rows; a < s->row_count; a++) *distance = fmax(*distance, fabs(rate[a]));
  return DVI_OK;
}

dvi_status dvi__rows_size(dvi__evaluator *e, double t, const double *q, const double *p,
                          double *size)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *v = r->along[0];
  *size = 0;
  DVI_TRY(s->nonholonomic_count > 0 ? velocity_rows(e, t, q, p, v, r->along[1])
                                    : dvi__rows_gradients(e, t, q, r->phi_q));
  for (int a = 0; a < s->row_count; a++)
    *size = fmax(*size, a < s->place_rows ? place_size(s, r, a, q)
                                          : row_size(s, r->phi_q, a, v) + fabs(r->phi_t[a]));
  return DVI_OK;
}

const char *dvi__rows_label(const dvi_system *s, int a, char label[DVI__ROW_LABEL])
{
  int first, count;
  const char *const *names;
  const char *name = name_of_row(s, a, &first, &count, &names);
  if (names != NULL) name = names[a - first];
  const int length = snprintf(label, DVI__ROW_LABEL, "'%.60s'", name);
  if (count > 1 && names == NULL)
    (void)snprintf(label + length, DVI__ROW_LABEL - (size_t)length, " (row %d)", a - first);
  return label;
}

static dvi_status refuse_row(const dvi_system *s, int a, double t, const char *what, double value)
{
  char label[DVI__ROW_LABEL];
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "constraint %s%s is %.17g at t = %.6g, not 0; start on the constraint, or "
                   "let the start be projected (dvi_start_options)",
                   dvi__rows_label(s, a, label), what, value, t);
}

dvi_status dvi__rows_check_place(dvi__evaluator *e, double t, const double *q)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *noise = r->along[1];
  int known = 0;
  DVI_TRY(dvi__rows_value(e, t, q, r->phi));
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  for (int a = 0; a < s->row_count; a++) {
    const double size = fabs(r->phi[a]);
    if (size <= on_constraint * place_size(s, r, a, q)) continue;
    if (!known++) dvi__rows_noise(e, t, q, noise);
    if (!(size <= noise[a])) return refuse_row(s, a, t, "", r->phi[a]);
  }
  return DVI_OK;
}

/* Find how far roundings of q move the rates. Far from the origin they are larger than the row
 * itself tells. */
static dvi_status rates_noise(dvi__evaluator *e, double t, const double *q, const double *p,
                              const double *rate, double *noise)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *v = r->derivative, *moved = r->before;
  memset(noise, 0, (size_t)s->row_count * sizeof *noise);
  for (int alike = 0; alike < 2; alike++) {
    for (int i = 0; i < s->n; i++)
      r->point[i] = q[i] * (1 + (alike || i % 2 ? 4 : -4) * DBL_EPSILON);
    DVI_TRY(velocity_rows(e, t, r->point, p, v, moved));
    for (int a = 0; a < s->row_count; a++) noise[a] = fmax(noise[a], fabs(moved[a] - rate[a]));
  }
  return DVI_OK;
}

dvi_status dvi__rows_check(dvi__evaluator *e, double t, const double *q, const double *p)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *v = r->along[0], *rate = r->along[1], *noise = r->defect;
  int known = 0;
  DVI_TRY(dvi__rows_check_place(e, t, q));
  DVI_TRY(velocity_rows(e, t, q, p, v, rate));
  const double speed = dvi__largest((size_t)s->n, v);
  for (int a = 0; a < s->row_count; a++) {
    const double size = row_size(s, r->phi_q, a, v) + fabs(r->phi_t[a]),
                 rounding = of_velocity * speed * gradient_size(s, r->phi_q, a);
    if (fabs(rate[a]) <= fmax(on_constraint * size, rounding)) continue;
    if (!known++) DVI_TRY(rates_noise(e, t, q, p, rate, noise));
    if (!(fabs(rate[a]) <= noise[a]))
      return refuse_row(
          s, a, t, a < s->place_rows ? ", its rate along the velocity," : ", A v + a,", rate[a]);
  }
  return DVI_OK;
}

/* Tell whether the momentum that is left in r->x is a rounding of its summands p, L_v in r->sum,
 * and G^T mu, and the rates behind it are no more than such roundings make of them. */
static int momentum_is_rounding(const dvi_system *s, const dvi__rows_memory *r, const double *p,
                                const double *mu)
{
  for (int i = 0; i < s->n; i++) r->sum[i] = fabs(r->sum[i]) + fabs(p[i]);
  for (int a = 0; a < s->row_count; a++)
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
      r->sum[s->rows_q.row[k]] += fabs(mu[a] * r->phi_q[k]);
  for (int i = 0; i < s->n; i++) {
    if (!(fabs(r->x[i]) <= 4 * DBL_EPSILON * r->sum[i])) return 0;
    const double mass = r->diagonal[i] >= 0 ? fabs(r->values[r->mass_place[r->diagonal[i]]]) : 1;
    r->sum[i] /= mass > 0 ? mass : 1;
  }
  for (int a = 0; a < s->row_count; a++)
    if (!(fabs(r->x[s->n + a]) <= 16 * DBL_EPSILON * row_size(s, r->phi_q, a, r->sum))) return 0;
  return 1;
}

/* Solve L_v(v) + G^T mu = p, G v + g = 0 by Newton's method. One iteration is exact for a
 * constant mass and independent rows, and a second one rounds its residual off. A velocity that is
 * 0 has no size of its own, so that then the momentum tells what a rounding is. */
dvi_status dvi__rows_project_momentum(dvi__evaluator *e, double t, const double *q, double *p,
                                      double *v)
{
  enum { MOST_ITERATIONS = 50 };
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int n = s->n, m = s->row_count, linear = s->lagrangian == NULL;
  double *mu = r->along[1], size = HUGE_VAL;
  memset(mu, 0, (size_t)m * sizeof(double));
  if (linear) memset(v, 0, (size_t)n * sizeof(double));
  DVI_TRY(dvi__rows_rate(e, t, q, r->phi_t));
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, NULL, r->along[0]));
    memcpy(r->sum, r->along[0], (size_t)n * sizeof(double));
    if (iteration == 0 || !linear) DVI_TRY(dvi__rows_factor(e, t, q, v));
    dvi__rows_pull(s, r->phi_q, mu, 1, r->along[0]);
    for (int i = 0; i < n; i++) r->x[i] = p[i] - r->along[0][i];
    dvi__rows_push(s, r->phi_q, v, r->phi_t, r->x + n);
    if (iteration >= 2 && momentum_is_rounding(s, r, p, mu)) {
      dvi__rows_pull(s, r->phi_q, mu, -1, p);
      return DVI_OK;
    }
    for (int a = 0; a < m; a++) r->x[n + a] = -r->x[n + a];
    DVI_TRY(dvi__rows_solve(r, n + m, t));
    for (int i = 0; i < n; i++) v[i] += r->x[i];
    for (int a = 0; a < m; a++) mu[a] += r->x[n + a];
    const double change = dvi__largest((size_t)n, r->x), speed = dvi__largest((size_t)n, v);
    if (change <= 4 * DBL_EPSILON * speed || (change <= 1e-10 * speed && change >= 0.5 * size)) {
      dvi__rows_pull(s, r->phi_q, mu, -1, p);
      return DVI_OK;
    }
    size = change;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "no velocity on the constraints was found at t = %.6g", t);
}

/* Factor the matrix, with a softness from where rows depend on others. */
static dvi_status factor_softly(dvi__evaluator *e, double t, const double *q, const double *v)
{
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const dvi_status factored = dvi__rows_factor(e, t, q, v);
  if (factored != DVI_SINGULAR || r->softness > 0) return factored;
  r->softness = DVI__SOFTNESS;
  return dvi__rows_factor(e, t, q, v);
}

dvi_status dvi__rows_approach(dvi__evaluator *e, double t, double *q, double *p)
{
  enum { MOST_ITERATIONS = 50 };
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const size_t n = (size_t)s->n;
  double *v = e->point[0], size = HUGE_VAL, next;
  r->softness = 0;
  memset(v, 0, n * sizeof(double));
  if (s->lagrangian != NULL) DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  DVI_TRY(place_distance(e, t, q, &next));
  for (int iteration = 0; iteration < MOST_ITERATIONS && next > 0 && next < size; iteration++) {
    size = next;
    DVI_TRY(factor_softly(e, t, q, v));
    memset(r->x, 0, n * sizeof(double));
    for (int a = 0; a < s->row_count; a++) r->x[s->n + a] = -r->phi[a];
    DVI_TRY(dvi__rows_solve(r, s->n + s->row_count, t));
    for (size_t i = 0; i < n; i++) r->point[i] = q[i] + r->x[i];
    DVI_TRY(place_distance(e, t, r->point, &next));
    if (next < size) memcpy(q, r->point, n * sizeof *q);
  }
  DVI_TRY(factor_softly(e, t, q, v));
  return dvi__rows_project_momentum(e, t, q, p, v);
}

dvi_status dvi__rows_found(dvi__evaluator *e, double t, const double *q)
{
  if (dvi__rows_check_place(e, t, q) == DVI_OK) return DVI_OK;
  return dvi__fail_in(DVI_NOT_CONVERGED, "no point of the constraints was found");
}

static dvi_status project_on_rows(dvi__evaluator *e, double t, double *q, double *p)
{
  DVI_TRY(dvi__rows_approach(e, t, q, p));
  return dvi__rows_found(e, t, q);
}

const dvi__state_constraint dvi__on_rows = {
    .matrix = "matrix of the constraints",
    .has_rank = 1,
    .check = dvi__rows_check,
    .admit = dvi__rows_are_nonholonomic,
    .project = project_on_rows,
    .distance = dvi__rows_distance,
    .size = dvi__rows_size,
    .side = dvi__rows_side,
};
