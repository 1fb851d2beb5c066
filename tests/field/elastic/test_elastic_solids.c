/* Elastic solids at rest: the patch test, stresses, energies, frequencies, and bad input. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field/elastic/elastic.h"
#include "support/field/generated.h"
#include "support/field/solids.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- affine displacements ---- */

enum { CELLS = 3 };

/* H of an affine displacement, of which a plane takes the first entries. */
static const double affine[3][3] = {{0.1, 0.2, -0.05}, {-0.12, 0.05, 0.07}, {0.03, -0.1, -0.08}};

static void displace(const dvi_elastic *solid, double *u)
{
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const double *X = dvi_mesh_points(mesh);
  const int n = dvi_mesh_dimension(mesh);
  for (int64_t k = 0; k < dvi_mesh_count(mesh, 0) * n; k++) {
    u[k] = 0;
    for (int j = 0; j < n && j < 3; j++) u[k] += affine[k % n][j] * X[k / n * n + j];
  }
}

/* Inner nodes of a mesh without any order are in equilibrium, and all cells have one stress.
 * Roundings are those of gradients of some cells, which are a few units of size 10. */
START_TEST(affine_displacements_have_one_stress_and_are_in_equilibrium)
{
  for (int n = 2; n <= 3; n++) {
    dvi_elastic *solid = solid_on(jittered_mesh(n, n, CELLS, 0.2, 5),
                                  unit_material((dvi_elastic_law)_i), (dvi_elastic_terms){0});
    const int64_t numbers = solid->vertices * n;
    double *u = calloc((size_t)(2 * numbers), sizeof *u), *f = u + numbers,
           *stress = calloc((size_t)(solid->cells * n * n), sizeof *stress);
    displace(solid, u);
    for (int64_t c = 0; c < solid->cells; c++) {
      double own[DVI__SOLID_NUMBERS], pull[DVI__SOLID_NUMBERS];
      dvi__solid_gather(solid, c, u, own);
      ck_assert_int_eq(dvi__solid_force(solid, c, own, pull), 0);
      for (int k = 0; k < (n + 1) * n; k++)
        f[solid->vertex[c * (n + 1) + k / n] * n + k % n] += pull[k];
    }
    for (int64_t k = 0; k < numbers; k++)
      if (!solid->is_outer[k / n]) ck_assert_double_eq_tol(f[k], 0, 1e-14);
    ck_assert_int_eq(dvi_elastic_stress(solid, 0, NULL, u, stress), DVI_OK);
    for (int64_t k = 0; k < solid->cells * n * n; k++)
      ck_assert_double_eq_tol(stress[k], stress[k % (n * n)], 1e-13);
    free(u);
    free(stress);
    dvi_elastic_destroy(&solid);
  }
}
END_TEST

/* Cauchy's stress of x = (a X, b Y, c Z) has the entries P_i F_i/J, with lambda = mu = 1 and
 * P_i = F_i (tr E + 2 E_i), or P_i = F_i + (ln J - 1)/F_i. */
START_TEST(stretched_cells_have_the_stress_of_their_law)
{
  const double F[3] = {1.2, 0.9, 1.05}, J = F[0] * F[1] * F[2];
  const int is_svk = _i == DVI_ELASTIC_SVK;
  dvi_elastic *solid = block(3, 1, 1, (dvi_elastic_law)_i);
  double u[24], stress[54], trace = 0;
  for (int k = 0; k < 24; k++) u[k] = (F[k % 3] - 1) * solid->point[k];
  for (int i = 0; i < 3; i++) trace += (F[i] * F[i] - 1) / 2;
  ck_assert_int_eq(dvi_elastic_stress(solid, 0, NULL, u, stress), DVI_OK);
  for (int k = 0; k < 54; k++) {
    const int i = k % 9 / 3, is_diagonal = k % 9 % 4 == 0;
    const double P = is_svk ? F[i] * (trace + F[i] * F[i] - 1) : F[i] + (log(J) - 1) / F[i];
    ck_assert_double_eq_tol(stress[k], is_diagonal ? P * F[i] / J : 0, 1e-14);
  }
  dvi_elastic_destroy(&solid);
}
END_TEST

/* Terms of W cancel in a turn, each of which has roundings of 1e-17. */
START_TEST(turns_and_translations_store_nothing)
{
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_NEO_HOOKEAN);
  dvi_elastic_energies energies;
  double u[81];
  for (int a = 0; a < 27; a++) {
    const double *X = solid->point + 3L * a, c = cos(0.5), s = sin(0.5);
    u[3 * a] = c * X[0] - s * X[1] - X[0] + 4;
    u[3 * a + 1] = s * X[0] + c * X[1] - X[1] - 7;
    u[3 * a + 2] = 1;
  }
  ck_assert_int_eq(dvi_elastic_energy(solid, 0, u, NULL, NULL, &energies), DVI_OK);
  ck_assert_double_eq_tol(energies.stored, 0, 1e-16);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- energies ---- */

static int weight(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)X, (void)user;
  ck_assert_ptr_null(normal);
  force[0] = force[1] = 0;
  force[2] = -3 * (1 + t);
  return 0;
}

/* A pressure of 2 on the right face, where the normal is (1, 0, 0). */
static int pressure(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)t, (void)user;
  ck_assert_double_eq_tol(X[0], 1, 1e-15);
  for (int i = 0; i < 3; i++) {
    ck_assert_double_eq_tol(normal[i], i == 0, 1e-15);
    force[i] = -2 * normal[i];
  }
  return 0;
}

/* A weight of 3 a volume, lifted by 0.5, has the energy 1.5 at t = 0, and the pressure of 2 on a
 * face that moves by 0.25 has 0.5. The kinetic energy is that of a velocity of length 3. */
START_TEST(energies_are_those_of_weight_pressure_and_motion)
{
  const dvi_elastic_load loads[] = {{.part = "all", .force = weight},
                                    {.part = "right", .force = pressure, .is_steady = 1}};
  dvi_elastic *solid = solid_on(grid_mesh("kuhn", 3, 2, 1.5), unit_material(DVI_ELASTIC_LINEAR),
                                (dvi_elastic_terms){.load = loads, .loads = 2});
  dvi_elastic_energies energies;
  double u[81], rate[81];
  for (int a = 0; a < 27; a++)
    for (int i = 0; i < 3; i++) {
      u[3 * a + i] = i == 0 ? 0.25 : i == 2 ? 0.5 : 0;
      rate[3 * a + i] = i == 0 ? 1 : 2;
    }
  ck_assert_int_eq(dvi_elastic_energy(solid, 1, u, rate, NULL, &energies), DVI_OK);
  ck_assert_double_eq_tol(energies.load, 3 + 0.5, 1e-14);
  ck_assert_double_eq_tol(energies.kinetic, 4.5, 1e-14);
  ck_assert_double_eq_tol(energies.stored, 0, 1e-28);
  ck_assert_int_eq(dvi_elastic_energy(solid, 0, u, rate, "right", &energies), DVI_BAD_ARGUMENT);
  check_words("the energy of part \"right\" is asked, which has no cells");
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(masses_are_parts_of_cells_and_coordinates_their_displacements)
{
  const dvi_elastic_condition held = {.part = "left", .component = {1, 0, 0}};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  material.rho = 2.5;
  dvi_elastic *solid = solid_on(jittered_mesh(2, 2, CELLS, 0.2, 3), material,
                                (dvi_elastic_terms){0});
  double sum = 0;
  for (int64_t a = 0; a < solid->vertices; a++) sum += dvi_elastic_masses(solid)[a];
  ck_assert_double_eq_tol(sum, 2.5, 1e-14);
  dvi_elastic_destroy(&solid);
  solid = solid_on(grid_mesh("kuhn", 2, 1, 1), material,
                   (dvi_elastic_terms){.condition = &held, .conditions = 1});
  int64_t unknowns;
  const int *unknown = dvi_elastic_unknowns(solid, &unknowns);
  const double u[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  double q[6], v[6], p[6], lifted[8], rate[8];
  ck_assert_int_eq((int)unknowns, 6);
  dvi_elastic_project(solid, u, u, q, v, p);
  ck_assert_int_eq(dvi_elastic_lift(solid, 0, q, p, lifted, rate), DVI_OK);
  for (int k = 0; k < 8; k++) {
    const int is_held = solid->point[k / 2 * 2] == 0 && k % 2 == 0;
    ck_assert_int_eq(unknown[k] < 0, is_held);
    ck_assert(lifted[k] == (is_held ? 0 : u[k]) && rate[k] == lifted[k]);
    if (!is_held) ck_assert(p[unknown[k]] == u[k] * solid->mass[k / 2]);
  }
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- frequencies ---- */

/* A bar of length 1 along x, of which y and z are held, has longitudinal waves with
 * c^2 = (lambda + 2 mu)/rho = 3. Held at the left its lowest frequency is pi c/2. */
static double lowest_of_bar(int cells)
{
  const dvi_elastic_condition conditions[] = {{.part = "left"},
                                              {.part = "all", .component = {0, 1, 1}}};
  const dvi_generator_options options = {.cells = {cells, 1, 1}, .extent = {1, 0.1, 0.1}};
  dvi_elastic *solid = solid_on(generated("kuhn", options), unit_material(DVI_ELASTIC_SVK),
                                (dvi_elastic_terms){.condition = conditions, .conditions = 2});
  const dvi_modes_options one = {.size = sizeof one, .count = 1};
  double lambda;
  int64_t zeros;
  ck_assert_msg(dvi_elastic_modes(solid, &one, &lambda, NULL, &zeros) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq((int)zeros, 0);
  dvi_elastic_destroy(&solid);
  return sqrt(lambda);
}

START_TEST(lowest_frequency_of_a_bar_has_order_2)
{
  const double exact = pi * sqrt(3) / 2;
  double last = 0;
  for (int cells = 10; cells <= 80; cells *= 2) {
    const double error = fabs(lowest_of_bar(cells) - exact);
    if (last > 0) ck_assert_double_eq_tol(log2(last / error), 2, 0.1);
    last = error;
  }
}
END_TEST

/* Modes without strain are left out: six of a free solid, three of a free plane one, and of one
 * whose z displacements are held three. The rest is orthonormal, and is not zero. */
START_TEST(rigid_motions_are_left_out_of_the_modes)
{
  const dvi_elastic_condition flat = {.part = "all", .component = {0, 0, 1}};
  for (int is_held = 0; is_held < 2; is_held++)
    for (int n = 2 + is_held; n <= 3; n++) {
      dvi_elastic *solid = solid_on(grid_mesh("kuhn", n, 2, 1.3),
                                    unit_material(DVI_ELASTIC_NEO_HOOKEAN),
                                    (dvi_elastic_terms){.condition = &flat, .conditions = is_held});
      const dvi_modes_options options = {.size = sizeof options, .count = 3};
      double lambda[3], omega, *mode = calloc((size_t)(3 * solid->vertices * n), sizeof *mode);
      int64_t zeros;
      ck_assert_int_eq(dvi_elastic_modes(solid, &options, lambda, mode, &zeros), DVI_OK);
      ck_assert_int_eq((int)zeros, n == 2 || is_held ? 3 : 6);
      ck_assert_int_eq(dvi_elastic_fastest(solid, &omega), DVI_OK);
      ck_assert(lambda[0] > 0.1 && lambda[0] <= lambda[1] && lambda[2] < omega * omega);
      for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) {
          double product = 0;
          for (int64_t k = 0; k < solid->vertices * n; k++)
            product += solid->mass[k / n] * mode[r * solid->vertices * n + k] *
                       mode[s * solid->vertices * n + k];
          ck_assert_double_eq_tol(product, r == s, 1e-10);
        }
      free(mode);
      dvi_elastic_destroy(&solid);
    }
}
END_TEST

/* The element bound: the largest frequency of the solid is at most that of its cells (Irons and
 * Treharne 1971). */
START_TEST(no_frequency_exceeds_those_of_the_cells)
{
  dvi_elastic *solid = solid_on(jittered_mesh(3, 3, 2, 0.2, 8), unit_material(DVI_ELASTIC_SVK),
                                (dvi_elastic_terms){0});
  double omega, largest = 0;
  ck_assert_int_eq(dvi_elastic_fastest(solid, &omega), DVI_OK);
  for (int64_t c = 0; c < solid->cells; c++) {
    double lambda;
    ck_assert_int_eq(dvi__solid_largest(solid, c, &lambda), DVI_OK);
    largest = fmax(largest, lambda);
  }
  ck_assert(omega < sqrt(largest) && omega > 0.5 * sqrt(largest));
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- what is refused ---- */

START_TEST(inverted_cells_are_named)
{
  dvi_elastic *solid = block(3, 1, 1, (dvi_elastic_law)_i);
  dvi_elastic_energies energies;
  double u[24] = {0}, stress[54];
  for (int a = 0; a < 8; a++)
    if (solid->point[3 * a + 2] == 1) u[3 * a + 2] = -1.5;
  ck_assert_int_eq(dvi_elastic_stress(solid, 0, NULL, u, stress), DVI_SINGULAR);
  check_words("tetrahedron 0 (vertices 0 1 3 7) is inverted");
  const dvi_status status = dvi_elastic_energy(solid, 0, u, NULL, NULL, &energies);
  ck_assert_int_eq(status, _i == DVI_ELASTIC_SVK ? DVI_OK : DVI_SINGULAR);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(numbers_that_are_not_finite_are_not_inverted_cells)
{
  dvi_elastic *solid = block(3, 1, 1, (dvi_elastic_law)_i);
  dvi_elastic_energies energies = {.stored = 7};
  double u[24] = {0, 0, NAN}, stress[54];
  ck_assert_int_eq(dvi_elastic_stress(solid, 0, NULL, u, stress), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_elastic_energy(solid, 0, u, NULL, NULL, &energies), DVI_NOT_FINITE);
  u[2] = 0;
  ck_assert_int_eq(dvi_elastic_energy(solid, 0, u, (double[24]){1e200}, NULL, &energies),
                   DVI_NOT_FINITE);
  check_words("energies of tetrahedron 0 (vertices 0 1 3 7) are not finite");
  ck_assert_double_eq(energies.stored, 7);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* The terms of a wrong solid, all of which the mistakes may change. */
typedef struct wrong {
  dvi_elastic_terms terms;
  dvi_elastic_material material[2];
  dvi_elastic_condition condition;
  dvi_elastic_load load;
  dvi_obstacle obstacle;
} wrong;

/* mu |H|^2/2 + s tr H: `user` is s. It has no minimum at rest for s != 0. */
static int pulled(int64_t count, const double *F, double *W, double *P, double *Hessian, void *user)
{
  const double s = *(const double *)user;
  ck_assert_int_eq((int)count, 1);
  if (W != NULL) *W = 0;
  for (int k = 0; k < 9; k++) {
    const double H = F[k] - (k % 4 == 0);
    if (W != NULL) *W += H * H / 2 + (k % 4 == 0 ? s * H : 0);
    if (P != NULL) P[k] = H + (k % 4 == 0 ? s : 0);
    for (int j = 0; j <= k && Hessian != NULL; j++) *Hessian++ = k == j;
  }
  return 0;
}

static int refuses(int64_t count, const double *F, double *W, double *P, double *Hessian,
                   void *user)
{
  (void)count, (void)F, (void)W, (void)P, (void)Hessian, (void)user;
  return -7;
}

static int infinite(double t, const double *X, double *u, double *rate, void *user)
{
  (void)t, (void)X, (void)rate, (void)user;
  u[0] = INFINITY;
  return 0;
}

static int failing(double t, const double *X, double *u, double *rate, void *user)
{
  (void)t, (void)X, (void)u, (void)rate, (void)user;
  return 4;
}

static int failing_load(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)t, (void)X, (void)normal, (void)force, (void)user;
  return 5;
}

static int nan_load(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)t, (void)X, (void)normal, (void)user;
  force[0] = force[1] = force[2] = NAN;
  return 0;
}

static double one_half = 0.5;

static void no_mesh(wrong *w)
{
  w->terms.mesh = NULL;
}
static void no_size(wrong *w)
{
  w->terms.size = 8;
}
static void no_material(wrong *w)
{
  w->terms.materials = 0;
}
static void strange_part(wrong *w)
{
  w->material[0].part = "steel";
}
static void flat_part(wrong *w)
{
  w->material[0].part = "left";
}
static void no_part(wrong *w)
{
  w->material[0].part = NULL;
}
static void no_law(wrong *w)
{
  w->material[0].law = (dvi_elastic_law)9;
}
static void no_mu(wrong *w)
{
  w->material[0].mu = 0;
}
static void low_lambda(wrong *w)
{
  w->material[0].lambda = -0.7;
}
static void high_mooney(wrong *w)
{
  w->material[0].law = DVI_ELASTIC_MOONEY_RIVLIN;
  w->material[0].mooney = 1.5;
}
static void idle_mooney(wrong *w)
{
  w->material[0].mooney = 0.2;
}
static void no_rho(wrong *w)
{
  w->material[0].rho = NAN;
}
static void negative_alpha(wrong *w)
{
  w->material[0].alpha = -1;
}
static void no_energy(wrong *w)
{
  w->material[0].law = DVI_ELASTIC_ENERGY;
}
static void stressed(wrong *w)
{
  w->material[0].law = DVI_ELASTIC_ENERGY;
  w->material[0].energy = pulled;
  w->material[0].user = &one_half;
}
static void refused(wrong *w)
{
  w->material[0].law = DVI_ELASTIC_ENERGY;
  w->material[0].energy = refuses;
}
static void strange_condition(wrong *w)
{
  w->condition.part = "wall";
}
static void all_held(wrong *w)
{
  w->condition.part = "all";
}
static void infinite_condition(wrong *w)
{
  w->condition.displacement = infinite;
}
static void failing_condition(wrong *w)
{
  w->condition.displacement = failing;
}
static void strange_load(wrong *w)
{
  w->load.part = "roof";
}
static void no_force(wrong *w)
{
  w->load.force = NULL;
}
static void load_fails(wrong *w)
{
  w->load.force = failing_load;
}
static void load_is_nan(wrong *w)
{
  w->load.force = nan_load;
}
static void no_name(wrong *w)
{
  w->obstacle.name = NULL;
}
static void no_normal(wrong *w)
{
  w->obstacle.normal[2] = 0;
}
static void no_radius(wrong *w)
{
  w->obstacle.kind = DVI_OBSTACLE_BALL;
}
static void bouncy(wrong *w)
{
  w->obstacle.restitution = 1.5;
}
static void negative_friction(wrong *w)
{
  w->obstacle.friction = -1;
}

static const struct mistake {
  void (*make)(wrong *w);
  dvi_status status;
  const char *words;
} mistakes[] = {
    {no_mesh, DVI_BAD_ARGUMENT, "a mesh is needed"},
    {no_size, DVI_BAD_ARGUMENT, "the size of the terms is 8, not"},
    {no_material, DVI_BAD_ARGUMENT, "a material is needed, and 0 are given"},
    {strange_part, DVI_BAD_ARGUMENT, "set on part \"steel\", which the mesh has not"},
    {flat_part, DVI_BAD_ARGUMENT, "set on part \"left\", which has no cells"},
    {no_part, DVI_BAD_ARGUMENT, "a material has no part of the mesh"},
    {no_law, DVI_BAD_ARGUMENT, "has no law 9"},
    {no_mu, DVI_BAD_ARGUMENT, "mu of the material on part \"all\" is 0; a finite number above 0"},
    {low_lambda, DVI_BAD_ARGUMENT, "lambda of the material on part \"all\" is -0.7"},
    {high_mooney, DVI_BAD_ARGUMENT, "mooney of the material on part \"all\" is 1.5"},
    {idle_mooney, DVI_BAD_ARGUMENT, "is 0.2; a finite number of 0 with its law is needed"},
    {no_rho, DVI_BAD_ARGUMENT, "rho of the material on part \"all\" is nan"},
    {negative_alpha, DVI_BAD_ARGUMENT, "alpha of the material on part \"all\" is -1"},
    {no_energy, DVI_BAD_ARGUMENT, "the stored energy of the material on part \"all\" is missing"},
    {stressed, DVI_BAD_ARGUMENT, "has a stress of 0.5 at F = I"},
    {refused, DVI_CALLBACK_FAILED, "returned -7 at F = I"},
    {strange_condition, DVI_BAD_ARGUMENT, "set on part \"wall\", which the mesh has not"},
    {all_held, DVI_BAD_ARGUMENT, "all displacements of the 8 vertices are given"},
    {infinite_condition, DVI_NOT_FINITE, "given at vertex 0, or its rate, is not finite"},
    {failing_condition, DVI_CALLBACK_FAILED, "given at vertex 0 returned 4"},
    {strange_load, DVI_BAD_ARGUMENT, "a load is set on part \"roof\", which the mesh has not"},
    {no_force, DVI_BAD_ARGUMENT, "a load has no force"},
    {load_fails, DVI_CALLBACK_FAILED, "a load returned 5 at tetrahedron"},
    {load_is_nan, DVI_NOT_FINITE, "a load at tetrahedron"},
    {no_name, DVI_BAD_ARGUMENT, "obstacle 0 has no name"},
    {no_normal, DVI_BAD_ARGUMENT, "the length of the normal of obstacle \"floor\" is 0"},
    {no_radius, DVI_BAD_ARGUMENT, "the radius of obstacle \"floor\" is 0"},
    {bouncy, DVI_BAD_ARGUMENT, "the restitution of obstacle \"floor\" is 1.5"},
    {negative_friction, DVI_BAD_ARGUMENT, "the friction of obstacle \"floor\" is -1"},
};
enum { MISTAKES = sizeof mistakes / sizeof *mistakes };

START_TEST(bad_terms_have_their_sentences)
{
  for (int i = 0; i < MISTAKES; i++) {
    dvi_mesh *mesh = grid_mesh("kuhn", 3, 1, 1);
    dvi_elastic *solid = NULL;
    wrong w = {.material = {unit_material(DVI_ELASTIC_SVK)},
               .condition = {.part = "left"},
               .load = {.part = "right", .force = pressure, .is_steady = 1},
               .obstacle = {.name = "floor", .normal = {0, 0, 2}, .point = {0, 0, -1}}};
    w.terms = (dvi_elastic_terms){.size = sizeof w.terms,
                                  .mesh = mesh,
                                  .material = w.material,
                                  .materials = 1,
                                  .condition = &w.condition,
                                  .conditions = 1,
                                  .load = &w.load,
                                  .loads = 1,
                                  .obstacle = &w.obstacle,
                                  .obstacles = 1};
    ck_assert_int_eq(dvi_elastic_create(&w.terms, &solid), DVI_OK);
    dvi_elastic_destroy(&solid);
    mistakes[i].make(&w);
    ck_assert_msg(dvi_elastic_create(&w.terms, &solid) == mistakes[i].status, "%d: %s", i,
                  dvi_last_error());
    check_words(mistakes[i].words);
    ck_assert_ptr_null(solid);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

static void check_refused_mesh(dvi_mesh *mesh, const char *words)
{
  const dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  const dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = mesh, .material = &material, .materials = 1};
  dvi_elastic *solid = NULL;
  ck_assert_int_eq(dvi_elastic_create(&terms, &solid), DVI_UNSUPPORTED);
  check_words(words);
  dvi_mesh_destroy(&mesh);
}

START_TEST(other_meshes_are_refused)
{
  check_refused_mesh(grid_mesh("box", 3, 2, 1), "of the kind box in a space of 3 dimensions");
  check_refused_mesh(generated("icosphere", (dvi_generator_options){.cells = {1}}),
                     "of the kind triangle in a space of 3 dimensions");
  check_refused_mesh(grid_mesh("kuhn-torus", 2, 4, 1), "repeats itself along axis 0");
}
END_TEST

START_TEST(a_plane_has_no_third_component)
{
  const dvi_elastic_condition third = {.part = "left", .component = {0, 0, 1}};
  const dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  dvi_mesh *mesh = grid_mesh("kuhn", 2, 1, 1);
  const dvi_elastic_terms terms = {.size = sizeof terms,
                                   .mesh = mesh,
                                   .material = &material,
                                   .materials = 1,
                                   .condition = &third,
                                   .conditions = 1};
  dvi_elastic *solid = NULL;
  ck_assert_int_eq(dvi_elastic_create(&terms, &solid), DVI_BAD_ARGUMENT);
  check_words("the condition on part \"left\" is on component 2");
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(elastic_solids)
{
  tcase_add_loop_test(tests, affine_displacements_have_one_stress_and_are_in_equilibrium, 0,
                      DVI_ELASTIC_ENERGY);
  tcase_add_loop_test(tests, stretched_cells_have_the_stress_of_their_law, DVI_ELASTIC_SVK,
                      DVI_ELASTIC_NEO_HOOKEAN + 1);
  tcase_add_test(tests, turns_and_translations_store_nothing);
  tcase_add_test(tests, energies_are_those_of_weight_pressure_and_motion);
  tcase_add_test(tests, masses_are_parts_of_cells_and_coordinates_their_displacements);
  tcase_add_test(tests, lowest_frequency_of_a_bar_has_order_2);
  tcase_add_test(tests, rigid_motions_are_left_out_of_the_modes);
  tcase_add_test(tests, no_frequency_exceeds_those_of_the_cells);
  tcase_add_loop_test(tests, inverted_cells_are_named, DVI_ELASTIC_SVK, DVI_ELASTIC_ENERGY);
  tcase_add_loop_test(tests, numbers_that_are_not_finite_are_not_inverted_cells, 0,
                      DVI_ELASTIC_ENERGY);
  tcase_add_test(tests, bad_terms_have_their_sentences);
  tcase_add_test(tests, other_meshes_are_refused);
  tcase_add_test(tests, a_plane_has_no_third_component);
}
