/* Nonholonomic constraints A(t,q) v + a(t,q) = 0 in the rows of an element of degree 1.
 *
 *     p0 + D1 Ld + f- = h/2 A(t0,q0)^T lambda,     A_d (q1 - q0) + h a_d = 0,
 *     p1 = D2 Ld + f+ - h/2 A(t1,q1)^T mu,         A(t1,q1) v1 + a(t1,q1) = 0,
 *
 * where A_d and a_d are A and a at the middle (t0 + h/2, (q0 + q1)/2), or the means of their values
 * at both ends. The second force is found last, as that of holonomic constraints, and the step is
 * symmetric. In the two-step form lambda and the mu of the step before add up to one multiplier,
 * and the equations are those of the discrete principle of Lagrange and d'Alembert. Rows are
 * divided by h, and unknowns are h^2 lambda, which keeps the condition independent of h.
 *
 * Sources: Cortes and Martinez 2001, sec. 3 (discrete principle of Lagrange and d'Alembert);
 * McLachlan and Perlmutter 2006, sec. 3 (symmetric discrete constraints). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "step/element/action_struct.h"
#include "system/dynamics/holonomic.h"

struct dvi__nonholonomic_rows {
  dvi__action *action;
  dvi__velocity_rule rule;
  int first, rows;     /* of the nonholonomic constraints among all rows */
  dvi__pattern acting; /* [n x rows] coordinates that each row meets */
  int knows_start;     /* A and a at the start of the element are known */
  int knows_path;      /* and those of the path in X */
  double *X;           /* [n] the middle, or the end */
  double *start, *at;  /* [entries of rows_q] G at the start, and at X */
  double *g0, *g;      /* [all rows] a at the start, and at X */
  double *Av_q;        /* [entries of by_q] */
  double *v, *p;       /* [n] */
  double *numbers;
};

typedef dvi__nonholonomic_rows rolling;

/* ---- create ---- */

static size_t derivative_entries(const dvi_system *s)
{
  size_t entries = 0;
  for (int k = 0; k < s->nonholonomic_count; k++)
    entries += (size_t)dvi__pattern_entries(&s->nonholonomics[k].by_q);
  return entries;
}

static dvi_status rolling_allocate(rolling *x)
{
  const dvi_system *s = x->action->system;
  const size_t n = (size_t)s->n, m = (size_t)s->row_count,
               entries = (size_t)dvi__pattern_entries(&s->rows_q);
  double *at = x->numbers = DVI_NEW(double, 3 * n + 2 * entries + 2 * m + derivative_entries(s));
  if (at == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nonholonomic constraints", x->rows);
  x->X = at;
  x->v = x->X + n;
  x->p = x->v + n;
  x->start = x->p + n;
  x->at = x->start + entries;
  x->g0 = x->at + entries;
  x->g = x->g0 + m;
  x->Av_q = x->g + m;
  return DVI_OK;
}

/* Write the coordinates that row a of a term meets, those of its entries in A and those on which
 * they depend, in ascending order. Return their number. */
static int meet_coordinates(const dvi__nonholonomic_term *term, int a, int *row)
{
  const dvi__pattern *A = &term->transposed, *by_q = &term->by_q;
  int count = 0, e = A->start[a];
  for (int j = 0; j < A->rows; j++) {
    const int acts = e < A->start[a + 1] && A->row[e] == j;
    if (acts || dvi__pattern_find(by_q, a, j) >= 0) row[count++] = j;
    e += acts;
  }
  return count;
}

static dvi_status make_acting(rolling *x)
{
  const dvi_system *s = x->action->system;
  size_t most = derivative_entries(s);
  for (int k = 0; k < s->nonholonomic_count; k++)
    most += (size_t)dvi__pattern_entries(&s->nonholonomics[k].transposed);
  x->acting = (dvi__pattern){s->n, x->rows, DVI_NEW(int, (size_t)x->rows + 1), DVI_NEW(int, most)};
  if (x->acting.start == NULL || x->acting.row == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nonholonomic constraints", x->rows);
  int at = 0;
  for (int k = 0, column = 0; k < s->nonholonomic_count; k++)
    for (int a = 0; a < s->nonholonomics[k].callbacks.count; a++) {
      at += meet_coordinates(&s->nonholonomics[k], a, x->acting.row + at);
      x->acting.start[++column] = at;
    }
  return DVI_OK;
}

/* ---- the path ---- */

static double part_of_step(const rolling *x)
{
  return x->rule == DVI__MIDDLE_ROWS ? 0.5 : 1;
}

static double weight_of_start(const rolling *x)
{
  return x->rule == DVI__MIDDLE_ROWS ? 0 : 0.5;
}

static void rolling_place(void *of, const dvi__row_path *p)
{
  rolling *x = of;
  for (int i = 0; i < p->n; i++) {
    const double place = p->q0[i] + part_of_step(x) * p->Y[i];
    x->knows_path &= x->X[i] == place;
    x->X[i] = place;
  }
}

static dvi_status rolling_evaluate(rolling *x, const dvi__row_path *p)
{
  dvi__evaluator *e = x->action->evaluator;
  const double t = p->t0 + part_of_step(x) * p->h;
  if (!x->knows_start) {
    DVI_TRY(dvi__rows_gradients(e, p->t0, p->q0, x->start));
    DVI_TRY(dvi__rows_rate(e, p->t0, p->q0, x->g0));
    x->knows_start = 1;
  }
  if (x->knows_path) return DVI_OK;
  DVI_TRY(dvi__rows_gradients(e, t, x->X, x->at));
  DVI_TRY(dvi__rows_rate(e, t, x->X, x->g));
  x->knows_path = 1;
  return DVI_OK;
}

/* Give an entry of A_d, and a component of a_d. */
static double discrete_entry(const rolling *x, int e)
{
  const double w = weight_of_start(x);
  return w * x->start[e] + (1 - w) * x->at[e];
}

static double discrete_affine(const rolling *x, int a)
{
  const double w = weight_of_start(x);
  return w * x->g0[x->first + a] + (1 - w) * x->g[x->first + a];
}

static dvi_status rolling_add(void *of, const dvi__row_path *p, const double *own, double *R,
                              double *dp, double *own_R)
{
  rolling *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  DVI_TRY(rolling_evaluate(x, p));
  for (int a = 0; a < x->rows; a++) {
    own_R[a] = discrete_affine(x, a);
    for (int e = G->start[x->first + a]; e < G->start[x->first + a + 1]; e++) {
      const int i = G->row[e];
      const double impulse = -0.5 / p->h * own[a] * x->start[e];
      R[i] -= p->end[0] * impulse;
      dp[i] += impulse;
      own_R[a] += discrete_entry(x, e) * p->Y[i] / p->h;
    }
  }
  return DVI_OK;
}

/* ---- derivatives ---- */

/* Evaluate d(A v + a)/dq at X for the velocity Y/h of the path. */
static dvi_status evaluate_derivatives(rolling *x, const dvi__row_path *p)
{
  for (int i = 0; i < p->n; i++) x->v[i] = p->Y[i] / p->h;
  return dvi__rows_derivatives(x->action->evaluator, p->t0 + part_of_step(x) * p->h, x->X, x->v,
                               x->Av_q);
}

/* Add values of Av_q, each times a factor, to the row and column of its entry. */
typedef void add_entry(void *to, int row, int column, double value);

static void each_derivative(const rolling *x, add_entry *add, void *to)
{
  const dvi_system *s = x->action->system;
  const double *values = x->Av_q;
  for (int k = 0; k < s->nonholonomic_count; k++) {
    const dvi__pattern *by_q = &s->nonholonomics[k].by_q;
    for (int j = 0; j < by_q->columns; j++)
      for (int e = by_q->start[j]; e < by_q->start[j + 1]; e++)
        add(to, s->nonholonomics[k].first - x->first + by_q->row[e], j, values[e]);
    values += dvi__pattern_entries(by_q);
  }
}

typedef struct magnitudes {
  const rolling *x;
  double *own;
} magnitudes;

static void add_magnitude(void *to, int row, int column, double value)
{
  const magnitudes *m = to;
  m->own[row] += fabs(value * m->x->X[column]);
}

/* The roundings of q change A by its derivatives. */
static void rolling_magnitudes(const void *of, const dvi__row_path *p, double *magnitude,
                               double *own_magnitude)
{
  const rolling *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  rolling *work = x->action->nonholonomic;
  (void)magnitude;
  for (int a = 0; a < x->rows; a++) {
    own_magnitude[a] += fabs(discrete_affine(x, a));
    for (int e = G->start[x->first + a]; e < G->start[x->first + a + 1]; e++)
      own_magnitude[a] += fabs(discrete_entry(x, e) * p->Y[G->row[e]] / p->h);
  }
  if (evaluate_derivatives(work, p) == DVI_OK)
    each_derivative(x, add_magnitude, &(magnitudes){x, own_magnitude});
}

typedef struct slopes {
  const dvi__row_jacobian *J;
  double factor;
} slopes;

static void add_slope(void *to, int row, int column, double value)
{
  const slopes *s = to;
  *dvi__row_own_rows(s->J, row, column, 0) += s->factor * value;
}

static dvi_status rolling_derivatives(void *of, const dvi__row_path *p, const double *own,
                                      const dvi__row_jacobian *J)
{
  rolling *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  (void)own;
  DVI_TRY(rolling_evaluate(x, p));
  DVI_TRY(evaluate_derivatives(x, p));
  for (int a = 0; a < x->rows; a++)
    for (int e = G->start[x->first + a]; e < G->start[x->first + a + 1]; e++) {
      *dvi__row_own_column(J, a, G->row[e]) += p->end[0] * 0.5 / p->h * x->start[e];
      *dvi__row_own_rows(J, a, G->row[e], 0) += discrete_entry(x, e) / p->h;
    }
  /* half of the movement reaches the middle, and half of the end's weight the end */
  each_derivative(x, add_slope, &(slopes){J, 0.5});
  return DVI_OK;
}

static void rolling_scale(const void *of, double h, double *scale)
{
  const rolling *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  for (int a = 0; a < x->rows; a++) {
    double size = 0;
    for (int e = G->start[x->first + a]; e < G->start[x->first + a + 1]; e++)
      size = fmax(size, fabs(x->start[e]));
    scale[a] = (size > 0 ? size : 1) / fabs(h);
  }
}

/* ---- the action ---- */

dvi_status dvi__action_constrain_velocities(dvi__action *a, dvi__velocity_rule rule)
{
  const dvi_system *s = a->system;
  rolling *x = a->nonholonomic = DVI_NEW(rolling, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for constraints");
  *x = (rolling){
      .action = a, .rule = rule, .first = s->place_rows, .rows = s->row_count - s->place_rows};
  DVI_TRY(rolling_allocate(x));
  DVI_TRY(make_acting(x));
  return dvi__action_add_term(a, &(dvi__row_term){.name = "nonholonomic constraints",
                                                  .of = x,
                                                  .unknowns = 1,
                                                  .acting = &x->acting,
                                                  .place = rolling_place,
                                                  .rows = rolling_add,
                                                  .magnitudes = rolling_magnitudes,
                                                  .derivatives = rolling_derivatives,
                                                  .scale = rolling_scale});
}

void dvi__action_forget_rolling(dvi__action *a)
{
  if (a->nonholonomic != NULL) a->nonholonomic->knows_start = a->nonholonomic->knows_path = 0;
}

void dvi__action_clear_rolling(dvi__action *a)
{
  if (a->nonholonomic == NULL) return;
  dvi__pattern_clear(&a->nonholonomic->acting);
  dvi__release(a->nonholonomic->numbers);
  dvi__release(a->nonholonomic);
}

dvi_status dvi__action_end_rolling(dvi__action *a, const double *Y, double *dp)
{
  const rolling *x = a->nonholonomic;
  return x == NULL ? DVI_OK : dvi__action_end_on_rows(a, Y, x->p, x->v, dp);
}
