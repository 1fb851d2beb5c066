/* Holonomic constraints phi(t,q) = 0 in the rows of an element.
 *
 * The discrete action gets the constraints at the s + 1 Lobatto points chi_k, with the weights
 * beta_k of Lobatto's rule, whatever the quadrature of L is,
 *
 *     S - h sum_k beta_k lambda_k.phi(t0 + chi_k h, q(chi_k)).
 *
 * At the nodes k = 0..s-1 this is a force -G^T lambda_k in the rows. The unknowns lambda_k make the
 * nodes k = 1..s fulfil phi = 0. The force of the node k = s changes only the momentum at the end,
 * and is found last, so that the velocity there stays on the constraint. The rows are divided by h,
 * and the unknowns are h^2 lambda_k, which keeps the condition of the equations independent of h.
 * For s = 1 this is RATTLE. Each row of phi is scaled by its gradient at the start of the step, to
 * which the multipliers are inverse.
 *
 * If rows depend on others, the Jacobian alone gets a small number on the diagonal of each row and
 * its multiplier. The rows stay exact, and so do q and p, which depend on G^T lambda alone.
 *
 * Source: Leyendecker, Marsden and Ortiz 2008 (constraints in the discrete action); Wenger, Ober-
 * Bloebaum and Leyendecker 2017 (Galerkin variational integrators with constraints). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/linear.h"
#include "space/quadrature.h"
#include "space/trial.h"
#include "step/element/action_struct.h"
#include "system/dynamics/holonomic.h"

struct dvi__constrained_rows {
  dvi__action *action;
  int rows, entries;   /* of phi, and of the gradients of all rows */
  dvi__pattern acting; /* [n x rows], the first columns of rows_q */
  double *chi, *beta;  /* [s + 1] */
  double *psi, *bar;   /* [(s + 1)*s] psi_l(chi_k) and psi_l(chi_k) - psi_l(1), at k*s + l */
  int knows_start;     /* phi_q has the gradients at the start of the element */
  int knows_path;      /* and at all other nodes, of the path in X */
  int dependent;       /* rows depend on others */
  int sign;            /* of the determinant of one coordinate's Jacobian with one row */
  double *X;           /* [(s + 1)*n] the nodes */
  double *phi, *phi_q; /* [(s + 1)*all rows], [(s + 1)*entries] */
  int in_batches;      /* callbacks take all nodes at once */
  /* [s + 1], [(s + 1)*n], [(s + 1)*(all rows + entries)] a batch with its results */
  double *times, *points, *results;
  double *size;         /* [rows] powers of two near the gradients at the start, inverted */
  double *w, *phi_w_qq; /* [all rows], [entries of rows_qq] */
  double *v, *impulse;  /* [n] */
  double *numbers;
};

typedef dvi__constrained_rows rows_term;

/* ---- create ---- */

static dvi_status rows_allocate(rows_term *x)
{
  const dvi__action *a = x->action;
  const size_t n = (size_t)a->n, s = (size_t)a->s, nodes = s + 1,
               rows = (size_t)a->system->row_count, entries = (size_t)x->entries,
               curvature = (size_t)dvi__pattern_entries(&a->system->rows_qq);
  double *at = x->numbers = DVI_NEW(double, nodes *(3 + 2 * s + 2 * n + 2 * rows + 2 * entries) +
                                                2 * rows + 2 * n + curvature);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d constraints", x->rows);
  x->chi = at;
  x->beta = x->chi + nodes;
  x->psi = x->beta + nodes;
  x->bar = x->psi + nodes * s;
  x->X = x->bar + nodes * s;
  x->phi_q = x->X + nodes * n;
  x->phi = x->phi_q + nodes * entries;
  x->times = x->phi + nodes * rows;
  x->points = x->times + nodes;
  x->results = x->points + nodes * n;
  x->w = x->results + nodes * (rows + entries);
  x->phi_w_qq = x->w + rows;
  x->v = x->phi_w_qq + curvature;
  x->impulse = x->v + n;
  x->size = x->impulse + n;
  return DVI_OK;
}

/* Write the Jacobian of a free unit mass with the constraint q = 0, by columns. */
static void fill_model(const rows_term *x, double *J)
{
  const dvi__action *a = x->action;
  const int s = a->s, size = 2 * s;
  for (int k = 0; k < s; k++)
    for (int l = 0; l < s; l++) {
      for (int j = 0; j < a->r; j++)
        J[l * size + k] += a->weight[j] * a->dpsi[k * a->lanes + j] * a->dpsi[l * a->lanes + j];
      J[(s + l) * size + k] = -x->beta[l] * x->bar[l * s + k];
      J[l * size + s + k] = x->psi[(k + 1) * s + l];
    }
}

/* Find the sign of that Jacobian's determinant. If the rank of the rows drops within a step, the
 * sign of the step's own one changes. */
static dvi_status find_sign(rows_term *x)
{
  const int size = 2 * x->action->s;
  dvi__pattern full = {0};
  dvi__linear *linear = NULL;
  double *J = DVI_NEW(double, (size_t)size *(size_t)size);
  dvi_status status = J != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "action: no memory");
  if (status == DVI_OK)
    status = dvi__pattern_copy_rectangular(&(dvi_pattern){0}, size, size, "constraints", &full);
  if (status == DVI_OK) status = dvi__linear_create(&full, DVI__LINEAR_DENSE, NULL, &linear);
  if (status == DVI_OK) {
    fill_model(x, J);
    status = dvi__linear_factor(linear, J);
  }
  if (status == DVI_OK) x->sign = dvi__linear_sign(linear);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&full);
  dvi__release(J);
  return status;
}

static dvi_status rows_fill_tables(rows_term *x)
{
  const dvi__action *a = x->action;
  const size_t s = (size_t)a->s;
  DVI_TRY(dvi_quadrature(DVI_LOBATTO, a->s + 1, x->chi, x->beta));
  for (size_t k = 0; k <= s; k++) {
    dvi__trial_in(&a->trial, x->chi[k], x->psi + k * s, NULL, a->line);
    for (size_t l = 0; l < s; l++) x->bar[k * s + l] = x->psi[k * s + l] - a->end[l];
  }
  /* to the last bit at the ends */
  for (size_t l = 0; l < s; l++) {
    x->psi[l] = x->bar[s * s + l] = 0;
    x->psi[s * s + l] = a->end[l];
    x->bar[l] = -a->end[l];
  }
  return find_sign(x);
}

/* ---- the path ---- */

static void rows_place(void *of, const dvi__row_path *p)
{
  rows_term *x = of;
  for (int k = 0; k <= p->s; k++)
    for (int i = 0; i < p->n; i++) {
      double sum = 0;
      for (int l = 0; l < p->s; l++) sum += x->psi[k * p->s + l] * p->Y[i * p->s + l];
      const double place = p->q0[i] + sum;
      x->knows_path &= x->X[k * p->n + i] == place;
      x->X[k * p->n + i] = place;
    }
}

static double node_time(const rows_term *x, const dvi__row_path *p, int k)
{
  return p->t0 + x->chi[k] * p->h;
}

static void measure_rows(rows_term *x)
{
  const dvi__pattern *G = &x->action->system->rows_q;
  for (int a = 0; a < x->rows; a++) {
    const double size = dvi__largest((size_t)(G->start[a + 1] - G->start[a]),
                                     x->phi_q + G->start[a]);
    x->size[a] = size > 0 && isfinite(size) ? ldexp(1.0, -ilogb(size)) : 1;
  }
}

typedef dvi_status (*rows_function)(dvi__evaluator *e, int count, const double *t, const double *q,
                                    double *result);

/* Evaluate a function with so many results at some nodes at once, node after node. */
static dvi_status ask_nodes(rows_term *x, const dvi__row_path *p, int first, int count,
                            rows_function function, int results, double *result)
{
  for (int k = 0; k < count; k++) x->times[k] = node_time(x, p, first + k);
  for (int k = 0; k < count; k++)
    for (int i = 0; i < p->n; i++) x->points[i * count + k] = x->X[(first + k) * p->n + i];
  DVI_TRY(function(x->action->evaluator, count, x->times, x->points, x->results));
  for (int k = 0; k < count; k++)
    for (int i = 0; i < results; i++) result[k * results + i] = x->results[i * count + k];
  return DVI_OK;
}

/* Evaluate phi at all nodes but the start. */
static dvi_status rows_values(rows_term *x, const dvi__row_path *p)
{
  const int rows = x->action->system->row_count;
  if (x->in_batches) return ask_nodes(x, p, 1, p->s, dvi__rows_values, rows, x->phi);
  for (int k = 1; k <= p->s; k++)
    DVI_TRY(dvi__rows_value(x->action->evaluator, node_time(x, p, k), x->X + k * p->n,
                            x->phi + (k - 1) * rows));
  return DVI_OK;
}

/* Evaluate the gradients at all nodes that are not known. Those at the start are known from the
 * first residual of an element, and all where the Jacobian is that of the last residual's path. */
static dvi_status rows_gradients(rows_term *x, const dvi__row_path *p)
{
  const int first = x->knows_start;
  if (x->knows_path) return DVI_OK;
  if (x->in_batches)
    DVI_TRY(ask_nodes(x, p, first, p->s + 1 - first, dvi__rows_all_gradients, x->entries,
                      x->phi_q + first * x->entries));
  for (int k = first; k <= p->s && !x->in_batches; k++)
    DVI_TRY(dvi__rows_gradients(x->action->evaluator, node_time(x, p, k), x->X + k * p->n,
                                x->phi_q + k * x->entries));
  if (!x->knows_start) measure_rows(x);
  x->knows_start = x->knows_path = 1;
  return DVI_OK;
}

/* Give h^2 lambda of row a at node k. */
static double multiplier_of(const rows_term *x, const double *own, int a, int k)
{
  return x->size[a] * own[a * x->action->s + k];
}

/* Compute the momentum [n] that the constraints add at node k. */
static void impulse_of_node(rows_term *x, const dvi__row_path *p, const double *own, int k)
{
  for (int a = 0; a < x->rows; a++) x->w[a] = multiplier_of(x, own, a, k);
  memset(x->impulse, 0, (size_t)p->n * sizeof(double));
  dvi__rows_pull(x->action->system, x->phi_q + k * x->entries, x->w, -x->beta[k] / p->h,
                 x->impulse);
}

static dvi_status rows_add(void *of, const dvi__row_path *p, const double *own, double *R,
                           double *dp, double *own_R)
{
  rows_term *x = of;
  DVI_TRY(rows_gradients(x, p));
  for (int k = 0; k < p->s; k++) {
    impulse_of_node(x, p, own, k);
    for (int i = 0; i < p->n; i++) {
      for (int j = 0; j < p->s; j++) R[i * p->s + j] += x->bar[k * p->s + j] * x->impulse[i];
      dp[i] += x->impulse[i];
    }
    dvi__action_carry(x->action, x->X + k * p->n, x->impulse, R, dp);
  }
  DVI_TRY(rows_values(x, p));
  for (int k = 0; k < p->s; k++)
    for (int a = 0; a < x->rows; a++)
      own_R[a * p->s + k] = x->size[a] * x->phi[k * x->action->system->row_count + a] / p->h;
  return DVI_OK;
}

/* The roundings of phi itself count beside those of its arguments. */
static void rows_magnitudes(const void *of, const dvi__row_path *p, double *magnitude,
                            double *own_magnitude)
{
  const rows_term *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  (void)magnitude;
  for (int k = 1; k <= p->s; k++) {
    dvi__rows_noise(x->action->evaluator, node_time(x, p, k), x->X + k * p->n, x->phi);
    for (int a = 0; a < x->rows; a++) {
      const double by = x->size[a] / fabs(p->h);
      own_magnitude[a * p->s + k - 1] += by * fabs(x->phi[a]) / DBL_EPSILON;
      for (int e = G->start[a]; e < G->start[a + 1]; e++)
        own_magnitude[a * p->s + k - 1] += by * fabs(x->phi_q[k * x->entries + e] *
                                                     x->X[k * p->n + G->row[e]]);
    }
  }
}

/* ---- derivatives ---- */

/* Add the derivatives by the place of node k of the momentum that is added there. x->w has the
 * multipliers. */
static dvi_status add_curvature(rows_term *x, const dvi__row_path *p, const dvi__carried *carried,
                                int k, const dvi__row_jacobian *J)
{
  const dvi__pattern *qq = &x->action->system->rows_qq;
  const double *end = x->action->end;
  DVI_TRY(dvi__rows_hessian(x->action->evaluator, node_time(x, p, k), x->X + k * p->n, x->w,
                            x->phi_w_qq));
  for (int column = 0; column < p->n; column++)
    for (int e = qq->start[column]; e < qq->start[column + 1]; e++) {
      const double more = dvi__carried_entry(carried, qq->row[e], x->phi_w_qq, e);
      for (int l = 0; l < p->s; l++) {
        double *rows = dvi__row_block(J, qq->row[e], column, l);
        const double by = -x->beta[k] / p->h * x->psi[k * p->s + l];
        for (int j = 0; j < p->s; j++)
          rows[j] += by * (x->bar[k * p->s + j] * x->phi_w_qq[e] - end[j] * more);
      }
    }
  return DVI_OK;
}

/* Add the derivatives by the multipliers of node k. */
static void add_gradients(const rows_term *x, const dvi__row_path *p, const dvi__carried *carried,
                          int k, const dvi__row_jacobian *J)
{
  const dvi__pattern *G = &x->action->system->rows_q;
  const double *phi_q = x->phi_q + k * x->entries, *end = x->action->end;
  for (int a = 0; a < x->rows; a++)
    for (int e = G->start[a]; e < G->start[a + 1]; e++) {
      double *column = dvi__row_own_column(J, a * p->s + k, G->row[e]);
      const double by = -x->beta[k] / p->h * x->size[a],
                   more = dvi__carried_entry(carried, G->row[e], phi_q, e);
      for (int j = 0; j < p->s; j++)
        column[j] += by * (x->bar[k * p->s + j] * phi_q[e] - end[j] * more);
    }
}

/* Make the Jacobian of dependent rows regular. G M^-1 G^T, as far as the diagonal M/h of the path's
 * own rows tells it, is the size of the rows' Schur complement. */
static void soften_rows(const rows_term *x, const dvi__row_path *p, const dvi__row_jacobian *J)
{
  const dvi__pattern *G = &x->action->system->rows_q;
  for (int a = 0; a < x->rows; a++) {
    double sum = 0;
    for (int e = G->start[a]; e < G->start[a + 1]; e++) {
      const double of_path = *dvi__row_block(J, G->row[e], G->row[e], 0),
                   g = x->size[a] * x->phi_q[e];
      sum += of_path != 0 ? g * g / of_path : 0;
    }
    for (int k = 0; k < p->s; k++)
      *dvi__row_own_diagonal(J, a * p->s + k) -= DVI__SOFTNESS * x->beta[k] / (p->h * p->h) * sum;
  }
}

static dvi_status rows_derivatives(void *of, const dvi__row_path *p, const double *own,
                                   const dvi__row_jacobian *J)
{
  rows_term *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  DVI_TRY(rows_gradients(x, p));
  for (int k = 0; k < p->s; k++) {
    impulse_of_node(x, p, own, k);
    const dvi__carried carried = dvi__action_carried(x->action, x->X + k * p->n, x->impulse);
    add_gradients(x, p, &carried, k, J);
    dvi__action_carry_movements(x->action, &carried, x->psi + k * p->s, J);
    if (k > 0) DVI_TRY(add_curvature(x, p, &carried, k, J));
  }
  for (int a = 0; a < x->rows; a++)
    for (int e = G->start[a]; e < G->start[a + 1]; e++)
      for (int l = 0; l < p->s; l++) {
        double *rows = dvi__row_own_rows(J, a, G->row[e], l);
        for (int k = 1; k <= p->s; k++)
          rows[k - 1] += x->size[a] * x->phi_q[k * x->entries + e] * x->psi[k * p->s + l] / p->h;
      }
  if (x->dependent) soften_rows(x, p, J);
  return DVI_OK;
}

static void rows_scale(const void *of, double h, double *scale)
{
  const rows_term *x = of;
  const dvi__pattern *G = &x->action->system->rows_q;
  const int s = x->action->s;
  for (int a = 0; a < x->rows; a++) {
    double size = 0;
    for (int e = G->start[a]; e < G->start[a + 1]; e++) size = fmax(size, fabs(x->phi_q[e]));
    for (int k = 0; k < s; k++) scale[a * s + k] = (size > 0 ? x->size[a] * size : 1) / fabs(h);
  }
}

/* ---- the action ---- */

dvi_status dvi__action_constrain(dvi__action *a)
{
  const dvi_system *system = a->system;
  if (system->place_rows == 0) return DVI_OK;
  rows_term *x = a->constrained = DVI_NEW(rows_term, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for constraints");
  const dvi__pattern *G = &system->rows_q;
  *x = (rows_term){.action = a,
                   .rows = system->place_rows,
                   .entries = dvi__pattern_entries(G),
                   .in_batches = dvi__rows_have_batches(system) && a->s < DVI_HOLONOMIC_POINTS,
                   .acting = {system->n, system->place_rows, G->start, G->row}};
  DVI_TRY(rows_allocate(x));
  DVI_TRY(rows_fill_tables(x));
  return dvi__action_add_term(a, &(dvi__row_term){.name = "holonomic constraints",
                                                  .of = x,
                                                  .pattern = &system->rows_qq,
                                                  .unknowns = a->s,
                                                  .acting = &x->acting,
                                                  .place = rows_place,
                                                  .rows = rows_add,
                                                  .magnitudes = rows_magnitudes,
                                                  .derivatives = rows_derivatives,
                                                  .scale = rows_scale});
}

void dvi__action_forget_start(dvi__action *a)
{
  if (a->constrained != NULL) a->constrained->knows_start = a->constrained->knows_path = 0;
}

void dvi__action_soften(dvi__action *a, int dependent)
{
  if (a->constrained == NULL) return;
  a->constrained->dependent = dependent;
  dvi__rows_soften(a->evaluator, dependent);
}

void dvi__action_begin_multipliers(const dvi__action *a, double *Y)
{
  if (a->constrained != NULL && a->constrained->dependent)
    memset(Y + a->n * a->s, 0, (size_t)a->constrained->rows * (size_t)a->s * sizeof *Y);
}

void dvi__action_clear_constraints(dvi__action *a)
{
  if (a->constrained != NULL) dvi__release(a->constrained->numbers);
  dvi__release(a->constrained);
}

dvi_status dvi__action_end_on_rows(dvi__action *a, const double *Y, double *p, double *v,
                                   double *dp)
{
  const size_t n = (size_t)a->n;
  dvi__action_path(a, Y, a->h, 1.0, NULL, v);
  for (size_t i = 0; i < n; i++) p[i] = a->p0[i] + dp[i];
  const dvi_status found = dvi__rows_project_momentum(a->evaluator, a->t0 + a->h, a->terms.q1, p,
                                                      v);
  /* a smaller step may end elsewhere */
  if (found != DVI_OK)
    return dvi__fail_in(found == DVI_SINGULAR ? DVI_NOT_CONVERGED : found, "the end of the step");
  for (size_t i = 0; i < n; i++) {
    const double added = p[i] - (a->p0[i] + dp[i]);
    dp[i] = p[i] - a->p0[i];
    p[i] = added;
  }
  dvi__action_arrive(a, p);
  return DVI_OK;
}

dvi_status dvi__action_constrain_end(dvi__action *a, const double *Y, double *dp)
{
  rows_term *x = a->constrained;
  if (x == NULL) return dvi__action_end_rolling(a, Y, dp);
  x->knows_path = 0; /* its places make room for p */
  return dvi__action_end_on_rows(a, Y, x->X, x->v, dp);
}

dvi_status dvi__action_stays_regular(dvi__action *a, int sign)
{
  const rows_term *x = a->constrained;
  if (x == NULL) return DVI_OK;
  const int odd = (a->n + x->rows) * a->s % 2,
            expected = (x->rows % 2 ? x->sign : 1) * (a->h < 0 && odd ? -1 : 1);
  if (sign == expected) return DVI_OK;
  /* from node to node, since gradients at the ends of a long step may be turned by a right angle.
   * p has taken the place of node 0 */
  for (int k = 0; k < a->s; k++) {
    const double t[] = {a->t0 + x->chi[k] * a->h, a->t0 + x->chi[k + 1] * a->h};
    const double *const q[] = {k == 0 ? a->q0 : x->X + k * a->n, x->X + (k + 1) * a->n};
    DVI_TRY(dvi__rows_stay_regular(a->evaluator, t, q, x->v));
  }
  return DVI_OK;
}
