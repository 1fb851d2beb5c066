/* labels: unit */
/* Potentials that are declared fast or quadratic: the parts of a system, and what the check
 * finds. */
#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/evaluate/evaluator.h"
#include "system/part.h"

/* V = sum of stiffness q_i^2/2 + bend q_i^3 + swing t q_i^2/2 + t q_i. */
typedef struct bowl {
  double stiffness, bend, swing;
} bowl;

static int value(double t, const double *q, double *V, void *user)
{
  const bowl *own = user;
  *V = 0;
  for (int i = 0; i < SITES; i++)
    *V += ((own->stiffness + own->swing * t) / 2 + own->bend * q[i]) * q[i] * q[i] + t * q[i];
  return 0;
}

static int gradient(double t, const double *q, double *V_q, void *user)
{
  const bowl *own = user;
  for (int i = 0; i < SITES; i++)
    V_q[i] = (own->stiffness + own->swing * t + 3 * own->bend * q[i]) * q[i] + t;
  return 0;
}

static dvi_potential declare_potential(bowl *own, int with_gradient)
{
  return (dvi_potential){.name = "bowl",
                         .value = value,
                         .gradient = with_gradient ? gradient : NULL,
                         .user = own,
                         .fast = 1,
                         .quadratic = 1};
}

static dvi_status check(bowl own, int with_gradient, dvi_derivative_check *found)
{
  behaviour calm = {0};
  const dvi_potential potentials[] = {springs(&calm, BATCH),
                                      declare_potential(&own, with_gradient)};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = potentials, .potential_count = 2});
  const dvi_status status = dvi_system_check(system, 0.3, generic_q, generic_v, 0, found);
  dvi_system_destroy(&system);
  return status;
}

START_TEST(a_quadratic_potential_passes_and_its_linear_part_may_move)
{
  dvi_derivative_check found;
  ck_assert_msg(check((bowl){.stiffness = 2500}, _i, &found) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(found.not_quadratic, 0);
}
END_TEST

START_TEST(a_potential_that_is_not_quadratic_although_it_is_declared_so_is_named)
{
  const bowl lies[] = {{.stiffness = 2500, .bend = 1}, {.stiffness = 2500, .swing = 1}};
  dvi_derivative_check found;
  ck_assert_int_eq(check(lies[_i / 2], _i % 2, &found), DVI_BAD_ARGUMENT);
  check_words("system check: potential 'bowl' is declared quadratic, but dV/dq (");
  ck_assert_int_eq(found.not_quadratic, 1);
}
END_TEST

/* Gives the gradient of a part's potentials at the point. */
static void evaluate_part(const dvi_system *part, double *V_q)
{
  const double t = 0.3;
  dvi__evaluator *e;
  ck_assert_int_eq(dvi__evaluator_create(part, 1, DVI__GRADIENTS, NULL, &e), DVI_OK);
  ck_assert_int_eq(dvi__potentials_gradient(e, 1, &t, generic_q, V_q), DVI_OK);
  dvi__evaluator_destroy(&e);
}

START_TEST(the_parts_of_a_system_add_up_to_it)
{
  bowl own = {.stiffness = 2500};
  behaviour calm = {0};
  double of_slow[SITES], of_fast[SITES], of_whole[SITES];
  const dvi_potential potentials[] = {declare_potential(&own, 1), springs(&calm, BATCH)};
  dvi_system *slow, *fast,
      *whole = make_system(
          &(dvi_system_terms){.dimension = SITES,
                              .mass = {.values = tridiagonal_mass, .pattern = tridiagonal},
                              .potentials = potentials,
                              .potential_count = 2});
  ck_assert_int_eq(dvi__system_slow_part(whole, &slow), DVI_OK);
  ck_assert_int_eq(dvi__system_fast_part(whole, &fast), DVI_OK);
  ck_assert(dvi__system_fast_is_quadratic(whole));
  ck_assert_mem_eq(fast->mass_values, whole->mass_values, sizeof tridiagonal_mass);
  evaluate_part(slow, of_slow);
  evaluate_part(fast, of_fast);
  evaluate_part(whole, of_whole);
  for (int i = 0; i < SITES; i++) ck_assert_double_eq(of_slow[i] + of_fast[i], of_whole[i]);
  dvi_system_destroy(&slow);
  dvi_system_destroy(&fast);
  dvi_system_destroy(&whole);
}
END_TEST

START_TEST(a_part_without_potentials_is_free)
{
  bowl own = {.stiffness = 2500};
  double of_slow[SITES];
  const dvi_potential potential = declare_potential(&own, 1);
  const double mass[SITES] = {1, 2, 3, 4, 5, 6};
  dvi_system *slow, *fast,
      *whole = make_system(&(dvi_system_terms){.dimension = SITES,
                                               .mass.diagonal = mass,
                                               .potentials = &potential,
                                               .potential_count = 1});
  ck_assert_int_eq(dvi__system_slow_part(whole, &slow), DVI_OK);
  ck_assert_int_eq(dvi__system_fast_part(whole, &fast), DVI_OK);
  evaluate_part(slow, of_slow);
  for (int i = 0; i < SITES; i++) ck_assert_double_eq(of_slow[i], 0);
  ck_assert_mem_eq(fast->mass_diagonal, mass, sizeof mass);
  dvi_system_destroy(&slow);
  dvi_system_destroy(&fast);
  dvi_system_destroy(&whole);
}
END_TEST

SUITE(speed)
{
  tcase_add_loop_test(tests, a_quadratic_potential_passes_and_its_linear_part_may_move, 0, 2);
  tcase_add_loop_test(tests, a_potential_that_is_not_quadratic_although_it_is_declared_so_is_named,
                      0, 4);
  tcase_add_test(tests, the_parts_of_a_system_add_up_to_it);
  tcase_add_test(tests, a_part_without_potentials_is_free);
}
