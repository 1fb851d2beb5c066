/* A stiff and a soft spring on one unit mass, with the slow potential q^2/2 and the fast potential
 * omega^2 q^2/2. Splitting methods meet their resonances here. */
#include <float.h>
#include <math.h>

#include "entry.h"

/* Evaluate stiffness q^2/2, which is both potentials. `user` is the stiffness. */
static int oscillators_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const double stiffness = *(const double *)user;
  (void)t;
  for (int k = 0; k < count; k++) V[k] = 0.5 * stiffness * q[k] * q[k];
  return 0;
}

static int oscillators_gradient(int count, const double *t, const double *q, double *V_q,
                                void *user)
{
  const double stiffness = *(const double *)user;
  (void)t;
  for (int k = 0; k < count; k++) V_q[k] = stiffness * q[k];
  return 0;
}

static int oscillators_hessian(int count, const double *t, const double *q, double *V_qq,
                               void *user)
{
  const double stiffness = *(const double *)user;
  (void)t, (void)q;
  for (int k = 0; k < count; k++) V_qq[k] = stiffness;
  return 0;
}

/* Evaluate stiffness q^2/2 along a curve. */
static int oscillators_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                              double *V_qq, void *user)
{
  (void)t;
  problem_spring_taylor(*(const double *)user, degree, q, V, V_q, V_qq);
  return 0;
}

typedef struct stiffnesses {
  double slow, fast;
} stiffnesses;

/* Compute q = q0 cos(w t), p = -w q0 sin(w t), w^2 = 1 + omega^2. */
static int oscillators_exact(const problem *made, double t, double *q, double *p)
{
  const stiffnesses *own = made->parameters;
  const double square = own->slow + own->fast;
  double c, s;
  problem_oscillation(square, t, &c, &s);
  q[0] = made->q[0] * c;
  p[0] = -sqrt(square) * made->q[0] * s;
  return 0;
}

static dvi_status oscillators_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 1, sizeof(stiffnesses));
  if (status != DVI_OK) return status;
  stiffnesses *own = made->parameters;
  own->slow = 1.0;
  own->fast = setting[0] * setting[0];
  problem_label(made, 0, "q");
  made->q[0] = 1.0;

  dvi_potential springs[2] = {
      {.name = "slow",
       .value_batch = oscillators_potential,
       .gradient_batch = oscillators_gradient,
       .hessian_batch = oscillators_hessian,
       .user = &own->slow,
       .taylor = oscillators_taylor},
      {.name = "fast",
       .value_batch = oscillators_potential,
       .gradient_batch = oscillators_gradient,
       .hessian_batch = oscillators_hessian,
       .user = &own->fast,
       .fast = 1,
       .quadratic = 1,
       .taylor = oscillators_taylor},
  };
  return problem_potential_system(made, 2, springs);
}

static const problem_parameter parameters[] = {
    {.name = "omega",
     .value = 50.0,
     .least = 0.0,
     .most = 1e100,
     .help = "the stiff spring's frequency, not negative"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.96754123273868278};
static const double digits_p[] = {12.638187027387501};

const problem_entry problem_entry_oscillators = {
    .name = "oscillators",
    .summary =
        "a stiff and a soft spring on one mass, declared as two potentials; exact solution known",
    .parameters = parameters,
    .make = oscillators_make,
    .exact = oscillators_exact,
    .h = 0.002,
    .t_end = 10.0,
    .order_h = 0.001,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
