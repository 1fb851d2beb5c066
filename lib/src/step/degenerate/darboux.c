#include "step/degenerate/darboux.h"

#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "step/onestep/collocation.h"
#include "step/joint.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "system/term/constant_components.h"
#include "system/dynamics/one_form.h"

enum { MOST = DVI__STAGES_MOST };

struct dvi__darboux {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, m;                               /* coordinates; stages, with the end */
  int *is_x;                              /* [n] */
  int collocates;                         /* the nodes are those of Gauss */
  double a[MOST][MOST], abar[MOST][MOST]; /* row m-1 holds the weights */
  /* the same by columns, padded with zeros, and the matrix 1 */
  double a_by_columns[MOST][MOST], abar_by_columns[MOST][MOST], unit[MOST][MOST];
  double ratio; /* the lengths of steps for which `shift` continues the stages, 0 if none */
  double shift[MOST][MOST];
  /* time of a stage in the step for H, and for guesses the mean of the times of x and p */
  double time[MOST], middle[MOST];
  dvi__pattern joint, pattern; /* joint is the pattern of one block, pattern that of the Jacobian */
  dvi__joint_entry *block;     /* [entries of joint] */
  /* The current step. */
  double t0, h;
  const double *q0, *p0;
  /* Values at the stages, component by component [n*m]. */
  double *t, *Q, *V, *L_q, *L_v, *H_qq, *H_qv, *H_vv;
};

/* ---- tableaux ---- */

static const double lobatto_IIIA[2][2] = {{0, 0}, {0.5, 0.5}}, lobatto_weight[] = {0.5, 0.5};

/* Complete the tableau from the rows 0 to s-1 of a. Add the row of the weights, and make the
 * conjugate abar. */
static void darboux_complete(dvi__darboux *d, const double *b)
{
  const int s = d->m - 1;
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) d->abar[i][j] = b[j] - b[j] * d->a[j][i] / b[i];
  for (int j = 0; j < s; j++) d->a[s][j] = d->abar[s][j] = b[j];
  for (int k = 0; k <= s; k++) {
    d->unit[k][k] = 1;
    for (int j = 0; j <= s; j++) {
      d->a_by_columns[j][k] = d->a[k][j];
      d->abar_by_columns[j][k] = d->abar[k][j];
    }
    for (int j = 0; j < s; j++) d->time[k] += d->a[k][j];
    for (int j = 0; j < s; j++) d->middle[k] += 0.5 * (d->a[k][j] + d->abar[k][j]);
  }
}

static dvi_status darboux_fill_tableau(dvi__darboux *d, dvi__darboux_rule rule)
{
  double b[MOST] = {1};
  const int s = d->m - 1;
  if (rule == DVI__GAUSS_STAGES) {
    double c[MOST];
    DVI_TRY(dvi_quadrature(DVI_GAUSS, s, c, b));
    DVI_TRY(dvi__collocate(s, c, d->a));
  } else if (rule == DVI__TRAPEZOIDAL_PAIR) {
    for (int i = 0; i < 2; i++) memcpy(d->a[i], lobatto_IIIA[i], sizeof lobatto_IIIA[i]);
    memcpy(b, lobatto_weight, sizeof lobatto_weight);
  } else {
    d->a[0][0] = rule == DVI__EULER_B;
  }
  darboux_complete(d, b);
  return DVI_OK;
}

static int stages_of(dvi__darboux_rule rule, int stages)
{
  return rule == DVI__GAUSS_STAGES ? stages : rule == DVI__TRAPEZOIDAL_PAIR ? 2 : 1;
}

/* ---- create ---- */

static double **darboux_owned_array(dvi__darboux *d, int i)
{
  double **const all[] = {&d->t, &d->Q, &d->V, &d->L_q, &d->L_v, &d->H_qq, &d->H_qv, &d->H_vv};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status darboux_allocate(dvi__darboux *d)
{
  const size_t n = (size_t)d->n, m = (size_t)d->m,
               qq = (size_t)dvi__pattern_entries(&d->system->qq),
               qv = (size_t)dvi__pattern_entries(&d->system->qv);
  const size_t size[] = {m, n * m, n * m, n * m, n * m, qq * m + 1, qv * m + 1, 1};
  for (int i = 0; darboux_owned_array(d, i) != NULL; i++) {
    *darboux_owned_array(d, i) = DVI_NEW(double, size[i]);
    if (*darboux_owned_array(d, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", d->m, d->n);
  }
  return DVI_OK;
}

static dvi_status darboux_initialise(dvi__darboux *d, dvi__darboux_rule rule,
                                     dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(d->system, d->m, d->m));
  d->is_x = DVI_NEW(int, d->n);
  if (d->is_x == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  DVI_TRY(dvi__form_constant_components(d->system, d->is_x));
  DVI_TRY(darboux_fill_tableau(d, rule));
  DVI_TRY(dvi__evaluator_create(d->system, d->m, DVI__HESSIANS, counters, &d->evaluator));
  DVI_TRY(dvi__joint_create(d->system, NULL, &d->joint, &d->block));
  DVI_TRY(dvi__pattern_blocks(&d->joint, d->m, &d->pattern));
  return darboux_allocate(d);
}

dvi_status dvi__darboux_create(const dvi_system *system, dvi__darboux_rule rule, int stages,
                               dvi_counters *counters, dvi__darboux **darboux)
{
  *darboux = NULL;
  dvi__darboux *d = DVI_NEW(dvi__darboux, 1);
  if (d == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  d->system = system;
  d->n = system->n;
  d->m = stages_of(rule, stages) + 1;
  d->collocates = rule == DVI__GAUSS_STAGES;
  const dvi_status status = darboux_initialise(d, rule, counters);
  if (status != DVI_OK) dvi__darboux_destroy(&d);
  *darboux = d;
  return status;
}

void dvi__darboux_destroy(dvi__darboux **darboux)
{
  dvi__darboux *d = *darboux;
  if (d == NULL) return;
  for (int i = 0; darboux_owned_array(d, i) != NULL; i++) dvi__release(*darboux_owned_array(d, i));
  dvi__evaluator_destroy(&d->evaluator);
  dvi__pattern_clear(&d->joint);
  dvi__pattern_clear(&d->pattern);
  dvi__release(d->block);
  dvi__release(d->is_x);
  dvi__release(d);
  *darboux = NULL;
}

const dvi__pattern *dvi__darboux_pattern(const dvi__darboux *d)
{
  return &d->pattern;
}

dvi__evaluator *dvi__darboux_evaluator(const dvi__darboux *d)
{
  return d->evaluator;
}

int dvi__darboux_is_x(const dvi__darboux *d, int i)
{
  return d->is_x[i];
}

void dvi__darboux_place(dvi__darboux *d, double t0, double h, const double *q0, const double *p0)
{
  d->t0 = t0;
  d->h = h;
  d->q0 = q0;
  d->p0 = p0;
  for (int k = 0; k < d->m; k++) d->t[k] = t0 + d->time[k] * h;
}

/* ---- residual ---- */

static double darboux_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int j = 0; j < count; j++) sum += x[j] * y[j];
  return sum;
}

/* Compute the stages. The velocity of y stands in no equation, because its components of the
 * one-form are constant. */
static void darboux_points(dvi__darboux *d, const double *x)
{
  const int m = d->m;
  for (int i = 0; i < d->n; i++, x += m)
    for (int k = 0; k < m; k++) {
      d->V[i * m + k] = d->is_x[i] ? x[k] / d->h : 0;
      d->Q[i * m + k] = d->q0[i] + (d->is_x[i] ? darboux_dot(m, d->a[k], x) : x[k]);
    }
}

/* The roundings of a component that never moves are smaller than this. */
static const double constant_to = 1e-11;

static dvi_status check_constants(const dvi__darboux *d)
{
  double scale = 0;
  for (int i = 0; i < d->n * d->m; i++) scale = fmax(scale, fabs(d->L_v[i]));
  for (int i = 0; i < d->n; i++)
    for (int k = 0; k < d->m && !d->is_x[i]; k++)
      if (fabs(d->L_v[i * d->m + k] - d->p0[i]) > constant_to * scale)
        return dvi__fail(DVI_UNSUPPORTED,
                         "component %d of the one-form, which was constant at all points probed, "
                         "changes here by %.3g",
                         i, d->L_v[i * d->m + k] - d->p0[i]);
  return DVI_OK;
}

dvi_status dvi__darboux_residual(dvi__darboux *d, const double *x, double *R)
{
  const int m = d->m;
  darboux_points(d, x);
  DVI_TRY(dvi__lagrangian_gradient(d->evaluator, m, d->t, d->Q, d->V, d->L_q, d->L_v));
  DVI_TRY(check_constants(d));
  for (int i = 0; i < d->n; i++) {
    const double *F = d->L_q + i * m, *theta = d->L_v + i * m;
    for (int k = 0; k < m; k++)
      R[i * m + k] = d->is_x[i] ? (theta[k] - d->p0[i]) - d->h * darboux_dot(m, d->abar[k], F)
                                : d->h * F[k];
  }
  return DVI_OK;
}

void dvi__darboux_end(const dvi__darboux *d, const double *x, double *dq)
{
  for (int i = 0; i < d->n; i++, x += d->m)
    dq[i] = d->is_x[i] ? darboux_dot(d->m, d->a[d->m - 1], x) : x[d->m - 1];
}

/* ---- Jacobian ---- */

/* An entry (i,j) of the joint pattern has d alpha_i/dq_j (A) at the stages, and the derivatives of
 * h F_i by Q_j (K) and by W_j (B). */
typedef struct entry {
  double A[MOST], B[MOST], K[MOST];
} entry;

static void darboux_gather_entry(const dvi__darboux *d, const dvi__joint_entry *where, entry *e)
{
  *e = (entry){{0}, {0}, {0}};
  for (int k = 0; k < d->m; k++) {
    if (where->vq >= 0) e->A[k] = d->H_qv[where->vq * d->m + k];
    if (where->qv >= 0) e->B[k] = d->H_qv[where->qv * d->m + k];
    if (where->qq >= 0) e->K[k] = d->h * d->H_qq[where->qq * d->m + k];
  }
}

/* Fill the rows of a block in column l of x, whose unknown W_l moves all X_k by a_kl. The stages
 * are lanes. */
INLINE void column_of_x(const dvi__darboux *d, const entry *e, int row_is_x, int l, const int lanes,
                        double *column)
{
  double F[MOST] = {0}, rows[MOST];
  const double *moved = d->a_by_columns[l];
  for (int k = 0; k < lanes; k++) F[k] = e->K[k] * moved[k] + e->B[k] * d->unit[l][k];
  for (int k = 0; k < lanes; k++) rows[k] = row_is_x ? e->A[k] * moved[k] : F[k];
  for (int j = 0; j < d->m && row_is_x; j++)
    for (int k = 0; k < lanes; k++) rows[k] -= F[j] * d->abar_by_columns[j][k];
  memcpy(column, rows, (size_t)d->m * sizeof *rows);
}

/* The same in a column of y, whose unknown is Y_l alone. */
INLINE void column_of_y(const dvi__darboux *d, const entry *e, int row_is_x, int l, const int lanes,
                        double *column)
{
  double rows[MOST];
  for (int k = 0; k < lanes; k++) {
    const double at = d->unit[l][k];
    rows[k] = row_is_x ? e->A[k] * at - e->K[l] * d->abar_by_columns[l][k] : e->K[k] * at;
  }
  memcpy(column, rows, (size_t)d->m * sizeof *rows);
}

INLINE void block_columns(const dvi__darboux *d, const entry *e, int row_is_x, int column_is_x,
                          const int lanes, size_t step, double *columns)
{
  for (int l = 0; l < d->m; l++, columns += step)
    if (column_is_x)
      column_of_x(d, e, row_is_x, l, lanes, columns);
    else
      column_of_y(d, e, row_is_x, l, lanes, columns);
}

/* Fill all columns of a block, which are `step` numbers apart. */
WIDE static void fill_block(const dvi__darboux *d, const entry *e, int row_is_x, int column_is_x,
                            size_t step, double *columns)
{
  if (d->m <= MOST / 2)
    block_columns(d, e, row_is_x, column_is_x, MOST / 2, step, columns);
  else
    block_columns(d, e, row_is_x, column_is_x, MOST, step, columns);
}

dvi_status dvi__darboux_jacobian(dvi__darboux *d, const double *x, double *values)
{
  const size_t m = (size_t)d->m;
  darboux_points(d, x);
  DVI_TRY(dvi__lagrangian_hessian(d->evaluator, d->m, d->t, d->Q, d->V, d->H_qq, d->H_qv, d->H_vv));
  for (int j = 0; j < d->n; j++) {
    const int first = d->joint.start[j], length = d->joint.start[j + 1] - first;
    for (int at = 0; at < length; at++) {
      entry e;
      darboux_gather_entry(d, &d->block[first + at], &e);
      fill_block(d, &e, d->is_x[d->joint.row[first + at]], d->is_x[j], (size_t)length * m,
                 values + m * m * (size_t)first + m * (size_t)at);
    }
  }
  return DVI_OK;
}

dvi_status dvi__darboux_scale(dvi__darboux *d, double *scale)
{
  DVI_TRY(dvi__form_scale(d->evaluator, d->q0, d->V));
  for (int i = 0; i < d->n * d->m; i++) scale[i] = d->V[i / d->m];
  return DVI_OK;
}

/* ---- guesses ---- */

void dvi__darboux_straight(const dvi__darboux *d, const double *v, double *x)
{
  for (int i = 0; i < d->n; i++, x += d->m)
    for (int k = 0; k < d->m; k++) x[k] = d->h * v[i] * (d->is_x[i] ? 1 : d->middle[k]);
}

/* Continue the polynomial through the stages. Only Gauss's stages lie close enough to the solution
 * for this. */
static void continue_polynomial(dvi__darboux *d, double ratio, const double *last, double *x)
{
  for (int k = 0; k < d->m && ratio != d->ratio; k++)
    dvi__lagrange_weights(d->m, d->middle, 1 + ratio * d->middle[k], d->shift[k]);
  d->ratio = ratio;
  for (int k = 0; k < d->m; k++) {
    for (int i = 0; i < d->n; i++) {
      const double *own = last + i * d->m, continued = darboux_dot(d->m, d->shift[k], own);
      x[i * d->m + k] = d->is_x[i] ? ratio * continued : continued - own[d->m - 1];
    }
  }
}

void dvi__darboux_continue(dvi__darboux *d, double ratio, const double *last, double *x)
{
  if (d->collocates) {
    continue_polynomial(d, ratio, last, x);
    return;
  }
  for (int i = 0; i < d->n; i++, x += d->m, last += d->m)
    for (int k = 0; k < d->m; k++) x[k] = ratio * last[d->m - 1] * (d->is_x[i] ? 1 : d->middle[k]);
}
