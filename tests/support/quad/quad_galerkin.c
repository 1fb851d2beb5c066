/*     q(tau) = q0 + sum_k psi_k(tau) Y_k,   psi_k(0) = 0,   k = 1..s
 *     sum_j b_j ( h (psi_k - psi_k(1)) L_q + psi_k' L_v )_j = psi_k(1) p0,
 *     p1 = p0 + h sum_j b_j L_q_j
 * (Marsden and West 2001, sec. 2.2.6), solved by the simplest fixed point iteration. */
#include "quad_galerkin.h"

#include <math.h>
#include <string.h>

/* ---- nodes ---- */

/* P_n and its first two derivatives at x inside (-1,1). */
static void legendre(int n, quad x, quad value[3])
{
  quad before = 1, here = x;
  for (int k = 1; k < n; k++) {
    const quad next = ((2 * k + 1) * x * here - k * before) / (k + 1);
    before = here;
    here = next;
  }
  value[0] = n == 0 ? 1 : here;
  value[1] = n == 0 ? 0 : n * (x * here - before) / (x * x - 1);
  value[2] = (2 * x * value[1] - n * (n + 1) * value[0]) / (1 - x * x);
}

/* Gives the zero of P_n (derivative 0) or P_n' (derivative 1) near x. */
static quad zero_near(int n, int derivative, quad x)
{
  quad value[3];
  for (int i = 0; i < 20; i++) {
    legendre(n, x, value);
    x -= value[derivative] / value[derivative + 1];
  }
  return x;
}

static void gauss(quad_galerkin *m)
{
  for (int j = 0; j < m->nodes; j++) {
    quad value[3];
    const quad x = zero_near(m->nodes, 0, (quad)-cos(acos(-1) * (j + 0.75) / (m->nodes + 0.5)));
    legendre(m->nodes, x, value);
    m->node[j] = (1 + x) / 2;
    m->weight[j] = 1 / ((1 - x * x) * value[1] * value[1]);
  }
}

static void lobatto(quad_galerkin *m)
{
  const int n = m->nodes;
  for (int j = 0; j < n; j++) {
    quad value[3];
    const int end = j == 0 || j == n - 1;
    const quad x = end ? (j == 0 ? -1 : 1)
                       : zero_near(n - 1, 1, (quad)-cos(acos(-1) * j / (n - 1)));
    if (end)
      value[0] = 1;
    else
      legendre(n - 1, x, value);
    m->node[j] = (1 + x) / 2;
    m->weight[j] = 1 / (n * (n - 1) * value[0] * value[0]);
  }
}

/* Legendre's polynomials by their recurrence, P_k'(x) by P_{k+1}' = P_{k-1}' + (2k+1) P_k. */
static void tabulate(quad_galerkin *m)
{
  for (int j = 0; j < m->nodes; j++) {
    const quad x = 2 * m->node[j] - 1;
    quad value[QUAD_DEGREE_MAX + 2] = {1, x}, derivative[QUAD_DEGREE_MAX + 2] = {0, 1};
    for (int k = 1; k < m->degree; k++) {
      value[k + 1] = ((2 * k + 1) * x * value[k] - k * value[k - 1]) / (k + 1);
      derivative[k + 1] = derivative[k - 1] + (2 * k + 1) * value[k];
    }
    for (int k = 0; k < m->degree; k++) {
      m->psi[k][j] = value[k + 1] + (k % 2 == 0 ? 1 : -1);
      m->slope[k][j] = 2 * derivative[k + 1];
      m->end[k] = k % 2 == 0 ? 2 : 0;
    }
  }
}

void quad_galerkin_prepare(quad_galerkin *m, int degree, int is_lobatto, int nodes)
{
  quad K[QUAD_DEGREE_MAX][QUAD_DEGREE_MAX] = {{0}};
  *m = (quad_galerkin){.degree = degree, .nodes = nodes};
  if (is_lobatto)
    lobatto(m);
  else
    gauss(m);
  tabulate(m);
  for (int k = 0; k < degree; k++) {
    m->inverse[k][k] = 1;
    for (int l = 0; l < degree; l++)
      for (int j = 0; j < nodes; j++) K[k][l] += m->weight[j] * m->slope[k][j] * m->slope[l][j];
  }
  for (int c = 0; c < degree; c++) { /* Gauss-Jordan elimination, as K is positive definite */
    const quad pivot = K[c][c];
    for (int l = 0; l < degree; l++) K[c][l] /= pivot, m->inverse[c][l] /= pivot;
    for (int k = 0; k < degree; k++) {
      const quad factor = K[k][c];
      for (int l = 0; l < degree && k != c; l++)
        K[k][l] -= factor * K[c][l], m->inverse[k][l] -= factor * m->inverse[c][l];
    }
  }
}

/* ---- the Lagrangian's derivatives ---- */

static void momentum_at(const quad_field *f, const quad *q, const quad *v, quad *p)
{
  quad y[2 * QUAD_N_MAX + 1] = {0};
  memcpy(y, q, (size_t)f->system.n * sizeof *y);
  memcpy(y + f->system.n, v, (size_t)f->system.n * sizeof *y);
  quad_momentum(f, y, p);
}

/* d/de p(q + e v, v) at e = 0 by central differences of order 2 SIDE: sum_k c_k (p(k step) - p(-k
 * step)) / step with c_k = -(-1)^k (SIDE!)^2 / (k (SIDE-k)! (SIDE+k)!). The high order allows a
 * long step, and that keeps the rounding noise at 1e-30. */
static void add_transport(const quad_field *f, const quad *q, const quad *v, quad *rate)
{
  enum { SIDE = 10 };
  const quad step = quad_parse("0.01", NULL);
  const int n = f->system.n;
  quad moved[QUAD_N_MAX], p[QUAD_N_MAX], c = 1;
  for (int k = 1; k <= SIDE; k++) {
    c *= -(quad)(SIDE - k + 1) / (SIDE + k);
    for (int sign = -1; sign <= 1; sign += 2) {
      for (int i = 0; i < n; i++) moved[i] = q[i] + sign * k * step * v[i];
      momentum_at(f, moved, v, p);
      for (int i = 0; i < n; i++) rate[i] -= sign * c * p[i] / (k * step);
    }
  }
}

/* L_v = p(q,v), and L_q = dp/dt = p(q,a) + d/de p(q + e v, v) for kinetic energies that are
 * quadratic in v. */
static void gradient(const quad_field *f, const quad *q, const quad *v, quad *L_q, quad *L_v)
{
  quad a[QUAD_N_MAX];
  f->problem->acceleration(&f->system, q, v, a);
  momentum_at(f, q, v, L_v);
  momentum_at(f, q, a, L_q);
  if (f->problem->velocity) add_transport(f, q, v, L_q);
}

/* ---- a step ---- */

typedef struct stage {
  quad Y[QUAD_DEGREE_MAX][QUAD_N_MAX], R[QUAD_DEGREE_MAX][QUAD_N_MAX], impulse[QUAD_N_MAX];
} stage;

static void residual(const quad_galerkin *m, const quad_field *f, quad h, const quad *q0,
                     const quad *p0, stage *s)
{
  const int n = f->system.n;
  memset(s->impulse, 0, sizeof s->impulse);
  for (int k = 0; k < m->degree; k++)
    for (int i = 0; i < n; i++) s->R[k][i] = -m->end[k] * p0[i];
  for (int j = 0; j < m->nodes; j++) {
    quad Q[QUAD_N_MAX], V[QUAD_N_MAX], L_q[QUAD_N_MAX], L_v[QUAD_N_MAX];
    for (int i = 0; i < n; i++) {
      Q[i] = q0[i], V[i] = 0;
      for (int k = 0; k < m->degree; k++) {
        Q[i] += m->psi[k][j] * s->Y[k][i];
        V[i] += m->slope[k][j] * s->Y[k][i] / h;
      }
    }
    gradient(f, Q, V, L_q, L_v);
    for (int i = 0; i < n; i++) {
      s->impulse[i] += h * m->weight[j] * L_q[i];
      for (int k = 0; k < m->degree; k++)
        s->R[k][i] += m->weight[j] *
                      (h * (m->psi[k][j] - m->end[k]) * L_q[i] + m->slope[k][j] * L_v[i]);
    }
  }
}

/* Computes Y -= h (K (x) M)^-1 R with the mass at q, and returns the largest change. */
static quad correct(const quad_galerkin *m, const quad_field *f, quad h, const quad *q, stage *s)
{
  const int n = f->system.n;
  quad change = 0, row[QUAD_DEGREE_MAX][QUAD_N_MAX], one[QUAD_N_MAX] = {0}, mass[QUAD_N_MAX];
  for (int i = 0; i < n; i++) one[i] = 1;
  if (!f->problem->velocity) momentum_at(f, q, one, mass);
  for (int k = 0; k < m->degree; k++)
    if (f->problem->velocity)
      f->problem->velocity(&f->system, q, s->R[k], row[k]);
    else
      for (int i = 0; i < n; i++) row[k][i] = s->R[k][i] / mass[i];
  for (int k = 0; k < m->degree; k++)
    for (int i = 0; i < n; i++) {
      quad sum = 0;
      for (int l = 0; l < m->degree; l++) sum += m->inverse[k][l] * row[l][i];
      s->Y[k][i] -= h * sum;
      if (!(quad_abs(h * sum) <= change)) change = quad_abs(h * sum);
    }
  return change;
}

/* Iterates until the changes shrink to the noise of the residual, wherever that is, and no
 * further. */
static int iterate(const quad_galerkin *m, const quad_field *f, quad h, const quad *q,
                   const quad *p, stage *s)
{
  enum { ITERATIONS = 400 };
  const double noise = 1e-26;
  double last = HUGE_VAL;
  for (int i = 0; i < ITERATIONS; i++) {
    residual(m, f, h, q, p, s);
    const double change = (double)correct(m, f, h, q, s);
    if (change < noise && change >= 0.5 * last) return 1;
    last = change;
  }
  return 0;
}

int quad_galerkin_step(const quad_galerkin *m, const quad_field *f, quad h, quad *q, quad *p)
{
  stage s;
  memset(&s, 0, sizeof s);
  const int settled = iterate(m, f, h, q, p, &s);
  for (int c = 0; c < f->system.n; c++) {
    p[c] += s.impulse[c];
    for (int k = 0; k < m->degree; k++) q[c] += m->end[k] * s.Y[k][c];
  }
  return settled;
}
