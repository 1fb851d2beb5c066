/* labels: unit */
/* Absorbing ends and conductors: the same fields as leapfrog has on the mesh of the boxes, whose
 * walls are made otherwise, and energy that only falls. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>

#include "support/field/electric.h"
#include "support/meshes.h"
#include "support/suite.h"
#include "support/waves/boxes.h"

/* ---- halls ---- */

enum { MOST_BOXES = 200, PMC = DVI_YEE_PMC, PEC = DVI_YEE_PEC, OPEN = DVI_YEE_ABSORBING };

typedef struct hall {
  int axes, degree, cells[3];
  double grading[3];
  int end[3][2], conducts;
} hall;

static const hall halls[] = {
    {1, 0, {20}, {1}, {{OPEN, OPEN}}, 0},
    {1, 0, {17}, {1.3}, {{PEC, OPEN}}, 1},
    {1, 0, {2}, {1.7}, {{OPEN, OPEN}}, 0},
    {2, 1, {7, 6}, {1, 1}, {{OPEN, OPEN}, {OPEN, OPEN}}, 0},
    {2, 1, {7, 6}, {1.4, 0.8}, {{OPEN, PEC}, {PMC, OPEN}}, 1},
    {2, 0, {7, 6}, {1, 1}, {{OPEN, OPEN}, {OPEN, OPEN}}, 0},
    {2, 0, {6, 8}, {0.7, 1.2}, {{PMC, OPEN}, {OPEN, PEC}}, 1},
    {3, 1, {5, 4, 6}, {1, 1, 1}, {{OPEN, OPEN}, {OPEN, OPEN}, {OPEN, OPEN}}, 0},
    {3, 1, {5, 6, 4}, {1.2, 1, 0.8}, {{PEC, OPEN}, {OPEN, PMC}, {OPEN, OPEN}}, 1},
    {3, 1, {4, 5, 6}, {1, 1.3, 1.1}, {{PMC, PMC}, {OPEN, PEC}, {PMC, OPEN}}, 0}};

enum { HALLS = sizeof halls / sizeof *halls };

/* A hall with materials at random in each box, as terms of a grid and as a field on its mesh, with
 * a dipole on the lower end of x, which always pushes. */
typedef struct twins {
  const hall *hall;
  double node[3][MOST_BOXES + 1], eps[MOST_BOXES], mu[MOST_BOXES], sigma[MOST_BOXES];
  dvi_yee_dipole dipole;
  dvi_yee_terms terms;
  dvi_field *field;
} twins;

static int constant(double t, double *value, void *user)
{
  (void)t, (void)user;
  *value = 0.3;
  return 0;
}

/* ---- the grid ---- */

static int boxes_of(const hall *own)
{
  int count = 1;
  for (int l = 0; l < own->axes; l++) count *= own->cells[l];
  return count;
}

static dvi_mesh *mesh_of(const hall *own)
{
  dvi_generator_options options = {.dimension = own->axes};
  for (int l = 0; l < own->axes; l++) {
    options.cells[l] = own->cells[l];
    options.grading[l] = own->grading[l];
    options.extent[l] = 1 + 0.1 * l;
  }
  return generated("box", options);
}

/* Read the nodes of the axes from the vertices of the mesh, to the last bit, and in order. */
static void take_nodes(twins *t, const dvi_mesh *mesh)
{
  const int axes = t->hall->axes;
  const double *point = dvi_mesh_points(mesh);
  for (int l = 0; l < axes; l++)
    for (int i = 0; i <= t->hall->cells[l]; i++) {
      t->node[l][i] = INFINITY;
      for (int64_t v = 0; v < dvi_mesh_count(mesh, 0); v++) {
        const double x = point[v * axes + l];
        if (x < t->node[l][i] && (i == 0 || x > t->node[l][i - 1])) t->node[l][i] = x;
      }
    }
}

/* Give the last node that is not beyond a coordinate. */
static int node_before(const twins *t, int axis, double x)
{
  int i = t->hall->cells[axis];
  while (t->node[axis][i] > x) i--;
  return i;
}

static void set_terms(twins *t)
{
  const hall *own = t->hall;
  const int is_scalar = own->degree == 0, across = own->axes == 1 ? 1 : 2;
  t->dipole = (dvi_yee_dipole){.at = {0, 0.45, 0.37}, .signal = constant};
  for (int l = 0; l < own->axes; l++) t->dipole.along[l] = is_scalar ? 0 : 1 - 0.4 * l;
  if (is_scalar) t->dipole.along[across] = 1;
  t->terms = (dvi_yee_terms){.size = sizeof t->terms,
                             .axes = own->axes,
                             .degree = own->degree,
                             .eps = {.cell = t->eps},
                             .mu = {.cell = t->mu},
                             .sigma = {.cell = own->conducts ? t->sigma : NULL},
                             .dipole = &t->dipole,
                             .dipoles = 1};
  for (int l = 0; l < own->axes; l++) {
    t->terms.axis[l] = (dvi_yee_axis){.cells = own->cells[l], .node = t->node[l]};
    for (int e = 0; e < 2; e++) t->terms.axis[l].end[e].kind = (dvi_yee_boundary)own->end[l][e];
  }
}

static void set_media(twins *t)
{
  unsigned long long seed = 7;
  for (int i = 0; i < boxes_of(t->hall); i++) {
    t->eps[i] = 1 + 3 * random_number(&seed);
    t->mu[i] = 1 + 2 * random_number(&seed);
    t->sigma[i] = 2 * random_number(&seed);
  }
}

/* ---- the field ---- */

static int list_walls(const hall *own, dvi_wall *wall)
{
  static const char *const name[3][2] = {{"left", "right"}, {"bottom", "top"}, {"back", "front"}};
  int count = 0;
  for (int l = 0; l < own->axes; l++)
    for (int e = 0; e < 2; e++) {
      const int end = own->end[l][e];
      if (end == PMC) continue;
      wall[count++] = (dvi_wall){name[l][e], end == PEC ? DVI_PEC : DVI_ABSORBING};
    }
  return count;
}

/* Give each cell of the mesh the materials of its box. */
static void spread_media(const twins *t, const dvi_mesh *mesh, double *eps, double *over_mu,
                         double *sigma)
{
  const int axes = t->hall->axes;
  const int64_t count = dvi_mesh_count(mesh, axes);
  double *centre = random_values(count * axes, 1);
  ck_assert(dvi_mesh_centres(mesh, axes, centre) == DVI_OK);
  for (int64_t i = 0; i < count; i++) {
    int box = 0;
    for (int l = axes - 1; l >= 0; l--)
      box = box * t->hall->cells[l] + node_before(t, l, centre[i * axes + l]);
    eps[i] = t->eps[box];
    over_mu[i] = 1 / t->mu[box];
    sigma[i] = t->sigma[box];
  }
  free(centre);
}

static void make_field(twins *t, dvi_mesh *mesh)
{
  const hall *own = t->hall;
  double eps[MOST_BOXES], over_mu[MOST_BOXES], sigma[MOST_BOXES];
  dvi_wall wall[6];
  const int is_scalar = own->degree == 0;
  dvi_current current = {.signal = constant};
  for (int l = 0; l < own->axes; l++) {
    current.at[l] = t->dipole.at[l];
    current.along[l] = is_scalar ? l == 0 : t->dipole.along[l];
  }
  spread_media(t, mesh, eps, over_mu, sigma);
  const double *factor[DVI_MESH_DIMENSION_MAX + 1] = {NULL};
  factor[own->degree] = eps;
  factor[own->degree + 1] = over_mu;
  const dvi_star_options options = {
      .size = sizeof options, .kind = DVI_CIRCUMCENTRIC, .factor = factor};
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  const dvi_maxwell_terms terms = {.size = sizeof terms,
                                   .star = star,
                                   .scalar = is_scalar,
                                   .wall = wall,
                                   .walls = list_walls(own, wall),
                                   .conductivity = own->conducts ? sigma : NULL,
                                   .current = &current,
                                   .currents = 1};
  ck_assert_msg(dvi_maxwell_create(&terms, &t->field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
}

static void make_twins(twins *t, const hall *own)
{
  dvi_mesh *mesh = mesh_of(own);
  *t = (twins){.hall = own};
  ck_assert_int_le(boxes_of(own), MOST_BOXES);
  take_nodes(t, mesh);
  set_media(t);
  set_terms(t);
  make_field(t, mesh);
  dvi_mesh_destroy(&mesh);
}

/* Give the number of the grid's edge that a cell of the mesh is. Both point upwards. */
static int64_t edge_of(const twins *t, const dvi_mesh *mesh, int64_t cell)
{
  const int axes = t->hall->axes;
  const double *point = dvi_mesh_points(mesh), *from = point + cell * axes, *to = from;
  int width, place[3] = {0, 0, 0}, c = axes == 1 ? 1 : 2;
  if (t->hall->degree == 1) {
    const int *vertex = dvi_mesh_vertices(mesh, 1, &width) + 2 * cell;
    from = point + vertex[0] * axes;
    to = point + vertex[1] * axes;
  }
  for (int l = 0; l < axes; l++) {
    ck_assert(from[l] <= to[l]);
    place[l] = node_before(t, l, from[l]);
    if (from[l] < to[l]) c = l;
  }
  return dvi_yee_place(&t->terms, DVI_FORM_E, c, place);
}

/* ---- against the mesh ---- */

typedef struct distance {
  double most, size;
} distance;

static void compare(const twins *t, const dvi_march *grid, const dvi_march *mesh, distance *d)
{
  const dvi_mesh *cells = dvi_star_mesh(dvi_field_star(t->field));
  double *E = sample_march(grid, DVI_FORM_E), *other = sample_march(mesh, DVI_FORM_E);
  for (int64_t i = 0; i < dvi_march_size(mesh, DVI_FORM_E); i++) {
    const double own = E[edge_of(t, cells, i)];
    d->most = fmax(d->most, fabs(own - other[i]));
    d->size = fmax(d->size, fabs(own));
  }
  free(E), free(other);
}

/* Start both from the same E, without B. */
static dvi_march *start_both(const twins *t, dvi_march *grid)
{
  const dvi_mesh *cells = dvi_star_mesh(dvi_field_star(t->field));
  const int64_t edges = dvi_march_size(grid, DVI_FORM_E);
  double *E = random_values(edges, 3), *same = random_values(edges, 1);
  ck_assert_int_eq(dvi_mesh_count(cells, t->hall->degree), edges);
  for (int64_t i = 0; i < edges; i++) same[i] = E[edge_of(t, cells, i)];
  start_boxes(grid, E, NULL);
  dvi_march *mesh = march_of(t->field, (dvi_march_options){.step = step_of_march(grid)}, same,
                             NULL);
  free(E), free(same);
  return mesh;
}

/* Roundings of coefficients, 4e-16, shift the phases of 200 steps by 2e-13 near the bound, which
 * fields of few modes show. */
START_TEST(absorbing_ends_are_walls_of_a_mesh)
{
  twins t;
  make_twins(&t, &halls[_i]);
  t.terms.fraction = t.hall->axes == 1 ? 0.5 : 0.9;
  dvi_march *grid = box_march(&t.terms), *mesh = start_both(&t, grid);
  const double dt = step_of_march(grid);
  distance d = {0, 0};
  compare(&t, grid, mesh, &d);
  for (int n = 1; n <= 200; n++) {
    const double now = (n + 0.5 * (n % 2)) * dt; /* between, E is the one that was stepped */
    advance_march(grid, now);
    advance_march(mesh, now);
    compare(&t, grid, mesh, &d);
    ck_assert_double_eq_tol(observe_march(grid, "energy"), observe_march(mesh, "energy"),
                            1e-12 * d.size * d.size);
  }
  ck_assert_msg(d.size > 0.5 && d.most < 1e-13 * d.size, "hall %d: %g of %g", _i, d.most, d.size);
  dvi_march_destroy(&grid);
  dvi_march_destroy(&mesh);
  dvi_field_destroy(&t.field);
}
END_TEST

/* ---- energy ---- */

/* Each step takes dt E.S E, so that only roundings of 1e-16 may add to what was there. */
START_TEST(energy_only_falls_near_the_bound)
{
  twins t;
  make_twins(&t, &halls[_i]);
  t.terms.dipoles = 0;
  t.terms.fraction = 0.99;
  dvi_march *march = box_march(&t.terms);
  const double dt = step_of_march(march);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3),
         *B = random_values(dvi_march_size(march, DVI_FORM_B), 4);
  start_boxes(march, E, B);
  double before = observe_march(march, "energy");
  const double start = before;
  for (int n = 1; n <= repeats(10000); n++) {
    advance_march(march, n * dt);
    const double now = observe_march(march, "energy");
    ck_assert_msg(now <= before + 4e-16 * start, "hall %d, step %d: %.17g after %.17g", _i, n, now,
                  before);
    before = now;
  }
  free(E), free(B);
  dvi_march_destroy(&march);
  dvi_field_destroy(&t.field);
}
END_TEST

/* A field that reaches the ends at the start leaves as well as any other, but for the short waves
 * of its jump there, 1e-5 of its energy. */
START_TEST(a_constant_field_leaves)
{
  enum { BOXES = 40 };
  double E[BOXES + 1];
  dvi_yee_terms terms = {
      .size = sizeof terms,
      .axes = 1,
      .axis = {
          {.cells = BOXES, .end = {{.kind = DVI_YEE_ABSORBING}, {.kind = DVI_YEE_ABSORBING}}}}};
  for (int i = 0; i <= BOXES; i++) E[i] = 1;
  dvi_march *march = box_march(&terms);
  start_boxes(march, E, NULL);
  const double start = observe_march(march, "energy");
  advance_march(march, 5);
  ck_assert_double_lt(observe_march(march, "energy"), 1e-4 * start);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- strong losses ---- */

/* Without B a field decays as r^n, r = (1 - s)/(1 + s), whatever s is, and a start is seen as it
 * was given. */
START_TEST(strong_losses_have_samples)
{
  static const double strength[] = {0.5, 1, 4, 1000};
  enum { N = 4 };
  const double s = strength[_i], dt = 0.5, r = (1 - s) / (1 + s), E[N] = {1, 1, 1, 1};
  double sigma[N];
  for (int i = 0; i < N; i++) sigma[i] = 2 * s / dt;
  const dvi_yee_axis axis = {
      .cells = N, .upper = N, .end = {{.kind = DVI_YEE_PERIODIC}, {.kind = DVI_YEE_PERIODIC}}};
  const dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 1, .axis = {axis}, .sigma = {.cell = sigma}, .step = dt};
  dvi_march *march = box_march(&terms);
  start_boxes(march, E, NULL);
  for (int n = 0; n <= 3; n++) {
    advance_march(march, n * dt);
    double *now = sample_march(march, DVI_FORM_E);
    for (int i = 0; i < N; i++) ck_assert_double_eq_tol(now[i], pow(r, n), 1e-13);
    free(now);
  }
  dvi_march_destroy(&march);
}
END_TEST

/* ---- charge ---- */

/* What conductors carry is accounted for, beside absorbing ends and with a phase, too. */
START_TEST(conductors_keep_account_of_charge)
{
  enum { N = 5 };
  double sigma[N * N * N];
  unsigned long long seed = 3;
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 3, .degree = 1, .sigma = {.cell = sigma}};
  for (int i = 0; i < N * N * N; i++) sigma[i] = random_number(&seed);
  for (int l = 0; l < 3; l++) {
    terms.axis[l] = (dvi_yee_axis){.cells = N, .upper = N, .phase = 0.7};
    for (int e = 0; e < 2; e++)
      terms.axis[l].end[e].kind = l == 2 ? DVI_YEE_BLOCH : DVI_YEE_ABSORBING;
  }
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3);
  start_boxes(march, E, NULL);
  advance_march(march, 20);
  ck_assert_double_gt(observe_march(march, "energy"), 1e-9);
  ck_assert_double_le(observe_march(march, "gauss"), 1e-13);
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- plane waves ---- */

static int bell(double t, double *value, void *user)
{
  (void)user;
  *value = exp(-(t - 2) * (t - 2));
  return 0;
}

/* Where a wave that enters its box first makes a field, that on an end has the share 1/(1 + s) of
 * that inside, as all that pushes there has. */
START_TEST(waves_enter_along_absorbing_ends)
{
  enum { BOXES = 12 };
  const dvi_yee_wave wave = {.lower = {3, 0, 0},
                             .upper = {9, BOXES, 0},
                             .direction = {1, 0, 0},
                             .polarization = {0, 0, 1},
                             .signal = bell};
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 2, .wave = &wave, .waves = 1, .step = 0.6};
  for (int l = 0; l < 2; l++) terms.axis[l] = (dvi_yee_axis){.cells = BOXES, .upper = BOXES};
  terms.axis[1].end[1].kind = DVI_YEE_ABSORBING;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  double inside = 0, on_end = 0;
  for (int n = 0; inside == 0; n++) {
    advance_march(march, (n + 0.5) * terms.step);
    double *E = sample_march(march, DVI_FORM_E);
    const int middle[] = {3, 6}, end[] = {3, BOXES};
    inside = E[dvi_yee_place(&terms, DVI_FORM_E, 2, middle)];
    on_end = E[dvi_yee_place(&terms, DVI_FORM_E, 2, end)];
    free(E);
  }
  ck_assert_double_eq_tol(on_end / inside * (1 + terms.step), 1, 1e-14);
  dvi_march_destroy(&march);
}
END_TEST

SUITE(yee_walls)
{
  tcase_add_loop_test(tests, absorbing_ends_are_walls_of_a_mesh, 0, HALLS);
  tcase_add_loop_test(tests, energy_only_falls_near_the_bound, 0, HALLS);
  tcase_add_test(tests, a_constant_field_leaves);
  tcase_add_loop_test(tests, strong_losses_have_samples, 0, 4);
  tcase_add_test(tests, conductors_keep_account_of_charge);
  tcase_add_test(tests, waves_enter_along_absorbing_ends);
}
