#include "magnetic.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/quad/quad_system.h"

/* ---- the bottle ---- */

static int bottle_A(double t, const double *q, double *A, void *user)
{
  const double half = 0.5 * (1 + 0.3 * q[2] * q[2]);
  (void)t, (void)user;
  A[0] = -half * q[1];
  A[1] = half * q[0];
  A[2] = 0;
  return 0;
}

/* Column j holds dA_j/dq: rows y, z of the first and x, z of the second column. */
static const int bottle_start[] = {0, 2, 4, 4}, bottle_row[] = {1, 2, 0, 2};

static int bottle_A_q(double t, const double *q, double *A_q, void *user)
{
  const double half = 0.5 * (1 + 0.3 * q[2] * q[2]), slope = 0.3 * q[2];
  (void)t, (void)user;
  A_q[0] = -half;
  A_q[1] = -slope * q[1];
  A_q[2] = half;
  A_q[3] = slope * q[0];
  return 0;
}

static const int bottle_qq_start[] = {0, 1, 2, 5}, bottle_qq_row[] = {2, 2, 0, 1, 2};

static int bottle_A_w_qq(double t, const double *q, const double *w, double *A_w_qq, void *user)
{
  const double slope = 0.3 * q[2];
  (void)t, (void)user;
  A_w_qq[0] = A_w_qq[2] = slope * w[1];
  A_w_qq[1] = A_w_qq[3] = -slope * w[0];
  A_w_qq[4] = 0.3 * (q[0] * w[1] - q[1] * w[0]);
  return 0;
}

static int bottle_V(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.05 * q[2] * q[2];
  return 0;
}

static int bottle_V_q(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = V_q[1] = 0;
  V_q[2] = 0.1 * q[2];
  return 0;
}

static int turn_about_z(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  xi[2] = 0;
  return 0;
}

/* ---- the wave ---- */

static int wave_A(int count, const double *t, const double *q, double *A, void *user)
{
  const double *x = q, *y = q + count;
  (void)user;
  for (int k = 0; k < count; k++) {
    A[k] = -0.4 * y[k] + 0.3 * sin(x[k] - t[k]);
    A[count + k] = 0.5 * x[k] + 0.2 * x[k] * y[k] * cos(t[k]);
  }
  return 0;
}

/* A full pattern: dA_x/dx, dA_x/dy, dA_y/dx, dA_y/dy. */
static int wave_A_q(int count, const double *t, const double *q, double *A_q, void *user)
{
  const double *x = q, *y = q + count;
  (void)user;
  for (int k = 0; k < count; k++) {
    A_q[k] = 0.3 * cos(x[k] - t[k]);
    A_q[count + k] = -0.4;
    A_q[2 * count + k] = 0.5 + 0.2 * y[k] * cos(t[k]);
    A_q[3 * count + k] = 0.2 * x[k] * cos(t[k]);
  }
  return 0;
}

static int wave_A_t(int count, const double *t, const double *q, double *A_t, void *user)
{
  const double *x = q, *y = q + count;
  (void)user;
  for (int k = 0; k < count; k++) {
    A_t[k] = -0.3 * cos(x[k] - t[k]);
    A_t[count + k] = -0.2 * x[k] * y[k] * sin(t[k]);
  }
  return 0;
}

static int wave_V(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = 0.5 * q[0] * q[0] + 0.4 * q[1] * q[1] + 0.1 * q[0] * sin(t);
  return 0;
}

static int wave_V_q(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  V_q[0] = q[0] + 0.1 * sin(t);
  V_q[1] = 0.8 * q[1];
  return 0;
}

/* ---- four coupled coordinates ---- */

static const int coupled_start[] = {0, 2, 4, 6, 8}, coupled_row[] = {0, 1, 0, 1, 2, 3, 2, 3};
static const double coupled_mass[] = {2, 0.5, 0.5, 1, 1, 0.2, 0.2, 1.5};

static int coupled_A(double t, const double *q, double *A, void *user)
{
  (void)t, (void)user;
  A[0] = 0.3 * q[1] * q[2];
  A[1] = 0.2 * q[3] * q[3];
  A[2] = 0.4 * q[0];
  A[3] = 0.5 * q[0] * q[1];
  return 0;
}

static int coupled_A_q(double t, const double *q, double *A_q, void *user)
{
  (void)t, (void)user;
  memset(A_q, 0, 16 * sizeof *A_q);
  A_q[0 * 4 + 1] = 0.3 * q[2];
  A_q[0 * 4 + 2] = 0.3 * q[1];
  A_q[1 * 4 + 3] = 0.4 * q[3];
  A_q[2 * 4 + 0] = 0.4;
  A_q[3 * 4 + 0] = 0.5 * q[1];
  A_q[3 * 4 + 1] = 0.5 * q[0];
  return 0;
}

static int coupled_V(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.1 * q[0] * q[0] * q[0] * q[0];
  for (int i = 0; i < 4; i++) *V += 0.5 * q[i] * q[i];
  return 0;
}

static int coupled_V_q(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 4; i++) V_q[i] = q[i];
  V_q[0] += 0.4 * q[0] * q[0] * q[0];
  return 0;
}

/* ---- systems ---- */

static const double wave_mass[] = {1, 1.5};
static const dvi_symmetry bottle_turn = {.name = "angular momentum", .generator = turn_about_z};

static const magnetic table[MAGNETIC_KINDS] = {
    {.name = "bottle",
     .terms = {.dimension = 3,
               .mass = {.scalar = 1.3},
               .symmetries = &bottle_turn,
               .symmetry_count = 1,
               .autonomous = 1},
     .A = {.value = bottle_A,
           .gradient = bottle_A_q,
           .hessian = bottle_A_w_qq,
           .gradients = {bottle_start, bottle_row},
           .qq = {bottle_qq_start, bottle_qq_row}},
     .V = {.value = bottle_V, .gradient = bottle_V_q},
     .q = {1, 0, 0.3},
     .v = {0.2, 0.9, 0.4},
     .span = 4},
    {.name = "wave",
     .terms = {.dimension = 2, .mass = {.diagonal = wave_mass}},
     .A = {.value_batch = wave_A, .gradient_batch = wave_A_q, .rate_batch = wave_A_t},
     .V = {.value = wave_V, .gradient = wave_V_q},
     .q = {0.8, -0.3},
     .v = {0.1, 0.6},
     .span = 4},
    {.name = "coupled",
     .terms = {.dimension = 4,
               .mass = {.values = coupled_mass, .pattern = {coupled_start, coupled_row}},
               .autonomous = 1},
     .A = {.value = coupled_A, .gradient = coupled_A_q},
     .V = {.value = coupled_V, .gradient = coupled_V_q},
     .q = {0.5, -0.2, 0.4, 0.3},
     .v = {0.1, 0.5, -0.3, 0.2},
     .span = 4},
};

static void make_parts(magnetic_kind kind, magnetic *made)
{
  *made = table[kind];
  made->kind = kind;
  made->n = made->terms.dimension;
  made->terms.potentials = &made->V;
  made->terms.potential_count = 1;
}

static void make_system(magnetic *made)
{
  ck_assert_msg(dvi_system_create(&made->terms, &made->system) == DVI_OK, "%s: %s", made->name,
                dvi_last_error());
}

void make_magnetic(magnetic_kind kind, magnetic *made)
{
  make_parts(kind, made);
  made->terms.vector_potential = &made->A;
  make_system(made);
}

void destroy_magnetic(magnetic *made)
{
  dvi_system_destroy(&made->system);
}

static int one_A(const dvi_vector_potential *A, double t, const double *q, double *value)
{
  return A->value != NULL ? A->value(t, q, value, NULL) : A->value_batch(1, &t, q, value, NULL);
}

static int one_A_q(const dvi_vector_potential *A, double t, const double *q, double *A_q)
{
  return A->gradient != NULL ? A->gradient(t, q, A_q, NULL)
                             : A->gradient_batch(1, &t, q, A_q, NULL);
}

static void momentum_of_mass(const magnetic *m, const double *v, double *p)
{
  const dvi_mass *mass = &m->terms.mass;
  for (int i = 0; i < m->n; i++) {
    p[i] = mass->diagonal != NULL ? mass->diagonal[i] * v[i] : mass->scalar * v[i];
    for (int e = 0; mass->values != NULL && e < mass->pattern.start[i + 1]; e++)
      if (e >= mass->pattern.start[i]) p[i] += mass->values[e] * v[mass->pattern.row[e]];
  }
}

static int whole_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                          void *user)
{
  const magnetic *m = user;
  const dvi_pattern *pattern = &m->A.gradients;
  double A[MAGNETIC_N], A_q[MAGNETIC_N * MAGNETIC_N], V_q[MAGNETIC_N];
  (void)one_A(&m->A, t, q, A);
  (void)one_A_q(&m->A, t, q, A_q);
  (void)m->V.gradient(t, q, V_q, NULL);
  momentum_of_mass(m, v, L_v);
  for (int i = 0; i < m->n; i++) {
    L_v[i] += A[i];
    L_q[i] = -V_q[i];
  }
  for (int j = 0; j < m->n; j++) {
    const int first = pattern->start != NULL ? pattern->start[j] : j * m->n,
              end = pattern->start != NULL ? pattern->start[j + 1] : first + m->n;
    for (int e = first; e < end; e++)
      L_q[pattern->start != NULL ? pattern->row[e] : e - first] += A_q[e] * v[j];
  }
  return 0;
}

static int whole_value(double t, const double *q, const double *v, double *L, void *user)
{
  const magnetic *m = user;
  double A[MAGNETIC_N], p[MAGNETIC_N], V;
  (void)one_A(&m->A, t, q, A);
  (void)m->V.value(t, q, &V, NULL);
  momentum_of_mass(m, v, p);
  *L = -V;
  for (int i = 0; i < m->n; i++) *L += (0.5 * p[i] + A[i]) * v[i];
  return 0;
}

void make_as_lagrangian(magnetic_kind kind, magnetic *made)
{
  make_parts(kind, made);
  dvi_system_terms *terms = &made->terms;
  made->L = (dvi_lagrangian){.value = whole_value, .gradient = whole_gradient, .user = made};
  const dvi_mass mass = terms->mass;
  terms->mass = (dvi_mass){0};
  terms->lagrangian = &made->L;
  terms->potentials = NULL;
  terms->potential_count = 0;
  make_system(made);
  terms->mass = mass;
}

/* ---- the judge: M v' = -V_q + sum_j (dA_j/dq_i - dA_i/dq_j) v_j - dA_i/dt ---- */

static quad of(const char *text)
{
  return quad_number(text);
}

static void bottle_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  /* B = curl A = (-.3 z x, -.3 z y, 1 + .3 z^2), and the force is v x B */
  const quad B[3] = {-of("0.3") * q[2] * q[0], -of("0.3") * q[2] * q[1],
                     1 + of("0.3") * q[2] * q[2]};
  (void)system;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    a[i] = (v[j] * B[k] - v[k] * B[j]) / of("1.3");
  }
  a[2] -= of("0.1") * q[2] / of("1.3");
}

static void wave_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad t = v[2], c = quad_cos(t), s = quad_sin(t),
             B = of("0.5") + of("0.2") * q[1] * c + of("0.4");
  (void)system;
  a[0] = B * v[1] + of("0.3") * quad_cos(q[0] - t) - q[0] - of("0.1") * s;
  a[1] = (-B * v[0] + of("0.2") * q[0] * q[1] * s - of("0.8") * q[1]) / of("1.5");
}

static void coupled_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  quad A_q[4][4] = {{0}}, f[4]; /* dA_j/dq_i at [i][j] */
  (void)system;
  A_q[1][0] = of("0.3") * q[2];
  A_q[2][0] = of("0.3") * q[1];
  A_q[3][1] = of("0.4") * q[3];
  A_q[0][2] = of("0.4");
  A_q[0][3] = of("0.5") * q[1];
  A_q[1][3] = of("0.5") * q[0];
  for (int i = 0; i < 4; i++) {
    f[i] = -q[i];
    for (int j = 0; j < 4; j++) f[i] += (A_q[i][j] - A_q[j][i]) * v[j];
  }
  f[0] -= of("0.4") * q[0] * q[0] * q[0];
  const quad first = 2 - of("0.25"), second = of("1.5") - of("0.04");
  a[0] = (f[0] - of("0.5") * f[1]) / first;
  a[1] = (2 * f[1] - of("0.5") * f[0]) / first;
  a[2] = (of("1.5") * f[2] - of("0.2") * f[3]) / second;
  a[3] = (f[3] - of("0.2") * f[2]) / second;
}

void magnetic_judge(magnetic_kind kind, double *q, double *v)
{
  static const quad_problem problems[MAGNETIC_KINDS] = {
      {.name = "bottle", .acceleration = bottle_acceleration},
      {.name = "wave", .acceleration = wave_acceleration},
      {.name = "coupled", .acceleration = coupled_acceleration}};
  const magnetic *m = &table[kind];
  const int n = m->terms.dimension;
  const quad_field field = {.problem = &problems[kind], .system = {.n = n, .nv = n}};
  quad y[2 * MAGNETIC_N + 1] = {0};
  char text[32];
  for (int i = 0; i < n; i++) {
    (void)snprintf(text, sizeof text, "%.15g", m->q[i]);
    y[i] = of(text);
    (void)snprintf(text, sizeof text, "%.15g", m->v[i]);
    y[n + i] = of(text);
  }
  ck_assert(quad_march(&field, (quad)m->span, y) < 1e-20);
  for (int i = 0; i < n; i++) {
    q[i] = (double)y[i];
    v[i] = (double)y[n + i];
  }
}
