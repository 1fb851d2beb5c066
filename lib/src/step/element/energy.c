#include "step/element/energy.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"

/* ---- memory ---- */

/* Allocate memory for systems that are not autonomous. There are two gradients at moved times, L_tq
 * and L_tv, and times and rates over the nodes. */
static int energy_allocate_rates(dvi__action *a)
{
  const size_t batch = (size_t)a->n * (size_t)a->r;
  a->moved_q = DVI_NEW(double, batch);
  a->moved_v = DVI_NEW(double, batch);
  a->rate_q = DVI_NEW(double, batch);
  a->rate_v = DVI_NEW(double, batch);
  a->moved_t = DVI_NEW(double, a->r);
  a->rate_t = DVI_NEW(double, a->r);
  a->moved_rate = DVI_NEW(double, a->r);
  return a->moved_q && a->moved_v && a->rate_q && a->rate_v && a->moved_t && a->rate_t &&
         a->moved_rate;
}

dvi_status dvi__action_prepare_energy(dvi__action *a)
{
  const size_t batch = (size_t)a->n * (size_t)a->r;
  DVI_TRY(dvi__system_has_rates(a->system));
  a->value = DVI_NEW(double, a->r);
  a->rate = DVI_NEW(double, a->r);
  a->by_q = DVI_NEW(double, batch);
  a->by_v = DVI_NEW(double, batch);
  if (a->value && a->rate && a->by_q && a->by_v &&
      (a->system->autonomous || energy_allocate_rates(a)))
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for the energies of %d coordinates", a->n);
}

void dvi__action_clear_energy(dvi__action *a)
{
  double *const owned[] = {a->value,  a->rate,    a->by_q,       a->by_v,    a->rate_q, a->rate_v,
                           a->rate_t, a->moved_t, a->moved_rate, a->moved_q, a->moved_v};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
}

/* ---- energies ---- */

dvi_status dvi__action_energies(dvi__action *a, dvi__energies *E)
{
  const size_t r = (size_t)a->r;
  double energy = 0, rate = 0, late_rate = 0, size = 0;
  DVI_TRY(dvi__lagrangian_value(a->evaluator, a->r, a->t, a->Q, a->V, a->value));
  DVI_TRY(dvi__lagrangian_rate(a->evaluator, a->r, a->t, a->Q, a->V, a->rate));
  for (size_t j = 0; j < r; j++) {
    double twice_kinetic = 0; /* L_v V; the residual left its weight in L_v */
    for (size_t i = 0; i < (size_t)a->n; i++) twice_kinetic += a->L_v[i * r + j] * a->V[i * r + j];
    energy += twice_kinetic - a->weight[j] * a->value[j];
    size += fabs(twice_kinetic) + fabs(a->weight[j] * a->value[j]);
    rate += a->weight[j] * a->rate[j];
    late_rate += a->weight[j] * a->node[j] * a->rate[j];
  }
  *E = (dvi__energies){energy + a->h * (rate - late_rate), energy - a->h * late_rate, size};
  return DVI_OK;
}

/* ---- gradients ---- */

/* Add factor * H x to y for a batch, with H in the order of the pattern. */
static void add_product(const dvi__pattern *pattern, size_t points, const double *H,
                        const double *x, double factor, double *y)
{
  for (size_t column = 0; column < (size_t)pattern->columns; column++)
    for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++)
      for (size_t j = 0; j < points; j++)
        y[(size_t)pattern->row[e] * points + j] += factor * H[(size_t)e * points + j] *
                                                   x[column * points + j];
}

/* Find the change by_q . dQ + by_v . dQ' of L_v V - L at the nodes, with the derivative Q' = h V in
 * tau. by_q = L_qv V - L_q, by_v = L_vv V / h. */
static dvi_status weigh_directions(dvi__action *a)
{
  const size_t r = (size_t)a->r, batch = (size_t)a->n * r;
  DVI_TRY(dvi__lagrangian_gradient(a->evaluator, a->r, a->t, a->Q, a->V, a->by_q, NULL));
  for (size_t e = 0; e < batch; e++) a->by_q[e] = -a->by_q[e];
  memset(a->by_v, 0, batch * sizeof(double));
  add_product(&a->system->qv, r, a->H_qv, a->V, 1, a->by_q);
  add_product(&a->system->vv, r, a->H_vv, a->V, 1 / a->h, a->by_v);
  return DVI_OK;
}

/* Give the step of differences in time. Differences over steps of 1/64 and 1/32 of h are of order
 * 4. They err by 1e-9 of the derivative where h is a radian of the driving motion. */
static double rate_step(const dvi__action *a, int j)
{
  return fmax(fabs(a->h) / 64, 64 * DBL_EPSILON * fabs(a->t[j]));
}

/* Add the part of one moved time, m steps away, to the derivative
 *
 *     f' = sum over m of w_m ( f(t + m step) - f(t - m step) ) / (their distance). */
static dvi_status add_moved_rates(dvi__action *a, int m)
{
  const double weight = m == 1 || m == -1 ? 4.0 / 3 : -1.0 / 3;
  const size_t r = (size_t)a->r;
  double *factor = a->line;
  for (int j = 0; j < a->r; j++) {
    const double moved = m * rate_step(a, j), here = a->t[j] + moved, there = a->t[j] - moved;
    a->moved_t[j] = here;
    factor[j] = weight / (here - there);
  }
  DVI_TRY(
      dvi__lagrangian_gradient(a->evaluator, a->r, a->moved_t, a->Q, a->V, a->moved_q, a->moved_v));
  DVI_TRY(dvi__lagrangian_rate(a->evaluator, a->r, a->moved_t, a->Q, a->V, a->moved_rate));
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) {
      a->rate_q[i * r + j] += factor[j] * a->moved_q[i * r + j];
      a->rate_v[i * r + j] += factor[j] * a->moved_v[i * r + j];
    }
  for (size_t j = 0; j < r; j++) a->rate_t[j] += factor[j] * a->moved_rate[j];
  return DVI_OK;
}

/* Evaluate L_t, L_tq, L_tv and L_tt at the nodes. */
static dvi_status difference_rates(dvi__action *a)
{
  const size_t r = (size_t)a->r, bytes = (size_t)a->n * r * sizeof(double);
  memset(a->rate_q, 0, bytes);
  memset(a->rate_v, 0, bytes);
  memset(a->rate_t, 0, r * sizeof(double));
  DVI_TRY(dvi__lagrangian_rate(a->evaluator, a->r, a->t, a->Q, a->V, a->rate));
  for (int m = -2; m <= 2; m++)
    if (m != 0) DVI_TRY(add_moved_rates(a, m));
  return DVI_OK;
}

/* Give the time of L_t in an energy, from the node. E- looks back from its own end, E+ from the
 * other one. */
static double rate_lever(const dvi__action *a, int at_start, int j)
{
  return at_start - a->node[j];
}

/* Write one coordinate of by_q and by_v with the rates' part, times the weights, into a->line. */
static void weigh_line(const dvi__action *a, int at_start, size_t i)
{
  double *in_q = a->line, *in_v = a->line + a->r;
  for (int j = 0; j < a->r; j++) {
    const size_t at = i * (size_t)a->r + (size_t)j;
    in_q[j] = a->by_q[at];
    in_v[j] = a->by_v[at];
    if (!a->system->autonomous) {
      in_q[j] += rate_lever(a, at_start, j) * a->h * a->rate_q[at];
      in_v[j] += rate_lever(a, at_start, j) * a->rate_v[at];
    }
    in_q[j] *= a->weight[j];
    in_v[j] *= a->weight[j];
  }
}

/* Give sum_i x_i V_i at node j. */
static double along_velocity(const dvi__action *a, int j, const double *x)
{
  double sum = 0;
  for (size_t i = 0, r = (size_t)a->r; i < (size_t)a->n; i++)
    sum += x[i * r + (size_t)j] * a->V[i * r + (size_t)j];
  return sum;
}

/* Give dE/dh with Y fixed, where V shrinks as 1/h and the nodes move by c_j.
 *     sum_j b_j ( -V.L_vv V/h + (c - l) L_tv V + (l - c) L_t + c l h L_tt )_j,   l the lever. */
static double derivative_in_h(const dvi__action *a, int at_start)
{
  double sum = 0;
  for (int j = 0; j < a->r; j++) {
    double term = -along_velocity(a, j, a->by_v);
    if (!a->system->autonomous) {
      const double c = a->node[j], l = rate_lever(a, at_start, j);
      term += (c - l) * (along_velocity(a, j, a->rate_v) - a->rate[j]) +
              c * l * a->h * a->rate_t[j];
    }
    sum += a->weight[j] * term;
  }
  return sum;
}

static double line_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int j = 0; j < count; j++) sum += x[j] * y[j];
  return sum;
}

static void collect_gradient(dvi__action *a, int at_start, dvi__energy_gradient *gradient)
{
  const double *in_q = a->line, *in_v = a->line + a->r;
  for (size_t i = 0; i < (size_t)a->n; i++) {
    weigh_line(a, at_start, i);
    gradient->q0[i] = 0;
    for (int j = 0; j < a->r; j++) gradient->q0[i] += in_q[j];
    for (int k = 0; k < a->s; k++)
      gradient->Y[i * (size_t)a->s + (size_t)k] = line_dot(a->r, a->psi + k * a->lanes, in_q) +
                                                  line_dot(a->r, a->dpsi + k * a->lanes, in_v);
  }
  gradient->h = derivative_in_h(a, at_start);
}

dvi_status dvi__action_energy_gradients(dvi__action *a, dvi__energy_gradient *start,
                                        dvi__energy_gradient *end)
{
  DVI_TRY(weigh_directions(a));
  if (!a->system->autonomous) DVI_TRY(difference_rates(a));
  collect_gradient(a, 1, start);
  collect_gradient(a, 0, end);
  return DVI_OK;
}

void dvi__action_h_column(const dvi__action *a, const dvi__energy_gradient *end, double *column)
{
  for (size_t i = 0, s = (size_t)a->s; i < (size_t)a->n; i++)
    for (size_t k = 0; k < s; k++) column[i * s + k] = a->end[k] * end->q0[i] - end->Y[i * s + k];
}
