/* labels: unit */
/* What nonholonomic constraints may be declared, where they are refused, how the check compares
 * them, which are integrable, and what happens where they fail. */
#include <math.h>
#include <string.h>

#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/rolling.h"

/* Two rows of a disk that rolls, x' = (1 + c t) cos(a) th' - u, y' = sin(a) th', in (x, y, a, th),
 * with the numbers c and u. */
static double numbers[2];

static int disk_rows(double t, const double *q, double *A, void *user)
{
  const double *c = user;
  A[0] = A[2] = 1;
  A[1] = -(1 + c[0] * t) * cos(q[2]);
  A[3] = -sin(q[2]);
  return 0;
}

static int disk_affine(double t, const double *q, double *a, void *user)
{
  (void)t, (void)q;
  a[0] = ((const double *)user)[1];
  a[1] = 0;
  return 0;
}

static int disk_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  const double *c = user;
  Av_q[0] = (1 + c[0] * t) * sin(q[2]) * v[3];
  Av_q[1] = -cos(q[2]) * v[3];
  return 0;
}

static int wrong_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  const int returned = disk_derivative(t, q, v, Av_q, user);
  Av_q[1] *= 1.01;
  return returned;
}

static const int rows_start[] = {0, 2, 4}, rows_row[] = {0, 3, 1, 3}, by_start[] = {0, 0, 0, 2, 2},
                 by_row[] = {0, 1};

static const dvi_nonholonomic good = {.name = "disk",
                                      .count = 2,
                                      .value = disk_rows,
                                      .affine = disk_affine,
                                      .derivative = disk_derivative,
                                      .transposed = {rows_start, rows_row},
                                      .by_q = {by_start, by_row},
                                      .user = numbers};

static dvi_status create_with(dvi_nonholonomic rows, int autonomous, dvi_system **system)
{
  const dvi_system_terms terms = {.dimension = 4,
                                  .mass = {.scalar = 1},
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = autonomous};
  return dvi_system_create(&terms, system);
}

static void refused(dvi_nonholonomic rows, dvi_status status, const char *words)
{
  dvi_system *system;
  ck_assert_int_eq(create_with(rows, 1, &system), status);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(rows_that_are_not_well_declared_are_refused)
{
  static const int beyond[] = {0, 4, 1, 3};
  dvi_nonholonomic rows = good;
  rows.value = NULL;
  refused(rows, DVI_BAD_ARGUMENT, "nonholonomic constraint 'disk' has no value callback");
  rows = good;
  rows.count = 0;
  refused(rows, DVI_BAD_SIZE, "nonholonomic constraint 'disk' has 0 rows");
  rows.count = 5;
  refused(rows, DVI_BAD_SIZE, "nonholonomic constraint 'disk' has 5 rows; 1 to 4 are possible");
  rows = good;
  rows.transposed = (dvi_pattern){rows_start, beyond};
  refused(rows, DVI_BAD_ARGUMENT, "disk");
  rows = good;
  rows.by_q = (dvi_pattern){by_start, (const int[]){0, 2}};
  refused(rows, DVI_BAD_ARGUMENT, "disk");
}
END_TEST

static void refused_beside(const char *problem_name, const char *words)
{
  problem *model = create_problem(problem_name, NULL);
  dvi_system_terms terms = *model->terms;
  dvi_system *system;
  terms.nonholonomics = &good;
  terms.nonholonomic_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
  check_words(words);
  problem_destroy(&model);
}

static int field(double t, const double *q, double *A, void *user)
{
  (void)t, (void)q, (void)user;
  A[0] = A[1] = A[2] = A[3] = 0;
  return 0;
}

START_TEST(rows_are_refused_beside_a_vector_potential)
{
  const dvi_vector_potential A = {.value = field, .gradient = field};
  const dvi_system_terms terms = {.dimension = 4,
                                  .mass = {.scalar = 1},
                                  .vector_potential = &A,
                                  .nonholonomics = &good,
                                  .nonholonomic_count = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
  check_words("not with nonholonomic constraints; declare a general Lagrangian");
}
END_TEST

START_TEST(rows_are_refused_beside_other_kinds_of_dynamics)
{
  refused_beside("guiding-centre", "nonholonomic constraints go with");
  refused_beside("elastica", "not with a Hamiltonian");
  refused_beside("pendulum-3d", "not with factors");
}
END_TEST

START_TEST(methods_that_take_no_rows_say_so)
{
  static const char *const methods[] = {"verlet",
                                        "midpoint",
                                        "trapezoidal",
                                        "galerkin",
                                        "sem",
                                        "shooting",
                                        "composition:base=verlet",
                                        "hp",
                                        "hamiltonian",
                                        "imex",
                                        "lie-galerkin",
                                        "prolongation-collocation"};
  problem *model = create_problem("sleigh", NULL);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(dvi_integrator_create(model->system, methods[m], &integrator),
                     DVI_UNSUPPORTED);
    check_words("nonholonomic constraints A v + a = 0");
    check_words("methods for this system: nonholonomic, composition");
  }
  problem_destroy(&model);
}
END_TEST

START_TEST(the_method_wants_such_rows)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_integrator_create(model->system, "nonholonomic", &integrator),
                   DVI_UNSUPPORTED);
  check_words("the method needs nonholonomic constraints A v + a = 0");
  problem_destroy(&model);
}
END_TEST

START_TEST(a_transform_of_time_and_a_path_take_no_rows)
{
  static const double q1[] = {0, 0, -1};
  problem *model = create_problem("sleigh", NULL);
  dvi_integrator *integrator;
  dvi_path *path;
  const dvi_monitor monitor = read_monitor("arclength");
  ck_assert_int_eq(create_transformed(model->system, &monitor, "nonholonomic", &integrator),
                   DVI_UNSUPPORTED);
  check_words("the system declares nonholonomic constraints, which the transform does not carry");
  const dvi_path_options options = {
      .ends = DVI_ENDS_FIXED, .steps = 5, .span = 1, .dimension = 3, .q0 = model->q, .q1 = q1};
  ck_assert_int_eq(dvi_path_create(model->system, "midpoint", &options, &path), DVI_UNSUPPORTED);
  check_words("path: the system declares nonholonomic constraints");
  problem_destroy(&model);
}
END_TEST

/* ---- the check ---- */

static void check_says(dvi_nonholonomic rows, double c, int autonomous, dvi_status status,
                       const char *words)
{
  static const double q[] = {0.3, -0.4, 0.8, 0.2}, v[] = {0.1, 0.2, 0.3, 0.4};
  dvi_system *system;
  numbers[0] = c;
  ck_assert_msg(create_with(rows, autonomous, &system) == DVI_OK, "%s", dvi_last_error());
  const dvi_status found = dvi_system_check(system, 0.3, q, v, 0, NULL);
  ck_assert_msg(found == status, "%s", dvi_last_error());
  if (status != DVI_OK) check_words(words);
  dvi_system_destroy(&system);
  numbers[0] = 0;
}

START_TEST(the_check_compares_derivatives_patterns_and_times)
{
  static const int too_few[] = {0, 0, 0, 1, 1};
  dvi_nonholonomic rows = good;
  check_says(good, 0, 1, DVI_OK, NULL);
  check_says(good, 0.2, 0, DVI_OK, NULL);
  check_says(good, 0.2, 1, DVI_BAD_ARGUMENT, "constraint 'disk': its matrix A has");
  rows.derivative = NULL;
  check_says(rows, 0, 1, DVI_OK, NULL);
  rows.by_q = (dvi_pattern){too_few, by_row};
  check_says(rows, 0, 1, DVI_BAD_ARGUMENT, "(1,2) is not in the pattern");
  rows = good;
  rows.derivative = wrong_derivative;
  check_says(rows, 0, 1, DVI_BAD_ARGUMENT, "constraint 'disk': d(A v + a)_i/dq_j at (i,j) = (1,2)");
}
END_TEST

/* ---- integrable and dependent rows ---- */

static int straight_rows(double t, const double *q, double *A, void *user)
{
  (void)t, (void)q, (void)user;
  A[0] = 1;
  A[1] = -0.5;
  return 0;
}

/* y' x - x' y = 0 keeps the angle of (x,y). */
static int angle_rows(double t, const double *q, double *A, void *user)
{
  (void)t, (void)user;
  A[0] = -q[1];
  A[1] = q[0];
  return 0;
}

/* dz = y dx and dx = z dy are not integrable, but together they leave one direction, and so a
 * curve. */
static int both_rows(double t, const double *q, double *A, void *user)
{
  const double entries[] = {-q[1], 0, 1, 1, -q[2], 0};
  (void)t, (void)user;
  memcpy(A, entries, sizeof entries);
  return 0;
}

/* dx = y dt is not integrable in (t,x,y). */
static int plain_rows(double t, const double *q, double *A, void *user)
{
  (void)t, (void)q, (void)user;
  A[0] = 1;
  A[1] = 0;
  return 0;
}

static int by_y(double t, const double *q, double *a, void *user)
{
  (void)t, (void)user;
  a[0] = -q[1];
  return 0;
}

static int by_time(double t, const double *q, double *a, void *user)
{
  (void)q, (void)user;
  a[0] = -cos(t);
  return 0;
}

/* Gives the status of the check and of a start at q = (0.4, 0.7, 0.3), which must agree. */
static dvi_status admitted(int n, int autonomous, dvi_nonholonomic rows)
{
  static const double q[] = {0.4, 0.7, 0.3}, zero[3] = {0};
  const dvi_system_terms terms = {.dimension = n,
                                  .mass = {.scalar = 1},
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = autonomous};
  dvi_system *system;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator *integrator = create_integrator(system, "nonholonomic");
  const dvi_start_options project = {.project = 1};
  const dvi_status checked = dvi_system_check(system, 0, q, zero, 0, NULL),
                   started = dvi_integrator_start_with(integrator, 0, q, zero, &project);
  ck_assert_msg(checked == started, "%d, %d: %s", checked, started, dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return checked;
}

START_TEST(integrable_rows_are_refused)
{
  static const int start[] = {0, 2}, row[] = {0, 1};
  const dvi_pattern pair = {start, row};
  const dvi_nonholonomic straight = {
      .name = "gears", .count = 1, .value = straight_rows, .transposed = pair};
  const dvi_nonholonomic angle = {
      .name = "angle", .count = 1, .value = angle_rows, .transposed = pair};
  const dvi_nonholonomic both = {.name = "both", .count = 2, .value = both_rows};
  dvi_nonholonomic drift = {
      .name = "drift", .count = 1, .value = plain_rows, .affine = by_y, .transposed = pair};
  ck_assert_int_eq(admitted(3, 1, straight), DVI_BAD_ARGUMENT);
  check_words("nonholonomic constraint 'gears' is integrable");
  ck_assert_int_eq(admitted(3, 1, angle), DVI_BAD_ARGUMENT);
  check_words("nonholonomic constraint 'angle' is integrable");
  ck_assert_int_eq(admitted(3, 1, both), DVI_BAD_ARGUMENT);
  check_words("the nonholonomic constraints, 'both' and the others, are integrable together");
  ck_assert_int_eq(admitted(2, 1, drift), DVI_OK);
  drift.affine = by_time;
  ck_assert_int_eq(admitted(2, 0, drift), DVI_BAD_ARGUMENT);
  check_words("nonholonomic constraint 'drift' is integrable");
}
END_TEST

static int twice_rows(double t, const double *q, double *A, void *user)
{
  (void)t, (void)user;
  A[0] = sin(q[2]);
  A[1] = -cos(q[2]);
  A[2] = 2 * A[0];
  A[3] = 2 * A[1];
  return 0;
}

START_TEST(dependent_rows_are_refused)
{
  static const int start[] = {0, 2, 4}, row[] = {0, 1, 0, 1};
  const dvi_nonholonomic twice = {
      .name = "twice", .count = 2, .value = twice_rows, .transposed = {start, row}};
  ck_assert_int_eq(admitted(3, 1, twice), DVI_SINGULAR);
  check_words("nonholonomic constraint 'twice' depends on the other constraints at t = 0");
}
END_TEST

/* ---- starts ---- */

START_TEST(starts_off_the_rows_are_refused_or_projected)
{
  problem *model = create_problem("knife-edge", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "nonholonomic");
  const double q[] = {0, 0, 0.5}, p[] = {1, 2, 0.3};
  double off;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_BAD_ARGUMENT);
  check_words("constraint 'blade', A v + a, is -1.27");
  const dvi_start_options project = {.project = 1};
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, q, p, &project), DVI_OK);
  const double *at = dvi_integrator_p(integrator), along = cos(0.5) + 2 * sin(0.5);
  ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
  ck_assert_double_lt(off, 1e-15);
  ck_assert_double_eq_tol(at[0], along * cos(0.5), 1e-15);
  ck_assert_double_eq_tol(at[1], along * sin(0.5), 1e-15);
  ck_assert_double_eq_tol(at[2], 0.3, 1e-15);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- failing callbacks ---- */

static int fails_later(double t, const double *q, double *A, void *user)
{
  const int failing = t > 0.25;
  A[0] = failing && *(const int *)user == 0 ? (double)NAN : sin(q[2]);
  A[1] = -cos(q[2]);
  return failing ? *(const int *)user : 0;
}

START_TEST(callbacks_that_fail_leave_the_state)
{
  static const int start[] = {0, 2}, row[] = {0, 1};
  static const int codes[] = {0, -1, 1};
  const double q[3] = {0}, v[] = {1, 0, 2};
  for (int k = 0; k < 3; k++) {
    int code = codes[k];
    const dvi_nonholonomic rows = {.name = "blade",
                                   .count = 1,
                                   .value = fails_later,
                                   .transposed = {start, row},
                                   .user = &code};
    const dvi_system_terms terms = {
        .dimension = 3, .mass = {.scalar = 1}, .nonholonomics = &rows, .nonholonomic_count = 1};
    dvi_system *system;
    ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
    dvi_integrator *integrator = create_integrator(system, "nonholonomic");
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
    advance(integrator, 0.1, 2);
    const double before = dvi_integrator_q(integrator)[0];
    const dvi_status status = dvi_integrator_step(integrator, 0.1);
    ck_assert_int_ne(status, DVI_OK);
    check_words("step 3 from t = 0.2");
    ck_assert_double_eq(dvi_integrator_q(integrator)[0], before);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* ---- checkpoints, ensembles ---- */

START_TEST(a_restored_run_has_the_same_bits)
{
  static unsigned char bytes[1 << 16];
  for (int kind = ROLLING_PLATE; kind <= ROLLING_COSINES; kind++) {
    size_t size;
    rolling model;
    make_rolling((rolling_kind)kind, 0, &model);
    dvi_integrator *first = rolling_integrator(&model, "nonholonomic"),
                   *second = create_integrator(model.system, "nonholonomic");
    advance(first, 0.01, 20);
    ck_assert_int_eq(dvi_integrator_save_memory(first, bytes, sizeof bytes, &size), DVI_OK);
    advance(first, 0.01, 20);
    ck_assert_msg(dvi_integrator_restore_memory(second, bytes, size) == DVI_OK, "%s",
                  dvi_last_error());
    advance(second, 0.01, 20);
    for (int i = 0; i < model.n; i++) {
      ck_assert_double_eq(dvi_integrator_q(first)[i], dvi_integrator_q(second)[i]);
      ck_assert_double_eq(dvi_integrator_p(first)[i], dvi_integrator_p(second)[i]);
    }
    dvi_integrator_destroy(&first);
    dvi_integrator_destroy(&second);
    destroy_rolling(&model);
  }
}
END_TEST

START_TEST(members_of_ensembles_have_the_bits_of_runs_alone)
{
  enum { MEMBERS = 3, N = 3 };
  problem *model = create_problem("sleigh", NULL);
  double q[N * MEMBERS], p[N * MEMBERS], t[MEMBERS], q_all[N * MEMBERS], p_all[N * MEMBERS];
  for (int k = 0; k < MEMBERS; k++)
    for (int i = 0; i < N; i++) {
      q[i * MEMBERS + k] = model->q[i];
      p[i * MEMBERS + k] = (1 + 0.1 * k) * model->p[i];
    }
  dvi_ensemble *e = create_ensemble(model->system, "nonholonomic",
                                    (dvi_ensemble_options){.members = MEMBERS});
  ck_assert_msg(dvi_ensemble_start(e, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.02, 25), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q_all, p_all), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    dvi_integrator *alone = create_integrator(model->system, "nonholonomic");
    const double q0[] = {q[k], q[MEMBERS + k], q[2 * MEMBERS + k]},
                 p0[] = {p[k], p[MEMBERS + k], p[2 * MEMBERS + k]};
    ck_assert_int_eq(dvi_integrator_start(alone, 0, q0, p0), DVI_OK);
    advance(alone, 0.02, 25);
    for (int i = 0; i < N; i++)
      ck_assert_double_eq(dvi_integrator_q(alone)[i], q_all[i * MEMBERS + k]);
    dvi_integrator_destroy(&alone);
  }
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_step_takes_no_memory)
{
  problem *model = create_problem("snakeboard", NULL);
  dvi_integrator *integrator = start_integrator(model, "composition:order=4");
  dvi_counters before, after;
  advance(integrator, 0.05, 3);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 0.05, 20);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(before.allocations, after.allocations);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(nonholonomic)
{
  tcase_add_test(tests, rows_that_are_not_well_declared_are_refused);
  tcase_add_test(tests, rows_are_refused_beside_other_kinds_of_dynamics);
  tcase_add_test(tests, rows_are_refused_beside_a_vector_potential);
  tcase_add_test(tests, methods_that_take_no_rows_say_so);
  tcase_add_test(tests, the_method_wants_such_rows);
  tcase_add_test(tests, a_transform_of_time_and_a_path_take_no_rows);
  tcase_add_test(tests, the_check_compares_derivatives_patterns_and_times);
  tcase_add_test(tests, integrable_rows_are_refused);
  tcase_add_test(tests, dependent_rows_are_refused);
  tcase_add_test(tests, starts_off_the_rows_are_refused_or_projected);
  tcase_add_test(tests, callbacks_that_fail_leave_the_state);
  tcase_add_test(tests, a_restored_run_has_the_same_bits);
  tcase_add_test(tests, members_of_ensembles_have_the_bits_of_runs_alone);
  tcase_add_test(tests, a_step_takes_no_memory);
}
