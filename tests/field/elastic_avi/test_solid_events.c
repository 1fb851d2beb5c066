/* labels: judge */
/* Marches of solids against asynchronous steps in quadruple precision, between any two events. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/marches.h"
#include "support/solid/judged_solids.h"
#include "support/solid/quad_avi.h"
#include "support/suite.h"

enum { LAWS = 4, END = 1, CHECKS_LEAST = 4 };

typedef struct pair {
  judged_solid s;
  dvi_march *march;
  quad_avi judge;
  quad *u, *v;
} pair;

static void give_equal_steps(const quad_solid *s, double length, double *step)
{
  for (int cell = 0; cell < s->cells; cell++)
    step[cell] = isinf(quad_solid_bound(s, cell)) ? (double)INFINITY : length;
}

static pair pair_of(const solid_case *of, const char *method, double fraction)
{
  pair p = {.s = make_judged(of, NULL, 0)};
  const quad_solid *s = &p.s.judge;
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  double *step = calloc((size_t)s->cells, sizeof *step);
  p.u = calloc((size_t)s->size, sizeof *p.u), p.v = calloc((size_t)s->size, sizeof *p.v);
  start_judged(&p.s, 1, p.u, p.v);
  double *u = rounded(s->size, p.u), *rate = rounded(s->size, p.v);
  for (int i = 0; i < s->size; i++) rate[i] = -rate[i];
  const dvi_march_state start = {.size = sizeof start, .A = u, .E = rate};
  ck_assert_msg(dvi_elastic_march_create(p.s.elastic, &options, &p.march) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_march_start(p.march, &start) == DVI_OK, "%s", dvi_last_error());
  if (strcmp(method, "verlet") == 0)
    give_equal_steps(s, step_of_march(p.march), step);
  else
    quad_avi_steps(s, fraction, strcmp(method, "avi") == 0, 0, step);
  p.judge = quad_avi_of(s, step, 0, p.u, p.v);
  free(step), free(u), free(rate);
  return p;
}

static void end_pair(pair *p)
{
  dvi_march_destroy(&p->march);
  quad_avi_clear(&p->judge);
  free(p->u), free(p->v);
  end_judged_solid(&p->s);
}

/* Require equal displacements and rates at a time, up to `rounding`. */
static void check_time(pair *p, double t, double rounding, const char *name)
{
  const int size = p->s.judge.size;
  quad_avi_advance(&p->judge, t, p->u, p->v);
  advance_march(p->march, t);
  double *u = sample_march(p->march, DVI_FORM_A), *v = sample_march(p->march, DVI_FORM_E);
  for (int i = 0; i < size; i++) v[i] = -v[i];
  ck_assert_msg(error_of_solid(size, u, p->u) < rounding, "%s: u off by %g at t = %.17g", name,
                error_of_solid(size, u, p->u), t);
  ck_assert_msg(error_of_solid(size, v, p->v) < 100 * rounding, "%s: v off by %g at t = %.17g",
                name, error_of_solid(size, v, p->v), t);
  free(u), free(v);
}

/* Steps of both are equal up to a rounding, and so are times. States are compared in the middle
 * between two times of events, up to t = 1; loads deform a solid too much later. Kicks at the start
 * are no events of a march. */
static void check_events(const solid_case *of, const char *method)
{
  pair p = pair_of(of, method, 0.4);
  dvi_march_facts facts;
  quad_avi_event(&p.judge);
  const long kicks = p.judge.events;
  int checks = 0;
  while (quad_avi_next(&p.judge) < END) {
    const quad from = quad_avi_next(&p.judge);
    quad_avi_event(&p.judge);
    const quad to = quad_avi_next(&p.judge);
    if (to - from < 1e-9) continue;
    check_time(&p, (double)((from + to) / 2), 1e-13, name_solid(of));
    dvi_march_facts_of(p.march, &facts);
    ck_assert_int_eq(facts.updates, p.judge.events - kicks);
    checks++;
  }
  ck_assert_int_ge(checks, CHECKS_LEAST);
  end_pair(&p);
}

static solid_case case_of(int i, unsigned traits)
{
  return (solid_case){.n = 2 + i / LAWS,
                      .cells = i < LAWS || i == LAWS + DVI_ELASTIC_NEO_HOOKEAN ? 2 : 1,
                      .grading = 2,
                      .jitter = 0.2,
                      .law = (dvi_elastic_law)(i % LAWS),
                      .traits = traits,
                      .seed = (unsigned)i + 1};
}

static void check_method(int i, const char *method)
{
  const solid_case free_one = case_of(i, SOLID_OF_TWO),
                   moved = case_of(i, SOLID_OF_TWO | SOLID_MOVED | SOLID_LOADED);
  check_events(&free_one, method);
  check_events(&moved, method);
}

START_TEST(classes_are_those_of_the_judge)
{
  check_method(_i, "avi");
}
END_TEST

START_TEST(free_steps_are_those_of_the_judge)
{
  check_method(_i, "avi:classes=no");
}
END_TEST

START_TEST(equal_steps_are_those_of_the_judge)
{
  check_method(_i, "verlet");
}
END_TEST

SUITE(solid_events)
{
  tcase_add_loop_test(tests, classes_are_those_of_the_judge, 0, 2 * LAWS);
  tcase_add_loop_test(tests, free_steps_are_those_of_the_judge, 0, 2 * LAWS);
  tcase_add_loop_test(tests, equal_steps_are_those_of_the_judge, 0, 2 * LAWS);
}
