/* Static problems of scalar fields: Dirichlet's, Neumann's, mixed ones, and with a potential. */
#include <dvi/field.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A problem on a mesh. Zero means none. */
typedef struct trial {
  dvi_mesh *mesh;
  dvi_star_kind kind;
  int conditions;
  dvi_condition condition[3];
  dvi_form_function *source;
  const dvi_field_potential *potential;
} trial;

static dvi_status create(const trial *t, dvi_field **field)
{
  const dvi_star_options options = {.size = sizeof options, .kind = t->kind};
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(t->mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = t->condition,
                                .conditions = t->conditions,
                                .source = t->source,
                                .potential = t->potential};
  const dvi_status status = dvi_wave_create(&terms, field);
  dvi_star_destroy(&star);
  return status;
}

/* Solve the problem. The caller frees the values. */
static double *solve(const trial *t, double mean)
{
  const dvi_field_solve_options options = {.size = sizeof options, .mean = mean};
  dvi_field_solve_report report;
  dvi_field *field = NULL;
  double *u = calloc((size_t)dvi_mesh_count(t->mesh, 0), sizeof *u);
  ck_assert_msg(create(t, &field) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_field_solve(field, &options, u, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert(report.residual < 1e-12);
  dvi_field_destroy(&field);
  return u;
}

typedef double solution(const double *x);

/* The largest error at the vertices, less that at the first one if only differences count. */
static double error_of(const trial *t, solution *exact, int differences)
{
  double *u = solve(t, 0), worst = 0;
  const int64_t count = dvi_mesh_count(t->mesh, 0);
  const int space = dvi_mesh_space(t->mesh);
  const double *point = dvi_mesh_points(t->mesh), first = u[0] - exact(point);
  for (int64_t v = 0; v < count; v++)
    worst = fmax(worst, fabs(u[v] - exact(point + v * space) - (differences ? first : 0)));
  free(u);
  return worst;
}

/* ---- Dirichlet's problem ---- */

static int bump_source(const double *x, double *f, void *user)
{
  (void)user;
  *f = 2 * pi * pi * sin(pi * x[0]) * sin(pi * x[1]);
  return 0;
}

static double bump(const double *x)
{
  return sin(pi * x[0]) * sin(pi * x[1]);
}

static double bump_error(int cells, dvi_star_kind kind)
{
  dvi_mesh *mesh = staggered_mesh(cells, cells);
  const trial t = {.mesh = mesh,
                   .kind = kind,
                   .conditions = 1,
                   .condition = {{.part = "boundary", .kind = DVI_FIXED}},
                   .source = bump_source};
  const double error = error_of(&t, bump, 0);
  dvi_mesh_destroy(&mesh);
  return error;
}

START_TEST(poisson_problem_has_second_order)
{
  double last = bump_error(8, DVI_CIRCUMCENTRIC);
  ck_assert_double_eq_tol(last, 2.0206e-2, 1e-6);
  for (int cells = 16; cells <= 64; cells *= 2) {
    const double error = bump_error(cells, DVI_CIRCUMCENTRIC);
    ck_assert_msg(log2(last / error) > 1.95, "order %g at %d", log2(last / error), cells);
    last = error;
  }
}
END_TEST

START_TEST(finite_elements_have_second_order)
{
  double last = bump_error(8, DVI_WHITNEY);
  for (int cells = 16; cells <= 64; cells *= 2) {
    const double error = bump_error(cells, DVI_WHITNEY);
    ck_assert_msg(log2(last / error) > 1.9, "order %g at %d", log2(last / error), cells);
    last = error;
  }
}
END_TEST

/* In two dimensions the formula of cotangents is that of linear finite elements, cell by cell. */
START_TEST(stiffness_of_the_plane_is_that_of_finite_elements)
{
  for (unsigned long long seed = 1; seed <= 10; seed++) {
    dvi_mesh *mesh = jittered_mesh(2, 2, 6, 0.25, seed);
    const int64_t cells = dvi_mesh_count(mesh, 2), vertices = dvi_mesh_count(mesh, 0);
    double *a = malloc((size_t)cells * sizeof *a), *u = calloc((size_t)(3 * vertices), sizeof *u);
    unsigned long long state = seed;
    for (int64_t c = 0; c < cells; c++) a[c] = 0.2 + 3 * random_number(&state);
    for (int64_t v = 0; v < vertices; v++) u[v] = random_number(&state);
    const double *const factor[] = {NULL, a, NULL};
    for (int i = 0; i < 2; i++) {
      const dvi_star_options options = {.size = sizeof options,
                                        .kind = i == 0 ? DVI_BARYCENTRIC : DVI_CIRCUMCENTRIC,
                                        .factor = factor};
      dvi_star *star = NULL;
      dvi_matrix *K = NULL;
      ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_OK);
      ck_assert_int_eq(dvi_form_laplacian_create(star, 0, &K), DVI_OK);
      dvi_matrix_multiply(K, 0, u, u + (1 + i) * vertices);
      dvi_matrix_destroy(&K);
      dvi_star_destroy(&star);
    }
    for (int64_t v = 0; v < vertices; v++)
      ck_assert_double_eq_tol(u[vertices + v], u[2 * vertices + v], 1e-11);
    free(a), free(u);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- Neumann's problem ---- */

static double wave_of_laplace(const double *x)
{
  return exp(x[0]) * sin(x[1]);
}

static int flux_of_laplace(const double *x, const double *normal, double *flux, void *user)
{
  (void)user;
  *flux = exp(x[0]) * (normal[0] * sin(x[1]) + normal[1] * cos(x[1]));
  return 0;
}

static double laplace_error(int cells)
{
  dvi_mesh *mesh = staggered_mesh(cells, cells);
  const trial t = {
      .mesh = mesh, .conditions = 1, .condition = {{.part = "boundary", .datum = flux_of_laplace}}};
  const double error = error_of(&t, wave_of_laplace, 1);
  dvi_mesh_destroy(&mesh);
  return error;
}

START_TEST(flux_gives_the_solution_up_to_a_constant)
{
  double last = laplace_error(8);
  ck_assert_double_eq_tol(last, 1.41267e-2, 1e-7);
  for (int cells = 16; cells <= 64; cells *= 2) {
    const double error = laplace_error(cells), order = log2(last / error);
    ck_assert_msg(order > 1.65 && order < 2.1, "order %g at %d", order, cells);
    last = error;
  }
}
END_TEST

static double affine(const double *x)
{
  return 0.3 * x[0] - 0.7 * x[1] + 1.1 * x[2] + 0.2 * x[3];
}

static int affine_flux(const double *x, const double *normal, double *flux, void *user)
{
  (void)x;
  const int space = *(int *)user;
  const double slope[] = {0.3, -0.7, 1.1, 0.2};
  *flux = 0;
  for (int l = 0; l < space; l++) *flux += slope[l] * normal[l];
  return 0;
}

static double affine_error(const dvi_mesh *mesh, dvi_star_kind kind)
{
  int space = dvi_mesh_space(mesh);
  const trial t = {.mesh = dvi_mesh_share(mesh),
                   .kind = kind,
                   .conditions = 1,
                   .condition = {{.part = "boundary", .datum = affine_flux, .user = &space}}};
  double *u = solve(&t, 0), worst = 0, mean = 0;
  const int64_t count = dvi_mesh_count(mesh, 0);
  for (int pass = 0; pass < 2; pass++)
    for (int64_t v = 0; v < count; v++) {
      double x[4] = {0};
      memcpy(x, dvi_mesh_points(mesh) + v * space, (size_t)space * sizeof *x);
      const double difference = u[v] - affine(x);
      if (pass == 0) mean += difference / (double)count;
      if (pass == 1) worst = fmax(worst, fabs(difference - mean));
    }
  free(u);
  dvi_mesh *shared = t.mesh;
  dvi_mesh_destroy(&shared);
  return worst;
}

START_TEST(linear_functions_solve_their_problem_exactly)
{
  const dvi_star_kind kinds[] = {DVI_CIRCUMCENTRIC, DVI_BARYCENTRIC, DVI_WHITNEY};
  for (int n = 1; n <= 4; n++) {
    const int cells = n < 3 ? 5 : 2;
    dvi_generator_options options = {.size = sizeof options, .dimension = n};
    for (int i = 0; i < n; i++) options.cells[i] = cells;
    dvi_mesh *jittered = jittered_mesh(n, n, cells, 0.1, 5), *box = NULL;
    ck_assert_int_eq(dvi_mesh_generate("box", &options, &box), DVI_OK);
    for (int k = 0; k < 3; k++) {
      ck_assert_msg(affine_error(jittered, kinds[k]) < 1e-12, "simplices, n = %d, star %d", n, k);
      ck_assert_msg(affine_error(box, kinds[k]) < 1e-12, "boxes, n = %d, star %d", n, k);
    }
    dvi_mesh_destroy(&jittered);
    dvi_mesh_destroy(&box);
  }
}
END_TEST

static int flux_of_one(const double *x, const double *normal, double *flux, void *user)
{
  (void)x, (void)normal, (void)user;
  *flux = 1;
  return 0;
}

START_TEST(unbalanced_data_are_refused_or_taken_away)
{
  dvi_mesh *mesh = staggered_mesh(4, 4);
  const trial t = {
      .mesh = mesh, .conditions = 1, .condition = {{.part = "boundary", .datum = flux_of_one}}};
  dvi_field *field = NULL;
  double u[64] = {0};
  dvi_field_solve_options options = {.size = sizeof options, .imbalance = 1.1, .mean = 0.5};
  dvi_field_solve_report report;
  ck_assert_int_eq(create(&t, &field), DVI_OK);
  ck_assert_int_eq(dvi_field_solve(field, NULL, u, NULL), DVI_BAD_ARGUMENT);
  ck_assert(strstr(dvi_last_error(), "sum to") != NULL);
  for (int i = 0; i < 64; i++) ck_assert(u[i] == 0);
  ck_assert_int_eq(dvi_field_solve(field, &options, u, &report), DVI_OK);
  ck_assert_double_eq_tol(report.imbalance, 1, 1e-14);
  const double *load = dvi_field_load(field);
  double sum = 0;
  for (int64_t i = 0; i < report.unknowns; i++) sum += load[i];
  ck_assert_double_eq_tol(sum, 4, 1e-13); /* the circumference */
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(mean_of_the_solution_is_as_asked)
{
  dvi_mesh *mesh = staggered_mesh(6, 6);
  dvi_matrix M;
  dvi_star *star = NULL;
  const trial t = {
      .mesh = mesh, .conditions = 1, .condition = {{.part = "boundary", .datum = flux_of_laplace}}};
  double *u = solve(&t, 2.5), sum = 0;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 0, &M), DVI_OK);
  for (int64_t v = 0; v < M.rows; v++) sum += M.value[v] * u[v];
  ck_assert_double_eq_tol(sum, 2.5, 1e-13);
  free(u);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static int value_of_three(const double *x, const double *normal, double *value, void *user)
{
  (void)x, (void)normal, (void)user;
  *value = 3;
  return 0;
}

/* Two strings, of which the second one has a fixed end. */
START_TEST(each_component_has_its_own_mean)
{
  static const double point[] = {0, 1, 2, 5, 6, 7, 8};
  static const int vertex[] = {0, 1, 1, 2, 3, 4, 4, 5, 5, 6}, end = 6;
  const dvi_mesh_part part = {.name = "end", .count = 1, .cell = &end};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 1,
                                .points = 7,
                                .point = point,
                                .cells = 5,
                                .vertex = vertex,
                                .part = &part,
                                .parts = 1};
  dvi_mesh *mesh = NULL;
  dvi_field *field = NULL;
  double eigenvalue;
  int64_t zeros;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  const trial t = {.mesh = mesh,
                   .conditions = 1,
                   .condition = {{.part = "end", .kind = DVI_FIXED, .datum = value_of_three}}};
  const dvi_modes_options one = {.size = sizeof one, .count = 1};
  ck_assert_int_eq(create(&t, &field), DVI_OK);
  ck_assert_int_eq(dvi_field_modes(field, &one, &eigenvalue, NULL, &zeros), DVI_OK);
  ck_assert_int_eq(zeros, 1);
  double *u = solve(&t, 0.25);
  for (int v = 0; v < 7; v++) ck_assert_double_eq_tol(u[v], v < 3 ? 0.25 : 3, 1e-14);
  free(u);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- mixed data ---- */

static int value_of_laplace(const double *x, const double *normal, double *value, void *user)
{
  (void)user;
  ck_assert_ptr_null(normal);
  *value = wave_of_laplace(x);
  return 0;
}

/* Of the corners, where fixed sides meet fluxes, each condition says its own. */
static double mixed_error(int cells)
{
  dvi_mesh *mesh = NULL;
  const dvi_generator_options options = {.size = sizeof options, .cells = {cells, cells}};
  ck_assert_int_eq(dvi_mesh_generate("staggered", &options, &mesh), DVI_OK);
  const trial t = {.mesh = mesh,
                   .conditions = 3,
                   .condition = {{.part = "boundary", .datum = flux_of_laplace},
                                 {.part = "left", .kind = DVI_FIXED, .datum = value_of_laplace},
                                 {.part = "bottom", .kind = DVI_FIXED}}};
  const double error = error_of(&t, wave_of_laplace, 0);
  dvi_mesh_destroy(&mesh);
  return error;
}

START_TEST(mixed_data_have_second_order)
{
  double last = mixed_error(8);
  for (int cells = 16; cells <= 64; cells *= 2) {
    const double error = mixed_error(cells), order = log2(last / error);
    ck_assert_msg(order > 1.6 && order < 2.2, "order %g at %d", order, cells);
    last = error;
  }
}
END_TEST

/* ---- a potential ---- */

static int pendulum_density(int64_t count, const double *x, const double *u, double *V, double *V_u,
                            double *V_uu, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) {
    if (V != NULL) V[i] = 1 - cos(u[i]);
    if (V_u != NULL) V_u[i] = sin(u[i]);
    if (V_uu != NULL) V_uu[i] = cos(u[i]);
  }
  return 0;
}

static double kink(const double *x)
{
  return 4 * atan(exp(x[0]));
}

static int kink_value(const double *x, const double *normal, double *value, void *user)
{
  (void)normal, (void)user;
  *value = kink(x);
  return 0;
}

static double kink_error(int cells)
{
  static const dvi_field_potential potential = {.density = pendulum_density};
  const dvi_generator_options options = {
      .size = sizeof options, .cells = {cells}, .extent = {8}, .origin = {-3}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("interval", &options, &mesh), DVI_OK);
  const trial t = {.mesh = mesh,
                   .conditions = 1,
                   .condition = {{.part = "boundary", .kind = DVI_FIXED, .datum = kink_value}},
                   .potential = &potential};
  const double error = error_of(&t, kink, 0);
  dvi_mesh_destroy(&mesh);
  return error;
}

START_TEST(kink_has_second_order)
{
  double last = kink_error(32);
  for (int cells = 64; cells <= 256; cells *= 2) {
    const double error = kink_error(cells);
    ck_assert_msg(fabs(log2(last / error) - 2) < 0.05, "order %g", log2(last / error));
    last = error;
  }
}
END_TEST

/* ---- what is refused ---- */

static void refuse(const trial *t, dvi_status status, const char *sentence)
{
  dvi_field *field = NULL;
  ck_assert_int_eq(create(t, &field), status);
  ck_assert_ptr_null(field);
  ck_assert_msg(strstr(dvi_last_error(), sentence) != NULL, "%s", dvi_last_error());
}

static int not_a_number(const double *x, const double *normal, double *value, void *user)
{
  (void)x, (void)normal, (void)user;
  *value = NAN;
  return 0;
}

static int failing_source(const double *x, double *f, void *user)
{
  (void)x, (void)user;
  *f = 0;
  return 7;
}

START_TEST(wrong_terms_are_refused)
{
  dvi_mesh *mesh = staggered_mesh(3, 3), *kuhn = NULL, *torus = NULL;
  const dvi_generator_options options = {.size = sizeof options, .cells = {3, 3}};
  ck_assert_int_eq(dvi_mesh_generate("kuhn-torus", &options, &torus), DVI_OK);
  trial t = {.mesh = mesh, .conditions = 1, .condition = {{.part = "rim"}}};
  refuse(&t, DVI_BAD_ARGUMENT, "\"rim\"");
  t.condition[0] = (dvi_condition){.part = "all", .kind = DVI_FIXED};
  refuse(&t, DVI_BAD_ARGUMENT, "nothing is unknown");
  t.condition[0] = (dvi_condition){.part = "boundary", .kind = (dvi_condition_kind)5};
  refuse(&t, DVI_BAD_ARGUMENT, "no kind 5");
  t.condition[0] = (dvi_condition){.part = "boundary", .kind = DVI_FIXED, .datum = not_a_number};
  refuse(&t, DVI_NOT_FINITE, "vertex");
  t.condition[0] = (dvi_condition){.part = "boundary", .datum = not_a_number};
  refuse(&t, DVI_NOT_FINITE, "flux on part \"boundary\"");
  t.conditions = 0;
  t.source = failing_source;
  refuse(&t, DVI_CALLBACK_FAILED, "source returned 7");
  t = (trial){.mesh = torus, .conditions = 1, .condition = {{.part = "all", .datum = flux_of_one}}};
  refuse(&t, DVI_BAD_ARGUMENT, "0 are of the boundary");
  dvi_mesh_destroy(&torus);
  dvi_mesh_destroy(&kuhn);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(statics)
{
  tcase_add_test(tests, poisson_problem_has_second_order);
  tcase_add_test(tests, finite_elements_have_second_order);
  tcase_add_test(tests, stiffness_of_the_plane_is_that_of_finite_elements);
  tcase_add_test(tests, flux_gives_the_solution_up_to_a_constant);
  tcase_add_test(tests, linear_functions_solve_their_problem_exactly);
  tcase_add_test(tests, unbalanced_data_are_refused_or_taken_away);
  tcase_add_test(tests, mean_of_the_solution_is_as_asked);
  tcase_add_test(tests, each_component_has_its_own_mean);
  tcase_add_test(tests, mixed_data_have_second_order);
  tcase_add_test(tests, kink_has_second_order);
  tcase_add_test(tests, wrong_terms_are_refused);
}
