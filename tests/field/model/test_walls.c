/* Absorbing walls and conductors: their matrix, and what they leave of the energy, on boxes,
 * triangles and tetrahedra, with circumcentric and Whitney stars. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/electric.h"
#include "support/meshes.h"
#include "support/suite.h"

static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};

/* ---- the matrix ---- */

/* Give the force -S v of a field's losses. */
static double *losses(dvi_field *field, const double *v)
{
  dvi_system_terms terms;
  ck_assert_msg(dvi_field_system_terms(field, &terms) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(terms.force_count, 1);
  double *F = calloc((size_t)terms.dimension, sizeof *F),
         *q = calloc((size_t)terms.dimension, sizeof *q);
  ck_assert_int_eq(terms.forces[0].value(0, q, v, F, terms.forces[0].user), 0);
  free(q);
  return F;
}

/* Return on how many faces of the unit cube's boundary a point is. */
static int walls_at(const double *x)
{
  int count = 0;
  for (int l = 0; l < 3; l++) count += x[l] == 0 || x[l] == 1;
  return count;
}

/* Edges of the unit cube's boundary have a dual edge as long as themselves, of which an edge of the
 * cube has a half on each of its two sides. With eps = 4 the admittance is 2. */
START_TEST(open_cubes_have_the_admittance_of_their_walls)
{
  enum { N = 3 };
  double eps[N * N * N];
  for (int c = 0; c < N * N * N; c++) eps[c] = 4;
  dvi_field *field = electric(generated("box", (dvi_generator_options){.cells = {N, N, N}}),
                              DVI_CIRCUMCENTRIC, eps,
                              (dvi_maxwell_terms){.wall = &open, .walls = 1});
  int64_t unknowns;
  (void)dvi_field_unknowns(field, &unknowns);
  double *v = malloc((size_t)unknowns * sizeof *v),
         *centre = malloc(3 * (size_t)unknowns * sizeof *v);
  for (int64_t i = 0; i < unknowns; i++) v[i] = 1;
  double *F = losses(field, v);
  ck_assert(dvi_mesh_centres(dvi_star_mesh(dvi_field_star(field)), 1, centre) == DVI_OK);
  for (int64_t i = 0; i < unknowns; i++)
    ck_assert_double_eq_tol(F[i], walls_at(centre + 3 * i) > 0 ? -2 : 0, 1e-14);
  free(v);
  free(centre);
  free(F);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- random fields lose energy ---- */

typedef struct room {
  const char *mesh;
  int cells[3];
  dvi_star_kind kind;
  int scalar;
} room;

static const room rooms[] = {{"interval", {12}, DVI_CIRCUMCENTRIC, 1},
                             {"box", {5, 4, 3}, DVI_CIRCUMCENTRIC, 0},
                             {"box", {6, 5}, DVI_CIRCUMCENTRIC, 1},
                             {"staggered", {5, 5}, DVI_CIRCUMCENTRIC, 0},
                             {"staggered", {5, 5}, DVI_CIRCUMCENTRIC, 1},
                             {"staggered", {5, 5}, DVI_WHITNEY, 0},
                             {"disk", {0}, DVI_WHITNEY, 0},
                             {"disk", {0}, DVI_WHITNEY, 1},
                             {"kuhn", {3, 3, 3}, DVI_WHITNEY, 0},
                             {"ball", {0}, DVI_WHITNEY, 0}};

static dvi_mesh *mesh_of(const room *r)
{
  return generated(r->mesh,
                   (dvi_generator_options){.cells = {r->cells[0], r->cells[1], r->cells[2]}});
}

/* Start from random numbers, and let the field lose energy in `steps` looks. Returns the part that
 * is left. */
static double lose(const room *r, const dvi_maxwell_terms *terms, int steps)
{
  dvi_field *field = electric(mesh_of(r), r->kind, NULL, *terms);
  const int64_t cells = dvi_mesh_count(dvi_star_mesh(dvi_field_star(field)),
                                       dvi_field_degree(field));
  double *E = malloc((size_t)cells * sizeof *E);
  unsigned long long seed = 7;
  for (int64_t i = 0; i < cells; i++) E[i] = random_number(&seed) - 0.5;
  dvi_march *march = march_of(field, (dvi_march_options){.fraction = 0.8}, E, NULL);
  const double first = observe_march(march, "energy"), dt = step_of_march(march);
  double last = first;
  for (int i = 1; i <= steps; i++) {
    advance_march(march, i * dt);
    const double energy = observe_march(march, "energy");
    ck_assert_msg(energy <= last * (1 + 1e-12), "%s: step %d, from %.17g to %.17g", r->mesh, i,
                  last, energy);
    last = energy;
  }
  if (dvi_field_degree(field) > 0) ck_assert_double_lt(observe_march(march, "gauss"), 1e-12);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  free(E);
  return last / first;
}

START_TEST(open_walls_take_energy_in_every_step)
{
  for (int i = 0; i < sampled_count((int)(sizeof rooms / sizeof *rooms)); i++) {
    const room *r = rooms + sampled_case(i);
    const double left = lose(
        r, &(dvi_maxwell_terms){.scalar = r->scalar, .wall = &open, .walls = 1}, 40);
    ck_assert_msg(left < 0.7, "%s: %g is left", r->mesh, left);
  }
}
END_TEST

START_TEST(conductors_take_energy_in_every_step)
{
  for (int i = 0; i < sampled_count((int)(sizeof rooms / sizeof *rooms)); i++) {
    const room *r = rooms + sampled_case(i);
    dvi_mesh *mesh = mesh_of(r);
    const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
    double *sigma = malloc((size_t)cells * sizeof *sigma);
    for (int64_t c = 0; c < cells; c++) sigma[c] = (double)(c % 3);
    dvi_mesh_destroy(&mesh);
    const double left = lose(r, &(dvi_maxwell_terms){.scalar = r->scalar, .conductivity = sigma},
                             40);
    ck_assert_msg(left < 0.3, "%s: %g is left", r->mesh, left);
    free(sigma);
  }
}
END_TEST

/* ---- a wave that leaves ---- */

static int pulse(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = value[2] = 0;
  value[1] = exp(-pow((x[0] - 1) / 0.15, 2));
  return 0;
}

typedef struct duct {
  const char *mesh;
  dvi_star_kind kind;
  int dimension, n;
  double most; /* that comes back, on the coarse mesh */
} duct;

/* Return the part of a pulse's energy that is left when it has met the open walls at both ends of
 * a duct, on whose other walls E is at a right angle to it, or along magnetic ones. */
static double left_of_pulse(const duct *d, int n)
{
  static const dvi_wall wall[] = {{.part = "left", .kind = DVI_ABSORBING},
                                  {.part = "right", .kind = DVI_ABSORBING},
                                  {.part = "bottom", .kind = DVI_PEC},
                                  {.part = "top", .kind = DVI_PEC}};
  dvi_field *field = electric(
      generated(d->mesh,
                (dvi_generator_options){.cells = {2 * n, n / 4, d->dimension == 3 ? n / 4 : 0},
                                        .extent = {2, 0.25, d->dimension == 3 ? 0.25 : 0}}),
      d->kind, NULL, (dvi_maxwell_terms){.wall = wall, .walls = 4});
  double *E = form_of(field, 1, pulse);
  dvi_march *march = march_of(field, (dvi_march_options){.fraction = 0.8}, E, NULL);
  const double first = observe_march(march, "energy");
  advance_march(march, 1.6);
  const double left = observe_march(march, "energy") / first;
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  free(E);
  return left;
}

/* At a right angle nothing comes back but by the error of the mesh. The amplitude's is of second
 * order, so that a sixteenth of the energy remains on a mesh twice as fine. */
START_TEST(waves_leave_through_open_walls)
{
  static const duct ducts[] = {{"box", DVI_CIRCUMCENTRIC, 2, 16, 1e-3},
                               {"staggered", DVI_CIRCUMCENTRIC, 2, 16, 1e-3},
                               {"staggered", DVI_WHITNEY, 2, 16, 1e-3},
                               {"kuhn", DVI_WHITNEY, 2, 16, 1e-3},
                               {"kuhn", DVI_WHITNEY, 3, 8, 1e-2}};
  for (int i = 0; i < sampled_count((int)(sizeof ducts / sizeof *ducts)); i++) {
    const int k = sampled_case(i);
    const double coarse = left_of_pulse(ducts + k, ducts[k].n),
                 fine = left_of_pulse(ducts + k, 2 * ducts[k].n);
    ck_assert_msg(coarse < ducts[k].most && fine < coarse / 10, "%s: %g and %g", ducts[k].mesh,
                  coarse, fine);
  }
}
END_TEST

SUITE(walls)
{
  tcase_add_test(tests, open_cubes_have_the_admittance_of_their_walls);
  tcase_add_test(tests, open_walls_take_energy_in_every_step);
  tcase_add_test(tests, conductors_take_energy_in_every_step);
  tcase_add_test(tests, waves_leave_through_open_walls);
}
