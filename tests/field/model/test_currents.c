/* Currents: methods of mechanics and leapfrog approach the same motion, which IDA judges, and they
 * fail as their callbacks do. */
#include <dvi/integrator.h>
#include <dvi/reference.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/electric.h"
#include "support/suite.h"

static const dvi_wall wall[] = {{.part = "left", .kind = DVI_PEC},
                                {.part = "right", .kind = DVI_ABSORBING}};

static int swing(double t, double *value, void *user)
{
  (void)user;
  *value = cos(4 * t) * (1 + t);
  return 0;
}

/* The integral of cos(4 t) (1 + t). */
static double swung(double t)
{
  return (1 + t) * sin(4 * t) / 4 + cos(4 * t) / 16;
}

static int impulse(double from, double to, double *value, void *user)
{
  (void)user;
  *value = swung(to) - swung(from);
  return 0;
}

static int density(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = sin(x[1]);
  value[1] = x[0] * x[1];
  return 0;
}

static int shape(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = cos(x[0]);
  value[1] = sin(2 * x[0]) * x[1];
  return 0;
}

/* Triangles with both kinds of currents, losses if asked for, and a start. */
typedef struct driven {
  dvi_field *field;
  dvi_system *system;
  int64_t edges, unknowns;
  double *E, *q, *p; /* the start */
} driven;

static driven make_driven(dvi_star_kind kind, int has_losses, int has_impulse)
{
  driven d = {.field = NULL};
  const dvi_current current[] = {
      {.density = density, .signal = swing, .impulse = has_impulse ? impulse : NULL},
      {.at = {0.43, 0.37}, .along = {1, -0.5}, .signal = swing}};
  dvi_mesh *mesh = generated("staggered", (dvi_generator_options){.cells = {5, 5}});
  const int64_t cells = dvi_mesh_count(mesh, 2);
  double *sigma = calloc((size_t)cells, sizeof *sigma);
  for (int64_t c = 0; c < cells; c++) sigma[c] = 0.2 * (double)(c % 3);
  d.field = electric(mesh, kind, NULL,
                     (dvi_maxwell_terms){.wall = wall,
                                         .walls = has_losses ? 2 : 1,
                                         .conductivity = has_losses ? sigma : NULL,
                                         .current = current,
                                         .currents = 2});
  free(sigma);
  d.edges = dvi_mesh_count(dvi_star_mesh(dvi_field_star(d.field)), 1);
  (void)dvi_field_unknowns(d.field, &d.unknowns);
  ck_assert_msg(dvi_field_system(d.field, &d.system) == DVI_OK, "%s", dvi_last_error());
  d.E = form_of(d.field, 1, shape);
  d.q = calloc(2 * (size_t)d.unknowns, sizeof *d.q);
  d.p = d.q + d.unknowns;
  ck_assert(dvi_field_project(d.field, NULL, d.E, NULL, d.p) == DVI_OK);
  for (int64_t i = 0; i < d.unknowns; i++) d.p[i] = -d.p[i];
  return d;
}

static void end_driven(driven *d)
{
  dvi_system_destroy(&d->system);
  dvi_field_destroy(&d->field);
  free(d->E);
  free(d->q);
}

static double *end_by_judge(const driven *d, double t)
{
  double *q = malloc(2 * (size_t)d->unknowns * sizeof *q);
  dvi_reference_report report;
  memcpy(q, d->q, 2 * (size_t)d->unknowns * sizeof *q);
  ck_assert_msg(dvi_reference_judge(d->system, 0, t, q, q + d->unknowns, NULL, &report) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_msg(report.error < 1e-8, "IDA: %g", report.error);
  return q;
}

/* Return the largest error of q = A after `steps`. */
static double error_of_method(const driven *d, const char *method, double t, int steps,
                              const double *judge)
{
  dvi_integrator *integrator = NULL;
  double worst = 0;
  ck_assert_msg(dvi_integrator_create(d->system, method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert(dvi_integrator_start(integrator, 0, d->q, d->p) == DVI_OK);
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, t / steps) == DVI_OK, "%s", dvi_last_error());
  for (int64_t i = 0; i < d->unknowns; i++)
    worst = fmax(worst, fabs(dvi_integrator_q(integrator)[i] - judge[i]));
  dvi_integrator_destroy(&integrator);
  return worst;
}

/* Return that of a march, which keeps A. */
static double error_of_march(const driven *d, const char *method, double t, int steps,
                             const double *judge)
{
  double *A = malloc((size_t)d->edges * sizeof *A), worst = 0;
  const int *unknown = dvi_field_unknowns(d->field, NULL);
  const dvi_march_options how = {.method = method, .step = t / steps, .potential = 1};
  dvi_march *march = march_of(d->field, how, d->E, NULL);
  advance_march(march, t);
  ck_assert_msg(dvi_march_sample(march, DVI_FORM_A, 0, NULL, A) == DVI_OK, "%s", dvi_last_error());
  for (int64_t i = 0; i < d->unknowns; i++) worst = fmax(worst, fabs(A[unknown[i]] - judge[i]));
  dvi_march_destroy(&march);
  free(A);
  return worst;
}

static void check_order(const char *method, const double *error)
{
  for (int i = 1; i < 4; i++)
    ck_assert_msg(fabs(log2(error[i - 1] / error[i]) - 2) < 0.1, "%s: %g, %g, %g, %g", method,
                  error[0], error[1], error[2], error[3]);
}

START_TEST(leapfrog_and_verlet_approach_the_motion_with_second_order)
{
  static const dvi_star_kind kind[] = {DVI_CIRCUMCENTRIC, DVI_WHITNEY};
  const double t = 0.8;
  for (int i = 0; i < 4; i++) {
    driven d = make_driven(kind[i / 2], i % 2, i % 2);
    double *judge = end_by_judge(&d, t), by_leapfrog[4], by_verlet[4];
    for (int level = 0; level < 4; level++) {
      by_leapfrog[level] = error_of_march(&d, "leapfrog", t, 40 << level, judge);
      by_verlet[level] = error_of_method(&d, "verlet", t, 40 << level, judge);
    }
    check_order("leapfrog", by_leapfrog);
    check_order("verlet", by_verlet);
    free(judge);
    end_driven(&d);
  }
}
END_TEST

/* Without a signal's integral the two are one method: the impulse of a step is that of its middle,
 * where verlet kicks. */
START_TEST(leapfrog_is_verlet)
{
  driven d = make_driven(DVI_CIRCUMCENTRIC, 0, 0);
  double *q = calloc((size_t)d.unknowns, sizeof *q);
  const double size = error_of_march(&d, "leapfrog", 0.8, 40, q);
  dvi_integrator *integrator = NULL;
  ck_assert(dvi_integrator_create(d.system, "verlet", &integrator) == DVI_OK);
  ck_assert(dvi_integrator_start(integrator, 0, d.q, d.p) == DVI_OK);
  for (int i = 0; i < 40; i++) ck_assert(dvi_integrator_step(integrator, 0.02) == DVI_OK);
  memcpy(q, dvi_integrator_q(integrator), (size_t)d.unknowns * sizeof *q);
  ck_assert_double_gt(size, 0.01);
  ck_assert_double_lt(error_of_march(&d, "leapfrog", 0.8, 40, q), 1e-13);
  dvi_integrator_destroy(&integrator);
  free(q);
  end_driven(&d);
}
END_TEST

/* ---- signals that fail ---- */

/* A signal that fails from the time *user on, or is not finite if that is negative. */
static int breaks(double t, double *value, void *user)
{
  const double end = *(const double *)user;
  *value = t >= fabs(end) && end < 0 ? (double)NAN : 1;
  return t >= fabs(end) && end > 0 ? 7 : 0;
}

START_TEST(signals_that_fail_stop_a_march_at_the_last_good_time)
{
  static const char *const marches[] = {"leapfrog", "avi"};
  for (int i = 0; i < 4; i++) {
    double end = i % 2 ? 0.5 : -0.5;
    const dvi_current current = {
        .at = {0.43, 0.37}, .along = {1, 0}, .signal = breaks, .user = &end};
    dvi_field *field = electric(generated("staggered", (dvi_generator_options){.cells = {5, 5}}),
                                DVI_CIRCUMCENTRIC, NULL,
                                (dvi_maxwell_terms){.current = &current, .currents = 1});
    dvi_march *march = march_of(field, (dvi_march_options){.method = marches[i / 2]}, NULL, NULL);
    ck_assert_int_eq(dvi_march_advance(march, 2), i % 2 ? DVI_CALLBACK_FAILED : DVI_NOT_FINITE);
    check_words("current 0");
    const double stands = dvi_march_time(march);
    ck_assert_msg(stands > 0.3 && stands <= 0.5 + 1e-9, "%s: %g", marches[i / 2], stands);
    /* it stays usable, and goes on once the signal is there again */
    ck_assert(isfinite(observe_march(march, "energy")));
    end = 1e9;
    advance_march(march, 2);
    ck_assert_double_eq(dvi_march_time(march), 2);
    dvi_march_destroy(&march);
    dvi_field_destroy(&field);
  }
}
END_TEST

START_TEST(a_signal_that_fails_at_the_start_leaves_leapfrog_as_it_was)
{
  double end = 1e9;
  const dvi_current current = {.at = {0.43, 0.37}, .along = {1, 0}, .signal = breaks, .user = &end};
  dvi_field *field = electric(generated("staggered", (dvi_generator_options){.cells = {5, 5}}),
                              DVI_CIRCUMCENTRIC, NULL,
                              (dvi_maxwell_terms){.current = &current, .currents = 1});
  dvi_march *march = march_of(field, (dvi_march_options){.fraction = 0.5}, NULL, NULL);
  advance_march(march, 0.4);
  const double energy = observe_march(march, "energy");
  const dvi_march_state state = {.size = sizeof state, .t = 3};
  end = 1;
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_CALLBACK_FAILED);
  ck_assert_double_eq(dvi_march_time(march), 0.4);
  ck_assert_double_eq(observe_march(march, "energy"), energy);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

SUITE(currents)
{
  tcase_add_test(tests, leapfrog_and_verlet_approach_the_motion_with_second_order);
  tcase_add_test(tests, leapfrog_is_verlet);
  tcase_add_test(tests, signals_that_fail_stop_a_march_at_the_last_good_time);
  tcase_add_test(tests, a_signal_that_fails_at_the_start_leaves_leapfrog_as_it_was);
}
