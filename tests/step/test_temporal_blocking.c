/* labels: unit */
/* Temporal blocking has the bits of plain passes over all sites, for any length, reach, block, cut
 * and instruction set, and when something fails. */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "step/split/temporal_blocking.h"
#include "integrator/integrator_struct.h"
#include "num/simd/lanes.h"
#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

enum { POTENTIALS = 2, MASSES = 5, THREADS_MOST = 4 };

/* Springs between each site and its next `reach` ones, and a well for each site that a drive moves.
 * What the springs' callback shall do wrong at one site, from some time on, is a number to return
 * or a number to give. */
typedef struct lattice {
  int n, reach;
  int bad_site; /* -1: none */
  double bad_time, bad_number;
  int bad_return;
  atomic_long entries, ranges; /* that the springs were asked for */
  atomic_long blind;           /* coordinates among them that were not finite */
} lattice;

static double spring(int distance, double d)
{
  return (d + 0.3 * d * d * d) / distance;
}

static double springs_entry(const lattice *own, const double *q, int i)
{
  double sum = 0;
  for (int k = 1; k <= own->reach; k++) {
    if (i - k >= 0) sum += spring(k, q[i] - q[i - k]);
    if (i + k < own->n) sum -= spring(k, q[i + k] - q[i]);
  }
  return sum;
}

static int springs_range(double t, const double *q, int first, int last, double *V_q, void *user)
{
  lattice *own = user;
  const int bad = own->bad_site >= first && own->bad_site < last && t >= own->bad_time;
  if (first < 0 || first >= last || last > own->n) return -7;
  atomic_fetch_add(&own->entries, last - first);
  atomic_fetch_add(&own->ranges, 1);
  for (int i = first; i < last; i++) V_q[i - first] = springs_entry(own, q, i);
  for (int i = first; i < last; i++)
    if (!isfinite(q[i])) atomic_fetch_add(&own->blind, 1);
  if (bad && own->bad_return == 0) V_q[own->bad_site - first] = own->bad_number;
  return bad ? own->bad_return : 0;
}

static int springs_value(double t, const double *q, double *V, void *user)
{
  const lattice *own = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < own->n; i++)
    for (int k = 1; k <= own->reach && i + k < own->n; k++) {
      const double d = q[i + k] - q[i];
      *V += (d * d / 2 + 0.3 * d * d * d * d / 4) / k;
    }
  return 0;
}

static int wells_range(double t, const double *q, int first, int last, double *V_q, void *user)
{
  (void)user;
  for (int i = first; i < last; i++) V_q[i - first] = (1 + i % 3) * q[i] * q[i] * q[i] + t;
  return 0;
}

static int wells_value(double t, const double *q, double *V, void *user)
{
  const lattice *own = user;
  *V = 0;
  for (int i = 0; i < own->n; i++) *V += (1 + i % 3) * pow(q[i], 4) / 4 + t * q[i];
  return 0;
}

/* A lattice with its system and two integrators of it that start alike. */
typedef struct pair {
  lattice lattice;
  dvi_system *system;
  dvi_integrator *wave, *plain;
} pair;

static double place_of_site(int i)
{
  return 0.4 * sin(1.0 + 7 * i);
}

static dvi_mass mass_of(int kind, int n, double *diagonal)
{
  const double scalar[] = {1, 0.25, 3, -7};
  for (int i = 0; i < n; i++) diagonal[i] = 1 + i % 5;
  return kind < 4 ? (dvi_mass){.scalar = scalar[kind]} : (dvi_mass){.diagonal = diagonal};
}

static void start_alike(pair *p)
{
  const int n = p->lattice.n;
  double *q = calloc(2 * (size_t)n, sizeof *q), *momenta = q + n;
  ck_assert_ptr_nonnull(q);
  for (int i = 0; i < n; i++) q[i] = place_of_site(i), momenta[i] = place_of_site(i + 1000);
  ck_assert_int_eq(dvi_integrator_start(p->wave, 0.25, q, momenta), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(p->plain, 0.25, q, momenta), DVI_OK);
  free(q);
}

/* `method` has a place for the keys of verlet. */
static void make_pair(pair *p, int n, int reach, int potentials, int mass, const char *method,
                      int threads, int block)
{
  const dvi_potential both[] = {
      {.name = "springs",
       .value = springs_value,
       .gradient_range = springs_range,
       .reach = reach,
       .user = &p->lattice},
      {.name = "wells", .value = wells_value, .gradient_range = wells_range, .user = &p->lattice}};
  double *diagonal = calloc((size_t)n, sizeof *diagonal);
  ck_assert_ptr_nonnull(diagonal);
  p->lattice = (lattice){.n = n, .reach = reach, .bad_site = -1};
  const dvi_system_terms terms = {.dimension = n,
                                  .mass = mass_of(mass, n, diagonal),
                                  .potentials = both,
                                  .potential_count = potentials};
  ck_assert_msg(dvi_system_create(&terms, &p->system) == DVI_OK, "%s", dvi_last_error());
  free(diagonal);
  dvi__blocking_choose_block(block);
  p->wave = create_integrator(p->system,
                              method_spec("%sblocking=temporal,threads=%d", method, threads));
  p->plain = create_integrator(p->system, method_spec("%sblocking=none", method));
  dvi__blocking_choose_block(0);
  start_alike(p);
}

static void destroy_pair(pair *p)
{
  dvi_integrator_destroy(&p->wave);
  dvi_integrator_destroy(&p->plain);
  dvi_system_destroy(&p->system);
}

/* All that the next step depends on. */
static void check_same(const dvi_integrator *a, const dvi_integrator *b, const char *when)
{
  const size_t n = (size_t)a->system->n, state = 4 * n * sizeof(double),
               memory = a->stepper.memory_count * sizeof(double);
  ck_assert_msg(memcmp(a->now.q, b->now.q, state) == 0, "%s: the state, n = %zu, %s", when, n,
                a->stepper.specification);
  ck_assert_msg(memcmp(a->stepper.memory, b->stepper.memory, memory) == 0,
                "%s: the memory, n = %zu, %s", when, n, a->stepper.specification);
  ck_assert_mem_eq(&a->now.t, &b->now.t, 2 * sizeof(double));
}

static void step_both(pair *p, double h)
{
  advance(p->wave, h, 1);
  advance(p->plain, h, 1);
}

static const char *const methods[] = {"verlet:", "composition:order=4,", "composition:order=6,",
                                      "composition:order=8,"};
static const int substeps[] = {1, 5, 9, 17};
enum { METHODS = 4 };

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
  dvi__blocking_choose_block(0);
}

/* ---- bits ---- */

START_TEST(any_length_reach_and_block_has_the_bits_of_the_plain_sweep)
{
  static const int lengths[] = {1, 2, 3, 5, 8, 13, 31, 64, 65, 130, 333, 1000, 2777},
                   blocks[] = {1, 7, 0, 16, 64, 3};
  int turn = 0;
  for (int reach = 0; reach <= 5; reach++)
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++, turn++) {
      pair p;
      make_pair(&p, lengths[k], reach, 1 + turn % POTENTIALS, turn % MASSES, methods[_i],
                1 + turn % THREADS_MOST, blocks[turn % 6]);
      step_both(&p, 0.05);
      check_same(p.wave, p.plain, "after the first step");
      step_both(&p, 0.05);
      step_both(&p, -0.03);
      check_same(p.wave, p.plain, "after a step back");
      destroy_pair(&p);
    }
}
END_TEST

/* The chain is long enough for default blocks on four threads, 4 (17+1) 8 + 4 512 + 8 coordinates
 * for each. */
START_TEST(every_instruction_set_and_thread_count_has_the_same_bits)
{
  enum { LENGTH = 12347 };
  for (int method = 0; method < METHODS; method += 3)
    for (int level = 0; level < dvi__lanes_levels(); level++)
      for (int threads = 1; threads <= THREADS_MOST; threads++) {
        pair p;
        char text[2048];
        make_pair(&p, LENGTH, 2, 2, threads, methods[method], threads, 0);
        dvi_integrator_explain(p.wave, text, sizeof text);
        ck_assert_msg(strstr(text, method_spec("threads: %d of %d\n", threads, threads)) != NULL,
                      "%s", text);
        dvi__lanes_choose(level);
        for (int i = 0; i < 3; i++) advance(p.wave, 0.04, 1);
        dvi__lanes_choose(0);
        for (int i = 0; i < 3; i++) advance(p.plain, 0.04, 1);
        check_same(p.wave, p.plain, dvi__lanes_level_name(level));
        destroy_pair(&p);
      }
}
END_TEST

/* The reach is that of rows of a mesh. The window of all substeps would not stay in the cache, so a
 * step takes several passes. */
START_TEST(a_long_reach_takes_several_passes_with_the_same_bits)
{
  static const int reaches[] = {900, 5000, 30000};
  pair p;
  char text[2048];
  make_pair(&p, 40000, 0, 1, 0, methods[2], 2, 0);
  destroy_pair(&p);
  for (int k = 0; k < 3; k++) {
    const dvi_potential wells = {.value = wells_value,
                                 .gradient_range = wells_range,
                                 .reach = reaches[k],
                                 .user = &p.lattice};
    const dvi_system_terms terms = {
        .dimension = 40000, .mass.scalar = 1, .potentials = &wells, .potential_count = 1};
    ck_assert_int_eq(dvi_system_create(&terms, &p.system), DVI_OK);
    p.wave = create_integrator(p.system, "composition:order=6,blocking=temporal,threads=2");
    p.plain = create_integrator(p.system, "composition:order=6,blocking=none");
    dvi_integrator_explain(p.wave, text, sizeof text);
    ck_assert_msg(strstr(text, k == 0   ? "at most 13 substeps"
                               : k == 1 ? "at most 2 substeps"
                                        : "at most 1 substeps") != NULL,
                  "%s", text);
    start_alike(&p);
    for (int i = 0; i < 2; i++) step_both(&p, 0.04);
    check_same(p.wave, p.plain, "several passes");
    destroy_pair(&p);
  }
}
END_TEST

/* The chain of the catalogue has both plain callbacks and ranges of one potential. */
START_TEST(the_catalogues_chain_has_the_same_bits_by_both_sweeps)
{
  static const char *const sizes[] = {"n=1", "n=2", "n=32", "n=4099"};
  problem *chain = create_problem("chain", sizes[_i]);
  dvi_integrator *plain = start_integrator(chain, "composition:order=8,blocking=none");
  advance(plain, 0.1, 20);
  for (int threads = 1; threads <= 2; threads++) {
    dvi_integrator *wave = start_integrator(
        chain, method_spec("composition:order=8,blocking=temporal,threads=%d", threads));
    advance(wave, 0.1, 20);
    check_same(wave, plain, "chain");
    dvi_integrator_destroy(&wave);
  }
  dvi_integrator_destroy(&plain);
  problem_destroy(&chain);
}
END_TEST

/* ---- cost ---- */

START_TEST(each_gradient_is_evaluated_once_and_nothing_is_allocated)
{
  enum { LENGTH = 5003, BLOCK = 512 };
  for (int threads = 1; threads <= 3; threads++) {
    pair p;
    dvi_counters before, after;
    make_pair(&p, LENGTH, 1, 1, 0, methods[_i], threads, BLOCK);
    step_both(&p, 0.05);
    dvi_integrator_counters(p.wave, &before);
    p.lattice.entries = p.lattice.ranges = 0;
    advance(p.wave, 0.05, 10);
    dvi_integrator_counters(p.wave, &after);
    /* none twice, on any thread */
    ck_assert_int_eq(p.lattice.entries, 10L * LENGTH * substeps[_i]);
    ck_assert_int_eq(after.gradients - before.gradients, 10 * substeps[_i]);
    ck_assert_int_eq(after.allocations - before.allocations, 0);
    /* whole blocks, but for the ends of the chain and of each thread's part */
    ck_assert_int_le(p.lattice.ranges, 10L * substeps[_i] * (LENGTH / BLOCK + 1 + 3 * threads));
    destroy_pair(&p);
  }
}
END_TEST

/* Five arrays move from one place to another, and are read, fetched and written. */
START_TEST(traffic_is_known_of_waves_alone)
{
  pair p;
  make_pair(&p, 1000, 1, 1, 0, methods[_i], 1, 0);
  ck_assert_double_eq(dvi_integrator_traffic(p.wave), 15 * 8 * 1000);
  ck_assert_double_eq(dvi_integrator_traffic(p.plain), 0);
  ck_assert_double_eq(dvi_integrator_traffic(NULL), 0);
  destroy_pair(&p);
}
END_TEST

/* ---- failures ---- */

typedef struct trouble {
  int site, returned;
  double number;
} trouble;

static const trouble troubles[] = {{0, 1, 0},    {700, -3, 0},        {1499, 2, 0},
                                   {733, 0, -1}, {1200, 0, HUGE_VAL}, {5, 0, 1e308 * 10}};
enum { TROUBLES = 6 };

static void make_trouble(pair *p, const trouble *what)
{
  p->lattice.bad_site = what->site;
  p->lattice.bad_return = what->returned;
  p->lattice.bad_number = what->number < 0 ? (double)NAN : what->number;
  /* in the midst of the third step, for compositions of order 8 too */
  p->lattice.bad_time = 0.25 + 0.2 + 0.05;
}

/* Both give one status and one sentence, and go on as if nothing had happened. */
START_TEST(a_failure_in_mid_wave_is_that_of_the_plain_sweep_and_leaves_no_trace)
{
  for (int threads = 1; threads <= THREADS_MOST; threads++) {
    char words[512];
    pair p;
    dvi_counters counters;
    make_pair(&p, 1500, 3, 2, threads, methods[_i / TROUBLES], threads, 16);
    for (int i = 0; i < 2; i++) step_both(&p, 0.1);
    make_trouble(&p, &troubles[_i % TROUBLES]);
    const dvi_status plain = dvi_integrator_step(p.plain, 0.1);
    (void)snprintf(words, sizeof words, "%s", dvi_last_error());
    ck_assert_int_ne(plain, DVI_OK);
    check_same(p.wave, p.plain, "before the failure");
    ck_assert_int_eq(dvi_integrator_step(p.wave, 0.1), plain);
    ck_assert_str_eq(dvi_last_error(), words);
    /* what a callback gave is looked at before the next is asked */
    ck_assert_int_eq(p.lattice.blind, 0);
    check_same(p.wave, p.plain, "after the failure");
    dvi_integrator_counters(p.wave, &counters);
    ck_assert_int_eq(counters.failed_steps, 1);
    ck_assert_int_eq(counters.steps, 2);
    p.lattice.bad_site = -1;
    step_both(&p, 0.1);
    check_same(p.wave, p.plain, "after going on");
    destroy_pair(&p);
  }
}
END_TEST

/* All callbacks succeed, but the numbers run away. */
START_TEST(a_state_that_is_not_finite_is_refused_by_both)
{
  for (int threads = 1; threads <= 2; threads++) {
    pair p;
    make_pair(&p, 300, 1, 1, 0, methods[_i], threads, 8);
    step_both(&p, 0.1);
    ck_assert_int_eq(dvi_integrator_step(p.plain, 1e200), DVI_NOT_FINITE);
    ck_assert_int_eq(dvi_integrator_step(p.wave, 1e200), DVI_NOT_FINITE);
    check_same(p.wave, p.plain, "after running away");
    destroy_pair(&p);
  }
}
END_TEST

/* The last gradient is finite, and its kick is not. No callback sees it. */
START_TEST(a_last_kick_that_overflows_is_refused_by_both)
{
  for (int threads = 1; threads <= 2; threads++) {
    pair p;
    make_pair(&p, 300, 0, 1, 0, methods[_i], threads, 8);
    step_both(&p, 0.1);
    p.lattice.bad_site = 277;
    p.lattice.bad_number = 1.7e308;
    p.lattice.bad_time = 0.35 + 0.98 * 20;
    ck_assert_int_eq(dvi_integrator_step(p.plain, 20), DVI_NOT_FINITE);
    check_words("the new state is not finite");
    ck_assert_int_eq(dvi_integrator_step(p.wave, 20), DVI_NOT_FINITE);
    check_words("the new state is not finite");
    check_same(p.wave, p.plain, "after an overflow");
    destroy_pair(&p);
  }
}
END_TEST

/* ---- what stands around a step ---- */

START_TEST(a_step_can_be_taken_back)
{
  pair p;
  make_pair(&p, 600, 2, 2, 4, methods[_i], 2, 16);
  step_both(&p, 0.1);
  advance(p.wave, 0.07, 1);
  ck_assert_int_eq(dvi__integrator_undo(p.wave, DVI_CALLBACK_RETRY), DVI_CALLBACK_RETRY);
  check_same(p.wave, p.plain, "after it is taken back");
  step_both(&p, 0.1);
  check_same(p.wave, p.plain, "after another step");
  destroy_pair(&p);
}
END_TEST

START_TEST(dense_output_is_that_of_the_plain_sweep)
{
  enum { LENGTH = 200 };
  double q[2][LENGTH], v[2][LENGTH];
  pair p;
  make_pair(&p, LENGTH, 2, 1, 2, methods[_i], 2, 8);
  for (int i = 0; i < 3; i++) step_both(&p, 0.1);
  ck_assert_int_eq(dvi_integrator_interpolate(p.wave, 0.25 + 0.23, q[0], v[0]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(p.plain, 0.25 + 0.23, q[1], v[1]), DVI_OK);
  ck_assert_mem_eq(q[0], q[1], sizeof q[0]);
  ck_assert_mem_eq(v[0], v[1], sizeof v[0]);
  destroy_pair(&p);
}
END_TEST

/* A new start forgets the gradient that was kept, wherever it was. */
START_TEST(a_new_start_begins_anew)
{
  pair p;
  make_pair(&p, 100, 1, 1, 0, methods[_i], 1, 0);
  for (int i = 0; i < 3; i++) advance(p.wave, 0.1, 1);
  start_alike(&p);
  for (int i = 0; i < 2; i++) step_both(&p, 0.1);
  check_same(p.wave, p.plain, "after a new start");
  destroy_pair(&p);
}
END_TEST

START_TEST(a_checkpoint_continues_bit_for_bit)
{
  pair p;
  make_pair(&p, 777, 3, 2, 4, methods[_i], 2, 16);
  for (int i = 0; i < 3; i++) step_both(&p, 0.1);
  ck_assert_msg(dvi_integrator_save(p.wave, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  dvi_integrator *restored = create_integrator(p.system, dvi_integrator_method(p.wave));
  ck_assert_msg(dvi_integrator_restore(restored, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < 3; i++) step_both(&p, 0.1);
  advance(restored, 0.1, 3);
  check_same(restored, p.wave, "restored");
  check_same(restored, p.plain, "restored, plain");
  dvi_integrator_destroy(&restored);
  destroy_pair(&p);
}
END_TEST

/* The zero is located, and the run's last step is a shorter one. */
static int first_site(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)v, (void)user;
  *g = q[0];
  return 0;
}

START_TEST(runs_with_events_are_those_of_the_plain_sweep)
{
  const dvi_event event = {.name = "first", .value = first_site};
  const dvi_run_options options = {.h = 0.1, .t_end = 7.33, .events = &event, .event_count = 1};
  dvi_run_report wave, plain;
  pair p;
  make_pair(&p, 150, 1, 2, 0, methods[_i], 2, 8);
  ck_assert_int_eq(dvi_run(p.wave, &options, &wave), DVI_OK);
  ck_assert_int_eq(dvi_run(p.plain, &options, &plain), DVI_OK);
  ck_assert_int_gt(wave.events, 0);
  ck_assert_int_eq(wave.events, plain.events);
  ck_assert_double_eq(wave.event_time, plain.event_time);
  check_same(p.wave, p.plain, "after a run");
  destroy_pair(&p);
}
END_TEST

SUITE(temporal_blocking)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, any_length_reach_and_block_has_the_bits_of_the_plain_sweep, 0,
                      METHODS);
  tcase_add_test(tests, every_instruction_set_and_thread_count_has_the_same_bits);
  tcase_add_test(tests, a_long_reach_takes_several_passes_with_the_same_bits);
  tcase_add_loop_test(tests, the_catalogues_chain_has_the_same_bits_by_both_sweeps, 0, 4);
  tcase_add_loop_test(tests, each_gradient_is_evaluated_once_and_nothing_is_allocated, 0, METHODS);
  tcase_add_loop_test(tests, traffic_is_known_of_waves_alone, 0, METHODS);
  tcase_add_loop_test(tests, a_failure_in_mid_wave_is_that_of_the_plain_sweep_and_leaves_no_trace,
                      0, METHODS * TROUBLES);
  tcase_add_loop_test(tests, a_state_that_is_not_finite_is_refused_by_both, 0, METHODS);
  tcase_add_loop_test(tests, a_last_kick_that_overflows_is_refused_by_both, 0, METHODS);
  tcase_add_loop_test(tests, a_step_can_be_taken_back, 0, METHODS);
  tcase_add_loop_test(tests, dense_output_is_that_of_the_plain_sweep, 0, METHODS);
  tcase_add_loop_test(tests, a_new_start_begins_anew, 0, METHODS);
  tcase_add_loop_test(tests, a_checkpoint_continues_bit_for_bit, 0, METHODS);
  tcase_add_loop_test(tests, runs_with_events_are_those_of_the_plain_sweep, 0, METHODS);
}
