/* A homogeneous ball that rolls without slipping on a disk, which turns with the angular velocity
 * omega. With Euler's angles (phi, th, psi), of the axes z, x, z,
 *
 *     L = m (x'^2 + y'^2)/2 + I (phi'^2 + th'^2 + psi'^2 + 2 cos(th) phi' psi')/2,
 *     x' - R wy + omega y = 0,   wx = cos(phi) th' + sin(phi) sin(th) psi',
 *     y' + R wx - omega x = 0,   wy = sin(phi) th' - cos(phi) sin(th) psi'
 *
 * The rows are affine. The ball runs in circles about a point at rest, with the angular velocity
 * omega I/(I + m R^2), 2/7 omega if it is solid. Source: Bloch 2003, sec. 1.12. */
#include <math.h>

#include "entry.h"

enum { X, Y, PHI, TH, PSI, N };

typedef struct ball {
  double m, I, R, omega;
} ball;

static int ball_lagrangian(double t, const double *q, const double *v, double *L, void *user)
{
  const ball *own = user;
  (void)t;
  *L = 0.5 * own->m * (v[X] * v[X] + v[Y] * v[Y]) +
       0.5 * own->I *
           (v[PHI] * v[PHI] + v[TH] * v[TH] + v[PSI] * v[PSI] + 2.0 * cos(q[TH]) * v[PHI] * v[PSI]);
  return 0;
}

static int ball_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  const ball *own = user;
  const double c = cos(q[TH]);
  (void)t;
  L_q[X] = L_q[Y] = L_q[PHI] = L_q[PSI] = 0.0;
  L_q[TH] = -own->I * sin(q[TH]) * v[PHI] * v[PSI];
  L_v[X] = own->m * v[X];
  L_v[Y] = own->m * v[Y];
  L_v[PHI] = own->I * (v[PHI] + c * v[PSI]);
  L_v[TH] = own->I * v[TH];
  L_v[PSI] = own->I * (v[PSI] + c * v[PHI]);
  return 0;
}

static int ball_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                        double *L_vv, void *user)
{
  const ball *own = user;
  const double c = own->I * cos(q[TH]), s = own->I * sin(q[TH]);
  const double by_v[] = {own->m, own->m, own->I, c, own->I, c, own->I};
  (void)t;
  L_qq[0] = -c * v[PHI] * v[PSI];
  L_qv[0] = -s * v[PSI];
  L_qv[1] = -s * v[PHI];
  memcpy(L_vv, by_v, sizeof by_v);
  return 0;
}

static int contact(double t, const double *q, double *A, void *user)
{
  const double R = ((const ball *)user)->R, s = sin(q[TH]);
  (void)t;
  A[0] = A[3] = 1.0;
  A[1] = -R * sin(q[PHI]);
  A[2] = R * cos(q[PHI]) * s;
  A[4] = R * cos(q[PHI]);
  A[5] = R * sin(q[PHI]) * s;
  return 0;
}

static int contact_affine(double t, const double *q, double *a, void *user)
{
  const double omega = ((const ball *)user)->omega;
  (void)t;
  a[0] = omega * q[Y];
  a[1] = -omega * q[X];
  return 0;
}

static int contact_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  const ball *own = user;
  const double R = own->R, sp = sin(q[PHI]), cp = cos(q[PHI]), s = sin(q[TH]), c = cos(q[TH]);
  (void)t;
  Av_q[0] = -own->omega;
  Av_q[1] = own->omega;
  Av_q[2] = -R * cp * v[TH] - R * sp * s * v[PSI];
  Av_q[3] = -R * sp * v[TH] + R * cp * s * v[PSI];
  Av_q[4] = R * cp * c * v[PSI];
  Av_q[5] = R * sp * c * v[PSI];
  return 0;
}

static void ball_start(const ball *own, double spin, double *q, double *v)
{
  const double wx = (own->omega - 0.3) / own->R;
  q[X] = 1.0;
  q[PHI] = 1.57079632679489661923;
  q[TH] = 1.2;
  v[Y] = 0.3;
  v[PSI] = wx / sin(q[TH]);
  v[PHI] = spin - v[PSI] * cos(q[TH]);
}

static dvi_status disk_ball_make(const double *setting, problem *made)
{
  static const int qq_start[] = {0, 0, 0, 0, 1, 1}, qq_row[] = {TH},
                   qv_start[] = {0, 0, 0, 1, 1, 2}, qv_row[] = {TH, TH},
                   vv_start[] = {0, 1, 2, 4, 5, 7}, vv_row[] = {X, Y, PHI, PSI, TH, PHI, PSI},
                   rows_start[] = {0, 3, 6}, rows_row[] = {X, TH, PSI, Y, TH, PSI},
                   by_start[] = {0, 1, 2, 4, 6, 6}, by_row[] = {1, 0, 0, 1, 0, 1};
  static const char *const label[] = {"x", "y", "phi", "th", "psi"};
  const dvi_status status = problem_room(made, N, sizeof(ball));
  if (status != DVI_OK) return status;
  ball *own = made->parameters;
  *own = (ball){.m = setting[0], .I = setting[1], .R = setting[2], .omega = setting[3]};
  for (int i = 0; i < N; i++) problem_label(made, i, "%s", label[i]);
  ball_start(own, setting[4], made->q, made->v);

  const dvi_lagrangian lagrangian = {.value = ball_lagrangian,
                                     .gradient = ball_gradient,
                                     .hessian = ball_hessian,
                                     .qq = {qq_start, qq_row},
                                     .qv = {qv_start, qv_row},
                                     .vv = {vv_start, vv_row},
                                     .user = own};
  const dvi_nonholonomic rows = {.name = "contact",
                                 .count = 2,
                                 .value = contact,
                                 .affine = contact_affine,
                                 .derivative = contact_derivative,
                                 .transposed = {rows_start, rows_row},
                                 .by_q = {by_start, by_row},
                                 .user = own};
  const dvi_system_terms terms = {.dimension = N,
                                  .lagrangian = &lagrangian,
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    PROBLEM_MASS(1.0),
    {.name = "I",
     .value = 0.1,
     .least = 1e-50,
     .most = 1e50,
     .help = "the moment of inertia, positive; 2/5 m R^2 of a solid ball"},
    {.name = "R", .value = 0.5, .least = 1e-6, .most = 1e6, .help = "the radius, positive"},
    {.name = "omega",
     .value = 1.0,
     .least = -1e3,
     .most = 1e3,
     .help = "the angular velocity of the disk, -1e3 to 1e3"},
    {.name = "spin",
     .value = 0.5,
     .least = -1e3,
     .most = 1e3,
     .help = "the ball's angular velocity about the vertical, -1e3 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.098833192119157517, 1.0393982301907301, 2.8699382610987003,
                                  1.2959946143121919, 7.2722834530449125};
static const double digits_p[] = {-0.29697092291163718, 0.042523769176902149, 0.05,
                                  0.028993547462974351, 0.15414951026420803};

const problem_entry problem_entry_disk_ball = {
    .name = "disk-ball",
    .summary = "a ball that rolls on a turning disk; nonholonomic, affine rows",
    .parameters = parameters,
    .make = disk_ball_make,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
