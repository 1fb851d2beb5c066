/* labels: unit slow */
/* The growth of fields under tents, before a run shows it. */
#include <dvi/maxwell.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/tents.h"
#include "support/meshes.h"
#include "support/suite.h"

static dvi_stability stability_of(const pitched *p, double span)
{
  dvi_stability report;
  ck_assert_msg(dvi__tents_stability(p->tents, span, &report) == DVI_OK, "%s", dvi_last_error());
  return report;
}

/* The rate at which the logarithm of the amplitude grows in the second half of a run. */
static double rate_of_run(const pitched *p, double span)
{
  fill_at_random(p->size, 1, 3, p->A);
  fill_at_random(p->size, 1, 4, p->E);
  for (int64_t i = 0; i < p->size; i++)
    if (p->tents->held[i]) p->A[i] = 0;
  start_tents(p);
  advance_tents(p, span);
  const double half = energy_of_tents(p);
  advance_tents(p, 2 * span);
  return 0.5 * log(energy_of_tents(p) / half) / span;
}

/* ---- equal tents ---- */

/* Slabs of equal tents are steps of leapfrog, which are stable. The run agrees. */
START_TEST(slabs_of_equal_tents_do_not_grow)
{
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++) {
      pitched p = tents_over(equilateral_torus(6, 6), k, NULL, NULL,
                             (dvi__tents_options){.fraction = i == 0 ? 0.5 : 0.95});
      const dvi_stability report = stability_of(&p, 0);
      ck_assert(report.is_stable && report.growth < 1 + 1e-9 && report.resolution < 1e-5);
      ck_assert_int_eq(report.followed, k == 0 ? 2 * 35 : 2 * 71); /* all but static fields */
      ck_assert_double_eq_tol(report.period, p.tents->reach[0], 1e-15);
      ck_assert_ptr_nonnull(strstr(report.schedule, "equal tents of "));
      ck_assert_double_lt(fabs(rate_of_run(&p, repeats(100))), 1e-2);
      strike_tents(&p);
    }
}
END_TEST

/* Beyond the bound of leapfrog the map of a slab grows as a run does. */
START_TEST(slabs_of_tents_that_are_too_high_grow_as_runs_do)
{
  for (int k = 0; k < 2; k++) {
    pitched p = tents_over(equilateral_torus(6, 6), k, NULL, NULL,
                           (dvi__tents_options){.fraction = 0.9});
    for (int64_t e = 0; e < dvi_mesh_count(p.tents->mesh, 1); e++)
      p.tents->reach[e] *= (k == 0 ? 1.25 : 1.05) / 0.9;
    const dvi_stability report = stability_of(&p, 0);
    const double rate = log(report.growth);
    ck_assert(!report.is_stable && rate > 5);
    ck_assert_double_eq_tol(rate_of_run(&p, 10), rate, 0.01 * rate);
    strike_tents(&p);
  }
}
END_TEST

/* More than 500 unknowns. */
START_TEST(slabs_of_large_meshes_are_searched)
{
  pitched p = tents_over(equilateral_torus(14, 14), 1, NULL, NULL, (dvi__tents_options){0});
  const dvi_stability report = stability_of(&p, repeats(20));
  ck_assert(report.is_stable && report.period > 0 && report.followed == 40);
  ck_assert_double_lt(report.resolution, 1);
  strike_tents(&p);
}
END_TEST

/* ---- other tents ---- */

static pitched random_cavity(void)
{
  dvi_mesh *mesh = staggered_mesh(5, 5);
  int64_t count;
  int8_t *held = DVI_NEW(int8_t, dvi_mesh_count(mesh, 1));
  const int *wall = dvi_mesh_part_cells(mesh, "boundary", 1, &count);
  ck_assert_ptr_nonnull(held);
  for (int64_t i = 0; i < count; i++) held[wall[i]] = 1;
  pitched p = tents_over(mesh, 1, NULL, held,
                         (dvi__tents_options){.fraction = 0.99, .least = 0.5, .seed = 3});
  dvi__release(held);
  return p;
}

/* Both are mean rates of fields that began otherwise, of e^10 and more. */
START_TEST(random_tents_are_followed_as_a_run_is)
{
  pitched p = random_cavity();
  const dvi_stability report = stability_of(&p, 400);
  const double rate = log(report.growth);
  ck_assert(!report.is_stable && report.period == 0 && report.followed == 1);
  ck_assert_ptr_nonnull(strstr(report.schedule, "random tents from "));
  ck_assert_double_gt(rate, 0.03);
  ck_assert_double_eq_tol(rate_of_run(&p, 200), rate, 0.1 * rate);
  strike_tents(&p);
}
END_TEST

/* ---- fields ---- */

static dvi_field *make_cavity(dvi_wall_kind kind)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {5, 5}};
  const dvi_wall wall = {.part = "boundary", .kind = kind};
  dvi_field *field = NULL;
  dvi_star *star = NULL;
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("staggered", &options, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &wall, .walls = 1, .scalar = 1};
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return field;
}

/* A run from a smooth start grows from 0.0127 at t = 1000 to 5.8e9 at t = 3000. */
START_TEST(fields_are_asked_for_their_stability)
{
  dvi_field *field = make_cavity(DVI_PEC), *open = make_cavity(DVI_ABSORBING);
  dvi_stability report = {.growth = -1};
  dvi_march_options options = {.size = sizeof options, .method = "tents:rise=1"};
  ck_assert_int_eq(dvi_field_stability(field, &options, 0, &report), DVI_BAD_OPTION);
  options.method = "tents";
  ck_assert_int_eq(dvi_field_stability(open, &options, 0, &report), DVI_UNSUPPORTED);
  check_words("absorbing walls: take leapfrog or avi");
  ck_assert_double_eq(report.growth, -1);
  ck_assert_int_eq(dvi_field_stability(field, &options, is_short_run() ? 1 : 1100, &report),
                   DVI_OK);
  ck_assert_ptr_nonnull(strstr(report.schedule, ", which do not repeat"));
  if (!is_short_run()) ck_assert_double_eq_tol(log(report.growth), 0.0067, 0.0005);
  if (!is_short_run()) ck_assert_int_eq(report.is_stable, 0);
  dvi_field_destroy(&field);
  dvi_field_destroy(&open);
}
END_TEST

START_TEST(lacking_memory_is_a_status)
{
  pitched p = tents_over(equilateral_torus(6, 6), 1, NULL, NULL, (dvi__tents_options){0});
  dvi_stability report = {.growth = -1};
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi__tents_stability(p.tents, 0, &report);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || (status == DVI_NO_MEMORY && report.growth == -1));
  }
  strike_tents(&p);
}
END_TEST

SUITE(tent_stability)
{
  tcase_add_test(tests, slabs_of_equal_tents_do_not_grow);
  tcase_add_test(tests, slabs_of_tents_that_are_too_high_grow_as_runs_do);
  tcase_add_test(tests, slabs_of_large_meshes_are_searched);
  tcase_add_test(tests, random_tents_are_followed_as_a_run_is);
  tcase_add_test(tests, fields_are_asked_for_their_stability);
  tcase_add_test(tests, lacking_memory_is_a_status);
}
