/* labels: unit slow */
/* The growth of fields under a schedule, before a run shows it. */
#include "field/avi/monodromy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/meshes.h"
#include "support/field/steps.h"
#include "support/suite.h"

static dvi_stability stability_of(const stepped *s)
{
  dvi_stability report;
  ck_assert_msg(dvi__avi_stability(&s->terms, 0, &report) == DVI_OK, "%s", dvi_last_error());
  return report;
}

/* ---- a string of four long cells and four short ones ---- */

static dvi_mesh *long_and_short(void)
{
  static const double x[] = {0, 1, 2, 3, 4, 4.25, 4.5, 4.75, 5};
  static const int vertex[] = {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8};
  dvi_mesh *mesh = NULL;
  const dvi_mesh_terms terms = {
      .size = sizeof terms, .dimension = 1, .points = 9, .point = x, .cells = 8, .vertex = vertex};
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  return mesh;
}

typedef struct ratio_case {
  double fraction, ratio, growth; /* the step of a short cell is fraction/4 */
  double period;                  /* in steps of the short cells */
} ratio_case;

/* Digits of an independent program, which multiplied the matrices of all events. */
START_TEST(two_steps_on_a_string_have_known_growths)
{
  static const ratio_case cases[] = {{0.8, 4, 1.01037903, 4}, {0.8, 3.75, 1.05123076, 15},
                                     {0.8, 2, 1, 2},          {0.8, 3, 1, 3},
                                     {0.8, 3.5, 1, 7},        {0.95, 3.5, 1.04151551, 7},
                                     {0.95, 4, 1, 4},         {0.5, 3.5, 1.00129581, 7}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const ratio_case *c = cases + i;
    stepped s = stepped_mesh(long_and_short(), 0, 1);
    double step[8];
    for (int f = 0; f < 8; f++) step[f] = c->fraction / 4 * (f < 4 ? c->ratio : 1);
    s.terms.step = step;
    const dvi_stability report = stability_of(&s);
    ck_assert_double_eq_tol(report.growth, c->growth, 6e-9); /* the digits that are known */
    ck_assert_double_eq_tol(report.period, c->period * c->fraction / 4, 1e-12);
    ck_assert_int_eq(report.is_stable, c->growth == 1);
    ck_assert_int_eq(report.followed, 14);
    ck_assert_double_lt(report.resolution, 1e-6);
    end_stepped(&s);
  }
}
END_TEST

/* ---- a graded square ---- */

/* Steps of the classes of cells by themselves, fraction/sqrt(1/hx^2 + 1/hy^2). */
static void step_by_cells(stepped *s, double fraction, int is_free, double *step)
{
  step_of_boxes(s->mesh, fraction, is_free, step);
  s->terms.step = step;
}

START_TEST(a_graded_square_is_unstable_from_095_on)
{
  static const double fraction[] = {0.5, 0.8, 0.9, 0.95};
  for (int i = 0; i < 4; i++) {
    stepped s = stepped_mesh(grid_mesh("box", 2, 10, 2), 1, 1);
    double step[100];
    step_by_cells(&s, fraction[i], 0, step);
    const dvi_stability report = stability_of(&s);
    ck_assert_double_eq_tol(report.growth, i == 3 ? 1.00481751 : 1, 6e-9);
    ck_assert_int_eq(report.is_stable, i < 3);
    ck_assert_int_eq(report.followed, 198);
    end_stepped(&s);
  }
}
END_TEST

/* Arnoldi's method sees it within a tenth, and nothing where nothing is. */
START_TEST(arnoldis_method_finds_the_same_growth)
{
  for (int i = 0; i < 2; i++) {
    stepped s = stepped_mesh(grid_mesh("box", 2, 10, 2), 1, 1);
    double step[100];
    step_by_cells(&s, i == 0 ? 0.95 : 0.9, 0, step);
    dvi__avi *avi = avi_of(&s.terms);
    const dvi__flow flow = dvi__avi_flow(avi);
    dvi_march_facts facts;
    dvi_stability report = {0};
    dvi__avi_facts(avi, &facts);
    ck_assert_int_eq(dvi__largest_multipliers(&flow, facts.longest, repeats(2000), &report),
                     DVI_OK);
    if (i == 0 && !is_short_run())
      ck_assert_double_eq_tol(report.growth, 1.00481751, 5e-4);
    else if (i > 0)
      ck_assert_double_lt(report.growth - 1, report.resolution);
    ck_assert_double_lt(report.resolution, repeats(10) == 1 ? 0.02 : 0.002);
    dvi__avi_destroy(&avi);
    end_stepped(&s);
  }
}
END_TEST

/* ---- other meshes: the run shows what was foretold ---- */

/* The rate at which the logarithm of the amplitude grows in the second half of a run. */
static double rate_of_run(const stepped *s, double span)
{
  dvi__avi_terms terms = s->terms;
  terms.band = 1e99;
  dvi__avi *avi = avi_of(&terms);
  start_at_random(s, avi, 5);
  advance_to(avi, span);
  const double half = energy_of(avi);
  advance_to(avi, 2 * span);
  const double rate = 0.5 * log(energy_of(avi) / half) / span;
  dvi__avi_destroy(&avi);
  return rate;
}

typedef struct mesh_case {
  const char *name;
  int dimension, cells, k;
  double grading, fraction, growth, span; /* growth 1 for none */
} mesh_case;

/* Half of the bounds, the default, is stable here. What grows does so by a factor of e^13 and more
 * in half of the time, so that the fastest field is alone then. */
START_TEST(runs_grow_as_foretold)
{
  static const mesh_case cases[] = {
      {"box", 3, 3, 0, 2, 0.99, 1.19765, 100},     {"box", 3, 3, 0, 2, 0.5, 1, 100},
      {"disk", 0, 3, 0, 0, 0.8, 1.02224, 600},     {"disk", 0, 3, 0, 0, 0.5, 1, 100},
      {"cylinder", 0, 2, 0, 0, 0.95, 1.57661, 60}, {"annulus", 0, 3, 1, 0, 0.5, 1, 100}};
  for (size_t i = 0; i < (is_short_run() ? 2 : sizeof cases / sizeof *cases); i++) {
    const mesh_case *c = cases + i;
    stepped s = stepped_mesh(grid_mesh(c->name, c->dimension, c->cells, c->grading), c->k, 1);
    s.terms.fraction = c->fraction;
    const dvi_stability report = stability_of(&s);
    const double rate = rate_of_run(&s, c->span);
    ck_assert_double_eq_tol(report.growth, c->growth, c->growth > 1 ? 1e-5 : 1e-9);
    ck_assert_int_eq(report.is_stable, c->growth == 1);
    if (c->growth > 1)
      ck_assert_double_eq_tol(rate, log(report.growth), 0.02 * rate);
    else
      ck_assert_double_lt(fabs(rate), 1e-3); /* some percent in the span */
    end_stepped(&s);
  }
}
END_TEST

/* ---- losses ---- */

/* A graded box with magnetic walls, and the currents of absorbing walls at two sides, 1/length. */
typedef struct open_box {
  stepped s;
  double damping[100];
} open_box;

static void make_open_box(open_box *b)
{
  const dvi_generator_options options = {
      .size = sizeof options, .dimension = 2, .cells = {6, 7}, .grading = {1.223, 2.745}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("box", &options, &mesh), DVI_OK);
  *b = (open_box){.s = stepped_mesh(mesh, 1, 0)};
  int width;
  const int *vertex = dvi_mesh_vertices(mesh, 1, &width);
  const double *point = dvi_mesh_points(mesh);
  for (int side = 0; side < 2; side++) {
    int64_t count;
    const int *edge = dvi_mesh_part_cells(mesh, side == 0 ? "left" : "right", 1, &count);
    for (int64_t i = 0; i < count; i++) {
      const double *from = point + 2 * vertex[2 * edge[i]],
                   *to = point + 2 * vertex[2 * edge[i] + 1];
      b->damping[edge[i]] = 1 / hypot(to[0] - from[0], to[1] - from[1]);
    }
  }
  b->s.terms.fraction = 0.7;
}

/* The losses make steps unstable that are stable without. Digits of an independent program, which
 * multiplied the matrices of all events. With shorter steps, a static field stays for ever. */
START_TEST(losses_can_make_a_field_grow)
{
  open_box b;
  make_open_box(&b);
  ck_assert(stability_of(&b.s).is_stable);
  b.s.terms.damping = b.damping;
  const dvi_stability report = stability_of(&b.s);
  ck_assert(!report.is_stable);
  ck_assert_double_eq_tol(report.growth, 1.011508820, 6e-9);
  ck_assert_int_eq(report.followed, 42 + 97); /* modes of A, and all of D */
  dvi__avi *avi = avi_of(&b.s.terms);
  const dvi__flow flow = dvi__avi_flow(avi);
  dvi_stability searched = {0};
  ck_assert_int_eq(dvi__largest_multipliers(&flow, report.period, 2000, &searched), DVI_OK);
  ck_assert_double_eq_tol(searched.growth, report.growth, 1e-8);
  dvi__avi_destroy(&avi);
  const double rate = rate_of_run(&b.s, 1000);
  ck_assert_double_eq_tol(rate, log(report.growth), 0.005 * rate);
  b.s.terms.fraction = 0.5;
  ck_assert(stability_of(&b.s).is_stable);
  ck_assert_double_lt(fabs(rate_of_run(&b.s, 1000)), 1e-6);
  end_stepped(&b.s);
}
END_TEST

/* Nothing is left of the field that is followed. */
START_TEST(losses_can_take_all_fields_away)
{
  for (int is_free = 0; is_free < 2; is_free++) {
    stepped s = stepped_mesh(grid_mesh("box", 2, 4, 2), 1, 1);
    double *damping = zeros(s.edges);
    for (int64_t e = 0; e < s.edges; e++) damping[e] = 5 * s.terms.M1[e];
    s.terms.damping = damping;
    s.terms.is_free = is_free;
    const dvi_stability report = stability_of(&s);
    ck_assert(report.is_stable && report.growth == 1);
    dvi__avi *avi = avi_of(&s.terms);
    const dvi__flow flow = dvi__avi_flow(avi);
    dvi_stability searched = {0};
    for (int far = 0; far < 2 && !is_free; far++) {
      ck_assert_int_eq(dvi__largest_multipliers(&flow, report.period, far ? 5e4 : 500, &searched),
                       DVI_OK);
      ck_assert(searched.growth == 1);
    }
    dvi__avi_destroy(&avi);
    free(damping);
    end_stepped(&s);
  }
}
END_TEST

/* ---- free steps ---- */

START_TEST(free_steps_are_followed_for_a_long_time)
{
  stepped s = stepped_mesh(grid_mesh("box", 2, 10, 2), 1, 1);
  double step[100];
  step_by_cells(&s, 0.8, 1, step);
  const dvi_stability report = stability_of(&s);
  ck_assert(report.period == 0 && report.is_stable == 0);
  ck_assert_double_gt(report.growth, 1.005); /* the energy grows 800 times in t = 400 */
  ck_assert_ptr_nonnull(strstr(report.schedule, "without a common period"));
  ck_assert_double_lt(report.resolution, 0.002);
  end_stepped(&s);
}
END_TEST

/* This string grows by a factor of 16 in each unit of time, so that its energy is 1e720 times as
 * large after 300. */
START_TEST(growth_beyond_all_numbers_is_refused)
{
  stepped s = stepped_mesh(grid_mesh("interval", 1, 16, 2), 0, 1);
  dvi_stability report = {.growth = -1};
  s.terms.is_free = 1;
  s.terms.fraction = 0.95;
  ck_assert_double_gt(stability_of(&s).growth, 15);
  ck_assert_int_eq(dvi__avi_stability(&s.terms, 64 * 300, &report), DVI_NOT_FINITE);
  check_words("take a shorter span");
  ck_assert(report.growth == -1);
  dvi__avi *avi = avi_of(&s.terms);
  const dvi__flow flow = dvi__avi_flow(avi);
  ck_assert_int_eq(dvi__largest_multipliers(&flow, 300, 80 * 300, &report), DVI_NOT_FINITE);
  check_words("take a shorter span");
  ck_assert_int_eq(dvi__all_multipliers(&flow, 300, &report), DVI_NOT_FINITE);
  check_words("take a shorter span");
  dvi__avi_destroy(&avi);
  end_stepped(&s);
}
END_TEST

START_TEST(schedules_are_told_in_words)
{
  stepped s = stepped_mesh(grid_mesh("interval", 1, 8, 2), 0, 1);
  double step[8];
  ck_assert_ptr_nonnull(strstr(stability_of(&s).schedule, "classes of steps, powers of 2 from"));
  for (int f = 0; f < 8; f++) step[f] = 1e-3;
  s.terms.step = step;
  ck_assert_str_eq(stability_of(&s).schedule, "equal steps of 0.001");
  end_stepped(&s);
}
END_TEST

START_TEST(lacking_memory_is_a_status)
{
  for (int way = 0; way < 2; way++) {
    stepped s = stepped_mesh(grid_mesh("box", 2, 4, 2), 1, 1);
    dvi_stability report = {.growth = -1};
    dvi_status status = DVI_NO_MEMORY;
    dvi__avi *avi = avi_of(&s.terms);
    const dvi__flow flow = dvi__avi_flow(avi);
    for (long successes = 0; status != DVI_OK; successes++) {
      dvi__fail_allocations_after(successes);
      status = way == 0 ? dvi__avi_stability(&s.terms, 0, &report)
                        : dvi__largest_multipliers(&flow, 1, 80, &report);
      dvi__fail_allocations_after(-1);
      ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
      ck_assert(status == DVI_OK || way == 1 || report.growth == -1);
    }
    dvi__avi_destroy(&avi);
    end_stepped(&s);
  }
}
END_TEST

SUITE(monodromy)
{
  tcase_add_test(tests, two_steps_on_a_string_have_known_growths);
  tcase_add_test(tests, a_graded_square_is_unstable_from_095_on);
  tcase_add_test(tests, arnoldis_method_finds_the_same_growth);
  tcase_add_test(tests, runs_grow_as_foretold);
  tcase_add_test(tests, losses_can_make_a_field_grow);
  tcase_add_test(tests, losses_can_take_all_fields_away);
  tcase_add_test(tests, free_steps_are_followed_for_a_long_time);
  tcase_add_test(tests, growth_beyond_all_numbers_is_refused);
  tcase_add_test(tests, schedules_are_told_in_words);
  tcase_add_test(tests, lacking_memory_is_a_status);
}
