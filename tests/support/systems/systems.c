#include "support/systems/systems.h"

#include <math.h>
#include <stddef.h>

#include "support/suite.h"

static const int diagonal_start[SITES + 1] = {0, 1, 2, 3, 4, 5, 6};
static const int diagonal_row[SITES] = {0, 1, 2, 3, 4, 5};
static const int bidiagonal_start[SITES + 1] = {0, 1, 3, 5, 7, 9, 11};
static const int bidiagonal_row[2 * SITES - 1] = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5};
static const int tridiagonal_start[SITES + 1] = {0, 2, 5, 8, 11, 14, 16};
static const int tridiagonal_row[3 * SITES - 2] = {0, 1, 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5, 4, 5};

static const dvi_pattern diagonal = {diagonal_start, diagonal_row};
static const dvi_pattern bidiagonal = {bidiagonal_start, bidiagonal_row};
const dvi_pattern tridiagonal = {tridiagonal_start, tridiagonal_row};
const double tridiagonal_mass[3 * SITES - 2] = {2,   -.5, -.5, 3,   -.5, -.5, 4,   -.5,
                                                -.5, 5,   -.5, -.5, 6,   -.5, -.5, 7};

const double generic_q[SITES] = {0.31, -0.72, 1.13, 0.54, -1.25, 0.86};
const double generic_v[SITES] = {-0.43, 0.64, 0.25, -1.06, 0.77, 0.98};

dvi_system *make_system(const dvi_system_terms *terms)
{
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

/* ---- springs ---- */

static double stretch(const double *q, int count, int k, int i)
{
  return q[(i + 1) * count + k] - q[i * count + k];
}

static int springs_values(int count, const double *t, const double *q, double *V, void *user)
{
  behaviour *b = user;
  (void)t;
  b->values++;
  for (int k = 0; k < count; k++) {
    V[k] = b->value_lie;
    for (int i = 0; i + 1 < SITES; i++) {
      const double d = stretch(q, count, k, i);
      V[k] += d * d / 2 + d * d * d * d / 4;
    }
  }
  return b->answer;
}

static int springs_gradients(int count, const double *t, const double *q, double *V_q, void *user)
{
  behaviour *b = user;
  (void)t;
  b->gradients++;
  for (int k = 0; k < count; k++) {
    for (int i = 0; i < SITES; i++) V_q[i * count + k] = i == b->at ? b->gradient_lie : 0;
    for (int i = 0; i + 1 < SITES; i++) {
      const double d = stretch(q, count, k, i), tension = d + d * d * d;
      V_q[(i + 1) * count + k] += tension;
      V_q[i * count + k] -= tension;
    }
  }
  return b->answer;
}

static int springs_hessians(int count, const double *t, const double *q, double *V_qq, void *user)
{
  behaviour *b = user;
  (void)t;
  b->hessians++;
  for (int k = 0; k < count; k++)
    for (int j = 0; j < SITES; j++)
      for (int e = tridiagonal_start[j]; e < tridiagonal_start[j + 1]; e++) {
        const int i = tridiagonal_row[e];
        const double left = j > 0 ? stretch(q, count, k, j - 1) : 0,
                     right = j + 1 < SITES ? stretch(q, count, k, j) : 0;
        const double to_left = j > 0 ? 1 + 3 * left * left : 0,
                     to_right = j + 1 < SITES ? 1 + 3 * right * right : 0;
        V_qq[e * count + k] = (i < j   ? -to_left
                               : i > j ? -to_right
                                       : to_left + to_right) +
                              (e == b->at ? b->hessian_lie : 0);
      }
  return b->answer;
}

static int springs_value(double t, const double *q, double *V, void *user)
{
  return springs_values(1, &t, q, V, user);
}

static int springs_gradient(double t, const double *q, double *V_q, void *user)
{
  return springs_gradients(1, &t, q, V_q, user);
}

static int springs_hessian(double t, const double *q, double *V_qq, void *user)
{
  return springs_hessians(1, &t, q, V_qq, user);
}

static int springs_rates(int count, const double *t, const double *q, double *V_t, void *user)
{
  const behaviour *b = user;
  (void)t, (void)q;
  for (int k = 0; k < count; k++) V_t[k] = b->rate_lie;
  return b->answer;
}

static int springs_rate(double t, const double *q, double *V_t, void *user)
{
  return springs_rates(1, &t, q, V_t, user);
}

dvi_potential springs(behaviour *user, callback_shape shape)
{
  dvi_potential p = {.name = "springs", .qq = tridiagonal, .user = user};
  if (shape == ONE_POINT) {
    p.rate = springs_rate;
    p.value = springs_value;
    p.gradient = springs_gradient;
    p.hessian = springs_hessian;
  } else {
    p.rate_batch = springs_rates;
    p.value_batch = springs_values;
    p.gradient_batch = springs_gradients;
    p.hessian_batch = springs_hessians;
  }
  return p;
}

/* ---- wells ---- */

static int wells_values(int count, const double *t, const double *q, double *V, void *user)
{
  behaviour *b = user;
  b->values++;
  for (int k = 0; k < count; k++) {
    V[k] = b->value_lie;
    for (int i = 0; i < SITES; i++)
      V[k] += (1 + i) * pow(q[i * count + k], 4) / 4 + t[k] * q[i * count + k];
  }
  return b->answer;
}

static int wells_gradients(int count, const double *t, const double *q, double *V_q, void *user)
{
  behaviour *b = user;
  b->gradients++;
  for (int k = 0; k < count; k++)
    for (int i = 0; i < SITES; i++)
      V_q[i * count + k] = (1 + i) * pow(q[i * count + k], 3) + t[k] +
                           (i == b->at ? b->gradient_lie : 0);
  return b->answer;
}

static int wells_hessians(int count, const double *t, const double *q, double *V_qq, void *user)
{
  behaviour *b = user;
  (void)t;
  b->hessians++;
  for (int k = 0; k < count; k++)
    for (int i = 0; i < SITES; i++)
      V_qq[i * count + k] = 3 * (1 + i) * q[i * count + k] * q[i * count + k] +
                            (i == b->at ? b->hessian_lie : 0);
  return b->answer;
}

static int wells_value(double t, const double *q, double *V, void *user)
{
  return wells_values(1, &t, q, V, user);
}

static int wells_gradient(double t, const double *q, double *V_q, void *user)
{
  return wells_gradients(1, &t, q, V_q, user);
}

static int wells_hessian(double t, const double *q, double *V_qq, void *user)
{
  return wells_hessians(1, &t, q, V_qq, user);
}

static int wells_rates(int count, const double *t, const double *q, double *V_t, void *user)
{
  const behaviour *b = user;
  (void)t;
  for (int k = 0; k < count; k++) {
    V_t[k] = b->rate_lie;
    for (int i = 0; i < SITES; i++) V_t[k] += q[i * count + k];
  }
  return b->answer;
}

static int wells_rate(double t, const double *q, double *V_t, void *user)
{
  return wells_rates(1, &t, q, V_t, user);
}

dvi_potential wells(behaviour *user, callback_shape shape)
{
  dvi_potential p = {.name = "wells", .qq = diagonal, .user = user};
  if (shape == ONE_POINT) {
    p.rate = wells_rate;
    p.value = wells_value;
    p.gradient = wells_gradient;
    p.hessian = wells_hessian;
  } else {
    p.rate_batch = wells_rates;
    p.value_batch = wells_values;
    p.gradient_batch = wells_gradients;
    p.hessian_batch = wells_hessians;
  }
  return p;
}

/* ---- rotors ---- */

static int rotors_values(int count, const double *t, const double *q, const double *v, double *L,
                         void *user)
{
  behaviour *b = user;
  b->values++;
  for (int k = 0; k < count; k++) {
    L[k] = b->value_lie;
    for (int i = 0; i < SITES; i++) {
      const double x = q[i * count + k], w = v[i * count + k];
      L[k] += (2 + cos(x)) * w * w / 2 - (1 + t[k]) * x * x / 2;
      if (i + 1 < SITES) L[k] += (w / 4 + sin(x)) * v[(i + 1) * count + k];
    }
  }
  return b->answer;
}

static int rotors_gradients(int count, const double *t, const double *q, const double *v,
                            double *L_q, double *L_v, void *user)
{
  behaviour *b = user;
  b->gradients++;
  for (int k = 0; k < count; k++)
    for (int i = 0; i < SITES; i++) {
      const double x = q[i * count + k], w = v[i * count + k],
                   lie = i == b->at ? b->gradient_lie : 0;
      const double before = i > 0 ? v[(i - 1) * count + k] : 0,
                   after = i + 1 < SITES ? v[(i + 1) * count + k] : 0;
      L_q[i * count + k] = -sin(x) * w * w / 2 + cos(x) * after - (1 + t[k]) * x +
                           (b->block == 0 ? lie : 0);
      L_v[i * count + k] = (2 + cos(x)) * w + (before + after) / 4 +
                           (i > 0 ? sin(q[(i - 1) * count + k]) : 0) + (b->block == 1 ? lie : 0);
    }
  return b->answer;
}

static double lie_of(const behaviour *b, int block, int entry)
{
  return b->block == block && b->at == entry ? b->hessian_lie : 0;
}

static int rotors_hessians(int count, const double *t, const double *q, const double *v,
                           double *L_qq, double *L_qv, double *L_vv, void *user)
{
  behaviour *b = user;
  b->hessians++;
  for (int k = 0; k < count; k++)
    for (int j = 0; j < SITES; j++) {
      const double x = q[j * count + k], w = v[j * count + k],
                   after = j + 1 < SITES ? v[(j + 1) * count + k] : 0;
      L_qq[j * count + k] = -cos(x) * w * w / 2 - sin(x) * after - (1 + t[k]) + lie_of(b, 0, j);
      for (int e = bidiagonal_start[j]; e < bidiagonal_start[j + 1]; e++)
        L_qv[e * count + k] = (bidiagonal_row[e] == j ? -sin(x) * w : cos(q[(j - 1) * count + k])) +
                              lie_of(b, 1, e);
      for (int e = tridiagonal_start[j]; e < tridiagonal_start[j + 1]; e++)
        L_vv[e * count + k] = (tridiagonal_row[e] == j ? 2 + cos(x) : 0.25) + lie_of(b, 2, e);
    }
  return b->answer;
}

static int rotors_value(double t, const double *q, const double *v, double *L, void *user)
{
  return rotors_values(1, &t, q, v, L, user);
}

static int rotors_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                           void *user)
{
  return rotors_gradients(1, &t, q, v, L_q, L_v, user);
}

static int rotors_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                          double *L_vv, void *user)
{
  return rotors_hessians(1, &t, q, v, L_qq, L_qv, L_vv, user);
}

static int rotors_rates(int count, const double *t, const double *q, const double *v, double *L_t,
                        void *user)
{
  const behaviour *b = user;
  (void)t, (void)v;
  for (int k = 0; k < count; k++) {
    L_t[k] = b->rate_lie;
    for (int i = 0; i < SITES; i++) L_t[k] -= q[i * count + k] * q[i * count + k] / 2;
  }
  return b->answer;
}

static int rotors_rate(double t, const double *q, const double *v, double *L_t, void *user)
{
  return rotors_rates(1, &t, q, v, L_t, user);
}

dvi_lagrangian rotors(behaviour *user, callback_shape shape)
{
  dvi_lagrangian l = {.qq = diagonal, .qv = bidiagonal, .vv = tridiagonal, .user = user};
  if (shape == ONE_POINT) {
    l.rate = rotors_rate;
    l.value = rotors_value;
    l.gradient = rotors_gradient;
    l.hessian = rotors_hessian;
  } else {
    l.rate_batch = rotors_rates;
    l.value_batch = rotors_values;
    l.gradient_batch = rotors_gradients;
    l.hessian_batch = rotors_hessians;
  }
  return l;
}

static int runaway_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -q[0] - q[0] * q[0] * q[0] / 3;
  return 0;
}

static int runaway_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = -1 - q[0] * q[0];
  return 0;
}

dvi_system *runaway(int fast)
{
  const dvi_potential potential = {
      .name = "runaway", .value = runaway_value, .gradient = runaway_gradient, .fast = fast};
  return make_system(&(dvi_system_terms){
      .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
}
