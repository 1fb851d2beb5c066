/* The rank of holonomic constraints at a state, and the rows that depend on others.
 *
 * With the mass M and the diagonal D of G M^-1 G^T the smallest mu of
 *
 *     G M^-1 G^T x = mu D x
 *
 * is found by inverse iteration with the matrix of the equations of motion, whose last block is
 * -softness D. Where mu is a rounding, a QR factorisation of M^-1/2 G^T with exchanged columns
 * (Golub and Van Loan 2013, sec. 5.4.2; LAPACK's dgeqp3) finds the rank and the rows that depend on
 * the others, G_b = sum_a c_a G_a.
 *
 * Rows are redundant only if they depend on the others everywhere. Then c.phi'' - phi_b'' vanishes
 * along every velocity that the constraints permit, where phi'' is the second derivative of phi
 * along the motion. Where it does not, the rank is another one nearby, or the rows contradict each
 * other. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/dynamics/holonomic.h"
#include "system/dynamics/holonomic_rows.h"
#include "system/evaluate/evaluator_struct.h"

/* LAPACK's Fortran interface. */
extern void dgeqp3_(const int *m, const int *n, double *a, const int *lda, int *jpvt, double *tau,
                    double *work, const int *lwork, int *info);

/* The squares of the sines of angles between rows that are tested, and the sines below which rows
 * are dependent. */
static const double tested = 1e-10, dependent_below = 1e-6;

/* Beyond so many numbers of G there is no QR factorisation. One row is named, then. */
static const double most_numbers = 4e6;

/* ---- the smallest mu ---- */

/* Sizes of rows, whose squares are the entries of D. */
static double size_of_row(const dvi__rows_memory *r, int a)
{
  return sqrt(-r->values[r->own_place[a]] / r->softness) / r->scale[a];
}

/* Write a vector that no symmetry makes orthogonal to the one that is sought. */
static void spread(int count, double *x)
{
  for (int i = 0; i < count; i++) {
    const double part = 0.618033988749895 * (i + 1);
    x[i] = part - floor(part) - 0.3;
  }
}

/* Find mu, and leave the vector D^1/2 x in r->samples. */
static dvi_status smallest_mu(const dvi_system *s, dvi__rows_memory *r, double t, double *mu)
{
  enum { ITERATIONS = 4 };
  const int n = s->n, m = s->row_count;
  double *x = r->samples, grown = 1;
  spread(m, x);
  for (int k = 0; k < ITERATIONS; k++) {
    const double size = dvi__largest((size_t)m, x);
    memset(r->x, 0, (size_t)n * sizeof(double));
    for (int a = 0; a < m; a++) r->x[n + a] = -(x[a] /= size) * size_of_row(r, a);
    DVI_TRY(dvi__rows_solve(r, n + m, t));
    for (int a = 0; a < m; a++) x[a] = r->x[n + a] * size_of_row(r, a);
    grown = dvi__largest((size_t)m, x);
  }
  *mu = 1 / grown - r->softness;
  return DVI_OK;
}

/* ---- dependent rows ---- */

/* A set of dependent rows with their coefficients. */
typedef struct relations {
  int m, rank;
  int *pivot;    /* [m] rows, independent ones first */
  double *c, *W; /* [m], [n*m] */
  double *work;
} relations;

static void clear_relations(relations *x)
{
  dvi__release(x->pivot);
  dvi__release(x->c);
  dvi__release(x->W);
  dvi__release(x->work);
}

/* Return the factor that makes a row's size about 1. Earlier rows become a little longer, so that
 * later ones are said to depend on them. */
static double column_factor(const dvi__rows_memory *r, int a)
{
  const double preference = 1e-3;
  return (1 - preference * a / r->row_count) / size_of_row(r, a);
}

/* Fill the columns of M^-1/2 G^T with their factors. */
static void fill_columns(const dvi_system *s, const dvi__rows_memory *r, double *W)
{
  for (int a = 0; a < s->row_count; a++) {
    double *column = W + (size_t)a * (size_t)s->n;
    const double by = column_factor(r, a);
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++) {
      const int i = s->rows_q.row[k];
      const double mass = r->diagonal[i] >= 0 ? fabs(r->values[r->mass_place[r->diagonal[i]]]) : 1;
      column[i] += by * r->phi_q[k] / sqrt(mass > 0 ? mass : 1);
    }
  }
}

static dvi_status factor_columns(const dvi_system *s, const dvi__rows_memory *r, relations *x)
{
  const int n = s->n, m = s->row_count, length = 3 * m + 1, least = n < m ? n : m;
  int info = 0;
  x->W = DVI_NEW(double, (size_t)n *(size_t)m);
  x->work = DVI_NEW(double, (size_t)m + (size_t)length);
  if (x->W == NULL || x->work == NULL)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for the rank of %d rows", m);
  fill_columns(s, r, x->W);
  dgeqp3_(&n, &m, x->W, &n, x->pivot, x->work, x->work + m, &length, &info);
  for (int a = 0; a < m; a++) x->pivot[a]--;
  while (x->rank < least &&
         fabs(x->W[(size_t)x->rank * (size_t)(n + 1)]) > dependent_below * fabs(x->W[0]))
    x->rank++;
  return DVI_OK;
}

/* Give the row at a place behind the rank, and the coefficients c of the combination of all rows
 * that vanishes. */
static int relation(const dvi_system *s, const dvi__rows_memory *r, const relations *x, int place)
{
  const size_t n = (size_t)s->n;
  const int row = x->pivot[place];
  double *c = x->work;
  if (x->W == NULL) return row; /* c is known */
  memset(x->c, 0, (size_t)x->m * sizeof(double));
  for (int k = x->rank - 1; k >= 0; k--) {
    c[k] = x->W[(size_t)place * n + (size_t)k];
    for (int l = k + 1; l < x->rank; l++) c[k] -= x->W[(size_t)l * n + (size_t)k] * c[l];
    c[k] /= x->W[(size_t)k * (n + 1)];
  }
  for (int k = 0; k < x->rank; k++) x->c[x->pivot[k]] = c[k] * column_factor(r, x->pivot[k]);
  x->c[row] = -column_factor(r, row);
  return row;
}

/* Find the rank, by the vector of the smallest mu alone where there are very many rows. */
static dvi_status find_relations(const dvi_system *s, const dvi__rows_memory *r, relations *x)
{
  const int m = x->m = s->row_count;
  x->pivot = DVI_NEW(int, m);
  x->c = DVI_NEW(double, m);
  if (x->pivot == NULL || x->c == NULL)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for the rank of %d rows", m);
  if ((double)s->n * m <= most_numbers) return factor_columns(s, r, x);
  x->rank = m - 1;
  x->pivot[m - 1] = m - 1;
  for (int a = 0; a < m; a++) {
    x->c[a] = r->samples[a] / size_of_row(r, a);
    if (fabs(r->samples[a]) > 1.001 * fabs(r->samples[x->pivot[m - 1]])) x->pivot[m - 1] = a;
  }
  return DVI_OK;
}

/* ---- rows that depend on others everywhere ---- */

/* Choose a velocity that the constraints permit. */
static dvi_status choose_velocity(dvi__evaluator *e, double t, const double *q, double *v)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int n = s->n, m = s->row_count;
  const double size = fmax(dvi__largest((size_t)n, q), 1e-2);
  spread(n, v);
  for (int i = 0; i < n; i++) v[i] *= size;
  DVI_TRY(dvi__rows_rate(e, t, q, r->phi_t));
  for (int k = 0; k < 3; k++) {
    memset(r->x, 0, (size_t)n * sizeof(double));
    dvi__rows_push(s, r->phi_q, v, r->phi_t, r->x + n);
    for (int a = 0; a < m; a++) r->x[n + a] *= -1;
    DVI_TRY(dvi__rows_solve(r, n + m, t));
    for (int i = 0; i < n; i++) v[i] += r->x[i];
  }
  return DVI_OK;
}

static dvi_status refuse_rank(const dvi_system *s, int row, double t)
{
  char label[DVI__ROW_LABEL];
  return dvi__fail(DVI_SINGULAR,
                   "constraint %s depends on the others at t = %.6g, but not around this point: "
                   "the rank of the constraints changes there, as at a dead centre, or the rows "
                   "contradict each other",
                   dvi__rows_label(s, row, label), t);
}

/* Test the second derivatives of all relations along one velocity. The factor and phi_q are those
 * of the point. */
static dvi_status test_relations(dvi__evaluator *e, double t, const double *q, const relations *x)
{
  const double most = 1e-6;
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *chosen = DVI_NEW(double, s->n);
  if (chosen == NULL) return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for the rank");
  dvi_status status = choose_velocity(e, t, q, chosen);
  const double speed = dvi__largest((size_t)s->n, chosen),
               size = fmax(dvi__largest((size_t)s->n, q), 1e-2);
  if (status == DVI_OK) status = dvi__rows_slopes(e, t, q, chosen);
  for (int place = x->rank; place < x->m && status == DVI_OK; place++) {
    const int row = relation(s, r, x, place);
    double sum = 0, whole = 0;
    for (int a = 0; a < x->m; a++) {
      sum += x->c[a] * r->x[s->n + a];
      whole += fabs(x->c[a] * r->x[s->n + a]) +
               fabs(x->c[a]) * size_of_row(r, a) * speed * speed / size;
    }
    if (!(fabs(sum) <= most * whole)) status = refuse_rank(s, row, t);
  }
  dvi__release(chosen);
  return status;
}

/* ---- the rank ---- */

static dvi_status refuse_no_gradient(const dvi__evaluator *e, double t)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  for (int a = 0; a < s->row_count; a++) {
    double size = 0;
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
      size = fmax(size, fabs(r->phi_q[k]));
    if (size == 0) {
      char label[DVI__ROW_LABEL];
      return dvi__fail(DVI_SINGULAR,
                       "constraint %s has the gradient 0 at t = %.6g, where it constrains nothing",
                       dvi__rows_label(s, a, label), t);
    }
  }
  return DVI_OK;
}

static dvi_status note_relations(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  relations x = {0};
  dvi_status status = find_relations(s, r, &x);
  for (int place = x.rank; status == DVI_OK && place < x.m; place++)
    r->dependent[x.pivot[place]] = 1;
  r->dependent_count = status == DVI_OK ? x.m - x.rank : 0;
  if (status == DVI_OK && r->dependent_count > 0 && s->nonholonomic_count > 0) {
    char label[DVI__ROW_LABEL];
    status = dvi__fail(DVI_SINGULAR,
                       "constraint %s depends on the others at t = %.6g; beside nonholonomic "
                       "constraints leave out the rows that follow from others",
                       dvi__rows_label(s, x.pivot[x.rank], label), t);
  }
  r->softness = DVI__SOFTNESS;
  if (status == DVI_OK && r->dependent_count > 0) status = dvi__rows_factor(e, t, q, v);
  if (status == DVI_OK && r->dependent_count > 0) status = test_relations(e, t, q, &x);
  clear_relations(&x);
  return status;
}

static dvi_status find_rank(dvi__evaluator *e, double t, const double *q, const double *p)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *v = e->point[0], mu;
  memset(v, 0, (size_t)s->n * sizeof(double));
  if (s->lagrangian != NULL) DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  r->dependent_count = 0;
  memset(r->dependent, 0, (size_t)s->row_count);
  r->softness = tested;
  DVI_TRY(dvi__rows_factor(e, t, q, v));
  DVI_TRY(refuse_no_gradient(e, t));
  DVI_TRY(smallest_mu(s, r, t, &mu));
  return mu < tested ? note_relations(e, t, q, v) : DVI_OK;
}

/* Steps keep the rank (dvi__rows_stay_regular), and find no solution where dependent rows part. */
dvi_status dvi__rows_side(dvi__evaluator *e, double t, const double *q, const double *p, int before,
                          int *side)
{
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  *side = 1;
  if (before > 0) *side = before;
  if (e->system->place_rows == 0 || before > 0) return DVI_OK;
  const dvi_counters counters = *e->counters;
  const dvi_status status = find_rank(e, t, q, p);
  *e->counters = counters;
  r->softness = r->dependent_count > 0 ? DVI__SOFTNESS : 0;
  *side = 1 + r->dependent_count;
  return status;
}

/* ---- a change of the rank ---- */

/* Factor the matrix with the rows of another place, and compare the signs of both determinants. */
static dvi_status compare_signs(dvi__evaluator *e, double t, const double *q, int *same)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int sign = dvi__linear_sign(r->linear);
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  for (int a = 0; a < s->row_count; a++)
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
      r->values[r->row_place[k]] = r->scale[a] * r->phi_q[k];
  const dvi_status status = dvi__linear_factor(r->linear, r->values);
  *same = status == DVI_OK && dvi__linear_sign(r->linear) == sign;
  return status == DVI_SINGULAR ? DVI_OK : status;
}

/* Name the row that adds least to the others. */
static dvi_status refuse_passage(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  char label[DVI__ROW_LABEL] = "";
  relations x = {0};
  const double softness = r->softness;
  double mu;
  r->softness = tested;
  dvi_status status = dvi__rows_factor(e, t, q, v);
  if (status == DVI_OK) status = smallest_mu(s, r, t, &mu);
  if (status == DVI_OK) status = find_relations(s, r, &x);
  if (status == DVI_OK)
    (void)dvi__rows_label(s, x.pivot[x.W != NULL && x.rank > 0 ? x.rank - 1 : x.m - 1], label);
  clear_relations(&x);
  r->softness = softness;
  return dvi__fail(DVI_SINGULAR,
                   "the step passes a point where constraint %s depends on the others, as at a "
                   "dead centre, from where the motion is not determined; or the step turns it by "
                   "more than a right angle, and a smaller one helps",
                   label);
}

dvi_status dvi__rows_stay_regular(dvi__evaluator *e, const double t[2], const double *const q[2],
                                  const double *v)
{
  int same;
  DVI_TRY(dvi__rows_factor(e, t[0], q[0], v));
  DVI_TRY(compare_signs(e, t[1], q[1], &same));
  return same ? DVI_OK : refuse_passage(e, t[1], q[1], v);
}

void dvi__rows_soften(dvi__evaluator *e, int dependent)
{
  dvi__rows_memory_of(e)->softness = dependent ? DVI__SOFTNESS : 0;
}

int dvi__rows_dependent(const dvi__evaluator *e, char *words, size_t size)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  size_t length = 0;
  words[0] = 0;
  for (int a = 0; r != NULL && a < r->row_count; a++) {
    char label[DVI__ROW_LABEL];
    if (!r->dependent[a] || length + DVI__ROW_LABEL + 8 > size) continue;
    length += (size_t)snprintf(words + length, size - length, "%s%s", length > 0 ? ", " : "",
                               dvi__rows_label(e->system, a, label));
  }
  return r != NULL ? r->dependent_count : 0;
}

void dvi__rows_choose(const dvi__evaluator *e, char *keep)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  for (int a = 0; a < r->row_count; a++) keep[a] = !r->dependent[a];
}
