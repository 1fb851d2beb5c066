/* The angle by which a step turns a stiff spring, and the rate at which slow forces carry energy
 * from one such spring to another.
 *
 * Springs x of one frequency omega that slow forces -K x couple move as x = Re z exp(i omega t),
 * where on average 2 i omega z' = K z. Each mode of K, with the eigenvalue kappa, turns faster by
 * kappa/(2 omega), and the springs exchange their energies as the modes' phases part. A step of one
 * mode,
 *
 *     x'' = -omega^2 x (fast) - kappa x (slow),
 *
 * is a matrix of determinant 1 that turns by theta(kappa), 2 cos theta = its trace. Its rate of the
 * exchange, with the exact one as the unit, is, for h = 1,
 *
 *     theta'(0) 2 omega = -omega trace'(0) / sin theta(0),
 *
 * with a difference for trace'. For kicks through filters that is psi phi/sinc
 * (HairerLubichWanner2006, sec. XIII.4), for imex it is 1 (Stern2009, theorem 2.2.4). */
#include <dvi/diagnostics.h>
#include <math.h>

#include "core/status.h"

static const double pi = 3.14159265358979323846;

/* Limits of h omega and of the turn. Turns beyond them are lost in the rounding of a trace near 2
 * or -2. */
static const double shortest = 1e-3, longest = 1e5, least_turn = 1e-12;

static int spring_value(double t, const double *x, double *V, void *user)
{
  const double *stiffness = user;
  (void)t;
  *V = 0.5 * *stiffness * x[0] * x[0];
  return 0;
}

static int spring_gradient(double t, const double *x, double *V_x, void *user)
{
  const double *stiffness = user;
  (void)t;
  V_x[0] = *stiffness * x[0];
  return 0;
}

static int spring_hessian(double t, const double *x, double *V_xx, void *user)
{
  const double *stiffness = user;
  (void)t, (void)x;
  V_xx[0] = *stiffness;
  return 0;
}

static dvi_potential spring_potential(double *stiffness, int fast)
{
  return (dvi_potential){.name = fast ? "fast" : "slow",
                         .value = spring_value,
                         .gradient = spring_gradient,
                         .hessian = spring_hessian,
                         .user = stiffness,
                         .fast = fast,
                         .quadratic = 1};
}

/* The ends (x, p) of a step from (1, 0) and from (0, 1). */
typedef struct step_matrix {
  double column[2][2];
} step_matrix;

static dvi_status take_steps(dvi_integrator *integrator, step_matrix *step)
{
  for (int k = 0; k < 2; k++) {
    const double x = k == 0, p = k == 1;
    DVI_TRY(dvi_integrator_start(integrator, 0, &x, &p));
    DVI_TRY(dvi_integrator_step(integrator, 1));
    step->column[k][0] = dvi_integrator_q(integrator)[0];
    step->column[k][1] = dvi_integrator_p(integrator)[0];
  }
  return DVI_OK;
}

static dvi_status take_step(const char *method, double omega, double kappa, step_matrix *step)
{
  double square = omega * omega;
  const dvi_potential springs[] = {spring_potential(&square, 1), spring_potential(&kappa, 0)};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass = {.scalar = 1},
                                  .potentials = springs,
                                  .potential_count = 2,
                                  .autonomous = 1};
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, method, &integrator);
  if (status == DVI_OK) status = take_steps(integrator, step);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return status;
}

static double step_trace(const step_matrix *step)
{
  return step->column[0][0] + step->column[1][1];
}

dvi_status dvi_exchange(const char *method, double h_omega, double *turn, double *rate)
{
  if (!method || !turn || !rate)
    return dvi__fail(DVI_BAD_ARGUMENT, "exchange: an argument is NULL");
  if (!(h_omega >= shortest && h_omega <= longest))
    return dvi__fail(DVI_BAD_ARGUMENT, "exchange: h omega = %g; it must be from %g to %g", h_omega,
                     shortest, longest);
  const double kappa = 1e-3 * h_omega * fmin(h_omega, 1);
  step_matrix softer, as_it_is, stiffer;
  DVI_TRY(take_step(method, h_omega, -kappa, &softer));
  DVI_TRY(take_step(method, h_omega, 0, &as_it_is));
  DVI_TRY(take_step(method, h_omega, kappa, &stiffer));
  const double cosine = 0.5 * step_trace(&as_it_is);
  if (!(fabs(cosine) < 1 - least_turn))
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "exchange: a step of h omega = %g by %s does not turn a spring, or by a multiple of pi",
        h_omega, method);
  const double angle = acos(cosine),
               slope = (step_trace(&stiffer) - step_trace(&softer)) / (2 * kappa);
  *turn = as_it_is.column[1][0] > 0 ? angle : 2 * pi - angle;
  *rate = -h_omega * slope / sin(*turn);
  return DVI_OK;
}
