/* labels: invariant long */
/* The norm over a million steps. */
#include <math.h>

#include "support/field/marches.h"
#include "support/field/schroedinger.h"
#include "support/suite.h"

static double drift(const char *kind, int periodic, const char *method)
{
  const int steps = repeats(1000000);
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
  ck_assert(drift("fem:degree=6,cells=20", 0, "midpoint") < 1e-12);
  ck_assert(drift("fem:degree=6,cells=20,lumped=yes", 0, "split") < 1e-12);
}
END_TEST

/* Neither do those of phases. */
START_TEST(phases_keep_the_norm_to_roundoff)
{
  ck_assert(drift("fourier:modes=30,points=61", 1, "split") < 1e-12);
}
END_TEST

/* What an iteration has not reached when it stops would add up. */
START_TEST(iterations_keep_the_norm_to_roundoff)
{
  ck_assert(drift("fourier:modes=10,points=21", 1, "midpoint") < 5e-13);
  ck_assert(drift("fourier:modes=10,points=21", 1, "gauss:stages=2") < 5e-13);
}
END_TEST

SUITE(schroedinger_long)
{
  tcase_add_test(tests, elements_keep_the_norm_to_roundoff);
  tcase_add_test(tests, phases_keep_the_norm_to_roundoff);
  tcase_add_test(tests, iterations_keep_the_norm_to_roundoff);
}
