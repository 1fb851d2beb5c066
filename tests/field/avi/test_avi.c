/* Asynchronous steps on arrays: their bounds, orders, charges, and refusals. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "support/meshes.h"
#include "support/field/steps.h"
#include "support/suite.h"

/* ---- currents ---- */

/* Fails from the time *user on. */
static dvi_status breaks_off(double from, double to, double *impulse, void *user)
{
  *impulse = to - from;
  if (to <= *(const double *)user) return DVI_OK;
  return dvi__fail(DVI_CALLBACK_FAILED, "current 0 failed");
}

/* ---- bounds ---- */

static double fastest_face(dvi_mesh *mesh, int is_fixed)
{
  stepped s = stepped_mesh(mesh, 1, is_fixed);
  dvi_march_facts facts;
  dvi__avi *avi = avi_of(&s.terms);
  dvi__avi_facts(avi, &facts);
  dvi__avi_destroy(&avi);
  end_stepped(&s);
  return 2 / facts.bound;
}

/* Squares of the width h have 2 sqrt(2)/h, cubes 4/h, of which only sqrt(12)/h is needed. The
 * staggered triangles have 48. */
START_TEST(bounds_of_faces_are_those_of_theory)
{
  ck_assert_double_eq_tol(fastest_face(grid_mesh("box", 2, 5, 1), 1), sqrt(8) * 5, 1e-12);
  ck_assert_double_eq_tol(fastest_face(grid_mesh("box", 3, 4, 1), 1), 4 * 4, 1e-12);
  ck_assert_double_eq_tol(fastest_face(staggered_mesh(8, 8), 1), 48.0, 0.05);
}
END_TEST

static void check_steps(const stepped *s, int is_free)
{
  dvi_march_facts facts;
  dvi__avi_terms terms = s->terms;
  terms.is_free = is_free;
  terms.span = 1.7;
  dvi__avi *avi = avi_of(&terms);
  dvi__avi_facts(avi, &facts);
  const double count = 1.7 / facts.step, ratio = facts.longest / facts.step;
  ck_assert_double_eq_tol(count, rint(count), 1e-9 * count);
  ck_assert(facts.step <= 0.5 * facts.bound * (1 + 1e-12));
  ck_assert(ratio > 1.5 && (is_free || ratio == exp2(rint(log2(ratio)))));
  dvi__avi_destroy(&avi);
}

START_TEST(steps_are_powers_of_two_of_one_that_divides_the_span)
{
  stepped s = mesh_of_case(0);
  check_steps(&s, 0);
  check_steps(&s, 1);
  end_stepped(&s);
}
END_TEST

/* ---- equal steps ---- */

/* Leapfrog by the matrices of the mesh, in place, E half a step behind. */
static void leapfrog(const loaded *l, double h, int steps, double *A, double *E)
{
  const dvi__avi_terms *t = &l->s.terms;
  double *kick = zeros(t->edges);
  for (int n = 0; n < steps; n++) {
    memset(kick, 0, (size_t)t->edges * sizeof *kick);
    for (int64_t f = 0; f < t->faces; f++) {
      double B = 0;
      for (int c = 0; c < t->width; c++)
        B += t->sign[f * t->width + c] * A[t->facet[f * t->width + c]];
      for (int c = 0; c < t->width; c++)
        kick[t->facet[f * t->width + c]] += t->sign[f * t->width + c] * t->M2[f] * B;
    }
    for (int64_t e = 0; e < t->edges; e++) {
      const double length = n == 0 ? 0.5 * h : h, from = n == 0 ? 0 : (n - 0.5) * h;
      double push = length * kick[e];
      for (int i = 0; i < t->currents; i++) {
        double impulse;
        (void)t->current[i].impulse(from, (n + 0.5) * h, &impulse, NULL);
        push -= t->current[i].profile[e] * impulse;
      }
      if (t->is_fixed[e]) continue;
      E[e] += push / t->M1[e];
      A[e] -= h * E[e];
    }
  }
  free(kick);
}

/* The noise is not used, because it is not the sum of its halves. The state of leapfrog after its
 * drift is that of the edges before their next event, and the sample of A is the same. */
static void check_leapfrog(int i, int steps)
{
  loaded l = {.s = mesh_of_case(i)};
  dvi_march_facts facts;
  load_steps(&l, 1, 0);
  dvi__avi *avi = avi_of(&l.s.terms);
  dvi__avi_facts(avi, &facts);
  dvi__avi_destroy(&avi);
  const double h = 0.9 * facts.bound;
  double *step = zeros(l.s.faces), *A = zeros(l.s.edges), *E = zeros(l.s.edges),
         *sample = zeros(l.s.edges), size = 0;
  for (int64_t f = 0; f < l.s.faces; f++) step[f] = h;
  unsigned long long seed = 5;
  for (int64_t e = 0; e < l.s.edges; e++)
    if (!l.s.is_fixed[e]) {
      A[e] = random_number(&seed) - 0.5;
      E[e] = random_number(&seed) - 0.5;
    }
  l.s.terms.step = step;
  avi = avi_of(&l.s.terms);
  ck_assert_int_eq(dvi__avi_start(avi, 0, A, E, NULL), DVI_OK);
  leapfrog(&l, h, steps, A, E);
  advance_to(avi, steps * h);
  take_form(avi, DVI_FORM_A, sample);
  for (int64_t e = 0; e < l.s.edges; e++) size = fmax(size, fabs(A[e]));
  for (int64_t e = 0; e < l.s.edges; e++)
    ck_assert_msg(fabs(A[e] - sample[e]) < 1e-13 * size * steps / 200, "mesh %d: %g of %g", i,
                  A[e] - sample[e], size);
  dvi__avi_destroy(&avi);
  free(step), free(A), free(E), free(sample);
  end_loaded(&l);
}

/* Roundings of 200 steps are some 1e-14 of the values. */
START_TEST(equal_steps_are_leapfrog)
{
  for (int i = 0; i < STEPPED_MESHES; i++) check_leapfrog(i, 200);
}
END_TEST

/* ---- orders ---- */

START_TEST(samples_at_any_time_are_of_order_two)
{
  for (int is_free = 0; is_free < 2; is_free++) {
    double exact[STRING_VALUES];
    run_string(0, 0.7, 0.4 / 256, exact);
    const double coarse = string_error(is_free, 0.7, 0.4, exact),
                 fine = string_error(is_free, 0.7, 0.4 / 16, exact),
                 order = log2(coarse / fine) / 4;
    ck_assert_msg(order > 1.75 && order < 2.3, "order %g (%g, %g)", order, coarse, fine);
  }
}
END_TEST

/* ---- charges ---- */

/* The sums of a node's terms are rounded some 1e4 times, at random. */
START_TEST(charges_follow_random_currents)
{
  for (int i = 0; i < 2; i++) {
    loaded l = {.s = mesh_of_case(i == 0 ? 0 : 3)};
    load_steps(&l, 2, i);
    l.s.terms.is_free = 1;
    l.s.terms.fraction = 0.3;
    l.s.terms.band = 1e9;
    dvi_march_facts facts;
    dvi__avi *avi = avi_of(&l.s.terms);
    start_at_random(&l.s, avi, 3);
    for (int n = 1; n <= repeats(50); n++) {
      advance_to(avi, n);
      ck_assert_double_lt(dvi__avi_gauss(avi), 1e-13);
    }
    dvi__avi_facts(avi, &facts);
    ck_assert_int_gt(facts.steps, repeats(50) * 200);
    dvi__avi_destroy(&avi);
    end_loaded(&l);
  }
}
END_TEST

/* ---- starts ---- */

START_TEST(a_start_is_what_it_says)
{
  stepped s = mesh_of_case(1);
  dvi__avi *avi = avi_of(&s.terms);
  double *A = zeros(s.edges), *E = zeros(s.edges), *B = zeros(s.faces), *seen = zeros(s.edges);
  unsigned long long seed = 2;
  for (int64_t e = 0; e < s.edges; e++) A[e] = random_number(&seed);
  for (int64_t e = 0; e < s.edges; e++) E[e] = s.is_fixed[e] ? 0 : random_number(&seed);
  for (int64_t f = 0; f < s.faces; f++) B[f] = random_number(&seed);
  ck_assert_int_eq(dvi__avi_start(avi, 3, A, E, B), DVI_OK);
  ck_assert(dvi__avi_time(avi) == 3);
  take_form(avi, DVI_FORM_A, seen);
  for (int64_t e = 0; e < s.edges; e++) ck_assert(seen[e] == A[e]);
  take_form(avi, DVI_FORM_E, seen);
  for (int64_t e = 0; e < s.edges; e++) ck_assert_double_eq_tol(seen[e], E[e], 1e-14);
  take_form(avi, DVI_FORM_B, seen);
  for (int64_t f = 0; f < s.faces; f++) ck_assert_double_eq_tol(seen[f], B[f], 1e-14);
  const int some[] = {4, 0, 4};
  ck_assert_int_eq(dvi__avi_sample(avi, DVI_FORM_A, 3, some, seen), DVI_OK);
  ck_assert(seen[0] == A[4] && seen[1] == A[0] && seen[2] == A[4]);
  E[s.edges / 2] = 1e200;
  for (int64_t e = 0; e < s.edges; e++) E[e] = 1e200;
  ck_assert_int_eq(dvi__avi_start(avi, 4, A, E, B), DVI_NOT_FINITE);
  ck_assert(dvi__avi_time(avi) == 3);
  free(A), free(E), free(B), free(seen);
  dvi__avi_destroy(&avi);
  end_stepped(&s);
}
END_TEST

/* ---- alarms and refusals ---- */

/* Steps of 0.97 of the bound of their cells with ratios of their own grow in a short time. */
START_TEST(a_run_that_grows_says_so_and_goes_on)
{
  stepped s = mesh_of_case(0);
  s.terms.is_free = 1;
  s.terms.fraction = 0.97;
  dvi__avi *avi = avi_of(&s.terms);
  start_at_random(&s, avi, 1);
  const double start = energy_of(avi);
  dvi_status status = DVI_OK;
  for (int n = 1; n < 1000 && status == DVI_OK; n++) status = dvi__avi_advance(avi, n);
  ck_assert_int_eq(status, DVI_STEP_TOO_LARGE);
  check_words("times that of the start");
  const double first = energy_of(avi) / start, t = dvi__avi_time(avi);
  ck_assert(first > 2 && t < 1000);
  dvi__avi *other = avi_of(&s.terms); /* without cuts, and it takes the wider band from the first */
  start_at_random(&s, other, 1);
  ck_assert_int_eq(dvi__avi_advance(other, 1000), DVI_STEP_TOO_LARGE);
  ck_assert(dvi__avi_time(other) == t);
  dvi_march_facts facts;
  dvi__avi_facts(other, &facts);
  start_at_random(&s, other, 1);
  advance_to(other, t - 64 * facts.longest); /* the comparison before did not see it */
  ck_assert_double_le(energy_of(other) / start, 2);
  start_at_random(&s, other, 1);
  reload_steps(avi, other);
  ck_assert(dvi__avi_advance(other, t + 0.1) == DVI_OK && dvi__avi_time(other) == t + 0.1);
  dvi__avi_destroy(&other);
  while (status == DVI_OK || status == DVI_STEP_TOO_LARGE) status = dvi__avi_advance(avi, t + 1e6);
  ck_assert_int_eq(status, DVI_NOT_FINITE);
  ck_assert(isfinite(energy_of(avi)));
  dvi__avi_destroy(&avi);
  end_stepped(&s);
}
END_TEST

static void check_break(int is_queued)
{
  double end = 0.5;
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 1, 0);
  l.current[0].impulse = breaks_off;
  l.current[0].user = &end;
  l.s.terms.is_queued = is_queued;
  dvi__avi *avi = avi_of(&l.s.terms);
  start_at_random(&l.s, avi, 1);
  ck_assert_int_eq(dvi__avi_advance(avi, 1), DVI_CALLBACK_FAILED);
  check_words("current 0 failed");
  const double t = dvi__avi_time(avi);
  ck_assert(t > 0.4 && t <= 0.5);
  end = 10; /* mended, it goes on as if nothing had happened */
  advance_to(avi, 1);
  dvi__avi *other = ran_steps(&l.s.terms, &l.s, 0);
  start_at_random(&l.s, other, 1);
  advance_to(other, 1);
  check_same(&l.s, avi, other);
  dvi__avi_destroy(&avi), dvi__avi_destroy(&other);
  end_loaded(&l);
}

START_TEST(a_signal_that_fails_leaves_the_last_good_time)
{
  check_break(0);
  check_break(1);
}
END_TEST

/* Fails once, at the first interval that ends behind *user. */
static dvi_status fails_once(double from, double to, double *impulse, void *user)
{
  double *end = user;
  *impulse = to - from;
  if (to <= *end) return DVI_OK;
  *end = INFINITY;
  return dvi__fail(DVI_CALLBACK_FAILED, "current 0 failed");
}

/* Of the events of one time, some have happened when the signal fails, and others follow. */
START_TEST(a_look_amid_events_of_one_time_is_not_the_last_one)
{
  loaded l = {.s = mesh_of_case(0)};
  double end = 0.5, *profile = zeros(l.s.edges);
  int64_t e = l.s.edges - 1;
  while (l.s.is_fixed[e]) e--;
  profile[e] = 1;
  const dvi__avi_current current = {profile, fails_once, &end};
  l.s.terms.current = &current;
  l.s.terms.currents = 1;
  l.s.terms.is_queued = 1;
  dvi__avi *avi = avi_of(&l.s.terms);
  start_at_random(&l.s, avi, 7);
  ck_assert_int_eq(dvi__avi_advance(avi, 1), DVI_CALLBACK_FAILED);
  const double t = dvi__avi_time(avi);
  ck_assert_double_gt(t, 0.5);
  (void)energy_of(avi);
  advance_to(avi, t);
  dvi__avi *other = ran_steps(&l.s.terms, &l.s, t);
  check_same(&l.s, avi, other);
  ck_assert(energy_of(avi) == energy_of(other));
  dvi__avi_destroy(&avi), dvi__avi_destroy(&other);
  free(profile);
  end_loaded(&l);
}
END_TEST

static void check_refusal(const dvi__avi_terms *terms, dvi_status status, const char *words)
{
  dvi__avi *avi = NULL;
  ck_assert_int_eq(dvi__avi_create(terms, &avi), status);
  ck_assert_ptr_null(avi);
  check_words(words);
}

static dvi_status counted(double from, double to, double *impulse, void *user)
{
  ++*(long *)user;
  *impulse = to - from;
  return DVI_OK;
}

/* Count the integrals of a current at one edge, in a run with a look at the energy. */
static long count_integrals(dvi__avi_terms terms, const stepped *s, double *profile)
{
  long count = 0;
  const dvi__avi_current current = {profile, counted, &count};
  terms.current = &current;
  terms.currents = 1;
  dvi__avi *avi = ran_steps(&terms, s, 0.5);
  (void)energy_of(avi);
  dvi__avi_destroy(&avi);
  return count;
}

START_TEST(currents_are_integrated_where_they_flow)
{
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 0, 1);
  double *profile = zeros(l.s.edges);
  int64_t e = 0;
  while (l.s.is_fixed[e]) e++;
  profile[e] = 1;
  for (int is_free = 0; is_free < 2; is_free++) {
    dvi__avi_terms terms = l.s.terms;
    terms.is_free = is_free;
    const long damped = count_integrals(terms, &l.s, profile);
    terms.damping = NULL;
    const long alone = count_integrals(terms, &l.s, profile);
    ck_assert_int_gt(alone, 0);
    ck_assert_int_eq(damped, alone);
  }
  free(profile);
  end_loaded(&l);
}
END_TEST

START_TEST(what_cannot_be_stepped_is_refused)
{
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 1, 1);
  dvi__avi_terms terms = l.s.terms;
  double *M1 = zeros(l.s.edges), *M2 = zeros(l.s.faces), *step = zeros(l.s.faces);
  int8_t *all = calloc((size_t)l.s.edges, 1);
  int64_t inner = 0;
  memcpy(M1, terms.M1, (size_t)l.s.edges * sizeof *M1);
  memcpy(M2, terms.M2, (size_t)l.s.faces * sizeof *M2);
  memset(all, 1, (size_t)l.s.edges);
  while (l.s.is_fixed[inner]) inner++;
  terms.fraction = 1;
  check_refusal(&terms, DVI_BAD_ARGUMENT, "are not stable; the least bound");
  terms.fraction = 0;
  terms.shortest = 1;
  check_refusal(&terms, DVI_BAD_ARGUMENT, "take a shorter step");
  terms.shortest = 0;
  terms.step = step;
  check_refusal(&terms, DVI_BAD_ARGUMENT, "has a step of 0");
  terms.step = NULL;
  terms.is_fixed = all;
  check_refusal(&terms, DVI_BAD_ARGUMENT, "nothing moves");
  terms.is_fixed = l.s.is_fixed;
  terms.M2 = M2;
  M2[3] = -1;
  check_refusal(&terms, DVI_SINGULAR, "no step is stable");
  M2[3] = INFINITY;
  check_refusal(&terms, DVI_NOT_FINITE, "at face 3");
  memset(M2, 0, (size_t)l.s.faces * sizeof *M2);
  check_refusal(&terms, DVI_UNSUPPORTED, "nothing moves it");
  terms.M2 = l.s.terms.M2;
  terms.M1 = M1;
  M1[inner] = 0;
  check_refusal(&terms, DVI_SINGULAR, "needs finite ones above 0");
  terms.M1 = l.s.terms.M1;
  l.damping[inner] = -1;
  check_refusal(&terms, DVI_BAD_ARGUMENT, "the damping is -1");
  l.damping[inner] = 0;
  l.profile[0][inner] = NAN;
  check_refusal(&terms, DVI_NOT_FINITE, "current 0");
  free(M1), free(M2), free(step), free(all);
  end_loaded(&l);
}
END_TEST

/* Of each allocation in turn. */
START_TEST(lacking_memory_is_a_status)
{
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 1, 1);
  l.s.terms.threads = 2;
  for (int is_free = 0; is_free < 2; is_free++) {
    dvi__avi *avi = NULL;
    dvi_status status = DVI_NO_MEMORY;
    l.s.terms.is_free = is_free;
    for (long successes = 0; status != DVI_OK; successes++) {
      dvi__fail_allocations_after(successes);
      status = dvi__avi_create(&l.s.terms, &avi);
      dvi__fail_allocations_after(-1);
      ck_assert(status == DVI_OK || (status == DVI_NO_MEMORY && avi == NULL));
    }
    dvi__avi_destroy(&avi);
  }
  end_loaded(&l);
}
END_TEST

/* A step, a sample and an observation need no memory. */
START_TEST(steps_allocate_nothing)
{
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 1, 1);
  for (int is_free = 0; is_free < 2; is_free++) {
    l.s.terms.is_free = is_free;
    double *values = zeros(l.s.edges);
    dvi__avi *avi = ran_steps(&l.s.terms, &l.s, 0.1);
    const long before = dvi__allocation_count();
    advance_to(avi, 3);
    take_form(avi, DVI_FORM_E, values);
    (void)energy_of(avi);
    ck_assert_int_eq(dvi__allocation_count(), before);
    dvi__avi_destroy(&avi);
    free(values);
  }
  end_loaded(&l);
}
END_TEST

SUITE(avi)
{
  tcase_add_test(tests, bounds_of_faces_are_those_of_theory);
  tcase_add_test(tests, steps_are_powers_of_two_of_one_that_divides_the_span);
  tcase_add_test(tests, equal_steps_are_leapfrog);
  tcase_add_test(tests, samples_at_any_time_are_of_order_two);
  tcase_add_test(tests, charges_follow_random_currents);
  tcase_add_test(tests, a_start_is_what_it_says);
  tcase_add_test(tests, a_run_that_grows_says_so_and_goes_on);
  tcase_add_test(tests, a_signal_that_fails_leaves_the_last_good_time);
  tcase_add_test(tests, a_look_amid_events_of_one_time_is_not_the_last_one);
  tcase_add_test(tests, currents_are_integrated_where_they_flow);
  tcase_add_test(tests, what_cannot_be_stepped_is_refused);
  tcase_add_test(tests, lacking_memory_is_a_status);
  tcase_add_test(tests, steps_allocate_nothing);
}
