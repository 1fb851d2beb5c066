/* Masses, forces, energies, stiffnesses and loads of cells against quadruple precision. */
#include <math.h>
#include <stdlib.h>

#include "field/elastic/elastic.h"
#include "support/meshes.h"
#include "support/solid/quad_avi.h"
#include "support/solid/judged_solids.h"
#include "support/suite.h"

enum { LAWS = 4, NUMBERS = 12 };

static solid_case random_case(int n, int law, unsigned traits, unsigned long long seed)
{
  return (solid_case){n, 2, 1.5, 0.2, (dvi_elastic_law)law, traits, 0, seed};
}

/* Deformations of up to a half in each entry of the gradient, with J > 0. */
static void random_shift(const quad_solid *s, int cell, double size, unsigned long long *seed,
                         quad *u)
{
  quad H[9] = {0};
  for (int i = 0; i < s->n * s->n; i++) H[i] = size * (2 * random_number(seed) - 1);
  for (int a = 0; a <= s->n; a++)
    for (int i = 0; i < s->n; i++) {
      u[a * s->n + i] = 0;
      for (int j = 0; j < s->n; j++)
        u[a * s->n + i] += H[i * s->n + j] * s->point[s->vertex[cell * (s->n + 1) + a] * s->n + j];
      u[a * s->n + i] = (double)u[a * s->n + i];
    }
}

static void check_cell(const judged_solid *s, int cell, const quad *u, const char *name)
{
  const int numbers = (s->judge.n + 1) * s->judge.n;
  double at[NUMBERS], f[NUMBERS], energy = 0, size = 0;
  quad exact[NUMBERS];
  for (int i = 0; i < numbers; i++) at[i] = (double)u[i];
  const quad stored = quad_solid_cell(&s->judge, cell, 0, u, exact);
  ck_assert_int_eq(dvi__solid_force(s->elastic, cell, at, f), 0);
  ck_assert_int_eq(dvi__solid_stored(s->elastic, cell, at, &energy), 0);
  for (int i = 0; i < numbers; i++) size = fmax(size, fabs((double)exact[i]));
  /* The gradients cancel to some 1e-15 of the size of displacements beside those of the cell. */
  const double rounding = 1e-14 * (size + (double)s->judge.volume[cell] * 30);
  ck_assert_msg(error_of_solid(numbers, f, exact) < rounding, "%s: cell %d has forces off by %g",
                name, cell, error_of_solid(numbers, f, exact));
  ck_assert_msg(fabs((double)(energy - stored)) < rounding, "%s: cell %d has %.17g, not %.17g",
                name, cell, energy, (double)stored);
}

static void check_stiffness(const judged_solid *s, int cell, quad *u, const char *name)
{
  const int numbers = (s->judge.n + 1) * s->judge.n;
  const quad h = 1e-12; /* differences have errors of some 1e-24 */
  double at[NUMBERS], K[NUMBERS * NUMBERS], column[NUMBERS];
  for (int i = 0; i < numbers; i++) at[i] = (double)u[i];
  ck_assert_int_eq(dvi__solid_stiffness(s->elastic, cell, at, K), 0);
  for (int c = 0; c < numbers; c++) {
    quad above[NUMBERS], below[NUMBERS];
    u[c] += h;
    (void)quad_solid_cell(&s->judge, cell, 0, u, above);
    u[c] -= 2 * h;
    (void)quad_solid_cell(&s->judge, cell, 0, u, below);
    u[c] += h;
    for (int r = 0; r < numbers; r++) {
      below[r] = (below[r] - above[r]) / (2 * h);
      column[r] = K[r * numbers + c];
    }
    ck_assert_msg(error_of_solid(numbers, column, below) < 1e-12, "%s: cell %d, column %d: %g",
                  name, cell, c, error_of_solid(numbers, column, below));
  }
}

START_TEST(forces_energies_and_stiffnesses_are_those_of_the_laws)
{
  unsigned long long seed = 7;
  for (int i = 0; i < 2 * LAWS; i++) {
    const solid_case of = random_case(2 + i / LAWS, i % LAWS, SOLID_OF_TWO, (unsigned)i + 1);
    judged_solid s = make_judged(&of, NULL, 0);
    for (int cell = 0; cell < s.judge.cells; cell++) {
      quad u[NUMBERS];
      random_shift(&s.judge, cell, 0.25, &seed, u);
      check_cell(&s, cell, u, name_solid(&of));
      check_stiffness(&s, cell, u, name_solid(&of));
    }
    for (int a = 0; a < s.judge.vertices; a++)
      ck_assert_double_eq_tol(dvi_elastic_masses(s.elastic)[a], (double)s.judge.mass[a], 1e-15);
    end_judged_solid(&s);
  }
}
END_TEST

/* Nearly cancelled small strains keep their digits: forces of displacements of 1e-9 are right to
 * 1e-14 of their size, not to 1e-16/1e-9. */
START_TEST(small_displacements_keep_their_digits)
{
  unsigned long long seed = 11;
  for (int i = 0; i < 2 * LAWS; i++) {
    const solid_case of = random_case(2 + i / LAWS, i % LAWS, 0, (unsigned)i + 1);
    judged_solid s = make_judged(&of, NULL, 0);
    const int numbers = (of.n + 1) * of.n;
    for (int cell = 0; cell < s.judge.cells; cell++) {
      quad u[NUMBERS] = {0}, exact[NUMBERS];
      double at[NUMBERS], f[NUMBERS], size = 0;
      random_shift(&s.judge, cell, 1e-9, &seed, u);
      for (int k = 0; k < numbers; k++) at[k] = (double)u[k];
      (void)quad_solid_cell(&s.judge, cell, 0, u, exact);
      ck_assert_int_eq(dvi__solid_force(s.elastic, cell, at, f), 0);
      for (int k = 0; k < numbers; k++) size = fmax(size, fabs((double)exact[k]));
      ck_assert_msg(error_of_solid(numbers, f, exact) < 1e-13 * size, "%s: cell %d: %g of %g",
                    name_solid(&of), cell, error_of_solid(numbers, f, exact), size);
    }
    end_judged_solid(&s);
  }
}
END_TEST

/* J <= 0 is refused by laws with a logarithm, and by these alone. */
START_TEST(inverted_cells_are_seen)
{
  unsigned long long seed = 13;
  for (int i = 0; i < 2 * LAWS; i++) {
    const solid_case of = random_case(2 + i / LAWS, i % LAWS, 0, (unsigned)i + 1);
    judged_solid s = make_judged(&of, NULL, 0);
    const int is_logarithm = i % LAWS >= DVI_ELASTIC_NEO_HOOKEAN;
    for (int cell = 0; cell < s.judge.cells; cell++) {
      quad u[NUMBERS] = {0}, f[NUMBERS];
      double at[NUMBERS], force[NUMBERS], energy;
      random_shift(&s.judge, cell, 1.5, &seed, u);
      for (int k = 0; k < NUMBERS; k++) at[k] = (double)u[k];
      const double stored = (double)quad_solid_cell(&s.judge, cell, 0, u, f);
      const int is_inverted = is_logarithm && isnan(stored);
      ck_assert_int_eq(dvi__solid_force(s.elastic, cell, at, force) > 0, is_inverted);
      ck_assert_int_eq(dvi__solid_stored(s.elastic, cell, at, &energy) > 0, is_inverted);
    }
    end_judged_solid(&s);
  }
}
END_TEST

START_TEST(loads_and_displacements_are_those_declared)
{
  for (int n = 2; n <= 3; n++) {
    const solid_case of = random_case(n, DVI_ELASTIC_SVK, SOLID_LOADED | SOLID_MOVED, 5);
    judged_solid s = make_judged(&of, NULL, 0);
    quad u[81] = {0}, v[81] = {0}, a[81] = {0};
    double given[81] = {0}, rate[81] = {0}, f[81] = {0};
    quad_solid_give(&s.judge, 0.75, u, v);
    for (int i = 0; i < s.judge.size; i += n)
      ck_assert_int_eq(dvi__solid_given(s.elastic, i / n, 0.75, given + i, rate + i), 0);
    for (int i = 0; i < s.judge.size; i++) {
      ck_assert_int_eq(dvi_elastic_unknowns(s.elastic, NULL)[i] < 0, s.judge.given[i] != NULL);
      if (!s.judge.given[i]) continue;
      ck_assert_double_eq_tol(given[i], (double)u[i], 1e-15);
      ck_assert_double_eq_tol(rate[i], (double)v[i], 1e-15);
      u[i] = 0;
    }
    quad_solid free_one = s.judge; /* the loads alone: accelerations at rest, nothing given */
    free_one.given = calloc(81, sizeof *free_one.given);
    quad_solid_accelerate(&free_one, 0.75, u, v, a);
    for (int cell = 0; cell < s.judge.cells; cell++) {
      double own[NUMBERS] = {0};
      ck_assert_int_eq(dvi__solid_add_load(s.elastic, cell, 0.75, own), 0);
      for (int k = 0; k < (n + 1) * n; k++)
        f[s.judge.vertex[cell * (n + 1) + k / n] * n + k % n] += own[k];
    }
    for (int i = 0; i < s.judge.size; i++)
      ck_assert_double_eq_tol(f[i], (double)(a[i] * s.judge.mass[i / n]), 1e-15);
    free(free_one.given);
    end_judged_solid(&s);
  }
}
END_TEST

START_TEST(largest_eigenvalues_are_those_of_the_cells)
{
  for (int n = 2; n <= 3; n++) {
    const solid_case of = random_case(n, DVI_ELASTIC_MOONEY_RIVLIN, SOLID_OF_TWO | SOLID_MOVED, 9);
    judged_solid s = make_judged(&of, NULL, 0);
    for (int cell = 0; cell < s.judge.cells; cell++) {
      double lambda = 0;
      ck_assert_int_eq(dvi__solid_largest(s.elastic, cell, &lambda), DVI_OK);
      ck_assert_double_eq_tol(2 / sqrt(lambda), quad_solid_bound(&s.judge, cell),
                              1e-12 * quad_solid_bound(&s.judge, cell));
    }
    end_judged_solid(&s);
  }
}
END_TEST

/* Rayleigh's quotients of powers come from below, and their errors are squares of those of the
 * vectors. */
static double frequency_of(const quad_solid *s)
{
  unsigned long long seed = 21;
  quad u[81] = {0}, none[81] = {0}, a[81] = {0}, quotient = 0;
  for (int i = 0; i < s->size; i++) u[i] = s->given[i] ? 0 : random_number(&seed) - 0.5;
  for (int round = 0; round < 400; round++) {
    quad norm = 0;
    quotient = 0;
    quad_solid_accelerate(s, 0, u, none, a);
    for (int i = 0; i < s->size; i++) {
      quotient -= s->mass[i / s->n] * u[i] * a[i];
      norm += s->mass[i / s->n] * u[i] * u[i];
    }
    quotient /= norm;
    for (int i = 0; i < s->size; i++) u[i] = a[i] / quotient;
  }
  return sqrt((double)quotient);
}

START_TEST(fastest_frequencies_are_bounded_closely)
{
  for (int i = 0; i < 8; i++) {
    const solid_case of = random_case(2 + i % 2, DVI_ELASTIC_LINEAR,
                                      SOLID_OF_TWO | (i > 3 ? SOLID_MOVED : 0), (unsigned)i + 1);
    judged_solid s = make_judged(&of, NULL, 0);
    double omega = 0;
    quad_solid judge = s.judge;
    judge.loads = 0;
    ck_assert_int_eq(dvi_elastic_fastest(s.elastic, &omega), DVI_OK);
    const double below = frequency_of(&judge);
    ck_assert_msg(omega >= below * (1 - 1e-12) && omega < below * 1.002, "%s: %g, not %g",
                  name_solid(&of), omega, below);
    end_judged_solid(&s);
  }
}
END_TEST

SUITE(solid_cells)
{
  tcase_add_test(tests, fastest_frequencies_are_bounded_closely);
  tcase_add_test(tests, forces_energies_and_stiffnesses_are_those_of_the_laws);
  tcase_add_test(tests, small_displacements_keep_their_digits);
  tcase_add_test(tests, inverted_cells_are_seen);
  tcase_add_test(tests, loads_and_displacements_are_those_declared);
  tcase_add_test(tests, largest_eigenvalues_are_those_of_the_cells);
}
