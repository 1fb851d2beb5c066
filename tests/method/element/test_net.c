/* Large nets of springs: created without what no step needs, and solved by Newton's methods without
 * the whole Jacobian. Counters and memory tell; docs/performance.md has the times, "Large sparse
 * systems". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

/* The catalogue's net of side^dim masses, k = 1. */
static problem *create_net(int dim, int side)
{
  char dim_setting[16], side_setting[16], message[256] = "";
  const char *const settings[] = {dim_setting, side_setting};
  problem *net = NULL;
  (void)snprintf(dim_setting, sizeof dim_setting, "dim=%d", dim);
  (void)snprintf(side_setting, sizeof side_setting, "side=%d", side);
  ck_assert_msg(problem_create("net", 2, settings, &net, message, sizeof message) == DVI_OK, "%s",
                message);
  return net;
}

/* Creates the system with a potential without a Hessian, so that every entry counts as not zero. */
static dvi_system *system_without_hessian(const problem *net)
{
  dvi_system *system = NULL;
  dvi_system_terms terms = *net->terms;
  dvi_potential springs = terms.potentials[0];
  springs.hessian_batch = NULL;
  springs.qq = (dvi_pattern){NULL, NULL};
  terms.potentials = &springs;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

/* With n = 5000 and degree 6 a Jacobian of 30 000 unknowns would have 1.8e6 entries, and its
 * factors 2e7. */
START_TEST(fixed_point_iteration_takes_no_jacobian)
{
  problem *net = create_net(2, 50);
  dvi_system *without = _i == 0 ? system_without_hessian(net) : NULL;
  const long before = heap_bytes();
  dvi_integrator *integrator = create_integrator(_i == 0 ? without : net->system,
                                                 "galerkin:degree=6");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, net->q, net->p), DVI_OK);
  advance(integrator, 0.1, 20);
  const dvi_counters counters = read_counters(integrator);
  ck_assert_int_eq(counters.fixed_points, 20);
  ck_assert_int_eq(counters.symbolic + counters.factorizations + counters.preparations, 0);
  ck_assert_int_lt(heap_bytes() - before, 12000000);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&without);
  problem_destroy(&net);
}
END_TEST

/* h omega = 14. */
START_TEST(a_stiff_step_takes_little_memory)
{
  static const char *const methods[] = {"galerkin:degree=6", "galerkin:degree=6,solver=newton"};
  problem *net = create_net(2, 50);
  const long before = heap_bytes();
  dvi_integrator *integrator = start_integrator(net, methods[_i]);
  advance(integrator, 5, 2);
  const dvi_counters counters = read_counters(integrator);
  ck_assert_int_eq(_i == 0 ? counters.simplified : counters.newtons, 2);
  ck_assert_int_eq(counters.products > 0, _i == 1);
  ck_assert_int_eq(counters.symbolic, 1); /* one n x n pattern, for three pairs of eigenvalues */
  ck_assert_int_lt(heap_bytes() - before, 50000000);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&net);
}
END_TEST

/* Compares solutions of one step's equations by two solvers. q is about 0.1. */
static void check_same_step(const problem *net, const char *one, const char *other, double h)
{
  dvi_integrator *a = start_integrator(net, one), *b = start_integrator(net, other);
  advance(a, h, 2);
  advance(b, h, 2);
  const double apart = distance(net->nq, dvi_integrator_q(a), dvi_integrator_q(b));
  ck_assert_msg(apart <= 1e-14, "%s, %s: %g", one, other, apart);
  ck_assert_int_gt(read_counters(b).products, 0);
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
}

/* Preconditioned by decoupled systems. */
START_TEST(newton_by_products_finds_what_the_ladder_finds)
{
  problem *net = create_net(2, 40);
  check_same_step(net, "galerkin:degree=6", "galerkin:degree=6,solver=newton", 4);
  check_same_step(net, "galerkin:degree=6", "galerkin:degree=6,solver=kinsol", 4);
  problem_destroy(&net);
}
END_TEST

/* In three dimensions factors do not pay beyond some 15 000 unknowns, and the kinetic part is the
 * preconditioner. */
START_TEST(newton_by_products_needs_no_factor)
{
  problem *net = create_net(3, 18);
  check_same_step(net, "galerkin:degree=2,solver=fixed-point", "galerkin:degree=2,solver=newton",
                  0.5);
  dvi_integrator *ladder = start_integrator(net, "galerkin:degree=2");
  advance(ladder, 3, 1);
  ck_assert_int_eq(read_counters(ladder).newtons, 1); /* simplified Newton's method is left out */
  ck_assert_int_eq(read_counters(ladder).simplified + read_counters(ladder).factorizations, 0);
  dvi_integrator_destroy(&ladder);
  problem_destroy(&net);
}
END_TEST

/* A run that is restored in the middle goes on with the same digits, because a step's
 * preconditioner is made from that step alone. */
START_TEST(a_step_by_products_depends_on_its_state_alone)
{
  problem *net = create_net(2, 40);
  dvi_integrator *whole = start_integrator(net, "galerkin:degree=6,solver=newton");
  dvi_integrator *other = start_integrator(net, "galerkin:degree=6,solver=newton");
  advance(other, 3, 1); /* at other places, and lengths */
  ck_assert_int_eq(dvi_integrator_start(other, 0, net->q, net->p), DVI_OK);
  advance(whole, 4, 2);
  advance(other, 4, 2);
  ck_assert_mem_eq(dvi_integrator_q(whole), dvi_integrator_q(other),
                   (size_t)net->nq * sizeof(double));
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&other);
  problem_destroy(&net);
}
END_TEST

static void check_explained(const problem *net, const char *method, const char *words)
{
  char text[2000];
  dvi_integrator *integrator = create_integrator(net->system, method);
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_msg(strstr(text, words) != NULL, "'%s' is not in:\n%s", words, text);
  ck_assert_int_eq(read_counters(integrator).factorizations, 0);
  dvi_integrator_destroy(&integrator);
}

START_TEST(explain_says_which_solver_it_would_be)
{
  problem *net = create_net(2, 50);
  check_explained(net, "midpoint", "linear solver: sparse LU (KLU) in the order of AMD, ");
  check_explained(
      net, "galerkin:degree=6",
      "linear solver: GMRES with products of the Jacobian, preconditioned by decoupled systems");
  problem_destroy(&net);
  net = create_net(3, 18);
  check_explained(net, "galerkin:degree=2",
                  "simplified Newton's method (not for systems of this size)");
  check_explained(net, "galerkin:degree=2", "preconditioned by its kinetic part");
  problem_destroy(&net);
}
END_TEST

/* V = -q^2/2 for every coordinate, with many Hessian entries that stay 0. */
enum { UNSTABLE = 3000 };

static int unstable_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int i = 0; i < UNSTABLE; i++) *V -= 0.5 * q[i] * q[i];
  return 0;
}

static int unstable_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < UNSTABLE; i++) V_q[i] = -q[i];
  return 0;
}

static int unstable_hessian(double t, const double *q, double *V_qq, void *user)
{
  const int *start = user, *row = start + UNSTABLE + 1;
  (void)t, (void)q;
  for (int j = 0; j < UNSTABLE; j++)
    for (int e = start[j]; e < start[j + 1]; e++) V_qq[e] = row[e] == j ? -1 : 0;
  return 0;
}

/* The pattern's start [UNSTABLE+1] and rows, freed by the caller: a graph without small separators,
 * whose factors fill. */
static int *create_tangle(void)
{
  static const int factor[] = {1, 17, 101, 577}, shift[] = {1, 5, 7, 11};
  static char meets[UNSTABLE][UNSTABLE];
  int *start = calloc(UNSTABLE + 1 + 9 * UNSTABLE, sizeof *start), entries = 0;
  ck_assert_ptr_nonnull(start);
  for (int i = 0; i < UNSTABLE; i++)
    for (int k = 0; k < 4; k++) {
      const int j = (i * factor[k] + shift[k]) % UNSTABLE;
      meets[i][i] = meets[i][j] = meets[j][i] = 1;
    }
  for (int j = 0; j < UNSTABLE; j++) {
    for (int i = 0; i < UNSTABLE; i++)
      if (meets[j][i]) start[UNSTABLE + 1 + entries++] = i;
    start[j + 1] = entries;
  }
  return start;
}

/* The midpoint rule q1 - q0 = h (p0 + p1)/2, p1 - p0 = h (q0 + q1)/2 has a pole at h = 2, and other
 * solutions beyond. */
START_TEST(products_do_not_lead_beyond_a_pole)
{
  static const struct {
    double h;
    dvi_status status;
    const char *words;
  } cases[] = {{1.9, DVI_OK, ""},
               {2, DVI_NOT_CONVERGED, "the matrix is singular"},
               {2.2, DVI_STEP_TOO_LARGE, "up to h = 1.99"},
               {5, DVI_STEP_TOO_LARGE, "up to h = 1.99"}};
  static double q[UNSTABLE], p[UNSTABLE];
  int *start = create_tangle();
  dvi_system *system;
  const dvi_potential potential = {.value = unstable_value,
                                   .gradient = unstable_gradient,
                                   .hessian = unstable_hessian,
                                   .qq = {start, start + UNSTABLE + 1},
                                   .user = start};
  const dvi_system_terms terms = {.dimension = UNSTABLE,
                                  .mass.scalar = 1,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .autonomous = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  for (int i = 0; i < UNSTABLE; i++) q[i] = 1 + 0.001 * i, p[i] = 0.5;
  dvi_integrator *integrator = create_integrator(system, "midpoint");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, cases[_i].h), cases[_i].status);
  if (cases[_i].status != DVI_OK) check_words(cases[_i].words);
  ck_assert_int_gt(read_counters(integrator).products, 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  free(start);
}
END_TEST

SUITE(net)
{
  tcase_set_timeout(tests, 300);
  tcase_add_loop_test(tests, fixed_point_iteration_takes_no_jacobian, 0, 2);
  tcase_add_loop_test(tests, a_stiff_step_takes_little_memory, 0, 2);
  tcase_add_test(tests, newton_by_products_finds_what_the_ladder_finds);
  tcase_add_test(tests, a_step_by_products_depends_on_its_state_alone);
  if (is_short_run()) return;
  tcase_add_loop_test(tests, products_do_not_lead_beyond_a_pole, 0, 4);
  tcase_add_test(tests, newton_by_products_needs_no_factor);
  tcase_add_test(tests, explain_says_which_solver_it_would_be);
}
