/* labels: unit */
/* Members with uniform friction are computed side by side, each with the bits of a run alone. */
#include "num/simd/lanes.h"
#include "support/friction/damped.h"
#include "integrator/ensemble/twins.h"

static const double lengths[] = {.05, .05, .05, .1, .1, -.02, .2, .7, .7, .05, .05};
enum { STEPS = sizeof lengths / sizeof *lengths };

static void compare(damped_kind kind, const char *method, int threads)
{
  damped model;
  make_damped(kind, 0.3, &model);
  const twins all = {.system = model.system,
                     .method = method,
                     .nq = model.nq,
                     .nv = model.nv,
                     .q = model.q,
                     .v = model.v,
                     .steps = STEPS,
                     .length = lengths};
  (void)compare_members(&all, threads);
  destroy_damped(&model);
}

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
}

typedef struct damped_run {
  damped_kind kind;
  const char *method;
} damped_run;

static const damped_run runs[] = {
    {DAMPED_OSCILLATOR, "verlet"},
    {DAMPED_PLANE, "verlet"},
    {DAMPED_PLANE, "composition:order=4,base=verlet"},
    {DAMPED_PLANE, "midpoint:solver=fixed-point"},
    {DAMPED_PLANE, "galerkin:degree=8,solver=fixed-point"},
    {DAMPED_PLANE, "composition:order=4,base=trapezoidal,solver=fixed-point"},
    {DAMPED_TOP, "lie-verlet"},
    {DAMPED_FREE_TOP, "composition:order=4,base=lie-verlet"},
};
enum { RUNS = sizeof runs / sizeof *runs };

START_TEST(members_have_the_bits_of_runs_alone)
{
  compare(runs[_i].kind, runs[_i].method, 1 + _i % 4);
}
END_TEST

START_TEST(every_level_gives_these_bits)
{
  dvi__lanes_choose(_i / RUNS);
  compare(runs[_i % RUNS].kind, runs[_i % RUNS].method, 1);
}
END_TEST

SUITE(ensemble_damped)
{
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_add_loop_test(tests, members_have_the_bits_of_runs_alone, 0, RUNS);
  tcase_add_loop_test(tests, every_level_gives_these_bits, 0, RUNS * dvi__lanes_levels());
}
