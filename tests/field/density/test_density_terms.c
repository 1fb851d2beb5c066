/* Terms of fields with densities that depend on time, couple components, or live on meshes; and the
 * memory that their steps take. */
#include <dvi/mesh.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "field/density/rooms.h"
#include "support/field/densities.h"
#include "support/suite.h"

static const dvi_jet value = {0}, rates[] = {{.rate = 1}, {.component = 1, .rate = 1}};

/* ---- time ---- */

/* l = x sin(3 t) u - cos(t)/2. */
static int push(int count, double t, const double *x, const double *z, double *l, double *l_z,
                double *l_zz, void *user)
{
  (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = x[k] * sin(3 * t) * z[k] - 0.5 * cos(t);
    if (l_z != NULL) l_z[k] = x[k] * sin(3 * t);
    if (l_zz != NULL) l_zz[k] = 0;
  }
  return 0;
}

static int push_in_time(int count, double t, const double *x, const double *z, double *l_t,
                        void *user)
{
  (void)user;
  for (int k = 0; k < count; k++) l_t[k] = 3 * x[k] * cos(3 * t) * z[k] + 0.5 * sin(t);
  return 0;
}

static const dvi_density_part push_part = {.name = "push",
                                           .kind = DVI_DENSITY_QUADRATIC,
                                           .variable = &value,
                                           .variables = 1,
                                           .density = push,
                                           .time_derivative = push_in_time,
                                           .depends_on_time = 1};

static const char *const kinds[] = {"fem:degree=2,cells=5", "spline:degree=3,cells=8",
                                    "fourier:modes=4"};

START_TEST(loads_that_depend_on_time_have_rates)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, push_part, sine_gordon_part};
  for (int i = 0; i < 3; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 2, 1), parts, 4, NULL, 0);
    dvi_system_terms terms;
    ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
    ck_assert(!terms.autonomous && terms.potentials[0].rate != NULL);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* The mean of x on [0,2] is 1, so that the mean of u has u'' = sin 3 t, and from rest it is
 * t/3 - sin(3 t)/9. */
START_TEST(loads_that_depend_on_time_push)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, push_part};
  density_field field = make_density(make_density_space("spline:degree=2,cells=6", 1, 0, 2, 1),
                                     parts, 3, NULL, 0);
  const int order[DVI_AXES_MAX] = {0};
  const double *weight;
  double u[64], sum = 0;
  run_density(&field, "galerkin:degree=3", 0, 0.02, 50);
  ck_assert_int_eq(dvi_density_lift(field.density, 1, field.q, field.U), DVI_OK);
  const int64_t points = dvi_space_points(field.space, NULL, &weight);
  ck_assert_int_le(points, 64);
  ck_assert_int_eq(dvi_space_apply(field.space, order, field.U, u), DVI_OK);
  for (int64_t k = 0; k < points; k++) sum += weight[k] * u[k] / 2;
  ck_assert_double_eq_tol(sum, 1.0 / 3 - sin(3) / 9, 1e-10);
  end_density(&field);
}
END_TEST

/* ---- components ---- */

/* l = (u_t^2 + u_t v_t + v_t^2)/2. */
static int coupled(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  const double *u = z, *v = z + count;
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0.5 * (u[k] * u[k] + u[k] * v[k] + v[k] * v[k]);
    if (l_z != NULL) l_z[k] = u[k] + 0.5 * v[k], l_z[count + k] = v[k] + 0.5 * u[k];
    if (l_zz != NULL) l_zz[k] = l_zz[2 * count + k] = 1, l_zz[count + k] = 0.5;
  }
  return 0;
}

static int line(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = 1 + x[k];
  return 0;
}

START_TEST(components_may_share_a_mass)
{
  static const char *const intervals[] = {"fem:degree=2,cells=4", "fem:degree=2,cells=4,lumped=yes",
                                          "spline:degree=2,cells=5", "fourier:modes=3"};
  const dvi_jet slopes[] = {{.order = {1}}, {.component = 1, .order = {1}}};
  dvi_density_part elastic[] = {elastic_part, elastic_part};
  for (int c = 0; c < 2; c++) elastic[c].variable = slopes + c;
  const dvi_density_part parts[] = {
      {.kind = DVI_DENSITY_KINETIC, .variable = rates, .variables = 2, .density = coupled},
      elastic[0],
      elastic[1],
      sine_gordon_part};
  const dvi_density_condition left = {
      .part = "left", .component = 1, .kind = DVI_FIXED, .datum = line};
  for (int i = 0; i < 4; i++) {
    const int is_fourier = i == 3;
    density_field field = make_density_of(
        make_density_space(intervals[i], 1, 0, 1, is_fourier),
        (dvi_density_terms){.components = 2,
                            .part = parts,
                            .parts = 4,
                            .condition = is_fourier ? NULL : &left,
                            .conditions = !is_fourier});
    dvi_matrix M;
    check_density(&field, 1e-6);
    ck_assert_int_eq(field.n, is_fourier ? field.places : field.places - 1);
    ck_assert_int_eq(dvi_density_matrix(field.density, DVI_FIELD_MASS, &M), DVI_OK);
    ck_assert(M.column != NULL);
    run_density(&field, "midpoint", 0, 0.01, 2);
    end_density(&field);
  }
}
END_TEST

/* ---- meshes ---- */

static int saddle(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = x[k] * x[k] - x[count + k] * x[count + k];
  return 0;
}

static int saddle_values(int64_t count, const double *x, double *f, void *user)
{
  return saddle(count, 0, x, f, user);
}

/* The flux of x^2 - y^2 through the sides x = 1 and y = 1 of the unit square, and 0 through the
 * others. */
static int saddle_flux(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++)
    datum[k] = x[k] > 1 - 1e-12 ? 2 : x[count + k] > 1 - 1e-12 ? -2 : 0;
  return 0;
}

static dvi_space *triangles(const char *kind)
{
  const dvi_generator_options square = {.size = sizeof square, .dimension = 2, .cells = {3, 4}};
  dvi_mesh *mesh = NULL;
  dvi_space *space = NULL;
  ck_assert_int_eq(dvi_mesh_generate("kuhn", &square, &mesh), DVI_OK);
  const dvi_space_options options = {.size = sizeof options, .kind = kind, .mesh = mesh};
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return space;
}

START_TEST(triangles_hold_a_saddle)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d};
  const dvi_density_condition fixed = {.part = "boundary", .kind = DVI_FIXED, .datum = saddle};
  density_field field = make_density(triangles("fem:degree=2"), parts, 2, &fixed, 1);
  const double x[2] = {0.3, 0.8};
  ck_assert_msg(dvi_density_solve(field.density, field.U, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, NULL), DVI_OK);
  ck_assert_double_eq_tol(density_at(&field, 0, x), 0.09 - 0.64, 1e-12);
  check_density(&field, 1e-6);
  end_density(&field);
}
END_TEST

/* x^2 - y^2 is harmonic, so that with its fluxes no coordinate feels a force. */
START_TEST(fluxes_pull_at_triangles)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d};
  const dvi_density_condition flux = {.part = "boundary", .datum = saddle_flux};
  density_field field = make_density(triangles("fem:degree=2"), parts, 2, &flux, 1);
  dvi_system_terms terms;
  double gradient[99];
  ck_assert_int_le(field.n, 99);
  ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
  set_density(&field, saddle_values, NULL, NULL);
  ck_assert_int_eq(terms.potentials[0].gradient(0, field.q, gradient, terms.potentials[0].user), 0);
  for (int64_t i = 0; i < field.n; i++) ck_assert_double_eq_tol(gradient[i], 0, 1e-12);
  end_density(&field);
}
END_TEST

static int unit_flux(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = 1;
  return 0;
}

/* The sum of the loads of a flux of 1 through a part is its size. */
static double size_of_part(dvi_space *space, const char *part)
{
  const dvi_density_condition flux = {.part = part, .datum = unit_flux};
  density_field field = make_density(space, &kinetic_part, 1, &flux, 1);
  dvi_system_terms terms;
  double sum = 0;
  ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
  ck_assert_int_eq(terms.potentials[0].gradient(0, field.q, field.p, terms.potentials[0].user), 0);
  for (int64_t i = 0; i < field.n; i++) sum -= field.p[i];
  end_density(&field);
  return sum;
}

static double size_of_boundary(const char *kind, dvi_generator_options options)
{
  dvi_mesh *mesh = NULL;
  dvi_space *space = NULL;
  options.size = sizeof options;
  ck_assert_int_eq(dvi_mesh_generate("kuhn", &options, &mesh), DVI_OK);
  const dvi_space_options of = {.size = sizeof of, .kind = kind, .mesh = mesh};
  ck_assert_msg(dvi_space_create(&of, &space) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return size_of_part(space, "boundary");
}

/* A unit square, a cylinder of it, and a unit cube. */
START_TEST(fluxes_go_through_all_facets)
{
  const dvi_generator_options square = {.dimension = 2, .cells = {3, 4}},
                              cylinder = {.dimension = 2, .cells = {4, 3}, .periodic = {1}},
                              cube = {.dimension = 3, .cells = {2, 2, 2}};
  static const char *const degrees[] = {"fem:degree=1", "fem:degree=2"};
  for (int i = 0; i < 2; i++) {
    ck_assert_double_eq_tol(size_of_boundary(degrees[i], square), 4, 1e-12);
    ck_assert_double_eq_tol(size_of_boundary(degrees[i], cylinder), 2, 1e-12);
    ck_assert_double_eq_tol(size_of_boundary(degrees[i], cube), 6, 1e-12);
  }
}
END_TEST

/* 5 cells of 0.6 from 0 add up to a little more than 3, and 13 of 10/13 to more than 10. */
START_TEST(fluxes_reach_the_ends_of_sides)
{
  static const struct {
    double length;
    const char *kind;
  } line[] = {{3, "fem:degree=2,cells=5,lumped=yes"}, {10, "fem:degree=1,cells=13,lumped=yes"}};
  for (int i = 0; i < 2; i++) {
    const dvi_axis axes[] = {{.to = line[i].length, .kind = line[i].kind},
                             {.to = 1, .kind = "fem:degree=1,cells=3,lumped=yes"}};
    const dvi_space_options of = {.size = sizeof of, .axis = axes, .axes = 2};
    dvi_space *space = NULL;
    ck_assert_msg(dvi_space_create(&of, &space) == DVI_OK, "%s", dvi_last_error());
    ck_assert_double_eq_tol(size_of_part(space, "top"), line[i].length, 1e-13);
  }
}
END_TEST

/* ---- memory ---- */

START_TEST(steps_take_no_memory)
{
  static const char *const methods[] = {"verlet", "midpoint", "galerkin:degree=2"};
  const dvi_density_part parts[] = {kinetic_part, elastic_part, push_part, sine_gordon_part};
  const dvi_density_condition ends = {
      .part = "boundary", .kind = DVI_FIXED, .datum = sine_datum, .rate = sine_datum_rates};
  for (int i = 0; i < 3; i++)
    for (int m = i < 2; m < 3;
         m++) { /* a vector potential, and a consistent mass, are not for all */
      density_field field = make_density(make_density_space(kinds[i], 1, 0, 1, i == 2), parts, 4,
                                         &ends, i < 2);
      dvi_integrator *integrator = NULL;
      ck_assert_msg(dvi_integrator_create(field.system, methods[m], &integrator) == DVI_OK, "%s",
                    dvi_last_error());
      ck_assert_int_eq(dvi_integrator_start(integrator, 0, field.q, field.p), DVI_OK);
      for (int k = 0; k < 2; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.01), DVI_OK);
      const long before = dvi__allocation_count();
      for (int k = 0; k < 5; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.01), DVI_OK);
      ck_assert_int_eq(dvi__allocation_count(), before);
      dvi_integrator_destroy(&integrator);
      end_density(&field);
    }
}
END_TEST

/* A room is taken once at a time, and returned ones are taken again. */
START_TEST(rooms_are_not_shared)
{
  enum { ROOMS = 70 };
  dvi__rooms *rooms = NULL;
  double *taken[ROOMS];
  ck_assert_int_eq(dvi__rooms_create(8, &rooms), DVI_OK);
  for (int i = 0; i < ROOMS; i++) {
    taken[i] = dvi__rooms_take(rooms);
    ck_assert(taken[i] != NULL);
    for (int j = 0; j < i; j++) ck_assert(taken[j] != taken[i]);
  }
  for (int i = 0; i < ROOMS; i++) dvi__rooms_return(rooms, taken[i]);
  const long before = dvi__allocation_count();
  for (int i = 0; i < 60; i++) taken[i] = dvi__rooms_take(rooms);
  ck_assert_int_eq(dvi__allocation_count(), before);
  for (int i = 0; i < 60; i++) dvi__rooms_return(rooms, taken[i]);
  dvi__rooms_return(rooms, NULL);
  dvi__rooms_destroy(&rooms);
  ck_assert(rooms == NULL);
}
END_TEST

SUITE(density_terms)
{
  tcase_add_test(tests, loads_that_depend_on_time_have_rates);
  tcase_add_test(tests, loads_that_depend_on_time_push);
  tcase_add_test(tests, components_may_share_a_mass);
  tcase_add_test(tests, triangles_hold_a_saddle);
  tcase_add_test(tests, fluxes_pull_at_triangles);
  tcase_add_test(tests, fluxes_go_through_all_facets);
  tcase_add_test(tests, fluxes_reach_the_ends_of_sides);
  tcase_add_test(tests, steps_take_no_memory);
  tcase_add_test(tests, rooms_are_not_shared);
}
