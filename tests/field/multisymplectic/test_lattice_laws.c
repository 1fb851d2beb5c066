/* labels: unit */
/* What lattices conserve: the multisymplectic form, what belongs to symmetries, energy and momentum
 * in each place by the box scheme, and of the whole field. And the bound of the steps. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/marches.h"
#include "support/suite.h"
#include "support/waves/lattices.h"

static const double pi = 3.14159265358979323846;

static double observe(const dvi_march *march, const char *name)
{
  double value = (double)NAN;
  int i = 0;
  while (dvi_march_observable(march, i) != NULL &&
         strcmp(dvi_march_observable(march, i), name) != 0)
    i++;
  ck_assert_ptr_nonnull(dvi_march_observable(march, i));
  ck_assert_int_eq(dvi_march_observe(march, i, &value), DVI_OK);
  return value;
}

static double law_named(const dvi_law *law, int count, const char *name)
{
  for (int i = 0; i < count; i++)
    if (strcmp(law[i].name, name) == 0) return law[i].error;
  ck_abort_msg("there is no law %s", name);
  return (double)NAN;
}

static const double weight[][2] = {
    {0, 0}, {1. / 6, 1. / 6}, {1. / 12, 1. / 12}, {1. / 4, 1. / 4}, {1. / 6, 1. / 4}};

enum { WEIGHTS = sizeof weight / sizeof *weight };

static int laws_of(const dvi_multisymplectic_terms *terms, int steps, dvi_law *law)
{
  int count = 0;
  const dvi_status status = dvi_multisymplectic_laws(terms, NULL, steps, 7, law, &count);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  return count;
}

/* ---- form formula ---- */

/* Errors are those of sums of some thousand terms, which cancel to a part of 1e-15 of their sizes.
 * At vertices inside the equations are solved to a few roundings. */
START_TEST(random_sets_of_cells_have_the_form_formula)
{
  static const char *const V[] = {"sine", "quartic"};
  const int i = _i % WEIGHTS, axes = 1 + _i / WEIGHTS % 2, variant = _i / WEIGHTS / 2;
  lattice w = {.axes = axes,
               .cells = axes == 1 ? 41 : 11,
               .space = weight[i][0],
               .time = weight[i][1],
               .V = V[variant % 2],
               .in_one = variant % 2,
               .levels = variant == 2,
               .fixed = variant > 0};
  dvi_law law[DVI_LAWS_MAX];
  lattice_terms(&w);
  w.terms.step = .6 * 2 * pi / w.cells / axes;
  const int count = laws_of(&w.terms, 30, law);
  ck_assert_double_lt(law_named(law, count, "multisymplectic"), 1e-14);
  ck_assert_double_lt(law_named(law, count, "linearised"), 1e-13);
  ck_assert_int_eq(law[0].is_exact, 1);
}
END_TEST

/* ---- symmetries ---- */

/* Two components with l = |u_t|^2/2 - |u_x|^2/2 - |u|^4/4, and z = (u, v, u_t, v_t, u_x, v_x). */
static int rotor(int count, double t, const double *x, const double *z, double *l, double *l_z,
                 double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  if (l_zz != NULL) memset(l_zz, 0, (size_t)(21 * count) * sizeof *l_zz);
  for (int i = 0; i < count; i++) {
    const double u = z[i], v = z[count + i], square = u * u + v * v;
    if (l != NULL) l[i] = -square * square / 4;
    if (l_z != NULL) l_z[i] = -square * u, l_z[count + i] = -square * v;
    if (l_zz != NULL) {
      l_zz[i] = -square - 2 * u * u;
      l_zz[count + i] = -2 * u * v;
      l_zz[2 * count + i] = -square - 2 * v * v;
    }
    for (int a = 2; a < 6; a++) {
      const double sign = a < 4 ? 1 : -1, d = z[a * count + i];
      if (l != NULL) l[i] += sign * d * d / 2;
      if (l_z != NULL) l_z[a * count + i] = sign * d;
      if (l_zz != NULL) l_zz[(a * (a + 1) / 2 + a) * count + i] = sign;
    }
  }
  return 0;
}

static int turn(int64_t count, const double *u, double *xi, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) {
    xi[i] = -u[count + i];
    xi[count + i] = u[i];
  }
  return 0;
}

static const dvi_jet rotor_jets[] = {{.component = 0}, {.component = 1},  {0, 1, {0}},
                                     {1, 1, {0}},      {0, 0, {1, 0, 0}}, {1, 0, {1, 0, 0}}};
static const dvi_density_part rotor_part = {
    .kind = DVI_DENSITY_GENERAL, .variable = rotor_jets, .variables = 6, .density = rotor};
static const dvi_multisymplectic_symmetry rotation = {.name = "charge", .field = turn};

static dvi_multisymplectic_terms rotors(const dvi_axis *axis, int i)
{
  return (dvi_multisymplectic_terms){.size = sizeof(dvi_multisymplectic_terms),
                                     .axis = axis,
                                     .axes = 1,
                                     .cells = {25},
                                     .components = 2,
                                     .part = &rotor_part,
                                     .parts = 1,
                                     .weights = {.space = {weight[i][0]}, .time = weight[i][1]},
                                     .step = .1,
                                     .symmetry = &rotation,
                                     .symmetries = 1};
}

START_TEST(symmetries_fulfil_noethers_theorem_on_sets_of_cells)
{
  const dvi_axis axis = {.from = 0, .to = 2 * pi, .periodic = 1};
  const dvi_multisymplectic_terms terms = rotors(&axis, _i);
  dvi_law law[DVI_LAWS_MAX];
  const int count = laws_of(&terms, 30, law);
  ck_assert_double_lt(law_named(law, count, "noether"), 1e-13);
  ck_assert_double_lt(law_named(law, count, "multisymplectic"), 1e-14);
}
END_TEST

/* Roundings of a thousand steps, which are random, of 1e-15 each. */
START_TEST(symmetries_conserve_what_belongs_to_them)
{
  const dvi_axis axis = {.from = 0, .to = 2 * pi, .periodic = 1};
  const dvi_multisymplectic_terms terms = rotors(&axis, _i);
  double A[50], E[50];
  dvi_march *march = NULL;
  for (int k = 0; k < 25; k++) {
    const double x = 2 * pi * k / 25;
    A[k] = 1 + .3 * cos(x), A[25 + k] = .2 * sin(2 * x);
    E[k] = .3 * sin(x), E[25 + k] = -1;
  }
  ck_assert_int_eq(dvi_multisymplectic_create(&terms, &march), DVI_OK);
  const dvi_march_state start = {.size = sizeof start, .A = A, .E = E};
  ck_assert_int_eq(dvi_march_start(march, &start), DVI_OK);
  const double charge = observe(march, "charge"), energy = observe(march, "energy");
  advance_march(march, 100);
  ck_assert_double_gt(charge, 1);
  ck_assert_double_eq_tol(observe(march, "charge"), charge, 1e-12 * charge);
  ck_assert_double_eq_tol(observe(march, "energy"), energy, 1e-2 * energy);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- the box scheme ---- */

START_TEST(the_box_scheme_has_local_laws_of_energy_and_momentum)
{
  lattice w = {.axes = 1 + _i % 2,
               .cells = _i % 2 ? 9 : 31,
               .space = .25,
               .time = .25,
               .V = _i / 2 % 2 ? "mass" : "none",
               .in_one = _i / 4 % 2,
               .fixed = _i / 8};
  dvi_law law[DVI_LAWS_MAX];
  lattice_terms(&w);
  w.terms.step = .8 * 2 * pi / w.cells;
  const int count = laws_of(&w.terms, 40, law);
  ck_assert_double_lt(law_named(law, count, "energy"), 1e-14);
  ck_assert_double_lt(law_named(law, count, "momentum"), 1e-14);
}
END_TEST

/* With V = 1 - cos u they have errors of order 2, and other weights have no such laws. */
START_TEST(local_laws_are_those_of_quadratic_densities)
{
  lattice w = {.cells = 31, .space = .25, .time = .25, .V = "sine", .step = .1};
  dvi_law law[DVI_LAWS_MAX];
  int count = laws_of(lattice_terms(&w), 10, law);
  ck_assert_int_eq(count, 4);
  ck_assert_double_gt(law_named(law, count, "energy"), 1e-6);
  w.space = w.time = 1. / 6;
  count = laws_of(lattice_terms(&w), 10, law);
  ck_assert_int_eq(count, 2);
}
END_TEST

/* ---- energy and momentum of the whole ---- */

static double lump(double t, const double *x, const void *of)
{
  (void)of;
  return exp(sin(x[0] - t)) + .5 * cos(2 * x[0] + 1.3 * t);
}

START_TEST(quadratic_densities_conserve_energy_and_momentum)
{
  lattice w = {.cells = 41,
               .space = weight[_i % WEIGHTS][0],
               .time = weight[_i % WEIGHTS][1],
               .V = _i / WEIGHTS ? "mass" : "none",
               .step = .11};
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, lump, NULL);
  const double energy = observe(march, "energy"), momentum = observe(march, "momentum_x");
  advance_march(march, 1000 * w.step);
  /* roundings of a thousand steps */
  ck_assert_double_eq_tol(observe(march, "energy"), energy, 1e-12 * energy);
  ck_assert_double_eq_tol(observe(march, "momentum_x"), momentum, 1e-12 * energy);
  dvi_march_destroy(&march);
}
END_TEST

/* Both integrals, of u_t^2/2 + u_x^2/2 and -u_t u_x, are that of exp(2 sin x) cos^2 x over a
 * period, pi I_1(2). */
static double right(double t, const double *x, const void *of)
{
  (void)of;
  return exp(sin(x[0] - t));
}

START_TEST(energy_and_momentum_have_their_values)
{
  const double exact = pi * 1.5906368546373291; /* I_1(2) */
  double before = 0;
  for (int cells = 41; cells < 400; cells *= 2) {
    lattice w = {.cells = cells + cells % 2 + 1,
                 .space = weight[_i][0],
                 .time = weight[_i][1],
                 .step = .6 * 2 * pi / cells};
    dvi_march *march = lattice_march(&w);
    lattice_start(march, &w, right, NULL);
    const double error = fmax(fabs(observe(march, "energy") - exact),
                              fabs(observe(march, "momentum_x") - exact));
    if (before > 0) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
  }
}
END_TEST

/* ---- steps ---- */

/* The bound of the header, for waves on one to three axes. */
START_TEST(the_bound_is_that_of_the_weights)
{
  static const double in_time[] = {0, 1. / 12, 1. / 6}, in_space[] = {0, 1. / 12, 1. / 6, .2};
  lattice w = {.axes = 1 + _i / 12,
               .cells = 5 + _i / 12,
               .space = in_space[_i % 4],
               .time = in_time[_i / 4 % 3],
               .step = 1e-3};
  dvi_march_facts facts;
  dvi_march *march = lattice_march(&w);
  dvi_march_facts_of(march, &facts);
  const double dx = 2 * pi / w.cells;
  ck_assert_double_eq_tol(facts.bound, dx * sqrt((1 - 4 * w.space) / (1 - 4 * w.time) / w.axes),
                          1e-12);
  dvi_march_destroy(&march);
}
END_TEST

START_TEST(steps_beyond_the_bound_are_refused_with_it)
{
  lattice w = {.cells = 10, .step = 1.0001 * 2 * pi / 10};
  dvi_march *march = NULL;
  ck_assert_int_eq(dvi_multisymplectic_create(lattice_terms(&w), &march), DVI_BAD_ARGUMENT);
  check_words("beyond the bound 0.62831853071795");
  ck_assert_ptr_null(march);
  w.time = .25;
  march = lattice_march(&w);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  ck_assert(isinf(facts.bound));
  dvi_march_destroy(&march);
}
END_TEST

/* The shortest wave is stable below the bound. */
static double alternating(double t, const double *x, const void *of)
{
  (void)t;
  return cos(x[0] * *(const double *)of);
}

START_TEST(waves_stay_bounded_up_to_the_bound)
{
  static const double in_time[] = {0, 1. / 12, 1. / 6, .25};
  const double k = 10;
  lattice w = {.cells = 20, .space = 1. / 6, .time = in_time[_i], .V = "mass"};
  w.step = _i == 3 ? 5 : 0;
  lattice_terms(&w);
  w.terms.fraction = .999;
  dvi_march *march = NULL;
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
  lattice_start(march, &w, alternating, &k);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  advance_march(march, 10000 * facts.step);
  double u[20];
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u), DVI_OK);
  /* close to the bound modes grow at first to 1/sqrt(1 - .999) of their start */
  for (int i = 0; i < 20; i++) ck_assert_double_lt(fabs(u[i]), 40);
  dvi_march_destroy(&march);
}
END_TEST

START_TEST(a_midpoint_in_space_needs_a_mass_that_sees_all)
{
  lattice w = {.cells = 20, .space = .25, .time = .25, .step = .1};
  dvi_march *march = NULL;
  ck_assert_int_eq(dvi_multisymplectic_create(lattice_terms(&w), &march), DVI_BAD_ARGUMENT);
  check_words("take an odd number of cells");
  w.cells = 21;
  lattice_terms(&w);
  w.axis[0].periodic = 0;
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_BAD_ARGUMENT);
  check_words("whose ends are free");
  w.condition.part = "left";
  w.terms.conditions = 1;
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
  dvi_march_destroy(&march);
  w.time = .2;
  ck_assert_int_eq(dvi_multisymplectic_create(lattice_terms(&w), &march), DVI_BAD_ARGUMENT);
  check_words("unless the weight of time");
}
END_TEST

SUITE(lattice_laws)
{
  tcase_add_loop_test(tests, random_sets_of_cells_have_the_form_formula, 0, 6 * WEIGHTS);
  tcase_add_loop_test(tests, symmetries_fulfil_noethers_theorem_on_sets_of_cells, 0, WEIGHTS);
  tcase_add_loop_test(tests, symmetries_conserve_what_belongs_to_them, 0, WEIGHTS);
  tcase_add_loop_test(tests, the_box_scheme_has_local_laws_of_energy_and_momentum, 0, 16);
  tcase_add_test(tests, local_laws_are_those_of_quadratic_densities);
  tcase_add_loop_test(tests, quadratic_densities_conserve_energy_and_momentum, 0, 2 * WEIGHTS);
  tcase_add_loop_test(tests, energy_and_momentum_have_their_values, 0, WEIGHTS);
  tcase_add_loop_test(tests, the_bound_is_that_of_the_weights, 0, 36);
  tcase_add_test(tests, steps_beyond_the_bound_are_refused_with_it);
  tcase_add_loop_test(tests, waves_stay_bounded_up_to_the_bound, 0, 4);
  tcase_add_test(tests, a_midpoint_in_space_needs_a_mass_that_sees_all);
}
