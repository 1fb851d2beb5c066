#include "support/systems/machine.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

enum { N = MACHINE_N, P = MACHINE_PARAMETERS, ROWS_MOST = 8 };

const machine bent_machine = {{1.3, 0.4, 1.7, 0.2}, 1},
              straight_machine = {{1.3, 0.4, 1.7, 0.2}, 0};

static void forces_of(const double complex *theta, double complex t, const double complex *q,
                      const double complex *v, double complex *F)
{
  F[0] = -theta[3] * v[0] + csin(t);
  F[1] = -theta[3] * v[1] * q[0] * q[0];
}

static void gradient_of(const double complex *theta, double bend, const double complex *q,
                        const double complex *v, double complex *L_q, double complex *L_v)
{
  const double complex m = theta[0], c = theta[1] * bend, k = theta[2];
  L_q[0] = c * ccos(q[0]) * v[0] * v[1] - k * (q[0] * q[0] * q[0] + q[1] / 2);
  L_q[1] = -m * bend * csin(q[1]) * v[0] * v[0] / 2 - k * (q[0] / 2 + 2 * q[1]);
  L_v[0] = m * (2 + bend * ccos(q[1])) * v[0] + c * csin(q[0]) * v[1];
  L_v[1] = v[1] + c * csin(q[0]) * v[0];
}

/* ---- the machine as a system, with derivatives by complex steps ---- */

static const double tiny = 1e-100;

typedef struct point {
  double complex theta[P], q[N], v[N], G[N], L_v[N], F[N];
} point;

static void evaluate(const machine *m, double t, const double *q, const double *v, int moved,
                     point *x)
{
  for (int k = 0; k < P; k++) x->theta[k] = m->theta[k];
  for (int i = 0; i < N; i++) x->q[i] = q[i], x->v[i] = v[i];
  if (moved >= 2 * N)
    x->theta[moved - 2 * N] += tiny * (double complex)I;
  else if (moved >= N)
    x->v[moved - N] += tiny * (double complex)I;
  else if (moved >= 0)
    x->q[moved] += tiny * (double complex)I;
  gradient_of(x->theta, m->bend, x->q, x->v, x->G, x->L_v);
  forces_of(x->theta, t, x->q, x->v, x->F);
}

static int machine_value(double t, const double *q, const double *v, double *L, void *user)
{
  const machine *m = user;
  const double k = m->theta[2];
  (void)t;
  *L = m->theta[0] * (2 + m->bend * cos(q[1])) * v[0] * v[0] / 2 + v[1] * v[1] / 2 +
       m->theta[1] * m->bend * sin(q[0]) * v[0] * v[1] -
       k * (pow(q[0], 4) / 4 + q[0] * q[1] / 2 + q[1] * q[1]);
  return 0;
}

static int machine_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  point x;
  evaluate(user, t, q, v, -1, &x);
  for (int i = 0; i < N; i++) L_q[i] = creal(x.G[i]), L_v[i] = creal(x.L_v[i]);
  return 0;
}

static int machine_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                           double *L_vv, void *user)
{
  point x;
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      evaluate(user, t, q, v, j, &x);
      L_qq[j * N + i] = cimag(x.G[i]) / tiny;
      evaluate(user, t, q, v, N + j, &x);
      L_qv[j * N + i] = cimag(x.G[i]) / tiny;
      L_vv[j * N + i] = cimag(x.L_v[i]) / tiny;
    }
  return 0;
}

static int potential_value(double t, const double *q, double *V, void *user)
{
  const double rest[N] = {0};
  machine_value(t, q, rest, V, user);
  *V = -*V;
  return 0;
}

static int potential_gradient(double t, const double *q, double *V_q, void *user)
{
  double none[N];
  const double rest[N] = {0};
  machine_gradient(t, q, rest, V_q, none, user);
  for (int i = 0; i < N; i++) V_q[i] = -V_q[i];
  return 0;
}

static int potential_hessian(double t, const double *q, double *V_qq, void *user)
{
  double qv[N * N], vv[N * N];
  const double rest[N] = {0};
  machine_hessian(t, q, rest, V_qq, qv, vv, user);
  for (int i = 0; i < N * N; i++) V_qq[i] = -V_qq[i];
  return 0;
}

static int force_value(double t, const double *q, const double *v, double *F, void *user)
{
  point x;
  evaluate(user, t, q, v, -1, &x);
  for (int i = 0; i < N; i++) F[i] = creal(x.F[i]);
  return 0;
}

static int force_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                          void *user)
{
  point x;
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      evaluate(user, t, q, v, j, &x);
      F_q[j * N + i] = cimag(x.F[i]) / tiny;
      evaluate(user, t, q, v, N + j, &x);
      F_v[j * N + i] = cimag(x.F[i]) / tiny;
    }
  return 0;
}

static int depend(double t, const double *q, const double *v, double *in_q, double *in_v,
                  void *user)
{
  point x;
  for (int k = 0; k < P; k++) {
    evaluate(user, t, q, v, 2 * N + k, &x);
    for (int i = 0; i < N; i++) {
      in_q[k * N + i] = cimag(x.G[i] + x.F[i]) / tiny;
      in_v[k * N + i] = cimag(x.L_v[i]) / tiny;
    }
  }
  return 0;
}

dvi_dependence machine_dependence(machine *m)
{
  return (dvi_dependence){P, depend, m};
}

dvi_system *machine_system_with(machine *m, const dvi_force *more)
{
  dvi_system *system = NULL;
  const dvi_lagrangian L = {
      .value = machine_value, .gradient = machine_gradient, .hessian = machine_hessian, .user = m};
  const dvi_potential V = {.value = potential_value,
                           .gradient = potential_gradient,
                           .hessian = potential_hessian,
                           .user = m};
  dvi_force forces[2] = {
      {.name = "forces", .value = force_value, .jacobian = force_jacobian, .user = m}};
  const double mass[N] = {2 * m->theta[0], 1};
  if (more != NULL) forces[1] = *more;
  dvi_system_terms terms = {.dimension = N, .forces = forces, .force_count = more != NULL ? 2 : 1};
  if (m->bend > 0)
    terms.lagrangian = &L;
  else
    terms.mass.diagonal = mass, terms.potentials = &V, terms.potential_count = 1;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

dvi_system *machine_system(machine *m)
{
  return machine_system_with(m, NULL);
}

/* ---- the discrete map: q(tau) = q0 + sum_k Y_k tau^k ---- */

typedef struct step {
  const double complex *theta, *z;
  double bend, t, h, c[8], b[8];
  int s, r;
} step;

/* Computes the rows, and the end of the step. */
static void step_rows(const step *x, const double complex *Y, double complex *rows,
                      double complex *end)
{
  memset(rows, 0, sizeof(*rows) * (size_t)(N * x->s));
  for (int i = 0; i < N; i++) {
    end[i] = x->z[i], end[N + i] = x->z[N + i];
    for (int k = 1; k <= x->s; k++) {
      end[i] += Y[i * x->s + k - 1];
      rows[i * x->s + k - 1] = -x->z[N + i];
    }
  }
  for (int j = 0; j < x->r; j++) {
    double complex q[N], v[N], G[N], L_v[N], F[N];
    for (int i = 0; i < N; i++) {
      q[i] = x->z[i], v[i] = 0;
      for (int k = 1; k <= x->s; k++) {
        q[i] += Y[i * x->s + k - 1] * pow(x->c[j], k);
        v[i] += Y[i * x->s + k - 1] * k * pow(x->c[j], k - 1) / x->h;
      }
    }
    gradient_of(x->theta, x->bend, q, v, G, L_v);
    forces_of(x->theta, x->t + x->c[j] * x->h, q, v, F);
    for (int i = 0; i < N; i++) {
      end[N + i] += x->h * x->b[j] * (G[i] + F[i]);
      for (int k = 1; k <= x->s; k++)
        rows[i * x->s + k - 1] += x->b[j] * (x->h * (pow(x->c[j], k) - 1) * (G[i] + F[i]) +
                                             k * pow(x->c[j], k - 1) * L_v[i]);
    }
  }
}

/* Solves A x = b by elimination with exchanges of rows. b becomes x. */
static void eliminate(int n, double complex A[ROWS_MOST][ROWS_MOST], double complex *b)
{
  for (int k = 0; k < n; k++) {
    int best = k;
    for (int i = k + 1; i < n; i++)
      if (cabs(A[i][k]) > cabs(A[best][k])) best = i;
    for (int j = 0; j < n; j++) {
      const double complex other = A[k][j];
      A[k][j] = A[best][j], A[best][j] = other;
    }
    const double complex other = b[k];
    b[k] = b[best], b[best] = other;
    for (int i = k + 1; i < n; i++) {
      const double complex f = A[i][k] / A[k][k];
      for (int j = k; j < n; j++) A[i][j] -= f * A[k][j];
      b[i] -= f * b[k];
    }
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int j = i + 1; j < n; j++) b[i] -= A[i][j] * b[j];
    b[i] /= A[i][i];
  }
}

/* Newton's method with a differenced Jacobian, until real and imaginary parts stay. */
static void step_solve(const step *x, double complex *Y, double complex *end)
{
  const int n = N * x->s;
  const double d = 1e-6;
  double complex A[ROWS_MOST][ROWS_MOST], rows[ROWS_MOST], moved[ROWS_MOST];
  for (int iteration = 0; iteration < 12; iteration++) {
    for (int j = 0; j < n; j++) {
      double complex less[ROWS_MOST];
      Y[j] += d;
      step_rows(x, Y, moved, end);
      Y[j] -= 2 * d;
      step_rows(x, Y, less, end);
      Y[j] += d;
      for (int i = 0; i < n; i++) A[i][j] = (moved[i] - less[i]) / (2 * d);
    }
    step_rows(x, Y, rows, end);
    eliminate(n, A, rows);
    for (int j = 0; j < n; j++) Y[j] -= rows[j];
  }
  step_rows(x, Y, rows, end);
}

void machine_run(const double complex *theta, double bend, dvi_rule rule, int s, int r, double h,
                 int steps, double complex *z)
{
  step x = {.theta = theta, .bend = bend, .h = h, .s = s, .r = r, .z = z};
  ck_assert_int_eq(dvi_quadrature(rule, r, x.c, x.b), DVI_OK);
  for (int k = 0; k < steps; k++) {
    double complex Y[ROWS_MOST] = {0}, end[2 * N];
    x.t = k * h;
    step_solve(&x, Y, end);
    memcpy(z, end, sizeof end);
  }
}
