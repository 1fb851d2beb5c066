/* labels: unit */
/* Boundaries that move or are held by springs, unequal cells, and densities of other kinds. */
#include <dvi/dvi.h>
#include <math.h>

#include "support/field/marches.h"
#include "support/suite.h"
#include "support/waves/lattices.h"

static const double pi = 3.14159265358979323846;

/* ---- conditions ---- */

static int moving_wall(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) datum[i] = sin(t - x[i]);
  return 0;
}

static int moving_wall_rate(int64_t count, double t, const double *x, double *rate, double *second,
                            void *user)
{
  (void)second, (void)user;
  for (int64_t i = 0; i < count; i++) rate[i] = cos(t - x[i]);
  return 0;
}

static double sine_wave(double t, const double *x, const void *of)
{
  (void)of;
  return sin(t - x[0]);
}

/* u = sin(t - x) on [0,1] between walls that move, of order 2. */
START_TEST(walls_may_move)
{
  static const double weight[][2] = {{0, 0}, {1. / 6, 1. / 6}, {.25, .25}, {1. / 6, .25}};
  double before = 0;
  for (int cells = 20; cells <= 160; cells *= 2) {
    lattice w = {.cells = cells,
                 .to = 1,
                 .fixed = 1,
                 .space = weight[_i][0],
                 .time = weight[_i][1],
                 .step = .8 / cells};
    lattice_terms(&w);
    w.condition.datum = moving_wall;
    w.condition.rate = moving_wall_rate;
    dvi_march *march = NULL;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, sine_wave, NULL);
    advance_march(march, 2);
    const double error = lattice_distance(march, &w, sine_wave, NULL);
    if (cells > 40) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
  }
}
END_TEST

/* du/dn of sin(t - x). */
static int moving_flux(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) datum[i] = (x[i] < .5 ? 1 : -1) * cos(t - x[i]);
  return 0;
}

START_TEST(fluxes_may_move)
{
  static const double weight[][2] = {{0, 0}, {1. / 6, 1. / 6}, {1. / 6, .25}};
  double before = 0;
  for (int cells = 20; cells <= 160; cells *= 2) {
    lattice w = {.cells = cells,
                 .to = 1,
                 .fixed = 1,
                 .space = weight[_i][0],
                 .time = weight[_i][1],
                 .step = .8 / cells};
    lattice_terms(&w);
    w.condition.kind = DVI_FREE;
    w.condition.datum = moving_flux;
    w.condition.rate = moving_wall_rate; /* it tells that the datum moves */
    dvi_march *march = NULL;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, sine_wave, NULL);
    advance_march(march, 2);
    const double error = lattice_distance(march, &w, sine_wave, NULL);
    if (cells > 40) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
  }
}
END_TEST

/* cos .8x cos .8t cos .8y on a square has the flux -a u with a = .8 tan .8 where x = 1 or y = 1. */
static double sprung(double t, const double *x, const void *of)
{
  (void)of;
  return cos(.8 * x[0]) * cos(.8 * x[1]) * cos(.8 * sqrt(2) * t);
}

START_TEST(springs_hold_the_boundary)
{
  double before = 0;
  for (int cells = 16; cells <= 64; cells *= 2) {
    lattice w = {.axes = 2,
                 .cells = cells,
                 .to = 1,
                 .fixed = 1,
                 .space = 1. / 6,
                 .time = 1. / 6,
                 .step = .5 / cells};
    lattice_terms(&w);
    dvi_density_condition ends[2] = {w.condition, w.condition};
    ends[0].part = "right", ends[1].part = "top";
    for (int k = 0; k < 2; k++) ends[k].kind = DVI_FREE, ends[k].robin = .8 * tan(.8);
    w.terms.condition = ends;
    w.terms.conditions = 2;
    dvi_march *march = NULL;
    dvi_law law[DVI_LAWS_MAX];
    int count;
    double energy, later;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, sprung, NULL);
    ck_assert_int_eq(dvi_march_observe(march, 0, &energy), DVI_OK);
    advance_march(march, 2);
    ck_assert_int_eq(dvi_march_observe(march, 0, &later), DVI_OK);
    ck_assert_double_eq_tol(energy, later, 1e-13); /* roundings */
    const double error = lattice_distance(march, &w, sprung, NULL);
    if (before > 0) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
    ck_assert_int_eq(dvi_multisymplectic_laws(&w.terms, NULL, 10, 3, law, &count), DVI_OK);
    ck_assert_double_lt(law[0].error, 1e-14);
    ck_assert_double_lt(law[1].error, 1e-13);
  }
}
END_TEST

/* Unequal cells, which a free end and a wall close, still have order 2 where they change slowly. */
static double quarter_wave(double t, const double *x, const void *of)
{
  (void)of;
  return cos(x[0] / 4) * cos(t / 4);
}

START_TEST(cells_may_be_unequal)
{
  double before = 0;
  for (int cells = 20; cells <= 160; cells *= 2) {
    double node[161];
    lattice w = {.cells = cells, .space = _i / 6.0, .time = .25, .step = 4.0 / cells};
    lattice_terms(&w);
    for (int i = 0; i <= cells; i++)
      node[i] = 2 * pi * ((double)i / cells + .05 * sin(2 * pi * i / cells));
    node[cells] = w.to;
    w.axis[0].periodic = 0;
    w.axis[0].node = node;
    w.axis[0].nodes = cells + 1;
    w.condition.part = "right";
    w.terms.conditions = 1;
    dvi_march *march = NULL;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    double energy, later;
    lattice_start(march, &w, quarter_wave, NULL);
    ck_assert_int_eq(dvi_march_observe(march, 0, &energy), DVI_OK);
    advance_march(march, 10);
    ck_assert_int_eq(dvi_march_observe(march, 0, &later), DVI_OK);
    ck_assert_double_eq_tol(energy, later, 1e-13); /* roundings */
    const double error = lattice_distance(march, &w, quarter_wave, NULL);
    if (cells > 40) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
  }
}
END_TEST
/* ---- other densities ---- */

static double right_going(double t, const double *x, const void *of)
{
  (void)of;
  return .4 * exp(sin(x[0] - t));
}

START_TEST(densities_may_be_nonlinear_in_the_rates)
{
  static const double weight[][2] = {{0, 0}, {1. / 6, 1. / 6}, {.25, .25}};
  double before = 0;
  for (int cells = 41; cells <= 330; cells *= 2) {
    lattice w = {.cells = cells + 1 - cells % 2, .step = .5 * 2 * pi / cells};
    lattice_terms(&w);
    w.terms.part = &lattice_strings;
    w.terms.parts = 1;
    w.terms.weights.space[0] = weight[_i][0];
    w.terms.weights.time = weight[_i][1];
    dvi_march *march = NULL;
    dvi_law law[DVI_LAWS_MAX];
    int count;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, right_going, NULL);
    advance_march(march, 2);
    const double error = lattice_distance(march, &w, right_going, NULL);
    if (cells > 100) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
    double u[400], E[400];
    for (int i = 0; i < w.terms.cells[0]; i++)
      u[i] = right_going(0, (double[]){2 * pi * i / w.terms.cells[0]}, NULL), E[i] = .2 * u[i];
    const dvi_march_state start = {.size = sizeof start, .A = u, .E = E};
    ck_assert_int_eq(dvi_multisymplectic_laws(&w.terms, &start, 6, 3, law, &count), DVI_OK);
    ck_assert_double_lt(law[0].error, 1e-13);
    ck_assert_double_lt(law[1].error, 1e-12);
  }
}
END_TEST
/* u_tt - u_xx = f with f = -3 sin x cos 2t has the solution sin x cos 2t. */
static int source(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)user;
  for (int i = 0; i < count; i++) {
    const double f = -3 * sin(x[i]) * cos(2 * t);
    if (l != NULL) l[i] = f * z[i];
    if (l_z != NULL) l_z[i] = f;
    if (l_zz != NULL) l_zz[i] = 0;
  }
  return 0;
}

static double driven(double t, const double *x, const void *of)
{
  (void)of;
  return sin(x[0]) * cos(2 * t);
}

START_TEST(densities_may_depend_on_time_and_place)
{
  static const dvi_jet value = {.component = 0};
  double before = 0;
  for (int cells = 41; cells <= 330; cells *= 2) {
    lattice w = {.cells = cells + 1 - cells % 2,
                 .space = _i / 6.0,
                 .time = _i * .25,
                 .step = .7 * 2 * pi / cells};
    lattice_terms(&w);
    w.part[2] = (dvi_density_part){.kind = DVI_DENSITY_QUADRATIC,
                                   .variable = &value,
                                   .variables = 1,
                                   .density = source,
                                   .depends_on_time = 1};
    w.terms.parts = 3;
    dvi_march *march = NULL;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, driven, NULL);
    advance_march(march, cells * w.step); /* at a level */
    const double error = lattice_distance(march, &w, driven, NULL);
    if (cells > 100) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
  }
}
END_TEST

/* l = (u_t + u_x/2)^2/2 - u_x^2/2, a wave in a frame that moves, with z = (u_t, u_x). Its matrix is
 * not symmetric. */
static int moving_frame(int count, double t, const double *x, const double *z, double *l,
                        double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int i = 0; i < count; i++) {
    const double w = z[count + i], v = z[i] + w / 2;
    if (l != NULL) l[i] = v * v / 2 - w * w / 2;
    if (l_z != NULL) l_z[i] = v, l_z[count + i] = v / 2 - w;
    if (l_zz != NULL) l_zz[i] = 1, l_zz[count + i] = .5, l_zz[2 * count + i] = -.75;
  }
  return 0;
}

static double slow_wave(double t, const double *x, const void *of)
{
  (void)of;
  return exp(sin(x[0] - 1.5 * t));
}

START_TEST(densities_may_mix_rates_and_derivatives)
{
  static const dvi_jet slopes[] = {{.rate = 1}, {.order = {1, 0, 0}}};
  static const dvi_density_part part = {
      .kind = DVI_DENSITY_GENERAL, .variable = slopes, .variables = 2, .density = moving_frame};
  static const double weight[] = {0, 1. / 6, .25};
  double before = 0;
  for (int cells = 41; cells <= 330; cells *= 2) {
    lattice w = {.cells = cells + 1 - cells % 2,
                 .space = weight[_i],
                 .time = weight[_i],
                 .step = .4 * 2 * pi / cells};
    lattice_terms(&w);
    w.terms.part = &part;
    w.terms.parts = 1;
    dvi_march *march = NULL;
    dvi_law law[DVI_LAWS_MAX];
    int count;
    double energy, later;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, slow_wave, NULL);
    ck_assert_int_eq(dvi_march_observe(march, 0, &energy), DVI_OK);
    advance_march(march, 2);
    ck_assert_int_eq(dvi_march_observe(march, 0, &later), DVI_OK);
    ck_assert_double_eq_tol(energy, later, 1e-12); /* roundings */
    const double error = lattice_distance(march, &w, slow_wave, NULL);
    if (cells > 100) ck_assert_double_eq_tol(log2(before / error), 2, 0.2);
    before = error;
    dvi_march_destroy(&march);
    ck_assert_int_eq(dvi_multisymplectic_laws(&w.terms, NULL, 8, 5, law, &count), DVI_OK);
    for (int i = 0; i < count; i++) ck_assert_double_lt(law[i].error, 1e-13);
  }
}
END_TEST

/* Springs of 2/h on cells of length h: the end cells have the stiffness [[1,-1],[-1,3]]/h and the
 * mass h/2. In the plane no formula is at hand. Beyond their bound, springs let the field grow. */
START_TEST(springs_bound_the_steps)
{
  const int axes = 1 + _i;
  const double h = .1;
  lattice w = {.axes = axes, .cells = 10, .to = 1, .fixed = 1, .space = _i == 0 ? 0 : 1. / 6};
  dvi_march *march = NULL;
  dvi_march_facts facts;
  double energy, later;
  lattice_terms(&w);
  w.condition.kind = DVI_FREE;
  w.condition.robin = _i == 0 ? 2 / h : 100 / h;
  w.terms.fraction = .999;
  ck_assert_msg(dvi_multisymplectic_create(&w.terms, &march) == DVI_OK, "%s", dvi_last_error());
  dvi_march_facts_of(march, &facts);
  if (_i == 0) ck_assert_double_eq_tol(facts.bound, 2 * h / sqrt(2 * (2 + sqrt(2))), 1e-14);
  lattice_start(march, &w, sine_wave, NULL);
  ck_assert_int_eq(dvi_march_observe(march, 0, &energy), DVI_OK);
  advance_march(march, 1000 * facts.step);
  ck_assert_int_eq(dvi_march_observe(march, 0, &later), DVI_OK);
  ck_assert_double_eq_tol(later, energy, 1e-11 * energy); /* roundings of a thousand steps */
  dvi_march_destroy(&march);
}
END_TEST

SUITE(lattice_ends)
{
  tcase_add_loop_test(tests, walls_may_move, 0, 4);
  tcase_add_loop_test(tests, fluxes_may_move, 0, 3);
  tcase_add_test(tests, springs_hold_the_boundary);
  tcase_add_loop_test(tests, springs_bound_the_steps, 0, 2);
  tcase_add_loop_test(tests, cells_may_be_unequal, 0, 2);
  tcase_add_loop_test(tests, densities_may_depend_on_time_and_place, 0, 2);
  tcase_add_loop_test(tests, densities_may_mix_rates_and_derivatives, 0, 3);
  tcase_add_loop_test(tests, densities_may_be_nonlinear_in_the_rates, 0, 3);
}
