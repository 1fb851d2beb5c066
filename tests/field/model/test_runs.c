/* Fields as systems like any other: every method, saved states, ensembles, other pacings. */
#include <dvi/ensemble.h>
#include <dvi/field.h>
#include <dvi/integrator.h>
#include <dvi/transform.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static const char *const methods[] = {"verlet",
                                      "galerkin:degree=1",
                                      "galerkin:degree=2",
                                      "galerkin:degree=3",
                                      "midpoint",
                                      "galerkin:degree=4",
                                      "trapezoidal",
                                      "composition:order=4",
                                      "imex",
                                      "trig",
                                      "respa:substeps=4",
                                      "mollified",
                                      "multiscale:omega=11",
                                      "composition:base=midpoint",
                                      "hp:degree=2"};
enum { METHODS = sizeof methods / sizeof *methods, MEMBERS = 3, STEPS = 12 };

static const double step = 0.01;

static int quartic(int64_t count, const double *x, const double *u, double *V, double *V_u,
                   double *V_uu, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) {
    if (V != NULL) V[i] = pow(u[i], 4) / 4;
    if (V_u != NULL) V_u[i] = pow(u[i], 3);
    if (V_uu != NULL) V_uu[i] = 3 * pow(u[i], 2);
  }
  return 0;
}

/* A nonlinear wave on a clamped sheet, and as many starts as members. */
typedef struct sheet {
  dvi_mesh *mesh;
  dvi_field *field;
  dvi_system *system;
  int n;
  double *q, *p; /* [MEMBERS][n] */
} sheet;

static sheet make_sheet(void)
{
  static const dvi_condition fixed = {.part = "boundary", .kind = DVI_FIXED};
  static const dvi_field_potential potential = {.density = quartic};
  sheet s = {.mesh = staggered_mesh(5, 4)};
  dvi_star *star = NULL;
  unsigned long long seed = 4;
  ck_assert_int_eq(dvi_star_create(s.mesh, NULL, &star), DVI_OK);
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = &fixed,
                                .conditions = 1,
                                .potential = &potential};
  ck_assert_int_eq(dvi_wave_create(&terms, &s.field), DVI_OK);
  ck_assert_int_eq(dvi_field_system(s.field, &s.system), DVI_OK);
  dvi_star_destroy(&star);
  s.n = dvi_system_nq(s.system);
  s.q = calloc(2 * MEMBERS * (size_t)s.n, sizeof *s.q);
  s.p = s.q + MEMBERS * s.n;
  for (int i = 0; i < MEMBERS * s.n; i++) {
    s.q[i] = random_number(&seed) - 0.5;
    s.p[i] = 0.05 * (random_number(&seed) - 0.5);
  }
  return s;
}

static void end_sheet(sheet *s)
{
  dvi_system_destroy(&s->system);
  dvi_field_destroy(&s->field);
  dvi_mesh_destroy(&s->mesh);
  free(s->q);
}

static dvi_integrator *start(const sheet *s, const char *method, int member)
{
  dvi_integrator *integrator = NULL;
  ck_assert_msg(dvi_integrator_create(s->system, method, &integrator) == DVI_OK, "%s: %s", method,
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, s->q + member * s->n, s->p + member * s->n),
                   DVI_OK);
  return integrator;
}

static void advance(dvi_integrator *integrator, double h, int steps)
{
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s", dvi_last_error());
}

/* A saved state goes on with the same bits. */
START_TEST(restored_waves_go_on_with_the_same_bits)
{
  sheet s = make_sheet();
  for (int m = 0; m < METHODS; m++) {
    dvi_integrator *whole = start(&s, methods[m], 0), *late = start(&s, methods[m], 1);
    size_t size;
    advance(whole, step, STEPS);
    (void)dvi_integrator_save_memory(whole, NULL, 0, &size);
    void *bytes = malloc(size);
    ck_assert_int_eq(dvi_integrator_save_memory(whole, bytes, size, &size), DVI_OK);
    ck_assert_int_eq(dvi_integrator_restore_memory(late, bytes, size), DVI_OK);
    advance(whole, step, STEPS);
    advance(late, step, STEPS);
    ck_assert_msg(
        memcmp(dvi_integrator_q(whole), dvi_integrator_q(late), (size_t)s.n * sizeof(double)) == 0,
        "%s", methods[m]);
    free(bytes);
    dvi_integrator_destroy(&whole);
    dvi_integrator_destroy(&late);
  }
  end_sheet(&s);
}
END_TEST

START_TEST(members_of_ensembles_have_the_bits_of_single_waves)
{
  sheet s = make_sheet();
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = 2};
  double *q = calloc(3 * MEMBERS * (size_t)s.n, sizeof *q), *p = q + MEMBERS * s.n,
         *last = p + MEMBERS * s.n;
  for (int i = 0; i < s.n; i++)
    for (int k = 0; k < MEMBERS; k++) {
      q[i * MEMBERS + k] = s.q[k * s.n + i];
      p[i * MEMBERS + k] = s.p[k * s.n + i];
    }
  for (int m = 0; m < METHODS; m++) {
    dvi_ensemble *ensemble = NULL;
    ck_assert_msg(dvi_ensemble_create(s.system, methods[m], &options, &ensemble) == DVI_OK,
                  "%s: %s", methods[m], dvi_last_error());
    ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, q, p), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_advance(ensemble, step, STEPS), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_state(ensemble, NULL, last, NULL), DVI_OK);
    for (int k = 0; k < MEMBERS; k++) {
      dvi_integrator *single = start(&s, methods[m], k);
      advance(single, step, STEPS);
      for (int i = 0; i < s.n; i++)
        ck_assert_msg(dvi_integrator_q(single)[i] == last[i * MEMBERS + k], "%s, member %d",
                      methods[m], k);
      dvi_integrator_destroy(&single);
    }
    dvi_ensemble_destroy(&ensemble);
  }
  free(q);
  end_sheet(&s);
}
END_TEST

/* All methods follow one motion. */
START_TEST(methods_agree)
{
  sheet s = make_sheet();
  dvi_integrator *judge = start(&s, "galerkin:degree=8", 0);
  advance(judge, step, STEPS);
  for (int m = 0; m < METHODS; m++) {
    dvi_integrator *integrator = start(&s, methods[m], 0);
    advance(integrator, step / 8, 8 * STEPS);
    for (int i = 0; i < s.n; i++)
      ck_assert_msg(fabs(dvi_integrator_q(integrator)[i] - dvi_integrator_q(judge)[i]) < 2e-3,
                    "%s: %g, %g", methods[m], dvi_integrator_q(integrator)[i],
                    dvi_integrator_q(judge)[i]);
    dvi_integrator_destroy(&integrator);
  }
  dvi_integrator_destroy(&judge);
  end_sheet(&s);
}
END_TEST

/* ---- other pacings ---- */

/* Make an integrator in the time of the arc length, take steps, and give the largest error of the
 * energy, of its size. */
static double energy_error(const sheet *s, const char *method, dvi_pacing pacing, double h)
{
  const dvi_monitor monitor = {.kind = DVI_MONITOR_ARCLENGTH};
  const dvi_integrator_options options = {
      .size = sizeof options, .method = method, .pacing = pacing, .monitor = &monitor};
  dvi_integrator *integrator = NULL;
  double first, now, worst = 0;
  ck_assert_msg(dvi_integrator_create_with(s->system, &options, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, s->q, s->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
  while (dvi_integrator_time(integrator) < 0.1) {
    advance(integrator, h, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &now), DVI_OK);
    worst = fmax(worst, fabs(now - first) / first);
  }
  dvi_integrator_destroy(&integrator);
  return worst;
}

START_TEST(waves_run_in_other_times)
{
  sheet s = make_sheet();
  const double transformed = energy_error(&s, "galerkin:degree=2", DVI_TIME_TRANSFORM, 0.1),
               controlled = energy_error(&s, "verlet", DVI_STEP_CONTROL, 0.02);
  ck_assert_msg(transformed < 1e-4, "%g", transformed);
  ck_assert_msg(controlled < 1e-2, "%g", controlled);
  end_sheet(&s);
}
END_TEST

SUITE(runs)
{
  tcase_add_test(tests, restored_waves_go_on_with_the_same_bits);
  tcase_add_test(tests, members_of_ensembles_have_the_bits_of_single_waves);
  tcase_add_test(tests, methods_agree);
  tcase_add_test(tests, waves_run_in_other_times);
}
