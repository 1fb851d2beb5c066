/* labels: invariant slow long */
/* The norm and the energy over a million steps. */
#include <math.h>

#include "support/field/marches.h"
#include "support/field/schroedinger.h"
#include "support/suite.h"

static double drift(const char *kind, int periodic, const char *method, int steps)
{
  quantum q = quantum_on_line(kind, -8, 8, periodic, harmonic, 0);
  dvi_march *march = quantum_march(&q, method, 0.05);
  const double start[] = {1, 0};
  start_wave(march, &q, packet, start);
  const double norm = observe_march(march, "norm");
  advance_march(march, 0.05 * steps);
  const double change = fabs(observe_march(march, "norm") / norm - 1);
  dvi_march_destroy(&march);
  free_quantum(&q);
  return change;
}

/* Roundings of factors are corrected and do not add up. */
START_TEST(elements_keep_the_norm_to_roundoff)
{
  ck_assert(drift("fem:degree=6,cells=20", 0, "midpoint", repeats(1000000)) < 1e-12);
  ck_assert(drift("fem:degree=6,cells=20,lumped=yes", 0, "split", repeats(1000000)) < 1e-12);
}
END_TEST

/* Neither do those of phases. */
START_TEST(phases_keep_the_norm_to_roundoff)
{
  ck_assert(drift("fourier:modes=30,points=61", 1, "split", repeats(1000000)) < 1e-12);
}
END_TEST

/* What an iteration has not reached when it stops would add up. */
START_TEST(iterations_keep_the_norm_to_roundoff)
{
  const char *const kind = "fourier:modes=10,points=21";
  const int steps = repeats(200000);
  ck_assert(drift(kind, 1, "midpoint", steps) < 1e-13);
  ck_assert(drift(kind, 1, "gauss:stages=2", steps) < 1e-13);
}
END_TEST

/* The largest distance of the energy from its start in some steps, looked at after each tenth. */
static double most_change(dvi_march *march, double step, int from, int to, double start)
{
  double most = 0;
  for (int i = from; i < to; i += 10) {
    advance_march(march, i * step);
    most = fmax(most, fabs(observe_march(march, "energy") - start));
  }
  return most;
}

/* A packet that attracts itself swings in a well. Its steps are an eighth of the bound. */
START_TEST(energies_of_split_steps_swing_and_do_not_drift)
{
  const int steps = repeats(1000000);
  const double step = 0.02, place[] = {1, 0};
  quantum q = quantum_on_line("fourier:modes=16,points=33", -8, 8, 1, harmonic, -2);
  dvi_march *march = quantum_march(&q, _i == 0 ? "split" : "split:order=4", step);
  start_wave(march, &q, packet, place);
  const double start = observe_march(march, "energy"),
               first = most_change(march, step, 0, steps / 10, start),
               last = most_change(march, step, steps - steps / 10, steps, start);
  ck_assert_double_lt(first, (_i == 0 ? 1e-3 : 1e-5) * fabs(start));
  ck_assert_double_lt(last, 1.5 * first);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

SUITE(schroedinger_long)
{
  tcase_add_test(tests, elements_keep_the_norm_to_roundoff);
  tcase_add_test(tests, phases_keep_the_norm_to_roundoff);
  tcase_add_test(tests, iterations_keep_the_norm_to_roundoff);
  tcase_add_loop_test(tests, energies_of_split_steps_swing_and_do_not_drift, 0, 2);
}
