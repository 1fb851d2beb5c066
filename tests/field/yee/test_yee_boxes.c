/* labels: unit */
/* Grids of boxes in vacuum: the known dispersion, a judge that knows only incidence and stars,
 * invariants, samples between steps, and the bound of the step. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/waves/boxes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- dispersion ---- */

/* A standing wave: E_c = a_c times cos(k_c x_c) and sin of the others, with a.k = 0. */
typedef struct mode {
  double k[3], a[3];
} mode;

static int mode_field(const double *x, double *value, void *user)
{
  const mode *m = user;
  for (int c = 0; c < 3; c++) {
    value[c] = m->a[c];
    for (int l = 0; l < 3; l++) value[c] *= l == c ? cos(m->k[l] * x[l]) : sin(m->k[l] * x[l]);
  }
  return 0;
}

/* Start with a mode, and return the largest distance from cos(omega t) times the start. At whole
 * steps a sample is the mean of two half steps, which has the frequency of the grid. */
static double distance_from_mode(const dvi_yee_terms *terms, dvi_form_function *field, void *user,
                                 double omega, int steps)
{
  dvi_march *march = box_march(terms);
  const int64_t edges = dvi_march_size(march, DVI_FORM_E);
  double *E = random_values(edges, 1), most = 0, size = 0;
  ck_assert_int_eq(dvi_yee_integrate(terms, DVI_FORM_E, field, user, E), DVI_OK);
  start_boxes(march, E, NULL);
  for (int64_t i = 0; i < edges; i++) size = fmax(size, fabs(E[i]));
  for (int n = 0; n <= steps; n++) {
    const double t = n * terms->step;
    advance_march(march, t);
    double *now = sample_march(march, DVI_FORM_E);
    for (int64_t i = 0; i < edges; i++) most = fmax(most, fabs(now[i] - cos(omega * t) * E[i]));
    free(now);
  }
  dvi_march_destroy(&march);
  free(E);
  return most / size;
}

/* sin^2(omega dt/2)/dt^2 = sum sin^2(k h/2)/h^2 (Taflove and Hagness 2005, eq. 4.12). The numbers
 * have 12 digits, and phases are compared over 25 times: 1e-11 and some. */
START_TEST(modes_of_a_box_have_the_frequencies_of_the_grid)
{
  static const double omega[3] = {4.973909883247, 5.973299740175, 6.414511709401};
  static const int number[3][3] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  static const double size[3] = {1, 0.8, 0.6};
  const double h = 0.2;
  const dvi_yee_terms terms = {
      .size = sizeof terms,
      .axes = 3,
      .degree = 1,
      .axis = {{.cells = 5, .upper = 1}, {.cells = 4, .upper = 0.8}, {.cells = 3, .upper = 0.6}},
      .step = 0.9 * h / sqrt(3)};
  mode m = {{0}, {0}};
  for (int l = 0; l < 3; l++) {
    m.k[l] = pi * number[_i][l] / size[l];
    m.a[l] = number[_i][l] == 0;
  }
  const double distance = distance_from_mode(&terms, mode_field, &m, omega[_i], repeats(240));
  ck_assert_double_le(distance, 2e-11);
}
END_TEST

static int te10(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = 0;
  value[1] = sin(pi * x[0]);
  return 0;
}

START_TEST(te10_of_a_square_has_the_frequency_of_the_grid)
{
  const dvi_yee_terms terms = {.size = sizeof terms,
                               .axes = 2,
                               .degree = 1,
                               .axis = {{.cells = 10}, {.cells = 10}},
                               .step = 0.05 / sqrt(2)};
  const double distance = distance_from_mode(&terms, te10, NULL, 3.130286593782, repeats(700));
  ck_assert_double_le(distance, 2e-11);
}
END_TEST

static int sine_of_both(const double *x, double *value, void *user)
{
  const int *axes = user;
  *value = sin(pi * x[0]) * (*axes > 1 ? sin(2 * pi * x[1]) : 1);
  return 0;
}

/* (Ez, Bx, By) on two axes and (Ey, Bz) on one. */
START_TEST(scalar_modes_have_the_frequencies_of_the_grid)
{
  int axes = _i;
  const double h = 0.1, hy = 0.125, dt = 0.05;
  const dvi_yee_terms terms = {
      .size = sizeof terms, .axes = axes, .axis = {{.cells = 10}, {.cells = 8}}, .step = dt};
  const double x = sin(pi * h / 2) / h, y = axes > 1 ? sin(pi * hy) / hy : 0,
               omega = 2 / dt * asin(dt * sqrt(x * x + y * y)),
               distance = distance_from_mode(&terms, sine_of_both, &axes, omega, repeats(700));
  ck_assert_double_le(distance, 1e-12); /* roundings of 700 steps */
}
END_TEST

/* A standing wave in a crystal's cell, E = a exp(i k.x) cos(omega t). */
typedef struct bloch {
  double k[3], a[3];
  int is_imaginary;
} bloch;

static int bloch_field(const double *x, double *value, void *user)
{
  const bloch *b = user;
  const double phase = b->k[0] * x[0] + b->k[1] * x[1] + b->k[2] * x[2];
  for (int c = 0; c < 3; c++) value[c] = b->a[c] * (b->is_imaginary ? sin(phase) : cos(phase));
  return 0;
}

START_TEST(waves_with_a_phase_have_the_frequency_of_the_grid)
{
  /* phase of a whole cell, of any number */
  bloch b = {{0.7, -1.1, 2.3}, {0}, 0};
  const double h[3] = {0.25, 1 / 3., 0.2}, dt = 0.1;
  dvi_yee_terms terms = {.size = sizeof terms,
                         .axes = 3,
                         .degree = 1,
                         .axis = {{.cells = 4}, {.cells = 3}, {.cells = 5}},
                         .step = dt};
  double s[3], sum = 0, most = 0;
  for (int l = 0; l < 3; l++) {
    terms.axis[l].end[0].kind = terms.axis[l].end[1].kind = DVI_YEE_BLOCH;
    terms.axis[l].phase = b.k[l];
    s[l] = sin(b.k[l] * h[l] / 2) / h[l];
    sum += s[l] * s[l];
  }
  /* The grid takes s for k/2. Integrals over edges have the factor s/(k/2), and with it they are
   * orthogonal to s. */
  b.a[0] = s[1] * s[1] / b.k[1], b.a[1] = -s[0] * s[0] / b.k[0];
  const double omega = 2 / dt * asin(dt * sqrt(sum));
  dvi_march *march = box_march(&terms);
  const int64_t edges = dvi_yee_size(&terms, DVI_FORM_E);
  ck_assert_int_eq(dvi_march_size(march, DVI_FORM_E), 2 * edges);
  double *E = random_values(2 * edges, 1);
  for (b.is_imaginary = 0; b.is_imaginary < 2; b.is_imaginary++)
    ck_assert_int_eq(
        dvi_yee_integrate(&terms, DVI_FORM_E, bloch_field, &b, E + b.is_imaginary * edges), DVI_OK);
  start_boxes(march, E, NULL);
  for (int n = 0; n <= 300; n++) {
    advance_march(march, n * dt);
    double *now = sample_march(march, DVI_FORM_E);
    for (int64_t i = 0; i < 2 * edges; i++)
      most = fmax(most, fabs(now[i] - cos(omega * n * dt) * E[i]));
    free(now);
  }
  ck_assert_double_le(most, 1e-12);
  dvi_march_destroy(&march);
  free(E);
}
END_TEST

/* ---- a judge ---- */

static const double graded[] = {0, 0.1, 0.25, 0.32, 0.5, 0.61, 0.8, 1};

#define ENDS(a, b) .end = {{.kind = a}, {.kind = b}}

/* Grids of all dimensions, with equal and unequal boxes, and all ends that conserve energy. */
static dvi_yee_terms grid_number(int number)
{
  static const dvi_yee_axis axes[] = {
      {.cells = 5, .upper = 1, ENDS(DVI_YEE_PEC, DVI_YEE_PEC)},
      {.cells = 7, .node = graded, ENDS(DVI_YEE_PMC, DVI_YEE_PEC)},
      {.cells = 6, .lower = -1, .upper = 0.5, ENDS(DVI_YEE_PERIODIC, DVI_YEE_PERIODIC)},
      {.cells = 7, .node = graded, ENDS(DVI_YEE_PERIODIC, DVI_YEE_PERIODIC)},
      {.cells = 4, .upper = 1, ENDS(DVI_YEE_PMC, DVI_YEE_PMC)},
      {.cells = 7, .node = graded, ENDS(DVI_YEE_PEC, DVI_YEE_PMC)},
      {.cells = 8, .upper = 2, ENDS(DVI_YEE_PEC, DVI_YEE_PMC)}};
  dvi_yee_terms terms = {.size = sizeof terms};
  const int kind = number / 7;
  terms.axes = kind == 0 ? 1 : kind < 3 ? 2 : 3;
  terms.degree = kind >= 2;
  for (int l = 0; l < terms.axes; l++) terms.axis[l] = axes[(number + l * (1 + number / 14)) % 7];
  return terms;
}

enum { GRIDS = 42 };

START_TEST(grids_move_as_matrices_say)
{
  dvi_yee_terms terms = grid_number(_i);
  const int steps = repeats(60);
  dvi_march *march = box_march(&terms);
  box_judge judge = make_judge(&terms);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  const double dt = facts.step;
  double *E = random_values(judge.edges, 3), *B = random_values(judge.faces, 4), most = 0;
  start_boxes(march, E, B);
  start_judge(&judge, E, B, dt);
  for (int n = 0; n < steps; n++) step_judge(&judge, dt);
  advance_march(march, steps * dt);
  double *B_now = sample_march(march, DVI_FORM_B);
  for (int64_t f = 0; f < judge.faces; f++) most = fmax(most, fabs(B_now[f] - judge.B[f]));
  /* E^{n-1/2} is E^n - (E^{n+1/2} - E^n) */
  double *E_now = sample_march(march, DVI_FORM_E), *E_after = judge.E;
  double *E_before = random_values(judge.edges, 1);
  memcpy(E_before, E_after, (size_t)judge.edges * sizeof *E_before);
  step_judge(&judge, dt);
  advance_march(march, (steps + 1) * dt);
  double *E_later = sample_march(march, DVI_FORM_E);
  for (int64_t e = 0; e < judge.edges; e++)
    most = fmax(most, fabs(E_later[e] - 0.5 * (E_before[e] + judge.E[e])));
  /* roundings of 60 steps with values around 1 */
  ck_assert_msg(most < 5e-13, "grid %d: %g", _i, most);
  free(E), free(B), free(B_now), free(E_now), free(E_before), free(E_later);
  free_judge(&judge);
  dvi_march_destroy(&march);
}
END_TEST

/* The bound is that of the matrices: bisection by axis against the power method. */
START_TEST(bounds_are_those_of_the_matrices)
{
  const dvi_yee_terms terms = grid_number(_i);
  dvi_march *march = box_march(&terms);
  box_judge judge = make_judge(&terms);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  const double bound = 2 / sqrt(largest_of_judge(&judge));
  /* the power method comes from below, and may not be there yet */
  ck_assert_msg(facts.bound <= bound * (1 + 1e-12) && facts.bound >= bound * (1 - 2e-3),
                "grid %d: %.15g, %.15g", _i, facts.bound, bound);
  ck_assert_double_eq_tol(facts.step, 0.9 * facts.bound, 1e-15);
  free_judge(&judge);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- invariants ---- */

START_TEST(energy_stays_near_the_bound)
{
  static const int numbers[] = {3, 9, 15, 23, 36};
  dvi_yee_terms terms = grid_number(numbers[_i]);
  terms.fraction = 0.99;
  dvi_march *march = box_march(&terms);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3),
         *B = random_values(dvi_march_size(march, DVI_FORM_B), 4), most = 0;
  start_boxes(march, E, B);
  const double start = observe_march(march, "energy");
  const int parts = 100, steps = repeats(1000);
  for (int n = 1; n <= parts; n++) {
    advance_march(march, facts.step * n * steps);
    most = fmax(most, fabs(observe_march(march, "energy") / start - 1));
  }
  /* 1e5 roundings add up like a random walk, to some 1e-14 here */
  ck_assert_msg(most < 1e-13, "grid %d: %g", numbers[_i], most);
  free(E), free(B);
  dvi_march_destroy(&march);
}
END_TEST

/* B = dA has no divergence, on two axes, too, and the charge that E has stays. */
START_TEST(divergence_and_charge_stay)
{
  dvi_yee_terms terms = grid_number(7 + _i);
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3);
  start_boxes(march, E, NULL);
  const double charge = observe_march(march, "charge");
  advance_march(march, 50);
  ck_assert_double_le(observe_march(march, "divergence"), 1e-13);
  ck_assert_double_le(observe_march(march, "gauss"), 1e-13);
  ck_assert_double_eq_tol(observe_march(march, "charge"), charge, 1e-11);
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- samples ---- */

/* Between steps both forms have errors of order 2, and no jumps at whole steps. */
static double error_between_steps(int cells, double part)
{
  const double h = 1. / cells, dt = 0.5 * h;
  const dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 1, .axis = {{.cells = cells}}, .step = dt};
  int one = 1;
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 1), most = 0;
  ck_assert_int_eq(dvi_yee_integrate(&terms, DVI_FORM_E, sine_of_both, &one, E), DVI_OK);
  start_boxes(march, E, NULL);
  for (double t = part * dt; t < 1.3; t += dt) {
    advance_march(march, t);
    double *now = sample_march(march, DVI_FORM_E), *B = sample_march(march, DVI_FORM_B);
    for (int i = 0; i <= cells; i++) most = fmax(most, fabs(now[i] - cos(pi * t) * E[i]));
    for (int i = 0; i < cells; i++)
      most = fmax(most, fabs(B[i] + sin(pi * t) * cos(pi * (i + 0.5) * h) * h) / h);
    free(now), free(B);
  }
  free(E);
  dvi_march_destroy(&march);
  return most;
}

START_TEST(samples_between_steps_have_order_two)
{
  const double part = 0.1 * _i, coarse = error_between_steps(40, part),
               fine = error_between_steps(80, part);
  ck_assert_msg(fabs(log2(coarse / fine) - 2) < 0.1, "part %g: %g %g", part, coarse, fine);
}
END_TEST

START_TEST(samples_are_continuous_at_whole_steps)
{
  dvi_yee_terms terms = grid_number(38);
  dvi_march *march = box_march(&terms);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3);
  start_boxes(march, E, NULL);
  for (int form = DVI_FORM_E; form <= DVI_FORM_B; form++) {
    const double t = (10 + 2 * form) * facts.step;
    advance_march(march, t - 1e-9 * facts.step);
    double *before = sample_march(march, (dvi_march_form)form);
    advance_march(march, t);
    double *at = sample_march(march, (dvi_march_form)form);
    for (int64_t i = 0; i < dvi_march_size(march, (dvi_march_form)form); i++)
      ck_assert_double_eq_tol(before[i], at[i], 1e-7); /* slopes of some ten */
    free(before), free(at);
  }
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

SUITE(yee_boxes)
{
  tcase_add_loop_test(tests, modes_of_a_box_have_the_frequencies_of_the_grid, 0, 3);
  tcase_add_test(tests, te10_of_a_square_has_the_frequency_of_the_grid);
  tcase_add_loop_test(tests, scalar_modes_have_the_frequencies_of_the_grid, 1, 3);
  tcase_add_test(tests, waves_with_a_phase_have_the_frequency_of_the_grid);
  tcase_add_loop_test(tests, grids_move_as_matrices_say, 0, GRIDS);
  tcase_add_loop_test(tests, bounds_are_those_of_the_matrices, 0, GRIDS);
  tcase_add_loop_test(tests, energy_stays_near_the_bound, 0, 5);
  tcase_add_loop_test(tests, divergence_and_charge_stay, 0, GRIDS - 7);
  tcase_add_loop_test(tests, samples_between_steps_have_order_two, 0, 10);
  tcase_add_test(tests, samples_are_continuous_at_whole_steps);
}
