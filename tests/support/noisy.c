#include "support/noisy.h"

#include <check.h>
#include <math.h>
#include <stddef.h>

#include "num/normal.h"
#include "support/runs.h"

/* The potential of all oscillators. Its user is a noisy_oscillators. */
static int springs_value(double t, const double *q, double *V, void *user)
{
  const noisy_oscillators *of = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < of->n; i++) *V += of->k * q[i] * q[i] / 2;
  return 0;
}

static int springs_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const noisy_oscillators *of = user;
  (void)t;
  for (int i = 0; i < of->n * count; i++) V_q[i] = of->k * q[i];
  return 0;
}

static int springs_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const noisy_oscillators *of = user;
  (void)t, (void)q;
  for (int i = 0; i < of->n * count; i++) V_qq[i] = of->k;
  return 0;
}

void make_noisy(int n, double m, double k, int coupled, dvi_noise noise, noisy_oscillators *made)
{
  static const int start[NOISY_MOST + 1] = {0, 1, 2, 3, 4}, row[NOISY_MOST] = {0, 1, 2, 3};
  double mass[NOISY_MOST * NOISY_MOST];
  for (int i = 0; i < n * n; i++) mass[i] = i % (n + 1) == 0 ? m : 0.3 * m;
  *made = (noisy_oscillators){.n = n, .k = k};
  const dvi_potential springs = {.name = "springs",
                                 .value = springs_value,
                                 .gradient_batch = springs_gradient,
                                 .hessian_batch = springs_hessian,
                                 .qq = {start, row},
                                 .user = made};
  dvi_system_terms terms = {.dimension = n,
                            .potentials = &springs,
                            .potential_count = 1,
                            .autonomous = 1,
                            .noise = &noise};
  if (coupled)
    terms.mass.values = mass;
  else
    terms.mass.scalar = m;
  ck_assert_msg(dvi_system_create(&terms, &made->system) == DVI_OK, "%s", dvi_last_error());
}

void destroy_noisy(noisy_oscillators *made)
{
  dvi_system_destroy(&made->system);
}

/* The state after one step from (q,p), and the temperature of the step. */
typedef struct one_step {
  double q, p, temperature;
} one_step;

static one_step step_once(const char *method, const dvi_system *system, double h, double q,
                          double p)
{
  one_step end;
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &p), DVI_OK);
  advance(integrator, h, 1);
  end.q = dvi_integrator_q(integrator)[0];
  end.p = dvi_integrator_p(integrator)[0];
  ck_assert_int_eq(dvi_integrator_temperature(integrator, &end.temperature), DVI_OK);
  dvi_integrator_destroy(&integrator);
  return end;
}

/* What one unit of each normal number does to q, p and the temperature's root. With two draws two
 * seeds give two equations. */
static void find_response(const char *method, double m, double k, dvi_noise noise, double h,
                          int draws, double b[2][2], double *heat)
{
  double normal[2][2], end[2][2], none = 0;
  for (int s = 0; s < draws; s++) {
    noisy_oscillators noisy;
    noise.seed++;
    make_noisy(1, m, k, 0, noise, &noisy);
    for (int d = 0; d < 2; d++) {
      const double draw = d;
      dvi__normals(1, noise.seed, 0, &draw, &none, &normal[s][d], NULL);
    }
    const one_step at = step_once(method, noisy.system, h, 0, 0);
    end[s][0] = at.q, end[s][1] = at.p;
    if (s == 0) *heat = at.temperature / (normal[0][0] * normal[0][0]);
    destroy_noisy(&noisy);
  }
  const double det = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
  for (int x = 0; x < 2; x++) {
    b[x][0] = draws == 1 ? end[0][x] / normal[0][0]
                         : (end[0][x] * normal[1][1] - end[1][x] * normal[0][1]) / det;
    b[x][1] = draws == 1 ? 0 : (end[1][x] * normal[0][0] - end[0][x] * normal[1][0]) / det;
  }
}

/* Solve three linear equations by elimination with pivots. */
static void solve_three(double a[3][4])
{
  for (int i = 0; i < 3; i++) {
    int best = i;
    for (int r = i; r < 3; r++)
      if (fabs(a[r][i]) > fabs(a[best][i])) best = r;
    for (int c = 0; c < 4; c++) {
      const double other = a[best][c];
      a[best][c] = a[i][c];
      a[i][c] = other;
    }
    for (int r = 0; r < 3; r++) {
      const double factor = a[r][i] / a[i][i];
      for (int c = i; c < 4 && r != i; c++) a[r][c] -= factor * a[i][c];
    }
  }
  for (int i = 0; i < 3; i++) a[i][3] /= a[i][i];
}

noisy_covariance find_covariance(const char *method, double m, double k, dvi_noise noise, double h,
                                 int draws)
{
  noisy_oscillators still;
  dvi_noise cold = noise;
  double b[2][2], heat = 0;
  cold.temperature = 0;
  make_noisy(1, m, k, 0, cold, &still);
  const one_step by_q = step_once(method, still.system, h, 1, 0),
                 by_p = step_once(method, still.system, h, 0, 1),
                 by_both = step_once(method, still.system, h, 1, 1);
  destroy_noisy(&still);
  find_response(method, m, k, noise, h, draws, b, &heat);
  /* S = A S A^T + B B^T for the entries qq, qp, pp of S */
  const double c = by_q.q, d = by_p.q, e = by_q.p, f = by_p.p;
  double a[3][4] = {
      {1 - c * c, -2 * c * d, -d * d, b[0][0] * b[0][0] + b[0][1] * b[0][1]},
      {-c * e, 1 - c * f - d * e, -d * f, b[0][0] * b[1][0] + b[0][1] * b[1][1]},
      {-e * e, -2 * e * f, 1 - f * f, b[1][0] * b[1][0] + b[1][1] * b[1][1]},
  };
  solve_three(a);
  const double mixed = by_both.temperature - by_q.temperature - by_p.temperature;
  return (noisy_covariance){.qq = a[0][3],
                            .qp = a[1][3],
                            .pp = a[2][3],
                            .temperature = draws == 1
                                               ? by_q.temperature * a[0][3] + mixed * a[1][3] +
                                                     by_p.temperature * a[2][3] + heat
                                               : a[2][3] / m};
}
