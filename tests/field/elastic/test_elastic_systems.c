/* Elastic solids as mechanical systems: derivatives, symmetries, and what the terms say. */
#include <dvi/contact.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/elastic/elastic.h"
#include "field/mesh/mesh.h"
#include "support/field/generated.h"
#include "support/field/solids.h"
#include "support/meshes.h"
#include "support/suite.h"

/* ---- what solids consist of ---- */

static int lift_left(double t, const double *X, double *u, double *rate, void *user)
{
  (void)X, (void)user;
  u[0] = 0.05 * sin(3 * t), rate[0] = 0.15 * cos(3 * t);
  return 0;
}

static int stretch_right(double t, const double *X, double *u, double *rate, void *user)
{
  (void)t, (void)user, (void)rate;
  u[1] = 0.1 * X[1];
  return 0;
}

static int constant_weight(double t, const double *X, const double *normal, double *force,
                           void *user)
{
  (void)t, (void)X, (void)normal, (void)user;
  force[0] = 0, force[1] = -1;
  return 0;
}

static int wind(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)X, (void)user;
  force[0] = -sin(t) * normal[0], force[1] = 0.5 - sin(t) * normal[1];
  return 0;
}

/* |H|^2 + |H|^4/2, which depends on turns. */
static int fancy(int64_t count, const double *F, double *W, double *P, double *Hessian, void *user)
{
  const int n = *(const int *)user, entries = n * n;
  for (int64_t c = 0; c < count; c++) {
    double H[9] = {0}, square = 0;
    for (int k = 0; k < entries; k++) {
      H[k] = F[k * count + c] - (k % (n + 1) == 0);
      square += H[k] * H[k];
    }
    if (W != NULL) W[c] = square + square * square / 2;
    for (int k = 0; k < entries && P != NULL; k++) P[k * count + c] = 2 * (1 + square) * H[k];
    for (int k = 0, at = 0; k < entries && Hessian != NULL; k++)
      for (int j = 0; j <= k; j++, at++)
        Hessian[at * count + c] = 2 * (1 + square) * (j == k) + 4 * H[j] * H[k];
  }
  return 0;
}

static int two = 2;

/* Kinds of solids. */
static const struct kind {
  dvi_elastic_law law;
  int is_split, is_driven, is_held, load, is_damped; /* load: 1 steady, 2 in time */
} kinds[] = {{DVI_ELASTIC_LINEAR, 0, 0, 0, 0, 0},        {DVI_ELASTIC_LINEAR, 0, 0, 1, 1, 1},
             {DVI_ELASTIC_LINEAR, 0, 1, 1, 2, 1},        {DVI_ELASTIC_SVK, 0, 0, 0, 0, 0},
             {DVI_ELASTIC_SVK, 1, 0, 1, 1, 1},           {DVI_ELASTIC_SVK, 1, 1, 1, 1, 1},
             {DVI_ELASTIC_NEO_HOOKEAN, 0, 1, 0, 2, 0},   {DVI_ELASTIC_NEO_HOOKEAN, 1, 0, 1, 0, 0},
             {DVI_ELASTIC_MOONEY_RIVLIN, 0, 1, 1, 1, 1}, {DVI_ELASTIC_ENERGY, 0, 0, 1, 1, 0},
             {DVI_ELASTIC_ENERGY, 1, 1, 0, 0, 1}};
enum { KINDS = sizeof kinds / sizeof *kinds };

static dvi_elastic *solid_of_kind(const struct kind *k)
{
  const dvi_elastic_condition conditions[] = {
      {.part = "left", .component = {1}, .displacement = lift_left},
      {.part = "right", .component = {0, 1}, .displacement = stretch_right, .is_steady = 1}};
  const dvi_elastic_load loads[] = {{.part = k->load == 1 ? "all" : "boundary",
                                     .force = k->load == 1 ? constant_weight : wind,
                                     .is_steady = k->load == 1}};
  dvi_elastic_material material = unit_material(k->law);
  if (k->is_damped) material.alpha = 0.3, material.beta = 0.02;
  material.energy = fancy;
  material.user = &two;
  return solid_on(grid_mesh("kuhn", 2, 2, 1.4), material,
                  (dvi_elastic_terms){.condition = conditions + !k->is_driven,
                                      .conditions = k->is_driven + k->is_held,
                                      .load = loads,
                                      .loads = k->load > 0,
                                      .split = k->is_split});
}

static void fill(int count, double *q, double *v)
{
  for (int k = 0; k < count; k++) {
    q[k] = 0.06 * sin(2.3 * k + 1);
    v[k] = 0.3 * cos(1.1 * k);
  }
}

/* ---- the callbacks ---- */

START_TEST(callbacks_have_the_derivatives_and_patterns_that_they_declare)
{
  dvi_elastic *solid = solid_of_kind(kinds + _i);
  dvi_system *system = system_of_solid(solid);
  double q[18], v[18];
  fill(18, q, v);
  ck_assert_msg(dvi_system_check(system, 0.4, q, v, 1e-8, NULL) == DVI_OK, "%s", dvi_last_error());
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* The potentials have the energies of the displacements, at a time when conditions move. */
START_TEST(potentials_are_the_energies_of_the_solid)
{
  const struct kind *kind = kinds + _i;
  dvi_elastic *solid = solid_of_kind(kind);
  dvi_system_terms terms;
  dvi_elastic_energies energies;
  double q[18], v[18], u[18], stored = 0, load = 0;
  ck_assert_int_eq(dvi_elastic_system_terms(solid, &terms), DVI_OK);
  fill(18, q, v);
  ck_assert_int_eq(dvi_elastic_lift(solid, 0.4, q, NULL, u, NULL), DVI_OK);
  ck_assert_int_eq(dvi_elastic_energy(solid, 0.4, u, NULL, NULL, &energies), DVI_OK);
  for (int i = 0; i < terms.potential_count; i++) {
    const dvi_potential *potential = terms.potentials + i;
    double V;
    ck_assert_int_eq(potential->value(0.4, q, &V, potential->user), 0);
    *(strcmp(potential->name, "load") == 0 ? &load : &stored) += V;
  }
  ck_assert_double_eq_tol(stored, energies.stored, 1e-15);
  ck_assert_double_eq_tol(load, energies.load, 1e-15);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* Rayleigh's force is -alpha m u' - beta K u' of all nodes, also of those that conditions move. */
START_TEST(damping_pulls_by_the_rates_of_all_nodes)
{
  const struct kind *kind = kinds + _i;
  dvi_elastic *solid = solid_of_kind(kind);
  dvi_system_terms terms;
  double q[18], v[18], p[18], F[18], u[18], rate[18], expected[18] = {0};
  ck_assert_int_eq(dvi_elastic_system_terms(solid, &terms), DVI_OK);
  ck_assert_int_eq(terms.force_count, kind->is_damped);
  fill(18, q, v);
  for (int k = 0; k < 18; k++)
    if (solid->unknown[k] >= 0) p[solid->unknown[k]] = solid->mass[k / 2] * v[solid->unknown[k]];
  ck_assert_int_eq(dvi_elastic_lift(solid, 0.4, q, p, u, rate), DVI_OK);
  for (int k = 0; k < 18; k++) expected[k] = -0.3 * solid->mass[k / 2] * rate[k];
  for (int64_t c = 0; c < solid->cells; c++) {
    double own[DVI__SOLID_NUMBERS], K[DVI__SOLID_NUMBERS * DVI__SOLID_NUMBERS];
    dvi__solid_gather(solid, c, rate, own);
    ck_assert_int_eq(dvi__solid_stiffness(solid, c, NULL, K), 0);
    for (int r = 0; r < 6; r++)
      for (int s = 0; s < 6; s++)
        expected[2 * solid->vertex[3 * c + r / 2] + r % 2] -= 0.02 * K[6 * r + s] * own[s];
  }
  if (kind->is_damped) ck_assert_int_eq(terms.forces->value(0.4, q, v, F, terms.forces->user), 0);
  for (int k = 0; k < 18 && kind->is_damped; k++)
    if (solid->unknown[k] >= 0) ck_assert_double_eq_tol(F[solid->unknown[k]], expected[k], 1e-15);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* A law that is not defined where F_11 > 1.5. */
static int brittle(int64_t count, const double *F, double *W, double *P, double *Hessian,
                   void *user)
{
  const int returned = fancy(count, F, W, P, Hessian, user);
  for (int64_t c = 0; c < count; c++)
    if (F[c] > 1.5) return 2;
  return returned;
}

/* Cells are evaluated several at a time, but the reason names the one. */
START_TEST(a_step_names_the_cell_whose_law_is_not_defined)
{
  dvi_elastic_material material = unit_material(DVI_ELASTIC_ENERGY);
  material.energy = brittle, material.user = &two;
  dvi_elastic *solid = solid_on(grid_mesh("kuhn", 2, 4, 1), material, (dvi_elastic_terms){0});
  dvi_system *system = system_of_solid(solid);
  dvi_integrator *integrator = NULL;
  double q[50] = {0}, p[50] = {0};
  for (int k = 0; k < 2; k++) {
    const int vertex = solid->vertex[3 * 20 + k];
    q[2 * vertex] = solid->point[2L * vertex];
  }
  ck_assert_int_eq(dvi_integrator_create(system, "verlet", &integrator), DVI_OK);
  dvi_status status = dvi_integrator_start(integrator, 0, q, p);
  if (status == DVI_OK) status = dvi_integrator_step(integrator, 0.01);
  ck_assert_int_eq(status, DVI_CALLBACK_RETRY);
  check_words("is inverted, or deformed to where its law is not defined");
  for (int64_t c = 0; c < solid->cells; c++) {
    double u[DVI__SOLID_NUMBERS], f[DVI__SOLID_NUMBERS];
    dvi__solid_gather(solid, c, q, u);
    if (dvi__solid_force(solid, c, u, f) == 0) continue;
    check_words(dvi__name_cell(solid->mesh, 2, c).text);
    break;
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- symmetries ---- */

static int push_z(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)t, (void)X, (void)normal, (void)user;
  force[0] = force[1] = 0, force[2] = -1;
  return 0;
}

static void check_symmetries(dvi_elastic *solid, const char *names)
{
  dvi_system *system = system_of_solid(solid);
  char found[128] = "";
  for (int i = 1, at = 0; i < dvi_system_invariant_count(system); i++)
    at += snprintf(found + at, sizeof found - (size_t)at, "%s ",
                   dvi_system_invariant_name(system, i));
  ck_assert_str_eq(found, names);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}

static dvi_elastic *cube_with(dvi_elastic_law law, dvi_elastic_terms terms)
{
  return solid_on(grid_mesh("kuhn", 3, 1, 1), unit_material(law), terms);
}

START_TEST(symmetries_are_those_that_conditions_loads_and_obstacles_allow)
{
  const dvi_elastic_condition slide = {.part = "left", .component = {1, 0, 0}};
  const dvi_elastic_load down = {.part = "all", .force = push_z, .is_steady = 1},
                         unknown = {.part = "all", .force = push_z};
  dvi_obstacle floor = {.name = "floor", .normal = {0, 0, 1}, .point = {0, 0, -1}},
               ball = {.name = "ball", .kind = DVI_OBSTACLE_BALL, .radius = 1};
  ball.point[2] = -2;
  check_symmetries(cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){0}),
                   "momentum_x momentum_y momentum_z angular_x angular_y angular_z ");
  check_symmetries(cube_with(DVI_ELASTIC_LINEAR, (dvi_elastic_terms){0}),
                   "momentum_x momentum_y momentum_z angular_x angular_y angular_z ");
  check_symmetries(
      cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){.condition = &slide, .conditions = 1}),
      "momentum_y momentum_z angular_x ");
  check_symmetries(cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){.load = &down, .loads = 1}),
                   "momentum_x momentum_y angular_z ");
  check_symmetries(cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){.load = &unknown, .loads = 1}),
                   "");
  check_symmetries(
      cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){.obstacle = &floor, .obstacles = 1}),
      "momentum_x momentum_y angular_z ");
  check_symmetries(
      cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){.obstacle = &ball, .obstacles = 1}),
      "angular_z ");
  floor.friction = 0.1;
  check_symmetries(
      cube_with(DVI_ELASTIC_SVK, (dvi_elastic_terms){.obstacle = &floor, .obstacles = 1}), "");
  check_symmetries(block(2, 2, 1, DVI_ELASTIC_NEO_HOOKEAN), "momentum_x momentum_y angular ");
  dvi_elastic_material turned = unit_material(DVI_ELASTIC_ENERGY);
  turned.energy = fancy, turned.user = &two;
  check_symmetries(solid_on(grid_mesh("kuhn", 2, 2, 1), turned, (dvi_elastic_terms){0}),
                   "momentum_x momentum_y ");
}
END_TEST

/* ---- contacts ---- */

/* Nodes of the boundary above a ball in a plane, and of those in a hollow one: gaps, and patterns
 * by differences. Friction has unit tangents at right angles to the gradient. */
START_TEST(contacts_are_the_distances_of_nodes)
{
  const dvi_obstacle obstacles[] = {
      {.name = "floor", .point = {0, -1}, .normal = {3, 4}, .friction = 0.2},
      {.name = "ball", .kind = DVI_OBSTACLE_BALL, .point = {0.5, -2}, .radius = 1},
      {.name = "box", .kind = DVI_OBSTACLE_HOLLOW, .point = {0.5, 0}, .radius = 3}};
  const dvi_elastic_condition driven = {
      .part = "left", .component = {1}, .displacement = lift_left};
  dvi_elastic *solid = solid_on(
      grid_mesh("kuhn", 2, 2, 1), unit_material(DVI_ELASTIC_SVK),
      (dvi_elastic_terms){
          .obstacle = obstacles, .obstacles = 3, .condition = &driven, .conditions = 1});
  dvi_system *system = system_of_solid(solid);
  dvi_system_terms terms;
  double q[18] = {0}, v[18], phi, T[2], phi_q[2];
  ck_assert_int_eq(dvi_elastic_system_terms(solid, &terms), DVI_OK);
  ck_assert_int_eq(terms.contact_count, 3 * 8);
  ck_assert_str_eq(dvi_system_contact_name(system, 8 + 2), "ball at vertex 2");
  const dvi_contact *c = terms.contacts + 2; /* the node (1, 0) */
  ck_assert_int_eq(c->gap(0, q, &phi, c->user), 0);
  ck_assert_double_eq_tol(phi, 0.6 + 0.8, 1e-15);
  ck_assert_int_eq(c->tangent(0, q, T, c->user), 0);
  ck_assert_int_eq(c->gradient(0, q, phi_q, c->user), 0);
  ck_assert_double_eq_tol(T[0] * phi_q[0] + T[1] * phi_q[1], 0, 1e-16);
  ck_assert_double_eq_tol(T[0] * T[0] + T[1] * T[1], 1, 1e-15);
  c = terms.contacts + 8 + 2;
  ck_assert_int_eq(c->gap(0, q, &phi, c->user), 0);
  ck_assert_double_eq_tol(phi, sqrt(4.25) - 1, 1e-15);
  c = terms.contacts + 16 + 2;
  ck_assert_int_eq(c->gap(0, q, &phi, c->user), 0);
  ck_assert_double_eq_tol(phi, 3 - 0.5, 1e-15);
  fill(18, q, v);
  ck_assert_msg(dvi_system_check(system, 0.4, q, v, 1e-8, NULL) == DVI_OK, "%s", dvi_last_error());
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* The tangents of a node in space are an orthonormal frame with the normal, wherever it looks. */
START_TEST(frames_of_friction_are_orthonormal)
{
  for (int i = 0; i < 12; i++) {
    const dvi_obstacle floor = {.name = "floor",
                                .point = {-5, -5, -5},
                                .normal = {sin(i), cos(2.0 * i), i % 3 == 0 ? 0 : 0.4 * i},
                                .friction = 1};
    dvi_elastic *solid = cube_with(DVI_ELASTIC_SVK,
                                   (dvi_elastic_terms){.obstacle = &floor, .obstacles = 1});
    dvi_system_terms terms;
    const double q[24] = {0};
    double frame[3][3];
    ck_assert_int_eq(dvi_elastic_system_terms(solid, &terms), DVI_OK);
    const dvi_contact *c = terms.contacts;
    ck_assert_int_eq(c->tangent_count, 2);
    ck_assert_int_eq(c->gradient(0, q, frame[0], c->user), 0);
    ck_assert_int_eq(c->tangent(0, q, frame[1], c->user), 0);
    for (int r = 0; r < 3; r++)
      for (int s = 0; s < 3; s++) {
        double product = 0;
        for (int k = 0; k < 3; k++) product += frame[r][k] * frame[s][k];
        ck_assert_double_eq_tol(product, r == s, 1e-15);
      }
    dvi_elastic_destroy(&solid);
  }
}
END_TEST

/* ---- memory ---- */

static dvi_status try_all(const dvi_elastic_terms *terms)
{
  dvi_elastic *solid = NULL;
  dvi_system *system = NULL;
  double lambda[2];
  const dvi_modes_options options = {.size = sizeof options, .count = 2};
  dvi_status status = dvi_elastic_create(terms, &solid);
  if (status == DVI_OK) status = dvi_elastic_system(solid, &system);
  if (status == DVI_OK) status = dvi_elastic_modes(solid, &options, lambda, NULL, NULL);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
  return status;
}

START_TEST(failing_allocations_are_told)
{
  const dvi_elastic_load load = {.part = "all", .force = constant_weight, .is_steady = 1};
  const dvi_elastic_condition held = {.part = "left", .component = {1}};
  const dvi_obstacle floor = {.name = "floor", .normal = {0, 1}, .point = {0, -1}};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  material.beta = 0.1;
  dvi_mesh *mesh = grid_mesh("kuhn", 2, 2, 1);
  const dvi_elastic_terms terms = {.size = sizeof terms,
                                   .mesh = mesh,
                                   .material = &material,
                                   .materials = 1,
                                   .condition = &held,
                                   .conditions = 1,
                                   .load = &load,
                                   .loads = 1,
                                   .obstacle = &floor,
                                   .obstacles = 1};
  dvi_status status = DVI_NO_MEMORY;
  int successes = 0;
  for (; successes < 1000 && status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = try_all(&terms);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
  }
  ck_assert(status == DVI_OK && successes > 40);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(elastic_systems)
{
  tcase_add_loop_test(tests, callbacks_have_the_derivatives_and_patterns_that_they_declare, 0,
                      KINDS);
  tcase_add_loop_test(tests, potentials_are_the_energies_of_the_solid, 0, KINDS);
  tcase_add_loop_test(tests, damping_pulls_by_the_rates_of_all_nodes, 0, KINDS);
  tcase_add_test(tests, a_step_names_the_cell_whose_law_is_not_defined);
  tcase_add_test(tests, symmetries_are_those_that_conditions_loads_and_obstacles_allow);
  tcase_add_test(tests, contacts_are_the_distances_of_nodes);
  tcase_add_test(tests, frames_of_friction_are_orthonormal);
  tcase_add_test(tests, failing_allocations_are_told);
}
