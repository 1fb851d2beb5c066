/* The full two-body problem. Two extended rigid bodies, each of six point masses on its principal
 * axes, attract each other by Newton's law, G = 1.
 *
 *     V = - sum_ab  m_a m_b / |x1 + R1 rho_a - x2 - R2 rho_b|        on SE(3) x SE(3)
 *
 * A body of mass m and semi-axes s_1, s_2, s_3 has masses m/6 at +- s_k e_k, and so the inertia
 *
 *     J_kk = m (|s|^2 - s_k^2)/3.
 *
 * Orbit and rotations exchange momentum. Source: Lee, Leok and McClamroch 2007 (Lie group
 * variational integrators for the full body problem), Comput. Methods Appl. Mech. Engrg.
 * 196:2907. */
#include "bodies/pulls.h"

enum { POINTS = 6, STORED = 12, VELOCITIES = 6 };

typedef struct bodies {
  pulls all;
  pull pull[POINTS * POINTS];
  arm arm[POINTS * POINTS][4];
  double inertia[2][9];
} bodies;

static const double shape[2][3] = {{0.6, 0.4, 0.3}, {0.35, 0.3, 0.15}};

/* Set the arms of x1 + R1 rho_a - x2 - R2 rho_b. */
static void two_body_connect(bodies *own, int a, int b, double size, double strength)
{
  const int index = POINTS * a + b;
  const double rho[2] = {(a % 2 == 0 ? size : -size) * shape[0][a / 2],
                         (b % 2 == 0 ? size : -size) * shape[1][b / 2]};
  arm *arms = own->arm[index];
  arms[0] = (arm){.first = 9, .stride = 1, .factor = 1.0};
  arms[1] = (arm){.first = a / 2, .stride = 3, .factor = rho[0]};
  arms[2] = (arm){.first = STORED + 9, .stride = 1, .factor = -1.0};
  arms[3] = (arm){.first = STORED + b / 2, .stride = 3, .factor = -rho[1]};
  own->pull[index] = (pull){.strength = strength, .arms = 4, .arm = arms};
}

static void two_body_set_inertia(const double *semiaxis, double size, double mass, double *J)
{
  const double square = semiaxis[0] * semiaxis[0] + semiaxis[1] * semiaxis[1] +
                        semiaxis[2] * semiaxis[2];
  for (int k = 0; k < 3; k++)
    J[4 * k] = mass * size * size * (square - semiaxis[k] * semiaxis[k]) / 3.0;
}

/* The axes that the generators point to. */
static int axes[] = {0, 1, 2};

/* Shift along axis e. two_body_turn turns in space about it, with Omega = R^t e, x' = e x x. */
static int two_body_shift(const double *q, double *xi, void *user)
{
  const int e = *(const int *)user;
  (void)q;
  memset(xi, 0, 2 * VELOCITIES * sizeof *xi);
  xi[3 + e] = xi[VELOCITIES + 3 + e] = 1.0;
  return 0;
}

static int two_body_turn(const double *q, double *xi, void *user)
{
  const int e = *(const int *)user, i = (e + 1) % 3, j = (e + 2) % 3;
  for (int body = 0; body < 2; body++, q += STORED, xi += VELOCITIES) {
    for (int k = 0; k < 3; k++) xi[k] = q[3 * e + k];
    xi[3 + e] = 0.0;
    xi[3 + i] = -q[9 + j];
    xi[3 + j] = q[9 + i];
  }
  return 0;
}

static const dvi_symmetry symmetries[] = {
    {.name = "momentum_x", .generator = two_body_shift, .user = &axes[0]},
    {.name = "momentum_y", .generator = two_body_shift, .user = &axes[1]},
    {.name = "momentum_z", .generator = two_body_shift, .user = &axes[2]},
    {.name = "angular_momentum_x", .generator = two_body_turn, .user = &axes[0]},
    {.name = "angular_momentum_y", .generator = two_body_turn, .user = &axes[1]},
    {.name = "angular_momentum_z", .generator = two_body_turn, .user = &axes[2]},
};

/* Place the bodies. The centre of mass rests at the origin. The bodies are apart along x and move
 * along y. */
static void two_body_place(problem *made, double m1, double m2, double distance, double speed)
{
  static const double Omega[2][3] = {{0.2, 0.3, 0.5}, {-0.4, 0.1, 0.8}};
  const double part[2] = {m2 / (m1 + m2), -m1 / (m1 + m2)};
  for (int body = 0; body < 2; body++) {
    made->q[STORED * body + 9] = part[body] * distance;
    made->v[VELOCITIES * body + 4] = part[body] * speed;
    memcpy(made->v + (ptrdiff_t)VELOCITIES * body, Omega[body], sizeof Omega[body]);
  }
}

static dvi_status two_body_make(const double *setting, problem *made)
{
  const dvi_factor kinds[2] = {{.kind = DVI_SE3}, {.kind = DVI_SE3}};
  const dvi_status status = problem_factors(made, 2, kinds, sizeof(bodies));
  if (status != DVI_OK) return status;
  bodies *own = made->parameters;
  const double *mass = setting, size = setting[4];
  own->all = (pulls){.nq = 2 * STORED, .count = POINTS * POINTS, .pull = own->pull};
  for (int a = 0; a < POINTS; a++)
    for (int b = 0; b < POINTS; b++)
      two_body_connect(own, a, b, size, mass[0] * mass[1] / (POINTS * POINTS));
  for (int body = 0; body < 2; body++)
    two_body_set_inertia(shape[body], size, mass[body], own->inertia[body]);
  two_body_place(made, mass[0], mass[1], setting[2], setting[3]);

  const dvi_factor factors[2] = {{.kind = DVI_SE3, .mass = mass[0], .inertia = own->inertia[0]},
                                 {.kind = DVI_SE3, .mass = mass[1], .inertia = own->inertia[1]}};
  const dvi_potential gravity = pulls_potential("gravity", &own->all);
  const dvi_system_terms terms = {.factors = factors,
                                  .factor_count = 2,
                                  .potentials = &gravity,
                                  .potential_count = 1,
                                  .symmetries = symmetries,
                                  .symmetry_count = sizeof symmetries / sizeof *symmetries,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "m1",
     .value = 1.0,
     .least = 1e-50,
     .most = 1e50,
     .help = "the mass of the first body, positive"},
    {.name = "m2",
     .value = 0.5,
     .least = 1e-50,
     .most = 1e50,
     .help = "the mass of the second body, positive"},
    {.name = "distance",
     .value = 3.0,
     .least = 1e-6,
     .most = 1e6,
     .start_only = 1,
     .help = "of the bodies' centres at the start, positive"},
    {.name = "speed",
     .value = 0.7,
     .least = -1e6,
     .most = 1e6,
     .start_only = 1,
     .help = "with which they pass each other at the start"},
    {.name = "size",
     .value = 1.0,
     .least = 1e-6,
     .most = 1e6,
     .help = "of the bodies, times semi-axes of (.6,.4,.3) and (.35,.3,.15); positive"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    -0.95614185418400621, -0.09038087349213135, 0.27861093371289292,  0.29067510844018946,
    -0.40991288502147583, 0.86456891456184937,  0.036065717944535287, 0.9076357884086379,
    0.41820633614159358,  0.36427609326704291,  0.91312230075724699,  -0.0036771709857861177,
    -0.49422251648001392, 0.86904386106007703,  0.022513812603729814, -0.85638598018208267,
    -0.49115071164534158, 0.15929228291994585,  0.14948965566799566,  0.059445319446261087,
    0.98697471945546611,  -0.72855218653408582, -1.826244601514494,   0.0073543419715722353};
static const double digits_p[] = {
    -0.0036518234789504056, 0.055437291534725062,   0.074412195215666388,  -0.2230728179174773,
    0.086620045030385617,   -0.0010201123270712328, 0.0054158920489912115, -0.0070880821804861268,
    0.027931605767460128,   0.2230728179174773,     -0.086620045030385617, 0.0010201123270712328};

const problem_entry problem_entry_two_body = {
    .name = "two-body",
    .summary = "two extended bodies that attract each other: orbit and attitude; rigid motions",
    .parameters = parameters,
    .make = two_body_make,
    .h = 0.05,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
