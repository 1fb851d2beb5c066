#include "scaling/step_cost.h"

#include <math.h>

#include "support/suite.h"

static const double roundoff = 1e-10; /* of roots, powers and two nearly equal sums */

/* Boxes, cut into cubes with two layers of ghosts around them. */
static step_cost cubes(void)
{
  step_cost cost = {.dimension = 3,
                    .cells = 1e6,
                    .traffic = 300,
                    .cuts = 3,
                    .per_step = 2e-6,
                    .per_byte = 4e-11,
                    .sharing = 1.1,
                    .latency = 1.5e-6,
                    .bandwidth = 12.5e9,
                    .overhead = 1e-6,
                    .packing = 5e-11};
  for (int i = 0; i < cost.cuts; i++) {
    const double parts = pow(8, i + 1), side = 100 / cbrt(parts);
    cost.cut[i] = (mesh_cut){parts, pow(side + 2, 3), 8 * 6 * side * side, i == 0 ? 7 : 26};
  }
  return cost;
}

START_TEST(a_fit_finds_the_constants)
{
  const double bytes[] = {1e6, 3e7, 2e8, 5e4};
  double seconds[4], per_step, per_byte, deviation[4];
  for (int i = 0; i < 4; i++) seconds[i] = 3e-6 + 5e-11 * bytes[i];
  ck_assert(step_cost_fit(4, bytes, seconds, &per_step, &per_byte, deviation));
  ck_assert_double_le(fabs(per_step / 3e-6 - 1), roundoff);
  ck_assert_double_le(fabs(per_byte / 5e-11 - 1), roundoff);
  for (int i = 0; i < 4; i++) ck_assert_double_le(fabs(deviation[i]), roundoff);
}
END_TEST

START_TEST(a_fit_says_how_far_it_is_off)
{
  const double bytes[] = {1e6, 1e6, 1e6}, seconds[] = {1e-3, 1e-3, 2e-3};
  double per_step, per_byte, deviation[3];
  ck_assert(step_cost_fit(3, bytes, seconds, &per_step, &per_byte, deviation));
  ck_assert_double_eq(per_step, 0);
  /* sum (1/t) / sum (1/t^2) = (1 + 1 + 1/2)/(1 + 1 + 1/4) ms */
  ck_assert_double_le(fabs(per_byte * 1e6 - 1e-3 * 2.5 / 2.25), roundoff);
  ck_assert_double_le(fabs(deviation[0] - (2.5 / 2.25 - 1)), roundoff);
  ck_assert_double_le(fabs(deviation[2] - (2.5 / 4.5 - 1)), roundoff);
}
END_TEST

START_TEST(a_fit_has_no_negative_constant)
{
  const double bytes[] = {1e5, 1e6, 1e7}, rising[] = {1e-6, 2e-5, 3e-4},
               falling[] = {3e-4, 2e-5, 1e-6};
  double per_step, per_byte, deviation[3];
  ck_assert(step_cost_fit(3, bytes, rising, &per_step, &per_byte, deviation));
  ck_assert(per_step == 0 && per_byte > 0);
  ck_assert(step_cost_fit(3, bytes, falling, &per_step, &per_byte, deviation));
  ck_assert(per_step > 0 && per_byte == 0);
}
END_TEST

START_TEST(a_fit_refuses_nonsense)
{
  const double good[] = {1e5, 1e6}, wrong[] = {0, -1, (double)NAN, (double)INFINITY};
  double per_step = 7, per_byte = 7, deviation[2];
  ck_assert(!step_cost_fit(0, good, good, &per_step, &per_byte, deviation));
  for (int i = 0; i < 4; i++) {
    const double bad[] = {1e5, wrong[i]};
    ck_assert(!step_cost_fit(2, bad, good, &per_step, &per_byte, deviation));
    ck_assert(!step_cost_fit(2, good, bad, &per_step, &per_byte, deviation));
  }
  ck_assert(per_step == 7 && per_byte == 7);
}
END_TEST

START_TEST(a_cut_is_predicted_as_it_is)
{
  const step_cost cost = cubes();
  for (int i = 0; i < cost.cuts; i++) {
    step_prediction p;
    ck_assert(step_cost_predict(&cost, cost.cut[i].parts, cost.cells, &p));
    ck_assert_double_le(fabs(p.share / cost.cut[i].share - 1), roundoff);
    ck_assert_double_le(fabs(p.bytes / cost.cut[i].bytes - 1), roundoff);
    ck_assert_double_le(fabs(p.messages - cost.cut[i].messages), roundoff);
    ck_assert_double_le(fabs(p.compute / (1.1 * (2e-6 + 4e-11 * 300 * cost.cut[i].share)) - 1),
                        roundoff);
    ck_assert_double_le(
        fabs(p.exchange / (cost.cut[i].messages * 2.5e-6 + cost.cut[i].bytes * 1.3e-10) - 1),
        roundoff);
  }
}
END_TEST

START_TEST(cubes_of_another_mesh_and_number_are_predicted_by_geometry)
{
  const step_cost cost = cubes();
  step_prediction p;
  ck_assert(step_cost_predict(&cost, 1e5, 1e5 * 27e3, &p)); /* 30^3 boxes a rank */
  ck_assert_double_le(fabs(p.share / (32. * 32 * 32) - 1), roundoff);
  ck_assert_double_le(fabs(p.bytes / (8 * 6 * 900.) - 1), roundoff);
  ck_assert_double_eq(p.messages, 26);
}
END_TEST

START_TEST(one_rank_waits_for_nobody)
{
  step_cost cost = cubes();
  step_prediction p;
  cost.agreements = 3;
  ck_assert(step_cost_predict(&cost, 1, 1e6, &p));
  ck_assert_double_eq(p.share, 1e6);
  ck_assert_double_eq(p.exchange, 0);
  ck_assert_double_le(fabs(p.seconds / (2e-6 + 4e-11 * 300 * 1e6) - 1), roundoff);
}
END_TEST

START_TEST(an_agreement_takes_messages_in_a_row)
{
  step_cost cost = cubes();
  step_prediction without, with;
  ck_assert(step_cost_predict(&cost, 1000, 1e6, &without));
  cost.agreements = 2;
  ck_assert(step_cost_predict(&cost, 1000, 1e6, &with));
  ck_assert_double_le(fabs(with.exchange - without.exchange - 2 * 10 * 2.5e-6), roundoff * 1e-6);
}
END_TEST

START_TEST(more_cells_and_more_ranks_with_as_many_each_take_no_less_time)
{
  const step_cost cost = cubes();
  double of_rank = 0, of_cells = 0;
  for (int ranks = 1; ranks <= 100000; ranks += 1 + ranks / 3) {
    step_prediction p;
    ck_assert(step_cost_predict(&cost, ranks, ranks * 5000., &p));
    ck_assert_double_ge(p.seconds, of_rank);
    of_rank = p.seconds;
    ck_assert(step_cost_predict(&cost, 512, 512. * ranks, &p));
    ck_assert_double_gt(p.seconds, of_cells);
    of_cells = p.seconds;
  }
}
END_TEST

START_TEST(a_slower_network_takes_more_time)
{
  step_cost cost = cubes();
  step_prediction fast, slow;
  ck_assert(step_cost_predict(&cost, 4096, 1e7, &fast));
  cost.latency *= 2;
  ck_assert(step_cost_predict(&cost, 4096, 1e7, &slow));
  ck_assert_double_gt(slow.seconds, fast.seconds);
  cost.latency /= 2;
  cost.bandwidth /= 2;
  ck_assert(step_cost_predict(&cost, 4096, 1e7, &slow));
  ck_assert_double_gt(slow.seconds, fast.seconds);
}
END_TEST

START_TEST(a_share_is_never_larger_than_the_mesh)
{
  const step_cost cost = cubes();
  step_prediction p;
  ck_assert(step_cost_predict(&cost, 8, 8, &p));
  ck_assert_double_eq(p.share, 8);
  ck_assert_double_eq(p.messages, 7);
}
END_TEST

START_TEST(a_prediction_refuses_nonsense)
{
  const step_cost good = cubes();
  step_prediction p = {.seconds = 7};
  ck_assert(!step_cost_predict(&good, 0, 1e6, &p));
  ck_assert(!step_cost_predict(&good, -1, 1e6, &p));
  ck_assert(!step_cost_predict(&good, 100, 99, &p));
  ck_assert(!step_cost_predict(&good, (double)NAN, 1e6, &p));
  ck_assert(!step_cost_predict(&good, 1, (double)INFINITY, &p));
  const double wrong[] = {-1, (double)NAN, (double)INFINITY};
  for (int i = 0; i < 3; i++) {
    step_cost bad[9];
    for (int k = 0; k < 9; k++) bad[k] = good;
    bad[0].latency = bad[1].bandwidth = bad[2].per_step = bad[3].per_byte = wrong[i];
    bad[4].sharing = bad[5].cut[1].share = bad[6].traffic = bad[7].agreements = wrong[i];
    bad[8].packing = wrong[i];
    for (int k = 0; k < 9; k++) ck_assert(!step_cost_predict(bad + k, 100, 1e6, &p));
  }
  step_cost bad = good;
  bad.bandwidth = 0;
  ck_assert(!step_cost_makes_sense(&bad));
  bad = good;
  bad.cut[1].parts = bad.cut[0].parts;
  ck_assert(!step_cost_makes_sense(&bad));
  bad = good;
  bad.dimension = 4;
  ck_assert(!step_cost_makes_sense(&bad));
  bad = good;
  bad.per_step = bad.per_byte = 0;
  ck_assert(!step_cost_makes_sense(&bad));
  ck_assert_double_eq(p.seconds, 7);
}
END_TEST

SUITE(step_cost)
{
  tcase_add_test(tests, a_fit_finds_the_constants);
  tcase_add_test(tests, a_fit_says_how_far_it_is_off);
  tcase_add_test(tests, a_fit_has_no_negative_constant);
  tcase_add_test(tests, a_fit_refuses_nonsense);
  tcase_add_test(tests, a_cut_is_predicted_as_it_is);
  tcase_add_test(tests, cubes_of_another_mesh_and_number_are_predicted_by_geometry);
  tcase_add_test(tests, one_rank_waits_for_nobody);
  tcase_add_test(tests, an_agreement_takes_messages_in_a_row);
  tcase_add_test(tests, more_cells_and_more_ranks_with_as_many_each_take_no_less_time);
  tcase_add_test(tests, a_slower_network_takes_more_time);
  tcase_add_test(tests, a_share_is_never_larger_than_the_mesh);
  tcase_add_test(tests, a_prediction_refuses_nonsense);
}
