/* labels: unit */
/* Temporal blocking has the bits of plain passes over all sites, for any length, reach, block, cut
 * and instruction set, and when something fails. */
#include <string.h>

#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"
#include "blocking_pair.h"

enum { POTENTIALS = 2, MASSES = 5 };

/* ---- bits ---- */

START_TEST(any_length_reach_and_block_has_the_bits_of_the_plain_sweep)
{
  static const int lengths[] = {1, 2, 3, 5, 8, 13, 31, 64, 65, 130, 333, 1000, 2777},
                   blocks[] = {1, 7, 0, 16, 64, 3};
  int turn = 0;
  for (int reach = 0; reach <= 5; reach++)
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++, turn++) {
      pair p;
      make_pair(&p, lengths[k], reach, 1 + turn % POTENTIALS, turn % MASSES, method_of(_i),
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
        make_pair(&p, LENGTH, 2, 2, threads, method_of(method), threads, 0);
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
  make_pair(&p, 40000, 0, 1, 0, method_of(STEPPERS * _i + 2), 2, 0);
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
    dvi__blocking_choose_long_chain(threads - 1);
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
    make_pair(&p, LENGTH, 1, 1, 0, method_of(_i), threads, BLOCK);
    step_both(&p, 0.05);
    dvi_integrator_counters(p.wave, &before);
    p.lattice.entries = p.lattice.ranges = 0;
    advance(p.wave, 0.05, 10);
    dvi_integrator_counters(p.wave, &after);
    /* none twice, on any thread */
    ck_assert_int_eq(p.lattice.entries, 10L * LENGTH * substeps[_i % STEPPERS]);
    ck_assert_int_eq(after.gradients - before.gradients, 10 * substeps[_i % STEPPERS]);
    ck_assert_int_eq(after.allocations - before.allocations, 0);
    /* whole blocks, but for the ends of the chain and of each thread's part; those of windows are
     * short where there are few substeps */
    const int count = substeps[_i % STEPPERS];
    const int block = _i < STEPPERS || 64 * count > BLOCK ? BLOCK : 64 * count;
    ck_assert_int_le(p.lattice.ranges, 10L * count * (LENGTH / block + 1 + 3 * threads));
    destroy_pair(&p);
  }
}
END_TEST

/* Five arrays move from one place to another. They are read, fetched and written, or stored past
 * the caches. */
START_TEST(traffic_is_known_of_waves_alone)
{
  pair p;
  make_pair(&p, 1000, 1, 1, 0, method_of(_i), 1, 0);
  ck_assert_double_eq(dvi_integrator_traffic(p.wave), (_i < STEPPERS ? 15 : 10) * 8 * 1000);
  ck_assert_double_eq(dvi_integrator_traffic(p.plain), 0);
  ck_assert_double_eq(dvi_integrator_traffic(NULL), 0);
  destroy_pair(&p);
}
END_TEST

SUITE(temporal_blocking)
{
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, any_length_reach_and_block_has_the_bits_of_the_plain_sweep, 0,
                      METHODS);
  tcase_add_test(tests, every_instruction_set_and_thread_count_has_the_same_bits);
  tcase_add_loop_test(tests, a_long_reach_takes_several_passes_with_the_same_bits, 0, 2);
  tcase_add_loop_test(tests, the_catalogues_chain_has_the_same_bits_by_both_sweeps, 0, 4);
  tcase_add_loop_test(tests, each_gradient_is_evaluated_once_and_nothing_is_allocated, 0, METHODS);
  tcase_add_loop_test(tests, traffic_is_known_of_waves_alone, 0, METHODS);
}
