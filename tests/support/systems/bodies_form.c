/* Compares the symplectic form of bodies before and after a step. */
#include <dvi/group.h>
#include <math.h>
#include <string.h>

#include "support/systems/bodies.h"
#include "support/suite.h"

enum { DIRECTIONS_MOST = 2 * BODY_V, POINTS = 4 };

/* the step of differences of order 4, which err by 1e-11, and by roundoff as much */
static const double difference_step = 2e-3;

typedef struct body_state {
  double q[BODY_Q], p[BODY_V];
} body_state;

/* A tangent vector, factor by factor: eta and dPi of a rotation, the other factors as stored. */
typedef struct tangent {
  double q[BODY_V], p[BODY_V];
} tangent;

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int has_rotation(const dvi_factor *factor)
{
  return factor->kind == DVI_SO3 || factor->kind == DVI_SE3;
}

static int coordinate_count(const dvi_factor *factor)
{
  return factor->kind == DVI_SO3   ? 9
         : factor->kind == DVI_SE3 ? 12
         : factor->kind == DVI_U1  ? 2
                                   : 3;
}

static int velocity_count(const dvi_factor *factor)
{
  return factor->kind == DVI_SE3 ? 6 : factor->kind == DVI_U1 ? 1 : 3;
}

/* Moves one factor by `by` along its velocity number k, or along its momentum number k - nv. */
static void move_factor(const dvi_factor *factor, int k, double by, double *q, double *p)
{
  const int nv = velocity_count(factor);
  double e[6] = {0}, E[9], R[9];
  if (k >= nv)
    p[k - nv] += by;
  else if (has_rotation(factor) && k >= 3)
    q[6 + k] += by;
  else if (factor->kind == DVI_RN)
    q[k] += by;
  e[k % nv] = by;
  if (has_rotation(factor) && k < 3) {
    dvi_so3_exp(e, E);
    memcpy(R, q, sizeof R);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        q[3 * i + j] = R[3 * i] * E[j] + R[3 * i + 1] * E[3 + j] + R[3 * i + 2] * E[6 + j];
  }
  if (factor->kind == DVI_U1 && k == 0) {
    const double angle = dvi_u1_log(q) + by;
    dvi_u1_exp(angle, q);
  }
  if (factor->kind != DVI_S2) return;
  const double along = dot(e, q);
  for (int i = 0; i < 3; i++) e[i] -= along * q[i];
  if (k < nv) dvi_s2_exp(q, e, q);
  const double radial = dot(p, q);
  for (int i = 0; i < 3; i++) p[i] -= radial * q[i];
}

static double largest_size(int count, const double *p)
{
  double largest = 0;
  for (int i = 0; i < count; i++) largest = fmax(largest, fabs(p[i]));
  return largest;
}

/* Moves along direction number k of all factors in a row. A momentum is in units of the factor's
 * largest momentum at the start. */
static void displace(const body *model, int k, double by, const body_state *start, body_state *at)
{
  int q = 0, v = 0;
  for (int f = 0; f < model->factor_count; f++) {
    const dvi_factor *factor = &model->factors[f];
    const int nv = velocity_count(factor), direction = k - 2 * v;
    if (direction >= 0 && direction < 2 * nv)
      move_factor(factor, direction, direction < nv ? by : by * largest_size(nv, start->p + v),
                  at->q + q, at->p + v);
    q += coordinate_count(factor);
    v += nv;
  }
}

static void add_difference(double weight, const dvi_factor *factor, const double *q0,
                           const double *q, double *delta)
{
  if (has_rotation(factor)) {
    double E[9], eta[3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        E[3 * i + j] = q0[i] * q[j] + q0[3 + i] * q[3 + j] + q0[6 + i] * q[6 + j];
    ck_assert_int_eq(dvi_so3_log(E, eta), DVI_OK);
    for (int i = 0; i < 3; i++) delta[i] += weight * eta[i];
    for (int i = 3; i < velocity_count(factor); i++) delta[i] += weight * (q[6 + i] - q0[6 + i]);
  } else if (factor->kind == DVI_U1) {
    delta[0] += weight * (q0[0] * q[1] - q0[1] * q[0]);
  } else {
    for (int i = 0; i < 3; i++) delta[i] += weight * q[i];
  }
}

static void add_state_difference(const body *model, double weight, const body_state *middle,
                                 const body_state *at, tangent *sum)
{
  int q = 0, v = 0;
  for (int f = 0; f < model->factor_count; f++) {
    const dvi_factor *factor = &model->factors[f];
    add_difference(weight, factor, middle->q + q, at->q + q, sum->q + v);
    for (int i = 0; i < velocity_count(factor); i++) sum->p[v + i] += weight * at->p[v + i];
    q += coordinate_count(factor);
    v += velocity_count(factor);
  }
}

static double symplectic_form(const body *model, const body_state *at, const tangent *a,
                              const tangent *b)
{
  double sum = 0;
  int v = 0;
  for (int i = 0; i < model->nv; i++) sum += a->p[i] * b->q[i] - b->p[i] * a->q[i];
  for (int f = 0; f < model->factor_count; f++) {
    const double *x = a->q + v, *y = b->q + v;
    const double bracket[] = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                              x[0] * y[1] - x[1] * y[0]};
    if (has_rotation(&model->factors[f])) sum -= dot(at->p + v, bracket);
    v += velocity_count(&model->factors[f]);
  }
  return sum;
}

static void read_body_state(const body *model, const dvi_integrator *made, body_state *state)
{
  memcpy(state->q, dvi_integrator_q(made), (size_t)model->nq * sizeof *state->q);
  memcpy(state->p, dvi_integrator_p(made), (size_t)model->nv * sizeof *state->p);
}

/* Takes a step. `from` is moved onto the constraints, if there are any. */
static void take_step(const body *model, const char *method, double h, body_state *from,
                      body_state *to)
{
  const dvi_start_options project = {.project = 1};
  dvi_integrator *made = NULL;
  ck_assert_msg(dvi_integrator_create(model->system, method, &made) == DVI_OK &&
                    dvi_integrator_start_with(made, 0, from->q, from->p, &project) == DVI_OK,
                "%s, %s: %s", model->name, method, dvi_last_error());
  read_body_state(model, made, from);
  ck_assert_msg(dvi_integrator_step(made, h) == DVI_OK, "%s, %s: %s", model->name, method,
                dvi_last_error());
  read_body_state(model, made, to);
  dvi_integrator_destroy(&made);
}

double symplectic_defect(const body *model, const char *method, double h)
{
  static const double multiple[POINTS] = {-2, -1, 1, 2},
                      weight[POINTS] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  tangent before[DIRECTIONS_MOST] = {0}, after[DIRECTIONS_MOST] = {0};
  body_state start = {0}, end = {0}, near, moved = {0};
  double largest = 0;
  memcpy(start.q, model->q, sizeof start.q);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, model->q, model->v, start.p), DVI_OK);
  take_step(model, method, h, &start, &end);
  for (int k = 0; k < 2 * model->nv; k++)
    for (int point = 0; point < POINTS; point++) {
      near = start;
      displace(model, k, multiple[point] * difference_step, &start, &near);
      take_step(model, method, h, &near, &moved);
      add_state_difference(model, weight[point] / difference_step, &start, &near, &before[k]);
      add_state_difference(model, weight[point] / difference_step, &end, &moved, &after[k]);
    }
  for (int k = 0; k < 2 * model->nv; k++)
    for (int l = 0; l < k; l++)
      largest = fmax(largest, fabs(symplectic_form(model, &end, &after[k], &after[l]) -
                                   symplectic_form(model, &start, &before[k], &before[l])));
  return largest / largest_size(model->nv, start.p);
}
