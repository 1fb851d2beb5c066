#include "support/systems/constrained.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

static const double gravity = 9.81;

/* ---- pendulums ---- */

static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t;
  *V = gravity * q[*(const int *)user - 1];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const int n = *(const int *)user;
  (void)t, (void)q;
  for (int i = 0; i < n; i++) V_q[i] = i == n - 1 ? gravity : 0;
  return 0;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  const int n = *(const int *)user;
  (void)t, (void)q;
  for (int e = 0; e < n * n; e++) V_qq[e] = 0;
  return 0;
}

static int rod_value(double t, const double *q, double *phi, void *user)
{
  (void)t;
  phi[0] = -0.5;
  for (int i = 0; i < *(const int *)user; i++) phi[0] += 0.5 * q[i] * q[i];
  return 0;
}

static int rod_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t;
  memcpy(phi_q, q, (size_t) * (const int *)user * sizeof *q);
  return 0;
}

static int rod_hessian(double t, const double *q, const double *w, double *phi_w_qq, void *user)
{
  const int n = *(const int *)user;
  (void)t, (void)q;
  for (int e = 0; e < n * n; e++) phi_w_qq[e] = e % (n + 1) == 0 ? w[0] : 0;
  return 0;
}

static int damping(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < 3; i++) F[i] = -0.2 * v[i];
  return 0;
}

/* ---- the pivot that moves ---- */

static double pivot(double t)
{
  return 0.3 * sin(2 * t);
}

static int swung_value(double t, const double *q, double *phi, void *user)
{
  const double x = q[0] - pivot(t);
  (void)user;
  phi[0] = 0.5 * (x * x + q[1] * q[1] - 1);
  return 0;
}

static int swung_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)user;
  phi_q[0] = q[0] - pivot(t);
  phi_q[1] = q[1];
  return 0;
}

static int swung_rate(double t, const double *q, double *phi_t, void *user)
{
  (void)user;
  phi_t[0] = -(q[0] - pivot(t)) * 0.6 * cos(2 * t);
  return 0;
}

/* ---- a general Lagrangian ---- */

static int curved_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = 0.5 * (1 + q[0] * q[0]) * (v[0] * v[0] + v[1] * v[1]) - q[1];
  return 0;
}

static int curved_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                           void *user)
{
  (void)t, (void)user;
  L_q[0] = q[0] * (v[0] * v[0] + v[1] * v[1]);
  L_q[1] = -1;
  L_v[0] = (1 + q[0] * q[0]) * v[0];
  L_v[1] = (1 + q[0] * q[0]) * v[1];
  return 0;
}

static const dvi_lagrangian curved = {.value = curved_value, .gradient = curved_gradient};

/* ---- slider-crank ----
 *
 * q = (x1, y1, a1, x2, y2, a2, x3): centres and angles of the crank and the rod, and the slider on
 * the x axis. */

static const double l1 = 0.3, l2 = 1, m1 = 0.2, m2 = 0.5, m3 = 0.3;

static int crank_weight(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = gravity * (m1 * q[1] + m2 * q[4]);
  return 0;
}

static int crank_weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, 7 * sizeof *V_q);
  V_q[1] = gravity * m1;
  V_q[4] = gravity * m2;
  return 0;
}

static int crank_weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_qq, 0, 49 * sizeof *V_qq);
  return 0;
}

static int crank_value(double t, const double *q, double *phi, void *user)
{
  const double c1 = cos(q[2]), s1 = sin(q[2]), c2 = cos(q[5]), s2 = sin(q[5]);
  (void)t, (void)user;
  phi[0] = q[0] - l1 / 2 * c1;
  phi[1] = q[1] - l1 / 2 * s1;
  phi[2] = q[3] - l1 * c1 - l2 / 2 * c2;
  phi[3] = q[4] - l1 * s1 - l2 / 2 * s2;
  phi[4] = q[6] - l1 * c1 - l2 * c2;
  phi[5] = l1 * s1 + l2 * s2;
  return 0;
}

/* Rows of each column: (x1, a1), (y1, a1), (a1, x2, a2), (a1, y2, a2), (a1, a2, x3), (a1, a2). */
static const int crank_start[] = {0, 2, 4, 7, 10, 13, 15},
                 crank_row[] = {0, 2, 1, 2, 2, 3, 5, 2, 4, 5, 2, 5, 6, 2, 5},
                 angle_start[] = {0, 0, 0, 1, 1, 1, 2, 2}, angle_row[] = {2, 5};

static int crank_gradient(double t, const double *q, double *phi_q, void *user)
{
  const double c1 = l1 * cos(q[2]), s1 = l1 * sin(q[2]), c2 = l2 * cos(q[5]), s2 = l2 * sin(q[5]);
  const double entries[] = {1, s1 / 2,  1,  -c1 / 2, s1, 1,  s2 / 2, -c1,
                            1, -c2 / 2, s1, s2,      1,  c1, c2};
  (void)t, (void)user;
  memcpy(phi_q, entries, sizeof entries);
  return 0;
}

static int crank_hessian(double t, const double *q, const double *w, double *phi_w_qq, void *user)
{
  const double c1 = l1 * cos(q[2]), s1 = l1 * sin(q[2]), c2 = l2 * cos(q[5]), s2 = l2 * sin(q[5]);
  (void)t, (void)user;
  phi_w_qq[0] = w[0] * c1 / 2 + w[1] * s1 / 2 + w[2] * c1 + w[3] * s1 + w[4] * c1 - w[5] * s1;
  phi_w_qq[1] = w[2] * c2 / 2 + w[3] * s2 / 2 + w[4] * c2 - w[5] * s2;
  return 0;
}

static void start_crank(constrained *made)
{
  const double a1 = acos(-1.0) / 4, w1 = 6, a2 = -asin(l1 * sin(a1) / l2),
               w2 = -l1 * cos(a1) * w1 / (l2 * cos(a2));
  const double c1 = l1 * cos(a1), s1 = l1 * sin(a1), c2 = l2 * cos(a2), s2 = l2 * sin(a2);
  const double q[] = {c1 / 2, s1 / 2, a1, c1 + c2 / 2, s1 + s2 / 2, a2, c1 + c2},
               v[] = {-s1 / 2 * w1,           c1 / 2 * w1,           w1,
                      -s1 * w1 - s2 / 2 * w2, c1 * w1 + c2 / 2 * w2, w2,
                      -s1 * w1 - s2 * w2};
  memcpy(made->q, q, sizeof q);
  memcpy(made->v, v, sizeof v);
}

/* ---- systems ---- */

static int three = 3, two = 2;
static const double crank_mass[] = {m1, m1, m1 *l1 *l1 / 12, m2, m2, m2 *l2 *l2 / 12, m3};

static const dvi_potential weight = {.name = "weight",
                                     .value = weight_value,
                                     .gradient = weight_gradient,
                                     .hessian = weight_hessian,
                                     .user = &three},
                           plane_weight = {.name = "weight",
                                           .value = weight_value,
                                           .gradient = weight_gradient,
                                           .hessian = weight_hessian,
                                           .user = &two},
                           crank_potential = {.name = "weight",
                                              .value = crank_weight,
                                              .gradient = crank_weight_gradient,
                                              .hessian = crank_weight_hessian};
static const dvi_force air = {.name = "air", .value = damping};

static const struct {
  const char *name;
  int n;
  const double *mass;
  const dvi_potential *potential;
  const dvi_lagrangian *lagrangian;
  const dvi_force *force;
  dvi_holonomic rows;
  double q[3], v[3], span;
} table[CONSTRAINED_KINDS] = {{"spherical pendulum",
                               3,
                               NULL,
                               &weight,
                               NULL,
                               NULL,
                               {.name = "rod",
                                .count = 1,
                                .value = rod_value,
                                .gradient = rod_gradient,
                                .hessian = rod_hessian,
                                .user = &three},
                               {0},
                               {0},
                               2},
                              {"damped pendulum",
                               3,
                               NULL,
                               &weight,
                               NULL,
                               &air,
                               {.name = "rod",
                                .count = 1,
                                .value = rod_value,
                                .gradient = rod_gradient,
                                .hessian = rod_hessian,
                                .user = &three},
                               {0},
                               {0},
                               2},
                              {"swung pendulum",
                               2,
                               NULL,
                               &plane_weight,
                               NULL,
                               NULL,
                               {.name = "rod",
                                .count = 1,
                                .value = swung_value,
                                .gradient = swung_gradient,
                                .hessian = rod_hessian,
                                .rate = swung_rate,
                                .user = &two},
                               {0.6, -0.8},
                               {0.6, 0},
                               2},
                              {"curved pendulum",
                               2,
                               NULL,
                               NULL,
                               &curved,
                               NULL,
                               {.name = "rod",
                                .count = 1,
                                .value = rod_value,
                                .gradient = rod_gradient,
                                .hessian = rod_hessian,
                                .user = &two},
                               {0.6, -0.8},
                               {0.8, 0.6},
                               2},
                              {"slider-crank",
                               7,
                               crank_mass,
                               &crank_potential,
                               NULL,
                               NULL,
                               {.name = "joints",
                                .count = 6,
                                .value = crank_value,
                                .gradient = crank_gradient,
                                .hessian = crank_hessian,
                                .gradients = {crank_start, crank_row},
                                .qq = {angle_start, angle_row}},
                               {0},
                               {0},
                               2}};

void make_constrained(constrained_kind kind, int differenced, constrained *made)
{
  dvi_holonomic rows = table[kind].rows;
  if (differenced) rows.hessian = NULL;
  const dvi_system_terms terms = {
      .dimension = table[kind].n,
      .mass = {.scalar = table[kind].mass == NULL && table[kind].lagrangian == NULL,
               .diagonal = table[kind].mass},
      .lagrangian = table[kind].lagrangian,
      .potentials = table[kind].potential,
      .potential_count = table[kind].potential != NULL,
      .forces = table[kind].force,
      .force_count = table[kind].force != NULL,
      .holonomics = &rows,
      .holonomic_count = 1,
      .autonomous = rows.rate == NULL};
  *made = (constrained){
      .name = table[kind].name, .n = table[kind].n, .rows = rows.count, .span = table[kind].span};
  memcpy(made->q, table[kind].q, sizeof table[kind].q);
  memcpy(made->v, table[kind].v, sizeof table[kind].v);
  if (kind == SLIDER_CRANK) start_crank(made);
  if (kind <= DAMPED_PENDULUM) {
    const double q[] = {sin(1.0), 0, -cos(1.0)}, v[] = {cos(1.0) / 2, 2, sin(1.0) / 2};
    memcpy(made->q, q, sizeof q);
    memcpy(made->v, v, sizeof v);
  }
  ck_assert_msg(dvi_system_create(&terms, &made->system) == DVI_OK, "%s: %s", made->name,
                dvi_last_error());
}

void destroy_constrained(constrained *made)
{
  dvi_system_destroy(&made->system);
}

/* The pendulum's digits are those of two independent codes in quadruple precision, in Cartesian
 * coordinates and on the sphere. Those of the crank are of its equation of motion in a1 alone. */
int constrained_digits(constrained_kind kind, double *q)
{
  static const double pendulum[] = {0.3160694015792743, 0.6893547174071988, -0.6518360276739546};
  for (int i = 0; i < CONSTRAINED_N; i++) q[i] = (double)NAN;
  if (kind == SPHERICAL_PENDULUM) memcpy(q, pendulum, sizeof pendulum);
  if (kind == SLIDER_CRANK) {
    q[2] = 16.5311820335446;
    q[6] = 0.771540272526710;
  }
  return kind == SPHERICAL_PENDULUM || kind == SLIDER_CRANK;
}

dvi_integrator *constrained_integrator(const constrained *model, const char *method)
{
  dvi_integrator *integrator;
  ck_assert_msg(dvi_integrator_create(model->system, method, &integrator) == DVI_OK, "%s: %s",
                model->name, dvi_last_error());
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model->q, model->v) == DVI_OK,
                "%s: %s", model->name, dvi_last_error());
  return integrator;
}
