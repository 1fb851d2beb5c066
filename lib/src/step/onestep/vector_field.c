#include "step/onestep/vector_field.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

struct dvi__vector_field {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  /* is_H is not 0 if the system declares a Hamiltonian, whose derivatives take the place of those
   * of L */
  int n, points, at, is_H;
  /* Values point by point, [points], [n*points], [entries*points]. */
  double *t, *q, *v, *p, *H_q, *L_qq, *L_qv, *L_vv;
  double *velocity, *w, *motion; /* [n], [n], [2n] */
  /* factors of L_vv at the selected point; NULL for a constant mass or a Hamiltonian */
  dvi__linear *linear;
};

static double **vector_field_owned_array(dvi__vector_field *f, int i)
{
  double **const all[] = {&f->t,    &f->q,    &f->v,        &f->p, &f->H_q,   &f->L_qq,
                          &f->L_qv, &f->L_vv, &f->velocity, &f->w, &f->motion};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status vector_field_allocate(dvi__vector_field *f)
{
  const dvi_system *s = f->system;
  const size_t n = (size_t)f->n, m = (size_t)f->points, qq = (size_t)dvi__pattern_entries(&s->qq),
               qv = (size_t)dvi__pattern_entries(&s->qv), vv = (size_t)dvi__pattern_entries(&s->vv);
  const size_t size[] = {m, n * m, n * m, n * m, n * m, qq * m, qv * m, vv * m, n, n, 2 * n};
  for (int i = 0; vector_field_owned_array(f, i) != NULL; i++) {
    *vector_field_owned_array(f, i) = DVI_NEW(double, size[i] > 0 ? size[i] : 1);
    if (*vector_field_owned_array(f, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", f->points, f->n);
  }
  return DVI_OK;
}

static dvi_status vector_field_initialise(dvi__vector_field *f, dvi_counters *counters)
{
  DVI_TRY(dvi__evaluator_create(f->system, 1, DVI__HESSIANS, counters, &f->evaluator));
  DVI_TRY(vector_field_allocate(f));
  return (f->system->lagrangian != NULL || f->system->vector != NULL) && !f->is_H
             ? dvi__linear_create(&f->system->vv, DVI__LINEAR_AUTO, counters, &f->linear)
             : DVI_OK;
}

dvi_status dvi__vector_field_create(const dvi_system *system, int points, dvi_counters *counters,
                                    dvi__vector_field **field)
{
  *field = NULL;
  dvi__vector_field *f = DVI_NEW(dvi__vector_field, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  f->system = system;
  f->n = system->n;
  f->points = points;
  f->is_H = (system->terms & DVI__HAMILTONIAN) != 0;
  const dvi_status status = vector_field_initialise(f, counters);
  if (status != DVI_OK) dvi__vector_field_destroy(&f);
  *field = f;
  return status;
}

void dvi__vector_field_destroy(dvi__vector_field **field)
{
  dvi__vector_field *f = *field;
  if (f == NULL) return;
  for (int i = 0; vector_field_owned_array(f, i) != NULL; i++)
    dvi__release(*vector_field_owned_array(f, i));
  dvi__linear_destroy(&f->linear);
  dvi__evaluator_destroy(&f->evaluator);
  dvi__release(f);
  *field = NULL;
}

void dvi__vector_field_guess(dvi__vector_field *f, const double *v)
{
  memcpy(f->velocity, v, (size_t)f->n * sizeof *v);
}

/* ---- points ---- */

/* Compute the velocity and p'. */
static dvi_status motion_at(dvi__vector_field *f, double t, const double *q, const double *p,
                            double *pdot)
{
  if (f->is_H) return dvi__state_rates(f->evaluator, t, q, p, f->velocity, pdot, NULL);
  DVI_TRY(dvi__legendre_inverse(f->evaluator, t, q, p, f->velocity));
  return dvi__lagrangian_gradient(f->evaluator, 1, &t, q, f->velocity, pdot, NULL);
}

dvi_status dvi__vector_field_place(dvi__vector_field *f, int k, double t, const double *q,
                                   const double *p, double *rate)
{
  const size_t n = (size_t)f->n, at = (size_t)k * n, bytes = n * sizeof *q;
  DVI_TRY(motion_at(f, t, q, p, rate + n));
  memcpy(rate, f->velocity, bytes);
  f->t[k] = t;
  memcpy(f->q + at, q, bytes);
  memcpy(f->v + at, f->velocity, bytes);
  memcpy(f->p + at, p, bytes);
  for (size_t i = 0; i < n; i++) f->H_q[at + i] = -rate[n + i];
  return DVI_OK;
}

/* Return the index of a pattern's first entry at point k. */
static size_t vector_field_first_of(const dvi__pattern *pattern, int k)
{
  return (size_t)dvi__pattern_entries(pattern) * (size_t)k;
}

dvi_status dvi__vector_field_differentiate(dvi__vector_field *f, int first, int count)
{
  const dvi_system *s = f->system;
  for (int k = first; k < first + count; k++) {
    const size_t at = (size_t)k * (size_t)f->n;
    double *L_vv = f->linear != NULL || f->is_H ? f->L_vv + vector_field_first_of(&s->vv, k) : NULL;
    DVI_TRY(dvi__lagrangian_hessian(f->evaluator, 1, f->t + k, f->q + at,
                                    (f->is_H ? f->p : f->v) + at,
                                    f->L_qq + vector_field_first_of(&s->qq, k),
                                    f->L_qv + vector_field_first_of(&s->qv, k), L_vv));
  }
  return DVI_OK;
}

dvi_status dvi__vector_field_select(dvi__vector_field *f, int k)
{
  f->at = k;
  return f->linear != NULL
             ? dvi__linear_factor(f->linear, f->L_vv + vector_field_first_of(&f->system->vv, k))
             : DVI_OK;
}

/* Add sign A x, or sign A^T x, to y. */
static void add_times(const dvi__pattern *of, const double *values, int transposed, double sign,
                      const double *x, double *y)
{
  for (int j = 0; j < of->columns; j++)
    for (int e = of->start[j]; e < of->start[j + 1]; e++) {
      const int i = of->row[e];
      y[transposed ? j : i] += sign * values[e] * x[transposed ? i : j];
    }
}

static void product_of_H(const dvi__vector_field *f, const double *motion, double *product)
{
  const dvi_system *s = f->system;
  const int n = f->n;
  const double *H_qp = f->L_qv + vector_field_first_of(&s->qv, f->at);
  memset(product, 0, 2 * (size_t)n * sizeof *product);
  add_times(&s->qq, f->L_qq + vector_field_first_of(&s->qq, f->at), 0, 1, motion, product);
  add_times(&s->qv, H_qp, 0, 1, motion + n, product);
  add_times(&s->qv, H_qp, 1, 1, motion, product + n);
  add_times(&s->vv, f->L_vv + vector_field_first_of(&s->vv, f->at), 0, 1, motion + n, product + n);
}

void dvi__vector_field_product(dvi__vector_field *f, const double *motion, double *product)
{
  const dvi_system *s = f->system;
  const int n = f->n;
  const double *L_qv = f->L_qv + vector_field_first_of(&s->qv, f->at);
  double *w = product + n;
  if (f->is_H) {
    product_of_H(f, motion, product);
    return;
  }
  memcpy(f->w, motion + n, (size_t)n * sizeof *w);
  add_times(&s->qv, L_qv, 1, -1, motion, f->w);
  if (f->linear != NULL)
    dvi__linear_solve(f->linear, f->w);
  else
    dvi__mass_solve(f->evaluator, 1, f->w, f->w);
  memset(product, 0, (size_t)n * sizeof *product);
  add_times(&s->qq, f->L_qq + vector_field_first_of(&s->qq, f->at), 0, -1, motion, product);
  add_times(&s->qv, L_qv, 0, -1, f->w, product);
  memcpy(w, f->w, (size_t)n * sizeof *w);
}

/* Compute the gradient of L = p.H_p - H. */
void dvi__vector_field_lagrangian(dvi__vector_field *f, double *gradient)
{
  const size_t n = (size_t)f->n, at = (size_t)f->at * n;
  memset(f->motion, 0, n * sizeof(double));
  memcpy(f->motion + n, f->p + at, n * sizeof(double));
  dvi__vector_field_product(f, f->motion, gradient);
  for (size_t i = 0; i < n; i++) gradient[i] -= f->H_q[at + i];
}

void dvi__vector_field_push(dvi__vector_field *f, double h, const double *motion, double *image)
{
  const int n = f->n;
  dvi__vector_field_product(f, motion, f->motion);
  for (int i = 0; i < n; i++) {
    image[i] = h * f->motion[n + i];
    image[n + i] = -h * f->motion[i];
  }
}

/* Compute f_z^T (a,b) = H_zz (-b,a). */
void dvi__vector_field_pull(dvi__vector_field *f, double h, const double *costate, double *image)
{
  const int n = f->n;
  for (int i = 0; i < n; i++) {
    f->motion[i] = -h * costate[n + i];
    f->motion[n + i] = h * costate[i];
  }
  dvi__vector_field_product(f, f->motion, image);
}

/* ---- velocities ---- */

dvi__vector_field_point dvi__vector_field_point_at(const dvi__vector_field *f, int k)
{
  const size_t at = (size_t)k * (size_t)f->n;
  return (dvi__vector_field_point){.t = f->t[k], .q = f->q + at, .v = f->v + at};
}

dvi__vector_field_point dvi__vector_field_selected(const dvi__vector_field *f)
{
  return dvi__vector_field_point_at(f, f->at);
}

/* Compute the change of p. For a constant mass L_v is linear, and the difference has no rounding
 * error of p. */
dvi_status dvi__vector_field_impulse(dvi__vector_field *f, int k, double t, const double *q,
                                     const double *dv, double *dp)
{
  const size_t n = (size_t)f->n, at = (size_t)k * n;
  if (f->linear == NULL) return dvi__lagrangian_gradient(f->evaluator, 1, &t, q, dv, NULL, dp);
  for (size_t i = 0; i < n; i++) f->w[i] = f->v[at + i] + dv[i];
  DVI_TRY(dvi__lagrangian_gradient(f->evaluator, 1, &t, q, f->w, NULL, dp));
  for (size_t i = 0; i < n; i++) dp[i] -= f->p[at + i];
  return DVI_OK;
}

static const double *constant_mass(const dvi__vector_field *f)
{
  return f->system->mass_diagonal != NULL ? f->system->mass_diagonal : f->system->mass_values;
}

static const double *vector_field_mass_of(const dvi__vector_field *f, int k)
{
  return f->linear != NULL ? f->L_vv + vector_field_first_of(&f->system->vv, k) : constant_mass(f);
}

void dvi__vector_field_lift(dvi__vector_field *f, int k, const double *motion, double *dp)
{
  const dvi_system *s = f->system;
  memset(dp, 0, (size_t)f->n * sizeof *dp);
  add_times(&s->qv, f->L_qv + vector_field_first_of(&s->qv, k), 1, 1, motion, dp);
  add_times(&s->vv, vector_field_mass_of(f, k), 0, 1, motion + f->n, dp);
}

void dvi__vector_field_lower(dvi__vector_field *f, int k, const double *covector, double *image)
{
  const dvi_system *s = f->system;
  memset(image, 0, 2 * (size_t)f->n * sizeof *image);
  add_times(&s->qv, f->L_qv + vector_field_first_of(&s->qv, k), 0, 1, covector, image);
  add_times(&s->vv, vector_field_mass_of(f, k), 0, 1, covector, image + f->n);
}

/* ---- sizes ---- */

static dvi_status vector_field_mass_at(dvi__vector_field *f, double t, const double *q,
                                       const double *v, const double **values)
{
  if (f->system->lagrangian != NULL) return dvi__velocity_hessian(f->evaluator, t, q, v, values);
  *values = constant_mass(f);
  return DVI_OK;
}

dvi_status dvi__vector_field_mass(dvi__vector_field *f, double t, const double *q, const double *v,
                                  double *size)
{
  const dvi__pattern *vv = &f->system->vv;
  const double *values;
  DVI_TRY(vector_field_mass_at(f, t, q, v, &values));
  memset(size, 0, (size_t)f->n * sizeof *size);
  for (int e = 0; e < dvi__pattern_entries(vv); e++)
    size[vv->row[e]] = fmax(size[vv->row[e]], fabs(values[e]));
  for (int i = 0; i < f->n; i++)
    if (!(size[i] > 0))
      return dvi__fail(DVI_SINGULAR, "the Lagrangian is degenerate: coordinate %d has no mass", i);
  return DVI_OK;
}
