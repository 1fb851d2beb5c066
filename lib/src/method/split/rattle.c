#include "method/split/rattle.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/finite.h"
#include "num/linear.h"
#include "system/dynamics/holonomic.h"
#include "system/dynamics/holonomic_rows.h"

struct dvi__rattle {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi_counters *counters;
  dvi__pattern pattern;  /* of G M^-1 G^T */
  dvi__linear *definite; /* takes this matrix for positive masses on the diagonal, else NULL */
  dvi__linear *general;  /* takes dependent rows and gradients at two places */
  dvi__linear *matrix;   /* the one of these with the last factor */
  double *values;        /* [entries] */
  /* For masses on the diagonal, entry e of the matrix is the sum of the products of the entries
   * `left` and `right` of G, pairs first[e] to first[e+1]-1. */
  int *first, *left, *right;
  int knows_start; /* the matrix and the gradients are those of t_start and q_start */
  int dependent, start_dependent; /* rows depend on others, now, and in the matrix of the start */
  double softness;                /* of the matrix of dependent rows */
  double t_start;
  double *numbers;         /* storage of all that follows */
  double *q_start;         /* [n] */
  double *phi_q, *next_q;  /* [entries of rows_q] gradients at the start, and on the way */
  double *moved_q;         /* [entries of rows_q] M^-1 phi_q for masses on the diagonal */
  double *phi, *phi_t, *w; /* [rows]; w is a correction of the multipliers */
  double *mu;              /* [rows] multipliers at the end */
  double *scale;           /* [rows] powers of two near the sizes of M^-1/2 G^T, inverted */
  double *x, *change, *v;  /* [n]; change is q1 - q0 */
};

/* ---- create ---- */

static int masses_are_diagonal(const dvi_system *s)
{
  return s->mass_values == NULL;
}

/* Count the coordinates that two rows share, and note the pairs of their entries from `at` on, if
 * there is room for them. */
static int pair_rows(const dvi__rattle *r, int a, int b, int at)
{
  const dvi__pattern *G = &r->system->rows_q;
  int i = G->start[a], j = G->start[b], count = 0;
  while (i < G->start[a + 1] && j < G->start[b + 1])
    if (G->row[i] < G->row[j])
      i++;
    else if (G->row[i] > G->row[j])
      j++;
    else {
      if (r->left != NULL) {
        r->left[at + count] = i;
        r->right[at + count] = j;
      }
      count++, i++, j++;
    }
  return count;
}

/* Make the pattern of the rows that share a coordinate. `rows_of` has the rows of each
 * coordinate. `seen` [rows] is work. */
static int lay_out_columns(dvi__rattle *r, const dvi__pattern *rows_of, int *seen)
{
  const dvi__pattern *G = &r->system->rows_q;
  const int m = r->system->row_count;
  int count = 0;
  for (int a = 0; a < m; a++) seen[a] = -1;
  for (int b = 0; b < m; b++) {
    const int begin = count;
    for (int k = G->start[b]; k < G->start[b + 1]; k++)
      for (int l = rows_of->start[G->row[k]]; l < rows_of->start[G->row[k] + 1]; l++) {
        const int a = rows_of->row[l];
        if (seen[a] == b) continue;
        seen[a] = b;
        int at = count++;
        if (r->pattern.row == NULL) continue;
        for (; at > begin && r->pattern.row[at - 1] > a; at--)
          r->pattern.row[at] = r->pattern.row[at - 1];
        r->pattern.row[at] = a;
      }
    r->pattern.start[b + 1] = count;
  }
  return count;
}

static dvi_status lay_out_shared(dvi__rattle *r, const dvi__pattern *rows_of)
{
  const int m = r->system->row_count;
  int *seen = DVI_NEW(int, m);
  r->pattern = (dvi__pattern){m, m, DVI_NEW(int, (size_t)m + 1), NULL};
  if (seen != NULL && r->pattern.start != NULL) {
    r->pattern.row = DVI_NEW(int, lay_out_columns(r, rows_of, seen));
    if (r->pattern.row != NULL) (void)lay_out_columns(r, rows_of, seen);
  }
  dvi__release(seen);
  return r->pattern.row != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "verlet: no memory for %d constraints", m);
}

static int pair_entries(dvi__rattle *r)
{
  int count = 0;
  for (int b = 0; b < r->pattern.columns; b++)
    for (int e = r->pattern.start[b]; e < r->pattern.start[b + 1]; e++) {
      r->first[e] = count;
      count += pair_rows(r, r->pattern.row[e], b, count);
    }
  r->first[dvi__pattern_entries(&r->pattern)] = count;
  return count;
}

static dvi_status prepare_pairs(dvi__rattle *r)
{
  dvi__pattern rows_of = {0};
  DVI_TRY(dvi__pattern_transpose(&r->system->rows_q, &rows_of));
  const dvi_status status = lay_out_shared(r, &rows_of);
  dvi__pattern_clear(&rows_of);
  DVI_TRY(status);
  r->first = DVI_NEW(int, (size_t)dvi__pattern_entries(&r->pattern) + 1);
  if (r->first == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory for constraints");
  const int pairs = pair_entries(r);
  r->left = DVI_NEW(int, pairs);
  r->right = DVI_NEW(int, pairs);
  if (r->left == NULL || r->right == NULL)
    return dvi__fail(DVI_NO_MEMORY, "verlet: no memory for constraints");
  (void)pair_entries(r);
  return DVI_OK;
}

static dvi_status rattle_allocate(dvi__rattle *r)
{
  const size_t n = (size_t)r->system->n, m = (size_t)r->system->row_count,
               entries = (size_t)dvi__pattern_entries(&r->system->rows_q);
  double *at = r->numbers = DVI_NEW(double, 4 * n + 5 * m + 3 * entries);
  r->values = DVI_NEW(double, dvi__pattern_entries(&r->pattern));
  if (at == NULL || r->values == NULL)
    return dvi__fail(DVI_NO_MEMORY, "verlet: no memory for %zu constraints", m);
  r->q_start = at;
  r->x = r->q_start + n;
  r->change = r->x + n;
  r->v = r->change + n;
  r->phi = r->v + n;
  r->phi_t = r->phi + m;
  r->w = r->phi_t + m;
  r->mu = r->w + m;
  r->scale = r->mu + m;
  r->phi_q = r->scale + m;
  r->next_q = r->phi_q + entries;
  r->moved_q = r->next_q + entries;
  return DVI_OK;
}

static dvi_status rattle_prepare(dvi__rattle *r)
{
  const int m = r->system->row_count;
  if (masses_are_diagonal(r->system))
    DVI_TRY(prepare_pairs(r));
  else
    DVI_TRY(dvi__pattern_copy_rectangular(&(dvi_pattern){0}, m, m, "constraints", &r->pattern));
  DVI_TRY(rattle_allocate(r));
  if (masses_are_diagonal(r->system) && dvi__mass_is_positive(r->evaluator))
    DVI_TRY(dvi__linear_create(&r->pattern, DVI__LINEAR_DEFINITE, r->counters, &r->definite));
  return dvi__linear_create(&r->pattern, DVI__LINEAR_AUTO, r->counters, &r->general);
}

dvi_status dvi__rattle_create(const dvi_system *system, dvi__evaluator *evaluator,
                              dvi_counters *counters, dvi__rattle **rattle)
{
  dvi__rattle *r = *rattle = DVI_NEW(dvi__rattle, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  r->system = system;
  r->evaluator = evaluator;
  r->counters = counters;
  const dvi_status status = rattle_prepare(r);
  if (status != DVI_OK) dvi__rattle_destroy(rattle);
  return status;
}

int dvi__rattle_has_matrix(const dvi__rattle *r, dvi__rattle_matrix *matrix)
{
  *matrix = (dvi__rattle_matrix){&r->pattern, r->first, r->left, r->right};
  return r->definite != NULL;
}

void dvi__rattle_destroy(dvi__rattle **rattle)
{
  dvi__rattle *r = *rattle;
  if (r == NULL) return;
  dvi__linear_destroy(&r->definite);
  dvi__linear_destroy(&r->general);
  dvi__pattern_clear(&r->pattern);
  dvi__release(r->first);
  dvi__release(r->left);
  dvi__release(r->right);
  dvi__release(r->values);
  dvi__release(r->numbers);
  dvi__release(r);
  *rattle = NULL;
}

/* ---- the matrix ---- */

/* Compute rows M^-1 G^T with G at the start. */
static void multiply_by_pairs(dvi__rattle *r, const double *rows)
{
  const int entries = dvi__pattern_entries(&r->pattern);
  for (int e = 0; e < entries; e++) {
    double sum = 0;
    for (int k = r->first[e]; k < r->first[e + 1]; k++)
      sum += rows[r->left[k]] * r->moved_q[r->right[k]];
    r->values[e] = sum;
  }
}

/* Set x to M^-1 G^T w. */
static void move_by(dvi__rattle *r, const double *w, double *x)
{
  const int is_diagonal = masses_are_diagonal(r->system);
  memset(x, 0, (size_t)r->system->n * sizeof *x);
  dvi__rows_pull(r->system, is_diagonal ? r->moved_q : r->phi_q, w, 1, x);
  if (!is_diagonal) dvi__mass_solve(r->evaluator, 1, x, x);
}

static void multiply_by_columns(dvi__rattle *r, const double *rows)
{
  const dvi_system *s = r->system;
  const int m = s->row_count;
  for (int b = 0; b < m; b++) {
    memset(r->x, 0, (size_t)s->n * sizeof(double));
    for (int k = s->rows_q.start[b]; k < s->rows_q.start[b + 1]; k++)
      r->x[s->rows_q.row[k]] = r->phi_q[k];
    dvi__mass_solve(r->evaluator, 1, r->x, r->x);
    for (int a = 0; a < m; a++) {
      double sum = 0;
      for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
        sum += rows[k] * r->x[s->rows_q.row[k]];
      r->values[b * m + a] = sum;
    }
  }
}

/* Scale the rows and columns by the diagonal, and add a part of it where rows depend on others
 * (dvi__rows_soften). */
static void scale_matrix(dvi__rattle *r)
{
  const dvi__pattern *P = &r->pattern;
  for (int a = 0; a < P->columns; a++) {
    const double square = fabs(r->values[dvi__pattern_find(P, a, a)]);
    r->scale[a] = square > 0 && isfinite(square) ? ldexp(1.0, -(ilogb(square) / 2)) : 1;
  }
  for (int b = 0; b < P->columns; b++)
    for (int e = P->start[b]; e < P->start[b + 1]; e++) {
      r->values[e] *= r->scale[P->row[e]] * r->scale[b];
      if (P->row[e] == b && r->dependent) r->values[e] *= 1 + r->softness;
    }
}

/* Replace w by the multipliers whose momenta change the rows by w. */
static dvi_status solve_matrix(dvi__rattle *r)
{
  const int m = r->system->row_count;
  if (r->matrix == r->definite) return dvi__linear_solve(r->matrix, r->w);
  for (int a = 0; a < m; a++) r->w[a] *= r->scale[a];
  DVI_TRY(dvi__linear_solve(r->matrix, r->w));
  for (int a = 0; a < m; a++) r->w[a] *= r->scale[a];
  return DVI_OK;
}

/* Factor rows M^-1 G^T of gradients here and of those at the start, which may be the same. */
static dvi_status factor_matrix(dvi__rattle *r, double t, const double *rows)
{
  const int is_definite = rows == r->phi_q && r->definite != NULL && !r->dependent;
  r->counters->jacobians++;
  if (masses_are_diagonal(r->system))
    multiply_by_pairs(r, rows);
  else
    multiply_by_columns(r, rows);
  if (!is_definite) scale_matrix(r);
  r->matrix = is_definite ? r->definite : r->general;
  const dvi_status status = dvi__linear_factor(r->matrix, r->values);
  return status != DVI_SINGULAR
             ? status
             : dvi__fail(status, "the holonomic constraints are dependent at t = %.6g", t);
}

/* Factor the matrix at a point, unless it is known. */
static dvi_status factor_at(dvi__rattle *r, double t, const double *q)
{
  const size_t size = (size_t)r->system->n * sizeof *q;
  if (r->knows_start && r->t_start == t && r->start_dependent == r->dependent &&
      memcmp(r->q_start, q, size) == 0)
    return DVI_OK;
  r->knows_start = 0;
  r->softness = DVI__SOFTNESS;
  DVI_TRY(dvi__rows_gradients(r->evaluator, t, q, r->phi_q));
  const double *mass = r->system->mass_diagonal;
  for (int k = 0; mass != NULL && k < dvi__pattern_entries(&r->system->rows_q); k++)
    r->moved_q[k] = r->phi_q[k] / mass[r->system->rows_q.row[k]];
  DVI_TRY(factor_matrix(r, t, r->phi_q));
  r->t_start = t;
  memcpy(r->q_start, q, size);
  r->knows_start = 1;
  r->start_dependent = r->dependent;
  return DVI_OK;
}

/* ---- the start of a step ---- */

/* Compute phi at q0 plus the change. */
static dvi_status value_at_end(dvi__rattle *r, const dvi__state *state, double h)
{
  r->counters->residuals++;
  for (int i = 0; i < r->system->n; i++)
    r->x[i] = state->q[i] + (r->change[i] - state->q_compensation[i]);
  DVI_TRY(dvi__rows_value(r->evaluator, state->t + h, r->x, r->phi));
  if (dvi__first_not_finite((size_t)r->system->row_count, r->phi) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the constraints at the end of the step are not finite");
}

/* Take the matrix of Newton's method at the present end, x. */
static dvi_status renew_matrix(dvi__rattle *r, const dvi__state *state, double h)
{
  r->knows_start = 0;
  DVI_TRY(dvi__rows_gradients(r->evaluator, state->t + h, r->x, r->next_q));
  const dvi_status status = factor_matrix(r, state->t + h, r->next_q);
  return status == DVI_SINGULAR ? DVI_NOT_CONVERGED : status; /* a smaller step ends elsewhere */
}

/* Correct the multipliers w = h^2 lambda/2 by one iteration. *moved becomes the largest change of
 * a coordinate. */
static dvi_status correct(dvi__rattle *r, double h, double *lambda, double *moved)
{
  const int n = r->system->n, m = r->system->row_count;
  memcpy(r->w, r->phi, (size_t)m * sizeof(double));
  DVI_TRY(solve_matrix(r));
  if (dvi__first_not_finite((size_t)m, r->w) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the multipliers of the step are not finite");
  const double per_step = 2 / (h * h);
  move_by(r, r->w, r->x);
  for (int i = 0; i < n; i++) r->change[i] -= r->x[i];
  for (int a = 0; a < m; a++) lambda[a] += per_step * r->w[a];
  *moved = dvi__largest((size_t)n, r->x);
  return DVI_OK;
}

/* Look for a point within the step where the rank drops, which changes the sign of
 * det(G1 M^-1 G0^T). A kept matrix is tested only if it is nearly singular, and small. */
static dvi_status check_passage(dvi__rattle *r, const dvi__state *state, double h, int renewed)
{
  enum { ROWS_MOST = 64 };
  const int look = r->system->row_count <= ROWS_MOST &&
                   dvi__linear_condition(r->matrix) < DVI__RATTLE_SUSPICIOUS;
  if (!renewed && !look) return DVI_OK;
  DVI_TRY(value_at_end(r, state, h));
  if (!renewed) DVI_TRY(renew_matrix(r, state, h));
  if (dvi__linear_sign(r->matrix) > 0) return DVI_OK;
  const double t[] = {state->t, state->t + h}, *const q[] = {state->q, r->x};
  dvi__rows_soften(r->evaluator, r->dependent);
  return dvi__rows_stay_regular(r->evaluator, t, q, r->v);
}

/* A kept matrix serves independent rows. The residual of dependent ones is consistent with the
 * gradients at its own place, but for the square of its distance from the constraints. A softness
 * in proportion to that distance keeps the multipliers small, and Newton's method quadratic
 * (Levenberg and Marquardt's; Yamashita and Fukushima 2001). */
static dvi_status find_multipliers(dvi__rattle *r, const dvi__state *state, double h,
                                   double *lambda)
{
  const size_t n = (size_t)r->system->n;
  const double size = fmax(dvi__largest(n, state->q), dvi__largest(n, r->change));
  double moved = HUGE_VAL, last = HUGE_VAL;
  int renewed = 0;
  for (int iteration = 0; iteration < DVI__RATTLE_ITERATIONS; iteration++) {
    DVI_TRY(value_at_end(r, state, h));
    r->softness = fmax(fmin(moved / size, 1e-2), DVI__SOFTNESS);
    if (r->dependent || (iteration > 1 && !(moved <= DVI__RATTLE_FAST_CHANGE * last))) {
      DVI_TRY(renew_matrix(r, state, h));
      renewed = 1;
    }
    last = moved;
    DVI_TRY(correct(r, h, lambda, &moved));
    if (!dvi__rattle_is_settled(moved, last, size)) continue;
    DVI_TRY(check_passage(r, state, h, renewed));
    *(renewed ? &r->counters->newtons : &r->counters->simplified) += 1;
    return DVI_OK;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the multipliers of the step do not settle in %d iterations (change %.1e)",
                   (int)DVI__RATTLE_ITERATIONS, moved);
}

/* The multipliers of a step's start differ from those at its end, and these from those of the next
 * start, by differences that hardly change from step to step (rattle.h). */
static void guess_start(dvi__rattle *r, double h, double *lambda, double *trend)
{
  const int m = r->system->row_count;
  /* what has no effect at one state may have some at the next one */
  if (r->dependent) {
    memset(lambda, 0, (size_t)m * sizeof *lambda);
    if (trend != NULL) memset(trend, 0, DVI__RATTLE_TREND * (size_t)m * sizeof *trend);
  }
  for (int a = 0; a < m; a++) r->mu[a] = lambda[a];
  for (int a = 0; trend != NULL && a < m; a++) lambda[a] += h * trend[a];
}

/* A row without a multiplier before, as at the start of a run, has no difference. */
static void note_start(const dvi__rattle *r, double h, const double *lambda, double *trend)
{
  for (int a = 0; trend != NULL && a < r->system->row_count; a++)
    if (r->mu[a] != 0) trend[a] = (lambda[a] - r->mu[a]) / h;
}

dvi_status dvi__rattle_begin(dvi__rattle *r, dvi__state *state, double h, double *lambda,
                             double *trend)
{
  const int n = r->system->n, m = r->system->row_count;
  r->dependent = state->side > 1;
  DVI_TRY(factor_at(r, state->t, state->q));
  guess_start(r, h, lambda, trend);
  dvi__mass_solve(r->evaluator, 1, state->p, r->change);
  for (int a = 0; a < m; a++) r->w[a] = 0.5 * h * h * lambda[a];
  move_by(r, r->w, r->x);
  for (int i = 0; i < n; i++) r->change[i] = h * r->change[i] - r->x[i];
  DVI_TRY(find_multipliers(r, state, h, lambda));
  note_start(r, h, lambda, trend);
  memset(r->x, 0, (size_t)n * sizeof(double));
  dvi__rows_pull(r->system, r->phi_q, lambda, -0.5 * h, r->x);
  dvi__add_compensated_all(n, state->p, state->p_compensation, r->x);
  return DVI_OK;
}

/* ---- the end of a step ---- */

/* Solve G M^-1 (p - G^T (mu + w)) + phi_t = 0 for w, and add it to mu. *changed becomes its size
 * beside that of mu. */
static dvi_status correct_end(dvi__rattle *r, const dvi__state *state, double *changed)
{
  const dvi_system *s = r->system;
  const size_t n = (size_t)s->n, m = (size_t)s->row_count;
  memset(r->x, 0, n * sizeof(double));
  dvi__rows_pull(s, r->phi_q, r->mu, -1, r->x);
  for (size_t i = 0; i < n; i++) r->v[i] = state->p[i] + (r->x[i] - state->p_compensation[i]);
  dvi__mass_solve(r->evaluator, 1, r->v, r->v);
  dvi__rows_push(s, r->phi_q, r->v, r->phi_t, r->w);
  DVI_TRY(solve_matrix(r));
  if (dvi__first_not_finite(m, r->w) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the multipliers at the end of the step are not finite");
  for (size_t a = 0; a < m; a++) r->mu[a] += r->w[a];
  *changed = dvi__largest(m, r->w) / dvi__largest(m, r->mu);
  return DVI_OK;
}

static void guess_end(dvi__rattle *r, double h, const double *lambda, const double *trend)
{
  const int m = r->system->row_count;
  for (int a = 0; a < m; a++)
    r->mu[a] = 0.5 * h * (lambda[a] + (trend != NULL ? h * trend[m + a] : 0));
}

static void note_end(const dvi__rattle *r, double h, double *lambda, double *trend)
{
  const int m = r->system->row_count;
  for (int a = 0; a < m; a++) {
    const double at_end = 2 * r->mu[a] / h;
    if (trend != NULL) trend[m + a] = (at_end - lambda[a]) / h;
    lambda[a] = at_end;
  }
}

/* Find mu [rows] from its guess. A large correction, or one by the matrix of dependent rows, is
 * corrected once more. */
static dvi_status find_end(dvi__rattle *r, dvi__state *state)
{
  double changed;
  r->dependent = state->side > 1;
  const dvi_status status = factor_at(r, state->t, state->q);
  /* a smaller step may end elsewhere */
  if (status != DVI_OK)
    return dvi__fail_in(status == DVI_SINGULAR ? DVI_NOT_CONVERGED : status, "the end of the step");
  DVI_TRY(dvi__rows_rate(r->evaluator, state->t, state->q, r->phi_t));
  DVI_TRY(correct_end(r, state, &changed));
  if (changed > DVI__RATTLE_SMALL_CHANGE || r->dependent) DVI_TRY(correct_end(r, state, &changed));
  memset(r->x, 0, (size_t)r->system->n * sizeof(double));
  dvi__rows_pull(r->system, r->phi_q, r->mu, -1, r->x);
  dvi__add_compensated_all(r->system->n, state->p, state->p_compensation, r->x);
  return DVI_OK;
}

dvi_status dvi__rattle_end(dvi__rattle *r, dvi__state *state, double h, double *lambda,
                           double *trend)
{
  guess_end(r, h, lambda, trend);
  DVI_TRY(find_end(r, state));
  note_end(r, h, lambda, trend);
  return DVI_OK;
}

dvi_status dvi__rattle_project(dvi__rattle *r, dvi__state *state)
{
  memset(r->mu, 0, (size_t)r->system->row_count * sizeof(double));
  return find_end(r, state);
}
