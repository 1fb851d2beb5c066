#include "support/field/moving_fields.h"

#include <math.h>
#include <stddef.h>

/* ---- sine-Gordon ---- */

static const dvi_jet variable[] = {{.rate = 1}, {.order = {1}}, {0}};

/* All of them have l_zz by the pairs (0,0), (1,1) and, with u, (2,2). */
static const int pair[][2] = {{0, 0}, {1, 1}, {2, 2}};

static int waving(int count, double t, const double *x, const double *z, double *l, double *l_z,
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

static int sine_gordon_density(int count, double t, const double *x, const double *z, double *l,
                               double *l_z, double *l_zz, void *user)
{
  (void)waving(count, t, x, z, l, l_z, l_zz, user);
  for (int k = 0; k < count; k++) {
    const double u = z[2 * count + k];
    if (l != NULL) l[k] += cos(u) - 1;
    if (l_z != NULL) l_z[2 * count + k] = -sin(u);
    if (l_zz != NULL) l_zz[2 * count + k] = -cos(u);
  }
  return 0;
}

const dvi_density_part free_wave = {
    .variable = variable, .variables = 2, .pair = pair, .pairs = 2, .density = waving};
const dvi_density_part sine_gordon = {
    .variable = variable, .variables = 3, .pair = pair, .pairs = 3, .density = sine_gordon_density};

/* sin(a)/a and its first two derivatives, by the series where rounding would spoil the formula. */
static void sinc(double a, double s[3])
{
  const double b = a * a;
  if (b < 0.01) {
    s[0] = 1 - b / 6 * (1 - b / 20 * (1 - b / 42 * (1 - b / 72)));
    s[1] = -a / 3 * (1 - b / 10 * (1 - b / 28 * (1 - b / 54)));
    s[2] = -1. / 3 + b / 10 * (1 - b * 5 / 84 * (1 - b * 7 / 270));
    return;
  }
  s[0] = sin(a) / a;
  s[1] = (cos(a) - s[0]) / a;
  s[2] = -s[0] - 2 * s[1] / a;
}

static int cosine_mean(int count, const double *left, const double *right, double *mean,
                       double *first, double *second, void *user)
{
  (void)user;
  for (int k = 0; k < count; k++) {
    const double middle = (left[k] + right[k]) / 2, c = cos(middle), d = sin(middle);
    double s[3];
    sinc((right[k] - left[k]) / 2, s);
    if (mean != NULL) mean[k] = c * s[0] - 1;
    if (first != NULL) {
      first[k] = (-d * s[0] - c * s[1]) / 2;
      first[count + k] = (-d * s[0] + c * s[1]) / 2;
    }
    if (second == NULL) continue;
    second[k] = (-c * s[0] + 2 * d * s[1] + c * s[2]) / 4;
    second[count + k] = (-c * s[0] - c * s[2]) / 4;
    second[2 * count + k] = (-c * s[0] - 2 * d * s[1] + c * s[2]) / 4;
  }
  return 0;
}

const dvi_moving_mean sine_gordon_mean = {.mean = cosine_mean};

double kink_value(const kink *k, double t, double x)
{
  return 4 * atan(exp((x - k->v * t - k->x0) / sqrt(1 - k->v * k->v)));
}

int kink_wave(int64_t count, const double *x, double *u, double *u_x, double *u_t, double *velocity,
              void *user)
{
  const kink *k = user;
  const double g = 1 / sqrt(1 - k->v * k->v);
  for (int64_t i = 0; i < count; i++) {
    u[i] = kink_value(k, 0, x[i]);
    u_x[i] = 2 * g / cosh(g * (x[i] - k->x0));
    u_t[i] = -k->v * u_x[i];
    velocity[i] = k->v;
  }
  return 0;
}

/* ---- waves that break ---- */

static int breaking_density(int count, double t, const double *x, const double *z, double *l,
                            double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double u_t = z[k], c = 1 + z[count + k];
    if (l != NULL) l[k] = u_t * u_t / 2 - c * c * c * c / 12;
    if (l_z != NULL) l_z[k] = u_t, l_z[count + k] = -c * c * c / 3;
    if (l_zz != NULL) l_zz[k] = 1, l_zz[count + k] = -c * c;
  }
  return 0;
}

const dvi_density_part breaking = {
    .variable = variable, .variables = 2, .pair = pair, .pairs = 2, .density = breaking_density};
