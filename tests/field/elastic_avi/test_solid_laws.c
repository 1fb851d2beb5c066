/* Laws of marches of solids. */
#include <string.h>

#include "support/field/generated.h"
#include "support/field/solids.h"
#include "support/suite.h"

static const char *const methods[] = {"avi", "avi:classes=no", "verlet"};
enum { METHODS = 3 };

static int laws_of(const dvi_elastic *solid, const char *method, dvi_law *law)
{
  const dvi_march_options how = {.size = sizeof how, .method = method};
  int count = -1;
  ck_assert_msg(dvi_elastic_laws(solid, &how, 50, law, &count) == DVI_OK, "%s", dvi_last_error());
  return count;
}

/* A block of tetrahedra or triangles, held at its left side or not. */
static dvi_elastic *small_block(int dimension, dvi_elastic_material material, int is_held)
{
  static const dvi_elastic_condition hold = {.part = "left", .is_steady = 1};
  const dvi_generator_options options = {.cells = {2, 2, dimension == 3 ? 2 : 0}, .grading = {2}};
  return solid_on(generated("kuhn", options), material,
                  (dvi_elastic_terms){.condition = &hold, .conditions = is_held});
}

/* 50 of the longest steps are some thousand kicks, whose roundings add up. */
START_TEST(momenta_of_free_solids_stay_to_roundings)
{
  static const char *const name[] = {"momentum", "angular", "energy"};
  dvi_elastic *solid = small_block(2 + _i % 2, unit_material((dvi_elastic_law)(_i / 2)), 0);
  for (int m = 0; m < METHODS; m++) {
    dvi_law law[DVI_LAWS_MAX];
    ck_assert_int_eq(laws_of(solid, methods[m], law), 3);
    for (int i = 0; i < 3; i++) {
      ck_assert_str_eq(law[i].name, name[i]);
      ck_assert_int_eq(law[i].is_exact, i < 2);
      ck_assert_msg(law[i].error < (i < 2 ? 1e-12 : 0.5), "%s of %s: %g", law[i].name, methods[m],
                    law[i].error);
    }
  }
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(held_solids_have_the_energy_alone_and_damped_ones_nothing)
{
  dvi_law law[DVI_LAWS_MAX];
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  dvi_elastic *held = small_block(3, material, 1);
  material.beta = 0.1;
  dvi_elastic *damped = small_block(3, material, 0);
  ck_assert_int_eq(laws_of(held, "avi", law), 1);
  ck_assert_str_eq(law[0].name, "energy");
  ck_assert_double_lt(law[0].error, 0.5);
  ck_assert_int_eq(laws_of(damped, "avi", law), 0);
  dvi_elastic_destroy(&held);
  dvi_elastic_destroy(&damped);
}
END_TEST

SUITE(solid_laws)
{
  tcase_add_loop_test(tests, momenta_of_free_solids_stay_to_roundings, 0, 6);
  tcase_add_test(tests, held_solids_have_the_energy_alone_and_damped_ones_nothing);
}
