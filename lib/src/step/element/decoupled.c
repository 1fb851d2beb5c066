#include "step/element/decoupled.h"

#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/eigen.h"
#include "num/simd/lanes.h"

/* A real eigenvalue, or a pair of complex ones. */
typedef struct mode {
  int place, parts;    /* first coefficient, and number of coefficients, 1 or 2 */
  double U[2], T[2];   /* real and imaginary part */
  dvi__linear *linear; /* NULL if not prepared */
} mode;

struct dvi__decoupled {
  dvi__action *action;
  dvi_counters *counters;
  int modes;
  mode mode[DVI_DEGREE_MAX];
  dvi__rank_two *rank_two;          /* NULL if the systems have the Hessian's joint pattern */
  double *in, *out;                 /* [s*lanes] by columns, X^{-1} K^{-1} and X */
  double *values, *b, *coefficient; /* [2 entries], [2 rows], [n*s], NULL if not prepared */
  double h, *point;                 /* step of the frozen Jacobian (0 if none), and its t, q, v */
};

/* ---- tables ---- */

/* Sum b_j left_k right_l over j, by columns. */
static void gram_matrix(const dvi__action *a, const double *left, const double *right, double *sum)
{
  for (int l = 0; l < a->s; l++)
    for (int k = 0; k < a->s; k++) {
      sum[l * a->s + k] = 0;
      for (int j = 0; j < a->r; j++)
        sum[l * a->s + k] += a->weight[j] * left[k * a->lanes + j] * right[l * a->lanes + j];
    }
}

/* Multiply A B, all by columns. K^{-1} is symmetric, so that its rows are its columns. */
static void multiply_by_columns(int s, const double *A, const double *B, double *product)
{
  for (int l = 0; l < s; l++)
    for (int k = 0; k < s; k++) {
      product[l * s + k] = 0;
      for (int m = 0; m < s; m++) product[l * s + k] += A[m * s + k] * B[l * s + m];
    }
}

static void pad_columns(int s, const double *columns, double *padded)
{
  const int lanes = dvi__lanes_for(s);
  for (int l = 0; l < s; l++)
    for (int k = 0; k < s; k++) padded[l * lanes + k] = columns[l * s + k];
}

/* List the eigenvalues. The first and second coefficients alpha, beta of a pair's two columns stand
 * for alpha - i beta, which D then multiplies by a + ib. */
static void list_modes(dvi__decoupled *d, int mixed, const double *real_part,
                       const double *imaginary_part)
{
  for (int k = 0; k < d->action->s; k += d->mode[d->modes - 1].parts) {
    mode *m = &d->mode[d->modes];
    const double x = real_part[k], y = imaginary_part[k];
    *m = (mode){.place = k, .parts = y != 0 ? 2 : 1};
    d->modes++;
    if (mixed)
      m->T[0] = x, m->T[1] = y, m->U[0] = y * y - x * x, m->U[1] = -2 * x * y;
    else
      m->U[0] = x, m->U[1] = y;
  }
}

/* Memory for making the tables, s x s each. */
typedef struct workspace {
  double matrix[DVI_DEGREE_MAX * DVI_DEGREE_MAX], X[DVI_DEGREE_MAX * DVI_DEGREE_MAX],
      inverse[DVI_DEGREE_MAX * DVI_DEGREE_MAX], product[DVI_DEGREE_MAX * DVI_DEGREE_MAX],
      real_part[DVI_DEGREE_MAX], imaginary_part[DVI_DEGREE_MAX];
} workspace;

static dvi_status decoupled_fill_tables(dvi__decoupled *d, workspace *w)
{
  dvi__action *a = d->action;
  const int mixed = dvi__pattern_entries(&a->system->qv) > 0 ||
                    (a->system->terms & DVI__FRICTION) != 0;
  gram_matrix(a, mixed ? a->dpsi : a->bar, a->psi, w->product);
  multiply_by_columns(a->s, a->stiffness_inverse, w->product, w->matrix);
  DVI_TRY(dvi__eigen(a->s, w->matrix, w->real_part, w->imaginary_part, w->X, w->inverse));
  multiply_by_columns(a->s, w->inverse, a->stiffness_inverse, w->product);
  pad_columns(a->s, w->product, d->in);
  pad_columns(a->s, w->X, d->out);
  list_modes(d, mixed, w->real_part, w->imaginary_part);
  return DVI_OK;
}

static dvi_status decoupled_allocate_tables(dvi__decoupled *d)
{
  const dvi__action *a = d->action;
  const size_t s = (size_t)a->s, lanes = (size_t)dvi__lanes_for(a->s);
  d->in = DVI_NEW(double, s *lanes);
  d->out = DVI_NEW(double, s *lanes);
  d->point = DVI_NEW(double, dvi__decoupled_point_size(d));
  if (d->in && d->out && d->point) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d decoupled systems in %d dimensions",
                   a->s, a->n);
}

dvi_status dvi__decoupled_create(dvi__action *action, dvi_counters *counters,
                                 dvi__decoupled **decoupled)
{
  *decoupled = NULL;
  dvi__decoupled *d = DVI_NEW(dvi__decoupled, 1);
  workspace *w = DVI_NEW(workspace, 1);
  dvi_status status = d != NULL && w != NULL ? DVI_OK
                                             : dvi__fail(DVI_NO_MEMORY, "action: no memory");
  if (status == DVI_OK) {
    d->action = action;
    d->counters = counters;
    status = decoupled_allocate_tables(d);
  }
  if (status == DVI_OK) status = decoupled_fill_tables(d, w);
  if (status == DVI_OK) status = dvi__rank_two_create(action->system, &d->rank_two);
  dvi__release(w);
  if (status != DVI_OK && d != NULL) dvi__decoupled_destroy(&d);
  *decoupled = d;
  return status;
}

void dvi__decoupled_destroy(dvi__decoupled **decoupled)
{
  dvi__decoupled *d = *decoupled;
  if (d == NULL) return;
  /* the first one shares its analysis and goes last */
  for (int m = d->modes - 1; m >= 0; m--) dvi__linear_destroy(&d->mode[m].linear);
  dvi__rank_two_destroy(&d->rank_two);
  dvi__release(d->in);
  dvi__release(d->out);
  dvi__release(d->values);
  dvi__release(d->b);
  dvi__release(d->coefficient);
  dvi__release(d->point);
  dvi__release(d);
  *decoupled = NULL;
}

/* ---- prepare ---- */

static const dvi__pattern *systems_pattern(const dvi__decoupled *d)
{
  return d->rank_two != NULL ? dvi__rank_two_pattern(d->rank_two) : &d->action->joint;
}

static dvi_status prepare_pattern(dvi__decoupled *d)
{
  return d->rank_two != NULL ? DVI_OK : dvi__action_prepare_hessians(d->action);
}

static dvi_status mode_create_linear(dvi__decoupled *d, mode *m)
{
  const dvi__linear_kind kind = m->parts == 2 ? DVI__LINEAR_COMPLEX : DVI__LINEAR_SPARSE;
  if (m->linear != NULL) return DVI_OK;
  if (m == d->mode) return dvi__linear_create(systems_pattern(d), kind, d->counters, &m->linear);
  return dvi__linear_create_like(d->mode[0].linear, kind, d->counters, &m->linear);
}

/* Prepare the systems. The next call completes what a failure has left. */
static dvi_status prepare_modes(dvi__decoupled *d)
{
  const dvi__action *a = d->action;
  const dvi__pattern *pattern = systems_pattern(d);
  DVI_TRY(prepare_pattern(d));
  for (int m = 0; m < d->modes; m++) DVI_TRY(mode_create_linear(d, &d->mode[m]));
  if (d->values == NULL) d->values = DVI_NEW(double, 2 * (size_t)dvi__pattern_entries(pattern));
  if (d->b == NULL) d->b = DVI_NEW(double, 2 * (size_t)pattern->columns);
  if (d->coefficient == NULL) d->coefficient = DVI_NEW(double, (size_t)a->n *(size_t)a->s);
  if (d->values && d->b && d->coefficient) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d decoupled systems in %d dimensions",
                   a->s, a->n);
}

dvi_status dvi__decoupled_analyse(dvi__decoupled *d, dvi__linear_cost *cost)
{
  DVI_TRY(prepare_pattern(d));
  DVI_TRY(mode_create_linear(d, &d->mode[0]));
  DVI_TRY(dvi__linear_analyse(d->mode[0].linear));
  const dvi__linear_cost first = dvi__linear_cost_of(d->mode[0].linear);
  const int is_complex = d->mode[0].parts == 2;
  *cost = (dvi__linear_cost){0, 0};
  for (int m = 0; m < d->modes; m++) {
    const int parts = d->mode[m].parts;
    cost->entries += first.entries * parts / (is_complex ? 2 : 1);
    cost->operations += first.operations * parts * parts / (is_complex ? 4 : 1);
  }
  return DVI_OK;
}

int dvi__decoupled_has_rank_two(const dvi__decoupled *d)
{
  return d->rank_two != NULL;
}

double dvi__decoupled_weight(const dvi__decoupled *d)
{
  double weight = 0;
  for (int m = 0; m < d->modes; m++) weight += d->mode[m].parts * d->mode[m].parts;
  return weight;
}

/* ---- factors ---- */

/* Assemble h U (L_qq + F_q) + T (L_vq - L_qv - F_v) + L_vv/h on the joint pattern. */
static void mode_assemble(const dvi__action *a, const mode *m, double *values)
{
  for (int e = 0, at = 0; e < dvi__pattern_entries(&a->joint); e++) {
    const dvi__joint_entry *block = &a->block[e];
    const double qq = a->h * (dvi__entry_or_zero(a->H_qq, block->qq) +
                              dvi__entry_or_zero(a->F_q, block->by_q)),
                 mixed = dvi__entry_or_zero(a->H_qv, block->vq) -
                         dvi__entry_or_zero(a->H_qv, block->qv) -
                         dvi__entry_or_zero(a->F_v, block->by_v);
    for (int part = 0; part < m->parts; part++, at++)
      values[at] = m->U[part] * qq + m->T[part] * mixed +
                   (part == 0 ? dvi__entry_or_zero(a->H_vv, block->vv) / a->h : 0.0);
  }
}

int dvi__decoupled_point_size(const dvi__decoupled *d)
{
  return 1 + 2 * d->action->n;
}

void dvi__decoupled_point(const dvi__decoupled *d, const double *Y, double *point)
{
  const dvi__action *a = d->action;
  double *q = point + 1, *v = q + a->n;
  point[0] = a->t0 + 0.5 * a->h;
  dvi__action_path(a, Y, a->h, 0.5, q, v);
  for (int i = 0; i < a->n; i++) q[i] += a->q0[i];
}

static dvi_status decoupled_factor(dvi__decoupled *d)
{
  dvi__action *a = d->action;
  const double *q = d->point + 1, *v = q + a->n;
  DVI_TRY(prepare_modes(d));
  d->counters->jacobians++;
  DVI_TRY(d->rank_two != NULL ? dvi__rank_two_evaluate(d->rank_two, d->point[0], q, v)
                              : dvi__action_evaluate_hessians(a, 1, d->point, q, v));
  for (int k = 0; k < d->modes; k++) {
    const mode *m = &d->mode[k];
    if (d->rank_two != NULL)
      dvi__rank_two_assemble(d->rank_two, a->h, m->parts, m->U, m->T, d->values);
    else
      mode_assemble(a, m, d->values);
    DVI_TRY(dvi__linear_factor(m->linear, d->values));
  }
  return DVI_OK;
}

dvi_status dvi__decoupled_freeze(dvi__decoupled *d, const double *point)
{
  const size_t bytes = (size_t)dvi__decoupled_point_size(d) * sizeof(double);
  if (d->h == d->action->h && memcmp(d->point, point, bytes) == 0) return DVI_OK;
  memcpy(d->point, point, bytes);
  const dvi_status status = decoupled_factor(d);
  d->h = status == DVI_OK ? d->action->h : 0;
  return status;
}

int dvi__decoupled_sign(const dvi__decoupled *d)
{
  int sign = 1;
  for (int m = 0; m < d->modes; m++)
    if (d->mode[m].parts == 1) sign *= dvi__linear_sign(d->mode[m].linear);
  return sign;
}

int dvi__decoupled_is_definite(const dvi__decoupled *d, int sign)
{
  for (int m = 0; m < d->modes; m++)
    if (d->mode[m].parts == 1 && !dvi__linear_is_definite(d->mode[m].linear, sign)) return 0;
  return 1;
}

/* ---- solve ---- */

static void solve_mode(dvi__decoupled *d, const mode *m)
{
  const size_t s = (size_t)d->action->s, n = (size_t)d->action->n;
  double *coefficient = d->coefficient + m->place;
  const size_t rows = (size_t)systems_pattern(d)->columns;
  memset(d->b + (size_t)m->parts * n, 0, (size_t)m->parts * (rows - n) * sizeof(double));
  if (m->parts == 1) {
    for (size_t i = 0; i < n; i++) d->b[i] = coefficient[i * s];
    dvi__linear_solve(m->linear, d->b);
    for (size_t i = 0; i < n; i++) coefficient[i * s] = d->b[i];
    return;
  }
  for (size_t i = 0; i < n; i++)
    d->b[2 * i] = coefficient[i * s], d->b[2 * i + 1] = -coefficient[i * s + 1];
  dvi__linear_solve(m->linear, d->b);
  for (size_t i = 0; i < n; i++)
    coefficient[i * s] = d->b[2 * i], coefficient[i * s + 1] = -d->b[2 * i + 1];
}

void dvi__decoupled_solve(dvi__decoupled *d, double *R)
{
  const dvi__action *a = d->action;
  const int lanes = dvi__lanes_for(a->s);
  dvi__lanes_product(a->n, a->s, lanes, a->s, d->in, R, d->coefficient);
  for (int m = 0; m < d->modes; m++) solve_mode(d, &d->mode[m]);
  dvi__lanes_product(a->n, a->s, lanes, a->s, d->out, d->coefficient, R);
}
