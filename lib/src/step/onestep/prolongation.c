#include "step/onestep/prolongation.h"

#include <math.h>
#include <string.h>

#include "step/onestep/flow_series.h"
#include "core/memory.h"
#include "core/status.h"
#include "space/osculation.h"

enum { START, END, ENDS, COEFFICIENTS = DVI__PROLONGATION_MOST + 1, UNKNOWNS = 3 };

struct dvi__prolongation {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi__flow_series *motion[ENDS];
  /* count is the number of coefficients of L in the quadrature */
  int n, m, count;
  /* [row][end] R_row is the sum over j of these times A_j or B_j */
  double plain[ENDS][ENDS][COEFFICIENTS];
  double weight[COEFFICIENTS];   /* w_j */
  dvi__pattern full, transposed; /* pattern of the Jacobian; pattern of dR/d(v0,v1)^T */
  dvi__linear *multipliers;      /* factors of dR/d(v0,v1)^T */
  /* [3 n] unknowns to which all numbers below belong, if `known` */
  double *at;
  int known;
  /* The current step. */
  double t0, h;
  const double *q0, *p0;
  double row[ENDS][ENDS][COEFFICIENTS]; /* `plain` times h^j */
  double w[ENDS][COEFFICIENTS];         /* weights of G_0 and G_1 */
  double *q[ENDS], *v[ENDS];            /* [n] */
  /* [row][end] dR_row/dq_end without the identity's part, n x n column by column */
  double *by_q[ENDS][ENDS];
  double *by_v[ENDS][ENDS]; /* dR_row/d(h v_end) */
  double *R[ENDS];          /* [n] */
  /* [m], [m*n] coefficients of L at one end, and their derivatives in q and v there */
  double *L, *L_q, *L_v;
  double *G_q[ENDS]; /* [n] dG_end/dq_end */
  double *lambda;    /* [2 n] */
  double *values;    /* values of the multipliers' matrix */
};

/* ---- create ---- */

/* Take the next `count` numbers of a block. Without a block, count the numbers only. */
static double *prolongation_take_block(double *block, size_t *used, size_t count)
{
  double *const at = block != NULL ? block + *used : NULL;
  *used += count;
  return at;
}

/* Lay all arrays into one block. Returns its size. */
static size_t prolongation_lay_out(dvi__prolongation *d, double *block)
{
  const size_t n = (size_t)d->n, m = (size_t)d->m;
  size_t used = 0;
  for (int end = 0; end < ENDS; end++) {
    d->q[end] = prolongation_take_block(block, &used, n);
    d->v[end] = prolongation_take_block(block, &used, n);
    d->R[end] = prolongation_take_block(block, &used, n);
    d->G_q[end] = prolongation_take_block(block, &used, n);
    for (int row = 0; row < ENDS; row++) {
      d->by_q[row][end] = prolongation_take_block(block, &used, n * n);
      d->by_v[row][end] = prolongation_take_block(block, &used, n * n);
    }
  }
  d->at = prolongation_take_block(block, &used, UNKNOWNS * n);
  d->L = prolongation_take_block(block, &used, m);
  d->L_q = prolongation_take_block(block, &used, m * n);
  d->L_v = prolongation_take_block(block, &used, m * n);
  d->lambda = prolongation_take_block(block, &used, 2 * n);
  d->values = prolongation_take_block(block, &used, 4 * n * n);
  return used;
}

static void fill_weights(dvi__prolongation *d)
{
  const int m = d->m, terms = m / 2;
  double a[COEFFICIENTS], b[COEFFICIENTS];
  dvi__hermite_next(m, a, b);
  a[m] = -1;
  b[m] = 0;
  for (int j = 0; j <= m; j++) {
    const double sign = j % 2 ? -1 : 1;
    d->plain[START][START][j] = a[j];
    d->plain[START][END][j] = b[j];
    d->plain[END][START][j] = sign * b[j];
    d->plain[END][END][j] = sign * a[j];
  }
  d->count = dvi__osculation_count(DVI__EULER_MACLAURIN, terms);
  dvi__osculation_weights(DVI__EULER_MACLAURIN, terms, d->weight);
}

static dvi_status prolongation_initialise(dvi__prolongation *d, dvi_counters *counters)
{
  const int n = d->n;
  for (int end = 0; end < ENDS; end++)
    DVI_TRY(dvi__flow_series_create(d->system, d->m, DVI__HESSIANS, counters, &d->motion[end]));
  DVI_TRY(dvi__evaluator_create(d->system, 1, DVI__GRADIENTS, counters, &d->evaluator));
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, UNKNOWNS * n, "step", &d->full));
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, 2 * n, "multipliers", &d->transposed));
  DVI_TRY(dvi__linear_create(&d->transposed, DVI__LINEAR_DENSE, counters, &d->multipliers));
  double *block = DVI_NEW(double, prolongation_lay_out(d, NULL));
  (void)prolongation_lay_out(d, block);
  if (block == NULL)
    return dvi__fail(DVI_NO_MEMORY, "no memory for %d derivatives in %d dimensions", d->m, n);
  fill_weights(d);
  return DVI_OK;
}

dvi_status dvi__prolongation_create(const dvi_system *system, int m, dvi_counters *counters,
                                    dvi__prolongation **prolongation)
{
  *prolongation = NULL;
  dvi__prolongation *d = DVI_NEW(dvi__prolongation, 1);
  if (d == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  d->system = system;
  d->n = system->n;
  d->m = m;
  const dvi_status status = prolongation_initialise(d, counters);
  if (status != DVI_OK) dvi__prolongation_destroy(&d);
  *prolongation = d;
  return status;
}

void dvi__prolongation_destroy(dvi__prolongation **prolongation)
{
  dvi__prolongation *d = *prolongation;
  if (d == NULL) return;
  for (int end = 0; end < ENDS; end++) dvi__flow_series_destroy(&d->motion[end]);
  dvi__evaluator_destroy(&d->evaluator);
  dvi__linear_destroy(&d->multipliers);
  dvi__pattern_clear(&d->full);
  dvi__pattern_clear(&d->transposed);
  dvi__release(d->q[START]); /* the block begins here */
  dvi__release(d);
  *prolongation = NULL;
}

const dvi__pattern *dvi__prolongation_pattern(const dvi__prolongation *d)
{
  return &d->full;
}

dvi__evaluator *dvi__prolongation_evaluator(const dvi__prolongation *d)
{
  return d->evaluator;
}

void dvi__prolongation_place(dvi__prolongation *d, double t0, double h, const double *q0,
                             const double *p0)
{
  double power = 1; /* h^j */
  d->known = 0;
  d->t0 = t0;
  d->h = h;
  d->q0 = q0;
  d->p0 = p0;
  for (int j = 0; j <= d->m; j++, power *= h) {
    for (int row = 0; row < ENDS; row++)
      for (int end = 0; end < ENDS; end++) d->row[row][end][j] = d->plain[row][end][j] * power;
    if (j >= d->count) continue;
    d->w[START][j] = h * power * d->weight[j];
    d->w[END][j] = (j % 2 ? -1 : 1) * d->w[START][j];
  }
}

/* ---- velocities at the ends ---- */

/* Expand both motions from the unknowns. */
static dvi_status prolongation_expand(dvi__prolongation *d, const double *x)
{
  for (int i = 0; i < d->n; i++, x += UNKNOWNS) {
    d->q[START][i] = d->q0[i];
    d->q[END][i] = d->q0[i] + x[0];
    d->v[START][i] = x[1] / d->h;
    d->v[END][i] = x[2] / d->h;
  }
  for (int end = 0; end < ENDS; end++)
    DVI_TRY(dvi__flow_series_expand(d->motion[end], d->t0 + (end == END ? d->h : 0), d->q[end],
                                    d->v[end]));
  return DVI_OK;
}

/* Add sum_{j>=1} c_j X_j to sum. The coefficients have `count` numbers each, at a distance of
 * `stride`. */
static void add_series(int m, const double *c, size_t count, size_t stride, const double *X,
                       double *sum)
{
  for (int j = 1; j <= m; j++)
    for (size_t i = 0; i < count; i++) sum[i] += c[j] * X[(size_t)j * stride + i];
}

/* Compute R. Only the difference of q0 and q1 contributes, because a_0 = -b_0. */
static void prolongation_mismatches(dvi__prolongation *d, const double *x)
{
  const size_t n = (size_t)d->n;
  for (int row = 0; row < ENDS; row++) {
    for (size_t i = 0; i < n; i++) d->R[row][i] = d->plain[row][END][0] * x[UNKNOWNS * i];
    for (int end = 0; end < ENDS; end++)
      add_series(d->m, d->row[row][end], n, n, dvi__flow_series_q(d->motion[end]), d->R[row]);
  }
}

static dvi_status prolongation_vary(dvi__prolongation *d)
{
  const size_t n = (size_t)d->n, square = n * n;
  for (int end = 0; end < ENDS; end++) {
    DVI_TRY(dvi__flow_series_vary(d->motion[end]));
    const double *dq = dvi__flow_series_dq(d->motion[end]);
    for (int row = 0; row < ENDS; row++) {
      double *by_q = d->by_q[row][end], *by_v = d->by_v[row][end];
      memset(by_q, 0, square * sizeof *by_q);
      memset(by_v, 0, square * sizeof *by_v);
      add_series(d->m, d->row[row][end], square, 2 * square, dq, by_q);
      add_series(d->m, d->row[row][end], square, 2 * square, dq + square, by_v);
      for (size_t e = 0; e < square; e++) by_v[e] /= d->h;
    }
  }
  return DVI_OK;
}

/* Evaluate the ends. The solver asks for the Jacobian and for the residual at the same point. */
static dvi_status prolongation_collocate(dvi__prolongation *d, const double *x)
{
  const size_t size = UNKNOWNS * (size_t)d->n * sizeof *x;
  if (d->known && memcmp(d->at, x, size) == 0) return DVI_OK;
  d->known = 0;
  DVI_TRY(prolongation_expand(d, x));
  prolongation_mismatches(d, x);
  DVI_TRY(prolongation_vary(d));
  memcpy(d->at, x, size);
  d->known = 1;
  return DVI_OK;
}

/* ---- derivatives of the discrete Lagrangian ---- */

/* Compute dG/dq of an end, and write dG/d(h v) to the right-hand side of the multipliers. */
static dvi_status differentiate_quadrature(dvi__prolongation *d, int end)
{
  const size_t n = (size_t)d->n;
  DVI_TRY(dvi__flow_series_lagrangian(d->motion[end], d->L, d->L_q, d->L_v));
  for (size_t i = 0; i < n; i++) {
    double G_q = 0, G_v = 0;
    for (size_t j = 0; j < (size_t)d->count; j++) {
      G_q += d->w[end][j] * d->L_q[j * n + i];
      G_v += d->w[end][j] * d->L_v[j * n + i];
    }
    d->G_q[end][i] = G_q;
    d->lambda[(size_t)end * n + i] = G_v / d->h;
  }
  return DVI_OK;
}

/* Solve dR/d(h v0, h v1)^T lambda = dG/d(h v0, h v1). Column r of the matrix holds the derivatives
 * of row r of R. */
static dvi_status solve_multipliers(dvi__prolongation *d)
{
  const size_t n = (size_t)d->n;
  for (int end = 0; end < ENDS; end++) DVI_TRY(differentiate_quadrature(d, end));
  for (size_t row = 0; row < ENDS; row++)
    for (size_t end = 0; end < ENDS; end++)
      for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++)
          d->values[(row * n + i) * 2 * n + end * n + j] = d->by_v[row][end][j * n + i];
  const dvi_status status = dvi__linear_factor(d->multipliers, d->values);
  if (status == DVI_SINGULAR)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "the points at the ends do not determine the velocities there (h = %g); take "
                     "a smaller step",
                     d->h);
  if (status == DVI_OK) dvi__linear_solve(d->multipliers, d->lambda);
  return status;
}

/* Return [dR/dq_end^T lambda]_i without the identity's part. */
static double prolongation_pulled_back(const dvi__prolongation *d, int end, size_t i)
{
  const size_t n = (size_t)d->n;
  double sum = 0;
  for (int row = 0; row < ENDS; row++)
    for (size_t k = 0; k < n; k++)
      sum += d->by_q[row][end][i * n + k] * d->lambda[(size_t)row * n + k];
  return sum;
}

dvi_status dvi__prolongation_residual(dvi__prolongation *d, const double *x, double *R)
{
  const size_t n = (size_t)d->n;
  DVI_TRY(prolongation_collocate(d, x));
  DVI_TRY(solve_multipliers(d));
  for (size_t i = 0; i < n; i++, R += UNKNOWNS) {
    const double identity = d->plain[START][START][0] * d->lambda[i] +
                            d->plain[END][START][0] * d->lambda[n + i];
    R[0] = d->R[START][i];
    R[1] = d->R[END][i];
    R[2] = d->h * (d->p0[i] + d->G_q[START][i] - identity - prolongation_pulled_back(d, START, i));
  }
  return DVI_OK;
}

/* Compute the end. In p1 - p0 = (D1 + D2) Ld the identity's parts cancel. */
dvi_status dvi__prolongation_end(dvi__prolongation *d, const double *x, double *dq, double *dp,
                                 double *path)
{
  const size_t n = (size_t)d->n;
  double *const A = path, *const B = path + (size_t)(d->m - 1) * n;
  double power = d->h;
  DVI_TRY(prolongation_collocate(d, x));
  DVI_TRY(solve_multipliers(d));
  for (size_t i = 0; i < n; i++) {
    dq[i] = B[i] = x[UNKNOWNS * i];
    dp[i] = d->G_q[START][i] + d->G_q[END][i] - prolongation_pulled_back(d, START, i) -
            prolongation_pulled_back(d, END, i);
  }
  for (size_t j = 1; j < (size_t)d->m; j++, power *= d->h)
    for (size_t i = 0; i < n; i++) {
      A[(j - 1) * n + i] = power * dvi__flow_series_q(d->motion[START])[j * n + i];
      B[j * n + i] = power * dvi__flow_series_q(d->motion[END])[j * n + i];
    }
  return DVI_OK;
}

void dvi__prolongation_path(const dvi__prolongation *d, const double *path, double h, double tau,
                            double *offset, double *v)
{
  const size_t n = (size_t)d->n, m = (size_t)d->m;
  const double *const A = path, *const B = path + (m - 1) * n;
  double here[COEFFICIENTS], slope[COEFFICIENTS], there[COEFFICIENTS], there_slope[COEFFICIENTS];
  dvi__hermite_functions(d->m, tau, here, slope);
  dvi__hermite_functions(d->m, 1 - tau, there, there_slope);
  for (size_t i = 0; i < n; i++) {
    double sum = 0, rate = 0;
    for (size_t j = 0; j < m; j++) {
      const double a = j > 0 ? A[(j - 1) * n + i] : 0, b = (j % 2 ? -1 : 1) * B[j * n + i];
      sum += here[j] * a + there[j] * b;
      rate += slope[j] * a - there_slope[j] * b;
    }
    if (offset != NULL) offset[i] = sum;
    if (v != NULL) v[i] = rate / h;
  }
}

/* ---- Jacobian ---- */

static dvi_status prolongation_kinetic(dvi__prolongation *d, const double *v, const double **L_vv)
{
  const dvi_system *s = d->system;
  if (s->lagrangian != NULL) return dvi__velocity_hessian(d->evaluator, d->t0, d->q0, v, L_vv);
  *L_vv = s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
  return DVI_OK;
}

static void prolongation_fill_collocation(const dvi__prolongation *d, double *values)
{
  const size_t n = (size_t)d->n, height = UNKNOWNS * n;
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      for (size_t row = 0; row < ENDS; row++) {
        double *at = values + UNKNOWNS * j * height + UNKNOWNS * i + row;
        at[0] = d->by_q[row][END][j * n + i] + (i == j ? d->plain[row][END][0] : 0);
        at[height] = d->by_v[row][START][j * n + i];
        at[2 * height] = d->by_v[row][END][j * n + i];
      }
}

dvi_status dvi__prolongation_jacobian(dvi__prolongation *d, const double *x, double *values)
{
  const size_t height = UNKNOWNS * (size_t)d->n;
  const dvi__pattern *vv = &d->system->vv;
  const double *L_vv;
  DVI_TRY(prolongation_collocate(d, x));
  DVI_TRY(prolongation_kinetic(d, dvi__flow_series_v(d->motion[START]), &L_vv));
  memset(values, 0, height * height * sizeof *values);
  prolongation_fill_collocation(d, values);
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++)
      values[(UNKNOWNS * (size_t)j + 1) * height + UNKNOWNS * (size_t)vv->row[e] + 2] = -L_vv[e];
  return DVI_OK;
}

/* Scale the rows of the momentum by the diagonal of L_vv, at rest. */
dvi_status dvi__prolongation_scale(dvi__prolongation *d, double *scale)
{
  const dvi__pattern *vv = &d->system->vv;
  const double *L_vv;
  memset(d->v[START], 0, (size_t)d->n * sizeof(double));
  DVI_TRY(prolongation_kinetic(d, d->v[START], &L_vv));
  for (int i = 0; i < d->n; i++, scale += UNKNOWNS) {
    const int e = dvi__pattern_find(vv, i, i);
    scale[0] = scale[1] = d->plain[START][END][0];
    scale[2] = e >= 0 && L_vv[e] != 0 ? fabs(L_vv[e]) : 1;
  }
  return DVI_OK;
}

/* ---- guesses ---- */

void dvi__prolongation_straight(const dvi__prolongation *d, const double *v, double *x)
{
  for (int i = 0; i < d->n; i++)
    for (int k = 0; k < UNKNOWNS; k++) x[UNKNOWNS * i + k] = d->h * v[i];
}

/* Continue the motion from the last step's end, or by the straight line where the motion has no
 * series there. */
void dvi__prolongation_continue(dvi__prolongation *d, double ratio, const double *last, double *x)
{
  const size_t n = (size_t)d->n;
  d->known = 0;
  for (size_t i = 0; i < n; i++) d->v[START][i] = ratio * last[UNKNOWNS * i + 2] / d->h;
  dvi__prolongation_straight(d, d->v[START], x);
  if (dvi__flow_series_expand(d->motion[START], d->t0, d->q0, d->v[START]) != DVI_OK) return;
  const double *q = dvi__flow_series_q(d->motion[START]);
  double power = d->h * d->h;
  for (size_t j = 2; j <= (size_t)d->m; j++, power *= d->h)
    for (size_t i = 0; i < n; i++) {
      x[UNKNOWNS * i] += power * q[j * n + i];
      x[UNKNOWNS * i + 2] += (double)j * power * q[j * n + i];
    }
}
