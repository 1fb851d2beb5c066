/* Waves on meshes: their modes, and their motion as mechanical systems. */
#include <dvi/field.h>
#include <dvi/integrator.h>
#include <dvi/reference.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A wave on a mesh, with its system. */
typedef struct wave {
  dvi_mesh *mesh;
  dvi_field *field;
  dvi_system *system;
  int64_t vertices, unknowns;
} wave;

static int pendulum_density(int64_t count, const double *x, const double *u, double *V, double *V_u,
                            double *V_uu, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) {
    if (V != NULL) V[i] = 1 - cos(u[i]);
    if (V_u != NULL) V_u[i] = sin(u[i]);
    if (V_uu != NULL) V_uu[i] = cos(u[i]);
  }
  return 0;
}

static const dvi_field_potential pendulum = {.density = pendulum_density};
static const dvi_condition fixed = {.part = "boundary", .kind = DVI_FIXED};

/* Make a wave on a mesh, which the wave owns then. */
static wave make_wave(dvi_mesh *mesh, dvi_star_kind kind, int conditions,
                      const dvi_field_potential *potential)
{
  wave w = {.mesh = mesh, .vertices = dvi_mesh_count(mesh, 0)};
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = &fixed,
                                .conditions = conditions,
                                .potential = potential};
  ck_assert_msg(dvi_wave_create(&terms, &w.field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  ck_assert_msg(dvi_field_system(w.field, &w.system) == DVI_OK, "%s", dvi_last_error());
  (void)dvi_field_unknowns(w.field, &w.unknowns);
  return w;
}

static void end_wave(wave *w)
{
  dvi_system_destroy(&w->system);
  dvi_field_destroy(&w->field);
  dvi_mesh_destroy(&w->mesh);
}

static dvi_mesh *generated(const char *name, int dimension, int cells, int periodic)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = dimension};
  for (int i = 0; i < dimension; i++) options.cells[i] = cells;
  for (int i = 0; i < dimension; i++) options.periodic[i] = periodic;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static double *numbers(int64_t count)
{
  return calloc((size_t)count, sizeof(double));
}

/* ---- modes ---- */

START_TEST(staggered_triangles_have_known_modes)
{
  double eigenvalue[3];
  int64_t zeros;
  const dvi_modes_options two = {.size = sizeof two, .count = 2};
  wave drum = make_wave(staggered_mesh(8, 8), DVI_CIRCUMCENTRIC, 1, NULL);
  ck_assert_int_eq(dvi_field_modes(drum.field, &two, eigenvalue, NULL, &zeros), DVI_OK);
  ck_assert_int_eq(zeros, 0);
  ck_assert_double_eq_tol(eigenvalue[0], 19.362777564429, 2e-11);
  ck_assert_double_eq_tol(eigenvalue[1], 46.629256462815, 5e-11);
  end_wave(&drum);
  wave sheet = make_wave(staggered_mesh(8, 8), DVI_CIRCUMCENTRIC, 0, NULL);
  ck_assert_int_eq(dvi_field_modes(sheet.field, &two, eigenvalue, NULL, &zeros), DVI_OK);
  ck_assert_int_eq(zeros, 1);
  ck_assert_double_eq_tol(eigenvalue[0], 9.743283624691, 2e-11);
  ck_assert_double_eq_tol(eigenvalue[1], 9.755353316864, 2e-11);
  end_wave(&sheet);
}
END_TEST

/* A string of m cells with fixed ends has lambda_j = (2 m sin(j pi/(2m)))^2. */
static double string_mode(int cells, int j)
{
  const double s = 2 * cells * sin(0.5 * pi * j / cells);
  return s * s;
}

START_TEST(modes_near_a_shift_are_found)
{
  double eigenvalue[3], vector[3 * 41];
  const dvi_modes_options near = {.size = sizeof near, .count = 3, .shift = string_mode(40, 7) + 1};
  wave string = make_wave(generated("interval", 1, 40, 0), DVI_CIRCUMCENTRIC, 1, NULL);
  ck_assert_int_eq(dvi_field_modes(string.field, &near, eigenvalue, vector, NULL), DVI_OK);
  for (int i = 0; i < 3; i++) {
    ck_assert_double_eq_tol(eigenvalue[i], string_mode(40, 6 + i), 1e-9);
    ck_assert(vector[i * 41] == 0 && vector[i * 41 + 40] == 0);
  }
  end_wave(&string);
}
END_TEST

START_TEST(largest_frequency_is_bounded_closely)
{
  for (int cells = 2; cells <= 64; cells *= 2) {
    double omega;
    const double exact = sqrt(string_mode(cells, cells - 1));
    wave string = make_wave(generated("interval", 1, cells, 0), DVI_CIRCUMCENTRIC, 1, NULL);
    ck_assert_int_eq(dvi_field_fastest(string.field, &omega), DVI_OK);
    ck_assert_msg(omega >= exact * (1 - 1e-14) && omega < exact * 1.001, "%.17g of %.17g", omega,
                  exact);
    end_wave(&string);
  }
}
END_TEST

START_TEST(all_modes_are_found_and_no_more)
{
  double eigenvalue[8];
  const dvi_modes_options many = {.size = sizeof many, .count = 8},
                          all = {.size = sizeof all, .count = 7};
  wave string = make_wave(generated("interval", 1, 8, 0), DVI_CIRCUMCENTRIC, 1, NULL);
  ck_assert_int_eq(dvi_field_modes(string.field, &all, eigenvalue, NULL, NULL), DVI_OK);
  for (int i = 0; i < 7; i++) ck_assert_double_eq_tol(eigenvalue[i], string_mode(8, i + 1), 1e-11);
  ck_assert_int_eq(dvi_field_modes(string.field, &many, eigenvalue, NULL, NULL), DVI_BAD_SIZE);
  end_wave(&string);
}
END_TEST

/* ---- orders, judged by the exact motion of three modes ---- */

enum { MODES = 3 };

typedef struct motion {
  const wave *w;
  double omega[MODES], *mode; /* [MODES][vertices] */
} motion;

static motion motion_of(const wave *w)
{
  motion m = {.w = w, .mode = numbers(MODES * w->vertices)};
  const dvi_modes_options options = {.size = sizeof options, .count = MODES};
  double eigenvalue[MODES];
  ck_assert_int_eq(dvi_field_modes(w->field, &options, eigenvalue, m.mode, NULL), DVI_OK);
  for (int i = 0; i < MODES; i++) m.omega[i] = sqrt(eigenvalue[i]);
  return m;
}

/* Set values and rates at a time. */
static void move(const motion *m, double t, double *u, double *rate)
{
  for (int64_t v = 0; v < m->w->vertices; v++) {
    u[v] = rate[v] = 0;
    for (int i = 0; i < MODES; i++) {
      const double phase = m->omega[i] * t + i;
      u[v] += m->mode[i * m->w->vertices + v] * cos(phase);
      rate[v] -= m->omega[i] * m->mode[i * m->w->vertices + v] * sin(phase);
    }
  }
}

static double error_after(const motion *m, const char *method, double t, int steps)
{
  const wave *w = m->w;
  double *u = numbers(2 * w->vertices), *q = numbers(3 * w->unknowns), worst = 0;
  double *p = q + w->unknowns, *exact = p + w->unknowns;
  dvi_integrator *integrator = NULL;
  move(m, 0, u, u + w->vertices);
  ck_assert_int_eq(dvi_field_project(w->field, u, u + w->vertices, q, p), DVI_OK);
  move(m, t, u, u + w->vertices);
  ck_assert_int_eq(dvi_field_project(w->field, u, NULL, exact, NULL), DVI_OK);
  ck_assert_msg(dvi_integrator_create(w->system, method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, t / steps) == DVI_OK, "%s", dvi_last_error());
  for (int64_t i = 0; i < w->unknowns; i++)
    worst = fmax(worst, fabs(dvi_integrator_q(integrator)[i] - exact[i]));
  dvi_integrator_destroy(&integrator);
  free(u), free(q);
  return worst;
}

typedef struct claim {
  const char *method;
  int order, first; /* steps of the first run */
} claim;

static void check_claim(const motion *m, const claim *c)
{
  const double t = 0.9, floor = 2e-12;
  double last = error_after(m, c->method, t, c->first);
  int measured = 0;
  for (int i = 1; i < 5; i++) {
    const double error = error_after(m, c->method, t, c->first << i);
    if (error > floor) {
      const double order = log2(last / error);
      ck_assert_msg(fabs(order - c->order) < 0.25, "%s: order %g at %d steps (%g, %g)", c->method,
                    order, c->first << i, last, error);
      measured++;
    }
    last = error;
  }
  ck_assert_msg(measured >= 2 && last < 1e-3, "%s: error %g", c->method, last);
}

START_TEST(methods_have_their_orders_on_triangles)
{
  static const claim claims[] = {{"verlet", 2, 64},
                                 {"imex", 2, 16},
                                 {"galerkin:degree=1", 2, 16},
                                 {"galerkin:degree=2", 4, 4},
                                 {"galerkin:degree=3", 6, 4},
                                 {"galerkin:degree=4", 8, 4},
                                 {"composition:order=4", 4, 32}};
  const int cells = is_short_run() ? 8 : 16;
  wave drum = make_wave(staggered_mesh(cells, cells), DVI_CIRCUMCENTRIC, 1, NULL);
  const motion m = motion_of(&drum);
  for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) check_claim(&m, claims + i);
  free(m.mode);
  end_wave(&drum);
}
END_TEST

/* The mass of finite elements is not diagonal. */
START_TEST(methods_have_their_orders_on_finite_elements)
{
  static const claim claims[] = {{"verlet", 2, 64}, {"galerkin:degree=2", 4, 4}};
  wave drum = make_wave(staggered_mesh(8, 8), DVI_WHITNEY, 1, NULL);
  const motion m = motion_of(&drum);
  for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) check_claim(&m, claims + i);
  free(m.mode);
  end_wave(&drum);
}
END_TEST

/* ---- steps that are too long ---- */

START_TEST(unstable_steps_are_refused_by_their_bound)
{
  static const char *const methods[] = {"verlet", "verlet:blocking=none", "composition:order=4",
                                        "composition:order=8", "respa:substeps=3"};
  wave string = make_wave(generated("interval", 1, 32, 0), DVI_CIRCUMCENTRIC, 1, NULL);
  double *q = numbers(2 * string.unknowns), *p = q + string.unknowns;
  unsigned long long seed = 3;
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    dvi_integrator *integrator = NULL;
    for (int64_t k = 0; k < string.unknowns; k++) q[k] = random_number(&seed) - 0.5;
    ck_assert_int_eq(dvi_integrator_create(string.system, methods[i], &integrator), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.2), DVI_STEP_TOO_LARGE);
    const char *bound = strstr(dvi_last_error(), "h may be ");
    ck_assert_msg(bound != NULL, "%s", dvi_last_error());
    for (int64_t k = 0; k < string.unknowns; k++)
      ck_assert(dvi_integrator_q(integrator)[k] == q[k]);
    const double h = 0.999 * strtod(bound + strlen("h may be "), NULL);
    double first, last;
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
    for (int k = 0; k < repeats(2000); k++)
      ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_OK);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &last), DVI_OK);
    ck_assert_msg(last < 1e4 * first, "%s: energy %g, then %g", methods[i], first, last);
    dvi_integrator_destroy(&integrator);
  }
  free(q);
  end_wave(&string);
}
END_TEST

START_TEST(frequency_of_a_term_is_checked)
{
  dvi_system_terms terms;
  dvi_system *system = NULL;
  wave string = make_wave(generated("interval", 1, 8, 0), DVI_CIRCUMCENTRIC, 1, NULL);
  ck_assert_int_eq(dvi_field_system_terms(string.field, &terms), DVI_OK);
  dvi_potential potential = terms.potentials[0];
  terms.potentials = &potential;
  potential.fastest = -1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  potential.fastest = 3;
  potential.quadratic = 0;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  ck_assert(strstr(dvi_last_error(), "not quadratic") != NULL);
  end_wave(&string);
}
END_TEST

/* ---- invariants ---- */

static double drift_of(const wave *w, const char *method, int invariant, double h, int steps)
{
  double *q = numbers(2 * w->unknowns), *p = q + w->unknowns, first, now, worst = 0;
  unsigned long long seed = 11;
  dvi_integrator *integrator = NULL;
  for (int64_t i = 0; i < w->unknowns; i++) {
    q[i] = random_number(&seed) - 0.5;
    p[i] = (random_number(&seed) - 0.5) / (double)w->unknowns;
  }
  ck_assert_int_eq(dvi_integrator_create(w->system, method, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, invariant, &first), DVI_OK);
  for (int i = 0; i < steps; i++) {
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s", dvi_last_error());
    if (i % 10 != 9) continue;
    ck_assert_int_eq(dvi_integrator_invariant(integrator, invariant, &now), DVI_OK);
    worst = fmax(worst, fabs(now - first) / fabs(first));
  }
  dvi_integrator_destroy(&integrator);
  free(q);
  return worst;
}

static void check_momenta(dvi_mesh *mesh, dvi_star_kind kind, const char *method, double h)
{
  wave w = make_wave(mesh, kind, 0, NULL);
  const int n = dvi_mesh_dimension(mesh);
  ck_assert_int_eq(dvi_system_invariant_count(w.system), 1 + n);
  ck_assert_str_eq(dvi_system_invariant_name(w.system, 1), "momentum_x");
  for (int i = 1; i <= n; i++) {
    const double drift = drift_of(&w, method, i, h, repeats(200));
    ck_assert_msg(drift < 2e-12, "%s, axis %d: %g", method, i, drift);
  }
  end_wave(&w);
}

START_TEST(momentum_is_conserved_on_grids_that_repeat_themselves)
{
  check_momenta(generated("interval", 1, 32, 1), DVI_CIRCUMCENTRIC, "verlet", 0.02);
  check_momenta(generated("box", 2, 8, 1), DVI_CIRCUMCENTRIC, "verlet", 0.03);
  check_momenta(generated("kuhn-torus", 3, 4, 0), DVI_CIRCUMCENTRIC, "verlet", 0.05);
  check_momenta(generated("bcc-torus", 3, 3, 0), DVI_CIRCUMCENTRIC, "imex", 0.05);
  check_momenta(generated("kuhn-torus", 2, 6, 0), DVI_WHITNEY, "galerkin:degree=2", 0.05);
}
END_TEST

/* u = sin(2 pi (x - t)) has the momentum -int u' D u with the central difference, whose factor is
 * sin(2 pi h)/h. */
START_TEST(momentum_is_positive_for_waves_along_the_axis)
{
  enum { CELLS = 32 };
  double q[CELLS], p[CELLS], momentum;
  dvi_integrator *integrator = NULL;
  wave w = make_wave(generated("interval", 1, CELLS, 1), DVI_CIRCUMCENTRIC, 0, NULL);
  for (int i = 0; i < CELLS; i++) {
    q[i] = sin(2 * pi * i / CELLS);
    p[i] = -2 * pi * cos(2 * pi * i / CELLS) / CELLS;
  }
  ck_assert_int_eq(dvi_integrator_create(w.system, "verlet", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 1, &momentum), DVI_OK);
  ck_assert_double_eq_tol(momentum, pi * CELLS * sin(2 * pi / CELLS), 1e-13);
  dvi_integrator_destroy(&integrator);
  end_wave(&w);
}
END_TEST

START_TEST(fields_that_are_not_alike_everywhere_have_no_momentum)
{
  wave drum = make_wave(staggered_mesh(4, 4), DVI_CIRCUMCENTRIC, 0, NULL);
  ck_assert_int_eq(dvi_system_invariant_count(drum.system), 1);
  end_wave(&drum);
  wave pendula = make_wave(generated("interval", 1, 8, 1), DVI_CIRCUMCENTRIC, 0, &pendulum);
  ck_assert_int_eq(dvi_system_invariant_count(pendula.system), 1);
  end_wave(&pendula);
}
END_TEST

START_TEST(energy_stays_bounded)
{
  wave pendula = make_wave(generated("interval", 1, 64, 1), DVI_CIRCUMCENTRIC, 0, &pendulum);
  const int steps = repeats(1000000);
  const double early = drift_of(&pendula, "verlet", 0, 0.005, steps / 10),
               late = drift_of(&pendula, "verlet", 0, 0.005, steps);
  ck_assert_msg(late < 0.2 && late < 2 * early + 1e-3, "%g, then %g", early, late);
  end_wave(&pendula);
}
END_TEST

/* ---- against IDA ---- */

/* The end of a smooth motion of pendula in a square. */
static void end_by(const wave *w, const char *method, double t, int steps, double *q)
{
  double *u = numbers(w->vertices), *p = numbers(w->unknowns);
  const double *x = dvi_mesh_points(w->mesh);
  for (int64_t v = 0; v < w->vertices; v++) u[v] = 2 * sin(pi * x[2 * v]) * sin(pi * x[2 * v + 1]);
  ck_assert_int_eq(dvi_field_project(w->field, u, NULL, q, NULL), DVI_OK);
  if (method == NULL) {
    dvi_reference_report report;
    ck_assert_msg(dvi_reference_judge(w->system, 0, t, q, p, NULL, &report) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_msg(report.error < 1e-8, "IDA: %g", report.error);
  } else {
    dvi_integrator *integrator = NULL;
    ck_assert_int_eq(dvi_integrator_create(w->system, method, &integrator), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    for (int i = 0; i < steps; i++)
      ck_assert_int_eq(dvi_integrator_step(integrator, t / steps), DVI_OK);
    memcpy(q, dvi_integrator_q(integrator), (size_t)w->unknowns * sizeof *q);
    dvi_integrator_destroy(&integrator);
  }
  free(u), free(p);
}

START_TEST(ida_judges_waves_of_pendula)
{
  static const claim claims[] = {{"verlet", 2, 100},
                                 {"imex", 2, 32},
                                 {"galerkin:degree=1", 2, 32},
                                 {"galerkin:degree=2", 4, 32}};
  const double t = 0.5;
  const int cells = is_short_run() ? 8 : 32;
  wave w = make_wave(staggered_mesh(cells, cells), DVI_CIRCUMCENTRIC, 1, &pendulum);
  double *judge = numbers(2 * w.unknowns), *q = judge + w.unknowns;
  end_by(&w, NULL, t, 0, judge);
  for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
    double last = 0;
    for (int k = 0; k < 4; k++) {
      double error = 0;
      end_by(&w, claims[i].method, t, claims[i].first << k, q);
      for (int64_t j = 0; j < w.unknowns; j++) error = fmax(error, fabs(q[j] - judge[j]));
      if (k > 0 && error > 2e-9)
        ck_assert_msg(fabs(log2(last / error) - claims[i].order) < 0.25, "%s: order %g (%g, %g)",
                      claims[i].method, log2(last / error), last, error);
      last = error;
    }
  }
  free(judge);
  end_wave(&w);
}
END_TEST

/* ---- the system ---- */

START_TEST(callbacks_agree_with_differences)
{
  const dvi_star_kind kinds[] = {DVI_CIRCUMCENTRIC, DVI_WHITNEY};
  for (int k = 0; k < 2; k++) {
    wave w = make_wave(staggered_mesh(4, 4), kinds[k], k, &pendulum);
    double *q = numbers(2 * w.unknowns);
    unsigned long long seed = 5;
    for (int64_t i = 0; i < 2 * w.unknowns; i++) q[i] = random_number(&seed);
    ck_assert_msg(dvi_system_check(w.system, 0, q, q + w.unknowns, 0, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    free(q);
    end_wave(&w);
  }
}
END_TEST

START_TEST(lift_undoes_project)
{
  wave w = make_wave(staggered_mesh(4, 4), DVI_CIRCUMCENTRIC, 1, NULL);
  double *u = numbers(2 * w.vertices), *q = numbers(w.unknowns), *back = u + w.vertices;
  int64_t count, unknowns;
  const int *rim = dvi_mesh_part_cells(w.mesh, "boundary", 0, &count);
  for (int64_t v = 0; v < w.vertices; v++) u[v] = (double)v;
  ck_assert_int_eq(dvi_field_project(w.field, u, NULL, q, NULL), DVI_OK);
  ck_assert_int_eq(dvi_field_lift(w.field, q, back), DVI_OK);
  for (int64_t i = 0; i < count; i++) ck_assert(back[rim[i]] == 0);
  const int *unknown = dvi_field_unknowns(w.field, &unknowns);
  ck_assert_int_eq(unknowns + count, w.vertices);
  for (int64_t i = 0; i < unknowns; i++) ck_assert(back[unknown[i]] == unknown[i]);
  free(u), free(q);
  end_wave(&w);
}
END_TEST

SUITE(waves)
{
  tcase_add_test(tests, staggered_triangles_have_known_modes);
  tcase_add_test(tests, modes_near_a_shift_are_found);
  tcase_add_test(tests, largest_frequency_is_bounded_closely);
  tcase_add_test(tests, all_modes_are_found_and_no_more);
  tcase_add_test(tests, methods_have_their_orders_on_triangles);
  tcase_add_test(tests, methods_have_their_orders_on_finite_elements);
  tcase_add_test(tests, unstable_steps_are_refused_by_their_bound);
  tcase_add_test(tests, frequency_of_a_term_is_checked);
  tcase_add_test(tests, momentum_is_conserved_on_grids_that_repeat_themselves);
  tcase_add_test(tests, momentum_is_positive_for_waves_along_the_axis);
  tcase_add_test(tests, fields_that_are_not_alike_everywhere_have_no_momentum);
  tcase_add_test(tests, energy_stays_bounded);
  tcase_add_test(tests, ida_judges_waves_of_pendula);
  tcase_add_test(tests, callbacks_agree_with_differences);
  tcase_add_test(tests, lift_undoes_project);
}
