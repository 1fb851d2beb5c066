#include "step/split/orbit.h"

#include <float.h>
#include <math.h>

#include "step/split/modes.h"

/* Evaluate G and r at s. Returns the time there. */
static double time_at(dvi__orbit *o, double s)
{
  double c[4];
  dvi__modes_functions(o->beta * s * s, c);
  o->s = s;
  o->G[0] = c[0];
  o->G[1] = s * c[1];
  o->G[2] = s * s * c[2];
  o->G[3] = s * s * s * c[3];
  o->r = o->r0 * o->G[0] + o->eta * o->G[1] + o->mu * o->G[2];
  return o->r0 * o->G[1] + o->eta * o->G[2] + o->mu * o->G[3];
}

/* ---- the equation for s ---- */

/* Return the eccentricity, by which Kepler's equation begins. */
static double eccentricity_of(const dvi__orbit *o)
{
  const double along = 1 - o->r0 * o->beta / o->mu, across = o->eta / o->mu;
  return sqrt(fmax(along * along + o->beta * across * across, 0));
}

typedef struct bracket {
  double low, high;
} bracket;

/* Bound s > 0 at a time tau > 0. On an ellipse x = sqrt(beta) s is within 2 e of the mean
 * anomaly. */
static bracket bracket_of(const dvi__orbit *o, double tau)
{
  if (!(o->beta > 0)) return (bracket){0, HUGE_VAL};
  const double root = sqrt(o->beta), mean = o->beta * root / o->mu * tau;
  const double apart = 2.001 * eccentricity_of(o);
  return (bracket){fmax(mean - apart, 0) / root, (mean + apart) * (1 + 1e-9) / root};
}

/* Guess s > 0 at a time tau > 0. On a hyperbola e sinh H - H, with a repulsion e sinh H + H, grows
 * with the time, and H is nearly the arsinh of that over e. */
static double guess_place(const dvi__orbit *o, double tau)
{
  if (!(o->beta < 0)) return tau / o->r0;
  const double root = sqrt(-o->beta), size = fabs(o->mu), e = eccentricity_of(o),
               along = root * o->eta / size, H = asinh(along / e),
               mean = along - copysign(H, o->mu * H) - o->beta * root / size * tau,
               x = asinh(mean / e) - H;
  return x > 0 ? x / root : tau / o->r0;
}

/* Correct by Laguerre's method for polynomials of degree 5, which converges from far away, and to
 * third order. Where numbers overflow it is NaN. */
static double laguerre_step(const dvi__orbit *o, double defect)
{
  const double bend = o->eta * o->G[0] + (o->mu - o->beta * o->r0) * o->G[1];
  const double part = defect / o->r;
  return -5 * part / (1 + sqrt(fabs(16 - 20 * part * bend / o->r)));
}

/* A step is near the solution at this part of s, or of a turn. Its error is about the cube. */
static int is_near(const dvi__orbit *o, double s, double step)
{
  const double near = 1e-6;
  return fabs(step) <= near * s && step * step * fabs(o->beta) <= near * near;
}

/* Take a near step by the series of G, whose third term is below rounding. */
static void finish(dvi__orbit *o, double step)
{
  const double *G = o->G, half = 0.5 * step * step;
  const double moved[] = {G[0] - o->beta * (step * G[1] + half * G[0]),
                          G[1] + (step * G[0] - half * o->beta * G[1]),
                          G[2] + (step * G[1] + half * G[0]), G[3] + (step * G[2] + half * G[1])};
  o->s += step;
  for (int k = 0; k < 4; k++) o->G[k] = moved[k];
  o->r = o->r0 * moved[0] + o->eta * moved[1] + o->mu * moved[2];
}

/* Find s > 0 at tau > 0 by a few steps from a guess. The time grows with s, so that there is one
 * solution. Returns 0 if they do not get near. */
static int find_near(dvi__orbit *o, double tau, double s)
{
  enum { MOST = 4 };
  for (int iteration = 0; iteration < MOST; iteration++) {
    const double step = laguerre_step(o, time_at(o, s) - tau);
    if (is_near(o, s, step)) {
      finish(o, step);
      return 1;
    }
    s += step;
    if (!(s > 0 && s <= DBL_MAX)) return 0;
  }
  return 0;
}

/* Find s > 0 at tau > 0 from anywhere. Bisection takes over where a step leaves the bracket or a
 * hyperbola overflows. */
static void find_far(dvi__orbit *o, double tau)
{
  enum { MOST = 200 };
  bracket b = bracket_of(o, tau);
  double s = guess_place(o, tau);
  if (!(s > b.low && s < b.high)) s = isfinite(b.high) ? 0.5 * (b.low + b.high) : tau / o->r0;
  for (int iteration = 0; iteration < MOST; iteration++) {
    const double defect = time_at(o, s) - tau, step = laguerre_step(o, defect);
    if (is_near(o, s, step)) {
      finish(o, step);
      return;
    }
    if (defect < 0)
      b.low = s;
    else
      b.high = s;
    const int inside = s + step >= b.low && s + step <= b.high;
    s = inside ? s + step : isfinite(b.high) ? 0.5 * (b.low + b.high) : 2 * s;
  }
}

void dvi__orbit_place(double mu, int dimension, const double *q, const double *v, double tau,
                      double guess, dvi__orbit *o)
{
  double square = 0, speed = 0, eta = 0;
  for (int i = 0; i < dimension; i++) {
    square += q[i] * q[i];
    speed += v[i] * v[i];
    eta += q[i] * v[i];
  }
  const double r0 = sqrt(square), sign = tau < 0 ? -1 : 1;
  *o = (dvi__orbit){.mu = mu, .r0 = r0, .eta = sign * eta, .beta = 2 * mu / r0 - speed};
  const double straight = fabs(tau) / r0;
  const int has_guess = guess != 0 || straight * straight * fabs(o->beta) < 1;
  if (tau == 0 || !isfinite(o->beta))
    (void)time_at(o, 0);
  else if (!has_guess || !find_near(o, fabs(tau), guess != 0 ? fabs(guess) : straight))
    find_far(o, fabs(tau));
  /* the motion backward is that with -v */
  o->eta = eta;
  o->s *= sign;
  o->G[1] *= sign;
  o->G[3] *= sign;
  o->f_less_1 = -mu * o->G[2] / r0;
  o->g = r0 * o->G[1] + eta * o->G[2];
  o->f_rate = -mu * o->G[1] / (o->r * r0);
  o->g_rate_less_1 = -mu * o->G[2] / o->r;
}

/* ---- the pullback ---- */

/* 1/(2j + 4)! and 1/(2j + 5)!. */
enum { TERMS = 8 };
static const double of_4[TERMS] = {1 / 24.0,          1 / 720.0,          1 / 40320.0,
                                   1 / 3628800.0,     1 / 479001600.0,    1 / 87178291200.0,
                                   1 / 20922789888e3, 1 / 6402373705728e3};
static const double of_5[TERMS] = {1 / 120.0,          1 / 5040.0,           1 / 362880.0,
                                   1 / 39916800.0,     1 / 6227020800.0,     1 / 1307674368e3,
                                   1 / 355687428096e3, 1 / 121645100408832e3};

/* Compute G_4 and G_5, by their series where the recursion cancels. */
static void higher_functions(const dvi__orbit *o, double *G_4, double *G_5)
{
  const double s2 = o->s * o->s, z = o->beta * s2;
  double c_4 = 0, c_5 = 0;
  if (fabs(z) > 1) {
    *G_4 = (0.5 * s2 - o->G[2]) / o->beta;
    *G_5 = (s2 * o->s / 6 - o->G[3]) / o->beta;
    return;
  }
  for (int j = TERMS - 1; j >= 0; j--) {
    c_4 = of_4[j] - z * c_4;
    c_5 = of_5[j] - z * c_5;
  }
  *G_4 = s2 * s2 * c_4;
  *G_5 = s2 * s2 * o->s * c_5;
}

/* The adjoint of the formulas above, from the last to the first. For a number x, of_x is the
 * derivative of lambda.q(tau) by x. d G_k/d beta = (k G_{k+2} - s G_{k+1})/2. */
void dvi__orbit_pullback(const dvi__orbit *o, int dimension, const double *q, const double *v,
                         const double *lambda, double *to_q, double *to_v)
{
  const double *G = o->G, mu = o->mu, r0 = o->r0, eta = o->eta, s = o->s;
  double of_f = 0, of_g = 0, G_4, G_5;
  for (int i = 0; i < dimension; i++) {
    of_f += lambda[i] * q[i];
    of_g += lambda[i] * v[i];
  }
  higher_functions(o, &G_4, &G_5);
  const double bent[] = {0.5 * (G[3] - s * G[2]), 0.5 * (2 * G_4 - s * G[3]),
                         0.5 * (3 * G_5 - s * G_4)};
  const double of_tau = (of_g * (o->r - mu * G[2]) - of_f * mu * G[1] / r0) / o->r;
  const double of_eta = (of_g - of_tau) * G[2];
  const double of_beta = (of_g - of_tau) * (r0 * bent[0] + eta * bent[1]) -
                         of_f * mu * bent[1] / r0 - of_tau * mu * bent[2];
  const double of_r0 = of_f * mu * G[2] / (r0 * r0) + (of_g - of_tau) * G[1] -
                       of_beta * 2 * mu / (r0 * r0);
  for (int i = 0; i < dimension; i++) {
    to_q[i] = lambda[i] + o->f_less_1 * lambda[i] + of_r0 / r0 * q[i] + of_eta * v[i];
    to_v[i] = o->g * lambda[i] + of_eta * q[i] - 2 * of_beta * v[i];
  }
}
