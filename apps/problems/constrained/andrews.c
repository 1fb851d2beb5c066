/* Andrews' squeezer, seven bodies in a plane that a constant moment drives, in the coordinates
 * beta, Theta, gamma, Phi, delta, Omega, epsilon (Hairer and Wanner 1996, sec. VII.7, with the
 * numbers of Mazzia and Magherini 2008).
 *
 * Three pairs of bodies turn on each other. A pair with the angles x of the first and x + y of the
 * second has the kinetic energy
 *
 *     a/2 x'^2 + b/2 (x' + y')^2 + k s(y) x' (x' + y'),     s = sin or cos.
 *
 * The seventh body turns by gamma, and a spring of stiffness c0 pulls it. In each of three loops
 * two rows say that arms of given lengths, turned by these angles, lead from a fixed point to
 * another one. */
#include <math.h>

#include "entry.h"

enum { BETA, THETA, GAMMA, PHI, DELTA, OMEGA, EPSILON, N, PAIRS = 3, LOOPS = 3, ROWS = 6 };

/* Lengths and places of points, in metres. */
static const double xa = -0.06934, ya = -0.00227, xb = -0.03635, yb = 0.03273, xc = 0.014,
                    yc = 0.072, rest = 0.07785, sc = 0.018, sd = 0.02;

/* m3 (sa^2 + sb^2) + I3. */
static const double inertia = 0.02373 * (0.01874 * 0.01874 + 0.01043 * 0.01043) + 5.255e-6;

typedef struct squeezer {
  double mom, c0;
} squeezer;

/* ---- the kinetic energy ---- */

typedef struct pair {
  int x, y, cosine;
  double a, b, k;
} pair;

static const pair pairs[PAIRS] = {
    {BETA, THETA, 1, 0.04325 * 0.00092 * 0.00092 + 2.194e-6 + 0.00365 * 0.007 * 0.007,
     0.00365 * 0.0115 * 0.0115 + 4.41e-7, -0.00365 * 0.0115 * 0.007},
    {DELTA, PHI, 0,
     0.0705 * (0.02308 * 0.02308 + 0.00916 * 0.00916) + 1.169e-5 + 0.00706 * 0.04 * 0.04,
     0.00706 * 0.00579 * 0.00579 + 5.667e-7, 0.00706 * 0.04 * 0.00579},
    {EPSILON, OMEGA, 0,
     0.05498 * (0.01228 * 0.01228 + 0.00449 * 0.00449) + 1.912e-5 + 0.00706 * 0.04 * 0.04,
     0.00706 * 0.00579 * 0.00579 + 5.667e-7, -0.00706 * 0.04 * 0.00579}};

/* Rates of a pair, and k s(y) with its two derivatives. */
typedef struct motion {
  double x, both, s, s1, s2;
} motion;

static motion motion_of(const pair *own, const double *q, const double *v)
{
  const double S = own->k * sin(q[own->y]), C = own->k * cos(q[own->y]);
  const double x = v[own->x], both = x + v[own->y];
  return own->cosine ? (motion){x, both, C, -S, -C} : (motion){x, both, S, C, -S};
}

static int kinetic(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = 0.5 * inertia * v[GAMMA] * v[GAMMA];
  for (int i = 0; i < PAIRS; i++) {
    const motion m = motion_of(&pairs[i], q, v);
    *L += 0.5 * (pairs[i].a * m.x * m.x + pairs[i].b * m.both * m.both) + m.s * m.x * m.both;
  }
  return 0;
}

static int kinetic_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  (void)t, (void)user;
  memset(L_q, 0, N * sizeof *L_q);
  L_v[GAMMA] = inertia * v[GAMMA];
  for (int i = 0; i < PAIRS; i++) {
    const pair *own = &pairs[i];
    const motion m = motion_of(own, q, v);
    L_q[own->y] = m.s1 * m.x * m.both;
    L_v[own->y] = own->b * m.both + m.s * m.x;
    L_v[own->x] = L_v[own->y] + own->a * m.x + m.s * m.both;
  }
  return 0;
}

/* Entries of the pattern vv, column by column: those of a pair are neighbours. */
static const int vv_start[] = {0, 2, 4, 5, 7, 9, 11, 13},
                 vv_row[] = {BETA, THETA, BETA,  THETA,   GAMMA, PHI,    DELTA,
                             PHI,  DELTA, OMEGA, EPSILON, OMEGA, EPSILON},
                 qv_start[] = {0, 1, 2, 2, 3, 4, 5, 6},
                 qv_row[] = {THETA, THETA, PHI, PHI, OMEGA, OMEGA},
                 qq_start[] = {0, 0, 1, 1, 2, 2, 3, 3}, qq_row[] = {THETA, PHI, OMEGA};

static int kinetic_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                           double *L_vv, void *user)
{
  (void)t, (void)user;
  L_vv[vv_start[GAMMA]] = inertia;
  for (int i = 0; i < PAIRS; i++) {
    const pair *own = &pairs[i];
    const motion m = motion_of(own, q, v);
    const int first = own->y < own->x; /* row x stands behind row y */
    L_qq[qq_start[own->y]] = m.s2 * m.x * m.both;
    L_qv[qv_start[own->x]] = m.s1 * (m.x + m.both);
    L_qv[qv_start[own->y]] = m.s1 * m.x;
    L_vv[vv_start[own->x] + first] = own->a + own->b + 2 * m.s;
    L_vv[vv_start[own->x] + !first] = L_vv[vv_start[own->y] + first] = own->b + m.s;
    L_vv[vv_start[own->y] + !first] = own->b;
  }
  return 0;
}

/* ---- spring and drive ---- */

static int forces(double t, const double *q, double *V, void *user)
{
  const squeezer *own = user;
  const double c = cos(q[GAMMA]), s = sin(q[GAMMA]),
               length = hypot(sd * c + sc * s + xb - xc, sd * s - sc * c + yb - yc);
  (void)t;
  *V = own->c0 / 2 * (length - rest) * (length - rest) - own->mom * q[BETA];
  return 0;
}

/* Give the length of the spring and its two derivatives by gamma. */
static void stretch(double gamma, double *length)
{
  const double c = cos(gamma), s = sin(gamma), x1 = sc * c - sd * s, y1 = sd * c + sc * s,
               x = y1 + xb - xc, y = yb - yc - x1;
  length[0] = hypot(x, y);
  length[1] = (x * x1 + y * y1) / length[0];
  length[2] = (x1 * x1 + y1 * y1 - x * y1 + y * x1 - length[1] * length[1]) / length[0];
}

static int forces_gradient(double t, const double *q, double *V_q, void *user)
{
  const squeezer *own = user;
  double length[3];
  (void)t;
  stretch(q[GAMMA], length);
  memset(V_q, 0, N * sizeof *V_q);
  V_q[BETA] = -own->mom;
  V_q[GAMMA] = own->c0 * (length[0] - rest) * length[1];
  return 0;
}

static int forces_hessian(double t, const double *q, double *V_qq, void *user)
{
  double length[3];
  (void)t;
  stretch(q[GAMMA], length);
  *V_qq = ((const squeezer *)user)->c0 * (length[1] * length[1] + (length[0] - rest) * length[2]);
  return 0;
}

/* ---- loops ---- */

/* An arm of a length, a quarter turn ahead or not, in the direction of one angle, or of the sum of
 * two. */
typedef struct arm {
  double length;
  int quarter, first, second;
} arm;

enum { ARMS = 4, NONE = -1 };

static const arm arms[LOOPS][ARMS] = {{{0.007, 0, BETA, NONE},
                                       {-0.028, 0, BETA, THETA},
                                       {0.035, 1, GAMMA, NONE},
                                       {0, 0, GAMMA, NONE}},
                                      {{0.007, 0, BETA, NONE},
                                       {-0.028, 0, BETA, THETA},
                                       {0.02, 1, PHI, DELTA},
                                       {-0.04, 0, DELTA, NONE}},
                                      {{0.007, 0, BETA, NONE},
                                       {-0.028, 0, BETA, THETA},
                                       {-0.02, 0, OMEGA, EPSILON},
                                       {0.04, 1, EPSILON, NONE}}};
static const double ends[ROWS] = {xb, yb, xa, ya, xa, ya};

static void direct(const arm *own, const double *q, double *x, double *y)
{
  const double angle = q[own->first] + (own->second != NONE ? q[own->second] : 0),
               c = own->length * cos(angle), s = own->length * sin(angle);
  *x = own->quarter ? -s : c;
  *y = own->quarter ? c : s;
}

static int loops(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  for (int a = 0; a < ROWS; a++) phi[a] = -ends[a];
  for (int i = 0; i < LOOPS; i++)
    for (int k = 0; k < ARMS; k++) {
      double x, y;
      direct(&arms[i][k], q, &x, &y);
      phi[2 * i] += x;
      phi[2 * i + 1] += y;
    }
  return 0;
}

static const int rows_start[] = {0, 3, 6, 10, 14, 18, 22},
                 rows_row[] = {BETA,  THETA,   GAMMA, BETA,  THETA, GAMMA,  BETA, THETA,
                               PHI,   DELTA,   BETA,  THETA, PHI,   DELTA,  BETA, THETA,
                               OMEGA, EPSILON, BETA,  THETA, OMEGA, EPSILON};

static int loops_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < LOOPS; i++) {
    double rows[2][N] = {{0}};
    for (int k = 0; k < ARMS; k++) {
      const arm *own = &arms[i][k];
      double x, y;
      direct(own, q, &x, &y);
      rows[0][own->first] -= y;
      rows[1][own->first] += x;
      if (own->second == NONE) continue;
      rows[0][own->second] -= y;
      rows[1][own->second] += x;
    }
    for (int a = 0; a < 2; a++)
      for (int e = rows_start[2 * i + a]; e < rows_start[2 * i + a + 1]; e++)
        phi_q[e] = rows[a][rows_row[e]];
  }
  return 0;
}

static const int bends_start[] = {0, 2, 4, 5, 7, 9, 11, 13};

static int loops_hessian(double t, const double *q, const double *w, double *phi_w, void *user)
{
  double bends[N][N] = {{0}};
  (void)t, (void)user;
  for (int i = 0; i < LOOPS; i++)
    for (int k = 0; k < ARMS; k++) {
      const arm *own = &arms[i][k];
      double x, y;
      direct(own, q, &x, &y);
      const double bend = -(w[2 * i] * x + w[2 * i + 1] * y);
      bends[own->first][own->first] += bend;
      if (own->second == NONE) continue;
      bends[own->first][own->second] += bend;
      bends[own->second][own->first] += bend;
      bends[own->second][own->second] += bend;
    }
  for (int j = 0; j < N; j++)
    for (int e = bends_start[j]; e < bends_start[j + 1]; e++) phi_w[e] = bends[vv_row[e]][j];
  return 0;
}

/* ---- the problem ---- */

static dvi_status squeezer_system(squeezer *own, problem *made)
{
  static const int spring_start[] = {0, 0, 0, 1, 1, 1, 1, 1}, spring_row[] = {GAMMA};
  static const char *const row_names[ROWS] = {"g1", "g2", "g3", "g4", "g5", "g6"};
  const dvi_lagrangian lagrangian = {.value = kinetic,
                                     .gradient = kinetic_gradient,
                                     .hessian = kinetic_hessian,
                                     .qq = {qq_start, qq_row},
                                     .qv = {qv_start, qv_row},
                                     .vv = {vv_start, vv_row}};
  const dvi_potential potential = {.name = "spring and drive",
                                   .value = forces,
                                   .gradient = forces_gradient,
                                   .hessian = forces_hessian,
                                   .qq = {spring_start, spring_row},
                                   .user = own};
  const dvi_holonomic rows = {.name = "loops",
                              .count = ROWS,
                              .value = loops,
                              .gradient = loops_gradient,
                              .hessian = loops_hessian,
                              .gradients = {rows_start, rows_row},
                              .qq = {bends_start, vv_row},
                              .row_names = row_names};
  return problem_system(made, &(dvi_system_terms){.dimension = N,
                                                  .lagrangian = &lagrangian,
                                                  .potentials = &potential,
                                                  .potential_count = 1,
                                                  .holonomics = &rows,
                                                  .holonomic_count = 1,
                                                  .autonomous = 1});
}

static dvi_status andrews_make(const double *setting, problem *made)
{
  static const char *const names[N] = {"beta",  "theta", "gamma",  "phi",
                                       "delta", "omega", "epsilon"};
  static const double start[N] = {-0.0617138900142764964, 0,
                                  0.4552798191630703803,  0.2226683901658858847,
                                  0.4873649795438425502,  -0.2226683901658858847,
                                  1.2305474445498211925};
  const dvi_status status = problem_room(made, N, sizeof(squeezer));
  if (status != DVI_OK) return status;
  squeezer *own = made->parameters;
  *own = (squeezer){.mom = setting[0], .c0 = setting[1]};
  for (int i = 0; i < N; i++) {
    problem_label(made, i, "%s", names[i]);
    made->q[i] = start[i];
  }
  return squeezer_system(own, made);
}

static const problem_parameter parameters[] = {
    {.name = "mom", .value = 0.033, .least = -1e3, .most = 1e3, .help = "the moment of the drive"},
    {.name = "c0",
     .value = 4530,
     .least = 0,
     .most = 1e10,
     .help = "the stiffness of the spring, 0 or more"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {15.810771195153706,   -15.756371058411839, 0.040822240119645796,
                                  -0.53473011634207956, 0.52440996587995403, 0.53473011634207956,
                                  1.0480807410419379};
static const double digits_p[] = {
    0.0027348918700174814,  7.1786400534273371e-05,  0.00017840381212173528, 1.5482775870117274e-05,
    3.7045469060061329e-05, -1.5509570053864488e-05, 1.3164997257259377e-05};

const problem_entry problem_entry_andrews = {
    .name = "andrews",
    .summary = "Andrews' squeezer; seven bodies in a plane, six constraints",
    .parameters = parameters,
    .make = andrews_make,
    .h = 0.0002,
    .t_end = 0.03,
    .order_h = 0.0003,
    .order_t_end = 0.03,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
