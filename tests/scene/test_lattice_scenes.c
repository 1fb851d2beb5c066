/* Multisymplectic steps of scenes whose start is a known motion, which gives both first levels. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 1024, VERTICES_MOST = 1700 };

static const double pi = 3.14159265358979323846;

#define SCALAR "fields: {u: scalar}\n"
#define SINE_GORDON "density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))\n"

/* Gives the march of a scene's method, and its step. */
static dvi_march *march_of(const char *text, double *step)
{
  dvi_march *march = NULL;
  dvi_march_facts facts;
  ck_assert_msg(parse_scene(text) == DVI_OK, "%s: %s", text, message);
  const dvi_scene_plan *plan = dvi_scene_plan_of(scene);
  const dvi_march_options options = {
      .size = sizeof options, .method = plan->method, .step = plan->h};
  ck_assert_msg(dvi_scene_march_create(scene, &options, &march) == DVI_OK, "%s", dvi_last_error());
  dvi_march_facts_of(march, &facts);
  *step = facts.step;
  return march;
}

/* Gives the values after some steps. */
static void values_after(dvi_march *march, double step, int steps, double *u)
{
  ck_assert_int_le(dvi_march_size(march, DVI_FORM_A), VERTICES_MOST);
  ck_assert_int_eq(dvi_march_advance(march, steps * step), DVI_OK);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u), DVI_OK);
}

/* ---- plane and standing waves ---- */

/* The frequencies are the solutions of s_at(omega dt)/dt^2 = s_ax(k dx)/dx^2, with s_a(th) =
 * 4 sin^2(th/2)/(1 - 4 a sin^2(th/2)), for k = 3 and dx = pi/10. The box scheme needs an odd number
 * of periodic cells, and stands between fixed ends instead. */
static const struct {
  const char *weights;
  double space, time, ratio, omega;
  int stands;
} waves[] = {{"space=0,time=0", 0, 0, .9, 2.977331178366868, 0},
             {"space=1/6,time=1/6", 1. / 6, 1. / 6, .9, 3.019550053106444, 0},
             {"space=1/12,time=1/12", 1. / 12, 1. / 12, .9, 2.998217003350727, 0},
             {"space=1/4,time=1/4", 1. / 4, 1. / 4, 3, 2.103968441015779, 1},
             {"space=1/6,time=1/4", 1. / 6, 1. / 4, 2, 2.463991275398103, 0}};

enum { WAVES = sizeof waves / sizeof *waves, CELLS = 20 };

static dvi_march *march_of_wave(int i, double *step)
{
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 "parameters: {omega: %.17g}\ndomain: {x: [0, 2*pi]}\n"
                 "space: fem:degree=1,cells=20\n" SCALAR "density: (u'^2 - d(u,x)^2)/2\n"
                 "boundary: %s\ninitial: {u: %s}\nmethod: multisymplectic:%s\nstep: %g*pi/10\n"
                 "until: 1\n",
                 waves[i].omega, waves[i].stands ? "fixed" : "periodic",
                 waves[i].stands ? "sin(3*x)*cos(omega*t)" : "cos(3*x - omega*t)", waves[i].weights,
                 waves[i].ratio);
  return march_of(text, step);
}

/* The rest of the equation of a vertex, M (u+ - 2 u + u-)/dt^2 + K (a u+ + (1 - 2 a) u + a u-) with
 * the mass and the stiffness of the weights, beside the sizes of its terms. */
static double residual(int i, double step, const double *const u[3])
{
  const double dx = pi / 10, a = waves[i].space, b = waves[i].time,
               terms = 4 / (step * step) + 4 / (dx * dx);
  const int last = waves[i].stands ? CELLS - 1 : CELLS;
  double largest = 0;
  for (int k = waves[i].stands; k <= last - !waves[i].stands; k++) {
    const int at[3] = {waves[i].stands ? k - 1 : (k + CELLS - 1) % CELLS, k,
                       waves[i].stands ? k + 1 : (k + 1) % CELLS};
    double force[3], mean[3];
    for (int s = 0; s < 3; s++) {
      force[s] = (u[0][at[s]] - 2 * u[1][at[s]] + u[2][at[s]]) / (step * step);
      mean[s] = b * u[0][at[s]] + (1 - 2 * b) * u[1][at[s]] + b * u[2][at[s]];
    }
    const double rest = a * force[0] + (1 - 2 * a) * force[1] + a * force[2] -
                        (mean[0] - 2 * mean[1] + mean[2]) / (dx * dx);
    largest = fmax(largest, fabs(rest));
  }
  return largest / terms;
}

/* Adds to the sums by which levels have their frequency, (u+ + u-)/2 = cos(omega dt) u. */
static void add_angle(const double *const u[3], double *product, double *square)
{
  for (int k = 0; k < CELLS; k++) {
    *product += u[1][k] * (u[0][k] + u[2][k]) / 2;
    *square += u[1][k] * u[1][k];
  }
}

/* The rests of the equations are roundings of nine values and of the solution of a matrix. */
START_TEST(plane_waves_from_exact_levels_keep_their_frequency)
{
  enum { STEPS = 60 };
  double u[STEPS + 1][CELLS + 1], step, product = 0, square = 0;
  dvi_march *march = march_of_wave(_i, &step);
  for (int n = 0; n <= STEPS; n++) values_after(march, step, n, u[n]);
  for (int n = 1; n < STEPS; n++) {
    const double *const levels[] = {u[n - 1], u[n], u[n + 1]};
    ck_assert_double_le(residual(_i, step, levels), 2e-15);
    add_angle(levels, &product, &square);
  }
  ck_assert_double_eq_tol(acos(product / square) / step, waves[_i].omega, 1e-14);
  for (int k = 0; k < CELLS; k++) {
    const double x = k * pi / 10, phase = waves[_i].omega * STEPS * step;
    ck_assert_double_eq_tol(u[STEPS][k],
                            waves[_i].stands ? sin(3 * x) * cos(phase) : cos(3 * x - phase), 1e-12);
  }
  dvi_march_destroy(&march);
}
END_TEST

static double symbol(double a, double theta)
{
  const double s = pow(sin(theta / 2), 2);
  return 4 * s / (1 - 4 * a * s);
}

/* The axes have weights of their own, and their symbols add. */
START_TEST(axes_have_weights_of_their_own)
{
  static const char *const spelled[] = {"space=1/6:0", "space=0:fourth,time=1/6"};
  static const double space[][2] = {{1. / 6, 0}, {0, 1. / 12}}, time[] = {0, 1. / 6};
  const double dx = 2 * pi / 12, dt = dx / 2,
               s = symbol(space[_i][0], 2 * dx) + symbol(space[_i][1], dx),
               sum = s * (dt * dt) / (dx * dx),
               omega = 2 * asin(sqrt(sum / (4 + 4 * time[_i] * sum))) / dt;
  double step, u[144], largest = 0;
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 "parameters: {omega: %.17g}\ndomain: {x: [0, 2*pi], y: [0, 2*pi]}\n"
                 "space: fem:degree=1,cells=12\n" SCALAR
                 "density: (u'^2 - d(u,x)^2 - d(u,y)^2)/2\nboundary: periodic\n"
                 "initial: {u: cos(2*x + y - omega*t)}\nmethod: multisymplectic:%s\n"
                 "step: pi/12\nuntil: 1\n",
                 omega, spelled[_i]);
  dvi_march *march = march_of(text, &step);
  values_after(march, step, 20, u);
  for (int i = 0; i < 12; i++)
    for (int k = 0; k < 12; k++)
      largest = fmax(largest, fabs(u[12 * i + k] - cos(2 * i * dx + k * dx - omega * 20 * step)));
  ck_assert_double_lt(largest, 1e-13);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- a start that moves ---- */

/* For other methods it has the rate of the field at t = 0, and so on meshes that move. */
START_TEST(a_start_that_depends_on_time_has_its_rate)
{
  static const char *const kind[] = {"", "moving: {mu: 0.1, kappa: 0.1}\n"};
  static const char *const start[] = {"sin(x) + 2*t*cos(x) + t^2", "sin(x)", "2*cos(x)"};
  char text[2][TEXT_SIZE];
  for (int k = 0; k < 2; k++)
    (void)snprintf(text[k], sizeof text[k],
                   "domain: {x: [0, 2*pi]}\nspace: fem:degree=1,cells=8\nfields: {u: scalar, w: "
                   "scalar}\ndensity: (u'^2 + w'^2 - d(u,x)^2 - d(w,x)^2)/2 - (1 - cos(u - w))\n"
                   "boundary: periodic\n%sinitial: {u: %s, w: cos(x)%s%s}\nmethod: midpoint\nstep: "
                   "0.1\nuntil: 1\n",
                   kind[_i], start[k], k == 1 ? ", u': " : "", k == 1 ? start[2] : "");
  double first[2][64];
  const double *q, *v, *p;
  (void)open_scene(text[0]);
  dvi_scene_start(scene, &q, &v, &p);
  const int n = dvi_system_nq(dvi_scene_system(scene));
  ck_assert_int_le(n, 64);
  memcpy(first[0], q, (size_t)n * sizeof *q);
  memcpy(first[1], v, (size_t)n * sizeof *v);
  (void)open_scene(text[1]);
  dvi_scene_start(scene, &q, &v, &p);
  for (int i = 0; i < n; i++) {
    ck_assert_double_eq_tol(q[i], first[0][i], 1e-15);
    ck_assert_double_eq_tol(v[i], first[1][i], 1e-15);
  }
}
END_TEST

START_TEST(rates_beside_such_a_start_are_refused)
{
  check_refused("domain: {x: [0, 2*pi]}\nspace: fem:degree=1,cells=8\n" SCALAR SINE_GORDON
                "initial: {u: sin(x - t), u': cos(x)}\nmethod: verlet\nstep: 0.1\nuntil: 1\n",
                DVI_BAD_FILE,
                ":5:26:", "a start that depends on t has rates; leave out the key u'");
}
END_TEST

/* ---- nonlinear waves ---- */

/* From levels that are exact, with 4/dt = round(8/dx) steps. The numbers are those of a program in
 * numpy. The trapezoidal rule is explicit and Gauss's is implicit. */
START_TEST(breathers_have_known_errors)
{
  static const struct {
    const char *weights;
    int cells;
    double error;
  } known[] = {{"space=0,time=0", 101, 5.55e-2},         {"space=0,time=0", 201, 1.43e-2},
               {"space=0,time=0", 401, 3.59e-3},         {"space=exact,time=exact", 101, .127},
               {"space=exact,time=exact", 201, 3.14e-2}, {"space=exact,time=exact", 401, 7.86e-3}};
  const int cells = known[_i].cells, steps = (int)round(8 / (40.0 / cells));
  const double g = sqrt(.75);
  double step, u[401], error = 0;
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 "parameters: {w: 0.5, g: sqrt(1 - w^2)}\ndomain: {x: [-20, 20]}\n"
                 "space: fem:degree=1,cells=%d\n" SCALAR SINE_GORDON "boundary: periodic\n"
                 "initial: {u: 4*atan(g/w*sin(w*t)/cosh(g*x))}\nmethod: multisymplectic:%s\n"
                 "step: 4/%d\nuntil: 4\n",
                 cells, known[_i].weights, steps);
  dvi_march *march = march_of(text, &step);
  values_after(march, step, steps, u);
  for (int i = 0; i < cells; i++) {
    const double x = -20 + 40.0 * i / cells;
    error = fmax(error, fabs(u[i] - 4 * atan(g / .5 * sin(2) / cosh(g * x))));
  }
  ck_assert_double_eq_tol(error, known[_i].error, .005 * known[_i].error);
  dvi_march_destroy(&march);
}
END_TEST

/* u(3, 0, 0) of sine-Gordon on a torus is known from a spectral solution. Errors of symmetric steps
 * are series in h^2, of which two extrapolations leave the sixth order. */
START_TEST(sine_gordon_on_a_torus_has_its_known_value)
{
  const double exact = -.80444209124;
  double found[3];
  for (int k = 0; k < 3; k++) {
    char text[TEXT_SIZE];
    double step, u[VERTICES_MOST];
    (void)snprintf(text, sizeof text,
                   "domain: {x: [0, 2*pi], y: [0, 2*pi]}\nspace: fem:degree=1,cells=%d\n" SCALAR
                   "density: (u'^2 - d(u,x)^2 - d(u,y)^2)/2 - (1 - cos(u))\nboundary: periodic\n"
                   "initial: {u: 1 + 0.5*cos(x)*cos(y), u': 0.3*sin(x + y)}\n"
                   "method: multisymplectic\nstep: 3/%d\nuntil: 3\n",
                   10 << k, 10 << k);
    dvi_march *march = march_of(text, &step);
    values_after(march, step, 10 << k, u);
    found[k] = u[0];
    dvi_march_destroy(&march);
  }
  ck_assert_double_eq_tol((found[1] - exact) / (found[2] - exact), 4, 0.2);
  const double coarse = (4 * found[1] - found[0]) / 3, fine = (4 * found[2] - found[1]) / 3;
  ck_assert_double_eq_tol((16 * fine - coarse) / 15, exact, 1e-5);
}
END_TEST

/* phi^4: a kink with the speed 1/2 has the energy 2 sqrt2 gamma/3, with an error of order 2. */
START_TEST(kinks_have_their_energy)
{
  const double exact = 2 * sqrt(2) / 3 / sqrt(.75);
  double before = 0;
  for (int cells = 200; cells <= 800; cells *= 2) {
    char text[TEXT_SIZE];
    double step, energy;
    (void)snprintf(text, sizeof text,
                   "parameters: {v: 0.5, g: 1/sqrt(1 - v^2)}\ndomain: {x: [-20, 20]}\n"
                   "space: fem:degree=1,cells=%d\n" SCALAR
                   "density: u'^2/2 - d(u,x)^2/2 - (u^2 - 1)^2/4\n"
                   "initial: {u: tanh(g*(x - v*t)/sqrt(2))}\nmethod: multisymplectic%s\n"
                   "step: 20/%d\nuntil: 5\n",
                   cells, _i == 0 ? "" : ":space=1/6,time=1/4", cells);
    dvi_march *march = march_of(text, &step);
    ck_assert_int_eq(dvi_march_advance(march, 5), DVI_OK);
    ck_assert_int_eq(dvi_march_observe(march, 0, &energy), DVI_OK);
    const double error = fabs(energy - exact);
    if (before > 0) ck_assert_double_eq_tol(log2(before / error), 2, 0.1);
    before = error;
    dvi_march_destroy(&march);
  }
  ck_assert_double_lt(before, 1e-3);
}
END_TEST

SUITE(lattice_scenes)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_loop_test(tests, plane_waves_from_exact_levels_keep_their_frequency, 0, WAVES);
  tcase_add_loop_test(tests, axes_have_weights_of_their_own, 0, 2);
  tcase_add_loop_test(tests, a_start_that_depends_on_time_has_its_rate, 0, 2);
  tcase_add_test(tests, rates_beside_such_a_start_are_refused);
  tcase_add_loop_test(tests, breathers_have_known_errors, 0, 6);
  tcase_add_test(tests, sine_gordon_on_a_torus_has_its_known_value);
  tcase_add_loop_test(tests, kinks_have_their_energy, 0, 2);
}
