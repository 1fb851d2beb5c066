/* What electromagnetic fields are made of: refusals, callbacks and memory that fail, and potentials
 * of a given B. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/electric.h"
#include "support/heap.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { N = 4 };

static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};

static int steady(double t, double *value, void *user)
{
  (void)t, (void)user;
  *value = 1;
  return 0;
}

static int along_x(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = 1 + x[0];
  value[1] = 0;
  return 0;
}

static dvi_star *star_of(const char *name, dvi_generator_options options, dvi_star_kind kind)
{
  dvi_mesh *mesh = generated(name, options);
  const dvi_star_options plain = {.size = sizeof plain, .kind = kind};
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, &plain, &star) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return star;
}

/* ---- refusals ---- */

/* Require that terms are refused with these words, on a square of boxes. */
static void refuse(dvi_maxwell_terms terms, dvi_status status, const char *words)
{
  dvi_field *field = (dvi_field *)&field;
  dvi_star *star = star_of("box", (dvi_generator_options){.cells = {N, N}}, DVI_CIRCUMCENTRIC);
  terms.size = sizeof terms;
  terms.star = star;
  ck_assert_int_eq(dvi_maxwell_create(&terms, &field), status);
  ck_assert_ptr_null(field);
  check_words(words);
  dvi_star_destroy(&star);
}

START_TEST(wrong_walls_and_media_are_refused)
{
  double sigma[N * N] = {0};
  refuse((dvi_maxwell_terms){.wall = &(dvi_wall){.part = "lid"}, .walls = 1}, DVI_BAD_ARGUMENT,
         "a wall is on part \"lid\", which the mesh has not");
  refuse((dvi_maxwell_terms){.wall = &(dvi_wall){.part = "left", .kind = 7}, .walls = 1},
         DVI_BAD_ARGUMENT, "no kind 7");
  refuse((dvi_maxwell_terms){.wall = &(dvi_wall){.kind = DVI_PEC}, .walls = 1}, DVI_BAD_ARGUMENT,
         "no part");
  refuse((dvi_maxwell_terms){.wall = &(dvi_wall){.part = "all", .kind = DVI_PEC}, .walls = 1},
         DVI_BAD_ARGUMENT, "nothing is unknown");
  refuse((dvi_maxwell_terms){.walls = 1}, DVI_BAD_ARGUMENT, "1 walls are announced");
  sigma[3] = -0.5;
  refuse((dvi_maxwell_terms){.conductivity = sigma}, DVI_BAD_ARGUMENT, "conductivity is -0.5 in");
  sigma[3] = (double)NAN;
  refuse((dvi_maxwell_terms){.conductivity = sigma}, DVI_BAD_ARGUMENT, "conductivity is nan in");
}
END_TEST

START_TEST(wrong_currents_and_probes_are_refused)
{
  static const double inside[] = {0.3, 0.3};
  dvi_current many[65];
  for (int i = 0; i < 65; i++) many[i] = (dvi_current){.signal = steady, .along = {1}};
  refuse((dvi_maxwell_terms){.current = many, .currents = 65}, DVI_BAD_SIZE, "at most 64");
  many[0].signal = NULL;
  refuse((dvi_maxwell_terms){.current = many, .currents = 1}, DVI_BAD_ARGUMENT, "no signal");
  many[1].at[0] = 3;
  refuse((dvi_maxwell_terms){.current = many + 1, .currents = 1}, DVI_BAD_ARGUMENT,
         "(3, 0, 0) lies outside");
  many[2].along[1] = (double)INFINITY;
  refuse((dvi_maxwell_terms){.current = many + 2, .currents = 1}, DVI_BAD_ARGUMENT, "not finite");
  dvi_field_probe probe[2] = {{.name = "ear", .of = "E", .at = {inside[0], inside[1]}}};
  probe[1] = probe[0];
  refuse((dvi_maxwell_terms){.probe = probe, .probes = 2}, DVI_BAD_ARGUMENT,
         "two probes have the name \"ear\"");
  probe[0].of = "H";
  refuse((dvi_maxwell_terms){.probe = probe, .probes = 1}, DVI_BAD_ARGUMENT,
         "of \"H\"; E, B, flux and energy");
  probe[0].at[1] = -1;
  probe[0].of = "B";
  refuse((dvi_maxwell_terms){.probe = probe, .probes = 1}, DVI_BAD_ARGUMENT, "lies outside");
  probe[0].name = "";
  refuse((dvi_maxwell_terms){.probe = probe, .probes = 1}, DVI_BAD_ARGUMENT, "no name");
  probe[0] = (dvi_field_probe){.name = "out", .of = "flux"};
  refuse((dvi_maxwell_terms){.probe = probe, .probes = 1}, DVI_BAD_ARGUMENT, "the mesh has not");
  probe[0].of = "energy";
  probe[0].part = "left";
  refuse((dvi_maxwell_terms){.probe = probe, .probes = 1}, DVI_BAD_ARGUMENT, "has no cells");
}
END_TEST

/* A conductor on a part of points holds no edge, and a wall must not be lost without a word. */
START_TEST(a_conductor_without_edges_is_refused)
{
  const int corner = 0;
  const dvi_mesh_part part = {.name = "corner", .degree = 0, .count = 1, .cell = &corner};
  static const double point[] = {0, 0, 1, 0, 0, 1};
  static const int vertex[] = {0, 1, 2};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = 3,
                                .point = point,
                                .cells = 1,
                                .vertex = vertex,
                                .part = &part,
                                .parts = 1};
  const dvi_star_options whitney = {.size = sizeof whitney, .kind = DVI_WHITNEY};
  const dvi_wall wall = {.part = "corner", .kind = DVI_PEC};
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert(dvi_mesh_create(&terms, &mesh) == DVI_OK);
  ck_assert(dvi_star_create(mesh, &whitney, &star) == DVI_OK);
  dvi_maxwell_terms made = {.size = sizeof made, .star = star, .wall = &wall, .walls = 1};
  ck_assert_int_eq(dvi_maxwell_create(&made, &field), DVI_BAD_ARGUMENT);
  check_words("part \"corner\" has no edge");
  made.scalar = 1;
  ck_assert_int_eq(dvi_maxwell_create(&made, &field), DVI_OK);
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- callbacks ---- */

static int fails(const double *x, double *value, void *user)
{
  value[0] = value[1] = 0;
  if (x[0] < 0.5) return 0;
  if (user != NULL) return 5;
  value[0] = (double)NAN;
  return 0;
}

START_TEST(densities_that_fail_are_refused)
{
  int any;
  const dvi_current current[] = {{.density = fails, .density_user = &any, .signal = steady},
                                 {.density = fails, .signal = steady}};
  refuse((dvi_maxwell_terms){.current = current, .currents = 1}, DVI_CALLBACK_FAILED, "returned 5");
  refuse((dvi_maxwell_terms){.current = current + 1, .currents = 1}, DVI_NOT_FINITE, "nan");
}
END_TEST

/* ---- memory ---- */

/* All that a field can have. */
static dvi_status create_all(const dvi_star *star, dvi_field **field)
{
  static const dvi_wall wall[] = {{.part = "left", .kind = DVI_PEC},
                                  {.part = "right", .kind = DVI_ABSORBING}};
  static const dvi_current current[] = {{.density = along_x, .signal = steady},
                                        {.at = {0.3, 0.4}, .along = {1, 1}, .signal = steady}};
  static const dvi_field_probe probe[] = {
      {.name = "ear", .of = "E", .at = {0.3, 0.4}, .along = {1, 0}},
      {.name = "out", .of = "flux", .part = "all"},
      {.name = "all", .of = "energy", .part = "all"}};
  double sigma[4 * N * N] = {0.5};
  const dvi_maxwell_terms terms = {.size = sizeof terms,
                                   .star = star,
                                   .wall = wall,
                                   .walls = 2,
                                   .conductivity = sigma,
                                   .current = current,
                                   .currents = 2,
                                   .probe = probe,
                                   .probes = 3};
  return dvi_maxwell_create(&terms, field);
}

static dvi_status work(const dvi_field *field)
{
  const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
  double *numbers = calloc((size_t)(2 * dvi_mesh_count(mesh, 1) + dvi_mesh_count(mesh, 2)),
                           sizeof *numbers),
         value;
  if (numbers == NULL) return DVI_NO_MEMORY;
  double *A = numbers, *B = numbers + 2 * dvi_mesh_count(mesh, 1);
  dvi_status status = dvi_field_vector_potential(field, B, A);
  for (int i = 0; i < 3 && status == DVI_OK; i++)
    status = dvi_field_probe_at(field, i, A, A, &value);
  const dvi_modes_options two = {.size = sizeof two, .count = 2};
  if (status == DVI_OK) status = dvi_field_modes(field, &two, A, NULL, NULL);
  free(numbers);
  return status;
}

/* Every request of a creation, and of what a field can do, fails once. Nothing is left behind. */
START_TEST(no_memory_is_a_status_and_leaves_nothing)
{
  for (int whitney = 0; whitney < 2; whitney++) {
    dvi_star *star = star_of(whitney ? "kuhn" : "box", (dvi_generator_options){.cells = {N, N}},
                             whitney ? DVI_WHITNEY : DVI_CIRCUMCENTRIC);
    dvi_field *field = NULL;
    ck_assert_msg(create_all(star, &field) == DVI_OK && work(field) == DVI_OK, "%s",
                  dvi_last_error());
    dvi_field_destroy(&field);
    const long before = heap_bytes();
    long request = 0;
    for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; request++) {
      ck_assert_int_lt(request, 20000);
      heap_fail_after(request);
      status = create_all(star, &field);
      if (status == DVI_OK) status = work(field);
      heap_fail_after(-1);
      if (!heap_is_counted()) status = DVI_OK;
      if (status != DVI_OK) ck_assert_int_eq(status, DVI_NO_MEMORY);
      dvi_field_destroy(&field);
      ck_assert_int_eq(heap_bytes(), before);
    }
    ck_assert(!heap_is_counted() || request > 50);
    dvi_star_destroy(&star);
  }
}
END_TEST

/* A large field finds its modes by another way, of which every 13th request fails. */
START_TEST(modes_of_large_fields_survive_a_lack_of_memory)
{
  dvi_field *field = electric(generated("staggered", (dvi_generator_options){.cells = {14, 14}}),
                              DVI_CIRCUMCENTRIC, NULL,
                              (dvi_maxwell_terms){.wall = &pec, .walls = 1});
  double lambda[2] = {-1, -1};
  const dvi_modes_options two = {.size = sizeof two, .count = 2};
  int64_t unknowns, zeros = -1;
  (void)dvi_field_unknowns(field, &unknowns);
  ck_assert_int_gt(unknowns, 500);
  const long before = heap_bytes();
  for (long request = 0; heap_is_counted(); request += 13) {
    heap_fail_after(request);
    const dvi_status status = dvi_field_modes(field, &two, lambda, NULL, &zeros);
    heap_fail_after(-1);
    ck_assert_int_eq(heap_bytes(), before);
    if (status == DVI_OK) break;
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    ck_assert_int_eq(zeros, -1);
  }
  ck_assert(!heap_is_counted() || (lambda[0] > 9 && lambda[1] < 11));
  dvi_field_destroy(&field);
}
END_TEST

/* ---- potentials ---- */

/* Set B = dA. */
static void curl(const dvi_field *field, const double *A, double *B)
{
  dvi_matrix d;
  const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
  ck_assert(dvi_mesh_incidence(mesh, dvi_field_degree(field), &d) == DVI_OK);
  dvi_matrix_multiply(&d, 0, A, B);
}

/* The charge d^T M A of a potential at the vertices, whose edges no conductor holds. */
static double largest_charge(const dvi_field *field, const double *A)
{
  dvi_matrix d, M;
  const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
  const int64_t vertices = dvi_mesh_count(mesh, 0), edges = dvi_mesh_count(mesh, 1);
  double *D = calloc((size_t)(edges + vertices), sizeof *D), *charge = D + edges, worst = 0;
  int64_t held;
  ck_assert(dvi_mesh_incidence(mesh, 0, &d) == DVI_OK);
  ck_assert(dvi_star_matrix(dvi_field_star(field), 1, &M) == DVI_OK);
  dvi_matrix_multiply(&M, 0, A, D);
  dvi_matrix_multiply(&d, 1, D, charge);
  const int *vertex = dvi_mesh_part_cells(mesh, "boundary", 0, &held);
  for (int64_t i = 0; i < held; i++) charge[vertex[i]] = 0;
  for (int64_t v = 0; v < vertices; v++) worst = fmax(worst, fabs(charge[v]));
  free(D);
  return worst;
}

typedef struct space {
  const char *mesh;
  int cells[3];
  dvi_star_kind kind;
} space;

START_TEST(a_curl_has_a_potential_without_charge)
{
  static const space spaces[] = {{"box", {6, 5}, DVI_CIRCUMCENTRIC},
                                 {"box", {4, 3, 3}, DVI_CIRCUMCENTRIC},
                                 {"staggered", {6, 6}, DVI_CIRCUMCENTRIC},
                                 {"disk", {0}, DVI_WHITNEY},
                                 {"kuhn", {3, 3, 3}, DVI_WHITNEY}};
  for (size_t i = 0; i < sizeof spaces / sizeof *spaces; i++) {
    const space *s = spaces + i;
    const int *c = s->cells;
    dvi_field *field = electric(
        generated(s->mesh, (dvi_generator_options){.cells = {c[0], c[1], c[2]}}), s->kind, NULL,
        (dvi_maxwell_terms){.wall = &pec, .walls = 1});
    const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
    const int64_t edges = dvi_mesh_count(mesh, 1), faces = dvi_mesh_count(mesh, 2);
    double *A = calloc((size_t)(2 * edges + 2 * faces), sizeof *A), *found = A + edges,
           *B = found + edges, *again = B + faces;
    unsigned long long seed = 3;
    int64_t unknowns;
    const int *unknown = dvi_field_unknowns(field, &unknowns);
    for (int64_t e = 0; e < unknowns; e++) A[unknown[e]] = random_number(&seed) - 0.5;
    curl(field, A, B);
    ck_assert_msg(dvi_field_vector_potential(field, B, found) == DVI_OK, "%s", dvi_last_error());
    curl(field, found, again);
    /* conjugate gradients end at 1e-14 of the right side, times the condition of K's square root */
    for (int64_t f = 0; f < faces; f++) ck_assert_double_eq_tol(again[f], B[f], 1e-11);
    ck_assert_msg(largest_charge(field, found) < 1e-10 || s->kind == DVI_WHITNEY, "%s: charge %g",
                  s->mesh, largest_charge(field, found));
    free(A);
    dvi_field_destroy(&field);
  }
}
END_TEST

/* Require that a uniform B on a square, or on one that repeats itself, has no potential, and that A
 * is left alone. */
static void refuse_uniform(dvi_generator_options options, int walls, double bent)
{
  dvi_field *field = electric(generated("box", options), DVI_CIRCUMCENTRIC, NULL,
                              (dvi_maxwell_terms){.wall = &pec, .walls = walls});
  const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
  const int64_t edges = dvi_mesh_count(mesh, 1), faces = dvi_mesh_count(mesh, 2);
  double *A = calloc((size_t)(edges + faces), sizeof *A), *B = A + edges;
  for (int64_t f = 0; f < faces; f++) B[f] = bent == 0 ? 1 : bent * (double)(f % 3);
  for (int64_t e = 0; e < edges; e++) A[e] = 9;
  ck_assert_int_eq(dvi_field_vector_potential(field, B, A), DVI_BAD_ARGUMENT);
  check_words("divergence, passes through an electric wall, or winds around a hole");
  for (int64_t e = 0; e < edges; e++) ck_assert_double_eq(A[e], 9);
  free(A);
  dvi_field_destroy(&field);
}

START_TEST(fields_without_a_potential_are_refused)
{
  refuse_uniform((dvi_generator_options){.cells = {4, 4}}, 1, 0);
  refuse_uniform((dvi_generator_options){.cells = {4, 4}, .periodic = {1, 1}}, 0, 0);
  refuse_uniform((dvi_generator_options){.cells = {3, 3, 3}}, 0, 0.1);
  double number = 0;
  ck_assert_int_eq(dvi_field_vector_potential(NULL, &number, &number), DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(maxwell_terms)
{
  tcase_add_test(tests, wrong_walls_and_media_are_refused);
  tcase_add_test(tests, wrong_currents_and_probes_are_refused);
  tcase_add_test(tests, a_conductor_without_edges_is_refused);
  tcase_add_test(tests, densities_that_fail_are_refused);
  tcase_add_test(tests, no_memory_is_a_status_and_leaves_nothing);
  tcase_add_test(tests, modes_of_large_fields_survive_a_lack_of_memory);
  tcase_add_test(tests, a_curl_has_a_potential_without_charge);
  tcase_add_test(tests, fields_without_a_potential_are_refused);
}
