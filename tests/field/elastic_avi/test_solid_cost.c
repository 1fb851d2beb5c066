/* labels: unit */
/* Counts of forces of cells, which are what marches of solids cost. */
#include <dvi/elastic.h>
#include <math.h>

#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/field/solids.h"
#include "support/suite.h"

/* A bar whose layers grow from 1 to 20, with cells twice as wide as the thickest layer. */
static dvi_elastic *graded_bar(void)
{
  enum { LAYERS = 162 };
  const double grading = 1.50835, width = 4 * (1 - pow(1 - 1.0 / LAYERS, grading));
  const dvi_generator_options options = {.size = sizeof options,
                                         .cells = {LAYERS, 2, 2},
                                         .extent = {1, width, width},
                                         .grading = {grading, 1, 1}};
  return solid_on(generated("kuhn", options), unit_material(DVI_ELASTIC_SVK),
                  (dvi_elastic_terms){0});
}

/* Forces in a unit of time. */
static double rate_of(const dvi_elastic *elastic, const char *method)
{
  dvi_march *march = march_of_solid(elastic, method, 0.5);
  dvi_march_facts facts;
  start_march_of_solid(march, NULL, NULL);
  dvi_march_facts_of(march, &facts);
  const double span = 128 * facts.step;
  advance_march(march, span);
  dvi_march_facts_of(march, &facts);
  dvi_march_destroy(&march);
  return (double)facts.updates / span;
}

START_TEST(graded_bars_need_five_times_fewer_forces_at_equal_fractions)
{
  dvi_elastic *elastic = graded_bar();
  const double verlet = rate_of(elastic, "verlet");
  ck_assert_double_ge(verlet, 5 * rate_of(elastic, "avi"));
  ck_assert_double_ge(verlet, 5 * rate_of(elastic, "avi:classes=no"));
  dvi_elastic_destroy(&elastic);
}
END_TEST

SUITE(solid_cost)
{
  tcase_add_test(tests, graded_bars_need_five_times_fewer_forces_at_equal_fractions);
}
