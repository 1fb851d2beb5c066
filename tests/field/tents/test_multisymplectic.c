/* The multisymplectic form formula on subsets of meshes of spacetime and of space. */
#include <dvi/field.h>
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/complex.h"
#include "support/meshes.h"
#include "support/suite.h"
#include "support/field/tents.h"

/* Two solutions on a mesh of spacetime. */
typedef struct solutions {
  dvi_star *star;
  int k;
  double *form[2]; /* [k-cells] */
} solutions;

static void clear(solutions *s)
{
  dvi_star_destroy(&s->star);
  free(s->form[0]);
  free(s->form[1]);
}

static void make_star(solutions *s, dvi_mesh_terms terms)
{
  dvi_mesh *mesh = NULL;
  terms.size = sizeof terms;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_star_create(mesh, NULL, &s->star) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < 2; i++)
    s->form[i] = calloc((size_t)dvi_mesh_count(mesh, s->k), sizeof(double));
  dvi_mesh_destroy(&mesh);
}

/* ---- spacetime of tents ---- */

enum { CORNERS = 5, AROUND = 64 };

/* A value on a vertex, or on the edge from one vertex to another. */
typedef struct value {
  int vertex[2];
  double of[2];
} value;

/* What two marches have pitched together: points with their times, simplices, and values. */
typedef struct record {
  dvi__tents *tents[2];
  const dvi_mesh *space;
  int n, k, points, simplices, values;
  int *now; /* [vertices of space] the highest point over each */
  double *point;
  int *vertex;
  value *value;
} record;

static void add_point(record *r, int v)
{
  double *point = r->point + (ptrdiff_t)r->points * (r->n + 1);
  for (int l = 0; l < r->n; l++) point[l] = r->space->point[v * r->n + l];
  point[r->n] = r->tents[0]->front.time[v];
  r->now[v] = r->points++;
}

static void add_value(record *r, int cell)
{
  value *a = r->value + r->values++;
  for (int c = 0; c <= r->k; c++)
    a->vertex[c] = r->now[r->k == 0 ? cell : r->space->corner[1][2 * cell + c]];
  for (int i = 0; i < 2; i++) a->of[i] = r->tents[i]->front.A[cell];
}

static void pitch(record *r)
{
  int v, w;
  double top, other;
  ck_assert_msg(dvi__tents_pitch(r->tents[0], &v, &top) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi__tents_pitch(r->tents[1], &w, &other) == DVI_OK, "%s", dvi_last_error());
  ck_assert(v == w && top == other);
  const dvi__tents *tents = r->tents[0];
  for (int64_t i = tents->cells.start[v]; i < tents->cells.start[v + 1]; i++) {
    const int *corner = r->space->corner[r->n] + (ptrdiff_t)tents->cells.cell[i] * (r->n + 1);
    int *simplex = r->vertex + (ptrdiff_t)(r->n + 2) * r->simplices++;
    for (int c = 0; c <= r->n; c++) simplex[c] = r->now[corner[c]];
    simplex[r->n + 1] = r->points;
  }
  add_point(r, v);
  for (int64_t i = tents->values.start[v]; i < tents->values.start[v + 1]; i++)
    add_value(r, tents->values.cell[i]);
}

/* Edges that are not recorded are poles, with A = 0. */
static void take_values(const record *r, solutions *s)
{
  const dvi_mesh *mesh = dvi_star_mesh(s->star);
  for (int i = 0; i < r->values; i++) {
    const value *a = r->value + i;
    const int64_t cell = r->k == 0 ? a->vertex[0] : dvi__complex_find(mesh, 1, a->vertex);
    const int sign = r->k == 0 || a->vertex[0] < a->vertex[1] ? 1 : -1;
    ck_assert_int_ge(cell, 0);
    for (int j = 0; j < 2; j++) s->form[j][cell] = sign * a->of[j];
  }
}

/* Pitch so many tents with random starts over a mesh of space, which is destroyed. */
static solutions tents_on(dvi_mesh *space, int k, int tents)
{
  const int n = dvi_mesh_dimension(space);
  const int64_t vertices = dvi_mesh_count(space, 0), cells = dvi_mesh_count(space, k);
  record r = {.space = space, .n = n, .k = k};
  solutions s = {.k = k};
  dvi_star *star = NULL;
  double metric[4] = {1, 1, 1, 1}, period[4] = {0};
  metric[n] = -1;
  for (int l = 0; l < n; l++) period[l] = space->period[l];
  r.now = calloc((size_t)vertices, sizeof *r.now);
  r.point = calloc((size_t)(vertices + tents) * (size_t)(n + 1), sizeof *r.point);
  r.vertex = calloc((size_t)tents * AROUND * CORNERS, sizeof *r.vertex);
  r.value = calloc((size_t)cells + (size_t)tents * AROUND, sizeof *r.value);
  ck_assert_msg(dvi_star_create(space, NULL, &star) == DVI_OK, "%s", dvi_last_error());
  double *E = calloc((size_t)cells, sizeof *E), *A = calloc((size_t)cells, sizeof *A);
  for (unsigned i = 0; i < 2; i++) {
    const dvi__tents_options options = {.fraction = 0.8, .least = 0.3, .seed = 2};
    ck_assert_int_eq(
        dvi__tents_create(&(dvi__tents_terms){.star = star, .k = k}, &options, &r.tents[i]),
        DVI_OK);
    fill_at_random(cells, 1, 2 * i + 1, A);
    fill_at_random(cells, 1, 2 * i + 2, E);
    dvi__tents_start(r.tents[i], &(dvi_march_state){.A = A, .E = E});
  }
  for (int v = 0; v < vertices; v++) add_point(&r, v);
  for (int cell = 0; cell < cells; cell++) add_value(&r, cell);
  for (int i = 0; i < tents; i++) pitch(&r);
  make_star(&s, (dvi_mesh_terms){.dimension = n + 1,
                                 .points = r.points,
                                 .point = r.point,
                                 .cells = r.simplices,
                                 .vertex = r.vertex,
                                 .metric = metric,
                                 .period = period});
  take_values(&r, &s);
  free(A);
  free(E);
  free(r.now);
  free(r.point);
  free(r.vertex);
  free(r.value);
  dvi__tents_destroy(&r.tents[0]);
  dvi__tents_destroy(&r.tents[1]);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&space);
  return s;
}

static dvi_mesh *bcc_torus(void)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {3, 3, 3}};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate("bcc-torus", &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static solutions tents_of(int n, int k)
{
  return n == 1   ? tents_on(ring_mesh(12, 0.2, 3), k, 160)
         : n == 2 ? tents_on(equilateral_torus(4, 4), k, 110)
                  : tents_on(bcc_torus(), k, is_short_run() ? 60 : 150);
}

/* ---- spacetime of boxes ---- */

/* Give the number of the k-cell over the corners of another one, some slices of time later. */
static int64_t later(const dvi_mesh *mesh, int k, const int *corner, int by)
{
  int vertex[DVI__CORNERS];
  for (int c = 0; c < 1 << k; c++) vertex[c] = corner[c] + by;
  return k == 0 ? vertex[0] : dvi__complex_find(mesh, k, vertex);
}

static int64_t between(const dvi_mesh *mesh, int k, const int *corner, int by)
{
  int vertex[DVI__CORNERS];
  for (int c = 0; c < 2 << k; c++) vertex[c] = corner[c >> 1] + (c & 1 ? by : 0);
  return dvi__complex_find(mesh, k + 1, vertex);
}

/* Solve the rows of one slice of time for the next slice. */
static void solve_slice(const solutions *s, int slice, int vertices, double *A)
{
  dvi_matrix d, M;
  const dvi_mesh *mesh = dvi_star_mesh(s->star);
  const int64_t count = dvi_mesh_count(mesh, s->k);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, s->k, &d), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(s->star, s->k + 1, &M), DVI_OK);
  double *F = calloc((size_t)M.rows * 2, sizeof *F), *row = calloc((size_t)count, sizeof *row);
  for (int pass = 0; pass < 2; pass++) {
    for (int64_t cell = 0; cell < count; cell++) {
      const int own = (int)cell, *corner = s->k == 0 ? &own : mesh->corner[1] + 2 * cell;
      if (corner[0] / vertices != slice || corner[(1 << s->k) - 1] / vertices != slice) continue;
      double *next = A + later(mesh, s->k, corner, vertices);
      *next = pass == 0 ? A[cell]
                        : A[cell] + row[cell] / M.value[between(mesh, s->k, corner, vertices)];
    }
    dvi_matrix_multiply(&d, 0, A, F);
    dvi_matrix_multiply(&M, 0, F, F + M.rows);
    dvi_matrix_multiply(&d, 1, F + M.rows, row);
  }
  free(F);
  free(row);
}

/* Boxes of 5 x .. x 5 cells of space that repeat themselves, and 6 steps: leapfrog and Yee's
 * scheme, from two random slices. */
static solutions boxes_of(int n, int k)
{
  enum { ACROSS = 5, UP = 6 };
  const int dimension = n + 1, vertices = n == 1 ? ACROSS : ACROSS * ACROSS;
  const double period[] = {1, n == 1 ? 0 : 1, 0}, metric[] = {1, n == 1 ? -1 : 1, -1};
  double point[3 * ACROSS * ACROSS * (UP + 1)];
  int vertex[8 * ACROSS * ACROSS * UP], count = 0;
  solutions s = {.k = k};
  for (int v = 0; v < vertices * (UP + 1); v++) {
    point[dimension * v] = (double)(v % ACROSS) / ACROSS;
    if (n == 2) point[dimension * v + 1] = (double)(v / ACROSS % ACROSS) / ACROSS;
    const int slice = v / vertices;
    point[dimension * v + n] = 0.1 * slice;
  }
  for (int cell = 0; cell < vertices * UP; cell++) {
    const int x = cell % ACROSS, y = n == 1 ? 0 : cell / ACROSS % ACROSS, t = cell / vertices;
    for (int c = 0; c < 2 << n; c++)
      vertex[count++] = (t + (c >> n)) * vertices + (x + (c & 1)) % ACROSS +
                        ACROSS * ((y + (n == 2 ? c >> 1 & 1 : 0)) % ACROSS);
  }
  make_star(&s, (dvi_mesh_terms){.kind = DVI_BOXES,
                                 .dimension = dimension,
                                 .points = (int64_t)vertices * (UP + 1),
                                 .point = point,
                                 .cells = (int64_t)vertices * UP,
                                 .vertex = vertex,
                                 .metric = metric,
                                 .period = period});
  const dvi_mesh *mesh = dvi_star_mesh(s.star);
  for (unsigned i = 0; i < 2; i++) {
    fill_at_random(dvi_mesh_count(mesh, k), 1, i + 1, s.form[i]);
    for (int64_t e = 0; e < dvi_mesh_count(mesh, 1) && k == 1; e++)
      if (mesh->corner[1][2 * e] / vertices != mesh->corner[1][2 * e + 1] / vertices)
        s.form[i][e] = 0;
    for (int slice = 1; slice < UP; slice++) solve_slice(&s, slice, vertices, s.form[i]);
  }
  return s;
}

/* ---- the formula ---- */

/* Choose the cells around a random one, for odd seeds without some of them. Returns their count. */
static int64_t choose_cells(const dvi_mesh *mesh, unsigned seed, int *cell)
{
  const int n = dvi_mesh_dimension(mesh), space = dvi_mesh_space(mesh);
  const int64_t count = dvi_mesh_count(mesh, n);
  unsigned long long state = seed * 7919;
  double *centre = calloc((size_t)(count * space), sizeof *centre), least[4] = {0}, most[4] = {0};
  ck_assert_int_eq(dvi_mesh_centres(mesh, n, centre), DVI_OK);
  for (int64_t c = 0; c < count; c++)
    for (int l = 0; l < space; l++) {
      least[l] = fmin(c == 0 ? (double)INFINITY : least[l], centre[c * space + l]);
      most[l] = fmax(c == 0 ? -(double)INFINITY : most[l], centre[c * space + l]);
    }
  for (int warm = 0; warm < 8; warm++) (void)random_number(&state);
  const int64_t middle = (int64_t)(random_number(&state) * (double)count);
  const double radius = 0.3 + 0.5 * random_number(&state);
  int64_t chosen = 0;
  for (int64_t c = 0; c < count; c++) {
    double square = 0;
    for (int l = 0; l < space; l++)
      square += pow((centre[c * space + l] - centre[middle * space + l]) / (most[l] - least[l]), 2);
    if (square < radius * radius && random_number(&state) < (seed % 2 ? 0.97 : 1))
      cell[chosen++] = (int)c;
  }
  free(centre);
  return chosen;
}

/* Returns the largest sum beside its size over 20 sets of cells. */
static double worst_of(const solutions *s, const double *a, const double *b)
{
  const dvi_mesh *mesh = dvi_star_mesh(s->star);
  int *cell = calloc((size_t)dvi_mesh_count(mesh, dvi_mesh_dimension(mesh)), sizeof *cell);
  double worst = 0;
  for (unsigned seed = 1; seed <= (unsigned)repeats(20); seed++) {
    double sum, size;
    const int64_t cells = choose_cells(mesh, seed, cell);
    ck_assert_msg(dvi_form_multisymplectic(s->star, s->k, cells, cell, a, b, &sum, &size) == DVI_OK,
                  "%s", dvi_last_error());
    ck_assert_double_gt(size, 0);
    worst = fmax(worst, fabs(sum) / size);
  }
  free(cell);
  return worst;
}

/* A form that solves no equation shows that the sum is not always small. */
static void check_formula(solutions s)
{
  const int64_t count = dvi_mesh_count(dvi_star_mesh(s.star), s.k);
  double *other = calloc((size_t)count, sizeof *other);
  ck_assert_double_le(worst_of(&s, s.form[0], s.form[1]), 1e-14);
  fill_at_random(count, 1, 77, other);
  ck_assert_double_ge(worst_of(&s, s.form[0], other), 1e-2);
  free(other);
  clear(&s);
}

/* The few sets of a short run may have no inner vertex of a mesh of four dimensions. */
static int dimensions(void)
{
  return is_short_run() ? 2 : 3;
}

START_TEST(waves_on_tents_are_multisymplectic)
{
  for (int n = 1; n <= dimensions(); n++) check_formula(tents_of(n, 0));
}
END_TEST

START_TEST(light_on_tents_is_multisymplectic)
{
  for (int n = 2; n <= dimensions(); n++) check_formula(tents_of(n, 1));
}
END_TEST

START_TEST(leapfrog_on_boxes_is_multisymplectic)
{
  check_formula(boxes_of(1, 0));
  check_formula(boxes_of(2, 0));
  check_formula(boxes_of(2, 1));
}
END_TEST

/* ---- the whole mesh ---- */

/* The star of the whole mesh, made by other code, has no row that is not zero above the first slice
 * and below the front, the poles' ones left out: a random start has charges. */
START_TEST(tents_solve_the_rows_of_their_mesh)
{
  for (int n = 1; n <= 3; n++)
    for (int k = 0; k < 2 && k < n; k++) {
      solutions s = tents_of(n, k);
      dvi_matrix d, M;
      const dvi_mesh *mesh = dvi_star_mesh(s.star);
      int64_t rim;
      const int *boundary = dvi_mesh_part_cells(mesh, "boundary", k, &rim);
      ck_assert_int_eq(dvi_mesh_incidence(mesh, k, &d), DVI_OK);
      ck_assert_int_eq(dvi_star_matrix(s.star, k + 1, &M), DVI_OK);
      double *F = calloc((size_t)M.rows * 2, sizeof *F), most = 0, worst = 0;
      double *row = calloc((size_t)d.columns, sizeof *row);
      dvi_matrix_multiply(&d, 0, s.form[0], F);
      dvi_matrix_multiply(&M, 0, F, F + M.rows);
      dvi_matrix_multiply(&d, 1, F + M.rows, row);
      for (int64_t f = 0; f < M.rows; f++) most = fmax(most, fabs(F[M.rows + f]));
      for (int64_t i = 0; i < rim; i++) row[boundary[i]] = 0;
      for (int64_t i = 0; i < d.columns; i++)
        if (k == 0 || s.form[0][i] != 0) worst = fmax(worst, fabs(row[i]));
      ck_assert_double_le(worst, 1e-13 * most);
      ck_assert_int_lt(rim, d.columns / (n < 3 ? 2 : 1));
      free(F);
      free(row);
      clear(&s);
    }
}
END_TEST

/* ---- statics ---- */

/* Affine functions are harmonic on any mesh, up to what roundings of thin duals leave. */
static void check_reciprocity(dvi_mesh *mesh, dvi_star_kind kind)
{
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  solutions s = {.k = 0};
  const int space = dvi_mesh_space(mesh);
  const int64_t count = dvi_mesh_count(mesh, 0);
  const double *x = dvi_mesh_points(mesh);
  double *square = calloc((size_t)count, sizeof *square);
  ck_assert_msg(dvi_star_create(mesh, &options, &s.star) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < 2; i++) s.form[i] = calloc((size_t)count, sizeof(double));
  for (int64_t v = 0; v < count; v++) {
    for (int l = 0; l < space; l++) {
      s.form[0][v] += (l + 1) * x[v * space + l];
      s.form[1][v] += (1 - 0.7 * l) * x[v * space + l];
    }
    square[v] = x[v * space] * x[v * space];
  }
  ck_assert_double_le(worst_of(&s, s.form[0], s.form[1]), 1e-14);
  ck_assert_double_ge(worst_of(&s, s.form[0], square), 1e-3);
  free(square);
  dvi_mesh_destroy(&mesh);
  clear(&s);
}

START_TEST(harmonic_functions_are_reciprocal)
{
  for (int n = 2; n <= 3; n++) {
    check_reciprocity(jittered_mesh(n, n, 4, 0.15, 3), DVI_CIRCUMCENTRIC);
    check_reciprocity(jittered_mesh(n, n, 4, 0.15, 3), DVI_WHITNEY);
  }
  check_reciprocity(staggered_mesh(6, 6), DVI_BARYCENTRIC);
}
END_TEST

/* In a medium the fluxes have its stiffness. u is held on the boundary, at x and at y^2. */
static int on_boundary(const double *x, const double *normal, double *datum, void *user)
{
  (void)normal;
  *datum = user != NULL ? x[0] : x[1] * x[1];
  return 0;
}

START_TEST(potentials_in_a_medium_are_reciprocal)
{
  solutions s = {.k = 0};
  dvi_mesh *mesh = staggered_mesh(7, 7);
  const int64_t cells = dvi_mesh_count(mesh, 2), count = dvi_mesh_count(mesh, 0);
  double *stiffness = calloc((size_t)cells, sizeof *stiffness);
  fill_at_random(cells, 1, 5, stiffness);
  for (int64_t c = 0; c < cells; c++) stiffness[c] += 1.5;
  const double *factor[] = {NULL, stiffness, NULL};
  const dvi_star_options options = {.size = sizeof options, .factor = factor};
  ck_assert_int_eq(dvi_star_create(mesh, &options, &s.star), DVI_OK);
  for (int i = 0; i < 2; i++) {
    const dvi_condition held = {
        .part = "boundary", .kind = DVI_FIXED, .datum = on_boundary, .user = i ? &s : NULL};
    const dvi_wave_terms terms = {
        .size = sizeof terms, .star = s.star, .condition = &held, .conditions = 1};
    dvi_field *field = NULL;
    s.form[i] = calloc((size_t)count, sizeof(double));
    ck_assert_msg(dvi_wave_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi_field_solve(field, NULL, s.form[i], NULL), DVI_OK);
    dvi_field_destroy(&field);
  }
  ck_assert_double_le(worst_of(&s, s.form[0], s.form[1]), 1e-12);
  free(stiffness);
  dvi_mesh_destroy(&mesh);
  clear(&s);
}
END_TEST

/* ---- refusals ---- */

START_TEST(sets_that_are_none_are_refused)
{
  dvi_mesh *mesh = staggered_mesh(3, 3);
  dvi_star *star = NULL;
  double u[64] = {0}, sum = 7, size = 8;
  int cell[] = {0, 1, 0};
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  ck_assert_int_eq(dvi_form_multisymplectic(star, 0, 3, cell, u, u, &sum, &size), DVI_BAD_ARGUMENT);
  check_words("cell 0 is given twice");
  cell[2] = (int)dvi_mesh_count(mesh, 2);
  ck_assert_int_eq(dvi_form_multisymplectic(star, 0, 3, cell, u, u, &sum, &size), DVI_BAD_ARGUMENT);
  check_words("is not from 0 to");
  ck_assert_int_eq(dvi_form_multisymplectic(star, 2, 2, cell, u, u, &sum, &size), DVI_BAD_ARGUMENT);
  check_words("degree 2 is not from 0 to 1");
  ck_assert_int_eq(dvi_form_multisymplectic(star, 0, 2, cell, u, NULL, &sum, &size),
                   DVI_BAD_ARGUMENT);
  u[0] = NAN;
  ck_assert_int_eq(dvi_form_multisymplectic(star, 0, 2, cell, u, u, &sum, &size), DVI_NOT_FINITE);
  ck_assert(sum == 7 && size == 8);
  u[0] = 0;
  ck_assert_int_eq(dvi_form_multisymplectic(star, 0, 0, cell, u, u, &sum, NULL), DVI_OK);
  ck_assert_double_eq(sum, 0);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(spectral_stars_are_refused)
{
  const dvi_generator_options options = {
      .size = sizeof options, .cells = {4, 4}, .periodic = {1, 1}};
  const dvi_star_options spectral = {.size = sizeof spectral, .kind = DVI_SPECTRAL};
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  double u[16] = {0}, sum;
  const int cell = 0;
  ck_assert_int_eq(dvi_mesh_generate("box", &options, &mesh), DVI_OK);
  ck_assert_msg(dvi_star_create(mesh, &spectral, &star) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_form_multisymplectic(star, 0, 1, &cell, u, u, &sum, NULL), DVI_UNSUPPORTED);
  check_words("the spectral star is no sum over cells");
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_formula_without_memory_leaves_nothing)
{
  dvi_mesh *mesh = staggered_mesh(3, 3);
  dvi_star *star = NULL;
  double u[64] = {0}, sum;
  const int cell = 0;
  dvi_status status = DVI_NO_MEMORY;
  int failures = 0;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  for (; status == DVI_NO_MEMORY; failures += status == DVI_NO_MEMORY) {
    dvi__fail_allocations_after(failures);
    status = dvi_form_multisymplectic(star, 1, 1, &cell, u, u, &sum, NULL);
    dvi__fail_allocations_after(-1);
  }
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_gt(failures, 8);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(multisymplectic)
{
  tcase_add_test(tests, waves_on_tents_are_multisymplectic);
  tcase_add_test(tests, light_on_tents_is_multisymplectic);
  tcase_add_test(tests, leapfrog_on_boxes_is_multisymplectic);
  tcase_add_test(tests, tents_solve_the_rows_of_their_mesh);
  tcase_add_test(tests, harmonic_functions_are_reciprocal);
  tcase_add_test(tests, potentials_in_a_medium_are_reciprocal);
  tcase_add_test(tests, sets_that_are_none_are_refused);
  tcase_add_test(tests, spectral_stars_are_refused);
  tcase_add_test(tests, a_formula_without_memory_leaves_nothing);
}
