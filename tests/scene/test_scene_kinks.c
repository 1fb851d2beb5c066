/* labels: order */
/* A kink of which the m-th derivative of the potential is the first that jumps leaves the order
 * m to a method of higher order, as docs/scenes.md says and dvi_scene_kink tells. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/suite.h"

enum { LEVELS = 4, RUNS = 10 };

static const double x_start = 0.7, t_end = 10;

/* x and p at the end. */
static void follow(const char *potential, int steps, double *end)
{
  char text[512], message[512];
  dvi_scene *scene = NULL;
  dvi_integrator *integrator = NULL;
  (void)snprintf(text, sizeof text,
                 "coordinates: {x: scalar}\nlagrangian: x'^2/2 - (%s)\ninitial: {x: 0.7}\nstep: "
                 "0.1\nuntil: 1\n",
                 potential);
  ck_assert_msg(dvi_scene_parse("k.yaml", text, strlen(text), 0, NULL, &scene, message,
                                sizeof message) == DVI_OK,
                "%s", message);
  ck_assert_int_eq(dvi_integrator_create(dvi_scene_system(scene), "galerkin:degree=2", &integrator),
                   DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &x_start, &(double){0}), DVI_OK);
  ck_assert_int_eq(
      dvi_run(integrator, &(dvi_run_options){.h = t_end / steps, .t_end = t_end}, NULL), DVI_OK);
  end[0] = dvi_integrator_q(integrator)[0];
  end[1] = dvi_integrator_p(integrator)[0];
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
}

/* Gives the largest error of some runs with about as many steps, because the place of the kink in a
 * step differs from run to run. */
static double largest_error(const char *potential, int steps, const double *exact)
{
  double largest = 0;
  for (int k = 0; k < RUNS; k++) {
    double end[2];
    follow(potential, (int)(steps * (1 + 0.02 * k)) + k % 3, end);
    largest = fmax(largest, fabs(end[0] - exact[0]) + fabs(end[1] - exact[1]));
  }
  return largest;
}

/* Single slopes scatter with the phase of the kink in a step, hence the tolerance 0.4 for the mean
 * of three. */
static void check_order(const char *potential, const double *exact, double order)
{
  const double first = largest_error(potential, 100, exact),
               last = largest_error(potential, 100 << (LEVELS - 1), exact);
  const double slope = log2(first / last) / (LEVELS - 1);
  ck_assert_msg(fabs(slope - order) < 0.4, "%s: slope %.2f instead of %g, from %.1e to %.1e",
                potential, slope, order, first, last);
}

/* Parabolas, to and fro. */
START_TEST(a_jump_of_the_force_leaves_order_1)
{
  const double quarter = sqrt(2 * x_start), s = fmod(t_end, 4 * quarter);
  ck_assert(s < quarter); /* on the side of the start at the end, after two periods */
  check_order("abs(x)", (double[]){x_start - s * s / 2, -s}, 1);
}
END_TEST

/* Half an oscillation of frequency 2, and half of one of frequency 1. */
START_TEST(a_kink_of_the_force_leaves_order_2)
{
  const double pi = 3.14159265358979323846, s = fmod(t_end, 1.5 * pi);
  ck_assert(s < pi / 4); /* on the side of the start at the end, after two periods */
  check_order("x^2/2 + 3/2*max(x, 0)^2",
              (double[]){x_start * cos(2 * s), -2 * x_start * sin(2 * s)}, 2);
}
END_TEST

/* Against much shorter steps, whose errors are 1e-6 of those that are measured. */
START_TEST(jumps_of_higher_derivatives_leave_more)
{
  double fine[2];
  follow("x^2/2 + 2*max(x, 0)^3", 100000, fine);
  check_order("x^2/2 + 2*max(x, 0)^3", fine, 3);
  follow("x^2/2 + 2*max(x, 0)^4", 50000, fine);
  check_order("x^2/2 + 2*max(x, 0)^4", fine, 4);
}
END_TEST

SUITE(scene_kinks)
{
  tcase_set_timeout(tests, 60);
  tcase_add_test(tests, a_jump_of_the_force_leaves_order_1);
  tcase_add_test(tests, a_kink_of_the_force_leaves_order_2);
  tcase_add_test(tests, jumps_of_higher_derivatives_leave_more);
}
