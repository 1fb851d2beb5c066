/* labels: order */
/* Families with two indices: their members, names and starts, and a lattice whose motion has the
 * order and the energy of any other. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { N = 8 };

#define RUN "step: 0.1\nuntil: 1\n"
#define GRID                                                                                \
  "parameters: {N: 3, M: 2}\ncoordinates: {\"u[N,M]\": scalar}\nlagrangian: sum(i, sum(j, " \
  "u[i,j]'^2/2 - i*u[i,j]^j))\n" RUN

START_TEST(the_last_index_runs_first)
{
  static const char *const name[] = {"u_1_1", "u_1_2", "u_2_1", "u_2_2", "u_3_1", "u_3_2"};
  const double *q, *v, *p;
  ck_assert_msg(parse_scene(GRID "initial: {\"u[i,j]\": 10*i + j, \"u'[i,j]\": j}\n") != DVI_OK,
                "u' has its index before the dash");
  ck_assert_msg(parse_scene(GRID "initial: {\"u[i,j]\": 10*i + j, \"u[i,j]'\": j - i}\n") == DVI_OK,
                "%s", message);
  dvi_scene_start(scene, &q, &v, &p);
  for (int k = 0; k < 6; k++) {
    const int i = k / 2 + 1, j = k % 2 + 1;
    ck_assert_str_eq(dvi_scene_coordinate(scene, k), name[k]);
    ck_assert(fabs(q[k] - (10 * i + j)) < 1e-14 && fabs(v[k] - (j - i)) < 1e-14);
  }
  double L, sum = 0;
  ck_assert_int_eq(dvi_system_lagrangian(dvi_scene_system(scene), 0, q, (double[6]){0}, &L),
                   DVI_OK);
  /* NOLINT(bugprone-integer-division) */
  for (int k = 0; k < 6; k++) sum -= (k / 2 + 1) * pow(q[k], k % 2 + 1);
  ck_assert(fabs(L - sum) <= 1e-13 * fabs(sum));
}
END_TEST

START_TEST(what_says_more_of_a_member_comes_first)
{
  const double *q, *v, *p;
  ck_assert_msg(
      parse_scene(GRID
                  "initial: {\"u[2,2]\": 7, \"u[i,j]\": 1, \"u[2,j]\": j + 1, \"u[i,1]'\": i}\n") ==
          DVI_OK,
      "%s", message);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_mem_eq(q, ((double[]){1, 1, 2, 7, 1, 1}), 6 * sizeof *q);
  ck_assert_mem_eq(v, ((double[]){1, 0, 2, 0, 3, 0}), 6 * sizeof *v);
  ck_assert_msg(parse_scene(GRID "initial: {u: [[1, 2], [3, 4], [5, 6]]}\n") == DVI_OK, "%s",
                message);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_mem_eq(q, ((double[]){1, 2, 3, 4, 5, 6}), 6 * sizeof *q);
}
END_TEST

START_TEST(vectors_and_momenta_may_stand_on_a_grid)
{
  const double *q, *v, *p;
  static const char text[] = "coordinates: {\"r[2,2]\": vector(2)}\nhamiltonian: sum(i, sum(j, "
                             "dot(p(r[i,j]), p(r[i,j]))/2 + i*r[i,j][2]))\n"
                             "initial: {\"r[i,j]\": \"[i, j]\", \"p(r[i,j])\": \"[i*j, 0]\"}\n" RUN;
  ck_assert_msg(parse_scene(text) == DVI_OK, "%s", message);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_mem_eq(q, ((double[]){1, 1, 1, 2, 2, 1, 2, 2}), 8 * sizeof *q);
  ck_assert_mem_eq(p, ((double[]){1, 0, 2, 0, 2, 0, 4, 0}), 8 * sizeof *p);
  ck_assert_str_eq(dvi_scene_coordinate(scene, 3), "r_1_2_y");
  ck_assert_str_eq(dvi_scene_momentum(scene, 4), "p_r_2_1_x");
}
END_TEST

START_TEST(slips_with_two_indices_are_told)
{
  static const char *const texts[][2] = {
      {GRID "initial: {\"u[i]\": 1}\n", "'u' has 2 indices, not 1"},
      {GRID "initial: {\"u[1,j]\": 1}\n", "the start of u is not given"},
      {GRID "initial: {\"u[i,j]\": 1, \"u[1,j]\": 1, \"u[i,1]\": 2}\n",
       "a number of u is given twice"},
      {GRID "initial: {\"u[4,1]\": 1}\n", "the index 4 is not between 1 and 3"},
      {GRID "initial: {\"u[1,4]\": 1}\n", "the index 4 is not between 1 and 2"},
      {GRID "initial: {u: [1, 2, 3, 4, 5, 6]}\n", "a vector of 6 for u, which is a 3 x 2 matrix"},
      {"coordinates: {\"u[2,2]\": scalar}\nlagrangian: sum(i, u[i]^2)\ninitial: {u: 1}\n" RUN,
       "u is a family of 2 x 2; take one of it, as u[1,1]"},
      {"coordinates: {\"u[2,2]\": scalar}\nlagrangian: u^2\ninitial: {u: 1}\n" RUN,
       "u is a family of 2 x 2; take one of it, as u[1,1]"},
      {"coordinates: {\"u[2,3]\": scalar}\nlagrangian: sum(i, u[i,i]^2)\ninitial: {u: 1}\n" RUN,
       "i runs over the 2 of u, but u has 3"},
      {"coordinates: {\"u[2,2,2]\": scalar}\nlagrangian: 1\ninitial: {u: 1}\n" RUN,
       "or as x[N,M] for one of N times M"},
      {"coordinates: {\"u[20000,20000]\": scalar}\nlagrangian: 1\ninitial: {u: 1}\n" RUN,
       "more than 100000000 coordinates"},
      {"coordinates: {\"u[2,2]\": scalar, u_1_2: scalar}\nlagrangian: u_1_2'^2\ninitial: {u: "
       "1}\n" RUN,
       "there is a column 'u_1_2' already"},
  };
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    ck_assert_int_ne(parse_scene(texts[k][0]), DVI_OK);
    ck_assert_msg(strstr(message, texts[k][1]) != NULL, "\"%s\" is not in \"%s\"", texts[k][1],
                  message);
  }
}
END_TEST

/* The lattice of the cookbook: sine-Gordon on 8 x 8 points of a torus. */
static const char lattice[] =
    "parameters: {N: 8, h: 1.25}\ncoordinates: {\"u[N,N]\": scalar}\n"
    "kinetic: h^2/2*sum(i, sum(j, u[i,j]'^2))\npotentials:\n"
    "  gravity: h^2*sum(i, sum(j, 1 - cos(u[i,j])))\n"
    "  springs: >-\n    sum(i, sum(j, (u[if(i < N, i + 1, 1),j] - u[i,j])^2\n"
    "    + (u[i,if(j < N, j + 1, 1)] - u[i,j])^2))/2\n"
    "initial: {\"u[i,j]\": \"3*exp(-((i - 5)^2 + (j - 5)^2)*h^2/4)\"}\n" RUN;

/* The forces of the lattice by loops. */
static void forces(const double *q, double *V_q)
{
  const double h = 1.25;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      const double u = q[N * i + j], around = q[N * ((i + 1) % N) + j] +
                                              q[N * ((i + N - 1) % N) + j] +
                                              q[N * i + (j + 1) % N] + q[N * i + (j + N - 1) % N];
      V_q[N * i + j] = h * h * sin(u) + 4 * u - around;
    }
}

START_TEST(neighbours_on_a_torus_are_those_of_loops)
{
  double V_q[N * N] = {0}, own[N * N], expected[N * N], q[N * N];
  const double t = 0;
  ck_assert_msg(parse_scene(lattice) == DVI_OK, "%s", message);
  for (int k = 0; k < N * N; k++) q[k] = sin(0.7 * k * k);
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  for (int k = 0; k < terms->potential_count; k++) {
    ck_assert_int_eq(terms->potentials[k].gradient_batch(1, &t, q, own, terms->potentials[k].user),
                     0);
    for (int i = 0; i < N * N; i++) V_q[i] += own[i];
  }
  forces(q, expected);
  for (int i = 0; i < N * N; i++) ck_assert(fabs(V_q[i] - expected[i]) < 1e-13);
  dvi_scene_facts facts;
  dvi_scene_facts_of(scene, &facts);
  ck_assert_int_eq(facts.kernels, 2); /* however many points there are */
  ck_assert_int_eq(facts.quadratic_potentials, 1);
}
END_TEST

/* Gives the state at t = 10, and the largest energy error on the way. */
static double follow(const char *method, double h, double *q)
{
  dvi_integrator *integrator = NULL;
  const double *start, *v, *p;
  double first, energy, largest = 0;
  ck_assert_int_eq(dvi_integrator_create(dvi_scene_system(scene), method, &integrator), DVI_OK);
  dvi_scene_start(scene, &start, &v, &p);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, start, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
  for (double t = 0; t < 10 - h / 2; t += h) {
    ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_OK);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
    largest = fmax(largest, fabs(energy - first));
  }
  memcpy(q, dvi_integrator_q(integrator), N * N * sizeof *q);
  dvi_integrator_destroy(&integrator);
  return largest;
}

static double distance(const double *a, const double *b)
{
  double largest = 0;
  for (int i = 0; i < N * N; i++) largest = fmax(largest, fabs(a[i] - b[i]));
  return largest;
}

/* Errors and energy errors of order 4, from one step length to its half. */
START_TEST(a_lattice_is_followed_in_the_order_of_the_method)
{
  double fine[N * N], coarse[N * N], half[N * N];
  ck_assert_msg(parse_scene(lattice) == DVI_OK, "%s", message);
  (void)follow("galerkin:degree=4", 0.05, fine);
  const double energy = follow("galerkin:degree=2", 0.1, coarse),
               energy_half = follow("galerkin:degree=2", 0.05, half);
  const double order = log2(distance(coarse, fine) / distance(half, fine));
  ck_assert_msg(fabs(order - 4) < 0.2, "order %.2f", order);
  ck_assert_msg(energy < 1e-4 && fabs(log2(energy / energy_half) - 4) < 0.3,
                "energy errors %.2e, %.2e", energy, energy_half);
}
END_TEST

SUITE(scene_grid)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, the_last_index_runs_first);
  tcase_add_test(tests, what_says_more_of_a_member_comes_first);
  tcase_add_test(tests, vectors_and_momenta_may_stand_on_a_grid);
  tcase_add_test(tests, slips_with_two_indices_are_told);
  tcase_add_test(tests, neighbours_on_a_torus_are_those_of_loops);
  tcase_add_test(tests, a_lattice_is_followed_in_the_order_of_the_method);
}
