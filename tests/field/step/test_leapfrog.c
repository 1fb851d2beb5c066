/* Leapfrog on meshes: dispersion, conserved quantities, losses, sources, and saved states. */
#include <dvi/field.h>
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;
static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};

/* A field with a march. */
typedef struct scene {
  dvi_field *field;
  dvi_march *march;
  int64_t edges, faces;
  double *E, *B;
} scene;

static void fill_random(int64_t count, double *values, unsigned long long seed)
{
  for (int64_t i = 0; i < count; i++) values[i] = random_number(&seed) - 0.5;
}

/* Make a march on a mesh, which is released, and start it from random numbers without magnetic
 * charge, B = dA. */
static scene make_scene(dvi_mesh *mesh, dvi_star_kind kind, dvi_maxwell_terms terms,
                        dvi_march_options how)
{
  scene s = {.field = NULL};
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  terms.size = sizeof terms;
  terms.star = star;
  how.size = sizeof how;
  ck_assert_msg(dvi_maxwell_create(&terms, &s.field) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_march_create(s.field, &how, &s.march) == DVI_OK, "%s", dvi_last_error());
  s.edges = dvi_march_size(s.march, DVI_FORM_E);
  s.faces = dvi_march_size(s.march, DVI_FORM_B);
  s.E = calloc((size_t)(2 * s.edges), sizeof(double));
  s.B = calloc((size_t)s.faces, sizeof(double));
  fill_random(2 * s.edges, s.E, 5);
  const dvi_march_state state = {.size = sizeof state, .E = s.E, .A = s.E + s.edges};
  ck_assert_msg(dvi_march_start(s.march, &state) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  dvi_star_destroy(&star);
  return s;
}

static void end_scene(scene *s)
{
  dvi_march_destroy(&s->march);
  dvi_field_destroy(&s->field);
  free(s->E);
  free(s->B);
}

static void sample(const scene *s)
{
  ck_assert(dvi_march_sample(s->march, DVI_FORM_E, 0, NULL, s->E) == DVI_OK);
  ck_assert(dvi_march_sample(s->march, DVI_FORM_B, 0, NULL, s->B) == DVI_OK);
}

static dvi_mesh *box(void)
{
  return generated("box", (dvi_generator_options){.cells = {5, 4, 3}, .extent = {1, 0.8, 0.6}});
}

/* ---- conservation ---- */

/* A sum of roundings after 1e5 steps is expected at 1e-16 times the root of their number. */
static void check_energy(dvi_mesh *mesh, dvi_star_kind kind, int walls, long steps)
{
  scene s = make_scene(mesh, kind, (dvi_maxwell_terms){.wall = &pec, .walls = walls},
                       (dvi_march_options){.fraction = 0.99});
  const double dt = step_of_march(s.march), start = observe_march(s.march, "energy");
  double worst = 0;
  for (long i = 1; i <= 100; i++) {
    advance_march(s.march, dt * (double)(steps / 100 * i));
    worst = fmax(worst, fabs(observe_march(s.march, "energy") / start - 1));
  }
  ck_assert_msg(worst < 1e-13, "energy changes by %g", worst);
  ck_assert(observe_march(s.march, "gauss") < 1e-13);
  end_scene(&s);
}

START_TEST(energy_and_charge_are_conserved_to_roundoff)
{
  check_energy(box(), DVI_CIRCUMCENTRIC, 1, repeats(100000));
  check_energy(staggered_mesh(6, 6), DVI_CIRCUMCENTRIC, 0, repeats(100000));
  check_energy(generated("bcc-torus", (dvi_generator_options){.cells = {3, 3, 3}}),
               DVI_CIRCUMCENTRIC, 0, repeats(20000));
  check_energy(staggered_mesh(4, 4), DVI_WHITNEY, 1, repeats(5000));
}
END_TEST

/* ---- motion ---- */

/* Start a mode of the box, whose frequency w obeys sin^2(w dt/2)/dt^2 = sum sin^2(k h/2)/h^2. The
 * digits are those of an independent code with dt = 0.9 of the bound. */
START_TEST(time_and_space_disperse_as_known)
{
  static const double known[3] = {4.973909883247, 5.973299740175, 6.414511709401};
  double omega[3], *mode;
  scene s = make_scene(box(), DVI_CIRCUMCENTRIC, (dvi_maxwell_terms){.wall = &pec, .walls = 1},
                       (dvi_march_options){.fraction = 0.5});
  const dvi_modes_options three = {.size = sizeof three, .count = 3};
  double sum = 0;
  for (int a = 0; a < 3; a++) sum += 25;
  const double dt = 0.9 / sqrt(sum); /* all edges are 0.2 long */
  mode = calloc((size_t)(3 * s.edges), sizeof(double));
  ck_assert(dvi_field_modes(s.field, &three, omega, mode, NULL) == DVI_OK);
  dvi_march_destroy(&s.march);
  const dvi_march_options how = {.size = sizeof how, .step = dt};
  ck_assert_msg(dvi_march_create(s.field, &how, &s.march) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < 3; i++) {
    const double w = 2 / dt * asin(dt * sqrt(omega[i]) / 2);
    const dvi_march_state state = {.size = sizeof state, .E = mode + i * s.edges};
    ck_assert_double_eq_tol(w, known[i], 1e-11);
    ck_assert(dvi_march_start(s.march, &state) == DVI_OK);
    advance_march(s.march, 150 * dt);
    sample(&s);
    for (int64_t e = 0; e < s.edges; e++)
      ck_assert_double_eq_tol(s.E[e], cos(150 * w * dt) * mode[i * s.edges + e], 1e-11);
  }
  free(mode);
  end_scene(&s);
}
END_TEST

/* The discrete frequency of the first mode between two electric walls with a conductor, from the
 * roots of the difference equation. */
START_TEST(a_conductor_damps_as_the_difference_equation_says)
{
  enum { N = 20 };
  double sigma[N], *mode = calloc(N + 1, sizeof *mode);
  const double dt = 0.8 / N;
  for (int i = 0; i < N; i++) sigma[i] = 0.7;
  for (int i = 0; i <= N; i++) mode[i] = sin(pi * i / N);
  scene s = make_scene(generated("box", (dvi_generator_options){.cells = {N}}), DVI_CIRCUMCENTRIC,
                       (dvi_maxwell_terms){.wall = &pec, .walls = 1, .conductivity = sigma},
                       (dvi_march_options){.step = dt});
  const dvi_march_state state = {.size = sizeof state, .E = mode};
  double value[3];
  ck_assert(dvi_march_start(s.march, &state) == DVI_OK);
  for (int i = 0; i < 3; i++) {
    sample(&s);
    value[i] = s.E[N / 2];
    advance_march(s.march, (i + 1) * dt);
  }
  /* E^{n+1} + E^{n-1} exp(2 a) = 2 E^n exp(a) cos(b) for roots exp(a +- i b) */
  const double rate = -0.350022869356, frequency = 3.120964341326, a = rate * dt;
  ck_assert_double_eq_tol(
      value[2], 2 * value[1] * exp(a) * cos(frequency * dt) - value[0] * exp(2 * a), 1e-13);
  free(mode);
  end_scene(&s);
}
END_TEST

/* A wave that leaves at a right angle is reflected by the difference scheme's own admittance alone,
 * which is an error of second order. */
START_TEST(absorbing_walls_absorb)
{
  double left[2];
  for (int level = 0; level < 2; level++) {
    const int n = 40 << level;
    static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};
    scene s = make_scene(generated("box", (dvi_generator_options){.cells = {n}}), DVI_CIRCUMCENTRIC,
                         (dvi_maxwell_terms){.wall = &open, .walls = 1},
                         (dvi_march_options){.fraction = 0.9});
    double *E = calloc((size_t)s.edges, sizeof *E);
    for (int64_t i = 0; i < s.edges; i++) E[i] = exp(-pow(((double)i / n - 0.5) / 0.08, 2));
    const dvi_march_state state = {.size = sizeof state, .E = E};
    ck_assert(dvi_march_start(s.march, &state) == DVI_OK);
    const double before = observe_march(s.march, "energy");
    advance_march(s.march, 1.2);
    left[level] = observe_march(s.march, "energy") / before;
    free(E);
    end_scene(&s);
  }
  ck_assert_msg(left[0] < 1e-3 && left[1] < left[0] / 8, "%g and %g are left", left[0], left[1]);
}
END_TEST

/* ---- sources ---- */

static int pulse(double t, double *value, void *user)
{
  unsigned long long seed = (unsigned long long)(1e6 * t) + *(const unsigned long long *)user;
  *value = random_number(&seed) - 0.5;
  return 0;
}

static int swirl(const double *x, double *value, void *user)
{
  (void)user;
  for (int l = 0; l < 3; l++) value[l] = sin(3 * x[(l + 1) % 3]);
  return 0;
}

/* Charge is moved by random currents, by conductors and walls, and its sum stays exact. */
/* A march shows what it was given, also if its first half step has losses and solves for M. The
 * solution has roundings beside E of 0.5. */
START_TEST(lossy_fields_start_with_what_is_given)
{
  static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};
  double sigma[8], given[16 + 9];
  for (int c = 0; c < 8; c++) sigma[c] = c;
  scene s = make_scene(generated("kuhn", (dvi_generator_options){.cells = {2, 2}}),
                       _i == 0 ? DVI_WHITNEY : DVI_BARYCENTRIC,
                       (dvi_maxwell_terms){.wall = &open, .walls = 1, .conductivity = sigma},
                       (dvi_march_options){.fraction = 0.9});
  ck_assert_int_le(s.edges, 25);
  memcpy(given, s.E, (size_t)s.edges * sizeof *given);
  sample(&s);
  for (int64_t e = 0; e < s.edges; e++) ck_assert_double_eq_tol(s.E[e], given[e], 1e-13);
  end_scene(&s);
}
END_TEST

/* All segments have the length 1, but one, which is between free ends and shorter. Alone, with the
 * parts of its ends that are its own, each has the square of frequency 4 / length^2. */
START_TEST(the_stiffest_cell_is_named)
{
  enum { POINTS = 9, SHORT = 5 };
  double x[POINTS] = {0};
  int vertex[2 * (POINTS - 1)];
  for (int i = 0; i < POINTS - 1; i++) {
    x[i + 1] = x[i] + (i == SHORT ? 0.9 : 1);
    vertex[2 * i] = i;
    vertex[2 * i + 1] = i + 1;
  }
  const dvi_mesh_terms of = {.size = sizeof of,
                             .dimension = 1,
                             .points = POINTS,
                             .point = x,
                             .cells = POINTS - 1,
                             .vertex = vertex};
  const dvi_star_options options = {.size = sizeof options, .kind = DVI_CIRCUMCENTRIC};
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  dvi_march *march = NULL;
  ck_assert_int_eq(dvi_mesh_create(&of, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_OK);
  const dvi_wave_terms terms = {.size = sizeof terms, .star = star};
  ck_assert_int_eq(dvi_wave_create(&terms, &field), DVI_OK);
  const dvi_march_options how = {.size = sizeof how, .step = 2};
  ck_assert_int_eq(dvi_march_create(field, &how, &march), DVI_BAD_ARGUMENT);
  check_words("(vertices 5 6) near (5, 0, 0)");
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static void start_at(scene *s, double size)
{
  for (int64_t e = 0; e < s->edges; e++) s->E[e] = (e % 2 ? 1 : -1) * size;
  const dvi_march_state state = {.size = sizeof state, .E = s->E};
  ck_assert_msg(dvi_march_start(s->march, &state) == DVI_OK, "%s", dvi_last_error());
}

/* The energy of fields of 1e200 overflows. */
START_TEST(an_energy_that_overflows_is_refused)
{
  double value = 7;
  scene s = make_scene(box(), DVI_CIRCUMCENTRIC, (dvi_maxwell_terms){0}, (dvi_march_options){0});
  start_at(&s, 1e200);
  advance_march(s.march, 10);
  ck_assert_str_eq(dvi_march_observable(s.march, 0), "energy");
  ck_assert_int_eq(dvi_march_observe(s.march, 0, &value), DVI_NOT_FINITE);
  check_words("energy");
  ck_assert_double_eq(value, 7);
  ck_assert_int_eq(dvi_march_sample(s.march, DVI_FORM_E, 0, NULL, s.E), DVI_OK);
  end_scene(&s);
}
END_TEST

/* Fields of 1e308 overflow. Then nothing is seen of the march until it is started again. */
START_TEST(values_that_overflow_are_refused)
{
  double value = 7;
  size_t size = 3;
  scene s = make_scene(box(), DVI_CIRCUMCENTRIC, (dvi_maxwell_terms){0}, (dvi_march_options){0});
  start_at(&s, 1.5e308);
  ck_assert_int_eq(dvi_march_advance(s.march, 10), DVI_NOT_FINITE);
  check_words("start from smaller values");
  s.E[0] = 5;
  ck_assert_int_eq(dvi_march_advance(s.march, 20), DVI_BAD_STATE);
  check_words("overflowed");
  ck_assert_int_eq(dvi_march_observe(s.march, 0, &value), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_march_sample(s.march, DVI_FORM_E, 0, NULL, s.E), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_march_save_memory(s.march, NULL, 0, &size), DVI_BAD_STATE);
  ck_assert_double_eq(value, 7);
  ck_assert_double_eq(s.E[0], 5);
  ck_assert_uint_eq(size, 3);
  start_at(&s, 1);
  advance_march(s.march, 1);
  ck_assert_double_gt(observe_march(s.march, "energy"), 0);
  end_scene(&s);
}
END_TEST

START_TEST(random_currents_keep_the_law_of_charge)
{
  static unsigned long long seed[2] = {3, 4};
  static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};
  double sigma[5 * 4 * 3];
  for (int i = 0; i < 60; i++) sigma[i] = 0.1 * (i % 3);
  const dvi_current current[2] = {
      {.density = swirl, .signal = pulse, .user = seed},
      {.at = {0.3, 0.4, 0.2}, .along = {1, -2, 0.5}, .signal = pulse, .user = seed + 1}};
  scene s = make_scene(
      box(), DVI_CIRCUMCENTRIC,
      (dvi_maxwell_terms){
          .wall = &open, .walls = 1, .conductivity = sigma, .current = current, .currents = 2},
      (dvi_march_options){.fraction = 0.9});
  advance_march(s.march, step_of_march(s.march) * (double)repeats(100000));
  ck_assert_double_lt(observe_march(s.march, "gauss"), 1e-12);
  end_scene(&s);
}
END_TEST

/* ---- the same bits ---- */

static void compare(const scene *a, const scene *b)
{
  sample(a);
  sample(b);
  ck_assert_mem_eq(a->E, b->E, (size_t)a->edges * sizeof(double));
  ck_assert_mem_eq(a->B, b->B, (size_t)a->faces * sizeof(double));
  ck_assert_double_eq(observe_march(a->march, "energy"), observe_march(b->march, "energy"));
  ck_assert_double_eq(observe_march(a->march, "gauss"), observe_march(b->march, "gauss"));
}

/* A current that ended at t = 0, by its values and by its integral. */
static int signal_of_the_past(double t, double *value, void *user)
{
  (void)user;
  *value = t < 0 ? 100 : 0;
  return 0;
}

static int impulse_of_the_past(double from, double to, double *value, void *user)
{
  (void)user;
  *value = 100 * (fmin(to, 0) - fmin(from, 0));
  return 0;
}

START_TEST(nothing_acts_that_came_before_the_start)
{
  for (int kind = 0; kind < 4; kind++) {
    const dvi_current dipole = {.at = {0.3, 0.3, 0.3},
                                .along = {0, 0, 1},
                                .signal = signal_of_the_past,
                                .impulse = kind % 2 ? impulse_of_the_past : NULL};
    scene s = make_scene(box(), kind < 2 ? DVI_CIRCUMCENTRIC : DVI_WHITNEY,
                         (dvi_maxwell_terms){.current = &dipole, .currents = 1},
                         (dvi_march_options){.fraction = 0.5});
    const dvi_march_state rest = {.size = sizeof rest};
    ck_assert_int_eq(dvi_march_start(s.march, &rest), DVI_OK);
    advance_march(s.march, 1);
    ck_assert_double_eq(observe_march(s.march, "energy"), 0);
    end_scene(&s);
  }
}
END_TEST

/* What differs are the places of a dipole, and the conductivities. */
START_TEST(states_of_other_sources_and_losses_are_refused)
{
  static unsigned long long seed = 3;
  const char *path = "foreign.state";
  double sigma[2][60];
  for (int c = 0; c < 60; c++) sigma[1][c] = 2 * (sigma[0][c] = 0.1);
  const dvi_current dipole[] = {
      {.at = {0.3, 0.3, 0.3}, .along = {0, 0, 1}, .signal = pulse, .user = &seed},
      {.at = {0.3, 0.5, 0.3}, .along = {0, 0, 1}, .signal = pulse, .user = &seed}};
  scene saved, other;
  for (int i = 0; i < 3; i++) {
    const dvi_maxwell_terms one = {.current = dipole, .currents = 1, .conductivity = sigma[0]},
                            two = {.current = dipole + (i == 0),
                                   .currents = 1,
                                   .conductivity = sigma[i == 1]};
    saved = make_scene(box(), DVI_CIRCUMCENTRIC, one, (dvi_march_options){.fraction = 0.5});
    other = make_scene(box(), DVI_CIRCUMCENTRIC, two, (dvi_march_options){.fraction = 0.5});
    ck_assert_int_eq(dvi_march_save(saved.march, path), DVI_OK);
    ck_assert_int_eq(dvi_march_load(other.march, path), i < 2 ? DVI_BAD_FILE : DVI_OK);
    end_scene(&saved);
    end_scene(&other);
  }
  (void)unlink(path);
}
END_TEST

START_TEST(cuts_threads_and_saved_states_keep_the_bits)
{
  static unsigned long long seed = 3;
  static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};
  const dvi_current current = {.density = swirl, .signal = pulse, .user = &seed};
  const dvi_maxwell_terms terms = {.wall = &open, .walls = 1, .current = &current, .currents = 1};
  const char *path = "leapfrog.state";
  for (int kind = 0; kind < 2; kind++) {
    const dvi_star_kind star = kind ? DVI_WHITNEY : DVI_CIRCUMCENTRIC;
    scene whole = make_scene(box(), star, terms, (dvi_march_options){.fraction = 0.5}),
          cut = make_scene(box(), star, terms, (dvi_march_options){.fraction = 0.5, .threads = 3}),
          resumed = make_scene(box(), star, terms, (dvi_march_options){.fraction = 0.5});
    advance_march(whole.march, 2.5);
    for (int i = 1; i <= 50; i++) {
      advance_march(cut.march, 0.05 * i);
      (void)observe_march(cut.march, "energy");
      sample(&cut);
      if (i == 20) ck_assert_msg(dvi_march_save(cut.march, path) == DVI_OK, "%s", dvi_last_error());
    }
    compare(&whole, &cut);
    ck_assert_msg(dvi_march_load(resumed.march, path) == DVI_OK, "%s", dvi_last_error());
    ck_assert_double_eq(dvi_march_time(resumed.march), 1);
    advance_march(resumed.march, 2.5);
    compare(&whole, &resumed);
    end_scene(&whole);
    end_scene(&cut);
    end_scene(&resumed);
  }
  (void)unlink(path);
}
END_TEST

START_TEST(steps_allocate_nothing)
{
  for (int kind = 0; kind < 2; kind++) {
    scene s = make_scene(box(), kind ? DVI_WHITNEY : DVI_CIRCUMCENTRIC,
                         (dvi_maxwell_terms){.wall = &pec, .walls = 1},
                         (dvi_march_options){.fraction = 0.5});
    const long before = dvi__allocation_count();
    advance_march(s.march, 20 * step_of_march(s.march));
    sample(&s);
    ck_assert_int_eq(dvi__allocation_count(), before);
    end_scene(&s);
  }
}
END_TEST

SUITE(leapfrog)
{
  tcase_add_test(tests, steps_allocate_nothing);
  tcase_add_test(tests, energy_and_charge_are_conserved_to_roundoff);
  tcase_add_test(tests, time_and_space_disperse_as_known);
  tcase_add_test(tests, a_conductor_damps_as_the_difference_equation_says);
  tcase_add_test(tests, absorbing_walls_absorb);
  tcase_add_loop_test(tests, lossy_fields_start_with_what_is_given, 0, 2);
  tcase_add_test(tests, the_stiffest_cell_is_named);
  tcase_add_test(tests, an_energy_that_overflows_is_refused);
  tcase_add_test(tests, values_that_overflow_are_refused);
  tcase_add_test(tests, random_currents_keep_the_law_of_charge);
  tcase_add_test(tests, cuts_threads_and_saved_states_keep_the_bits);
  tcase_add_test(tests, nothing_acts_that_came_before_the_start);
  tcase_add_test(tests, states_of_other_sources_and_losses_are_refused);
}
