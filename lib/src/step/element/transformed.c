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
 * The iteration contracts with h g_q.v, where that of given systems does with h^2 V_qq/m. This is
 * the work of two numbers at each node, g and the kinetic energy. Both are known to first order
 * without another evaluation, the energy by the new P, and g by its gradient. So the sums are
 * formed several times for each evaluation.
 *
 * The physical time of an element is here for all transformed systems. */
#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/fixed_point.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/simd/lanes.h"
#include "num/simd/rescaled.h"
#include "system/rescale/transformed.h"

/* Sums for each evaluation. Without the third one steps of kepler with e = 0.9 and h = 0.7 take a
 * sixth more evaluations, and a quarter of those with h = 1.2 do not contract. More gain
 * little. */
enum { SWEEPS = 3 };

/* Where the first iteration moves continued nodes by more than this part of the step, as after a
 * close encounter, a straight line is the better start. */
static const double farthest = 0.5;

struct dvi__transformed_stages {
  dvi__transformed *of;
  dvi__rescaled_sums sums; /* its arrays are parts of `numbers`, but for p0, origin and Q */
  dvi__rescaled at;        /* what was evaluated at Q, the same arrays */
  double *numbers;
  double *place, *momentum; /* [r*lanes] W_ij and 1 - W_ji by columns */
  double *path;             /* [r*path_lanes] from u to paths, by columns */
  double *inverse_mass;     /* [n] */
  double *weight, h;        /* [lanes] h b_j, and the h of them */
  int continues;            /* the nodes are those of continued u and f */
  dvi__shifts shift;        /* from the last step's u and f to those of this one */
};

typedef struct dvi__transformed_stages stages;

/* ---- create ---- */

/* Allocate all arrays. Those which are evaluated have room for whole vectors behind their last
 * row. */
static dvi_status stages_allocate(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r, lanes = (size_t)a->lanes, batch = n * r,
               table = r * lanes, rows = n * lanes;
  stages *s = a->transformed;
  double **const part[] = {&s->place,     &s->momentum, &s->path,   &s->inverse_mass,
                           &s->weight,    &s->at.g,     &s->at.V,   &s->at.g_q,
                           &s->at.V_q,    &s->sums.P,   &s->sums.Z, &s->sums.next,
                           &s->sums.rate, &s->sums.u,   &s->sums.f, &s->shift.table};
  const size_t size[] = {table,
                         table,
                         r * (size_t)a->path_lanes,
                         n,
                         lanes,
                         lanes,
                         lanes,
                         batch + lanes,
                         batch + lanes,
                         rows,
                         rows,
                         rows,
                         lanes,
                         batch,
                         batch,
                         DVI__SHIFTS * table};
  size_t total = 0;
  for (size_t i = 0; i < sizeof size / sizeof *size; i++) total += size[i];
  double *at = s->numbers = DVI_NEW(double, total);
  if (at == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r, a->n);
  for (size_t i = 0; i < sizeof part / sizeof *part; at += size[i++]) *part[i] = at;
  return DVI_OK;
}

/* Let the sums have their arrays. */
static void stages_connect(dvi__action *a)
{
  stages *s = a->transformed;
  s->sums.n = a->n;
  s->sums.stages = a->r;
  s->sums.lanes = a->lanes;
  s->sums.sweeps = SWEEPS;
  s->sums.place = s->place;
  s->sums.momentum = s->momentum;
  s->sums.weight = s->weight;
  s->sums.inverse_mass = s->inverse_mass;
  s->sums.g = s->at.g;
  s->sums.V = s->at.V;
  s->sums.g_q = s->at.g_q;
  s->sums.V_q = s->at.V_q;
  s->sums.Q = a->Q;
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
  stages_connect(a);
  for (int i = 0; i < a->n; i++) s->inverse_mass[i] = 1 / masses[i];
  return dvi__action_fill_transformed(a, s->place, s->momentum, s->path);
}

void dvi__action_clear_transformed(dvi__action *a)
{
  if (a->transformed != NULL) dvi__release(a->transformed->numbers);
  dvi__release(a->transformed);
  a->transformed = NULL;
}

/* ---- iterations ---- */

/* Put the sums at the element's place. */
static void place_sums(dvi__action *a)
{
  stages *s = a->transformed;
  s->sums.p0 = a->p0;
  s->sums.origin = a->q0;
  if (s->h == a->h) return;
  s->h = a->h;
  for (int j = 0; j < a->r; j++) s->weight[j] = a->h * a->weight[j];
}

/* Put the nodes where Z has them, with the momenta of the start. */
static void put_nodes(dvi__action *a)
{
  const size_t r = (size_t)a->r, lanes = (size_t)a->lanes;
  const stages *s = a->transformed;
  for (size_t i = 0; i < (size_t)a->n; i++) {
    for (size_t j = 0; j < r; j++) a->Q[i * r + j] = a->q0[i] + s->sums.Z[i * lanes + j];
    for (size_t j = 0; j < lanes; j++) s->sums.P[i * lanes + j] = a->p0[i];
  }
}

void dvi__transformed_begin(dvi__action *a, const double *Y)
{
  stages *s = a->transformed;
  place_sums(a);
  s->continues = 0;
  dvi__lanes_product(a->n, a->s, a->lanes, a->lanes, a->psi, Y, s->sums.Z);
  put_nodes(a);
}

/* Put the nodes on the straight line along the velocity at the start. */
static dvi_status begin_straight(dvi__action *a)
{
  double g;
  stages *s = a->transformed;
  DVI_TRY(dvi__monitor_value(dvi__transformed_monitor(s->of), 1, a->q0, &g));
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < (size_t)a->r; j++)
      s->sums.Z[i * (size_t)a->lanes + j] = a->node[j] *
                                            (a->h * g * (s->inverse_mass[i] * a->p0[i]));
  put_nodes(a);
  return DVI_OK;
}

void dvi__transformed_continue(dvi__action *a, double ratio, const double *flows)
{
  stages *s = a->transformed;
  place_sums(a);
  dvi__lanes_product(2 * a->n, a->r, a->lanes, a->r, dvi__action_stage_shift(a, &s->shift, ratio),
                     flows, s->sums.u);
  dvi__rescaled_begin(&s->sums);
  s->continues = 1;
}

static dvi_status iterate_once(dvi__action *a)
{
  stages *s = a->transformed;
  DVI_TRY(dvi__transformed_evaluate(s->of, a->r, a->t, a->Q, &s->at));
  a->iterated = 1;
  dvi__rescaled_iterate(&s->sums);
  return DVI_OK;
}

dvi_status dvi__transformed_iterate(dvi__action *a, double *change, double *largest)
{
  stages *s = a->transformed;
  DVI_TRY(iterate_once(a));
  if (s->continues && s->sums.change > farthest * s->sums.largest) {
    DVI_TRY(begin_straight(a));
    DVI_TRY(iterate_once(a));
  }
  s->continues = 0;
  *change = s->sums.change;
  *largest = s->sums.largest;
  return DVI_OK;
}

void dvi__transformed_path(const dvi__action *a, double *Y)
{
  const stages *s = a->transformed;
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, s->path, s->sums.u, Y);
}

void dvi__transformed_ends(const dvi__action *a, double *dq, double *dq_low, double *dp)
{
  const stages *s = a->transformed;
  for (size_t i = 0, r = (size_t)a->r; i < (size_t)a->n; i++) {
    dq[i] = dq_low[i] = dp[i] = 0;
    for (size_t k = i * r; k < (i + 1) * r; k++) {
      const dvi__twofold sum = dvi__exact_sum(dq[i], s->sums.u[k]);
      dq[i] = sum.head;
      dq_low[i] += sum.tail;
      dp[i] += s->sums.f[k];
    }
  }
}

/* Give u and f of the last iteration, or those of a path that the rows have. */
void dvi__transformed_flows(const dvi__action *a, double *flows)
{
  const size_t r = (size_t)a->r, batch = (size_t)a->n * r;
  const stages *s = a->transformed;
  if (a->iterated) {
    memcpy(flows, s->sums.u, 2 * batch * sizeof(double));
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
    for (int j = 0; j < a->r; j++) sum += a->transformed->sums.rate[j];
    *duration = sum;
    return DVI_OK;
  }
  dvi__action_stages(a, Y);
  DVI_TRY(dvi__monitor_value(dvi__transformed_monitor(transformed), a->r, a->Q, g));
  for (int j = 0; j < a->r; j++) sum += a->weight[j] * g[j];
  *duration = a->h * sum;
  return DVI_OK;
}

/* ---- the Jacobian at one place ---- */

/* Without (E0 - E) g_qq, which is small near the orbit, the Hessian of Lg is that of a sparse L and
 * four products with g_q (system/rescale/transformed.c). A system h U Lg_qq + T (Lg_wq - Lg_qw) +
 * Lg_ww/h is then S + g_q x^T + y g_q^T with S sparse,
 *
 *     S = h U g L_qq + T (L_vq - L_qv) + L_vv/(h g),
 *     x = h U (d + v.L_vv v/(2 g) g_q) + T L_vv v/g,   y the same with -T,
 *
 * which is solved with two more unknowns, x^T z and g_q^T z. They leave the determinant as it
 * is. */
struct dvi__rank_two {
  dvi__transformed *of;
  dvi__pattern joint, pattern; /* of S, and with the border */
  dvi__joint_entry *block;     /* [entries of joint] */
  dvi__curvature at;
};

/* Full matrices are as fast for fewer coordinates, and for a pattern that fills more than this part
 * of the matrix. */
enum { LEAST_BORDERED = 48 };
static const double most_filled = 0.25;

/* Put two full rows below the joint pattern, and two columns behind it. */
static dvi_status fill_border(dvi__rank_two *b)
{
  const int n = b->joint.columns, entries = dvi__pattern_entries(&b->joint);
  dvi__pattern *to = &b->pattern;
  to->rows = to->columns = n + 2;
  to->start = DVI_NEW(int, (size_t)n + 3);
  to->row = DVI_NEW(int, (size_t)entries + 4 * (size_t)n + 2);
  if (to->start == NULL || to->row == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for a border in %d dimensions", n);
  int at = 0;
  for (int j = 0; j < n; j++, at += 2) {
    to->start[j] = at;
    for (int e = b->joint.start[j]; e < b->joint.start[j + 1]; e++) to->row[at++] = b->joint.row[e];
    to->row[at] = n;
    to->row[at + 1] = n + 1;
  }
  for (int j = n; j < n + 2; j++) {
    to->start[j] = at;
    for (int i = 0; i < n; i++) to->row[at++] = i;
    to->row[at++] = j;
  }
  to->start[n + 2] = at;
  return DVI_OK;
}

dvi_status dvi__rank_two_create(const dvi_system *system, dvi__rank_two **rank_two)
{
  dvi__transformed *of = dvi__transformed_of(system);
  const double n = system->n;
  *rank_two = NULL;
  if (of == NULL || system->n < LEAST_BORDERED) return DVI_OK;
  dvi__rank_two *b = *rank_two = DVI_NEW(dvi__rank_two, 1);
  if (b == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  b->of = of;
  dvi_status status = dvi__joint_create(dvi__transformed_base(of), NULL, &b->joint, &b->block);
  const int sparse = status == DVI_OK && dvi__pattern_entries(&b->joint) <= most_filled * n * n;
  if (sparse) status = fill_border(b);
  if (!sparse || status != DVI_OK) dvi__rank_two_destroy(rank_two);
  return status;
}

void dvi__rank_two_destroy(dvi__rank_two **rank_two)
{
  dvi__rank_two *b = *rank_two;
  if (b == NULL) return;
  dvi__pattern_clear(&b->joint);
  dvi__pattern_clear(&b->pattern);
  dvi__release(b->block);
  dvi__release(b);
  *rank_two = NULL;
}

const dvi__pattern *dvi__rank_two_pattern(const dvi__rank_two *b)
{
  return &b->pattern;
}

dvi_status dvi__rank_two_evaluate(dvi__rank_two *b, double t, const double *q, const double *w)
{
  return dvi__transformed_curvature(b->of, t, q, w, &b->at);
}

/* One part, real or imaginary, of all entries. */
static void assemble_part(const dvi__rank_two *b, double hU, double T, double by_h, double unit,
                          int stride, double *values)
{
  const dvi__curvature *at = &b->at;
  const int n = b->joint.columns;
  const double half = at->vMv / (2 * at->g);
  for (int j = 0; j < n; j++) {
    for (int e = b->joint.start[j]; e < b->joint.start[j + 1]; e++, values += stride) {
      const dvi__joint_entry *block = &b->block[e];
      *values = hU * at->g * dvi__entry_or_zero(at->L_qq, block->qq) +
                T * (dvi__entry_or_zero(at->L_qv, block->vq) -
                     dvi__entry_or_zero(at->L_qv, block->qv)) +
                by_h * dvi__entry_or_zero(at->L_vv, block->vv);
    }
    values[0] = hU * (at->d[j] + half * at->g_q[j]) + T * at->Mv[j] / at->g;
    values[stride] = unit * at->g_q[j];
    values += 2 * (size_t)stride;
  }
  for (int i = 0; i < n; i++, values += stride) *values = unit * at->g_q[i];
  *values = -unit;
  values += stride;
  for (int i = 0; i < n; i++, values += stride)
    *values = hU * (at->d[i] + half * at->g_q[i]) - T * at->Mv[i] / at->g;
  *values = -unit;
}

void dvi__rank_two_assemble(const dvi__rank_two *b, double h, int parts, const double *U,
                            const double *T, double *values)
{
  for (int part = 0; part < parts; part++) {
    const double unit = part == 0;
    assemble_part(b, h * U[part], T[part], unit / (h * b->at.g), unit, parts, values + part);
  }
}
