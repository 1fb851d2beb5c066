/* labels: unit */
/* A specification that cannot be is refused with a sentence that says why. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

START_TEST(verlet_is_refused_on_a_general_lagrangian_by_name)
{
  problem *model = create_problem("double-pendulum", NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(
      dvi_integrator_create(model->system, _i == 0 ? "verlet" : "composition", &integrator),
      DVI_UNSUPPORTED);
  ck_assert_ptr_null(integrator);
  check_words("verlet: ");
  check_words("a general Lagrangian");
  problem_destroy(&model);
}
END_TEST

/* A specification, and words that its refusal must hold. test_galerkin.c has more of galerkin's
 * own. */
static const struct {
  const char *method, *because;
} refused[] = {
    {"euler", "unknown method 'euler'; there are galerkin"},
    {"", "unknown method ''"},
    {":", "unknown method ''"},
    {":degree=2", "unknown method ''"},
    {"Verlet", "unknown method 'Verlet'"},
    {"galerkin,degree=2", "unknown method 'galerkin,degree=2'"},
    {"verlet:", "'' is not key=value"},
    {"verlet:solver=auto", "verlet: unknown key 'solver'; it takes blocking, threads"},
    {"midpoint:degree=2", "midpoint: unknown key 'degree'; it takes solver"},
    {"trapezoidal:solver=",
     "trapezoidal: solver=; possible are auto, certified, fixed-point, simplified, newton, kinsol"},
    {"midpoint:solver=newton,solver=newton", "midpoint: solver is given twice"},
    {"galerkin:=3", "'=3' is not key=value"},
    {"galerkin:degree=3:nodes=4", "galerkin: degree=3:nodes=4 is not a whole number"},
    {"galerkin:degree=0x3", "galerkin: degree=0x3 is not a whole number"},
    {"galerkin:degree=-1", "galerkin: degree=-1 is not a whole number in plain digits"},
    {"galerkin:degree=+2", "galerkin: degree=+2 is not a whole number in plain digits"},
    {"galerkin:degree= 2", "galerkin: degree= 2 is not a whole number in plain digits"},
    {"galerkin:degree=2 ", "galerkin: degree=2  is not a whole number in plain digits"},
    {"galerkin:degree=02", "galerkin: degree=02 is not a whole number in plain digits"},
    {"galerkin:degree=", "galerkin: degree= is not a whole number in plain digits"},
    {"galerkin:degree=,nodes=4", "galerkin: degree= is not a whole number in plain digits"},
    {"galerkin:degree=0", "galerkin: degree=0; 1 to 40 are possible"},
    {"galerkin:degree=41", "galerkin: degree=41; 1 to 40 are possible"},
    {"galerkin:nodes=123456789012345678901234567890",
     "nodes=123456789012345678901234567890; 1 to 80 are possible"},
    {"galerkin:degree=5,nodes=4", "see at most 4 of the 5 velocity modes of degree 5"},
    {"composition:base=galerkin,degree=5,nodes=4", "composition: galerkin: 4 quadrature points"},
    {"composition:order=4,order=6", "composition: order is given twice"},
    {"composition:base=midpoint,solver=auto,solver=newton",
     "composition: midpoint: solver is given twice"},
    {"composition:base=galerkin,quadrature=radau-left",
     "is not symmetric; choose a symmetric quadrature"},
    {"composition:order=", "order=; possible are 4, 6, 8"},
    {"composition:base", "'base' is not key=value"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(a_wrong_specification_is_refused_with_its_reason)
{
  problem *model = create_problem("oscillator", NULL);
  dvi_integrator *integrator = (dvi_integrator *)model;
  ck_assert_int_eq(dvi_integrator_create(model->system, refused[_i].method, &integrator),
                   DVI_BAD_OPTION);
  ck_assert_ptr_null(integrator);
  check_words(refused[_i].because);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_specification_without_end_is_refused)
{
  static const char *const fronts[] = {
      "", "verlet:", "galerkin:degree=", "galerkin:basis=", "galerkin:", "composition:order=4,"};
  enum { LENGTH = 100000 };
  const char *const tails[] = {"", "=1"};
  problem *model = create_problem("oscillator", NULL);
  char *text = malloc(LENGTH + 32);
  dvi_integrator *integrator = NULL;
  ck_assert_ptr_nonnull(text);
  const size_t front = strlen(fronts[_i]);
  memcpy(text, fronts[_i], front);
  memset(text + front, '7', LENGTH);
  for (int k = 0; k < 2; k++) {
    memcpy(text + LENGTH, tails[k], strlen(tails[k]) + 1);
    ck_assert_int_eq(dvi_integrator_create(model->system, text, &integrator), DVI_BAD_OPTION);
    ck_assert_ptr_null(integrator);
    ck_assert_uint_lt(strlen(dvi_last_error()), 1024); /* the sentence's own limit */
  }
  free(text);
  problem_destroy(&model);
}
END_TEST

/* Returns 1 if the list that ends a sentence ends with that word, behind a comma. */
static void check_list_end(const char *method, const problem *model, dvi_status status,
                           const char *last)
{
  char end[64];
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, method, &integrator), status);
  const char *sentence = dvi_last_error();
  (void)snprintf(end, sizeof end, ", %s", last);
  ck_assert_uint_ge(strlen(sentence), strlen(end));
  ck_assert_str_eq(sentence + strlen(sentence) - strlen(end), end);
}

START_TEST(no_list_of_a_sentence_is_cut_short)
{
  char longest[600];
  problem *model = create_problem("kepler", NULL);
  const char *last = dvi_method_name(dvi_method_count() - 1);
  memset(longest, 'x', sizeof longest);
  longest[sizeof longest - 1] = '\0';
  check_list_end("unheard-of", model, DVI_BAD_OPTION, last);
  for (int i = 0; i < dvi_method_count(); i++) check_words(dvi_method_name(i));
  check_list_end(longest, model, DVI_BAD_OPTION, last);
  check_list_end("lie-verlet", model, DVI_UNSUPPORTED, "prolongation-collocation");
  check_list_end("shooting:onestep=unheard-of", model, DVI_BAD_OPTION, "file");
  check_list_end("trig:filter=unheard-of", model, DVI_BAD_OPTION, "hairer-lubich");
  check_list_end("shooting:unheard-of=1", model, DVI_BAD_OPTION, "type");
  problem_destroy(&model);
}
END_TEST

SUITE(specification)
{
  tcase_add_loop_test(tests, verlet_is_refused_on_a_general_lagrangian_by_name, 0, 2);
  tcase_add_loop_test(tests, a_wrong_specification_is_refused_with_its_reason, 0, REFUSED);
  tcase_add_loop_test(tests, a_specification_without_end_is_refused, 0, 6);
  tcase_add_test(tests, no_list_of_a_sentence_is_cut_short);
}
