/* Potentials are fast as scenes tag them, and quadratic as they are written. Only splitting methods
 * distinguish them. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { STEPS = 50 };

#define RUN "step: 0.1\nuntil: 1\n"
#define CHAIN                                                                                    \
  "coordinates: {x: scalar, y: scalar}\nkinetic: (x'^2 + y'^2)/2\ninitial: {x: 1, y: 0.5}\n" RUN \
  "potentials:\n"

/* Which are fast, and which have constant second derivatives, in the order of the file. */
static void check_speeds(const char *text, int count, const int *fast, const int *quadratic)
{
  (void)open_scene(text);
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  ck_assert_int_eq(terms->potential_count, count);
  for (int k = 0; k < count; k++) {
    ck_assert_int_eq(terms->potentials[k].fast, fast[k]);
    ck_assert_int_eq(terms->potentials[k].quadratic, quadratic[k]);
  }
}

START_TEST(potentials_are_fast_as_they_are_tagged)
{
  static const int of_groups[] = {1, 1, 0, 0}, quadratic[] = {1, 0, 1, 1}, moved[] = {1, 1, 0},
                   one[] = {0, 1}, neither[] = {0, 0};
  check_speeds(CHAIN "  fast: {bond: 50*(x - y)^2, bend: (x - y)^2*x}\n  slow: {weight: x + y}\n  "
                     "well: 3*x*y - y^2/2 + t^3\n",
               4, of_groups, quadratic);
  check_speeds(CHAIN "  slow: x^4\n  fast: t*x^2\n", 2, one, neither);
  check_speeds(
      CHAIN
      "  fast: {drive: 50*(x - y)^2 - x*sin(t) + t^2, weight: 3*y*t}\n  slow: {tide: x^2*cos(t)}\n",
      3, of_groups, moved);
  check_speeds(CHAIN "  bond: sqrt(x)^2\n  bend: cos(y)\n", 2, neither, neither);
}
END_TEST

/* Terms that only splitting methods distinguish are one potential for all other methods. */
START_TEST(tags_do_not_change_what_other_methods_do)
{
  static const char *const text[] = {CHAIN "  fast: {bond: 50*(x - y)^2}\n  slow: {well: x^4}\n",
                                     CHAIN "  bond: 50*(x - y)^2\n  well: x^4\n"};
  static const char *const method[] = {"verlet", "galerkin:degree=2", "midpoint", "sem"};
  for (int m = 0; m < 4; m++) {
    double end[2][2];
    for (int k = 0; k < 2; k++) {
      const double *q, *v, *p;
      dvi_integrator *integrator;
      (void)open_scene(text[k]);
      dvi_scene_start(scene, &q, &v, &p);
      ck_assert_int_eq(dvi_integrator_create(dvi_scene_system(scene), method[m], &integrator),
                       DVI_OK);
      ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
      for (int i = 0; i < 10; i++)
        ck_assert_msg(dvi_integrator_step(integrator, 0.02) == DVI_OK, "%s", dvi_last_error());
      memcpy(end[k], dvi_integrator_q(integrator), sizeof end[k]);
      dvi_integrator_destroy(&integrator);
    }
    ck_assert_mem_eq(end[0], end[1], sizeof end[0]);
  }
}
END_TEST

START_TEST(imex_factorises_a_quadratic_fast_potential_once_a_run)
{
  double state[2] = {1, 0.5};
  const double momenta[2] = {0};
  dvi_counters counters;
  dvi_integrator *integrator;
  (void)open_scene(CHAIN "  fast: {bond: 50*(x - y)^2}\n  slow: {well: x^4/4}\n");
  ck_assert_msg(dvi_integrator_create(dvi_scene_system(scene), "imex", &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, state, momenta), DVI_OK);
  for (int k = 0; k < STEPS; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.factorizations, 1);
  ck_assert_int_eq(counters.hessians, 1);
  ck_assert_int_eq(counters.solves, STEPS);
  ck_assert_int_eq(
      counters.jacobians + counters.residuals + counters.newtons + counters.fixed_points, 0);
  dvi_integrator_destroy(&integrator);
}
END_TEST

SUITE(scene_speeds)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, potentials_are_fast_as_they_are_tagged);
  tcase_add_test(tests, tags_do_not_change_what_other_methods_do);
  tcase_add_test(tests, imex_factorises_a_quadratic_fast_potential_once_a_run);
}
