/* labels: unit */
/* Verlet's method and its compositions take at most twelve numbers of memory for each coordinate:
 * three of q and p, two of their compensations, and two of the forces, at the present state, before
 * the last step and after the next one. All else is made when it is first asked for. */
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

enum { COORDINATES = 8000, MOST = 12, SOME_BYTES = 16384 };

static const char *const methods[] = {
    "verlet",
    "verlet:blocking=none",
    "composition:order=4,base=verlet",
    "composition:order=8,base=verlet",
    "composition:order=8,base=verlet,blocking=none",
};
enum { METHODS = sizeof methods / sizeof *methods };

/* Bytes for each coordinate, less what does not grow with their number. */
static double bytes_for_each(long bytes)
{
  return (double)(bytes - SOME_BYTES) / COORDINATES;
}

START_TEST(explicit_methods_take_twelve_numbers_a_coordinate)
{
  if (!heap_is_counted()) return;
  problem *model = create_problem("chain", "n=8000");
  const long before = heap_bytes();
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  advance(integrator, 0.1, 3);
  const double taken = bytes_for_each(heap_bytes() - before);
  ck_assert_msg(taken <= MOST * sizeof(double), "%s: %g bytes a coordinate", methods[_i], taken);
  dvi_integrator_destroy(&integrator);
  ck_assert_int_eq(heap_bytes(), before);
  problem_destroy(&model);
}
END_TEST

/* Velocities, at both ends of the step. */
START_TEST(dense_output_takes_two_more_when_it_is_asked_for)
{
  static double q[COORDINATES], v[COORDINATES];
  if (!heap_is_counted()) return;
  problem *model = create_problem("chain", "n=8000");
  dvi_integrator *integrator = start_integrator(model, "verlet");
  advance(integrator, 0.1, 2);
  const long before = heap_bytes();
  for (int i = 0; i < 2; i++) {
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.15, q, v), DVI_OK);
    const double taken = (double)(heap_bytes() - before) / COORDINATES;
    ck_assert(taken >= 2 * sizeof(double) && taken < 2.1 * sizeof(double));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(memory)
{
  tcase_add_loop_test(tests, explicit_methods_take_twelve_numbers_a_coordinate, 0, METHODS);
  tcase_add_test(tests, dense_output_takes_two_more_when_it_is_asked_for);
}
