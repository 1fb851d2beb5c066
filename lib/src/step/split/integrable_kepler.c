/* Bodies that move about a fixed centre, each on its own. */
#include <math.h>

#include "step/split/integrable_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

/* ---- the centres ---- */

enum { SAMPLES = 5 };

/* Put all bodies at a sample's place. At the first one the gradient is (k,0,0), with k to the last
 * bit. The others are spread over distances and directions. */
static void place_bodies(const dvi__integrable *own, int sample, double *q)
{
  static const double distance[SAMPLES] = {1, 1, 1e-3, 1e3, 37};
  for (int i = 0; i < own->n; i++) {
    const double angle = sample + 0.7 * i;
    q[i] = sample == 0 ? i % own->dimension == 0 : distance[sample] * cos(angle);
  }
}

/* Compare the gradient of a body with k q/|q|^3. */
static int is_pull(int dimension, const double *q, const double *V_q, double k)
{
  const double rounding = 1e-12;
  double square = 0, apart = 0;
  for (int i = 0; i < dimension; i++) square += q[i] * q[i];
  const double pull = k / (square * sqrt(square));
  for (int i = 0; i < dimension; i++) apart = fmax(apart, fabs(V_q[i] - pull * q[i]));
  return apart <= rounding * fabs(pull) * sqrt(square);
}

/* Test if the bodies of so many coordinates are pulled alike at all samples. */
static dvi_status try_dimension(dvi__integrable *own, int *found)
{
  const double *m = own->system->mass_diagonal, zero = 0;
  const int d = own->dimension;
  *found = own->n % d == 0;
  own->bodies = *found ? own->n / d : 0;
  for (int sample = 0; sample < SAMPLES && *found; sample++) {
    place_bodies(own, sample, own->dq);
    const dvi_status status = dvi__potentials_gradient(own->evaluator, 1, &zero, own->dq, own->dp);
    if (status == DVI_CALLBACK_FAILED) return status;
    *found = status == DVI_OK;
    for (int b = 0; b < own->bodies && *found; b++) {
      const double *V_q = own->dp + d * b;
      if (sample == 0) own->mu[b] = V_q[0];
      *found = is_pull(d, own->dq + d * b, V_q, own->mu[b]);
      for (int i = 1; i < d; i++) *found = *found && m[d * b + i] == m[d * b];
    }
  }
  return DVI_OK;
}

static dvi_status keep_centres(dvi__integrable *own)
{
  own->kind = &dvi__integrable_kepler;
  own->mass = DVI_NEW(double, own->bodies);
  own->orbits = DVI_NEW(dvi__orbit, (size_t)own->bodies * (size_t)own->capacity);
  if (own->mass == NULL || own->orbits == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  for (int b = 0; b < own->bodies; b++) {
    own->mass[b] = own->system->mass_diagonal[b * own->dimension];
    own->mu[b] /= own->mass[b];
  }
  return DVI_OK;
}

dvi_status dvi__integrable_find_centres(dvi__integrable *own, int *found)
{
  *found = 0;
  if (own->system->mass_diagonal == NULL) return DVI_OK;
  own->mu = DVI_NEW(double, own->n);
  if (own->mu == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  for (own->dimension = 3; own->dimension > 1; own->dimension--) {
    DVI_TRY(try_dimension(own, found));
    if (*found) return keep_centres(own);
  }
  return DVI_OK;
}

/* ---- the flow ---- */

typedef struct centred_body {
  double q[3], v[3], lambda[3], by_q[3], by_v[3];
} centred_body;

static void take_body(const dvi__integrable *own, const dvi__points *at, int b, int k,
                      centred_body *body)
{
  for (int i = 0; i < own->dimension; i++) {
    const int place = (b * own->dimension + i) * at->count + k;
    body->q[i] = at->q[place];
    body->v[i] = at->p[place] / own->mass[b];
  }
}

/* Place the orbit of a body. Without a force the body moves straight. */
static void place_orbit(const dvi__integrable *own, int b, const centred_body *body, double tau,
                        dvi__orbit *orbit)
{
  if (own->mu[b] != 0)
    dvi__orbit_place(own->mu[b], own->dimension, body->q, body->v, tau, orbit->s, orbit);
  else
    *orbit = (dvi__orbit){.g = tau};
}

static dvi_status refuse_collision(void)
{
  return dvi__fail(DVI_NOT_FINITE, "a body meets the centre of its Kepler motion");
}

static dvi_status kepler_move(dvi__integrable *own, const dvi__points *at, double *to_q,
                              double *to_p)
{
  const int d = own->dimension;
  centred_body body;
  for (int b = 0; b < own->bodies; b++)
    for (int k = 0; k < at->count; k++) {
      dvi__orbit *orbit = &own->orbits[b * own->capacity + k];
      take_body(own, at, b, k, &body);
      place_orbit(own, b, &body, at->tau[k], orbit);
      for (int i = 0; i < d; i++) {
        const int place = (b * d + i) * at->count + k;
        to_q[place] = body.q[i] + (orbit->f_less_1 * body.q[i] + orbit->g * body.v[i]);
        if (to_p == NULL) continue;
        to_p[place] = at->p[place] +
                      own->mass[b] * (orbit->f_rate * body.q[i] + orbit->g_rate_less_1 * body.v[i]);
      }
    }
  const size_t numbers = (size_t)own->n * (size_t)at->count;
  return dvi__first_not_finite(numbers, to_q) < 0 ? DVI_OK : refuse_collision();
}

static dvi_status kepler_change(dvi__integrable *own, double tau, const double *q, const double *p)
{
  const dvi__points point = {.count = 1, .tau = &tau, .q = q, .p = p};
  const int d = own->dimension;
  centred_body body;
  for (int b = 0; b < own->bodies; b++) {
    dvi__orbit orbit = {.s = 0};
    take_body(own, &point, b, 0, &body);
    place_orbit(own, b, &body, tau, &orbit);
    for (int i = 0; i < d; i++) {
      own->dq[b * d + i] = orbit.f_less_1 * body.q[i] + orbit.g * body.v[i];
      own->dp[b * d + i] = own->mass[b] *
                           (orbit.f_rate * body.q[i] + orbit.g_rate_less_1 * body.v[i]);
    }
  }
  const int finite = dvi__first_not_finite((size_t)own->n, own->dq) < 0 &&
                     dvi__first_not_finite((size_t)own->n, own->dp) < 0;
  return finite ? DVI_OK : refuse_collision();
}

static void pull_body_back(const dvi__integrable *own, int b, double tau, const dvi__orbit *orbit,
                           centred_body *body)
{
  if (own->mu[b] != 0) {
    dvi__orbit_pullback(orbit, own->dimension, body->q, body->v, body->lambda, body->by_q,
                        body->by_v);
    return;
  }
  for (int i = 0; i < own->dimension; i++) {
    body->by_q[i] = body->lambda[i];
    body->by_v[i] = tau * body->lambda[i];
  }
}

static dvi_status kepler_pullback(dvi__integrable *own, const dvi__points *at,
                                  const double *lambda_q, const double *lambda_p, double *by_q,
                                  double *by_p)
{
  const int d = own->dimension;
  centred_body body = {.q = {0}};
  (void)lambda_p;
  for (int b = 0; b < own->bodies; b++)
    for (int k = 0; k < at->count; k++) {
      take_body(own, at, b, k, &body);
      for (int i = 0; i < d; i++) body.lambda[i] = lambda_q[(b * d + i) * at->count + k];
      pull_body_back(own, b, at->tau[k], &own->orbits[b * own->capacity + k], &body);
      for (int i = 0; i < d; i++) {
        const int place = (b * d + i) * at->count + k;
        by_q[place] = body.by_q[i];
        by_p[place] = body.by_v[i] / own->mass[b];
      }
    }
  return DVI_OK;
}

const dvi__integrable_kind dvi__integrable_kepler = {
    .words = "kepler, the exact motion of each body about a fixed centre",
    .move = kepler_move,
    .change = kepler_change,
    .pullback = kepler_pullback};
