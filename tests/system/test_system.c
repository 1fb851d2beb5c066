#include <math.h>
#include <pthread.h>
#include <string.h>

#include "core/memory.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/system.h"

static behaviour quiet;

static void refused(const dvi_system_terms *terms, dvi_status status, const char *words)
{
  dvi_system *system = (dvi_system *)&quiet;
  ck_assert_int_eq(dvi_system_create(terms, &system), status);
  ck_assert_ptr_null(system);
  check_words(words);
}

static int unused_generator(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = q[0];
  return 0;
}

START_TEST(a_dimension_below_one_is_refused)
{
  refused(&(dvi_system_terms){.dimension = 0, .mass.scalar = 1}, DVI_BAD_SIZE,
          "dimension 0; at least 1 is needed");
  refused(&(dvi_system_terms){.dimension = -3, .mass.scalar = 1}, DVI_BAD_SIZE, "dimension -3");
}
END_TEST

START_TEST(negative_counts_are_refused)
{
  refused(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1, .potential_count = -1},
          DVI_BAD_SIZE, "-1 potentials");
  refused(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1, .symmetry_count = -1}, DVI_BAD_SIZE,
          "-1 symmetries");
  refused(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1, .invariant_count = -1},
          DVI_BAD_SIZE, "-1 invariants");
}
END_TEST

START_TEST(lists_that_are_missing_are_refused)
{
  refused(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1, .potential_count = 2},
          DVI_BAD_ARGUMENT, "2 potentials declared, but");
  refused(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1, .symmetry_count = 2},
          DVI_BAD_ARGUMENT, "2 symmetries declared, but");
  refused(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1, .invariant_count = 2},
          DVI_BAD_ARGUMENT, "2 invariants declared, but");
}
END_TEST

/* A forgotten count would leave the forces out without a word. */
START_TEST(lists_without_a_count_are_refused)
{
  const dvi_potential p = springs(&quiet, ONE_POINT);
  const dvi_symmetry symmetry = {"a", unused_generator, NULL};
  const dvi_invariant invariant = {0};
  refused(&(dvi_system_terms){.dimension = SITES, .mass.scalar = 1, .potentials = &p},
          DVI_BAD_ARGUMENT, "a list of potentials is given, but their count is 0");
  refused(&(dvi_system_terms){.dimension = SITES, .mass.scalar = 1, .symmetries = &symmetry},
          DVI_BAD_ARGUMENT, "a list of symmetries is given");
  refused(&(dvi_system_terms){.dimension = SITES, .mass.scalar = 1, .invariants = &invariant},
          DVI_BAD_ARGUMENT, "a list of invariants is given");
}
END_TEST

START_TEST(a_callback_in_two_shapes_is_refused)
{
  const dvi_potential p1 = springs(&quiet, ONE_POINT), pb = springs(&quiet, BATCH);
  const dvi_lagrangian l1 = rotors(&quiet, ONE_POINT), lb = rotors(&quiet, BATCH);
  for (int kind = 0; kind < 3; kind++) {
    static const char *const words[] = {"its value callback in two shapes",
                                        "its gradient callback in two", "its Hessian callback in"};
    dvi_potential p = p1;
    dvi_lagrangian l = l1;
    if (kind == 0) p.value_batch = pb.value_batch, l.value_batch = lb.value_batch;
    if (kind == 1) p.gradient_batch = pb.gradient_batch, l.gradient_batch = lb.gradient_batch;
    if (kind == 2) p.hessian_batch = pb.hessian_batch, l.hessian_batch = lb.hessian_batch;
    refused(
        &(dvi_system_terms){
            .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1},
        DVI_BAD_ARGUMENT, words[kind]);
    refused(&(dvi_system_terms){.dimension = SITES, .lagrangian = &l}, DVI_BAD_ARGUMENT,
            words[kind]);
  }
}
END_TEST

START_TEST(missing_terms_or_a_missing_result_are_refused)
{
  refused(NULL, DVI_BAD_ARGUMENT, "no terms");
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1}, NULL),
                   DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(a_system_without_kinetic_part_is_refused)
{
  refused(&(dvi_system_terms){.dimension = 1}, DVI_BAD_ARGUMENT,
          "neither a mass (other than 0) nor a general Lagrangian");
}
END_TEST

START_TEST(a_mass_beside_a_lagrangian_is_refused)
{
  const dvi_lagrangian l = rotors(&quiet, ONE_POINT);
  refused(&(dvi_system_terms){.dimension = SITES, .mass.scalar = 1, .lagrangian = &l},
          DVI_BAD_ARGUMENT, "both a constant mass and a general Lagrangian");
}
END_TEST

START_TEST(two_forms_of_the_mass_are_refused)
{
  const double ones[SITES] = {1, 1, 1, 1, 1, 1};
  refused(&(dvi_system_terms){.dimension = SITES, .mass = {.scalar = 1, .diagonal = ones}},
          DVI_BAD_ARGUMENT, "2 forms; one is possible");
  refused(
      &(dvi_system_terms){
          .dimension = SITES,
          .mass = {.diagonal = ones, .values = tridiagonal_mass, .pattern = tridiagonal}},
      DVI_BAD_ARGUMENT, "2 forms; one is possible");
}
END_TEST

START_TEST(a_mass_pattern_without_values_is_refused)
{
  refused(&(dvi_system_terms){.dimension = SITES, .mass = {.scalar = 1, .pattern = tridiagonal}},
          DVI_BAD_ARGUMENT, "a pattern but no values");
}
END_TEST

START_TEST(masses_that_vanish_or_are_not_finite_are_singular)
{
  const double bad[] = {0, (double)NAN, HUGE_VAL, -HUGE_VAL, 1e-320};
  for (int k = 0; k < 5; k++) {
    const double masses[2] = {1, bad[k]};
    refused(&(dvi_system_terms){.dimension = 2, .mass.diagonal = masses}, DVI_SINGULAR,
            "of coordinate 1; a finite number other than 0");
    if (k > 0)
      refused(&(dvi_system_terms){.dimension = 2, .mass.scalar = bad[k]}, DVI_SINGULAR,
              "of coordinate 0");
  }
}
END_TEST

START_TEST(a_singular_sparse_mass_is_refused)
{
  const double zero[4] = {1, 1, 1, 1}, bad[4] = {1, (double)NAN, (double)NAN, 1};
  refused(&(dvi_system_terms){.dimension = 2, .mass.values = zero}, DVI_SINGULAR,
          "system: mass matrix: ");
  refused(&(dvi_system_terms){.dimension = 2, .mass.values = bad}, DVI_SINGULAR,
          "the mass matrix is not finite");
}
END_TEST

START_TEST(an_unsymmetric_mass_is_refused)
{
  const double values[4] = {2, 1, 0.5, 2}, upper[3] = {2, 1, 2};
  refused(&(dvi_system_terms){.dimension = 2, .mass.values = values}, DVI_BAD_ARGUMENT,
          "not symmetric at (1,0)");
  refused(&(dvi_system_terms){.dimension = 2,
                              .mass = {.values = upper,
                                       .pattern = {(int[]){0, 1, 3}, (int[]){0, 0, 1}}}},
          DVI_BAD_ARGUMENT, "not symmetric at (0,1)");
}
END_TEST

START_TEST(a_mass_pattern_that_is_none_is_refused)
{
  refused(&(dvi_system_terms){.dimension = 1,
                              .mass = {.values = tridiagonal_mass,
                                       .pattern = {(int[]){0, 1}, (int[]){1}}}},
          DVI_BAD_ARGUMENT, "system: mass matrix: row 1 in column 0");
}
END_TEST

static void potential_refused(dvi_potential p, dvi_status status, const char *words)
{
  refused(
      &(dvi_system_terms){
          .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1},
      status, words);
}

START_TEST(a_potential_without_a_value_is_refused_by_name)
{
  dvi_potential p = springs(&quiet, ONE_POINT);
  p.value = NULL;
  potential_refused(p, DVI_BAD_ARGUMENT, "potential 'springs' has no value callback");
}
END_TEST

START_TEST(a_potential_with_a_bad_pattern_is_refused_by_name)
{
  dvi_potential p = springs(&quiet, ONE_POINT);
  p.qq = (dvi_pattern){(int[]){0, 2, 2, 2, 2, 2, 2}, (int[]){1, 0}};
  potential_refused(p, DVI_BAD_ARGUMENT,
                    "springs: the rows in column 0 of the pattern are not ascending");
  p.qq = (dvi_pattern){(int[]){0, 1, 1, 1, 1, 1, 1}, (int[]){6}};
  potential_refused(p, DVI_BAD_ARGUMENT,
                    "springs: row 6 in column 0 of the pattern is outside 0..5");
}
END_TEST

START_TEST(one_triangle_of_a_hessian_pattern_is_not_enough)
{
  dvi_potential p = springs(&quiet, ONE_POINT);
  p.qq = (dvi_pattern){(int[]){0, 1, 1, 1, 1, 1, 1}, (int[]){2}};
  potential_refused(p, DVI_BAD_ARGUMENT,
                    "springs: the pattern holds (2,0) but not (0,2); both triangles are needed");
}
END_TEST

static void lagrangian_refused(dvi_lagrangian l, dvi_status status, const char *words)
{
  refused(&(dvi_system_terms){.dimension = SITES, .lagrangian = &l}, status, words);
}

START_TEST(a_lagrangian_without_a_value_or_with_bad_patterns_is_refused)
{
  const dvi_pattern bad = {(int[]){0, 1, 1, 1, 1, 1, 1}, (int[]){-1}},
                    half = {(int[]){0, 1, 1, 1, 1, 1, 1}, (int[]){3}};
  dvi_lagrangian l = rotors(&quiet, BATCH);
  l.value_batch = NULL;
  lagrangian_refused(l, DVI_BAD_ARGUMENT, "the Lagrangian has no value callback");
  l = rotors(&quiet, BATCH);
  l.qq = bad;
  lagrangian_refused(l, DVI_BAD_ARGUMENT, "Lagrangian: d2L/dq2: row -1");
  l = rotors(&quiet, BATCH);
  l.qv = bad;
  lagrangian_refused(l, DVI_BAD_ARGUMENT, "Lagrangian: d2L/dqdv: row -1");
  l = rotors(&quiet, BATCH);
  l.vv = bad;
  lagrangian_refused(l, DVI_BAD_ARGUMENT, "Lagrangian: d2L/dv2: row -1");
  l.vv = half;
  lagrangian_refused(l, DVI_BAD_ARGUMENT,
                     "Lagrangian: d2L/dv2: the pattern holds (3,0) but not (0,3)");
}
END_TEST

START_TEST(symmetries_and_invariants_need_their_callbacks)
{
  const dvi_symmetry symmetries[] = {{"a", unused_generator, NULL}, {"b", NULL, NULL}};
  const dvi_invariant invariant = {"c", NULL, NULL};
  refused(
      &(dvi_system_terms){
          .dimension = 1, .mass.scalar = 1, .symmetries = symmetries, .symmetry_count = 2},
      DVI_BAD_ARGUMENT, "symmetry 1 has no generator");
  refused(
      &(dvi_system_terms){
          .dimension = 1, .mass.scalar = 1, .invariants = &invariant, .invariant_count = 1},
      DVI_BAD_ARGUMENT, "invariant 0 has no value callback");
}
END_TEST

/* A method that needs no Hessian takes the system. One that needs it is refused each time. */
START_TEST(a_full_pattern_that_no_int_can_count_is_refused_where_it_is_needed)
{
  dvi_potential p = springs(&quiet, ONE_POINT);
  p.qq = (dvi_pattern){0};
  const long before = dvi__allocation_count();
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = 50000, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  ck_assert_int_lt(dvi__allocation_count() - before, 20);
  for (int k = 0; k < 2; k++) {
    ck_assert_int_eq(dvi__system_prepare_hessian(s), DVI_BAD_SIZE);
    check_words("declare a sparse pattern");
  }
  dvi_system_destroy(&s);
}
END_TEST

static void *prepare(void *system)
{
  return dvi__system_prepare_hessian(system) == DVI_OK ? system : NULL;
}

START_TEST(threads_may_prepare_one_system_together)
{
  enum { THREADS = 8 };
  dvi_potential p = springs(&quiet, ONE_POINT);
  p.qq = (dvi_pattern){0};
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = 500, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  pthread_t thread[THREADS];
  for (int k = 0; k < THREADS; k++)
    ck_assert_int_eq(pthread_create(&thread[k], NULL, prepare, s), 0);
  for (int k = 0; k < THREADS; k++) {
    void *result = NULL;
    ck_assert_int_eq(pthread_join(thread[k], &result), 0);
    ck_assert_ptr_eq(result, s);
  }
  ck_assert_int_eq(dvi__pattern_entries(&s->qq), 500 * 500);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(the_patterns_are_the_unions_over_the_terms)
{
  const dvi_lagrangian l = rotors(&quiet, ONE_POINT);
  const dvi_potential potentials[] = {wells(&quiet, BATCH), springs(&quiet, BATCH)};
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .lagrangian = &l, .potentials = potentials, .potential_count = 2});
  ck_assert_int_eq(dvi_system_nq(s), SITES);
  ck_assert_int_eq(dvi_system_nv(s), SITES);
  ck_assert_int_eq(s->terms, DVI__LAGRANGIAN | DVI__POTENTIAL);
  ck_assert_int_eq(dvi__system_prepare_hessian(s), DVI_OK);
  ck_assert_int_eq(dvi__pattern_entries(&s->qq), 3 * SITES - 2);
  ck_assert_mem_eq(s->qq.row, tridiagonal.row, (3 * SITES - 2) * sizeof(int));
  ck_assert_int_eq(dvi__pattern_entries(&s->qv), 2 * SITES - 1);
  ck_assert_int_eq(dvi__pattern_entries(&s->vv), 3 * SITES - 2);
  for (int j = 0; j < SITES; j++)
    ck_assert_int_eq(s->lagrangian->in_qq[j], dvi__pattern_find(&s->qq, j, j));
  dvi_system_destroy(&s);
  ck_assert_ptr_null(s);
  dvi_system_destroy(&s);
  dvi_system_destroy(NULL);
  ck_assert_int_eq(dvi_system_nq(NULL) + dvi_system_nv(NULL) + dvi_system_invariant_count(NULL), 0);
  ck_assert_ptr_null(dvi_system_invariant_name(NULL, 0));
}
END_TEST

START_TEST(a_constant_mass_has_an_empty_mixed_block)
{
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = 3, .mass.scalar = 2});
  ck_assert_int_eq(dvi__system_prepare_hessian(s), DVI_OK);
  ck_assert_int_eq(s->terms, DVI__CONSTANT_MASS);
  ck_assert_int_eq(dvi__pattern_entries(&s->qq), 0);
  ck_assert_int_eq(dvi__pattern_entries(&s->qv), 0);
  ck_assert_int_eq(dvi__pattern_entries(&s->vv), 3);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(everything_declared_is_copied)
{
  char name[] = "gravity";
  double masses[SITES] = {1, 2, 3, 4, 5, 6}, p[SITES];
  int start[SITES + 1], row[3 * SITES - 2];
  memcpy(start, tridiagonal.start, sizeof start);
  memcpy(row, tridiagonal.row, sizeof row);
  dvi_potential potential = springs(&quiet, ONE_POINT);
  potential.name = name;
  potential.qq = (dvi_pattern){start, row};
  dvi_symmetry symmetry = {name, unused_generator, NULL};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES,
                                                  .mass.diagonal = masses,
                                                  .potentials = &potential,
                                                  .potential_count = 1,
                                                  .symmetries = &symmetry,
                                                  .symmetry_count = 1});
  memset(name, 'x', sizeof name - 1);
  memset(masses, 0, sizeof masses);
  memset(start, 0, sizeof start);
  memset(row, 0, sizeof row);
  potential.value = NULL;
  symmetry.generator = NULL;
  ck_assert_str_eq(dvi_system_invariant_name(s, 1), "gravity");
  ck_assert_str_eq(s->potentials[0].name, "gravity");
  ck_assert_str_eq(s->potentials[0].callbacks.name, "gravity");
  ck_assert_str_eq(s->symmetries[0].name, "gravity");
  ck_assert_int_eq(dvi_system_momentum(s, 0, generic_q, generic_v, p), DVI_OK);
  for (int i = 0; i < SITES; i++) ck_assert_double_eq(p[i], (1 + i) * generic_v[i]);
  ck_assert_int_eq(dvi__pattern_entries(&s->potentials[0].qq), 3 * SITES - 2);
  dvi_system_destroy(&s);
}
END_TEST

SUITE(system)
{
  tcase_add_test(tests, a_dimension_below_one_is_refused);
  tcase_add_test(tests, negative_counts_are_refused);
  tcase_add_test(tests, lists_that_are_missing_are_refused);
  tcase_add_test(tests, missing_terms_or_a_missing_result_are_refused);
  tcase_add_test(tests, a_system_without_kinetic_part_is_refused);
  tcase_add_test(tests, a_mass_beside_a_lagrangian_is_refused);
  tcase_add_test(tests, two_forms_of_the_mass_are_refused);
  tcase_add_test(tests, a_mass_pattern_without_values_is_refused);
  tcase_add_test(tests, masses_that_vanish_or_are_not_finite_are_singular);
  tcase_add_test(tests, a_singular_sparse_mass_is_refused);
  tcase_add_test(tests, an_unsymmetric_mass_is_refused);
  tcase_add_test(tests, a_mass_pattern_that_is_none_is_refused);
  tcase_add_test(tests, a_potential_without_a_value_is_refused_by_name);
  tcase_add_test(tests, a_potential_with_a_bad_pattern_is_refused_by_name);
  tcase_add_test(tests, one_triangle_of_a_hessian_pattern_is_not_enough);
  tcase_add_test(tests, a_lagrangian_without_a_value_or_with_bad_patterns_is_refused);
  tcase_add_test(tests, symmetries_and_invariants_need_their_callbacks);
  tcase_add_test(tests, lists_without_a_count_are_refused);
  tcase_add_test(tests, a_callback_in_two_shapes_is_refused);
  tcase_add_test(tests, a_full_pattern_that_no_int_can_count_is_refused_where_it_is_needed);
  tcase_add_test(tests, threads_may_prepare_one_system_together);
  tcase_add_test(tests, the_patterns_are_the_unions_over_the_terms);
  tcase_add_test(tests, a_constant_mass_has_an_empty_mixed_block);
  tcase_add_test(tests, everything_declared_is_copied);
}
