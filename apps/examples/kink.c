/* A sine-Gordon kink of speed 0.9, once around a ring of 64 cells that travel with it. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

enum { CELLS = 64 };

static const double speed = 0.9, pi = 3.14159265358979323846;

/* l = u_t^2/2 - u_x^2/2. The rest of the density, cos u - 1, is given by its mean. */
static int wave(int count, double t, const double *x, const double *z, double *l, double *l_z,
                double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double u_t = z[k], u_x = z[count + k];
    if (l != NULL) l[k] = (u_t * u_t - u_x * u_x) / 2;
    if (l_z != NULL) l_z[k] = u_t, l_z[count + k] = -u_x;
    if (l_zz != NULL) l_zz[k] = 1, l_zz[count + k] = -1;
  }
  return 0;
}

/* sin(a)/a and its first two derivatives. */
static void sinc(double a, double s[3])
{
  const int small = fabs(a) < 0.02;
  s[0] = small ? 1 - a * a / 6 * (1 - a * a / 20) : sin(a) / a;
  s[1] = small ? -a / 3 * (1 - a * a / 10 * (1 - a * a / 28)) : (cos(a) - s[0]) / a;
  s[2] = small ? -1. / 3 + a * a / 10 * (1 - a * a * 5 / 84) : -s[0] - 2 * s[1] / a;
}

/* The mean of cos u - 1 over a cell is cos(m) sinc(a) - 1, with the middle m and half of the
 * difference a of the values at its ends. */
static int mean(int count, const double *left, const double *right, double *value, double *first,
                double *second, void *user)
{
  (void)user;
  for (int k = 0; k < count; k++) {
    const double m = (left[k] + right[k]) / 2, c = cos(m), d = sin(m);
    double s[3];
    sinc((right[k] - left[k]) / 2, s);
    if (value != NULL) value[k] = c * s[0] - 1;
    if (first != NULL) first[k] = (-d * s[0] - c * s[1]) / 2;
    if (first != NULL) first[count + k] = (-d * s[0] + c * s[1]) / 2;
    if (second == NULL) continue;
    second[k] = (-c * s[0] + 2 * d * s[1] + c * s[2]) / 4;
    second[count + k] = -c * (s[0] + s[2]) / 4;
    second[2 * count + k] = (-c * s[0] - 2 * d * s[1] + c * s[2]) / 4;
  }
  return 0;
}

static int kink(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                double *velocity, void *user)
{
  const double g = 1 / sqrt(1 - speed * speed);
  (void)user;
  for (int64_t i = 0; i < count; i++) {
    u[i] = 4 * atan(exp(g * x[i]));
    u_x[i] = 2 * g / cosh(g * x[i]);
    u_t[i] = -speed * u_x[i];
    velocity[i] = speed;
  }
  return 0;
}

static int monitor(int64_t count, const double *x, double *m, void *user)
{
  const double g = 1 / sqrt(1 - speed * speed);
  (void)user;
  for (int64_t i = 0; i < count; i++) m[i] = hypot(1, 2 * g / cosh(g * x[i]));
  return 0;
}

static void report(const dvi_moving *moving, dvi_integrator *integrator, double *value)
{
  double x[CELLS + 1], shortest = INFINITY;
  const double t = dvi_integrator_time(integrator);
  (void)dvi_integrator_invariants(integrator, value);
  (void)dvi_moving_lift(moving, t, dvi_integrator_q(integrator), x, NULL);
  for (int k = 0; k < CELLS; k++) shortest = fmin(shortest, x[k + 1] - x[k]);
  printf("t = %2g  energy %.6f  momentum %.12f  shortest cell %.3f\n", t, value[0], value[1],
         shortest);
}

static dvi_status travel(dvi_moving *moving)
{
  double q[2 * CELLS], p[2 * CELLS], value[2], there, u;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_status status = dvi_moving_start(moving, kink, NULL, q, NULL, p);
  if (!status) status = dvi_moving_system(moving, &system);
  if (!status) status = dvi_integrator_create(system, "midpoint", &integrator);
  if (!status) status = dvi_integrator_start(integrator, 0, q, p);
  for (int i = 0; i <= 400 && !status; i++) {
    if (i % 100 == 0) report(moving, integrator, value);
    if (i < 400) status = dvi_integrator_step(integrator, 0.05);
  }
  there = 20 * speed;
  if (!status)
    status = dvi_moving_evaluate(moving, 20, dvi_integrator_q(integrator), 0, 1, &there, &u);
  if (!status) printf("the middle of the kink has u = %.4f, exactly %.4f\n", u, pi);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return status;
}

int main(void)
{
  const dvi_jet variable[2] = {{.rate = 1}, {.order = {1}}};
  const int pair[2][2] = {{0, 0}, {1, 1}};
  const double jump = 2 * pi;
  const dvi_density_part part = {
      .variable = variable, .variables = 2, .pair = pair, .pairs = 2, .density = wave};
  const dvi_moving_mean potential = {.mean = mean};
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.from = -10, .to = 10, .periodic = 1},
                                  .cells = CELLS,
                                  .part = &part,
                                  .mean = &potential,
                                  .translations = 1,
                                  .mu = 0.01,
                                  .kappa = 0.05,
                                  .monitor = monitor,
                                  .jump = &jump};
  dvi_moving *moving = NULL;
  dvi_status status = dvi_moving_create(&terms, &moving);
  if (!status) status = travel(moving);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  dvi_moving_destroy(&moving);
  return status != 0;
}
