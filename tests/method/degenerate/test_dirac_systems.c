/* labels: order */
/* dg-phase with a Hamiltonian: more constraints than two, many particles, forces that depend on
 * time, ensembles. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/paced.h"
#include "support/suite.h"

/* ---- beads on hoops ---- */

/* Free particles of unit mass, each on the unit circle in the plane n.q = 0. Each has the four
 * constraints (|q|^2 - 1)/2, q.p, n.q and n.p, and turns about n at a constant rate. */
enum { BEADS_MOST = 24, N = 3 * BEADS_MOST, M = 4 * BEADS_MOST };

static const double axis[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3};

typedef struct beads {
  int count;
  int phi_start[M + 1], phi_row[15 * BEADS_MOST], diagonal_start[N + 1], diagonal_row[N],
      none[N + 1];
  double q[N], p[N];
} beads;

static int beads_H(double t, const double *q, const double *p, double *H, void *user)
{
  const beads *string = user;
  (void)t, (void)q;
  *H = 0;
  for (int i = 0; i < 3 * string->count; i++) *H += p[i] * p[i] / 2;
  return 0;
}

static int beads_H_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                            void *user)
{
  const beads *string = user;
  (void)t, (void)q;
  for (int i = 0; i < 3 * string->count; i++) {
    H_q[i] = 0;
    H_p[i] = p[i];
  }
  return 0;
}

static int beads_H_hessian(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                           double *H_pp, void *user)
{
  const beads *string = user;
  (void)t, (void)q, (void)p, (void)H_qq, (void)H_qp;
  for (int i = 0; i < 3 * string->count; i++) H_pp[i] = 1;
  return 0;
}

static int beads_phi(const double *q, const double *p, double *phi, void *user)
{
  const beads *string = user;
  for (int b = 0; b < string->count; b++, q += 3, p += 3, phi += 4) {
    phi[0] = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1) / 2;
    phi[1] = q[0] * p[0] + q[1] * p[1] + q[2] * p[2];
    phi[2] = axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2];
    phi[3] = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
  }
  return 0;
}

/* A bead has 15 entries, and its constraints have 3, 6, 3 and 3. */
static int beads_phi_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  const beads *string = user;
  for (int b = 0; b < string->count; b++, q += 3, p += 3, phi_z += 15)
    for (int i = 0; i < 3; i++) {
      phi_z[i] = phi_z[6 + i] = q[i];
      phi_z[3 + i] = p[i];
      phi_z[9 + i] = phi_z[12 + i] = axis[i];
    }
  return 0;
}

static int beads_phi_hessian(const double *q, const double *p, const double *w, double *qq,
                             double *qp, double *pp, void *user)
{
  const beads *string = user;
  (void)q, (void)p, (void)pp;
  for (int i = 0; i < 3 * string->count; i++) {
    qq[i] = w[i / 3 * 4];
    qp[i] = w[i / 3 * 4 + 1];
  }
  return 0;
}

static void fill_patterns(beads *string)
{
  static const int first[4] = {0, 3, 9, 12};
  const int n = 3 * string->count;
  for (int b = 0; b < string->count; b++) {
    for (int k = 0; k < 4; k++) string->phi_start[4 * b + k] = 15 * b + first[k];
    for (int i = 0; i < 3; i++) {
      int *row = string->phi_row + 15 * b + i;
      row[0] = row[3] = row[9] = 3 * b + i;
      row[6] = row[12] = n + 3 * b + i;
    }
  }
  string->phi_start[4 * string->count] = 15 * string->count;
  for (int i = 0; i <= n; i++) string->diagonal_start[i] = i;
  for (int i = 0; i < n; i++) string->diagonal_row[i] = i;
}

/* Places the beads at time t. Bead b turns at the rate 1 + b/10. The vectors span the plane, and
 * axis = u x w. */
static void place_beads(const beads *string, double t, double *q, double *p)
{
  static const double u[3] = {2.0 / 3, 1.0 / 3, -2.0 / 3}, w[3] = {-2.0 / 3, 2.0 / 3, -1.0 / 3};
  for (int b = 0; b < string->count; b++) {
    const double rate = 1 + 0.1 * b, c = cos(rate * t), s = sin(rate * t);
    for (int i = 0; i < 3; i++) {
      q[3 * b + i] = c * u[i] + s * w[i];
      p[3 * b + i] = rate * (c * w[i] - s * u[i]);
    }
  }
}

static dvi_system *create_beads(beads *string, int count)
{
  *string = (beads){.count = count};
  fill_patterns(string);
  place_beads(string, 0, string->q, string->p);
  const dvi_pattern none = {string->none, NULL},
                    diagonal = {string->diagonal_start, string->diagonal_row};
  const dvi_hamiltonian H = {.value = beads_H,
                             .gradient = beads_H_gradient,
                             .hessian = beads_H_hessian,
                             .qq = none,
                             .qp = none,
                             .pp = diagonal,
                             .user = string};
  const dvi_constraint phi = {.count = 4 * count,
                              .value = beads_phi,
                              .gradient = beads_phi_gradient,
                              .hessian = beads_phi_hessian,
                              .gradients = {string->phi_start, string->phi_row},
                              .qq = diagonal,
                              .qp = diagonal,
                              .pp = none,
                              .user = string};
  const dvi_system_terms terms = {
      .dimension = 3 * count, .autonomous = 1, .hamiltonian = &H, .constraint = &phi};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_system_check(system, 0, string->q, string->p, 0, NULL) == DVI_OK, "%s",
                dvi_last_error());
  return system;
}

/* One bead, whose Jacobian is dense, and so many that it is sparse. Degree 4 errs by 1e-12 at this
 * step and the largest rate. */
START_TEST(beads_turn_at_their_rates)
{
  beads string;
  double q[N], p[N];
  dvi_system *system = create_beads(&string, _i);
  dvi_integrator *integrator = create_integrator(system, "dg-phase:degree=4");
  ck_assert_msg(dvi_integrator_start(integrator, 0, string.q, string.p) == DVI_OK, "%s",
                dvi_last_error());
  advance(integrator, 0.02, 50);
  place_beads(&string, 1, q, p);
  ck_assert_double_le(distance(3 * _i, dvi_integrator_q(integrator), q), 1e-11);
  ck_assert_double_le(distance(3 * _i, dvi_integrator_p(integrator), p), 3e-11);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* The entries grow in proportion to the beads. */
START_TEST(the_jacobian_is_as_sparse_as_the_system)
{
  static const int counts[] = {1, BEADS_MOST};
  int entries[2];
  for (int k = 0; k < 2; k++) {
    beads string;
    char text[1024];
    dvi_system *system = create_beads(&string, counts[k]);
    dvi_integrator *integrator = create_integrator(system, "dg-phase:degree=2");
    ck_assert_uint_lt(dvi_integrator_explain(integrator, text, sizeof text), sizeof text);
    const char *at = strstr(text, "Jacobian with ");
    ck_assert_ptr_nonnull(at);
    entries[k] = (int)strtol(at + strlen("Jacobian with "), NULL, 10);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
  ck_assert_int_eq(entries[1], BEADS_MOST * entries[0]);
}
END_TEST

/* ---- time ---- */

static int driven_H(double t, const double *q, const double *p, double *H, void *user)
{
  (void)user;
  *H = (p[0] * p[0] + p[1] * p[1]) / 2 + (1 + 0.5 * cos(2 * t)) * q[1];
  return 0;
}

static int driven_H_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                             void *user)
{
  (void)q, (void)user;
  H_q[0] = 0;
  H_q[1] = 1 + 0.5 * cos(2 * t);
  H_p[0] = p[0];
  H_p[1] = p[1];
  return 0;
}

/* Judged by ARKODE at its default 1e-12, far below the errors here. */
START_TEST(a_hamiltonian_may_depend_on_time)
{
  problem *model = create_problem("circle-dirac", NULL);
  const dvi_hamiltonian H = {.value = driven_H, .gradient = driven_H_gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .hamiltonian = &H, .constraint = model->terms->constraint};
  const dvi_reference_options options = {.code = DVI_ARKODE};
  dvi_system *system = NULL;
  double q[2], p[2], error[3];
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  memcpy(q, model->q, sizeof q);
  memcpy(p, model->p, sizeof p);
  ck_assert_msg(dvi_reference_judge(system, 0, 2, q, p, &options, NULL) == DVI_OK, "%s",
                dvi_last_error());
  for (int level = 0; level < 3; level++) {
    dvi_integrator *integrator = create_integrator(system, "dg-phase:degree=2");
    const int steps = 25 << level;
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
    advance(integrator, 2.0 / steps, steps);
    error[level] = distance(2, dvi_integrator_q(integrator), q);
    dvi_integrator_destroy(&integrator);
    if (level > 0) ck_assert_double_eq_tol(log2(error[level - 1] / error[level]), 4, 0.2);
  }
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* ---- steps of other lengths ---- */

static int height(double t, const double *q, double *g, void *user)
{
  (void)t, (void)user;
  *g = 1.5 + q[1];
  return 0;
}

/* Steps have the length 3/2 + y, forth and back. The parasitic mode from a change of length turns
 * back with them. */
START_TEST(controlled_steps_back_undo_steps)
{
  problem *model = create_problem("circle-dirac", NULL);
  const dvi_monitor monitor = {.kind = DVI_MONITOR_FUNCTION,
                               .function = {.name = "height", .value = height}};
  dvi_integrator *integrator = NULL;
  ck_assert_msg(create_controlled(model->system, &monitor, "dg-phase:degree=2", &integrator) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_msg(dvi_integrator_start(integrator, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  advance(integrator, 0.05, 40);
  ck_assert_double_gt(distance(2, dvi_integrator_q(integrator), model->q), 0.5);
  advance(integrator, -0.05, 40);
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator), model->q), 1e-10);
  ck_assert_double_le(distance(2, dvi_integrator_p(integrator), model->p), 1e-10);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- ensembles ---- */

START_TEST(members_have_the_digits_of_single_runs)
{
  enum { MEMBERS = 3 };
  problem *model = create_problem("circle-dirac", NULL);
  dvi_ensemble *ensemble = NULL;
  double q[2 * MEMBERS], p[2 * MEMBERS], end_q[2 * MEMBERS];
  for (int k = 0; k < MEMBERS; k++)
    for (int i = 0; i < 2; i++) {
      q[i * MEMBERS + k] = model->q[i];
      p[i * MEMBERS + k] = model->p[i] * (1 + k);
    }
  const dvi_ensemble_options options = {.members = MEMBERS};
  ck_assert_msg(dvi_ensemble_create(model->system, "dg-phase:degree=3", &options, &ensemble) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_msg(dvi_ensemble_start(ensemble, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  for (int step = 0; step < 20; step++) ck_assert_int_eq(dvi_ensemble_step(ensemble, 0.1), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(ensemble, NULL, end_q, NULL), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    dvi_integrator *single = create_integrator(model->system, "dg-phase:degree=3");
    ck_assert_int_eq(dvi_integrator_start(single, 0, model->q,
                                          (double[]){model->p[0] * (1 + k), model->p[1] * (1 + k)}),
                     DVI_OK);
    advance(single, 0.1, 20);
    for (int i = 0; i < 2; i++)
      ck_assert_double_eq(end_q[i * MEMBERS + k], dvi_integrator_q(single)[i]);
    dvi_integrator_destroy(&single);
  }
  dvi_ensemble_destroy(&ensemble);
  problem_destroy(&model);
}
END_TEST

SUITE(dirac_systems)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, beads_turn_at_their_rates, 1, 3);
  tcase_add_loop_test(tests, beads_turn_at_their_rates, BEADS_MOST, BEADS_MOST + 1);
  tcase_add_test(tests, the_jacobian_is_as_sparse_as_the_system);
  tcase_add_test(tests, a_hamiltonian_may_depend_on_time);
  tcase_add_test(tests, controlled_steps_back_undo_steps);
  tcase_add_test(tests, members_have_the_digits_of_single_runs);
}
