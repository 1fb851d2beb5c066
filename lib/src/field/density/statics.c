/* Static states of a field, where the gradient F(q) of V = -L(q, q' = 0) vanishes, by Newton's
 * method
 *
 *     H(q) d = F(q),    q <- q - s d,
 *
 * with the largest s of 1, 1/2, 1/4, .. for which |F| falls. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/density/density.h"
#include "num/finite.h"

enum { ITERATIONS = 60, HALVINGS = 12, FULL_MOST = 2000 /* coordinates of a full Hessian */ };

/* A step that is no larger beside q ends the iteration, if |F| falls no more. */
static const double small_step = 1e-9;

/* |F| that is no larger beside the terms of H q is roundoff. A field that may be moved along an
 * axis almost freely, as a kink far from the walls, is static there wherever it is, although
 * Newton's step is long. */
static const double small_force = 16 * DBL_EPSILON;

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for a static state");
}

/* ---- gradients and Hessians ---- */

/* Add a sign times the gradient in q of an integral. */
static dvi_status add_gradient(const dvi__integral *integral, double sign, const double *q,
                               double *part, double *F)
{
  if (integral->parts == 0) return DVI_OK;
  const int failed = dvi__integral_evaluate(integral, &(dvi__density_point){.q = q},
                                            &(dvi__density_sums){.q = part});
  for (int64_t i = 0; i < integral->density->unknowns; i++) F[i] += sign * part[i];
  return dvi__density_refuse(failed, integral->part[0]->name);
}

/* Give F at q. part has room for as many numbers. K and the load are all of the quadratic parts but
 * for what depends on time. */
static dvi_status find_gradient(const dvi_density *density, const double *q, double *part,
                                double *F)
{
  const int has_matrix = density->has_rest || !density->quadratic.depends_on_time;
  memset(F, 0, (size_t)density->unknowns * sizeof *F);
  DVI_TRY(add_gradient(&density->lagrangian, -1, q, part, F));
  if (!has_matrix) DVI_TRY(add_gradient(&density->quadratic, 1, q, part, F));
  for (int i = 0; i < density->potentials; i++)
    DVI_TRY(add_gradient(density->potential + i, 1, q, part, F));
  for (int64_t i = 0; i < density->unknowns && has_matrix; i++) {
    const dvi__csr *K = &density->stiffness;
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++) F[i] += K->value[e] * q[K->column[e]];
    F[i] -= density->load[i];
  }
  return DVI_OK;
}

/* Make the Hessian in q of an integral. That of a Fourier field is full. */
static dvi_status make_part(const dvi__integral *integral, const double *q, dvi__csr *part)
{
  const int64_t n = integral->density->unknowns;
  if (integral->density->is_fourier && n > FULL_MOST)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: part '%s' has a full Hessian on fourier, which is for at most %d "
                     "coordinates, not %lld: take kind=spline or fem",
                     integral->part[0]->name, (int)FULL_MOST, (long long)n);
  if (integral->density->is_fourier) {
    DVI_TRY(dvi__csr_allocate(n, n, n * n, part));
    for (int64_t i = 0; i <= n; i++) part->start[i] = i * n;
    for (int64_t e = 0; e < n * n; e++) part->column[e] = (int)(e % n);
  } else {
    DVI_TRY(dvi__matrix_of_pattern(&integral->patterns.qq, part));
  }
  const int failed = dvi__integral_evaluate(integral, &(dvi__density_point){.q = q},
                                            &(dvi__density_sums){.qq = part->value});
  return dvi__density_refuse(failed, integral->part[0]->name);
}

/* Add a sign times the Hessian of an integral to a matrix. */
static dvi_status add_hessian(const dvi__integral *integral, double sign, const double *q,
                              dvi__csr *hessian)
{
  dvi__csr part = {0}, sum = {0};
  if (integral->parts == 0) return DVI_OK;
  dvi_status status = make_part(integral, q, &part);
  for (int64_t e = 0; status == DVI_OK && e < part.start[part.rows]; e++) part.value[e] *= sign;
  const dvi_matrix A = dvi__csr_view(hessian, 1), B = dvi__csr_view(&part, 1);
  if (status == DVI_OK) status = dvi__csr_sum(&A, &B, &sum);
  dvi__csr_clear(&part);
  if (status != DVI_OK) return status;
  dvi__csr_clear(hessian);
  *hessian = sum;
  return DVI_OK;
}

dvi_status dvi__density_hessian(const dvi_density *density, const double *q, dvi__csr *hessian)
{
  const dvi_matrix K = dvi__csr_view(&density->stiffness, 1);
  DVI_TRY(dvi__csr_copy(&K, hessian));
  dvi_status status = add_hessian(&density->lagrangian, -1, q, hessian);
  for (int i = 0; i < density->potentials && status == DVI_OK; i++)
    status = add_hessian(density->potential + i, 1, q, hessian);
  if (status != DVI_OK) dvi__csr_clear(hessian);
  return status;
}

/* ---- Newton's method ---- */

typedef struct search {
  const dvi_density *density;
  int64_t n;
  double *q, *F, *d, *trial, *F_trial, *part; /* [n] */
  double size, length;                        /* |F|, and the last step beside q */
  double scale;                               /* the largest |q| and |d| so far */
  double terms;                               /* size of the terms of H q */
  int iterations;
} search;

static double length_of(int64_t n, const double *x)
{
  double sum = 0;
  for (int64_t i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

/* A minimum has a positive definite Hessian, whose factor takes less. */
static dvi_status factor(const dvi_density *density, const dvi_matrix *H, dvi__definite *solver)
{
  dvi_status status = DVI_SINGULAR;
  if (!dvi__definite_iterates(H->rows, density->dimension))
    status = dvi__definite_create(H, density->dimension, solver);
  return status == DVI_SINGULAR ? dvi__regular_create(H, solver) : status;
}

static double size_of_terms(const dvi__csr *H, const double *q)
{
  double square = 0;
  for (int64_t i = 0; i < H->rows; i++) {
    double sum = 0;
    for (int64_t e = H->start[i]; e < H->start[i + 1]; e++)
      sum += fabs(H->value[e] * q[H->column[e]]);
    square += sum * sum;
  }
  return sqrt(square);
}

static dvi_status find_direction(search *s)
{
  dvi__csr H = {0};
  dvi__definite solver = {0};
  DVI_TRY(dvi__density_hessian(s->density, s->q, &H));
  const dvi_matrix view = dvi__csr_view(&H, 1);
  s->terms = size_of_terms(&H, s->q);
  dvi_status status = factor(s->density, &view, &solver);
  if (status == DVI_OK) status = dvi__definite_solve(&solver, s->F, s->d, NULL);
  dvi__definite_clear(&solver);
  dvi__csr_clear(&H);
  if (status != DVI_SINGULAR) return status;
  return dvi__fail(DVI_SINGULAR,
                   "density: the Hessian of the static state is singular: fix a value on the "
                   "boundary, or start from a state that is not symmetric");
}

/* Try q - s d. |F| is infinite where a callback asks for another point. */
static dvi_status try_step(search *s, double part, double *size)
{
  for (int64_t i = 0; i < s->n; i++) s->trial[i] = s->q[i] - part * s->d[i];
  const dvi_status status = find_gradient(s->density, s->trial, s->part, s->F_trial);
  *size = length_of(s->n, s->F_trial);
  if (status == DVI_CALLBACK_RETRY || (status == DVI_OK && !isfinite(*size))) *size = INFINITY;
  return status == DVI_CALLBACK_RETRY ? DVI_OK : status;
}

static void take_step(search *s, double part, double size)
{
  double *const q = s->q, *const F = s->F;
  s->q = s->trial, s->trial = q;
  s->F = s->F_trial, s->F_trial = F;
  s->size = size;
  s->length = part * dvi__largest((size_t)s->n, s->d) / s->scale;
}

/* Take one step. `is_done` tells that |F| falls no more, or q is right to roundoff. */
static dvi_status advance(search *s, int *is_done)
{
  double part = 1, size;
  DVI_TRY(find_direction(s));
  s->scale = fmax(s->scale,
                  fmax(dvi__largest((size_t)s->n, s->q), dvi__largest((size_t)s->n, s->d)));
  for (int halving = 0; halving < HALVINGS; halving++, part /= 2) {
    DVI_TRY(try_step(s, part, &size));
    if (size < s->size * (1 - 1e-4 * part)) {
      take_step(s, part, size);
      *is_done = s->length <= 4 * DBL_EPSILON;
      return DVI_OK;
    }
    if (dvi__largest((size_t)s->n, s->d) <= small_step * s->scale) break;
  }
  s->length = dvi__largest((size_t)s->n, s->d) / s->scale;
  *is_done = 1;
  return DVI_OK;
}

static dvi_status iterate(search *s)
{
  int is_done = 0;
  DVI_TRY(find_gradient(s->density, s->q, s->part, s->F));
  s->size = length_of(s->n, s->F);
  s->scale = DBL_MIN;
  if (!isfinite(s->size))
    return dvi__fail(DVI_NOT_FINITE, "density: the gradient of the start is not finite");
  while (s->size > 0 && !is_done && s->iterations < ITERATIONS) {
    s->iterations++;
    DVI_TRY(advance(s, &is_done));
  }
  if (s->size == 0) s->length = 0;
  if (s->length <= small_step) return DVI_OK;
  if (s->size <= small_force * s->terms) {
    s->length = s->size / s->terms;
    return DVI_OK;
  }
  return dvi__fail(
      DVI_NOT_CONVERGED,
      "density: Newton's method stopped after %d iterations, where its step is %.2g of "
      "the state: start from a state nearer to a static one, and a kink that may be moved almost "
      "freely in the middle between the walls",
      s->iterations, s->length);
}

static dvi_status solve(const dvi_density *density, double *room, double *U,
                        dvi_field_solve_report *report)
{
  const int64_t n = density->unknowns;
  search s = {.density = density, .n = n};
  double **const vectors[] = {&s.q, &s.F, &s.d, &s.trial, &s.F_trial, &s.part};
  for (int i = 0; i < 6; i++) *vectors[i] = room + i * n;
  dvi__density_take(density, U, s.q);
  DVI_TRY(iterate(&s));
  DVI_TRY(dvi_density_lift(density, 0, s.q, U));
  if (report != NULL)
    *report = (dvi_field_solve_report){
        .unknowns = n, .iterations = s.iterations, .residual = s.length};
  return DVI_OK;
}

dvi_status dvi_density_solve(const dvi_density *density, double *U, dvi_field_solve_report *report)
{
  if (density == NULL || U == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field and coefficients are needed");
  double *room = DVI_NEW(double, 6 * density->unknowns);
  if (room == NULL) return no_memory();
  const dvi_status status = solve(density, room, U, report);
  dvi__release(room);
  return status;
}
