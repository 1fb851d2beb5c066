/* An oscillator with friction that a force drives,
 *
 *     L = v^2/2 - q^2/2,   F = -c v + f sin(omega t). */
#include <math.h>

#include "entry.h"

typedef struct damping {
  double c, f, omega;
} damping;

static int spring_potential(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * q[0] * q[0];
  return 0;
}

static int spring_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0];
  return 0;
}

static int spring_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  V_qq[0] = 1.0;
  return 0;
}

static int damped_driven_force(double t, const double *q, const double *v, double *F, void *user)
{
  const damping *own = user;
  (void)q;
  F[0] = -own->c * v[0] + own->f * sin(own->omega * t);
  return 0;
}

static int damped_driven_jacobian(double t, const double *q, const double *v, double *F_q,
                                  double *F_v, void *user)
{
  (void)t, (void)q, (void)v, (void)F_q;
  F_v[0] = -((const damping *)user)->c;
  return 0;
}

/* Compute q = A cos wt + B sin wt + exp(-at) (C cos nt + D sin nt) with a = c/2, n^2 = 1 - a^2. */
static int damped_driven_exact(const problem *made, double t, double *q, double *p)
{
  const damping *own = made->parameters;
  const double w = own->omega, detuning = (1.0 - w) * (1.0 + w), loss = own->c * w,
               square = detuning * detuning + loss * loss;
  if (!(square > 0.0)) return -1;
  const double a = 0.5 * own->c, n = sqrt((1.0 - a) * (1.0 + a)), decay = exp(-a * t),
               A = -loss * own->f / square, B = detuning * own->f / square, C = made->q[0] - A,
               D = (a * C - B * w) / n;
  double cn, sn;
  problem_oscillation((1.0 - a) * (1.0 + a), t, &cn, &sn);
  const double cw = cos(w * t), sw = sin(w * t);
  q[0] = A * cw + B * sw + decay * (C * cn + D * sn);
  p[0] = w * (B * cw - A * sw) + decay * ((n * D - a * C) * cn - (n * C + a * D) * sn);
  return 0;
}

static dvi_status damped_driven_make(const double *setting, problem *made)
{
  static const int nothing[] = {0, 0};
  const dvi_status status = problem_room(made, 1, sizeof(damping));
  if (status != DVI_OK) return status;
  damping *own = made->parameters;
  *own = (damping){.c = setting[0], .f = setting[1], .omega = setting[2]};
  problem_label(made, 0, "q");
  made->q[0] = 1.0;

  const dvi_potential spring = {.name = "spring",
                                .value = spring_potential,
                                .gradient = spring_gradient,
                                .hessian = spring_hessian,
                                .quadratic = 1};
  const dvi_force force = {.name = "damping and drive",
                           .value = damped_driven_force,
                           .jacobian = damped_driven_jacobian,
                           .by_q = {nothing, nothing},
                           .user = own};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass = {.scalar = 1.0},
                                  .potentials = &spring,
                                  .potential_count = 1,
                                  .forces = &force,
                                  .force_count = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "c",
     .value = 0.2,
     .least = 0.0,
     .most = 1.9,
     .help = "the friction, 0 to 1.9; 2 is critical"},
    {.name = "f",
     .value = 0.5,
     .least = -1e50,
     .most = 1e50,
     .help = "the amplitude of the drive, any number"},
    {.name = "omega",
     .value = 2.0,
     .least = 1e-3,
     .most = 1e3,
     .help = "the angular frequency of the drive, 1e-3 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.56331912005831950};
static const double digits_p[] = {-0.0025742232918875799};

const problem_entry problem_entry_damped_driven = {
    .name = "damped-driven",
    .summary = "an oscillator with friction and a drive; forces without a potential",
    .parameters = parameters,
    .make = damped_driven_make,
    .exact = damped_driven_exact,
    .h = 0.1,
    .t_end = 50.0,
    .order_h = 0.2,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
