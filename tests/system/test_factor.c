/* Configuration spaces with factors: layout, mass, refusals, and points off the manifold. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "support/systems/bodies.h"
#include "support/runs.h"
#include "support/suite.h"
#include "system/system.h"

static const double inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9}, centre[] = {.1, -.2, .15};

static dvi_system *made;

static void destroy(void)
{
  dvi_system_destroy(&made);
}

static dvi_status create(const dvi_factor *factors, int count)
{
  return dvi_system_create(&(dvi_system_terms){.factors = factors, .factor_count = count}, &made);
}

START_TEST(numbers_stand_in_the_order_of_the_factors)
{
  const dvi_factor factors[] = {{.kind = DVI_U1, .mass = 1},
                                {.kind = DVI_RN, .size = 2, .mass = 3},
                                {.kind = DVI_SE3, .mass = 2, .inertia = inertia},
                                {.kind = DVI_S2, .mass = 1},
                                {.kind = DVI_SO3, .inertia = inertia}};
  ck_assert_msg(create(factors, 5) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_nq(made), 2 + 2 + 12 + 3 + 9);
  ck_assert_int_eq(dvi_system_nv(made), 1 + 2 + 6 + 3 + 3);
  ck_assert_int_eq(made->nx, 1 + 2 + 6 + 2 + 3);
  const int q[] = {0, 2, 3, 4, 13, 14, 15, 16, 19}, v[] = {0, 1, 2, 3, 6, 7, 8, 9, 12},
            x[] = {0, 1, 2, 3, 6, 7, 8, 9, 11};
  ck_assert_int_eq(made->slot_count, 9);
  for (int c = 0; c < 9; c++) {
    ck_assert_int_eq(made->slots[c].q, q[c]);
    ck_assert_int_eq(made->slots[c].v, v[c]);
    ck_assert_int_eq(made->slots[c].x, x[c]);
  }
}
END_TEST

/* Omega.J Omega/2 + x'.R (Omega x m rho) + m |x'|^2/2, p of it, and the way back. */
START_TEST(a_bodys_energy_is_that_of_its_inertia)
{
  const dvi_factor factor = {.kind = DVI_SE3, .mass = 2, .inertia = inertia, .centre = centre};
  const double q[12] = {0, -1, 0, 1, 0, 0, 0, 0, 1, .3, .2, .1}, v[6] = {.7, -.4, .5, 1, 2, -1};
  double L, expected = 0, p[6], back[6] = {0};
  ck_assert_int_eq(create(&factor, 1), DVI_OK);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) expected += 0.5 * v[i] * inertia[3 * i + j] * v[j];
  const double swing[] = {v[1] * centre[2] - v[2] * centre[1], v[2] * centre[0] - v[0] * centre[2],
                          v[0] * centre[1] - v[1] * centre[0]};
  for (int i = 0; i < 3; i++) {
    expected += v[3 + i] * v[3 + i];
    for (int j = 0; j < 3; j++) expected += 2 * v[3 + i] * q[3 * i + j] * swing[j];
  }
  ck_assert_int_eq(dvi_system_lagrangian(made, 0, q, v, &L), DVI_OK);
  ck_assert_double_eq_tol(L, expected, 1e-14);
  ck_assert_int_eq(dvi_system_momentum(made, 0, q, v, p), DVI_OK);
  double power = 0;
  for (int i = 0; i < 6; i++) power += p[i] * v[i];
  ck_assert_double_eq_tol(power, 2 * L, 1e-13);
  ck_assert_int_eq(dvi_system_velocity(made, 0, q, p, back), DVI_OK);
  ck_assert_double_le(distance(6, v, back), 1e-14);
}
END_TEST

/* The system's mass adds to the factors'. */
START_TEST(masses_add_up)
{
  const dvi_factor factors[] = {{.kind = DVI_RN, .size = 2, .mass = 3},
                                {.kind = DVI_RN, .size = 1, .mass = 5}};
  const double mass[] = {1, 0, .5, 0, 1, 0, .5, 0, 1}, q[3] = {0}, v[] = {1, 2, 3};
  double L;
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = factors, .factor_count = 2, .mass = {.values = mass}},
          &made),
      DVI_OK);
  ck_assert_int_eq(dvi_system_lagrangian(made, 0, q, v, &L), DVI_OK);
  ck_assert_double_eq_tol(L, 0.5 * (4 + 4 * 4 + 6 * 9 + 2 * .5 * 3), 1e-15);
}
END_TEST

/* ---- refusals ---- */

static const double flat[] = {1, 0, 0, 0, 1, 0, 0, 0, 3},
                    indefinite[] = {1, 2, 0, 2, 1, 0, 0, 0, 1},
                    skew[] = {1, .1, 0, 0, 1, 0, 0, 0, 1},
                    not_a_number[] = {NAN, 0, 0, 0, 1, 0, 0, 0, 1},
                    infinite[] = {1, 0, 0, 0, 1, 0, 0, 0, INFINITY},
                    negative[] = {-1, 0, 0, 0, -1, 0, 0, 0, -1}, far[] = {2, 0, 0};

static const struct {
  dvi_factor factor;
  dvi_status status;
  const char *words;
} refusals[] = {
    {{.kind = DVI_SO3, .inertia = flat}, DVI_BAD_ARGUMENT, "is that of no body"},
    {{.kind = DVI_SO3, .inertia = indefinite}, DVI_BAD_ARGUMENT, "is not positive definite"},
    {{.kind = DVI_SO3, .inertia = skew}, DVI_BAD_ARGUMENT, "is not symmetric at (0,1)"},
    {{.kind = DVI_SO3, .inertia = not_a_number},
     DVI_BAD_ARGUMENT,
     "the inertia of factor 0 is not finite"},
    {{.kind = DVI_SO3, .inertia = infinite},
     DVI_BAD_ARGUMENT,
     "the inertia of factor 0 is not finite"},
    {{.kind = DVI_SO3, .inertia = negative}, DVI_BAD_ARGUMENT, "is not positive definite"},
    {{.kind = DVI_SE3, .mass = 2, .inertia = inertia, .centre = not_a_number},
     DVI_BAD_ARGUMENT,
     "centre of mass of factor 0 is not"},
    {{.kind = DVI_SE3, .mass = 2, .inertia = inertia, .centre = far},
     DVI_BAD_ARGUMENT,
     "and its centre of mass"},
    {{.kind = DVI_SE3, .mass = 2}, DVI_BAD_ARGUMENT, "has a mass but no inertia"},
    {{.kind = DVI_SO3, .mass = 2, .inertia = inertia}, DVI_BAD_ARGUMENT, "its inertia says all"},
    {{.kind = DVI_SO3, .inertia = inertia, .centre = centre},
     DVI_BAD_ARGUMENT,
     "has a centre of mass"},
    {{.kind = DVI_S2, .mass = 1, .inertia = inertia}, DVI_BAD_ARGUMENT, "has an inertia matrix"},
    {{.kind = DVI_S2, .mass = -1}, DVI_BAD_ARGUMENT, "has mass -1"},
    {{.kind = DVI_U1, .mass = INFINITY}, DVI_BAD_ARGUMENT, "has mass inf"},
    {{.kind = DVI_U1, .mass = NAN}, DVI_BAD_ARGUMENT, "has mass nan"},
    {{.kind = DVI_SO3}, DVI_SINGULAR, "factor 0 has no mass at coordinates 0 to 8"},
    {{.kind = DVI_SE3}, DVI_SINGULAR, "factor 0 has no mass at coordinates 0 to 11"},
    {{.kind = DVI_SE3, .inertia = inertia},
     DVI_SINGULAR,
     "factor 0 has no mass at coordinates 9 to 11"},
    {{.kind = DVI_S2}, DVI_SINGULAR, "factor 0 has no mass at coordinates 0 to 2"},
    {{.kind = DVI_U1}, DVI_SINGULAR, "factor 0 has no mass at coordinates 0 to 1"},
    {{.kind = DVI_RN, .size = 2}, DVI_SINGULAR, "factor 0 has no mass at coordinates 0 to 1"},
    {{.kind = DVI_RN, .mass = 1}, DVI_BAD_SIZE, "has size 0"},
    {{.kind = DVI_S2, .size = 3, .mass = 1}, DVI_BAD_SIZE, "has size 3"},
    {{.kind = (dvi_factor_kind)17}, DVI_BAD_ARGUMENT, "is of no known kind (17)"},
};

START_TEST(bad_factors_are_refused_with_the_reason)
{
  const dvi_status status = create(&refusals[_i].factor, 1);
  ck_assert_msg(status == refusals[_i].status, "%d: %s: %s", _i, dvi_status_name(status),
                dvi_last_error());
  ck_assert_ptr_null(made);
  check_words(refusals[_i].words);
}
END_TEST

/* As small as an atom's, or as large as a star's. */
START_TEST(inertia_has_any_unit)
{
  static const double units[] = {1e-300, 1e-150, 1e150, 1e300};
  double scaled[9];
  for (int i = 0; i < 9; i++) scaled[i] = units[_i] * inertia[i];
  ck_assert_msg(create(&(dvi_factor){.kind = DVI_SO3, .inertia = scaled}, 1) == DVI_OK, "%s",
                dvi_last_error());
}
END_TEST

/* Rounding is removed, because a mass is symmetric. */
START_TEST(inertia_is_made_symmetric)
{
  const double rounded[] = {1.3, .1 + 1e-14, 0, .1, 1.1, .05, 0, .05 - 1e-14, .9};
  ck_assert_int_eq(create(&(dvi_factor){.kind = DVI_SO3, .inertia = rounded}, 1), DVI_OK);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      ck_assert_double_eq(made->mass_values[dvi__pattern_find(&made->vv, i, j)],
                          made->mass_values[dvi__pattern_find(&made->vv, j, i)]);
}
END_TEST

static int some_gradient(int count, const double *t, const double *q, const double *v, double *L_q,
                         double *L_v, void *user)
{
  (void)t, (void)user;
  memcpy(L_q, q, (size_t)count * sizeof *q);
  memcpy(L_v, v, (size_t)count * sizeof *v);
  return 0;
}

static int some_value(int count, const double *t, const double *q, const double *v, double *L,
                      void *user)
{
  (void)t, (void)q, (void)user;
  memcpy(L, v, (size_t)count * sizeof *v);
  return 0;
}

START_TEST(general_lagrangians_and_wrong_sizes_are_refused)
{
  const dvi_factor factor = {.kind = DVI_U1, .mass = 1};
  const dvi_lagrangian lagrangian = {.value_batch = some_value, .gradient_batch = some_gradient};
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = &factor, .factor_count = 1, .lagrangian = &lagrangian},
          &made),
      DVI_UNSUPPORTED);
  check_words("factors");
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .dimension = 3},
                        &made),
      DVI_BAD_SIZE);
  check_words("dimension 3, but the factors have 2");
}
END_TEST

/* ---- points ---- */

/* A wrong number of a start, the status of the start, and that of the projection to the nearest
 * point. */
static const struct {
  body_kind kind;
  int at;
  double value;
  dvi_status start, project;
  const char *words, *project_words;
} places[] = {
    {FREE_BODY, 1, 1e-6, DVI_BAD_ARGUMENT, DVI_OK,
     "coordinates 0 to 8 are no rotation matrix: off by 7.07e-07", NULL},
    {FREE_BODY, 8, -1, DVI_BAD_ARGUMENT, DVI_BAD_ARGUMENT, "no rotation matrix",
     "no nearest rotation"},
    {FREE_BODY, 8, 0, DVI_BAD_ARGUMENT, DVI_BAD_ARGUMENT, "no rotation matrix",
     "no nearest rotation"},
    {FREE_BODY, 8, NAN, DVI_NOT_FINITE, DVI_NOT_FINITE, "the start's q[8] = nan", "not finite"},
    {DIRECTIONS, 5, 1.001, DVI_BAD_ARGUMENT, DVI_OK,
     "coordinates 3 to 5 are no unit vector: off by 1.00e-03", NULL},
    {DIRECTIONS, 5, 0, DVI_BAD_ARGUMENT, DVI_BAD_ARGUMENT, "no unit vector",
     "coordinates 3 to 5 have no nearest direction"},
    {ANGLE, 0, 1e200, DVI_BAD_ARGUMENT, DVI_OK, "no unit vector", NULL},
};

START_TEST(points_off_the_manifold_are_refused_and_projected_on_request)
{
  body model;
  dvi_integrator *integrator;
  double before[BODY_Q];
  make_body(places[_i].kind, &model);
  model.q[places[_i].at] = places[_i].value;
  memcpy(before, model.q, sizeof before);
  ck_assert_int_eq(dvi_integrator_create(model.system, "lie-galerkin", &integrator), DVI_OK);
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model.q, model.v) == places[_i].start,
                "%d: %s", _i, dvi_last_error());
  check_words(places[_i].words);
  ck_assert_int_eq(dvi_system_project(model.system, model.q), places[_i].project);
  if (places[_i].project == DVI_OK) {
    ck_assert_double_le(dvi_system_distance(model.system, model.q), 1e-15);
    ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model.q, model.v) == DVI_OK, "%s",
                  dvi_last_error());
  } else {
    check_words(places[_i].project_words);
    ck_assert_mem_eq(before, model.q, sizeof before);
  }
  dvi_integrator_destroy(&integrator);
  destroy_body(&model);
}
END_TEST

START_TEST(velocities_off_the_tangent_plane_are_refused)
{
  body model;
  dvi_integrator *integrator;
  make_body(DIRECTIONS, &model);
  model.v[5] = 1e-3;
  ck_assert_int_eq(dvi_integrator_create(model.system, "lie-galerkin", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, model.q, model.v),
                   DVI_BAD_ARGUMENT);
  check_words("numbers 3 to 5 of the velocity or momentum of a direction q are not orthogonal to "
              "it: off by");
  check_words("subtract (p.q) q");
  dvi_integrator_destroy(&integrator);
  destroy_body(&model);
}
END_TEST

START_TEST(distances_are_those_of_the_nearest_point)
{
  body model;
  make_body(FREE_BODY, &model);
  ck_assert_double_eq(dvi_system_distance(model.system, model.q), 0);
  for (int i = 0; i < 9; i++) model.q[i] *= 1.1; /* 0.1 times |I| */
  ck_assert_double_eq_tol(dvi_system_distance(model.system, model.q), 0.1 * sqrt(3), 1e-15);
  model.q[4] = NAN;
  ck_assert(isnan(dvi_system_distance(model.system, model.q)));
  ck_assert(isnan(dvi_system_distance(NULL, model.q)));
  ck_assert_int_eq(dvi_system_project(NULL, model.q), DVI_BAD_ARGUMENT);
  destroy_body(&model);
}
END_TEST

/* A line without a mass of its own, coupled to an angle by the system's. */
START_TEST(massless_factors_may_be_coupled)
{
  const dvi_factor factors[] = {{.kind = DVI_U1, .mass = 1}, {.kind = DVI_RN, .size = 1}};
  const double mass[] = {0, 0, .5, 0, 0, 0, .5, 0, 0}, q[] = {0, 1, 0}, v[] = {1, 2};
  double p[2], back[2] = {0};
  ck_assert_int_eq(create(factors, 2), DVI_SINGULAR);
  check_words("factor 1 has no mass at coordinates 2 to 2");
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = factors, .factor_count = 2, .mass = {.values = mass}},
          &made),
      DVI_OK);
  ck_assert_int_eq(dvi_system_momentum(made, 0, q, v, p), DVI_OK);
  ck_assert_int_eq(dvi_system_velocity(made, 0, q, p, back), DVI_OK);
  ck_assert_double_le(distance(2, v, back), 1e-15);
}
END_TEST

/* A direction with a mass along x alone. A velocity across x has no momentum. */
START_TEST(singular_masses_cannot_start)
{
  const dvi_factor factor = {.kind = DVI_S2};
  const double mass[] = {1, 0, 0}, q[] = {0, 0, 1}, v[] = {1, 0, 0};
  dvi_integrator *integrator;
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = &factor, .factor_count = 1, .mass = {.diagonal = mass}},
          &made),
      DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(made, "lie-galerkin", &integrator), DVI_OK);
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, q, v) == DVI_SINGULAR, "%s",
                dvi_last_error());
  dvi_integrator_destroy(&integrator);
}
END_TEST

START_TEST(a_success_leaves_the_last_error_as_it_is)
{
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia};
  char before[256];
  ck_assert_int_eq(dvi_system_create(NULL, &made), DVI_BAD_ARGUMENT);
  (void)snprintf(before, sizeof before, "%s", dvi_last_error());
  ck_assert_int_eq(create(&factor, 1), DVI_OK);
  ck_assert_str_eq(dvi_last_error(), before);
}
END_TEST

START_TEST(systems_with_factors_survive_every_failure)
{
  const dvi_factor factors[] = {{.kind = DVI_SE3, .mass = 2, .inertia = inertia, .centre = centre},
                                {.kind = DVI_S2, .mass = 1}};
  double mass[15] = {0};
  for (int i = 0; i < 15; i++) mass[i] = 0.1;
  const dvi_system_terms terms = {
      .factors = factors, .factor_count = 2, .mass = {.diagonal = mass}};
  const long before = dvi__allocation_count();
  ck_assert_int_eq(dvi_system_create(&terms, &made), DVI_OK);
  const long needed = dvi__allocation_count() - before;
  dvi_system_destroy(&made);
  ck_assert_int_gt(needed, 10);
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi_system_create(&terms, &made);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    ck_assert_ptr_null(made);
    check_words("no memory");
  }
}
END_TEST

SUITE(factor)
{
  tcase_add_checked_fixture(tests, NULL, destroy);
  tcase_add_test(tests, numbers_stand_in_the_order_of_the_factors);
  tcase_add_test(tests, a_bodys_energy_is_that_of_its_inertia);
  tcase_add_test(tests, masses_add_up);
  tcase_add_loop_test(tests, bad_factors_are_refused_with_the_reason, 0,
                      sizeof refusals / sizeof *refusals);
  tcase_add_loop_test(tests, inertia_has_any_unit, 0, 4);
  tcase_add_test(tests, inertia_is_made_symmetric);
  tcase_add_test(tests, general_lagrangians_and_wrong_sizes_are_refused);
  tcase_add_loop_test(tests, points_off_the_manifold_are_refused_and_projected_on_request, 0,
                      sizeof places / sizeof *places);
  tcase_add_test(tests, velocities_off_the_tangent_plane_are_refused);
  tcase_add_test(tests, distances_are_those_of_the_nearest_point);
  tcase_add_test(tests, massless_factors_may_be_coupled);
  tcase_add_test(tests, singular_masses_cannot_start);
  tcase_add_test(tests, a_success_leaves_the_last_error_as_it_is);
  tcase_add_test(tests, systems_with_factors_survive_every_failure);
}
