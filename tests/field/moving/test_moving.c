/* Fields on moving meshes: derivatives of the Lagrangian, static states, and bad input. */
#include <dvi/moving.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/moving_fields.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_moving *create(const dvi_moving_terms *terms)
{
  dvi_moving *moving = NULL;
  ck_assert_msg(dvi_moving_create(terms, &moving) == DVI_OK, "%s", dvi_last_error());
  return moving;
}

/* ---- derivatives ---- */

/* A density of two components that depends on all, and on x. */
static int tangle(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) {
    const double a = 1 + 0.3 * sin(x[k]), u = z[k], w = z[count + k], u_t = z[2 * count + k],
                 w_t = z[3 * count + k], u_x = z[4 * count + k], w_x = z[5 * count + k];
    const double value[6] = {-sin(u) * w_x,           2 * w * u_t,
                             u_t + w * w + 0.2 * w_t, w_t + 0.2 * u_t,
                             -a * u_x * (1 + w_x),    -w_x + cos(u) - a * u_x * u_x / 2};
    if (l != NULL)
      l[k] = (u_t * u_t + w_t * w_t) / 2 + 0.2 * u_t * w_t + w * w * u_t + cos(u) * w_x -
             a * u_x * u_x / 2 * (1 + w_x) - w_x * w_x / 2;
    for (int j = 0; j < 6 && l_z != NULL; j++) l_z[j * count + k] = value[j];
    if (l_zz == NULL) continue;
    for (int p = 0; p < 21; p++) l_zz[p * count + k] = 0;
    l_zz[0 * count + k] = -cos(u) * w_x; /* u u */
    l_zz[2 * count + k] = 2 * u_t;       /* w w */
    l_zz[4 * count + k] = 2 * w;         /* u_t w */
    l_zz[5 * count + k] = 1;
    l_zz[8 * count + k] = 0.2;
    l_zz[9 * count + k] = 1;
    l_zz[14 * count + k] = -a * (1 + w_x);
    l_zz[15 * count + k] = -sin(u); /* w_x u */
    l_zz[19 * count + k] = -a * u_x;
    l_zz[20 * count + k] = -1;
  }
  return 0;
}

static int tangle_by_x(int count, double t, const double *x, const double *z, double *l_x,
                       double *l_xz, double *l_xx, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) {
    const double u_x = z[4 * count + k], w_x = z[5 * count + k], a_x = 0.3 * cos(x[k]);
    l_x[k] = -a_x * u_x * u_x / 2 * (1 + w_x);
    if (l_xx != NULL) l_xx[k] = 0.3 * sin(x[k]) * u_x * u_x / 2 * (1 + w_x);
    if (l_xz == NULL) continue;
    for (int j = 0; j < 4; j++) l_xz[j * count + k] = 0;
    l_xz[4 * count + k] = -a_x * u_x * (1 + w_x);
    l_xz[5 * count + k] = -a_x * u_x * u_x / 2;
  }
  return 0;
}

static const dvi_jet both[] = {{0},
                               {.component = 1},
                               {.rate = 1},
                               {.component = 1, .rate = 1},
                               {.order = {1}},
                               {.component = 1, .order = {1}}};
static const dvi_density_part tangled = {.variable = both, .variables = 6, .density = tangle};

/* A mean of two components, u_l w_r^2 + sin(w_l) u_r. */
static int mixed_mean(int count, const double *left, const double *right, double *mean,
                      double *first, double *second, void *user)
{
  (void)count, (void)user;
  const double a = left[0], b = left[1], c = right[0], d = right[1];
  *mean = a * d * d + sin(b) * c;
  const double of_first[4] = {d * d, cos(b) * c, sin(b), 2 * a * d};
  const double of_second[10] = {0, 0, -sin(b) * c, 0, cos(b), 0, 2 * d, 0, 0, 2 * a};
  if (first != NULL) memcpy(first, of_first, sizeof of_first);
  if (second != NULL) memcpy(second, of_second, sizeof of_second);
  return 0;
}

static int sway(int count, double t, const double *X, double *x, double *rate, void *user)
{
  (void)user;
  for (int k = 0; k < count; k++) {
    x[k] = X[k] + 0.1 * sin(X[k] + t);
    rate[k] = 0.1 * cos(X[k] + t);
  }
  return 0;
}

/* Check all derivatives of a field at a state with uneven cells. */
static void check_derivatives(const dvi_moving_terms *terms)
{
  dvi_moving *moving = create(terms);
  dvi_system *system = NULL;
  int cells;
  const double *node = dvi_moving_nodes(moving, &cells);
  double x[16], u[32], x_rate[16], u_rate[32], q[64], v[64];
  dvi_derivative_check found;
  for (int k = 0; k <= cells; k++) {
    x[k] = node[k] + 0.1 * sin(3.0 * k);
    x_rate[k] = 0.4 * cos(2.0 * k);
    for (int c = 0; c < 2; c++) u[c * (cells + 1) + k] = sin(1.7 * k + c);
    for (int c = 0; c < 2; c++) u_rate[c * (cells + 1) + k] = cos(2.3 * k + 2 * c);
  }
  ck_assert_msg(!dvi_moving_project(moving, 0, x, u, x_rate, u_rate, q, v, NULL), "%s",
                dvi_last_error());
  ck_assert_msg(!dvi_moving_system(moving, &system), "%s", dvi_last_error());
  ck_assert_msg(!dvi_system_check(system, 0, q, v, 1e-8, &found), "%s", dvi_last_error());
  dvi_system_destroy(&system);
  dvi_moving_destroy(&moving);
}

START_TEST(derivatives_agree_with_differences)
{
  const double jump[2] = {0.7, -0.4};
  const dvi_moving_mean mean = {.mean = mixed_mean};
  for (int k = 0; k < 24; k++) {
    const dvi_moving_motion motion = (dvi_moving_motion)(k % 3);
    const int moves = motion != DVI_MOVING_PRESCRIBED;
    const int periodic = k / 3 % 2, rough = k / 6 % 2, few = k / 12;
    check_derivatives(&(dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                                          .axis = {.to = 2 * pi, .periodic = periodic},
                                          .cells = few ? 3 - (motion != DVI_MOVING_EQUAL) : 5,
                                          .components = 2,
                                          .part = &tangled,
                                          .mean = &mean,
                                          .space_derivative = tangle_by_x,
                                          .motion = motion,
                                          .stretch = motion == DVI_MOVING_EQUAL ? 0.8 : 0,
                                          .path = moves ? NULL : sway,
                                          .mu = moves ? 0.3 : 0,
                                          .kappa = moves ? 0.2 : 0,
                                          .left = {.kind = periodic ? DVI_FREE : DVI_FIXED},
                                          .jump = periodic ? jump : NULL,
                                          .viscosity = rough ? 0.3 : 0,
                                          .dispersion = rough ? 0.2 : 0});
  }
}
END_TEST

/* ---- static states ---- */

/* Give the energy of a static kink beyond 8, with cells of one length or free nodes. */
static double kink_excess(int cells, dvi_moving_motion motion, const dvi_moving_mean *mean,
                          int points, double kappa)
{
  kink still = {0};
  double end[2], *q = calloc(2 * (size_t)cells, sizeof *q);
  for (int side = 0; side < 2; side++) end[side] = kink_value(&still, 0, side ? 10 : -10);
  dvi_moving *moving = create(&(dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                                                  .axis = {.from = -10, .to = 10},
                                                  .cells = cells,
                                                  .part = mean != NULL ? &free_wave : &sine_gordon,
                                                  .mean = mean,
                                                  .translations = 1,
                                                  .points = points,
                                                  .motion = motion,
                                                  .mu = motion == DVI_MOVING_FREE,
                                                  .kappa = kappa,
                                                  .left = {.kind = DVI_FIXED, .value = end},
                                                  .right = {.kind = DVI_FIXED, .value = end + 1}});
  dvi_moving_report report;
  ck_assert_msg(!dvi_moving_start(moving, kink_wave, &still, q, NULL, NULL), "%s",
                dvi_last_error());
  ck_assert_msg(!dvi_moving_solve(moving, q, &report), "%s", dvi_last_error());
  dvi_moving_destroy(&moving);
  free(q);
  return report.energy - report.barrier - 8;
}

/* The numbers are from minimisations in numpy. With 8 equal cells the least energy belongs to a
 * kink between two nodes. One at a node is a saddle of 8.8473. */
START_TEST(free_nodes_lower_the_energy_of_a_kink)
{
  const double even[4] = {0.343934, 0.171661, 0.042769, 0.010810};
  const double free_ones[4] = {0.07638, 0.02065, 0.00538, 0.00137};
  for (int k = 0; k < 4; k++) {
    const double of_even = kink_excess(8 << k, DVI_MOVING_PRESCRIBED, &sine_gordon_mean, 0, 0);
    const double of_free = kink_excess(8 << k, DVI_MOVING_FREE, &sine_gordon_mean, 0, 1e-7);
    ck_assert_double_eq_tol(of_even, even[k], 1e-6);
    ck_assert_double_eq_tol(of_free, free_ones[k], 5e-6);
  }
}
END_TEST

/* The energy of a kink is 8 at least. With two points a cell the mesh finds places where the sum is
 * far below the integral. */
START_TEST(nodes_exploit_an_error_of_the_quadrature)
{
  ck_assert(kink_excess(8, DVI_MOVING_FREE, NULL, 2, 1e-7) < -1.38);
  ck_assert_double_eq_tol(kink_excess(8, DVI_MOVING_FREE, NULL, 8, 1e-7), 0.07638, 5e-6);
}
END_TEST

/* ---- states ---- */

static const double two_pi = 2 * 3.14159265358979323846;

static dvi_moving_terms ring(void)
{
  return (dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                            .axis = {.to = two_pi, .periodic = 1},
                            .cells = 8,
                            .part = &free_wave,
                            .translations = 1,
                            .mu = 1,
                            .jump = &two_pi};
}

static int tilted(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                  double *velocity, void *user)
{
  (void)velocity;
  for (int64_t i = 0; i < count; i++) u[i] = x[i], u_x[i] = 1, u_t[i] = *(const double *)user;
  return 0;
}

START_TEST(lift_undoes_start)
{
  const dvi_moving_terms terms = ring();
  dvi_moving *moving = create(&terms);
  double rate = 0.5, q[16], v[16], x[9], u[9];
  ck_assert(!dvi_moving_start(moving, tilted, &rate, q, v, NULL));
  ck_assert(!dvi_moving_lift(moving, 0, q, x, u));
  for (int k = 0; k <= 8; k++) {
    ck_assert_double_eq_tol(x[k], k * two_pi / 8, 1e-15);
    ck_assert_double_eq_tol(u[k], x[k], 1e-14);
  }
  for (int k = 0; k < 8; k++) ck_assert(v[2 * k] == 0 && v[2 * k + 1] == 0.5);
  dvi_moving_destroy(&moving);
}
END_TEST

START_TEST(periodic_fields_repeat_with_their_jump)
{
  const dvi_moving_terms terms = ring();
  dvi_moving *moving = create(&terms);
  double rate = 0, q[16], x[41], u[41], slope[41];
  ck_assert(!dvi_moving_start(moving, tilted, &rate, q, NULL, NULL));
  for (int i = 0; i <= 40; i++) x[i] = -20 + i;
  ck_assert(!dvi_moving_evaluate(moving, 0, q, 0, 41, x, u));
  ck_assert(!dvi_moving_evaluate(moving, 0, q, 1, 41, x, slope));
  for (int i = 0; i <= 40; i++) {
    ck_assert_double_eq_tol(u[i], x[i], 1e-13);
    ck_assert_double_eq_tol(slope[i], 1, 1e-13);
  }
  dvi_moving_destroy(&moving);
}
END_TEST

static int steep(int64_t count, const double *x, double *m, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) m[i] = 1 + x[i];
  return 0;
}

/* The integral of 1 + x to x = sqrt(1 + 3 s) - 1 is the part s of that to 1. */
START_TEST(monitor_has_one_integral_in_all_cells)
{
  dvi_moving *moving = create(&(dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                                                  .axis = {.to = 1},
                                                  .cells = 10,
                                                  .part = &free_wave,
                                                  .translations = 1,
                                                  .monitor = steep});
  int cells;
  const double *node = dvi_moving_nodes(moving, &cells);
  ck_assert_int_eq(cells, 10);
  for (int k = 0; k <= 10; k++)
    ck_assert_double_eq_tol(node[k], sqrt(1 + 0.3 * k) - 1, 1e-6); /* 640 points */
  dvi_moving_destroy(&moving);
}
END_TEST

/* A peak of the width 1e-4 has sqrt(pi)/(1 + sqrt(pi)), 0.639, of the integral. */
static int needle(int64_t count, const double *x, double *m, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) m[k] = 1 + 1e4 * exp(-pow((x[k] - 0.4321) / 1e-4, 2));
  return 0;
}

START_TEST(monitor_has_a_narrow_peak)
{
  dvi_moving *moving = create(&(dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                                                  .axis = {.to = 1},
                                                  .cells = 100,
                                                  .part = &free_wave,
                                                  .translations = 1,
                                                  .monitor = needle});
  const double *node = dvi_moving_nodes(moving, NULL);
  int inside = 0;
  for (int k = 0; k <= 100; k++) inside += fabs(node[k] - 0.4321) < 4e-4;
  ck_assert(inside == 63 || inside == 64);
  dvi_moving_destroy(&moving);
}
END_TEST

/* ---- bad input ---- */

static int negative_monitor(int64_t count, const double *x, double *m, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) m[i] = x[i] - 3;
  return 0;
}

static int failing_monitor(int64_t count, const double *x, double *m, void *user)
{
  (void)count, (void)x, (void)m, (void)user;
  return 7;
}

static void refuse(const dvi_moving_terms *terms, dvi_status status, const char *words)
{
  dvi_moving *moving = (dvi_moving *)&status;
  ck_assert_msg(dvi_moving_create(terms, &moving) == status, "%s", words);
  ck_assert(moving == NULL);
  check_words(words);
}

#define REFUSE(status, words, ...)   \
  do {                               \
    dvi_moving_terms terms = ring(); \
    terms.__VA_ARGS__;               \
    refuse(&terms, status, words);   \
  } while (0)

START_TEST(bad_meshes_are_refused)
{
  const double backward[4] = {0, 2, 1, 3};
  REFUSE(DVI_BAD_ARGUMENT, "set terms.size", size = 8);
  REFUSE(DVI_BAD_ARGUMENT, "the axis reaches from 0 to -1", axis.to = -1);
  REFUSE(DVI_BAD_ARGUMENT, "must ascend and be finite", axis.to = NAN);
  REFUSE(DVI_BAD_ARGUMENT, "leave the kind out", axis.kind = "fourier");
  REFUSE(DVI_BAD_ARGUMENT, "cell 1 of the axis reaches from 2 to 1",
         axis = (dvi_axis){.to = 3, .node = backward, .nodes = 4});
  REFUSE(DVI_BAD_ARGUMENT, "at least 3 are needed",
         axis = (dvi_axis){.to = 2, .node = backward, .nodes = 2});
  REFUSE(DVI_BAD_SIZE, "1 cells asked, 2 to", cells = 1);
  REFUSE(DVI_BAD_SIZE, "17 points a cell asked", points = 17);
  REFUSE(DVI_BAD_SIZE, "5 components asked", components = 5);
  REFUSE(DVI_NOT_FINITE, "the monitor is -2.99", monitor = negative_monitor);
  REFUSE(DVI_CALLBACK_FAILED, "the monitor returned 7", monitor = failing_monitor);
}
END_TEST

START_TEST(bad_masses_and_ends_are_refused)
{
  const double nowhere = NAN;
  REFUSE(DVI_BAD_ARGUMENT, "kappa is -1, but it must be at least 0", kappa = -1);
  REFUSE(DVI_BAD_ARGUMENT, "mu is nan", mu = NAN);
  REFUSE(DVI_BAD_ARGUMENT, "the viscosity is inf", viscosity = INFINITY);
  REFUSE(DVI_BAD_ARGUMENT, "the dispersion is -2", dispersion = -2);
  REFUSE(DVI_BAD_ARGUMENT, "there is no motion 5", motion = (dvi_moving_motion)5);
  REFUSE(DVI_BAD_ARGUMENT, "a stretch needs DVI_MOVING_EQUAL", stretch = 1);
  REFUSE(DVI_BAD_ARGUMENT, "leave both out", motion = DVI_MOVING_PRESCRIBED);
  REFUSE(DVI_BAD_ARGUMENT, "choose DVI_MOVING_PRESCRIBED", path = sway);
  REFUSE(DVI_BAD_ARGUMENT, "a path_step needs a path", path_step = 1);
  REFUSE(DVI_BAD_ARGUMENT, "has no ends at which u is fixed", left.kind = DVI_FIXED);
  REFUSE(DVI_BAD_ARGUMENT, "a jump needs a periodic axis", axis.periodic = 0);
  REFUSE(DVI_BAD_ARGUMENT, "the jump of component 0 is nan", jump = &nowhere);
}
END_TEST

START_TEST(bad_densities_are_refused)
{
  const dvi_jet curved = {.order = {2}}, foreign = {.component = 3}, same[2] = {{0}, {0}};
  dvi_density_part part = free_wave;
  const dvi_moving_mean none = {0};
  REFUSE(DVI_BAD_ARGUMENT, "a density with its variables is needed", part = NULL);
  REFUSE(DVI_BAD_ARGUMENT, "the mean has no callback", mean = &none);
  REFUSE(DVI_BAD_ARGUMENT, "give space_derivative, or set translations", translations = 0);
  part.variables = 1;
  part.variable = &curved;
  REFUSE(DVI_BAD_ARGUMENT, "variable 0 of the density has order 2", part = &part);
  part.variable = &foreign;
  REFUSE(DVI_BAD_ARGUMENT, "variable 0 is of component 3", part = &part);
  part.variable = same;
  part.variables = 2;
  REFUSE(DVI_BAD_ARGUMENT, "variables 0 and 1 of the density are the same", part = &part);
  part.variable = free_wave.variable;
  part.pair = (const int[1][2]){{0, 1}};
  part.pairs = 1;
  REFUSE(DVI_BAD_ARGUMENT, "pair 0 of the density is (0,1)", part = &part);
}
END_TEST

START_TEST(nodes_without_mass_are_refused)
{
  dvi_moving_terms terms = ring();
  double rate = 1, q[16], p[16];
  terms.mu = 0;
  dvi_moving *moving = create(&terms);
  ck_assert_int_eq(dvi_moving_start(moving, tilted, &rate, q, NULL, p), DVI_SINGULAR);
  check_words("u is straight at node 0");
  check_words("give mu > 0, or prescribe the nodes");
  ck_assert_int_eq(dvi_moving_start(moving, tilted, &rate, q, NULL, NULL), DVI_OK);
  dvi_moving_destroy(&moving);
}
END_TEST

START_TEST(components_without_rate_have_no_system)
{
  dvi_moving_terms terms = ring();
  dvi_density_part part = free_wave;
  dvi_system *system;
  part.variable = free_wave.variable + 1;
  part.variables = 1;
  part.pair = NULL;
  terms.part = &part;
  dvi_moving *moving = create(&terms);
  ck_assert_int_eq(dvi_moving_system(moving, &system), DVI_SINGULAR);
  check_words("the density has no rate of component 0");
  dvi_moving_destroy(&moving);
}
END_TEST

START_TEST(bad_states_are_refused)
{
  const dvi_moving_terms terms = ring();
  dvi_moving *moving = create(&terms);
  double rate = NAN, q[16], x[9], u[9] = {0};
  ck_assert_int_eq(dvi_moving_start(moving, tilted, &rate, q, NULL, NULL), DVI_NOT_FINITE);
  check_words("at node 0 u is 0 and its rate nan");
  for (int k = 0; k <= 8; k++) x[k] = k * two_pi / 8;
  x[3] = x[5];
  ck_assert_int_eq(dvi_moving_project(moving, 0, x, u, NULL, NULL, q, NULL, NULL),
                   DVI_BAD_ARGUMENT);
  check_words("the mesh is tangled, cell 3 of 8");
  x[3] = NAN;
  ck_assert_int_eq(dvi_moving_project(moving, 0, x, u, NULL, NULL, q, NULL, NULL), DVI_NOT_FINITE);
  check_words("at node 3 the position is nan");
  dvi_moving_destroy(&moving);
}
END_TEST

START_TEST(arcs_of_one_length_are_refused_where_they_are_not_possible)
{
  dvi_moving_terms terms = ring();
  dvi_moving *moving = NULL;
  double q[16] = {0};
  terms.motion = DVI_MOVING_EQUAL;
  terms.cells = 2;
  ck_assert_int_eq(dvi_moving_create(&terms, &moving), DVI_BAD_SIZE);
  check_words("at least 3 cells, not 2");
  terms.cells = 8;
  moving = create(&terms);
  ck_assert_int_eq(dvi_moving_solve(moving, q, NULL), DVI_UNSUPPORTED);
  dvi_moving_destroy(&moving);
}
END_TEST

static int cliff(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                 double *velocity, void *user)
{
  (void)u_t, (void)velocity, (void)user;
  for (int64_t i = 0; i < count; i++) {
    u[i] = 100 * tanh(50 * (x[i] - 3));
    u_x[i] = 5000 / pow(cosh(50 * (x[i] - 3)), 2);
  }
  return 0;
}

START_TEST(arcs_that_are_not_found_are_refused)
{
  dvi_moving_terms terms = ring();
  double q[16];
  terms.motion = DVI_MOVING_EQUAL;
  terms.stretch = 1;
  dvi_moving *moving = create(&terms);
  ck_assert_int_eq(dvi_moving_start(moving, cliff, NULL, q, NULL, NULL), DVI_NOT_CONVERGED);
  check_words("give a monitor with cells of nearly equal arcs");
  dvi_moving_destroy(&moving);
}
END_TEST

/* An allocation of a static state may fail, and the state stays. */
START_TEST(lack_of_memory_leaves_a_static_state)
{
  const dvi_moving_terms terms = ring();
  double rate = 0, q[16], before[16];
  dvi_moving *moving = create(&terms);
  ck_assert(!dvi_moving_start(moving, tilted, &rate, q, NULL, NULL));
  q[3] += 0.1;
  memcpy(before, q, sizeof q);
  long allowed = 0;
  dvi_status status = DVI_NO_MEMORY;
  for (; status == DVI_NO_MEMORY; allowed++) {
    ck_assert_mem_eq(before, q, sizeof q);
    dvi__fail_allocations_after(allowed);
    status = dvi_moving_solve(moving, q, NULL);
    dvi__fail_allocations_after(-1);
  }
  ck_assert_msg(status == DVI_OK && allowed > 2, "%s", dvi_last_error());
  dvi_moving_destroy(&moving);
}
END_TEST

START_TEST(points_outside_are_refused)
{
  dvi_moving_terms terms = ring();
  double rate = 0, q[18], u, at[2] = {-0.1, NAN};
  dvi_moving *periodic = create(&terms);
  ck_assert(!dvi_moving_start(periodic, tilted, &rate, q, NULL, NULL));
  ck_assert_int_eq(dvi_moving_evaluate(periodic, 0, q, 0, 1, at + 1, &u), DVI_BAD_ARGUMENT);
  dvi_moving_destroy(&periodic);
  terms.axis.periodic = 0;
  terms.jump = NULL;
  dvi_moving *moving = create(&terms);
  ck_assert(!dvi_moving_start(moving, tilted, &rate, q, NULL, NULL));
  for (int i = 0; i < 2; i++)
    ck_assert_int_eq(dvi_moving_evaluate(moving, 0, q, 0, 1, at + i, &u), DVI_BAD_ARGUMENT);
  at[0] = two_pi;
  ck_assert(!dvi_moving_evaluate(moving, 0, q, 0, 1, at, &u));
  ck_assert_double_eq_tol(u, two_pi, 1e-14);
  dvi_moving_destroy(&moving);
}
END_TEST

/* Every allocation of a field, of starts and of a system may fail. */
START_TEST(lack_of_memory_is_reported)
{
  dvi_moving_terms terms = ring();
  terms.motion = DVI_MOVING_EQUAL;
  terms.viscosity = terms.dispersion = 0.1;
  double rate = 0, q[16], x = 1, u;
  long allowed = 0;
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; allowed++) {
    dvi_moving *moving = NULL;
    dvi_system *system = NULL;
    dvi__fail_allocations_after(allowed);
    status = dvi_moving_create(&terms, &moving);
    if (!status) status = dvi_moving_start(moving, tilted, &rate, q, NULL, q);
    if (!status) status = dvi_moving_start(moving, tilted, &rate, q, NULL, NULL);
    if (!status) status = dvi_moving_evaluate(moving, 0, q, 0, 1, &x, &u);
    if (!status) status = dvi_moving_system(moving, &system);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(!status || status == DVI_NO_MEMORY, "%s", dvi_last_error());
    dvi_system_destroy(&system);
    dvi_moving_destroy(&moving);
  }
  ck_assert(allowed > 10);
}
END_TEST

SUITE(moving)
{
  tcase_add_test(tests, derivatives_agree_with_differences);
  tcase_add_test(tests, free_nodes_lower_the_energy_of_a_kink);
  tcase_add_test(tests, nodes_exploit_an_error_of_the_quadrature);
  tcase_add_test(tests, lift_undoes_start);
  tcase_add_test(tests, periodic_fields_repeat_with_their_jump);
  tcase_add_test(tests, monitor_has_one_integral_in_all_cells);
  tcase_add_test(tests, monitor_has_a_narrow_peak);
  tcase_add_test(tests, bad_meshes_are_refused);
  tcase_add_test(tests, bad_masses_and_ends_are_refused);
  tcase_add_test(tests, bad_densities_are_refused);
  tcase_add_test(tests, nodes_without_mass_are_refused);
  tcase_add_test(tests, components_without_rate_have_no_system);
  tcase_add_test(tests, bad_states_are_refused);
  tcase_add_test(tests, arcs_of_one_length_are_refused_where_they_are_not_possible);
  tcase_add_test(tests, arcs_that_are_not_found_are_refused);
  tcase_add_test(tests, lack_of_memory_leaves_a_static_state);
  tcase_add_test(tests, points_outside_are_refused);
  tcase_add_test(tests, lack_of_memory_is_reported);
}
