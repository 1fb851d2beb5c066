/* Fields with densities as systems like any other: methods, threads, three dimensions. */
#include <dvi/ensemble.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/densities.h"
#include "support/runs.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static const char *const kinds[] = {"fem:degree=2,cells=6,lumped=yes", "fem:degree=2,cells=6",
                                    "spline:degree=3,cells=9", "fourier:modes=4,points=20"};
static const char *const methods[] = {"verlet",
                                      "galerkin:degree=1",
                                      "galerkin:degree=3",
                                      "midpoint",
                                      "trapezoidal",
                                      "composition:order=4",
                                      "imex",
                                      "trig",
                                      "respa:substeps=4",
                                      "mollified",
                                      "composition:base=midpoint",
                                      "hp:degree=2"};
enum { KINDS = 4, METHODS = sizeof methods / sizeof *methods, MEMBERS = 4 };

static density_field pendula(const char *kind)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  density_field field = make_density(make_density_space(kind, 1, 0, 2 * pi, 1), parts, 3, NULL, 0);
  set_density(&field, pendula_start, pendula_rate, NULL);
  return field;
}

/* The bound is the error of the methods of order 2 with steps of 1/200 over a time of 1/2. */
START_TEST(methods_agree)
{
  for (int i = 0; i < KINDS; i++) {
    density_field field = pendula(kinds[i]);
    double *judged = calloc((size_t)field.n, sizeof *judged);
    run_density(&field, "galerkin:degree=6", 0, 0.05, 10);
    memcpy(judged, field.q, (size_t)field.n * sizeof *judged);
    for (int m = 0; m < METHODS; m++) {
      memset(field.U, 0, (size_t)field.places * sizeof *field.U);
      set_density(&field, pendula_start, pendula_rate, NULL);
      run_density(&field, methods[m], 0, 0.005, 100);
      const double error = distance((int)field.n, field.q, judged);
      ck_assert_msg(error < 2e-5, "%s on %s: %g", methods[m], kinds[i], error);
    }
    free(judged);
    end_density(&field);
  }
}
END_TEST

/* Several threads evaluate one field at a time, with the bits of one thread. */
START_TEST(threads_share_a_field)
{
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = 2};
  for (int i = 0; i < KINDS; i++) {
    density_field field = pendula(kinds[i]);
    const int n = (int)field.n;
    dvi_ensemble *ensemble = create_ensemble(field.system, "galerkin:degree=2", options);
    double *q = calloc(3 * MEMBERS * (size_t)n, sizeof *q), *p = q + n * MEMBERS,
           *last = p + n * MEMBERS;
    for (int e = 0; e < n * MEMBERS; e++) {
      q[e] = field.q[e / MEMBERS] * (1 + 0.1 * (e % MEMBERS));
      p[e] = field.p[e / MEMBERS];
    }
    ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, q, p), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.05, 5), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_state(ensemble, NULL, last, NULL), DVI_OK);
    for (int k = 0; k < MEMBERS; k++) {
      for (int j = 0; j < n; j++) field.q[j] = q[j * MEMBERS + k];
      for (int j = 0; j < n; j++) field.p[j] = p[j * MEMBERS + k];
      run_density(&field, "galerkin:degree=2", 0, 0.05, 5);
      for (int j = 0; j < n; j++)
        ck_assert_msg(field.q[j] == last[j * MEMBERS + k], "%s, member %d", kinds[i], k);
    }
    dvi_ensemble_destroy(&ensemble);
    free(q);
    end_density(&field);
  }
}
END_TEST

/* verlet takes a chain through memory in ranges, on one thread or two, with the same bits. */
START_TEST(ranges_and_threads_have_the_same_bits)
{
  static const char *const chains[] = {"fem:degree=1,cells=5000,lumped=yes",
                                       "fem:degree=3,cells=2000,lumped=yes"};
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(chains[i], 1, 0, 200, 0), parts, 3, NULL,
                                       0);
    double *q = calloc((size_t)field.n, sizeof *q);
    set_density(&field, pendula_start, pendula_rate, NULL);
    run_density(&field, "verlet", 0, 0.005, 60);
    memcpy(q, field.q, (size_t)field.n * sizeof *q);
    memset(field.U, 0, (size_t)field.places * sizeof *field.U);
    set_density(&field, pendula_start, pendula_rate, NULL);
    run_density(&field, "verlet:threads=2", 0, 0.005, 60);
    ck_assert(memcmp(q, field.q, (size_t)field.n * sizeof *q) == 0);
    free(q);
    end_density(&field);
  }
}
END_TEST

/* ---- three dimensions ---- */

static int elastic_3d(int count, double t, const double *x, const double *z, double *l, double *l_z,
                      double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0;
    for (int a = 0; a < 3; a++) {
      const double s = z[a * count + k];
      if (l != NULL) l[k] -= 0.5 * s * s;
      if (l_z != NULL) l_z[a * count + k] = -s;
      if (l_zz != NULL) l_zz[a * count + k] = -1;
    }
  }
  return 0;
}

static int upper_flux(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = 2;
  return 0;
}

static const dvi_jet gradient[] = {{.order = {1}}, {.order = {0, 1}}, {.order = {0, 0, 1}}};
static const int squares[][2] = {{0, 0}, {1, 1}, {2, 2}};

/* A box that is held below, at z = 0, and pulled above has u = 2 z. */
START_TEST(boxes_are_pulled)
{
  static const char *const boxes[] = {"fem:degree=1,cells=2", "spline:degree=2,cells=2"};
  const dvi_density_part parts[] = {{.kind = DVI_DENSITY_QUADRATIC,
                                     .variable = gradient,
                                     .variables = 3,
                                     .pair = squares,
                                     .pairs = 3,
                                     .density = elastic_3d},
                                    kinetic_part,
                                    sine_gordon_part};
  const dvi_density_condition sides[] = {{.part = "back", .kind = DVI_FIXED},
                                         {.part = "front", .datum = upper_flux}};
  const double x[3] = {0.3, 0.7, 0.6};
  for (int i = 0; i < 2; i++) {
    density_field still = make_density(make_density_space(boxes[i], 3, 0, 1, 0), parts, 1, sides,
                                       2);
    ck_assert_msg(dvi_density_solve(still.density, still.U, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_density_project(still.density, still.U, NULL, still.q, NULL, NULL),
                     DVI_OK);
    ck_assert_double_eq_tol(density_at(&still, 0, x), 1.2, 1e-12);
    end_density(&still);
    density_field field = make_density(make_density_space(boxes[i], 3, 0, 1, 0), parts, 3, sides,
                                       2);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* ---- orders in two dimensions ---- */

static int product(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = cos(x[k]) * sin(x[count + k]);
  return 0;
}

/* The largest error of u = cos x sin y cos w t with w^2 = 2 + 2.25 at some points at t = 1. */
START_TEST(squares_have_their_orders_in_space)
{
  static const char *const sizes[][2] = {{"fem:degree=2,cells=6", "fem:degree=2,cells=12"},
                                         {"spline:degree=3,cells=6", "spline:degree=3,cells=12"}};
  static const int order[] = {3, 4};
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d, klein_gordon_part};
  for (int i = 0; i < 2; i++) {
    double error[2];
    for (int j = 0; j < 2; j++) {
      density_field field = make_density(make_density_space(sizes[i][j], 2, 0, 2 * pi, 1), parts, 3,
                                         NULL, 0);
      set_density(&field, product, NULL, NULL);
      run_density(&field, "galerkin:degree=3", 0, 0.05, 20);
      error[j] = 0;
      for (int k = 0; k < 200; k++) {
        const double x[2] = {2 * pi * k / 200, fmod(0.1 + 1.7 * k, 2 * pi)};
        error[j] = fmax(error[j],
                        fabs(density_at(&field, 1, x) - cos(x[0]) * sin(x[1]) * cos(sqrt(4.25))));
      }
      end_density(&field);
    }
    ck_assert_msg(log2(error[0] / error[1]) > order[i] - 0.5, "%g %g", error[0], error[1]);
  }
}
END_TEST

SUITE(density_runs)
{
  tcase_add_test(tests, methods_agree);
  tcase_add_test(tests, threads_share_a_field);
  tcase_add_test(tests, ranges_and_threads_have_the_same_bits);
  tcase_add_test(tests, boxes_are_pulled);
  tcase_add_test(tests, squares_have_their_orders_in_space);
}
