/* Fields on meshes of triangles that move: derivatives, static states, paths, and bad input. */
#include <math.h>

#include "core/memory.h"
#include "support/field/journeys.h"
#include "support/field/planes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- derivatives ---- */

/* l = a_0(x) |z|^2/2 + sum_k a_k(x) sin(b_k.z) of eight variables. */
enum { VARIABLES = 8, WAVES = 2 };

static double factor(int k, const double *x)
{
  return 1 + 0.3 * sin(k + x[0] + 0.5 * x[1]);
}

static double slope(int k, const double *x, int axis)
{
  return 0.3 * cos(k + x[0] + 0.5 * x[1]) * (axis ? 0.5 : 1);
}

static double curvature(int k, const double *x, int axis, int other)
{
  return -0.3 * sin(k + x[0] + 0.5 * x[1]) * (axis ? 0.5 : 1) * (other ? 0.5 : 1);
}

static double share(int k, int j)
{
  return cos(1.3 * k + 2.1 * j);
}

/* Give half of the square of z, and the arguments of the sines. */
static double read_point(int count, const double *z, int at, double *sine)
{
  double square = 0;
  for (int k = 1; k <= WAVES; k++) sine[k] = 0;
  for (int j = 0; j < VARIABLES; j++) {
    square += z[j * count + at] * z[j * count + at] / 2;
    for (int k = 1; k <= WAVES; k++) sine[k] += share(k, j) * z[j * count + at];
  }
  return square;
}

static int tangle(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)user;
  for (int at = 0; at < count; at++) {
    const double here[2] = {x[at], x[count + at]};
    double s[WAVES + 1];
    const double square = read_point(count, z, at, s);
    if (l != NULL) l[at] = factor(0, here) * square;
    for (int k = 1; k <= WAVES && l != NULL; k++) l[at] += factor(k, here) * sin(s[k]);
    for (int j = 0, p = 0; j < VARIABLES; j++) {
      if (l_z != NULL) l_z[j * count + at] = factor(0, here) * z[j * count + at];
      for (int k = 1; k <= WAVES && l_z != NULL; k++)
        l_z[j * count + at] += factor(k, here) * share(k, j) * cos(s[k]);
      for (int i = 0; i <= j && l_zz != NULL; i++, p++) {
        l_zz[p * count + at] = i == j ? factor(0, here) : 0;
        for (int k = 1; k <= WAVES; k++)
          l_zz[p * count + at] -= factor(k, here) * share(k, j) * share(k, i) * sin(s[k]);
      }
    }
  }
  return 0;
}

static int tangle_by_x(int count, double t, const double *x, const double *z, double *l_x,
                       double *l_xz, double *l_xx, void *user)
{
  (void)t, (void)user;
  for (int at = 0; at < count; at++) {
    const double here[2] = {x[at], x[count + at]};
    double s[WAVES + 1];
    const double square = read_point(count, z, at, s);
    for (int i = 0, p = 0; i < 2; i++) {
      l_x[i * count + at] = slope(0, here, i) * square;
      for (int k = 1; k <= WAVES; k++) l_x[i * count + at] += slope(k, here, i) * sin(s[k]);
      for (int e = 0; e <= i && l_xx != NULL; e++, p++) {
        l_xx[p * count + at] = curvature(0, here, i, e) * square;
        for (int k = 1; k <= WAVES; k++)
          l_xx[p * count + at] += curvature(k, here, i, e) * sin(s[k]);
      }
      for (int j = 0; j < VARIABLES && l_xz != NULL; j++) {
        double *of = l_xz + (i * VARIABLES + j) * count + at;
        *of = slope(0, here, i) * z[j * count + at];
        for (int k = 1; k <= WAVES; k++) *of += slope(k, here, i) * share(k, j) * cos(s[k]);
      }
    }
  }
  return 0;
}

static const dvi_jet both[VARIABLES] = {{0},
                                        {.component = 1},
                                        {.rate = 1},
                                        {.component = 1, .rate = 1},
                                        {.order = {1}},
                                        {.component = 1, .order = {1}},
                                        {.order = {0, 1}},
                                        {.component = 1, .order = {0, 1}}};
static const dvi_density_part tangled = {
    .variable = both, .variables = VARIABLES, .density = tangle};

/* Create a field, and a state whose nodes and values move. */
static dvi_moving *create(const dvi_moving_terms *terms, double *q, double *v, double *p)
{
  dvi_moving *moving = NULL;
  double x[128], rate[128], u[128], u_rate[128];
  ck_assert_msg(!dvi_moving_create(terms, &moving), "%s", dvi_last_error());
  const int nodes = (int)dvi_mesh_count(terms->mesh, 0);
  for (int k = 0; k < 2 * nodes; k++) {
    x[k] = dvi_moving_nodes(moving, NULL)[k] + 0.02 * sin(3.0 * k);
    rate[k] = 0.4 * cos(2.0 * k);
    u[k] = sin(1.7 * k);
    u_rate[k] = cos(2.3 * k);
  }
  ck_assert_msg(!dvi_moving_project(moving, 0, x, u, rate, u_rate, q, v, p), "%s",
                dvi_last_error());
  return moving;
}

static void check_derivatives(const dvi_moving_terms *terms)
{
  double q[256], v[256];
  dvi_system *system = NULL;
  dvi_derivative_check found;
  dvi_moving *moving = create(terms, q, v, NULL);
  ck_assert_msg(!dvi_moving_system(moving, &system), "%s", dvi_last_error());
  ck_assert_msg(!dvi_system_check(system, 0, q, v, 1e-8, &found), "%s", dvi_last_error());
  dvi_system_destroy(&system);
  dvi_moving_destroy(&moving);
}

static int ramp(int64_t count, double t, const double *x, double *value, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) value[k] = x[k] - x[count + k];
  return 0;
}

/* Boxes are periodic along none of their axes, one, or both. */
START_TEST(derivatives_agree_with_differences)
{
  const double jumps[3][4] = {{0}, {0.7, -0.4}, {0.7, -0.4, 0.2, 0.5}};
  const int points[3] = {1, 3, 6};
  for (int i = 0; i < 18; i++) {
    const int periodic = i % 3, moves = i / 3 % 2, held = i / 6 != 1;
    const dvi_generator_options box = {.size = sizeof box,
                                       .cells = {4, 3},
                                       .extent = {1, 1},
                                       .periodic = {periodic > 0, periodic > 1}};
    const dvi_density_condition fixed = {
        .part = "boundary", .component = i / 6 - 1, .kind = DVI_FIXED, .datum = ramp};
    dvi_mesh *mesh = plane_mesh(&box, periodic > 1 ? shake : NULL, NULL);
    check_derivatives(&(dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                                          .mesh = mesh,
                                          .components = 2,
                                          .part = &tangled,
                                          .space_derivative = tangle_by_x,
                                          .points = points[i / 6],
                                          .motion = moves ? DVI_MOVING_FREE : DVI_MOVING_PRESCRIBED,
                                          .path = moves ? NULL : plane_sway,
                                          .mu = moves ? 0.3 : 0,
                                          .kappa = moves ? 0.2 : 0,
                                          .jump = jumps[periodic],
                                          .condition = &fixed,
                                          .conditions = held,
                                          .slide = i % 2});
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- static states ---- */

static int one(int64_t count, double t, const double *x, double *value, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) value[k] = 1;
  return 0;
}

static int flat(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                double *velocity, void *user)
{
  (void)x, (void)u_x, (void)u_t, (void)velocity, (void)user;
  for (int64_t k = 0; k < count; k++) u[k] = 1;
  return 0;
}

/* Give the energy of a layer at the sides of a box, without the part of kappa. */
static double layer_energy(int cells, dvi_moving_motion motion)
{
  const double side = 20;
  const dvi_generator_options box = {
      .size = sizeof box, .cells = {cells, cells}, .extent = {side, side}};
  const dvi_density_condition rim = {
      .part = "boundary", .component = -1, .kind = DVI_FIXED, .datum = one};
  dvi_mesh *mesh = plane_mesh(&box, NULL, NULL);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_massive,
                                  .translations = 1,
                                  .motion = motion,
                                  .kappa = motion == DVI_MOVING_FREE ? 1e-4 : 0,
                                  .condition = &rim,
                                  .conditions = 1,
                                  .slide = 1};
  double q[JOURNEY_MOST];
  dvi_moving *moving = NULL;
  dvi_moving_report report;
  ck_assert_msg(!dvi_moving_create(&terms, &moving), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_start(moving, flat, NULL, q, NULL, NULL), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_solve(moving, q, &report), "%s", dvi_last_error());
  dvi_moving_destroy(&moving);
  dvi_mesh_destroy(&mesh);
  return report.energy - report.barrier;
}

/* The energy is 200 (1 - sum over odd m, n of 64/(pi^4 m^2 n^2 (1 + pi^2 (m^2 + n^2)/400))). The
 * integral of the linear field is exact, and cannot be below. */
START_TEST(free_nodes_lower_the_energy_of_a_layer)
{
  const double exact = 37.453521, even[2] = {15.240, 4.480}, freed[2] = {0.881, 0.287};
  for (int k = 0; k < 2; k++) {
    const double of_even = layer_energy(6 << k, DVI_MOVING_PRESCRIBED) - exact;
    const double of_free = layer_energy(6 << k, DVI_MOVING_FREE) - exact;
    ck_assert_double_eq_tol(of_even, even[k], 1e-3);
    ck_assert_double_eq_tol(of_free, freed[k], 1e-3);
  }
}
END_TEST

/* ---- paths that are given ---- */

static int affine(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                  double *velocity, void *user)
{
  (void)velocity, (void)user;
  for (int64_t k = 0; k < count; k++) {
    u[k] = 1.3 * x[k] - 0.4 * x[count + k];
    u_x[k] = 1.3;
    u_x[count + k] = -0.4;
    u_t[k] = 0.7;
  }
  return 0;
}

static const double affine_jump[2] = {1.3, -0.4};

/* Areas of cells are squares of the time, which two points a step integrate. The field takes a
 * rounding of its size, at most 3, each step. */
START_TEST(prescribed_nodes_keep_affine_fields)
{
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {5, 4}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, shake, NULL);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_wave,
                                  .translations = 1,
                                  .motion = DVI_MOVING_PRESCRIBED,
                                  .path = plane_sway,
                                  .path_step = 0.05,
                                  .jump = affine_jump};
  journey j;
  depart(&terms, affine, NULL, "galerkin:degree=1,nodes=2", &j);
  travel(&j, 20, 0.05);
  for (int k = 0; k < 20; k++)
    ck_assert_double_eq_tol(j.u[k], 0.7 + 1.3 * j.x[k] - 0.4 * j.x[20 + k], 5e-15);
  arrive(&j);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static dvi_moving_terms torus_terms(dvi_mesh *mesh)
{
  return (dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                            .mesh = mesh,
                            .part = &plane_wave,
                            .translations = 1,
                            .mu = 1,
                            .jump = affine_jump};
}

START_TEST(periodic_fields_repeat_with_their_jumps)
{
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {5, 4}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, shake, NULL);
  const dvi_moving_terms terms = torus_terms(mesh);
  double q[60], x[128], u[64];
  dvi_moving *moving = NULL;
  ck_assert_msg(!dvi_moving_create(&terms, &moving), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_start(moving, affine, NULL, q, NULL, NULL), "%s", dvi_last_error());
  for (int k = 0; k < 60; k++) q[k] += k % 3 == 2 ? 0 : 5; /* nodes move, values stay */
  for (int k = 0; k < 64; k++) x[k] = -2 + 0.07 * k, x[64 + k] = 3 - 0.11 * k;
  for (int slope = 0; slope <= 2; slope++) {
    const double by[3] = {NAN, 1.3, -0.4};
    ck_assert_msg(!dvi_moving_evaluate(moving, 0, q, slope, 64, x, u), "%s", dvi_last_error());
    for (int k = 0; k < 64; k++) {
      const double value = 1.3 * (x[k] - 5) - 0.4 * (x[64 + k] - 5);
      ck_assert_double_eq_tol(u[k], slope ? by[slope] : value, 1e-13);
    }
  }
  dvi_moving_destroy(&moving);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The rate at a place, and the integral of u_t + 2 u_x - 1 over the torus. */
static int rate_and_slope(int count, double t, const double *x, const double *z, double *l,
                          double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)l_z, (void)l_zz, (void)user;
  for (int k = 0; k < count; k++) l[k] = z[k] + 2 * z[count + k] - 1;
  return 0;
}

START_TEST(functions_have_rates_at_places_and_integrals)
{
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {5, 4}, .extent = {1, 1}, .periodic = {1, 1}};
  const dvi_jet variable[2] = {{.rate = 1}, {.order = {1}}};
  const dvi_density_part function = {
      .variable = variable, .variables = 2, .density = rate_and_slope};
  dvi_mesh *mesh = plane_mesh(&torus, shake, NULL), *now = NULL;
  const dvi_moving_terms terms = torus_terms(mesh);
  const double at[2] = {7.3, -2.2};
  double q[60], v[60], f, node[40];
  int nodes;
  dvi_moving *moving = NULL;
  ck_assert_msg(!dvi_moving_create(&terms, &moving), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_start(moving, affine, NULL, q, NULL, NULL), "%s", dvi_last_error());
  /* u = 1.3 x - 0.4 y + 0.7 t on nodes with velocities of their own */
  for (int k = 0; k < 20; k++) {
    v[3 * k] = sin(k);
    v[3 * k + 1] = cos(2 * k);
    v[3 * k + 2] = 0.7 + 1.3 * v[3 * k] - 0.4 * v[3 * k + 1];
  }
  ck_assert_msg(!dvi_moving_measure(moving, 0, q, v, &function, at, &f), "%s", dvi_last_error());
  ck_assert_double_eq_tol(f, 0.7 + 2.6 - 1, 1e-13);
  ck_assert_msg(!dvi_moving_measure(moving, 0, q, v, &function, NULL, &f), "%s", dvi_last_error());
  ck_assert_double_eq_tol(f, 0.7 + 2.6 - 1, 1e-13);
  ck_assert_int_eq(dvi_moving_measure(moving, 0, q, NULL, &function, at, &f), DVI_BAD_ARGUMENT);
  check_words("the function has a rate: give velocities");
  const int *unknown = dvi_moving_unknowns(moving, &nodes);
  ck_assert(nodes == 20 && unknown[0] == 0 && unknown[59] == 59);
  ck_assert_msg(!dvi_moving_mesh(moving, 0, q, &now), "%s", dvi_last_error());
  ck_assert_msg(!dvi_moving_lift(moving, 0, q, node, NULL), "%s", dvi_last_error());
  for (int k = 0; k < 40; k++) ck_assert(dvi_mesh_points(now)[k] == node[k % 2 * 20 + k / 2]);
  dvi_mesh_destroy(&now);
  dvi_moving_destroy(&moving);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- boundaries ---- */

/* Start a wave on a strip that is periodic along x, and let it go. */
static void let_go(int slide, journey *j)
{
  double speed = 0;
  const dvi_generator_options strip = {
      .size = sizeof strip, .cells = {4, 3}, .extent = {1, 1}, .periodic = {1, 0}};
  dvi_mesh *mesh = plane_mesh(&strip, NULL, NULL);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_quartic,
                                  .translations = 1,
                                  .mu = 0.02,
                                  .kappa = 0.05,
                                  .slide = slide};
  depart(&terms, plane_bump, &speed, "midpoint", j);
  travel(j, 50, 0.02);
  dvi_mesh_destroy(&mesh);
}

/* The lower nodes of the strip are 0 to 3. */
START_TEST(nodes_slide_along_straight_edges)
{
  journey j;
  let_go(1, &j);
  ck_assert_str_eq(dvi_system_invariant_name(j.system, 1), "momentum_x");
  ck_assert_str_eq(dvi_system_invariant_name(j.system, 2), "momentum_u");
  ck_assert(j.drift[1] < 1e-14 && j.drift[2] < 1e-14);
  for (int k = 0; k < 4; k++) ck_assert(fabs(j.x[k] - 0.25 * k) > 1e-4 && j.x[16 + k] == 0);
  arrive(&j);
}
END_TEST

START_TEST(nodes_of_a_boundary_rest)
{
  journey j;
  let_go(0, &j);
  ck_assert_int_eq(dvi_system_invariant_count(j.system), 2);
  ck_assert_str_eq(dvi_system_invariant_name(j.system, 1), "momentum_u");
  for (int k = 0; k < 4; k++) ck_assert(j.x[k] == 0.25 * k && j.x[16 + k] == 0);
  arrive(&j);
}
END_TEST

START_TEST(points_outside_are_refused)
{
  const dvi_generator_options box = {.size = sizeof box, .cells = {3, 3}, .extent = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&box, NULL, NULL);
  double q[64], speed = 0, u;
  const double at[2] = {0.5, 1.1};
  dvi_moving *moving = NULL;
  ck_assert(!dvi_moving_create(&(dvi_moving_terms){.size = sizeof(dvi_moving_terms),
                                                   .mesh = mesh,
                                                   .part = &plane_wave,
                                                   .translations = 1,
                                                   .mu = 1},
                               &moving));
  ck_assert(!dvi_moving_start(moving, plane_bump, &speed, q, NULL, NULL));
  ck_assert_int_eq(dvi_moving_evaluate(moving, 0, q, 0, 1, at, &u), DVI_BAD_ARGUMENT);
  check_words("the point (0.5, 1.1) is outside of the mesh");
  ck_assert_int_eq(dvi_moving_evaluate(moving, 0, q, 3, 1, at, &u), DVI_BAD_ARGUMENT);
  check_words("there is no axis 3");
  dvi_moving_destroy(&moving);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- tangled meshes ---- */

static int crash(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                 double *velocity, void *user)
{
  double speed = 0;
  const int returned = plane_bump(count, x, u, u_x, u_t, velocity, user != NULL ? user : &speed);
  for (int64_t k = 0; k < count; k++) velocity[k] = -5 * sin(2 * pi * x[k]);
  return returned;
}

START_TEST(tangled_mesh_is_named)
{
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {5, 5}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, NULL, NULL);
  const dvi_moving_terms terms = {
      .size = sizeof terms, .mesh = mesh, .part = &plane_wave, .translations = 1, .mu = 1};
  journey j;
  depart(&terms, crash, NULL, "midpoint", &j);
  dvi_status status = DVI_OK;
  for (int k = 0; k < 100 && !status; k++) status = dvi_integrator_step(j.integrator, 0.01);
  ck_assert_int_eq(status, DVI_CALLBACK_RETRY);
  check_words("the mesh is tangled, cell ");
  check_words(" of 50 at (");
  check_words("take a smaller step or a larger kappa");
  arrive(&j);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Heavy nodes move straight on. In the middle of the step cells have lost 0.6 of their
 * length at most, at the end 1.19. */
START_TEST(steps_do_not_end_on_tangled_meshes)
{
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {5, 5}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, NULL, NULL), *now = NULL;
  const dvi_moving_terms terms = {
      .size = sizeof terms, .mesh = mesh, .part = &plane_wave, .translations = 1, .mu = 1000};
  journey j;
  depart(&terms, crash, NULL, "midpoint", &j);
  const dvi_status status = dvi_integrator_step(j.integrator, 0.05);
  ck_assert_int_eq(status, DVI_CALLBACK_RETRY);
  check_words("step 1 from t = 0 with h = 0.05 failed; the state is unchanged");
  check_words("the admit callback asked for a smaller step (1): the mesh is tangled, cell ");
  ck_assert(dvi_integrator_time(j.integrator) == 0);
  ck_assert_msg(!dvi_moving_mesh(j.moving, 0, dvi_integrator_q(j.integrator), &now), "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_step(j.integrator, 0.01), DVI_OK);
  dvi_mesh_destroy(&now);
  arrive(&j);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- bad input ---- */

static int nowhere(int64_t count, double t, const double *x, double *value, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) value[k] = NAN;
  return 0;
}

static int failing(int64_t count, double t, const double *x, double *value, void *user)
{
  (void)count, (void)t, (void)x, (void)value, (void)user;
  return 7;
}

#define REFUSE(status, words, ...)                                                            \
  do {                                                                                        \
    dvi_moving_terms terms = {                                                                \
        .size = sizeof terms, .mesh = mesh, .part = &plane_wave, .translations = 1, .mu = 1}; \
    dvi_moving *moving = (dvi_moving *)&terms;                                                \
    terms.__VA_ARGS__;                                                                        \
    ck_assert_msg(dvi_moving_create(&terms, &moving) == (status), "%s", words);               \
    ck_assert(moving == NULL);                                                                \
    check_words(words);                                                                       \
  } while (0)

#define REFUSE_CONDITION(status, words, ...)                      \
  do {                                                            \
    const dvi_density_condition it = {__VA_ARGS__};               \
    REFUSE(status, words, condition = &it; terms.conditions = 1); \
  } while (0)

START_TEST(bad_terms_are_refused)
{
  const dvi_generator_options box = {.size = sizeof box, .cells = {3, 3}};
  const double bad[2] = {0, NAN};
  const dvi_moving_mean mean = {0};
  dvi_mesh *mesh = plane_mesh(
      &(dvi_generator_options){.size = sizeof box, .cells = {3, 3}, .extent = {1, 1}}, NULL, NULL);
  REFUSE(DVI_BAD_ARGUMENT, "a mesh is given, and an axis", cells = 4);
  REFUSE(DVI_BAD_ARGUMENT, "and a mean over cells", mean = &mean);
  REFUSE(DVI_BAD_ARGUMENT, "and ends", left.kind = DVI_FIXED);
  REFUSE(DVI_BAD_ARGUMENT, "and viscosity", viscosity = 1);
  REFUSE(DVI_BAD_ARGUMENT, "and dispersion", dispersion = 1);
  REFUSE(DVI_BAD_ARGUMENT, "and equal arcs", motion = DVI_MOVING_EQUAL);
  REFUSE(DVI_BAD_SIZE, "2 points a triangle asked, 1, 3 or 6 possible", points = 2);
  REFUSE(DVI_BAD_ARGUMENT, "the jump of component 0 is nan", jump = bad);
  REFUSE(DVI_BAD_ARGUMENT, "a jump of 1.3 along x needs a mesh", jump = affine_jump);
  REFUSE(DVI_BAD_ARGUMENT, "need a mesh", mesh = NULL; terms.axis.to = 1; terms.cells = 2;
         terms.slide = 1);
  REFUSE(DVI_BAD_ARGUMENT, "2 conditions are not given", conditions = 2);
  REFUSE_CONDITION(DVI_BAD_ARGUMENT, "is set on \"rim\", which is no part", .part = "rim");
  REFUSE_CONDITION(DVI_BAD_ARGUMENT, "is of component 3 of 1", .part = "boundary", .component = 3);
  REFUSE_CONDITION(DVI_BAD_ARGUMENT, "has a flux, a rate or robin", .part = "boundary",
                   .datum = one);
  REFUSE_CONDITION(DVI_CALLBACK_FAILED, "returned 7", .part = "all", .kind = DVI_FIXED,
                   .datum = failing);
  REFUSE_CONDITION(DVI_NOT_FINITE, "is nan at (", .part = "all", .kind = DVI_FIXED,
                   .datum = nowhere);
  dvi_mesh_destroy(&mesh);
  ck_assert(!dvi_mesh_generate("box", &box, &mesh));
  REFUSE(DVI_UNSUPPORTED, "the mesh has boxes of dimension 2", mu = 2);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(free_nodes_of_a_mesh_need_a_mass)
{
  const dvi_generator_options box = {.size = sizeof box, .cells = {3, 3}, .extent = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&box, NULL, NULL);
  double q[64], speed = 0;
  dvi_moving *moving = NULL;
  ck_assert(!dvi_moving_create(
      &(dvi_moving_terms){
          .size = sizeof(dvi_moving_terms), .mesh = mesh, .part = &plane_wave, .translations = 1},
      &moving));
  ck_assert_int_eq(dvi_moving_start(moving, plane_bump, &speed, q, NULL, q), DVI_SINGULAR);
  check_words("give mu > 0, or prescribe the nodes");
  dvi_moving_destroy(&moving);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Every allocation of a field, of a start, of values and of a system may fail. */
START_TEST(lack_of_memory_is_reported)
{
  const dvi_generator_options box = {.size = sizeof box, .cells = {3, 3}, .extent = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&box, NULL, NULL);
  const dvi_moving_terms terms = {
      .size = sizeof terms, .mesh = mesh, .part = &plane_wave, .translations = 1, .mu = 1};
  double q[64], speed = 0, u;
  const double at[2] = {0.5, 0.3};
  long allowed = 0;
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; allowed++) {
    dvi_moving *moving = NULL;
    dvi_system *system = NULL;
    dvi__fail_allocations_after(allowed);
    status = dvi_moving_create(&terms, &moving);
    if (!status) status = dvi_moving_start(moving, plane_bump, &speed, q, NULL, q);
    if (!status) status = dvi_moving_start(moving, plane_bump, &speed, q, NULL, NULL);
    if (!status) status = dvi_moving_evaluate(moving, 0, q, 0, 1, at, &u);
    if (!status) status = dvi_moving_system(moving, &system);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(!status || status == DVI_NO_MEMORY, "%s", dvi_last_error());
    dvi_system_destroy(&system);
    dvi_moving_destroy(&moving);
  }
  ck_assert(allowed > 10);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(moving_planes)
{
  tcase_add_test(tests, derivatives_agree_with_differences);
  tcase_add_test(tests, free_nodes_lower_the_energy_of_a_layer);
  tcase_add_test(tests, prescribed_nodes_keep_affine_fields);
  tcase_add_test(tests, periodic_fields_repeat_with_their_jumps);
  tcase_add_test(tests, functions_have_rates_at_places_and_integrals);
  tcase_add_test(tests, tangled_mesh_is_named);
  tcase_add_test(tests, steps_do_not_end_on_tangled_meshes);
  tcase_add_test(tests, bad_terms_are_refused);
  tcase_add_test(tests, free_nodes_of_a_mesh_need_a_mass);
  tcase_add_test(tests, nodes_slide_along_straight_edges);
  tcase_add_test(tests, nodes_of_a_boundary_rest);
  tcase_add_test(tests, points_outside_are_refused);
  tcase_add_test(tests, lack_of_memory_is_reported);
}
