/* A mass on a stiff spring that swings in a plane. a is the spring's extension, th the angle from
 * straight down.
 *
 *     L = m/2 (a'^2 + (l+a)^2 th'^2) + m g (l+a) cos th - k a^2/2
 *
 * A general Lagrangian with one-point callbacks and sparse blocks. */
#include <math.h>

#include "entry.h"

typedef struct stiff_pendulum_coefficients {
  double k, l, m, g;
} stiff_pendulum_coefficients;

static int stiff_pendulum_lagrangian(double t, const double *q, const double *v, double *L,
                                     void *user)
{
  const stiff_pendulum_coefficients *own = user;
  const double length = own->l + q[0], swing = length * v[1];
  (void)t;
  *L = 0.5 * own->m * (v[0] * v[0] + swing * swing) + own->m * own->g * length * cos(q[1]) -
       0.5 * own->k * q[0] * q[0];
  return 0;
}

static int stiff_pendulum_gradient(double t, const double *q, const double *v, double *L_q,
                                   double *L_v, void *user)
{
  const stiff_pendulum_coefficients *own = user;
  const double length = own->l + q[0];
  (void)t;
  L_q[0] = own->m * (length * v[1] * v[1] + own->g * cos(q[1])) - own->k * q[0];
  L_q[1] = -own->m * own->g * length * sin(q[1]);
  L_v[0] = own->m * v[0];
  L_v[1] = own->m * length * length * v[1];
  return 0;
}

/* L_qq is full, L_qv has only the entry (a, th'), L_vv is diagonal. */
static const int qv_start[] = {0, 0, 1}, qv_row[] = {0};
static const int vv_start[] = {0, 1, 2}, vv_row[] = {0, 1};

static int stiff_pendulum_hessian(double t, const double *q, const double *v, double *L_qq,
                                  double *L_qv, double *L_vv, void *user)
{
  const stiff_pendulum_coefficients *own = user;
  const double length = own->l + q[0];
  (void)t;
  L_qq[0] = own->m * v[1] * v[1] - own->k;
  L_qq[1] = L_qq[2] = -own->m * own->g * sin(q[1]);
  L_qq[3] = -own->m * own->g * length * cos(q[1]);
  L_qv[0] = 2.0 * own->m * length * v[1];
  L_vv[0] = own->m;
  L_vv[1] = own->m * length * length;
  return 0;
}

static dvi_status stiff_pendulum_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 2, sizeof(stiff_pendulum_coefficients));
  if (status != DVI_OK) return status;
  stiff_pendulum_coefficients *own = made->parameters;
  *own = (stiff_pendulum_coefficients){
      .k = setting[0], .l = setting[1], .m = setting[2], .g = setting[3]};
  problem_label(made, 0, "a");
  problem_label(made, 1, "theta");
  made->q[0] = 0.05;
  made->q[1] = 1.0;

  const dvi_lagrangian lagrangian = {.value = stiff_pendulum_lagrangian,
                                     .gradient = stiff_pendulum_gradient,
                                     .hessian = stiff_pendulum_hessian,
                                     .qv = {qv_start, qv_row},
                                     .vv = {vv_start, vv_row},
                                     .user = own};
  const dvi_system_terms terms = {.dimension = 2, .lagrangian = &lagrangian, .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "k",
     .value = 1e4,
     .least = 0.0,
     .most = 1e100,
     .help = "the stiffness of the spring, not negative"},
    {.name = "l",
     .value = 1.0,
     .least = 1e-50,
     .most = 1e50,
     .help = "the length of the spring at rest, positive"},
    PROBLEM_MASS(1.0),
    PROBLEM_GRAVITY(9.81),
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.044882232671395289, -0.98070161619132682};
static const double digits_p[] = {2.1995025784392814, -0.56714560045691314};

const problem_entry problem_entry_stiff_pendulum = {
    .name = "stiff-pendulum",
    .summary = "a mass on a stiff spring that swings; fast and slow motion, coupled",
    .parameters = parameters,
    .make = stiff_pendulum_make,
    .h = 0.002,
    .t_end = 10.0,
    .order_h = 0.001,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
