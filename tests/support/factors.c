#include "support/factors.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/systems.h"
#include "system/charted.h"

const double free_body_moments[] = {3, 2, 1.5}, free_body_end[] = {.4671205340242394, .6269711557238373, -.1811252970621061};
const double pendulum_moments[] = {.13, .28, .17}, pendulum_end[] = {-6.751473860336227, .1484346732487297, 3.362315606396518};

static const double identity[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

void bodies_clear(bodies *of)
{
  dvi_system_destroy(&of->system);
}

bodies body_of(const double inertia[9], const double Omega[3])
{
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia};
  bodies made = {.system = make_system(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1})};
  memcpy(made.q, identity, sizeof identity);
  memcpy(made.v, Omega, 3 * sizeof *Omega);
  return made;
}

bodies free_body(void)
{
  const double J[] = {3, 0, 0, 0, 2, 0, 0, 0, 1.5}, Omega[] = {.5, -.5, .4};
  return body_of(J, Omega);
}

dvi_integrator *body_started(const bodies *of, const char *method)
{
  dvi_integrator *integrator = made_integrator(of->system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, of->q, of->v), DVI_OK);
  return integrator;
}

/* ---- the pendulum ---- */

static const double weight = 9.81 * .3; /* m g rho, rho along the third axis */

static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -weight * q[8];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, 9 * sizeof *V_q);
  V_q[8] = -weight;
  return 0;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_qq, 0, 81 * sizeof *V_qq);
  return 0;
}

static int vertical(const double *q, double *xi, void *user)
{
  (void)user;
  memcpy(xi, q + 6, 3 * sizeof *xi);
  return 0;
}

bodies pendulum_in_space(void)
{
  const double J[] = {.13, 0, 0, 0, .28, 0, 0, 0, .17};
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = J};
  const dvi_potential potential = {.value = weight_value, .gradient = weight_gradient, .hessian = weight_hessian};
  const dvi_symmetry symmetry = {.name = "vertical", .generator = vertical};
  bodies made = {.system = make_system(&(dvi_system_terms){.factors = &factor,
                                                           .factor_count = 1,
                                                           .potentials = &potential,
                                                           .potential_count = 1,
                                                           .symmetries = &symmetry,
                                                           .symmetry_count = 1,
                                                           .autonomous = 1}),
                 .v = {4.14, 4.14, 4.14}};
  memcpy(made.q, identity, sizeof identity);
  return made;
}

/* ---- products ---- */

/* V = sum_i w_i q_i + sum_i k_i q_i q_(i+3) + q_i^2/2, for any number of coordinates; user: how many. */
static double linear_of(int i)
{
  return 0.3 * sin(1.7 * i + 0.4);
}

static double product_of(int i)
{
  return 0.4 * cos(2.3 * i + 0.9);
}

static int mixed_value(double t, const double *q, double *V, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  *V = 0;
  for (int i = 0; i < n; i++) *V += linear_of(i) * q[i] + q[i] * q[i] / 2 + (i + 3 < n ? product_of(i) * q[i] * q[i + 3] : 0);
  return 0;
}

static int mixed_gradient(double t, const double *q, double *V_q, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  for (int i = 0; i < n; i++)
    V_q[i] = linear_of(i) + q[i] + (i + 3 < n ? product_of(i) * q[i + 3] : 0) + (i >= 3 ? product_of(i - 3) * q[i - 3] : 0);
  return 0;
}

static dvi_potential mixed(int *n)
{
  return (dvi_potential){.value = mixed_value, .gradient = mixed_gradient, .user = n};
}

static const double offset_inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9}, offset[] = {.1, -.2, .15};

bodies loose_cells(void)
{
  static int n = 19;
  const dvi_factor factors[] = {{.kind = DVI_S2, .mass = .8},
                                {.kind = DVI_U1, .mass = .7},
                                {.kind = DVI_RN, .size = 2, .mass = 1.2},
                                {.kind = DVI_SE3, .mass = 2, .inertia = offset_inertia, .centre = offset}};
  const dvi_potential potential = mixed(&n);
  return (bodies){.system = make_system(&(dvi_system_terms){
                      .factors = factors, .factor_count = 4, .potentials = &potential, .potential_count = 1, .autonomous = 1}),
                  .q = {.6, 0, .8, 1, 0, .3, -.2, 1, 0, 0, 0, 1, 0, 0, 0, 1, .3, .1, 0},
                  .v = {0, 1, 0, .8, .5, .2, 1, .3, -.4, .1, 0, .2}};
}

bodies tied_cells(void)
{
  static int n = 29;
  const dvi_factor factors[] = {{.kind = DVI_S2},
                                {.kind = DVI_S2},
                                {.kind = DVI_SE3, .mass = 2, .inertia = offset_inertia, .centre = offset},
                                {.kind = DVI_U1, .mass = .7},
                                {.kind = DVI_SO3, .inertia = offset_inertia}};
  double M[29 * 29] = {0};
  for (int i = 0; i < 3; i++) {
    M[i * n + i] = .6;
    M[(3 + i) * n + 3 + i] = M[i * n + 3 + i] = M[(3 + i) * n + i] = .3;
    M[(3 + i) * n + 15 + i] = M[(15 + i) * n + 3 + i] = .1;
  }
  M[19 * n + 19] = .3;
  M[20 * n + 20] = .5;
  const dvi_potential potential = mixed(&n);
  return (bodies){.system = make_system(&(dvi_system_terms){.factors = factors,
                                                            .factor_count = 5,
                                                            .mass = {.values = M},
                                                            .potentials = &potential,
                                                            .potential_count = 1,
                                                            .autonomous = 1}),
                  .q = {.6, 0, .8, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, .3, .1, 0, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                  .v = {0, 1, 0, .5, 0, 0, 1, .3, -.4, .1, 0, .2, .8, .3, -.2, .6}};
}

/* ---- symplecticity ---- */

/* Canonical coordinates about a state: z = (xi, pi), [2 nx]. */
typedef struct darboux {
  const dvi_system *system;
  dvi__charted *charts;
} darboux;

static darboux darboux_at(const dvi_system *system, dvi_counters *counters, const double *q)
{
  darboux made = {.system = system};
  ck_assert_int_eq(dvi__charted_create(system, 0, counters, &made.charts), DVI_OK);
  dvi__charted_centre(made.charts, q);
  return made;
}

/* Column j of A at xi, [nv]. */
static void column_of(const darboux *at, const double *xi, int j, double *column)
{
  double rate[BODIES_MOST] = {0};
  rate[j] = 1;
  dvi__charted_point(at->charts, xi, rate, NULL, column);
}

static double product(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static void z_of_state(const darboux *at, const double *q, const double *p, double *z)
{
  const int nx = at->system->nx;
  dvi__charted_inverse(at->charts, q, z);
  for (int j = 0; j < nx; j++) {
    double column[BODIES_MOST];
    column_of(at, z, j, column);
    z[nx + j] = product(at->system->nv, column, p);
  }
}

/* x <- G^-1 x, G symmetric and positive definite, by elimination. */
static void solve_positive(int n, double G[BODIES_MOST][BODIES_MOST], double *x)
{
  for (int k = 0; k < n; k++)
    for (int i = k + 1; i < n; i++) {
      const double factor = G[i][k] / G[k][k];
      for (int j = k; j < n; j++) G[i][j] -= factor * G[k][j];
      x[i] -= factor * x[k];
    }
  for (int i = n - 1; i >= 0; i--) {
    for (int j = i + 1; j < n; j++) x[i] -= G[i][j] * x[j];
    x[i] /= G[i][i];
  }
}

/* p = A (A^T A)^-1 pi: tangent, with A^T p = pi. */
static void state_of_z(const darboux *at, const double *z, double *q, double *p)
{
  const int nx = at->system->nx, nv = at->system->nv;
  double A[BODIES_MOST][BODIES_MOST], G[BODIES_MOST][BODIES_MOST], x[BODIES_MOST];
  dvi__charted_point(at->charts, z, NULL, q, NULL);
  memcpy(x, z + nx, (size_t)nx * sizeof *x);
  for (int j = 0; j < nx; j++) column_of(at, z, j, A[j]);
  for (int i = 0; i < nx; i++)
    for (int j = 0; j < nx; j++) G[i][j] = product(nv, A[i], A[j]);
  solve_positive(nx, G, x);
  for (int i = 0; i < nv; i++) {
    p[i] = 0;
    for (int j = 0; j < nx; j++) p[i] += A[j][i] * x[j];
  }
}

/* z1 of z0 by one step. */
static void map(dvi_integrator *integrator, const darboux *from, const darboux *to, double h, const double *z0, double *z1)
{
  double q[BODIES_MOST], p[BODIES_MOST];
  state_of_z(from, z0, q, p);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_OK);
  z_of_state(to, dvi_integrator_q(integrator), dvi_integrator_p(integrator), z1);
}

/* Column j of D, by central differences of order 6. */
static void derivative(dvi_integrator *integrator, const darboux *from, const darboux *to, double h, const double *z, int j,
                       double *column)
{
  static const double weight_of[] = {45.0 / 60, -9.0 / 60, 1.0 / 60}, width = 4e-3;
  const int n = 2 * from->system->nx;
  memset(column, 0, (size_t)n * sizeof *column);
  for (int k = 1; k <= 3; k++)
    for (int sign = -1; sign <= 1; sign += 2) {
      double moved[2 * BODIES_MOST], end[2 * BODIES_MOST];
      memcpy(moved, z, (size_t)n * sizeof *z);
      moved[j] += sign * k * width;
      map(integrator, from, to, h, moved, end);
      for (int i = 0; i < n; i++) column[i] += sign * weight_of[k - 1] / width * end[i];
    }
}

double symplecticity_of_step(const bodies *of, const char *method, double h)
{
  const int nx = of->system->nx;
  double z0[2 * BODIES_MOST], D[2 * BODIES_MOST][2 * BODIES_MOST], worst = 0;
  dvi_counters counters = {0};
  dvi_integrator *integrator = body_started(of, method);
  darboux from = darboux_at(of->system, &counters, of->q);
  z_of_state(&from, of->q, dvi_integrator_p(integrator), z0);
  advance(integrator, h, 1);
  darboux to = darboux_at(of->system, &counters, dvi_integrator_q(integrator));
  for (int j = 0; j < 2 * nx; j++) derivative(integrator, &from, &to, h, z0, j, D[j]);
  for (int i = 0; i < 2 * nx; i++)
    for (int j = 0; j < 2 * nx; j++) {
      const double form = product(nx, D[i], D[j] + nx) - product(nx, D[i] + nx, D[j]);
      worst = fmax(worst, fabs(form - (j == i + nx) + (i == j + nx)));
    }
  dvi__charted_destroy(&from.charts);
  dvi__charted_destroy(&to.charts);
  dvi_integrator_destroy(&integrator);
  return worst;
}
