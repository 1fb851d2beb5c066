/* labels: judge */
/* Deficits and holonomies of random lengths against quadruple precision. */
#include <dvi/curvature.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/quad/quad_regge.h"
#include "support/suite.h"

enum { MESHES = 7 };

typedef struct judged {
  dvi_mesh *mesh;
  int64_t edges, hinges;
  double *length;
  quad *deficit; /* of the judge */
  int8_t *is_outer;
} judged;

static dvi_mesh *generated(const char *name)
{
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate(name, NULL, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static dvi_mesh *mesh_of_case(int i)
{
  switch (i) {
  case 0: return jittered_mesh(2, 2, 4, 0.25, 5);
  case 1: return jittered_mesh(3, 3, 3, 0.25, 6);
  case 2: return jittered_mesh(4, 4, 2, 0.1, 7);
  case 3: return generated("icosphere");
  case 4: return generated("cell-16");
  case 5: return generated("cell-600");
  default: return generated("cross-5");
  }
}

static double distance_of(const dvi_mesh *mesh, int a, int b)
{
  const int space = dvi_mesh_space(mesh);
  const double *point = dvi_mesh_points(mesh);
  double sum = 0;
  for (int i = 0; i < space; i++) {
    const double d = point[a * space + i] - point[b * space + i];
    sum += d * d;
  }
  return sqrt(sum);
}

/* Kuhn's simplices allow changes of a hundredth. */
static judged judged_of(int i)
{
  judged c = {.mesh = mesh_of_case(i)};
  unsigned long long seed = (unsigned)i + 17;
  const int n = dvi_mesh_dimension(c.mesh), *end = dvi_mesh_vertices(c.mesh, 1, NULL);
  c.edges = dvi_mesh_count(c.mesh, 1);
  c.hinges = dvi_mesh_count(c.mesh, n - 2);
  c.length = calloc((size_t)c.edges, sizeof *c.length);
  c.deficit = calloc((size_t)c.hinges, sizeof *c.deficit);
  c.is_outer = calloc((size_t)c.hinges, sizeof *c.is_outer);
  quad *length = calloc((size_t)c.edges, sizeof *length),
       *volume = calloc((size_t)c.hinges, sizeof *volume);
  for (int64_t e = 0; e < c.edges; e++) {
    c.length[e] = distance_of(c.mesh, end[2 * e], end[2 * e + 1]);
    c.length[e] *= 1 + (i < 3 ? 0.01 : 0.1) * (2 * random_number(&seed) - 1);
    length[e] = c.length[e];
  }
  (void)quad_hinges(c.mesh, length, c.deficit, volume);
  int64_t outer = 0;
  const int *at = dvi_mesh_part_cells(c.mesh, "boundary", n - 2, &outer);
  for (int64_t k = 0; k < outer; k++) c.is_outer[at[k]] = 1;
  free(length), free(volume);
  return c;
}

static void end_judged(judged *c)
{
  dvi_mesh_destroy(&c->mesh);
  free(c->length), free(c->deficit), free(c->is_outer);
}

START_TEST(deficits_have_their_digits)
{
  judged c = judged_of(_i);
  double *deficit = calloc((size_t)c.hinges, sizeof *deficit);
  ck_assert_msg(dvi_hinge_deficits(c.mesh, c.length, deficit) == DVI_OK, "%s", dvi_last_error());
  for (int64_t h = 0; h < c.hinges; h++)
    ck_assert_double_eq_tol(deficit[h], (double)c.deficit[h], 2e-14);
  free(deficit);
  end_judged(&c);
}
END_TEST

/* Up to whole turns, of a lift up to two. */
static void check_turns(const judged *c, int spin)
{
  const double pi = acos(-1), turn = (spin ? 4 : 2) * pi;
  const dvi_connection_options options = {
      .size = sizeof options, .length = c->length, .spin = spin};
  dvi_connection *connection = NULL;
  ck_assert_msg(dvi_connection_create(c->mesh, &options, &connection) == DVI_OK, "%s",
                dvi_last_error());
  for (int64_t h = 0; h < c->hinges; h++) {
    double angle, rest;
    if (c->is_outer[h]) continue;
    ck_assert_int_eq(dvi_connection_turn(connection, h, &angle, &rest), DVI_OK);
    ck_assert_double_le(fabs(remainder(angle - (double)c->deficit[h], turn)), 1e-13);
    ck_assert_double_le(rest, 1e-13);
  }
  dvi_connection_destroy(&connection);
}

START_TEST(holonomies_turn_by_the_deficits)
{
  judged c = judged_of(_i);
  check_turns(&c, 0);
  check_turns(&c, 1);
  end_judged(&c);
}
END_TEST

/* ---- thin simplices ---- */

/* Flat ones, needles, and ones with all corners but two in one place, by 1e-1 to 1e-5. */
static void thin_lengths(int n, int shape, int seed, double *length)
{
  double point[5][4];
  unsigned long long state = (unsigned)seed;
  const double part = pow(10, -1 - seed % 5);
  int e = 0;
  for (int v = 0; v <= n; v++)
    for (int a = 0; a < n; a++) {
      const int is_small = shape == 0 ? a == n - 1 : shape == 1 ? a > 0 : v > 1;
      point[v][a] = (random_number(&state) - 0.5) * (is_small ? part : 1);
    }
  for (int v = 0; v <= n; v++)
    for (int w = v + 1; w <= n; w++) {
      double square = 0;
      for (int a = 0; a < n; a++) square += pow(point[v][a] - point[w][a], 2);
      length[e++] = sqrt(square);
    }
}

/* All hinges are at the boundary, and their deficits pi less small angles or angles near pi. */
START_TEST(deficits_of_thin_simplices_have_their_digits)
{
  const int n = 2 + _i % 3, edges = n * (n + 1) / 2;
  dvi_mesh *mesh = random_simplex(n, n, NULL, 1);
  for (int seed = 0; seed < 50; seed++) {
    double length[10], deficit[10];
    quad given[10], exact[10], volume[10];
    thin_lengths(n, _i / 3, seed, length);
    for (int e = 0; e < edges; e++) given[e] = length[e];
    (void)quad_hinges(mesh, given, exact, volume);
    ck_assert_msg(dvi_hinge_deficits(mesh, length, deficit) == DVI_OK, "%s", dvi_last_error());
    for (int h = 0; h < edges; h++)
      ck_assert_double_eq_tol(deficit[h] / (double)exact[h], 1, 4e-15);
  }
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(curvature_judge)
{
  tcase_add_loop_test(tests, deficits_have_their_digits, 0, MESHES);
  tcase_add_loop_test(tests, holonomies_turn_by_the_deficits, 0, MESHES);
  tcase_add_loop_test(tests, deficits_of_thin_simplices_have_their_digits, 0, 9);
}
