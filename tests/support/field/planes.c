#include "support/field/planes.h"

#include <math.h>
#include <stdlib.h>

#include "support/suite.h"

/* ---- densities ---- */

static const double pi = 3.14159265358979323846;

static const dvi_jet variable[] = {{.rate = 1}, {.order = {1}}, {.order = {0, 1}}, {0}};
static const int pair[][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}};
static const int quartic_pair[][2] = {{0, 0}, {1, 1}, {2, 2}, {2, 1}};

static int waving(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double u_t = z[k], u_x = z[count + k], u_y = z[2 * count + k];
    if (l != NULL) l[k] = (u_t * u_t - u_x * u_x - u_y * u_y) / 2;
    if (l_z != NULL) l_z[k] = u_t, l_z[count + k] = -u_x, l_z[2 * count + k] = -u_y;
    if (l_zz != NULL) l_zz[k] = 1, l_zz[count + k] = l_zz[2 * count + k] = -1;
  }
  return 0;
}

static int sine_gordon(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  (void)waving(count, t, x, z, l, l_z, l_zz, user);
  for (int k = 0; k < count; k++) {
    const double u = z[3 * count + k];
    if (l != NULL) l[k] += cos(u) - 1;
    if (l_z != NULL) l_z[3 * count + k] = -sin(u);
    if (l_zz != NULL) l_zz[3 * count + k] = -cos(u);
  }
  return 0;
}

static int massive(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)waving(count, t, x, z, l, l_z, l_zz, user);
  for (int k = 0; k < count; k++) {
    const double u = z[3 * count + k];
    if (l != NULL) l[k] -= u * u / 2;
    if (l_z != NULL) l_z[3 * count + k] = -u;
    if (l_zz != NULL) l_zz[3 * count + k] = -1;
  }
  return 0;
}

static int quartic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)waving(count, t, x, z, l, l_z, l_zz, user);
  for (int k = 0; k < count; k++) {
    const double u_x = z[count + k], u_y = z[2 * count + k], square = u_x * u_x + u_y * u_y;
    if (l != NULL) l[k] -= square * square / 4;
    if (l_z != NULL) l_z[count + k] -= square * u_x, l_z[2 * count + k] -= square * u_y;
    if (l_zz == NULL) continue;
    l_zz[count + k] -= square + 2 * u_x * u_x;
    l_zz[2 * count + k] -= square + 2 * u_y * u_y;
    l_zz[3 * count + k] = -2 * u_x * u_y;
  }
  return 0;
}

const dvi_density_part plane_wave = {
    .variable = variable, .variables = 3, .pair = pair, .pairs = 3, .density = waving};
const dvi_density_part plane_sine_gordon = {
    .variable = variable, .variables = 4, .pair = pair, .pairs = 4, .density = sine_gordon};
const dvi_density_part plane_massive = {
    .variable = variable, .variables = 4, .pair = pair, .pairs = 4, .density = massive};
const dvi_density_part plane_quartic = {
    .variable = variable, .variables = 3, .pair = quartic_pair, .pairs = 4, .density = quartic};

/* ---- meshes ---- */

dvi_mesh *plane_mesh(const dvi_generator_options *options, void (*move)(double *point, void *user),
                     void *user)
{
  dvi_mesh *regular = NULL, *mesh = NULL;
  int width;
  ck_assert_msg(!dvi_mesh_generate("kuhn", options, &regular), "%s", dvi_last_error());
  const size_t points = (size_t)dvi_mesh_count(regular, 0);
  double *point = malloc(2 * points * sizeof *point), period[2];
  for (size_t k = 0; k < 2 * points; k++) point[k] = dvi_mesh_points(regular)[k];
  for (size_t k = 0; k < points && move != NULL; k++) move(point + 2 * k, user);
  for (int i = 0; i < 2; i++) period[i] = options->periodic[i] ? options->extent[i] : 0;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = (int64_t)points,
                                .point = point,
                                .cells = dvi_mesh_count(regular, 2),
                                .vertex = dvi_mesh_vertices(regular, 2, &width),
                                .period = period};
  ck_assert_msg(!dvi_mesh_create(&terms, &mesh), "%s", dvi_last_error());
  dvi_mesh_destroy(&regular);
  free(point);
  return mesh;
}

void shake(double *point, void *user)
{
  const double x = 2 * pi * point[0], y = 2 * pi * point[1];
  const double amount = user != NULL ? *(const double *)user : 1;
  point[0] += amount * (0.04 * sin(x + 2 * y) + 0.02 * cos(3 * x));
  point[1] += amount * (0.04 * sin(2 * x - y) + 0.02 * cos(3 * y));
}

int plane_sway(int count, double t, const double *X, double *x, double *rate, void *user)
{
  (void)user;
  for (int k = 0; k < count; k++)
    for (int i = 0; i < 2; i++) {
      const double phase = 2 * pi * (X[k] - (i ? 2 : -1) * X[count + k]) + t;
      x[i * count + k] = X[i * count + k] + 0.03 * sin(phase);
      rate[i * count + k] = 0.03 * cos(phase);
    }
  return 0;
}

int plane_bump(int64_t count, const double *x, double *u, double *u_x, double *u_t,
               double *velocity, void *user)
{
  const double speed = *(const double *)user;
  for (int64_t k = 0; k < count; k++) {
    const double a = 2 * pi * x[k], b = 2 * pi * (x[k] + x[count + k]);
    u[k] = 0.1 * (sin(a) + 0.5 * cos(b));
    u_x[k] = 0.2 * pi * (cos(a) - 0.5 * sin(b));
    u_x[count + k] = -0.1 * pi * sin(b);
    u_t[k] = -0.1 * cos(a);
    velocity[k] = speed;
    velocity[count + k] = 0.3 * speed;
  }
  return 0;
}

/* ---- a kink along the diagonal ---- */

double plane_kink_value(const plane_kink *k, double t, const double *x)
{
  const double at = (x[0] + x[1]) / sqrt(2) - k->v * t, turn = round(at / k->period);
  const double g = 1 / sqrt(1 - k->v * k->v);
  return 4 * atan(exp(g * (at - turn * k->period))) + 2 * pi * turn;
}

int plane_kink_wave(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                    double *velocity, void *user)
{
  const plane_kink *k = user;
  const double g = 1 / sqrt(1 - k->v * k->v);
  for (int64_t i = 0; i < count; i++) {
    const double place[2] = {x[i], x[count + i]}, at = (place[0] + place[1]) / sqrt(2);
    u[i] = plane_kink_value(k, 0, place);
    const double slope = 2 * g / cosh(g * (at - k->period * round(at / k->period)));
    u_t[i] = -k->v * slope;
    u_x[i] = u_x[count + i] = slope / sqrt(2);
    velocity[i] = velocity[count + i] = k->v / sqrt(2);
  }
  return 0;
}

/* The integral of the monitor 1 + u_n, whose mean is m = 1 + 2 pi/period up to the tails, is
 * s + u(s) along n. A point goes to the s where it is m times its place. */
void grade_for_kink(double *point, void *user)
{
  const plane_kink *k = user;
  const double at = (point[0] + point[1]) / sqrt(2);
  double low = at - k->period, high = at + k->period;
  for (int i = 0; i < 60; i++) {
    const double s = (low + high) / 2, place[2] = {s * sqrt(0.5), s * sqrt(0.5)};
    if (s + plane_kink_value(k, 0, place) - pi < (1 + 2 * pi / k->period) * at)
      low = s;
    else
      high = s;
  }
  const double shift = ((low + high) / 2 - at) / sqrt(2);
  point[0] += shift;
  point[1] += shift;
}
