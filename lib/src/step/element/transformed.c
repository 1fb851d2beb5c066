/* Fixed-point iteration of a time-transformed element. Its system has a potential and a constant
 * mass without coupling, whose transformed Lagrangian is w.Mw/(2g) + g (E0 - V). The element has as
 * many nodes as functions.
 *
 * Velocities at the nodes then determine the path, and the momenta P = Mw/g at the nodes are
 * unknowns as good as velocities. With them the rows of action.h have the solution
 *
 *     P_i = p0 + sum_j (1 - W_ji) f_j,     f_j = -h b_j [ g V_q + (P.M^-1 P/2 + V - E0) g_q ]_j,
 *     q(c_i) = q0 + sum_j W_ij u_j,        u_j = h b_j g_j M^-1 P_j,
 *     q1 = q0 + sum_j u_j,   p1 = p0 + sum_j f_j,   t1 = t0 + sum_j h b_j g_j,
 *
 * with W_ij = psi(c_i)^T K^{-1} psi'(c_j), a partitioned Runge-Kutta method for g (H - E0). It is
 * symplectic to the last bit of W and h b_j, because the same numbers stand in both sums (Suris
 * 1989; Hairer, Lubich and Wanner 2006, sec. VI.4.2).
 *
 * An iteration contracts with h g_q.v, where that of given systems does with h^2 V_qq/m. This is the
 * work of two numbers at each node, g and the kinetic energy. Both are known to first order without
 * another evaluation, P as it comes out, and g by its gradient. So the sums are formed twice for
 * each evaluation, and it contracts with the square.
 *
 * A step of the physical time that belongs to an element is here, too, for all transformed
 * systems. */
#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/fixed_point.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/lanes.h"
#include "system/rescale/transformed.h"

enum { SWEEPS = 2 }; /* sums for each evaluation; a third one gains a tenth of the evaluations */

struct dvi__transformed_stages {
  dvi__transformed *of;
  double *place, *momentum; /* [r*lanes] W_ij and 1 - W_ji by columns */
  double *path;             /* [r*path_lanes] from u to paths, by columns */
  double *inverse_mass;     /* [n] */
  double *weight, h;        /* [r] h b_j, and the h of them */
  double *energy, *rate;    /* [r] H - E0, and h b_j g_j of u_j */
  double *P, *Z, *next;     /* [n*r] momenta, offsets from q0 of the nodes, and new offsets */
  double *u, *f;            /* [n*r] each, one after the other */
  dvi__rescaled at;         /* [r] and [n*r], at Q */
  dvi__shifts shift;        /* from the last step's u and f to those of this one */
};

typedef struct dvi__transformed_stages stages;

/* ---- create ---- */

static dvi_status stages_allocate(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r, batch = n * r, table = r * (size_t)a->lanes;
  stages *s = a->transformed;
  double **const part[] = {&s->place,  &s->momentum, &s->path,  &s->inverse_mass, &s->weight,
                           &s->energy, &s->rate,     &s->P,     &s->Z,            &s->next,
                           &s->u,      &s->f,        &s->at.g,  &s->at.V,         &s->at.g_q,
                           &s->at.V_q, &s->shift.table};
  const size_t size[] = {table, table, r * (size_t)a->path_lanes,
                         n,     r,     r,
                         r,     batch, batch,
                         batch, batch, batch,
                         r,     r,     batch,
                         batch, DVI__SHIFTS * table};
  size_t total = 0;
  for (size_t i = 0; i < sizeof size / sizeof *size; i++) total += size[i];
  double *at = DVI_NEW(double, total);
  if (at == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r, a->n);
  for (size_t i = 0; i < sizeof part / sizeof *part; at += size[i++]) *part[i] = at;
  return DVI_OK;
}

dvi_status dvi__action_prepare_transformed(dvi__action *a)
{
  dvi__transformed *of = dvi__transformed_of(a->system);
  const double *masses = of != NULL ? dvi__transformed_masses(of) : NULL;
  if (masses == NULL || a->r != a->s) return DVI_OK;
  stages *s = a->transformed = DVI_NEW(stages, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  s->of = of;
  DVI_TRY(stages_allocate(a));
  for (int i = 0; i < a->n; i++) s->inverse_mass[i] = 1 / masses[i];
  return dvi__action_fill_transformed(a, s->place, s->momentum, s->path);
}

void dvi__action_clear_transformed(dvi__action *a)
{
  if (a->transformed != NULL) dvi__release(a->transformed->place);
  dvi__release(a->transformed);
  a->transformed = NULL;
}

/* ---- sums over the nodes ---- */

static void set_weights(dvi__action *a)
{
  stages *s = a->transformed;
  if (s->h == a->h) return;
  s->h = a->h;
  for (int j = 0; j < a->r; j++) s->weight[j] = a->h * a->weight[j];
}

/* Find the momenta from f. */
static void sum_forces(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r;
  stages *s = a->transformed;
  dvi__lanes_product(a->n, a->r, a->lanes, a->r, s->momentum, s->f, s->P);
  for (size_t i = 0; i < n; i++)
    for (size_t k = i * r; k < (i + 1) * r; k++) s->P[k] = a->p0[i] + s->P[k];
}

static void find_momenta(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r;
  stages *s = a->transformed;
  for (size_t j = 0; j < r; j++) s->energy[j] = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < r; j++)
      s->energy[j] += s->inverse_mass[i] * (s->P[i * r + j] * s->P[i * r + j]);
  for (size_t j = 0; j < r; j++) s->energy[j] = 0.5 * s->energy[j] + s->at.V[j];
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < r; j++)
      s->f[i * r + j] = -s->weight[j] * (s->at.g[j] * s->at.V_q[i * r + j] +
                                         s->energy[j] * s->at.g_q[i * r + j]);
  sum_forces(a);
}

/* Find the new offsets from u. */
static void sum_rates(dvi__action *a, double *Z)
{
  const stages *s = a->transformed;
  dvi__lanes_product(a->n, a->r, a->lanes, a->r, s->place, s->u, Z);
}

/* Take g where the new offsets are, to first order from where it was evaluated. */
static void predict_rates(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r;
  stages *s = a->transformed;
  for (size_t j = 0; j < r; j++) s->rate[j] = s->at.g[j];
  for (size_t i = 0; i < n; i++)
    for (size_t k = i * r, j = 0; j < r; j++, k++)
      s->rate[j] += s->at.g_q[k] * (s->next[k] - s->Z[k]);
  for (size_t j = 0; j < r; j++) s->rate[j] *= s->weight[j];
}

static void find_offsets(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r;
  stages *s = a->transformed;
  predict_rates(a);
  for (size_t i = 0; i < n; i++)
    for (size_t k = i * r, j = 0; j < r; j++, k++)
      s->u[k] = s->rate[j] * (s->inverse_mass[i] * s->P[k]);
  sum_rates(a, s->next);
}

/* ---- iterations ---- */

static void put_nodes(dvi__action *a)
{
  for (size_t i = 0, r = (size_t)a->r; i < (size_t)a->n; i++)
    for (size_t k = i * r; k < (i + 1) * r; k++) a->Q[k] = a->q0[i] + a->transformed->Z[k];
}

void dvi__transformed_begin(dvi__action *a, const double *Y)
{
  stages *s = a->transformed;
  set_weights(a);
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->psi, Y, s->Z);
  for (size_t k = 0, r = (size_t)a->r; k < (size_t)a->n * r; k++) s->P[k] = a->p0[k / r];
  put_nodes(a);
}

void dvi__transformed_continue(dvi__action *a, double ratio, const double *last)
{
  stages *s = a->transformed;
  set_weights(a);
  dvi__lanes_product(2 * a->n, a->r, a->lanes, a->r,
                     dvi__action_stage_shift(a, &s->shift, ratio), last, s->u);
  sum_forces(a);
  sum_rates(a, s->Z);
  put_nodes(a);
}

dvi_status dvi__transformed_iterate(dvi__action *a, double *change, double *largest)
{
  const size_t batch = (size_t)a->n * (size_t)a->r;
  stages *s = a->transformed;
  DVI_TRY(dvi__transformed_evaluate(s->of, a->r, a->t, a->Q, &s->at));
  a->iterated = 1;
  memcpy(s->next, s->Z, batch * sizeof(double));
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    find_momenta(a);
    find_offsets(a);
  }
  for (size_t k = 0; k < batch; k++) s->Z[k] -= s->next[k];
  *change = dvi__lanes_largest(batch, s->Z);
  *largest = dvi__lanes_largest(batch, s->next);
  memcpy(s->Z, s->next, batch * sizeof(double));
  put_nodes(a);
  return DVI_OK;
}

void dvi__transformed_path(const dvi__action *a, double *Y)
{
  const stages *s = a->transformed;
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, s->path, s->u, Y);
}

/* The error of each sum is Knuth's (1969), sec. 4.2.2. */
void dvi__transformed_ends(const dvi__action *a, double *dq, double *dq_low, double *dp)
{
  const stages *s = a->transformed;
  for (size_t i = 0, r = (size_t)a->r; i < (size_t)a->n; i++) {
    dq[i] = dq_low[i] = dp[i] = 0;
    for (size_t k = i * r; k < (i + 1) * r; k++) {
      const double sum = dq[i] + s->u[k], back = sum - dq[i];
      dq_low[i] += (dq[i] - (sum - back)) + (s->u[k] - back);
      dq[i] = sum;
      dp[i] += s->f[k];
    }
  }
}

/* Give u and f of the last iteration, or those of a path that the rows have. */
void dvi__transformed_flows(const dvi__action *a, double *flows)
{
  const size_t r = (size_t)a->r, batch = (size_t)a->n * r;
  const stages *s = a->transformed;
  if (a->iterated) {
    memcpy(flows, s->u, 2 * batch * sizeof(double));
    return;
  }
  for (size_t k = 0; k < batch; k++) {
    flows[k] = a->h * a->weight[k % r] * a->V[k];
    flows[batch + k] = a->h * a->L_q[k];
  }
}

/* ---- physical time ---- */

/* The action's quadrature of g is the derivative of the discrete action by E0. */
dvi_status dvi__action_duration(dvi__action *a, const double *Y, double *duration)
{
  dvi__transformed *transformed = dvi__transformed_of(a->system);
  *duration = a->h;
  if (transformed == NULL) return DVI_OK;
  double *g = a->line, sum = 0;
  if (a->iterated) {
    for (int j = 0; j < a->r; j++) sum += a->transformed->rate[j];
    *duration = sum;
    return DVI_OK;
  }
  dvi__action_stages(a, Y);
  DVI_TRY(dvi__monitor_value(dvi__transformed_monitor(transformed), a->r, a->Q, g));
  for (int j = 0; j < a->r; j++) sum += a->weight[j] * g[j];
  *duration = a->h * sum;
  return DVI_OK;
}
