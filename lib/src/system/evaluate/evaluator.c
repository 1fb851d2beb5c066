#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/evaluate/form_batches.h"
#include "system/term/force.h"
#include "system/term/vector.h"

static size_t count_numbers(const dvi__evaluator *e, int count)
{
  return (size_t)e->system->n * (size_t)count;
}

static int allocate_general(dvi__evaluator *e)
{
  const dvi_system *system = e->system;
  e->unwanted = DVI_NEW(double, count_numbers(e, e->capacity));
  e->velocity_search = DVI_NEW(double, 6 * count_numbers(e, 1));
  e->hessian[0] = DVI_NEW(double, dvi__pattern_entries(&system->lagrangian->qq));
  e->hessian[1] = DVI_NEW(double, dvi__pattern_entries(&system->qv));
  e->hessian[2] = DVI_NEW(double, dvi__pattern_entries(&system->vv));
  return e->unwanted && e->velocity_search && e->hessian[0] && e->hessian[1] && e->hessian[2];
}

/* Test whether functions of one point need no room for vectors, but for symmetries: a diagonal mass
 * and potentials. Large systems of this kind should cost little more memory than their states. */
static int is_lean(const dvi__evaluator *e)
{
  const dvi_system *s = e->system;
  return e->capacity == 1 && dvi__only_potentials(s) && s->mass_diagonal != NULL && s->damping == 0;
}

/* Return the length of `term`, which has the value of a potential at each point if nothing else is
 * summed. */
static size_t length_of_term(const dvi__evaluator *e, int hessians)
{
  const size_t points = (size_t)e->capacity;
  return !hessians && is_lean(e) && e->system->potential_count <= 1
             ? points
             : points * (size_t)dvi__longest_hessian(e->system, hessians);
}

/* Allocate scratch memory and `term`, with room for potentials' Hessians or without, in place of
 * what is there. */
static dvi_status evaluator_allocate_scratch(dvi__evaluator *e, int hessians)
{
  const dvi_system *system = e->system;
  const size_t length = length_of_term(e, hessians);
  dvi__scratch scratch;
  DVI_TRY(dvi__scratch_create(system, e->capacity, hessians, &scratch));
  double *term = DVI_NEW(double, length), *by_v = NULL;
  const int has_by_v = hessians && system->force_count > 0;
  if (has_by_v) by_v = DVI_NEW(double, length);
  if (term == NULL || (has_by_v && by_v == NULL)) {
    dvi__scratch_clear(&scratch);
    dvi__release(term);
    dvi__release(by_v);
    return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory for %d points in %d dimensions",
                     e->capacity, system->n);
  }
  dvi__scratch_clear(&e->scratch);
  dvi__release(e->term);
  dvi__release(e->force_by_v);
  e->scratch = scratch;
  e->term = term;
  e->force_by_v = by_v;
  e->has_hessians = hessians;
  return DVI_OK;
}

dvi_status dvi__evaluator_prepare_hessians(dvi__evaluator *e)
{
  if (e->has_hessians) return DVI_OK;
  DVI_TRY(dvi__system_prepare_hessian(e->system));
  return evaluator_allocate_scratch(e, 1);
}

dvi_status dvi__evaluator_prepare_symmetries(dvi__evaluator *e)
{
  if (e->point[2] == NULL) e->point[2] = DVI_NEW(double, e->system->n);
  return e->point[2] != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "evaluator: no memory for %d numbers", e->system->n);
}

static dvi_status evaluator_allocate(dvi__evaluator *e, int hessians)
{
  const dvi_system *system = e->system;
  DVI_TRY(hessians ? dvi__evaluator_prepare_hessians(e) : evaluator_allocate_scratch(e, 0));
  if (is_lean(e)) return DVI_OK;
  for (int i = 0; i < 3; i++) e->point[i] = DVI_NEW(double, system->n);
  if (e->point[0] && e->point[1] && e->point[2] &&
      (system->lagrangian == NULL || allocate_general(e)))
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory for %d points in %d dimensions",
                   e->capacity, system->n);
}

dvi_status dvi__evaluator_create(const dvi_system *system, int capacity, dvi__derivatives most,
                                 dvi_counters *counters, dvi__evaluator **evaluator)
{
  *evaluator = NULL;
  dvi__evaluator *e = DVI_NEW(dvi__evaluator, 1);
  if (e == NULL) return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory");
  e->system = system;
  e->capacity = capacity;
  e->counters = counters != NULL ? counters : &e->own_counters;
  dvi_status status = evaluator_allocate(e, most == DVI__HESSIANS);
  if (status == DVI_OK) status = system->dynamics->prepare(e, most);
  if (status != DVI_OK) dvi__evaluator_destroy(&e);
  *evaluator = e;
  return status;
}

void dvi__evaluator_destroy(dvi__evaluator **evaluator)
{
  dvi__evaluator *e = *evaluator;
  if (e == NULL) return;
  dvi__linear_destroy(&e->velocity);
  if (e->system->dynamics->release != NULL) e->system->dynamics->release(e);
  dvi__scratch_clear(&e->scratch);
  dvi__release(e->term);
  dvi__release(e->force_by_v);
  for (int i = 0; i < 3; i++) dvi__release(e->point[i]);
  dvi__release(e->unwanted);
  dvi__release(e->velocity_search);
  for (int i = 0; i < 3; i++) dvi__release(e->hessian[i]);
  dvi__release(e);
  *evaluator = NULL;
}

/* ---- constant mass ---- */

/* Compute y = M x for a batch. */
static void mass_times(const dvi_system *s, int count, const double *x, double *y)
{
  const size_t points = (size_t)count;
  if (s->mass_diagonal != NULL) {
    for (size_t i = 0; i < (size_t)s->n; i++)
      for (size_t k = i * points; k < (i + 1) * points; k++) y[k] = s->mass_diagonal[i] * x[k];
    return;
  }
  memset(y, 0, (size_t)s->n * points * sizeof(double));
  for (size_t j = 0; j < (size_t)s->n; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++)
      for (size_t k = 0; k < points; k++)
        y[(size_t)s->vv.row[e] * points + k] += s->mass_values[e] * x[j * points + k];
}

void dvi__mass_solve(dvi__evaluator *e, int count, const double *y, double *x)
{
  const dvi_system *s = e->system;
  const size_t points = (size_t)count;
  if (s->mass_diagonal != NULL) {
    for (size_t i = 0; i < (size_t)s->n; i++)
      for (size_t k = i * points; k < (i + 1) * points; k++) x[k] = y[k] / s->mass_diagonal[i];
    return;
  }
  for (size_t k = 0; k < points; k++) {
    for (size_t i = 0; i < (size_t)s->n; i++) e->point[0][i] = y[i * points + k];
    dvi__linear_solve(e->velocity, e->point[0]);
    for (size_t i = 0; i < (size_t)s->n; i++) x[i * points + k] = e->point[0][i];
  }
}

int dvi__mass_sign(const dvi__evaluator *e)
{
  const dvi_system *s = e->system;
  int negative = 0;
  if (s->mass_diagonal == NULL) return dvi__linear_sign(e->velocity);
  for (int i = 0; i < s->n; i++) negative ^= s->mass_diagonal[i] < 0;
  return negative ? -1 : 1;
}

int dvi__mass_is_positive(const dvi__evaluator *e)
{
  const dvi_system *s = e->system;
  if (s->mass_diagonal == NULL) return dvi__linear_is_definite(e->velocity, 1);
  for (int i = 0; i < s->n; i++)
    if (s->mass_diagonal[i] < 0) return 0;
  return 1;
}

void dvi__count_differences(dvi__evaluator *e)
{
  e->counters->values += e->scratch.of_value.points;
  e->counters->gradients += e->scratch.of_gradient.points;
  e->scratch.of_value.points = e->scratch.of_gradient.points = 0;
}

/* ---- value ---- */

static void constant_mass_energy(dvi__evaluator *e, int count, const double *v, double *T)
{
  const size_t points = (size_t)count;
  const double *m = e->system->mass_diagonal;
  memset(T, 0, points * sizeof(double));
  if (m == NULL) mass_times(e->system, count, v, e->term);
  for (size_t i = 0; i < (size_t)e->system->n; i++)
    for (size_t k = 0, at = i * points; k < points; k++, at++)
      T[k] += 0.5 * v[at] * (m != NULL ? m[i] * v[at] : e->term[at]);
}

/* Add x.v to a sum [count], with x in e->term. */
static void add_along(dvi__evaluator *e, int count, const double *v, double *sum)
{
  const size_t points = (size_t)count;
  for (size_t i = 0; i < (size_t)e->system->n; i++)
    for (size_t k = 0; k < points; k++) sum[k] += e->term[i * points + k] * v[i * points + k];
}

dvi_status dvi__mass_energy(dvi__evaluator *e, double t, const double *q, const double *v,
                            double *E)
{
  const dvi_system *s = e->system;
  double V;
  e->counters->values++;
  constant_mass_energy(e, 1, v, E);
  for (int p = 0; p < s->potential_count; p++) {
    DVI_TRY(dvi__potential_value(&s->potentials[p], &e->scratch, 1, &t, q, &V));
    *E += V;
  }
  if (dvi__first_not_finite(1, E) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the energy at t = %.6g is not finite", t);
  return DVI_OK;
}

dvi_status dvi__lagrangian_value(dvi__evaluator *e, int count, const double *t, const double *q,
                                 const double *v, double *L)
{
  const dvi_system *s = e->system;
  e->counters->values += count;
  if (s->lagrangian != NULL)
    DVI_TRY(dvi__general_value(s->lagrangian, &e->scratch, count, t, q, v, L));
  else
    constant_mass_energy(e, count, v, L);
  for (int p = 0; p < s->potential_count; p++) {
    DVI_TRY(dvi__potential_value(&s->potentials[p], &e->scratch, count, t, q, e->term));
    for (int k = 0; k < count; k++) L[k] -= e->term[k];
  }
  if (s->vector != NULL) {
    DVI_TRY(dvi__vector_value(s->vector, &e->scratch, count, t, q, e->term));
    add_along(e, count, v, L);
  }
  if (dvi__first_not_finite((size_t)count, L) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the %s's value is not finite", s->dynamics->function);
  return DVI_OK;
}

dvi_status dvi__lagrangian_rate(dvi__evaluator *e, int count, const double *t, const double *q,
                                const double *v, double *L_t)
{
  const dvi_system *s = e->system;
  memset(L_t, 0, (size_t)count * sizeof(double));
  if (s->autonomous) return DVI_OK;
  e->counters->values += count;
  if (s->lagrangian != NULL)
    DVI_TRY(dvi__general_rate(s->lagrangian, &e->scratch, count, t, q, v, L_t));
  for (int p = 0; p < s->potential_count; p++) {
    DVI_TRY(dvi__potential_rate(&s->potentials[p], &e->scratch, count, t, q, e->term));
    for (int k = 0; k < count; k++) L_t[k] -= e->term[k];
  }
  if (s->vector == NULL) return DVI_OK;
  DVI_TRY(dvi__vector_rate(s->vector, &e->scratch, count, t, q, e->term));
  add_along(e, count, v, L_t);
  return DVI_OK;
}

dvi_status dvi__lagrangian_admit(const dvi__evaluator *e, double t, const double *q)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  return l != NULL ? dvi__general_admit(l, t, q) : DVI_OK;
}

/* ---- gradient ---- */

/* Sum the potentials' gradients. The first one is evaluated in place. */
static dvi_status sum_gradients(dvi__evaluator *e, int count, const double *t, const double *q,
                                double *V_q)
{
  const dvi_system *s = e->system;
  const size_t length = count_numbers(e, count);
  if (s->potential_count == 0) memset(V_q, 0, length * sizeof(double));
  for (int p = 0; p < s->potential_count; p++) {
    DVI_TRY(dvi__potential_gradient(&s->potentials[p], &e->scratch, count, t, q,
                                    p == 0 ? V_q : e->term));
    for (size_t i = 0; i < length && p > 0; i++) V_q[i] += e->term[i];
  }
  return DVI_OK;
}

/* Return the index of the next force of these kinds, from `k` on. */
static int next_force(const dvi_system *s, unsigned kinds, int k)
{
  while (k < s->force_count && !(kinds & dvi__force_kind(&s->forces[k]))) k++;
  return k;
}

/* Add the forces of these kinds from `first` on, times a sign, to the sum of the others,
 * [nv*count]. */
static dvi_status add_forces(dvi__evaluator *e, unsigned kinds, int first, int count, double sign,
                             const double *t, const double *q, const double *v, double *sum)
{
  const dvi_system *s = e->system;
  for (int k = next_force(s, kinds, first); k < s->force_count; k = next_force(s, kinds, k + 1)) {
    DVI_TRY(dvi__force_value(&s->forces[k], &e->scratch, count, t, q, v, e->term));
    for (size_t i = 0; i < (size_t)s->nv * (size_t)count; i++) sum[i] += sign * e->term[i];
  }
  return DVI_OK;
}

/* The first force is evaluated in place. */
dvi_status dvi__forces(dvi__evaluator *e, unsigned kinds, int count, const double *t,
                       const double *q, const double *v, double *F)
{
  const dvi_system *s = e->system;
  const int first = next_force(s, kinds, 0);
  e->counters->gradients += count;
  if (first < s->force_count)
    DVI_TRY(dvi__force_value(&s->forces[first], &e->scratch, count, t, q, v, F));
  else
    memset(F, 0, (size_t)s->nv * (size_t)count * sizeof(double));
  return add_forces(e, kinds, first + 1, count, 1, t, q, v, F);
}

dvi_status dvi__potentials_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                    double *V_q)
{
  e->counters->gradients += count;
  dvi_status status = sum_gradients(e, count, t, q, V_q);
  /* with factors forces have other numbers than V_q */
  if (status == DVI_OK && e->system->slot_count == 0)
    status = add_forces(e, DVI__FORCE, 0, count, -1, t, q, NULL, V_q);
  dvi__count_differences(e);
  return status;
}

static dvi_status potential_forces(dvi__evaluator *e, int count, const double *t, const double *q,
                                   double *L_q)
{
  DVI_TRY(sum_gradients(e, count, t, q, L_q));
  for (size_t i = 0; i < count_numbers(e, count); i++) L_q[i] = -L_q[i];
  return DVI_OK;
}

static dvi_status general_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                   const double *v, double *L_q, double *L_v)
{
  const dvi_system *s = e->system;
  DVI_TRY(dvi__general_gradient(s->lagrangian, &e->scratch, count, t, q, v, L_q, L_v));
  for (int p = 0; p < s->potential_count; p++) {
    DVI_TRY(dvi__potential_gradient(&s->potentials[p], &e->scratch, count, t, q, e->term));
    for (size_t i = 0; i < count_numbers(e, count); i++) L_q[i] -= e->term[i];
  }
  return DVI_OK;
}

dvi_status dvi__vector_potential(dvi__evaluator *e, int count, const double *t, const double *q,
                                 double *A)
{
  e->counters->gradients += count;
  return dvi__vector_value(e->system->vector, &e->scratch, count, t, q, A);
}

dvi_status dvi__magnetic_field(dvi__evaluator *e, int count, const double *t, const double *q,
                               double *A_q, double *A_t)
{
  const dvi_system *s = e->system;
  DVI_TRY(dvi__vector_gradients(s->vector, &e->scratch, count, t, q, A_q));
  if (s->autonomous) memset(A_t, 0, count_numbers(e, count) * sizeof(double));
  return s->autonomous ? DVI_OK : dvi__vector_rate(s->vector, &e->scratch, count, t, q, A_t);
}

/* Add the part of a vector potential, (A.v)_q to L_q and A to L_v. Either may be NULL. */
static dvi_status add_vector_gradient(dvi__evaluator *e, int count, const double *t,
                                      const double *q, const double *v, double *L_q, double *L_v)
{
  const dvi_system *s = e->system;
  if (L_q != NULL) {
    DVI_TRY(dvi__vector_forces(s->vector, &e->scratch, count, t, q, v, e->term));
    for (size_t i = 0; i < count_numbers(e, count); i++) L_q[i] += e->term[i];
  }
  if (L_v == NULL) return DVI_OK;
  DVI_TRY(dvi__vector_value(s->vector, &e->scratch, count, t, q, e->term));
  for (size_t i = 0; i < count_numbers(e, count); i++) L_v[i] += e->term[i];
  return DVI_OK;
}

dvi_status dvi__lagrangian_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                    const double *v, double *L_q, double *L_v)
{
  const dvi_system *s = e->system;
  if (s->lagrangian == NULL && L_v != NULL) mass_times(s, count, v, L_v);
  if (s->lagrangian == NULL && s->vector == NULL && L_q == NULL) return DVI_OK;
  e->counters->gradients += count;
  dvi_status status = DVI_OK;
  if (s->lagrangian != NULL)
    status = general_gradient(e, count, t, q, v, L_q ? L_q : e->unwanted, L_v ? L_v : e->unwanted);
  else if (L_q != NULL)
    status = potential_forces(e, count, t, q, L_q);
  if (status == DVI_OK && s->vector != NULL)
    status = add_vector_gradient(e, count, t, q, v, L_q, L_v);
  /* with factors forces have other numbers than L_q */
  if (status == DVI_OK && L_q != NULL && s->slot_count == 0)
    status = add_forces(e, DVI__FORCES, 0, count, 1, t, q, v, L_q);
  dvi__count_differences(e);
  return status;
}

dvi_status dvi__magnetic_gradient(dvi__evaluator *e, int count, const double *t, const double *q,
                                  const double *v, double *V_q, double *A)
{
  const dvi_system *s = e->system;
  DVI_TRY(dvi__potentials_gradient(e, count, t, q, V_q));
  DVI_TRY(dvi__vector_forces(s->vector, &e->scratch, count, t, q, v, e->term));
  for (size_t i = 0; i < count_numbers(e, count); i++) V_q[i] -= e->term[i];
  return dvi__vector_value(s->vector, &e->scratch, count, t, q, A);
}

/* ---- Hessian ---- */

static void copy_mass_hessian(const dvi_system *s, int count, double *L_vv)
{
  const double *M = s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
  const size_t points = (size_t)count;
  for (size_t entry = 0; entry < (size_t)dvi__pattern_entries(&s->vv); entry++)
    for (size_t k = 0; k < points; k++) L_vv[entry * points + k] = M[entry];
}

static void add_embedded(const dvi__pattern *part, const int *where, size_t points, double sign,
                         const double *values, double *whole)
{
  const size_t entries = (size_t)dvi__pattern_entries(part);
  for (size_t entry = 0; entry < entries; entry++)
    for (size_t k = 0; k < points; k++)
      whole[(size_t)where[entry] * points + k] += sign * values[entry * points + k];
}

dvi_status dvi__subtract_potential_hessians(dvi__evaluator *e, int count, const double *t,
                                            const double *q, double *L_qq)
{
  const dvi_system *s = e->system;
  for (int p = 0; p < s->potential_count; p++) {
    const dvi__potential_term *term = &s->potentials[p];
    DVI_TRY(dvi__potential_hessian(term, &e->scratch, count, t, q, e->term));
    add_embedded(&term->qq, term->in_qq, (size_t)count, -1, e->term, L_qq);
  }
  return DVI_OK;
}

void dvi__spread_entries(const dvi_system *s, size_t points, double *L_qq)
{
  int from = dvi__pattern_entries(&s->lagrangian->qq) - 1;
  for (int entry = dvi__pattern_entries(&s->qq) - 1; entry >= 0; entry--) {
    const int found = from >= 0 && s->lagrangian->in_qq[from] == entry;
    for (size_t k = 0; k < points; k++)
      L_qq[(size_t)entry * points + k] = found ? L_qq[(size_t)from * points + k] : 0.0;
    from -= found;
  }
}

static dvi_status sum_hessians(dvi__evaluator *e, int count, const double *t, const double *q,
                               const double *v, double *L_qq, double *L_qv, double *L_vv)
{
  const dvi_system *s = e->system;
  const size_t points = (size_t)count;
  if (s->lagrangian != NULL) {
    DVI_TRY(dvi__general_hessian(s->lagrangian, &e->scratch, count, t, q, v, L_qq, L_qv, L_vv));
    dvi__spread_entries(s, points, L_qq);
    return dvi__subtract_potential_hessians(e, count, t, q, L_qq);
  }
  if (L_vv != NULL) copy_mass_hessian(s, count, L_vv);
  if (s->vector != NULL && L_qv != NULL)
    DVI_TRY(dvi__vector_gradients(s->vector, &e->scratch, count, t, q, L_qv));
  if (L_qq == NULL) return DVI_OK;
  memset(L_qq, 0, (size_t)dvi__pattern_entries(&s->qq) * points * sizeof(double));
  if (s->vector != NULL) {
    DVI_TRY(dvi__vector_hessian(s->vector, &e->scratch, count, t, q, v, e->term));
    add_embedded(&s->vector->qq, s->vector->in_qq, points, 1, e->term, L_qq);
  }
  return dvi__subtract_potential_hessians(e, count, t, q, L_qq);
}

dvi_status dvi__lagrangian_hessian(dvi__evaluator *e, int count, const double *t, const double *q,
                                   const double *v, double *L_qq, double *L_qv, double *L_vv)
{
  e->counters->hessians += count;
  const dvi_status status = sum_hessians(e, count, t, q, v, L_qq, L_qv, L_vv);
  dvi__count_differences(e);
  return status;
}

dvi_status dvi__forces_jacobian(dvi__evaluator *e, int count, const double *t, const double *q,
                                const double *v, double *F_q, double *F_v)
{
  const dvi_system *s = e->system;
  const size_t points = (size_t)count;
  double *by_v = e->force_by_v;
  memset(F_q, 0, (size_t)dvi__pattern_entries(&s->by_q) * points * sizeof(double));
  memset(F_v, 0, (size_t)dvi__pattern_entries(&s->by_v) * points * sizeof(double));
  for (int k = 0; k < s->force_count; k++) {
    const dvi__force_term *f = &s->forces[k];
    DVI_TRY(dvi__force_jacobian(f, &e->scratch, count, t, q, v, e->term, by_v));
    add_embedded(&f->by_q, f->in_by_q, points, 1, e->term, F_q);
    add_embedded(&f->by_v, f->in_by_v, points, 1, by_v, F_v);
  }
  dvi__count_differences(e);
  return DVI_OK;
}

dvi_status dvi__form_gradient(dvi__evaluator *e, const double *q, const double *w,
                              double *alpha_w_q, double *alpha)
{
  const double any_time = 0;
  e->counters->gradients++;
  return dvi__general_gradient(e->system->lagrangian, &e->scratch, 1, &any_time, q, w, alpha_w_q,
                               alpha);
}

dvi_status dvi__form_hessian(dvi__evaluator *e, const double *q, const double *w,
                             double *alpha_w_qq, double *alpha_q)
{
  const double any_time = 0;
  e->counters->hessians++;
  const dvi_status status = dvi__general_hessian(e->system->lagrangian, &e->scratch, 1, &any_time,
                                                 q, w, alpha_w_qq, alpha_q, e->hessian[2]);
  dvi__count_differences(e);
  if (status == DVI_OK) dvi__spread_entries(e->system, 1, alpha_w_qq);
  return status;
}

dvi_status dvi__velocity_hessian(dvi__evaluator *e, double t, const double *q, const double *v,
                                 const double **L_vv)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  const int alone = l->computed != NULL; /* these give L_vv alone, which costs less */
  e->counters->hessians++;
  *L_vv = e->hessian[2];
  const dvi_status status = dvi__general_hessian(l, &e->scratch, 1, &t, q, v,
                                                 alone ? NULL : e->hessian[0],
                                                 alone ? NULL : e->hessian[1], e->hessian[2]);
  dvi__count_differences(e);
  return status;
}
