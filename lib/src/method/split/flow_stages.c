#include "method/split/flow_stages.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "solve/progress.h"
#include "space/legendre.h"
#include "space/quadrature.h"
#include "system/part.h"

struct dvi__flow_stages {
  int n, s;
  const dvi_flow *flow;
  dvi_counters *counters;
  dvi_system *slow;       /* potentials of H1; NULL beside a declared rest */
  dvi__evaluator *forces; /* of `slow` */
  dvi__integrable *integrable;
  double *node, *slant, *weight; /* [s] c, c - 1/2, b */
  double *matrix;                /* [s*s] A by rows */
  double *legendre;              /* [s*s] (2k + 1) P_k at node j, by rows j */
  double ratio, *ahead;          /* [s*s] by rows: continues forces to a step `ratio` as long */
  double h, *t, *tau;            /* [s] the step */
  double *w0;                    /* [2n] */
  double *W, *Z, *moved;         /* [2 n*s] stages, and their points on the orbit, q before p */
  double *lambda, *G;            /* [2 n*s] grad H1 at the points, and G */
  double *numbers;               /* owns all of these */
};

/* ---- tables ---- */

/* Evaluate (2k + 1) P_k and the integrals of P_k from 0, k = 0..s-1, at a place c. */
static void flow_polynomials(int s, long double c, long double *value, long double *integral)
{
  long double difference[DVI_QUADRATURE_MAX + 2];
  dvi__legendre(s, c, value, difference);
  for (int k = 0; k < s; k++) {
    integral[k] = k == 0 ? c : -(difference[k + 1] + difference[k]) / (2 * (2 * k + 1));
    value[k] *= 2 * k + 1;
  }
}

/* Round to multiples of 2^-53, of which sums to 1 are exact. */
static double flow_to_grid(long double x)
{
  return (double)ldexpl(nearbyintl(ldexpl(x, 53)), -53);
}

static dvi_status fill_tables(dvi__flow_stages *own)
{
  const int s = own->s;
  long double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  long double value[DVI_QUADRATURE_MAX + 2], integral[DVI_QUADRATURE_MAX];
  DVI_TRY(dvi__quadrature_long(DVI_GAUSS, s, node, weight));
  for (int j = 0; j < s; j++) {
    own->slant[j] = flow_to_grid(node[j] - 0.5L);
    own->node[j] = 0.5 + own->slant[j];
    own->weight[j] = (double)weight[j];
    flow_polynomials(s, node[j], value, integral);
    for (int k = 0; k < s; k++) own->legendre[j * s + k] = (double)value[k];
  }
  for (int i = 0; i < s; i++) {
    flow_polynomials(s, node[i], value, integral);
    for (int j = 0; j < i; j++) {
      long double a = -0.5L, other[DVI_QUADRATURE_MAX + 2], unused[DVI_QUADRATURE_MAX];
      flow_polynomials(s, node[j], other, unused);
      for (int k = 0; k < s; k++) a += other[k] * integral[k];
      own->matrix[i * s + j] = 0.5 + flow_to_grid(a);
      own->matrix[j * s + i] = 0.5 - flow_to_grid(a);
    }
    own->matrix[i * s + i] = 0.5;
  }
  return DVI_OK;
}

/* Lagrange's polynomials of the nodes, at the nodes of the next step. */
static void extrapolate_nodes(dvi__flow_stages *own, double ratio)
{
  const int s = own->s;
  if (own->ratio == ratio) return;
  own->ratio = ratio;
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      const double x = 1 + ratio * own->node[i];
      double product = 1;
      for (int k = 0; k < s; k++)
        if (k != j) product *= (x - own->node[k]) / (own->node[j] - own->node[k]);
      own->ahead[i * s + j] = product;
    }
}

/* ---- create, destroy ---- */

/* Cut `count` numbers off. */
static double *cut(double **at, size_t count)
{
  double *first = *at;
  *at += count;
  return first;
}

static dvi_status allocate_flow_stages(dvi__flow_stages *own)
{
  const size_t n = (size_t)own->n, s = (size_t)own->s, batch = 2 * n * s;
  double *at = own->numbers = DVI_NEW(double, 5 * s + 3 * s * s + 2 * n + 5 * batch);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory for %zu stages", s);
  own->node = cut(&at, s);
  own->slant = cut(&at, s);
  own->weight = cut(&at, s);
  own->t = cut(&at, s);
  own->tau = cut(&at, s);
  own->matrix = cut(&at, s * s);
  own->legendre = cut(&at, s * s);
  own->ahead = cut(&at, s * s);
  own->w0 = cut(&at, 2 * n);
  own->W = cut(&at, batch);
  own->Z = cut(&at, batch);
  own->moved = cut(&at, batch);
  own->lambda = cut(&at, batch);
  own->G = cut(&at, batch);
  return DVI_OK;
}

static int has_rest(const dvi__flow_stages *own)
{
  return own->flow != NULL && own->flow->rest != NULL;
}

static dvi_status initialise_stages(dvi__flow_stages *own, const dvi_system *system)
{
  DVI_TRY(allocate_flow_stages(own));
  DVI_TRY(fill_tables(own));
  DVI_TRY(dvi__integrable_create(system, own->flow, own->s, own->counters, &own->integrable));
  if (has_rest(own)) return DVI_OK;
  DVI_TRY(dvi__system_slow_part(system, &own->slow));
  return dvi__evaluator_create(own->slow, own->s, DVI__GRADIENTS, own->counters, &own->forces);
}

dvi_status dvi__flow_stages_create(const dvi_system *system, const dvi_flow *flow, int stages,
                                   dvi_counters *counters, dvi__flow_stages **made)
{
  dvi__flow_stages *own = *made = DVI_NEW(dvi__flow_stages, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  *own = (dvi__flow_stages){.n = system->n, .s = stages, .flow = flow, .counters = counters};
  const dvi_status status = initialise_stages(own, system);
  if (status != DVI_OK) dvi__flow_stages_destroy(made);
  return status;
}

void dvi__flow_stages_destroy(dvi__flow_stages **stages)
{
  dvi__flow_stages *own = *stages;
  if (own == NULL) return;
  dvi__integrable_destroy(&own->integrable);
  dvi__evaluator_destroy(&own->forces);
  dvi_system_destroy(&own->slow);
  dvi__release(own->numbers);
  dvi__release(own);
  *stages = NULL;
}

dvi__integrable *dvi__flow_stages_flow(const dvi__flow_stages *own)
{
  return own->integrable;
}

/* ---- the iteration ---- */

static size_t half_batch(const dvi__flow_stages *own)
{
  return (size_t)own->n * (size_t)own->s;
}

static dvi__points stage_points(const dvi__flow_stages *own)
{
  return (dvi__points){
      .count = own->s, .tau = own->tau, .q = own->W, .p = own->W + half_batch(own)};
}

/* Move the stages along the flow, into `to`. */
static dvi_status move_stages(dvi__flow_stages *own, double *to)
{
  const dvi__points points = stage_points(own);
  return dvi__integrable_move(own->integrable, &points, to,
                              has_rest(own) ? to + half_batch(own) : NULL);
}

static dvi_status evaluate_rest(dvi__flow_stages *own)
{
  const size_t half = half_batch(own);
  double *lambda = own->lambda;
  if (!has_rest(own)) return dvi__potentials_gradient(own->forces, own->s, own->t, own->Z, lambda);
  for (size_t i = 0; i < 2 * half; i++) lambda[i] = (double)NAN;
  own->counters->gradients += own->s;
  const int returned = own->flow->rest(own->s, own->t, own->Z, own->Z + half, lambda, lambda + half,
                                       own->flow->user);
  if (returned != 0)
    return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                     "the flow's rest returned %d", returned);
  if (dvi__first_not_finite(2 * half, lambda) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the flow's rest gave NaN or Inf, or left a number out");
}

/* Set G from the forces, G_q = h b D_p and G_p = -h b D_q of the pulled back forces D. */
static dvi_status pull_back(dvi__flow_stages *own)
{
  const size_t half = half_batch(own), s = (size_t)own->s;
  const dvi__points points = stage_points(own);
  double *G_q = own->G, *G_p = own->G + half;
  DVI_TRY(dvi__integrable_pullback(own->integrable, &points, own->lambda,
                                   has_rest(own) ? own->lambda + half : NULL, G_p, G_q));
  for (size_t i = 0; i < (size_t)own->n; i++)
    for (size_t j = 0; j < s; j++) {
      const double part = own->h * own->weight[j];
      G_q[i * s + j] *= part;
      G_p[i * s + j] *= -part;
    }
  return DVI_OK;
}

/* Set W_i = w0 + sum_j A_ij G_j. */
static void place_stages(dvi__flow_stages *own)
{
  const int s = own->s;
  for (int row = 0; row < 2 * own->n; row++)
    for (int i = 0; i < s; i++) {
      double sum = 0;
      for (int j = 0; j < s; j++) sum += own->matrix[i * s + j] * own->G[row * s + j];
      own->W[row * s + i] = own->w0[row] + sum;
    }
}

/* Guess the stages: on the orbit of w0, or where the continued forces of the last step take
 * them. */
static dvi_status guess_stages(dvi__flow_stages *own, const double *kept)
{
  const int s = own->s, rows = has_rest(own) ? 2 * own->n : own->n;
  const double last_h = kept[0], *last = kept + 1;
  memset(own->G, 0, 2 * half_batch(own) * sizeof(double));
  place_stages(own);
  dvi__integrable_begin(own->integrable);
  DVI_TRY(move_stages(own, own->Z));
  if (last_h == 0) return DVI_OK;
  extrapolate_nodes(own, own->h / last_h);
  for (int row = 0; row < rows; row++)
    for (int i = 0; i < s; i++) {
      double sum = 0;
      for (int j = 0; j < s; j++) sum += own->ahead[i * s + j] * last[row * s + j];
      own->lambda[row * s + i] = sum;
    }
  DVI_TRY(pull_back(own));
  place_stages(own);
  return move_stages(own, own->Z);
}

/* Find the largest change of n rows of the stages on the orbit, from Z to `moved`, and their
 * largest distance from w0. */
static void measure(const dvi__flow_stages *own, int first_row, double *change, double *largest)
{
  const int s = own->s;
  *change = *largest = 0;
  for (int row = first_row; row < first_row + own->n; row++)
    for (int i = row * s; i < (row + 1) * s; i++) {
      *change = fmax(*change, fabs(own->moved[i] - own->Z[i]));
      *largest = fmax(*largest, fabs(own->moved[i] - own->w0[row]));
    }
}

/* Make one iteration. Gives the largest change of a coordinate on the orbit, and the largest
 * distance of one from w0. Where the rest depends on the momenta, their change counts, too, in
 * parts of their distance. */
static dvi_status iterate_stages(dvi__flow_stages *own, double *change, double *largest)
{
  own->counters->residuals++;
  DVI_TRY(evaluate_rest(own));
  DVI_TRY(pull_back(own));
  place_stages(own);
  DVI_TRY(move_stages(own, own->moved));
  measure(own, 0, change, largest);
  if (has_rest(own)) {
    double kick, most;
    measure(own, own->n, &kick, &most);
    if (most > 0) *change = fmax(*change, kick / most * *largest);
  }
  double *last = own->Z;
  own->Z = own->moved;
  own->moved = last;
  return DVI_OK;
}

static void place_step(dvi__flow_stages *own, double t, double h, const double *q0,
                       const double *p0)
{
  const size_t n = (size_t)own->n;
  own->h = h;
  for (int j = 0; j < own->s; j++) {
    own->tau[j] = h * own->slant[j];
    own->t[j] = t + h * own->node[j];
  }
  memcpy(own->w0, q0, n * sizeof(double));
  memcpy(own->w0 + n, p0, n * sizeof(double));
}

/* No other solver follows, and any gain is taken. */
dvi_status dvi__flow_stages_solve(dvi__flow_stages *own, double t, double h, const double *q0,
                                  const double *p0, const double *kept)
{
  const dvi__criteria criteria = dvi__fixed_point_criteria(1, 1);
  const int most = dvi__fixed_point_most(1);
  dvi__history history = {0};
  double change, largest;
  place_step(own, t, h, q0, p0);
  DVI_TRY(guess_stages(own, kept));
  for (int iteration = 0; iteration < most; iteration++) {
    DVI_TRY(iterate_stages(own, &change, &largest));
    const dvi__progress progress = dvi__test_correction(change, &history, &criteria, largest,
                                                        dvi__largest((size_t)own->n, own->w0));
    if (progress == DVI__STALLED) break;
    if (progress != DVI__CONVERGED) continue;
    own->counters->fixed_points++;
    return DVI_OK;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the rest beside the flow is too large for a step of h = %.6g: fixed-point "
                   "iteration does not contract (change %.1e after %.1e)",
                   h, history.last, history.before);
}

/* ---- results ---- */

void dvi__flow_stages_ends(const dvi__flow_stages *own, double *dq, double *dp)
{
  const int s = own->s;
  for (int row = 0; row < 2 * own->n; row++) {
    double sum = 0;
    for (int j = 0; j < s; j++) sum += own->G[row * s + j];
    *(row < own->n ? dq + row : dp + (row - own->n)) = sum;
  }
}

static size_t kept_forces(const dvi__flow_stages *own)
{
  return (has_rest(own) ? 2 : 1) * half_batch(own);
}

/* The numbers are h, the forces, w0, and G. */
size_t dvi__flow_stages_kept(const dvi__flow_stages *own)
{
  return 1 + kept_forces(own) + 2 * (size_t)own->n + 2 * half_batch(own);
}

void dvi__flow_stages_keep(const dvi__flow_stages *own, double *kept)
{
  const size_t n = (size_t)own->n, forces = kept_forces(own);
  kept[0] = own->h;
  memcpy(kept + 1, own->lambda, forces * sizeof(double));
  memcpy(kept + 1 + forces, own->w0, 2 * n * sizeof(double));
  memcpy(kept + 1 + forces + 2 * n, own->G, 2 * half_batch(own) * sizeof(double));
}

dvi_status dvi__flow_stages_path(dvi__flow_stages *own, const double *kept, double x, double *q,
                                 double *p)
{
  const int s = own->s, n = own->n;
  const double *w0 = kept + 1 + kept_forces(own), *G = w0 + 2 * (ptrdiff_t)n,
               tau = kept[0] * (x - 0.5);
  long double value[DVI_QUADRATURE_MAX + 2], integral[DVI_QUADRATURE_MAX];
  double *w = own->W;
  flow_polynomials(s, x, value, integral);
  memcpy(w, w0, 2 * (size_t)n * sizeof *w);
  for (int j = 0; j < s; j++) {
    double part = 0;
    for (int k = 0; k < s; k++) part += own->legendre[j * s + k] * (double)integral[k];
    for (int row = 0; row < 2 * n; row++) w[row] += part * G[row * s + j];
  }
  dvi__integrable_begin(own->integrable);
  return dvi__integrable_move(own->integrable,
                              &(dvi__points){.count = 1, .tau = &tau, .q = w, .p = w + n}, q, p);
}
