/* Scenes of fields with a density are those fields: their parts are found, their derivatives right,
 * and their motions the known ones. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/field/densities.h"
#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 2048, UNKNOWNS_MOST = 400 };

static const double pi = 3.14159265358979323846;

#define CIRCLE "domain: {x: [0, 2*pi]}\nboundary: periodic\n"
#define SCALAR "fields: {u: scalar}\n"
#define SINE_GORDON "density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))\n"
#define START "initial: {u: 1.5 + 0.5*cos(x), u': 0.3*sin(x)}\n"

static const char *const kinds[] = {"fem:degree=2,cells=9", "fem:degree=2,cells=9,lumped=yes",
                                    "spline:degree=3,cells=12", "fourier:modes=5"};
enum { KINDS = sizeof kinds / sizeof *kinds };

static const char *with_space(const char *kind, const char *rest)
{
  static char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text, "space: %s\n%s", kind, rest);
  return text;
}

/* Numbers from -0.5 to 0.5 that look random. */
static void draw(int count, double *x)
{
  for (int i = 0; i < count; i++) x[i] = 0.5 * sin(1.0 + 12.9898 * (i + 1) * (i + 2));
}

/* Requires that all callbacks of the scene agree with differences. */
static void check_system(const char *text)
{
  double q[UNKNOWNS_MOST], v[UNKNOWNS_MOST];
  const dvi_system *system = open_scene(text);
  const int n = dvi_system_nq(system);
  ck_assert_int_le(n, UNKNOWNS_MOST);
  draw(n, q);
  draw(n, v);
  ck_assert_msg(dvi_system_check(system, 0.3, q, v, 1e-6, NULL) == DVI_OK, "%s: %s", text,
                dvi_last_error());
}

/* Runs the scene's method to its end, and gives the watched numbers there. */
static void run_scene(const char *text, double *value)
{
  const double *q, *v, *p;
  const dvi_system *system = open_scene(text);
  const dvi_scene_plan *plan = dvi_scene_plan_of(scene);
  dvi_integrator *integrator = NULL;
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_msg(dvi_integrator_create(system, plan->method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_msg(dvi_run(integrator, &(dvi_run_options){.h = plan->h, .t_end = plan->t_end}, NULL) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_invariants(system, dvi_integrator_time(integrator),
                                         dvi_integrator_q(integrator), dvi_integrator_p(integrator),
                                         value),
                   DVI_OK);
  dvi_integrator_destroy(&integrator);
}

static void requires_near(double value, double right, double tolerance)
{
  ck_assert_msg(fabs(value - right) <= tolerance, "%.15g, not %.15g", value, right);
}

/* Returns the place of a watched number of the scene. */
static int watched(const char *name)
{
  const dvi_system *system = dvi_scene_system(scene);
  for (int i = 0; i < dvi_system_invariant_count(system); i++)
    if (strcmp(dvi_system_invariant_name(system, i), name) == 0) return i;
  ck_abort_msg("nothing watched is called %s", name);
  return -1;
}

/* ---- structure ---- */

START_TEST(the_parts_of_a_density_are_found)
{
  static const struct {
    const char *density, *form;
    int potentials, quadratic;
  } list[] = {
      {"u'^2/2 - d(u,x)^2/2 - (1 - cos(u))", "separable", 2, 1},
      {"(1 + 0.1*sin(x))*(u'^2 - d(u,x)^2)/2 - u*sin(t)", "separable", 1, 1},
      {"u'^2/2 + d(u',x)^2/6 - d(u,x)^2/2 - sin(t)*u^2", "separable", 2, 1},
      {"0.5*(u' + d(u,x))*(u' - d(u,x)) - u^4/4", "general Lagrangian", 1, 0},
      {"(1 + u^2)*u'^2/2 - d(u,x)^2/2", "general Lagrangian", 1, 1},
      {"u'^2/2 + 0.1*u'*d(u,x) - d(u,x)^2/2", "general Lagrangian", 1, 1},
      {"d(u,x)*u'/2 + d(u,x)^3 - d(u,x,x)^2/2", "one-form", 2, 1},
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    char text[TEXT_SIZE];
    dvi_scene_facts facts;
    (void)snprintf(text, sizeof text, CIRCLE SCALAR "space: spline:degree=3,cells=9\ndensity: %s\n",
                   list[i].density);
    check_system(text);
    dvi_scene_facts_of(scene, &facts);
    ck_assert_str_eq(facts.form, list[i].form);
    if (strcmp(facts.form, "general Lagrangian") != 0)
      ck_assert_int_eq(dvi_scene_terms(scene)->potential_count, list[i].potentials);
    ck_assert_int_eq(facts.quadratic_potentials, list[i].quadratic);
  }
}
END_TEST

START_TEST(callbacks_agree_with_differences_on_all_spaces)
{
  for (int k = 0; k < KINDS; k++) check_system(with_space(kinds[k], CIRCLE SCALAR SINE_GORDON));
}
END_TEST

START_TEST(callbacks_agree_with_differences_in_the_plane)
{
  check_system("domain: {x: [0, 1], y: [-1, 1]}\nspace: fem:degree=2,cells=2\n" SCALAR
               "boundary: {x: periodic, y: fixed}\n"
               "density: u'^2/2 - dot(grad(u), grad(u))/2 - x*y*u - u^4/4\n");
  check_system("domain: {x: [0, 1], y: [0, 1]}\nspace: {x: 'fourier:modes=2', y: "
               "'fourier:modes=1'}\n" SCALAR
               "boundary: periodic\ndensity: u'^2/2 - d(u,x)^2/2 - d(u,y)^2/2 + cos(u)\n");
}
END_TEST

START_TEST(callbacks_agree_with_differences_on_meshes)
{
  check_system("mesh: {generator: disk, cells: 2}\nspace: fem:degree=2\n" SCALAR
               "boundary: {rim: {fixed: x*sin(t)}}\n"
               "density: u'^2/2 - dot(grad(u), grad(u))/2 - u^4/4\n");
}
END_TEST

START_TEST(callbacks_agree_with_differences_with_several_fields)
{
  check_system("domain: {x: [0, 1]}\nspace: fem:degree=2,cells=5\n"
               "fields: {u: scalar, w: vector(2), psi: complex}\n"
               "definitions: {strain: 'd(w,x)', n: 'dot(psi, psi)'}\n"
               "boundary:\n  left: {u: fixed, w: {fixed: '[t^2, x]'}, psi: fixed}\n"
               "  right: {robin: 2}\n"
               "density: u'^2/2 + dot(w',w')/2 + dot(psi',psi')/2 - d(u,x)^2/2 - dot(strain, "
               "strain)/2 - u*w[1]*w[2] - exp(-n) - re(psi)*d(im(psi),x)\n");
}
END_TEST

/* Parts without second derivatives are loads, and kinks but for their points. */
START_TEST(parts_may_be_linear)
{
  static const char *const linear[] = {"density: u'^2/2 + cos(t)*x*u\n",
                                       "density: u'^2/2 - d(u,x)^2/2 - abs(u)\n",
                                       "density: u'^2/2 + u'^4 + sin(x)*u\n"};
  for (int i = 0; i < KINDS; i++)
    for (int k = 0; k < 3; k++) {
      char text[TEXT_SIZE];
      (void)snprintf(text, sizeof text, "space: %s\n%s%s%s", kinds[i], CIRCLE, SCALAR, linear[k]);
      check_system(text);
    }
}
END_TEST

/* The kernels of a scene and callbacks written by hand differ by the order of roundings alone. */
START_TEST(a_scene_is_the_field_that_a_program_declares)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  for (int k = 0; k < KINDS; k++) {
    double q[UNKNOWNS_MOST], p[UNKNOWNS_MOST], v[2][UNKNOWNS_MOST], L[2];
    const dvi_system *system = open_scene(with_space(kinds[k], CIRCLE SCALAR SINE_GORDON));
    density_field field = make_density(make_density_space(kinds[k], 1, 0, 2 * pi, 1), parts, 3,
                                       NULL, 0);
    const dvi_system *const both[] = {system, field.system};
    const int n = dvi_system_nq(system);
    ck_assert_int_eq(n, dvi_system_nq(field.system));
    draw(n, q);
    draw(n, p);
    for (int i = 0; i < 2; i++) {
      ck_assert_int_eq(dvi_system_velocity(both[i], 0, q, p, v[i]), DVI_OK);
      ck_assert_int_eq(dvi_system_lagrangian(both[i], 0, q, v[i], &L[i]), DVI_OK);
    }
    for (int i = 0; i < n; i++) requires_near(v[0][i], v[1][i], 1e-13 * (1 + fabs(v[1][i])));
    requires_near(L[0], L[1], 1e-13 * (1 + fabs(L[1])));
    end_density(&field);
  }
}
END_TEST

/* ---- motions ---- */

/* u(0,4) of 12 modes and 16 stages of Gauss' method, to 12 digits. Its functions are those of the
 * first scene. Elements of third order come as near as their h^4 lets them. */
START_TEST(sine_gordon_waves_are_the_known_ones)
{
  static const struct {
    const char *kind;
    double tolerance;
  } list[] = {{"fourier:modes=12", 1e-10},
              {"spline:degree=3,cells=40", 1e-6},
              {"fem:degree=3,cells=20", 1e-5},
              {"fem:degree=3,cells=20,lumped=yes", 1e-5}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    double value[8];
    run_scene(with_space(list[i].kind, CIRCLE SCALAR SINE_GORDON START
                         "probes: {ear: u(0)}\nmethod: galerkin:degree=6\nstep: 0.1\nuntil: 4\n"),
              value);
    requires_near(value[watched("ear")], -1.445122382059, list[i].tolerance);
  }
}
END_TEST

/* With more than 4 times as many points as modes momentum is kept to roundoff, and with 17 for 8
 * modes it is not. */
START_TEST(points_enough_keep_the_momentum_of_a_polynomial)
{
  static const char scene_text[] = CIRCLE SCALAR
      "density: u'^2/2 - d(u,x)^2/2 - (u^2 - 1)^2/4\n"
      "initial: {u: cos(x) + 0.7*sin(2*x) + 0.4*cos(5*x), u': sin(3*x) + cos(5*x)}\n"
      "method: midpoint\nstep: 0.05\nuntil: 10\n";
  double first[8], value[8], drift[2];
  static const char *const kind[] = {"fourier:modes=8", "fourier:modes=8,points=17"};
  for (int k = 0; k < 2; k++) {
    const double *q, *v, *p;
    run_scene(with_space(kind[k], scene_text), value);
    dvi_scene_start(scene, &q, &v, &p);
    ck_assert_int_eq(dvi_system_invariants(dvi_scene_system(scene), 0, q, p, first), DVI_OK);
    drift[k] = fabs(value[watched("momentum_x")] - first[watched("momentum_x")]);
  }
  ck_assert_msg(drift[0] < 1e-12, "%g", drift[0]);
  ck_assert_msg(drift[1] > 1e-8, "%g", drift[1]);
}
END_TEST

/* What varies along y leaves the momentum along x. */
START_TEST(a_coefficient_takes_the_momentum_of_its_own_axis_alone)
{
  double first[8], value[8];
  const double *q, *v, *p;
  run_scene("domain: {x: [0, 2*pi], y: [0, 2*pi]}\n"
            "space: {x: fourier:modes=3, y: fourier:modes=2}\nboundary: periodic\n" SCALAR
            "density: u'^2/2 - d(u,x)^2/2 - (1 + 0.3*cos(y))*d(u,y)^2/2 - u^4/4\n"
            "initial: {u: 0.5*cos(x) + 0.3*sin(x + y), u': 0.2*sin(x)}\n"
            "method: midpoint\nstep: 0.05\nuntil: 1\n",
            value);
  ck_assert_int_eq(dvi_system_invariant_count(dvi_scene_system(scene)), 2);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_invariants(dvi_scene_system(scene), 0, q, p, first), DVI_OK);
  requires_near(value[watched("momentum_x")], first[watched("momentum_x")], 1e-13);
}
END_TEST

/* u = sin(t - x) moves both ends. The error of elements of second order falls by 8 when the cells
 * are halved, here below the one of the method. */
START_TEST(ends_that_move_carry_a_wave)
{
  double value[2][8];
  for (int k = 0; k < 2; k++) {
    char text[TEXT_SIZE];
    (void)snprintf(text, sizeof text,
                   "domain: {x: [0, 1]}\nspace: fem:degree=2,cells=%d\n" SCALAR
                   "density: u'^2/2 - d(u,x)^2/2\n"
                   "boundary: {left: {fixed: sin(t)}, right: {fixed: sin(t - x)}}\n"
                   "initial: {u: sin(-x), u': cos(x)}\n"
                   "probes: {square: {integral: (u - sin(t - x))^2}, rate: {integral: u'}}\n"
                   "method: galerkin:degree=4\nstep: 0.05\nuntil: 2\n",
                   4 << k);
    run_scene(text, value[k]);
  }
  const int place = watched("square");
  const double order = log2(sqrt(value[0][place] / value[1][place]));
  ck_assert_msg(order > 2.8, "order %.2f", order);
  ck_assert_msg(sqrt(value[1][place]) < 1e-4, "%g", sqrt(value[1][place]));
  requires_near(value[1][watched("rate")], sin(2) - sin(1), 1e-4);
}
END_TEST

/* ---- Schroedinger's equation ---- */

#define PLANE_WAVE                                                                 \
  "parameters: {k: 2, a: 0.7, beta: 1.5}\n" CIRCLE                                 \
  "space: fourier:modes=6\ninitial: {psi: \"[a*cos(k*x), a*sin(k*x)]\"}\n"         \
  "probes: {re: {of: re(psi), at: 0}, im: {of: im(psi), at: 0}, norm: {integral: " \
  "\"dot(psi,psi)\"}}\nmethod: vprk:nodes=3\nstep: 0.05\nuntil: 2\n"

/* psi = a exp(i (k x - w t)) with w = hbar k^2/(2 m) + (V + beta a^2)/hbar. */
static void check_plane_wave(const char *density, double omega, double energy)
{
  double value[8];
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text, PLANE_WAVE "%s", density);
  run_scene(text, value);
  requires_near(value[watched("re")], 0.7 * cos(omega * 2), 1e-9);
  requires_near(value[watched("im")], -0.7 * sin(omega * 2), 1e-9);
  requires_near(value[watched("norm")], 2 * pi * 0.49, 1e-11);
  requires_near(value[watched("energy")], energy, 1e-9);
}

START_TEST(the_short_form_moves_plane_waves)
{
  const double n = 0.49, length = 2 * pi;
  check_plane_wave("schroedinger: {interaction: beta}\n", 2 + 1.5 * n,
                   length * (2 * n + 0.75 * n * n));
  check_plane_wave("schroedinger: {interaction: beta, potential: 0.5, hbar: 2, mass: 4}\n",
                   2 * 4 / 8.0 + (0.5 + 1.5 * n) / 2,
                   length * (4 * 4 / 8.0 * n + 0.5 * n + 0.75 * n * n));
}
END_TEST

START_TEST(the_short_form_is_a_density)
{
  check_plane_wave("fields: {psi: complex}\ndefinitions: {n: \"dot(psi,psi)\"}\n"
                   "density: im(psi)*re(psi)' - re(psi)*im(psi)' - dot(d(psi,x), d(psi,x))/2 - "
                   "beta/2*n^2\n",
                   2 + 1.5 * 0.49, 2 * pi * (2 * 0.49 + 0.75 * 0.49 * 0.49));
}
END_TEST

/* A soliton of Korteweg and de Vries' equation u' = D grad H, with the central difference D and H
 * = sum h ((u_{i+1} - u_i)^2/(2 h^2) - u_i^3), by the midpoint rule. w is u at every second
 * point, and differences of phi are u between them. The error is that of a program in numpy, in
 * L2. */
START_TEST(central_differences_move_a_soliton_with_their_error)
{
  double first[8], last[8];
  const double *q, *v, *p;
  run_scene("parameters: {N: 200, L: 20, c: 4, place: 8, h: L/N, K: N/2}\n"
            "coordinates: {'phi[K]': scalar, 'w[K]': scalar}\n"
            "definitions: {m: 'sum(j=1..K, c/2/cosh(sqrt(c)/2*((2*j - 1)*h - place))^2)/K'}\n"
            "one_form: {'phi[i]': 'h*w[i]'}\n"
            "hamiltonian: 'sum(j=1..K, h*(((m + (phi[if(j < K, j + 1, 1)] - phi[j])/(2*h) - "
            "w[j])/h)^2/2 + ((w[if(j < K, j + 1, 1)] - m - (phi[if(j < K, j + 1, 1)] - "
            "phi[j])/(2*h))/h)^2/2 - w[j]^3 - (m + (phi[if(j < K, j + 1, 1)] - "
            "phi[j])/(2*h))^3))'\n"
            "initial:\n"
            "  phi[i]: '2*h*(sum(j=1..K, if(j < i, c/2/cosh(sqrt(c)/2*((2*j - 1)*h - place))^2, "
            "0)) - (i - 1)*m)'\n"
            "  w[i]: c/2/cosh(sqrt(c)/2*((2*i - 2)*h - place))^2\n"
            "invariants:\n"
            "  mass: 'h*sum(j=1..K, w[j] + m + (phi[if(j < K, j + 1, 1)] - phi[j])/(2*h))'\n"
            "  error: 'sum(j=1..K, h*(w[j] - c/2/cosh(sqrt(c)/2*((2*j - 2)*h - place - c*t))^2)^2 "
            "+ h*(m + (phi[if(j < K, j + 1, 1)] - phi[j])/(2*h) - c/2/cosh(sqrt(c)/2*((2*j - 1)*h "
            "- place - c*t))^2)^2)'\n"
            "method: vprk:nodes=1\nstep: 0.01\nuntil: 0.5\n",
            last);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_invariants(dvi_scene_system(scene), 0, q, p, first), DVI_OK);
  const int mass = watched("mass"), error = watched("error");
  requires_near(first[error], 0, 1e-25);
  requires_near(sqrt(last[error]), 8.647e-3, 5e-7);
  requires_near(last[mass], first[mass], 4e-15); /* some roundings of a sum of about 4 */
}
END_TEST

/* The same in canonical form, with p = h w. Far from the soliton p is as small as e^-24, and
 * roundings of the forces h/dx^3 are not small beside it. The error is that of vprk:nodes=1. */
START_TEST(small_momenta_beside_stiff_forces_are_no_obstacle)
{
  double last[8];
  run_scene("parameters: {N: 60, L: 20, c: 4, place: 8, h: L/N, K: N/2}\n"
            "coordinates: {'phi[K]': scalar}\n"
            "definitions:\n"
            "  all: 'sum(j=1..K, 2*h*c/2/cosh(sqrt(c)/2*((2*j - 1)*h - place))^2)'\n"
            "hamiltonian: 'sum(j=1..K, h*((((phi[if(j < K, j + 1, 1)] + if(j < K, 0, all) - "
            "phi[j])/(2*h) - p(phi[j])/h)/h)^2/2 + ((p(phi[if(j < K, j + 1, 1)])/h - (phi[if(j < "
            "K, j + 1, 1)] + if(j < K, 0, all) - phi[j])/(2*h))/h)^2/2 - (p(phi[j])/h)^3 - "
            "((phi[if(j < K, j + 1, 1)] + if(j < K, 0, all) - phi[j])/(2*h))^3))'\n"
            "initial:\n"
            "  phi[i]: 'sum(j=1..K, if(j < i, 2*h*c/2/cosh(sqrt(c)/2*((2*j - 1)*h - place))^2, "
            "0))'\n"
            "  p(phi[i]): 'h*c/2/cosh(sqrt(c)/2*((2*i - 2)*h - place))^2'\n"
            "invariants:\n"
            "  error: 'sum(j=1..K, h*(p(phi[j])/h - c/2/cosh(sqrt(c)/2*((2*j - 2)*h - place - "
            "c*t))^2)^2 + h*((phi[if(j < K, j + 1, 1)] + if(j < K, 0, all) - phi[j])/(2*h) - "
            "c/2/cosh(sqrt(c)/2*((2*j - 1)*h - place - c*t))^2)^2)'\n"
            "method: hamiltonian:degree=1\nstep: 0.01\nuntil: 0.5\n",
            last);
  requires_near(last[watched("error")], 0.00739546037180, 1e-12);
}
END_TEST

/* The lowest energies of the oscillator are hbar sqrt(k/m) (n + 1/2), here with sqrt(k/m) = 1/2. */
START_TEST(the_short_form_is_an_equation)
{
  double energy[2];
  (void)open_scene("domain: {x: [-12, 12]}\nspace: fem:degree=4,cells=40\nboundary: fixed\n"
                   "schroedinger: {potential: x^2/2, hbar: 0.5, mass: 4}\n");
  ck_assert_int_eq(dvi_schroedinger_modes(dvi_scene_schroedinger(scene), 2, energy, NULL), DVI_OK);
  requires_near(energy[0], 0.125, 1e-6);
  requires_near(energy[1], 0.375, 1e-5);
  (void)open_scene(CIRCLE SCALAR SINE_GORDON "space: fem:degree=1,cells=4\n");
  ck_assert_ptr_null(dvi_scene_schroedinger(scene));
}
END_TEST

/* ---- what is watched ---- */

START_TEST(probes_are_values_derivatives_and_integrals)
{
  double value[16];
  const double *q, *v, *p;
  const dvi_system *system = open_scene(
      CIRCLE SCALAR SINE_GORDON START
      "space: fourier:modes=6\nparameters: {at: 0.4}\n"
      "probes:\n  value: u(at)\n  slope: {of: 'd(u,x)', at: at}\n  rate: {of: u', at: 1}\n"
      "  mass: {integral: u}\n  moment: {integral: x*u^0}\n  current: {integral: \"-u'*d(u,x)\"}\n"
      "  power: {integral: \"u'^2/2 + d(u,x)^2/2 + 1 - cos(u)\"}\n");
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_invariants(system, 0, q, p, value), DVI_OK);
  requires_near(value[watched("value")], 1.5 + 0.5 * cos(0.4), 1e-13);
  requires_near(value[watched("slope")], -0.5 * sin(0.4), 1e-13);
  requires_near(value[watched("rate")], 0.3 * sin(1), 1e-13);
  requires_near(value[watched("mass")], 3 * pi, 1e-12);
  requires_near(value[watched("current")], 0.15 * pi, 1e-13);
  requires_near(value[watched("current")], value[watched("momentum_x")], 1e-13);
  requires_near(value[watched("power")], value[0], 1e-12);
}
END_TEST

START_TEST(unknowns_have_the_names_of_their_fields)
{
  (void)open_scene(CIRCLE SCALAR SINE_GORDON "space: fem:degree=1,cells=4\n");
  ck_assert_str_eq(dvi_scene_coordinate(scene, 3), "u_4");
  ck_assert_str_eq(dvi_scene_component(scene, 0), "u");
  ck_assert_ptr_null(dvi_scene_component(scene, 1));
  (void)open_scene("domain: {x: [0, 1]}\nspace: fem:degree=1,cells=4\nschroedinger: {}\n"
                   "boundary: fixed\n");
  ck_assert_str_eq(dvi_scene_coordinate(scene, 3), "psi_2_y");
  ck_assert_str_eq(dvi_scene_component(scene, 1), "psi_im");
}
END_TEST

START_TEST(fields_are_known_as_they_are_declared)
{
  dvi_scene_declared field;
  (void)open_scene("domain: {x: [0, 1], y: [0, 1]}\nspace: fem:degree=2,cells=4\n"
                   "fields: {u: scalar, psi: complex, w: vector(3)}\nboundary: fixed\n"
                   "density: u'^2/2 + dot(psi',psi')/2 + dot(w',w')/2\n");
  ck_assert(dvi_scene_declared_of(scene, 1, &field));
  ck_assert_str_eq(field.name, "psi");
  ck_assert_int_eq(field.first, 1);
  ck_assert_int_eq(field.components, 2);
  ck_assert(field.is_complex);
  ck_assert(dvi_scene_declared_of(scene, 2, &field));
  ck_assert_int_eq(field.first, 3);
  ck_assert_int_eq(field.components, 3);
  ck_assert(!field.is_complex);
  ck_assert(!dvi_scene_declared_of(scene, 3, &field));
  ck_assert(!dvi_scene_declared_of(NULL, 0, &field));
}
END_TEST

START_TEST(the_end_of_a_path_is_the_field_there)
{
  dvi_scene_end end;
  (void)open_scene("domain: {x: [0, 1]}\nspace: fem:degree=1,cells=4\nfields: {u: scalar}\n"
                   "boundary: fixed\ndensity: u'^2/2 - d(u,x)^2/2\nfinal: {u: x*(1 - x)}\n");
  ck_assert(dvi_scene_end_of(scene, &end));
  for (int i = 0; i < 3; i++) {
    const double x = 0.25 * (i + 1);
    ck_assert_double_eq_tol(end.q[i], x * (1 - x), 1e-16);
    ck_assert(!end.free_q[i]);
    ck_assert(end.free_p[i]);
  }
  (void)open_scene("domain: {x: [0, 1]}\nspace: fem:degree=1,cells=4\nfields: {u: scalar}\n"
                   "boundary: fixed\ndensity: u'^2/2 - d(u,x)^2/2\n");
  ck_assert(!dvi_scene_end_of(scene, &end));
}
END_TEST

START_TEST(a_domain_has_a_mesh_for_what_is_shown)
{
  (void)open_scene("domain: {x: [0, 1], y: [0, 1]}\nspace: fem:degree=2,cells=4\n"
                   "fields: {u: scalar}\nboundary: fixed\ndensity: u'^2/2\n");
  const dvi_mesh *mesh = dvi_scene_mesh(scene);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 81);
  ck_assert_ptr_eq(dvi_scene_mesh(scene), mesh);
}
END_TEST

START_TEST(a_step_is_a_fraction_of_the_largest_stable_one)
{
  double omega;
  (void)open_scene(CIRCLE SCALAR SINE_GORDON
                   "space: fem:degree=2,cells=9\nstep: {fraction: 0.5}\nuntil: 1\n");
  ck_assert_int_eq(dvi_density_fastest(dvi_scene_density(scene), &omega), DVI_OK);
  const double h = dvi_scene_plan_of(scene)->h;
  ck_assert_msg(h <= 1 / omega * (1 + 1e-12) && h > 0.8 / omega, "%g beside %g", h, 1 / omega);
}
END_TEST

/* Solves for the static state of a scene, and returns its first probe there. */
static double static_probe(const char *text)
{
  double U[UNKNOWNS_MOST], q[UNKNOWNS_MOST], value = 0;
  const double *start, *v, *p;
  ck_assert_msg(parse_scene(text) == DVI_OK, "%s", message);
  const dvi_density *density = dvi_scene_density(scene);
  dvi_scene_start(scene, &start, &v, &p);
  ck_assert_int_eq(dvi_density_lift(density, 0, start, U), DVI_OK);
  ck_assert_msg(dvi_density_solve(density, U, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_density_project(density, U, NULL, q, NULL, NULL), DVI_OK);
  const dvi_invariant *probe = dvi_scene_terms(scene)->invariants;
  ck_assert_int_eq(probe->value(0, q, NULL, &value, probe->user), 0);
  return value;
}

/* u is linear: its slope is the flux, less a u where there is a spring. */
START_TEST(conditions_hold_linear_fields)
{
  static const struct {
    const char *boundary;
    double value;
  } list[] = {{"{left: fixed, right: {fixed: 3*x}}", 1.5},
              {"{left: fixed, right: {free: 2}}", 1},
              {"{left: fixed, right: {robin: 3, free: 4}}", 0.5},
              {"{left: {u: {fixed: 1}}, right: {u: {robin: 1}}}", 0.75},
              {"{x: {fixed: 1 + x}}", 1.5}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    char text[TEXT_SIZE];
    (void)snprintf(text, sizeof text,
                   "domain: {x: [0, 1]}\nspace: fem:degree=1,cells=4\n" SCALAR
                   "density: -d(u,x)^2/2\nboundary: %s\nprobes: {middle: u(0.5)}\n",
                   list[i].boundary);
    requires_near(static_probe(text), list[i].value, 1e-13);
  }
  requires_near(static_probe("domain: {x: [0, 1], y: [0, 2]}\nspace: fem:degree=2,cells=2\n" SCALAR
                             "density: -dot(grad(u), grad(u))/2\n"
                             "boundary: {bottom: fixed, top: {fixed: 4}, x: periodic}\n"
                             "probes: {some: 'u(0.3, 0.7)'}\n"),
                1.4, 1e-13);
  requires_near(static_probe("mesh: {generator: kuhn, cells: [3, 3]}\n" SCALAR
                             "density: -dot(grad(u), grad(u))/2\n"
                             "boundary: {boundary: {fixed: x - 2*y}}\n"
                             "probes: {some: {of: u^2, at: [0.3, 0.7]}}\n"),
                1.21, 1e-12);
}
END_TEST

/* The force between the walls and a kink is e^{-2 sqrt(2) 10} = 5e-13 here, so that Newton's steps
 * are long where all forces are roundoff. */
START_TEST(a_kink_far_from_the_walls_is_static)
{
  requires_near(static_probe("domain: {x: [-10, 10]}\nspace: fem:degree=2,cells=60\n" SCALAR
                             "density: -d(u,x)^2/2 - (u^2 - 1)^2/4\n"
                             "boundary: {left: {fixed: -1}, right: {fixed: 1}}\n"
                             "initial: {u: tanh(x/2)}\nprobes: {slope: {of: 'd(u,x)', at: 0.1}}\n"),
                sqrt(0.5) / pow(cosh(0.1 * sqrt(0.5)), 2), 2e-3);
}
END_TEST

/* Half of the kink 4 atan(e^x) has the energy 4, less 16 e^-20 or so beyond its end at 10. */
START_TEST(a_static_state_needs_no_rates)
{
  requires_near(static_probe("domain: {x: [0, 10]}\nspace: fem:degree=3,cells=30\n" SCALAR
                             "density: -d(u,x)^2/2 - (1 - cos(u))\n"
                             "boundary: {x: {fixed: 4*atan(exp(x))}}\n"
                             "initial: {u: pi*(1 + tanh(x))}\n"
                             "probes: {half: {integral: 'd(u,x)^2/2 + 1 - cos(u)'}}\n"),
                4, 1e-6);
  ck_assert_ptr_null(dvi_scene_system(scene));
}
END_TEST

/* (a u')' = x^2 on [0,1] with u = 0 at both ends. The functions that solve (a phi')' = 0 are exact
 * at the ends of cells, if both integrals are (Leok 2004, sec. 5.7.1). The points resolve them to
 * more than 10 digits. */
START_TEST(multiscale_elements_have_the_coefficient_of_the_density)
{
  requires_near(static_probe("domain: {x: [0, 1]}\nspace: msfem:cells=8,fine=400\n" SCALAR
                             "definitions: {a: 10/(1 + 0.95*sin(2*pi*x/0.025))}\n"
                             "density: -a*d(u,x)^2/2 - x^2*u\nboundary: fixed\n"
                             "probes: {middle: u(0.5)}\n"),
                -3.598584209602927e-3, 1e-10);
}
END_TEST

/* The default of four modes is right for the fourth degree. One of the sixth takes more points. */
START_TEST(points_follow_the_degree_of_the_density)
{
  char text[TEXT_SIZE];
  (void)open_scene(CIRCLE SCALAR "space: fourier:modes=8\n"
                                 "density: u'^2/2 - d(u,x)^2/2 - u^6/6\n");
  ck_assert_int_gt((int)dvi_space_points(dvi_density_space(dvi_scene_density(scene)), NULL, NULL),
                   48);
  dvi_scene_density_explain(scene, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "polynomial of degree 6"));
  ck_assert_ptr_nonnull(strstr(text, "kept to roundoff"));
  (void)open_scene(CIRCLE SCALAR "space: fourier:modes=8,points=17\n"
                                 "density: u'^2/2 - d(u,x)^2/2 - u^4/4\n");
  dvi_scene_density_explain(scene, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "needs points=33, not 17"));
}
END_TEST

SUITE(density_scenes)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, the_parts_of_a_density_are_found);
  tcase_add_test(tests, callbacks_agree_with_differences_on_all_spaces);
  tcase_add_test(tests, callbacks_agree_with_differences_in_the_plane);
  tcase_add_test(tests, callbacks_agree_with_differences_on_meshes);
  tcase_add_test(tests, callbacks_agree_with_differences_with_several_fields);
  tcase_add_test(tests, parts_may_be_linear);
  tcase_add_test(tests, a_scene_is_the_field_that_a_program_declares);
  tcase_add_test(tests, sine_gordon_waves_are_the_known_ones);
  tcase_add_test(tests, points_enough_keep_the_momentum_of_a_polynomial);
  tcase_add_test(tests, a_coefficient_takes_the_momentum_of_its_own_axis_alone);
  tcase_add_test(tests, ends_that_move_carry_a_wave);
  tcase_add_test(tests, the_short_form_moves_plane_waves);
  tcase_add_test(tests, the_short_form_is_a_density);
  tcase_add_test(tests, central_differences_move_a_soliton_with_their_error);
  tcase_add_test(tests, small_momenta_beside_stiff_forces_are_no_obstacle);
  tcase_add_test(tests, the_short_form_is_an_equation);
  tcase_add_test(tests, probes_are_values_derivatives_and_integrals);
  tcase_add_test(tests, unknowns_have_the_names_of_their_fields);
  tcase_add_test(tests, fields_are_known_as_they_are_declared);
  tcase_add_test(tests, the_end_of_a_path_is_the_field_there);
  tcase_add_test(tests, a_domain_has_a_mesh_for_what_is_shown);
  tcase_add_test(tests, a_step_is_a_fraction_of_the_largest_stable_one);
  tcase_add_test(tests, conditions_hold_linear_fields);
  tcase_add_test(tests, a_static_state_needs_no_rates);
  tcase_add_test(tests, a_kink_far_from_the_walls_is_static);
  tcase_add_test(tests, multiscale_elements_have_the_coefficient_of_the_density);
  tcase_add_test(tests, points_follow_the_degree_of_the_density);
}
